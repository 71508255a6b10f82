//! Indices of mesh elements: `u32` newtypes, so that a vertex is never taken for a face.

use core::fmt;

macro_rules! index_type {
    ($(#[$doc:meta])* $name:ident, $noun:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(transparent)]
        pub struct $name(pub u32);

        impl $name {
            /// The index as `usize`, for arrays.
            #[inline]
            pub const fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl fmt::Debug for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, concat!($noun, " {}"), self.0)
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, concat!($noun, " {}"), self.0)
            }
        }
    };
}

index_type!(
    /// A vertex of a mesh, counted from 0.
    VertexId,
    "vertex"
);
index_type!(
    /// A face of a mesh, counted from 0.
    FaceId,
    "face"
);
index_type!(
    /// A half-edge: `3·face + corner`, running from that corner of the face to the next one.
    HalfEdgeId,
    "half-edge"
);

impl HalfEdgeId {
    /// The half-edge that leaves corner `corner` (0, 1 or 2) of `face`.
    #[inline]
    pub const fn of(face: FaceId, corner: usize) -> Self {
        Self(face.0 * 3 + corner as u32)
    }

    /// The face to its left.
    #[inline]
    pub const fn face(self) -> FaceId {
        FaceId(self.0 / 3)
    }

    /// The corner of its face that it leaves: 0, 1 or 2.
    #[inline]
    pub const fn corner(self) -> usize {
        (self.0 % 3) as usize
    }

    /// The next half-edge of the same face, counter-clockwise.
    #[inline]
    pub const fn next(self) -> Self {
        Self(if self.0 % 3 == 2 {
            self.0 - 2
        } else {
            self.0 + 1
        })
    }

    /// The previous half-edge of the same face.
    #[inline]
    pub const fn previous(self) -> Self {
        Self(if self.0.is_multiple_of(3) {
            self.0 + 2
        } else {
            self.0 - 1
        })
    }
}

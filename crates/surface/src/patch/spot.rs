//! Where part of a piece is over its face: what division in four leads to.

/// A part of the parameter triangle: its first corner, and its edges' length there, negative where it is inverted.
#[derive(Clone, Copy, Debug)]
pub struct ParamTriangle {
    pub u: f64,
    pub v: f64,
    pub size: f64,
}

impl ParamTriangle {
    pub const WHOLE: Self = Self {
        u: 0.0,
        v: 0.0,
        size: 1.0,
    };

    /// One of its four parts, as [`super::RefinedPatch`] numbers them.
    #[inline]
    pub fn child(self, child: usize) -> Self {
        let Self { u, v, size } = self;
        let half = 0.5 * size;
        match child {
            0 => Self { u, v, size: half },
            1 => Self {
                u: u + half,
                v,
                size: half,
            },
            2 => Self {
                u,
                v: v + half,
                size: half,
            },
            _ => Self {
                u: u + half,
                v: v + half,
                size: -half,
            },
        }
    }

    /// The part `depth` levels below whose first corner stands i edges along edge 0 and j along edge 2 from the first corner.
    #[inline]
    pub fn leaf(self, depth: u32, i: usize, j: usize) -> Self {
        let size = self.size / f64::from(1u32 << depth);
        Self {
            u: self.u + size * i as f64,
            v: self.v + size * j as f64,
            size,
        }
    }

    /// The part `depth` levels below in column i and row j, upright or inverted.
    pub fn row(self, depth: u32, i: usize, j: usize, is_inverted: bool) -> Self {
        let Self { u, v, size } = self.leaf(depth, i, j);
        if is_inverted {
            Self {
                u: u + size,
                v: v + size,
                size: -size,
            }
        } else {
            Self { u, v, size }
        }
    }

    pub fn corners(self) -> [[f64; 2]; 3] {
        let Self { u, v, size } = self;
        [[u, v], [u + size, v], [u, v + size]]
    }

    /// A place along an edge, `t` from its start to its end.
    pub fn along(self, edge: usize, t: f64) -> [f64; 2] {
        let Self { u, v, size } = self;
        let t = t * size;
        match edge {
            0 => [u + t, v],
            1 => [u + (size - t), v + t],
            _ => [u, v + (size - t)],
        }
    }

    /// The place of the part's own (u, v) in the whole.
    #[inline]
    pub fn at(self, [u, v]: [f64; 2]) -> [f64; 2] {
        [self.u + self.size * u, self.v + self.size * v]
    }

    /// The weights of the whole's corners at the part's own (u, v).
    pub(crate) fn weights(self, at: [f64; 2]) -> [f64; 3] {
        let [u, v] = self.at(at);
        [1.0 - u - v, u, v].map(|weight| weight.clamp(0.0, 1.0))
    }
}

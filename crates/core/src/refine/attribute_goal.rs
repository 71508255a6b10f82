//! Goals for the data that a mesh carries in addition to its shape: values at its vertices, or
//! other positions of its vertices.

use crate::mesh::{Mesh, MeshError};

/// The function that is bounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum GoalKind {
    /// The difference at the same place.
    Values,
    /// The distance between two surfaces.
    Surface,
}

/// A goal for a function on the control mesh's faces, which triangles store at their corners and
/// interpolate linearly: it must be within a tolerance of the original, everywhere
/// ([`Goals::attributes`](super::Goals::attributes)).
///
/// The function is the limit surface of a mesh with the control mesh's faces in the same order,
/// whose positions are the values. Its vertices may differ: where one is repeated, values have a
/// seam.
#[derive(Clone, Debug)]
pub struct AttributeGoal {
    pub(crate) meshes: Vec<Mesh>,
    pub(crate) tolerance: f64,
    pub(crate) kind: GoalKind,
}

impl AttributeGoal {
    /// The values of a place differ by no more than `tolerance`, as a Euclidean length over all their numbers; each mesh has
    /// three of these as its positions ([`crate::carry::goal`] makes them of a channel).
    pub fn values(meshes: Vec<Mesh>, tolerance: f64) -> Self {
        Self {
            meshes,
            tolerance,
            kind: GoalKind::Values,
        }
    }

    /// The surface of `moved`, by a morph target or a pose, and the refined triangles moved alike
    /// are within `tolerance` of each other, both ways.
    pub fn surface(moved: Mesh, tolerance: f64) -> Self {
        Self {
            meshes: vec![moved],
            tolerance,
            kind: GoalKind::Surface,
        }
    }

    /// Refuses tolerances that are not positive numbers, and meshes with another number of faces.
    pub(crate) fn check(&self, faces: usize) -> Result<(), MeshError> {
        let bad = |name, value, expected| {
            Err(MeshError::BadOption {
                name,
                value,
                expected,
            })
        };
        if !(self.tolerance > 0.0 && self.tolerance.is_finite()) {
            return bad(
                "tolerance of an attribute",
                self.tolerance,
                "a number above 0",
            );
        }
        match self.meshes.iter().find(|mesh| mesh.face_count() != faces) {
            Some(mesh) => bad(
                "number of an attribute's faces",
                mesh.face_count() as f64,
                "that of the control mesh",
            ),
            None => Ok(()),
        }
    }
}

//! The criterion of Amresh, Farin and Razdan (2000), with which the paper compares itself.

use super::{Criterion, CriterionError, check_angle};
use crate::index::{FaceId, HalfEdgeId};
use crate::limit::LimitTable;
use crate::mesh::{INFINITELY_SHARP, Mesh, Sharpness};
use crate::parallel;

/// A face is divided where its normal and that of an edge neighbour differ by more than an angle.
///
/// Faces without area have no say, and neither have neighbours across an edge that stays sharp for ever.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct NeighbourNormal {
    /// The angle, in radians.
    pub angle: f64,
}

impl NeighbourNormal {
    /// The criterion with its angle in radians.
    pub fn new(angle: f64) -> Self {
        Self { angle }
    }
}

impl Criterion for NeighbourNormal {
    fn name(&self) -> &str {
        "amresh"
    }

    fn divisible(&self, mesh: &Mesh, _limits: &LimitTable<'_>) -> Result<Vec<bool>, CriterionError> {
        check_angle(self.angle)?;
        let normals = parallel::map(mesh.face_count(), |f| mesh.unit_face_normal(f));
        let cosine = self.angle.cos();
        let sharpness = Sharpness::of(mesh);
        Ok(parallel::map(mesh.face_count(), |face| {
            let normal = normals[face];
            normal.length_squared() > 0.0
                && (0..3).any(|corner| {
                    let h = HalfEdgeId::of(FaceId(face as u32), corner);
                    mesh.topology().twin(h).is_some_and(|twin| {
                        let other = normals[twin.face().index()];
                        other.length_squared() > 0.0
                            && other.dot(normal) < cosine
                            && sharpness.edge(h) < INFINITELY_SHARP
                    })
                })
        }))
    }
}

//! The criterion of Amresh, Farin and Razdan (2000), with which the paper compares itself.

use super::{Criterion, CriterionError, angle_ratio, check_angle};
use crate::index::{FaceId, HalfEdgeId};
use crate::limit::LimitTable;
use crate::mesh::{INFINITELY_SHARP, Mesh, Sharpness};
use crate::parallel;

/// A face fails where its normal and that of an edge neighbour differ by more than an angle.
///
/// Faces without area are ignored, and so are neighbours across an infinitely sharp edge.
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

    fn ratios(&self, mesh: &Mesh, _limits: &LimitTable<'_>) -> Result<Vec<f64>, CriterionError> {
        check_angle(self.angle)?;
        let normals = parallel::map(mesh.face_count(), |f| mesh.unit_face_normal(f));
        let sharpness = Sharpness::of(mesh);
        Ok(parallel::map(mesh.face_count(), |face| {
            let normal = normals[face];
            if normal.length_squared() == 0.0 {
                return 0.0;
            }
            let cosines = (0..3).filter_map(|corner| {
                let h = HalfEdgeId::of(FaceId(face as u32), corner);
                let other = normals[mesh.topology().twin(h)?.face().index()];
                let counts = other.length_squared() > 0.0 && sharpness.edge(h) < INFINITELY_SHARP;
                counts.then(|| other.dot(normal))
            });
            cosines
                .reduce(f64::min)
                .map_or(0.0, |cosine| angle_ratio(cosine, self.angle))
        }))
    }
}

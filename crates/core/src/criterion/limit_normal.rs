//! The paper's criterion, equation (2), and its view-dependent form, equation (11).

use super::view::Threshold;
use super::{Criterion, CriterionError, View, check_angle};
use crate::index::{FaceId, HalfEdgeId};
use crate::limit::LimitTable;
use crate::mesh::Mesh;
use crate::parallel;
use crate::vector::{DVec3, vector};

/// A face is divided where its normal leaves the cone of angle α around the limit normal of one of its vertices:
/// `min_i N_Vi · N_f < cos α`.
///
/// Vertices on sharp edges have a limit normal for each side; each face is judged by that of its own. Faces without
/// area and vertices without a limit normal have no say.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct LimitNormal {
    /// The cone's angle α, in radians.
    pub angle: f64,
    /// Makes the angle depend on where the viewer stands.
    pub view: Option<View>,
}

impl LimitNormal {
    /// The criterion with the cone's angle in radians.
    pub fn new(angle: f64) -> Self {
        Self { angle, view: None }
    }

    /// Sets [`Self::view`].
    pub fn view(mut self, view: View) -> Self {
        self.view = Some(view);
        self
    }
}

/// The threshold for face `face`, whose unit normal is given, as a view has it.
fn seen(view: &View, angle: f64, mesh: &Mesh, face: usize, normal: DVec3) -> Threshold {
    let [a, b, c] = mesh.as_triangles().corners(face).map(vector);
    view.threshold(angle, view.direction(a / 3.0 + b / 3.0 + c / 3.0).dot(normal))
}

impl Criterion for LimitNormal {
    fn name(&self) -> &str {
        "limit-normal"
    }

    fn divisible(&self, mesh: &Mesh, limits: &LimitTable<'_>) -> Result<Vec<bool>, CriterionError> {
        check_angle(self.angle)?;
        self.view.map_or(Ok(()), |view| view.check())?;
        let normals = limits.sided_normals(mesh)?;
        // Without a view the cosine is the same for all faces.
        let plain_cosine = self.angle.cos();
        Ok(parallel::map(mesh.face_count(), |face| {
            let normal = mesh.unit_face_normal(face);
            if normal.length_squared() == 0.0 {
                return false;
            }
            let cosine = match self.view.map(|view| seen(&view, self.angle, mesh, face, normal)) {
                None => plain_cosine,
                Some(Threshold::Never) => return false,
                Some(Threshold::Always) => return true,
                Some(Threshold::Angle(angle)) => angle.cos(),
            };
            (0..3).any(|corner| {
                let corner = HalfEdgeId::of(FaceId(face as u32), corner);
                let limit_normal = vector(normals.at(mesh.topology(), corner));
                limit_normal.length_squared() > 0.0 && limit_normal.dot(normal) < cosine
            })
        }))
    }
}

//! Pieces of any limit surface: a face with as much of the mesh around it as decides the surface over it.
//!
//! For schemes of no known family. One refinement is a step of uniform refinement of the piece's surroundings, which
//! honours all tags; limits of vertices come from the scheme's stencils. Both are sums of the piece's points, whose weights are those of
//! its form ([`super::mesh_form`]).

use std::sync::Arc;

use super::mesh_form::{GridPoint, MeshForm, SAMPLED_LEVELS, surroundings};
use super::rules::Rules;
use super::{Limit, Patch};
use crate::index::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::{Mesh, Sharpness};
use crate::vector::{DVec3, vector};

/// A face with all that the surface over it depends on.
#[derive(Clone, Debug)]
pub struct MeshPatch {
    form: Arc<MeshForm>,
    points: Vec<DVec3>,
}

impl MeshPatch {
    /// The piece over a face of a mesh.
    pub fn of(mesh: &Mesh, sharpness: &Sharpness<'_>, face: FaceId, rules: &Rules<'_>) -> Self {
        let (small, sources) = surroundings(mesh, sharpness, HalfEdgeId::of(face, 0));
        let points = sources
            .iter()
            .map(|v| vector(mesh.positions()[v.index()]))
            .collect();
        Self {
            form: rules.forms().root(small),
            points,
        }
    }

    fn corners(&self) -> [VertexId; 3] {
        self.form.mesh.triangles()[0].map(VertexId)
    }

    /// The point of a corner of the face.
    pub(super) fn control_point(&self, corner: usize) -> DVec3 {
        self.points[self.corners()[corner].index()]
    }

    /// The corners and their neighbours; some more than once.
    pub(crate) fn points(&self) -> impl Iterator<Item = DVec3> + '_ {
        let topology = self.form.mesh.topology();
        let around = self
            .corners()
            .into_iter()
            .flat_map(|v| core::iter::once(v).chain(topology.ring(v)));
        around.map(|v| self.points[v.index()])
    }

    /// The limits of all vertices [`SAMPLED_LEVELS`] below, the corners left out, and where they stand; none after a failure, which
    /// the rules keep.
    pub fn samples(&self, rules: &Rules<'_>) -> Vec<(GridPoint, DVec3)> {
        let limit = |weights: &[f64]| {
            weights
                .iter()
                .zip(&self.points)
                .map(|(&w, &point)| w * point)
                .sum()
        };
        match self.form.samples(SAMPLED_LEVELS, rules.forms()) {
            Ok(samples) => samples
                .iter()
                .map(|(place, weights)| (*place, limit(weights)))
                .collect(),
            Err(why) => {
                rules.fail(why);
                Vec::new()
            }
        }
    }

    /// The piece refined once.
    pub(crate) fn refined<'a>(&self, rules: &'a Rules<'a>) -> RefinedMeshPatch<'a> {
        let points = self.form.step(rules.forms()).points(&self.points);
        RefinedMeshPatch {
            form: Arc::clone(&self.form),
            points,
            rules,
        }
    }
}

/// A piece refined once.
pub struct RefinedMeshPatch<'a> {
    /// Before the step.
    form: Arc<MeshForm>,
    /// After it.
    points: Vec<DVec3>,
    rules: &'a Rules<'a>,
}

impl RefinedMeshPatch<'_> {
    /// A part; numbered as [`super::box_spline::Refined::part`] does.
    pub(crate) fn part(&self, part: usize) -> Patch {
        let (form, points) =
            self.form
                .step(self.rules.forms())
                .part(part, &self.points, self.rules.forms());
        Patch::Mesh(MeshPatch { form, points })
    }

    /// The limit of the new vertex on the edge from corner `edge`, on the face's side; the origin and no normal after a failure, which the
    /// rules keep.
    pub(crate) fn middle<L: Limit>(&self, edge: usize) -> L {
        let step = self.form.step(self.rules.forms());
        let position = step
            .middle(edge, &self.points)
            .map_err(|why| self.rules.fail(why));
        L::of(position.unwrap_or_default(), || {
            let normal = step.middle_normal(edge, &self.points, self.rules.table());
            vector(
                normal
                    .map_err(|why| self.rules.fail(why))
                    .unwrap_or_default(),
            )
        })
    }
}

//! The sharp edges and vertices of a part: edges beyond an angle, and the tips of cones.

use crate::index::{HalfEdgeId, VertexId};
use crate::math;
use crate::mesh::{CreasesAbove, Mesh, MeshError};
use crate::parallel;
use crate::vector::DVec3;

/// The sharp edges and vertices of a part.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Part {
    /// The angle between faces' normals that parts sharp edges from others, in degrees.
    pub degrees: f64,
    /// The edges beyond that angle.
    pub creases: CreasesAbove,
    /// The tips of cones: vertices at which no edge is sharp, but whose faces lean more than half of that angle away from their common
    /// normal, whereas the surface around them is straight.
    pub tips: Vec<VertexId>,
}

/// Edges across from a tip bend by less than this part of how far its faces lean; on a sphere by as much as these, or twice as much.
const STRAIGHT: f64 = 0.5;

impl Part {
    /// The sharp edges and vertices of `mesh`: edges whose faces' normals differ by more than `degrees`.
    ///
    /// # Errors
    /// The angle is not within 0 … 180.
    pub fn at_angle(degrees: f64, mesh: &Mesh) -> Result<Self, MeshError> {
        let creases = mesh.creases_above(degrees.to_radians())?;
        let tips = tips(mesh, &creases.edges, degrees.to_radians());
        Ok(Self {
            degrees,
            creases,
            tips,
        })
    }

    /// The mesh with creases along the sharp edges and corners at the tips; the tags that it has stay.
    pub fn on(&self, mesh: Mesh) -> Mesh {
        mesh.with_creases(&self.creases.edges)
            .with_corners(&self.tips)
    }
}

/// The tips of cones, ascending.
fn tips(mesh: &Mesh, sharp: &[HalfEdgeId], angle: f64) -> Vec<VertexId> {
    let topology = mesh.topology();
    let normals = parallel::map(mesh.face_count(), |face| mesh.unit_face_normal(face));
    let mut is_sharp = vec![false; topology.half_edge_count()];
    for &h in sharp {
        is_sharp[h.index()] = true;
        topology
            .twin(h)
            .into_iter()
            .for_each(|twin| is_sharp[twin.index()] = true);
    }
    let between = |m: DVec3, n: DVec3| math::atan2(m.cross(n).length(), m.dot(n));
    let normal = |h: HalfEdgeId| normals[h.face().index()];
    let is_tip = |&v: &VertexId| {
        let spokes = || topology.outgoing_ring(v);
        if topology.is_boundary(v) || spokes().any(|h| is_sharp[h.index()]) {
            return false;
        }
        let common: DVec3 = spokes().map(normal).sum();
        let lean = spokes()
            .map(|h| between(normal(h), common))
            .fold(0.0, f64::max);
        // The edges across from the vertex, with the faces beyond them.
        let across = spokes()
            .map(HalfEdgeId::next)
            .filter(|h| !is_sharp[h.index()]);
        let bends = across.filter_map(|h| Some(between(normal(h), normal(topology.twin(h)?))));
        2.0 * lean > angle && bends.fold(0.0, f64::max) < STRAIGHT * lean
    };
    topology.vertices().filter(is_tip).collect()
}

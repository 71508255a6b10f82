//! How the faces of a mesh meet at the edges between them.

use crate::index::{HalfEdgeId, VertexId};
use crate::math;
use crate::mesh::Mesh;
use crate::parallel;
use crate::vector::{DVec3, vector};

/// Edges longer than so many times what vertices are apart in the median lead to a damaged coordinate.
const FAR: f64 = 1000.0;

/// An edge between two faces, and how they meet there.
pub(super) struct Bend {
    pub(super) edge: HalfEdgeId,
    pub(super) twin: HalfEdgeId,
    /// Between the normals.
    pub(super) degrees: f64,
    pub(super) is_concave: bool,
    pub(super) length: f64,
}

/// How faces meet at the edges between them, but for edges that lead to damaged coordinates.
pub(super) fn bends(mesh: &Mesh) -> Vec<Bend> {
    let topology = mesh.topology();
    let normals = parallel::map(mesh.face_count(), |face| mesh.unit_face_normal(face));
    let longest = FAR * middle_distance(mesh.positions());
    let bend = |edge: HalfEdgeId| {
        let twin = topology.twin(edge).filter(|twin| edge < *twin)?;
        let [m, n] = [edge, twin].map(|h| normals[h.face().index()]);
        let [a, b] = topology
            .ends(edge)
            .map(|v| vector(mesh.positions()[v.index()]));
        let (degrees, length) = (
            math::atan2(m.cross(n).length(), m.dot(n)).to_degrees(),
            (b - a).length(),
        );
        let is_one = m != DVec3::ZERO && n != DVec3::ZERO && length <= longest;
        is_one.then(|| Bend {
            edge,
            twin,
            degrees,
            is_concave: is_concave(mesh, edge),
            length,
        })
    };
    topology.half_edges().filter_map(bend).collect()
}

/// Whether the faces at an edge inside the mesh look towards each other.
pub(super) fn is_concave(mesh: &Mesh, h: HalfEdgeId) -> bool {
    let topology = mesh.topology();
    let at = |v: VertexId| vector(mesh.positions()[v.index()]);
    let beyond = topology.twin(h).map_or(DVec3::ZERO, |twin| {
        at(topology.opposite(twin)) - at(topology.origin(h))
    });
    beyond.dot(mesh.scaled_face_normal(h.face().index())) > 0.0
}

/// The median distance of `positions` from the median of their coordinates: a size that a damaged coordinate does not change.
fn middle_distance(positions: &[[f64; 3]]) -> f64 {
    let median = |mut values: Vec<f64>| {
        let middle = values.len() / 2;
        if values.is_empty() {
            0.0
        } else {
            *values.select_nth_unstable_by(middle, f64::total_cmp).1
        }
    };
    let centre = vector([0, 1, 2].map(|axis| median(positions.iter().map(|p| p[axis]).collect())));
    median(
        positions
            .iter()
            .map(|&p| (vector(p) - centre).length())
            .collect(),
    )
}

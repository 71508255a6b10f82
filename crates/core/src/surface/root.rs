//! The patch of a control face.

use super::fan::{Centre, Fan, Fans};
use super::patch::Patch;
use crate::index::{FaceId, HalfEdgeId};
use crate::mesh::Mesh;
use crate::vector::vector;

/// The limit surface over a control face.
pub(crate) fn root_patch(mesh: &Mesh, face: FaceId) -> Patch {
    Patch::of(Fans([0, 1, 2].map(|corner| fan(mesh, HalfEdgeId::of(face, corner)))))
}

/// The fan of the origin of `h`, on the side of the face of `h`.
fn fan(mesh: &Mesh, h: HalfEdgeId) -> Fan {
    let topology = mesh.topology();
    let vertex = topology.origin(h);
    let open = topology.is_boundary(vertex);
    let corner = mesh.tags().is_corner(vertex);
    let target = topology.target(h);
    let at = |v: crate::index::VertexId| vector(mesh.positions()[v.index()]);
    let ring: Vec<_> = topology.ring(vertex).collect();
    let slot = ring.iter().position(|&u| u == target).unwrap_or(0);
    let centre = match (corner, open) {
        (true, open) => Centre::Corner { open },
        (false, true) => Centre::Crease,
        (false, false) => Centre::Smooth { sharp: None },
    };
    Fan { at: at(vertex), neighbours: ring.into_iter().map(at).collect(), centre, slot }
}

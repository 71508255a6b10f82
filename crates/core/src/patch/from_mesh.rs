//! The patch of a control face.

use super::large_rings::LargeRings;
use super::mesh_patch::MeshPatch;
use super::rules::Rules;
use super::sector::{Centre, Far, SectorPatch, VertexSector};
use super::semi_sharp::{SemiSharpPatch, SemiSharpVertex};
use super::{Neighbours, Patch};
use crate::index::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::{Mesh, Sector, Sharpness, Topology};
use crate::ring::RingShape;
use crate::vector::vector;

/// The limit surface over a control face.
///
/// `large` are the mesh's large rings.
pub(crate) fn root_patch(
    mesh: &Mesh,
    sharpness: &Sharpness<'_>,
    large: &LargeRings,
    face: FaceId,
    rules: &Rules<'_>,
) -> Patch {
    let corners = [0, 1, 2].map(|corner| HalfEdgeId::of(face, corner));
    if !rules.is_certified() {
        return Patch::Mesh(MeshPatch::of(mesh, sharpness, face));
    }
    match fades(mesh, sharpness, corners) {
        true => SemiSharpPatch::of(corners.map(|h| SemiSharpVertex::of(mesh, sharpness, h))),
        false => patch_of(mesh, sharpness, large, corners),
    }
}

/// Whether a tag that fades decides the surface over a face, given its corners.
pub(super) fn fades(mesh: &Mesh, sharpness: &Sharpness<'_>, corners: [HalfEdgeId; 3]) -> bool {
    let vertices = corners.map(|h| mesh.topology().origin(h));
    vertices.into_iter().any(|v| sharpness.is_tagged(v) && sharpness.ring(v).fading() > 0.0)
}

/// The surface over a face, given its corners, for a scheme of the Loop family. No tag may fade there.
fn patch_of(mesh: &Mesh, sharpness: &Sharpness<'_>, large: &LargeRings, corners: [HalfEdgeId; 3]) -> Patch {
    let near = |h: HalfEdgeId| {
        let is_tagged = sharpness.is_tagged(mesh.topology().origin(h));
        if is_tagged { None } else { large.sector(mesh, h) }
    };
    Patch::of(SectorPatch(
        corners.map(|corner| near(corner).unwrap_or_else(|| sector(mesh, sharpness, corner))),
    ))
}

/// The sector of the origin of `h`, on the side of the face of `h`.
fn sector(mesh: &Mesh, sharpness: &Sharpness<'_>, h: HalfEdgeId) -> VertexSector {
    let topology = mesh.topology();
    let at = |v: VertexId| vector(mesh.positions()[v.index()]);
    let sector = sector_of(topology, sharpness, h);
    let neighbours: Neighbours = sector.neighbours(topology).map(at).collect();
    let slot = sector.outgoing(topology).position(|other| other == h).unwrap_or(0);
    VertexSector {
        at: at(topology.origin(h)),
        neighbours,
        centre: Centre::of(sector.shape),
        slot,
        far: Far::Kept,
    }
}

/// The sector of the ring of the origin of `h` that the face of `h` is in.
pub(crate) fn sector_of(topology: &Topology, sharpness: &Sharpness<'_>, h: HalfEdgeId) -> Sector {
    let vertex = topology.origin(h);
    let (valence, open) = topology.valence_and_openness(vertex);
    if !sharpness.is_tagged(vertex) {
        // A closed ring has no beginning of its own.
        let first = if open { topology.outgoing(vertex) } else { h };
        let shape = RingShape { open, ..RingShape::interior(valence) };
        return Sector { first, shape };
    }
    let sectors = sharpness.sectors(vertex);
    let own = sectors.iter().find(|sector| sector.outgoing(topology).any(|other| other == h));
    own.copied().unwrap_or(Sector { first: h, shape: RingShape::interior(valence) })
}

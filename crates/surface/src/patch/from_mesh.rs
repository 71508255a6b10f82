//! The patch of a control face.

use super::large_rings::LargeRings;
use super::mesh_patch::MeshPatch;
use super::quad::root_piece;
use super::rules::Rules;
use super::sector::{Centre, Far, SectorPatch, VertexSector};
use super::semi_sharp::{SemiSharpPatch, SemiSharpVertex};
use super::{Neighbours, Patch, Points, box_spline};
use crate::index::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::{Mesh, Sector, Sharpness, Topology};
use crate::ring::RingShape;
use crate::vector::vector;

/// The limit surface over a control face.
///
/// `large` are the mesh's large rings.
pub fn root_patch(
    mesh: &Mesh,
    sharpness: &Sharpness<'_>,
    large: &LargeRings,
    face: FaceId,
    rules: &Rules<'_>,
) -> Patch {
    if mesh.topology().has_quads() {
        return root_piece(mesh, sharpness, face, rules);
    }
    let corners = [0, 1, 2].map(|corner| HalfEdgeId::of(face, corner));
    if !rules.is_certified() {
        return Patch::Mesh(MeshPatch::of(mesh, sharpness, face, rules));
    }
    if let Some(points) = regular(mesh, sharpness, corners) {
        return Patch::Regular(points);
    }
    match is_semi_sharp(mesh, sharpness, large, corners) {
        true => SemiSharpPatch::of(
            corners.map(|h| match large.whole(mesh.topology().origin(h)) {
                Some(ring) => ring.near(h),
                None => SemiSharpVertex::of(mesh, sharpness, h),
            }),
        ),
        false => patch_of(mesh, sharpness, large, corners),
    }
}

/// The points around a face whose corners are regular vertices inside the surface, without tags: most there are, so that they are not
/// looked at any closer.
fn regular(mesh: &Mesh, sharpness: &Sharpness<'_>, corners: [HalfEdgeId; 3]) -> Option<Points> {
    let topology = mesh.topology();
    let ring = |h: HalfEdgeId| {
        let mut targets = topology.outgoing_from(h).map(|h| topology.target(h));
        let mut ring = [topology.target(h); 6];
        for vertex in &mut ring {
            *vertex = targets.next()?;
        }
        targets.next().is_none().then_some(ring)
    };
    let vertices = corners.map(|h| topology.origin(h));
    if vertices
        .into_iter()
        .any(|vertex| sharpness.is_tagged(vertex) || topology.is_boundary(vertex))
    {
        return None;
    }
    let [a, b, c] = corners;
    let rings = [ring(a)?, ring(b)?, ring(c)?];
    let points = box_spline::assemble(vertices, rings.each_ref(), [0; 3]);
    Some(points.map(|vertex| vector(mesh.positions()[vertex.index()])))
}

/// Whether a semi-sharp tag decides the surface over a face, given its corners.
pub(super) fn is_semi_sharp(
    mesh: &Mesh,
    sharpness: &Sharpness<'_>,
    large: &LargeRings,
    corners: [HalfEdgeId; 3],
) -> bool {
    let is_semi_sharp = |vertex: VertexId| match large.whole(vertex) {
        Some(ring) => ring.is_semi_sharp(),
        None => sharpness.ring(vertex).semi_sharpness() > 0.0,
    };
    let mut vertices = corners.into_iter().map(|h| mesh.topology().origin(h));
    vertices.any(|vertex| sharpness.is_tagged(vertex) && is_semi_sharp(vertex))
}

/// The surface over a face, given its corners, for a scheme of the Loop family. No tag may be semi-sharp there.
fn patch_of(
    mesh: &Mesh,
    sharpness: &Sharpness<'_>,
    large: &LargeRings,
    corners: [HalfEdgeId; 3],
) -> Patch {
    let near = |h: HalfEdgeId| {
        let vertex = mesh.topology().origin(h);
        match sharpness.is_tagged(vertex) {
            true => large.whole(vertex).map(|ring| ring.near(h).sector()),
            false => large.sector(mesh, h),
        }
    };
    Patch::of(SectorPatch(corners.map(|corner| {
        near(corner).unwrap_or_else(|| sector(mesh, sharpness, corner))
    })))
}

/// The sector of the origin of `h`, on the side of the face of `h`.
fn sector(mesh: &Mesh, sharpness: &Sharpness<'_>, h: HalfEdgeId) -> VertexSector {
    let topology = mesh.topology();
    let at = |v: VertexId| vector(mesh.positions()[v.index()]);
    let sector = sector_of(topology, sharpness, h);
    let neighbours: Neighbours = sector.neighbours(topology).map(at).collect();
    let slot = sector
        .outgoing(topology)
        .take_while(|&other| other != h)
        .count();
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
        let shape = RingShape {
            open,
            ..RingShape::interior(valence)
        };
        return Sector { first, shape };
    }
    let sectors = sharpness.sectors(vertex);
    let own = sectors
        .iter()
        .find(|sector| sector.outgoing(topology).any(|other| other == h));
    own.copied().unwrap_or(Sector {
        first: h,
        shape: RingShape::interior(valence),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use limitmesh_testing::models::stirred;

    /// The quick test agrees with the sectors of the corners, and misses no regular face without tags.
    #[test]
    fn regular_faces_are_those_whose_sectors_are() {
        let (mut regular_faces, mut others) = (0, 0);
        for name in [
            "tetrahedron",
            "icosphere",
            "torus",
            "sheet",
            "head",
            "cup",
            "shoe",
        ] {
            let mesh = stirred(name, 4);
            let (topology, sharpness) = (mesh.topology(), Sharpness::of(&mesh));
            let large = LargeRings::of(&mesh);
            for face in 0..mesh.face_count() as u32 {
                let corners = [0, 1, 2].map(|corner| HalfEdgeId::of(FaceId(face), corner));
                let found = regular(&mesh, &sharpness, corners);
                let is_edged = |v: VertexId| sharpness.is_tagged(v) || topology.is_boundary(v);
                if corners.iter().any(|&h| is_edged(topology.origin(h))) {
                    assert_eq!(found, None, "{name}, face {face}");
                    continue;
                }
                let expected = match patch_of(&mesh, &sharpness, &large, corners) {
                    Patch::Regular(points) => Some(points),
                    _ => None,
                };
                assert_eq!(found, expected, "{name}, face {face}");
                *(if found.is_some() {
                    &mut regular_faces
                } else {
                    &mut others
                }) += 1;
            }
        }
        assert!(
            regular_faces > 1000 && others > 100,
            "{regular_faces}, {others}"
        );
    }
}

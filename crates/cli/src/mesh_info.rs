//! Properties of a control mesh: components, boundary loops, genus, valences, extent, volume, sharp edges,
//! triangles.

use limitmesh::measure::watertightness;
use limitmesh::{Mesh, VertexId};

use crate::bulk::Bulk;
use crate::dihedral::Dihedrals;
use crate::report::information::BoundingBox;
use crate::report::{MeshInformation, QualityReport};

/// Examines a control mesh, with the input's faces that its own are from; none where these are not known.
pub(crate) fn examine(mesh: &Mesh, faces: &[u32]) -> MeshInformation {
    let surface = mesh.as_triangles();
    let tightness = watertightness(surface);
    let topology = mesh.topology();
    let boundary_loops = boundary_loops(mesh);
    let euler = topology.euler_characteristic();
    let valences = topology
        .vertices()
        .map(|v| topology.valence_and_openness(v).0);
    let (min_valence, max_valence) = valences.fold((u32::MAX, 0), |(low, high), valence| {
        (low.min(valence), high.max(valence))
    });
    let [low, high] = surface.bounding_box().unwrap_or_default();
    MeshInformation {
        vertices: mesh.vertex_count(),
        edges: topology.edge_count(),
        triangles: mesh.face_count(),
        components: tightness.components,
        // A manifold of c orientable components has χ = 2c − 2g − loops.
        genus: (2 * tightness.components as i64 - euler - boundary_loops as i64) / 2,
        euler_characteristic: euler,
        boundary_loops,
        boundary_edges: tightness.boundary_edges,
        watertight: tightness.is_watertight(),
        min_valence,
        max_valence,
        irregular_vertices: topology
            .vertices()
            .filter(|&v| !mesh.ring_shape(v).is_regular())
            .count(),
        bounding_box: BoundingBox {
            low,
            high,
            diagonal: surface.diagonal(),
        },
        bulk: Bulk::of(mesh),
        dihedrals: Dihedrals::of(mesh, faces),
        quality: QualityReport::of(mesh),
    }
}

/// Number of closed curves that the boundary consists of.
fn boundary_loops(mesh: &Mesh) -> usize {
    let topology = mesh.topology();
    let mut seen = vec![false; topology.vertex_count()];
    let mut loops = 0;
    for start in topology.vertices().filter(|&v| topology.is_boundary(v)) {
        if seen[start.index()] {
            continue;
        }
        loops += 1;
        let mut vertex: VertexId = start;
        // In a manifold each boundary vertex has one outgoing boundary half-edge, so the walk comes back.
        while !std::mem::replace(&mut seen[vertex.index()], true) {
            vertex = topology.target(topology.outgoing(vertex));
        }
    }
    loops
}

//! What kind of surface a control mesh is: components, boundary loops, genus, valences, extent, volume, sharp edges,
//! triangles.

use limitmesh::measure::{triangle_quality, watertightness};
use limitmesh::{Mesh, VertexId};

use crate::bulk::Bulk;
use crate::dihedral::Dihedrals;
use crate::report::MeshInformation;
use crate::report::information::BoundingBox;

/// Examines a control mesh, with the input's faces that its own are from; none where these are not known.
pub(crate) fn examine(mesh: &Mesh, faces: &[u32]) -> MeshInformation {
    let surface = mesh.as_triangles();
    let tightness = watertightness(surface);
    let quality = triangle_quality(surface);
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
        min_angle_degrees: quality.min_angle_degrees,
        mean_min_angle_degrees: quality.mean_min_angle_degrees,
        angle_histogram: quality.histogram,
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_ring_has_two_loops_and_no_genus() {
        // The border of a 3 × 3 grid of squares.
        let mut positions = Vec::new();
        for y in 0..4 {
            positions.extend((0..4).map(|x| [f64::from(x), f64::from(y), 0.0]));
        }
        let mut triangles = Vec::new();
        for (x, y) in (0..9u32)
            .map(|i| (i % 3, i / 3))
            .filter(|&cell| cell != (1, 1))
        {
            let a = 4 * y + x;
            triangles.extend([[a, a + 1, a + 5], [a, a + 5, a + 4]]);
        }
        let mesh = Mesh::from_triangles(positions, triangles).unwrap();
        let shape = examine(&mesh, &[]);
        assert_eq!(
            (
                shape.boundary_loops,
                shape.genus,
                shape.euler_characteristic
            ),
            (2, 0, 0)
        );
        assert_eq!((shape.vertices, shape.edges, shape.triangles), (16, 32, 16));
        assert_eq!(shape.bounding_box.high, [3.0, 3.0, 0.0]);
    }
}

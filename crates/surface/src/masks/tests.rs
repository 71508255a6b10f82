//! Points at vertices of very many edges, against the schemes' formulas and against masks that are not kept.

use core::f64::consts::TAU;

use super::*;
use crate::scheme::{Loop, ModifiedButterfly};

/// `count` triangles around vertex 0, from vertex 1 on; open: without the last of them.
fn fan(count: u32, open: bool) -> Mesh {
    let mut positions = vec![[0.0, 0.0, 1.0]];
    for i in 0..count {
        let (sine, cosine) = (TAU * f64::from(i) / f64::from(count)).sin_cos();
        positions.push([(1.0 + 0.1 * f64::from(i % 3)) * cosine, sine, 0.0]);
    }
    let last = count - u32::from(open);
    Mesh::from_triangles(
        positions,
        (0..last).map(|i| [0, 1 + i, 1 + (i + 1) % count]).collect(),
    )
    .unwrap()
}

#[test]
fn loop_points_beside_a_vertex_of_many_edges_follow_the_formulas() {
    for mesh in [fan(4000, false), fan(4000, true)] {
        let (topology, masks) = (mesh.topology(), Masks::new(&mesh, &Loop));
        for h in (0..topology.half_edge_count()).map(|h| HalfEdgeId(h as u32)) {
            let at = |v: VertexId| vector(mesh.positions()[v.index()]);
            let [a, b] = topology.ends(h).map(at);
            let expected = match topology.twin(h) {
                None => (a + b) / 2.0,
                Some(twin) => {
                    (a + b) * 0.375
                        + (at(topology.opposite(h)) + at(topology.opposite(twin))) * 0.125
                }
            };
            let point = masks.edge_point(h);
            assert!(
                point.distance(expected) < 1e-14,
                "{h}: {point}, expected {expected}"
            );
        }
    }
}

#[test]
fn kept_masks_and_those_on_demand_give_the_same_points() {
    // 2500 edges with 2503 weights each are more than are kept.
    for mesh in [
        fan(2500, true),
        fan(40, true),
        fan(40, false),
        fan(7, true),
        fan(3, true),
        fan(4, false),
    ] {
        let kept = Masks::new(&mesh, &ModifiedButterfly);
        let on_demand = Masks::on_demand(&mesh, &ModifiedButterfly);
        let edges = mesh.topology().half_edge_count();
        assert!(
            kept.edge_masks
                .iter()
                .map(|(_, mask)| mask.origin_ring.len())
                .sum::<usize>()
                <= MOST_WEIGHTS
        );
        for h in (0..edges)
            .step_by(1 + edges / 500)
            .map(|h| HalfEdgeId(h as u32))
        {
            assert_eq!(kept.edge_shape(h), mesh.edge_shape(h), "{h}");
            assert_eq!(kept.edge_point(h), on_demand.edge_point(h), "{h}");
        }
    }
}

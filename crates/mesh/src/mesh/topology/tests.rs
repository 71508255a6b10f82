//! Rings, twins and counts of known surfaces, and the errors that validation must find.

use proptest::prelude::*;

use super::*;

/// A hexagonal fan round vertex 0, counter-clockwise, and a further triangle.
fn fan() -> Vec<[u32; 3]> {
    vec![
        [3, 0, 2],
        [0, 1, 2],
        [0, 3, 4],
        [5, 0, 4],
        [6, 0, 5],
        [1, 0, 6],
        [2, 1, 7],
    ]
}

fn tetrahedron() -> Vec<[u32; 3]> {
    vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
}

/// A torus of `n` by `m` squares, each cut in two.
fn torus(n: u32, m: u32) -> Vec<[u32; 3]> {
    let at = |i: u32, j: u32| (i % n) * m + j % m;
    let square = |i: u32, j: u32| {
        [
            [at(i, j), at(i + 1, j), at(i + 1, j + 1)],
            [at(i, j), at(i + 1, j + 1), at(i, j + 1)],
        ]
    };
    (0..n)
        .flat_map(|i| (0..m).flat_map(move |j| square(i, j)))
        .collect()
}

fn ring(topology: &Topology, v: u32) -> Vec<u32> {
    topology.ring(VertexId(v)).map(|v| v.0).collect()
}

#[test]
fn interior_rings_run_counter_clockwise() {
    let topology = Topology::from_triangles(fan(), 8).unwrap();
    let mut around = ring(&topology, 0);
    let first = around.iter().position(|&v| v == 1).unwrap();
    around.rotate_left(first);
    assert_eq!(around, [1, 2, 3, 4, 5, 6]);
    assert!(!topology.is_boundary(VertexId(0)));
    assert_eq!(topology.valence_and_openness(VertexId(0)), (6, false));
    assert_eq!(topology.outgoing_ring(VertexId(0)).count(), 6);
}

#[test]
fn boundary_rings_run_from_one_boundary_neighbour_to_the_other() {
    let topology = Topology::from_triangles(fan(), 8).unwrap();
    assert_eq!(ring(&topology, 1), [7, 2, 0, 6]);
    assert_eq!(ring(&topology, 2), [3, 0, 1, 7]);
    assert_eq!(ring(&topology, 7), [2, 1]);
    assert_eq!(topology.valence_and_openness(VertexId(1)), (4, true));
    assert_eq!(topology.valence_and_openness(VertexId(7)), (2, true));
    assert_eq!(topology.twin(topology.outgoing(VertexId(1))), None);
}

#[test]
fn characteristics_of_known_surfaces() {
    let numbers = |triangles: Vec<[u32; 3]>, vertices| {
        let t = Topology::from_triangles(triangles, vertices).unwrap();
        t.validate().unwrap();
        (
            t.euler_characteristic(),
            t.edge_count(),
            t.boundary_edge_count(),
        )
    };
    assert_eq!(numbers(tetrahedron(), 4), (2, 6, 0));
    assert_eq!(numbers(fan(), 8), (1, 14, 7));
    assert_eq!(numbers(torus(4, 5), 20), (0, 60, 0));
    assert_eq!(numbers(vec![[0, 1, 2]], 3), (1, 3, 3));
}

#[test]
fn edges_are_found_from_both_ends() {
    let topology = Topology::from_triangles(fan(), 8).unwrap();
    let mut edges = 0;
    for a in topology.vertices() {
        for b in topology.vertices() {
            let expected = topology.ring(a).any(|v| v == b);
            match topology.edge_between(a, b) {
                Some(h) => {
                    let [from, to] = topology.ends(h);
                    assert!(expected && ((from, to) == (a, b) || (from, to) == (b, a)));
                    edges += 1;
                }
                None => assert!(!expected, "{a} {b}"),
            }
        }
    }
    assert_eq!(edges, 2 * topology.edge_count());
}

#[test]
fn what_is_no_manifold_is_named() {
    let error = |triangles: &[[u32; 3]], vertices| {
        Topology::from_triangles(triangles.to_vec(), vertices).unwrap_err()
    };
    assert_eq!(
        error(&[[0, 1, 3]], 3),
        MeshError::VertexOutOfRange {
            face: 0,
            vertex: 3,
            count: 3
        }
    );
    assert_eq!(
        error(&[[0, 1, 2], [1, 0, 1]], 3),
        MeshError::RepeatedCorner { face: 1, vertex: 1 }
    );
    assert_eq!(error(&[[0, 1, 2]], 4), MeshError::Isolated { vertex: 3 });
    assert_eq!(
        error(&[[0, 1, 2], [3, 0, 1]], 4),
        MeshError::EdgeUsedTwice {
            from: 0,
            to: 1,
            face: 1
        }
    );
    let mut two = tetrahedron();
    two.extend(
        tetrahedron()
            .iter()
            .map(|t| t.map(|v| if v == 0 { 0 } else { v + 3 })),
    );
    two.push([0, 7, 8]);
    assert_eq!(error(&two, 9), MeshError::BowTie { vertex: 0, fans: 3 });
}

/// Every single broken entry of the arrays must be noticed.
#[test]
fn validate_notices_broken_arrays() {
    for (triangles, vertices) in [(fan(), 8), (tetrahedron(), 4), (torus(3, 3), 9)] {
        let whole = Topology::from_triangles(triangles, vertices).unwrap();
        whole.validate().unwrap();
        let half_edges = whole.twins.len() as u32;
        for h in 0..whole.twins.len() {
            for twin in (0..half_edges + 2)
                .chain([NONE])
                .filter(|&twin| twin != whole.twins[h])
            {
                let mut broken = whole.clone();
                broken.twins[h] = twin;
                assert!(broken.validate().is_err(), "twin of {h} set to {twin}");
            }
        }
        for v in 0..vertices {
            for h in (0..half_edges + 2)
                .chain([NONE])
                .filter(|&h| h != whole.outgoing[v])
            {
                let mut broken = whole.clone();
                broken.outgoing[v] = h;
                let leaves = h < half_edges && broken.origin(HalfEdgeId(h)).index() == v;
                // Round an interior vertex any of its half-edges may come first.
                let allowed = leaves && !whole.is_boundary(VertexId(v as u32));
                assert_eq!(
                    broken.validate().is_ok(),
                    allowed,
                    "outgoing of {v} set to {h}"
                );
            }
        }
        let mut broken = whole.clone();
        broken.twins.pop();
        assert!(broken.validate().is_err());
        let mut broken = whole;
        broken.triangles[0].swap(0, 1);
        assert!(broken.validate().is_err());
    }
}

/// A slit whose lips run between the same two vertices cannot be distinguished from an uncut edge
/// by indices.
#[test]
fn validate_refuses_an_edge_torn_open() {
    let mut torn = Topology::from_triangles(tetrahedron(), 4).unwrap();
    let twin = torn.twins[0];
    torn.twins[0] = NONE;
    torn.twins[twin as usize] = NONE;
    torn.outgoing = outgoing_half_edges(&torn.triangles, &torn.twins, 4);
    assert!(torn.validate().is_err());
}

proptest! {
    /// Twins against a search through all pairs of half-edges.
    #[test]
    fn twins_are_those_of_a_search(n in 3u32..6, m in 3u32..6, left_out in prop::collection::vec(any::<bool>(), 50)) {
        let triangles: Vec<[u32; 3]> =
            torus(n, m).into_iter().zip(left_out.into_iter().chain(core::iter::repeat(false)))
                .filter(|(_, out)| !out).map(|(t, _)| t).collect();
        prop_assume!(!triangles.is_empty());
        let twins = match_twins(&triangles, (n * m) as usize).unwrap();
        let edges: Vec<[u32; 2]> = triangles
            .iter()
            .flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]])
            .collect();
        for (h, &[a, b]) in edges.iter().enumerate() {
            let expected = edges.iter().position(|&e| e == [b, a]).map_or(NONE, |g| g as u32);
            prop_assert_eq!(twins[h], expected);
        }
    }
}

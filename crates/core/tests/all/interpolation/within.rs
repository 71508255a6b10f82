//! Limits that may leave their vertices: how far they do, and how fair the control net is.

use limitmesh::interpolate::{
    InterpolateError, InterpolateOptions, interpolate as interpolate_within,
};
use limitmesh::limit::LimitTable;
use limitmesh::mesh::Tags;
use limitmesh::scheme::Loop;
use limitmesh::{Mesh, VertexId};

use crate::interpolation::{dense, dense_solution, from_limits, interpolate, loop_beta, tagged};
use crate::support::{Point, Random, corner, distance, lumpy, octahedron, sheet, torus};

/// The energy that the documentation names, on a mesh without tags.
fn thin_plate(mesh: &Mesh) -> f64 {
    let topology = mesh.topology();
    let of = |v: VertexId| {
        let ring: Vec<VertexId> = topology.ring(v).collect();
        let ends = if topology.is_boundary(v) {
            vec![ring[0], ring[ring.len() - 1]]
        } else {
            ring
        };
        let at = |v: VertexId| mesh.positions()[v.index()];
        (0..3)
            .map(|i| {
                (ends.iter().map(|&u| at(u)[i]).sum::<f64>() / ends.len() as f64 - at(v)[i]).powi(2)
            })
            .sum::<f64>()
    };
    topology.vertices().map(of).sum::<f64>() / 2.0
}

#[test]
fn limits_stay_within_and_the_net_gets_fairer() {
    for mesh in [
        octahedron(),
        lumpy(60, 6),
        sheet(7, 6, 2),
        tagged(lumpy(40, 2), 3, true),
        tagged(torus(9, 7), 1, false),
    ] {
        let size = mesh.diagonal();
        let through = interpolate(&mesh, &Loop).unwrap();
        let (mut energy, mut share) = (thin_plate(&through.mesh), 1.0);
        for within in [1e-4, 1e-3, 1e-2, 3e-2].map(|part| part * size) {
            let options = InterpolateOptions::default().within(within);
            let found = interpolate_within(&mesh, &Loop, &options).unwrap();
            let away = from_limits(&found, &Loop, &mesh);
            at_most!(away, within + 1e-12 * size);
            above!(away, 0.3 * within);
            assert!((away - found.residual).abs() < 1e-12 * size);
            let fairness = found.fairness.unwrap();
            assert!(fairness.least_energy <= fairness.energy && fairness.energy < share);
            above!(fairness.least_energy, 0.99 * fairness.energy);
            share = fairness.energy;
            if mesh.tags().is_empty() {
                let now = thin_plate(&found.mesh);
                assert!(now < energy, "{now} {energy}");
                energy = now;
            }
        }
    }
}

/// On a closed mesh the whole surface is one region: no feasible control mesh may be fairer than what is proven.
#[test]
fn no_other_net_is_fairer_than_proven() {
    let mesh = lumpy(25, 4);
    let within = 0.01 * mesh.diagonal();
    let matrix = dense(&mesh, loop_beta);
    let through = thin_plate(&interpolate(&mesh, &Loop).unwrap().mesh);
    let found =
        interpolate_within(&mesh, &Loop, &InterpolateOptions::default().within(within)).unwrap();
    let fairness = found.fairness.unwrap();
    assert!((thin_plate(&found.mesh) / through - fairness.energy).abs() < 1e-4);
    // Limits moved at random, and a little from those found, by projection into the balls.
    let limits = LimitTable::new(&Loop).positions(&found.mesh).unwrap();
    let mut random = Random::new(5);
    for try_ in 0..200 {
        let far = within * 0.5f64.powi(try_ % 12);
        let near: Vec<Point> = limits
            .iter()
            .zip(mesh.positions())
            .map(|(&limit, &v)| {
                let moved = limit.map(|x| x + far * random.signed());
                let away = distance(moved, v);
                let part = (within / away).min(1.0);
                [0, 1, 2].map(|i| v[i] + part * (moved[i] - v[i]))
            })
            .collect();
        let other = mesh.clone().with_positions(near).unwrap();
        let net = other
            .clone()
            .with_positions(dense_solution(&matrix, &other))
            .unwrap();
        assert!(thin_plate(&net) / through >= fairness.least_energy);
        assert!(
            thin_plate(&net) / through >= 0.998 * fairness.energy,
            "{try_}"
        );
    }
}

/// Where nothing holds it back, the fairest line is straight: a boundary between two corners, its limits within reach.
#[test]
fn lines_within_reach_of_straight_ones_get_straight() {
    let mut positions: Vec<Point> = (0..=10)
        .map(|i| [f64::from(i), 0.0, 0.05 * f64::from(i % 3) - 0.05])
        .collect();
    positions.extend((0..=10).map(|i| [f64::from(i), 3.0, 0.0]));
    let mut triangles = Vec::new();
    for i in 0..10 {
        triangles.extend([[i, i + 1, i + 12], [i, i + 12, i + 11]]);
    }
    positions[0][2] = 0.0;
    positions[10][2] = 0.0;
    let corners = [0, 10, 11, 21]
        .map(|vertex| corner(vertex, f64::INFINITY))
        .to_vec();
    let tags = Tags {
        corners,
        ..Tags::default()
    };
    let mesh = Mesh::from_triangles(positions, triangles)
        .unwrap()
        .with_tags(tags)
        .unwrap();
    let found =
        interpolate_within(&mesh, &Loop, &InterpolateOptions::default().within(0.06)).unwrap();
    let fairness = found.fairness.unwrap();
    assert!(fairness.energy < 1e-6, "{fairness:?}");
    assert!(found.mesh.positions().iter().all(|p| p[2].abs() < 1e-2));
    // Corners keep their place.
    for v in [0, 10, 11, 21] {
        assert_eq!(found.mesh.positions()[v], mesh.positions()[v]);
    }
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        let error = interpolate_within(&mesh, &Loop, &InterpolateOptions::default().within(bad))
            .unwrap_err();
        assert!(matches!(error, InterpolateError::Mesh(_)), "{error}");
    }
}

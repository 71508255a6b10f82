//! Goals for what meshes carry: against dense samples of the values and of the moved surfaces, found by uniform refinement.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::support::*;
use limitmesh::carry::{carried, goal};
use limitmesh::measure::Bvh;
use limitmesh::mesh::{Channel, Domain, Interpolation, Semantic};
use limitmesh::refine::{
    AttributeGoal, Exact, ExactOptions, ExactStop, Finish, Origin, Traced, UniformOptions, exact,
    exact_estimate, limit_reference, uniform,
};
use limitmesh::scheme::{Loop, ModifiedButterfly};
use limitmesh::{HalfEdgeId, Mesh};

/// Values at the corners of faces, with seams: every third face has a value of its own at its first corner.
fn channel(mesh: &Mesh, arity: usize, seed: u64) -> Channel {
    let mut random = Random::new(seed);
    let mut values: Vec<f64> = (0..arity * mesh.vertex_count())
        .map(|_| random.signed())
        .collect();
    let mut indices = mesh.triangles().as_flattened().to_vec();
    for face in (0..mesh.face_count()).step_by(3) {
        indices[3 * face] = (values.len() / arity) as u32;
        values.extend((0..arity).map(|_| random.signed()));
    }
    Channel::new(
        "values",
        Semantic::TextureCoordinates,
        Domain::Corner,
        arity,
    )
    .with(values, indices)
}

/// Where the corners of a mesh are in their own control faces.
fn corner_origins(control: &Mesh, found: &dyn Traced) -> Vec<Origin> {
    let corners = 0..3 * found.mesh().face_count() as u32;
    corners
        .map(|h| {
            found
                .corner_origin(control.triangles(), HalfEdgeId(h))
                .unwrap()
        })
        .collect()
}

/// The barycentric coordinates of a place in a triangle of places, all of one control face.
fn within(place: [f64; 3], triangle: [[f64; 3]; 3]) -> Option<[f64; 3]> {
    let [a, b, c] = triangle.map(|corner| [corner[1], corner[2]]);
    let cross = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
        (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
    };
    let p = [place[1], place[2]];
    let area = cross(a, b, c);
    let weights = [cross(p, b, c), cross(a, p, c), cross(a, b, p)].map(|own| own / area);
    weights
        .iter()
        .all(|&weight| weight >= -1e-12)
        .then_some(weights)
}

/// The greatest difference between a channel and what the triangles hold of it, at places of a uniform refinement.
fn sampled(control: &Mesh, channel: &Channel, found: &Exact, levels: usize) -> f64 {
    let options = UniformOptions::default()
        .levels(levels)
        .limit(true)
        .origins(true);
    let dense = uniform(control, &Loop, &options).unwrap();
    let [own, truth] = [found as &dyn Traced, &dense].map(|mesh| {
        carried(std::slice::from_ref(channel), control, &Loop, mesh)
            .unwrap()
            .remove(0)
    });
    let mut of_face: Vec<Vec<([f64; 3], usize)>> = vec![Vec::new(); control.face_count()];
    for (corner, origin) in corner_origins(control, &dense).into_iter().enumerate() {
        of_face[origin.face as usize].push((origin.barycentric, corner));
    }
    let mut greatest = 0.0f64;
    for (triangle, corners) in corner_origins(control, found)
        .as_chunks::<3>()
        .0
        .iter()
        .enumerate()
    {
        for &(place, dense_corner) in &of_face[corners[0].face as usize] {
            let Some(weights) = within(place, corners.map(|corner| corner.barycentric)) else {
                continue;
            };
            let held = |i: usize| -> f64 {
                (0..3)
                    .map(|corner| weights[corner] * own.value(3 * triangle + corner)[i])
                    .sum()
            };
            let squares = truth
                .value(dense_corner)
                .iter()
                .enumerate()
                .map(|(i, x)| (x - held(i)).powi(2));
            greatest = greatest.max(squares.sum::<f64>().sqrt());
        }
    }
    greatest
}

fn coarse(mesh: &Mesh) -> ExactOptions {
    ExactOptions::default()
        .tolerance(0.1 * mesh.diagonal())
        .flat_regions(false)
}

#[test]
fn values_are_within_their_tolerance() {
    for (name, mesh) in samples() {
        for (seed, arity, tolerance) in [(1, 2, 0.03), (2, 4, 0.1), (3, 1, 0.01)] {
            let channel = channel(&mesh, arity, seed);
            let plain = exact(&mesh, &Loop, &coarse(&mesh)).unwrap();
            let before = sampled(&mesh, &channel, &plain, 4);
            let goal = goal(&channel, &mesh, tolerance).unwrap().unwrap();
            let found = exact(&mesh, &Loop, &coarse(&mesh).attributes(vec![goal])).unwrap();
            let (bound, what) = (
                found.attribute_bounds[0],
                format!("{name}, {arity} numbers"),
            );
            assert_eq!(found.stop, ExactStop::Met, "{what}");
            at_most!(bound, tolerance, "{what}");
            let after = sampled(&mesh, &channel, &found, 5);
            at_most!(after, bound * (1.0 + 1e-9), "{what}");
            above!(before, 2.0 * tolerance, "{what}");
            // Bounds are no wild guesses, and no face is divided for nothing.
            above!(after, 0.2 * bound, "{what}");
            assert!(found.error.upper <= 0.1 * mesh.diagonal());
        }
    }
}

#[test]
fn linear_channels_and_names_ask_for_nothing() {
    let mesh = octahedron();
    let channel = channel(&mesh, 2, 5);
    for interpolation in [Interpolation::Linear, Interpolation::Nearest] {
        let channel = channel.clone().interpolated(interpolation);
        assert!(goal(&channel, &mesh, 1e-9).unwrap().is_none());
    }
}

/// The mesh with its vertices somewhere else, and triangles whose vertices move as they do.
fn moved(mesh: &Mesh, seed: u64) -> (Mesh, Channel) {
    let mut random = Random::new(seed);
    let size = 0.3 * mesh.diagonal();
    let positions: Vec<[f64; 3]> = mesh
        .positions()
        .iter()
        .map(|p| p.map(|x| x + size * random.signed()))
        .collect();
    let values = positions.as_flattened().to_vec();
    let channel = Channel::new("moved", Semantic::Displacement, Domain::Vertex, 3)
        .with(values, (0..mesh.vertex_count() as u32).collect());
    (mesh.clone().with_positions(positions).unwrap(), channel)
}

#[test]
fn moved_surfaces_are_within_their_tolerance() {
    for (name, mesh) in samples() {
        let (target, channel) = moved(&mesh, 3);
        let tolerance = 0.01 * mesh.diagonal();
        let goal = AttributeGoal::surface(target.clone(), tolerance);
        let found = exact(&mesh, &Loop, &coarse(&mesh).attributes(vec![goal])).unwrap();
        let bound = found.attribute_bounds[0];
        assert_eq!(found.stop, ExactStop::Met, "{name}");
        at_most!(bound, tolerance, "{name}");
        let dense = limit_reference(&target, &Loop, 5).unwrap();
        let distance_of = |found: &Exact| {
            let own = carried(std::slice::from_ref(&channel), &mesh, &Loop, found)
                .unwrap()
                .remove(0);
            let corners = found.mesh.triangles().as_flattened();
            let mut positions = vec![[0.0; 3]; found.mesh.vertex_count()];
            for (corner, &vertex) in corners.iter().enumerate() {
                positions[vertex as usize] = own.value(corner).try_into().unwrap();
            }
            let posed = found.mesh.clone().with_positions(positions).unwrap();
            let tree = Bvh::new(posed.as_triangles()).unwrap();
            let to = dense
                .positions()
                .iter()
                .map(|&p| tree.closest(p).distance)
                .fold(0.0, f64::max);
            let tree = Bvh::new(dense.as_triangles()).unwrap();
            let middles = posed.triangles().iter().map(|t| {
                let corners = t.map(|v| posed.positions()[v as usize]);
                [0, 1, 2].map(|i| (corners[0][i] + corners[1][i] + corners[2][i]) / 3.0)
            });
            middles.map(|p| tree.closest(p).distance).fold(to, f64::max)
        };
        let plain = exact(&mesh, &Loop, &coarse(&mesh)).unwrap();
        let (before, after) = (distance_of(&plain), distance_of(&found));
        // The dense mesh itself is a little off the surface.
        at_most!(after, 1.02 * bound, "{name}");
        above!(before, 2.0 * tolerance, "{name}");
    }
}

/// Where levels end first, the bound says how far it came; and it is true.
#[test]
fn goals_that_are_not_met_are_told() {
    let mesh = torus(5, 4);
    let channel = channel(&mesh, 2, 9);
    let goals = || vec![goal(&channel, &mesh, 1e-4).unwrap().unwrap()];
    let found = exact(
        &mesh,
        &Loop,
        &coarse(&mesh).attributes(goals()).max_levels(2),
    )
    .unwrap();
    assert_eq!(found.stop, ExactStop::LevelCap);
    let after = sampled(&mesh, &channel, &found, 5);
    above!(after, 1e-4);
    at_most!(after, found.attribute_bounds[0]);
    let found = exact(
        &mesh,
        &Loop,
        &coarse(&mesh).attributes(goals()).max_triangles(Some(400)),
    )
    .unwrap();
    assert_eq!(found.stop, ExactStop::TriangleCap);
    assert!(found.mesh.face_count() <= 400);
    assert!(sampled(&mesh, &channel, &found, 4) <= found.attribute_bounds[0]);
}

/// Schemes without proofs have estimates, which samples between do not exceed by much.
#[test]
fn other_schemes_have_estimates() {
    let mesh = octahedron();
    let (target, _) = moved(&mesh, 4);
    let tolerance = 0.02 * mesh.diagonal();
    let values = AttributeGoal::values(vec![target.clone()], tolerance);
    let goals = vec![values, AttributeGoal::surface(target, tolerance)];
    let found = exact(&mesh, &ModifiedButterfly, &coarse(&mesh).attributes(goals)).unwrap();
    assert!(
        found
            .attribute_bounds
            .iter()
            .all(|&bound| bound <= tolerance),
        "{:?}",
        found.attribute_bounds
    );
    assert!(!found.error.certified && found.stop == ExactStop::Met);
}

#[test]
fn estimates_count_what_goals_ask_for() {
    let mesh = torus(5, 4);
    let goal = goal(&channel(&mesh, 2, 9), &mesh, 0.01).unwrap().unwrap();
    let options = coarse(&mesh).attributes(vec![goal]);
    let (found, told) = (
        exact(&mesh, &Loop, &options).unwrap(),
        exact_estimate(&mesh, &Loop, &options).unwrap(),
    );
    let ratio = told.triangles as f64 / found.mesh.face_count() as f64;
    assert!((0.7..1.1).contains(&ratio), "{ratio}");
}

#[test]
fn goals_that_make_no_sense_are_refused() {
    let mesh = octahedron();
    let other = torus(5, 4);
    let refused = |options: ExactOptions, words: &str| {
        let error = exact(&mesh, &Loop, &options).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    };
    let values =
        |mesh: &Mesh, tolerance| vec![AttributeGoal::values(vec![mesh.clone()], tolerance)];
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        refused(
            coarse(&mesh).attributes(values(&mesh, tolerance)),
            "tolerance of an attribute",
        );
    }
    refused(coarse(&mesh).attributes(values(&other, 1.0)), "but is 40");
    for options in [
        coarse(&mesh).triangles(100),
        coarse(&mesh).finish(Finish::Balanced),
        coarse(&mesh).finish(Finish::Collapsed),
    ] {
        refused(
            options.attributes(values(&mesh, 1.0)),
            "0 with a number of triangles",
        );
    }
}

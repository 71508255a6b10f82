//! Flat regions of meshes with channels: values that are the same everywhere change nothing, and faces bound regions where their
//! values differ.

use std::f64::consts::TAU;

use limitmesh::Mesh;
use limitmesh::carry::{borders, carried};
use limitmesh::mesh::{Channel, Domain, Semantic};
use limitmesh::refine::Exact;
use limitmesh::scheme::Loop;

use crate::support::{creased, cross, dot, exact, within};

const FACETS: u32 = 24;
const TOLERANCE: f64 = 1e-4;

/// A drum whose ends are fans of triangles around their middles.
fn drum() -> Mesh {
    let ring = |z: f64| {
        (0..FACETS).map(move |i| {
            let (s, c) = (TAU * f64::from(i) / f64::from(FACETS)).sin_cos();
            [c, s, z]
        })
    };
    let positions: Vec<[f64; 3]> = ring(0.0)
        .chain(ring(1.0))
        .chain([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
        .collect();
    let (bottom, top) = (2 * FACETS, 2 * FACETS + 1);
    let faces = (0..FACETS).flat_map(|i| {
        let next = (i + 1) % FACETS;
        let (up, next_up) = (FACETS + i, FACETS + next);
        [
            [i, next, next_up],
            [i, next_up, up],
            [next, i, bottom],
            [up, next_up, top],
        ]
    });
    creased(positions, faces.collect())
}

/// A value of its own for each element, as files have them.
fn channel(domain: Domain, values: Vec<f64>) -> Channel {
    let indices = (0..values.len() as u32).collect();
    Channel::new("stl", Semantic::Label, domain, 1).with(values, indices)
}

fn refined(mesh: &Mesh, channels: &[Channel]) -> Exact {
    let options = within(TOLERANCE).kept_edges(borders(channels, mesh));
    exact(mesh, &Loop, &options).unwrap()
}

#[test]
fn channels_that_are_the_same_everywhere_change_nothing() {
    let mesh = drum();
    let plain = refined(&mesh, &[]);
    let divided = exact(&mesh, &Loop, &within(TOLERANCE).flat_regions(false)).unwrap();
    assert!(divided.mesh.face_count() > 2 * plain.mesh.face_count());
    for (domain, count) in [
        (Domain::Face, mesh.face_count()),
        (Domain::Vertex, mesh.vertex_count()),
        (Domain::Corner, 3 * mesh.face_count()),
    ] {
        let own = channel(domain, vec![7.0; count]);
        let found = refined(&mesh, std::slice::from_ref(&own));
        assert_eq!(found.mesh.triangles(), plain.mesh.triangles());
        let told = carried(&[own], &mesh, &Loop, &found).unwrap();
        let elements = if domain == Domain::Face { 1 } else { 3 } * found.mesh.face_count();
        assert_eq!(told[0].indices.len(), elements);
        assert!((0..elements).all(|element| told[0].value(element) == [7.0]));
    }
}

/// The face of the control mesh's ends over which a point lies: the sides of the fans lead along planes of symmetry, so that
/// the surface over each is in its own sector.
fn located(mesh: &Mesh, point: [f64; 3], normal: [f64; 3]) -> usize {
    let surface = mesh.as_triangles();
    let faces = (0..mesh.face_count()).filter(|&face| {
        let corners = surface.corners(face);
        let is_level = corners
            .iter()
            .all(|corner| (corner[2] - point[2]).abs() < 1e-9);
        is_level
            && (0..3).all(|i| {
                let [from, to] = [corners[i], corners[(i + 1) % 3]];
                let (along, away) = (
                    [0, 1, 2].map(|i| to[i] - from[i]),
                    [0, 1, 2].map(|i| point[i] - from[i]),
                );
                dot(cross(along, away), normal) > -1e-12
            })
    });
    let found: Vec<usize> = faces.collect();
    assert_eq!(found.len(), 1, "{point:?}: {found:?}");
    found[0]
}

/// One half of the ends and the other; each second sector; a sector alone.
#[test]
fn faces_bound_regions_where_their_values_differ() {
    let mesh = drum();
    let plain = refined(&mesh, &[]).mesh.face_count();
    let divided = exact(&mesh, &Loop, &within(TOLERANCE).flat_regions(false))
        .unwrap()
        .mesh
        .face_count();
    let sector = |face: usize| face as u32 / 4;
    let values: [&dyn Fn(usize) -> u32; 3] = [
        &|face| u32::from(sector(face) < FACETS / 2),
        &|face| sector(face) % 2,
        &|face| u32::from(sector(face) == 5),
    ];
    for value in values {
        let own = channel(
            Domain::Face,
            (0..mesh.face_count())
                .map(|face| f64::from(value(face)))
                .collect(),
        );
        let found = refined(&mesh, std::slice::from_ref(&own));
        found.mesh.validate().unwrap();
        assert!(found.error.upper <= TOLERANCE && found.error.certified);
        let count = found.mesh.face_count();
        at_most!(plain, count);
        below!(2 * count, divided);
        let told = carried(&[own], &mesh, &Loop, &found).unwrap();
        let surface = found.mesh.as_triangles();
        let mut met = 0;
        for face in 0..count {
            let corners = surface.corners(face);
            let normal = cross(
                [0, 1, 2].map(|i| corners[1][i] - corners[0][i]),
                [0, 1, 2].map(|i| corners[2][i] - corners[0][i]),
            );
            if normal[2].abs() < 0.999 * dot(normal, normal).sqrt() {
                continue;
            }
            met += 1;
            assert!(
                corners
                    .iter()
                    .all(|corner| (corner[2] - corners[0][2]).abs() < 1e-12)
            );
            // Near to each corner, and to the middle.
            let middle =
                [0, 1, 2].map(|i| corners.iter().map(|corner| corner[i]).sum::<f64>() / 3.0);
            for corner in corners.iter().chain([&middle]) {
                let point = [0, 1, 2].map(|i| 0.999 * corner[i] + 0.001 * middle[i]);
                let own = located(&mesh, point, [0.0, 0.0, normal[2].signum()]);
                assert_eq!(
                    told[0].value(face),
                    [f64::from(value(own))],
                    "triangle {face} near {point:?}"
                );
            }
        }
        assert!(met > 2 * FACETS as usize, "{met}");
    }
}

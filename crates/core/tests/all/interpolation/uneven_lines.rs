//! Lines whose edges are of very different lengths: extruded profiles, against themselves.

use std::f64::consts::TAU;

use limitmesh::Mesh;
use limitmesh::measure::CertifiedOptions;
use limitmesh::scheme::Loop;

use super::interpolate;
use crate::support::{creased, enclosed, exact, within};

/// A convex profile extruded, its ends fans around vertices in their middle.
fn extruded(profile: &[[f64; 2]], height: f64) -> Mesh {
    let middle = [0, 1].map(|i| profile.iter().map(|p| p[i]).sum::<f64>() / profile.len() as f64);
    extruded_around(profile, middle, height)
}

/// An extrusion with fans around vertices elsewhere.
fn extruded_around(profile: &[[f64; 2]], middle: [f64; 2], height: f64) -> Mesh {
    let n = profile.len() as u32;
    let at = |z: f64| profile.iter().map(move |&[x, y]| [x, y, z]);
    let centres = [0.0, height].map(|z| [middle[0], middle[1], z]);
    let positions = at(0.0).chain(at(height)).chain(centres).collect();
    let mut triangles = Vec::new();
    for i in 0..n {
        let next = (i + 1) % n;
        triangles.extend([[i, next, n + next], [i, n + next, n + i]]);
        triangles.extend([[2 * n, next, i], [2 * n + 1, n + i, n + next]]);
    }
    creased(positions, triangles)
}

/// The least and greatest distance from the mesh of the surface through the vertices, and the
/// number of relaxed vertices.
fn apart(mesh: &Mesh) -> ([f64; 2], usize) {
    let found = interpolate(mesh, &Loop).unwrap();
    below!(found.residual, 1e-12 * mesh.diagonal());
    let options = within(1e-5 * mesh.diagonal()).unfold(true);
    let smooth = exact(&found.mesh, &Loop, &options).unwrap();
    assert_eq!(smooth.inverted_triangles(), 0);
    let options = CertifiedOptions::default();
    let apart = enclosed(&smooth.mesh, mesh, &options);
    ([apart.lower(), apart.upper()], found.relaxed.len())
}

#[test]
fn a_vertex_near_the_end_of_a_straight_edge_does_no_harm() {
    let (box_apart, relaxed) = apart(&extruded(
        &[
            [0.0, 0.0],
            [5.0, 0.0],
            [60.0, 0.0],
            [60.0, 40.0],
            [0.0, 40.0],
        ],
        5.0,
    ));
    assert!(box_apart[1] < 1e-7, "{box_apart:?}");
    assert_eq!(relaxed, 2);
}

/// A rectangle with rounded corners: the surface is as near to the polygon of its chords as the arcs are, about.
#[test]
fn rounded_corners_between_long_edges_keep_their_shape() {
    for segments in [2, 6, 24] {
        let mut profile = Vec::new();
        for (corner, [x, y]) in [[30.0, 15.0], [-30.0, 15.0], [-30.0, -15.0], [30.0, -15.0]]
            .iter()
            .enumerate()
        {
            for i in 0..=segments {
                let (s, c) =
                    (TAU * (corner as f64 + f64::from(i) / f64::from(segments)) / 4.0).sin_cos();
                profile.push([x + 5.0 * c, y + 5.0 * s]);
            }
        }
        let mesh = extruded(&profile, 8.0);
        let (found, relaxed) = apart(&mesh);
        let sagitta = 5.0 * (1.0 - (TAU / f64::from(8 * segments)).cos());
        below!(found[1], 3.0 * sagitta, "{segments}");
        assert_eq!(relaxed, 16, "{segments}");
    }
}

/// Evenly spaced lines are led through all their vertices.
#[test]
fn edges_up_to_three_times_as_long_count_as_they_are() {
    let profile = [
        [0.0, 0.0],
        [10.0, 0.0],
        [40.0, 0.0],
        [40.0, 30.0],
        [0.0, 30.0],
    ];
    assert_eq!(apart(&extruded(&profile, 20.0)).1, 0);
    let circle: Vec<[f64; 2]> = (0..24)
        .map(|i| (TAU * f64::from(i) / 24.0).sin_cos())
        .map(|(s, c)| [c, s])
        .collect();
    assert_eq!(apart(&extruded(&circle, 1.0)).1, 0);
}

/// Led through a vertex near the corner of a flat face, its control point lay beyond that corner.
#[test]
fn a_vertex_near_the_corner_of_a_flat_face_stays() {
    let mesh = extruded_around(
        &[[0.0, 0.0], [60.0, 0.0], [60.0, 40.0], [0.0, 40.0]],
        [57.0, 37.0],
        30.0,
    );
    let (box_apart, relaxed) = apart(&mesh);
    assert!(box_apart[1] < 1e-7 && relaxed == 0, "{box_apart:?}");
    // Where the sides are smooth it is led through.
    let smooth = mesh.with_tags(Default::default()).unwrap();
    let found = interpolate(&smooth, &Loop).unwrap();
    assert!(super::from_limits(&found, &Loop, &smooth) < 1e-12 * smooth.diagonal());
}

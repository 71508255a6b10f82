//! Channels, normals and control faces of meshes whose edges were collapsed: on both sides of seams, borders and creases.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::f64::consts::TAU;

use crate::support::*;
use limitmesh::carry::{borders, carried};
use limitmesh::mesh::{Channel, Domain, Interpolation, Semantic};
use limitmesh::refine::{Exact, Finish};

use crate::support::exact;
use limitmesh::scheme::Loop;
use limitmesh::{FaceId, HalfEdgeId, Mesh};

/// Squares around and across a torus.
const AROUND: u32 = 24;
const ACROSS: u32 = 12;

/// Texture coordinates by the squares of a torus, from 0 to 1 both ways: cut open along two circles.
fn unrolled(mesh: &Mesh) -> Channel {
    let mut values = Vec::new();
    let mut indices = Vec::new();
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(|v| [v / ACROSS, v % ACROSS]);
        // Corners on the far side of the last squares are at 1.
        let far = |own: u32, others: [u32; 3], count: u32| {
            let wraps = others.iter().any(|&x| x == count - 1) && own == 0;
            f64::from(if wraps { count } else { own }) / f64::from(count)
        };
        for own in [a, b, c] {
            let value = [
                far(own[0], [a[0], b[0], c[0]], AROUND),
                far(own[1], [a[1], b[1], c[1]], ACROSS),
            ];
            let known = values
                .iter()
                .position(|&known| known == value)
                .unwrap_or_else(|| {
                    values.push(value);
                    values.len() - 1
                });
            indices.push(known as u32);
        }
    }
    Channel::new("unrolled", Semantic::TextureCoordinates, Domain::Corner, 2)
        .with(values.concat(), indices)
        .interpolated(Interpolation::Linear)
}

fn collapsed(mesh: &Mesh, channels: &[Channel], tolerance: f64) -> Exact {
    // Where the surface is flat, or straight in one direction, refinement alone would leave nothing to collapse.
    let plain = within(tolerance).flat_regions(false);
    let options = plain
        .clone()
        .finish(Finish::Collapsed)
        .kept_edges(borders(channels, mesh));
    let found = exact(mesh, &Loop, &options).unwrap();
    assert!(found.is_collapsed());
    let plain = exact(mesh, &Loop, &plain).unwrap();
    assert!(found.mesh.face_count() < plain.mesh.face_count());
    found
}

/// Where the limit of the vertex of a square would be if it were between its neighbours: the torus is the same all around.
#[test]
fn seams_stay_where_they_were() {
    let mesh = torus(AROUND, ACROSS);
    let channel = unrolled(&mesh);
    let fine = collapsed(&mesh, std::slice::from_ref(&channel), 2e-3);
    let carried = &carried(&[channel], &mesh, &Loop, &fine).unwrap()[0];
    let mut wraps = 0;
    for (face, triangle) in fine.mesh.triangles().iter().enumerate() {
        let at = [0, 1, 2].map(|corner| carried.value(3 * face + corner));
        for axis in 0..2 {
            let [a, b, c] = at.map(|value| value[axis]);
            let width = a.max(b).max(c) - a.min(b).min(c);
            assert!(width < 0.5, "triangle {face} reaches over a seam: {at:?}");
        }
        for (corner, &v) in triangle.iter().enumerate() {
            let [x, y, _] = fine.mesh.positions()[v as usize];
            let turn = (y.atan2(x) / TAU).rem_euclid(1.0);
            let off = (at[corner][0] - turn).rem_euclid(1.0);
            assert!(
                off.min(1.0 - off) < 0.3 / f64::from(AROUND),
                "{:?} at {turn}",
                at[corner]
            );
            wraps += usize::from(at[corner][0] == 1.0);
        }
    }
    assert!(wraps > 0, "one side of the seam has 1");
}

/// A smooth channel whose values are the positions has the vertices' positions, whichever control faces triangles reach over.
#[test]
fn smooth_values_are_exact_at_corners() {
    let mesh = lumpy(1, 5);
    let indices = mesh.triangles().as_flattened().to_vec();
    let places = Channel::new("places", Semantic::Displacement, Domain::Corner, 3)
        .with(mesh.positions().as_flattened().to_vec(), indices);
    let halves = (0..mesh.face_count())
        .map(|face| (face % 2) as u32)
        .collect();
    let label =
        Channel::new("label", Semantic::Label, Domain::Face, 1).with(vec![0.0, 1.0], halves);
    let fine = collapsed(&mesh, std::slice::from_ref(&places), 1e-3 * mesh.diagonal());
    let carried = carried(&[places, label], &mesh, &Loop, &fine).unwrap();
    for (corner, &v) in fine.mesh.triangles().as_flattened().iter().enumerate() {
        let value = carried[0].value(corner).try_into().unwrap();
        assert!(distance(value, fine.mesh.positions()[v as usize]) < 1e-9);
    }
}

/// The areas of materials are those that they had before edges were collapsed.
#[test]
fn borders_of_materials_stay() {
    let mesh = torus(AROUND, ACROSS);
    let of = |face: usize| {
        mesh.triangles()[face]
            .iter()
            .all(|v| (3..9).contains(&(v / ACROSS)))
    };
    let label = Channel::new("materials", Semantic::Label, Domain::Face, 1).with(
        vec![0.0, 1.0],
        (0..mesh.face_count())
            .map(|face| u32::from(of(face)))
            .collect(),
    );
    let coarse = collapsed(&mesh, std::slice::from_ref(&label), 1e-3);
    let fine = exact(&mesh, &Loop, &within(1e-4)).unwrap();
    let area = |found: &Exact| {
        let carried = &carried(std::slice::from_ref(&label), &mesh, &Loop, found).unwrap()[0];
        let own = (0..found.mesh.face_count()).filter(|&face| carried.value(face) == [1.0]);
        own.map(|face| {
            let [a, b, c] = found.mesh.as_triangles().corners(face);
            let (u, v) = (
                [0, 1, 2].map(|i| b[i] - a[i]),
                [0, 1, 2].map(|i| c[i] - a[i]),
            );
            let cross = [0, 1, 2]
                .map(|i| u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3]);
            0.5 * cross.iter().map(|x| x * x).sum::<f64>().sqrt()
        })
        .sum::<f64>()
    };
    let [one, other] = [&coarse, &fine].map(area);
    above!(other, 0.1, "{one}");
    below!((one / other - 1.0).abs(), 5e-3, "{one}");
}

/// A prism with sharp edges around its flat ends: their corners there have the ends' normals, and the sides' corners look outwards.
#[test]
fn normals_are_those_of_their_side_of_a_crease() {
    const SIDES: u32 = 16;
    let rim = |z: f64| {
        (0..SIDES).map(move |i| {
            let turn = TAU * f64::from(i) / f64::from(SIDES);
            [turn.cos(), turn.sin(), z]
        })
    };
    let positions = rim(-1.0)
        .chain(rim(1.0))
        .chain([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]])
        .collect();
    let triangles = (0..SIDES).flat_map(|i| {
        let j = (i + 1) % SIDES;
        let (a, b, c, d) = (i, j, SIDES + j, SIDES + i);
        [
            [a, b, c],
            [a, c, d],
            [2 * SIDES, b, a],
            [2 * SIDES + 1, d, c],
        ]
    });
    let mesh = Mesh::from_triangles(positions, triangles.collect()).unwrap();
    let mesh = mesh.with_creases_above(60f64.to_radians()).unwrap();
    let fine = collapsed(&mesh, &[], 2e-3);
    let mut counts = [0; 2];
    for face in 0..fine.mesh.face_count() {
        let corners = fine.mesh.as_triangles().corners(face);
        let is_end = corners
            .iter()
            .all(|corner| (corner[2] - corners[0][2]).abs() < 1e-9);
        counts[usize::from(is_end)] += 1;
        for (corner, [x, y, z]) in corners.into_iter().enumerate() {
            let normal = fine.corner_normal(HalfEdgeId::of(FaceId(face as u32), corner));
            let expected = if is_end {
                [0.0, 0.0, z.signum()]
            } else {
                [x, y, 0.0].map(|c| c / x.hypot(y))
            };
            let cosine: f64 = (0..3).map(|i| normal[i] * expected[i]).sum();
            assert!(
                cosine > 0.999,
                "{normal:?} at {x} {y} {z}, expected {expected:?}"
            );
        }
    }
    assert!(counts[0] > 20 && counts[1] > 20, "{counts:?}");
    assert_eq!(fine.inverted_triangles(), 0);
}

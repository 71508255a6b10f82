//! Meshes within a distance of the mesh that was given: witnesses are dense samples with distances to triangles by brute force, the volume by
//! the divergence theorem, and the analytic ball that voxels were made of.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::collections::HashMap;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use crate::support::*;
use limitmesh::progress::Progress;
use limitmesh::refine::{RefineError, Within, WithinOptions, within, within_observed};
use limitmesh::scheme::{Loop, ModifiedButterfly};
use limitmesh::{Mesh, PolygonSoup, Triangles};

/// The outer faces of the voxels of size 1 around the whole-numbered points for which `is_inside` holds, within `n` of the origin.
fn voxels(n: i32, is_inside: impl Fn([i32; 3]) -> bool) -> Mesh {
    let mut soup = PolygonSoup::default();
    let mut numbers: HashMap<[i32; 3], u32> = HashMap::new();
    let range = || -n..=n;
    for point in range().flat_map(|x| range().flat_map(move |y| range().map(move |z| [x, y, z]))) {
        for axis in 0..3 {
            for side in [-1, 1] {
                let mut beyond = point;
                beyond[axis] += side;
                if !is_inside(point) || is_inside(beyond) {
                    continue;
                }
                let corner = |[u, v]: [i32; 2]| {
                    let mut twice = point.map(|x| 2 * x);
                    twice[axis] += side;
                    twice[(axis + 1) % 3] += u;
                    twice[(axis + 2) % 3] += v * side;
                    twice
                };
                let corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(corner);
                let face = corners.map(|twice| {
                    *numbers.entry(twice).or_insert_with(|| {
                        soup.positions.push(twice.map(|x| 0.5 * f64::from(x)));
                        soup.positions.len() as u32 - 1
                    })
                });
                soup.faces.push(&face);
            }
        }
    }
    Mesh::from_soup(&soup, &Default::default()).unwrap().0
}

fn ball(radius: i32) -> Mesh {
    voxels(radius + 1, |[x, y, z]| {
        x * x + y * y + z * z <= radius * radius
    })
}

/// A bent tube of the radius 3 around a part of a circle of the radius 14; open where its ends are left out.
fn tube() -> Mesh {
    voxels(18, |[x, y, z]| {
        let off = f64::from(x).hypot(f64::from(y)) - 14.0;
        off * off + f64::from(z * z) <= 9.0 && x >= 0 && y >= -4
    })
}

fn asked(mesh: &Mesh, length: f64) -> Within {
    within(mesh, &Loop, &WithinOptions::default().within(length)).unwrap()
}

/// The closest distance of a point from a triangle (Ericson 2005, section 5.1.5).
fn distance_to_triangle(p: Point, [a, b, c]: [Point; 3]) -> f64 {
    let (ab, ac, ap) = (minus(b, a), minus(c, a), minus(p, a));
    let at = |v: f64, w: f64| [0, 1, 2].map(|i| a[i] + v * ab[i] + w * ac[i]);
    let (d1, d2) = (dot(ab, ap), dot(ac, ap));
    let (bp, cp) = (minus(p, b), minus(p, c));
    let (d3, d4, d5, d6) = (dot(ab, bp), dot(ac, bp), dot(ab, cp), dot(ac, cp));
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    let closest = if d1 <= 0.0 && d2 <= 0.0 {
        a
    } else if d3 >= 0.0 && d4 <= d3 {
        b
    } else if d6 >= 0.0 && d5 <= d6 {
        c
    } else if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        at(d1 / (d1 - d3), 0.0)
    } else if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        at(0.0, d2 / (d2 - d6))
    } else if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        at(1.0 - w, w)
    } else {
        let sum = va + vb + vc;
        at(vb / sum, vc / sum)
    };
    let off = minus(p, closest);
    dot(off, off).sqrt()
}

/// Points on all triangles of a surface, on a grid of so many steps on each.
fn points(surface: Triangles<'_>, steps: usize) -> Vec<Point> {
    let weights = (0..=steps).flat_map(|i| (0..=steps - i).map(move |j| [i, j, steps - i - j]));
    let weights: Vec<[f64; 3]> = weights
        .map(|w| w.map(|w| w as f64 / steps as f64))
        .collect();
    let on = |face: usize| {
        let corners = surface.corners(face);
        let at = |w: [f64; 3]| [0, 1, 2].map(|axis| (0..3).map(|c| w[c] * corners[c][axis]).sum());
        weights.iter().map(|&w| at(w)).collect::<Vec<Point>>()
    };
    (0..surface.triangles.len()).flat_map(on).collect()
}

/// The greatest distance of some points from a surface, where it is at most `most`; else infinite. Triangles are looked up in cells of that size.
fn greatest_distance(points: &[Point], surface: Triangles<'_>, most: f64) -> f64 {
    let size = most.max(0.02 * surface.diagonal());
    let cell = |p: Point| p.map(|x| (x / size).floor() as i64);
    let mut cells: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    for face in 0..surface.triangles.len() {
        let corners = surface.corners(face);
        let end =
            |by: f64, pick: fn(f64, f64) -> f64| {
                cell([0, 1, 2].map(|axis| {
                    pick(pick(corners[0][axis], corners[1][axis]), corners[2][axis]) + by
                }))
            };
        let (low, high) = (end(-most, f64::min), end(most, f64::max));
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    cells.entry([x, y, z]).or_default().push(face);
                }
            }
        }
    }
    let distance = |&p: &Point| {
        let near = cells.get(&cell(p)).into_iter().flatten();
        near.map(|&face| distance_to_triangle(p, surface.corners(face)))
            .fold(f64::INFINITY, f64::min)
    };
    points.iter().map(distance).fold(0.0, f64::max)
}

/// Both ways, on dense samples.
fn check_distance(mesh: &Mesh, found: &Within, most: f64) {
    let (input, output) = (mesh.as_triangles(), found.refined.mesh.as_triangles());
    let there = greatest_distance(&points(output, 3), input, most);
    let back = greatest_distance(&points(input, 16), output, most);
    at_most!(there, most);
    at_most!(back, most);
    // The reported lower bound is no more than the sampled distance, up to the distances between
    // samples.
    let sampled = there.max(back);
    at_most!(found.distance.lower, sampled * 1.02 + 1e-9);
    at_most!(sampled, found.distance.upper + 1e-9);
}

/// By the divergence theorem.
fn volume(mesh: &Mesh) -> f64 {
    let surface = mesh.as_triangles();
    let of = |[a, b, c]: [Point; 3]| dot(a, cross(b, c)) / 6.0;
    (0..surface.triangles.len())
        .map(|face| of(surface.corners(face)))
        .sum()
}

fn is_inverted_nowhere(found: &Within) {
    assert_eq!(found.inverted, 0);
    assert_eq!(found.refined.inverted_triangles(), 0);
}

/// Mean and standard deviation.
fn spread(numbers: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let count = numbers.clone().count() as f64;
    let mean = numbers.clone().sum::<f64>() / count;
    (
        mean,
        (numbers.map(|x| (x - mean).powi(2)).sum::<f64>() / count).sqrt(),
    )
}

fn length(p: Point) -> f64 {
    dot(p, p).sqrt()
}

#[test]
fn a_ball_of_voxels_becomes_round() {
    let mesh = ball(10);
    assert!((volume(&mesh) - 4169.0).abs() < 1e-9);
    let found = asked(&mesh, 0.87);
    assert!(found.is_kept(), "{:?}", found.distance);
    let radii = found.refined.mesh.positions().iter().map(|&p| length(p));
    let (mean, deviation) = spread(radii.clone());
    assert!(deviation <= 0.07, "{deviation}");
    let of_volume = (4169.0 * 3.0 / (4.0 * std::f64::consts::PI)).cbrt();
    assert!(
        (mean - of_volume).abs() < 0.05,
        "{mean}, {of_volume} by the volume"
    );
    assert!((volume(&found.refined.mesh) / 4169.0 - 1.0).abs() < 0.01);
    check_distance(&mesh, &found, 0.87);
    is_inverted_nowhere(&found);
    // The plain limit surface keeps the steps.
    let plain = limitmesh::refine::exact(&mesh, &Loop, &crate::support::within(0.02));
    let (_, of_plain) = spread(plain.unwrap().mesh.positions().iter().map(|&p| length(p)));
    assert!(of_plain > 0.19, "{of_plain}");
}

#[test]
fn a_vessel_of_voxels_keeps_its_volume() {
    let mesh = tube();
    for length in [0.6, 0.87, 2.0] {
        let found = asked(&mesh, length);
        assert!(found.is_kept(), "{length}: {:?}", found.distance);
        check_distance(&mesh, &found, length);
        let kept = volume(&found.refined.mesh) / volume(&mesh);
        assert!((kept - 1.0).abs() < 0.01, "{length}: {kept}");
        is_inverted_nowhere(&found);
    }
}

#[test]
fn open_surfaces_stay_near_with_their_boundaries() {
    let mesh = sheet(12, 15, 5);
    for length in [0.05, 0.3] {
        let found = asked(&mesh, length);
        assert!(found.is_kept(), "{length}: {:?}", found.distance);
        check_distance(&mesh, &found, length);
    }
}

#[test]
fn each_component_keeps_its_own_volume() {
    // Two balls, one of them far away and inside out: with normals inwards its volume is negative.
    let (near, far) = (ball(5), ball(3));
    let count = near.vertex_count() as u32;
    let positions = near
        .positions()
        .iter()
        .copied()
        .chain(far.positions().iter().map(|p| [p[0] + 30.0, p[1], p[2]]));
    let turned = far
        .triangles()
        .iter()
        .map(|&[a, b, c]| [a + count, c + count, b + count]);
    let mesh = Mesh::from_triangles(
        positions.collect(),
        near.triangles().iter().copied().chain(turned).collect(),
    );
    let mesh = mesh.unwrap();
    let found = asked(&mesh, 0.8);
    assert!(found.is_kept());
    check_distance(&mesh, &found, 0.8);
    let of_part = |is_far: bool| {
        let surface = found.refined.mesh.as_triangles();
        let faces = (0..surface.triangles.len()).map(|face| surface.corners(face));
        let own = faces.filter(|corners| (corners[0][0] > 15.0) == is_far);
        own.map(|[a, b, c]| dot(a, cross(b, c)) / 6.0).sum::<f64>()
    };
    for (is_far, whole) in [(false, volume(&near)), (true, -volume(&far))] {
        below!((of_part(is_far) / whole - 1.0).abs(), 0.01, "{whole}");
    }
}

/// A box at the origin, each of its sides of two triangles.
fn box_of(sizes: Point) -> Mesh {
    let mut soup = PolygonSoup::default();
    let side = |c: u32, axis: usize| if c >> axis & 1 == 0 { 0.0 } else { sizes[axis] };
    soup.positions = (0..8u32)
        .map(|c| [0, 1, 2].map(|axis| side(c, axis)))
        .collect();
    for face in [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ] {
        soup.faces.push(&face);
    }
    Mesh::from_soup(&soup, &Default::default()).unwrap().0
}

/// A prism, or a cone, of the radius 1 over a polygon with so many sides, closed by fans.
fn column(sides: u32, height: f64, is_cone: bool) -> Mesh {
    let angle = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(sides);
    let ring = |z: f64| (0..sides).map(move |i| [angle(i).cos(), angle(i).sin(), z]);
    let mut positions = vec![[0.0, 0.0, 0.0], [0.0, 0.0, height]];
    positions.extend(ring(0.0));
    if !is_cone {
        positions.extend(ring(height));
    }
    let mut triangles = Vec::new();
    for i in 0..sides {
        let [a, b] = [2 + i, 2 + (i + 1) % sides];
        let [c, d] = [a + sides, b + sides];
        triangles.push([0, b, a]);
        match is_cone {
            true => triangles.push([1, a, b]),
            false => triangles.extend([[1, c, d], [a, b, c], [b, d, c]]),
        }
    }
    Mesh::from_triangles(positions, triangles).unwrap()
}

/// Triangles of a surface whose normal is more than 90° from those of all faces of a mesh that are that near their middle.
fn looking_away(mesh: &Mesh, surface: Triangles<'_>, near: f64) -> usize {
    let normal = |[a, b, c]: [Point; 3]| cross(minus(b, a), minus(c, a));
    let input = mesh.as_triangles();
    let faces: Vec<_> = (0..input.triangles.len())
        .map(|face| input.corners(face))
        .collect();
    let looks_away = |own: [Point; 3]| {
        let middle = [0, 1, 2].map(|i| (own[0][i] + own[1][i] + own[2][i]) / 3.0);
        let close = faces
            .iter()
            .filter(|&&face| distance_to_triangle(middle, face) <= near);
        close
            .map(|&face| dot(normal(own), normal(face)))
            .fold(f64::MIN, f64::max)
            < 0.0
    };
    (0..surface.triangles.len())
        .filter(|&face| looks_away(surface.corners(face)))
        .count()
}

/// Parts, cages and needles, coarse relative to the distance: edges that cannot be round stay as
/// sharp as they were.
#[test]
fn parts_and_cages_stay_within_any_distance() {
    let meshes = [
        box_of([40.0, 20.0, 5.0]),
        box_of([1.0, 1.0, 1e-3]),
        octahedron(),
        column(32, 4.0, false),
        column(6, 40.0, true),
        voxels(2, |[x, y, z]| {
            z == 0 && x.abs() < 2 && y.abs() < 2 && !(x > 0 && y > 0)
        }),
    ];
    for (number, mesh) in meshes.iter().enumerate() {
        for part in [1e-3, 1e-2] {
            let most = part * mesh.diagonal();
            let found = asked(mesh, most);
            assert!(
                found.is_kept(),
                "{number} within {most}: {:?}",
                found.distance
            );
            check_distance(mesh, &found, most);
            assert_eq!(
                looking_away(mesh, found.refined.mesh.as_triangles(), most),
                0,
                "{number} within {most}"
            );
            is_inverted_nowhere(&found);
        }
    }
}

#[test]
fn a_box_that_no_smooth_surface_is_near_stays_a_box() {
    let mesh = box_of([40.0, 20.0, 5.0]);
    let found = asked(&mesh, 0.04);
    assert!(found.is_kept(), "{:?}", found.distance);
    assert_eq!(found.sharpened, 12, "{:?}", found.distance);
    check_distance(&mesh, &found, 0.04);
    assert!((volume(&found.refined.mesh) - 4000.0).abs() < 1e-6);
    // Round where there is room.
    let found = asked(&mesh, 1.5 * mesh.diagonal());
    assert!(found.is_kept() && found.sharpened == 0);
    check_distance(&mesh, &found, 1.5 * mesh.diagonal());
}

/// The round side of a prism over a polygon with 64 sides, between sharp rims.
#[test]
fn only_what_has_to_be_sharp_is() {
    let mesh = column(64, 4.0, false);
    let found = asked(&mesh, 0.01);
    assert!(found.is_kept(), "{:?}", found.distance);
    assert_eq!(found.sharpened, 128, "{:?}", found.distance);
    check_distance(&mesh, &found, 0.01);
    // Rounder than the polygon, whose sides are 1.2e-3 nearer to the axis in their middle.
    let radius = |p: &Point| p[0].hypot(p[1]);
    let side = found
        .refined
        .mesh
        .positions()
        .iter()
        .filter(|p| p[2] > 0.1 && p[2] < 3.9);
    let off = side.map(|p| (radius(p) - 1.0).abs()).fold(0.0, f64::max);
    assert!(off < 4e-4, "{off}");
}

#[test]
fn a_tiny_distance_does_not_take_millions_of_triangles() {
    for mesh in [lumpy(500, 3), ball(4)] {
        let most = 1e-7 * mesh.diagonal();
        let found = asked(&mesh, most);
        assert!(found.is_kept(), "{:?}", found.distance);
        let triangles = found.refined.mesh.face_count();
        at_most!(triangles, 4 * mesh.face_count());
        check_distance(&mesh, &found, most);
    }
}

#[test]
fn corners_and_creases_of_the_file_stay() {
    let mesh = ball(4);
    let mesh = mesh.with_creases_above(1.0).unwrap();
    let found = asked(&mesh, 0.3);
    // Faces are divided, and creases with them: as many at least lead to each vertex of the file as did.
    let creases_at = |mesh: &Mesh, v: u32| {
        mesh.tags()
            .creases
            .iter()
            .filter(|crease| crease.vertices.contains(&v))
            .count()
    };
    for v in 0..mesh.vertex_count() as u32 {
        assert!(creases_at(&found.control, v) >= creases_at(&mesh, v), "{v}");
    }
    assert!(found.is_kept(), "{:?}", found.distance);
    check_distance(&mesh, &found, 0.3);
}

#[test]
fn the_same_comes_out_for_any_number_of_threads() {
    let mesh = ball(6);
    let of = |threads| {
        let pool = pool(threads);
        let found = pool.install(|| asked(&mesh, 0.8));
        (
            found.refined.mesh.positions().to_vec(),
            found.refined.mesh.triangles().to_vec(),
        )
    };
    assert!(of(1) == of(3));
}

#[test]
fn smoothing_is_observed_and_ends_when_it_is_told_to() {
    let mesh = ball(16);
    let options = WithinOptions::default().within(0.87);
    let mut calls = 0;
    let mut longest = Duration::ZERO;
    let mut last = Instant::now();
    let whole = within_observed(&mesh, &Loop, &options, &mut |_: &Progress| {
        calls += 1;
        longest = longest.max(last.elapsed());
        last = Instant::now();
        ControlFlow::Continue(())
    });
    assert!(whole.is_ok() && calls > 100, "{calls}");
    below!(longest, Duration::from_secs(2));
    for stop in [1, 50, calls / 2] {
        let mut calls = 0;
        let found = within_observed(&mesh, &Loop, &options, &mut |_: &Progress| {
            calls += 1;
            if calls < stop {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        });
        assert!(
            matches!(found, Err(RefineError::Cancelled(_))) && calls == stop,
            "{calls} of {stop}"
        );
    }
}

#[test]
fn what_makes_no_sense_is_refused() {
    let mesh = octahedron();
    for length in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = within(&mesh, &Loop, &WithinOptions::default().within(length));
        assert!(matches!(refused, Err(RefineError::Mesh(_))), "{length}");
    }
    let options = WithinOptions::default().within(0.1).tolerance(Some(0.2));
    let refused = within(&mesh, &Loop, &options);
    assert!(matches!(refused, Err(RefineError::Mesh(_))));
    let options = WithinOptions::default().within(0.1);
    let refused = within(&mesh, &ModifiedButterfly, &options);
    assert!(refused.is_err_and(|error| error.to_string().contains("butterfly")));
}

//! Surfaces that are straight in one direction, and flat ends that follow their rims alone, against exact shapes and against the same
//! surface with all of its hierarchy.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::support::{
    Point, Random, creased, distance, dot, exact, mapped, minus, peg, pool, sampled,
};
use limitmesh::Mesh;
use limitmesh::mesh::{BoundaryRule, PolygonSoup};
use limitmesh::refine::{ExactOptions, ExactStop, Finish, exact_estimate, limit_reference};
use limitmesh::scheme::Loop;

fn within(tolerance: f64) -> ExactOptions {
    ExactOptions::default().tolerance(tolerance).unfold(true)
}

/// A point of a uniform cubic B-spline.
fn spline(t: f64, points: [Point; 4]) -> Point {
    let weights = [
        (1.0 - t).powi(3),
        3.0 * t * t * t - 6.0 * t * t + 4.0,
        1.0 + 3.0 * (t + t * t - t * t * t),
        t * t * t,
    ];
    [0, 1, 2].map(|axis| {
        weights
            .iter()
            .zip(points)
            .map(|(w, p)| w * p[axis])
            .sum::<f64>()
            / 6.0
    })
}

/// The distance of a point to a segment.
fn to_segment(p: Point, [a, b]: [Point; 2]) -> f64 {
    let (along, off) = (minus(b, a), minus(p, a));
    let t = (dot(along, off) / dot(along, along)).clamp(0.0, 1.0);
    distance(p, [0, 1, 2].map(|i| a[i] + t * along[i]))
}

/// The limit of the control polygon at one end of a peg is a spline: all of a rim's corners are on it, no chord is farther from it than
/// asked, and all chords are alike, whatever slivers the ends were made of. Two triangles for each stand between both rims, and no vertex.
#[test]
fn pegs_follow_their_rims() {
    for (facets, tolerance) in [(13, 1e-2), (16, 2e-3), (16, 1e-4), (16, 1e-5)] {
        let mesh = peg(facets);
        let result = exact(&mesh, &Loop, &within(tolerance)).unwrap();
        result.mesh.validate().unwrap();
        assert_eq!(result.stop, ExactStop::Met);
        let control = mesh.positions();
        let axis = [0, 1, 2].map(|i| (control[facets as usize][i] - control[0][i]) / 3.0);
        let positions = result.mesh.positions();
        let mut per_rim = Vec::new();
        for first in [0, facets] {
            let on_rim: Vec<Point> = positions
                .iter()
                .copied()
                .filter(|&p| dot(minus(p, control[first as usize]), axis).abs() < 1e-9)
                .collect();
            let curve: Vec<Point> = (0..facets)
                .flat_map(|i| {
                    let points = [0, 1, 2, 3]
                        .map(|k| control[(first + (i + facets - 1 + k) % facets) as usize]);
                    (0..512).map(move |step| spline(f64::from(step) / 512.0, points))
                })
                .collect();
            let nearest = |p: Point| {
                let along = curve.iter().map(|&q| distance(p, q)).enumerate();
                along.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap()
            };
            let mut along: Vec<(usize, Point)> = on_rim
                .iter()
                .map(|&p| {
                    let (at, off) = nearest(p);
                    assert!(off < 1e-9, "a corner is {off} off its rim");
                    (at, p)
                })
                .collect();
            along.sort_by_key(|&(at, _)| at);
            let chord = |i: usize| [along[i].1, along[(i + 1) % along.len()].1];
            let lengths: Vec<f64> = (0..along.len())
                .map(chord)
                .map(|[a, b]| distance(a, b))
                .collect();
            let [least, most] =
                [f64::min, f64::max].map(|of| lengths.iter().copied().reduce(of).unwrap());
            assert!(most < 1.1 * least, "{facets}, {tolerance}: {least} {most}");
            for (at, &p) in curve.iter().enumerate() {
                let off = (0..along.len())
                    .map(|i| to_segment(p, chord(i)))
                    .fold(f64::INFINITY, f64::min);
                assert!(off <= tolerance, "{facets}, {tolerance}: {off} at {at}");
            }
            per_rim.push(along.len());
        }
        assert_eq!(per_rim[0], per_rim[1]);
        // Except for some where leaves are divided next to others of the same line that are not.
        at_most!(positions.len(), 2 * per_rim[0] + 8);
        assert_eq!(result.mesh.face_count(), 2 * positions.len() - 4);
        let reference = limit_reference(&mesh, &Loop, 6).unwrap();
        let apart = sampled(&result.mesh, &reference, 50_000);
        // The reference's own chords leave the rims by less than this.
        at_most!(apart, tolerance + 2e-5);
    }
}

/// A sheet over a grid that is straight in one direction, with rows of control vertices along it, turned in space.
fn corrugated(columns: u32, rows: u32, numbers: &mut Random) -> Mesh {
    let turn = numbers.signed();
    let slant = 0.4 * numbers.signed();
    let profile: Vec<[f64; 2]> = (0..columns)
        .map(|i| {
            [
                f64::from(i) + 0.2 * numbers.signed(),
                1.5 * numbers.signed(),
            ]
        })
        .collect();
    let at = |i: u32, j: u32| {
        let ([x, z], y) = (profile[i as usize], f64::from(j));
        let (s, c) = turn.sin_cos();
        [c * x - s * y + slant * z, s * x + c * y, z + slant * y]
    };
    let positions = (0..rows)
        .flat_map(|j| (0..columns).map(move |i| (i, j)))
        .map(|(i, j)| at(i, j))
        .collect();
    Mesh::from_triangles(positions, crate::support::grid(columns, rows)).unwrap()
}

/// Fewer triangles than with all of the hierarchy, as near to the limit surface, whatever the profile; control vertices stay.
#[test]
fn strips_are_as_near_as_all_of_the_hierarchy() {
    let mut numbers = Random::new(7);
    let mut saved = 0;
    for case in 0..24 {
        let mesh = corrugated(4 + case % 5, 2 + case % 3, &mut numbers);
        let tolerance = [0.03, 0.01, 0.002][case as usize % 3];
        let options = within(tolerance);
        let merged = exact(&mesh, &Loop, &options).unwrap();
        let kept = exact(&mesh, &Loop, &options.clone().flat_regions(false)).unwrap();
        merged.mesh.validate().unwrap();
        assert_eq!(
            (merged.stop, kept.stop),
            (ExactStop::Met, ExactStop::Met),
            "{case}"
        );
        assert!(merged.mesh.face_count() <= kept.mesh.face_count(), "{case}");
        saved += kept.mesh.face_count() - merged.mesh.face_count();
        let reference = limit_reference(&mesh, &Loop, 6).unwrap();
        let apart = sampled(&merged.mesh, &reference, 20_000);
        at_most!(apart, 1.01 * tolerance, "{case}");
        assert_eq!(merged.mesh.topology().euler_characteristic(), 1);
        let corners = mesh.vertex_count();
        assert_eq!(
            merged.mesh.positions()[..corners],
            kept.mesh.positions()[..corners]
        );
        assert!(merged.parents.is_sorted());
        let estimate = exact_estimate(&mesh, &Loop, &options).unwrap();
        assert_eq!(estimate.triangles, merged.mesh.face_count(), "{case}");
        let most = merged.mesh.face_count();
        let budget = exact(&mesh, &Loop, &ExactOptions::default().triangles(most)).unwrap();
        assert!(budget.mesh.face_count() <= most);
        assert!(
            budget.error.upper <= 1.17 * merged.error.upper.max(tolerance),
            "{case}: {:?}",
            budget.error
        );
    }
    assert!(saved > 1000, "{saved}");
}

/// Two flat sides that go over into two round ones: the line between them may be straight, but what is flat has no sharp rim.
#[test]
fn flat_sides_may_go_over_into_round_ones() {
    let mut profile: Vec<[f64; 2]> = Vec::new();
    for (middle, from) in [(3.0, -0.25f64), (-3.0, 0.25)] {
        for i in 0..=8 {
            let (s, c) = (std::f64::consts::TAU * (from + f64::from(i) / 16.0)).sin_cos();
            profile.push([middle + c, s]);
        }
        // Two more in a row, so that something between them is flat.
        let side = if from < 0.0 { 1.0 } else { -1.0 };
        profile.extend([1.5, 0.0, -1.5].map(|x| [side * x, side]));
    }
    let count = profile.len() as u32;
    let positions = [0.0, 2.0]
        .iter()
        .flat_map(|&z| profile.iter().map(move |&[x, y]| [x, y, z]))
        .collect();
    let mut triangles = Vec::new();
    for i in 0..count {
        let next = (i + 1) % count;
        triangles.extend([[i, next, count + next], [i, count + next, count + i]]);
    }
    // Fans from the middle of a round side.
    for i in 5..count + 3 {
        let [here, next] = [i, i + 1].map(|i| i % count);
        triangles.extend([[4, next, here], [count + 4, count + here, count + next]]);
    }
    let mesh = creased(positions, triangles);
    for tolerance in [1e-2, 1e-3] {
        let [merged, folded] = [true, false].map(|unfold| within(tolerance).unfold(unfold));
        let [merged, folded] =
            [merged, folded].map(|options| exact(&mesh, &Loop, &options).unwrap());
        let kept = exact(&mesh, &Loop, &within(tolerance).flat_regions(false)).unwrap();
        for result in [&merged, &folded] {
            result.mesh.validate().unwrap();
            assert_eq!(result.stop, ExactStop::Met);
            assert_eq!(result.mesh.topology().euler_characteristic(), 2);
            assert_eq!(result.inverted_triangles(), 0);
        }
        // Hardly anything but the rims has vertices: where curvature changes some leaves are
        // divided next to others that are not.
        assert_eq!(merged.mesh.face_count(), 2 * merged.mesh.vertex_count() - 4);
        let inside = merged
            .mesh
            .positions()
            .iter()
            .filter(|p| p[2] != 0.0 && p[2] != 2.0)
            .count();
        assert!(8 * inside < merged.mesh.vertex_count(), "{inside}");
        assert!(4 * merged.mesh.face_count() < kept.mesh.face_count());
        let reference = limit_reference(&mesh, &Loop, 5).unwrap();
        let apart = sampled(&merged.mesh, &reference, 50_000);
        at_most!(apart, tolerance + 5e-5);
    }
}

/// Coordinates of single precision are off their lines by what they are rounded to, and what that does is counted.
#[test]
fn rounded_coordinates_have_strips_too() {
    let mesh = peg(16);
    let rounded = mapped(&mesh, |p| p.map(|x| f64::from(x as f32)));
    let [exactly, single] =
        [&mesh, &rounded].map(|mesh| exact(mesh, &Loop, &within(1e-3)).unwrap());
    assert_eq!(single.mesh.face_count(), exactly.mesh.face_count());
    assert!(single.error.upper <= 1e-3);
    let reference = limit_reference(&rounded, &Loop, 6).unwrap();
    let apart = sampled(&single.mesh, &reference, 50_000);
    assert!(apart <= 1e-3 + 2e-5, "{}", apart);
}

/// Two sheets in one place, joined along their border.
fn doubled(columns: u32, rows: u32, numbers: &mut Random) -> Mesh {
    let sheet = corrugated(columns, rows, numbers);
    let (mut positions, mut behind) = (sheet.positions().to_vec(), Vec::new());
    for v in 0..columns * rows {
        let is_inside =
            (1..columns - 1).contains(&(v % columns)) && (1..rows - 1).contains(&(v / columns));
        behind.push(if is_inside { positions.len() as u32 } else { v });
        positions.extend(is_inside.then_some(positions[v as usize]));
    }
    let back = |&[a, b, c]: &[u32; 3]| [a, c, b].map(|v| behind[v as usize]);
    // The other diagonals behind: at the corners of the sheet the same would be edges of four faces.
    let backs: Vec<[u32; 3]> = sheet.triangles().iter().map(back).collect();
    let backs = backs.chunks(2).flat_map(|pair| {
        let ([a, c, b], [_, d, _]) = (pair[0], pair[1]);
        [[a, d, b], [b, d, c]]
    });
    let triangles = sheet.triangles().iter().copied().chain(backs).collect();
    creased(positions, triangles)
}

/// Lines of two sheets in one place may have the same ends: then not both are put together, as an edge has two faces.
#[test]
fn sheets_may_touch_along_straight_lines() {
    let mut numbers = Random::new(3);
    let mut saved = 0;
    for case in 0..12 {
        let mesh = doubled(5 + case % 4, 3 + case % 2, &mut numbers);
        let tolerance = [0.01, 0.003, 0.001][case as usize % 3];
        let options = within(tolerance).unfold(case % 2 == 0);
        let merged = exact(&mesh, &Loop, &options).unwrap();
        let kept = exact(&mesh, &Loop, &options.flat_regions(false)).unwrap();
        merged.mesh.validate().unwrap();
        let again = Mesh::from_triangles(
            merged.mesh.positions().to_vec(),
            merged.mesh.triangles().to_vec(),
        );
        assert!(again.is_ok(), "{case}: {again:?}");
        assert_eq!(merged.mesh.topology().euler_characteristic(), 2, "{case}");
        assert_eq!(merged.mesh.topology().boundary_edge_count(), 0, "{case}");
        saved += kept.mesh.face_count() - merged.mesh.face_count();
    }
    assert!(saved > 1000, "{saved}");
}

/// Any number of threads gives equal bytes.
#[test]
fn threads_change_nothing() {
    let mesh = peg(16);
    let run = || exact(&mesh, &Loop, &within(1e-4)).unwrap();
    let here = run();
    for threads in [1, 3] {
        let pool = pool(threads);
        let there = pool.install(run);
        assert_eq!(here.mesh.positions(), there.mesh.positions());
        assert_eq!(here.mesh.triangles(), there.mesh.triangles());
    }
}

/// Quadrilaterals of a side may be cut this way and that: the creases' vertices are irregular then, and not many more triangles come out.
#[test]
fn sides_may_be_cut_either_way() {
    let even = peg(16);
    let mut triangles = even.triangles().to_vec();
    for i in (0..16u32).filter(|i| i % 3 == 1) {
        let next = (i + 1) % 16;
        triangles[2 * i as usize] = [i, next, 16 + i];
        triangles[2 * i as usize + 1] = [next, 16 + next, 16 + i];
    }
    let uneven = creased(even.positions().to_vec(), triangles);
    for tolerance in [0.01, 0.003] {
        let [regular, irregular, whole] =
            [(&even, true), (&uneven, true), (&uneven, false)].map(|(mesh, has_flat)| {
                let result = exact(mesh, &Loop, &within(tolerance).flat_regions(has_flat)).unwrap();
                assert_eq!(result.stop, ExactStop::Met);
                result.mesh.face_count()
            });
        at_most!(irregular, 3 * regular, "within {tolerance}");
        at_most!(4 * irregular, 3 * whole, "within {tolerance}");
    }
}

/// Where quadrilaterals lie in planes and the surface is straight nowhere, all is as without the option.
#[test]
fn what_is_curved_both_ways_has_no_strips() {
    for name in ["torus", "cup", "shoe"] {
        let soup = limitmesh_models::find(name).unwrap().soup();
        let mesh = Mesh::from_soup(&soup, &Default::default()).unwrap().0;
        let options = within(9e-4 * mesh.diagonal());
        let result = exact(&mesh, &Loop, &options).unwrap();
        let kept = exact(&mesh, &Loop, &options.flat_regions(false)).unwrap();
        assert_eq!(result.mesh.triangles(), kept.mesh.triangles(), "{name}");
        assert_eq!(result.mesh.positions(), kept.mesh.positions(), "{name}");
    }
}

/// Where flat ends and straight sides are merged, balanced vertices, of which none are, need more triangles: those on the surface are taken.
#[test]
fn balanced_pegs_take_no_more_triangles() {
    for (facets, tolerance) in [(13, 1e-2), (16, 1e-3), (32, 1e-4)] {
        let mesh = peg(facets);
        for options in [
            within(tolerance),
            ExactOptions::default().tolerance(tolerance),
        ] {
            let plain = exact(&mesh, &Loop, &options).unwrap();
            let balanced = exact(&mesh, &Loop, &options.clone().finish(Finish::Balanced)).unwrap();
            assert_eq!(
                (plain.stop, balanced.stop),
                (ExactStop::Met, ExactStop::Met)
            );
            let [plain, count] = [&plain, &balanced].map(|result| result.mesh.face_count());
            at_most!(count, plain, "{facets}, {tolerance}");
            let told = exact_estimate(&mesh, &Loop, &options.finish(Finish::Balanced))
                .unwrap()
                .triangles;
            at_most!(4 * told, 6 * count, "{facets}, {tolerance}");
            at_most!(4 * count, 6 * told, "{facets}, {tolerance}");
        }
    }
}

/// A pentagon with a corner a billionth from the edge opposite, nearly flat: the mesh by which its
/// bound was to be made tight had far too many triangles, which each of thousands of rounds
/// assembled to find whether strips left fewer.
#[test]
fn nearer_meshes_with_too_many_triangles_are_given_up() {
    let at = [
        [1.0, 0.25, -1.5e-8],
        [4.0, 0.25, -6.4e-8],
        [4.0, 3.25, -5.4e-9],
        [2.5, 0.250000001, 1.5e-7],
        [1.0, 3.25, 3.1e-7],
    ];
    let mut soup = PolygonSoup {
        positions: at.to_vec(),
        ..PolygonSoup::default()
    };
    soup.faces.push(&[4, 3, 2, 1, 0]);
    let (mesh, _) = Mesh::from_soup(&soup, &Default::default()).unwrap();
    let (mesh, _) = mesh
        .with_boundary(BoundaryRule::Fixed)
        .with_divided_concave_corners()
        .unwrap();
    let options = ExactOptions::default()
        .tolerance(0.01 * mesh.diagonal())
        .unfold(true);
    // Rounds, not calls, of which there are more where another program is at work.
    let mut rounds = std::collections::HashSet::new();
    let mut count = |at: &limitmesh::progress::Progress| {
        if at.stage == limitmesh::progress::Stage::Refining && at.triangles > 50_000 {
            rounds.insert(at.done);
        }
        if rounds.len() > 100 {
            core::ops::ControlFlow::Break(())
        } else {
            core::ops::ControlFlow::Continue(())
        }
    };
    let found = limitmesh::refine::exact_observed(&mesh, &Loop, &options, &mut count).unwrap();
    assert!(found.error.upper <= 0.01 * mesh.diagonal() && found.stop == ExactStop::Met);
}

//! Flat regions that the rules fold over: what the rim encloses stands there, at each tolerance alike.

use std::collections::HashSet;
use std::f64::consts::TAU;

use limitmesh::Mesh;
use limitmesh::index::FaceId;
use limitmesh::measure::{CertifiedOptions, SamplingOptions, hausdorff};
use limitmesh::mesh::{INFINITELY_SHARP, Tags};
use limitmesh::refine::{Exact, ExactOptions, ExactStop, Finish, exact_estimate, limit_reference};
use limitmesh::scheme::Loop;

use crate::support::{
    Random, corner, creased, distance, dot, enclosed, exact, grid, minus, within,
};

/// A plate with a round hole whose triangles are slivers, as programs for design write them: the rules turn some over where two
/// fans meet. The hole's vertices are those from the seventh on.
fn plate_of_slivers(facets: u32) -> Mesh {
    let on_circle = |radius: f64, turn: f64| {
        let (s, c) = (TAU * turn).sin_cos();
        [radius * c, radius * s, 0.0]
    };
    let third = |i: u32| f64::from(2 * i + 1) / 6.0;
    let mut positions: Vec<[f64; 3]> = (0..3).map(|i| on_circle(2.0, third(i))).collect();
    positions.extend((0..3).map(|i| on_circle(1.2, third(i))));
    positions.extend((0..facets).map(|i| on_circle(0.5, f64::from(i) / f64::from(facets))));
    let hole = |i: u32| 6 + i % facets;
    let mut triangles = Vec::new();
    for i in 0..facets {
        let (inner, next) = (3 + 3 * i / facets, 3 + (3 * (i + 1) / facets) % 3);
        triangles.push([hole(i + 1), hole(i), inner]);
        if inner != next {
            triangles.push([hole(i + 1), inner, next]);
        }
    }
    for i in 0..3 {
        let next = (i + 1) % 3;
        triangles.extend([[3 + i, i, next], [3 + i, next, 3 + next]]);
    }
    let corners = (0..3)
        .map(|vertex| corner(vertex, INFINITELY_SHARP))
        .collect();
    let plate = Mesh::from_triangles(positions, triangles).unwrap();
    plate.with_tags(crate::support::corners(corners)).unwrap()
}

/// The triangles cover the inside of the rims, once.
#[test]
fn plates_with_holes_do_not_fold() {
    let facets = 24;
    let plate = plate_of_slivers(facets);
    let hole = |i: u32| 6 + i % facets;
    let [whole, folded] =
        [true, false].map(|flat| exact(&plate, &Loop, &within(1e-4).unfold(flat)).unwrap());
    assert!(folded.inverted_triangles() > 0 && folded.statistics.unfolded == 0);
    assert_eq!(
        (
            whole.inverted_triangles(),
            whole.statistics.unfolded,
            whole.stop
        ),
        (0, 1, ExactStop::Met)
    );
    let areas: Vec<f64> = (0..whole.mesh.face_count() as u32)
        .map(|face| whole.mesh.face_normal(FaceId(face))[2])
        .collect();
    assert!(areas.iter().all(|&area| area > 0.0));
    // The hole's rim is a uniform cubic B-spline of its vertices: no chord is farther from it than asked.
    let bend = |t: f64, p: [f64; 4]| {
        let weights = [
            (1.0 - t).powi(3),
            3.0 * t * t * t - 6.0 * t * t + 4.0,
            1.0 + 3.0 * (t + t * t - t * t * t),
            t * t * t,
        ];
        weights.iter().zip(p).map(|(w, x)| w * x).sum::<f64>() / 6.0
    };
    let rim = |i: u32, t: f64| {
        let points = [0, 1, 2, 3].map(|k| plate.positions()[hole(i + facets - 1 + k) as usize]);
        [0, 1].map(|axis| bend(t, points.map(|p| p[axis])))
    };
    let mut inside = 0.0;
    for i in 0..facets {
        for step in 0..1000 {
            let [[ax, ay], [bx, by]] = [0, 1].map(|k| rim(i, f64::from(step + k) * 1e-3));
            inside += 0.5 * (ax * by - ay * bx);
        }
    }
    let area = 0.5 * areas.iter().sum::<f64>();
    let outside = 3.0 * 3f64.sqrt();
    // The chords of the rim leave it by the tolerance at most, along its length of half a circle's and less.
    assert!(
        (area - (outside - inside)).abs() < TAU * 0.5 * 1e-4,
        "{area} {inside}"
    );
    // A region that folds over has its rim divided as well.
    assert!(
        whole.mesh.topology().boundary_edge_count() < folded.mesh.topology().boundary_edge_count()
    );
}

/// The ends of a mesh's boundary edges.
fn rims(mesh: &Mesh) -> Vec<[[f64; 3]; 2]> {
    let edges = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [c, a]];
    let all: HashSet<[u32; 2]> = mesh.triangles().iter().flat_map(edges).collect();
    let open = all.iter().filter(|&&[from, to]| !all.contains(&[to, from]));
    open.map(|ends| ends.map(|vertex| mesh.positions()[vertex as usize]))
        .collect()
}

/// How far a point is from the nearest of some segments.
fn to_segments(point: [f64; 3], segments: &[[[f64; 3]; 2]]) -> f64 {
    let distance = |&[from, to]: &[[f64; 3]; 2]| {
        let along = minus(to, from);
        let t = (dot(minus(point, from), along) / dot(along, along)).clamp(0.0, 1.0);
        distance(point, [0, 1, 2].map(|i| from[i] + t * along[i]))
    };
    segments.iter().map(distance).fold(f64::INFINITY, f64::min)
}

/// A thin ring whose rims' chords cross while the curves do not, adjacent to a plate that the rules
/// fold over: the ring's rims are divided until it can be triangulated, and the plate is measured
/// as the inside of its rim.
#[test]
fn rims_whose_chords_cross_are_divided() {
    let plate = plate_of_slivers(24);
    let shift = plate.vertex_count() as u32;
    let mut positions = plate.positions().to_vec();
    for (radius, facets) in [(1.0, 6), (0.84, 12)] {
        positions.extend((0..facets).map(|i| {
            let (s, c) = (TAU * f64::from(i) / f64::from(facets)).sin_cos();
            [5.0 + radius * c, radius * s, 0.0]
        }));
    }
    let mut triangles = plate.triangles().to_vec();
    let of_ring = |i: u32| {
        let [o, p] = [i, (i + 1) % 6].map(|i| shift + i);
        let [a, b, c] = [2 * i, 2 * i + 1, (2 * i + 2) % 12].map(|i| shift + 6 + i);
        [[o, p, b], [o, b, a], [p, c, b]]
    };
    triangles.extend((0..6).flat_map(of_ring));
    let mesh = Mesh::from_triangles(positions, triangles)
        .unwrap()
        .with_tags(plate.tags().clone())
        .unwrap();
    let reference = limit_reference(&mesh, &Loop, 6).unwrap();
    let curves = rims(&reference);
    for (tolerance, budget) in [(0.3, None), (0.1, None), (0.1, Some(70)), (0.003, None)] {
        let options = within(tolerance).unfold(true);
        let options = budget.map_or(options.clone(), |most| options.triangles(most));
        let found = exact(&mesh, &Loop, &options).unwrap();
        assert_eq!(found.inverted_triangles(), 0, "{tolerance} {budget:?}");
        above!(found.statistics.unfolded, 0, "{tolerance} {budget:?}");
        assert!(found.error.upper <= tolerance);
        let estimate = exact_estimate(&mesh, &Loop, &options).unwrap();
        assert_eq!(estimate.triangles, found.mesh.face_count());
        let chords = rims(&found.mesh);
        let farthest = curves
            .iter()
            .map(|&[point, _]| to_segments(point, &chords))
            .fold(0.0, f64::max);
        at_most!(found.error.lower, farthest + 1e-9);
    }
}

/// A thin slab whose flat sides fold: balanced vertices would meet an angle there after a hundred times as many divisions as those on the surface,
/// which are put together afterwards, and are not tried any further than these.
#[test]
fn balanced_angles_of_folding_sides_come_to_an_end() {
    let plate = plate_of_slivers(24);
    let count = plate.vertex_count() as u32;
    let below = plate.positions().iter().map(|&[x, y, z]| [x, y, z - 1e-3]);
    let positions = plate.positions().iter().copied().chain(below).collect();
    let mut triangles = plate.triangles().to_vec();
    triangles.extend(
        plate
            .triangles()
            .iter()
            .map(|&[a, b, c]| [a, c, b].map(|vertex| vertex + count)),
    );
    let topology = plate.topology();
    for h in topology
        .half_edges()
        .filter(|&h| topology.twin(h).is_none())
    {
        let [from, to] = topology.ends(h).map(|vertex| vertex.0);
        triangles.extend([[to, from, from + count], [to, from + count, to + count]]);
    }
    let slab = creased(positions, triangles);
    let options = within(0.02 * slab.diagonal())
        .angle(20f64.to_radians())
        .unfold(true);
    let most_triangles = |options: &ExactOptions| {
        let mut most = 0;
        let mut watch = |progress: &limitmesh::progress::Progress| {
            most = most.max(progress.triangles);
            core::ops::ControlFlow::Continue(())
        };
        let found = limitmesh::refine::exact_observed(&slab, &Loop, options, &mut watch).unwrap();
        (most, found)
    };
    let (plain_most, plain) = most_triangles(&options);
    let options = options.finish(Finish::Balanced);
    let (most, found) = most_triangles(&options);
    assert!(found.mesh.face_count() <= plain.mesh.face_count());
    assert!(most <= plain_most, "{most} {plain_most}");
    assert_eq!(
        exact_estimate(&slab, &Loop, &options).unwrap().triangles,
        found.mesh.face_count()
    );
}

/// The plate in the middle of a tent: where the surface goes on smoothly, triangles that fold are
/// near to more than the inside of a rim, so they stay, and the proven bound holds.
#[test]
fn what_folds_beside_smooth_surfaces_stays() {
    let plate = plate_of_slivers(24);
    let count = plate.vertex_count() as u32;
    let mut positions = plate.positions().to_vec();
    positions.extend((0..3).map(|i| {
        let (s, c) = (TAU * f64::from(2 * i + 1) / 6.0).sin_cos();
        [3.0 * c, 3.0 * s, -1.0]
    }));
    let mut triangles = plate.triangles().to_vec();
    for i in 0..3 {
        let next = (i + 1) % 3;
        triangles.extend([[i, count + i, count + next], [i, count + next, next]]);
    }
    let tent = Mesh::from_triangles(positions, triangles).unwrap();
    let reference = limit_reference(&tent, &Loop, 5).unwrap();
    let samples = SamplingOptions::default().samples(30_000);
    for tolerance in [0.1, 0.02, 2e-3] {
        let found = exact(&tent, &Loop, &within(tolerance).unfold(true)).unwrap();
        assert_eq!(found.statistics.unfolded, 0, "{tolerance}");
        above!(found.inverted_triangles(), 0, "{tolerance}");
        let sampled = hausdorff(
            found.mesh.as_triangles(),
            reference.as_triangles(),
            &samples,
        )
        .unwrap();
        // The reference's own chords are off by less than this.
        at_most!(sampled.symmetric(), found.error.upper + 2e-4, "{tolerance}");
    }
}

/// A flat grid whose vertices were moved about by so much at most: the rules fold some over their boundary.
fn stirred_grid(columns: u32, rows: u32, numbers: &mut Random, most: f64) -> Mesh {
    let cells = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
    let positions: Vec<[f64; 3]> = cells
        .map(|(i, j)| {
            [
                f64::from(i) + most * numbers.signed(),
                f64::from(j) + most * numbers.signed(),
                0.0,
            ]
        })
        .collect();
    Mesh::from_triangles(positions, grid(columns, rows)).unwrap()
}

/// Flat strips side by side, sharp in between, whose vertices on both sides are of any number and much farther apart along them than across;
/// those around all stay.
fn strips_between_sharp_lines(numbers: &mut Random) -> Mesh {
    const LENGTH: f64 = 8.0;
    let (mut positions, mut rows) = (Vec::new(), Vec::<Vec<u32>>::new());
    let mut y = 0.0;
    for _ in 0..4 {
        let edges = 3 + (3.5 * (numbers.signed() + 1.0)) as u32;
        let most = [0.0, 0.3, 0.8, 1.3][(2.0 * (numbers.signed() + 1.0)) as usize % 4];
        let first = positions.len() as u32;
        rows.push((first..=first + edges).collect());
        for i in 0..=edges {
            let x = LENGTH * f64::from(i) / f64::from(edges);
            positions.push([x, y + 0.5 * most * (numbers.signed() + 1.0), 0.0]);
        }
        y += [0.2, 0.5, 1.2][(1.5 * (numbers.signed() + 1.0)) as usize % 3];
    }
    let mut triangles = Vec::new();
    for sides in rows.windows(2) {
        let [low, high] = [&sides[0], &sides[1]];
        let (mut i, mut j) = (0, 0);
        while i + 1 < low.len() || j + 1 < high.len() {
            let next = |row: &[u32], at: usize| {
                row.get(at + 1).map(|&vertex| positions[vertex as usize][0])
            };
            let is_low = match [next(low, i), next(high, j)] {
                [Some(below), Some(above)] => below <= above,
                [below, _] => below.is_some(),
            };
            let third = if is_low { low[i + 1] } else { high[j + 1] };
            triangles.push([low[i], third, high[j]]);
            if is_low { i += 1 } else { j += 1 }
        }
    }
    let mesh = Mesh::from_triangles(positions, triangles).unwrap();
    let inner = rows[1..rows.len() - 1]
        .iter()
        .flat_map(|row| row.windows(2));
    let creases = inner.map(|edge| crate::support::crease([edge[0], edge[1]], INFINITELY_SHARP));
    let is_inside = |vertex: &u32| {
        rows[1..rows.len() - 1]
            .iter()
            .any(|row| row[1..row.len() - 1].contains(vertex))
    };
    let around = (0..mesh.vertex_count() as u32).filter(|vertex| !is_inside(vertex));
    let corners = around
        .map(|vertex| corner(vertex, INFINITELY_SHARP))
        .collect();
    mesh.with_tags(Tags {
        creases: creases.collect(),
        corners,
    })
    .unwrap()
}

/// Regions that cannot be triangulated from their rims keep their triangles, and estimates count these.
#[test]
fn estimates_count_regions_that_stay() {
    let mut numbers = Random::new(11);
    let mut kept = 0;
    for case in 0..40 {
        let mesh = stirred_grid(4 + case % 3, 4 + case % 2, &mut numbers, 1.0);
        let options = within(3e-4 * mesh.diagonal()).unfold(case % 2 == 0);
        let result = exact(&mesh, &Loop, &options).unwrap();
        let estimate = exact_estimate(&mesh, &Loop, &options).unwrap();
        assert_eq!(estimate.triangles, result.mesh.face_count(), "{case}");
        // Else nothing but the rim and control vertices had any.
        let on_rim = result.mesh.topology().boundary_edge_count();
        kept += usize::from(result.mesh.vertex_count() > mesh.vertex_count() + on_rim);
    }
    assert!(kept > 3, "{kept}");
}

/// One mesh is as near as reported to another of a much smaller distance, which approximates the
/// same surface.
fn assert_as_near_as_told(found: &Exact, fine: &Exact, what: &str) {
    at_most!(fine.error.lower, fine.error.upper, "{what}");
    at_most!(found.error.lower, found.error.upper, "{what}");
    let options = CertifiedOptions::default().gap(Some(fine.error.upper));
    let apart = enclosed(&found.mesh, &fine.mesh, &options);
    let off = fine.error.upper;
    at_most!(apart.lower(), found.error.upper + off, "{what}");
    at_most!(found.error.lower, apart.upper() + off, "{what}");
}

/// Grids, plates and strips that fold approximate one surface at all tolerances.
#[test]
fn what_folds_is_the_same_at_each_tolerance() {
    let mut numbers = Random::new(12);
    let (mut unfolded, mut folded) = (0, 0);
    for case in 0..24 {
        let mesh = match case % 3 {
            2 => strips_between_sharp_lines(&mut numbers),
            0 => stirred_grid(
                4 + case % 4,
                4 + case % 5,
                &mut numbers,
                0.2 + 0.1 * f64::from(case % 9),
            ),
            _ => {
                let plate = plate_of_slivers(12 + case);
                let most = 0.01 * f64::from(case % 8);
                let stirred = |&[x, y, z]: &[f64; 3]| {
                    [x + most * numbers.signed(), y + most * numbers.signed(), z]
                };
                let positions = plate.positions().iter().map(stirred).collect();
                plate.with_positions(positions).unwrap()
            }
        };
        let within = |share: f64| {
            exact(&mesh, &Loop, &within(share * mesh.diagonal()).unfold(true)).unwrap()
        };
        let fine = within(1e-4);
        for share in [0.03, 0.01, 3e-3] {
            assert_as_near_as_told(&within(share), &fine, &format!("{case} within {share}"));
        }
        let balanced = super::within(0.01 * mesh.diagonal())
            .unfold(true)
            .finish(Finish::Balanced);
        assert_as_near_as_told(
            &exact(&mesh, &Loop, &balanced).unwrap(),
            &fine,
            &format!("{case} balanced"),
        );
        (unfolded, folded) = (
            unfolded + fine.statistics.unfolded,
            folded + usize::from(fine.inverted_triangles() > 0),
        );
    }
    assert!(unfolded > 2 && folded > 2, "{unfolded} {folded}");
}

/// Budgets as well, balanced or not. The surface of strips had been derived from their triangles
/// where vertices are balanced, and where rims that are divided again needed far more triangles
/// than the budget.
#[test]
fn what_folds_is_the_same_under_budgets() {
    for seed in [12, 40, 69, 121, 140, 170, 172] {
        let mesh = strips_between_sharp_lines(&mut Random::new(seed));
        let fine = exact(&mesh, &Loop, &within(1e-3 * mesh.diagonal()).unfold(true)).unwrap();
        for times in [1.2, 2.0, 3.0] {
            let most = (times * mesh.face_count() as f64) as usize;
            for finish in [Finish::OnSurface, Finish::Balanced] {
                let options = ExactOptions::default()
                    .triangles(most)
                    .unfold(true)
                    .finish(finish);
                let found = exact(&mesh, &Loop, &options).unwrap();
                assert!(found.mesh.face_count() <= most);
                assert_as_near_as_told(&found, &fine, &format!("{seed} with {most}, {finish:?}"));
            }
        }
    }
}

/// A plate below a thin roof of the same plane: the curve that they share bulges over the roof's own rim, while the chords do not. Where what rims
/// enclose is asked for, the one winds forwards there and the other backwards, but no triangle is where the plate's surface reaches.
#[test]
fn what_two_rims_undo_counts() {
    let plate = [
        [-1.0, -5.0],
        [0.0, -2.0],
        [1.0, 1.0],
        [2.0, 1.0],
        [3.0, -2.0],
        [4.0, -5.0],
    ];
    let left = [
        [-22.8, -5.0],
        [-23.1, -5.0],
        [-22.8, -4.925],
        [-18.3, -3.8],
        [-11.7, -2.15],
        [-5.1, -0.5],
    ];
    let right = [
        [1.5, 1.15],
        [8.1, -0.5],
        [14.7, -2.15],
        [21.3, -3.8],
        [25.8, -4.925],
        [26.1, -5.0],
        [25.8, -5.0],
    ];
    let positions = plate
        .iter()
        .chain(&left)
        .chain(&right)
        .map(|&[x, y]| [x, y, 0.0])
        .collect();
    let triangles = [
        [0, 5, 4],
        [1, 0, 4],
        [1, 4, 3],
        [3, 2, 1],
        [18, 17, 16],
        [8, 7, 6],
        [6, 0, 1],
        [4, 5, 18],
        [6, 1, 2],
        [3, 4, 18],
        [9, 8, 6],
        [18, 16, 15],
        [18, 15, 14],
        [10, 9, 6],
        [10, 6, 2],
        [3, 18, 14],
        [3, 14, 13],
        [3, 13, 12],
        [2, 3, 12],
        [2, 12, 11],
        [2, 11, 10],
    ];
    let mesh = Mesh::from_triangles(positions, triangles.to_vec()).unwrap();
    let crease = |first| crate::support::crease([first, first + 1], INFINITELY_SHARP);
    let mesh = mesh
        .with_tags(crate::support::creases((0..5).map(crease).collect()))
        .unwrap();
    let reference = limit_reference(&mesh, &Loop, 6).unwrap();
    for options in [
        within(0.8),
        within(0.4),
        within(0.2),
        ExactOptions::default().triangles(22),
    ] {
        let found = exact(&mesh, &Loop, &options.unfold(true)).unwrap();
        let sampled = hausdorff(
            found.mesh.as_triangles(),
            reference.as_triangles(),
            &SamplingOptions::default(),
        );
        let sampled = sampled.unwrap().symmetric();
        at_least!(found.error.upper, 0.99 * sampled);
    }
}

//! Regions of the limit surface that lie in a plane, against exact shapes.

#![allow(clippy::unwrap_used, clippy::panic)]

mod channels;
mod folding;
use std::f64::consts::TAU;

use crate::support::{creased, cross, dot, exact, mapped, peg, sampled, within};
use limitmesh::Mesh;
use limitmesh::refine::{Exact, ExactOptions, ExactStop, Finish, exact_estimate, limit_reference};
use limitmesh::scheme::Loop;

/// A slab with a hole through it, both round, and with vertices inside its flat sides where `has_inner`.
pub(crate) fn washer(facets: u32, has_inner: bool) -> Mesh {
    let rings: &[(f64, f64)] = if has_inner {
        &[
            (2.0, 0.0),
            (2.0, 1.0),
            (1.5, 1.0),
            (1.0, 1.0),
            (1.0, 0.0),
            (1.5, 0.0),
        ]
    } else {
        &[(2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 0.0)]
    };
    let ring = |&(r, z): &(f64, f64)| {
        (0..facets).map(move |i| {
            let (s, c) = (TAU * f64::from(i) / f64::from(facets)).sin_cos();
            [r * c, r * s, z]
        })
    };
    let positions = rings.iter().flat_map(ring).collect();
    let mut triangles = Vec::new();
    for (at, _) in rings.iter().enumerate() {
        let (here, there) = (
            at as u32 * facets,
            (at as u32 + 1) % rings.len() as u32 * facets,
        );
        for i in 0..facets {
            let next = (i + 1) % facets;
            triangles.extend([
                [here + i, here + next, there + next],
                [here + i, there + next, there + i],
            ]);
        }
    }
    creased(positions, triangles)
}

/// Triangles, and area, of those whose normals are within a degree of a direction.
fn facing(result: &Exact, direction: [f64; 3]) -> (usize, f64) {
    let surface = result.mesh.as_triangles();
    let (mut count, mut area) = (0, 0.0);
    for face in 0..result.mesh.face_count() {
        let [a, b, c] = surface.corners(face);
        let normal = cross(
            [0, 1, 2].map(|i| b[i] - a[i]),
            [0, 1, 2].map(|i| c[i] - a[i]),
        );
        let length = dot(normal, normal).sqrt();
        if dot(normal, direction) > 0.9998 * length {
            (count, area) = (count + 1, area + 0.5 * length);
        }
    }
    (count, area)
}

/// Without the option and with it: both within the tolerance of one surface.
fn both(mesh: &Mesh, tolerance: f64) -> (Exact, Exact) {
    let options = within(tolerance);
    let merged = exact(mesh, &Loop, &options).unwrap();
    let kept = exact(mesh, &Loop, &options.flat_regions(false)).unwrap();
    for result in [&merged, &kept] {
        result.mesh.validate().unwrap();
        assert_eq!(result.stop, ExactStop::Met);
        let faces = mesh.face_count() as u32;
        assert!(result.parents.is_sorted() && result.parents.iter().all(|&face| face < faces));
        assert_eq!(result.origins.len(), result.mesh.vertex_count());
        assert_eq!(
            result.mesh.topology().boundary_edge_count() == 0,
            mesh.topology().boundary_edge_count() == 0
        );
        assert_eq!(
            result.mesh.topology().euler_characteristic(),
            mesh.topology().euler_characteristic()
        );
    }
    // Flat regions here are flat to rounding, and cost no more; rims are divided as they need it
    // themselves.
    for result in [&merged, &kept] {
        let error = &result.error;
        at_most!(error.lower, error.upper);
        at_most!(error.upper, tolerance);
    }
    at_most!(sampled(&merged.mesh, &kept.mesh, 20_000), 2.0 * tolerance);
    (merged, kept)
}

/// The ends of a peg have no vertices inside, cover what they covered, and are seen as flat.
#[test]
fn the_ends_of_a_peg_follow_their_rims_alone() {
    for (facets, tolerance) in [(13, 1e-2), (16, 2e-3), (16, 1e-4)] {
        let mesh = peg(facets);
        let (merged, kept) = both(&mesh, tolerance);
        let axis = {
            let [a, b] = [0, facets].map(|vertex| mesh.positions()[vertex as usize]);
            [0, 1, 2].map(|i| (b[i] - a[i]) / 3.0)
        };
        let mut at_ends = 0;
        for direction in [axis, axis.map(|x| -x)] {
            let [(few, area), (many, same)] =
                [&merged, &kept].map(|result| facing(result, direction));
            // Between curve and chords along the rim.
            assert!((area - same).abs() < TAU * tolerance, "{area} {same}");
            assert!(many > 2 * few, "{many} {few}");
            // As many as its rim's polygon has corners, less two.
            let on_rim = merged
                .sides
                .iter()
                .filter(|&&(_, normal)| dot(normal, direction) > 0.999_999);
            let corners: std::collections::BTreeSet<u32> = on_rim
                .map(|&(h, _)| merged.mesh.triangles()[h as usize / 3][h as usize % 3])
                .collect();
            assert_eq!(few + 2, corners.len());
            at_ends += corners.len();
        }
        assert!(at_ends >= 4 * facets as usize);
        // Each corner knows its own side.
        for h in merged.mesh.topology().half_edges() {
            let triangle = merged.mesh.as_triangles().corners(h.face().index());
            let normal = cross(
                [0, 1, 2].map(|i| triangle[1][i] - triangle[0][i]),
                [0, 1, 2].map(|i| triangle[2][i] - triangle[0][i]),
            );
            let along = dot(normal, merged.corner_normal(h)) / dot(normal, normal).sqrt();
            assert!(along > 0.8, "{along}");
        }
    }
}

/// Holes stay, and so do control vertices.
#[test]
fn holes_and_control_vertices_stay() {
    for has_inner in [false, true] {
        let mesh = washer(12, has_inner);
        let (merged, kept) = both(&mesh, 2e-3);
        assert!(merged.mesh.face_count() < kept.mesh.face_count());
        for direction in [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]] {
            let [(few, area), (many, same)] =
                [&merged, &kept].map(|result| facing(result, direction));
            // Between curves and chords along the rims of radius 2 and 1.
            assert!((area - same).abs() < 3.0 * TAU * 2e-3, "{area} {same}");
            assert!(few < many);
        }
        for vertex in 0..mesh.vertex_count() {
            assert_eq!(
                merged.mesh.positions()[vertex],
                kept.mesh.positions()[vertex]
            );
        }
    }
}

/// A round plate with nothing beyond its rim.
#[test]
fn boundaries_are_rims_too() {
    let facets = 9;
    let mut positions = vec![[0.0; 3]];
    positions.extend((0..facets).map(|i| {
        let (s, c) = (TAU * f64::from(i) / f64::from(facets)).sin_cos();
        [c, s, 0.0]
    }));
    let triangles = (0..facets)
        .map(|i| [0, 1 + i, 1 + (i + 1) % facets])
        .collect();
    let mesh = Mesh::from_triangles(positions, triangles).unwrap();
    let (merged, kept) = both(&mesh, 1e-3);
    assert!(merged.mesh.face_count() < kept.mesh.face_count());
    let on_rim = merged.mesh.topology().boundary_edge_count();
    // All of the rim's corners and the one in the middle.
    assert_eq!(merged.mesh.face_count(), on_rim);
    assert_eq!(merged.mesh.vertex_count(), on_rim + 1);
}

/// Two flat sheets that share a rim: no edge has four faces, and caps hold though a region keeps
/// its triangles.
#[test]
fn sheets_that_share_their_rims_stay_apart() {
    for stretch in [1.0, 0.05] {
        let facets = 16;
        let mut positions = vec![[0.0; 3]; 2];
        positions.extend((0..facets).map(|i| {
            let (s, c) = (TAU * f64::from(i) / f64::from(facets)).sin_cos();
            [c, stretch * s, 0.0]
        }));
        let rim = |i: u32| 2 + i % facets;
        let triangles =
            (0..facets).flat_map(|i| [[0, rim(i), rim(i + 1)], [1, rim(i + 1), rim(i)]]);
        let mesh = creased(positions, triangles.collect());
        let (merged, kept) = both(&mesh, 1e-4);
        assert!(merged.mesh.face_count() < kept.mesh.face_count());
        for most in [100, 150, 200, 300] {
            let capped = exact(&mesh, &Loop, &ExactOptions::default().triangles(most)).unwrap();
            capped.mesh.validate().unwrap();
            at_most!(capped.mesh.face_count(), most);
        }
    }
}

/// Numbers of triangles count what is handed out.
#[test]
fn budgets_and_estimates_count_what_is_left() {
    let mesh = peg(16);
    let merged = exact(&mesh, &Loop, &within(1e-3)).unwrap();
    let kept = exact(&mesh, &Loop, &within(1e-3).flat_regions(false)).unwrap();
    let estimate = exact_estimate(&mesh, &Loop, &within(1e-3)).unwrap();
    assert_eq!(estimate.triangles, merged.mesh.face_count());
    let most = merged.mesh.face_count();
    assert!(2 * most < kept.mesh.face_count());
    let budget = exact(&mesh, &Loop, &ExactOptions::default().triangles(most)).unwrap();
    assert!(budget.mesh.face_count() <= most);
    at_most!(budget.error.upper, 1.15 * merged.error.upper);
}

/// Collapses leave a rim's triangles and hold what they promise: of flat ends that follow the hierarchy nothing could be proven.
#[test]
fn what_is_flat_is_optimised_with_proof() {
    let mesh = peg(16);
    let plain = exact(&mesh, &Loop, &within(2e-3)).unwrap();
    let optimised = exact(&mesh, &Loop, &within(2e-3).finish(Finish::Collapsed)).unwrap();
    optimised.mesh.validate().unwrap();
    at_most!(optimised.mesh.face_count(), plain.mesh.face_count());
    assert!(optimised.error.upper <= 2e-3);
    let reference = limit_reference(&mesh, &Loop, 6).unwrap();
    let sampled = sampled(&optimised.mesh, &reference, 50_000);
    // The reference's own chords leave the rims by less than this.
    at_most!(sampled, optimised.error.upper + 2e-5);
}

/// Planes in files of single precision are planes, and nothing curved is taken for one.
#[test]
fn rounded_coordinates_are_flat_and_curved_ones_are_not() {
    let mesh = peg(16);
    let rounded = mapped(&mesh, |p| p.map(|x| f64::from(x as f32)));
    let options = within(1e-3);
    let [exactly, single] = [&mesh, &rounded].map(|mesh| exact(mesh, &Loop, &options).unwrap());
    assert!(single.mesh.face_count() <= exactly.mesh.face_count() + 20);
    assert!(single.error.upper <= 1e-3);
    // Half a unit in the last place of single precision, in each coordinate of what spans a plane and is off it.
    below!(exactly.statistics.off_planes, 1e-12);
    assert!((1e-9..1e-6).contains(&single.statistics.off_planes));
    // One vertex of an end off its plane by less than a thousandth: it is in the ring of all that meet at the fan's tip.
    let axis = [0, 1, 2].map(|i| (mesh.positions()[16][i] - mesh.positions()[0][i]) / 3.0);
    let mut positions = mesh.positions().to_vec();
    positions[21] = [0, 1, 2].map(|i| positions[21][i] + 5e-4 * axis[i]);
    let bent = mesh.clone().with_positions(positions).unwrap();
    let [merged, kept] =
        [true, false].map(|flat| exact(&bent, &Loop, &within(1e-3).flat_regions(flat)).unwrap());
    let [(count, area), (same, as_large)] = [&merged, &kept].map(|result| facing(result, axis));
    // Triangles in one plane are put together, but the end is none.
    let other = axis.map(|x| -x);
    let flat = facing(&merged, other).0;
    below!(10 * flat, count);
    at_most!(count, same);
    below!((area - as_large).abs(), 1e-4);
    assert!(flat < facing(&kept, other).0);
}

/// Separate planar squares, whose surfaces are bent along their boundaries alone: a number of triangles is used for these, and takes about as many
/// steps as a tolerance. It had begun with distances far below rounding.
#[test]
fn budgets_of_flat_faces_are_not_guessed_from_rounding() {
    let mut random = crate::support::Random::new(7);
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for card in 0..60u32 {
        let at = [0, 1, 2].map(|_| random.signed());
        let turn = TAU * random.signed();
        let (s, c) = turn.sin_cos();
        for (u, v) in [(0.0, 0.0), (0.2, 0.0), (0.2, 0.2), (0.0, 0.2)] {
            positions.push([at[0] + u * c, at[1] + u * s, at[2] + v]);
        }
        triangles
            .extend([[0, 1, 2], [0, 2, 3]].map(|corners| corners.map(|corner| 4 * card + corner)));
    }
    let mesh = Mesh::from_triangles(positions, triangles).unwrap();
    let mut rounds = 0;
    let mut before = f64::INFINITY;
    for number in [300, 1000, 3000] {
        let mut count = |progress: &limitmesh::progress::Progress| {
            if progress.stage == limitmesh::progress::Stage::Refining {
                rounds = rounds.max(progress.done);
            }
            core::ops::ControlFlow::Continue(())
        };
        let options = ExactOptions::default().triangles(number);
        let result = limitmesh::refine::exact_observed(&mesh, &Loop, &options, &mut count).unwrap();
        let count = result.mesh.face_count();
        at_most!(count, number);
        at_least!(count, 3 * number / 4);
        let own = exact(&mesh, &Loop, &within(result.error.upper)).unwrap();
        at_most!(own.mesh.face_count(), count, "{number}");
        assert!(result.error.upper < before, "{number}");
        before = result.error.upper;
    }
    assert!(rounds < 200, "{rounds}");
}

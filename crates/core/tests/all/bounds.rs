//! Proven bounds against the true distance, which the certified measurement of meshes finds by
//! other means: never below it; and without a goal for distances not far above it either, or not
//! reported.

#![allow(clippy::unwrap_used)]

use limitmesh::Mesh;
use limitmesh::criterion::{Camera, View, Viewpoint};
use limitmesh::measure::{Bvh, CertifiedOptions, SamplingOptions, hausdorff_between};
use limitmesh::progress::Progress;
use limitmesh::refine::limit_reference;
use limitmesh::refine::{Exact, ExactOptions, ExactStop, Finish, exact_observed};
use limitmesh::scheme::Loop;

use crate::support::{enclosed, exact, model, torus, within};

/// The greatest distance between a result and the limit surface, for which a mesh that is nearer to it stands.
fn true_distance(control: &Mesh, result: &Exact) -> (f64, f64) {
    let options = within(result.error.lower / 25.0).max_triangles(Some(400_000));
    let fine = exact(control, &Loop, &options).unwrap();
    let asked = CertifiedOptions::default().relative_gap(0.03);
    let found = enclosed(&result.mesh, &fine.mesh, &asked);
    let found = found.widened(fine.error.upper);
    (found.lower(), found.upper())
}

fn goals(control: &Mesh) -> Vec<(&'static str, ExactStop, ExactOptions)> {
    let diagonal = control.diagonal();
    let [low, high] = control.as_triangles().bounding_box().unwrap();
    let centre: [f64; 3] = std::array::from_fn(|i| 0.5 * (low[i] + high[i]));
    let eye = [
        centre[0] + 1.3 * diagonal,
        centre[1] + 0.4 * diagonal,
        centre[2] + 0.2 * diagonal,
    ];
    let up = [0.0, 0.0, 1.0];
    let camera = Camera {
        eye,
        target: centre,
        up,
        fov_degrees: 45.0,
        width: 960,
        height: 540,
    };
    let view = View {
        viewpoint: Viewpoint::Direction([0.0, 0.0, -1.0]),
        dilatation: 1.0,
    };
    let none = ExactOptions::default;
    vec![
        ("angle", ExactStop::Met, none().angle(10f64.to_radians())),
        (
            "angle in a view",
            ExactStop::Met,
            none().angle_seen(10f64.to_radians(), view),
        ),
        ("pixels", ExactStop::Met, none().pixels(0.5, vec![camera])),
        (
            "pixels and an angle",
            ExactStop::Met,
            none().pixels(0.5, vec![camera]).angle(20f64.to_radians()),
        ),
    ]
}

#[test]
fn bounds_are_near_the_truth_where_no_distance_was_asked_for() {
    let mut told = 0;
    for name in ["cup", "sphere", "sheet", "teddy"] {
        let control = model(name);
        for (goal, stop, options) in goals(&control) {
            let result = exact(&control, &Loop, &options).unwrap();
            assert_eq!(result.stop, stop, "{name}, {goal}");
            let (least, most) = true_distance(&control, &result);
            let error = result.error;
            assert!(error.certified, "{name}, {goal}");
            at_most!(error.lower, most, "{name}, {goal}");
            at_most!(least, error.upper, "{name}, {goal}");
            told += usize::from(error.upper.is_finite());
            // A loose bound is not reported.
            assert!(
                error.upper <= 1.25 * most || error.upper == f64::INFINITY,
                "{name}, {goal}: {error:?}, in truth {least} to {most}"
            );
        }
    }
    // But some are.
    assert!(told >= 3, "{told}");
}

/// Whatever ended the refinement, the greatest distance that dense samples find to a mesh of
/// uniform refinement, which knows nothing of the engine, is at most a quarter below what is
/// proven, or a half where that is a tolerance, except for the errors of that mesh and the samples.
#[test]
fn bounds_are_near_the_truth_whatever_ended_the_refinement() {
    let sharp = |name: &str, degrees: f64| {
        model(name)
            .with_creases_above(degrees.to_radians())
            .unwrap()
    };
    let models = [
        ("cup", model("cup"), 5),
        ("bunny", model("bunny"), 4),
        ("spike", model("spike"), 5),
        ("torus with creases", sharp("torus", 20.0), 5),
        ("cube with creases", sharp("cube", 30.0), 7),
        ("head with creases", sharp("head", 40.0), 5),
    ];
    for (name, control, levels) in models {
        let reference = limit_reference(&control, &Loop, levels).unwrap();
        let finer = limit_reference(&control, &Loop, levels + 1).unwrap();
        let tree = Bvh::new(reference.as_triangles()).unwrap();
        let step = finer.positions().len().div_ceil(20_000);
        let chords = finer
            .positions()
            .iter()
            .step_by(step)
            .map(|&p| tree.closest(p).distance)
            .fold(0.0, f64::max);
        let diagonal = control.diagonal();
        let within = |share: f64| within(share * diagonal);
        let budget = ExactOptions::default().triangles(3 * control.face_count());
        let goals = [
            ("a tolerance", within(1e-2)),
            (
                "a tolerance and an angle",
                within(2e-2).angle(8f64.to_radians()),
            ),
            ("balance", within(5e-3).finish(Finish::Balanced)),
            ("collapses", within(5e-3).finish(Finish::Collapsed)),
            (
                "hierarchies in flat regions",
                within(5e-3).flat_regions(false),
            ),
            ("a number", budget.clone()),
            ("a balanced number", budget.clone().finish(Finish::Balanced)),
            ("a collapsed number", budget.finish(Finish::Collapsed)),
        ];
        for (goal, options) in goals {
            let result = exact(&control, &Loop, &options).unwrap();
            let output = Bvh::new(result.mesh.as_triangles()).unwrap();
            let samples = SamplingOptions::default().samples(60_000);
            let found = hausdorff_between(&output, &tree, &samples).symmetric();
            let error = result.error;
            // The reference's chords leave the surface by 4/3 of the next level's distance in the end.
            let chords = 4.0 / 3.0 * chords;
            // A tolerance that is met is proven already.
            let is_met = options.goals.tolerance.is_some()
                && options.goals.angle.is_none()
                && options.finish != Finish::Collapsed;
            let times = if is_met { 2.0 } else { 1.25 };
            assert!(
                found <= error.upper + chords
                    && error.upper <= times * 1.02 * (found + chords).max(1e-6 * diagonal),
                "{name}, {goal}: {error:?}, samples find {found}, give or take {chords}"
            );
            let at = [&output, &tree].map(|of| of.closest(error.at).distance);
            at_most!(error.lower, at[0].max(at[1]) + chords, "{name}, {goal}");
        }
    }
}

/// Where levels end the division the undivided rest is bounded, too: samples never find more than
/// the upper bound, except for the error of the mesh that approximates the limit surface.
#[test]
fn bounds_hold_where_levels_end_the_division() {
    for name in [
        "torus",
        "sphere",
        "cup",
        "bunny",
        "spike",
        "bumpy",
        "head",
        "cube",
        "tetrahedron",
    ] {
        let control = model(name);
        for levels in [0, 1, 2] {
            // Its chords are a 64th as high as the result's.
            let reference = limit_reference(&control, &Loop, levels + 3).unwrap();
            let reference = Bvh::new(reference.as_triangles()).unwrap();
            let options = within(1e-6 * control.diagonal()).max_levels(levels);
            let result = exact(&control, &Loop, &options).unwrap();
            assert_eq!(result.stop, ExactStop::LevelCap, "{name}");
            let samples = SamplingOptions::default().samples(10_000);
            let output = Bvh::new(result.mesh.as_triangles()).unwrap();
            let found = hausdorff_between(&output, &reference, &samples).symmetric();
            at_most!(found, 1.01 * result.error.upper, "{name}, {levels} levels");
        }
    }
}

/// The certified measurement against a mesh much nearer to the limit surface shares nothing with the engine's bounds but that
/// mesh's. `--nocapture` shows how near both come.
#[test]
fn the_certified_measurement_agrees_with_what_is_proven() {
    let names = [
        "head", "shoe", "bunny", "teddy", "shark", "cup", "radish", "cusp", "sphere", "torus",
    ];
    for name in names {
        let control = model(name);
        for share in [1e-2, 3e-3, 1e-3] {
            let tolerance = share * control.diagonal();
            let result = exact(&control, &Loop, &within(tolerance)).unwrap();
            assert_eq!(result.stop, ExactStop::Met, "{name}, {share}");
            let (least, most) = true_distance(&control, &result);
            let error = result.error;
            println!(
                "{name:7} {share:5}: {:6} triangles, proven {:.3} to {:.3}, measured {:.3} to {:.3} of the tolerance: {:.3}",
                result.mesh.face_count(),
                error.lower / tolerance,
                error.upper / tolerance,
                least / tolerance,
                most / tolerance,
                error.upper / most
            );
            assert!(error.certified, "{name}, {share}");
            at_most!(error.upper, tolerance, "{name}, {share}");
            at_most!(least, error.upper, "{name}, {share}");
            at_most!(error.lower, most, "{name}, {share}");
        }
    }
}

/// With fewer triangles than it takes to prove a tolerance triangle by triangle, or fewer levels, it may be met all the same, as the whole is
/// measured anew: then that is why the refinement ended.
#[test]
fn tolerances_that_are_proven_are_met_whatever_ended_the_division() {
    let (mut met, mut missed) = (0, 0);
    for name in ["cup", "torus", "bunny", "sheet"] {
        let control = model(name);
        for share in [0.01, 0.004] {
            let tolerance = share * control.diagonal();
            let options = within(tolerance);
            let count = exact(&control, &Loop, &options).unwrap().mesh.face_count();
            let caps = [0.97, 0.9, 0.8, 0.5].map(|part| Some((part * count as f64) as usize));
            let capped = caps.map(|most| options.clone().max_triangles(most));
            for options in capped.into_iter().chain([options.clone().max_levels(1)]) {
                let found = exact(&control, &Loop, &options).unwrap();
                let is_proven = found.error.upper <= tolerance;
                assert_eq!(
                    found.stop == ExactStop::Met,
                    is_proven,
                    "{name} {share}: {:?}",
                    found.error
                );
                assert_eq!(
                    found.statistics.worst <= 1.0,
                    is_proven,
                    "{name} {share}: {}",
                    found.statistics.worst
                );
                if is_proven {
                    let (least, _) = true_distance(&control, &found);
                    assert!(least <= tolerance, "{name} {share}: {least}");
                }
                *(if is_proven { &mut met } else { &mut missed }) += 1;
            }
        }
    }
    assert!(met > 5 && missed > 5, "{met}, {missed}");
}

/// A vertex that a damaged coordinate moves far away draws its faces out to needles. No mesh of hundreds of times as many triangles is
/// made to prove more about them.
#[test]
fn one_far_vertex_takes_no_finer_meshes() {
    let plain = torus(20, 10);
    for far in [1e4, 1e6, 1e9] {
        let mut positions = plain.positions().to_vec();
        positions[0] = [0.0, 0.0, far];
        let control = plain.clone().with_positions(positions).unwrap();
        for share in [1e-2, 1e-3] {
            let tolerance = share * control.diagonal();
            let options = within(tolerance);
            let mut most = 0;
            let mut watch = |progress: &Progress| {
                most = most.max(progress.triangles);
                core::ops::ControlFlow::Continue(())
            };
            let found = exact_observed(&control, &Loop, &options, &mut watch).unwrap();
            let count = found.mesh.face_count();
            at_most!(most, 4 * count, "{far}, {share}");
            // The proven bound holds: dense samples of the true surface find no more.
            let reference = limit_reference(&control, &Loop, 5).unwrap();
            let output = Bvh::new(found.mesh.as_triangles()).unwrap();
            let sampled = reference
                .positions()
                .iter()
                .map(|&p| output.closest(p).distance)
                .fold(0.0, f64::max);
            at_most!(found.error.upper, tolerance, "{far}, {share}");
            at_most!(sampled, found.error.upper, "{far}, {share}");
        }
    }
}

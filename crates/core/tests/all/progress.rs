//! Every long function of the library reports progress to an observer, gives the result that it
//! gives unobserved, and ends when the observer breaks.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::ops::ControlFlow;

use crate::support::*;
use limitmesh::Mesh;
use limitmesh::criterion::{Camera, LimitNormal};
use limitmesh::interpolate::{
    InterpolateError, InterpolateOptions, interpolate, interpolate_observed,
};
use limitmesh::measure::*;
use limitmesh::progress::{Observer, Progress, Stage};
use limitmesh::refine::{
    ExactOptions, Finish, Frame, RefineError, Replay, ReplayError, StepwiseOptions, UniformOptions,
    exact, exact_estimate, exact_estimate_observed, exact_observed, limit_reference, stepwise,
    stepwise_observed, uniform, uniform_observed,
};
use limitmesh::scheme::Loop;

/// Runs a function to its end and checks its reports, then cancels it at the first, third, … call.
fn watch<T: PartialEq + std::fmt::Debug, E: std::fmt::Debug>(
    name: &str,
    unobserved: T,
    is_cancelled: impl Fn(&E) -> bool,
    mut run: impl FnMut(&mut Observer<'_>) -> Result<T, E>,
) {
    let mut told: Vec<Progress> = Vec::new();
    let observed = run(&mut |progress: &Progress| {
        told.push(*progress);
        ControlFlow::Continue(())
    });
    assert_eq!(observed.unwrap(), unobserved, "{name}");
    assert!(
        told.iter()
            .all(|p| p.total.is_none_or(|total| p.done <= total)),
        "{name}: more than all is done"
    );
    assert!(told.iter().any(|p| p.triangles > 0), "{name}: no triangles");
    for run in told.chunk_by(|a, b| (a.stage, a.total) == (b.stage, b.total)) {
        assert!(
            run.windows(2)
                .all(|pair| pair[0].done <= pair[1].done || pair[1].done == 0),
            "{name}"
        );
    }
    // How often it is called depends on how the threads share the work; fewer than ten times would be seldom.
    assert!(told.len() >= 10, "{name}: called {} times", told.len());
    for last in [1, 2, 5, 10] {
        let mut calls = 0;
        let result = run(&mut |_: &Progress| {
            calls += 1;
            if calls < last {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        });
        assert!(
            result.as_ref().is_err_and(&is_cancelled),
            "{name}: {result:?} after {last} calls"
        );
        assert_eq!(calls, last, "{name}: called again after it said stop");
    }
}

fn sphere(levels: usize) -> Mesh {
    limit_reference(&octahedron(), &Loop, levels).unwrap()
}

#[test]
fn refinement_is_observed() {
    let cancelled = |error: &RefineError| matches!(error, RefineError::Cancelled(_));
    let options = UniformOptions::default().levels(6).limit(true);
    let points = |refinement: limitmesh::refine::Refinement| refinement.mesh.positions().to_vec();
    let plain = points(uniform(&octahedron(), &Loop, &options).unwrap());
    watch("uniform", plain, cancelled, |o| {
        uniform_observed(&octahedron(), &Loop, &options, o).map(points)
    });

    let options = StepwiseOptions::default().levels(6);
    let criterion = LimitNormal::new(0.02);
    let plain = points(stepwise(&octahedron(), &Loop, &criterion, &options).unwrap());
    watch("stepwise", plain, cancelled, |o| {
        stepwise_observed(&octahedron(), &Loop, &criterion, &options, o).map(points)
    });
}

#[test]
fn replays_are_observed() {
    let cancelled = |error: &ReplayError| matches!(error, ReplayError::Cancelled(_));
    let control = model("bunny");
    let options = within(1e-3 * control.diagonal()).flat_regions(false);
    let refined = exact(&control, &Loop, &options).unwrap();
    let points = |replay: Replay| {
        let mut frame = Frame::default();
        replay
            .frame(control.positions(), &mut frame)
            .map(|()| frame)
    };
    let plain = Replay::new(&control, &Loop, &refined)
        .and_then(points)
        .unwrap();
    watch("replay", plain, cancelled, |o| {
        Replay::new_observed(&control, &Loop, &refined, o).and_then(points)
    });
}

#[test]
fn interpolation_is_observed() {
    let cancelled = |error: &InterpolateError| matches!(error, InterpolateError::Cancelled(_));
    let mesh = sphere(4);
    for within in [0.0, 1e-3] {
        let options = InterpolateOptions::default().within(within);
        let plain = interpolate(&mesh, &Loop, &options).unwrap();
        watch("interpolate", plain, cancelled, |o| {
            interpolate_observed(&mesh, &Loop, &options, o)
        });
    }
}

#[test]
fn measurement_is_observed() {
    let (coarse, fine) = (sphere(3), sphere(5));
    let (a, b) = (coarse.as_triangles(), fine.as_triangles());
    let cancelled = |error: &MeasureError| matches!(error, MeasureError::Cancelled(_));

    let options = SamplingOptions::default().samples(20_000);
    let plain = hausdorff(a, b, &options).unwrap();
    watch("hausdorff", plain, cancelled, |o| {
        hausdorff_observed(a, b, &options, o)
    });

    let options = CertifiedOptions::default();
    let plain = certified_hausdorff(a, b, &options).unwrap();
    watch("certified", plain, cancelled, |o| {
        certified_hausdorff_observed(a, b, &options, o)
    });

    let plain = distances_to(fine.positions(), a).unwrap();
    watch("distances", plain, cancelled, |o| {
        distances_to_observed(fine.positions(), a, o)
    });
}

#[test]
fn watertightness_is_observed() {
    // Open at one face, so that T-junctions are looked for as well.
    let fine = sphere(6);
    let open = surface(fine.positions(), &fine.triangles()[1..]);
    let plain = watertightness(open);
    assert_eq!(plain.boundary_edges, 3);
    watch(
        "watertightness",
        plain,
        |_| true,
        |o| watertightness_observed(open, o),
    );
}

/// A stage, its rounds, and triangles.
type Event = (Stage, usize, usize);

/// The reports of a run without their frequency, which depends on how threads share the work:
/// stages, rounds, triangles.
fn event(told: &Progress) -> Event {
    (
        told.stage,
        if told.stage == Stage::Refining {
            told.done
        } else {
            0
        },
        told.triangles,
    )
}

/// A run, and how often each event was reported, in order.
fn calls_by_event<T: std::fmt::Debug>(
    run: &mut impl FnMut(&mut Observer<'_>) -> Result<T, RefineError>,
) -> (T, Vec<(Event, usize)>) {
    let mut calls: Vec<(Event, usize)> = Vec::new();
    let result = run(&mut |told: &Progress| {
        assert!(
            told.total.is_none_or(|total| told.done <= total),
            "more than all is done: {told:?}"
        );
        match calls.last_mut() {
            Some((last, count)) if *last == event(told) => *count += 1,
            _ => calls.push((event(told), 1)),
        }
        ControlFlow::Continue(())
    });
    (result.unwrap(), calls)
}

/// Cancels a run at a call within an event, both counted from 0, and checks that this is the end of it.
fn cancel_at<T: std::fmt::Debug>(
    name: &str,
    (last_event, last_call): (usize, usize),
    run: &mut impl FnMut(&mut Observer<'_>) -> Result<T, RefineError>,
) {
    let (mut at, mut calls, mut is_over, mut known) = (0, 0, false, None);
    let result = run(&mut |told: &Progress| {
        assert!(!is_over, "{name}: called again after it said stop");
        match known.replace(event(told)) {
            Some(last) if last == event(told) => calls += 1,
            Some(_) => (at, calls) = (at + 1, 0),
            None => {}
        }
        is_over = at == last_event && calls == last_call;
        if is_over {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    let is_cancelled = matches!(result, Err(RefineError::Cancelled(_)));
    assert!(
        is_over && is_cancelled,
        "{name}: call {last_call} of event {last_event}"
    );
}

/// Every goal of exact refinement gives the same bytes observed, and ends wherever in its course the observer says so.
#[test]
fn exact_refinement_is_observed_and_cancelled_everywhere() {
    let options = ExactOptions::default;
    for name in ["cup", "sheet", "cube"] {
        let control = model(name);
        let eye = [0.3, 0.2, 3.0].map(|x| x * control.diagonal());
        let (target, up) = ([0.0; 3], [0.0, 1.0, 0.0]);
        let camera = Camera {
            eye,
            target,
            up,
            fov_degrees: 40.0,
            width: 640,
            height: 480,
        };
        let within = options().tolerance(3e-3 * control.diagonal());
        let goals = [
            ("tolerance", within.clone()),
            ("balance", within.clone().finish(Finish::Balanced)),
            ("optimise", within.finish(Finish::Collapsed)),
            (
                "triangles",
                options().triangles(4 * control.face_count() + 100),
            ),
            ("angle", options().angle(0.2)),
            ("pixels", options().pixels(1.0, vec![camera])),
        ];
        for (goal, options) in goals {
            let name = format!("{name}, {goal}");
            let plain = exact(&control, &Loop, &options).unwrap();
            let mut run =
                |observer: &mut Observer<'_>| exact_observed(&control, &Loop, &options, observer);
            let (watched, calls) = calls_by_event(&mut run);
            assert_eq!(
                (&watched.mesh, &watched.normals),
                (&plain.mesh, &plain.normals),
                "{name}"
            );
            assert_eq!(watched.error, plain.error, "{name}");
            assert!(calls.len() >= 5, "{name}: {calls:?}");
            // On one thread every run makes the same calls: with several, how many fall between two steps is chance.
            pool(1).install(|| {
                let (_, calls) = calls_by_event(&mut run);
                for i in 0..8 {
                    cancel_at(&name, (i * (calls.len() - 1) / 7, 0), &mut run);
                }
            });
        }
    }
}

/// Also where very few faces are divided very deeply, the observer is called in proportion to the work, in each stage, and is heard
/// in the middle of a face. Calls at the ends of blocks of faces would be a dozen. On one thread every run makes the same calls.
#[test]
fn single_faces_that_take_long_are_observed() {
    pool(1).install(|| {
        let control = model("tetrahedron");
        let balanced = ExactOptions::default()
            .tolerance(3e-6 * control.diagonal())
            .finish(Finish::Balanced);
        for options in [balanced.clone().finish(Finish::OnSurface), balanced] {
            let mut run =
                |observer: &mut Observer<'_>| exact_observed(&control, &Loop, &options, observer);
            let (result, calls) = calls_by_event(&mut run);
            let triangles = result.mesh.face_count();
            assert!(triangles > 100_000);
            // Only what is balanced is bounded all over again.
            let bounded = (options.finish == Finish::Balanced).then_some(Stage::Bounding);
            for stage in [Stage::Refining, Stage::Assembling]
                .into_iter()
                .chain(bounded)
            {
                let count: usize = calls
                    .iter()
                    .filter(|(event, _)| event.0 == stage)
                    .map(|(_, n)| n)
                    .sum();
                at_least!(count, triangles / 10_000, "{stage:?}");
            }
            let mut most: Vec<(usize, usize)> =
                calls.iter().map(|(_, count)| *count).enumerate().collect();
            most.sort_by_key(|&(_, count)| std::cmp::Reverse(count));
            for &(i, count) in most.iter().take(4) {
                cancel_at("tetrahedron", (i, count / 2), &mut run);
            }
        }
    });
}

/// Flat faces with very many vertices inside are triangulated as one, which can be cancelled at any
/// time.
#[test]
fn large_flat_regions_are_observed() {
    pool(1).install(|| {
        const SIDE: u32 = 150;
        let place = |i: u32| [f64::from(i % SIDE), f64::from(i / SIDE), 0.0];
        let plate =
            Mesh::from_triangles((0..SIDE * SIDE).map(place).collect(), grid(SIDE, SIDE)).unwrap();
        let options = within(1e-4 * plate.diagonal()).unfold(true);
        let mut run =
            |observer: &mut Observer<'_>| exact_observed(&plate, &Loop, &options, observer);
        let (result, calls) = calls_by_event(&mut run);
        let triangles = result.mesh.face_count();
        assert!(triangles > plate.face_count());
        let of_stage = |stage| {
            calls
                .iter()
                .filter(move |(event, _)| event.0 == stage)
                .map(|(_, count)| count)
        };
        let count: usize = of_stage(Stage::Assembling).sum();
        at_least!(count, triangles / 100);
        for (i, &(_, count)) in calls.iter().enumerate() {
            (0..count)
                .step_by(count / 12 + 1)
                .for_each(|at| cancel_at("plate", (i, at), &mut run));
        }
    });
}

/// On one thread, where every run makes the same calls: with several, how many of them fall between two steps is chance.
#[test]
fn estimates_are_observed() {
    pool(1).install(|| {
        let control = model("cup");
        let tolerance = within(5e-4 * control.diagonal());
        for options in [tolerance.clone(), tolerance.finish(Finish::Collapsed)] {
            let plain = exact_estimate(&control, &Loop, &options).unwrap();
            let mut run = |observer: &mut Observer<'_>| {
                exact_estimate_observed(&control, &Loop, &options, observer)
            };
            let (watched, calls) = calls_by_event(&mut run);
            assert_eq!(watched, plain);
            for i in [0, calls.len() / 2, calls.len() - 1] {
                cancel_at("estimate", (i, 0), &mut run);
            }
        }
    });
}

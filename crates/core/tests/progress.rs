//! Every long function of the library tells an observer how it goes on, gives what it gives unobserved, and ends when the
//! observer says so.

#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use std::ops::ControlFlow;

use limitmesh::criterion::LimitNormal;
use limitmesh::measure::*;
use limitmesh::progress::{Observer, Progress};
use limitmesh::refine::{
    RefineError, StepwiseOptions, UniformOptions, stepwise, stepwise_observed, uniform, uniform_observed,
};
use limitmesh::scheme::Loop;
use limitmesh::{Mesh, Triangles};
use support::*;

/// Runs a function to its end and looks at what it tells, then cancels it at the first, third, … call.
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
        told.iter().all(|p| p.total.is_none_or(|total| p.done <= total)),
        "{name}: more than all is done"
    );
    assert!(told.iter().any(|p| p.triangles > 0), "{name}: no triangles");
    for run in told.chunk_by(|a, b| (a.stage, a.total) == (b.stage, b.total)) {
        assert!(run.windows(2).all(|pair| pair[0].done <= pair[1].done || pair[1].done == 0), "{name}");
    }
    // How often it is called depends on how the threads share the work; fewer than ten times would be seldom.
    assert!(told.len() >= 10, "{name}: called {} times", told.len());
    for last in [1, 2, 5, 10] {
        let mut calls = 0;
        let result = run(&mut |_: &Progress| {
            calls += 1;
            if calls < last { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        assert!(result.as_ref().is_err_and(&is_cancelled), "{name}: {result:?} after {last} calls");
        assert_eq!(calls, last, "{name}: called again after it said stop");
    }
}

fn sphere(levels: usize) -> Mesh {
    uniform(&octahedron(), &Loop, &UniformOptions::default().levels(levels).limit(true)).unwrap().mesh
}

#[test]
fn refinement_is_observed() {
    let cancelled = |error: &RefineError| matches!(error, RefineError::Cancelled(_));
    let options = UniformOptions::default().levels(6).limit(true);
    let points = |refinement: limitmesh::refine::Refinement| refinement.mesh.positions().to_vec();
    let plain = points(uniform(&octahedron(), &Loop, &options).unwrap());
    watch("uniform", plain, cancelled, |o| uniform_observed(&octahedron(), &Loop, &options, o).map(points));

    let options = StepwiseOptions::default().levels(6);
    let criterion = LimitNormal::new(0.02);
    let plain = points(stepwise(&octahedron(), &Loop, &criterion, &options).unwrap());
    watch("stepwise", plain, cancelled, |o| {
        stepwise_observed(&octahedron(), &Loop, &criterion, &options, o).map(points)
    });
}

#[test]
fn measurement_is_observed() {
    let (coarse, fine) = (sphere(3), sphere(5));
    let (a, b) = (coarse.as_triangles(), fine.as_triangles());
    let cancelled = |error: &MeasureError| matches!(error, MeasureError::Cancelled(_));

    let options = SamplingOptions::default().samples(20_000);
    let plain = hausdorff(a, b, &options).unwrap();
    watch("hausdorff", plain, cancelled, |o| hausdorff_observed(a, b, &options, o));

    let options = CertifiedOptions::default();
    let plain = certified_hausdorff(a, b, &options).unwrap();
    watch("certified", plain, cancelled, |o| certified_hausdorff_observed(a, b, &options, o));

    let plain = distances_to(fine.positions(), a).unwrap();
    watch("distances", plain, cancelled, |o| distances_to_observed(fine.positions(), a, o));
}

#[test]
fn watertightness_is_observed() {
    // Open at one face, so that T-junctions are looked for as well.
    let fine = sphere(6);
    let open = Triangles { positions: fine.positions(), triangles: &fine.triangles()[1..] };
    let plain = watertightness(open);
    assert_eq!(plain.boundary_edges, 3);
    watch("watertightness", plain, |_| true, |o| watertightness_observed(open, o));
}

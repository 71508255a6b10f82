//! The greatest time between two calls of the observer, from the last one to the end, and from its saying stop to the end: each
//! should be below a tenth of a second, on any input.

use core::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result, ensure};
use limitmesh::Mesh;
use limitmesh::criterion::Camera;
use limitmesh::measure::{
    Bvh, CertifiedOptions, SamplingOptions, certified_hausdorff_between_observed,
    hausdorff_observed, watertightness_observed,
};
use limitmesh::progress::{Observer, Progress};
use limitmesh::refine::{
    ExactOptions, Finish, StepwiseOptions, UniformOptions, exact_estimate_observed, exact_observed,
    stepwise_observed, uniform_observed,
};
use limitmesh::scheme::Loop;

use crate::mesh;

/// Places in the course of a run at which it is cancelled.
const CANCELLED: usize = 5;

/// A long function.
type Work<'a> = dyn Fn(&mut Observer<'_>) -> Result<()> + 'a;

/// Prints the gaps of all long functions that refine and measure.
pub(crate) fn gaps(folder: &Path) -> Result<()> {
    println!(
        "work                                      seconds     calls   ms between calls   ms to the end once stopped"
    );
    let [canyon, bunny] =
        ["gcanyon_530k.ply", "bunny_3674.obj"].map(|name| mesh(&folder.join(name)));
    let (canyon, bunny) = (canyon?, bunny?);
    let cup = limitmesh_models::find("cup").context("the cup is built in")?;
    let (cup, _) = Mesh::from_soup(&cup.soup(), &Default::default())?;
    let within = |mesh: &Mesh, percent: f64| {
        ExactOptions::default().tolerance(0.01 * percent * mesh.diagonal())
    };
    let jobs = [
        ("canyon within 0.1 %", &canyon, within(&canyon, 0.1)),
        ("canyon within 0.001 %", &canyon, within(&canyon, 0.001)),
        ("cup within 0.0001 %", &cup, within(&cup, 0.0001)),
        ("bunny within 0.001 %", &bunny, within(&bunny, 0.001)),
        (
            "bunny within 0.01 %, balanced",
            &bunny,
            within(&bunny, 0.01).finish(Finish::Balanced),
        ),
        (
            "bunny with 200,000 triangles",
            &bunny,
            ExactOptions::default().triangles(200_000),
        ),
        (
            "canyon with 2,000,000 triangles",
            &canyon,
            ExactOptions::default().triangles(2_000_000),
        ),
        (
            "bunny within 0.05 %, optimised",
            &bunny,
            within(&bunny, 0.05).finish(Finish::Collapsed),
        ),
        (
            "bunny at 1 degree",
            &bunny,
            ExactOptions::default().angle(1f64.to_radians()),
        ),
        (
            "bunny at a tenth of a pixel",
            &bunny,
            ExactOptions::default().pixels(0.1, vec![camera(&bunny)]),
        ),
    ];
    for (name, control, options) in &jobs {
        gap(name, &|observer| {
            Ok(exact_observed(control, &Loop, options, observer).map(|_| ())?)
        })?;
    }
    let options = within(&bunny, 0.01).finish(Finish::Collapsed);
    gap("bunny, an estimate", &|observer| {
        Ok(exact_estimate_observed(&bunny, &Loop, &options, observer).map(|_| ())?)
    })?;
    let options = UniformOptions::default()
        .levels(5)
        .limit(true)
        .normals(true);
    gap("bunny, uniform, 5 levels", &|observer| {
        Ok(uniform_observed(&bunny, &Loop, &options, observer).map(|_| ())?)
    })?;
    let options = StepwiseOptions::default().levels(3);
    let criterion = limitmesh::criterion::LimitNormal::new(0.01);
    gap("canyon, stepwise, 3 levels", &|observer| {
        Ok(stepwise_observed(&canyon, &Loop, &criterion, &options, observer).map(|_| ())?)
    })?;
    measurements(&bunny, &canyon)
}

/// Distances between a mesh and a finer one, and what else is measured.
fn measurements(bunny: &Mesh, canyon: &Mesh) -> Result<()> {
    let fine = limitmesh::refine::limit_reference(bunny, &Loop, 4)?;
    let (a, b) = (bunny.as_triangles(), fine.as_triangles());
    gap("bunny, sampled distances", &|observer| {
        Ok(hausdorff_observed(
            a,
            b,
            &SamplingOptions::default().samples(1_000_000),
            observer,
        )
        .map(|_| ())?)
    })?;
    gap("bunny, certified distances", &|observer| {
        let (surface, reference) = (
            Bvh::new_observed(a, observer)?,
            Bvh::new_observed(b, observer)?,
        );
        let options = CertifiedOptions::default();
        Ok(
            certified_hausdorff_between_observed(&surface, &reference, &options, observer)
                .map(|_| ())?,
        )
    })?;
    gap("canyon, watertight", &|observer| {
        Ok(watertightness_observed(canyon.as_triangles(), observer).map(|_| ())?)
    })
}

fn camera(mesh: &Mesh) -> Camera {
    let eye = [0.0, 0.0, 2.0 * mesh.diagonal()];
    Camera {
        eye,
        target: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        fov_degrees: 40.0,
        width: 1920,
        height: 1080,
    }
}

/// Runs to the end once, and then to some places on the way.
fn gap(name: &str, work: &Work<'_>) -> Result<()> {
    let (mut calls, mut greatest) = (0usize, 0.0f64);
    let start = Instant::now();
    let mut last = start;
    work(&mut |_: &Progress| {
        let now = Instant::now();
        greatest = greatest.max((now - last).as_secs_f64());
        (calls, last) = (calls + 1, now);
        ControlFlow::Continue(())
    })?;
    let (whole, greatest) = (
        start.elapsed().as_secs_f64(),
        greatest.max(last.elapsed().as_secs_f64()),
    );
    let mut slowest = 0.0f64;
    for place in 1..=CANCELLED {
        let stop = whole * (place as f64 - 0.5) / CANCELLED as f64;
        let (start, mut stopped) = (Instant::now(), None);
        let result = work(&mut |_: &Progress| {
            if start.elapsed().as_secs_f64() < stop {
                return ControlFlow::Continue(());
            }
            stopped = Some(Instant::now());
            ControlFlow::Break(())
        });
        if let Some(stopped) = stopped {
            ensure!(result.is_err(), "{name} went on to its end");
            slowest = slowest.max(stopped.elapsed().as_secs_f64());
        }
    }
    println!(
        "{name:40} {whole:8.2} {calls:9} {:18.1} {:28.1}",
        1e3 * greatest,
        1e3 * slowest
    );
    Ok(())
}

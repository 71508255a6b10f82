//! Exact refinement beside the paper's method at equal triangle counts.

use std::path::Path;

use anyhow::Result;
use limitmesh::Mesh;
use limitmesh::criterion::LimitNormal;
use limitmesh::refine::{ExactOptions, Finish, StepwiseOptions, exact, stepwise};
use limitmesh::scheme::Loop;

use super::cast::{Model, gather};
use super::judge::{Judge, Reference};
use super::table::{self, count, digits, median};

/// The angle at which the paper's method is run, in degrees.
const ANGLE: f64 = 10.0;

/// Finer control meshes give more triangles in four steps than the reference tells apart.
const MOST_FACES: usize = 12_000;

/// Three and four steps of the paper's method on every model; exact refinement with as many triangles.
pub(crate) fn against_paper(folder: &Path) -> Result<()> {
    println!(
        "\nexact refinement beside the paper's method ({ANGLE}°), equal triangle counts, distances in % of the diagonal"
    );
    let models = gather(folder, MOST_FACES)?;
    let mut rows = Vec::new();
    let mut ratios = [[Vec::new(), Vec::new()], [Vec::new(), Vec::new()]];
    for model in &models {
        let reference = Reference::new(&model.mesh)?;
        let judge = Judge::new(&reference)?;
        for (steps, ratios) in [3, 4].into_iter().zip(&mut ratios) {
            rows.push(row(model, &judge, steps, ratios)?);
        }
    }
    table::print(
        &[
            "model",
            "steps",
            "triangles",
            "paper",
            "exact",
            "balanced",
            "paper / exact",
            "paper / balanced",
        ],
        &rows,
    );
    for (steps, [plain, balanced]) in [3, 4].into_iter().zip(ratios.clone()) {
        println!(
            "\nmedian over {} models, {steps} steps: {} times lower, {} times with balance",
            models.len(),
            digits(median(plain)),
            digits(median(balanced))
        );
    }
    let all = |which: usize| median(ratios.iter().flat_map(|r| r[which].iter().copied()));
    println!(
        "\nmedian of both: {} and {}",
        digits(all(0)),
        digits(all(1))
    );
    Ok(())
}

fn row(
    model: &Model,
    judge: &Judge<'_>,
    steps: usize,
    ratios: &mut [Vec<f64>; 2],
) -> Result<Vec<String>> {
    let criterion = LimitNormal::new(ANGLE.to_radians());
    let options = StepwiseOptions::default().levels(steps);
    let paper = stepwise(&model.mesh, &Loop, &criterion, &options)?.mesh;
    let triangles = paper.face_count();
    let theirs = judge.distance(&paper)?;
    drop(paper);
    let ours = |finish| -> Result<f64> { judge.distance(&best(&model.mesh, triangles, finish)?) };
    let (plain, balanced) = (ours(Finish::OnSurface)?, ours(Finish::Balanced)?);
    ratios[0].push(theirs / plain);
    ratios[1].push(theirs / balanced);
    let mut row = vec![model.name.clone(), steps.to_string(), count(triangles)];
    row.extend([theirs, plain, balanced].map(|d| digits(judge.percent(d))));
    row.extend([theirs / plain, theirs / balanced].map(digits));
    Ok(row)
}

/// The best mesh with at most so many triangles.
pub(crate) fn best(control: &Mesh, triangles: usize, finish: Finish) -> Result<Mesh> {
    let options = ExactOptions::default().triangles(triangles).finish(finish);
    Ok(exact(control, &Loop, &options)?.mesh)
}

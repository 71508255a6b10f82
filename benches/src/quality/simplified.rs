//! Beside "five uniform levels, then simplified by quadrics", with MeshLab's and meshoptimizer's edge collapses.

use std::path::Path;

use anyhow::Result;
use limitmesh::refine::limit_reference;
use limitmesh::refine::{ExactOptions, exact};
use limitmesh::scheme::Loop;
use limitmesh::simplify::{Features, SimplifyOptions, simplify};

use super::cast::{Model, gather};
use super::judge::{Judge, Reference};
use super::table::{self, count, digits, median};
use crate::clock::one_thread;
use crate::peers::{self, Simplifier};

/// Triangles to which level 5 is simplified.
const TRIANGLES: [usize; 2] = [4_000, 16_000];

const LEVEL: usize = 5;

/// At level 5 a million triangles, of which MeshLab takes some ten seconds.
const MOST_FACES: usize = 1_000;

/// The optimised mesh is collapsed from one with so many times as many triangles.
const FINER: usize = 16;

/// Distances and seconds at equal counts.
pub(crate) fn against_simplified(folder: &Path) -> Result<()> {
    println!(
        "\nbeside level {LEVEL}, then quadric edge collapse: distances in % of the diagonal, processor seconds"
    );
    table::begin(&[
        "model",
        "triangles",
        "method",
        "distance",
        "seconds",
        "distance / exact",
        "distance / optimised",
        "seconds / exact",
        "seconds / optimised",
    ]);
    let mut distances = vec![Vec::new(); 2];
    let mut speeds = vec![Vec::new(); 2];
    for model in gather(folder, MOST_FACES)? {
        let reference = Reference::new(&model.mesh)?;
        let judge = Judge::new(&reference)?;
        compare(&model, &judge, &mut distances, &mut speeds)?;
    }
    if distances.iter().all(Vec::is_empty) {
        println!(
            "neither MeshLab nor meshoptimizer is installed (pip install pymeshlab meshoptimizer)"
        );
        return Ok(());
    }
    for (which, name) in Simplifier::ALL.iter().enumerate() {
        println!(
            "\n{}: median {} times the distance of exact refinement and {} times its time",
            name.name(),
            digits(median(distances[which].clone())),
            digits(median(speeds[which].clone()))
        );
    }
    Ok(())
}

fn compare(
    model: &Model,
    judge: &Judge<'_>,
    distances: &mut [Vec<f64>],
    speeds: &mut [Vec<f64>],
) -> Result<()> {
    let control = &model.mesh;
    let (subdividing, fine) = one_thread(|| limit_reference(control, &Loop, LEVEL))?;
    let fine = fine?;
    for triangles in TRIANGLES {
        if triangles <= control.face_count() {
            continue;
        }
        let (time, plain) = one_thread(|| {
            exact(
                control,
                &Loop,
                &ExactOptions::default().triangles(triangles),
            )
        })?;
        let plain = plain?.mesh;
        let (optimizing, optimized) = one_thread(|| {
            let finer = exact(
                control,
                &Loop,
                &ExactOptions::default().triangles(FINER * triangles),
            )?;
            let options = SimplifyOptions::default()
                .triangles(Some(triangles))
                .certify(false);
            Ok::<_, anyhow::Error>(simplify(&finer.mesh, &Features::default(), &options)?)
        })?;
        let optimized = optimized?.mesh;
        let ours = [
            (judge.distance(&plain)?, time.all),
            (judge.distance(&optimized)?, optimizing.all),
        ];
        for ((distance, seconds), name) in ours.into_iter().zip(["exact", "optimised"]) {
            let mut row = vec![model.name.clone(), count(triangles), name.to_owned()];
            row.extend([digits(judge.percent(distance)), digits(seconds)]);
            row.extend(["", "", "", ""].map(str::to_owned));
            table::print_row(&row);
        }
        for (which, simplifier) in Simplifier::ALL.into_iter().enumerate() {
            let Some(theirs) = peers::simplified(simplifier, &fine, triangles)? else {
                continue;
            };
            let distance = judge.distance(&theirs.mesh)?;
            let seconds = subdividing.all + theirs.seconds;
            distances[which].push(distance / ours[0].0);
            speeds[which].push(seconds / ours[0].1);
            let mut row = vec![
                model.name.clone(),
                count(theirs.mesh.face_count()),
                simplifier.name().to_owned(),
            ];
            row.extend([digits(judge.percent(distance)), digits(seconds)]);
            row.extend(ours.map(|(d, _)| digits(distance / d)));
            row.extend(ours.map(|(_, s)| digits(seconds / s)));
            table::print_row(&row);
        }
    }
    Ok(())
}

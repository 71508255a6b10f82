//! Refinement: output triangles per second, beside OpenSubdiv's uniform refinement.

use std::path::Path;

use anyhow::Result;
use limitmesh::criterion::LimitNormal;
use limitmesh::refine::{StepwiseOptions, UniformOptions};
use limitmesh::scheme::Loop;

use crate::{best_of, mesh, peers};

const REPEATS: usize = 5;

/// Uniform Loop refinement, levels 3 to 6.
pub(crate) fn uniform(model: &Path) -> Result<()> {
    let control = mesh(model)?;
    println!("uniform Loop of {}: million output triangles per second, best of {REPEATS}", name(model));
    println!(
        "level  triangles  1 thread  2 threads  gain  with limit positions, 1 thread  OpenSubdiv Far, 1 thread"
    );
    for level in 3..=6 {
        let run = |threads, limit| {
            best_of(REPEATS, threads, || {
                let options = UniformOptions::default().levels(level).limit(limit);
                limitmesh::refine::uniform(&control, &Loop, &options).map(|r| r.mesh.face_count())
            })
        };
        let (one, triangles) = run(1, false)?;
        let triangles = triangles?;
        let (two, _) = run(2, false)?;
        let (limit, _) = run(1, true)?;
        let rate = |seconds: f64| triangles as f64 / seconds / 1e6;
        let peer = match peers::opensubdiv_far(model, level, REPEATS)? {
            Some(seconds) => format!("{:.1} (ours is {:.2} times that)", rate(seconds), seconds / one),
            None => "not installed".into(),
        };
        println!(
            "{level:5}  {triangles:9}  {:8.1}  {:9.1}  {:4.2}  {:31.1}  {peer}",
            rate(one),
            rate(two),
            one / two,
            rate(limit)
        );
    }
    Ok(())
}

/// The paper's stepwise refinement: 4 steps at 5°, and longer work.
pub(crate) fn stepwise(model: &Path) -> Result<()> {
    let control = mesh(model)?;
    println!("\nstepwise limit-normal Loop of {}, best of {REPEATS}", name(model));
    for (levels, degrees) in [(4, 5.0f64), (7, 1.0)] {
        let criterion = LimitNormal::new(degrees.to_radians());
        let run = |threads| {
            best_of(REPEATS, threads, || {
                let options = StepwiseOptions::default().levels(levels);
                limitmesh::refine::stepwise(&control, &Loop, &criterion, &options)
                    .map(|r| r.mesh.face_count())
            })
        };
        let (one, triangles) = run(1)?;
        let (two, _) = run(2)?;
        let triangles = triangles?;
        let rate = |seconds: f64| triangles as f64 / seconds / 1e6;
        println!(
            "{levels} steps, {degrees}°: {triangles} triangles: {:.2} million a second on 1 thread, {:.2} on 2 (gain {:.2})",
            rate(one),
            rate(two),
            one / two
        );
    }
    Ok(())
}

fn name(model: &Path) -> String {
    model.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

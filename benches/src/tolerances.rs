//! Exact refinement of chosen models to chosen goals: triangles, and the processor time that they take. Programs built from two
//! commits, run in turn, tell what lies between these.

use std::path::Path;

use anyhow::{Context, Result, bail};
use limitmesh::Mesh;
use limitmesh::refine::{Exact, ExactOptions, Finish, RefineError, exact};
use limitmesh::scheme::Loop;

use crate::best_of;
use crate::clock::one_thread;

/// Runs of each goal where no number is given; the fastest counts.
const RUNS: usize = 4;

/// Prints a line for each `MODEL@PERCENT`, a tolerance in per cent of the diagonal, and `MODEL@n:COUNT`, a number of triangles;
/// MODEL is a file or built in. `--balance` moves vertices off the surface, `--runs K` takes the least of K runs. With `--threads N`
/// it prints seconds by the clock on the wall instead, of one thread and of N in turn, and how many times as fast these are.
pub(crate) fn tolerances(mut arguments: impl Iterator<Item = String>) -> Result<()> {
    let (mut finish, mut runs, mut threads, mut jobs) = (Finish::OnSurface, RUNS, None, Vec::new());
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--balance" => finish = Finish::Balanced,
            "--runs" => runs = arguments.next().context("--runs needs a number")?.parse()?,
            "--threads" => {
                threads = Some(
                    arguments
                        .next()
                        .context("--threads needs a number")?
                        .parse()?,
                )
            }
            _ => jobs.push(argument),
        }
    }
    if jobs.is_empty() {
        bail!(
            "name models and goals: cup@0.01 is within 0.01 % of the diagonal, cup@n:5000 has 5,000 triangles"
        );
    }
    match threads {
        None => {
            println!("model and goal                                       triangles          ms")
        }
        Some(threads) => println!(
            "model and goal                                       triangles  1 thread, ms  {threads} threads, ms  gain"
        ),
    }
    for job in &jobs {
        let (name, goal) = job
            .rsplit_once('@')
            .with_context(|| format!("no goal in {job}"))?;
        let control = model(name)?;
        let options = ExactOptions::default().finish(finish);
        let options = match goal.strip_prefix("n:") {
            Some(count) => options.triangles(count.parse()?),
            None => options.tolerance(0.01 * goal.parse::<f64>()? * control.diagonal()),
        };
        let run = || exact(&control, &Loop, &options);
        if let Some(threads) = threads {
            let (least, triangles) = in_turn(threads, runs, run)?;
            let [one, more] = least.map(|seconds| 1e3 * seconds);
            println!(
                "{job:50} {triangles:11} {one:13.1} {more:14.1} {:5.2}",
                one / more
            );
            continue;
        }
        let (mut least, mut triangles) = (f64::INFINITY, 0);
        for _ in 0..runs {
            let (seconds, result) = one_thread(run)?;
            (least, triangles) = (least.min(seconds.all), result?.mesh.face_count());
        }
        println!("{job:50} {triangles:11} {:11.1}", 1e3 * least);
    }
    Ok(())
}

/// The least seconds by the clock on the wall that one thread and so many take, and the triangles; in turns, so that a busy machine slows
/// both.
fn in_turn(
    threads: usize,
    runs: usize,
    run: impl Fn() -> Result<Exact, RefineError> + Sync,
) -> Result<([f64; 2], usize)> {
    let (mut least, mut triangles) = ([f64::INFINITY; 2], 0);
    for _ in 0..runs {
        for (threads, least) in [1, threads].into_iter().zip(&mut least) {
            let (seconds, result) = best_of(1, threads, &run)?;
            (*least, triangles) = (least.min(seconds), result?.mesh.face_count());
        }
    }
    Ok((least, triangles))
}

/// A model that is built in, or a file's.
fn model(name: &str) -> Result<Mesh> {
    match limitmesh_models::find(name) {
        Some(model) => Ok(Mesh::from_soup(&model.soup(), &Default::default())?.0),
        None => crate::mesh(Path::new(name)),
    }
}

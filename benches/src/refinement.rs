//! Refinement: output triangles per second, beside OpenSubdiv's uniform refinement.

use std::path::Path;

use anyhow::{Result, ensure};
use limitmesh::criterion::LimitNormal;
use limitmesh::refine::{StepwiseOptions, UniformOptions};
use limitmesh::scheme::{CatmullClark, Loop, Scheme};
use limitmesh::{Mesh, QuadControl};

use crate::clock::one_thread;
use crate::peers::{OpenSubdiv, opensubdiv};
use crate::{best_of, mesh};

const REPEATS: usize = 5;

/// Uniform refinement by Loop's scheme, levels 3 to 6.
pub(crate) fn uniform(model: &Path) -> Result<()> {
    by_scheme(model, &mesh(model)?, &Loop)
}

/// The same by Catmull and Clark's; the cage must be of quads alone.
pub(crate) fn uniform_quads(model: &Path) -> Result<()> {
    let cage = limitmesh_io::read(model)?;
    let quads = cage.faces.iter().all(|face| face.len() == 4);
    ensure!(quads, "{} is not of quads alone", name(model));
    let (control, _) = QuadControl::from_soup(&cage, &Default::default())?;
    by_scheme(model, &control.mesh, &CatmullClark)
}

fn by_scheme(model: &Path, control: &Mesh, scheme: &dyn Scheme) -> Result<()> {
    println!(
        "uniform {} of {}: million output triangles per second, best of {REPEATS}",
        scheme.name(),
        name(model)
    );
    println!("level  triangles  1 thread  2 threads  gain  OpenSubdiv Far, 1 thread");
    for level in 3..=6 {
        let run = |threads| {
            best_of(REPEATS, threads, || {
                let options = UniformOptions::default().levels(level);
                limitmesh::refine::uniform(control, scheme, &options).map(|r| r.mesh.face_count())
            })
        };
        let (one, triangles) = run(1)?;
        let triangles = triangles?;
        let (two, _) = run(2)?;
        let rate = |seconds: f64| triangles as f64 / seconds / 1e6;
        let peer = match opensubdiv(OpenSubdiv::Far, model, level, REPEATS)? {
            Some(seconds) => format!(
                "{:.1} (ours is {:.2} times that)",
                rate(seconds),
                seconds / one
            ),
            None => "not installed".into(),
        };
        println!(
            "{level:5}  {triangles:9}  {:8.1}  {:9.1}  {:4.2}  {peer}",
            rate(one),
            rate(two),
            one / two
        );
    }
    limits(model, control, scheme)
}

/// The same with all vertices on the limit surface and with their normals, by processor time on one thread, as triangles alone and as
/// a mesh with its connections; the gain of two threads by the clock.
fn limits(model: &Path, control: &Mesh, scheme: &dyn Scheme) -> Result<()> {
    println!(
        "\nthe same with limit positions: million triangles per processor second, best of {REPEATS}; triangles alone, as of the peer, \
         but for the mesh with connections"
    );
    println!(
        "level  triangles  positions  and normals  gain of 2 threads  normals and connections  OpenSubdiv Bfr, positions and normals"
    );
    for level in [4, 5] {
        let options = UniformOptions::default().levels(level).limit(true);
        let alone = |normals| {
            limitmesh::refine::uniform_triangles(control, scheme, &options.normals(normals))
                .map(|found| found.triangles.len())
        };
        let connected = || {
            limitmesh::refine::uniform(control, scheme, &options.normals(true))
                .map(|r| r.mesh.face_count())
        };
        let (mut least, mut triangles, mut peer) = ([f64::MAX; 3], 0, None::<f64>);
        // In turns, so that a busy machine slows all of them.
        for _ in 0..REPEATS {
            let runs = [
                one_thread(|| alone(false))?,
                one_thread(|| alone(true))?,
                one_thread(connected)?,
            ];
            for (least, (seconds, count)) in least.iter_mut().zip(runs) {
                (*least, triangles) = (least.min(seconds.all), count?);
            }
            let of_peer = opensubdiv(OpenSubdiv::Bfr, model, level, 1)?;
            peer = of_peer.map(|seconds| peer.unwrap_or(seconds).min(seconds));
        }
        let (one, _) = best_of(REPEATS, 1, || alone(true))?;
        let (two, _) = best_of(REPEATS, 2, || alone(true))?;
        let rate = |seconds: f64| triangles as f64 / seconds / 1e6;
        let [positions, normals, connected] = least;
        let peer = match peer {
            Some(seconds) => format!(
                "{:.2} (ours is {:.2} times that, {:.2} with connections)",
                rate(seconds),
                seconds / normals,
                seconds / connected
            ),
            None => "not installed".into(),
        };
        println!(
            "{level:5}  {triangles:9}  {:9.1}  {:11.1}  {:17.2}  {:23.1}  {peer}",
            rate(positions),
            rate(normals),
            one / two,
            rate(connected)
        );
    }
    Ok(())
}

/// The paper's stepwise refinement: 4 steps at 5°, and longer work.
pub(crate) fn stepwise(model: &Path) -> Result<()> {
    let control = mesh(model)?;
    println!(
        "\nstepwise limit-normal Loop of {}, best of {REPEATS}",
        name(model)
    );
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
    model
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

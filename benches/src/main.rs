//! Benchmarks, side by side with peers in the same run.
//!
//! `cargo run --release -p limitmesh-benches -- WORK [MODELS]` with MODELS the folder of the shared models (default: the
//! environment variable `LIMITMESH_MODELS`) and WORK one of
//!
//! * `uniform`, `uniform-quads`, `stepwise`, `distance`, `certified`, `load`: speed beside peers; `speed` runs all of these;
//! * `against-paper`, `against-uniform`, `against-optimum`, `against-simplified`, `certificate`: how good exact refinement
//!   is, over many models; `quality` runs all of these;
//! * `throughput`: its triangles per second and bytes per triangle;
//! * `through`: limit surfaces through the vertices of thinned meshes, against the meshes before;
//! * `replay`: frames of an animation beside OpenSubdiv's limit stencils;
//! * `points`: the limit surface evaluated, and closest points of it beside those of a fine mesh;
//! * `channels`: what texture coordinates add to a refinement;
//! * `gaps`: how long observers of long functions wait at most;
//! * `front`: updates of a front against fresh ones, and a camera's way around a model;
//! * `files`: writing and reading each format; needs no models;
//! * `scaling`: exact refinement of ever larger meshes, larger in one way each; needs no models;
//! * `tolerances GOALS`: triangles and time of exact refinement, each of the GOALS a model, built in or a file, and what is
//!   asked of it: `cup@0.01` is within 0.01 % of the diagonal, `cup@n:5000` has 5,000 triangles; options `--balance`, `--runs K`;
//! * `figures FOLDER`: the pictures of the README, from built-in models;
//! * `all`: `speed`, `quality` and `throughput`.
//!
//! Peers that are not installed are left out, and that is said.

mod channels;
mod clock;
mod distance;
mod figures;
mod files;
mod front;
mod gaps;
mod load;
mod peers;
mod points;
mod quality;
mod refinement;
mod replay;
mod scaling;
mod thinning;
mod through;
mod tolerances;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use limitmesh::Mesh;

/// All measurements of speed beside peers, in the order in which `speed` makes them.
const SPEED: [&str; 6] = [
    "uniform",
    "uniform-quads",
    "stepwise",
    "distance",
    "certified",
    "load",
];

/// All measurements of quality, in the order in which `quality` makes them.
const QUALITY: [&str; 5] = [
    "against-paper",
    "against-uniform",
    "against-optimum",
    "against-simplified",
    "certificate",
];

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let work = arguments.next().unwrap_or_else(|| "all".into());
    if work == "scaling" {
        return scaling::scaling();
    }
    if work == "files" {
        return files::files();
    }
    if work == "tolerances" {
        return tolerances::tolerances(arguments);
    }
    let folder = arguments
        .next()
        .map(PathBuf::from)
        .or_else(|| std::env::var_os("LIMITMESH_MODELS").map(PathBuf::from))
        .context("name the folder of the models, or of the figures, or set LIMITMESH_MODELS")?;
    match work.as_str() {
        // Works in processes of their own, whose peaks of memory are then theirs.
        "load-child" => load::child(&folder),
        "throughput-child" => {
            let tolerance = arguments.next().context("a tolerance is missing")?;
            quality::throughput_child(&folder, tolerance.parse()?)
        }
        "figures" => figures::figures(&folder),
        "speed" => SPEED.iter().try_for_each(|work| measure(work, &folder)),
        "quality" => QUALITY.iter().try_for_each(|work| measure(work, &folder)),
        "all" => {
            let works = SPEED.iter().chain(&QUALITY).chain(&["throughput"]);
            works
                .into_iter()
                .try_for_each(|work| measure(work, &folder))
        }
        one => measure(one, &folder),
    }
}

/// One measurement, on the models in `folder`.
fn measure(work: &str, folder: &Path) -> Result<()> {
    let bunny = folder.join("bunny_3674.obj");
    match work {
        "uniform" => refinement::uniform(&bunny),
        "uniform-quads" => refinement::uniform_quads(&folder.join("bob_cage.obj")),
        "stepwise" => refinement::stepwise(&bunny),
        "distance" => distance::distance(&bunny),
        "certified" => distance::certified(&bunny),
        "load" => load::load(&folder.join("gcanyon_530k.ply")),
        "against-paper" => quality::against_paper(folder),
        "against-uniform" => quality::against_uniform(folder),
        "against-optimum" => quality::against_optimum(folder),
        "against-simplified" => quality::against_simplified(folder),
        "certificate" => quality::certificate(folder),
        "throughput" => quality::throughput(folder),
        "through" => through::through(folder),
        "replay" => replay::replay(&bunny),
        "points" => points::points(&bunny),
        "channels" => channels::channels(folder),
        "gaps" => gaps::gaps(folder),
        "front" => front::front(folder),
        other => bail!(
            "no benchmark is called {other}: {}, speed, {}, quality, throughput, through, replay, points, channels, gaps, front, files, scaling, tolerances, figures, all",
            SPEED.join(", "),
            QUALITY.join(", ")
        ),
    }
}

/// The control mesh in a file.
fn mesh(path: &Path) -> Result<Mesh> {
    let soup = limitmesh_io::read(path)?;
    let (mesh, _) = Mesh::from_soup(&soup, &Default::default())?;
    Ok(mesh)
}

/// Runs `work` on a pool of `threads` threads `repeats` times and returns the least seconds and the last result.
fn best_of<T: Send>(
    repeats: usize,
    threads: usize,
    work: impl Fn() -> T + Sync,
) -> Result<(f64, T)> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()?;
    let run = || {
        let start = std::time::Instant::now();
        let result = pool.install(&work);
        (start.elapsed().as_secs_f64(), result)
    };
    let mut best = run();
    for _ in 1..repeats {
        let next = run();
        best = (best.0.min(next.0), next.1);
    }
    Ok(best)
}

//! Benchmarks, side by side with peers in the same run.
//!
//! `cargo run --release -p limitmesh-benches -- WORK [MODELS]` with WORK one of `uniform`, `stepwise`, `distance`,
//! `certified`, `load` or `all`, and MODELS the folder of the shared models (default: the environment variable
//! `LIMITMESH_MODELS`). Peers that are not installed are left out, and that is said.

mod distance;
mod load;
mod peers;
mod refinement;

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use limitmesh::Mesh;

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let work = arguments.next().unwrap_or_else(|| "all".into());
    let models = arguments
        .next()
        .map(PathBuf::from)
        .or_else(|| std::env::var_os("LIMITMESH_MODELS").map(PathBuf::from))
        .context("name the folder of the models, or set LIMITMESH_MODELS")?;
    let bunny = models.join("bunny_3674.obj");
    match work.as_str() {
        "uniform" => refinement::uniform(&bunny),
        "stepwise" => refinement::stepwise(&bunny),
        "distance" => distance::distance(&bunny),
        "certified" => distance::certified(&bunny),
        "load" => load::load(&models.join("gcanyon_530k.ply")),
        // Reading and building in a process of its own, whose peak of memory is then that work's.
        "load-child" => load::child(&models),
        "all" => {
            refinement::uniform(&bunny)?;
            refinement::stepwise(&bunny)?;
            distance::distance(&bunny)?;
            distance::certified(&bunny)?;
            load::load(&models.join("gcanyon_530k.ply"))
        }
        other => bail!("no benchmark is called {other}: uniform, stepwise, distance, certified, load, all"),
    }
}

/// The control mesh in a file.
fn mesh(path: &std::path::Path) -> Result<Mesh> {
    let soup = limitmesh_io::read(path)?;
    let (mesh, _) = Mesh::from_soup(&soup, &Default::default())?;
    Ok(mesh)
}

/// Runs `work` on a pool of `threads` threads `repeats` times and returns the least seconds and the last result.
fn best_of<T: Send>(repeats: usize, threads: usize, work: impl Fn() -> T + Sync) -> Result<(f64, T)> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
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

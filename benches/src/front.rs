//! A front that is updated: one per cent of its nodes against a fresh one, and a camera's way around a model, on one thread.

use std::path::Path;
use std::time::Instant;

use anyhow::Result;
use limitmesh::Mesh;
use limitmesh::criterion::Camera;
use limitmesh::front::{Demand, Front};
use limitmesh::scheme::Loop;

use crate::{best_of, mesh};

/// Triangles of the front.
const TRIANGLES: usize = 1_000_000;

/// Frames of the camera's way, and how often it is gone; each frame counts as often as it was fastest.
const FRAMES: usize = 200;
const PASSES: usize = 3;

/// Degrees around the model that the whole way is.
const TURNS: [f64; 3] = [30.0, 90.0, 360.0];

/// Prints the tables of docs/benchmarks.md.
pub(crate) fn front(folder: &Path) -> Result<()> {
    let control = mesh(&folder.join("bunny_3674.obj"))?;
    let (_, printed) = best_of(1, 1, || {
        tolerances(&control)?;
        TURNS
            .iter()
            .try_for_each(|&degrees| camera(&control, degrees))
    })?;
    printed
}

/// Updates from one tolerance to another and back, against a fresh front.
fn tolerances(control: &Mesh) -> Result<()> {
    let mut front = Front::new(control, &Loop)?;
    let mut demands = Vec::new();
    for triangles in [TRIANGLES, TRIANGLES / 100 * 99] {
        front.update(&Demand::tolerance(0.0).triangles(triangles))?;
        demands.push(Demand::tolerance(front.limit()));
    }
    let mut fresh = f64::INFINITY;
    let mut seconds = [f64::INFINITY; 2];
    let mut counts = [(0, 0); 2];
    for _ in 0..PASSES {
        let mut front = Front::new(control, &Loop)?;
        let start = Instant::now();
        front.update(&demands[0])?;
        fresh = fresh.min(start.elapsed().as_secs_f64());
        for way in [1, 0] {
            let start = Instant::now();
            let changes = front.update(&demands[way])?;
            seconds[way] = seconds[way].min(start.elapsed().as_secs_f64());
            counts[way] = (changes.divided + changes.merged, changes.triangles.len());
        }
    }
    println!("\n{TRIANGLES} triangles afresh: {:.0} ms", 1e3 * fresh);
    for (what, way) in [("coarser", 1), ("finer", 0)] {
        let (nodes, triangles) = counts[way];
        println!(
            "{what}: {nodes} nodes and {triangles} triangles changed: {:.1} ms, {:.1} % of that",
            1e3 * seconds[way],
            100.0 * seconds[way] / fresh
        );
    }
    Ok(())
}

/// The limit in pixels at which a front has its number of triangles, kept along a way around the model.
fn camera(control: &Mesh, degrees: f64) -> Result<()> {
    let size = control.diagonal();
    let [low, high] = control.as_triangles().bounding_box().unwrap_or_default();
    let middle = [0, 1, 2].map(|axis| 0.5 * (low[axis] + high[axis]));
    let camera = |frame: usize| {
        let (sine, cosine) = (degrees.to_radians() * frame as f64 / (FRAMES - 1) as f64).sin_cos();
        let eye = [
            middle[0] + 0.9 * size * sine,
            middle[1] + 0.2 * size,
            middle[2] + 0.9 * size * cosine,
        ];
        Camera {
            eye,
            target: middle,
            up: [0.0, 1.0, 0.0],
            fov_degrees: 40.0,
            width: 3840,
            height: 2160,
        }
    };
    let mut front = Front::new(control, &Loop)?;
    front.update(&Demand::pixels(0.0, &[camera(0)]).triangles(TRIANGLES))?;
    let limit = front.limit();
    let mut seconds = vec![f64::INFINITY; FRAMES];
    let mut triangles = Vec::new();
    let mut nodes = 0;
    for _ in 0..PASSES {
        let mut front = Front::new(control, &Loop)?;
        front.update(&Demand::pixels(limit, &[camera(0)]))?;
        triangles.clear();
        nodes = 0;
        for (frame, seconds) in seconds.iter_mut().enumerate().skip(1) {
            let demand = Demand::pixels(limit, &[camera(frame)]);
            let start = Instant::now();
            let changes = front.update(&demand)?;
            *seconds = seconds.min(start.elapsed().as_secs_f64());
            nodes += changes.divided + changes.merged;
            triangles.push((changes.triangles.len(), front.triangles().len()));
        }
    }
    seconds.remove(0);
    seconds.sort_by(f64::total_cmp);
    let changed: usize = triangles.iter().map(|&(changed, _)| changed).sum();
    let all = triangles.iter().map(|&(_, all)| all);
    println!(
        "\n{degrees}° in {FRAMES} frames at {limit:.3} pixels, {} to {} triangles: {} nodes and {} triangles changed a frame, {:.2} ms in the \
         median, {:.2} ms at most",
        all.clone().min().unwrap_or(0),
        all.max().unwrap_or(0),
        nodes / (FRAMES - 1),
        changed / (FRAMES - 1),
        1e3 * seconds[seconds.len() / 2],
        1e3 * seconds[seconds.len() - 1],
    );
    Ok(())
}

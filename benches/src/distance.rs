//! Sampled symmetric Hausdorff distance, beside MeshLab's.

use std::path::Path;

use anyhow::Result;
use limitmesh::measure::{SamplingOptions, hausdorff};
use limitmesh::refine::UniformOptions;
use limitmesh::scheme::Loop;

use crate::{best_of, mesh, peers};

const SAMPLES: usize = 500_000;

/// Level 2 against level 5 with 500,000 samples a side, building of the hierarchies included.
pub(crate) fn distance(model: &Path) -> Result<()> {
    let control = mesh(model)?;
    let level = |levels| {
        let options = UniformOptions::default().levels(levels);
        limitmesh::refine::uniform(&control, &Loop, &options).map(|r| r.mesh)
    };
    let (coarse, fine) = (level(2)?, level(5)?);
    println!(
        "\nsampled symmetric Hausdorff distance, {} against {} triangles, {SAMPLES} samples a side",
        coarse.face_count(),
        fine.face_count()
    );
    let run = |threads| {
        best_of(3, threads, || {
            let options = SamplingOptions::default().samples(SAMPLES);
            hausdorff(coarse.as_triangles(), fine.as_triangles(), &options)
        })
    };
    let (one, found) = run(1)?;
    let (two, _) = run(2)?;
    let found = found?;
    println!(
        "limitmesh: {:.6} ({:.6} and {:.6}) in {one:.2} s on 1 thread, {two:.2} s on 2 (gain {:.2})",
        found.symmetric(),
        found.forward.max,
        found.backward.max,
        one / two
    );
    match peers::meshlab_distance(&coarse, &fine, SAMPLES)? {
        Some(theirs) => println!(
            "MeshLab:   {:.6} ({:.6} and {:.6}) in {:.2} s: {:.1} times as long as ours on 2 threads, {:.1} on 1; value {:+.2} %",
            theirs.forward.max(theirs.backward),
            theirs.forward,
            theirs.backward,
            theirs.seconds,
            theirs.seconds / two,
            theirs.seconds / one,
            100.0 * (found.symmetric() / theirs.forward.max(theirs.backward) - 1.0)
        ),
        None => println!("MeshLab:   not installed (pip install pymeshlab)"),
    }
    Ok(())
}

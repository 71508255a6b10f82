//! Symmetric Hausdorff distance, sampled beside MeshLab's and with certified bounds.

use std::path::Path;

use anyhow::Result;
use limitmesh::Mesh;
use limitmesh::measure::{
    Bounds, CertifiedOptions, SamplingOptions, certified_hausdorff, hausdorff,
};
use limitmesh::refine::UniformOptions;
use limitmesh::scheme::Loop;

use crate::{best_of, mesh, peers};

const SAMPLES: usize = 500_000;

/// Uniform levels 2 and 5 of a model.
fn levels(model: &Path) -> Result<(Mesh, Mesh)> {
    let control = mesh(model)?;
    let level = |levels| {
        let options = UniformOptions::default().levels(levels);
        limitmesh::refine::uniform(&control, &Loop, &options).map(|r| r.mesh)
    };
    Ok((level(2)?, level(5)?))
}

/// Level 2 against level 5 with 500,000 samples a side, building of the hierarchies included.
pub(crate) fn distance(model: &Path) -> Result<()> {
    let (coarse, fine) = levels(model)?;
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

/// Level 2 against level 5 with certified bounds, building of the hierarchies included: within one per cent, and within
/// the 1e-3 that CGAL's `bounded_error_symmetric_Hausdorff_distance` was timed with.
pub(crate) fn certified(model: &Path) -> Result<()> {
    let (coarse, fine) = levels(model)?;
    println!(
        "\ncertified symmetric Hausdorff distance, {} against {} triangles",
        coarse.face_count(),
        fine.face_count()
    );
    let one_percent = CertifiedOptions::default();
    for (words, options) in [
        ("1 %", one_percent),
        ("0.1 %", one_percent.relative_gap(1e-3)),
        ("1e-3", one_percent.relative_gap(0.0).gap(Some(1e-3))),
    ] {
        let run = |threads| {
            best_of(3, threads, || {
                certified_hausdorff(coarse.as_triangles(), fine.as_triangles(), &options)
            })
        };
        let (one, found) = run(1)?;
        let (two, _) = run(2)?;
        let found = found?;
        let interval = |b: &Bounds| format!("[{:.6}, {:.6}]", b.lower, b.upper);
        println!(
            "gap {words}: [{:.6}, {:.6}] (forward {}, backward {}){} in {one:.2} s on 1 thread, {two:.2} s on 2 (gain \
             {:.2}), {:.1} million units of work",
            found.lower(),
            found.upper(),
            interval(&found.forward),
            interval(&found.backward),
            if found.converged() {
                ""
            } else {
                ", not converged"
            },
            one / two,
            found.work as f64 / 1e6
        );
    }
    Ok(())
}

//! What it costs to carry channels along: a refinement, and its channels, on one thread.

use std::path::Path;

use anyhow::Result;
use limitmesh::Mesh;
use limitmesh::carry::carried;
use limitmesh::mesh::Interpolation;
use limitmesh::refine::{ExactOptions, exact};
use limitmesh::scheme::Loop;

use crate::best_of;

/// Models with texture coordinates.
const MODELS: [&str; 3] = ["bob_cage.obj", "fish_cage.obj", "assets/fuze.obj"];

/// Parts of the diagonal, in per cent.
const TOLERANCES: [f64; 2] = [0.01, 0.001];

/// Prints the table of docs/benchmarks.md.
pub(crate) fn channels(folder: &Path) -> Result<()> {
    println!(
        "| model | tolerance % | triangles | refinement ms | channel | ms | ns a number and triangle |"
    );
    println!("|---|---:|---:|---:|---|---:|---:|");
    for model in MODELS
        .iter()
        .map(|model| folder.join(model))
        .filter(|path| path.exists())
    {
        let soup = limitmesh_io::read(&model)?;
        let (mesh, _, trace) = Mesh::from_soup_traced(&soup, &Default::default())?;
        let Some(channel) = soup
            .channels
            .iter()
            .find(|channel| channel.name == limitmesh_io::TEXTURE)
        else {
            continue;
        };
        let channel = channel.on_mesh(&soup, &mesh, &trace)?;
        for tolerance in TOLERANCES {
            let length = 0.01 * tolerance * mesh.diagonal();
            let options = ExactOptions::default()
                .tolerance(length)
                .flat_regions(false);
            let (refining, found) = best_of(5, 1, || exact(&mesh, &Loop, &options))?;
            let found = found?;
            let triangles = found.mesh.face_count();
            let smooth = channel
                .clone()
                .interpolated(Interpolation::Smooth(Default::default()));
            for channel in [smooth, channel.clone().interpolated(Interpolation::Linear)] {
                let one = core::slice::from_ref(&channel);
                let (seconds, carried) = best_of(9, 1, || carried(one, &mesh, &Loop, &found))?;
                carried?;
                let kind = if channel.interpolation == Interpolation::Linear {
                    "linear"
                } else {
                    "smooth"
                };
                println!(
                    "| {} | {tolerance} | {triangles} | {:.0} | {kind} | {:.1} | {:.1} |",
                    model.file_stem().unwrap_or_default().display(),
                    1e3 * refining,
                    1e3 * seconds,
                    1e9 * seconds / (channel.arity * triangles) as f64,
                );
            }
        }
    }
    Ok(())
}

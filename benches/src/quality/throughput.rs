//! Triangles per processor second and bytes per triangle of exact refinement with its certificate, on one thread.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use limitmesh::Mesh;
use limitmesh::refine::{Exact, ExactOptions, Origin, exact};
use limitmesh::scheme::Loop;

use super::builtin;
use super::table::{self, count, digits, median};
use crate::clock::{one_thread, peak_bytes, resident_bytes};

/// Built-in models, and files.
const MODELS: [&str; 4] = ["cup", "bunny_1k.off", "bunny_3674.obj", "teddy.obj"];

/// Triangles for which a tolerance is looked for, nearly.
const TRIANGLES: [usize; 4] = [500_000, 1_000_000, 2_000_000, 4_000_000];

/// Of as many runs the fastest counts.
const REPEATS: usize = 3;

/// Every run in a process of its own, whose peak of memory is then its.
pub(crate) fn throughput(folder: &Path) -> Result<()> {
    println!(
        "\nexact refinement within a tolerance, with certificate, one thread; best of {REPEATS}"
    );
    table::begin(&[
        "model",
        "tolerance %",
        "triangles",
        "million triangles a second, user time",
        "user and system time",
        "peak bytes a triangle beyond input and output",
    ]);
    let mut rates = Vec::new();
    for name in MODELS {
        let path = folder.join(name);
        if Path::new(name).extension().is_some() && !path.exists() {
            eprintln!("{name} is not in {}: left out", folder.display());
            continue;
        }
        let control = load(&path)?;
        for wanted in TRIANGLES {
            let tolerance = tolerance_for(&control, wanted)?;
            let output = Command::new(std::env::current_exe()?)
                .arg("throughput-child")
                .arg(&path)
                .arg(tolerance.to_string())
                .output()?;
            ensure!(
                output.status.success(),
                "{}",
                String::from_utf8_lossy(&output.stderr)
            );
            let line = String::from_utf8(output.stdout)?;
            let numbers = line
                .split_whitespace()
                .map(str::parse)
                .collect::<Result<Vec<f64>, _>>()?;
            let [triangles, all, user, bytes] = numbers[..] else {
                anyhow::bail!("the process printed {line}, expected four numbers");
            };
            rates.push(triangles / user / 1e6);
            let mut row = vec![
                name.to_owned(),
                format!("{:.5}", 100.0 * tolerance / control.diagonal()),
            ];
            row.push(count(triangles as usize));
            row.extend([triangles / user / 1e6, triangles / all / 1e6].map(digits));
            row.push(format!("{bytes:.0}"));
            table::print_row(&row);
        }
    }
    println!(
        "\nmedian: {} million triangles a second of user time",
        digits(median(rates))
    );
    Ok(())
}

/// A file, or a built-in model where there is no such file.
fn load(path: &Path) -> Result<Mesh> {
    if path.exists() {
        return crate::mesh(path);
    }
    builtin(
        &path
            .file_name()
            .context("a path without a name")?
            .to_string_lossy(),
    )
}

/// The count grows as the tolerance falls, nearly in inverse proportion.
fn tolerance_for(control: &Mesh, wanted: usize) -> Result<f64> {
    let mut tolerance = 1e-4 * control.diagonal();
    for _ in 0..3 {
        let found = exact(
            control,
            &Loop,
            &ExactOptions::default().tolerance(tolerance),
        )?
        .mesh
        .face_count();
        let ratio = found as f64 / wanted as f64;
        if (ratio - 1.0).abs() < 0.1 {
            break;
        }
        tolerance *= ratio;
    }
    Ok(tolerance)
}

/// One model, one tolerance: prints triangles, processor seconds, those of the program alone, and bytes a triangle.
pub(crate) fn child(path: &Path, tolerance: f64) -> Result<()> {
    let control = load(path)?;
    let run = || {
        one_thread(|| {
            exact(
                &control,
                &Loop,
                &ExactOptions::default().tolerance(tolerance),
            )
        })
    };
    let before = resident_bytes()?;
    let (mut best, result) = run()?;
    let result = result?;
    let triangles = result.mesh.face_count();
    let beyond = (peak_bytes()? - before) as f64 - output_bytes(&result) as f64;
    drop(result);
    for _ in 1..REPEATS {
        let (seconds, _) = run()?;
        best.all = best.all.min(seconds.all);
        best.user = best.user.min(seconds.user);
    }
    println!(
        "{triangles} {} {} {}",
        best.all,
        best.user,
        beyond / triangles as f64
    );
    Ok(())
}

/// Mesh with topology, normals, where everything came from.
fn output_bytes(result: &Exact) -> usize {
    let (vertices, triangles) = (result.mesh.vertex_count(), result.mesh.face_count());
    let vector = size_of::<[f64; 3]>();
    // A triangle has three corners and three twins, a vertex an outgoing half-edge.
    vertices * (2 * vector + size_of::<u32>() + size_of::<Origin>())
        + triangles * 7 * size_of::<u32>()
}

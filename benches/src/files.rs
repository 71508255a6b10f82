//! Writing and reading files of each format, on one thread and on two, beside trimesh in Python.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use limitmesh::Mesh;
use limitmesh::refine::{ExactOptions, exact};
use limitmesh::scheme::Loop;
use limitmesh_io::Output;

use crate::best_of;
use crate::peers::{Exported, exported};

/// By ending.
const FORMATS: [&str; 6] = ["ply", "stl", "obj", "off", "glb", "3mf"];

/// Of as many runs the fastest counts.
const REPEATS: usize = 5;
const REPEATS_OF_PEER: usize = 2;

/// The tolerance of the model, as a share of its diagonal.
const WITHIN: f64 = 1e-5;

/// The built-in cup, refined, with its normals.
pub(crate) fn files() -> Result<()> {
    let cup = limitmesh_models::find("cup").context("the cup is built in")?;
    let (control, _) = Mesh::from_soup(&cup.soup(), &Default::default())?;
    let options = ExactOptions::default().tolerance(WITHIN * control.diagonal());
    let refined = exact(&control, &Loop, &options)?;
    let output = Output::new(refined.mesh.as_triangles()).normals(&refined.normals);
    let folder = tempfile::tempdir()?;
    let place = |ending: &str| folder.path().join(format!("own.{ending}"));
    println!(
        "\nfiles of {} triangles, with normals where the format has some; milliseconds by the clock, best of {REPEATS}",
        refined.mesh.face_count()
    );
    limitmesh_io::write(&place("ply"), &output, &Default::default())?;
    let peer = exported(&place("ply"), folder.path(), REPEATS_OF_PEER, &FORMATS)?;
    println!("format  megabytes  written by 1 thread  by 2  read  trimesh: written  read");
    for (number, ending) in FORMATS.into_iter().enumerate() {
        let path = place(ending);
        let write = |threads: usize| -> Result<f64> {
            let mut least = f64::INFINITY;
            for _ in 0..REPEATS {
                // A file that takes the name of another is brought to the disk at once by some systems.
                if path.exists() {
                    std::fs::remove_file(&path)?;
                }
                let (seconds, done) = best_of(1, threads, || {
                    limitmesh_io::write(&path, &output, &Default::default())
                })?;
                done?;
                least = least.min(seconds);
            }
            Ok(1e3 * least)
        };
        let (one, two) = (write(1)?, write(2)?);
        let (read, again) = best_of(REPEATS, 1, || limitmesh_io::read(&path))?;
        ensure!(
            again?.faces.len() == refined.mesh.face_count(),
            "{ending}: other faces than were written"
        );
        let peer = match &peer {
            Some(seconds) => {
                let Exported { written, read } = seconds[number];
                format!("{:16.0}  {:4.0}", 1e3 * written, 1e3 * read)
            }
            None => "not installed".into(),
        };
        println!(
            "{ending:6}  {:9.1}  {one:19.0}  {two:4.0}  {:4.0}  {peer}",
            megabytes(&path)?,
            1e3 * read
        );
    }
    Ok(())
}

fn megabytes(path: &Path) -> Result<f64> {
    Ok(std::fs::metadata(path)?.len() as f64 / 1e6)
}

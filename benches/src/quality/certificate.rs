//! How tight the certified interval is at the default tolerance, on every model of the folder.

use std::path::Path;

use anyhow::Result;
use limitmesh::Mesh;
use limitmesh::refine::{ExactOptions, exact};
use limitmesh::scheme::Loop;

use super::table::{self, count, digits};
use crate::clock::one_thread;

/// The program's default tolerance, as a share of the control mesh's diagonal.
const TOLERANCE: f64 = 1e-3;

const EXTENSIONS: [&str; 4] = ["obj", "off", "ply", "stl"];

/// Prints [L, U], triangles and seconds for every file that can be read.
pub(crate) fn certificate(folder: &Path) -> Result<()> {
    println!("\ncertified interval at a tolerance of 0.1 % of the diagonal");
    let mut files: Vec<_> = std::fs::read_dir(folder)?.collect::<Result<Vec<_>, _>>()?;
    files.sort_by_key(|file| file.file_name());
    let mut rows = Vec::new();
    let mut worst = 0.0f64;
    for file in files {
        let path = file.path();
        let known = path
            .extension()
            .is_some_and(|e| EXTENSIONS.iter().any(|known| e.eq_ignore_ascii_case(known)));
        if !known {
            continue;
        }
        let control = crate::mesh(&path)?;
        let name = file.file_name().to_string_lossy().into_owned();
        let (row, ratio) = measure(name, &control)?;
        worst = worst.max(ratio);
        rows.push(row);
    }
    table::print(
        &[
            "model",
            "faces",
            "triangles",
            "L %",
            "U %",
            "U / L",
            "CPU seconds",
            "million triangles a second",
            "ended by",
        ],
        &rows,
    );
    println!("\ngreatest U / L: {}", digits(worst));
    Ok(())
}

fn measure(name: String, control: &Mesh) -> Result<(Vec<String>, f64)> {
    let diagonal = control.diagonal();
    let options = ExactOptions::default().tolerance(TOLERANCE * diagonal);
    let (seconds, result) = one_thread(|| exact(control, &Loop, &options))?;
    let result = result?;
    let [lower, upper] =
        [result.error.lower, result.error.upper].map(|length| 100.0 * length / diagonal);
    let triangles = result.mesh.face_count();
    let row = vec![
        name,
        count(control.face_count()),
        count(triangles),
        format!("{lower:.5}"),
        format!("{upper:.5}"),
        format!("{:.3}", upper / lower),
        digits(seconds.all),
        digits(triangles as f64 / seconds.all / 1e6),
        format!("{:?}", result.stop),
    ];
    Ok((row, upper / lower))
}

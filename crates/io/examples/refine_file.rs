//! Reads a mesh, refines it by limit normals, measures the result and writes it.
//!
//! `cargo run --release -p limitmesh-io --example refine_file [INPUT OUTPUT]`; without arguments a built-in model is
//! refined and written to the folder for temporary files.

use std::error::Error;
use std::path::PathBuf;

use limitmesh::Mesh;
use limitmesh::criterion::LimitNormal;
use limitmesh::limit::LimitTable;
use limitmesh::measure::{SamplingOptions, hausdorff};
use limitmesh::refine::limit_reference;
use limitmesh::refine::{StepwiseOptions, stepwise};
use limitmesh::scheme::Loop;
use limitmesh_io::{Output, WriteOptions, read, write};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let soup = match arguments.next() {
        Some(path) => read(&path)?,
        None => limitmesh_models::find("cup")
            .ok_or("no such built-in model")?
            .soup(),
    };
    let output = arguments
        .next()
        .unwrap_or_else(|| std::env::temp_dir().join("limitmesh-cup.ply"));

    let (control, diagnosis) = Mesh::from_soup(&soup, &Default::default())?;
    if !diagnosis.is_clean() {
        println!("{diagnosis}");
    }
    let criterion = LimitNormal::new(10f64.to_radians());
    let refined = stepwise(
        &control,
        &Loop,
        &criterion,
        &StepwiseOptions::default().levels(3),
    )?;
    for step in &refined.steps {
        println!(
            "step {}: {} of {} faces divided, {} faces after it",
            step.step, step.divisible, step.faces_before, step.faces_after
        );
    }

    let limit = limit_reference(&control, &Loop, 4)?;
    let samples = SamplingOptions::default().samples(20_000);
    let distance = hausdorff(refined.mesh.as_triangles(), limit.as_triangles(), &samples)?;
    println!(
        "at least {:.4} % of the diagonal away from the limit surface",
        distance.symmetric_percent()
    );

    let normals = LimitTable::new(&Loop).normals(&refined.mesh)?;
    let content = Output::new(refined.mesh.as_triangles()).normals(&normals);
    write(&output, &content, &WriteOptions::default())?;
    println!("written: {}", output.display());
    Ok(())
}

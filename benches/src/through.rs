//! Limit surfaces through the vertices of thinned meshes, against the meshes that these were before: how far they are from
//! them, and how their normals differ.
//!
//! The mesh as it was stands for the truth.

use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use limitmesh::Mesh;
use limitmesh::interpolate::{InterpolateOptions, interpolate};
use limitmesh::measure::{Bvh, SamplingOptions, hausdorff_between};
use limitmesh::refine::limit_reference;
use limitmesh::scheme::Loop;

use crate::mesh;
use crate::thinning::{normal, thinned};

/// Closed models whose faces are small against their features.
const MODELS: [&str; 5] = [
    "bunny_3674.obj",
    "teddy.obj",
    "goathead_be.ply",
    "skull_low.obj",
    "monsterfrog.obj",
];

/// Parts of the diagonal, in per cent, that limits may be from their vertices.
const WITHIN: [f64; 3] = [0.02, 0.05, 0.2];

/// Levels of uniform refinement whose limits stand for a surface.
const LEVELS: usize = 4;

/// Prints the table of docs/benchmarks.md.
pub(crate) fn through(folder: &Path) -> Result<()> {
    println!(
        "| model | triangles | surface | greatest distance % | RMS distance % | RMS angle | steps |"
    );
    println!("|---|---:|---|---:|---:|---:|---:|");
    for model in MODELS {
        let truth = mesh(&folder.join(model))?;
        let tree = Bvh::new(truth.as_triangles())?;
        let thinned = thinned(&truth, truth.face_count() / 4)?;
        let size = truth.diagonal();
        let row = |name: &str, control: &Mesh, steps: String| -> Result<()> {
            let surface = limit_reference(control, &Loop, LEVELS)?;
            let surface = Bvh::new(surface.as_triangles())?;
            let options = SamplingOptions::default().samples(200_000);
            let found = hausdorff_between(&surface, &tree, &options);
            println!(
                "| {model} | {} | {name} | {:.3} | {:.4} | {:.2}° | {steps} |",
                control.face_count(),
                100.0 * found.symmetric() / size,
                100.0 * found.forward.rms / size,
                normals_apart(&surface, &tree).to_degrees(),
            );
            Ok(())
        };
        row("plain limit", &thinned, "-".into())?;
        for within in [0.0].into_iter().chain(WITHIN) {
            let options = InterpolateOptions::default().within(0.01 * within * size);
            let found = interpolate(&thinned, &Loop, &options)?;
            let steps = found
                .fairness
                .map_or(found.iterations, |fairness| fairness.steps);
            let name = if within == 0.0 {
                "through".to_owned()
            } else {
                format!("within {within} %")
            };
            row(&name, &found.mesh, steps.to_string())?;
        }
    }
    Ok(())
}

/// The root of the mean square angle between a surface's facets and those of another at the nearest points, by area.
fn normals_apart(surface: &Bvh<'_>, truth: &Bvh<'_>) -> f64 {
    let corners = |of: &Bvh<'_>, face| of.surface().corners(face).map(DVec3::from_array);
    let (mut sum, mut areas) = (0.0, 0.0);
    for face in 0..surface.surface().triangles.len() {
        let own = corners(surface, face);
        let middle = own.iter().sum::<DVec3>() / 3.0;
        let other = corners(truth, truth.closest(middle.to_array()).face as usize);
        let angle = normal(own).angle_between(normal(other));
        let area = normal(own).length();
        if angle.is_finite() {
            sum += area * angle * angle;
            areas += area;
        }
    }
    (sum / areas).sqrt()
}

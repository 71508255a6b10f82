//! Exact refinement beside uniform refinement with its vertices on the limit surface.

use std::path::Path;

use anyhow::Result;
use limitmesh::Mesh;
use limitmesh::refine::{ExactOptions, Finish, exact};
use limitmesh::scheme::Loop;

use super::cast::{Model, gather};
use super::judge::{Judge, Reference};
use super::paper::best;
use super::table::{self, count, digits, median};

/// Uniform levels that are compared, where the reference is two levels finer.
const MOST_LEVELS: usize = 4;

const MOST_FACES: usize = 12_000;

/// Tolerances that are tried for a mesh that is just as near as the uniform one.
const ATTEMPTS: usize = 4;

/// Distances that differ by less are those of the same mesh, with its triangles in another order.
const SAME: f64 = 1e-9;

/// Both at equal counts, and the count at which exact refinement is as near.
pub(crate) fn against_uniform(folder: &Path) -> Result<()> {
    println!(
        "\nexact refinement beside uniform refinement with limit vertices, distances in % of the diagonal"
    );
    let models = gather(folder, MOST_FACES)?;
    let mut rows = Vec::new();
    let mut savings = Vec::new();
    let mut worst = f64::MAX;
    for model in &models {
        let reference = Reference::new(&model.mesh)?;
        let judge = Judge::new(&reference)?;
        let levels = MOST_LEVELS.min(reference.level - 2);
        let mut of_model = Vec::new();
        for level in 1..=levels {
            let compared = compare(model, &judge, level)?;
            worst = worst.min(compared.nearer);
            of_model.push(compared.fewer);
            rows.push(compared.row);
        }
        savings.push((median(of_model), model.name.as_str()));
    }
    table::print(
        &[
            "model",
            "level",
            "triangles",
            "uniform",
            "exact, as many",
            "uniform / exact",
            "exact as near: triangles",
            "times fewer",
        ],
        &rows,
    );
    savings.sort_by(|a, b| b.0.total_cmp(&a.0));
    println!(
        "\nleast uniform / exact: {} (below 1, uniform is nearer)",
        digits(worst)
    );
    println!(
        "\nmedian of the models' medians: {} times fewer triangles",
        digits(median(savings.iter().map(|s| s.0)))
    );
    let by_model: Vec<_> = savings
        .iter()
        .map(|(saving, name)| format!("{name} {}", digits(*saving)))
        .collect();
    println!("\nby model: {}", by_model.join(", "));
    Ok(())
}

struct Compared {
    row: Vec<String>,
    /// Uniform distance by exact distance at equal counts.
    nearer: f64,
    /// Uniform count by exact count at equal distance.
    fewer: f64,
}

fn compare(model: &Model, judge: &Judge<'_>, level: usize) -> Result<Compared> {
    let uniform = limitmesh::refine::limit_reference(&model.mesh, &Loop, level)?;
    let theirs = judge.distance(&uniform)?;
    let triangles = uniform.face_count();
    drop(uniform);
    let as_many = best(&model.mesh, triangles, Finish::OnSurface)?;
    let ours = judge.distance(&as_many)?;
    let mut needed = as_near(&model.mesh, judge, theirs)?;
    if ours <= theirs * (1.0 + SAME) {
        needed = needed.min(as_many.face_count());
    }
    let (nearer, fewer) = (theirs / ours, triangles as f64 / needed as f64);
    let row = vec![
        model.name.clone(),
        level.to_string(),
        count(triangles),
        digits(judge.percent(theirs)),
        digits(judge.percent(ours)),
        digits(nearer),
        count(needed),
        digits(fewer),
    ];
    Ok(Compared { row, nearer, fewer })
}

/// The fewest triangles met that are measured no farther than `distance`.
///
/// A mesh within a tolerance is measured somewhat nearer than it; the tolerance is raised by that until it is used up.
fn as_near(control: &Mesh, judge: &Judge<'_>, distance: f64) -> Result<usize> {
    let mut fewest = usize::MAX;
    let mut tolerance = distance;
    for _ in 0..ATTEMPTS {
        let mesh = exact(
            control,
            &Loop,
            &ExactOptions::default().tolerance(tolerance),
        )?
        .mesh;
        let found = judge.distance(&mesh)?;
        if found <= distance {
            fewest = fewest.min(mesh.face_count());
        }
        tolerance *= distance / found;
        if (found / distance - 1.0).abs() < 0.01 {
            break;
        }
    }
    Ok(fewest)
}

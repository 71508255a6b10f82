//! Against the asymptotic optimum: a smooth closed surface needs 0.19245·∫√|K| dA / ε vertices for inscribed triangles
//! within ε of it.

use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use limitmesh::Mesh;
use limitmesh::refine::{ExactOptions, Finish, exact};
use limitmesh::scheme::Loop;
use limitmesh::simplify::{Features, SimplifyOptions, simplify};

use super::cast::gather;
use super::judge::{Judge, Reference};
use super::paper::best;
use super::table::{self, count, digits, median};

/// 1 / (3√3), of the asymptotic optimum.
const OPTIMUM: f64 = 0.192_450_089_729_875_25;

/// Counts at which the meshes are compared. An asymptote asks for many, the time that it takes for few.
const TRIANGLES: [usize; 2] = [8_000, 32_000];

/// The optimised mesh is collapsed from one with so many times as many triangles.
const FINER: usize = 16;

/// Finer control meshes have more to show than these counts of triangles can.
const MOST_FACES: usize = 2_000;

/// The ratio of each closed model, refined and optimised.
pub(crate) fn against_optimum(folder: &Path) -> Result<()> {
    println!(
        "\ndistance × vertices / (0.19245 ∫√|K| dA), closed models; 1 is the asymptotic optimum for inscribed meshes"
    );
    let mut models = gather(folder, MOST_FACES)?;
    models.retain(|model| model.is_closed());
    let mut rows = Vec::new();
    let mut ratios = vec![Vec::new(); 3 * TRIANGLES.len()];
    for model in &models {
        let reference = Reference::new(&model.mesh)?;
        let judge = Judge::new(&reference)?;
        let integral = root_of_curvature(&reference.mesh);
        let mut row = vec![
            model.name.clone(),
            digits(integral / reference.mesh.diagonal()),
        ];
        for (at, triangles) in TRIANGLES.into_iter().enumerate() {
            let meshes = [
                best(&model.mesh, triangles, Finish::OnSurface)?,
                best(&model.mesh, triangles, Finish::Balanced)?,
                optimized(&model.mesh, triangles)?,
            ];
            for (which, mesh) in meshes.iter().enumerate() {
                let ratio =
                    judge.distance(mesh)? * mesh.vertex_count() as f64 / (OPTIMUM * integral);
                ratios[3 * at + which].push(ratio);
                row.push(digits(ratio));
            }
        }
        rows.push(row);
    }
    let mut last = vec!["median".to_owned(), String::new()];
    last.extend(
        ratios
            .into_iter()
            .map(|of_column| digits(median(of_column))),
    );
    rows.push(last);
    let mut heads = vec!["model".to_owned(), "∫√\\|K\\| dA / diagonal".to_owned()];
    for triangles in TRIANGLES {
        heads.extend(
            ["exact", "balanced", "optimised"].map(|name| format!("{name}, {}", count(triangles))),
        );
    }
    table::print(&heads.iter().map(String::as_str).collect::<Vec<_>>(), &rows);
    Ok(())
}

/// A mesh with at most so many triangles, collapsed from a finer exact one.
pub(crate) fn optimized(control: &Mesh, triangles: usize) -> Result<Mesh> {
    let fine = exact(
        control,
        &Loop,
        &ExactOptions::default().triangles(FINER * triangles),
    )?
    .mesh;
    let options = SimplifyOptions::default()
        .triangles(Some(triangles))
        .certify(false);
    Ok(simplify(&fine, &Features::default(), &options)?.mesh)
}

/// ∫√|K| dA by angle defects: that of a vertex is K times its share of the area, so that √|K| dA = √(|defect|·area).
fn root_of_curvature(mesh: &Mesh) -> f64 {
    let mut defects = vec![std::f64::consts::TAU; mesh.vertex_count()];
    let mut areas = vec![0.0; mesh.vertex_count()];
    for (face, triangle) in mesh.triangles().iter().enumerate() {
        let corners = mesh.as_triangles().corners(face).map(DVec3::from_array);
        for (i, &vertex) in triangle.iter().enumerate() {
            let [at, next, last] = [0, 1, 2].map(|k| corners[(i + k) % 3]);
            let (to_next, to_last) = (next - at, last - at);
            let doubled_area = to_next.cross(to_last).length();
            defects[vertex as usize] -= doubled_area.atan2(to_next.dot(to_last));
            areas[vertex as usize] += doubled_area / 6.0;
        }
    }
    defects
        .iter()
        .zip(areas)
        .map(|(defect, area): (&f64, f64)| (defect.abs() * area).sqrt())
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_integral_over_a_sphere_is_four_pi_times_its_radius() {
        // √K = 1/r, and the area is 4πr².
        let control = super::super::builtin("icosphere").unwrap();
        let mut mesh = limitmesh::refine::limit_reference(&control, &Loop, 3).unwrap();
        let onto_sphere = |p: &[f64; 3]| (2.5 * DVec3::from_array(*p).normalize()).to_array();
        let positions = mesh.positions().iter().map(onto_sphere).collect();
        mesh = mesh.with_positions(positions).unwrap();
        let expected = 4.0 * std::f64::consts::PI * 2.5;
        assert!((root_of_curvature(&mesh) / expected - 1.0).abs() < 1e-3);
    }
}

//! Uniform refinement to the limit, on the shared models (the folder in `LIMITMESH_MODELS`): what levels done together give
//! is what steps and the stencils of vertices give.

use super::support::shared;
use std::path::PathBuf;

use limitmesh::Mesh;
use limitmesh::limit::LimitTable;
use limitmesh::refine::{UniformOptions, uniform};
use limitmesh::scheme::Loop;

/// Triangles of the refined meshes at most.
const MOST: usize = 250_000;

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3)
        .map(|axis| (a[axis] - b[axis]).powi(2))
        .sum::<f64>()
        .sqrt()
}

#[test]
fn limits_of_shared_models_agree_with_stencils() {
    let Some(folder) = shared("") else { return };
    let files = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = files.collect();
    files.sort();
    let mut met = 0;
    for file in files.iter().filter(|file| file.is_file()) {
        let Ok(soup) = limitmesh_io::read(file) else {
            continue;
        };
        let control = Mesh::from_soup(&soup, &Default::default()).unwrap().0;
        let levels = (2..=4)
            .rev()
            .find(|levels| control.face_count() << (2 * levels) <= MOST);
        let Some(levels) = levels else { continue };
        met += 1;
        let name = file.display();
        let options = UniformOptions::default().levels(levels);
        let steps = uniform(&control, &Loop, &options).unwrap().mesh;
        let table = LimitTable::new(&Loop);
        let (positions, normals) = (
            table.positions(&steps).unwrap(),
            table.sided_normals(&steps).unwrap(),
        );
        let found = uniform(&control, &Loop, &options.limit(true).normals(true)).unwrap();
        assert!(found.mesh.topology() == steps.topology(), "{name}");
        assert_eq!(
            (found.mesh.tags(), found.mesh.junctions()),
            (steps.tags(), steps.junctions()),
            "{name}"
        );
        let diagonal = control.diagonal();
        // Copies of a vertex that was cut have the position of the first.
        let is_copy = !steps.junctions().is_empty();
        for (v, (&a, &b)) in found.mesh.positions().iter().zip(&positions).enumerate() {
            assert!(
                is_copy || distance(a, b) <= 1e-12 * diagonal,
                "{name}: vertex {v} at {a:?}, not {b:?}"
            );
        }
        let sided = found.normals.unwrap();
        for h in steps.topology().half_edges() {
            let (a, b) = (
                sided.at(steps.topology(), h),
                normals.at(steps.topology(), h),
            );
            assert!(
                distance(a, b) <= 1e-9,
                "{name}, level {levels}: {h} has the normal {a:?}, not {b:?}"
            );
        }
    }
    assert!(met > 15, "{met} models");
}

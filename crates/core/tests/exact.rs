//! Exact refinement against uniform refinement with limit vertices, dense sampling and exact shapes.

#![allow(clippy::unwrap_used)]

mod support;

use std::collections::HashMap;

use limitmesh::measure::{SamplingOptions, hausdorff, limit_reference};
use limitmesh::refine::{ExactOptions, ExactStop, exact};
use limitmesh::scheme::{Loop, LoopWarren, ModifiedButterfly, Scheme};
use limitmesh::{Mesh, models};

fn model(name: &str) -> Mesh {
    Mesh::from_soup(&models::find(name).unwrap().soup(), &Default::default()).unwrap().0
}

/// Every vertex is a vertex of the uniform refinement that is as deep, at the same place.
#[test]
fn vertices_lie_where_uniform_refinement_has_its_limits() {
    for scheme in [&Loop as &dyn Scheme, &LoopWarren] {
        for name in ["tetrahedron", "cube", "cup", "head", "sheet", "spike"] {
            let control = model(name);
            let diagonal = control.diagonal();
            let result =
                exact(&control, scheme, &ExactOptions::default().tolerance(0.004 * diagonal)).unwrap();
            result.mesh.validate().unwrap();
            let levels = result.levels.min(5);
            let reference = limit_reference(&control, scheme, levels).unwrap();
            let scale = 1e-9 * diagonal;
            let key = |p: &[f64; 3]| p.map(|x| (x / scale / 1000.0).round() as i64);
            let mut near: HashMap<[i64; 3], Vec<[f64; 3]>> = HashMap::new();
            for p in reference.positions() {
                near.entry(key(p)).or_default().push(*p);
            }
            let finest = 1.0 / (1u64 << levels) as f64;
            for (p, origin) in result.mesh.positions().iter().zip(&result.origins) {
                if origin.barycentric.iter().any(|b| b % finest != 0.0) {
                    continue;
                }
                let [x, y, z] = key(p);
                let cells = (-1..=1)
                    .flat_map(|i| (-1..=1).flat_map(move |j| (-1..=1).map(move |k| [x + i, y + j, z + k])));
                let found = cells
                    .filter_map(|cell| near.get(&cell))
                    .flatten()
                    .any(|q| (0..3).all(|i| (p[i] - q[i]).abs() < scale));
                assert!(found, "{name}, {}: {p:?} from {origin:?}", scheme.name());
            }
        }
    }
}

#[test]
fn the_certified_bound_holds_and_is_tight() {
    for name in ["cup", "head", "teddy", "sphere", "sheet", "spike"] {
        let control = model(name);
        let tolerance = 0.002 * control.diagonal();
        let result = exact(&control, &Loop, &ExactOptions::default().tolerance(tolerance)).unwrap();
        assert_eq!(result.stop, ExactStop::Met);
        assert!(result.error.upper <= tolerance, "{name}: {}", result.error.upper);
        let reference = limit_reference(&control, &Loop, 6).unwrap();
        let samples = SamplingOptions::default().samples(200_000);
        let sampled = hausdorff(result.mesh.as_triangles(), reference.as_triangles(), &samples).unwrap();
        // The reference's own chords leave the surface, inwards, by less than this.
        let slack = 0.02 * tolerance;
        assert!(sampled.symmetric() <= result.error.upper + slack, "{name}: {}", sampled.symmetric());
        assert_eq!(
            result.mesh.topology().euler_characteristic(),
            control.topology().euler_characteristic(),
            "{name}"
        );
        assert_eq!(
            result.mesh.topology().boundary_edge_count() == 0,
            control.topology().boundary_edge_count() == 0
        );
    }
}

#[test]
fn schemes_of_other_families_are_refused() {
    let control = model("cube");
    let error = exact(&control, &ModifiedButterfly, &ExactOptions::default().tolerance(0.1)).unwrap_err();
    assert!(error.to_string().contains("butterfly"), "{error}");
}

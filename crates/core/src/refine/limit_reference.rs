//! The reference that the paper measures against: a control mesh refined uniformly, its vertices on the limit
//! surface.

use super::{RefineError, UniformOptions, uniform};
use crate::mesh::Mesh;
use crate::scheme::Scheme;

/// The limit surface of `control` under `scheme`, as triangles after `levels` uniform refinements with all vertices on
/// the surface: what the paper measures distances to (section 5).
///
/// Each level has four times the triangles of the one before; the chords still leave the surface by about a
/// quarter of what they did a level earlier, which bounds what a distance to this reference can tell.
///
/// # Errors
/// See [`RefineError`].
pub fn limit_reference(control: &Mesh, scheme: &dyn Scheme, levels: usize) -> Result<Mesh, RefineError> {
    Ok(uniform(control, scheme, &UniformOptions::default().levels(levels).limit(true))?.mesh)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limit::LimitTable;
    use crate::measure::{SamplingOptions, hausdorff};
    use crate::scheme::Loop;

    #[test]
    fn references_lie_on_the_limit_surface_and_close_in_on_it() {
        let corners = vec![
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [-1.0, 0.0, 0.0],
            [0.0, -1.0, 0.0],
            [0.0, 0.0, -1.0],
        ];
        let triangles =
            vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
        let control = Mesh::from_triangles(corners, triangles).unwrap();
        let scheme = Loop;
        let references: Vec<Mesh> =
            (0..=4).map(|levels| limit_reference(&control, &scheme, levels).unwrap()).collect();
        assert_eq!(references[3].face_count(), 8 * 64);

        // The limit positions of the control vertices are vertices of every level.
        for limit in LimitTable::new(&scheme).positions(&control).unwrap() {
            for reference in &references {
                let nearest = |p: &[f64; 3]| (0..3).map(|i| (p[i] - limit[i]).abs()).fold(0.0, f64::max);
                assert!(reference.positions().iter().any(|p| nearest(p) < 1e-12));
            }
        }
        // Once the triangles are small against the curvature, the distance between levels falls by about four.
        let options = SamplingOptions::default().samples(20_000);
        let distances: Vec<f64> = references[1..]
            .windows(2)
            .map(|pair| {
                hausdorff(pair[0].as_triangles(), pair[1].as_triangles(), &options).unwrap().symmetric()
            })
            .collect();
        for pair in distances.windows(2) {
            assert!((3.5..4.5).contains(&(pair[0] / pair[1])), "{distances:?}");
        }
    }
}

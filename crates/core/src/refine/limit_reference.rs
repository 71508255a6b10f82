//! The reference that the paper measures against: a control mesh refined uniformly, its vertices on the limit
//! surface.

use super::{RefineError, UniformOptions, uniform};
use crate::mesh::Mesh;
use crate::scheme::Scheme;

/// Levels that are enough for most: the distance of such a mesh to the limit surface is about a thousandth of the control
/// mesh's.
const USUAL_LEVELS: usize = 5;

/// The most triangles of a reference: it and its search tree take about a gigabyte.
const USUAL_TRIANGLES: usize = 4_000_000;

/// The least number of levels by which a reference is finer than the measured mesh: a mesh two
/// levels coarser is measured sixteenfold nearer than it is far itself.
const FINER: usize = 2;

/// Triangles that a reference has at most for that: four gigabytes.
const MOST_TRIANGLES: usize = 1 << 24;

/// The suitable levels of [`limit_reference`] for a mesh of `measured_triangles` triangles that is
/// measured against the limit surface of a control mesh of `control_faces` faces: five, or as many
/// as give four million triangles, but at least two more than take the control mesh about to the
/// measured mesh's number of triangles, so that a mesh is not compared with itself. `None` where
/// these give more than 16 million triangles: [`limit_distance`](super::limit_distance()) needs
/// fewer.
pub fn reference_levels(control_faces: usize, measured_triangles: usize) -> Option<usize> {
    let fits = |levels: usize, most: usize| {
        4usize
            .checked_pow(levels as u32)
            .and_then(|times| times.checked_mul(control_faces))
            .is_some_and(|n| n <= most)
    };
    let usual = (0..=USUAL_LEVELS)
        .rev()
        .find(|&levels| fits(levels, USUAL_TRIANGLES))
        .unwrap_or(0);
    // Nearer to the next level than to this one.
    let own = (0..)
        .take_while(|&levels| fits(levels, measured_triangles / 2))
        .count();
    Some(usual.max(own + FINER)).filter(|&levels| fits(levels, MOST_TRIANGLES))
}

/// The limit surface of `control` under `scheme`, as triangles after `levels` uniform refinements
/// with all vertices on the surface: the paper measures distances to these (section 5).
///
/// Each level has four times the triangles of the one before; the chords still leave the surface by
/// about a quarter of the distance a level earlier, which bounds the precision of a distance to
/// this reference.
///
/// # Errors
/// See [`RefineError`].
pub fn limit_reference(
    control: &Mesh,
    scheme: &dyn Scheme,
    levels: usize,
) -> Result<Mesh, RefineError> {
    Ok(uniform(
        control,
        scheme,
        &UniformOptions::default().levels(levels).limit(true),
    )?
    .mesh)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_are_two_levels_finer_than_what_is_measured() {
        // Small meshes have five levels, or as many as they can afford.
        assert_eq!(reference_levels(142, 5_000), Some(5));
        assert_eq!(reference_levels(3674, 20_000), Some(5));
        assert_eq!(reference_levels(5_000, 5_000), Some(4));
        // A mesh of five levels is compared with seven, one of nearly as many triangles, too.
        assert_eq!(reference_levels(200, 200 * 1024), Some(7));
        assert_eq!(reference_levels(200, 190 * 1024), Some(7));
        // Large ones with two levels, as long as there is room.
        assert_eq!(reference_levels(530_450, 530_450), Some(2));
        assert_eq!(reference_levels(530_450, 533_106), Some(2));
        assert_eq!(reference_levels(530_450, 4 * 530_450), None);
        assert_eq!(reference_levels(1_048_576, 1_000_000), Some(2));
        assert_eq!(reference_levels(1_048_577, 1_000_000), None);
        assert_eq!(reference_levels(3000, 3000 * 1024), None);
        assert_eq!(reference_levels(usize::MAX, usize::MAX), None);
    }
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
        let triangles = vec![
            [0, 1, 2],
            [1, 3, 2],
            [3, 4, 2],
            [4, 0, 2],
            [1, 0, 5],
            [3, 1, 5],
            [4, 3, 5],
            [0, 4, 5],
        ];
        let control = Mesh::from_triangles(corners, triangles).unwrap();
        let scheme = Loop;
        let references: Vec<Mesh> = (0..=4)
            .map(|levels| limit_reference(&control, &scheme, levels).unwrap())
            .collect();
        assert_eq!(references[3].face_count(), 8 * 64);

        // The limit positions of the control vertices are vertices of every level.
        for limit in LimitTable::new(&scheme).positions(&control).unwrap() {
            for reference in &references {
                let nearest =
                    |p: &[f64; 3]| (0..3).map(|i| (p[i] - limit[i]).abs()).fold(0.0, f64::max);
                assert!(reference.positions().iter().any(|p| nearest(p) < 1e-12));
            }
        }
        // Once the triangles are small against the curvature, the distance between levels falls by about four.
        let options = SamplingOptions::default().samples(20_000);
        let distances: Vec<f64> = references[1..]
            .windows(2)
            .map(|pair| {
                hausdorff(pair[0].as_triangles(), pair[1].as_triangles(), &options)
                    .unwrap()
                    .symmetric()
            })
            .collect();
        for pair in distances.windows(2) {
            assert!((3.5..4.5).contains(&(pair[0] / pair[1])), "{distances:?}");
        }
    }
}

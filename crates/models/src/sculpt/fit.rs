//! Control meshes whose Loop limit surface passes near given points.
//!
//! Progressive interpolation (Cheng et al. 2009): each control vertex is moved by what its limit position lacks;
//! for Loop's scheme this converges. Warren's weights stand for Loop's here: they differ by a few per cent and
//! need no cosine.

use super::Surface;
use glam::DVec3;

/// The whole surface of a half whose vertices are to lie on the limit: the half and its mirror image, its control
/// vertices moved in `rounds` rounds so that their limit positions approach where they stand now.
pub(crate) fn mirrored_with_limit_through(half: &Surface, rounds: usize) -> Surface {
    let mut whole = half.mirrored();
    let neighbours = whole.neighbours();
    for _ in 0..rounds {
        let mut moved = half.clone();
        for (v, (target, (all, boundary))) in half.positions.iter().zip(&neighbours).enumerate() {
            let p = whole.positions[v];
            moved.positions[v] = p + *target - limit_position(&whole.positions, p, all, boundary);
            // The mirror plane is kept exactly, whatever order the neighbours were added up in.
            if target.x == 0.0 {
                moved.positions[v].x = 0.0;
            }
        }
        whole.positions = moved.mirrored().positions;
    }
    whole
}

/// The limit of a vertex from its neighbours: cubic B-spline along a boundary, Loop's limit mask inside.
fn limit_position(positions: &[DVec3], p: DVec3, all: &[u32], boundary: &[u32]) -> DVec3 {
    let sum = |list: &[u32]| list.iter().map(|&u| positions[u as usize]).sum::<DVec3>();
    if !boundary.is_empty() {
        return (p * 4.0 + sum(boundary)) / 6.0;
    }
    let valence = all.len() as f64;
    let beta = if all.len() == 3 {
        3.0 / 16.0
    } else {
        3.0 / (8.0 * valence)
    };
    let weight = 1.0 / (3.0 / (8.0 * beta) + valence);
    p * (1.0 - valence * weight) + sum(all) * weight
}

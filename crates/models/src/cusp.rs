//! Three curved horns that sharpen to points, grown from one ball: curvature from nearly flat to nearly infinite.

use super::sculpt::field::{at, ball, fold, limb, union};
use super::sculpt::{Grid, Surface, sculpt};
use glam::DVec3;

/// Joints of a horn; so many that its bend and its taper look even.
const JOINTS: usize = 8;

/// 480 triangles, closed, genus 0.
pub(super) fn cusp() -> Surface {
    let grid = Grid::new([-0.75, -0.45], [1.0, 1.05, 0.85], 0.034);
    let horn = horn();
    sculpt(&|p| cusp_field(p, &horn), &grid, 480)
}

fn cusp_field(p: DVec3, horn: &[(DVec3, f64)]) -> f64 {
    let p = fold(p);
    let core = ball(p, at(0.0, 0.0, 0.0), 0.3);
    // The horns lie 120° apart: along y, and along (√3/2, −1/2) with its mirror image.
    let (along, across) = (0.866_025_403_784_438_6, -0.5);
    let upper = limb(at(p.y, p.x, p.z), horn, 0.02);
    let turned = at(along * p.x + across * p.y, across * p.x - along * p.y, p.z);
    let lower = limb(turned, horn, 0.02);
    union(core, union(upper, lower, 0.12), 0.14)
}

/// The joints of a horn along x that bends towards z, with its radii.
fn horn() -> [(DVec3, f64); JOINTS] {
    core::array::from_fn(|i| {
        let part = i as f64 / (JOINTS - 1) as f64;
        let joint = at(
            0.1 + 0.95 * part - 0.13 * part * part,
            0.0,
            0.62 * part * part - 0.02,
        );
        (joint, 0.02 + 0.24 * (1.0 - part) * (1.0 - 0.25 * part))
    })
}

//! Three curved horns that sharpen to points, grown from one ball: curvature from nearly flat to nearly infinite.

use super::sculpt::field::{at, ball, fold, limb, union};
use super::sculpt::{Grid, Surface, sculpt};
use crate::vector::DVec3;

/// 480 triangles, closed, genus 0.
pub(super) fn cusp() -> Surface {
    let grid = Grid::new([-0.75, -0.45], [1.0, 1.05, 0.85], 0.036);
    sculpt(&cusp_field, &grid, 480)
}

fn cusp_field(p: DVec3) -> f64 {
    let p = fold(p);
    let core = ball(p, at(0.0, 0.0, 0.0), 0.3);
    // The horns lie 120° apart: along y, and along (√3/2, −1/2) with its mirror image.
    let upper = horn(p.y, p.x, p.z);
    let (along, across) = (0.866_025_403_784_438_6, -0.5);
    let lower = horn(along * p.x + across * p.y, across * p.x - along * p.y, p.z);
    union(core, union(upper, lower, 0.12), 0.14)
}

/// A horn along the first direction that bends towards the third.
fn horn(along: f64, across: f64, bend: f64) -> f64 {
    let joints = [
        (at(0.1, 0.0, 0.0), 0.28),
        (at(0.4, 0.0, 0.02), 0.19),
        (at(0.65, 0.0, 0.12), 0.12),
        (at(0.84, 0.0, 0.3), 0.06),
        (at(0.93, 0.0, 0.54), 0.012),
    ];
    limb(DVec3::new(along, across, bend), &joints, 0.06)
}

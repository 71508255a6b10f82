//! A low shoe of 684 triangles, closed: upper with an opening and a tongue, sole with a heel.

use super::sculpt::field::{at, difference, ellipsoid, fold, intersection, rod, union};
use super::sculpt::{Grid, Surface, sculpt};
use crate::vector::DVec3;

/// 684 triangles, the toe towards +z.
pub(super) fn shoe() -> Surface {
    let grid = Grid::new([-0.55, -1.02], [0.48, 0.62, 1.06], 0.036);
    let mut shoe = sculpt(&shoe_field, &grid, 684);
    // A left shoe: the front half bends inwards.
    for p in &mut shoe.positions {
        p.x -= 0.09 * (p.z + 0.2).max(0.0).powi(2);
    }
    shoe
}

/// The outline of the sole seen from above, grown by `margin`, as a field in the plane.
fn outline(p: DVec3, margin: f64) -> f64 {
    let flat = DVec3::new(p.x, 0.0, p.z);
    let ball = ellipsoid(flat, at(0.0, 0.0, 0.42), at(0.35 + margin, 1.0, 0.54 + margin));
    let heel = ellipsoid(flat, at(0.0, 0.0, -0.6), at(0.255 + margin, 1.0, 0.33 + margin));
    let waist = rod(flat, at(0.0, 0.0, 0.2), 0.25 + margin, at(0.0, 0.0, -0.5), 0.21 + margin);
    union(union(ball, heel, 0.05), waist, 0.1)
}

fn shoe_field(p: DVec3) -> f64 {
    let p = fold(p);
    let vamp = ellipsoid(p, at(0.0, -0.3, 0.4), at(0.33, 0.29, 0.56));
    let instep = rod(p, at(0.0, -0.2, 0.3), 0.25, at(0.0, 0.14, -0.25), 0.26);
    let counter = rod(p, at(0.0, -0.25, -0.6), 0.27, at(0.0, 0.3, -0.54), 0.24);
    let collar = rod(p, at(0.0, 0.3, -0.58), 0.22, at(0.0, 0.26, -0.25), 0.23);
    let arch = rod(p, at(0.0, -0.2, 0.3), 0.22, at(0.0, -0.2, -0.6), 0.22);
    let mut upper = union(union(union(vamp, arch, 0.05), instep, 0.25), union(counter, collar, 0.1), 0.2);
    upper = intersection(upper, outline(p, 0.0), 0.08);
    // The top edge of the quarters slopes down towards the heel's dip and up to the tongue.
    upper = intersection(upper, p.y - 0.38 - 0.1 * (p.z + 0.4), 0.04);
    let cavity = ellipsoid(p, at(0.0, 0.5, -0.44), at(0.16, 0.55, 0.3));
    let tongue = rod(p, at(0.0, 0.2, 0.02), 0.09, at(0.0, 0.46, -0.14), 0.06);
    upper = union(difference(upper, cavity, 0.05), tongue, 0.05);
    let slab = (p.y + 0.38).abs() - 0.05;
    let sole = intersection(outline(p, 0.05), slab, 0.05);
    let block =
        intersection(intersection(outline(p, 0.03), (p.y + 0.44).abs() - 0.09, 0.04), p.z + 0.32, 0.04);
    union(upper, union(sole, block, 0.02), 0.03)
}

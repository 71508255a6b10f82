//! A radish: round bulb, thin root, two leaves; closed, genus 0.

use super::sculpt::field::{at, ellipsoid, fold, limb, union};
use super::sculpt::{Grid, Surface, sculpt};
use glam::DVec3;

/// 640 triangles, the root down, the leaves to both sides.
pub(super) fn radish() -> Surface {
    let grid = Grid::new([-1.05, -0.5], [0.75, 1.02, 0.5], 0.034);
    sculpt(&radish_field, &grid, 640)
}

fn radish_field(p: DVec3) -> f64 {
    let p = fold(p);
    let bulb = ellipsoid(p, at(0.0, -0.3, 0.0), at(0.42, 0.38, 0.42));
    let root = limb(
        p,
        &[
            (at(0.0, -0.5, 0.0), 0.2),
            (at(0.0, -0.72, 0.0), 0.075),
            (at(0.0, -1.0, 0.06), 0.022),
        ],
        0.08,
    );
    let stalk = limb(
        p,
        &[
            (at(0.0, 0.02, 0.0), 0.08),
            (at(0.1, 0.22, 0.0), 0.05),
            (at(0.2, 0.4, 0.0), 0.045),
        ],
        0.05,
    );
    // The blade is a chain of balls pressed flat across its own, gently bowed, surface.
    let bow = p.z - 0.5 * (p.x - 0.3) * (p.x - 0.3);
    let flat = DVec3::new(p.x, p.y, 2.6 * bow);
    let blade = limb(
        flat,
        &[
            (at(0.17, 0.34, 0.0), 0.06),
            (at(0.28, 0.54, 0.0), 0.15),
            (at(0.42, 0.74, 0.0), 0.16),
            (at(0.56, 0.92, 0.0), 0.05),
        ],
        0.08,
    );
    let body = union(bulb, root, 0.12);
    union(
        union(body, stalk, 0.08),
        union(stalk, 0.5 * blade, 0.05),
        0.02,
    )
}

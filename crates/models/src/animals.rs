//! Three stylised animals, closed and of genus 0: a rabbit, a teddy bear, a shark.

use super::sculpt::field::{at, ball, blade, difference, ellipsoid, fold, limb, rod, union};
use super::sculpt::{Grid, Surface, sculpt};
use glam::DVec3;

/// A sitting rabbit, looking to the front, 900 triangles.
pub(super) fn bunny() -> Surface {
    let grid = Grid::new([-0.82, -0.75], [0.6, 1.02, 0.62], 0.034);
    sculpt(&bunny_field, &grid, 900)
}

fn bunny_field(p: DVec3) -> f64 {
    let p = fold(p);
    let body = ellipsoid(p, at(0.0, -0.38, -0.15), at(0.36, 0.4, 0.44));
    let chest = ball(p, at(0.0, -0.2, 0.1), 0.26);
    let haunch = ellipsoid(p, at(0.27, -0.5, -0.16), at(0.17, 0.24, 0.29));
    let foot = rod(
        p,
        at(0.27, -0.72, -0.05),
        0.08,
        at(0.25, -0.73, 0.24),
        0.075,
    );
    let arm = rod(p, at(0.13, -0.3, 0.25), 0.09, at(0.11, -0.71, 0.37), 0.075);
    let tail = ball(p, at(0.0, -0.55, -0.6), 0.13);
    let skull = ellipsoid(p, at(0.0, 0.18, 0.2), at(0.235, 0.225, 0.26));
    let cheek = ball(p, at(0.1, 0.1, 0.34), 0.12);
    let muzzle = ball(p, at(0.0, 0.1, 0.44), 0.085);
    let ear = ear(p);
    let mut value = union(body, chest, 0.2);
    value = union(value, haunch, 0.06);
    value = union(value, foot, 0.05);
    value = union(value, arm, 0.07);
    value = union(value, tail, 0.04);
    let mut head = union(skull, cheek, 0.1);
    head = union(head, muzzle, 0.07);
    head = union(head, ear, 0.06);
    value = union(value, head, 0.1);
    let socket = ball(p, at(0.235, 0.25, 0.36), 0.07);
    difference(value, socket, 0.04)
}

/// The rabbit's ear: a long leaf with a hollow in front.
fn ear(p: DVec3) -> f64 {
    let leaf = limb(
        p,
        &[
            (at(0.09, 0.3, 0.13), 0.065),
            (at(0.15, 0.55, 0.05), 0.095),
            (at(0.18, 0.76, 0.0), 0.09),
            (at(0.2, 0.93, -0.02), 0.05),
        ],
        0.05,
    );
    let hollow = limb(
        p,
        &[(at(0.14, 0.5, 0.16), 0.04), (at(0.19, 0.8, 0.09), 0.045)],
        0.05,
    );
    difference(leaf, hollow, 0.04)
}

/// A sitting teddy bear, 800 triangles.
pub(super) fn teddy() -> Surface {
    let grid = Grid::new([-0.85, -0.55], [0.85, 1.02, 0.85], 0.038);
    sculpt(&teddy_field, &grid, 800)
}

fn teddy_field(p: DVec3) -> f64 {
    let p = fold(p);
    let body = ellipsoid(p, at(0.0, -0.3, 0.0), at(0.4, 0.46, 0.35));
    let skull = ellipsoid(p, at(0.0, 0.42, 0.06), at(0.38, 0.34, 0.34));
    let muzzle = ellipsoid(p, at(0.0, 0.34, 0.36), at(0.17, 0.14, 0.16));
    let nose = ellipsoid(p, at(0.0, 0.4, 0.52), at(0.06, 0.045, 0.05));
    let ear = ellipsoid(p, at(0.31, 0.75, 0.0), at(0.16, 0.16, 0.085));
    let ear_hollow = ball(p, at(0.33, 0.77, 0.13), 0.1);
    let arm = limb(
        p,
        &[
            (at(0.34, -0.02, 0.03), 0.14),
            (at(0.56, -0.2, 0.2), 0.135),
            (at(0.66, -0.28, 0.36), 0.14),
        ],
        0.06,
    );
    let leg = limb(
        p,
        &[(at(0.24, -0.6, 0.1), 0.18), (at(0.4, -0.64, 0.52), 0.165)],
        0.06,
    );
    let paw = ellipsoid(p, at(0.42, -0.58, 0.66), at(0.17, 0.22, 0.11));
    let socket = ball(p, at(0.15, 0.52, 0.44), 0.075);
    let mut head = union(skull, muzzle, 0.06);
    head = union(head, nose, 0.03);
    head = union(head, difference(ear, ear_hollow, 0.05), 0.04);
    head = difference(head, socket, 0.04);
    let mut value = union(body, head, 0.08);
    value = union(value, arm, 0.06);
    union(value, union(leg, paw, 0.08), 0.06)
}

/// A shark that swims to the front, 700 triangles.
pub(super) fn shark() -> Surface {
    let grid = Grid::new([-0.45, -1.25], [0.8, 0.7, 1.1], 0.03);
    sculpt(&shark_field, &grid, 700)
}

fn shark_field(p: DVec3) -> f64 {
    let p = fold(p);
    let trunk = ellipsoid(p, at(0.0, 0.0, 0.17), at(0.21, 0.235, 0.82));
    let snout = ellipsoid(p, at(0.0, 0.04, 0.75), at(0.13, 0.1, 0.26));
    let stem = rod(p, at(0.0, 0.0, -0.2), 0.16, at(0.0, 0.04, -0.88), 0.05);
    let mouth = ellipsoid(p, at(0.0, -0.17, 0.72), at(0.13, 0.07, 0.1));
    // Fins are flat blades: those in the middle by (z, y), the paired ones by (x, z) on a slope.
    let upright = [p.z, p.y, p.x];
    let dorsal = blade(
        upright,
        &[[0.32, 0.1], [-0.2, 0.62], [-0.24, 0.56], [-0.12, 0.1]],
        0.05,
        0.05,
    );
    let second = blade(
        upright,
        &[[-0.4, 0.02], [-0.66, 0.27], [-0.62, 0.02]],
        0.04,
        0.04,
    );
    let upper_tail = blade(
        upright,
        &[[-0.7, 0.0], [-1.16, 0.66], [-1.2, 0.6], [-0.95, -0.02]],
        0.045,
        0.05,
    );
    let lower_tail = blade(
        upright,
        &[[-0.76, 0.12], [-0.93, 0.08], [-1.1, -0.34], [-1.06, -0.38]],
        0.045,
        0.05,
    );
    let slope = [p.x, p.z, p.y + 0.08 + 0.3 * p.x];
    let pectoral = blade(
        slope,
        &[[0.05, 0.12], [0.72, -0.17], [0.74, -0.1], [0.05, 0.47]],
        0.045,
        0.05,
    );
    let pelvic = blade(
        slope,
        &[[0.0, -0.45], [0.32, -0.58], [0.0, -0.22]],
        0.04,
        0.04,
    );
    let mut body = union(union(trunk, snout, 0.15), stem, 0.16);
    body = difference(body, mouth, 0.04);
    [
        dorsal,
        second,
        union(upper_tail, lower_tail, 0.04),
        pectoral,
        pelvic,
    ]
    .iter()
    .fold(body, |body, &fin| union(body, fin, 0.06))
}

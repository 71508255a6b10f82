//! A low shoe of 684 triangles, closed, built as on a last: rings of vertices from the middle of the sole's
//! underside out to its edge, up over the upper to the collar, and down inside to the insole.

use super::sculpt::Surface;
use glam::DVec3;

/// Vertices of a ring on one side, from toe to heel, both of which lie in the middle.
const STATIONS: usize = 10;

/// Vertices of a ring: 18 · (18 strips · 2 + 2 fans) = 684 triangles.
const AROUND: u32 = 2 * (STATIONS as u32 - 1);

/// What a station is in each of the outlines: x and z of the sole's edge, of the collar and of the insole, how far
/// it belongs to the vamp (1) rather than to the quarters (0), and the height of the underside.
struct Station {
    sole: [f64; 2],
    collar: [f64; 2],
    insole: [f64; 2],
    vamp: f64,
    ground: f64,
}

const fn station(
    sole: [f64; 2],
    collar: [f64; 2],
    insole: [f64; 2],
    vamp: f64,
    ground: f64,
) -> Station {
    Station {
        sole,
        collar,
        insole,
        vamp,
        ground,
    }
}

const OUTLINES: [Station; STATIONS] = [
    station([0.0, 1.0], [0.0, 0.1], [0.0, 0.35], 1.0, -0.43),
    station([0.21, 0.92], [0.075, 0.08], [0.1, 0.32], 1.0, -0.46),
    station([0.33, 0.72], [0.12, 0.01], [0.16, 0.22], 0.95, -0.5),
    station([0.375, 0.44], [0.15, -0.1], [0.18, 0.08], 0.8, -0.51),
    station([0.34, 0.14], [0.17, -0.23], [0.18, -0.08], 0.55, -0.48),
    station([0.275, -0.16], [0.18, -0.37], [0.18, -0.27], 0.25, -0.41),
    station([0.265, -0.42], [0.185, -0.51], [0.18, -0.45], 0.08, -0.52),
    station([0.275, -0.68], [0.175, -0.65], [0.17, -0.63], 0.0, -0.55),
    station([0.2, -0.88], [0.115, -0.76], [0.11, -0.74], 0.0, -0.55),
    station([0.0, -0.96], [0.0, -0.8], [0.0, -0.78], 0.0, -0.55),
];

/// Height of the sole's upper side.
const SOLE_TOP: f64 = -0.33;

/// The upper's rings: how far from the sole's edge to the collar, height on the vamp and on the quarters.
const UPPER: [[f64; 3]; 8] = [
    [0.03, 0.05, 0.06],
    [0.05, 0.14, 0.17],
    [0.13, 0.22, 0.28],
    [0.32, 0.28, 0.39],
    [0.56, 0.37, 0.49],
    [0.78, 0.5, 0.57],
    [0.94, 0.64, 0.63],
    [1.0, 0.72, 0.66],
];

/// The shoe, its toe towards +z.
pub(super) fn shoe() -> Surface {
    let mut rings: Vec<[DVec3; STATIONS]> = Vec::new();
    let mut ring = |position: &dyn Fn(&Station) -> DVec3| {
        rings.push(core::array::from_fn(|k| position(&OUTLINES[k])));
    };
    // The underside and the edge of the sole; close rings make its edges rather sharp.
    ring(&|s| scaled(s.sole, 0.5, s.ground + 0.005));
    ring(&|s| scaled(s.sole, 0.93, s.ground));
    ring(&|s| scaled(s.sole, 1.01, s.ground + 0.02));
    ring(&|s| scaled(s.sole, 1.03, SOLE_TOP - 0.03));
    ring(&|s| scaled(s.sole, 1.01, SOLE_TOP));
    ring(&|s| scaled(s.sole, 0.95, SOLE_TOP));
    for [part, vamp, quarter] in UPPER {
        ring(&|s| {
            let out = scaled(s.sole, 0.95, 0.0).lerp(scaled(s.collar, 1.0, 0.0), part);
            out.with_y(SOLE_TOP + quarter + (vamp - quarter) * s.vamp - dip(s, part))
        });
    }
    // The collar's rounded edge, the lining and the insole.
    let collar_top = |s: &Station| SOLE_TOP + 0.66 + 0.06 * s.vamp - dip(s, 1.0);
    ring(&|s| shrunk(s.collar, 0.035, collar_top(s) - 0.01));
    ring(&|s| shrunk(s.collar, 0.05, collar_top(s) - 0.09));
    ring(&|s| shrunk(s.insole, 0.03, -0.02));
    ring(&|s| shrunk(s.insole, 0.01, -0.22));
    ring(&|s| shrunk(s.insole, 0.07, -0.25));
    loft(&rings)
}

/// The collar dips at the ankle, between tongue and heel.
fn dip(station: &Station, part: f64) -> f64 {
    let side = station.collar[0] / 0.185;
    0.09 * part * part * side * side
}

/// A point of an outline scaled about the shoe's middle, at height `y`.
fn scaled([x, z]: [f64; 2], scale: f64, y: f64) -> DVec3 {
    DVec3::new(x * scale, y, z * scale)
}

/// A point of an outline moved inwards by about `by`, towards the middle of the heel.
fn shrunk([x, z]: [f64; 2], by: f64, y: f64) -> DVec3 {
    let inwards = DVec3::new(-x, 0.0, -0.35 - z).normalize_or_zero();
    DVec3::new(x, y, z) + inwards * by
}

/// The closed surface through the rings, with a fan at both ends.
fn loft(rings: &[[DVec3; STATIONS]]) -> Surface {
    let mut shoe = Surface::default();
    for ring in rings {
        shoe.positions.extend(ring);
        shoe.positions
            .extend(ring[1..STATIONS - 1].iter().rev().map(|p| p.with_x(-p.x)));
    }
    let vertex = |ring: usize, k: u32| ring as u32 * AROUND + k % AROUND;
    for strip in 0..rings.len() - 1 {
        for k in 0..AROUND {
            let [a, b] = [k, k + 1].map(|k| vertex(strip, k));
            let [d, c] = [k, k + 1].map(|k| vertex(strip + 1, k));
            // The diagonals on both sides mirror each other.
            if k < AROUND / 2 {
                shoe.triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                shoe.triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    for (ring, outwards) in [(0, false), (rings.len() - 1, true)] {
        let pole = shoe.positions.len() as u32;
        let first = ring * AROUND as usize;
        let members = &shoe.positions[first..first + AROUND as usize];
        let centre = members.iter().sum::<DVec3>() / f64::from(AROUND);
        shoe.positions.push(centre);
        shoe.triangles.extend((0..AROUND).map(|k| {
            let [a, b] = [k, k + 1].map(|k| vertex(ring, k));
            if outwards { [a, b, pole] } else { [b, a, pole] }
        }));
    }
    // A foot is not symmetric: the front half bends to one side.
    for p in &mut shoe.positions {
        let forward = (p.z + 0.2).max(0.0);
        p.x -= 0.08 * forward * forward;
    }
    shoe
}

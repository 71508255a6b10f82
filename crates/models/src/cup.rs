//! A cup: a lathed wall and floor with rather sharp rims, and a handle swept between two holes in the wall.

use core::f64::consts::TAU;

use super::sculpt::Surface;
use glam::DVec3;
use limitmesh_mesh::math;

/// Cells around the axis.
const SECTORS: u32 = 18;

/// Radius and height of the rings, from the underside over the rim to the floor inside. Close pairs of rings make
/// the rims sharp.
const PROFILE: [[f64; 2]; 17] = [
    [0.28, -0.62],
    [0.46, -0.62],
    [0.5, -0.6],
    [0.52, -0.5],
    [0.53, -0.36],
    [0.54, -0.2],
    [0.55, 0.0],
    [0.56, 0.2],
    [0.57, 0.36],
    [0.58, 0.55],
    [0.585, 0.62],
    [0.535, 0.62],
    [0.525, 0.54],
    [0.49, 0.0],
    [0.46, -0.47],
    [0.4, -0.53],
    [0.2, -0.53],
];

/// The strips of the outer wall (by their lower ring) where the handle joins.
const HANDLE_STRIPS: [u32; 2] = [7, 4];

/// Strips of the handle between the upper and the lower hole.
const SECTIONS: usize = 8;

/// 700 triangles, genus 1, the handle towards +x.
pub(super) fn cup() -> Surface {
    let mut cup = Surface::default();
    for [radius, height] in PROFILE {
        for sector in 0..SECTORS {
            let (sin, cos) = math::sin_cos(TAU * f64::from(sector) / f64::from(SECTORS));
            cup.positions
                .push(DVec3::new(radius * cos, height, -radius * sin));
        }
    }
    let rings = PROFILE.len() as u32;
    for strip in 0..rings - 1 {
        for sector in 0..SECTORS {
            let next_to_handle = sector == 0 || sector == SECTORS - 1;
            if !(next_to_handle && HANDLE_STRIPS.contains(&strip)) {
                let [a, b] = [sector, sector + 1].map(|s| vertex(strip, s));
                let [d, c] = [sector, sector + 1].map(|s| vertex(strip + 1, s));
                cup.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    close_with_pole(&mut cup, 0, PROFILE[0][1]);
    close_with_pole(&mut cup, rings - 1, PROFILE[PROFILE.len() - 1][1]);
    add_handle(&mut cup);
    cup
}

fn vertex(ring: u32, sector: u32) -> u32 {
    ring * SECTORS + sector % SECTORS
}

/// Closes the first or the last ring by a fan to a vertex on the axis.
fn close_with_pole(cup: &mut Surface, ring: u32, height: f64) {
    let pole = cup.positions.len() as u32;
    cup.positions.push(DVec3::new(0.0, height, 0.0));
    cup.triangles.extend((0..SECTORS).map(|sector| {
        let [a, b] = [sector, sector + 1].map(|s| vertex(ring, s));
        if ring == 0 {
            [pole, b, a]
        } else {
            [a, b, pole]
        }
    }));
}

/// Sweeps a hexagon from the upper hole along half an ellipse to the lower hole.
fn add_handle(cup: &mut Surface) {
    // The six vertices of a hole, clockwise seen from outside, starting on the handle's outer side: for the upper
    // hole that is the upper edge, for the lower hole the lower edge.
    let hole = |outer: u32, inner: u32| {
        [
            (outer, SECTORS - 1),
            (outer, 0),
            (outer, 1),
            (inner, 1),
            (inner, 0),
            (inner, SECTORS - 1),
        ]
        .map(|(ring, sector)| vertex(ring, sector))
    };
    let upper = hole(HANDLE_STRIPS[0] + 1, HANDLE_STRIPS[0]);
    let lower = hole(HANDLE_STRIPS[1], HANDLE_STRIPS[1] + 1);
    let mut before = upper;
    for section in 1..=SECTIONS {
        let after = if section == SECTIONS {
            lower
        } else {
            let first = cup.positions.len() as u32;
            cup.positions
                .extend(handle_section(section as f64 / SECTIONS as f64));
            core::array::from_fn(|i| first + i as u32)
        };
        for i in 0..6 {
            let j = (i + 1) % 6;
            cup.triangles.extend([
                [before[j], before[i], after[i]],
                [before[j], after[i], after[j]],
            ]);
        }
        before = after;
    }
}

/// The hexagon of the handle at `part` of its way from the upper to the lower hole.
fn handle_section(part: f64) -> [DVec3; 6] {
    let (sin, cos) = math::sin_cos(TAU / 2.0 * part);
    let centre = DVec3::new(0.56 + 0.42 * sin, 0.33 * cos, 0.0);
    let outwards = DVec3::new(sin, 0.9 * cos, 0.0).normalize();
    // Wide where it meets the wall, slender half-way.
    let width = 0.08 + 0.08 * cos * cos;
    let thickness = 0.06;
    let corner =
        |side: f64, out: f64| centre + DVec3::Z * (width * side) + outwards * (thickness * out);
    // Sector SECTORS − 1 lies towards +z, sector 1 towards −z.
    [
        corner(1.0, 0.7),
        corner(0.0, 1.0),
        corner(-1.0, 0.7),
        corner(-1.0, -0.7),
        corner(0.0, -1.0),
        corner(1.0, -0.7),
    ]
}

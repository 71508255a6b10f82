//! Control meshes sampled from closed forms: sphere, torus, wavy sheet, spike.

use core::f64::consts::TAU;

use super::sculpt::Surface;
use glam::DVec3;
use limitmesh_mesh::math;

/// The vertices (u, v) of a grid that closes on itself in the directions asked for, two triangles a cell.
///
/// Seen with u to the right and v up, the triangles run counter-clockwise.
fn grid(cells: [u32; 2], closed: [bool; 2], position: impl Fn(f64, f64) -> DVec3) -> Surface {
    let [nu, nv] = [0, 1].map(|i| cells[i] + u32::from(!closed[i]));
    let mut surface = Surface::default();
    for j in 0..nv {
        for i in 0..nu {
            let (u, v) = (
                f64::from(i) / f64::from(cells[0]),
                f64::from(j) / f64::from(cells[1]),
            );
            surface.positions.push(position(u, v));
        }
    }
    for j in 0..cells[1] {
        for i in 0..cells[0] {
            let at = |i: u32, j: u32| (j % nv) * nu + i % nu;
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            surface.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    surface
}

/// The unit sphere by longitude and latitude: 20 slices, 10 stacks, poles of valence 20; 360 triangles, of which
/// two uniform steps make 5,760.
pub(super) fn sphere() -> Surface {
    const SLICES: u32 = 20;
    const STACKS: u32 = 10;
    let mut surface = Surface::default();
    surface.positions.push(-DVec3::Y);
    for stack in 1..STACKS {
        let (radius, depth) = math::sin_cos(TAU / 2.0 * f64::from(stack) / f64::from(STACKS));
        for slice in 0..SLICES {
            let (x, z) = math::sin_cos(TAU * f64::from(slice) / f64::from(SLICES));
            surface
                .positions
                .push(DVec3::new(radius * x, -depth, radius * z));
        }
    }
    surface.positions.push(DVec3::Y);
    let north = surface.positions.len() as u32 - 1;
    for i in 0..SLICES {
        let next = (i + 1) % SLICES;
        let ring = |stack: u32, i: u32| 1 + (stack - 1) * SLICES + i;
        surface.triangles.push([0, ring(1, next), ring(1, i)]);
        for stack in 1..STACKS - 1 {
            let [a, b] = [i, next].map(|i| ring(stack, i));
            let [d, c] = [i, next].map(|i| ring(stack + 1, i));
            surface.triangles.extend([[a, b, c], [a, c, d]]);
        }
        surface
            .triangles
            .push([ring(STACKS - 1, i), ring(STACKS - 1, next), north]);
    }
    surface
}

/// A torus about the y axis with radii 0.7 and 0.3: 16 × 8 cells, 256 triangles, every valence 6.
pub(super) fn torus() -> Surface {
    grid([16, 8], [true, true], |u, v| {
        let (x, z) = math::sin_cos(TAU * u);
        let (height, out) = math::sin_cos(TAU * v);
        let radius = 0.7 + 0.3 * out;
        DVec3::new(radius * x, 0.3 * height, radius * z)
    })
}

/// An open wavy sheet of 12 × 12 cells, 288 triangles, with one boundary.
pub(super) fn sheet() -> Surface {
    grid([12, 12], [false, false], |u, v| {
        let (x, z) = (2.0 * u - 1.0, 1.0 - 2.0 * v);
        // Two waves that cross, one of them growing to the right.
        let height = 0.16 * math::sin(TAU * (0.9 * x + 0.2 * z))
            + 0.12 * (1.0 + x) * math::cos(TAU * 0.7 * z);
        DVec3::new(x, height - 0.1, z)
    })
}

/// A witch's hat: a pole of valence 64 whose slope steepens to a spike, with an open rim; 320 triangles.
pub(super) fn spike() -> Surface {
    const SLICES: u32 = 64;
    /// Radius and height of each ring, from the rim to the one below the tip.
    const RINGS: [[f64; 2]; 3] = [[1.0, -0.5], [0.55, -0.4], [0.22, 0.0]];
    let mut surface = grid([SLICES, RINGS.len() as u32 - 1], [true, false], |u, v| {
        let (x, z) = math::sin_cos(TAU * u);
        let [radius, height] = RINGS[(v * (RINGS.len() - 1) as f64).round() as usize];
        DVec3::new(radius * x, height, radius * z)
    });
    let tip = surface.positions.len() as u32;
    surface.positions.push(DVec3::new(0.0, 1.0, 0.0));
    let last = tip - SLICES;
    surface
        .triangles
        .extend((0..SLICES).map(|i| [last + i, last + (i + 1) % SLICES, tip]));
    surface
}

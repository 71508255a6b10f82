//! An ellipsoid with a head's proportions, evenly faceted: what is left of a head without nose and ears.
//!
//! Points of a sphere that turn by the golden angle from one to the next while they sink, each as far as its share of the area
//! (Fibonacci's spiral), their convex hull, and that stretched.

use core::f64::consts::PI;

use super::sculpt::Surface;
use glam::DVec3;
use limitmesh_mesh::math;

/// A closed surface of so many points has 2·73 − 4 = 142 triangles.
const POINTS: u32 = 73;

/// Half of width, height and depth.
const AXES: DVec3 = DVec3::new(0.5, 0.8, 0.6);

/// A hull's other points are below its triangles by more than this, and its own are not.
const IN_PLANE: f64 = 1e-9;

/// 142 triangles, closed; semi-axes in the ratio 1 : 1.2 : 1.6 of width, depth and height.
pub(super) fn ellipsoid() -> Surface {
    let positions = (0..POINTS)
        .map(|i| {
            let part = f64::from(i) + 0.5;
            let height = 1.0 - 2.0 * part / f64::from(POINTS);
            let (sine, cosine) = math::sin_cos(PI * (1.0 + 5.0_f64.sqrt()) * part);
            let radius = (1.0 - height * height).sqrt();
            DVec3::new(radius * cosine, height, radius * sine)
        })
        .collect();
    let mut surface = Surface {
        positions,
        triangles: Vec::new(),
    };
    surface.triangles = hull(&surface.positions);
    surface.positions.iter_mut().for_each(|p| *p *= AXES);
    surface
}

/// The triangles of the convex hull of points on a sphere around the origin, no four of them in a plane that bounds it.
fn hull(points: &[DVec3]) -> Vec<[u32; 3]> {
    let mut triangles = Vec::new();
    for a in 0..points.len() {
        for b in a + 1..points.len() {
            for c in b + 1..points.len() {
                let [p, q, r] = [points[a], points[b], points[c]];
                let normal = (q - p).cross(r - p);
                let outwards = normal * normal.dot(p).signum();
                if points.iter().all(|s| (*s - p).dot(outwards) < IN_PLANE) {
                    let [a, b, c] = [a, b, c].map(|v| v as u32);
                    triangles.push(if normal.dot(p) > 0.0 {
                        [a, b, c]
                    } else {
                        [a, c, b]
                    });
                }
            }
        }
    }
    triangles
}

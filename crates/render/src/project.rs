//! From space to the picture: projected vertices, and the pieces of triangles that can be seen.
//!
//! Triangles that reach behind the eye or far out of the picture are clipped in homogeneous coordinates
//! (Sutherland and Hodgman), so that what the rasteriser gets fits its fixed-point numbers.

use limitmesh::Triangles;

use crate::camera::{Camera, Homogeneous};
use crate::parallel;

/// Steps of the fixed-point grid in a pixel. With the borders below, edge functions stay under 2⁵¹.
pub(crate) const STEPS: i32 = 256;

/// How far beyond the picture a corner may lie, in pixels, before its triangle is clipped.
const BORDER: f64 = 16_384.0;

/// The nearest visible distance of a perspective, as a part of the farthest one. Depths are proportional to the
/// inverse distance, whose relative precision does not depend on this; corners in f64 leave 1e-8 of it at the far
/// end of a triangle that starts at the near one.
const NEAR: f64 = 1e-8;

/// A corner on the fixed-point grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Corner {
    pub(crate) x: i32,
    pub(crate) y: i32,
    /// Linear in the picture, 0 (far) to 1 (near).
    pub(crate) depth: f64,
}

/// Marks corners of the mesh that lie behind the eye or too far out.
const OUTSIDE: Corner = Corner {
    x: i32::MIN,
    y: i32::MIN,
    depth: 0.0,
};

/// A triangle or a part of one, ready for rasterising.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    pub(crate) corners: [u32; 3],
    /// The triangle it belongs to.
    pub(crate) face: u32,
}

/// Everything projected.
pub(crate) struct Projected {
    /// Picture coordinates of each vertex of the mesh.
    pub(crate) homogeneous: Vec<Homogeneous>,
    /// The mesh's vertices on the grid, then those that clipping added.
    pub(crate) corners: Vec<Corner>,
    pub(crate) pieces: Vec<Piece>,
}

/// The picture's size and what of the space in front of it is visible.
#[derive(Clone, Copy)]
struct Frustum {
    width: f64,
    height: f64,
    near: f64,
    perspective: bool,
    low: f64,
    per_distance: f64,
}

impl Frustum {
    fn new(camera: &Camera, points: &[Homogeneous], width: u32, height: u32) -> Self {
        let ends = points.iter().map(|p| p.distance);
        let (low, high) = ends.fold((f64::MAX, f64::MIN), |(a, b), d| (a.min(d), b.max(d)));
        let per_distance = if high > low { 1.0 / (high - low) } else { 0.0 };
        let near = (NEAR * high).max(f64::MIN_POSITIVE);
        let perspective = camera.is_perspective();
        Self {
            width: width.into(),
            height: height.into(),
            near,
            perspective,
            low,
            per_distance,
        }
    }

    /// Signed distances from the five planes that a triangle may be clipped at; inside is not negative.
    fn planes(&self, p: &Homogeneous) -> [f64; 5] {
        let near = if self.perspective {
            p.w - self.near
        } else {
            1.0
        };
        [
            near,
            p.x + BORDER * p.w,
            (self.width + BORDER) * p.w - p.x,
            p.y + BORDER * p.w,
            (self.height + BORDER) * p.w - p.y,
        ]
    }

    fn contains(&self, p: &Homogeneous) -> bool {
        self.planes(p).iter().all(|&d| d >= 0.0)
    }

    /// A point inside on the grid.
    fn corner(&self, p: &Homogeneous) -> Corner {
        let grid = |value: f64| (value / p.w * f64::from(STEPS)).round() as i32;
        let depth = if self.perspective {
            self.near / p.w
        } else {
            1.0 - (p.distance - self.low) * self.per_distance
        };
        Corner {
            x: grid(p.x),
            y: grid(p.y),
            depth,
        }
    }

    /// Corner of a vertex of the mesh, or the mark that it needs clipping.
    fn corner_or_mark(&self, p: &Homogeneous) -> Corner {
        if self.contains(p) {
            self.corner(p)
        } else {
            OUTSIDE
        }
    }
}

/// Projects a surface whose indices and positions have been checked.
pub(crate) fn project(
    surface: Triangles<'_>,
    camera: &Camera,
    width: u32,
    height: u32,
) -> Projected {
    let positions = surface.positions;
    let homogeneous = parallel::map(positions.len(), |v| {
        camera.homogeneous(positions[v], width, height)
    });
    let frustum = Frustum::new(camera, &homogeneous, width, height);
    let mut corners = parallel::map(positions.len(), |v| frustum.corner_or_mark(&homogeneous[v]));
    let mut pieces = Vec::with_capacity(surface.triangles.len());
    for (face, &triangle) in surface.triangles.iter().enumerate() {
        let face = face as u32;
        if triangle.iter().all(|&v| corners[v as usize] != OUTSIDE) {
            pieces.push(Piece {
                corners: triangle,
                face,
            });
        } else {
            let polygon = clip(&frustum, triangle.map(|v| homogeneous[v as usize]));
            let first = corners.len() as u32;
            corners.extend(polygon.iter().map(|p| frustum.corner(p)));
            let fan = (2..polygon.len() as u32).map(|i| [first, first + i - 1, first + i]);
            pieces.extend(fan.map(|corners| Piece { corners, face }));
        }
    }
    Projected {
        homogeneous,
        corners,
        pieces,
    }
}

/// The part of a triangle inside of all planes: a convex polygon, perhaps empty.
///
/// A crossing is always computed from the inner end to the outer one, so that two triangles that share an edge
/// are cut at the same point of it.
fn clip(frustum: &Frustum, triangle: [Homogeneous; 3]) -> Vec<Homogeneous> {
    let mut polygon = triangle.to_vec();
    for plane in 0..5 {
        let distance = |p: &Homogeneous| frustum.planes(p)[plane];
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (i, a) in polygon.iter().enumerate() {
            let b = &polygon[(i + 1) % polygon.len()];
            let (da, db) = (distance(a), distance(b));
            if da >= 0.0 {
                kept.push(*a);
            }
            if (da >= 0.0) != (db >= 0.0) {
                let crossing = if da >= 0.0 {
                    between(a, b, da / (da - db))
                } else {
                    between(b, a, db / (db - da))
                };
                kept.push(crossing);
            }
        }
        polygon = kept;
        if polygon.is_empty() {
            break;
        }
    }
    polygon
}

fn between(a: &Homogeneous, b: &Homogeneous, t: f64) -> Homogeneous {
    let mix = |a: f64, b: f64| a + (b - a) * t;
    Homogeneous {
        x: mix(a.x, b.x),
        y: mix(a.y, b.y),
        w: mix(a.w, b.w),
        distance: mix(a.distance, b.distance),
    }
}

impl Projected {
    /// The three corners of a piece.
    pub(crate) fn triangle(&self, piece: &Piece) -> [Corner; 3] {
        piece.corners.map(|c| self.corners[c as usize])
    }
}

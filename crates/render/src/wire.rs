//! Triangle edges as lines of constant width in pixels, hidden where the surface hides them.
//!
//! Each triangle draws its half of the lines along its edges, by the distance of a sample to the edge in the
//! picture. Two things need the neighbours: an edge of which only one side is seen (an outline or a border) gets
//! the whole width on that side, and lines fade where they would lie closer together than they are wide, so that
//! dense meshes stay readable instead of turning black. All edges of a triangle fade alike, by its size in the picture:
//! by the distance of each from its opposite corner, where triangles are seen at a slant, some would stay and stand alone as
//! stripes; by the sizes on both sides of it, outlines of large triangles among small ones would be broken.

use crate::camera::Homogeneous;
use crate::parallel;

/// Triangles smaller than this many pixels, or line widths where lines are wider, show no line at all …
const FADE_FROM: f32 = 4.0;
/// … and from this many on the full one. In between, lines would cover more than a third of the surface.
const FADE_TO: f32 = 7.0;

/// How a triangle draws the edge opposite to each of its corners.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Ink {
    /// How far the line reaches into the triangle, in pixels.
    pub(crate) reach: [f32; 3],
    /// 0 invisible to 1 full, of all three alike.
    pub(crate) opacity: f32,
}

/// A triangle in the picture: the lines through its edges and which way it faces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lines {
    /// Coefficients of the line opposite to each corner: its value at a pixel (x, y) is ax + by + c. The three
    /// values are in the ratio of the (perspective-correct) barycentric coordinates.
    pub(crate) lines: [[f64; 3]; 3],
    /// Whether the outside is seen.
    pub(crate) front: bool,
}

impl Lines {
    pub(crate) fn new([a, b, c]: [Homogeneous; 3]) -> Self {
        let cross = |p: Homogeneous, q: Homogeneous| {
            [
                p.y * q.w - p.w * q.y,
                p.w * q.x - p.x * q.w,
                p.x * q.y - p.y * q.x,
            ]
        };
        let lines = [cross(b, c), cross(c, a), cross(a, b)];
        // y runs downwards in the picture, so counter-clockwise triangles have a negative determinant.
        let front = lines[0][0] * a.x + lines[0][1] * a.y + lines[0][2] * a.w < 0.0;
        Self { lines, front }
    }

    /// Barycentric coordinates of the surface's point seen at a pixel; kept within the triangle.
    #[inline]
    pub(crate) fn barycentric(&self, x: f64, y: f64) -> [f64; 3] {
        let sign = if self.front { -1.0 } else { 1.0 };
        let weights = self
            .lines
            .map(|[a, b, c]| (sign * (a * x + b * y + c)).max(0.0));
        let sum = weights[0] + weights[1] + weights[2];
        if sum > 0.0 && sum.is_finite() {
            weights.map(|w| w / sum)
        } else {
            [1.0 / 3.0; 3]
        }
    }

    /// How barycentric coordinates change from a point of the picture to the next pixel to the right and below, on the triangle's
    /// plane: the derivatives of a quotient of linear functions.
    pub(crate) fn steps(&self, x: f64, y: f64) -> [[f64; 3]; 2] {
        let values = self.lines.map(|[a, b, c]| a * x + b * y + c);
        let sum = values[0] + values[1] + values[2];
        [0, 1].map(|axis| {
            let slopes = self.lines.map(|line| line[axis]);
            let slope = slopes[0] + slopes[1] + slopes[2];
            [0, 1, 2].map(|i| (slopes[i] * sum - values[i] * slope) / (sum * sum))
        })
    }

    /// The lines scaled so that their values are distances in pixels.
    #[inline]
    pub(crate) fn distances(&self) -> [[f32; 3]; 3] {
        self.lines.map(|[a, b, c]| {
            let length = a.hypot(b);
            let scale = if length > 0.0 { 1.0 / length } else { 0.0 };
            [(a * scale) as f32, (b * scale) as f32, (c * scale) as f32]
        })
    }
}

/// The size of a triangle in pixels: 6 A/P with area A and perimeter P, which is the altitude of an equilateral one, and falls
/// with the share of its area that lines along its edges cover. Infinite for those that reach behind the eye.
fn size(corners: [Homogeneous; 3]) -> f32 {
    if corners.iter().any(|p| p.w <= 0.0) {
        return f32::INFINITY;
    }
    let [a, b, c] = corners.map(|p| [p.x / p.w, p.y / p.w]);
    let side = |p: [f64; 2], q: [f64; 2]| (q[0] - p[0]).hypot(q[1] - p[1]);
    let perimeter = side(a, b) + side(b, c) + side(c, a);
    let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
    if perimeter > 0.0 {
        (6.0 * area / perimeter) as f32
    } else {
        0.0
    }
}

/// What is needed to know of one side of an edge.
#[derive(Clone, Copy)]
struct Side {
    other_end: u32,
    face: u32,
    corner: u8,
}

/// The ink of every triangle for lines `width` pixels wide.
pub(crate) fn ink(triangles: &[[u32; 3]], points: &[Homogeneous], width: f32) -> Vec<Ink> {
    let looks = parallel::map(triangles.len(), |face| {
        let corners = triangles[face].map(|v| points[v as usize]);
        (Lines::new(corners).front, size(corners))
    });
    let mut inks: Vec<Ink> = looks
        .iter()
        .map(|(_, size)| Ink {
            reach: [width; 3],
            opacity: fade(size / width.max(1.0)),
        })
        .collect();
    let (starts, mut sides) = edges_by_lower_end(triangles, points.len());
    for vertex in 0..points.len() {
        let here = &mut sides[starts[vertex]..starts[vertex + 1]];
        here.sort_unstable_by_key(|side| (side.other_end, side.face, side.corner));
        for edge in here.chunk_by(|a, b| a.other_end == b.other_end) {
            let faces_one_way =
                |s: &Side| looks[s.face as usize].0 == looks[edge[0].face as usize].0;
            if edge.len() > 1 && edge.iter().all(faces_one_way) {
                for side in edge {
                    inks[side.face as usize].reach[side.corner as usize] = 0.5 * width;
                }
            }
        }
    }
    inks
}

fn fade(size: f32) -> f32 {
    let t = ((size - FADE_FROM) / (FADE_TO - FADE_FROM)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The sides of all edges, those of an edge at the lower of its two vertices: where each vertex's part starts,
/// and the sides.
fn edges_by_lower_end(triangles: &[[u32; 3]], vertices: usize) -> (Vec<usize>, Vec<Side>) {
    let ends = |triangle: &[u32; 3], corner: usize| {
        let (a, b) = (triangle[(corner + 1) % 3], triangle[(corner + 2) % 3]);
        (a.min(b) as usize, a.max(b))
    };
    let mut starts = vec![0usize; vertices + 1];
    for triangle in triangles {
        for corner in 0..3 {
            starts[ends(triangle, corner).0 + 1] += 1;
        }
    }
    for vertex in 0..vertices {
        starts[vertex + 1] += starts[vertex];
    }
    let mut next = starts.clone();
    let mut sides = vec![
        Side {
            other_end: 0,
            face: 0,
            corner: 0
        };
        triangles.len() * 3
    ];
    for (face, triangle) in triangles.iter().enumerate() {
        for corner in 0..3u8 {
            let (low, other_end) = ends(triangle, corner.into());
            sides[next[low]] = Side {
                other_end,
                face: face as u32,
                corner,
            };
            next[low] += 1;
        }
    }
    (starts, sides)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of squares, each cut in two, seen at a slant: in the picture a square is 12 pixels wide and `high` pixels high.
    fn slanted_grid(high: f64) -> Vec<Ink> {
        const SIDE: u32 = 9;
        let at = |x: u32, y: u32| y * SIDE + x;
        let point = |x: u32, y: u32| Homogeneous {
            x: 12.0 * f64::from(x),
            y: high * f64::from(y),
            w: 1.0,
            distance: 1.0,
        };
        let points: Vec<Homogeneous> = (0..SIDE * SIDE)
            .map(|v| point(v % SIDE, v / SIDE))
            .collect();
        let cells = (0..(SIDE - 1) * (SIDE - 1)).map(|cell| (cell % (SIDE - 1), cell / (SIDE - 1)));
        let triangles: Vec<[u32; 3]> = cells
            .flat_map(|(x, y)| {
                let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
                [[a, b, c], [a, c, d]]
            })
            .collect();
        ink(&triangles, &points, 1.0)
    }

    #[test]
    fn smaller_triangles_fade_more() {
        let opacities = [1.0, 2.0, 4.0, 8.0, 12.0].map(|high| slanted_grid(high)[0].opacity);
        assert!(opacities.is_sorted(), "{opacities:?}");
        assert!(opacities[0] == 0.0 && opacities[4] > 0.9, "{opacities:?}");
    }

    /// An equilateral triangle by its altitude in pixels, drawn with lines of a width.
    fn opacity(altitude: f64, width: f32) -> f32 {
        let point = |x: f64, y: f64| Homogeneous {
            x,
            y,
            w: 1.0,
            distance: 1.0,
        };
        let half = altitude / 3f64.sqrt();
        let corners = [point(-half, 0.0), point(half, 0.0), point(0.0, altitude)];
        ink(&[[0, 1, 2]], &corners, width)[0].opacity
    }

    #[test]
    fn triangles_below_four_pixels_have_no_edges() {
        for altitude in [0.5, 2.0, 3.9] {
            assert_eq!(opacity(altitude, 0.9), 0.0, "{altitude}");
        }
        assert!(opacity(4.5, 0.9) > 0.0 && opacity(4.5, 0.9) < 1.0);
        assert_eq!(opacity(7.1, 0.9), 1.0);
        // Of wide lines four times their width.
        assert_eq!((opacity(11.0, 3.0), opacity(21.3, 3.0)), (0.0, 1.0));
    }
}

//! Triangle edges as lines of constant width in pixels, hidden where the surface hides them.
//!
//! Each triangle draws its half of the lines along its edges, by the distance of a sample to the edge in the
//! picture. Two things need the neighbours: an edge of which only one side is seen (an outline or a border) gets
//! the whole width on that side, and lines fade where they would lie closer together than they are wide, so that
//! dense meshes stay readable instead of turning black.

use crate::camera::Homogeneous;
use crate::parallel;

/// Triangles narrower than this many line widths show no line at all …
const FADE_FROM: f32 = 1.5;
/// … and from this many on the full one. In between, lines would cover more than a third of the surface.
const FADE_TO: f32 = 7.0;

/// How a triangle draws the edge opposite to each of its corners.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Ink {
    /// How far the line reaches into the triangle, in pixels.
    pub(crate) reach: [f32; 3],
    /// 0 invisible to 1 full.
    pub(crate) opacity: [f32; 3],
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
            [p.y * q.w - p.w * q.y, p.w * q.x - p.x * q.w, p.x * q.y - p.y * q.x]
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
        let weights = self.lines.map(|[a, b, c]| (sign * (a * x + b * y + c)).max(0.0));
        let sum = weights[0] + weights[1] + weights[2];
        if sum > 0.0 && sum.is_finite() { weights.map(|w| w / sum) } else { [1.0 / 3.0; 3] }
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

    /// Distance of each corner from the opposite edge in pixels; infinite for corners behind the eye.
    fn altitudes(&self, corners: [Homogeneous; 3]) -> [f32; 3] {
        [0, 1, 2].map(|i| {
            let ([a, b, c], p) = (self.lines[i], corners[i]);
            if p.w <= 0.0 {
                return f32::INFINITY;
            }
            let length = a.hypot(b) * p.w;
            if length > 0.0 { ((a * p.x + b * p.y + c * p.w).abs() / length) as f32 } else { 0.0 }
        })
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
        let lines = Lines::new(corners);
        (lines.front, lines.altitudes(corners))
    });
    let mut inks = vec![Ink::default(); triangles.len()];
    let (starts, mut sides) = edges_by_lower_end(triangles, points.len());
    for vertex in 0..points.len() {
        let here = &mut sides[starts[vertex]..starts[vertex + 1]];
        here.sort_unstable_by_key(|side| (side.other_end, side.face, side.corner));
        for edge in here.chunk_by(|a, b| a.other_end == b.other_end) {
            let faces_one_way = |s: &Side| looks[s.face as usize].0 == looks[edge[0].face as usize].0;
            let shared = edge.len() > 1 && edge.iter().all(faces_one_way);
            let mean: f32 = edge.iter().map(|s| looks[s.face as usize].1[s.corner as usize]).sum::<f32>()
                / edge.len() as f32;
            for side in edge {
                let (face, corner) = (side.face as usize, side.corner as usize);
                let room = if shared { mean } else { looks[face].1[corner] };
                inks[face].reach[corner] = if shared { 0.5 * width } else { width };
                inks[face].opacity[corner] = fade(room / width);
            }
        }
    }
    inks
}

fn fade(widths: f32) -> f32 {
    let t = ((widths - FADE_FROM) / (FADE_TO - FADE_FROM)).clamp(0.0, 1.0);
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
    let mut sides = vec![Side { other_end: 0, face: 0, corner: 0 }; triangles.len() * 3];
    for (face, triangle) in triangles.iter().enumerate() {
        for corner in 0..3u8 {
            let (low, other_end) = ends(triangle, corner.into());
            sides[next[low]] = Side { other_end, face: face as u32, corner };
            next[low] += 1;
        }
    }
    (starts, sides)
}

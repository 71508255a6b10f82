//! Where a surface is sampled: all its vertices, points along the sides of its triangles by length, points in
//! its triangles by area (Metro's three kinds; Cignoni, Rocchini, Scopigno 1998).
//!
//! The points are spread evenly and reproducibly rather than at random: sample k of m stands at the fraction
//! (k + 1/2) / m of the total length or area, and inside its triangle at the k-th point of a low-discrepancy
//! sequence (Roberts' R2, built on the plastic number). All kinds follow the order of the surface's tree, so that
//! consecutive samples are near each other.

use core::ops::Range;

use super::bvh::Bvh;
use super::pieces::map_pieces;
use crate::vector::{DVec3, vector};

/// Triangles whose weights are summed together: few enough to search a piece again for each run of samples, many
/// enough that the list of sums stays small.
const PIECE: usize = 256;

/// Share of the samples beside the vertices that goes to the sides: 1 in 5. They matter where the greatest
/// distance lies on a sharp edge; the mean needs the points inside.
const SIDE_SHARE: usize = 5;

/// Where the vertices alone are more than the samples asked for, sides and insides still get this share of the
/// number: 1 in 4. Without it the mean would not see the insides at all.
const LEAST_SHARE: usize = 4;

/// Reciprocals of the plastic number (the real root of x³ = x + 1) and of its square.
const R2: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];

/// The samples of a surface: first the vertices, then points on sides, then points inside.
pub(super) struct Samples<'s, 'a> {
    surface: &'s Bvh<'a>,
    vertices: Vec<u32>,
    sides: Spread,
    insides: Spread,
}

/// Points spread evenly over the triangles by some weight.
struct Spread {
    /// Number of points.
    count: usize,
    /// Weight before each piece of triangles, and the total at the end.
    before: Vec<f64>,
    weight: fn([DVec3; 3]) -> f64,
}

/// Length of the three sides.
fn perimeter([a, b, c]: [DVec3; 3]) -> f64 {
    a.distance(b) + b.distance(c) + c.distance(a)
}

/// Twice the area.
fn area([a, b, c]: [DVec3; 3]) -> f64 {
    (b - a).cross(c - a).length()
}

impl<'s, 'a> Samples<'s, 'a> {
    /// About `wanted` samples; all vertices in use are among them.
    pub(super) fn new(surface: &'s Bvh<'a>, wanted: usize) -> Self {
        let vertices = vertices_in_order(surface);
        let rest = wanted.saturating_sub(vertices.len()).max(wanted / LEAST_SHARE).max(1);
        let sides = Spread::new(surface, rest / SIDE_SHARE, perimeter);
        let insides = Spread::new(surface, rest - rest / SIDE_SHARE, area);
        Self { surface, vertices, sides, insides }
    }

    /// Number of samples.
    pub(super) fn len(&self) -> usize {
        self.vertices.len() + self.sides.count + self.insides.count
    }

    /// The samples inside triangles, each standing for the same area; empty if the surface has no area.
    pub(super) fn insides(&self) -> Range<usize> {
        self.vertices.len() + self.sides.count..self.len()
    }

    /// Calls `f` with each sample of `range` in turn.
    pub(super) fn visit(&self, range: Range<usize>, mut f: impl FnMut(DVec3)) {
        let part = |from: usize, count: usize| {
            range.start.clamp(from, from + count) - from..range.end.clamp(from, from + count) - from
        };
        let surface = self.surface.surface();
        for &v in &self.vertices[part(0, self.vertices.len())] {
            f(vector(surface.positions[v as usize]));
        }
        let first_side = self.vertices.len();
        self.sides.visit(self.surface, part(first_side, self.sides.count), |_, corners, lengths, into| {
            f(along_sides(corners, lengths, into));
        });
        let first_inside = first_side + self.sides.count;
        self.insides.visit(self.surface, part(first_inside, self.insides.count), |k, [a, b, c], _, _| {
            let [u, v] = R2.map(|step| (0.5 + step * k as f64).fract());
            // The half of the unit square beyond the diagonal is folded back onto the triangle.
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            f(a * (1.0 - u - v) + b * u + c * v);
        });
    }

    /// One sample.
    pub(super) fn point(&self, index: usize) -> DVec3 {
        let mut point = DVec3::ZERO;
        self.visit(index..index + 1, |p| point = p);
        point
    }
}

/// The vertices that triangles use, in the order in which the tree's triangles first name them.
fn vertices_in_order(surface: &Bvh<'_>) -> Vec<u32> {
    let mut seen = vec![false; surface.surface().positions.len()];
    let mut vertices = Vec::with_capacity(seen.len());
    for slot in 0..surface.surface().triangles.len() {
        for v in surface.in_order(slot) {
            if !core::mem::replace(&mut seen[v as usize], true) {
                vertices.push(v);
            }
        }
    }
    vertices
}

/// The point `into` along the sides laid end to end, of a triangle whose sides have these lengths.
fn along_sides([a, b, c]: [DVec3; 3], [ab, bc, ca]: [f64; 3], into: f64) -> DVec3 {
    let between = |from: DVec3, to: DVec3, into: f64, length: f64| {
        let t = if length > 0.0 { (into / length).clamp(0.0, 1.0) } else { 0.0 };
        from * (1.0 - t) + to * t
    };
    if into < ab {
        between(a, b, into, ab)
    } else if into < ab + bc {
        between(b, c, into - ab, bc)
    } else {
        between(c, a, into - ab - bc, ca)
    }
}

impl Spread {
    fn new(surface: &Bvh<'_>, count: usize, weight: fn([DVec3; 3]) -> f64) -> Self {
        let sums = map_pieces(surface.surface().triangles.len(), PIECE, |slots| {
            slots.map(|slot| weight(surface.scaled_corners(slot))).sum::<f64>()
        });
        let mut before = Vec::with_capacity(sums.len() + 1);
        let mut total = 0.0;
        before.push(total);
        for sum in sums {
            total += sum;
            before.push(total);
        }
        Self { count: if total > 0.0 { count } else { 0 }, before, weight }
    }

    /// Calls `f` with each point's number, its triangle's corners and side lengths, and how far into the triangle's
    /// weight the point stands.
    fn visit(
        &self,
        surface: &Bvh<'_>,
        range: Range<usize>,
        mut f: impl FnMut(usize, [DVec3; 3], [f64; 3], f64),
    ) {
        if range.is_empty() {
            return;
        }
        let total = self.before[self.before.len() - 1];
        let faces = surface.surface().triangles.len();
        let target = |k: usize| (k as f64 + 0.5) / self.count as f64 * total;
        let mut piece = self.before.partition_point(|&sum| sum <= target(range.start)).saturating_sub(1);
        let mut slot = piece * PIECE;
        let mut sum = self.before[piece];
        let mut corners = surface.scaled_corners(slot);
        let mut weight = (self.weight)(corners);
        for k in range {
            let target = target(k);
            // The sums of the pieces are kept, so that rounding cannot carry a sample out of its own.
            while sum + weight <= target && slot + 1 < faces {
                sum += weight;
                slot += 1;
                if slot == (piece + 1) * PIECE {
                    piece += 1;
                    sum = self.before[piece];
                }
                corners = surface.scaled_corners(slot);
                weight = (self.weight)(corners);
            }
            let [a, b, c] = corners;
            let lengths = [a.distance(b), b.distance(c), c.distance(a)];
            f(k, surface.corners(slot), lengths, (target - sum).clamp(0.0, weight));
        }
    }
}

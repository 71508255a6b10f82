//! The samples of a surface: all its vertices, points along the sides of its triangles by length,
//! points in its triangles by area (Metro's three kinds; Cignoni, Rocchini, Scopigno 1998).
//!
//! The points are spread evenly and reproducibly rather than at random: sample k of m is at the
//! fraction (k + 1/2) / m of the total length or area, and inside its triangle at the k-th point of
//! a low-discrepancy sequence (Roberts' R2, built on the plastic number). All kinds follow the
//! order of the surface's tree, so that consecutive samples are near each other.

use core::ops::Range;

use super::bvh::Bvh;
use crate::parallel;
use crate::vector::{DVec3, vector};

/// Triangles whose weights are summed together: few enough that finding a sample's triangle in its piece costs little,
/// many enough that the list of sums stays small.
const PIECE: usize = 16;

/// Share of the samples other than the vertices that goes to the sides: 1 in 5. They matter where
/// the greatest distance lies on a sharp edge; the mean needs the points inside.
const SIDE_SHARE: usize = 5;

/// Where the vertices alone are more than the requested samples, sides and insides still get this
/// share of the number: 1 in 4. Without it the mean would not see the insides at all.
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

/// Where a point of a spread stands.
struct SpreadPoint {
    /// Its number.
    number: usize,
    /// Its triangle, by place in the tree's order.
    slot: usize,
    /// The triangle's corners, scaled.
    scaled: [DVec3; 3],
    /// How far into the weight of the triangle.
    into: f64,
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
    pub(crate) fn new(surface: &'s Bvh<'a>, wanted: usize) -> Self {
        let vertices = vertices_in_order(surface);
        let rest = wanted
            .saturating_sub(vertices.len())
            .max(wanted / LEAST_SHARE)
            .max(1);
        let [lengths, areas] = weights_before(surface);
        let sides = Spread::new(rest / SIDE_SHARE, lengths, perimeter);
        let insides = Spread::new(rest - rest / SIDE_SHARE, areas, area);
        Self {
            surface,
            vertices,
            sides,
            insides,
        }
    }

    /// The vertices in use alone.
    pub(super) fn of_vertices(surface: &'s Bvh<'a>) -> Self {
        let none = |weight| Spread {
            count: 0,
            before: Vec::new(),
            weight,
        };
        Self {
            surface,
            vertices: vertices_in_order(surface),
            sides: none(perimeter as fn(_) -> _),
            insides: none(area),
        }
    }

    /// The vertices, which are the first samples, in their order.
    pub(super) fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    /// Number of samples.
    pub(super) fn len(&self) -> usize {
        self.vertices.len() + self.sides.count + self.insides.count
    }

    /// The samples inside triangles, each representing an equal area; empty if the surface has no
    /// area.
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
        self.sides
            .visit(self.surface, part(first_side, self.sides.count), |side| {
                f(along_sides(
                    self.surface.corners(side.slot),
                    side.scaled,
                    side.into,
                ));
            });
        let first_inside = first_side + self.sides.count;
        self.insides.visit(
            self.surface,
            part(first_inside, self.insides.count),
            |inside| {
                let [a, b, c] = self.surface.corners(inside.slot);
                let k = inside.number;
                let [u, v] = R2.map(|step| (0.5 + step * k as f64).fract());
                // The half of the unit square beyond the diagonal is folded back onto the triangle.
                let (u, v) = if u + v > 1.0 {
                    (1.0 - u, 1.0 - v)
                } else {
                    (u, v)
                };
                f(a * (1.0 - u - v) + b * u + c * v);
            },
        );
    }

    /// One sample.
    pub(super) fn point(&self, index: usize) -> DVec3 {
        let mut point = DVec3::ZERO;
        self.visit(index..index + 1, |p| point = p);
        point
    }

    /// The samples that are no vertices.
    pub(super) fn beside_vertices(&self) -> Range<usize> {
        self.vertices.len()..self.len()
    }

    /// The triangle, by its position in the tree's order, of a sample that is no vertex.
    pub(super) fn triangle(&self, index: usize) -> usize {
        let mut found = 0;
        let first_inside = self.vertices.len() + self.sides.count;
        let (spread, k) = match index.checked_sub(first_inside) {
            Some(k) => (&self.insides, k),
            None => (&self.sides, index - self.vertices.len()),
        };
        spread.visit(self.surface, k..k + 1, |sample| found = sample.slot);
        found
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

/// The point at the length `into` along the scaled sides of a triangle laid end to end.
fn along_sides([a, b, c]: [DVec3; 3], scaled: [DVec3; 3], into: f64) -> DVec3 {
    let [ab, bc, ca] = [(0, 1), (1, 2), (2, 0)].map(|(from, to)| scaled[from].distance(scaled[to]));
    let between = |from: DVec3, to: DVec3, into: f64, length: f64| {
        let t = if length > 0.0 {
            (into / length).clamp(0.0, 1.0)
        } else {
            0.0
        };
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

/// Perimeters and areas before each piece of triangles, and their totals at the end.
fn weights_before(surface: &Bvh<'_>) -> [Vec<f64>; 2] {
    let faces = surface.surface().triangles.len();
    let mut sums = vec![[0.0; 2]; faces.div_ceil(PIECE)];
    parallel::for_each_chunk(&mut sums, 256, |run, sums| {
        for (i, sum) in sums.iter_mut().enumerate() {
            let first = (run * 256 + i) * PIECE;
            for slot in first..faces.min(first + PIECE) {
                let corners = surface.scaled_corners(slot);
                sum[0] += perimeter(corners);
                sum[1] += area(corners);
            }
        }
    });
    [0, 1].map(|kind| {
        let mut total = 0.0;
        let running = sums.iter().map(|sum| {
            total += sum[kind];
            total
        });
        core::iter::once(0.0).chain(running).collect()
    })
}

impl Spread {
    fn new(count: usize, before: Vec<f64>, weight: fn([DVec3; 3]) -> f64) -> Self {
        let total = before[before.len() - 1];
        Self {
            count: if total > 0.0 { count } else { 0 },
            before,
            weight,
        }
    }

    /// Calls `f` with each point of `range` in turn.
    fn visit(&self, surface: &Bvh<'_>, range: Range<usize>, mut f: impl FnMut(SpreadPoint)) {
        if range.is_empty() {
            return;
        }
        let total = self.before[self.before.len() - 1];
        let faces = surface.surface().triangles.len();
        let target = |k: usize| (k as f64 + 0.5) / self.count as f64 * total;
        let mut piece = self
            .before
            .partition_point(|&sum| sum <= target(range.start))
            .saturating_sub(1);
        let mut slot = piece * PIECE;
        let mut sum = self.before[piece];
        let mut corners = surface.scaled_corners(slot);
        let mut weight = (self.weight)(corners);
        for k in range {
            let target = target(k);
            let last = piece;
            while piece + 2 < self.before.len() && self.before[piece + 1] <= target {
                piece += 1;
            }
            if piece > last {
                (slot, sum) = (piece * PIECE, self.before[piece]);
                corners = surface.scaled_corners(slot);
                weight = (self.weight)(corners);
            }
            while sum + weight <= target && slot + 1 < faces.min((piece + 1) * PIECE) {
                sum += weight;
                slot += 1;
                corners = surface.scaled_corners(slot);
                weight = (self.weight)(corners);
            }
            f(SpreadPoint {
                number: k,
                slot,
                scaled: corners,
                into: (target - sum).clamp(0.0, weight),
            });
        }
    }
}

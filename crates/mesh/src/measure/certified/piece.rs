//! A piece of a triangle and upper bounds of its distance to the other surface.
//!
//! Let t be a piece with corners cᵢ. The bounds, each valid alone, in the order of trial:
//!
//! * **step**: for any point p of t, d(p) + max |cᵢ − p|, as the distance changes no faster than the point;
//! * **one triangle**: for any triangle k of the other surface, max d(cᵢ, k), as the distance to a convex set is convex;
//! * **cover**: see [`super::cover`]; the only one whose error falls with the square of the size of t where t lies
//!   over several triangles;
//! * **two triangles**: see [`super::between`]; attained where t lies between two.

use super::cover::Cover;
use super::scale::DEEPEST;
use super::target::{Near, Target};
use crate::vector::{DVec3, unit_or_zero};

/// A side this many times longer than the shortest one is cut alone: pieces then get rounder.
const SLENDER: f64 = 2.0;

/// A piece of a triangle of the surface that is measured.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    /// No point of it is farther away than this.
    pub(super) upper: f64,
    pub(super) corners: [DVec3; 3],
    /// A triangle of the other surface near each corner.
    pub(super) faces: [u32; 3],
    /// Splits since the triangle.
    pub(super) depth: u32,
}

/// A point and its distance.
#[derive(Clone, Copy)]
pub(super) struct Sample {
    pub(super) point: DVec3,
    pub(super) distance: f64,
}

impl Piece {
    /// Whether it has been split as often as rounding allows.
    pub(super) fn is_deepest(&self) -> bool {
        self.depth >= DEEPEST
    }
}

impl Sample {
    /// The farther of two; the first of equals.
    pub(super) fn farther(self, other: Self) -> Self {
        if other.distance > self.distance {
            other
        } else {
            self
        }
    }
}

/// The search state for bounding pieces; its memory is used again.
pub(crate) struct Worker<'t, 's, 'a> {
    pub(super) target: &'t Target<'s, 'a>,
    pub(super) cover: Cover,
    /// Triangles in a sheet at most.
    pub(super) limit: usize,
    /// Whether the middle of a piece is tested before a sheet is gathered from a corner.
    middle_first: bool,
    /// The farthest point met.
    pub(super) farthest: Sample,
    /// Pieces bounded, and nodes visited in searches.
    pub(super) steps: u64,
}

impl<'t, 's, 'a> Worker<'t, 's, 'a> {
    pub(crate) fn new(target: &'t Target<'s, 'a>, limit: usize, middle_first: bool) -> Self {
        let farthest = Sample {
            point: DVec3::ZERO,
            distance: f64::NEG_INFINITY,
        };
        Self {
            target,
            cover: Cover::new(),
            limit,
            middle_first,
            farthest,
            steps: 0,
        }
    }

    /// Pieces bounded, and triangles and boxes visited for that.
    pub(super) fn work(&self) -> u64 {
        self.steps + self.cover.visited
    }

    /// The nearest triangle to a point of a piece, which counts as a sample.
    pub(super) fn sample(&mut self, point: DVec3, guess: u32) -> Near {
        let near = self.target.nearest(point, guess);
        self.steps += u64::from(near.visited);
        self.farthest = self.farthest.farther(Sample {
            point,
            distance: near.distance,
        });
        near
    }

    /// An upper bound of the distance of a piece; better ones are tried until one is at most `goal`.
    pub(super) fn bound(&mut self, t: [DVec3; 3], faces: [u32; 3], goal: f64) -> f64 {
        self.steps += 1;
        let slack = self.target.scale.slack;
        let best = self.by_corners(t, faces, goal - slack) + slack;
        if best <= goal {
            return best;
        }
        let mut best = best;
        if !self.middle_first {
            best = best.min(self.covered(t, faces[0], goal));
            if best <= goal {
                return best;
            }
        }
        let middle = (t[0] + t[1] + t[2]) / 3.0;
        let face = self.sample(middle, faces[0]).face;
        let step = t
            .iter()
            .fold(0.0f64, |step, corner| step.max(corner.distance(middle)));
        best = best.min(self.target.distance_to(middle, face) + step + slack);
        if best > goal && !faces.contains(&face) {
            best = best.min(self.to_one(t, face) + slack);
        }
        if best > goal && (self.middle_first || face != faces[0]) {
            best = best.min(self.covered(t, face, goal));
        }
        if best > goal {
            let [a, b, c] = faces;
            best = best.min(self.between(t, &[a, b, c, face], goal - slack) + slack);
        }
        best
    }

    /// Steps from each corner, and one triangle near a corner for all; the first that is at most `goal`, or the best.
    fn by_corners(&self, t: [DVec3; 3], faces: [u32; 3], goal: f64) -> f64 {
        let sides = [
            t[1].distance(t[2]),
            t[2].distance(t[0]),
            t[0].distance(t[1]),
        ];
        let own: [f64; 3] = core::array::from_fn(|i| self.target.distance_to(t[i], faces[i]));
        let step = |i: usize| own[i] + sides[(i + 1) % 3].max(sides[(i + 2) % 3]);
        let mut best = step(0).min(step(1)).min(step(2));
        for (i, &face) in faces.iter().enumerate() {
            if best > goal && !faces[..i].contains(&face) {
                let to_one = (0..3).fold(0.0, |greatest: f64, j| {
                    let known = faces[j] == face;
                    greatest.max(if known {
                        own[j]
                    } else {
                        self.target.distance_to(t[j], face)
                    })
                });
                best = best.min(to_one);
            }
        }
        best
    }

    /// The greatest distance of the corners to one triangle.
    fn to_one(&self, t: [DVec3; 3], face: u32) -> f64 {
        t.iter().fold(0.0, |greatest: f64, &corner| {
            greatest.max(self.target.distance_to(corner, face))
        })
    }

    /// The bound by a sheet around a triangle, seen along its normal, then along that of the piece.
    fn covered(&mut self, t: [DVec3; 3], face: u32, goal: f64) -> f64 {
        let normal = |[a, b, c]: [DVec3; 3]| unit_or_zero((b - a).cross(c - a));
        let mut best = f64::INFINITY;
        for direction in [normal(self.target.triangle(face)), normal(t)] {
            if best > goal && direction != DVec3::ZERO {
                best =
                    best.min(
                        self.cover
                            .bound(self.target, t, face, direction, goal, self.limit),
                    );
            }
        }
        best
    }

    /// Splits a piece and adds those parts to `parts` that may be farther away than `goal`; returns the greatest bound
    /// of the others.
    pub(super) fn split(&mut self, piece: &Piece, goal: f64, parts: &mut Vec<Piece>) -> f64 {
        let mut dropped = f64::NEG_INFINITY;
        let Piece {
            corners: c,
            faces: f,
            ..
        } = *piece;
        let mut add = |worker: &mut Self, corners, faces| {
            let upper = worker.bound(corners, faces, goal).min(piece.upper);
            if upper <= goal {
                dropped = dropped.max(upper);
            } else {
                parts.push(Piece {
                    upper,
                    corners,
                    faces,
                    depth: piece.depth + 1,
                });
            }
        };
        let sides = [
            c[0].distance(c[1]),
            c[1].distance(c[2]),
            c[2].distance(c[0]),
        ];
        let longest = (1..3).fold(0, |best, i| if sides[i] > sides[best] { i } else { best });
        let [i, j, k] = [longest, (longest + 1) % 3, (longest + 2) % 3];
        let middle = |worker: &mut Self, i: usize, j: usize| {
            let point = (c[i] + c[j]) * 0.5;
            (point, worker.sample(point, f[i]).face)
        };
        let (ij, f_ij) = middle(self, i, j);
        if sides[i] > SLENDER * sides[j].min(sides[k]) {
            add(self, [c[i], ij, c[k]], [f[i], f_ij, f[k]]);
            add(self, [ij, c[j], c[k]], [f_ij, f[j], f[k]]);
        } else {
            let (jk, f_jk) = middle(self, j, k);
            let (ki, f_ki) = middle(self, k, i);
            add(self, [c[i], ij, ki], [f[i], f_ij, f_ki]);
            add(self, [ij, c[j], jk], [f_ij, f[j], f_jk]);
            add(self, [ki, jk, c[k]], [f_ki, f_jk, f[k]]);
            add(self, [ij, jk, ki], [f_ij, f_jk, f_ki]);
        }
        dropped
    }
}

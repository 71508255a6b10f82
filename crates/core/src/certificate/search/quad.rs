//! The bound of a triangle over any triangle of a quad's domain, such as half of a quad that is cut by its other diagonal: the quad is
//! divided until its parts are polynomials, and the domain is divided with it.

use super::super::borders::{Borders, INSIDE};
use super::super::effort::Effort;
use super::super::triangle_frame::TriangleFrame;
use super::{HullPoint, Search, SubTriangle};
use crate::patch::{Patch, Rules};
use crate::vector::DVec3;

/// How often the net of a polynomial is halved.
const HALVINGS: usize = 6;

/// Chords of angles beyond which neighbours do not help: the triangle is bounded on its own.
const ALONE: [f64; 3] = [2.0; 3];

/// The surface over a quad: the pieces over the half with its first corner and over the half with its third one.
pub(crate) struct QuadPieces {
    pub(crate) halves: [Patch; 2],
}

/// A convex part of a quad's domain.
#[derive(Clone)]
struct Domain {
    corners: Vec<Corner>,
}

/// A corner of a domain.
#[derive(Clone, Copy)]
struct Corner {
    /// Its place in the quad, from 0 to 1 along its first edge and along its last one backwards.
    at: [f64; 2],
    /// The triangle's edge that the edge from here is a part of, or [`INSIDE`].
    border: u8,
}

impl QuadPieces {
    /// A bound, without its neighbours, of the distance between a triangle and the surface over a triangle of the domain, whose corners
    /// are its corners' places; no tighter than `limit`, and infinite where that is certainly exceeded. The triangle's corners lie on
    /// the surface.
    pub(crate) fn bound(
        &self,
        triangle: [DVec3; 3],
        places: [[f64; 2]; 3],
        limit: f64,
        rules: &Rules<'_>,
    ) -> f64 {
        let frame = TriangleFrame::new(triangle);
        if !frame.is_finite() {
            return f64::INFINITY;
        }
        let effort = Effort {
            target: limit,
            halvings: HALVINGS,
            open: [true; 3],
            rim_alone: false,
            chords: ALONE,
            slopes: [0.0; 3],
            gives_up: true,
            least_chord: None,
        };
        let mut search = Search::<DVec3>::of(effort.bound(&frame), rules, effort);
        let corner = |i: usize| Corner {
            at: places[i],
            border: i as u8,
        };
        let corners = [0, 1, 2].map(corner).to_vec();
        search.over_quad(self, &Domain { corners }, 0);
        search.found.own
    }

    /// The four quads that it is divided into, by row and column.
    fn parts(&self, rules: &Rules<'_>) -> [[Self; 2]; 2] {
        let [first, second] = self.halves.each_ref().map(|half| half.refined(rules));
        let quad = |halves| Self { halves };
        [
            [
                quad([first.part(0), first.part(3)]),
                quad([first.part(1), second.part(2)]),
            ],
            [
                quad([first.part(2), second.part(1)]),
                quad([second.part(3), second.part(0)]),
            ],
        ]
    }
}

impl<P: HullPoint> Search<'_, P> {
    fn over_quad(&mut self, quad: &QuadPieces, domain: &Domain, depth: usize) {
        let [half, _] = &quad.halves;
        if let Patch::Bicubic(piece) = half {
            for (places, borders) in domain.triangles() {
                let net = piece.net(places, |point| P::of(self.bound.frame, point));
                self.net(&net, borders, HALVINGS);
            }
            return;
        }
        if self.is_settled(half, SubTriangle::Whole, domain.borders(), depth) {
            return;
        }
        let parts = quad.parts(self.rules);
        let rows = domain.halves(1);
        for (row, domain) in parts.iter().zip(rows) {
            for (part, domain) in row.iter().zip(domain.halves(0)) {
                if domain.corners.len() > 2 {
                    self.over_quad(part, &domain, depth + 1);
                }
            }
        }
    }
}

impl Domain {
    /// The triangles that its first corner makes with its edges.
    fn triangles(&self) -> impl Iterator<Item = ([[f64; 2]; 3], Borders)> {
        let corners = &self.corners;
        let last = corners.len() - 1;
        (1..last).map(move |i| {
            let places = [0, i, i + 1].map(|i| corners[i].at);
            let first = if i == 1 { corners[0].border } else { INSIDE };
            let third = if i + 1 == last {
                corners[last].border
            } else {
                INSIDE
            };
            (places, [first, corners[i].border, third])
        })
    }

    /// The triangle's edges that it has a part of.
    fn borders(&self) -> Borders {
        let has = |&border: &u8| self.corners.iter().any(|corner| corner.border == border);
        [0, 1, 2].map(|border| if has(&border) { border } else { INSIDE })
    }

    /// What of it is before the middle of the quad along an axis, and what is behind it: each in the part of the quad on its side.
    fn halves(&self, axis: usize) -> [Self; 2] {
        let within = |is_behind: bool| {
            let offset = if is_behind { 1.0 } else { 0.0 };
            let depth = |corner: &Corner| match is_behind {
                true => corner.at[axis] - 0.5,
                false => 0.5 - corner.at[axis],
            };
            let mut corners: Vec<Corner> = Vec::with_capacity(self.corners.len() + 1);
            for (i, corner) in self.corners.iter().enumerate() {
                let next = &self.corners[(i + 1) % self.corners.len()];
                let (own, other) = (depth(corner), depth(next));
                if own >= 0.0 {
                    // What follows a corner on the cut runs along it, unless the next one is on this side as well.
                    let leaves = own == 0.0 && other < 0.0;
                    let border = if leaves { INSIDE } else { corner.border };
                    corners.push(Corner { border, ..*corner });
                }
                if own * other < 0.0 {
                    let share = own / (own - other);
                    let at = [0, 1]
                        .map(|axis| corner.at[axis] + share * (next.at[axis] - corner.at[axis]));
                    let border = if own > 0.0 { INSIDE } else { corner.border };
                    corners.push(Corner { at, border });
                }
            }
            // A corner alone, or an edge, has no part of the surface.
            if corners.iter().all(|corner| depth(corner) <= 0.0) {
                corners.clear();
            }
            for corner in &mut corners {
                corner.at[axis] = (2.0 * corner.at[axis] - offset).clamp(0.0, 1.0);
            }
            Self { corners }
        };
        [within(false), within(true)]
    }
}

//! The closest point, by branch and bound over boxes, faces and pieces, the least bound first.
//!
//! A piece is skipped if a lower bound of its distance is not below the least distance found less
//! the tolerance: the bound is by its box, or by the triangle that it is near, or the squared
//! distance bends so little downwards that its value and derivatives at one place bound it
//! ([`super::convexity`]). Others are searched by Newton's method within their triangle, and
//! quartered where that does not decide.

use core::cmp::Ordering;
use std::collections::BinaryHeap;

use super::pieces::{FacePieces, Form, Piece, RegularPiece};
use super::{Closest, Proximity};
use crate::geometry::box_tree::distance_to;
use crate::geometry::closest_to_origin;
use crate::index::FaceId;
use crate::parallel::IsStopped;
use crate::patch::ParamTriangle;
use crate::vector::{DVec3, vector};

/// Newton's steps on a piece at most: it converges within five, or it is better to quarter the piece.
const STEPS: usize = 8;

/// The number of steps where nothing is known of convexity, only to find a near point.
const FEW_STEPS: usize = 2;

/// Pieces between two questions whether to stop: some milliseconds at most.
const BETWEEN_QUESTIONS: u32 = 256;

/// Pieces whose triangle is smaller are not divided any more: rounding moves them as much.
const SPECK: f64 = 1e-15;

/// Searches for several points, one after the other.
pub(super) struct Query<'q> {
    proximity: &'q Proximity<'q>,
    tolerance: f64,
    is_stopped: &'q IsStopped<'q>,
    /// The pieces that wait.
    waiting: BinaryHeap<Waiting>,
    /// Pieces until the next question whether to stop.
    left: u32,
    /// The point, and the nearest one so far.
    from: DVec3,
    best: Best,
    /// A lower bound of the distance of all skipped pieces.
    passed_over: f64,
}

/// The nearest point so far.
#[derive(Clone, Copy)]
struct Best {
    distance: f64,
    point: DVec3,
    face: u32,
    weights: [f64; 3],
}

const NOTHING: Best = Best {
    distance: f64::INFINITY,
    point: DVec3::ZERO,
    face: 0,
    weights: [1.0, 0.0, 0.0],
};

/// Something that is no nearer than its bound.
struct Waiting {
    bound: f64,
    /// The order of pieces with equal bounds.
    number: u32,
    pending: Pending,
}

enum Pending {
    /// A node of the tree.
    Node(usize),
    /// A piece that is kept, by its face and place there, and whether its bound is that of its triangle, not only of its box.
    Kept(u32, u32, bool),
    /// One that was made for this search, and its face.
    Own(Box<Piece>, u32),
}

impl Ord for Waiting {
    /// The entry with the least bound is the greatest, as heaps need it; among equals the latest,
    /// which is smallest.
    fn cmp(&self, other: &Self) -> Ordering {
        other
            .bound
            .total_cmp(&self.bound)
            .then(self.number.cmp(&other.number))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Waiting {}

impl<'q> Query<'q> {
    pub(crate) fn new(
        proximity: &'q Proximity<'q>,
        tolerance: f64,
        is_stopped: &'q IsStopped<'q>,
    ) -> Self {
        let (waiting, left) = (BinaryHeap::new(), BETWEEN_QUESTIONS);
        Self {
            proximity,
            tolerance,
            is_stopped,
            waiting,
            left,
            from: DVec3::ZERO,
            best: NOTHING,
            passed_over: f64::INFINITY,
        }
    }

    /// The closest point; meaningless once the search was stopped.
    pub(crate) fn closest(&mut self, point: [f64; 3]) -> Closest {
        let frame = &self.proximity.frame;
        (self.from, self.best, self.passed_over) =
            (frame.inside(vector(point)), NOTHING, f64::INFINITY);
        let mut number = 0;
        self.waiting.clear();
        self.wait(&mut number, 0.0, Pending::Node(0));
        while let Some(Waiting { bound, pending, .. }) = self.waiting.pop() {
            if bound >= self.limit() {
                self.pass_over(bound);
                break;
            }
            match pending {
                Pending::Node(node) => self.open(node, &mut number),
                Pending::Kept(face, at, is_of_triangle) => {
                    let piece = &self.proximity.faces[face as usize].pieces[at as usize];
                    let own = if is_of_triangle {
                        bound
                    } else {
                        self.bound(piece)
                    };
                    if own > bound && self.waiting.peek().is_some_and(|next| next.bound < own) {
                        self.wait(&mut number, own, Pending::Kept(face, at, true));
                    } else {
                        self.look_at(piece, face, &mut number);
                    }
                }
                Pending::Own(piece, face) => self.look_at(&piece, face, &mut number),
            }
            self.left -= 1;
            if self.left == 0 {
                self.left = BETWEEN_QUESTIONS;
                if (self.is_stopped)() {
                    break;
                }
            }
        }
        let (best, lower) = (self.best, self.passed_over);
        Closest {
            point: frame.outside(best.point).to_array(),
            face: FaceId(best.face),
            barycentric: best.weights,
            distance: frame.length_outside(best.distance),
            lower: frame.length_outside(lower.clamp(0.0, best.distance)),
        }
    }

    /// The bound from which the search skips pieces.
    fn limit(&self) -> f64 {
        self.best.distance - self.tolerance
    }

    fn pass_over(&mut self, bound: f64) {
        self.passed_over = self.passed_over.min(bound);
    }

    fn wait(&mut self, number: &mut u32, bound: f64, pending: Pending) {
        *number = number.wrapping_add(1);
        self.waiting.push(Waiting {
            bound,
            number: *number,
            pending,
        });
    }

    /// Looks into a node of the tree.
    fn open(&mut self, node: usize, number: &mut u32) {
        let proximity = self.proximity;
        let tree = &proximity.tree;
        if let Some(children) = tree.children(node) {
            for child in children {
                let bound = distance_to(&tree.nodes()[child].bounds, self.from);
                self.wait(number, bound, Pending::Node(child));
            }
            return;
        }
        let face = tree.items()[tree.nodes()[node].range().start];
        match proximity.faces.get(face as usize) {
            Some(kept) => {
                for (piece, at) in kept.pieces.iter().zip(0..) {
                    let bound = distance_to(&piece.bounds, self.from);
                    match bound < self.limit() {
                        true => self.wait(number, bound, Pending::Kept(face, at, false)),
                        false => self.pass_over(bound),
                    }
                }
            }
            None => {
                for piece in
                    FacePieces::of(proximity.surface, &proximity.frame, FaceId(face)).pieces
                {
                    let bound = self.bound(&piece);
                    self.wait(number, bound, Pending::Own(Box::new(piece), face));
                }
            }
        }
    }

    /// No point of a piece is nearer than this.
    fn bound(&self, piece: &Piece) -> f64 {
        let of_box = distance_to(&piece.bounds, self.from);
        if of_box >= self.limit() {
            return of_box;
        }
        let [a, b, c] = piece.corners.map(|corner| corner - self.from);
        of_box.max(closest_to_origin(a, b, c).squared.sqrt() - piece.height)
    }

    /// Tests a piece, and lets its parts wait if that does not decide.
    fn look_at(&mut self, piece: &Piece, face: u32, number: &mut u32) {
        match &piece.form {
            Form::Regular(regular) => {
                let [a, b, c] = piece.corners.map(|corner| corner - self.from);
                let [_, u, v] = closest_to_origin(a, b, c).weights;
                if let Some(lower) = self.descend(regular, [u, v], (piece.domain, face)) {
                    return self.pass_over(lower);
                }
            }
            Form::Irregular(_) => {
                for (corner, at) in
                    piece
                        .corners
                        .into_iter()
                        .zip([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
                {
                    self.offer(corner.distance(self.from), corner, (piece.domain, face), at);
                }
            }
        }
        let bound = self.bound(piece);
        let size = (piece.corners[1] - piece.corners[0])
            .abs()
            .max((piece.corners[2] - piece.corners[0]).abs());
        if bound >= self.limit() || size.max_element() < SPECK {
            return self.pass_over(bound);
        }
        let proximity = self.proximity;
        for part in piece.parts(&proximity.frame, proximity.surface.rules()) {
            let bound = self.bound(&part);
            match bound >= self.limit() {
                true => self.pass_over(bound),
                false => self.wait(number, bound, Pending::Own(Box::new(part), face)),
            }
        }
    }

    /// Takes a point if it is nearer than any before, and reports whether it is.
    fn offer(
        &mut self,
        distance: f64,
        point: DVec3,
        (domain, face): (ParamTriangle, u32),
        at: [f64; 2],
    ) -> bool {
        let is_nearer = distance < self.best.distance;
        if is_nearer {
            self.best = Best {
                distance,
                point,
                face,
                weights: domain.weights(at),
            };
        }
        is_nearer
    }

    /// Newton's method on a regular piece, from a place; gives a bound for the whole piece. The
    /// nearest point so far is iterated until it converges, which moves it by far more than its
    /// distance changes.
    fn descend(
        &mut self,
        piece: &RegularPiece,
        mut at: [f64; 2],
        over: (ParamTriangle, u32),
    ) -> Option<f64> {
        let from = self.from - piece.origin;
        let made = if piece.convexity.is_none() {
            Some(piece.convexity())
        } else {
            None
        };
        let convexity = piece.convexity.as_ref().or(made.as_ref())?;
        let eigenvalue = convexity.least_eigenvalue(from);
        let mut decided = None;
        for step in 0..STEPS {
            let [u, v] = at;
            let point = piece.polynomial.point(u, v);
            let away = point - from;
            let [by_u, by_v] = piece.polynomial.tangents(u, v);
            let is_nearest = self.offer(away.length(), point + piece.origin, over, at);
            let gradient = [away.dot(by_u), away.dot(by_v)];
            let lower = convexity.bound(0.5 * away.length_squared(), at, gradient, eigenvalue);
            // NaN is no bound.
            let lower = if lower > 0.0 {
                (2.0 * lower).sqrt()
            } else {
                0.0
            };
            if lower >= self.limit() {
                decided = Some(lower);
            }
            let is_known_convex = eigenvalue > 0.0;
            if (decided.is_some() && !is_nearest)
                || (decided.is_none() && !is_known_convex && step + 1 == FEW_STEPS)
            {
                return decided;
            }
            let [uu, uv, vv] = piece
                .polynomial
                .second_derivatives(u, v)
                .map(|second| away.dot(second));
            let first = [by_u.dot(by_u), by_u.dot(by_v), by_v.dot(by_v)];
            let whole = [first[0] + uu, first[1] + uv, first[2] + vv];
            let hessian = if is_definite(whole) { whole } else { first };
            match least(at, gradient, hessian) {
                Some(next) if next != at => at = next,
                _ => return decided,
            }
        }
        decided
    }
}

fn is_definite([uu, uv, vv]: [f64; 3]) -> bool {
    uu > 0.0 && vv > 0.0 && uu * vv > uv * uv
}

/// Where in the unit triangle a quadratic function is least, given its derivatives at a place; `None` if it is not convex.
fn least(at: [f64; 2], gradient: [f64; 2], hessian: [f64; 3]) -> Option<[f64; 2]> {
    let [uu, uv, vv] = hessian;
    if !is_definite(hessian) {
        return None;
    }
    let determinant = uu * vv - uv * uv;
    let step = [
        (uv * gradient[1] - vv * gradient[0]) / determinant,
        (uv * gradient[0] - uu * gradient[1]) / determinant,
    ];
    let [u, v] = [at[0] + step[0], at[1] + step[1]];
    if u >= 0.0 && v >= 0.0 && u + v <= 1.0 {
        return Some([u, v]);
    }
    const EDGES: [([f64; 2], [f64; 2]); 3] = [
        ([0.0, 0.0], [1.0, 0.0]),
        ([0.0, 0.0], [0.0, 1.0]),
        ([1.0, 0.0], [-1.0, 1.0]),
    ];
    let mut best = (f64::INFINITY, at);
    for (start, [eu, ev]) in EDGES {
        let d = [start[0] - at[0], start[1] - at[1]];
        let by = [
            uu * d[0] + uv * d[1] + gradient[0],
            uv * d[0] + vv * d[1] + gradient[1],
        ];
        let bend = uu * eu * eu + 2.0 * uv * eu * ev + vv * ev * ev;
        let along = (-(by[0] * eu + by[1] * ev) / bend).clamp(0.0, 1.0);
        let there = [start[0] + along * eu, start[1] + along * ev];
        let [du, dv] = [there[0] - at[0], there[1] - at[1]];
        let value = gradient[0] * du
            + gradient[1] * dv
            + 0.5 * (uu * du * du + 2.0 * uv * du * dv + vv * dv * dv);
        if value < best.0 {
            best = (value, there);
        }
    }
    Some(best.1)
}

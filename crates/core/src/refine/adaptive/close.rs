//! Judges what the closing of gaps brings: the triangles of leaves with split edges (the paper's Figure 5), and leaves that were
//! made for their neighbours' sake. Counts vertices and triangles on the way.

use std::collections::HashMap;

use super::chains::Chains;
use super::decide::Control;
use super::judge::{Allowance, Condition, Extent, Goal, Judge, Outcome, Verdict};
use super::leaf::leaf_triangles;
use super::quadtree::{Edges, Place, Trees};
use super::rim::{Rim, bits};
use super::surface::{Spot, Surface, with_patch};
use super::walk::{Knot, Node, Visitor, Walk};
use crate::certificate::{Cell, Pieces, SubTriangle};

/// What the walk over a control face found.
#[derive(Clone, Debug, Default)]
pub(super) struct Closed {
    /// Vertices inside the face.
    pub(super) vertices: u32,
    /// Triangles.
    pub(super) triangles: u32,
    /// For each leaf with two split edges, in the order of the walk, whether its diagonal starts at the unsplit edge's end.
    pub(super) diagonals: Vec<bool>,
    /// What was judged here.
    pub(super) extent: Option<Extent>,
    /// Leaves whose triangles fail.
    pub(super) failing: Vec<Place>,
    /// Leaves that pass on conditions, in the order of the walk.
    pub(super) conditions: Vec<Condition>,
    /// What was said of leaves, by the edges that were split, for the next walk.
    pub(super) verdicts: Verdicts,
}

/// Verdicts of leaves by their place, the edges that are split; with the diagonal.
pub(super) type Verdicts = HashMap<(Place, u8), (Verdict, bool)>;

/// Counts a face's vertices and triangles; whether there is anything to judge.
struct Counter {
    triangles: usize,
    has_more: bool,
}

impl Visitor for Counter {
    fn chain(&mut self, _: &[Knot], _: usize, _: Spot, _: &Surface<'_>) {}

    fn leaves(&mut self, node: &Node<'_>, _: &mut [Knot]) {
        self.triangles += node.triangles();
        self.has_more |= node.is_unjudged || !node.is_plain();
    }
}

/// Walks over a face.
pub(super) fn close(
    control: &Control<'_>,
    goal: &Goal,
    edges: &Edges<'_>,
    (trees, chains): (&Trees, &Chains),
    (allowance, known, is_kept): (&Allowance, &Verdicts, bool),
    face: u32,
    knots: &mut Vec<Knot>,
) -> Closed {
    let mut walk = Walk { trees, rules: control.rules, knots: core::mem::take(knots), next: 0 };
    walk.knots.clear();
    let sides = chains.sides(control.mesh, edges, face, &mut walk.knots);
    let at = (Place::root(face), Spot::WHOLE);
    let mut counter = Counter { triangles: 0, has_more: false };
    walk.node(trees.root(face), at, sides, &Surface::Unknown, &mut counter);
    let mut closed = Closed { vertices: walk.next, triangles: counter.triangles as u32, ..Closed::default() };
    if counter.has_more {
        let mut closer = Closer {
            judge: goal.judge(control, face),
            allowance,
            known,
            is_kept,
            open: control.open(face),
            rim: Rim::default(),
            closed: Closed { extent: Some(Extent::NONE), ..closed },
        };
        with_patch(&control.patch(face), control.corners(face), 0, &mut |surface| {
            walk.node(trees.root(face), at, sides, surface, &mut closer);
        });
        closed = closer.closed;
    }
    *knots = walk.knots;
    closed
}

struct Closer<'a> {
    judge: Judge<'a>,
    allowance: &'a Allowance,
    known: &'a Verdicts,
    /// Whether verdicts are kept for the next walk.
    is_kept: bool,
    /// The face's own edges.
    open: [bool; 3],
    rim: Rim,
    closed: Closed,
}

impl Visitor for Closer<'_> {
    fn chain(&mut self, _: &[Knot], _: usize, _: Spot, _: &Surface<'_>) {}

    fn leaves(&mut self, node: &Node<'_>, knots: &mut [Knot]) {
        if node.is_plain() {
            if node.is_unjudged {
                self.leaf(node, (0, 0), [None; 3]);
            }
            return;
        }
        self.rim.set(node, knots);
        let n = 1 << node.depth;
        for (i, j) in Rim::leaves(n) {
            let split = self.rim.split(n, i, j);
            if split != [None; 3] || node.is_unjudged {
                self.leaf(node, (i, j), split);
            }
        }
    }
}

/// Whether an edge of a node lies along an edge of its control face.
pub(super) fn lies_along(place: Place, edge: usize) -> bool {
    (0..place.level).all(|level| {
        let child = place.digit(level);
        child == edge || child == (edge + 1) % 3
    })
}

impl Closer<'_> {
    /// The triangles of a leaf, of which `split` says which edges are split.
    fn leaf(&mut self, node: &Node<'_>, (i, j): (usize, usize), split: [Option<usize>; 3]) {
        let n = 1 << node.depth;
        let place = node.place.leaf(node.depth, (i, j), false);
        let on_side = [j == 0, i + j + 1 == n, i == 0];
        let open = [0, 1, 2].map(|edge| self.open[edge] && on_side[edge] && lies_along(node.place, edge));
        let middles = [0, 1, 2].map(|edge| split[edge].map(|_| 3 + edge));
        let (judge, allowance) = (&self.judge, *self.allowance);
        let key = (place, bits(&split));
        let found = match node.surface {
            _ if self.known.contains_key(&key) => self.known[&key],
            Surface::Regular(ground, spot) => {
                let spot = spot.leaf(node.depth, i, j);
                let [a, b, c] = spot.corners();
                let domain = [a, b, c, spot.along(0, 0.5), spot.along(1, 0.5), spot.along(2, 0.5)];
                let points = domain.map(|at| ground.at(at));
                best(middles, open, |part, labels, open| {
                    let cell = Cell(labels.map(|label| domain[label]));
                    judge.regular(
                        ground,
                        (place, part),
                        &cell,
                        &labels.map(|label| points[label]),
                        open,
                        &allowance,
                    )
                })
            }
            Surface::General { patch, corners, .. } => {
                let mut pieces = Pieces::of(patch);
                let [a, b, c] = *corners;
                let refined = pieces.refined(judge.rules);
                let [d, e, f] = [0, 1, 2].map(|edge| refined.middle(edge));
                let points = [a, b, c, d, e, f];
                best(middles, open, |part, labels, open| {
                    let part = (place.level, part);
                    judge.general(&mut pieces, part, &labels.map(|label| points[label]), open, &allowance)
                })
            }
            Surface::Unknown => return,
        };
        if self.is_kept {
            self.closed.verdicts.insert(key, found);
        }
        if bits(&split).count_ones() == 2 {
            self.closed.diagonals.push(found.1);
        }
        if let Some(extent) = &mut self.closed.extent {
            extent.add(&Extent { worst: Some(place), ..found.0.extent });
        }
        match found.0.outcome {
            Outcome::Passes => {}
            Outcome::Fails => self.closed.failing.push(place),
            Outcome::Depends { .. } if node.is_strict => self.closed.failing.push(place),
            Outcome::Depends { deviation, tilt, slope } => {
                self.closed.conditions.push(Condition { place, deviation, tilt, slope });
            }
        }
    }
}

/// The verdict over all triangles of a leaf, by the better of two diagonals where there is a choice, and whether that
/// starts at the unsplit edge's end.
fn best(
    middles: [Option<usize>; 3],
    open: [bool; 3],
    mut judge: impl FnMut(SubTriangle, [usize; 3], [bool; 3]) -> Verdict,
) -> (Verdict, bool) {
    let is_choice = middles.iter().flatten().count() == 2;
    let mut best: Option<(Verdict, bool)> = None;
    for from_end in [false, true] {
        let mut all = Verdict::NONE;
        for triangle in leaf_triangles([0, 1, 2], middles, from_end) {
            let open = triangle.borders.map(|border| border.is_some_and(|edge| open[edge]));
            all = all.and(&judge(triangle.part, triangle.corners, open));
        }
        let is_better = best.is_none_or(|(known, _)| {
            (known.fails() && !all.fails())
                || all.fails() == known.fails() && all.extent.bound < known.extent.bound
        });
        if is_better {
            best = Some((all, from_end));
        }
        if !is_choice || !all.fails() {
            break;
        }
    }
    best.unwrap_or((Verdict::NONE, false))
}

//! Judges what the closing of gaps brings: the triangles of leaves with split edges (the paper's Figure 5), and leaves that were
//! made for their neighbours' sake. Counts vertices and triangles on the way.

use super::chains::Chains;
use super::control::Control;
use super::judge::{Allowance, Condition, Extent, Goal, Judge, Outcome, Verdict};
use super::leaf::leaf_triangles;
use super::quadtree::{Edges, Place, Trees, UNJUDGED, is_split};
use super::rim::Rim;
use super::surface::{GeneralPiece, Ground, Surface};
use super::walk::{Knot, Node, Visitor, Walk};
use crate::certificate::{Cell, Pieces, SubTriangle};
use crate::parallel::IsStopped;
use crate::patch::{LimitPoint, Spot};

/// Leaves that are judged between two questions whether that is still of use.
const ASKED: usize = 256;

/// What the walk over a control face found.
#[derive(Clone, Debug, Default)]
pub(super) struct Closed {
    /// Vertices inside the face.
    pub(super) vertices: u32,
    /// Triangles.
    pub(super) triangles: u32,
    /// Leaves.
    leaves: usize,
    /// What is known of leaves that were judged; most faces have none.
    pub(super) judged: Option<Box<JudgedLeaves>>,
}

/// What the leaves that a walk had to judge come to.
#[derive(Clone, Debug, Default)]
pub(super) struct JudgedLeaves {
    /// For each leaf with two split edges, in the order of the walk, whether its diagonal starts at the unsplit edge's end.
    diagonals: Vec<bool>,
    /// What was judged here.
    extent: Extent,
    /// Leaves whose triangles fail.
    failing: Vec<Place>,
    /// Leaves that pass on conditions, in the order of the walk.
    pub(super) conditions: Vec<Condition>,
    /// What was said of leaves, by the edges that were split, for the next walk.
    verdicts: Verdicts,
}

/// What was said of leaves in the order of the walk.
type Verdicts = Vec<Judged>;

/// A leaf with split edges, or one that was made for its neighbours' sake.
#[derive(Clone, Debug)]
pub(super) struct Judged {
    place: Place,
    /// The edges that are split.
    split: [bool; 3],
    /// The edges beyond which there is nobody.
    open: [bool; 3],
    is_strict: bool,
    /// What was said of it, and whether its diagonal starts at the unsplit edge's end.
    verdict: Option<(Verdict, bool)>,
}

/// Lists the leaves of a face that have to be judged, and counts its triangles and all leaves.
struct Lister {
    triangles: usize,
    count: usize,
    /// The face's own edges.
    open: [bool; 3],
    rim: Rim,
    leaves: Verdicts,
}

impl Visitor for Lister {
    fn chain(&mut self, _: &[Knot], _: usize, _: Spot, _: Surface<'_>) {}

    fn leaves(&mut self, node: &Node<'_>, knots: &mut [Knot]) {
        self.triangles += node.triangles();
        self.count += 1 << (2 * node.depth);
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

impl Lister {
    fn leaf(&mut self, node: &Node<'_>, (i, j): (usize, usize), split: [Option<usize>; 3]) {
        let n = 1 << node.depth;
        let place = node.place.leaf(node.depth, (i, j), false);
        let on_side = [j == 0, i + j + 1 == n, i == 0];
        let open = [0, 1, 2].map(|edge| self.open[edge] && on_side[edge] && node.place.lies_along(edge));
        let split = split.map(|middle| middle.is_some());
        self.leaves.push(Judged { place, split, open, is_strict: node.is_strict, verdict: None });
    }
}

/// Walks over a face; `known` is what was said on the last walk.
pub(super) fn close(
    control: &Control<'_>,
    (goal, max_levels): (&Goal, u32),
    edges: &Edges<'_>,
    (trees, chains): (&Trees, &Chains),
    (allowance, known, is_kept): (&Allowance, &Closed, bool),
    (face, is_stopped): (u32, &IsStopped<'_>),
    knots: &mut Vec<Knot>,
) -> Closed {
    let word = trees.root(face);
    if !is_split(word) && word & UNJUDGED == 0 && chains.are_none(edges, face) {
        return Closed { triangles: 1, leaves: 1, ..Closed::default() };
    }
    let mut walk = Walk::new(trees, core::mem::take(knots), 0, is_stopped);
    walk.knots.clear();
    let sides = chains.sides(control.mesh, edges, face, &mut walk.knots);
    let at = (Place::root(face), Spot::WHOLE);
    let mut lister =
        Lister { triangles: 0, count: 0, open: control.open(face), rim: Rim::default(), leaves: Vec::new() };
    walk.node(word, at, sides, Surface::Unknown, &mut lister);
    *knots = walk.knots;
    let Lister { triangles, count, mut leaves, .. } = lister;
    let mut closed =
        Closed { vertices: walk.next, triangles: triangles as u32, leaves: count, ..Closed::default() };
    if leaves.is_empty() {
        return closed;
    }
    recall(known.judged.as_ref().map_or(&[], |judged| &judged.verdicts), &mut leaves);
    if leaves.iter().any(|leaf| leaf.verdict.is_none()) {
        let closer = Closer { judge: goal.judge(control, max_levels, face), allowance };
        closer.judge(control.piece(face).surface(control.rules), 0, &mut leaves, is_stopped);
    }
    let mut judged = JudgedLeaves::of(&leaves, max_levels);
    if is_kept {
        judged.verdicts = leaves;
    }
    closed.judged = Some(Box::new(judged));
    closed
}

/// Takes over what was said of the same leaves with the same edges split.
fn recall(known: &[Judged], leaves: &mut Verdicts) {
    let mut known = known.iter().peekable();
    for leaf in leaves {
        while known.next_if(|other| other.place.precedes(leaf.place)).is_some() {}
        if let Some(other) = known.next_if(|other| other.place == leaf.place)
            && other.split == leaf.split
        {
            leaf.verdict = other.verdict;
        }
    }
}

impl Closed {
    /// Forgets what is known of the tree and its leaves: it was replaced.
    pub(super) fn forget(&mut self) {
        self.leaves = 0;
        self.judged.iter_mut().for_each(|judged| judged.verdicts = Verdicts::new());
    }

    /// The same, but for leaves that are within a value whatever their neighbours are.
    pub(super) fn forget_beyond(&mut self, limit: f64) {
        self.leaves = 0;
        let is_within = |leaf: &Judged| {
            let verdict = leaf.verdict.as_ref();
            verdict.is_some_and(|(verdict, _)| verdict.passes() && verdict.extent.bound <= limit)
        };
        self.judged.iter_mut().for_each(|judged| judged.verdicts.retain(is_within));
    }

    /// For each leaf with two split edges, in the order of the walk, whether its diagonal starts at the unsplit edge's end.
    pub(super) fn diagonals(&self) -> &[bool] {
        self.judged.as_ref().map_or(&[], |judged| &judged.diagonals)
    }

    /// What was judged here.
    pub(super) fn extent(&self) -> Option<&Extent> {
        self.judged.as_ref().map(|judged| &judged.extent)
    }

    /// Leaves that pass on conditions, in the order of the walk.
    pub(super) fn conditions(&self) -> &[Condition] {
        self.judged.as_ref().map_or(&[], |judged| &judged.conditions)
    }

    /// Leaves whose triangles fail; they are told once.
    pub(super) fn take_failing(&mut self) -> Vec<Place> {
        self.judged.as_mut().map(|judged| core::mem::take(&mut judged.failing)).unwrap_or_default()
    }

    /// Whether triangles and conditions are the same if the vertices along the edges are: in between leaves were only divided.
    pub(super) fn is_as(&self, other: &Self) -> bool {
        self.leaves == other.leaves
            && self.diagonals() == other.diagonals()
            && self.conditions() == other.conditions()
    }
}

impl JudgedLeaves {
    /// What was said of leaves.
    fn of(leaves: &[Judged], max_levels: u32) -> Self {
        let mut judged = Self::default();
        for leaf in leaves {
            let place = leaf.place;
            let Some((verdict, from_end)) = leaf.verdict else {
                // What nobody has judged is beyond every bound.
                judged.extent.add(&Extent { bound: f64::INFINITY, worst: Some(place), ..Extent::NONE });
                continue;
            };
            if leaf.split.iter().filter(|&&is_split| is_split).count() == 2 {
                judged.diagonals.push(from_end);
            }
            judged.extent.add(&Extent { worst: Some(place), ..verdict.extent });
            match verdict.outcome {
                Outcome::Passes => {}
                Outcome::Fails => judged.failing.push(place),
                Outcome::Depends { .. } if leaf.is_strict && place.level < max_levels => {
                    judged.failing.push(place)
                }
                Outcome::Depends { deviation, tilt, slopes } => {
                    judged.conditions.push(Condition { place, deviation, tilt, slopes });
                }
            }
        }
        judged
    }
}

/// Judges leaves of a face.
struct Closer<'a> {
    judge: Judge<'a>,
    allowance: &'a Allowance,
}

impl Closer<'_> {
    /// Judges those of a node's leaves that nobody has judged, over its surface.
    fn judge(&self, surface: Surface<'_>, level: u32, leaves: &mut [Judged], is_stopped: &IsStopped<'_>) {
        let mut wanting = leaves.iter_mut().filter(|leaf| leaf.verdict.is_none()).peekable();
        if wanting.peek().is_none() {
            return;
        }
        match surface {
            Surface::Unknown => {}
            Surface::Regular(piece, spot) => {
                let ground = piece.ground();
                for (i, leaf) in wanting.enumerate() {
                    if i % ASKED == ASKED - 1 && is_stopped() {
                        return;
                    }
                    let levels = level..leaf.place.level;
                    let spot = levels.fold(spot, |spot, level| spot.child(leaf.place.digit(level)));
                    leaf.verdict = Some(self.regular(ground, spot, leaf));
                }
            }
            Surface::General(..) if is_stopped() => {}
            Surface::General(piece, rules) => match leaves {
                [leaf] if leaf.place.level == level => {
                    leaf.verdict = Some(self.general(piece, piece.middles(rules), leaf))
                }
                _ => {
                    for of_child in leaves.chunk_by_mut(|a, b| a.place.digit(level) == b.place.digit(level)) {
                        let child = of_child[0].place.digit(level);
                        self.judge(surface.child(child), level + 1, of_child, is_stopped);
                    }
                }
            },
        }
    }

    /// The triangles of a leaf over a regular piece.
    fn regular(&self, ground: &Ground, spot: Spot, leaf: &Judged) -> (Verdict, bool) {
        let [a, b, c] = spot.corners();
        let domain = [a, b, c, spot.along(0, 0.5), spot.along(1, 0.5), spot.along(2, 0.5)];
        let points = ground.at(domain);
        best(leaf, |part, labels, open| {
            let cell = Cell(labels.map(|label| domain[label]));
            let at = (spot, leaf.place.level, part);
            let corners = labels.map(|label| points[label]);
            self.judge.regular(ground, at, &cell, &corners, open, self.allowance)
        })
    }

    /// The triangles of a leaf over any piece.
    fn general(&self, piece: &GeneralPiece, middles: [LimitPoint; 3], leaf: &Judged) -> (Verdict, bool) {
        let mut pieces = Pieces::of(&piece.patch);
        let ([a, b, c], [d, e, f]) = (piece.corners, middles);
        let points = [a, b, c, d, e, f];
        best(leaf, |part, labels, open| {
            let corners = labels.map(|label| points[label]);
            let at = (leaf.place.level, part);
            self.judge.general(&mut pieces, at, &corners, open, self.allowance)
        })
    }
}

/// The verdict over all triangles of a leaf, by the better of two diagonals where there is a choice, and whether that
/// starts at the unsplit edge's end.
fn best(
    leaf: &Judged,
    mut judge: impl FnMut(SubTriangle, [usize; 3], [bool; 3]) -> Verdict,
) -> (Verdict, bool) {
    let open = leaf.open;
    let middles = [0, 1, 2].map(|edge| leaf.split[edge].then_some(3 + edge));
    let is_choice = middles.iter().flatten().count() == 2;
    let mut best: Option<(Verdict, bool)> = None;
    for from_end in [false, true] {
        let mut all = Verdict::NONE;
        for triangle in leaf_triangles([0, 1, 2], middles, from_end) {
            let open = triangle.borders.map(|border| border.is_some_and(|edge| open[edge]));
            all = all.and(&judge(triangle.part, triangle.corners, open));
        }
        // A leaf with split edges has several triangles, each with edges of its own.
        let all = if leaf.split == [false; 3] { all } else { all.spread() };
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

//! Judges what the closing of gaps brings: the triangles of leaves with split edges (the paper's Figure 5), and leaves that were
//! made for their neighbours' sake. Counts vertices and triangles on the way.
//!
//! A face is walked over as a whole once; where leaves were split since, only they and those beside them are looked at
//! again ([`Closing::close_again`]).

mod judged;
mod unfinished;

use super::chains::Chains;
use super::control::Control;
use super::dirty::split_edges;
use super::judge::{Allowance, Goal, Judge, Verdict};
use super::leaf::leaf_triangles;
use super::quadtree::{Edges, Place, STRICT, Trees, UNJUDGED, is_split, is_unjudged};
use super::rim::Rim;
use super::surface::{GeneralPiece, Ground, Surface, SurfacePiece};
use super::walk::{Knot, Node, Visitor, Walk};
use crate::certificate::{Cell, Pieces, SubTriangle};
use crate::parallel::IsStopped;
use crate::patch::{LimitPoint, Spot};
pub(super) use judged::{Closed, Counts};
use judged::{Judged, recall};
pub(super) use unfinished::Unfinished;

/// Leaves that are judged between two questions whether that is still of use.
const ASKED: usize = 256;

/// Lists the leaves of a face that have to be judged, and counts its triangles and all leaves.
struct Lister {
    triangles: usize,
    count: usize,
    /// The face's own edges.
    open: [bool; 3],
    rim: Rim,
    leaves: Vec<Judged>,
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
        let open =
            [0, 1, 2].map(|edge| self.open[edge] && on_side[edge] && node.place.lies_along(edge));
        let split = split.map(|middle| middle.is_some());
        self.leaves
            .push(Judged::new(place, split, open, node.is_strict));
    }
}

/// What closing a face takes.
#[derive(Clone, Copy)]
pub(super) struct Closing<'a> {
    pub(super) control: &'a Control<'a>,
    pub(super) goal: &'a Goal,
    pub(super) max_levels: u32,
    pub(super) edges: &'a Edges<'a>,
    pub(super) trees: &'a Trees,
    pub(super) chains: &'a Chains,
}

impl Closing<'_> {
    /// Walks over a face; `known` is what was said the last time. Gives leaves that fail, too.
    pub(super) fn close(
        &self,
        face: u32,
        (allowance, known): (&Allowance, &Closed),
        is_stopped: &IsStopped<'_>,
        knots: &mut Vec<Knot>,
    ) -> (Closed, Vec<Place>) {
        let Self {
            control,
            edges,
            trees,
            chains,
            ..
        } = *self;
        let word = trees.root(face);
        if !is_split(word) && word & UNJUDGED == 0 && chains.are_none(edges, face) {
            return (
                Closed {
                    triangles: 1,
                    leaves: 1,
                    ..Closed::default()
                },
                Vec::new(),
            );
        }
        let mut walk = Walk::new(trees, core::mem::take(knots), 0, is_stopped);
        walk.knots.clear();
        let sides = chains.sides(control.mesh, edges, face, &mut walk.knots);
        let at = (Place::root(face), Spot::WHOLE);
        let (open, rim) = (control.open(face), Rim::default());
        let mut lister = Lister {
            triangles: 0,
            count: 0,
            open,
            rim,
            leaves: Vec::new(),
        };
        walk.node(word, at, sides, Surface::Unknown, &mut lister);
        *knots = walk.knots;
        let Lister {
            triangles,
            count,
            mut leaves,
            ..
        } = lister;
        leaves.sort_unstable_by(|a, b| a.place.in_order(&b.place));
        recall(known.known(), &mut leaves);
        self.judge(face, (&mut leaves, allowance), &mut None, is_stopped);
        let failing = self.failing(&leaves);
        let counts = Counts {
            vertices: walk.next,
            triangles: triangles as u32,
            leaves: count,
        };
        (Closed::of(counts, leaves, trees, self.max_levels), failing)
    }

    /// Closes a face again, of which leaves were `split` since, by looking at the leaves that see these: `seen`. Both are in the order of
    /// places. What has changed since it was `known` is kept in `unfinished`. Gives what it comes to in numbers, and leaves that fail.
    pub(super) fn close_again(
        &self,
        face: u32,
        (allowance, known): (&Allowance, &Closed),
        (split, seen): (&[Place], &[Place]),
        unfinished: &mut Unfinished,
        is_stopped: &IsStopped<'_>,
    ) -> (Counts, Vec<Place>) {
        split
            .iter()
            .for_each(|&place| unfinished.replace(known.known(), place, None));
        let open = self.control.open(face);
        let mut leaves = Vec::with_capacity(seen.len());
        for &place in seen {
            let mask = split_edges(self.trees, self.edges, place);
            let word = self.trees.word_at(place).unwrap_or(UNJUDGED);
            if mask == [false; 3] && !is_unjudged(word) {
                unfinished.replace(known.known(), place, None);
                continue;
            }
            let open = [0, 1, 2].map(|edge| open[edge] && place.lies_along(edge));
            let mut leaf = Judged::new(place, mask, open, word & STRICT != 0);
            unfinished
                .leaf(known.known(), place)
                .into_iter()
                .for_each(|before| leaf.recall(before));
            leaves.push(leaf);
        }
        self.judge(
            face,
            (&mut leaves, allowance),
            &mut unfinished.piece,
            is_stopped,
        );
        let failing = self.failing(&leaves);
        for leaf in leaves {
            unfinished.replace(known.known(), leaf.place, Some(leaf));
        }
        let count = known.leaves + 3 * split.len();
        let triangles = count + unfinished.split_edges;
        // A disc of so many triangles and vertices on its rim has (triangles − rim) / 2 + 1 vertices inside (Euler).
        let on_rim: usize = (3 * face..3 * face + 3)
            .map(|h| self.chains.along(self.edges, h) + 1)
            .sum();
        let vertices = (triangles + 2).saturating_sub(on_rim) / 2;
        (
            Counts {
                vertices: vertices as u32,
                triangles: triangles as u32,
                leaves: count,
            },
            failing,
        )
    }

    /// Leaves whose triangles fail.
    fn failing(&self, leaves: &[Judged]) -> Vec<Place> {
        leaves
            .iter()
            .filter(|leaf| leaf.fails(self.max_levels))
            .map(|leaf| leaf.place)
            .collect()
    }

    /// Judges those leaves of a face that nobody has judged.
    fn judge(
        &self,
        face: u32,
        (leaves, allowance): (&mut [Judged], &Allowance),
        piece: &mut Option<Box<SurfacePiece>>,
        is_stopped: &IsStopped<'_>,
    ) {
        let Self {
            control,
            goal,
            max_levels,
            ..
        } = *self;
        let mut wanting: Vec<&mut Judged> =
            leaves.iter_mut().filter(|leaf| !leaf.is_said()).collect();
        if matches!(goal, Goal::Nothing) {
            wanting
                .into_iter()
                .for_each(|leaf| leaf.say((Verdict::NONE, false)));
        } else if !wanting.is_empty() {
            let closer = Closer {
                judge: goal.judge(control, max_levels, face),
                allowance,
            };
            let piece = piece.get_or_insert_with(|| Box::new(control.piece(face)));
            closer.judge(piece.surface(control.rules), 0, &mut wanting, is_stopped);
        }
    }
}

/// Judges leaves of a face.
struct Closer<'a> {
    judge: Judge<'a>,
    allowance: &'a Allowance,
}

impl Closer<'_> {
    /// Judges leaves of a node over its surface.
    fn judge(
        &self,
        surface: Surface<'_>,
        level: u32,
        leaves: &mut [&mut Judged],
        is_stopped: &IsStopped<'_>,
    ) {
        match surface {
            Surface::Unknown => {}
            Surface::Regular(piece, spot) => {
                let ground = piece.ground();
                for (i, leaf) in leaves.iter_mut().enumerate() {
                    if i % ASKED == ASKED - 1 && is_stopped() {
                        return;
                    }
                    let levels = level..leaf.place.level;
                    let spot = levels.fold(spot, |spot, level| spot.child(leaf.place.digit(level)));
                    leaf.say(self.regular(ground, spot, leaf));
                }
            }
            Surface::General(..) if is_stopped() => {}
            Surface::General(piece, rules) => match leaves {
                [leaf] if leaf.place.level == level => {
                    leaf.say(self.general(piece, *piece.middles(rules), leaf));
                }
                _ => {
                    for of_child in
                        leaves.chunk_by_mut(|a, b| a.place.digit(level) == b.place.digit(level))
                    {
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
        let domain = [
            a,
            b,
            c,
            spot.along(0, 0.5),
            spot.along(1, 0.5),
            spot.along(2, 0.5),
        ];
        let points = ground.at(domain);
        best(leaf, |part, labels, open| {
            let cell = Cell(labels.map(|label| domain[label]));
            let at = (spot, leaf.place.level, part);
            let corners = labels.map(|label| points[label]);
            self.judge
                .regular(ground, at, &cell, &corners, open, self.allowance)
        })
    }

    /// The triangles of a leaf over any piece.
    fn general(
        &self,
        piece: &GeneralPiece,
        middles: [LimitPoint; 3],
        leaf: &Judged,
    ) -> (Verdict, bool) {
        let mut pieces = Pieces::of(&piece.patch);
        let ([a, b, c], [d, e, f]) = (piece.corners, middles);
        let points = [a, b, c, d, e, f];
        best(leaf, |part, labels, open| {
            let corners = labels.map(|label| points[label]);
            let at = (leaf.place.level, part);
            self.judge
                .general(&mut pieces, at, &corners, open, self.allowance)
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
            let open = triangle
                .borders
                .map(|border| border.is_some_and(|edge| open[edge]));
            all = all.and(&judge(triangle.part, triangle.corners, open));
        }
        // A leaf with split edges has several triangles, each with edges of its own.
        let all = if leaf.split == [false; 3] {
            all
        } else {
            all.spread()
        };
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

#[cfg(test)]
mod tests;

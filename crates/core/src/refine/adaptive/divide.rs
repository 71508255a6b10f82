//! How far each control face is divided: depth first, each node by a guess from its own piece of the surface.
//!
//! Takes the control mesh and the goal; gives a quadtree a face, and what its proven leaves have and assume of the triangles around them.

mod even_parts;
mod expected;

use core::sync::atomic::{AtomicUsize, Ordering};

use super::Engine;
use super::control::Control;
use super::judge::{Goal, Judge, Verdict};
use super::quadtree::{LEAF, MOST_LEVELS, NodeAddress, PROVEN, Piece, Trees, asking};
use super::seen::{Allowance, Extent, Fate, Seen};
use super::surface::QuarticPiece;
use crate::certificate::{CellRows, Marks, Pieces};
use crate::parallel::IsStopped;
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::{LimitPoint, ParamTriangle, Patch, RefinedPatch, child_corners};
use crate::refine::RefineError;
use crate::vector::DVec3;
use even_parts::{AtOnce, MOST_TESTED};
use expected::Expected;

/// The proven leaves of a control face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Proven {
    /// The assumption of their bounds.
    pub(super) allowance: Allowance,
    pub(super) extent: Extent,
}

/// The quadtrees, and by control face its proven leaves.
pub(super) struct Division {
    pub(super) trees: Trees,
    pub(super) proven: Vec<Proven>,
}

/// The open edges of a node's child.
#[inline]
pub(super) fn child_open(open: [bool; 3], child: usize) -> [bool; 3] {
    if child == 3 {
        return [false; 3];
    }
    let mut own = open;
    own[(child + 1) % 3] = false;
    own
}

/// Divides all control faces; `None` if that takes more than `most` leaves.
pub(super) fn divide(
    engine: &Engine<'_>,
    goal: &Goal,
    most: usize,
) -> Result<Option<Division>, RefineError> {
    let faces = engine.control.mesh.face_count();
    let count = Count {
        leaves: AtomicUsize::new(0),
        most,
    };
    let expected = Expected::of_all(engine, goal)?;
    let (control, max_levels) = (engine.control, engine.max_levels.min(MOST_LEVELS));
    let expected = &expected[..];
    let found = engine.watch.long_shares(faces, |block, is_stopped| {
        let mut divider = Divider {
            control,
            goal,
            expected,
            judge: goal.judge(control, 0),
            max_levels,
            piece: Piece::default(),
            extent: Extent::NONE,
            cell_rows: None,
            marks: Default::default(),
            leaves: 0,
            weight: 1,
            count: &count,
            is_stopped,
        };
        let proven: Vec<Proven> = block.map(|face| divider.face(face as u32)).collect();
        divider.add_count();
        (divider.piece, proven)
    })?;
    if count.is_passed() {
        return Ok(None);
    }
    let (pieces, proven): (Vec<_>, Vec<_>) = found.into_iter().unzip();
    let trees = Trees::of(&pieces, &mut || engine.watch.poll())?;
    Ok(Some(Division {
        trees,
        proven: proven.concat(),
    }))
}

/// Leaves of all faces, counted while they come about: each is a triangle at least.
struct Count {
    leaves: AtomicUsize,
    most: usize,
}

impl Count {
    /// Makes it too many.
    fn stop(&self) {
        self.leaves.store(usize::MAX / 2, Ordering::Relaxed);
    }

    fn is_passed(&self) -> bool {
        self.leaves.load(Ordering::Relaxed) > self.most
    }
}

/// Divides faces one by one.
struct Divider<'a> {
    control: &'a Control<'a>,
    goal: &'a Goal,
    /// By control face.
    expected: &'a [Expected],
    /// Of the face at hand.
    judge: Judge<'a>,
    max_levels: u32,
    piece: Piece,
    extent: Extent,
    /// Made when rows are tested first.
    cell_rows: Option<Box<CellRows>>,
    marks: [Marks; MOST_TESTED],
    /// Leaves that were not added to the count, and so many of them count as one.
    leaves: usize,
    weight: usize,
    count: &'a Count,
    is_stopped: &'a IsStopped<'a>,
}

/// A node over a part of a regular piece.
#[derive(Clone, Copy)]
struct Part<'a> {
    quartic: &'a QuarticPiece,
    domain: ParamTriangle,
    place: NodeAddress,
    corners: [LimitPoint; 3],
    open: [bool; 3],
    /// Whether rows may be worth while at the node or below it.
    has_rows: bool,
}

impl Divider<'_> {
    /// Divides a face.
    fn face(&mut self, face: u32) -> Proven {
        let control = self.control;
        self.judge = self.goal.judge(control, face);
        let weight = control.flat.weight(face);
        if weight != self.weight {
            self.add_count();
            self.weight = weight;
        }
        self.extent = Extent::NONE;
        let (patch, corners) = (control.patch(face), control.corners(face));
        let (open, place) = (control.open(face), NodeAddress::root(face));
        let word = if let Patch::Regular(points) = &patch {
            let net = BezierTriangle::of(points);
            let middles = net.middles();
            let points = middles.map(|position| LimitPoint {
                position,
                normal: DVec3::ZERO,
            });
            self.judge.allowance = self.allowance(face, &Seen::of(&corners), &points);
            self.regular(&net, &middles, corners, open, place)
        } else {
            let refined = patch.refined(control.rules);
            let middles = [0, 1, 2].map(|edge| refined.middle(edge));
            self.judge.allowance = self.allowance(face, &Seen::of(&corners), &middles);
            self.general(&patch, &refined, middles, corners, open, place)
        };
        self.piece.roots.push(word);
        Proven {
            allowance: self.judge.allowance,
            extent: self.extent,
        }
    }

    /// Adds the leaves to the common count.
    fn add_count(&mut self) {
        let leaves = core::mem::take(&mut self.leaves).div_ceil(self.weight);
        self.count.leaves.fetch_add(leaves, Ordering::Relaxed);
    }

    fn node(
        &mut self,
        patch: &Patch,
        corners: [LimitPoint; 3],
        open: [bool; 3],
        place: NodeAddress,
    ) -> u32 {
        if let Patch::Regular(points) = patch {
            let net = BezierTriangle::of(points);
            return self.regular(&net, &net.middles(), corners, open, place);
        }
        let refined = patch.refined(self.control.rules);
        let middles = [0, 1, 2].map(|edge| refined.middle(edge));
        self.general(patch, &refined, middles, corners, open, place)
    }

    /// A piece that is not regular, with its refinement and the limits in the middles of its edges.
    fn general(
        &mut self,
        patch: &Patch,
        refined: &RefinedPatch<'_>,
        middles: [LimitPoint; 3],
        corners: [LimitPoint; 3],
        open: [bool; 3],
        place: NodeAddress,
    ) -> u32 {
        // Pieces that are not regular take long each.
        if self.is_too_much() || place.level > 0 && (self.is_stopped)() {
            return LEAF;
        }
        let judge = self.judge;
        let is_deepest = place.level >= self.max_levels;
        let may_stay = !self.control.demands.divides(place)
            && (judge.is_inside(open) || judge.may_stay(patch, &corners, &middles, place.level));
        if is_deepest || may_stay {
            let mut pieces = Pieces::with_refined(patch, refined);
            let verdict = judge.general(&mut pieces, place.level, &corners, open);
            if verdict.fate != Fate::Fails || is_deepest {
                return self.leaf(&verdict);
            }
        }
        let is_demanded = self.control.demands.divides(place);
        if !is_demanded && let Some(edges) = judge.asked(&corners, &middles, open) {
            return self.asking_leaf(edges);
        }
        let children = [0, 1, 2, 3].map(|child| {
            let own = child_corners(corners, middles, child);
            self.node(
                &refined.part(child),
                own,
                child_open(open, child),
                place.child(child),
            )
        });
        self.piece.irregular_node(children)
    }

    /// A regular piece, with its points in the middles of its edges: those at irregular vertices are small.
    fn regular(
        &mut self,
        net: &BezierTriangle,
        middles: &[DVec3; 3],
        corners: [LimitPoint; 3],
        open: [bool; 3],
        place: NodeAddress,
    ) -> u32 {
        let seen = Seen::of(&corners);
        let is_demanded = self.control.demands.divides(place);
        let surely_fails = is_demanded || self.judge.surely_fails(&seen, middles);
        if !surely_fails
            && let Some(verdict) = self.judge.at_a_glance(net, &seen, open)
            && verdict.fate != Fate::Fails
        {
            return self.leaf(&verdict);
        }
        let (quartic, has_rows) = (&QuarticPiece::with_jet(net), self.judge.has_rows());
        self.part(
            Part {
                quartic,
                domain: ParamTriangle::WHOLE,
                place,
                corners,
                open,
                has_rows,
            },
            surely_fails,
        )
    }

    /// A part of a regular piece. One that is divided in any case need not be judged.
    fn part(&mut self, part: Part<'_>, surely_fails: bool) -> u32 {
        if self.is_too_much() {
            return LEAF;
        }
        let Part {
            quartic,
            domain,
            place,
            corners,
            open,
            mut has_rows,
        } = part;
        let is_demanded = self.control.demands.divides(place);
        let mut fails = surely_fails || is_demanded;
        if has_rows && !is_demanded && open == [false; 3] && !self.judge.is_inside(open) {
            match self.rows(quartic, domain, place) {
                AtOnce::Decided(word) => return word,
                AtOnce::NotHere {
                    fails: is_known,
                    may_be_below,
                } => {
                    (fails, has_rows) = (fails | is_known, may_be_below);
                }
            }
        }
        let is_deepest = place.level >= self.max_levels;
        if !fails || is_deepest {
            let verdict = self
                .judge
                .regular(quartic, domain, place.level, &corners, open);
            if verdict.fate != Fate::Fails || is_deepest {
                return self.leaf(&verdict);
            }
        }
        let middles = quartic.at([0, 1, 2].map(|edge| domain.along(edge, 0.5)));
        if !is_demanded && let Some(edges) = self.judge.asked(&corners, &middles, open) {
            return self.asking_leaf(edges);
        }
        let children = [0, 1, 2, 3].map(|child| {
            let own = Part {
                domain: domain.child(child),
                place: place.child(child),
                corners: child_corners(corners, middles, child),
                open: child_open(open, child),
                has_rows,
                ..part
            };
            self.part(own, false)
        });
        self.piece.node(children)
    }

    fn count_leaves(&mut self, count: usize) {
        self.leaves += count;
        // Leaves are added to the common count together.
        if self.leaves >= 256 {
            self.add_count();
            if (self.is_stopped)() {
                self.count.stop();
            }
        }
    }

    /// Whether there are too many leaves by now, so that nothing matters any more.
    fn is_too_much(&self) -> bool {
        self.leaves == 0 && self.count.is_passed()
    }

    /// A leaf that asks for the middles of the edges of these bits.
    fn asking_leaf(&mut self, edges: u8) -> u32 {
        self.count_leaves(1 + edges.count_ones() as usize);
        asking(edges)
    }

    fn leaf(&mut self, verdict: &Verdict) -> u32 {
        self.count_leaves(1);
        match verdict.fate {
            Fate::Proven => {
                self.extent.add(&verdict.extent);
                LEAF | PROVEN
            }
            Fate::Likely | Fate::Fails => LEAF,
        }
    }
}

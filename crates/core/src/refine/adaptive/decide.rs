//! How far each control face is divided: depth first, each node judged by itself.
//!
//! Takes the control mesh and what is asked; gives a quadtree a face, and what the leaves come to. What triangles may count on of
//! those beside ([`Allowance`]) is guessed from the control faces' own curvature, checked against what came out, and
//! widened where it was too little.

mod again;
mod allowances;
mod even_parts;
mod found;

use super::Engine;
use super::control::Control;
use super::guess::Expected;
use super::judge::{Allowance, Condition, Extent, Goal, Judge, Outcome, Seen, Verdict};
use core::sync::atomic::{AtomicUsize, Ordering};

use super::quadtree::{
    CONDITIONAL, Edges, LEAF, MOST_LEVELS, Piece, Place, Trees, UNJUDGED, bounded,
};
use super::surface::Ground;
use crate::certificate::{Cell, CellRows, Marks, Pieces, SubTriangle};
use crate::parallel::{self, IsStopped};
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::{LimitPoint, Patch, RefinedPatch, Spot, child_corners};
use crate::progress::{Cancelled, SharedWatch};
use crate::refine::RefineError;
use crate::vector::DVec3;
use even_parts::{AtOnce, MOST_TESTED};
use found::Found;

/// Leaves that are added to the common count together.
const COUNTED: usize = 256;

/// The trees, and what their leaves come to and count on, by control face.
#[derive(Clone)]
pub(super) struct Decision {
    pub(super) trees: Trees,
    /// By control face.
    found: Vec<Found>,
    /// How often faces were divided again.
    rounds: usize,
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
pub(super) fn decide(
    (control, watch): (&Control<'_>, &SharedWatch<'_>),
    goal: &Goal,
    edges: &Edges<'_>,
    max_levels: u32,
    most: usize,
) -> Result<Option<Decision>, RefineError> {
    let faces = control.mesh.face_count();
    let count = Count {
        leaves: AtomicUsize::new(0),
        most,
    };
    let expected = Expected::of_all((control, watch), goal)?;
    let mut found = limitmesh_pages::filled(Found::NOTHING, faces);
    let size = parallel::share(faces);
    let blocks: Vec<_> = found.chunks_mut(size).enumerate().collect();
    let pieces = parallel::each_long_polled(
        blocks,
        &mut |_| watch.poll(),
        |(block, found), is_stopped| {
            let mut decider = Decider::new(control, edges, goal, max_levels, (&count, is_stopped));
            decider.expected = &expected;
            for (face, found) in (size * block..).zip(found) {
                *found = decider.face(face as u32, None);
            }
            decider.tell();
            decider.piece
        },
    )?;
    if count.is_passed() {
        return Ok(None);
    }
    let trees = Trees::of(&pieces, &mut || watch.poll())?;
    let mut decision = Decision {
        trees,
        found,
        rounds: 0,
    };
    drop((pieces, expected));
    loop {
        match decision.settle((control, watch), goal, edges, (max_levels, most), |_| None)? {
            Some(faces) if faces.is_empty() => return Ok(Some(decision)),
            Some(_) => {}
            None => return Ok(None),
        }
    }
}

/// How many leaves some control faces come to, each divided by itself from the beginning; about, where that is more than the number beside it.
pub(super) fn leaves_of(
    engine: &Engine<'_>,
    goal: &Goal,
    faces: &[(u32, usize)],
) -> Result<Vec<usize>, Cancelled> {
    let Engine {
        control,
        watch,
        ref edges,
        max_levels,
        ..
    } = *engine;
    let blocks = watch.long_shares(faces.len(), |block, is_stopped| {
        let leaves = faces[block].iter().map(|&(face, most)| {
            let count = Count {
                leaves: AtomicUsize::new(0),
                most,
            };
            let mut decider = Decider::new(control, edges, goal, max_levels, (&count, is_stopped));
            decider.face(face, None);
            decider.tell();
            count.leaves.load(Ordering::Relaxed)
        });
        leaves.collect::<Vec<usize>>()
    })?;
    Ok(blocks.concat())
}

impl Decision {
    /// The leaves of a face that pass on conditions, in the order of the tree; those that were split since are among them.
    pub(super) fn conditions(&self, face: u32) -> &[Condition] {
        self.found[face as usize].conditions()
    }

    /// What the triangles of a face count on.
    pub(super) fn allowance(&self, face: u32) -> &Allowance {
        &self.found[face as usize].allowance
    }

    /// The same trees, of whose leaves nothing is known.
    pub(super) fn unjudged(mut self) -> Self {
        self.found.fill(Found::NOTHING);
        self
    }

    /// The greatest bound of a leaf of a face, conditions expected to hold.
    pub(super) fn bound(&self, face: u32) -> f64 {
        let found = &self.found[face as usize];
        let conditional = found
            .conditions()
            .iter()
            .map(|condition| condition.deviation.height);
        conditional.fold(found.bound(), f64::max)
    }

    /// Whether leaves fail that must not be divided.
    pub(super) fn has_failed(&self) -> bool {
        self.found.iter().any(Found::has_failed)
    }

    /// What the leaves of a face come to.
    pub(super) fn extent(&self, face: u32) -> Extent {
        self.found[face as usize].extent(face)
    }
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
struct Decider<'a> {
    control: &'a Control<'a>,
    edges: &'a Edges<'a>,
    goal: &'a Goal,
    /// By control face, if it is known of all.
    expected: &'a [Expected],
    /// Of the face at hand.
    judge: Judge<'a>,
    max_levels: u32,
    piece: Piece,
    allowance: Allowance,
    extent: Extent,
    conditions: Vec<Condition>,
    has_failed: bool,
    /// Made when rows are tested first.
    cell_rows: Option<Box<CellRows>>,
    marks: [Marks; MOST_TESTED],
    /// Leaves that were not added to the count, and so many of them count as one.
    leaves: usize,
    weight: usize,
    count: &'a Count,
    is_stopped: &'a IsStopped<'a>,
}

impl<'a> Decider<'a> {
    fn new(
        control: &'a Control<'a>,
        edges: &'a Edges<'a>,
        goal: &'a Goal,
        max_levels: u32,
        (count, is_stopped): (&'a Count, &'a IsStopped<'a>),
    ) -> Self {
        Self {
            control,
            edges,
            goal,
            expected: &[],
            judge: goal.judge(control, max_levels, 0),
            max_levels: max_levels.min(MOST_LEVELS),
            piece: Piece::default(),
            allowance: Allowance::NOTHING,
            extent: Extent::NONE,
            conditions: Vec::new(),
            has_failed: false,
            cell_rows: None,
            marks: Default::default(),
            leaves: 0,
            weight: 1,
            count,
            is_stopped,
        }
    }

    /// Divides a face from the beginning, with an allowance or one that is guessed.
    fn face(&mut self, face: u32, allowance: Option<Allowance>) -> Found {
        if let Goal::Even(levels, is_finer) = self.goal {
            let word = self.even(levels + u32::from(is_finer[face as usize]));
            self.piece.roots.push(word);
            return Found::NOTHING;
        }
        self.begin(face);
        let patch = self.control.patch(face);
        let corners = self.control.corners(face);
        let (open, place) = (self.control.open(face), Place::root(face));
        let word = if let Patch::Regular(points) = &patch {
            let net = BezierTriangle::of(points);
            let middles = net.middles();
            let points = middles.map(|position| LimitPoint {
                position,
                normal: DVec3::ZERO,
            });
            let seen = Seen::of(&corners, 0);
            self.allowance = allowance.unwrap_or_else(|| self.guess(face, &seen, &points));
            self.regular(&net, &middles, (corners, &seen), open, place)
        } else {
            let refined = patch.refined(self.control.rules);
            let middles = [0, 1, 2].map(|edge| refined.middle(edge));
            self.allowance =
                allowance.unwrap_or_else(|| self.guess(face, &Seen::of(&corners, 0), &middles));
            self.general(&patch, (&refined, middles), corners, open, place)
        };
        self.piece.roots.push(word);
        self.end(face)
    }

    /// Begins with a face.
    fn begin(&mut self, face: u32) {
        self.judge = self.goal.judge(self.control, self.max_levels, face);
        let weight = self.control.flat.weight(face);
        if weight != self.weight {
            self.tell();
            self.weight = weight;
        }
        (self.extent, self.has_failed) = (Extent::NONE, false);
    }

    /// What the face came to.
    fn end(&mut self, face: u32) -> Found {
        let conditions = core::mem::take(&mut self.conditions);
        Found::of(
            face,
            &self.extent,
            self.allowance,
            (self.has_failed, conditions),
        )
    }

    /// A node with leaves so many levels below it that were not judged.
    fn even(&mut self, levels: u32) -> u32 {
        if levels == 0 {
            self.count_leaves(1);
            return LEAF | UNJUDGED;
        }
        let children = [0; 4].map(|_| self.even(levels - 1));
        self.piece.irregular_node(children)
    }

    /// Tells how many leaves were not told yet.
    fn tell(&mut self) {
        let leaves = core::mem::take(&mut self.leaves).div_ceil(self.weight);
        self.count.leaves.fetch_add(leaves, Ordering::Relaxed);
    }

    /// What triangles of a face count on at first.
    fn guess(&self, face: u32, seen: &Seen, middles: &[LimitPoint; 3]) -> Allowance {
        let beside = self
            .control
            .beside(self.edges, face)
            .map(|face| match self.expected {
                [] => Expected::of(self.control, self.goal, face),
                known => known[face as usize],
            });
        self.judge.guess(seen, middles, beside)
    }

    fn node(
        &mut self,
        patch: &Patch,
        corners: [LimitPoint; 3],
        open: [bool; 3],
        place: Place,
    ) -> u32 {
        if let Patch::Regular(points) = patch {
            let (net, seen) = (BezierTriangle::of(points), Seen::of(&corners, place.level));
            return self.regular(&net, &net.middles(), (corners, &seen), open, place);
        }
        let refined = patch.refined(self.control.rules);
        let middles = [0, 1, 2].map(|edge| refined.middle(edge));
        self.general(patch, (&refined, middles), corners, open, place)
    }

    /// A piece that is not regular, with its refinement and the limits in the middles of its edges.
    fn general(
        &mut self,
        patch: &Patch,
        (refined, middles): (&RefinedPatch<'_>, [LimitPoint; 3]),
        corners: [LimitPoint; 3],
        open: [bool; 3],
        place: Place,
    ) -> u32 {
        // Pieces that are not regular take long each.
        if self.is_too_much() || place.level > 0 && (self.is_stopped)() {
            return LEAF;
        }
        let judge = self.judge;
        if judge.is_inside(open) {
            return self.leaf(place, &Verdict::NONE);
        }
        let may_stay = !self.control.demands.divides(place);
        if place.level >= self.max_levels
            || may_stay && judge.may_pass(patch, &corners, &middles, place.level)
        {
            let mut pieces = Pieces::with_refined(patch, refined);
            let part = (place.level, SubTriangle::Whole);
            let verdict = judge.general(&mut pieces, part, &corners, open, &self.allowance);
            if !verdict.fails() || place.level >= self.max_levels {
                return self.leaf(place, &verdict);
            }
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

    /// A regular piece, with its points in the middles of its edges: those beside irregular vertices are small.
    fn regular(
        &mut self,
        net: &BezierTriangle,
        middles: &[DVec3; 3],
        (corners, seen): ([LimitPoint; 3], &Seen),
        open: [bool; 3],
        place: Place,
    ) -> u32 {
        let may_stay =
            !self.control.demands.divides(place) && !self.judge.surely_fails(seen, middles);
        if may_stay || place.level >= self.max_levels {
            let verdict = self.judge.at_a_glance(net, seen, open, &self.allowance);
            if let Some(verdict) =
                verdict.filter(|known| !known.fails() || place.level >= self.max_levels)
            {
                return self.leaf(place, &verdict);
            }
        }
        self.part(
            &Ground::with_jet(net),
            Spot::WHOLE,
            corners,
            open,
            (place, self.judge.has_rows()),
            !may_stay,
        )
    }

    /// A part of a regular piece; `has_rows` as long as whole rows may be worth while below. One that is divided in any case need not be
    /// judged.
    fn part(
        &mut self,
        ground: &Ground,
        spot: Spot,
        corners: [LimitPoint; 3],
        open: [bool; 3],
        (place, has_rows): (Place, bool),
        surely_fails: bool,
    ) -> u32 {
        if self.is_too_much() {
            return LEAF;
        }
        if self.judge.is_inside(open) {
            return self.leaf(place, &Verdict::NONE);
        }
        let is_demanded = self.control.demands.divides(place);
        let (mut has_rows, mut surely_fails) = (has_rows, surely_fails || is_demanded);
        if has_rows && !is_demanded && open == [false; 3] {
            match self.rows(ground, spot, place) {
                AtOnce::Decided(word) => return word,
                AtOnce::NotHere {
                    fails,
                    may_be_below,
                } => (surely_fails, has_rows) = (surely_fails | fails, may_be_below),
            }
        }
        if !surely_fails || place.level >= self.max_levels {
            let at = (spot, place.level, SubTriangle::Whole);
            let verdict = self.judge.regular(
                ground,
                at,
                &Cell(spot.corners()),
                &corners,
                open,
                &self.allowance,
            );
            if !verdict.fails() || place.level >= self.max_levels {
                return self.leaf(place, &verdict);
            }
        }
        let middles = ground.at([0, 1, 2].map(|edge| spot.along(edge, 0.5)));
        let children = [0, 1, 2, 3].map(|child| {
            let own = child_corners(corners, middles, child);
            let at = (place.child(child), has_rows);
            self.part(
                ground,
                spot.child(child),
                own,
                child_open(open, child),
                at,
                false,
            )
        });
        self.piece.node(children)
    }

    fn count_leaves(&mut self, count: usize) {
        self.leaves += count;
        if self.leaves >= COUNTED {
            self.tell();
            if (self.is_stopped)() {
                self.count.stop();
            }
        }
    }

    /// Whether there are too many leaves by now, so that nothing matters any more.
    fn is_too_much(&self) -> bool {
        self.leaves == 0 && self.count.is_passed()
    }

    fn leaf(&mut self, place: Place, verdict: &Verdict) -> u32 {
        self.extent.add(&Extent {
            worst: Some(place),
            ..verdict.extent
        });
        self.count_leaves(1);
        match verdict.outcome {
            Outcome::Passes => bounded(LEAF, verdict.extent.bound),
            Outcome::Fails => {
                self.has_failed = true;
                LEAF
            }
            Outcome::Depends {
                deviation,
                tilt,
                slopes,
            } => {
                self.conditions.push(Condition {
                    place,
                    deviation,
                    tilt,
                    slopes,
                });
                LEAF | CONDITIONAL
            }
        }
    }
}

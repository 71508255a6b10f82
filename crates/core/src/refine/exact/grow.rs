//! Grows the forest until the goals are met: rounds of evaluating what changed and splitting what fails.

use super::emit::Emission;
use super::evaluate::{ABOVE_WANTED, Evaluation, Found, WANTED};
use super::forest::{Changes, Forest};
use super::options::{ExactOptions, ExactProgress, ExactStop};
use super::probe::rounding;
use crate::certificate::Deviation;
use crate::criterion::{Criteria, Distance, LimitNormal, Pixels};
use crate::limit::SidedNormals;
use crate::mesh::{Mesh, Sharpness};
use crate::patch::{LimitPoint, Rules};
use crate::progress::Cancelled;
use crate::refine::RefineError;
use crate::refine::junctions::join_copies;
use crate::vector::{DVec3, unit_or_zero, vector};

/// Halvings of a net before a leaf is called too bad: the bound is within some per cent of the truth then.
const HALVINGS: usize = 2;

/// Halvings for the final bounds: within a per cent.
const MOST_HALVINGS: usize = 5;

/// Under a budget, a round splits what is worse than this part of the worst value: the nearer to 1, the closer to splitting one
/// by one.
const WORST_SHARE: f64 = 0.8;

/// The part of a budget kept for leaves whose bounds come out greater than expected among their neighbours.
const RESERVE: usize = 100;

/// The same with balancing, which shows only afterwards where triangles are still needed.
const BALANCING_RESERVE: usize = 5;

/// How far triangles may miss the goals before they are balanced: by half that much afterwards at best.
const UNBALANCED: f64 = 1.8;

/// What balancing leaves of the worst value at best.
const BALANCED: f64 = 0.4;

/// Rounds of balancing and splitting what it did not help.
const MOST_BALANCINGS: usize = 12;

/// Triangles that one split adds at most: three, and one at each neighbour.
const MOST_ADDED: usize = 6;

/// A position that is not known yet.
const UNKNOWN: LimitPoint = LimitPoint { position: DVec3::NAN, normal: DVec3::ZERO };

/// The state of a refinement.
pub(super) struct Growth<'a> {
    pub(super) control: &'a Mesh,
    pub(super) sharpness: Sharpness<'a>,
    /// What is sharp in the limit: without what fades.
    pub(super) lasting: Sharpness<'a>,
    /// Limit normals of the control vertices.
    pub(super) sided: SidedNormals,
    pub(super) rules: &'a Rules<'a>,
    pub(super) options: &'a ExactOptions<'a>,
    pub(super) criteria: Criteria,
    /// What rounding may do to a distance.
    pub(super) rounding: f64,
    pub(super) forest: Forest,
    /// Limits of the vertices.
    pub(super) points: Vec<LimitPoint>,
    /// How far each vertex is moved along its normal; empty where none is.
    pub(super) offsets: Vec<f64>,
    /// By node: the value as a leaf.
    pub(super) values: Vec<f64>,
    /// By node: the deviations as a leaf.
    pub(super) deviations: Vec<Deviation>,
    /// By node: what distances in any direction are multiplied by for the value at most.
    pub(super) scales: Vec<f64>,
    /// By node: whether a leaf's diagonal starts at the unsplit edge's end.
    pub(super) diagonals: Vec<bool>,
    /// By node: whether the value was not tightened, being below the target of its time.
    loose: Vec<bool>,
    marks: Vec<u8>,
    /// Leaves to be evaluated.
    wanted: Vec<u32>,
    /// Nodes that were evaluated since the bounds were last taken among neighbours.
    pub(super) unsettled: Vec<u32>,
    /// Nodes whose values may be too much, and by node whether it is among them.
    above: Vec<u32>,
    is_above: Vec<bool>,
    /// Triangles that must not be exceeded.
    budget: usize,
    halvings: usize,
    /// Whether the triangles stand as they are.
    is_emitted: bool,
    round: usize,
}

impl<'a> Growth<'a> {
    pub(super) fn new(
        control: &'a Mesh,
        rules: &'a Rules<'a>,
        options: &'a ExactOptions<'a>,
    ) -> Result<Self, RefineError> {
        let table = rules.table();
        let (mut positions, sided) = (table.positions(control)?, table.sided_normals(control)?);
        join_copies(&mut positions, &control.junctions().vertices);
        let points = positions.into_iter().zip(sided.by_vertex());
        let sharpness = Sharpness::of(control);
        let rounding = rounding(control, options.max_levels);
        let lasting = sharpness.lasting();
        let forest = Forest::new(control, &lasting);
        let nodes = forest.node_count();
        Ok(Self {
            control,
            sharpness,
            lasting,
            rules,
            options,
            criteria: criteria(control, options, rounding)?,
            rounding,
            forest,
            points: points
                .map(|(position, normal)| LimitPoint { position: vector(position), normal: vector(*normal) })
                .collect(),
            sided,
            offsets: Vec::new(),
            values: vec![f64::INFINITY; nodes],
            deviations: vec![Deviation::default(); nodes],
            diagonals: vec![false; nodes],
            loose: vec![false; nodes],
            marks: vec![0; nodes],
            wanted: (0..nodes as u32).collect(),
            unsettled: Vec::new(),
            above: Vec::new(),
            is_above: vec![false; nodes],
            scales: vec![0.0; nodes],
            budget: options.budget().0,
            halvings: HALVINGS,
            is_emitted: false,
            round: 0,
        })
    }

    /// Divides all control faces by so many levels.
    pub(super) fn split_all(&mut self, levels: usize) -> Result<(), RefineError> {
        for _ in 0..levels {
            let mut changes = Changes::default();
            for leaf in self.leaf_nodes().collect::<Vec<_>>() {
                self.forest.split(leaf, &mut changes)?;
            }
            self.grown(&changes);
        }
        // There may be no round left that would tell these leaves apart.
        if levels > 0 { self.evaluate(0.0) } else { Ok(()) }
    }

    /// Splits until the goals are met or nothing more is allowed.
    pub(super) fn run(&mut self) -> Result<(ExactStop, Emission), RefineError> {
        // Values above it fail; without a criterion all do.
        let floor = if self.criteria.is_some() { 1.0 } else { 0.0 };
        let full = self.budget;
        self.budget = full - full / if self.options.balance { BALANCING_RESERVE } else { RESERVE };
        // Balanced triangles may miss the surface by more than others before they are.
        let mut stop = self.grow(if self.options.balance { UNBALANCED * floor } else { floor })?;
        self.budget = full;
        let mut limit = if floor > 0.0 { floor } else { self.worst() };
        for round in 0.. {
            // With the neighbours as they are emitted, some bounds come out greater than was expected.
            if self.options.balance && round < MOST_BALANCINGS {
                let emission = Emission::of(self);
                self.balance(&emission);
                self.wanted = emission.leaves.order.clone();
                self.evaluate(if floor > 0.0 { floor } else { BALANCED * limit })?;
                limit = if floor > 0.0 { floor } else { limit.min(WORST_SHARE * self.worst()) };
            }
            let fails = self.settle(limit);
            if !fails && (round + 1 >= MOST_BALANCINGS || self.worst() <= limit || !self.options.balance) {
                break;
            }
            if let Some(reason) = self.split_worst(limit)? {
                return Ok((reason, Emission::of(self)));
            }
            if stop == ExactStop::Met {
                stop = self.grow(floor)?;
            } else {
                self.evaluate(limit)?;
            }
        }
        Ok((stop, Emission::of(self)))
    }

    /// Evaluates and splits until no leaf is known to fail.
    pub(super) fn grow(&mut self, floor: f64) -> Result<ExactStop, RefineError> {
        // With a budget the worst come first: the target falls from round to round.
        let mut target = if self.options.triangles.is_some() { f64::INFINITY } else { floor };
        loop {
            self.evaluate(target)?;
            let worst = self.worst();
            if worst <= floor {
                let met = self.above().all(|node| self.values[node as usize] <= floor);
                return Ok(if met { ExactStop::Met } else { ExactStop::LevelCap });
            }
            if target > floor {
                target = floor.max((WORST_SHARE * worst).min(target));
            }
            // Under a higher target they were not tightened.
            if self.want_loose(target) {
                continue;
            }
            if let Some(stop) = self.split_worst(target)? {
                return Ok(stop);
            }
        }
    }

    /// The greatest value of a leaf that may be split.
    fn worst(&self) -> f64 {
        let splittable = self.above().filter(|&node| self.forest.level(node) < self.options.max_levels);
        splittable.map(|node| self.values[node as usize]).fold(0.0, f64::max)
    }

    /// The greatest value of any leaf.
    pub(super) fn worst_value(&self) -> f64 {
        self.leaf_nodes().map(|node| self.values[node as usize]).fold(0.0, f64::max)
    }

    fn leaf_nodes(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.forest.node_count() as u32).filter(|&node| self.forest.children(node).is_none())
    }

    /// The leaves that may fail: all that do are among them.
    fn above(&self) -> impl Iterator<Item = u32> + '_ {
        self.above.iter().copied().filter(|&node| self.forest.children(node).is_none())
    }

    /// Sets the value of a leaf, and keeps it in mind if that may be too much.
    pub(super) fn set_value(&mut self, leaf: u32, value: f64) {
        self.values[leaf as usize] = value;
        let least = if self.criteria.is_some() { 1.0 } else { 0.0 };
        if value > least && !self.is_above[leaf as usize] {
            self.is_above[leaf as usize] = true;
            self.above.push(leaf);
        }
    }

    /// Wants the leaves above the target whose values are not tight; whether there are any.
    fn want_loose(&mut self, target: f64) -> bool {
        let above = |&node: &u32| self.loose[node as usize] && self.values[node as usize] > target;
        self.wanted = self.above().filter(above).collect();
        self.wanted.sort_unstable();
        !self.wanted.is_empty()
    }

    /// Splits the leaves above the target, worst first, as far as allowed. Says why if none could be.
    fn split_worst(&mut self, target: f64) -> Result<Option<ExactStop>, RefineError> {
        let (forest, values, is_above) = (&self.forest, &self.values, &mut self.is_above);
        let least = if self.criteria.is_some() { 1.0 } else { 0.0 };
        self.above.retain(|&node| {
            let stays = forest.children(node).is_none() && values[node as usize] > least;
            is_above[node as usize] = stays;
            stays
        });
        let mut failing: Vec<u32> =
            self.above().filter(|&node| self.values[node as usize] > target).collect();
        let value = |node: u32| self.values[node as usize];
        failing.sort_by(|&a, &b| value(b).total_cmp(&value(a)).then(a.cmp(&b)));
        let mut changes = Changes::default();
        let mut stop = ExactStop::LevelCap;
        for node in failing {
            if self.forest.children(node).is_some() || self.forest.level(node) >= self.options.max_levels {
                continue;
            }
            if !self.fits(node) {
                stop = self.options.budget().1;
                break;
            }
            self.forest.split(node, &mut changes)?;
        }
        self.grown(&changes);
        Ok(changes.split.is_empty().then_some(stop))
    }

    /// Whether splitting a leaf keeps the triangles within the budget.
    fn fits(&self, node: u32) -> bool {
        let room = self.budget.saturating_sub(self.forest.triangle_count());
        // Working out what a split needs takes time; mostly there is plenty of room.
        room >= MOST_ADDED * 64 || room >= MOST_ADDED * self.forest.needed(node).len()
    }

    /// Evaluates what is wanted, and reports the round.
    fn evaluate(&mut self, target: f64) -> Result<(), RefineError> {
        let roots = self.mark_wanted();
        let found = self.evaluation(target).run(&roots);
        self.check_rules()?;
        let worst = self.take(found, target);
        self.unsettled.extend_from_slice(&self.wanted);
        self.unmark_wanted();
        self.round += 1;
        let progress = ExactProgress { round: self.round, triangles: self.forest.triangle_count(), worst };
        match self.options.observer {
            Some(observer) if observer(&progress).is_break() => Err(Cancelled.into()),
            _ => Ok(()),
        }
    }

    /// Refuses to go on where the scheme had no limit.
    pub(super) fn check_rules(&self) -> Result<(), RefineError> {
        self.rules.failure().map_or(Ok(()), |why| Err(why.clone().into()))
    }

    pub(super) fn evaluation(&self, target: f64) -> Evaluation<'_> {
        Evaluation {
            control: self.control,
            sharpness: &self.sharpness,
            has_sides: !self.lasting.is_empty(),
            sided: &self.sided,
            rules: self.rules,
            forest: &self.forest,
            points: &self.points,
            offsets: &self.offsets,
            marks: &self.marks,
            criteria: &self.criteria,
            target,
            halvings: self.halvings,
            fixed: self.is_emitted.then_some(&self.diagonals[..]),
        }
    }

    /// Evaluates leaves again with bounds as tight as they get, down to a length.
    pub(super) fn tighten(&mut self, wanted: Vec<u32>, length: f64) -> Result<(), RefineError> {
        let scale = wanted.first().map_or(0.0, |&leaf| self.scales[leaf as usize]);
        self.wanted = wanted;
        (self.halvings, self.is_emitted) = (MOST_HALVINGS, true);
        self.evaluate(length * scale)
    }

    /// Keeps what an evaluation found; gives the greatest value.
    fn take(&mut self, found: Vec<Found>, target: f64) -> f64 {
        let mut worst = 0.0f64;
        let mut fresh = Vec::new();
        for block in found {
            for leaf in block.leaves {
                let node = leaf.node as usize;
                self.set_value(leaf.node, leaf.value);
                self.deviations[node] = leaf.deviation;
                self.scales[node] = leaf.scale;
                self.diagonals[node] = leaf.diagonal_from_end;
                self.loose[node] = leaf.value <= target;
                worst = worst.max(leaf.value);
            }
            for (vertex, point) in block.points {
                let known = &mut self.points[vertex as usize];
                if known.position.is_nan() {
                    *known = point;
                } else {
                    // The other side's, which differs at creases.
                    known.normal += point.normal;
                    fresh.push(vertex);
                }
            }
        }
        for vertex in fresh {
            let normal = &mut self.points[vertex as usize].normal;
            *normal = unit_or_zero(*normal);
        }
        worst
    }

    /// Marks the wanted leaves and all above them; gives the control faces that have any.
    fn mark_wanted(&mut self) -> Vec<u32> {
        let mut roots: Vec<u32> = Vec::new();
        for &leaf in &self.wanted {
            self.marks[leaf as usize] |= WANTED;
            let mut node = leaf;
            let reached_root = loop {
                let Some((parent, _)) = self.forest.parent(node) else { break true };
                if self.marks[parent as usize] & ABOVE_WANTED != 0 {
                    break false;
                }
                self.marks[parent as usize] |= ABOVE_WANTED;
                node = parent;
            };
            if reached_root {
                roots.push(node);
            }
        }
        roots.sort_unstable();
        roots
    }

    fn unmark_wanted(&mut self) {
        for leaf in core::mem::take(&mut self.wanted) {
            self.marks[leaf as usize] = 0;
            let mut node = leaf;
            while let Some((parent, _)) = self.forest.parent(node) {
                if self.marks[parent as usize] == 0 {
                    break;
                }
                self.marks[parent as usize] = 0;
                node = parent;
            }
        }
    }

    /// Makes room for new nodes and vertices and says what must be looked at again.
    fn grown(&mut self, changes: &Changes) {
        let nodes = self.forest.node_count();
        self.values.resize(nodes, f64::INFINITY);
        self.deviations.resize(nodes, Deviation::default());
        self.scales.resize(nodes, 0.0);
        self.diagonals.resize(nodes, false);
        self.loose.resize(nodes, false);
        self.is_above.resize(nodes, false);
        self.marks.resize(nodes, 0);
        self.points.resize(self.forest.vertex_count(), UNKNOWN);
        if !self.offsets.is_empty() {
            self.offsets.resize(self.forest.vertex_count(), 0.0);
        }
        for &node in &changes.split {
            if let Some(first) = self.forest.children(node) {
                self.wanted.extend(first..first + 4);
            }
        }
        self.wanted.extend(changes.touched.iter().copied());
        let forest = &self.forest;
        self.wanted.retain(|&node| forest.children(node).is_none());
        self.wanted.sort_unstable();
        self.wanted.dedup();
    }
}

/// What the options ask for.
fn criteria(control: &Mesh, options: &ExactOptions<'_>, rounding: f64) -> Result<Criteria, RefineError> {
    let distance = options.tolerance.map(|tolerance| Distance::new(tolerance, rounding));
    let cone = options.angle.map(|angle| LimitNormal { view: options.view, ..LimitNormal::new(angle) });
    let is_closed = control.topology().boundary_edge_count() == 0;
    let pixels = options.pixels.map(|limit| Pixels::new(limit, &options.cameras, is_closed)).transpose()?;
    Ok(Criteria::new(distance, cone, pixels, rounding)?)
}

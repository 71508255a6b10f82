//! Grows the forest until the goals are met: rounds of evaluating what changed and splitting what fails.

use super::demand::Demand;
use super::emit::Emission;
use super::evaluate::{ABOVE_WANTED, Evaluation, WANTED};
use super::forest::{Changes, Forest};
use super::options::{ExactOptions, ExactProgress, ExactStop};
use crate::limit::LimitTable;
use crate::mesh::Mesh;
use crate::refine::RefineError;
use crate::scheme::Scheme;
use crate::surface::{Deviation, LimitPoint, Rules};
use crate::vector::{DVec3, vector};

/// Halvings of a net before a leaf is called too bad: the bound is within some per cent of the truth then.
const HALVINGS: usize = 2;

/// A position that is not known yet.
const UNKNOWN: LimitPoint = LimitPoint { position: DVec3::NAN, normal: DVec3::ZERO };

/// The state of a refinement.
pub(super) struct Growth<'a> {
    pub(super) control: &'a Mesh,
    pub(super) rules: &'a Rules<'a>,
    pub(super) options: &'a ExactOptions<'a>,
    pub(super) demand: Demand,
    pub(super) forest: Forest,
    /// Limits of the vertices.
    pub(super) points: Vec<LimitPoint>,
    /// By node: the value as a leaf.
    pub(super) values: Vec<f64>,
    /// By node: the deviations as a leaf.
    pub(super) deviations: Vec<Deviation>,
    /// By node: whether a leaf's diagonal starts at the unsplit edge's end.
    pub(super) diagonals: Vec<bool>,
    marks: Vec<u8>,
    /// Leaves to be evaluated.
    wanted: Vec<u32>,
    round: usize,
}

impl<'a> Growth<'a> {
    pub(super) fn new(
        control: &'a Mesh,
        scheme: &dyn Scheme,
        rules: &'a Rules<'a>,
        options: &'a ExactOptions<'a>,
    ) -> Result<Self, RefineError> {
        let table = LimitTable::new(scheme);
        let (positions, normals) = (table.positions(control)?, table.normals(control)?);
        let points = positions.into_iter().zip(normals);
        let forest = Forest::new(control);
        let nodes = forest.node_count();
        Ok(Self {
            control,
            rules,
            options,
            demand: Demand { tolerance: options.tolerance, angle: options.angle },
            forest,
            points: points
                .map(|(position, normal)| LimitPoint { position: vector(position), normal: vector(normal) })
                .collect(),
            values: vec![f64::INFINITY; nodes],
            deviations: vec![Deviation::default(); nodes],
            diagonals: vec![false; nodes],
            marks: vec![0; nodes],
            wanted: (0..nodes as u32).collect(),
            round: 0,
        })
    }

    /// Splits until the goals are met or nothing more is allowed.
    pub(super) fn run(&mut self) -> Result<(ExactStop, Emission), RefineError> {
        let has_demand = self.demand.tolerance.is_some() || self.demand.angle.is_some();
        let mut target = if has_demand { 1.0 } else { 0.0 };
        loop {
            let stop = self.grow(&mut target)?;
            // With the neighbours as they are emitted, some bounds come out greater than was expected.
            let emission = Emission::of(self);
            self.settle(&emission);
            let failing = self.failing(target);
            if stop != ExactStop::Met || failing.is_empty() {
                return Ok((stop, emission));
            }
            if !self.split_worst(failing)? {
                return Ok((ExactStop::LevelCap, emission));
            }
        }
    }

    /// Evaluates and splits until no leaf is known to fail.
    fn grow(&mut self, target: &mut f64) -> Result<ExactStop, RefineError> {
        loop {
            let worst = self.evaluate(*target);
            self.round += 1;
            let progress =
                ExactProgress { round: self.round, triangles: self.forest.triangle_count(), worst };
            if self.options.observer.is_some_and(|observer| observer(&progress).is_break()) {
                return Err(RefineError::Cancelled { steps: self.round });
            }
            let failing = self.failing(*target);
            if failing.is_empty() {
                return Ok(ExactStop::Met);
            }
            if !self.split_worst(failing)? {
                return Ok(ExactStop::LevelCap);
            }
        }
    }

    /// Splits the leaves that fail, as far as allowed; whether any was.
    fn split_worst(&mut self, failing: Vec<(u32, f64)>) -> Result<bool, RefineError> {
        let mut changes = Changes::default();
        for (node, _) in failing {
            if self.forest.children(node).is_none() && self.forest.level(node) < self.options.max_levels {
                self.forest.split(node, &mut changes)?;
            }
        }
        self.grown(&changes);
        Ok(!changes.split.is_empty())
    }

    /// The leaves above the target, worst first.
    fn failing(&self, target: f64) -> Vec<(u32, f64)> {
        let mut failing: Vec<(u32, f64)> = (0..self.forest.node_count() as u32)
            .filter(|&node| self.forest.children(node).is_none() && self.values[node as usize] > target)
            .map(|node| (node, self.values[node as usize]))
            .collect();
        failing.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        failing
    }

    /// Evaluates what is wanted; gives the greatest value found.
    fn evaluate(&mut self, target: f64) -> f64 {
        let mut roots: Vec<u32> = Vec::new();
        for &leaf in &self.wanted {
            self.marks[leaf as usize] |= WANTED;
            let mut node = leaf;
            while let Some((parent, _)) = self.forest.parent(node) {
                if self.marks[parent as usize] & ABOVE_WANTED != 0 {
                    break;
                }
                self.marks[parent as usize] |= ABOVE_WANTED;
                node = parent;
            }
            if (node as usize) < self.forest.roots() {
                roots.push(node);
            }
        }
        roots.sort_unstable();
        roots.dedup();
        let evaluation = Evaluation {
            control: self.control,
            rules: self.rules,
            forest: &self.forest,
            points: &self.points,
            marks: &self.marks,
            demand: &self.demand,
            target,
            halvings: HALVINGS,
        };
        let found = evaluation.run(&roots);
        let mut worst = 0.0f64;
        for block in found {
            for leaf in block.leaves {
                self.values[leaf.node as usize] = leaf.value;
                self.deviations[leaf.node as usize] = leaf.deviation;
                self.diagonals[leaf.node as usize] = leaf.diagonal_from_end;
                worst = worst.max(leaf.value);
            }
            for (vertex, point) in block.points {
                let known = &mut self.points[vertex as usize];
                if known.position.is_nan() {
                    *known = point;
                }
            }
        }
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
        worst
    }

    /// Makes room for new nodes and vertices and says what must be looked at again.
    fn grown(&mut self, changes: &Changes) {
        let nodes = self.forest.node_count();
        self.values.resize(nodes, f64::INFINITY);
        self.deviations.resize(nodes, Deviation::default());
        self.diagonals.resize(nodes, false);
        self.marks.resize(nodes, 0);
        self.points.resize(self.forest.vertex_count(), UNKNOWN);
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

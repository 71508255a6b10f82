//! The least set of divided nodes, brought from one demand to the next.
//!
//! A node *wants* to be divided if it fails. Let S be the least set of nodes such that
//!
//! 1. a control face that wants is in S, and a child of a node in S that wants is, too;
//! 2. where a node of S shares an edge with a node of its level, that one's parent is in S.
//!
//! S exists: the intersection of sets that keep both rules keeps them. A front divides just the
//! nodes of S (the first rule says where, the second that neighbouring leaves are at most one level
//! apart), so it depends on the demand alone. And the more nodes want, the greater is S.
//!
//! **From one demand to the next.** A node that no longer wants may have been the reason of others,
//! and two nodes may be each other's reason though neither is wanted. So a node that loses a reason
//! is first *overdeleted*, with all nodes of which it may be a reason: its children in S, and the
//! parents beyond its edges that do not want on their own account. Then nodes with a reason that is
//! not overdeleted are *rederived*, and the nodes of which they are a reason, until nothing
//! changes: each node in S has a chain of reasons from control faces that want, so it is rederived
//! in the end. The others are merged, from the finest level up ([`loosen`]). (Gupta, Mumick,
//! Subrahmanian, "Maintaining views incrementally", 1993, call this deletion and rederivation.)
//! Then nodes that newly want join as they would in a fresh forest ([`extend`]). The work is
//! proportional to the nodes that change and their neighbours.
//!
//! To be divided, a node needs those of its level beyond its edges; where one is missing, the node above it is divided first. That is rule 2
//! for the parents of both.

use smallvec::SmallVec;

use super::forest::{Forest, NONE};
use super::halt::Halt;

/// The callbacks while nodes are divided.
pub(super) trait Watch {
    /// Answers whether a new node wants.
    fn arrived(&mut self, forest: &Forest<'_>, node: u32) -> bool;

    /// Whether to go on dividing, asked after each division.
    fn goes_on(&mut self, forest: &Forest<'_>) -> bool;
}

/// The outcome of a change of demands.
#[derive(Clone, Debug, Default)]
pub(super) struct Outcome {
    pub(super) divided: usize,
    pub(super) merged: usize,
    /// Nodes that want and were not divided since the watch stopped it.
    pub(super) waiting: Vec<u32>,
    /// Nodes that are to be merged and were not since the observer asked to stop.
    pub(super) leaving: Vec<u32>,
}

/// Removes the nodes that are no longer in the set: `lost` no longer want. Nodes that would join
/// stay waiting; nodes not merged when the observer asks to stop stay leaving.
pub(super) fn loosen(forest: &mut Forest<'_>, lost: Vec<u32>, halt: &mut Halt<'_>) -> Outcome {
    let suspects = suspected(forest, lost);
    let mut settling = Settling {
        forest,
        watch: None,
        work: Vec::new(),
        outcome: Outcome::default(),
    };
    for &node in &suspects {
        if settling.forest.node(node).is_suspect && settling.has_reason(node) {
            settling.rederive(node);
        }
    }
    settling.run();
    let Settling { mut outcome, .. } = settling;
    let mut overdeleted: Vec<u32> = suspects
        .into_iter()
        .filter(|&node| forest.node(node).is_suspect)
        .collect();
    overdeleted
        .sort_unstable_by_key(|&node| (core::cmp::Reverse(forest.node(node).place.level), node));
    for node in overdeleted {
        forest.node_mut(node).is_suspect = false;
        if halt.goes_on(forest.triangles) {
            forest.merge(node);
            outcome.merged += 1;
        } else {
            outcome.leaving.push(node);
        }
    }
    outcome
}

/// Adds to the set the nodes that are in it now: `gained` want. Where the watch stops it, the set
/// is that of a demand between, and the missing nodes wait.
pub(super) fn extend(forest: &mut Forest<'_>, gained: &[u32], watch: &mut dyn Watch) -> Outcome {
    let mut settling = Settling {
        forest,
        watch: Some(watch),
        work: Vec::new(),
        outcome: Outcome::default(),
    };
    for &node in gained {
        if settling.is_reachable(node) {
            settling.join(node);
            settling.run();
        }
    }
    settling.outcome
}

/// The divided nodes whose reasons may be gone.
fn suspected(forest: &mut Forest<'_>, lost: Vec<u32>) -> Vec<u32> {
    let (mut stack, mut suspects) = (lost, Vec::new());
    while let Some(node) = stack.pop() {
        if forest.node(node).is_suspect || !forest.is_divided(node) {
            continue;
        }
        forest.node_mut(node).is_suspect = true;
        suspects.push(node);
        let first = forest.node(node).children;
        stack.extend(first..first + 4);
        for edge in 0..3 {
            for (other, _) in forest.adjacent(node, edge) {
                let above = forest.node(other).parent;
                if above != NONE && above != forest.node(node).parent && !forest.wants(above) {
                    stack.push(above);
                }
            }
        }
    }
    suspects
}

struct Settling<'f, 'a, 'w> {
    forest: &'f mut Forest<'a>,
    /// The callbacks; without them, nothing is divided.
    watch: Option<&'w mut dyn Watch>,
    /// Nodes of S whose consequences have not been drawn.
    work: Vec<u32>,
    outcome: Outcome,
}

impl Settling<'_, '_, '_> {
    /// Whether a node is known to be in S.
    fn is_in(&self, node: u32) -> bool {
        self.forest.is_divided(node) && !self.forest.node(node).is_suspect
    }

    /// Whether it is a control face or a child of a node of S.
    fn is_reachable(&self, node: u32) -> bool {
        let parent = self.forest.node(node).parent;
        parent == NONE || self.is_in(parent)
    }

    /// Whether a rule says that a suspect is in S.
    fn has_reason(&self, node: u32) -> bool {
        if self.forest.wants(node) && self.is_reachable(node) {
            return true;
        }
        let first = self.forest.node(node).children;
        (0..3u8).any(|child| {
            let outer = [child, (child + 2) % 3];
            outer.into_iter().any(|edge| {
                let adjacent = self.forest.adjacent(first + u32::from(child), edge);
                adjacent.iter().any(|&(other, _)| self.is_in(other))
            })
        })
    }

    fn rederive(&mut self, node: u32) {
        self.forest.node_mut(node).is_suspect = false;
        self.work.push(node);
    }

    /// A node that a rule says is in S.
    fn join(&mut self, node: u32) {
        if !self.forest.is_divided(node) {
            self.divide(node);
        } else if self.forest.node(node).is_suspect {
            self.rederive(node);
        }
    }

    /// Divides a node, after those that must be before it.
    fn divide(&mut self, node: u32) {
        let Some(watch) = &mut self.watch else {
            return self.outcome.waiting.push(node);
        };
        let mut way = SmallVec::<[u32; 8]>::from_slice(&[node]);
        while let Some(&next) = way.last() {
            if self.forest.is_divided(next) {
                way.pop();
            } else if let Some(missing) = self.forest.missing(next) {
                way.push(missing);
            } else {
                way.pop();
                self.forest.divide(next);
                self.outcome.divided += 1;
                self.work.push(next);
                let first = self.forest.node(next).children;
                for child in first..first + 4 {
                    let wants = watch.arrived(self.forest, child);
                    self.forest.extents[child as usize].wants = wants;
                }
            }
        }
        if !watch.goes_on(self.forest) {
            self.watch = None;
        }
    }

    fn run(&mut self) {
        while let Some(node) = self.work.pop() {
            let first = self.forest.node(node).children;
            for child in first..first + 4 {
                if self.forest.wants(child) {
                    self.join(child);
                }
            }
            for edge in 0..3 {
                for (other, _) in self.forest.adjacent(node, edge) {
                    let above = self.forest.node(other).parent;
                    if above != NONE && self.forest.node(above).is_suspect {
                        self.rederive(above);
                    }
                }
            }
        }
    }
}

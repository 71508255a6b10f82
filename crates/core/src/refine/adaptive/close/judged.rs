//! What closing a control face came to: its counts, and what was said of the leaves that had to be judged, for the next time.

use super::super::judge::{Condition, Extent, Outcome, Verdict};
use super::super::quadtree::{Place, Trees};
use crate::certificate::Deviation;

/// What the closing of a control face came to.
#[derive(Clone, Debug, Default)]
pub(in super::super) struct Closed {
    /// Vertices inside the face.
    pub(in super::super) vertices: u32,
    /// Triangles.
    pub(in super::super) triangles: u32,
    /// Leaves.
    pub(super) leaves: usize,
    /// What is known of leaves that were judged; most faces have none.
    pub(in super::super) judged: Option<Box<JudgedLeaves>>,
}

/// What a face comes to in numbers.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Counts {
    pub(super) vertices: u32,
    pub(super) triangles: u32,
    pub(super) leaves: usize,
}

/// What the leaves that had to be judged come to.
#[derive(Clone, Debug, Default)]
pub(in super::super) struct JudgedLeaves {
    /// For each leaf with two split edges, in the order of the walk, whether its diagonal starts at the unsplit edge's end.
    diagonals: Vec<bool>,
    /// What was judged here.
    extent: Extent,
    /// Leaves that pass on conditions, in the order of the walk.
    pub(in super::super) conditions: Vec<Condition>,
    /// What was said of leaves, by the edges that were split, for the next time; in the order of places, which that of a walk is not where
    /// nodes are walked over row by row.
    pub(super) leaves: Vec<Judged>,
}

/// A leaf with split edges, or one that was made for its neighbours' sake.
#[derive(Clone, Debug)]
pub(super) struct Judged {
    pub(super) place: Place,
    /// The edges that are split.
    pub(super) split: [bool; 3],
    /// The edges beyond which there is nobody.
    pub(super) open: [bool; 3],
    pub(super) is_strict: bool,
    /// Whether its diagonal starts at the unsplit edge's end.
    from_end: bool,
    /// What it comes to.
    extent: Extent,
    said: Said,
}

/// What was said of a leaf; few pass on conditions.
#[derive(Clone, Debug)]
enum Said {
    Nothing,
    Passes,
    Fails,
    Depends(Box<(Deviation, f64, [f64; 3])>),
}

impl Judged {
    /// A leaf of which nothing was said.
    pub(super) fn new(place: Place, split: [bool; 3], open: [bool; 3], is_strict: bool) -> Self {
        Self {
            place,
            split,
            open,
            is_strict,
            from_end: false,
            extent: Extent::NONE,
            said: Said::Nothing,
        }
    }

    /// How many of its edges are split.
    pub(super) fn split_edges(&self) -> usize {
        self.split.iter().filter(|&&is_split| is_split).count()
    }

    pub(super) fn is_said(&self) -> bool {
        !matches!(self.said, Said::Nothing)
    }

    /// Whether its triangles fail; where conditions are not enough these do.
    pub(super) fn fails(&self, max_levels: u32) -> bool {
        match self.said {
            Said::Nothing | Said::Passes => false,
            Said::Fails => true,
            Said::Depends(_) => self.is_strict && self.place.level < max_levels,
        }
    }

    /// Keeps a verdict, and whether the diagonal starts at the unsplit edge's end.
    pub(super) fn say(&mut self, (verdict, from_end): (Verdict, bool)) {
        (self.extent, self.from_end) = (verdict.extent, from_end);
        self.said = match verdict.outcome {
            Outcome::Passes => Said::Passes,
            Outcome::Fails => Said::Fails,
            Outcome::Depends {
                deviation,
                tilt,
                slopes,
            } => Said::Depends(Box::new((deviation, tilt, slopes))),
        };
    }

    /// Takes over what was said of the same leaf, if the same edges were split.
    pub(super) fn recall(&mut self, known: &Self) {
        if known.split == self.split {
            (self.from_end, self.extent, self.said) =
                (known.from_end, known.extent, known.said.clone());
        }
    }
}

/// Takes over what was said of the same leaves with the same edges split; both are in the order of places.
pub(super) fn recall(known: &[Judged], leaves: &mut [Judged]) {
    let mut known = known.iter().peekable();
    for leaf in leaves {
        while known
            .next_if(|other| other.place.precedes(leaf.place))
            .is_some()
        {}
        if let Some(other) = known.next_if(|other| other.place == leaf.place) {
            leaf.recall(other);
        }
    }
}

impl Closed {
    /// What a face comes to with these leaves, in the order of places.
    pub(super) fn of(counts: Counts, leaves: Vec<Judged>, trees: &Trees, max_levels: u32) -> Self {
        let Counts {
            vertices,
            triangles,
            leaves: count,
        } = counts;
        let is_none = leaves.is_empty();
        let judged = (!is_none).then(|| Box::new(JudgedLeaves::of(leaves, trees, max_levels)));
        Self {
            vertices,
            triangles,
            leaves: count,
            judged,
        }
    }

    /// What was said of leaves.
    pub(super) fn known(&self) -> &[Judged] {
        self.judged.as_ref().map_or(&[], |judged| &judged.leaves)
    }

    /// Forgets what is known of the tree and its leaves: it was replaced.
    pub(in super::super) fn forget(&mut self) {
        self.leaves = 0;
        self.judged
            .iter_mut()
            .for_each(|judged| judged.leaves = Vec::new());
    }

    /// The same, but for leaves that are within a value whatever their neighbours are.
    pub(in super::super) fn forget_beyond(&mut self, limit: f64) {
        self.leaves = 0;
        let is_within =
            |leaf: &Judged| matches!(leaf.said, Said::Passes) && leaf.extent.bound <= limit;
        self.judged
            .iter_mut()
            .for_each(|judged| judged.leaves.retain(is_within));
    }

    /// For each leaf with two split edges, in the order of the walk, whether its diagonal starts at the unsplit edge's end.
    pub(in super::super) fn diagonals(&self) -> &[bool] {
        self.judged.as_ref().map_or(&[], |judged| &judged.diagonals)
    }

    /// What was judged here.
    pub(in super::super) fn extent(&self) -> Option<&Extent> {
        self.judged.as_ref().map(|judged| &judged.extent)
    }

    /// Leaves that pass on conditions, in the order of the walk.
    pub(in super::super) fn conditions(&self) -> &[Condition] {
        self.judged
            .as_ref()
            .map_or(&[], |judged| &judged.conditions)
    }

    /// The same face with other numbers.
    pub(in super::super) fn count(&mut self, counts: Counts) {
        Counts {
            vertices: self.vertices,
            triangles: self.triangles,
            leaves: self.leaves,
        } = counts;
    }

    /// Whether triangles and conditions are the same if the vertices along the edges are: in between leaves were only divided.
    pub(in super::super) fn is_as(&self, other: &Self) -> bool {
        self.leaves == other.leaves && self.is_judged_as(other)
    }

    /// The same if there are as many leaves.
    pub(in super::super) fn is_judged_as(&self, other: &Self) -> bool {
        self.diagonals() == other.diagonals() && self.conditions() == other.conditions()
    }
}

/// The leaves in the order of a walk, which goes over nodes below which all leaves are equally deep row by row.
pub(super) fn in_walks_order<'l>(leaves: &'l [Judged], trees: &Trees) -> Vec<&'l Judged> {
    let mut ordered: Vec<&Judged> = leaves.iter().collect();
    let mut rest = &mut ordered[..];
    while let [first, ..] = rest {
        let node = trees.even_node(first.place);
        let count = rest
            .iter()
            .take_while(|leaf| node.holds(leaf.place))
            .count();
        let (own, others) = core::mem::take(&mut rest).split_at_mut(count);
        own.sort_by_key(|leaf| leaf.place.row_below(node.level));
        rest = others;
    }
    ordered
}

impl JudgedLeaves {
    /// What was said of leaves, which are in the order of places.
    fn of(leaves: Vec<Judged>, trees: &Trees, max_levels: u32) -> Self {
        let mut judged = Self::default();
        for leaf in in_walks_order(&leaves, trees) {
            let place = leaf.place;
            if leaf.is_said() && leaf.split_edges() == 2 {
                judged.diagonals.push(leaf.from_end);
            }
            let bound = if leaf.is_said() {
                leaf.extent.bound
            } else {
                f64::INFINITY
            };
            judged.extent.add(&Extent {
                bound,
                worst: Some(place),
                ..leaf.extent
            });
            match &leaf.said {
                // What nobody has judged is beyond every bound.
                Said::Nothing | Said::Passes | Said::Fails => {}
                Said::Depends(_) if leaf.fails(max_levels) => {}
                Said::Depends(on) => {
                    let (deviation, tilt, slopes) = **on;
                    judged.conditions.push(Condition {
                        place,
                        deviation,
                        tilt,
                        slopes,
                    });
                }
            }
        }
        judged.leaves = leaves;
        judged
    }
}

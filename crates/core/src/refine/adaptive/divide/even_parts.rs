//! Even parts of regular pieces: all nodes of a level are tested at once, and single ones only where that leaves something open.

use super::super::quadtree::{LEAF, NodeAddress, PROVEN};
use super::super::seen::{Extent, Fate};
use super::super::surface::QuarticPiece;
use super::{Divider, Part};
use crate::certificate::{MOST_DIVISIONS, Mark, Marks, RowBlock, RowExtent};
use crate::patch::ParamTriangle;

/// Levels tested at most.
pub(super) const MOST_TESTED: usize = 3;

/// The outcome of testing all nodes of some levels below a node at once.
pub(super) enum AtOnce {
    /// The node is divided so.
    Decided(u32),
    /// It is not worth while, and whether it may be below; a node that certainly fails need not be judged.
    NotHere { fails: bool, may_be_below: bool },
}

/// A node whose rows were tested.
struct Rows<'a> {
    quartic: &'a QuarticPiece,
    place: NodeAddress,
    domain: ParamTriangle,
    /// By level from `first` below the node on.
    marks: &'a [Marks],
    first: u32,
}

impl Divider<'_> {
    /// Divides a part of a regular piece by testing all nodes of some levels at once, where that is worth while.
    pub(super) fn rows(
        &mut self,
        quartic: &QuarticPiece,
        domain: ParamTriangle,
        place: NodeAddress,
    ) -> AtOnce {
        let target = self.judge.row_target();
        let block = RowBlock::of(
            &quartic.piece,
            quartic.jet(),
            [domain.u, domain.v],
            domain.size,
        );
        let (least, most) = block.levels(&target);
        let fails = least > 0;
        if !fails {
            return AtOnce::NotHere {
                fails,
                may_be_below: most > 1,
            };
        }
        let last = most.min(least + MOST_TESTED as u32 - 1);
        if least > MOST_DIVISIONS || most > last || !block.is_fine(least, target.distance) {
            return AtOnce::NotHere {
                fails,
                may_be_below: true,
            };
        }
        // The node itself may do with middles of its edges.
        let is_deepest = place.level >= self.max_levels;
        if least == 1
            && !is_deepest
            && let Some(word) = self.asking(quartic, domain)
        {
            return AtOnce::Decided(word);
        }
        let last = last.min(MOST_DIVISIONS);
        if place.level + last > self.max_levels {
            return AtOnce::NotHere {
                fails,
                may_be_below: false,
            };
        }
        let mut levels = core::mem::take(&mut self.marks);
        let mut extent = RowExtent::NONE;
        let mut tested = 0;
        for divisions in least..=last {
            let marks = &mut levels[tested];
            self.cell_rows.get_or_insert_default().test(
                &block,
                divisions,
                &target,
                &mut extent,
                marks,
            );
            tested += 1;
            if marks.are_all_passing() {
                break;
            }
        }
        let RowExtent {
            normal_deviation,
            slope,
            displacement_slope,
            bound,
        } = extent;
        self.extent.add(&Extent {
            normal_deviation,
            slope,
            displacement_slope,
            bound,
        });
        let is_even = tested == 1 && levels[0].are_all_passing();
        let word = if is_even && !self.judge.asking.may_be {
            self.count_leaves(1 << (2 * least));
            (LEAF | PROVEN) + least
        } else {
            let found = Rows {
                quartic,
                place,
                domain,
                marks: &levels[..tested],
                first: least,
            };
            self.row_node(&found, 0, 0, false, 0)
        };
        self.marks = levels;
        AtOnce::Decided(word)
    }

    /// The word of a node that asks for the middles of its edges; `None` if it is divided.
    fn asking(&mut self, quartic: &QuarticPiece, domain: ParamTriangle) -> Option<u32> {
        if !self.judge.asking.may_be {
            return None;
        }
        let [a, b, c] = domain.corners();
        let middles = [0, 1, 2].map(|edge| domain.along(edge, 0.5));
        let [a, b, c, d, e, f] = quartic.at([a, b, c, middles[0], middles[1], middles[2]]);
        let edges = self.judge.asked(&[a, b, c], &[d, e, f], [false; 3])?;
        Some(self.asking_leaf(edges))
    }

    /// A node `level` levels below the one whose rows were tested.
    fn row_node(
        &mut self,
        rows: &Rows<'_>,
        i: usize,
        j: usize,
        is_inverted: bool,
        level: u32,
    ) -> u32 {
        if level >= rows.first {
            let tested = (level - rows.first) as usize;
            let mark = rows.marks[tested].at(i, j, is_inverted);
            if mark == Mark::Passes {
                self.count_leaves(1);
                return LEAF | PROVEN;
            }
            let is_last = tested + 1 == rows.marks.len();
            if is_last || mark == Mark::Open {
                let quartic = rows.quartic;
                let domain = rows.domain.row(level, i, j, is_inverted);
                let place = rows.place.leaf(level, (i, j), is_inverted);
                let (corners, open) = (quartic.at(domain.corners()), [false; 3]);
                if is_last {
                    return self.part(
                        Part {
                            quartic,
                            domain,
                            place,
                            corners,
                            open,
                            has_rows: false,
                        },
                        false,
                    );
                }
                let verdict = self
                    .judge
                    .regular(quartic, domain, place.level, &corners, open);
                if verdict.fate != Fate::Fails {
                    return self.leaf(&verdict);
                }
            }
        }
        // A node whose children are small enough may do with middles of its edges.
        if level > 0 && level + 1 >= rows.first {
            let domain = rows.domain.row(level, i, j, is_inverted);
            if let Some(word) = self.asking(rows.quartic, domain) {
                return word;
            }
        }
        let (x, y) = (2 * i, 2 * j);
        let below = if is_inverted {
            [
                (x + 1, y + 1, true),
                (x, y + 1, true),
                (x + 1, y, true),
                (x + 1, y + 1, false),
            ]
        } else {
            [
                (x, y, false),
                (x + 1, y, false),
                (x, y + 1, false),
                (x, y, true),
            ]
        };
        let mut children = [LEAF; 4];
        for (word, (i, j, is_inverted)) in children.iter_mut().zip(below) {
            *word = self.row_node(rows, i, j, is_inverted, level + 1);
        }
        self.piece.node(children)
    }
}

//! Faces divided for less than they were divided for before: what was tested then and is within less stays as it is, and what failed need
//! not be tested again.

use super::super::judge::{Extent, Goal};
use super::super::quadtree::{LEAF, Place, Trees, bound_of, even_depth, is_split, is_unjudged};
use super::super::surface::Ground;
use super::{Decider, Found, child_open};
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::{LimitPoint, Patch, Spot, child_corners};

/// What is divided again: the trees, and the goal that they were made for.
#[derive(Clone, Copy)]
pub(super) struct Before<'a> {
    pub(super) trees: &'a Trees,
    pub(super) goal: &'a Goal,
}

impl Before<'_> {
    /// Whether a node was split, and not for its neighbours' sake alone.
    fn is_divided(&self, word: u32) -> bool {
        is_split(word)
            && (even_depth(word).is_some()
                || (0..4).any(|child| !is_unjudged(self.trees.child(word, child))))
    }

    /// Whether all leaves below a node are known to be within a value.
    fn is_within(&self, word: u32, limit: f64) -> bool {
        match even_depth(word) {
            Some(_) => bound_of(word).is_some_and(|bound| bound <= limit),
            None => (0..4).all(|child| self.is_within(self.trees.child(word, child), limit)),
        }
    }
}

impl Decider<'_> {
    /// Divides a face further than it was divided, or from the beginning where it was for much more.
    pub(super) fn again(&mut self, face: u32, before: Before<'_>, found: &Found) -> Found {
        if !self.goal.is_near(before.goal, face) {
            return self.face(face, None);
        }
        self.begin(face);
        // What was let pass counts on that still, and of what replaces it nothing is tilted more.
        self.allowance = found.allowance;
        self.extent = Extent {
            bound: 0.0,
            worst: None,
            ..found.extent(face)
        };
        let word = before.trees.root(face);
        let (open, place) = (self.control.open(face), Place::root(face));
        let word = if before.is_within(word, self.judge.limit) {
            self.kept(before.trees, word, place)
        } else {
            let patch = self.control.patch(face);
            self.node_again(
                (before, word),
                &patch,
                self.control.corners(face),
                open,
                place,
            )
        };
        self.piece.roots.push(word);
        self.end(face)
    }

    /// A node all of whose leaves stay.
    fn kept(&mut self, trees: &Trees, word: u32, place: Place) -> u32 {
        if let Some(depth) = even_depth(word) {
            let bound = bound_of(word).unwrap_or(f64::INFINITY);
            self.extent.add(&Extent {
                bound,
                worst: Some(place.leaf(depth, (0, 0), false)),
                ..Extent::NONE
            });
            self.count_leaves(1 << (2 * depth));
            return word;
        }
        let children = [0, 1, 2, 3]
            .map(|child| self.kept(trees, trees.child(word, child), place.child(child)));
        self.piece.irregular_node(children)
    }

    fn node_again(
        &mut self,
        (before, word): (Before<'_>, u32),
        patch: &Patch,
        corners: [LimitPoint; 3],
        open: [bool; 3],
        place: Place,
    ) -> u32 {
        if !before.is_divided(word) {
            return self.node(patch, corners, open, place);
        }
        if let Patch::Regular(points) = patch {
            let ground = Ground::of(&BezierTriangle::of(points));
            return self.part_again((before, word), &ground, Spot::WHOLE, corners, open, place);
        }
        if self.is_too_much() || (self.is_stopped)() {
            return LEAF;
        }
        let refined = patch.refined(self.control.rules);
        let middles = [0, 1, 2].map(|edge| refined.middle(edge));
        let mut children = [LEAF; 4];
        for (child, own) in children.iter_mut().enumerate() {
            let (word, at) = (before.trees.child(word, child), place.child(child));
            *own = if before.is_within(word, self.judge.limit) {
                self.kept(before.trees, word, at)
            } else {
                let corners = child_corners(corners, middles, child);
                self.node_again(
                    (before, word),
                    &refined.part(child),
                    corners,
                    child_open(open, child),
                    at,
                )
            };
        }
        self.piece.irregular_node(children)
    }

    fn part_again(
        &mut self,
        (before, word): (Before<'_>, u32),
        ground: &Ground,
        spot: Spot,
        corners: [LimitPoint; 3],
        open: [bool; 3],
        place: Place,
    ) -> u32 {
        if self.is_too_much() {
            return LEAF;
        }
        // Where all are equally deep, and some are not good enough, most will not be.
        if even_depth(word).is_some() || !before.is_divided(word) {
            return self.part(
                ground,
                spot,
                corners,
                open,
                (place, self.judge.has_rows()),
                false,
            );
        }
        let middles = ground.at([0, 1, 2].map(|edge| spot.along(edge, 0.5)));
        let mut children = [LEAF; 4];
        for (child, own) in children.iter_mut().enumerate() {
            let (word, at) = (before.trees.child(word, child), place.child(child));
            *own = if before.is_within(word, self.judge.limit) {
                self.kept(before.trees, word, at)
            } else {
                let corners = child_corners(corners, middles, child);
                self.part_again(
                    (before, word),
                    ground,
                    spot.child(child),
                    corners,
                    child_open(open, child),
                    at,
                )
            };
        }
        self.piece.node(children)
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::control::Control;
    use super::super::super::demands::Demands;
    use super::super::super::with_engine;
    use super::*;
    use crate::certificate::TriangleFrame;
    use crate::models::stirred;
    use crate::progress::unobserved;
    use crate::refine::ExactOptions;
    use crate::scheme::Loop;

    /// Levels below a leaf whose corners are looked at.
    const SAMPLED: u32 = 3;

    struct Sampling<'a> {
        control: &'a Control<'a>,
        trees: &'a Trees,
        limit: f64,
        leaves: usize,
        samples: usize,
    }

    impl Sampling<'_> {
        /// Looks at the leaves below a node.
        fn node(&mut self, word: u32, patch: &Patch, corners: [LimitPoint; 3]) {
            if !is_split(word) {
                if let Some(bound) = bound_of(word) {
                    self.leaves += 1;
                    assert!(bound <= self.limit * 1.001, "{bound} {}", self.limit);
                    let frame = TriangleFrame::new(corners.map(|corner| corner.position));
                    self.below(patch, corners, (&frame, bound), SAMPLED);
                }
                return;
            }
            self.children(patch, corners, |sampling, child, patch, corners| {
                sampling.node(sampling.trees.child(word, child), patch, corners);
            });
        }

        /// The corners below a node are no higher over its triangle than its bound.
        fn below(
            &mut self,
            patch: &Patch,
            corners: [LimitPoint; 3],
            (frame, bound): (&TriangleFrame, f64),
            levels: u32,
        ) {
            for corner in corners {
                let height = frame.height(corner.position).abs();
                assert!(height <= bound * (1.0 + 1e-9) + 1e-13, "{height} {bound}");
                self.samples += 1;
            }
            if levels > 0 {
                self.children(patch, corners, |sampling, _, patch, corners| {
                    sampling.below(patch, corners, (frame, bound), levels - 1);
                });
            }
        }

        fn children(
            &mut self,
            patch: &Patch,
            corners: [LimitPoint; 3],
            mut run: impl FnMut(&mut Self, usize, &Patch, [LimitPoint; 3]),
        ) {
            let refined = patch.refined(self.control.rules);
            let middles = [0, 1, 2].map(|edge| refined.middle(edge));
            (0..4).for_each(|child| {
                run(
                    self,
                    child,
                    &refined.part(child),
                    child_corners(corners, middles, child),
                )
            });
        }
    }

    /// What stays is as near as its word says, and that is near enough.
    #[test]
    fn leaves_that_stay_are_within_their_bounds() {
        let (mut leaves, mut samples) = (0, 0);
        for (name, seed) in [
            ("torus", 0),
            ("cup", 3),
            ("head", 0),
            ("icosphere", 5),
            ("spike", 4),
            ("sheet", 8),
        ] {
            let mesh = stirred(name, seed);
            let options = (&ExactOptions::default().triangles(1), &Demands::default());
            with_engine(&mesh, &Loop, options, &mut unobserved, |engine| {
                let mut distance = 4e-3 * mesh.diagonal();
                let mut plan = engine.plan(Goal::Within(distance), usize::MAX)?.unwrap();
                for _ in 0..3 {
                    distance *= 0.8;
                    let all: Vec<u32> = (0..plan.closed.len() as u32).collect();
                    plan = engine
                        .finer(&plan, Goal::Within(distance), &all, usize::MAX)?
                        .unwrap();
                    assert!(engine.settle(&mut plan, usize::MAX)?);
                    let (control, trees) = (engine.control, &plan.decision.trees);
                    let mut sampling = Sampling {
                        control,
                        trees,
                        limit: distance,
                        leaves: 0,
                        samples: 0,
                    };
                    for face in all {
                        let (patch, corners) = (control.patch(face), control.corners(face));
                        sampling.node(trees.root(face), &patch, corners);
                    }
                    leaves += sampling.leaves;
                    samples += sampling.samples;
                }
                Ok(())
            })
            .unwrap();
        }
        assert!(
            leaves > 10_000 && samples > 100 * leaves,
            "{leaves}, {samples}"
        );
    }
}

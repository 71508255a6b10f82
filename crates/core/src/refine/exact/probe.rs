//! The certified interval for the whole mesh.

use super::blocks::Blocks;
use super::emit::Emission;
use super::grow::Growth;
use super::leaf::leaf_triangles;
use super::options::ErrorBounds;
use crate::certificate::{Deviation, TriangleFrame};
use crate::index::VertexId;
use crate::mesh::Mesh;
use crate::parallel;
use crate::refine::RefineError;
use crate::vector::DVec3;

/// Leaves with the greatest bounds that are looked at for a lower bound.
const PROBED: usize = 256;

/// Samples whose distance to the whole mesh is measured.
const MEASURED: usize = 160;

/// Leaves whose samples are measured where nothing is certain.
const MOST_MEASURED: usize = 2_000;

/// Leaves that are evaluated again for a tighter upper bound.
const MOST_TIGHTENED: usize = 20_000;

/// Levels below a leaf whose vertices are sampled: the greatest distance is met within some per cent.
const SAMPLED_LEVELS: usize = 3;

/// Bounds below this part of the greatest tell nothing about the mesh.
const TELLING: f64 = 0.8;

/// Leaves that one call takes together.
const BLOCK: usize = 1024;

/// Levels below which edges have no length left.
const MOST_LEVELS: usize = 64;

/// A lower bound beyond this part of the upper one is good enough.
const NARROW: f64 = 0.99;

impl Growth<'_> {
    /// The certified interval.
    pub(super) fn probe(&mut self, emission: &Emission) -> Result<ErrorBounds, RefineError> {
        let blocks = Blocks::of(self, emission);
        let mut bounds = self.bounds(emission);
        let mut best = self.sampled(emission, &blocks, &bounds);
        // Bounds below the goals were not tightened while the mesh grew.
        let slack = bounds.partition_point(|&(bound, _)| bound > NARROW * best.lower);
        if best.lower > 0.0 && slack > 0 && slack <= MOST_TIGHTENED {
            let mut wanted: Vec<u32> = bounds[..slack].iter().map(|&(_, leaf)| leaf).collect();
            wanted.sort_unstable();
            let before: Vec<Deviation> = wanted.iter().map(|&leaf| self.deviations[leaf as usize]).collect();
            let known: Vec<f64> = wanted.iter().map(|&leaf| self.settled(leaf)).collect();
            self.tighten(wanted.clone(), best.lower)?;
            // Smaller pieces show steeper drifts, which may cost more than they gain.
            for ((&leaf, deviation), known) in wanted.iter().zip(before).zip(known) {
                if self.settled(leaf) > known {
                    self.deviations[leaf as usize] = deviation;
                }
            }
            bounds = self.bounds(emission);
        }
        let upper = if best.certified {
            bounds.first().map_or(0.0, |worst| worst.0)
        } else {
            self.measured(emission, &blocks, &bounds, &mut best)
        };
        best.upper = upper + self.rounding;
        best.lower = (best.lower - self.rounding).max(0.0);
        Ok(best)
    }

    /// The bounds of the leaves that matter, the greatest first: those of others are less than [`TELLING`] times as
    /// much.
    fn bounds(&self, emission: &Emission) -> Vec<(f64, u32)> {
        let leaves = &emission.leaves.order;
        let least = |leaf: u32| {
            let deviation = self.deviations[leaf as usize];
            deviation.own.min(deviation.height)
        };
        // Estimates need not be met by anything.
        let telling = if self.rules.is_certified() { TELLING } else { 0.0 };
        let enough = telling * leaves.iter().map(|&leaf| least(leaf)).fold(0.0, f64::max);
        let found = parallel::pieces_of(leaves.len(), BLOCK, |block| {
            let telling = |&leaf: &u32| self.deviations[leaf as usize].own > enough;
            let leaves = leaves[block].iter().copied().filter(telling);
            leaves.map(|leaf| (self.settled(leaf), leaf)).collect::<Vec<_>>()
        });
        let mut bounds: Vec<(f64, u32)> =
            found.into_iter().flatten().filter(|&(bound, _)| bound >= enough).collect();
        bounds.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        bounds
    }

    /// The greatest distance found from samples over the leaves that promise most.
    fn sampled(&self, emission: &Emission, blocks: &Blocks, bounds: &[(f64, u32)]) -> ErrorBounds {
        let upper = bounds.first().map_or(0.0, |worst| worst.0);
        // Bounds may be large for lack of room to drift; heights tell the truth about the rest.
        let mut worst: Vec<u32> = bounds.iter().take(PROBED).map(|&(_, leaf)| leaf).collect();
        let height = |leaf: u32| self.deviations[leaf as usize].height;
        let mut by_height = emission.leaves.order.clone();
        let probed = PROBED.min(by_height.len());
        if probed < by_height.len() {
            by_height
                .select_nth_unstable_by(probed, |&a, &b| height(b).total_cmp(&height(a)).then(a.cmp(&b)));
        }
        worst.extend(&by_height[..probed]);
        worst.sort_unstable();
        worst.dedup();
        let mut best = ErrorBounds { lower: 0.0, upper, at: [0.0; 3], certified: self.rules.is_certified() };
        for (_, point) in self.samples(&worst).into_iter().take(MEASURED) {
            if best.lower > NARROW * upper {
                break;
            }
            let distance = blocks.distance(self, emission, point);
            if distance > best.lower {
                (best.lower, best.at) = (distance, point.to_array());
            }
        }
        best
    }

    /// Where bounds are estimates: the greatest distance of samples over all leaves that may be worse than what was found;
    /// after many of them the next estimate.
    fn measured(
        &self,
        emission: &Emission,
        blocks: &Blocks,
        bounds: &[(f64, u32)],
        best: &mut ErrorBounds,
    ) -> f64 {
        let evaluation = self.evaluation(0.0);
        for (count, &(bound, leaf)) in bounds.iter().enumerate() {
            if bound <= best.lower || count >= MOST_MEASURED {
                return bound.max(best.lower);
            }
            let frames = self.frames(leaf);
            for point in evaluation.samples(leaf, SAMPLED_LEVELS) {
                let own = frames.iter().map(|frame| frame.squared(point)).fold(f64::INFINITY, f64::min);
                if own > best.lower * best.lower {
                    let distance = blocks.distance(self, emission, point);
                    if distance > best.lower {
                        (best.lower, best.at) = (distance, point.to_array());
                    }
                }
            }
        }
        best.lower
    }

    /// The triangles of a leaf.
    fn frames(&self, leaf: u32) -> Vec<TriangleFrame> {
        let corners = self.forest.corners(leaf).map(|vertex| self.emitted(vertex));
        let middles = [0, 1, 2].map(|edge| self.forest.middle(leaf, edge).map(|vertex| self.emitted(vertex)));
        leaf_triangles(corners, middles, self.diagonals[leaf as usize])
            .map(|triangle| TriangleFrame::new(triangle.corners))
            .collect()
    }

    /// Points of the surface over leaves, one for each, those highest over their triangles first.
    fn samples(&self, leaves: &[u32]) -> Vec<(f64, DVec3)> {
        let evaluation = self.evaluation(0.0);
        let mut samples: Vec<(f64, DVec3)> = Vec::new();
        for &leaf in leaves {
            let frames = self.frames(leaf);
            // Sideways the neighbours take over: the height over the nearest triangle tells more than the distance.
            let promise = |point: DVec3| {
                let nearest = frames.iter().min_by(|a, b| a.squared(point).total_cmp(&b.squared(point)));
                nearest.map_or(0.0, |frame| frame.height(point).abs())
            };
            let points = evaluation.samples(leaf, SAMPLED_LEVELS).into_iter();
            samples.extend(points.map(|point| (promise(point), point)).max_by(|a, b| a.0.total_cmp(&b.0)));
        }
        samples.sort_by(|a, b| b.0.total_cmp(&a.0));
        samples
    }
}

/// What rounding can have done to a distance: positions are convex combinations of convex combinations, one for
/// each level, and each adds a few units in the last place of the coordinates' size; those of a control vertex add one for
/// each neighbour. Points near an edge of a triangle count as on it ([`TriangleFrame::on_edge`]), on either side.
pub(super) fn rounding(control: &Mesh, max_levels: usize) -> f64 {
    let size = control.positions().as_flattened().iter().fold(0.0f64, |size, x| size.max(x.abs()));
    let topology = control.topology();
    let valence = |v: u32| topology.valence_and_openness(VertexId(v)).0;
    let most = (0..control.vertex_count() as u32).map(valence).max().unwrap_or(0);
    let units = 32.0 + 8.0 * max_levels.min(MOST_LEVELS) as f64 + f64::from(most);
    (units * f64::EPSILON + 4.0 * TriangleFrame::ROUNDING) * size
}

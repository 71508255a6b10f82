//! Distances of single points to the emitted mesh, without a search tree: the triangles of each control face stand
//! together, in a box of their own.

use super::emit::Emission;
use super::grow::Growth;
use crate::geometry::closest_to_origin;
use crate::vector::DVec3;

/// The boxes of the control faces' triangles.
pub(super) struct Blocks {
    /// First triangle, one past the last, least and greatest coordinates.
    blocks: Vec<(usize, usize, DVec3, DVec3)>,
}

impl Blocks {
    pub(super) fn of(growth: &Growth<'_>, emission: &Emission) -> Self {
        let at = |vertex: u32| growth.emitted(vertex);
        let leaves = &emission.leaves;
        let mut blocks: Vec<(usize, usize, DVec3, DVec3)> = Vec::with_capacity(growth.forest.roots());
        let mut last = None;
        for (&leaf, &root) in leaves.order.iter().zip(&leaves.roots) {
            let start = leaves.starts[leaf as usize] as usize;
            if last != Some(root) {
                blocks.push((start, start, DVec3::INFINITY, DVec3::NEG_INFINITY));
                last = Some(root);
            }
            let Some(block) = blocks.last_mut() else { continue };
            block.1 = start + 1 + growth.forest.split_edges(leaf).count_ones() as usize;
            for vertex in emission.triangles[start..block.1].as_flattened() {
                (block.2, block.3) = (block.2.min(at(*vertex)), block.3.max(at(*vertex)));
            }
        }
        Self { blocks }
    }

    /// The distance of a point to the mesh.
    pub(super) fn distance(&self, growth: &Growth<'_>, emission: &Emission, point: DVec3) -> f64 {
        let gap = |low: DVec3, high: DVec3| (low - point).max(point - high).max(DVec3::ZERO).length_squared();
        let mut near: Vec<(f64, usize)> =
            self.blocks.iter().enumerate().map(|(i, block)| (gap(block.2, block.3), i)).collect();
        near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut least = f64::INFINITY;
        for (gap, block) in near {
            if gap > least {
                break;
            }
            let (start, end, ..) = self.blocks[block];
            for triangle in &emission.triangles[start..end] {
                let [a, b, c] = triangle.map(|vertex| growth.emitted(vertex) - point);
                least = least.min(closest_to_origin(a, b, c).squared);
            }
        }
        least.sqrt()
    }
}

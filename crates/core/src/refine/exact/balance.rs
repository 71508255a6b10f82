//! Moves the vertices off the limit surface by half of what the triangles miss, so that the error lies on both sides.
//!
//! Triangles with their corners on a convex surface lie inside it by up to e; with the corners moved out by e/2 both
//! sides have e/2 (mathematically: the midpoint of the heights' range is moved to 0). Where a surface bends both ways, and on
//! boundaries and sharp edges, vertices stay.

use super::emit::Emission;
use super::evaluate::Evaluation;
use super::grow::Growth;
use super::leaf::leaf_triangles;
use crate::certificate::TriangleFrame;
use crate::parallel;
use crate::vector::DVec3;

/// Levels below a leaf whose vertices are sampled.
const SAMPLED_LEVELS: usize = 2;

/// Leaves that one call takes together.
const BLOCK: usize = 256;

impl Growth<'_> {
    /// Sets the offsets of all vertices along their normals, from the heights of the surface over the triangles that
    /// have their corners on it.
    pub(super) fn balance(&mut self, emission: &Emission) {
        let count = self.forest.vertex_count();
        let leaves = &emission.leaves.order;
        let evaluation = self.evaluation(0.0);
        let bulges = parallel::pieces_of(leaves.len(), BLOCK, |block| {
            let mut found = Vec::new();
            leaves[block].iter().for_each(|&leaf| self.bulges(&evaluation, leaf, &mut found));
            found
        });
        let mut sums = vec![(0.0f64, 0u32); count];
        for (vertices, bulge) in bulges.into_iter().flatten() {
            for vertex in vertices {
                let sum = &mut sums[vertex as usize];
                *sum = (sum.0 + bulge, sum.1 + 1);
            }
        }
        self.offsets = sums.into_iter().map(|(sum, faces)| sum / f64::from(faces.max(1))).collect();
        for &leaf in leaves {
            let corners = self.forest.corners(leaf);
            let open = self.forest.open_edges(leaf);
            for edge in (0..3).filter(|&edge| open[edge]) {
                self.offsets[corners[edge] as usize] = 0.0;
                self.offsets[corners[(edge + 1) % 3] as usize] = 0.0;
            }
        }
        // Corners and darts inside a face's reach.
        for vertex in self.lasting.tagged_vertices() {
            self.offsets[vertex.index()] = 0.0;
        }
    }

    /// The triangles of a leaf with the middle of the heights of the surface over each.
    fn bulges(&self, evaluation: &Evaluation<'_>, leaf: u32, found: &mut Vec<([u32; 3], f64)>) {
        let samples = evaluation.samples(leaf, SAMPLED_LEVELS);
        let middles = [0, 1, 2].map(|edge| self.forest.middle(leaf, edge));
        for triangle in leaf_triangles(self.forest.corners(leaf), middles, self.diagonals[leaf as usize]) {
            let at = |vertex: u32| self.points[vertex as usize].position;
            let frame = TriangleFrame::new(triangle.corners.map(at));
            let (mut low, mut high) = (0.0f64, 0.0f64);
            for &sample in
                samples.iter().filter(|&&sample| (0..3).all(|edge| frame.beside(edge, sample).outside <= 0.0))
            {
                let height = frame.height(sample);
                (low, high) = (low.min(height), high.max(height));
            }
            found.push((triangle.corners, 0.5 * (low + high)));
        }
    }

    /// Where a vertex is emitted: its limit, moved along its normal.
    #[inline]
    pub(super) fn emitted(&self, vertex: u32) -> DVec3 {
        let point = self.points[vertex as usize];
        match self.offsets.get(vertex as usize) {
            Some(&offset) if offset != 0.0 => point.position + offset * point.normal,
            _ => point.position,
        }
    }
}

//! Limit normals at sharp edges, one for each side.
//!
//! The normals of vertices are shared by all triangles around; where a crease or a corner of one passes, each side has
//! its own. The patches of a side know it: walks down to the leaves at sharp vertices and takes it from there.

use super::emit::Emission;
use super::grow::Growth;
use crate::index::{FaceId, HalfEdgeId};
use crate::parallel;
use crate::patch::large_rings::LargeRings;
use crate::patch::{Patch, root_patch};
use crate::vector::{DVec3, vector};

/// Leaves that one call takes together.
const BLOCK: usize = 64;

impl Growth<'_> {
    /// The normals of the corners of emitted triangles at vertices on sharp edges, by the half-edge that leaves the corner,
    /// ascending.
    pub(super) fn sides(&self, emission: &Emission) -> Vec<(u32, [f64; 3])> {
        if self.lasting.is_empty() {
            return Vec::new();
        }
        let mut is_sharp = vec![false; self.forest.vertex_count()];
        self.lasting.tagged_vertices().for_each(|vertex| is_sharp[vertex.index()] = true);
        for crease in &self.tags(emission).creases {
            crease.vertices.iter().for_each(|&vertex| is_sharp[vertex as usize] = true);
        }
        let is_wanted = |leaf: u32| {
            let middles = (0..3).filter_map(|edge| self.forest.middle(leaf, edge));
            self.forest.corners(leaf).into_iter().chain(middles).any(|vertex| is_sharp[vertex as usize])
        };
        let mut above = vec![false; self.forest.node_count()];
        for &leaf in emission.leaves.order.iter().filter(|&&leaf| is_wanted(leaf)) {
            let mut node = Some(leaf);
            while let Some(at) = node.filter(|&at| !above[at as usize]) {
                above[at as usize] = true;
                node = self.forest.parent(at).map(|(parent, _)| parent);
            }
        }
        let walk = Walk { growth: self, emission, is_sharp, above };
        let roots = self.forest.roots();
        let found = parallel::pieces_of(roots, BLOCK, |block| {
            let mut found = Vec::new();
            for root in block.filter(|&root| walk.above[root]) {
                let face = FaceId(root as u32);
                let patch =
                    root_patch(self.control, &self.sharpness, &LargeRings::default(), face, self.rules);
                let normal = |corner| self.sided.at(self.control.topology(), HalfEdgeId::of(face, corner));
                walk.visit(root as u32, &patch, [0, 1, 2].map(|corner| vector(normal(corner))), &mut found);
            }
            found
        });
        let mut sides = found.concat();
        sides.sort_unstable_by_key(|&(h, _)| h);
        sides
    }
}

struct Walk<'a> {
    growth: &'a Growth<'a>,
    emission: &'a Emission,
    is_sharp: Vec<bool>,
    /// By node, whether a leaf at a sharp vertex is below it.
    above: Vec<bool>,
}

impl Walk<'_> {
    fn visit(&self, node: u32, patch: &Patch, normals: [DVec3; 3], found: &mut Vec<(u32, [f64; 3])>) {
        let refined = patch.refined(self.growth.rules);
        let middles = [0, 1, 2].map(|edge| refined.middle(edge).normal);
        let Some(first) = self.growth.forest.children(node) else {
            self.leaf(node, [normals, middles].as_flattened(), found);
            return;
        };
        for part in (0..4).filter(|part| self.above[first as usize + part]) {
            let mut own = [middles[1], middles[2], middles[0]];
            if part < 3 {
                own[part] = normals[part];
                own[(part + 1) % 3] = middles[part];
                own[(part + 2) % 3] = middles[(part + 2) % 3];
            }
            self.visit(first + part as u32, &refined.part(part), own, found);
        }
    }

    /// The corners of a leaf's triangles, given the normals at its corners and the middles of its edges.
    fn leaf(&self, leaf: u32, normals: &[DVec3], found: &mut Vec<(u32, [f64; 3])>) {
        let start = self.emission.leaves.starts[leaf as usize];
        for (place, triangle) in (start..).zip(self.growth.pattern(leaf).triangles()) {
            for (corner, &label) in (0..).zip(triangle) {
                let vertex = self.emission.triangles[place as usize][corner as usize];
                if self.is_sharp[vertex as usize] {
                    found.push((3 * place + corner, normals[label as usize].to_array()));
                }
            }
        }
    }
}

//! Splits that count for the result, and the splits that they need: both parents of a node, and all
//! sides of a sharp edge together.

use super::{Forest, Side, edge_of, node_of, side};
use crate::geometry::NONE;

/// A triangle of the result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::sqrt3) enum Triangle {
    /// A node that is not split.
    Leaf(u32),
    /// The third of a split node at a half-edge with a node across it that is not split: two ends and the apex.
    Third(Side),
}

/// The most triangles that there may be are there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sqrt3) struct Full;

impl Forest<'_> {
    /// Number of triangles of the result.
    pub(in crate::sqrt3) fn triangle_count(&self) -> usize {
        self.triangles
    }

    /// The level of the node that is split where a triangle is divided: its own, or that across its old edge.
    pub(in crate::sqrt3) fn level(&self, triangle: Triangle) -> u8 {
        match triangle {
            Triangle::Leaf(node) => self.nodes[node as usize].level,
            Triangle::Third(own) => self.node(own).level,
        }
    }

    /// All control faces, as triangles.
    pub(in crate::sqrt3) fn roots(&self) -> impl Iterator<Item = Triangle> + use<> {
        (0..self.control.face_count() as u32).map(Triangle::Leaf)
    }

    /// The triangles that arose since the last query.
    pub(in crate::sqrt3) fn take_fresh(&mut self) -> Vec<Triangle> {
        core::mem::take(&mut self.fresh)
    }

    /// Whether a triangle is still one of the result.
    pub(in crate::sqrt3) fn is_there(&self, triangle: Triangle) -> bool {
        match triangle {
            Triangle::Leaf(node) => !self.nodes[node as usize].is_split,
            Triangle::Third(own) => !self
                .across(own)
                .is_some_and(|other| self.node(other).is_split),
        }
    }

    /// Divides a triangle: splits its node, or the one across its old edge.
    ///
    /// # Errors
    /// There would be too many triangles. The splits done by then are a valid result.
    pub(in crate::sqrt3) fn divide(&mut self, triangle: Triangle) -> Result<(), Full> {
        match triangle {
            Triangle::Leaf(node) => self.split(node as usize),
            Triangle::Third(own) => match self.require(own) {
                Some(other) => self.split(node_of(other)),
                None => Ok(()),
            },
        }
    }

    /// Splits a node, and before it the nodes that this needs.
    fn split(&mut self, t: usize) -> Result<(), Full> {
        if self.nodes[t].is_split {
            return Ok(());
        }
        self.split_parents(t)?;
        let (rim, sides) = self.cut_together(t);
        // Levels fall, so this ends.
        for &other in &sides {
            self.split_parents(other)?;
        }
        let new: Vec<usize> = sides
            .into_iter()
            .filter(|&other| !self.nodes[other].is_split)
            .collect();
        // Each split gives three triangles for one, or two more where adjacent thirds become nodes.
        if self.triangles + 2 * new.len() > self.max_triangles {
            return Err(Full);
        }
        for other in new {
            self.split_one(other);
        }
        if let Some(rim) = rim {
            self.rims.rims[rim as usize].is_cut = true;
        }
        Ok(())
    }

    /// Makes a node one of the result.
    fn split_parents(&mut self, t: usize) -> Result<(), Full> {
        let parent = self.nodes[t].parent;
        if parent == NONE {
            return Ok(());
        }
        let other = self.across(parent);
        self.split(node_of(parent))?;
        other.map_or(Ok(()), |other| self.split(node_of(other)))
    }

    /// The sharp edge that is cut with a node, and all nodes that are cut with it, the node among them.
    fn cut_together(&mut self, t: usize) -> (Option<u32>, Vec<usize>) {
        let cut = self.nodes[t]
            .cut_edge()
            .and_then(|edge| self.rim_of.get(&side(t, edge)).copied());
        let Some((rim, own)) = cut else {
            return (None, vec![t]);
        };
        let sides = self.rims.rims[rim as usize].ends.len() as u32;
        let others = (0..sides).filter(|&number| number != own);
        let others: Vec<usize> = others
            .filter_map(|number| self.odd_owner(rim, number))
            .map(node_of)
            .collect();
        (Some(rim), core::iter::once(t).chain(others).collect())
    }

    fn split_one(&mut self, t: usize) {
        self.grow(t);
        self.nodes[t].is_split = true;
        self.triangles += 2;
        for edge in 0..3 {
            let own = side(t, edge);
            let children = match self.across(own) {
                Some(other) if self.node(other).is_split => [self.child(own), self.child(other)],
                _ if self.nodes[t].is_sharp(edge) => [self.child(own), None],
                _ => {
                    self.fresh.push(Triangle::Third(own));
                    continue;
                }
            };
            self.fresh.extend(
                children
                    .into_iter()
                    .flatten()
                    .map(|child| Triangle::Leaf(child as u32)),
            );
        }
    }

    /// The corners of a triangle.
    pub(in crate::sqrt3) fn corners(&self, triangle: Triangle) -> [u32; 3] {
        match triangle {
            Triangle::Leaf(node) => self.nodes[node as usize].corners,
            Triangle::Third(own) => {
                let [a, b] = self.ends(own);
                [self.node(own).apex(edge_of(own)), a, b]
            }
        }
    }
}

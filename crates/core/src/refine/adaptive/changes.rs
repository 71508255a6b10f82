//! Which triangles may come to something else than when they were looked at last.
//!
//! What a triangle comes to depends on its part of the surface, on its corners and on those of the triangles beside it. In control
//! faces that were not touched since, triangles and vertices are the same, but for where vertices on their edges were moved.

use super::chains::Chains;
use super::emit::Emission;
use super::quadtree::Edges;
use crate::mesh::NONE;
use crate::progress::{Cancelled, SharedWatch};

/// How far the vertices of an emission were moved.
pub(super) struct Moves {
    offsets: Vec<f64>,
    /// By half-edge, the number of the first vertex of its own.
    on_edges: Vec<u32>,
}

impl Moves {
    /// Of an emission that is going to be replaced.
    pub(super) fn of(emission: &mut Emission, chains: &Chains) -> Self {
        let half_edges = 0..3 * (emission.starts.len() as u32 - 1);
        let offsets = core::mem::take(&mut emission.offsets);
        Self { offsets, on_edges: half_edges.map(|h| chains.own(h).0).collect() }
    }
}

/// What has changed.
pub(super) struct Changes {
    /// By control face, whether its triangles are others.
    is_touched: Vec<bool>,
    /// By vertex on control edges, whether it was moved in another way; those within one control face are moved with its triangles.
    is_moved: Vec<bool>,
}

impl Changes {
    /// Since vertices were moved like that, with the control faces that were touched in the meantime; all faces, if there is nothing
    /// before.
    pub(super) fn since(
        before: Option<&Moves>,
        is_touched: Vec<bool>,
        emission: &Emission,
        (edges, chains): (&Edges<'_>, &Chains),
        watch: &SharedWatch<'_>,
    ) -> Result<Self, Cancelled> {
        let Some(before) = before.filter(|before| !before.offsets.is_empty()) else {
            return Ok(Self { is_touched, is_moved: Vec::new() });
        };
        let first = chains.own(0).0 as usize;
        let mut is_moved = vec![false; first + chains.count()];
        let offset = |vertex: usize| emission.offsets[vertex];
        watch.each(0..first, |vertex| is_moved[vertex] = before.offsets[vertex] != offset(vertex))?;
        watch.each((0..).zip(&before.on_edges), |(h, &was)| {
            let is_touched = |h: u32| is_touched[h as usize / 3];
            // Otherwise there are as many as before, and all the triangles that they belong to are others anyway.
            if !is_touched(h) || edges.twin(h).is_some_and(|twin| !is_touched(twin)) {
                let (now, places) = chains.own(h);
                for i in 0..places.len() {
                    let now = now as usize + i;
                    is_moved[now] = before.offsets[was as usize + i] != offset(now);
                }
            }
        })?;
        Ok(Self { is_touched, is_moved })
    }

    /// Whether all triangles of a control face are others.
    pub(super) fn is_touched(&self, face: u32) -> bool {
        self.is_touched[face as usize]
    }

    /// Whether a triangle may come to something else.
    pub(super) fn concern(&self, emission: &Emission, triangle: u32) -> bool {
        let meet = |triangle: u32| {
            let triangle = triangle as usize;
            let corners = emission.triangles[triangle];
            self.is_touched(emission.parents[triangle]) || corners.iter().any(|&vertex| self.is_moved(vertex))
        };
        let twins = &emission.twins[3 * triangle as usize..3 * triangle as usize + 3];
        meet(triangle) || twins.iter().any(|&twin| twin != NONE && meet(twin / 3))
    }

    /// The control faces some of whose triangles may.
    pub(super) fn faces(
        &self,
        emission: &Emission,
        edges: &Edges<'_>,
        watch: &SharedWatch<'_>,
    ) -> Result<Vec<u32>, Cancelled> {
        let count = self.is_touched.len() as u32;
        // What has not changed itself and only meets others that have not, has no such triangles.
        let mut has_changed = vec![false; count as usize];
        watch.each(0..count, |face| {
            let is_moved = |&h: &u32| self.is_moved(emission.triangles[h as usize / 3][h as usize % 3]);
            let mut half_edges = 3 * face..3 * face + 3;
            has_changed[face as usize] =
                self.is_touched(face) || half_edges.any(|h| emission.borders.along(h).iter().any(is_moved));
        })?;
        let mut faces = Vec::new();
        watch.each(0..count, |face| {
            let mut beyond = (3 * face..3 * face + 3).filter_map(|h| edges.twin(h)).map(|twin| twin / 3);
            let may_be = has_changed[face as usize] || beyond.any(|face| has_changed[face as usize]);
            let mut triangles = emission.triangles_of(face);
            if self.is_touched(face)
                || may_be && triangles.any(|triangle| self.concern(emission, triangle as u32))
            {
                faces.push(face);
            }
        })?;
        Ok(faces)
    }

    fn is_moved(&self, vertex: u32) -> bool {
        self.is_moved.get(vertex as usize).is_some_and(|&moved| moved)
    }
}

#[cfg(test)]
mod tests;

//! Where a refined mesh came from on its control mesh.

use limitmesh::refine::Origin;

/// The origins of vertices and triangles; empty where nobody asked.
#[derive(Default)]
pub(super) struct Trail {
    /// By vertex.
    pub(super) origins: Vec<Origin>,
    /// The control face of each triangle, of several one.
    pub(super) parents: Vec<u32>,
    /// After collapses, where triangles reach over several control faces: of corners on edges with two sides, ascending.
    pub(super) sides: Option<Vec<(u32, Origin)>>,
}

impl Trail {
    /// Where a triangle's corner at a vertex came from, on its triangle's side of edges.
    pub(super) fn corner(
        &self,
        triangle: usize,
        corner: usize,
        vertex: u32,
        control: &[[u32; 3]],
    ) -> Option<Origin> {
        let origin = self.origins[vertex as usize];
        let Some(sides) = &self.sides else {
            return origin.in_face(control, self.parents[triangle]);
        };
        let at = (3 * triangle + corner) as u32;
        let own = sides.binary_search_by_key(&at, |&(corner, _)| corner);
        Some(own.map_or(origin, |at| sides[at].1))
    }
}

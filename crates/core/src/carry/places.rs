//! Where the corners of refined triangles are in their own control faces.
//!
//! A vertex knows one face that it came from; a triangle that has it may be in another beside that one.

use super::Key;
use crate::geometry::NONE;
use crate::index::HalfEdgeId;
use crate::mesh::{Channel, ChannelError, Mesh};
use crate::refine::{Origin, Traced};

/// A refined mesh's places on its control mesh.
pub(super) struct Places<'a> {
    control: &'a Mesh,
    result: &'a dyn Traced,
    /// By triangle, its control face.
    pub(super) parents: &'a [u32],
    pub(super) vertex_count: usize,
}

impl<'a> Places<'a> {
    /// If channels are by face only, where corners are need not be known.
    ///
    /// # Errors
    /// Origins or parents are missing, or a triangle reaches over several control faces.
    pub(super) fn of(
        control: &'a Mesh,
        result: &'a dyn Traced,
        is_by_face: bool,
    ) -> Result<Self, ChannelError> {
        let mesh = result.mesh();
        let unknown = |why| Err(ChannelError::Unknown { why });
        if result.parents().len() != mesh.face_count() {
            return unknown("the triangles have no control faces");
        }
        if !is_by_face && result.origins().len() != mesh.vertex_count() {
            return unknown("the vertices have no origins");
        }
        let places = Self { control, result, parents: result.parents(), vertex_count: mesh.vertex_count() };
        let faces = control.face_count();
        let is_known = |face: u32| (face as usize) < faces;
        if !places.parents.iter().all(|&face| is_known(face))
            || !result.origins().iter().all(|origin| is_known(origin.face))
        {
            return unknown("they come from another control mesh");
        }
        if is_by_face {
            return Ok(places);
        }
        let corners = 0..3 * mesh.face_count() as u32;
        match corners.into_iter().all(|corner| places.place(corner).is_some()) {
            true => Ok(places),
            false => unknown("a triangle reaches over several control faces"),
        }
    }

    /// The place of a corner.
    fn place(&self, corner: u32) -> Option<Origin> {
        self.result.corner_origin(self.control.triangles(), HalfEdgeId(corner))
    }

    /// Calls `visit` with the vertex and the place of each corner, triangle by triangle.
    pub(super) fn for_each_corner(&self, mut visit: impl FnMut(u32, Origin)) {
        for (corner, &vertex) in self.result.mesh().triangles().as_flattened().iter().enumerate() {
            if let Some(place) = self.place(corner as u32) {
                visit(vertex, place);
            }
        }
    }

    /// The numbers of the values that a place depends on, in the order of their control vertices.
    pub(super) fn key(&self, channel: &Channel, Origin { face, barycentric }: Origin) -> Key {
        let vertices = self.control.triangles()[face as usize];
        let mut own = [(NONE, NONE); 3];
        for (corner, &vertex) in vertices.iter().enumerate() {
            if barycentric[corner] != 0.0 {
                own[corner] = (vertex, channel.indices[3 * face as usize + corner]);
            }
        }
        own.sort_unstable();
        own.map(|(_, value)| value)
    }
}

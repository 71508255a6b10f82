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
    /// Origins or parents are missing, or are of another control mesh.
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
        Ok(places)
    }

    /// The place of a corner.
    fn place(&self, corner: u32) -> Option<Origin> {
        self.result.corner_origin(self.control.triangles(), HalfEdgeId(corner))
    }

    /// Calls `visit` with the vertex and the place of each corner, triangle by triangle.
    ///
    /// # Errors
    /// A triangle reaches over several control faces, of which nobody knows where.
    pub(super) fn for_each_corner(&self, mut visit: impl FnMut(u32, Origin)) -> Result<(), ChannelError> {
        let origins = self.result.origins();
        for (corner, &vertex) in self.result.mesh().triangles().as_flattened().iter().enumerate() {
            // Most are inside of a face, where all triangles have them at one place.
            if let Some(origin) = origins.get(vertex as usize).filter(|origin| is_inside(origin)) {
                visit(vertex, *origin);
                continue;
            }
            let Some(place) = self.place(corner as u32) else {
                return Err(ChannelError::Unknown { why: "a triangle reaches over several control faces" });
            };
            visit(vertex, place);
        }
        Ok(())
    }

    /// The numbers of the values that a place depends on, in the order of their control vertices; of places inside a face, which all
    /// corners at a vertex share, nothing needs to be told apart.
    pub(super) fn key(&self, channel: &Channel, origin: Origin) -> Key {
        if is_inside(&origin) {
            return [NONE; 3];
        }
        let Origin { face, barycentric } = origin;
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

/// Whether a place is on no edge of its face.
#[inline]
fn is_inside(Origin { barycentric, .. }: &Origin) -> bool {
    barycentric.iter().all(|&weight| weight != 0.0)
}

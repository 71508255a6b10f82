//! Where the corners of refined triangles are in their own control faces.
//!
//! A vertex knows one face that it came from; a triangle that has it may be in another beside that one.

use super::{Key, SEVERAL};
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

    /// The vertices of all corners.
    pub(super) fn corners(&self) -> &[u32] {
        self.result.mesh().triangles().as_flattened()
    }

    /// Calls `visit` with the vertex and the place of each corner, triangle by triangle.
    ///
    /// # Errors
    /// A triangle reaches over several control faces, of which nobody knows where.
    pub(super) fn for_each_corner(&self, mut visit: impl FnMut(u32, Origin)) -> Result<(), ChannelError> {
        self.corners().iter().enumerate().try_for_each(|(corner, &vertex)| {
            visit(vertex, self.known_place(corner as u32)?);
            Ok(())
        })
    }

    /// Gives what `find` does for their vertices and places to the corners that have [`SEVERAL`].
    ///
    /// # Errors
    /// As for [`Self::for_each_corner`].
    pub(super) fn for_each_corner_of(
        &self,
        numbers: &mut [u32],
        mut find: impl FnMut(u32, Origin) -> u32,
    ) -> Result<(), ChannelError> {
        for (corner, number) in numbers.iter_mut().enumerate().filter(|(_, number)| **number == SEVERAL) {
            *number = find(self.corners()[corner], self.known_place(corner as u32)?);
        }
        Ok(())
    }

    /// Calls `visit` with the vertices, and their places, at which a channel has one value in whatever face: those inside of control
    /// faces, and on edges that are no seams.
    pub(super) fn for_each_vertex_of_one_value(
        &self,
        channel: &Channel,
        mut visit: impl FnMut(usize, Origin),
    ) {
        let topology = self.control.topology();
        let is_seam: Vec<bool> = topology
            .half_edges()
            .map(|h| topology.twin(h).is_some_and(|twin| !channel.is_continuous(h, twin)))
            .collect();
        for (vertex, origin) in self.result.origins().iter().enumerate() {
            let [a, b, c] = origin.barycentric.map(|weight| weight == 0.0);
            let has_one = match (a, b, c) {
                (false, false, false) => true,
                // The edge opposite the corner without weight.
                (true, false, false) => !is_seam[3 * origin.face as usize + 1],
                (false, true, false) => !is_seam[3 * origin.face as usize + 2],
                (false, false, true) => !is_seam[3 * origin.face as usize],
                _ => false,
            };
            if has_one {
                visit(vertex, *origin);
            }
        }
    }

    fn known_place(&self, corner: u32) -> Result<Origin, ChannelError> {
        self.place(corner)
            .ok_or(ChannelError::Unknown { why: "a triangle reaches over several control faces" })
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

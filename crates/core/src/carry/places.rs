//! Where the corners of refined triangles are in their own control faces.
//!
//! A vertex knows one face that it came from; a triangle that has it may be in another beside that one. Both faces then share the
//! control vertex or edge on which the vertex is, so its barycentric coordinates there are found by the vertices' names.

use super::Key;
use crate::geometry::NONE;
use crate::mesh::{Channel, ChannelError, Mesh};
use crate::refine::{Exact, Origin};

/// A refined mesh's places on its control mesh.
pub(super) struct Places<'a> {
    control: &'a Mesh,
    triangles: &'a [[u32; 3]],
    origins: &'a [Origin],
    /// By triangle, its control face.
    pub(super) parents: &'a [u32],
    pub(super) vertex_count: usize,
}

impl<'a> Places<'a> {
    /// If channels are by face only, where corners are need not be known.
    ///
    /// # Errors
    /// Origins or parents are missing, or a triangle reaches over several control faces.
    pub(super) fn of(control: &'a Mesh, result: &'a Exact, is_by_face: bool) -> Result<Self, ChannelError> {
        let mesh = &result.mesh;
        let unknown = |why| Err(ChannelError::Unknown { why });
        if result.parents.len() != mesh.face_count() {
            return unknown("the triangles have no control faces");
        }
        if !is_by_face && result.origins.len() != mesh.vertex_count() {
            return unknown("the vertices have no origins");
        }
        let places = Self {
            control,
            triangles: mesh.triangles(),
            origins: &result.origins,
            parents: &result.parents,
            vertex_count: mesh.vertex_count(),
        };
        let faces = control.face_count();
        let is_known = |face: u32| (face as usize) < faces;
        if !places.parents.iter().all(|&face| is_known(face))
            || !places.origins.iter().all(|origin| is_known(origin.face))
        {
            return unknown("they come from another control mesh");
        }
        if is_by_face {
            return Ok(places);
        }
        let mut is_whole = true;
        places.for_each_corner(|_, origin| is_whole &= origin.face != NONE);
        if is_whole { Ok(places) } else { unknown("a triangle reaches over several control faces") }
    }

    /// Calls `visit` with the vertex and the place of each corner, triangle by triangle; the place's face is [`NONE`] where the vertex
    /// is not on the triangle's.
    pub(super) fn for_each_corner(&self, mut visit: impl FnMut(u32, Origin)) {
        for (triangle, &parent) in self.triangles.iter().zip(self.parents) {
            for &vertex in triangle {
                visit(vertex, self.in_face(&self.origins[vertex as usize], parent));
            }
        }
    }

    /// The same place seen from another face.
    fn in_face(&self, origin: &Origin, face: u32) -> Origin {
        if origin.face == face {
            return *origin;
        }
        let [from, to] = [origin.face, face].map(|face| self.control.triangles()[face as usize]);
        let mut barycentric = [0.0; 3];
        for (vertex, &weight) in from.iter().zip(&origin.barycentric) {
            if weight == 0.0 {
                continue;
            }
            match to.iter().position(|other| other == vertex) {
                Some(corner) => barycentric[corner] = weight,
                None => return Origin { face: NONE, barycentric },
            }
        }
        Origin { face, barycentric }
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

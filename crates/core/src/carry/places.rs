//! The places of refined triangles' corners in their own control faces.
//!
//! A vertex has the origin of one of its faces; a triangle with this vertex may be in an adjacent
//! face.

use crate::geometry::NONE;
use crate::index::HalfEdgeId;
use crate::mesh::{Channel, ChannelError, Mesh};
use crate::refine::{Origin, Traced};

/// The numbers of the values at the control vertices of the face, edge or vertex that a place is
/// in: the values on which it depends where channels are linear, and its side of seams.
pub(super) type Key = [u32; 3];

/// A refined mesh's places on its control mesh.
pub(super) struct Places<'a> {
    control: &'a Mesh,
    result: &'a dyn Traced,
    /// By triangle, its control face.
    pub(super) parents: &'a [u32],
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
        let places = Self {
            control,
            result,
            parents: result.parents(),
        };
        // Without an early exit, several loops run together.
        let last_parent = places.parents.iter().copied().max();
        let last_origin = result.origins().iter().map(|origin| origin.face).max();
        if last_parent
            .max(last_origin)
            .is_some_and(|face| face as usize >= control.face_count())
        {
            return unknown("they come from another control mesh");
        }
        Ok(places)
    }

    /// Where vertices came from.
    pub(super) fn origins(&self) -> &'a [Origin] {
        self.result.origins()
    }

    /// The vertices of all corners.
    pub(super) fn corners(&self) -> &[u32] {
        self.result.mesh().triangles().as_flattened()
    }

    /// Calls `visit` with the vertices at which a channel has one value in whatever face: those inside of control faces, on edges that
    /// are no seams, and at control vertices where no seam ends.
    pub(super) fn for_each_vertex_of_one_value(
        &self,
        channel: &Channel,
        mut visit: impl FnMut(usize),
    ) {
        let topology = self.control.topology();
        let is_seam: Vec<bool> = topology
            .half_edges()
            .map(|h| {
                topology
                    .twin(h)
                    .is_some_and(|twin| !channel.is_continuous(h, twin))
            })
            .collect();
        let triangles = self.control.triangles();
        let has_one = values_of_vertices(channel, self.control);
        let has_one = |face: u32, corner: usize| has_one[triangles[face as usize][corner] as usize];
        for (vertex, &Origin { face, barycentric }) in self.origins().iter().enumerate() {
            let is_one = match barycentric.map(|weight| weight == 0.0) {
                [false, false, false] => true,
                // The edge opposite the corner without weight.
                [true, false, false] => !is_seam[3 * face as usize + 1],
                [false, true, false] => !is_seam[3 * face as usize + 2],
                [false, false, true] => !is_seam[3 * face as usize],
                [false, true, true] => has_one(face, 0),
                [true, false, true] => has_one(face, 1),
                [true, true, false] => has_one(face, 2),
                // A vertex of no face.
                [true, true, true] => false,
            };
            if is_one {
                visit(vertex);
            }
        }
    }

    /// The place of a corner.
    ///
    /// # Errors
    /// Its triangle covers parts of several control faces, so that the origin is ambiguous.
    pub(super) fn known_place(&self, corner: usize) -> Result<Origin, ChannelError> {
        let corner = HalfEdgeId(corner as u32);
        self.result
            .corner_origin(self.control.triangles(), corner)
            .ok_or(ChannelError::Unknown {
                why: "a triangle reaches over several control faces",
            })
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

/// By control vertex, whether all corners at it have one value.
fn values_of_vertices(channel: &Channel, control: &Mesh) -> Vec<bool> {
    let mut first = vec![NONE; control.vertex_count()];
    let mut has_one = vec![true; control.vertex_count()];
    for (&vertex, &value) in control
        .triangles()
        .as_flattened()
        .iter()
        .zip(&channel.indices)
    {
        let (first, has_one) = (&mut first[vertex as usize], &mut has_one[vertex as usize]);
        match *first {
            NONE => *first = value,
            other => *has_one &= other == value,
        }
    }
    has_one
}

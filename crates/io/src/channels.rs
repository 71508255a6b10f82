//! Names of channels that files give no names, and the values of channels by vertex.

use limitmesh::mesh::{Channel, Domain};

/// The channel of texture coordinates where a format gives them no name of their own.
pub const TEXTURE: &str = "texture coordinates";
/// Lists of texture coordinates by corner in PLY files, as MeshLab writes them.
pub(crate) const TEXTURE_LISTS: &str = "texcoord";
/// Colours where a format gives them no name.
pub(crate) const COLOUR: &str = "colours";
/// Colours of faces where a format gives them no name.
pub(crate) const FACE_COLOUR: &str = "colours of faces";
/// Attributes of facets in binary STL files.
pub(crate) const ATTRIBUTE: &str = "attributes of facets";
/// The name of a solid without a name in STL files, which need one; no name when read.
pub(crate) const UNNAMED_SOLID: &str = "limitmesh";
/// Normals of corners: where they differ between two faces, their edge was meant to be sharp. They are found anew, so no file holds them.
pub const NORMALS: &str = "normals";
/// Names of objects.
pub const OBJECT: &str = "names of objects";
/// Groups.
pub const GROUP: &str = "groups";
/// The channel of materials, by face.
pub const MATERIAL: &str = "materials";
/// Smoothing groups.
pub const SMOOTHING_GROUP: &str = "smoothing groups";

/// No value.
const NONE: u32 = u32::MAX;

/// A channel's values by vertex.
pub(crate) struct ByVertex {
    /// By vertex, the number of its value, of several corners the first's.
    pub(crate) indices: Vec<u32>,
    /// How many vertices have several values.
    pub(crate) torn: usize,
}

/// The values of a channel, which must have some, by vertex.
pub(crate) fn by_vertex(channel: &Channel, vertices: usize, triangles: &[[u32; 3]]) -> ByVertex {
    if channel.domain == Domain::Vertex {
        let indices = channel.indices.clone();
        return ByVertex { indices, torn: 0 };
    }
    let (mut indices, mut is_torn) = (vec![NONE; vertices], vec![false; vertices]);
    for (corner, &vertex) in triangles.as_flattened().iter().enumerate() {
        let is_by_face = channel.domain == Domain::Face;
        let index = channel.indices[if is_by_face { corner / 3 } else { corner }];
        let first = &mut indices[vertex as usize];
        is_torn[vertex as usize] |= *first != NONE && *first != index;
        if *first == NONE {
            *first = index;
        }
    }
    // Vertices in no triangle have the first value there is.
    for index in indices.iter_mut().filter(|index| **index == NONE) {
        *index = 0;
    }
    let torn = is_torn.into_iter().filter(|&is_torn| is_torn).count();
    ByVertex { indices, torn }
}

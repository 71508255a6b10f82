//! Names of channels that files give no names, and which format holds which.

use limitmesh::mesh::{Channel, Domain, Semantic};

use crate::format::Format;
use crate::write::WriteOptions;

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
/// Normals of corners: where they differ between two faces, their edge was meant to be sharp. They are found anew, so no file holds them.
pub const NORMALS: &str = "normals";
/// Names of objects.
pub const OBJECT: &str = "names of objects";
/// Groups.
pub const GROUP: &str = "groups";
/// The channel of materials, by face.
pub const MATERIAL: &str = "materials";
/// What a solid without a name is called in STL files, which have to call it something; no name when read.
pub(crate) const UNNAMED_SOLID: &str = "limitmesh";
/// Smoothing groups.
pub const SMOOTHING_GROUP: &str = "smoothing groups";

/// Whether files of a format have a place for a channel.
pub fn holds(format: Format, options: &WriteOptions, channel: &Channel) -> bool {
    if channel.name == NORMALS {
        return false;
    }
    let is_named = |name: &str| channel.domain == Domain::Face && channel.name == name;
    match format {
        Format::Obj => match (channel.semantic, channel.domain) {
            (Semantic::TextureCoordinates, _) => true,
            (Semantic::Colour, domain) => domain != Domain::Face && channel.arity == 3,
            (Semantic::Label, Domain::Face) => {
                [OBJECT, GROUP, MATERIAL, SMOOTHING_GROUP].contains(&channel.name.as_str())
            }
            _ => false,
        },
        Format::Ply => match channel.semantic {
            Semantic::TextureCoordinates => channel.domain != Domain::Face,
            Semantic::Label => channel.labels.is_empty(),
            _ => true,
        },
        Format::Off => channel.semantic == Semantic::Colour && [3, 4].contains(&channel.arity),
        // One in text, the other in bytes.
        Format::Stl if options.ascii => is_named(OBJECT),
        Format::Stl => is_named(ATTRIBUTE) && channel.arity == 1,
        // A new document's; one that is edited keeps what it has.
        Format::Gltf | Format::Glb => match channel.semantic {
            Semantic::TextureCoordinates => channel.domain != Domain::Face,
            Semantic::Colour => channel.domain != Domain::Face && [3, 4].contains(&channel.arity),
            Semantic::Other => channel.domain != Domain::Face && (1..=4).contains(&channel.arity),
            _ => is_named(MATERIAL),
        },
        Format::ThreeMf => false,
    }
}

/// By vertex, the number of its value, of several corners the first's; and how many vertices have several. The channel must have values.
pub(crate) fn by_vertex(
    channel: &Channel,
    vertices: usize,
    triangles: &[[u32; 3]],
) -> (Vec<u32>, usize) {
    const NONE: u32 = u32::MAX;
    if channel.domain == Domain::Vertex {
        return (channel.indices.clone(), 0);
    }
    let (mut values, mut is_torn) = (vec![NONE; vertices], vec![false; vertices]);
    for (corner, &vertex) in triangles.as_flattened().iter().enumerate() {
        let element = if channel.domain == Domain::Face {
            corner / 3
        } else {
            corner
        };
        let (index, first) = (channel.indices[element], &mut values[vertex as usize]);
        is_torn[vertex as usize] |= *first != NONE && *first != index;
        if *first == NONE {
            *first = index;
        }
    }
    // Vertices in no triangle have the first value there is.
    values
        .iter_mut()
        .filter(|index| **index == NONE)
        .for_each(|index| *index = 0);
    (
        values,
        is_torn.into_iter().filter(|&is_torn| is_torn).count(),
    )
}

/// How many vertices have several values of a channel of which a format holds one: these get the first of their corners'.
pub fn values_lost(
    format: Format,
    channel: &Channel,
    triangles: &[[u32; 3]],
    vertices: usize,
) -> usize {
    let options = WriteOptions::default();
    let is_by_corner = channel.semantic == Semantic::TextureCoordinates || format.is_gltf();
    if channel.domain != Domain::Corner || is_by_corner || !holds(format, &options, channel) {
        return 0;
    }
    by_vertex(channel, vertices, triangles).1
}

//! Names of channels that several formats share, and which format holds which.

use limitmesh::mesh::{Channel, Domain, Semantic};

use crate::format::Format;

/// Texture coordinates where a format gives them no name.
pub(crate) const TEXTURE: &str = "texture coordinates";
/// Colours where a format gives them no name.
pub(crate) const COLOUR: &str = "colours";
/// Names of objects.
pub(crate) const OBJECT: &str = "names of objects";
/// Groups.
pub(crate) const GROUP: &str = "groups";
/// Materials.
pub(crate) const MATERIAL: &str = "materials";
/// Smoothing groups.
pub(crate) const SMOOTHING_GROUP: &str = "smoothing groups";

/// Whether files of a format have a place for a channel.
pub fn holds(format: Format, channel: &Channel) -> bool {
    match format {
        Format::Obj => match (channel.semantic, channel.domain) {
            (Semantic::TextureCoordinates, _) => true,
            (Semantic::Colour, domain) => domain != Domain::Face && channel.arity == 3,
            (Semantic::Label, Domain::Face) => {
                [OBJECT, GROUP, MATERIAL, SMOOTHING_GROUP].contains(&channel.name.as_str())
            }
            _ => false,
        },
        Format::Ply | Format::Stl | Format::Off | Format::Gltf | Format::Glb => false,
    }
}

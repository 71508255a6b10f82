//! Values of the meshes of a scene, as channels of one soup.
//!
//! A channel of the scene has the values of all meshes, one after the other, as often as the scene shows them; where a mesh has no
//! such attribute the value is zero. Texture coordinates run upwards, as in other formats: glTF's v is 1 − v.

use super::attributes::CornerAttribute;
use super::parts::MeshSoup;
use super::scene::Placement;
use crate::channels::{COLOUR, MATERIAL, NORMALS, TEXTURE};
use crate::flaw::Result;
use crate::formats::gltf::document::source::Source;
use crate::reading::named_faces;
use limitmesh::mesh::{Channel, Domain, PolygonFaces, Semantic};

/// Channels of a scene, as far as they were gathered.
#[derive(Debug, Default)]
pub(crate) struct SceneChannels {
    channels: Vec<Channel>,
    /// By face, one more than the number of its material; 0 without one.
    materials: Vec<u32>,
    corners: usize,
}

impl SceneChannels {
    /// Adds a mesh once more, where it is placed; `materials` are those of its primitives.
    pub(crate) fn add(
        &mut self,
        mesh: &MeshSoup,
        materials: &[Option<usize>],
        placement: &Placement,
    ) {
        let is_mirrored = placement.mirrors();
        for attribute in mesh.attributes.iter().filter(|own| own.target.is_none()) {
            let channel = self.of_attribute(attribute);
            let first = channel.value_count() as u32;
            let is_texture = channel.semantic == Semantic::TextureCoordinates;
            for value in attribute.values.chunks_exact(attribute.width) {
                if let ([u, v], true) = (value, is_texture) {
                    channel.values.extend([*u, 1.0 - *v]);
                    continue;
                }
                // A colour without alpha is opaque.
                let rest = channel.arity.saturating_sub(value.len());
                channel.values.extend(value.iter().take(channel.arity));
                channel.values.extend(std::iter::repeat_n(1.0, rest));
            }
            add_faces(
                channel,
                first,
                &attribute.corners,
                &mesh.soup.faces,
                is_mirrored,
            );
        }
        self.add_normals(mesh, placement, is_mirrored);
        self.corners += mesh.soup.faces.corner_count();
        for channel in &mut self.channels {
            pad(channel, self.corners);
        }
        for part in &mesh.parts {
            let material = materials.get(part.primitive).copied().flatten();
            let number = material.map_or(0, |material| material as u32 + 1);
            self.materials.extend(part.faces.clone().map(|_| number));
        }
    }

    /// Adds a mesh's normals as the scene shows them, mirrored or not, if it has some.
    fn add_normals(&mut self, mesh: &MeshSoup, placement: &Placement, is_mirrored: bool) {
        let Some(own) = &mesh.normals else { return };
        let mut values = own.values.clone();
        let mut is_moved = vec![false; own.value_count()];
        for (&v, &index) in mesh.soup.faces.iter().flatten().zip(&own.indices) {
            if !std::mem::replace(&mut is_moved[index as usize], true)
                && let Some(normal) = values.as_chunks_mut::<3>().0.get_mut(index as usize)
            {
                *normal = placement.apply_to_normal(mesh, v as usize, *normal);
            }
        }
        let channel = self.channel(NORMALS, Semantic::Other, 3);
        let first = channel.value_count() as u32;
        channel.values.extend(values);
        let faces = &mesh.soup.faces;
        add_faces(channel, first, &own.indices, faces, is_mirrored);
    }

    /// The scene's channel of a name, with values at all corners so far.
    fn channel(&mut self, name: &str, semantic: Semantic, arity: usize) -> &mut Channel {
        let mut known = self.channels.iter();
        let known = known.position(|channel| channel.name == name);
        let at = known.unwrap_or_else(|| {
            let mut channel = Channel::new(name, semantic, Domain::Corner, arity);
            pad(&mut channel, self.corners);
            self.channels.push(channel);
            self.channels.len() - 1
        });
        &mut self.channels[at]
    }

    /// The scene's channel for an attribute.
    fn of_attribute(&mut self, attribute: &CornerAttribute) -> &mut Channel {
        let (name, semantic) = match attribute.name.as_str() {
            "TEXCOORD_0" => (TEXTURE, Semantic::TextureCoordinates),
            "COLOR_0" => (COLOUR, Semantic::Colour),
            name if name.starts_with("TEXCOORD_") => (name, Semantic::TextureCoordinates),
            name if name.starts_with("COLOR_") => (name, Semantic::Colour),
            name if attribute.is_integer => (name, Semantic::Label),
            name => (name, Semantic::Other),
        };
        let channel = self.channel(name, semantic, attribute.width);
        if channel.arity < attribute.width {
            widen(channel, attribute.width);
        }
        channel
    }

    /// All channels; materials by name, where there are any.
    pub(crate) fn into_channels(mut self, source: &Source) -> Result<Vec<Channel>> {
        if self.materials.iter().any(|&material| material != 0) {
            let mut labels = vec![String::new()];
            for (index, material) in source.root().list("materials")?.iter().enumerate() {
                // An empty label is that of faces without a material.
                let name = material.name().filter(|name| !name.is_empty());
                labels.push(name.map_or_else(|| format!("materials[{index}]"), str::to_owned));
            }
            self.channels
                .push(named_faces(MATERIAL, labels, self.materials));
        }
        Ok(self.channels)
    }
}

/// Adds faces whose corners have values from `first` on, mirrored or not.
fn add_faces(
    channel: &mut Channel,
    first: u32,
    corners: &[u32],
    faces: &PolygonFaces,
    is_mirrored: bool,
) {
    let start = channel.indices.len();
    channel
        .indices
        .extend(corners.iter().map(|own| first + own));
    let mut left = &mut channel.indices[start..];
    for face in faces.iter().filter(|_| is_mirrored) {
        let own = left.split_off_mut(..face.len());
        own.into_iter().for_each(<[u32]>::reverse);
    }
}

/// Gives zeros to corners that have no value yet.
fn pad(channel: &mut Channel, corners: usize) {
    if channel.indices.len() < corners {
        let zero = channel.value_count() as u32;
        channel
            .values
            .extend(std::iter::repeat_n(0.0, channel.arity));
        channel.indices.resize(corners, zero);
    }
}

/// Makes room for more numbers in each value: ones, which is what alpha is where there is none.
fn widen(channel: &mut Channel, arity: usize) {
    let values = std::mem::take(&mut channel.values);
    let ones = arity - channel.arity;
    for value in values.chunks_exact(channel.arity) {
        channel.values.extend(value);
        channel.values.extend(std::iter::repeat_n(1.0, ones));
    }
    channel.arity = arity;
}

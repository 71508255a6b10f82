//! What the meshes of a scene carry, as channels of one soup.
//!
//! A channel of the scene has the values of all meshes, one after the other, as often as the scene shows them; where a mesh has no
//! such attribute the value is zero. Texture coordinates run upwards, as in other formats: glTF's v is 1 − v.

use super::attributes::CornerAttribute;
use super::flaw::Result;
use super::parts::MeshSoup;
use super::scene::Placement;
use super::source::Source;
use crate::channels::{COLOUR, MATERIAL, NORMALS, TEXTURE};
use limitmesh::mesh::{Channel, Domain, Semantic};

/// Channels of a scene, as far as they were gathered.
#[derive(Debug, Default)]
pub(super) struct SceneChannels {
    channels: Vec<Channel>,
    /// By face, one more than the number of its material; 0 without one.
    materials: Vec<u32>,
    corners: usize,
}

impl SceneChannels {
    /// Adds a mesh once more, where it is placed; `materials` are those of its primitives.
    pub(super) fn add(
        &mut self,
        mesh: &MeshSoup,
        materials: &[Option<usize>],
        placement: &Placement,
    ) {
        let is_mirrored = placement.mirrors();
        let corners = 3 * mesh.soup.faces.len();
        for attribute in mesh
            .attributes
            .iter()
            .filter(|attribute| attribute.target.is_none())
        {
            let channel = self.channel(attribute);
            let first = channel.value_count() as u32;
            let values = attribute.values.chunks_exact(attribute.width.max(1));
            for value in values {
                match channel.semantic {
                    Semantic::TextureCoordinates if value.len() == 2 => {
                        channel.values.extend([value[0], 1.0 - value[1]]);
                    }
                    _ => {
                        // A colour without alpha is opaque.
                        let rest = channel.arity.saturating_sub(value.len());
                        channel.values.extend(value.iter().take(channel.arity));
                        channel.values.extend(std::iter::repeat_n(1.0, rest));
                    }
                }
            }
            for mut face in attribute.corners.iter().copied() {
                if is_mirrored {
                    face.reverse();
                }
                channel.indices.extend(face.map(|index| first + index));
            }
        }
        self.add_normals(mesh, placement, is_mirrored);
        self.corners += corners;
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
        let at = self
            .channels
            .iter()
            .position(|channel| channel.name == NORMALS)
            .unwrap_or_else(|| {
                let mut channel = Channel::new(NORMALS, Semantic::Other, Domain::Corner, 3);
                pad(&mut channel, self.corners);
                self.channels.push(channel);
                self.channels.len() - 1
            });
        let channel = &mut self.channels[at];
        let first = channel.value_count() as u32;
        channel.values.extend(values);
        for mut face in own.indices.as_chunks::<3>().0.iter().copied() {
            if is_mirrored {
                face.reverse();
            }
            channel.indices.extend(face.map(|index| first + index));
        }
    }

    /// The scene's channel for an attribute, with values at all corners so far.
    fn channel(&mut self, attribute: &CornerAttribute) -> &mut Channel {
        let (name, semantic) = match attribute.name.as_str() {
            "TEXCOORD_0" => (TEXTURE, Semantic::TextureCoordinates),
            "COLOR_0" => (COLOUR, Semantic::Colour),
            name if name.starts_with("TEXCOORD_") => (name, Semantic::TextureCoordinates),
            name if name.starts_with("COLOR_") => (name, Semantic::Colour),
            name if attribute.is_integer => (name, Semantic::Label),
            name => (name, Semantic::Other),
        };
        if let Some(at) = self
            .channels
            .iter()
            .position(|channel| channel.name == name)
        {
            let channel = &mut self.channels[at];
            if channel.arity < attribute.width {
                widen(channel, attribute.width);
            }
            return &mut self.channels[at];
        }
        let mut channel = Channel::new(name, semantic, Domain::Corner, attribute.width);
        pad(&mut channel, self.corners);
        let at = self.channels.len();
        self.channels.push(channel);
        &mut self.channels[at]
    }

    /// All channels; materials by name, where there are any.
    pub(super) fn into_channels(mut self, source: &Source) -> Result<Vec<Channel>> {
        if self.materials.iter().any(|&material| material != 0) {
            let mut labels = vec![String::new()];
            for (index, material) in source.root().list("materials")?.iter().enumerate() {
                // An empty label is that of faces without a material.
                let name = material.name().filter(|name| !name.is_empty());
                labels.push(name.map_or_else(|| format!("materials[{index}]"), str::to_owned));
            }
            let values = (0..labels.len()).map(|label| label as f64).collect();
            let channel = Channel::new(MATERIAL, Semantic::Label, Domain::Face, 1);
            let mut channel = channel.with(values, self.materials);
            channel.labels = labels;
            self.channels.push(channel);
        }
        Ok(self.channels)
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
    for value in values.chunks_exact(channel.arity.max(1)) {
        channel.values.extend(value);
        channel
            .values
            .extend(std::iter::repeat_n(1.0, arity - channel.arity));
    }
    channel.arity = arity;
}

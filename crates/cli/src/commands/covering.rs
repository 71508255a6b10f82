//! The covering of a surface in a picture: one texture by a mesh's texture coordinates, or the materials of a glTF document.

use std::path::Path;

use anyhow::Context;
use limitmesh::Mesh;
use limitmesh::mesh::{Channel, Domain, Semantic};
use limitmesh_io::gltf::BaseTexture;
use limitmesh_io::{Asset, MATERIAL, TEXTURE};
use limitmesh_render::{Covering, Material, Texture};

use crate::failure::usage;
use crate::input::Input;

/// The pattern that needs no file, and nothing at all.
const CHECKER: &str = "checker";
const NONE: &str = "none";

/// No material.
const BARE: u32 = u32::MAX;

/// Materials, and where a mesh has them.
pub(super) struct Cover {
    materials: Vec<Material>,
    of_triangle: Vec<u32>,
    corners: Vec<[f64; 2]>,
}

impl Cover {
    /// Of a mesh that was read: with the texture that is asked for, or else with its own. `None` where it has neither.
    ///
    /// # Errors
    /// The texture cannot be read, or the mesh has no texture coordinates.
    pub(super) fn of(input: &Input, texture: Option<&Path>) -> anyhow::Result<Option<Self>> {
        match texture {
            Some(path) if path.as_os_str() == NONE => Ok(None),
            Some(path) if path.as_os_str() == CHECKER => {
                Self::of_texture(input, Texture::checker()).map(Some)
            }
            Some(path) => {
                let name = || format!("--texture {}", path.display());
                let bytes = std::fs::read(path).with_context(name)?;
                Self::of_texture(input, Texture::decode(&bytes).with_context(name)?).map(Some)
            }
            None => input
                .asset
                .as_ref()
                .map(|asset| Self::of_asset(input, asset))
                .transpose(),
        }
    }

    /// One texture over the whole mesh.
    fn of_texture(input: &Input, texture: Texture) -> anyhow::Result<Self> {
        let is_laid = |channel: &&Channel| channel.semantic == Semantic::TextureCoordinates;
        let Some(channel) = input.channels.iter().find(is_laid) else {
            return usage(format!(
                "{} has no texture coordinates (vt of OBJ, s and t of PLY, TEXCOORD_0 of glTF) that --texture could lie by",
                input.name
            ));
        };
        let count = input.mesh.face_count();
        let corners = (0..3 * count)
            .map(|corner| place(&input.mesh, channel, corner))
            .collect();
        let materials = vec![Material {
            colour: [1.0; 3],
            texture: Some(texture),
        }];
        Ok(Self {
            materials,
            of_triangle: vec![0; count],
            corners,
        })
    }

    /// The base colours of a document's materials.
    fn of_asset(input: &Input, asset: &Asset) -> anyhow::Result<Self> {
        let colours = asset.base_colours()?;
        let channel = |name: &str| input.channels.iter().find(|channel| channel.name == name);
        let names = channel(MATERIAL);
        let (mut materials, mut laid) = (Vec::new(), Vec::new());
        for colour in colours {
            let set = colour.texture.as_ref().map(|texture| match texture.set {
                0 => TEXTURE.to_owned(),
                set => format!("TEXCOORD_{set}"),
            });
            let own = colour
                .texture
                .as_ref()
                .zip(set.and_then(|name| channel(&name)));
            let picture = own
                .map(|(texture, _)| Texture::decode(&texture.file))
                .transpose();
            let [r, g, b, _] = colour.factor.map(|x| x as f32);
            materials.push(Material {
                colour: [r, g, b],
                texture: picture.context("a material's texture")?,
            });
            laid.push(own.map(|(texture, channel)| (Transform::of(texture), channel)));
        }
        let (mut of_triangle, mut corners) = (Vec::new(), Vec::new());
        for face in 0..input.mesh.face_count() {
            // Value 0 is no material.
            let number = names.and_then(|names| (names.indices[face] as usize).checked_sub(1));
            of_triangle.push(number.map_or(BARE, |number| number as u32));
            for corner in 3 * face..3 * face + 3 {
                let own = number.and_then(|number| laid.get(number)?.as_ref());
                corners.push(own.map_or([0.0; 2], |(transform, channel)| {
                    transform.apply(place(&input.mesh, channel, corner))
                }));
            }
        }
        Ok(Self {
            materials,
            of_triangle,
            corners,
        })
    }

    /// As it is drawn.
    pub(super) fn covering(&self) -> Covering<'_> {
        Covering {
            materials: &self.materials,
            of_triangle: &self.of_triangle,
            corners: &self.corners,
        }
    }
}

/// The first two of the texture coordinates at a corner of a mesh.
fn place(mesh: &Mesh, channel: &Channel, corner: usize) -> [f64; 2] {
    let value = channel.value(match channel.domain {
        Domain::Vertex => mesh.triangles()[corner / 3][corner % 3] as usize,
        Domain::Corner => corner,
        Domain::Face => corner / 3,
    });
    [0, 1].map(|axis| value.get(axis).copied().unwrap_or(0.0))
}

/// A document's transform of texture coordinates.
struct Transform([[f64; 2]; 3]);

impl Transform {
    fn of(texture: &BaseTexture) -> Self {
        Self(texture.transform)
    }

    /// Channels' texture coordinates run upwards, and those of glTF downwards.
    fn apply(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let [x, y, shift] = self.0;
        let v = 1.0 - v;
        let moved = [0, 1].map(|axis| x[axis] * u + y[axis] * v + shift[axis]);
        [moved[0], 1.0 - moved[1]]
    }
}

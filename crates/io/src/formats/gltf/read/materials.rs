//! The looks of a document's materials in plain light: colours, and the textures that multiply them.

use crate::flaw::Result;
use crate::formats::gltf::document::extensions::TRANSFORM;
use crate::formats::gltf::document::json::At;
use crate::formats::gltf::document::source::Source;
use limitmesh::math;

/// The base colour of a material.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct BaseColour {
    /// Red, green, blue in linear light, and opacity; multiplies the texture.
    pub factor: [f64; 4],
    /// The texture, if it has one.
    pub texture: Option<BaseTexture>,
}

/// A picture and the texture coordinates that it lies by.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct BaseTexture {
    /// The picture's file: PNG or JPEG, or what an extension allows.
    pub file: Vec<u8>,
    /// Which set of texture coordinates.
    pub set: usize,
    /// Their transform, in glTF's own direction (v downwards): the columns of a matrix and a shift (`KHR_texture_transform`).
    pub transform: [[f64; 2]; 3],
}

impl Source {
    /// The base colours of all materials.
    pub(crate) fn base_colours(&self) -> Result<Vec<BaseColour>> {
        let all = self.root().list("materials")?.into_iter();
        all.map(|own| self.base_colour(&own)).collect()
    }

    fn base_colour(&self, material: &At<'_>) -> Result<BaseColour> {
        let Some(model) = material.get("pbrMetallicRoughness") else {
            return Ok(BaseColour {
                factor: [1.0; 4],
                texture: None,
            });
        };
        let factor = model.numbers_or("baseColorFactor", [1.0; 4])?;
        let texture = model.get("baseColorTexture");
        let texture = texture.map(|info| self.base_texture(&info));
        Ok(BaseColour {
            factor,
            texture: texture.transpose()?.flatten(),
        })
    }

    /// `None` if the texture has no picture of its own, as extensions for other kinds of files allow.
    fn base_texture(&self, info: &At<'_>) -> Result<Option<BaseTexture>> {
        let root = self.root();
        let texture = info.require("index")?.item_of(&root, "textures")?;
        let Some(image) = texture.get("source") else {
            return Ok(None);
        };
        let image = image.item_of(&root, "images")?;
        let file = match image.get("bufferView") {
            Some(view) => self.view(&view)?.bytes.to_vec(),
            None => self.picture(&image.require("uri")?)?,
        };
        let mut transform = [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]];
        if let Some(own) = info.path(&["extensions", TRANSFORM]) {
            let [x, y] = own.numbers_or("scale", [1.0; 2])?;
            let (sine, cosine) = math::sin_cos(own.number_or("rotation", 0.0)?);
            let offset = own.numbers_or("offset", [0.0; 2])?;
            transform = [[cosine * x, -sine * x], [sine * y, cosine * y], offset];
        }
        Ok(Some(BaseTexture {
            file,
            set: texture_set(info)?,
            transform,
        }))
    }

    /// The set of texture coordinates by which a material's normal map lies: the first without one.
    pub(crate) fn tangent_set(&self, material: usize) -> Result<usize> {
        let materials = self.root().list("materials")?;
        let map = materials.get(material);
        let map = map.and_then(|own| own.get("normalTexture"));
        map.map_or(Ok(0), |map| texture_set(&map))
    }
}

/// The set of texture coordinates that a use of a texture names.
fn texture_set(info: &At<'_>) -> Result<usize> {
    let set = info.count_or("texCoord", 0)?;
    let transform = info.path(&["extensions", TRANSFORM]);
    transform.map_or(Ok(set), |own| own.count_or("texCoord", set))
}

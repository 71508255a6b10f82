//! What the materials of a document look like in plain light: colours, and the textures that multiply them.

use super::Asset;
use super::flaw::Result;
use super::json::At;
use super::source::Source;
use crate::error::ReadError;

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
    /// What is done to them, in glTF's own direction (v downwards): the columns of a matrix and a shift (`KHR_texture_transform`).
    pub transform: [[f64; 2]; 3],
}

/// The extension that shifts, turns and scales texture coordinates, or names others.
pub(super) const TRANSFORM: &str = "KHR_texture_transform";

impl Asset {
    /// The base colours of all materials, by the numbers that channels give them.
    ///
    /// # Errors
    /// A material, a texture or an image breaks the rules, or a picture's file cannot be read.
    pub fn base_colours(&self) -> std::result::Result<Vec<BaseColour>, ReadError> {
        self.source.base_colours().map_err(|flaw| self.told(flaw))
    }
}

impl Source {
    fn base_colours(&self) -> Result<Vec<BaseColour>> {
        self.root()
            .list("materials")?
            .iter()
            .map(|material| self.base_colour(material))
            .collect()
    }

    fn base_colour(&self, material: &At<'_>) -> Result<BaseColour> {
        let Some(model) = material.get("pbrMetallicRoughness") else {
            return Ok(BaseColour {
                factor: [1.0; 4],
                texture: None,
            });
        };
        let factor = model
            .get("baseColorFactor")
            .map_or(Ok([1.0; 4]), |factor| factor.numbers())?;
        let texture = model
            .get("baseColorTexture")
            .map(|info| self.base_texture(&info))
            .transpose()?;
        Ok(BaseColour {
            factor,
            texture: texture.flatten(),
        })
    }

    /// `None` if the texture has no picture of its own, as extensions for other kinds of files allow.
    fn base_texture(&self, info: &At<'_>) -> Result<Option<BaseTexture>> {
        let root = self.root();
        let (_, texture) = info.require("index")?.item_of(&root, "textures")?;
        let Some(image) = texture.get("source") else {
            return Ok(None);
        };
        let (_, image) = image.item_of(&root, "images")?;
        let file = match image.get("bufferView") {
            Some(view) => self.view(&view)?.bytes.to_vec(),
            None => self.picture(&image.require("uri")?)?,
        };
        let set = info.count_or("texCoord", 0)?;
        let (mut set, mut transform) = (set, [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]]);
        if let Some(extension) = info.path(&["extensions", TRANSFORM]) {
            set = extension.count_or("texCoord", set)?;
            let pair =
                |key: &str, otherwise| extension.get(key).map_or(Ok(otherwise), |at| at.numbers());
            let (offset, [x, y]) = (pair("offset", [0.0; 2])?, pair("scale", [1.0; 2])?);
            let (sine, cosine) = extension
                .get("rotation")
                .map_or(Ok(0.0), |at| at.number())?
                .sin_cos();
            transform = [[cosine * x, -sine * x], [sine * y, cosine * y], offset];
        }
        Ok(Some(BaseTexture {
            file,
            set,
            transform,
        }))
    }
}

//! Materials of OBJ files as those of a new document: base colours, and pictures in the document or in files.

use serde_json::{Value, json};
use std::collections::HashMap;
use std::path::Path;

use super::flaw::{GltfFlaw, Result};
use super::fresh::attributes;
use super::json::shortened;
use super::source::Source;
use super::uri;
use crate::format::Format;
use crate::mtl::{Material, Picture};
use crate::write::Output;

/// What a document says of materials, each list for its member.
#[derive(Default)]
pub(super) struct Looks {
    pub(super) materials: Vec<Value>,
    pub(super) textures: Vec<Value>,
    pub(super) images: Vec<Value>,
    pub(super) views: Vec<Value>,
    /// What the views name.
    pub(super) bytes: Vec<u8>,
}

/// Where pictures are.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Pictures {
    /// In the binary chunk.
    InChunk,
    /// Files, which are copied to the document's folder.
    Files,
    /// In the text.
    InText,
}

impl Pictures {
    /// Those of a document that is written to a file, or somewhere else.
    pub(super) fn of(format: Format, path: Option<&Path>) -> Self {
        match (format, path) {
            (Format::Glb, _) => Self::InChunk,
            (_, Some(_)) => Self::Files,
            (_, None) => Self::InText,
        }
    }
}

impl Looks {
    /// Of materials of these names, as far as libraries describe them.
    ///
    /// # Errors
    /// A picture cannot be read.
    pub(super) fn of(
        names: &[&str],
        output: Option<&Output<'_>>,
        pictures: Pictures,
    ) -> Result<Self> {
        let mut looks = Self::default();
        let named = |name: &&str| json!({ "name": name });
        let Some((output, found)) = output.and_then(|output| Some((output, output.materials?)))
        else {
            looks.materials = names.iter().map(named).collect();
            return Ok(looks);
        };
        let has_places = attributes(output)
            .iter()
            .any(|(name, _)| name == "TEXCOORD_0");
        // Of several of one name the last holds, as later statements do.
        let described: HashMap<&str, &Material> = found
            .materials
            .iter()
            .map(|own| (own.name.as_str(), own))
            .collect();
        let mut textures: HashMap<&Path, usize> = HashMap::new();
        for name in names {
            let Some(own) = described.get(name) else {
                looks.materials.push(named(name));
                continue;
            };
            let mut texture = None;
            if let Some(Picture {
                file,
                mime_type: Some(kind),
            }) = own.picture.as_ref().filter(|_| has_places)
            {
                let number = *textures.entry(file).or_insert(looks.textures.len());
                if number == looks.textures.len() {
                    looks.add_picture(&found.folder, file, kind, pictures)?;
                }
                texture = Some(number);
            }
            looks.materials.push(material(own, texture));
        }
        Ok(looks)
    }

    /// Adds a picture and its texture.
    fn add_picture(
        &mut self,
        folder: &Path,
        file: &Path,
        kind: &str,
        pictures: Pictures,
    ) -> Result<()> {
        let names: Vec<String> = file
            .iter()
            .map(|part| part.to_string_lossy().into_owned())
            .collect();
        let name = names.join("/");
        let read = || {
            std::fs::read(folder.join(file)).map_err(|why| {
                let met = format!("'{}', which cannot be read: {why}", shortened(&name));
                GltfFlaw::new("images", met, "a picture that can be read")
            })
        };
        self.textures.push(json!({"source": self.images.len()}));
        self.images.push(match pictures {
            Pictures::InChunk => {
                self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
                let (start, own) = (self.bytes.len(), read()?);
                self.views
                    .push(json!({"buffer": 0, "byteOffset": start, "byteLength": own.len()}));
                self.bytes.extend(own);
                json!({"bufferView": self.views.len() - 1, "mimeType": kind})
            }
            Pictures::Files => json!({"uri": uri::escaped(&name)}),
            Pictures::InText => {
                json!({"uri": format!("data:{kind};base64,{}", uri::to_base64(&read()?))})
            }
        });
        Ok(())
    }

    /// The lists by their members' names, but for the materials; and the buffer that the views are of.
    pub(super) fn others(&self) -> Vec<(&'static str, Value)> {
        let lists = [
            ("textures", &self.textures),
            ("images", &self.images),
            ("bufferViews", &self.views),
        ];
        let mut all: Vec<(&str, Value)> = lists
            .into_iter()
            .filter(|(_, list)| !list.is_empty())
            .map(|(key, list)| (key, Value::from(list.clone())))
            .collect();
        if !self.bytes.is_empty() {
            all.push(("buffers", json!([{"byteLength": self.bytes.len()}])));
        }
        all
    }

    /// Gives a document the bytes that its views name.
    pub(super) fn fill(self, source: &mut Source) {
        if !self.bytes.is_empty() {
            (source.container.bin, source.container.is_glb) = (Some(self.bytes), true);
        }
    }
}

/// A dull surface, as OBJ files know no metals.
fn material(own: &Material, texture: Option<usize>) -> Value {
    let [r, g, b] = own.colour;
    let mut model = json!({"baseColorFactor": [r, g, b, own.opacity], "metallicFactor": 0});
    if let Some(texture) = texture {
        model["baseColorTexture"] = json!({"index": texture});
    }
    let mut material = json!({"name": own.name, "pbrMetallicRoughness": model});
    if own.opacity < 1.0 {
        material["alphaMode"] = json!("BLEND");
    }
    material
}

//! Materials of OBJ files as those of a new document: base colours, and pictures in the document or in files.

use super::document::source::Source;
use super::document::uri;
use super::grouped::attributes;
use crate::flaw::{Flaw, Result, shortened};
use crate::format::Format;
use crate::mtl::{Material, Picture};
use crate::output::Output;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::path::Path;

/// A document's members about materials, each list for its member.
#[derive(Default)]
pub(super) struct Looks {
    pub(super) materials: Vec<Value>,
    textures: Vec<Value>,
    images: Vec<Value>,
    views: Vec<Value>,
    /// The bytes that the views name.
    bytes: Vec<u8>,
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
    /// Those of a document that is written to a file.
    pub(super) fn of_file(format: Format) -> Self {
        if format == Format::Glb {
            Self::InChunk
        } else {
            Self::Files
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
        let described = output.and_then(|output| Some((output, output.materials?)));
        let Some((output, found)) = described else {
            looks.materials = names.iter().map(named).collect();
            return Ok(looks);
        };
        let mut has_places = attributes(output).into_iter();
        let has_places = has_places.any(|own| own.name == "TEXCOORD_0");
        // Of several of one name the last holds, as later statements do.
        let materials = found.materials.iter().map(|own| (own.name.as_str(), own));
        let described: HashMap<&str, &Material> = materials.collect();
        let mut textures: HashMap<&Path, usize> = HashMap::new();
        for name in names {
            let Some(own) = described.get(name) else {
                looks.materials.push(named(name));
                continue;
            };
            let mut texture = None;
            let picture = own.picture.as_ref().filter(|_| has_places);
            if let Some(Picture {
                file,
                mime_type: Some(kind),
            }) = picture
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
        let names = file.iter().map(|part| part.to_string_lossy().into_owned());
        let name = names.collect::<Vec<String>>().join("/");
        let read = || {
            std::fs::read(folder.join(file)).map_err(|why| {
                let met = format!("'{}', which cannot be read: {why}", shortened(&name));
                Flaw::new("images", met, "a picture that can be read")
            })
        };
        self.textures.push(json!({"source": self.images.len()}));
        self.images.push(match pictures {
            Pictures::InChunk => {
                self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
                let (start, own) = (self.bytes.len(), read()?);
                let view = json!({"buffer": 0, "byteOffset": start, "byteLength": own.len()});
                self.views.push(view);
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
        let mut all = vec![
            ("textures", Value::from(self.textures.clone())),
            ("images", self.images.clone().into()),
            ("bufferViews", self.views.clone().into()),
        ];
        all.retain(|(_, list)| list.get(0).is_some());
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

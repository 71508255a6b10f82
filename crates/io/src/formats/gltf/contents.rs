//! The contents of a document, for people.

use super::asset::Asset;
use super::document::json::At;
use crate::error::ReadError;
use crate::flaw::Result;
use serde::Serialize;
use std::collections::BTreeMap;

/// The meshes of a glTF document, and how much else it holds.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct AssetContents {
    /// The document's meshes.
    pub meshes: Vec<MeshContents>,
    /// Nodes, materials and so on, by the document's names for them.
    pub counts: BTreeMap<&'static str, usize>,
    /// Extensions that the document uses.
    pub extensions: Vec<String>,
}

/// A mesh of a glTF document.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MeshContents {
    /// Its name in the document.
    pub name: Option<String>,
    /// How often the scene has it.
    pub shown: usize,
    /// Its primitives.
    pub primitives: Vec<PrimitiveContents>,
}

/// A primitive of a mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct PrimitiveContents {
    /// Such as `triangles` or `triangle strip`.
    pub mode: &'static str,
    /// Vertices, as its accessors count them.
    pub vertices: usize,
    /// Indices, or vertices where it has none.
    pub indices: usize,
    /// Names of its attributes.
    pub attributes: Vec<String>,
    /// Morph targets that it has.
    pub morph_targets: usize,
    /// The name of its material, or its number; null without one.
    pub material: Option<String>,
    /// Extensions that it uses, such as compression.
    pub extensions: Vec<String>,
}

const MODES: [&str; 7] = [
    "points",
    "lines",
    "line loop",
    "line strip",
    "triangles",
    "triangle strip",
    "triangle fan",
];

impl Asset {
    /// The meshes of the document, and how much else it holds.
    ///
    /// # Errors
    /// Something that should be a number, an array or an object is none.
    pub fn contents(&self) -> std::result::Result<AssetContents, ReadError> {
        self.read_contents().map_err(|flaw| self.in_file(flaw))
    }

    fn read_contents(&self) -> Result<AssetContents> {
        let root = self.source.root();
        let mut contents = AssetContents::default();
        for (i, mesh) in root.list("meshes")?.iter().enumerate() {
            let primitives = mesh.list("primitives")?;
            let primitives = primitives.iter().map(|at| self.primitive_contents(at));
            contents.meshes.push(MeshContents {
                name: mesh.name().map(str::to_owned),
                primitives: primitives.collect::<Result<_>>()?,
                shown: self.scene.shown(i).count(),
            });
        }
        for key in [
            "nodes",
            "materials",
            "images",
            "skins",
            "animations",
            "cameras",
        ] {
            let count = root.list(key)?.len();
            if count > 0 {
                contents.counts.insert(key, count);
            }
        }
        for name in root.list("extensionsUsed")? {
            contents.extensions.push(name.text()?.to_owned());
        }
        Ok(contents)
    }

    fn primitive_contents(&self, at: &At<'_>) -> Result<PrimitiveContents> {
        let root = self.source.root();
        let count = |accessor: At<'_>| {
            let found = accessor.item_of(&root, "accessors")?.require("count")?;
            found.count()
        };
        let names = |at: At<'_>| Ok(at.members()?.map(|(name, _)| name.to_owned()).collect());
        let attributes = at.require("attributes")?;
        let vertices = attributes.get("POSITION").map_or(Ok(0), count)?;
        let material = match at.get("material") {
            None => None,
            Some(at) => {
                let material = at.item_of(&root, "materials")?;
                Some(material.name().unwrap_or(material.place()).to_owned())
            }
        };
        let mode = at.count_or("mode", 4)?;
        Ok(PrimitiveContents {
            mode: MODES.get(mode).copied().unwrap_or("of an unknown mode"),
            vertices,
            indices: at.get("indices").map_or(Ok(vertices), count)?,
            attributes: names(attributes)?,
            morph_targets: at.list("targets")?.len(),
            material,
            extensions: at.get("extensions").map_or_else(|| Ok(Vec::new()), names)?,
        })
    }
}

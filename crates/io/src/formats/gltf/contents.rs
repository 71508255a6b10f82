//! What a document holds, for people.

use super::asset::Asset;
use super::document::json::At;
use crate::error::ReadError;
use crate::flaw::Result;

/// What a document holds, for people.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Contents {
    /// All meshes.
    pub meshes: Vec<MeshContents>,
    /// How many there are of other things, such as `nodes`, by the document's own names; those that it has.
    pub counts: Vec<(String, usize)>,
    /// Extensions that the document uses.
    pub extensions: Vec<String>,
}

/// What a mesh holds.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct MeshContents {
    /// Its name, if it has one.
    pub name: Option<String>,
    /// Its primitives.
    pub primitives: Vec<PrimitiveContents>,
    /// How often the scene that is shown has it.
    pub shown: usize,
}

/// What a primitive holds.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct PrimitiveContents {
    /// `triangles`, `triangle strip`, `triangle fan`, `points`, `lines`, `line loop` or `line strip`.
    pub mode: &'static str,
    /// Vertices, as its accessors tell.
    pub vertices: usize,
    /// Indices, or vertices where it has none.
    pub corners: usize,
    /// The names of its attributes.
    pub attributes: Vec<String>,
    /// Number of morph targets.
    pub targets: usize,
    /// The name of its material, or its number; `None` without one.
    pub material: Option<String>,
    /// Extensions, such as compression.
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
    /// What the document holds.
    ///
    /// # Errors
    /// Something that should be a number, an array or an object is none.
    pub fn contents(&self) -> std::result::Result<Contents, ReadError> {
        self.read_contents().map_err(|flaw| self.in_file(flaw))
    }

    fn read_contents(&self) -> Result<Contents> {
        let root = self.source.root();
        let mut contents = Contents::default();
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
                contents.counts.push((key.to_owned(), count));
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
            corners: at.get("indices").map_or(Ok(vertices), count)?,
            attributes: names(attributes)?,
            targets: at.list("targets")?.len(),
            material,
            extensions: at.get("extensions").map_or_else(|| Ok(Vec::new()), names)?,
        })
    }
}

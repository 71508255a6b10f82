//! glTF 2.0: a document is opened, the triangles of its meshes are taken out and replaced, and everything else stays as
//! it was written.
//!
//! ```text
//! file ─▶ Container ─▶ Source ─▶ Primitive ─▶ MeshSoup ─▶ (refinement) ─▶ Geometry ─▶ Appended ─▶ Changes ─▶ files
//!         GLB, text    buffers   accessors    joined                      bytes                   edited text
//! ```
//!
//! An asset is far more than its triangles: nodes, materials, animations, cameras, extras, extensions that nobody here has
//! heard of. So documents are *edited, never written anew*: the JSON text is kept, new buffers, views and accessors are
//! appended to its arrays, and of a primitive only `attributes`, `indices`, `targets` and `mode` change. What says how
//! geometry was stored goes when none is stored so any more, what extensions say of triangles by number goes with these, and bytes that
//! nothing names go from a buffer that is written anew, so that offsets of views change. All other bytes of the text are those that were read. The
//! JSON is read by serde_json, and found again in its text by serde_json's raw values; a crate that has a document model of its own would write that model, not the text.
//!
//! What a document says of itself is not believed: every count, offset and index is checked before room is made for
//! what it names, files are reached below the document's folder only, and a flaw names its place as JavaScript would.

mod accessor;
mod attributes;
mod backs;
mod changes;
mod codecs;
mod container;
mod edit;
mod flaw;
mod fresh;
mod geometry;
mod gone;
mod idle;
mod json;
mod kinds;
mod levels;
mod looks;
mod materials;
mod parts;
mod poses;
mod primitive;
mod rest;
mod scene;
mod scene_channels;
mod source;
mod tangents;
mod unused;
mod uri;
mod write;
mod zeros;

pub use attributes::CornerAttribute;
pub use flaw::GltfFlaw;
pub(crate) use fresh::write_fresh;
pub use geometry::{Geometry, VertexAttribute};
pub use levels::{DetailLevel, write_levels};
pub use materials::{BaseColour, BaseTexture};
pub use parts::{Joining, KeptApart, MeshSoup, Part};
pub use tangents::WithTangents;

use crate::error::ReadError;
use crate::format::Format;
use crate::read::read_all;
use changes::Changes;
use flaw::Result as Flawed;
use limitmesh::PolygonSoup;
use rest::Rest;
use scene::{Placement, Scene};
use scene_channels::SceneChannels;
use source::Source;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// A glTF document with everything that belongs to it.
#[derive(Debug)]
pub struct Asset {
    /// The file, if it was one.
    path: Option<PathBuf>,
    source: Source,
    scene: Scene,
    changes: Changes,
}

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
    /// Opens a `.gltf` or `.glb` file; which of them it is, its content tells.
    ///
    /// # Errors
    /// The file cannot be read, or its JSON, its chunks or its tree of nodes break the rules. Meshes are looked at
    /// when they are asked for.
    pub fn open(path: &Path) -> Result<Self, ReadError> {
        let bytes = read_all(path).map_err(|reason| ReadError::Io {
            path: path.to_owned(),
            reason,
        })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let asset = Self::from_bytes(&bytes, Some(folder)).map_err(|error| error.in_file(path))?;
        Ok(Self {
            path: Some(path.to_owned()),
            ..asset
        })
    }

    /// A document from the bytes of its file, and the folder that files are below which it names; without one it may
    /// name none.
    ///
    /// # Errors
    /// As for [`Self::open`].
    pub fn from_bytes(bytes: &[u8], folder: Option<&Path>) -> Result<Self, ReadError> {
        if bytes.is_empty() {
            return Err(ReadError::Empty {
                path: None,
                format: Format::Gltf,
            });
        }
        let source = Source::parse(bytes, folder)?;
        let scene = source.scene()?;
        Ok(Self {
            path: None,
            source,
            scene,
            changes: Changes::default(),
        })
    }

    /// Number of meshes.
    pub fn mesh_count(&self) -> usize {
        self.scene.placements.len()
    }

    /// A mesh as it is called in messages: `meshes[2] 'Wheel'`.
    pub fn mesh_name(&self, mesh: usize) -> String {
        let meshes = self.source.json.get("meshes");
        let name = meshes.and_then(|all| all.get(mesh)?.get("name")?.as_str());
        name.map_or_else(
            || format!("meshes[{mesh}]"),
            |name| format!("meshes[{mesh}] '{}'", json::shortened(name)),
        )
    }

    /// How many times longer the scene shows a vector of a mesh at most, over all nodes and instances that use it: the
    /// greatest singular value of their matrices; 1 for meshes that no node uses.
    pub fn stretch(&self, mesh: usize) -> f64 {
        self.scene.stretch(mesh)
    }

    /// What the scene does to vectors of a mesh where it shows it largest, by rows: x' = row · x.
    pub fn largest(&self, mesh: usize) -> [[f64; 3]; 3] {
        self.scene.largest(mesh)
    }

    /// The triangles of a mesh, its primitives joined into one soup; none where it has only points and lines.
    ///
    /// # Errors
    /// There is no such mesh, or an accessor breaks the rules; the flaw names it.
    pub fn mesh(&self, mesh: usize, joining: Joining) -> Result<MeshSoup, ReadError> {
        self.mesh_of(mesh, joining, |_| true)
    }

    /// [`Self::mesh`] of some of its primitives, given by their numbers.
    ///
    /// # Errors
    /// As for [`Self::mesh`], also where it is another primitive's accessor.
    pub fn mesh_of(
        &self,
        mesh: usize,
        joining: Joining,
        is_wanted: impl Fn(usize) -> bool,
    ) -> Result<MeshSoup, ReadError> {
        self.read_mesh(mesh, joining, true, is_wanted)
            .map_err(|flaw| self.told(flaw))
    }

    /// A flaw as an error with the file's name.
    fn told(&self, flaw: GltfFlaw) -> ReadError {
        ReadError::Gltf {
            path: self.path.clone(),
            flaw,
        }
    }

    /// A mesh's shape alone.
    fn shape(&self, mesh: usize) -> Result<MeshSoup, ReadError> {
        self.read_mesh(mesh, Joining::Together, false, |_| true)
            .map_err(|flaw| self.told(flaw))
    }

    fn read_mesh(
        &self,
        mesh: usize,
        joining: Joining,
        with_attributes: bool,
        is_wanted: impl Fn(usize) -> bool,
    ) -> Flawed<MeshSoup> {
        let Some(at) = self
            .source
            .root()
            .get("meshes")
            .and_then(|all| all.item(mesh))
        else {
            let expected = format!("a number below {}", self.mesh_count());
            return Err(GltfFlaw::new("meshes", mesh.to_string(), expected));
        };
        let mut primitives = Vec::new();
        for (i, primitive) in at.require("primitives")?.items()?.enumerate() {
            primitives.extend(
                self.source
                    .primitive(&primitive, i, with_attributes)?
                    .filter(|found| !found.triangles.is_empty()),
            );
        }
        parts::join(primitives, joining, is_wanted)
    }

    /// The corners of the box around everything that the scene shows; `None` if it shows no triangles.
    ///
    /// # Errors
    /// As for [`Self::mesh`].
    pub fn bounding_box(&self) -> Result<Option<[[f64; 3]; 2]>, ReadError> {
        let mut found: Option<[[f64; 3]; 2]> = None;
        for mesh in 0..self.mesh_count() {
            let soup = self.shape(mesh)?;
            for placement in self.scene.shown(mesh) {
                for v in 0..soup.soup.positions.len() {
                    let p = self.shown(mesh, placement, &soup, v)?;
                    let [low, high] = found.get_or_insert([p, p]);
                    (0..3).for_each(|i| (low[i], high[i]) = (low[i].min(p[i]), high[i].max(p[i])));
                }
            }
        }
        Ok(found)
    }

    /// Where the scene shows a vertex of a mesh: matrices of nodes, instances and skins may hold anything.
    fn shown(
        &self,
        mesh: usize,
        placement: &Placement,
        soup: &MeshSoup,
        v: usize,
    ) -> Result<[f64; 3], ReadError> {
        let p = placement.apply(soup, v);
        if p.iter().all(|x| x.is_finite()) {
            return Ok(p);
        }
        let name = self.mesh_name(mesh);
        let problem = format!("vertex {v} of {name} is at {p:?}, which are no finite coordinates");
        Err(self.told(GltfFlaw::saying("the scene", problem)))
    }

    /// Everything that the scene shows as one soup in the scene's coordinates, with texture coordinates, colours, names of materials
    /// and other attributes as its channels, and in words what else its meshes have. Texture coordinates run upwards.
    ///
    /// # Errors
    /// As for [`Self::mesh`]; or there are more vertices than can be counted.
    pub fn scene_soup(&self) -> Result<PolygonSoup, ReadError> {
        let mut all = PolygonSoup::default();
        let mut names = BTreeSet::new();
        let mut channels = SceneChannels::default();
        for mesh in 0..self.mesh_count() {
            let own = self.mesh(mesh, Joining::Together)?;
            let materials = self.materials_of(mesh).map_err(|flaw| self.told(flaw))?;
            names.extend(
                own.parts
                    .iter()
                    .flat_map(|part| &part.attributes)
                    .filter_map(|name| left_out(name)),
            );
            names.extend(own.has_targets().then_some("morph targets"));
            for placement in self.scene.shown(mesh) {
                let (first, is_mirrored) = (all.positions.len(), placement.mirrors());
                if own.soup.positions.len() + first > MOST
                    || own.soup.faces.len() + all.faces.len() > MOST
                {
                    let problem = format!(
                        "with all instances there are more than {MOST} vertices or triangles"
                    );
                    return Err(self.told(GltfFlaw::saying("the scene", problem)));
                }
                for v in 0..own.soup.positions.len() {
                    all.positions.push(self.shown(mesh, placement, &own, v)?);
                }
                for face in own.soup.faces.iter() {
                    let mut corners: Vec<u32> = face.iter().map(|&v| v + first as u32).collect();
                    if is_mirrored {
                        corners.reverse();
                    }
                    all.faces.push(&corners);
                }
                channels.add(&own, &materials, placement);
            }
        }
        all.channels = channels
            .into_channels(&self.source)
            .map_err(|flaw| self.told(flaw))?;
        all.left_out = names.into_iter().map(str::to_owned).collect();
        if self.source.json.get("materials").is_some() {
            all.left_out
                .push("colours and textures of materials".to_owned());
        }
        Ok(all)
    }

    /// By primitive of a mesh, the number of its material.
    fn materials_of(&self, mesh: usize) -> Flawed<Vec<Option<usize>>> {
        let root = self.source.root();
        let Some(mesh) = root.get("meshes").and_then(|all| all.item(mesh)) else {
            return Ok(Vec::new());
        };
        let of = |primitive: &json::At<'_>| match primitive.get("material") {
            None => Ok(None),
            Some(material) => Ok(Some(material.item_of(&root, "materials")?.0)),
        };
        mesh.list("primitives")?.iter().map(of).collect()
    }

    /// What the document holds.
    ///
    /// # Errors
    /// Something that should be a number, an array or an object is none.
    pub fn contents(&self) -> Result<Contents, ReadError> {
        self.read_contents().map_err(|flaw| self.told(flaw))
    }

    fn read_contents(&self) -> Flawed<Contents> {
        let root = self.source.root();
        let mut contents = Contents::default();
        for (i, mesh) in root.list("meshes")?.iter().enumerate() {
            let primitives = mesh.list("primitives")?;
            contents.meshes.push(MeshContents {
                name: mesh.name().map(str::to_owned),
                primitives: primitives
                    .iter()
                    .map(|at| self.primitive_contents(at))
                    .collect::<Flawed<_>>()?,
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

    fn primitive_contents(&self, at: &json::At<'_>) -> Flawed<PrimitiveContents> {
        let root = self.source.root();
        let count = |accessor: &json::At<'_>| {
            accessor
                .item_of(&root, "accessors")?
                .1
                .require("count")?
                .count()
        };
        let attributes = at.require("attributes")?;
        let vertices = attributes
            .get("POSITION")
            .map_or(Ok(0), |accessor| count(&accessor))?;
        let mode = at.count_or("mode", 4)?;
        let material = match at.get("material") {
            None => None,
            Some(at) => {
                let (index, material) = at.item_of(&root, "materials")?;
                Some(
                    material
                        .name()
                        .map_or_else(|| format!("materials[{index}]"), str::to_owned),
                )
            }
        };
        let names =
            |at: &json::At<'_>| Ok(at.members()?.map(|(name, _)| name.to_owned()).collect());
        Ok(PrimitiveContents {
            mode: MODES.get(mode).copied().unwrap_or("of an unknown mode"),
            vertices,
            corners: at
                .get("indices")
                .map_or(Ok(vertices), |accessor| count(&accessor))?,
            attributes: names(&attributes)?,
            targets: at.list("targets")?.len(),
            material,
            extensions: at
                .get("extensions")
                .map_or_else(|| Ok(Vec::new()), |at| names(&at))?,
        })
    }

    /// Replaces the triangles of a mesh's primitive; its material, extras and extensions stay, but for those that say something of
    /// the triangles and vertices that it had.
    ///
    /// # Errors
    /// The geometry does not fit together, or has numbers that 32-bit floats cannot hold.
    pub fn replace(
        &mut self,
        mesh: usize,
        primitive: usize,
        geometry: &Geometry<'_>,
    ) -> Result<(), GltfFlaw> {
        let place = format!("meshes[{mesh}].primitives[{primitive}]");
        let new = self.changes.appended.add(geometry, &place)?;
        self.changes.primitives.insert((mesh, primitive), new);
        Ok(())
    }

    /// The names of extensions that said something of triangles and vertices that were replaced, and go with these when the document is
    /// written.
    pub fn left_out(&self) -> Vec<String> {
        Rest::of(&self.source.json, &self.changes)
            .left_out
            .into_iter()
            .collect()
    }
}

/// An attribute that a soup of the scene hasn't, in words.
fn left_out(attribute: &str) -> Option<&'static str> {
    match attribute
        .split_once('_')
        .map_or(attribute, |(kind, _)| kind)
    {
        "NORMAL" => Some("normals"),
        "TANGENT" => Some("tangents"),
        "JOINTS" | "WEIGHTS" => Some("joints and weights"),
        _ => None,
    }
}

/// Vertices or faces at most of a soup.
const MOST: usize = u32::MAX as usize;

impl From<GltfFlaw> for ReadError {
    fn from(flaw: GltfFlaw) -> Self {
        Self::Gltf { path: None, flaw }
    }
}

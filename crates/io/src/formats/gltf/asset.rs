//! A document with everything that belongs to it: its meshes, where the scene shows them, and their replacement.

use super::document::json::At;
use super::document::source::Source;
use super::edit::geometry::{Changes, Geometry, PrimitiveAddress};
use super::edit::rest::Rest;
use super::read::Joining;
use super::read::materials::BaseColour;
use super::read::parts::{self, MeshSoup};
use super::read::scene::{Placement, Scene};
use super::read::scene_channels::SceneChannels;
use crate::affine::bounding_box;
use crate::content::looks_like_other;
use crate::error::ReadError;
use crate::files::{folder_of, read_all};
use crate::flaw::{self, Flaw, shortened};
use crate::format::Format;
use crate::reading::MOST;
use limitmesh::PolygonSoup;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// A glTF document with everything that belongs to it.
#[derive(Debug)]
pub struct Asset {
    /// The file, if it was one.
    pub(super) path: Option<PathBuf>,
    pub(super) source: Source,
    pub(super) scene: Scene,
    pub(super) changes: Changes,
}

impl Asset {
    /// Opens a `.gltf` or `.glb` file; which of them it is, its content says.
    ///
    /// # Errors
    /// The file cannot be read, or its JSON, its chunks or its tree of nodes break the rules. Meshes are looked at
    /// when they are asked for.
    pub fn open(path: &Path) -> Result<Self, ReadError> {
        let asset = Self::from_bytes(&read_all(path)?, Some(folder_of(path)));
        let asset = asset.map_err(|error| error.in_file(path))?;
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
        let format = Format::Gltf;
        if bytes.is_empty() {
            return Err(ReadError::Empty { path: None, format });
        }
        if let Some(looks_like) = looks_like_other(bytes, format) {
            return Err(ReadError::OtherContent {
                path: None,
                format,
                looks_like,
            });
        }
        let asset = Source::parse(bytes, folder).and_then(|source| Self::of(None, source));
        asset.map_err(|flaw| flaw.read_as(format))
    }

    /// The document of a source, which a file has.
    pub(super) fn of(path: Option<PathBuf>, source: Source) -> flaw::Result<Self> {
        let scene = source.scene()?;
        Ok(Self {
            path,
            source,
            scene,
            changes: Changes::default(),
        })
    }

    /// Number of meshes.
    pub fn mesh_count(&self) -> usize {
        self.scene.placements.len()
    }

    fn mesh_at(&self, mesh: usize) -> Option<At<'_>> {
        self.source.root().get("meshes")?.item(mesh)
    }

    /// A mesh as it is called in messages: `meshes[2] 'Wheel'`.
    pub fn mesh_name(&self, mesh: usize) -> String {
        let at = self.mesh_at(mesh);
        let found = at.as_ref().and_then(At::name);
        let name = found.map(|name| format!(" '{}'", shortened(name)));
        format!("meshes[{mesh}]{}", name.unwrap_or_default())
    }

    /// How many times longer the scene shows a vector of a mesh at most, over all nodes and instances that use it: the
    /// greatest singular value of their matrices; 1 for meshes that no node uses.
    pub fn stretch(&self, mesh: usize) -> f64 {
        self.scene.stretch(mesh)
    }

    /// The linear map of a mesh's vectors in the scene, where it is largest, by rows: x' = row · x.
    pub fn largest(&self, mesh: usize) -> [[f64; 3]; 3] {
        self.scene.largest(mesh)
    }

    /// The faces of a mesh, its primitives joined into one soup; none where it has only points and lines. They are triangles, and
    /// polygons where `FB_ngon_encoding` or `EXT_mesh_polygon` has some.
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
        self.read_mesh(mesh, joining, [true, true], is_wanted)
            .map_err(|flaw| self.in_file(flaw))
    }

    /// [`Self::mesh_of`] with the triangles that the document cuts polygons into.
    ///
    /// # Errors
    /// As for [`Self::mesh_of`].
    pub fn triangles_of(
        &self,
        mesh: usize,
        joining: Joining,
        is_wanted: impl Fn(usize) -> bool,
    ) -> Result<MeshSoup, ReadError> {
        self.read_mesh(mesh, joining, [true, false], is_wanted)
            .map_err(|flaw| self.in_file(flaw))
    }

    /// A flaw as an error with the file's name.
    pub(super) fn in_file(&self, flaw: Flaw) -> ReadError {
        ReadError::Flaw {
            path: self.path.clone(),
            format: Format::Gltf,
            flaw,
        }
    }

    fn read_mesh(
        &self,
        mesh: usize,
        joining: Joining,
        [with_attributes, with_polygons]: [bool; 2],
        is_wanted: impl Fn(usize) -> bool,
    ) -> flaw::Result<MeshSoup> {
        let Some(at) = self.mesh_at(mesh) else {
            let expected = format!("a number below {}", self.mesh_count());
            return Err(Flaw::new("meshes", mesh, expected));
        };
        let mut primitives = Vec::new();
        for (i, primitive) in at.require("primitives")?.items()?.enumerate() {
            let source = &self.source;
            let found = source.primitive(&primitive, i, with_attributes, with_polygons)?;
            primitives.extend(found.filter(|found| !found.faces.is_empty()));
        }
        parts::join(primitives, joining, is_wanted)
    }

    /// The corners of the box around everything that the scene shows; `None` if it shows no triangles.
    ///
    /// # Errors
    /// As for [`Self::mesh`].
    pub fn bounding_box(&self) -> Result<Option<[[f64; 3]; 2]>, ReadError> {
        let mut corners = Vec::new();
        for mesh in 0..self.mesh_count() {
            let own = self.read_mesh(mesh, Joining::Together, [false, true], |_| true);
            let own = own.map_err(|flaw| self.in_file(flaw))?;
            for placement in self.scene.shown(mesh) {
                let points = self.shown(mesh, placement, &own)?;
                corners.extend(bounding_box(points).into_iter().flatten());
            }
        }
        Ok(bounding_box(corners))
    }

    /// Where the scene shows the vertices of a mesh: matrices of nodes, instances and skins may hold anything.
    fn shown(
        &self,
        mesh: usize,
        placement: &Placement,
        own: &MeshSoup,
    ) -> Result<Vec<[f64; 3]>, ReadError> {
        let points = (0..own.soup.positions.len()).map(|v| {
            let p = placement.apply(own, v);
            if p.iter().all(|x| x.is_finite()) {
                return Ok(p);
            }
            let name = self.mesh_name(mesh);
            let problem =
                format!("vertex {v} of {name} is at {p:?}, which are no finite coordinates");
            Err(self.in_file(Flaw::saying("the scene", problem)))
        });
        points.collect()
    }

    /// Everything that the scene shows as one soup in the scene's coordinates, with texture coordinates, colours, names of materials
    /// and other attributes as its channels, and in words what else its meshes have. Texture coordinates run upwards.
    ///
    /// # Errors
    /// As for [`Self::mesh`]; or there are more vertices than can be counted.
    pub fn scene_soup(&self) -> Result<PolygonSoup, ReadError> {
        self.scene_of(|mesh| self.mesh(mesh, Joining::Together))
    }

    /// [`Self::scene_soup`] with the triangles that the document cuts polygons into.
    ///
    /// # Errors
    /// As for [`Self::scene_soup`].
    pub fn scene_triangles(&self) -> Result<PolygonSoup, ReadError> {
        self.scene_of(|mesh| self.triangles_of(mesh, Joining::Together, |_| true))
    }

    fn scene_of(
        &self,
        read: impl Fn(usize) -> Result<MeshSoup, ReadError>,
    ) -> Result<PolygonSoup, ReadError> {
        let mut all = PolygonSoup::default();
        let mut names = BTreeSet::new();
        let (mut channels, mut as_triangles) = (SceneChannels::default(), 0);
        for mesh in 0..self.mesh_count() {
            let own = read(mesh)?;
            let materials = self.materials_of(mesh).map_err(|flaw| self.in_file(flaw))?;
            let attributes = own.parts.iter().flat_map(|part| &part.attributes);
            names.extend(attributes.filter_map(|name| left_out(name)));
            names.extend(own.has_targets().then_some("morph targets"));
            as_triangles += own.as_triangles;
            for placement in self.scene.shown(mesh) {
                let first = all.positions.len();
                let faces = own.soup.faces.len() + all.faces.len();
                if (own.soup.positions.len() + first).max(faces) > MOST {
                    let problem = format!(
                        "with all instances there are more than {MOST} vertices or triangles"
                    );
                    return Err(self.in_file(Flaw::saying("the scene", problem)));
                }
                all.positions.extend(self.shown(mesh, placement, &own)?);
                for face in own.soup.faces.iter() {
                    let mut corners: Vec<u32> = face.iter().map(|&v| v + first as u32).collect();
                    if placement.mirrors() {
                        corners.reverse();
                    }
                    all.faces.push(&corners);
                }
                channels.add(&own, &materials, placement);
            }
        }
        let channels = channels.into_channels(&self.source);
        all.channels = channels.map_err(|flaw| self.in_file(flaw))?;
        all.left_out = names.into_iter().map(str::to_owned).collect();
        all.left_out.extend(parts::cut_polygons(as_triangles));
        if self.source.json.get("materials").is_some() {
            all.left_out
                .push("colours and textures of materials".to_owned());
        }
        Ok(all)
    }

    /// By primitive of a mesh, the number of its material.
    fn materials_of(&self, mesh: usize) -> flaw::Result<Vec<Option<usize>>> {
        let root = self.source.root();
        let Some(mesh) = self.mesh_at(mesh) else {
            return Ok(Vec::new());
        };
        let of = |primitive: &At<'_>| {
            let found = primitive.get("material");
            found
                .map(|own| own.number_in(&root, "materials"))
                .transpose()
        };
        mesh.list("primitives")?.iter().map(of).collect()
    }

    /// The base colours of all materials, by the numbers that channels give them.
    ///
    /// # Errors
    /// A material, a texture or an image breaks the rules, or a picture's file cannot be read.
    pub fn base_colours(&self) -> Result<Vec<BaseColour>, ReadError> {
        let found = self.source.base_colours();
        found.map_err(|flaw| self.in_file(flaw))
    }

    /// The name of the texture coordinates by which a primitive's normal map lies, and so its tangents: those that its material names, or
    /// the first.
    ///
    /// # Errors
    /// There is no such primitive, or its material breaks the rules.
    pub fn tangent_coordinates(&self, mesh: usize, primitive: usize) -> Result<String, ReadError> {
        let set = self
            .materials_of(mesh)
            .and_then(|all| match all.get(primitive) {
                Some(Some(material)) => self.source.tangent_set(*material),
                _ => Ok(0),
            });
        set.map(|set| format!("TEXCOORD_{set}"))
            .map_err(|flaw| self.in_file(flaw))
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
    ) -> Result<(), Flaw> {
        let place = format!("meshes[{mesh}].primitives[{primitive}]");
        let new = self.changes.appended.add(geometry, &place)?;
        self.changes
            .primitives
            .insert(PrimitiveAddress { mesh, primitive }, new);
        Ok(())
    }

    /// The names of extensions that said something of triangles and vertices that were replaced, and go with these when the document is
    /// written.
    pub fn left_out(&self) -> Vec<String> {
        let found = Rest::of(&self.source.json, &self.changes).left_out;
        found.into_iter().collect()
    }
}

/// An attribute that a soup of the scene does not have, in words.
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

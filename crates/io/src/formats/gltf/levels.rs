//! Levels of detail in one document: a mesh and a node for each, the finest in the scene and the others named by it
//! (`MSFT_lod`, with `MSFT_screencoverage` for the sizes in the picture at which they take turns).
//!
//! Programs that do not know the extension show the finest level. How a level grows out of the coarser one is its morph target: at weight
//! 1 it is the coarser level, at weight 0, which is what a program shows that does not know of it, itself.

use super::asset::Asset;
use super::document::extensions::LOD;
use super::document::source::Source;
use super::document::text::{Members, quoted};
use super::fresh::{Coarser, empty, fill, scale_to_metres};
use super::gone::Gone;
use super::grouped::{Groups, capacity};
use super::looks::{Looks, Pictures};
use crate::error::WriteError;
use crate::flaw::Result;
use crate::format::Format;
use crate::output::Output;
use crate::unit::LengthUnit;
use serde_json::{Value, json};
use std::path::Path;

/// A level of detail.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct DetailLevel<'a> {
    /// Its triangles, normals and channels.
    pub output: Output<'a>,
    /// By vertex, its place on the coarser level and the normal that it is shaded with there, of any length.
    pub coarser: Option<[&'a [[f64; 3]]; 2]>,
    /// The least height of the object in a picture, as a part of the picture's, at which the level is shown.
    pub least_coverage: f64,
}

impl<'a> DetailLevel<'a> {
    /// A level that is shown at any size.
    pub fn new(output: Output<'a>) -> Self {
        Self {
            output,
            coarser: None,
            least_coverage: 0.0,
        }
    }

    /// Sets [`Self::coarser`].
    pub fn coarser(mut self, positions: &'a [[f64; 3]], normals: &'a [[f64; 3]]) -> Self {
        self.coarser = Some([positions, normals]);
        self
    }

    /// Sets [`Self::least_coverage`].
    pub fn least_coverage(mut self, coverage: f64) -> Self {
        self.least_coverage = coverage;
        self
    }

    /// Checks that its parts fit together and into the format.
    fn check(&self, format: Format) -> std::result::Result<(), WriteError> {
        capacity().check(&self.output, format)?;
        let elements = self.output.surface.positions.len();
        for (own, what) in self
            .coarser
            .into_iter()
            .flatten()
            .zip(["places", "normals"])
        {
            if own.len() != elements {
                let what = format!("{} {what} on the coarser level", own.len());
                let problem = format!("there are {what} for {elements} vertices: each needs one");
                return Err(WriteError::Unfit { problem });
            }
        }
        Ok(())
    }
}

/// Writes levels of detail, the finest first, as one document, whose nodes and meshes are called `name` with `_LOD0` and so on. With the
/// asset that the levels were made of, its materials, textures and images come along, and the bytes that something may name; not its nodes,
/// skins, animations and cameras, nor extensions that name them. Where the unit of the numbers is known, nodes scale them to metres.
///
/// # Errors
/// The levels do not fit together, or have numbers that 32-bit floats cannot hold; or the system refuses.
pub fn write_levels(
    path: &Path,
    format: Format,
    name: &str,
    levels: &[DetailLevel<'_>],
    of: Option<&Asset>,
    unit: Option<LengthUnit>,
) -> std::result::Result<(), WriteError> {
    levels.iter().try_for_each(|level| level.check(format))?;
    let groups = levels.iter().map(|level| Groups::of(&level.output));
    let groups: Vec<Groups> = groups.collect();
    let written = Document {
        name,
        levels,
        groups: &groups,
        of,
        unit,
    };
    let mut asset = written.asset(Pictures::of_file(format))?;
    for (mesh, (level, groups)) in levels.iter().zip(&groups).enumerate() {
        let coarser = level
            .coarser
            .map(|[positions, normals]| Coarser { positions, normals });
        fill(&mut asset, mesh, groups, &level.output, coarser)?;
    }
    asset.write(path, format).map(drop)
}

/// The document before geometry is put into it.
struct Document<'a> {
    name: &'a str,
    levels: &'a [DetailLevel<'a>],
    groups: &'a [Groups],
    of: Option<&'a Asset>,
    unit: Option<LengthUnit>,
}

impl<'a> Document<'a> {
    fn asset(&self, pictures: Pictures) -> Result<Asset> {
        // An asset has pictures of its own.
        let finest = self.levels.first().map(|level| &level.output);
        let finest = finest.filter(|_| self.of.is_none());
        let mut materials: Vec<&str> = Vec::new();
        let meshes = self.meshes(&mut materials)?;
        let looks = Looks::of(&materials, finest, pictures)?;
        let text = self.text(meshes, &looks)?;
        let folder = match self.of {
            Some(asset) => asset.source.folder(),
            None => finest
                .and_then(|own| own.materials)
                .map(|found| found.folder.as_path()),
        };
        let mut source = Source::parse(text.as_bytes(), folder)?;
        looks.fill(&mut source);
        if let Some(asset) = self.of {
            let own = &asset.source.container;
            (source.container.bin, source.container.is_glb) = (own.bin.clone(), own.is_glb);
        }
        Asset::of(self.of.and_then(|asset| asset.path.clone()), source)
    }

    /// A mesh for each level. `materials` are those that the asset does not have, which come after its own.
    fn meshes(&self, materials: &mut Vec<&'a str>) -> Result<Vec<Value>> {
        let known = match self.of {
            Some(asset) => asset.source.root().list("materials")?.len(),
            None => 0,
        };
        let mut number = |material: &'a str, label: usize| {
            // Labels of a scene's soup are one more than the numbers of its materials.
            if (1..=known).contains(&label) {
                return label - 1;
            }
            let at = materials.iter().position(|known| *known == material);
            known
                + at.unwrap_or_else(|| {
                    materials.push(material);
                    materials.len() - 1
                })
        };
        let name = self.name;
        let meshes = self
            .levels
            .iter()
            .zip(self.groups)
            .enumerate()
            .map(|(i, (level, groups))| {
                let primitive = |(material, &label): (&'a String, &usize)| {
                    let mut primitive = json!({"attributes": {}});
                    if !material.is_empty() {
                        primitive["material"] = number(material, label).into();
                    }
                    primitive
                };
                let primitives = groups.names.iter().zip(&groups.labels).map(primitive);
                let primitives: Vec<Value> = primitives.collect();
                let mut mesh = json!({"name": format!("{name}_LOD{i}"), "primitives": primitives});
                if level.coarser.is_some() {
                    mesh["weights"] = json!([0.0]);
                    mesh["extras"] = json!({"targetNames": ["coarser"]});
                }
                mesh
            });
        Ok(meshes.collect())
    }

    /// A node for each mesh, of which the first names the others.
    fn nodes(&self) -> Vec<Value> {
        let node = |i: usize| {
            let mut node = json!({"name": format!("{}_LOD{i}", self.name), "mesh": i});
            scale_to_metres(&mut node, self.unit);
            node
        };
        let mut nodes: Vec<Value> = (0..self.levels.len()).map(node).collect();
        if self.levels.len() > 1 {
            let coverage: Vec<f64> = self.levels.iter().map(|own| own.least_coverage).collect();
            let others: Vec<usize> = (1..self.levels.len()).collect();
            nodes[0]["extensions"] = json!({ LOD: {"ids": others} });
            nodes[0]["extras"] = json!({ "MSFT_screencoverage": coverage });
        }
        nodes
    }

    fn text(&self, meshes: Vec<Value>, looks: &Looks) -> Result<String> {
        let empty = empty().to_string();
        let text = self.of.map_or(&empty, |asset| &asset.source.container.text);
        let top = Members::of(text)?;
        let gone = self
            .of
            .map_or_else(Gone::default, |asset| Gone::of(&asset.source.json));
        let array =
            |items: Vec<String>| (!items.is_empty()).then(|| format!("[{}]", items.join(",")));
        let of_values = |items: Vec<Value>| Some(Value::from(items).to_string());
        let list = |key: &str, new: Option<String>| -> Result<Option<String>> {
            let is_left = |item: &&str| !gone.names.iter().any(|name| **item == quoted(name));
            let old = top.items(key)?.into_iter().filter(is_left);
            let mut all: Vec<String> = old.map(str::to_owned).collect();
            let new = new.filter(|item| !all.contains(item));
            all.extend(new);
            Ok(array(all))
        };
        let used = (self.levels.len() > 1).then(|| quoted(LOD));
        let all = top.items("materials")?.into_iter().map(str::to_owned);
        let mut materials: Vec<String> = all.collect();
        materials.extend(looks.materials.iter().map(Value::to_string));
        let mut changes = vec![
            ("scene", Some("0".to_owned())),
            ("scenes", Some(r#"[{"nodes":[0]}]"#.to_owned())),
            ("nodes", of_values(self.nodes())),
            ("meshes", of_values(meshes)),
            ("materials", array(materials)),
            ("extensionsUsed", list("extensionsUsed", used)?),
            ("extensionsRequired", list("extensionsRequired", None)?),
            ("extensions", gone.left_of_root(&top)?),
            ("skins", None),
            ("animations", None),
            ("cameras", None),
        ];
        let others = looks.others().into_iter();
        changes.extend(others.map(|(key, value)| (key, Some(value.to_string()))));
        Ok(top.with(&changes))
    }
}

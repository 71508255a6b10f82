//! Levels of detail in one document: a mesh and a node for each, the finest in the scene and the others named by it
//! (`MSFT_lod`, with `MSFT_screencoverage` for the sizes in the picture at which they take turns).
//!
//! Programs that do not know the extension show the finest level. How a level grows out of the coarser one is its morph target: at weight
//! 1 it is the coarser level, at weight 0, which is what a program shows that does not know of it, itself.

use std::path::Path;

use serde_json::{Value, json};

use super::Asset;
use super::changes::Changes;
use super::edit::{Members, items_of, quoted};
use super::flaw::Result;
use super::fresh::{Groups, empty, fill, scale_to_metres};
use super::gone::Gone;
use super::looks::{Looks, Pictures};
use super::source::Source;
use crate::error::WriteError;
use crate::format::Format;
use crate::threemf::LengthUnit;
use crate::write::{Output, WriteOptions, check};

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
    fn check(&self, format: Format) -> core::result::Result<(), WriteError> {
        check(&self.output, format, &WriteOptions::default())?;
        let vertices = self.output.surface.positions.len();
        let [places, normals] = self
            .coarser
            .map_or([vertices; 2], |own| own.map(<[_]>::len));
        for (what, count) in [
            ("places on the coarser level", places),
            ("normals on the coarser level", normals),
        ] {
            if count != vertices {
                return Err(WriteError::AttributeCount {
                    what,
                    count,
                    vertices,
                });
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
    (name, levels): (&str, &[DetailLevel<'_>]),
    of: Option<&Asset>,
    unit: Option<LengthUnit>,
) -> core::result::Result<(), WriteError> {
    let flawed = |flaw| WriteError::Gltf { flaw };
    levels.iter().try_for_each(|level| level.check(format))?;
    let groups: Vec<Groups> = levels
        .iter()
        .map(|level| Groups::of(&level.output))
        .collect();
    let pictures = Pictures::of(format, Some(path));
    let mut asset = document((name, levels), &groups, of, unit, pictures).map_err(flawed)?;
    for (mesh, (level, groups)) in levels.iter().zip(&groups).enumerate() {
        fill(&mut asset, mesh, groups, &level.output, level.coarser).map_err(flawed)?;
    }
    asset.write(path, format).map(drop)
}

/// The document that geometry is put into.
fn document(
    (name, levels): (&str, &[DetailLevel<'_>]),
    groups: &[Groups],
    of: Option<&Asset>,
    unit: Option<LengthUnit>,
    pictures: Pictures,
) -> Result<Asset> {
    let known = of
        .map_or_else(
            || Ok(Vec::new()),
            |asset| asset.source.root().list("materials"),
        )?
        .len();
    let mut materials: Vec<&str> = Vec::new();
    let mut meshes: Vec<Value> = Vec::new();
    for (i, (level, groups)) in levels.iter().zip(groups).enumerate() {
        let mut primitives: Vec<Value> = Vec::new();
        for (material, &label) in groups.names.iter().zip(&groups.labels) {
            let mut primitive = json!({"attributes": {}});
            // Labels of a scene's soup are one more than the numbers of its materials.
            let own = (1..=known).contains(&label).then(|| label - 1);
            let fresh = || {
                let at = materials.iter().position(|known| known == material);
                known
                    + at.unwrap_or_else(|| {
                        materials.push(material);
                        materials.len() - 1
                    })
            };
            if !material.is_empty() {
                primitive["material"] = own.unwrap_or_else(fresh).into();
            }
            primitives.push(primitive);
        }
        let mut mesh = json!({"name": format!("{name}_LOD{i}"), "primitives": primitives});
        if level.coarser.is_some() {
            mesh["weights"] = json!([0.0]);
            mesh["extras"] = json!({"targetNames": ["coarser"]});
        }
        meshes.push(mesh);
    }
    let named = |i: usize| {
        let mut node = json!({"name": format!("{name}_LOD{i}"), "mesh": i});
        scale_to_metres(&mut node, unit);
        node
    };
    let mut nodes: Vec<Value> = (0..levels.len()).map(named).collect();
    if levels.len() > 1 {
        let coverage: Vec<f64> = levels.iter().map(|level| level.least_coverage).collect();
        nodes[0]["extensions"] =
            json!({"MSFT_lod": {"ids": (1..levels.len()).collect::<Vec<_>>()}});
        nodes[0]["extras"] = json!({ "MSFT_screencoverage": coverage });
    }
    // An asset has pictures of its own.
    let finest = levels
        .first()
        .map(|level| &level.output)
        .filter(|_| of.is_none());
    let looks = Looks::of(&materials, finest, pictures)?;
    let fresh: Vec<String> = looks.materials.iter().map(Value::to_string).collect();
    let empty = empty().to_string();
    let text = of.map_or(&empty, |asset| &asset.source.container.text);
    let top = Members::of(text)?;
    let gone = of.map_or_else(Gone::default, |asset| Gone::of(&asset.source.json));
    let list = |key: &str, new: Vec<String>| -> Result<Option<String>> {
        let old = top.get(key).map_or_else(|| Ok(Vec::new()), items_of)?;
        let is_left = |item: &&str| {
            key == "materials" || !gone.names.iter().any(|name| **item == quoted(name))
        };
        let mut all: Vec<String> = old.into_iter().filter(is_left).map(str::to_owned).collect();
        let new: Vec<String> = new
            .into_iter()
            .filter(|item| key == "materials" || !all.contains(item))
            .collect();
        all.extend(new);
        Ok((!all.is_empty()).then(|| format!("[{}]", all.join(","))))
    };
    let used = if levels.len() > 1 {
        vec![quoted(LOD)]
    } else {
        Vec::new()
    };
    let array = |items: Vec<Value>| Some(Value::from(items).to_string());
    let mut changes = vec![
        ("scene", Some("0".to_owned())),
        ("scenes", Some(r#"[{"nodes":[0]}]"#.to_owned())),
        ("nodes", array(nodes)),
        ("meshes", array(meshes)),
        ("materials", list("materials", fresh)?),
        ("extensionsUsed", list("extensionsUsed", used)?),
        (
            "extensionsRequired",
            list("extensionsRequired", Vec::new())?,
        ),
        ("extensions", gone.left_of_root(&top)?),
        ("skins", None),
        ("animations", None),
        ("cameras", None),
    ];
    changes.extend(
        looks
            .others()
            .into_iter()
            .map(|(key, value)| (key, Some(value.to_string()))),
    );
    let folder = match of {
        Some(asset) => asset.source.folder(),
        None => finest
            .and_then(|output| output.materials)
            .map(|found| found.folder.as_path()),
    };
    let mut source = Source::parse(top.with(&changes).as_bytes(), folder)?;
    looks.fill(&mut source);
    if let Some(asset) = of {
        let own = &asset.source.container;
        (source.container.bin, source.container.is_glb) = (own.bin.clone(), own.is_glb);
    }
    let scene = source.scene()?;
    Ok(Asset {
        path: of.and_then(|asset| asset.path.clone()),
        source,
        scene,
        changes: Changes::default(),
    })
}

/// The extension.
pub(super) const LOD: &str = "MSFT_lod";

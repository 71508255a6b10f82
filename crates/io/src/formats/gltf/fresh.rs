//! A document of one mesh, for triangles that come from no document: with texture coordinates, colours, numbers of vertices and
//! corners, and a primitive for each material, of which the name is known.

use super::asset::Asset;
use super::document::source::Source;
use super::edit::geometry::{Geometry, VertexAttribute};
use super::grouped::{Groups, Part, attributes, nowhere};
use super::looks::{Looks, Pictures};
use crate::error::WriteError;
use crate::flaw::Result;
use crate::format::Format;
use crate::output::{Output, WriteOptions};
use crate::unit::LengthUnit;
use crate::whole::write_in_pieces;
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;

/// Writes triangles with their normals and channels to a file.
pub(super) fn write_file(
    path: &Path,
    format: Format,
    output: &Output<'_>,
    options: &WriteOptions,
) -> std::result::Result<(), WriteError> {
    let asset = document(output, options.unit, Pictures::of_file(format))?;
    asset.write(path, format).map(drop)
}

/// Writes triangles with their normals and channels as one file.
pub(super) fn write(
    writer: &mut dyn Write,
    format: Format,
    output: &Output<'_>,
    options: &WriteOptions,
) -> std::result::Result<(), WriteError> {
    let is_glb = format == Format::Glb;
    let pictures = if is_glb {
        Pictures::InChunk
    } else {
        Pictures::InText
    };
    let asset = document(output, options.unit, pictures)?;
    Ok(write_in_pieces(writer, &asset.to_bytes(format)?)?)
}

fn document(output: &Output<'_>, unit: Option<LengthUnit>, pictures: Pictures) -> Result<Asset> {
    let groups = Groups::of(output);
    let all = groups.names.iter().map(String::as_str);
    let names = all.filter(|name| !name.is_empty());
    let names: Vec<&str> = names.collect();
    let looks = Looks::of(&names, Some(output), pictures)?;
    let folder = output.materials.map(|found| found.folder.as_path());
    let text = text(&groups, unit, &looks).to_string();
    let mut source = Source::parse(text.as_bytes(), folder)?;
    looks.fill(&mut source);
    let mut asset = Asset::of(None, source)?;
    fill(&mut asset, 0, &groups, output, None)?;
    Ok(asset)
}

/// Where vertices are on a coarser level of detail.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coarser<'a> {
    pub(super) positions: &'a [[f64; 3]],
    /// The normals that they are shaded with there, of any length.
    pub(super) normals: &'a [[f64; 3]],
}

/// Puts triangles into the primitives of a mesh, one for each material; with their vertices' places and normals on a coarser level of
/// detail as a morph target.
pub(super) fn fill(
    asset: &mut Asset,
    mesh: usize,
    groups: &Groups,
    output: &Output<'_>,
    coarser: Option<Coarser<'_>>,
) -> Result<()> {
    let channels = attributes(output);
    let mut known = nowhere(output);
    for (primitive, triangles) in groups.triangles.iter().enumerate() {
        let own = Part::of(output, &channels, triangles, &mut known);
        let at = |points: &[[f64; 3]]| -> Vec<[f64; 3]> {
            own.vertices.iter().map(|&v| points[v as usize]).collect()
        };
        // Where vertices have several normals, the writer is given a vertex for each.
        let positions = at(output.surface.positions);
        let normals = output.vertex_normals().map(at);
        let mut targets = Vec::new();
        if let Some(coarser) = coarser {
            let mut target = vec![displaced("POSITION", &positions, &at(coarser.positions))];
            let shaded = normals
                .iter()
                .map(|own| displaced("NORMAL", own, &at(coarser.normals)));
            target.extend(shaded);
            targets.push(target);
        }
        let geometry = Geometry {
            positions: &positions,
            normals: normals.as_deref(),
            triangles: &own.triangles,
            attributes: &own.attributes,
            targets: &targets,
        };
        asset.replace(mesh, primitive, &geometry)?;
    }
    Ok(())
}

/// The displacements of a morph target.
fn displaced(name: &str, from: &[[f64; 3]], to: &[[f64; 3]]) -> VertexAttribute {
    let added = from
        .iter()
        .zip(to)
        .flat_map(|(from, to)| [0, 1, 2].map(|i| to[i] - from[i]));
    VertexAttribute::new(name, 3, added.collect())
}

/// A document that holds nothing.
pub(super) fn empty() -> Value {
    let generator = concat!("limitmesh ", env!("CARGO_PKG_VERSION"));
    json!({"asset": {"version": "2.0", "generator": generator}})
}

/// Makes metres of what a node shows, whose numbers are measured in a unit.
pub(super) fn scale_to_metres(node: &mut Value, unit: Option<LengthUnit>) {
    if let Some(metres) = unit.map(LengthUnit::metres).filter(|&metres| metres != 1.0) {
        node["scale"] = json!([metres, metres, metres]);
    }
}

/// The document that takes the geometry.
fn text(groups: &Groups, unit: Option<LengthUnit>, looks: &Looks) -> Value {
    let mut document = empty();
    if groups.triangles.is_empty() {
        return document;
    }
    let mut materials = 0..looks.materials.len();
    let primitives = groups.names.iter().map(|name| {
        let mut primitive = json!({"attributes": {}});
        if let Some(material) = (!name.is_empty()).then(|| materials.next()).flatten() {
            primitive["material"] = material.into();
        }
        primitive
    });
    let primitives: Vec<Value> = primitives.collect();
    document["scene"] = 0.into();
    document["scenes"] = json!([{"nodes": [0]}]);
    document["nodes"] = json!([{"mesh": 0}]);
    scale_to_metres(&mut document["nodes"][0], unit);
    document["meshes"] = json!([{ "primitives": primitives }]);
    if !looks.materials.is_empty() {
        document["materials"] = looks.materials.clone().into();
    }
    for (key, value) in looks.others() {
        document[key] = value;
    }
    document
}

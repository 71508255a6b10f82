//! A document of one mesh, for triangles that come from no document: with texture coordinates, colours, numbers of vertices and
//! corners, and a primitive for each material, of which the name is known.
//!
//! A vertex of the file stands for each vertex of the surface and each combination of values there. v runs downwards in glTF.

use std::collections::HashMap;
use std::path::Path;

use limitmesh::mesh::{Channel, Domain, Semantic, Triangles};
use serde_json::{Value, json};

use super::changes::Changes;
use super::looks::{Looks, Pictures};
use super::source::Source;
use super::{Asset, Geometry, GltfFlaw, VertexAttribute};
use crate::channels::MATERIAL;
use crate::error::WriteError;
use crate::format::Format;
use crate::threemf::LengthUnit;
use crate::write::{Output, WriteOptions};

/// Writes triangles with their normals and channels to a file, or to one byte vector without a path.
pub(crate) fn write_fresh(
    path: Option<&Path>,
    format: Format,
    output: &Output<'_>,
    options: &WriteOptions,
) -> Result<Vec<u8>, WriteError> {
    let flawed = |flaw| WriteError::Gltf { flaw };
    let groups = Groups::of(output);
    let names: Vec<&str> = groups
        .names
        .iter()
        .map(String::as_str)
        .filter(|name| !name.is_empty())
        .collect();
    let looks = Looks::of(&names, Some(output), Pictures::of(format, path)).map_err(flawed)?;
    let document = groups.document(options.unit, &looks).to_string();
    let folder = output.materials.map(|found| found.folder.as_path());
    let mut source = Source::parse(document.as_bytes(), folder).map_err(flawed)?;
    looks.fill(&mut source);
    let scene = source.scene().map_err(flawed)?;
    let mut asset = Asset {
        path: None,
        source,
        scene,
        changes: Changes::default(),
    };
    fill(&mut asset, 0, &groups, output, None).map_err(flawed)?;
    match path {
        Some(path) => asset.write(path, format).map(|_| Vec::new()),
        None => asset.to_bytes(format),
    }
}

/// Puts triangles into the primitives of a mesh, one for each material; with their vertices' places and normals on a coarser level of
/// detail as a morph target.
pub(super) fn fill(
    asset: &mut Asset,
    mesh: usize,
    groups: &Groups,
    output: &Output<'_>,
    coarser: Option<[&[[f64; 3]]; 2]>,
) -> Result<(), GltfFlaw> {
    let channels = attributes(output);
    let mut known = vec![NOWHERE; output.surface.positions.len()];
    for (primitive, triangles) in groups.triangles.iter().enumerate() {
        let own = Part::of(output, &channels, triangles, &mut known);
        let at = |points: &[[f64; 3]]| {
            own.vertices
                .iter()
                .map(|&v| points[v as usize])
                .collect::<Vec<_>>()
        };
        // Where vertices have several normals, the writer is given a vertex for each.
        let (positions, normals) = (
            at(output.surface.positions),
            output.vertex_normals().map(at),
        );
        let target = coarser.map(|[places, shaded]| {
            let shaded = normals
                .as_ref()
                .map(|normals| displaced("NORMAL", normals, &at(shaded)));
            core::iter::once(displaced("POSITION", &positions, &at(places)))
                .chain(shaded)
                .collect()
        });
        let targets: Vec<Vec<VertexAttribute>> = target.into_iter().collect();
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

/// What a morph target adds.
fn displaced(name: &str, from: &[[f64; 3]], to: &[[f64; 3]]) -> VertexAttribute {
    let values = from
        .iter()
        .zip(to)
        .flat_map(|(from, to)| [0, 1, 2].map(|i| to[i] - from[i]))
        .collect();
    VertexAttribute {
        name: name.to_owned(),
        width: 3,
        values,
        is_integer: false,
    }
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

/// Triangles by material, in the order in which materials are met.
pub(super) struct Groups {
    /// Empty for triangles without one.
    pub(super) names: Vec<String>,
    /// The numbers of the names in the channel's list.
    pub(super) labels: Vec<usize>,
    pub(super) triangles: Vec<Vec<usize>>,
}

impl Groups {
    pub(super) fn of(output: &Output<'_>) -> Self {
        let count = output.surface.triangles.len();
        let is_material = |own: &&Channel| own.name == MATERIAL && own.domain == Domain::Face;
        let Some(channel) = output.channels.iter().find(is_material) else {
            // A mesh needs some triangles.
            let triangles = if count > 0 {
                vec![(0..count).collect()]
            } else {
                Vec::new()
            };
            return Self {
                names: vec![String::new(); triangles.len()],
                labels: vec![0; triangles.len()],
                triangles,
            };
        };
        let (mut names, mut labels, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
        let mut numbers = HashMap::new();
        for (triangle, &label) in channel.indices.iter().enumerate() {
            let number = *numbers.entry(label).or_insert_with(|| {
                let value = channel
                    .values
                    .get(label as usize)
                    .map_or(0, |&value| value as usize);
                names.push(channel.labels.get(value).cloned().unwrap_or_default());
                labels.push(value);
                triangles.push(Vec::new());
                names.len() - 1
            });
            triangles[number].push(triangle);
        }
        Self {
            names,
            labels,
            triangles,
        }
    }

    /// What geometry is put into.
    fn document(&self, unit: Option<LengthUnit>, looks: &Looks) -> Value {
        let mut document = empty();
        if self.triangles.is_empty() {
            return document;
        }
        let mut materials = (0..looks.materials.len()).peekable();
        let primitives = self.names.iter().map(|name| {
            let mut primitive = json!({"attributes": {}});
            if let Some(material) = materials.next_if(|_| !name.is_empty()) {
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
}

/// The channels that become attributes, by their names in the document.
pub(super) fn attributes<'a>(output: &Output<'a>) -> Vec<(String, &'a Channel)> {
    let options = WriteOptions::default();
    let held = output
        .channels
        .iter()
        .filter(|own| own.domain != Domain::Face && own.value_count() > 0);
    let mut named: Vec<(String, &Channel)> = Vec::new();
    for channel in held.filter(|own| crate::holds(Format::Glb, &options, own)) {
        let usual = match channel.semantic {
            Semantic::TextureCoordinates => Some("TEXCOORD_"),
            Semantic::Colour => Some("COLOR_"),
            _ => None,
        };
        let name = match usual {
            Some(kind) => {
                let count = named
                    .iter()
                    .filter(|(name, _)| name.starts_with(kind))
                    .count();
                format!("{kind}{count}")
            }
            None => own_name(&channel.name),
        };
        if named.iter().all(|(known, _)| *known != name) {
            named.push((name, channel));
        }
    }
    named
}

/// A name that is no name of the specification's: these begin with a line below.
fn own_name(name: &str) -> String {
    let visible = name.chars().map(|c| {
        if c.is_ascii_alphanumeric() {
            c.to_ascii_uppercase()
        } else {
            '_'
        }
    });
    let visible: String = visible.collect();
    if visible.starts_with('_') {
        visible
    } else {
        format!("_{visible}")
    }
}

/// The vertices of a primitive, in the order of the file.
pub(super) struct Part {
    /// Of the surface.
    pub(super) vertices: Vec<u32>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) attributes: Vec<VertexAttribute>,
}

/// No vertex of the file.
const NOWHERE: u32 = u32::MAX;

/// Vertices of the file at one of the surface that are looked at one after the other.
const CROWD: usize = 16;

impl Part {
    /// `known` has a place for each vertex of the surface, and nothing there before and after.
    pub(super) fn of(
        output: &Output<'_>,
        channels: &[(String, &Channel)],
        triangles: &[usize],
        known: &mut [u32],
    ) -> Self {
        let Triangles {
            triangles: corners, ..
        } = output.surface;
        let mut vertices: Vec<u32> = Vec::new();
        let mut values: Vec<Vec<u32>> = vec![Vec::new(); channels.len()];
        // By vertex of the file, another one at the same vertex of the surface; and those beside which there are too many to look at.
        let mut others: Vec<u32> = Vec::new();
        let mut crowded: HashMap<(u32, Vec<u32>), u32> = HashMap::new();
        let mut number = |triangle: usize, corner: usize| {
            let vertex = corners[triangle][corner];
            let index = |channel: &Channel| match channel.domain {
                Domain::Vertex => channel.indices[vertex as usize],
                _ => channel.indices[3 * triangle + corner],
            };
            let (mut at, mut count) = (known[vertex as usize], 0);
            while at != NOWHERE {
                let mut own = channels.iter().zip(&values);
                if own.all(|((_, channel), values)| values[at as usize] == index(channel)) {
                    return at;
                }
                (at, count) = (others[at as usize], count + 1);
            }
            let new = vertices.len() as u32;
            if count < CROWD {
                others.push(std::mem::replace(&mut known[vertex as usize], new));
            } else {
                let own = channels.iter().map(|(_, channel)| index(channel)).collect();
                let at = *crowded.entry((vertex, own)).or_insert(new);
                if at != new {
                    return at;
                }
                others.push(NOWHERE);
            }
            vertices.push(vertex);
            channels
                .iter()
                .zip(&mut values)
                .for_each(|((_, channel), values)| values.push(index(channel)));
            new
        };
        let triangles = triangles
            .iter()
            .map(|&triangle| [0, 1, 2].map(|corner| number(triangle, corner)));
        let triangles = triangles.collect();
        vertices
            .iter()
            .for_each(|&vertex| known[vertex as usize] = NOWHERE);
        let attributes = channels
            .iter()
            .zip(&values)
            .map(|((name, channel), values)| attribute(name, channel, values));
        Self {
            vertices,
            triangles,
            attributes: attributes.collect(),
        }
    }
}

fn attribute(name: &str, channel: &Channel, indices: &[u32]) -> VertexAttribute {
    let is_texture = channel.semantic == Semantic::TextureCoordinates;
    let width = if is_texture { 2 } else { channel.arity };
    let mut values = Vec::with_capacity(width * indices.len());
    for &index in indices {
        let value = &channel.values[index as usize * channel.arity..][..channel.arity];
        match is_texture {
            true => values.extend([value[0], 1.0 - value.get(1).copied().unwrap_or(0.0)]),
            false => values.extend(value),
        }
    }
    VertexAttribute {
        name: name.to_owned(),
        width,
        values,
        is_integer: false,
    }
}

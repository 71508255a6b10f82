//! Primitives: positions, triangles and what moves vertices apart, out of the document.
//!
//! Strips and fans become triangles as the specification winds them: triangle i of a strip is (i, i + 1 + i mod 2,
//! i + 2 − i mod 2), of a fan (i + 1, i + 2, 0).

use super::accessor::Numbers;
use super::codecs;
use super::flaw::{GltfFlaw, Result};
use super::json::At;
use super::source::Source;
use std::collections::BTreeMap;

/// The extension of primitives that are compressed.
pub(super) const DRACO: &str = "KHR_draco_mesh_compression";

/// Triangles of one material.
#[derive(Clone, Debug)]
pub(super) struct Primitive {
    /// Its number among the mesh's.
    pub(super) index: usize,
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Its morph targets.
    pub(super) targets: Vec<Target>,
    /// By vertex, the joints that move it with their weights above 0, by joint; empty without a skin.
    pub(super) influences: Vec<Vec<(u32, f64)>>,
    /// Its normals as they stand, of any length; empty where it has none or they make no sense, or if nobody asked for attributes.
    pub(super) normals: Vec<[f64; 3]>,
    /// Attributes beside positions, normals, tangents, joints and weights, if these were asked for.
    pub(super) attributes: Vec<(AttributeName, Numbers)>,
    /// Names of all attributes.
    pub(super) names: Vec<String>,
}

/// Which attribute of a primitive: its own, or what a morph target adds to it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct AttributeName {
    /// The morph target's number, for what it adds.
    pub(super) target: Option<usize>,
    pub(super) name: String,
}

/// A morph target: what it adds to a primitive's attributes.
#[derive(Clone, Debug, Default)]
pub(super) struct Target {
    /// How it moves the vertices; empty where it doesn't.
    pub(super) displacements: Vec<[f64; 3]>,
    /// Names of all attributes that it adds to.
    pub(super) names: Vec<String>,
}

impl Primitive {
    /// Adds a vertex that is as another, and gives its number.
    pub(super) fn repeat_vertex(&mut self, v: u32) -> u32 {
        let (own, new) = (v as usize, self.positions.len() as u32);
        self.positions.push(self.positions[own]);
        for target in self
            .targets
            .iter_mut()
            .filter(|target| !target.displacements.is_empty())
        {
            target.displacements.push(target.displacements[own]);
        }
        if !self.influences.is_empty() {
            self.influences.push(self.influences[own].clone());
        }
        if !self.normals.is_empty() {
            self.normals.push(self.normals[own]);
        }
        for (_, numbers) in &mut self.attributes {
            let start = own * numbers.components;
            numbers
                .values
                .extend_from_within(start..start + numbers.components);
        }
        new
    }
}

/// What a primitive is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    /// Points and lines, which are left as they are.
    Other,
    Triangles,
    Strip,
    Fan,
}

/// The mode of a primitive.
pub(super) fn mode(primitive: &At<'_>) -> Result<Mode> {
    let Some(mode) = primitive.get("mode") else {
        return Ok(Mode::Triangles);
    };
    match mode.count()? {
        0..=3 => Ok(Mode::Other),
        4 => Ok(Mode::Triangles),
        5 => Ok(Mode::Strip),
        6 => Ok(Mode::Fan),
        _ => Err(mode.unexpected("0 to 6")),
    }
}

impl Source {
    /// The primitive at `at`, number `index` of its mesh, perhaps with its attributes; `None` if it has no triangles to be.
    pub(super) fn primitive(
        &self,
        at: &At<'_>,
        index: usize,
        with_attributes: bool,
    ) -> Result<Option<Primitive>> {
        let mode = mode(at)?;
        let attributes = at.require("attributes")?;
        let names: Vec<String> = attributes
            .members()?
            .map(|(name, _)| name.to_owned())
            .collect();
        if mode == Mode::Other || attributes.get("POSITION").is_none() {
            return Ok(None);
        }
        let mut compressed = self.compressed(at, &attributes)?;
        let mut read = |name: &str, expected: Option<usize>| -> Result<Option<Numbers>> {
            let Some(accessor) = attributes.get(name) else {
                return Ok(None);
            };
            match compressed
                .as_mut()
                .and_then(|stream| stream.attributes.remove(name))
            {
                Some(numbers) => Ok(Some(numbers)),
                None => self.numbers(&accessor, expected).map(Some),
            }
        };
        let place = attributes.require("POSITION")?;
        let positions = match read("POSITION", None)? {
            Some(numbers) => numbers.points(&place)?,
            None => Vec::new(),
        };
        let count = positions.len();
        let mut influences = Vec::new();
        for set in 0.. {
            let (joints, weights) = (format!("JOINTS_{set}"), format!("WEIGHTS_{set}"));
            let (Some(joints), Some(weights)) =
                (read(&joints, Some(count))?, read(&weights, Some(count))?)
            else {
                break;
            };
            influences.resize(count, Vec::new());
            add_influences(&mut influences, &joints, &weights);
        }
        sort_influences(&mut influences);
        // They are found anew, and only say which edges were meant to be sharp: a document is none the worse without.
        let normals = if with_attributes {
            read("NORMAL", Some(count)).ok().flatten()
        } else {
            None
        };
        let normals = normals.filter(|own| own.components == 3);
        let normals = normals.map_or_else(Vec::new, |own| own.values.as_chunks::<3>().0.to_vec());
        let normals = if normals.len() == count {
            normals
        } else {
            Vec::new()
        };
        let mut others = Vec::new();
        for name in names
            .iter()
            .filter(|name| with_attributes && is_carried(name))
        {
            let own = AttributeName {
                target: None,
                name: name.clone(),
            };
            others.extend(read(name, Some(count))?.map(|numbers| (own, numbers)));
        }
        let mut targets = Vec::new();
        for (number, target) in at.list("targets")?.iter().enumerate() {
            let (target, added) = self.target(target, count, with_attributes)?;
            targets.push(target);
            let name = |name| AttributeName {
                target: Some(number),
                name,
            };
            others.extend(added.into_iter().map(|(own, numbers)| (name(own), numbers)));
        }
        let corners = match (compressed, at.get("indices")) {
            (Some(stream), _) => checked(stream.indices, count, at)?,
            (None, Some(indices)) => checked(self.integers(&indices)?, count, &indices)?,
            // A primitive without indices has at most as many corners as it has positions.
            (None, None) => (0..count as u32).collect(),
        };
        let triangles = triangles(&corners, mode);
        Ok(Some(Primitive {
            index,
            positions,
            triangles,
            targets,
            influences,
            normals,
            attributes: others,
            names,
        }))
    }

    /// The morph target at `at` of a primitive with `count` vertices, and perhaps what it adds to attributes that are carried.
    fn target(
        &self,
        at: &At<'_>,
        count: usize,
        with_attributes: bool,
    ) -> Result<(Target, Vec<(String, Numbers)>)> {
        let mut target = Target::default();
        let mut added = Vec::new();
        for (name, accessor) in at.members()? {
            target.names.push(name.to_owned());
            let is_displacement = name == "POSITION";
            let is_read = is_displacement || with_attributes && is_carried(name);
            if !is_read {
                continue;
            }
            let numbers = self.numbers(&accessor, Some(count))?;
            if is_displacement {
                target.displacements = numbers.points(&accessor)?;
            }
            if with_attributes {
                added.push((name.to_owned(), numbers));
            }
        }
        Ok((target, added))
    }

    /// What is in the primitive's Draco stream, if it has one.
    fn compressed(&self, at: &At<'_>, attributes: &At<'_>) -> Result<Option<Stream>> {
        let Some(extension) = at.path(&["extensions", DRACO]) else {
            return Ok(None);
        };
        let mut normalized = Vec::new();
        for (name, accessor) in attributes.members()? {
            let (_, accessor) = accessor.item_of(&self.root(), "accessors")?;
            normalized.push((name.to_owned(), accessor.flag("normalized")?));
        }
        let view = self.view(&extension.require("bufferView")?)?;
        let found = codecs::draco(&extension, view.bytes, &normalized, self.room())?;
        let bytes = found
            .attributes
            .iter()
            .map(|(_, numbers)| 8 * numbers.values.len())
            .sum();
        self.take_room(&extension, bytes)?;
        let attributes = found.attributes.into_iter().collect();
        Ok(Some(Stream {
            attributes,
            indices: found.indices,
        }))
    }
}

/// Whether an attribute is a value of its own: normals and tangents follow from the surface, joints and weights move it.
fn is_carried(name: &str) -> bool {
    let kind = name.split_once('_').map_or(name, |(kind, _)| kind);
    !matches!(
        kind,
        "POSITION" | "NORMAL" | "TANGENT" | "JOINTS" | "WEIGHTS"
    )
}

/// What a Draco stream held.
struct Stream {
    attributes: BTreeMap<String, Numbers>,
    indices: Vec<u32>,
}

fn checked(corners: Vec<u32>, count: usize, at: &At<'_>) -> Result<Vec<u32>> {
    match corners.iter().position(|&v| v as usize >= count) {
        None => Ok(corners),
        Some(i) => {
            let found = format!("{} in element {i}", corners[i]);
            Err(GltfFlaw::new(
                at.place(),
                found,
                format!("indices below {count} (the number of vertices)"),
            ))
        }
    }
}

fn triangles(corners: &[u32], mode: Mode) -> Vec<[u32; 3]> {
    // Strips repeat vertices on purpose, to go on elsewhere.
    let has_area = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    match mode {
        Mode::Other => Vec::new(),
        Mode::Triangles => corners.as_chunks::<3>().0.to_vec(),
        Mode::Strip => {
            let turned = |(i, w): (usize, &[u32])| {
                if i % 2 == 0 {
                    [w[0], w[1], w[2]]
                } else {
                    [w[0], w[2], w[1]]
                }
            };
            corners
                .windows(3)
                .enumerate()
                .map(turned)
                .filter(has_area)
                .collect()
        }
        Mode::Fan => {
            let Some((&first, rest)) = corners.split_first() else {
                return Vec::new();
            };
            rest.windows(2)
                .map(|w| [w[0], w[1], first])
                .filter(has_area)
                .collect()
        }
    }
}

fn add_influences(influences: &mut [Vec<(u32, f64)>], joints: &Numbers, weights: &Numbers) {
    let width = joints.components.min(weights.components);
    for (v, list) in influences.iter_mut().enumerate() {
        for i in 0..width {
            let joint = joints.values.get(v * joints.components + i);
            let weight = weights.values.get(v * weights.components + i);
            if let (Some(&joint), Some(&weight)) = (joint, weight)
                && weight > 0.0
                && weight.is_finite()
            {
                list.push((joint as u32, weight));
            }
        }
    }
}

/// By joint, each once.
fn sort_influences(influences: &mut [Vec<(u32, f64)>]) {
    for list in influences {
        list.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        list.dedup_by(|next, kept| {
            let is_same = next.0 == kept.0;
            if is_same {
                kept.1 += next.1;
            }
            is_same
        });
    }
}

//! Primitives: positions, faces and what moves vertices apart, out of the document.
//!
//! Faces are triangles, and polygons where an extension has some (`polygons`).
//! Strips and fans become triangles as the specification winds them: triangle i of a strip is (i, i + 1 + i mod 2,
//! i + 2 − i mod 2), of a fan (i + 1, i + 2, 0).

use super::mode::{Mode, checked, mode};
use super::polygons::Polygons;
use crate::flaw::Result;
use crate::formats::gltf::document::codecs::{self, Compressed};
use crate::formats::gltf::document::extensions::DRACO;
use crate::formats::gltf::document::json::At;
use crate::formats::gltf::document::numbers::Numbers;
use crate::formats::gltf::document::source::Source;
use limitmesh::mesh::PolygonFaces;
use std::collections::BTreeMap;

/// A vertex of a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Local {
    pub(crate) part: usize,
    pub(crate) vertex: u32,
}

/// A joint that moves a vertex, and its weight, which is above 0.
type Influence = (u32, f64);

/// Faces of one material.
#[derive(Clone, Debug)]
pub(crate) struct Primitive {
    /// Its number among the mesh's.
    pub(crate) index: usize,
    pub(crate) positions: Vec<[f64; 3]>,
    /// Its polygons, or the triangles that these are where there are no others.
    pub(crate) faces: PolygonFaces,
    /// Polygons of which there are the triangles instead.
    pub(crate) as_triangles: usize,
    /// Its morph targets.
    pub(crate) targets: Vec<Target>,
    /// By vertex, the joints that move it with their weights above 0, by joint; empty without a skin.
    pub(crate) influences: Vec<Vec<(u32, f64)>>,
    /// Its normals as they stand, of any length; empty where it has none or they make no sense, or if nobody asked for attributes.
    pub(crate) normals: Vec<[f64; 3]>,
    /// Attributes apart from positions, normals, tangents, joints and weights, if these were asked for.
    pub(crate) attributes: Vec<(AttributeName, Numbers)>,
    /// Names of all attributes.
    pub(crate) names: Vec<String>,
}

/// Which attribute of a primitive: its own, or what a morph target adds to it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct AttributeName {
    /// The morph target's number, for what it adds.
    pub(crate) target: Option<usize>,
    pub(crate) name: String,
}

/// A morph target: what it adds to a primitive's attributes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Target {
    /// How it moves the vertices; empty where it doesn't.
    pub(crate) displacements: Vec<[f64; 3]>,
    /// Names of all attributes that it adds to.
    pub(crate) names: Vec<String>,
}

impl Primitive {
    /// Adds a vertex that is as another, and gives its number.
    pub(crate) fn repeat_vertex(&mut self, v: u32) -> u32 {
        let (own, new) = (v as usize, self.positions.len() as u32);
        self.positions.push(self.positions[own]);
        for target in &mut self.targets {
            target
                .displacements
                .extend(target.displacements.get(own).copied());
        }
        self.influences.extend(self.influences.get(own).cloned());
        self.normals.extend(self.normals.get(own).copied());
        for (_, numbers) in &mut self.attributes {
            let start = own * numbers.components;
            numbers
                .values
                .extend_from_within(start..start + numbers.components);
        }
        new
    }
}

impl Source {
    /// The primitive at `at`, number `index` of its mesh, perhaps with its attributes, and its polygons as polygons or as the triangles that
    /// the document cuts them into; `None` if it has no triangles to be.
    pub(crate) fn primitive(
        &self,
        at: &At<'_>,
        index: usize,
        with_attributes: bool,
        with_polygons: bool,
    ) -> Result<Option<Primitive>> {
        let mode = mode(at)?;
        let attributes = at.require("attributes")?;
        let names = attributes.members()?.map(|(name, _)| name.to_owned());
        let names: Vec<String> = names.collect();
        let Some(place) = attributes.get("POSITION").filter(|_| mode != Mode::Other) else {
            return Ok(None);
        };
        let mut compressed = self.compressed(at, &attributes)?;
        let mut read = |name: &str, expected: Option<usize>| -> Result<Option<Numbers>> {
            let stream = compressed.as_mut();
            match (
                stream.and_then(|stream| stream.attributes.remove(name)),
                attributes.get(name),
            ) {
                (_, None) => Ok(None),
                (Some(numbers), _) => Ok(Some(numbers)),
                (None, Some(accessor)) => self.numbers(&accessor, expected).map(Some),
            }
        };
        let positions = read("POSITION", None)?.map(|own| own.points(&place));
        let positions = positions.transpose()?.unwrap_or_default();
        let count = positions.len();
        let mut influences = Vec::new();
        for set in 0.. {
            let joints = read(&format!("JOINTS_{set}"), Some(count))?;
            let weights = read(&format!("WEIGHTS_{set}"), Some(count))?;
            let (Some(joints), Some(weights)) = (joints, weights) else {
                break;
            };
            influences.resize(count, Vec::new());
            add_influences(&mut influences, &joints, &weights);
        }
        influences.iter_mut().for_each(sort_influences);
        // They are found anew, and only say which edges were meant to be sharp: a document is none the worse without.
        let normals = if with_attributes {
            read("NORMAL", Some(count))
        } else {
            Ok(None)
        };
        let is_whole = |own: &Numbers| own.components == 3 && own.len() == count;
        let normals = normals.ok().flatten().filter(is_whole);
        let normals = normals.map_or_else(Vec::new, |own| own.values.as_chunks::<3>().0.to_vec());
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
            targets.push(self.target(
                target,
                number,
                count,
                with_attributes.then_some(&mut others),
            )?);
        }
        let is_compressed = compressed.is_some();
        let triangles = || {
            let corners = match (compressed, at.get("indices")) {
                (Some(stream), _) => checked(stream.indices, count, at)?,
                (None, Some(indices)) => checked(self.integers(&indices)?, count, &indices)?,
                // A primitive without indices has at most as many corners as it has positions.
                (None, None) => (0..count as u32).collect(),
            };
            Ok(triangles(&corners, mode))
        };
        let Polygons {
            faces,
            as_triangles,
        } = self.polygons(at, mode, count, with_polygons, is_compressed, triangles)?;
        Ok(Some(Primitive {
            index,
            positions,
            faces,
            as_triangles,
            targets,
            influences,
            normals,
            attributes: others,
            names,
        }))
    }

    /// The morph target at `at`, with its number, of a primitive with `count` vertices; what it adds to attributes that are carried goes to
    /// `added`.
    fn target(
        &self,
        at: &At<'_>,
        number: usize,
        count: usize,
        mut added: Option<&mut Vec<(AttributeName, Numbers)>>,
    ) -> Result<Target> {
        let mut target = Target::default();
        for (name, accessor) in at.members()? {
            target.names.push(name.to_owned());
            let is_displacement = name == "POSITION";
            if !is_displacement && (added.is_none() || !is_carried(name)) {
                continue;
            }
            let numbers = self.numbers(&accessor, Some(count))?;
            if is_displacement {
                target.displacements = numbers.points(&accessor)?;
            }
            if let Some(added) = &mut added {
                let own = AttributeName {
                    target: Some(number),
                    name: name.to_owned(),
                };
                added.push((own, numbers));
            }
        }
        Ok(target)
    }

    /// The contents of the primitive's Draco stream, if it has one.
    fn compressed(&self, at: &At<'_>, attributes: &At<'_>) -> Result<Option<Compressed>> {
        let Some(extension) = at.path(&["extensions", DRACO]) else {
            return Ok(None);
        };
        let mut is_normalized = BTreeMap::new();
        for (name, accessor) in attributes.members()? {
            let accessor = accessor.item_of(&self.root(), "accessors")?;
            is_normalized.insert(name, accessor.flag("normalized")?);
        }
        let view = self.view(&extension.require("bufferView")?)?;
        let found = codecs::draco(&extension, view.bytes, &is_normalized, self.room())?;
        let bytes = found.attributes.values();
        let bytes = bytes.map(|numbers| 8 * numbers.values.len()).sum();
        self.take_room(&extension, bytes)?;
        Ok(Some(found))
    }
}

/// Whether an attribute is a value of its own: normals and tangents follow from the surface, joints and weights move it.
fn is_carried(name: &str) -> bool {
    let kind = name.split_once('_').map_or(name, |(kind, _)| kind);
    !["POSITION", "NORMAL", "TANGENT", "JOINTS", "WEIGHTS"].contains(&kind)
}

fn triangles(corners: &[u32], mode: Mode) -> Vec<[u32; 3]> {
    // Strips repeat vertices on purpose, to go on elsewhere.
    let has_area = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    match mode {
        Mode::Other | Mode::Loops => Vec::new(),
        Mode::Triangles => corners.as_chunks::<3>().0.to_vec(),
        Mode::Strip => {
            let turned = |i: usize| [corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]];
            let all = (0..corners.len().saturating_sub(2)).map(turned);
            all.filter(has_area).collect()
        }
        Mode::Fan => {
            let turned = |i: usize| [corners[i + 1], corners[i + 2], corners[0]];
            let all = (0..corners.len().saturating_sub(2)).map(turned);
            all.filter(has_area).collect()
        }
    }
}

fn add_influences(influences: &mut [Vec<Influence>], joints: &Numbers, weights: &Numbers) {
    let joints = joints.values.chunks_exact(joints.components);
    let weights = weights.values.chunks_exact(weights.components);
    for (list, (joints, weights)) in influences.iter_mut().zip(joints.zip(weights)) {
        let own = joints.iter().zip(weights);
        let own = own.map(|(&joint, &weight)| (joint as u32, weight));
        list.extend(own.filter(|&(_, weight)| weight > 0.0 && weight.is_finite()));
    }
}

/// By joint, each once.
fn sort_influences(list: &mut Vec<Influence>) {
    list.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    list.dedup_by(|next, kept| {
        let is_same = next.0 == kept.0;
        if is_same {
            kept.1 += next.1;
        }
        is_same
    });
}

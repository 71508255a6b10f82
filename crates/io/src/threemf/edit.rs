//! New text for the vertices and triangles of a mesh, between the tags that stay.

use super::flaw::{PackageFlaw, Result};
use super::model::{MeshText, Model};
use super::properties::{self, Inherited, Source};
use super::volumes::Volume;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Triangles that take the place of an object's.
#[derive(Clone, Copy)]
pub struct NewTriangles<'a> {
    /// Positions of the vertices.
    pub positions: &'a [[f64; 3]],
    /// Corners of the triangles.
    pub triangles: &'a [[u32; 3]],
    /// By triangle, where it came from.
    pub source: &'a dyn Fn(usize) -> Source,
    /// Whether they inherit the attribute of a name.
    pub keeps: &'a dyn Fn(&str) -> bool,
}

/// What takes the place of a mesh's text.
pub(super) struct Replacement {
    vertices: String,
    triangles: String,
    /// By volume of the object, its new first and last triangle.
    pub(super) volumes: BTreeMap<[u32; 2], [u32; 2]>,
}

impl Replacement {
    /// Of the triangles of a mesh, some ranges of which are volumes.
    pub(super) fn new(
        model: &Model,
        mesh: &MeshText,
        volumes: &[&Volume],
        new: &NewTriangles<'_>,
    ) -> Result<(Self, Inherited)> {
        let flaw = |problem: String| PackageFlaw::new(&model.name, problem);
        let beyond = |&&v: &&u32| v as usize >= new.positions.len();
        if let Some(vertex) = new.triangles.as_flattened().iter().find(beyond) {
            let count = new.positions.len();
            return Err(flaw(format!(
                "a triangle names vertex {vertex}, but there are {count}"
            )));
        }
        if let Some(x) = new.positions.as_flattened().iter().find(|x| !x.is_finite()) {
            return Err(flaw(format!(
                "a coordinate is {x}, which is no finite number"
            )));
        }
        let needs_sources = !mesh.attributes.is_empty() || !volumes.is_empty();
        let sources: Vec<Source> = match needs_sources {
            true => (0..new.triangles.len()).map(new.source).collect(),
            false => Vec::new(),
        };
        if let Some(source) = sources
            .iter()
            .find(|source| source.face >= mesh.triangles.len())
        {
            let count = mesh.triangles.len();
            return Err(flaw(format!(
                "triangle {} is named, but there are {count}",
                source.face
            )));
        }
        // Volumes are ranges: triangles stand in the order of those that they came from.
        let mut order: Vec<u32> = (0..new.triangles.len() as u32).collect();
        if needs_sources {
            order.sort_by_key(|&triangle| sources[triangle as usize].face);
        }
        let mut ranges = BTreeMap::new();
        for volume in volumes {
            let before = |face: u32| {
                order.partition_point(|&t| (sources[t as usize].face as u32) < face) as u32
            };
            let (first, end) = (before(volume.first), before(volume.last.saturating_add(1)));
            if first >= end {
                let (first, last) = (volume.first, volume.last);
                return Err(flaw(format!(
                    "the volume from triangle {first} to {last} has no triangle left"
                )));
            }
            ranges.insert([volume.first, volume.last], [first, end - 1]);
        }
        let (mut told, prefix) = (Inherited::default(), model.prefix.as_str());
        let mut numbers = Numbers::default();
        let vertices = between(&model.text[mesh.vertices_at.clone()], |out, lead| {
            for [x, y, z] in new.positions {
                let _ = write!(out, "{lead}<{prefix}vertex x=\"{}\"", numbers.text(*x));
                let _ = write!(out, " y=\"{}\"", numbers.text(*y));
                let _ = write!(out, " z=\"{}\"/>", numbers.text(*z));
            }
        });
        let triangles = between(&model.text[mesh.triangles_at.clone()], |out, lead| {
            for &number in &order {
                let [a, b, c] = new.triangles[number as usize];
                let _ = write!(
                    out,
                    "{lead}<{prefix}triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\""
                );
                if let Some(source) = sources.get(number as usize)
                    && let Some(at) = mesh.attributes.get(source.face)
                {
                    let text = &model.text[at.start as usize..at.end as usize];
                    properties::inherit(out, text, source, new.keeps, &mut told);
                }
                out.push_str("/>");
            }
        });
        Ok((
            Self {
                vertices,
                triangles,
                volumes: ranges,
            },
            told,
        ))
    }
}

/// The text of a list of elements with blanks as the old one has them.
fn between(old: &str, fill: impl FnOnce(&mut String, &str)) -> String {
    let lead = &old[..old.len() - old.trim_ascii_start().len()];
    let tail = &old[old.trim_ascii_end().len().max(lead.len())..];
    let mut out = String::new();
    fill(&mut out, lead);
    out.push_str(tail);
    out
}

/// The fewest digits that read back as a number.
#[derive(Default)]
pub(super) struct Numbers(Option<zmij::Buffer>);

impl Numbers {
    pub(super) fn text(&mut self, x: f64) -> &str {
        let text = self.0.insert(zmij::Buffer::new()).format(x);
        text.strip_suffix(".0").unwrap_or(text)
    }
}

/// A model's text with replacements for some of its objects, by their numbers in the model.
pub(super) fn edited(model: &Model, replaced: &BTreeMap<usize, &Replacement>) -> String {
    let (mut out, mut at) = (String::with_capacity(model.text.len()), 0);
    for (&object, new) in replaced {
        let Some(mesh) = &model.objects[object].mesh else {
            continue;
        };
        out.push_str(&model.text[at..mesh.vertices_at.start]);
        out.push_str(&new.vertices);
        out.push_str(&model.text[mesh.vertices_at.end..mesh.triangles_at.start]);
        out.push_str(&new.triangles);
        at = mesh.triangles_at.end;
    }
    out.push_str(&model.text[at..]);
    out
}

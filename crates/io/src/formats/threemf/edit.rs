//! New text for the vertices and triangles of a mesh, between the tags that stay.

use super::model::{MeshText, Model};
use super::properties::{self, Inherited, Source};
use super::volumes::Volume;
use crate::flaw::{Flaw, Result};
use std::collections::BTreeMap;

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

/// The text that replaces a mesh's.
pub(super) struct Replacement {
    vertices: String,
    triangles: String,
    /// By volume of the object, its new first and last triangle.
    pub(super) volumes: BTreeMap<[u32; 2], [u32; 2]>,
}

impl Replacement {
    /// Of the triangles of a mesh, some ranges of which are volumes; notes in `losses` what attributes lost.
    pub(super) fn new(
        model: &Model,
        mesh: &MeshText,
        volumes: &[&Volume],
        new: &NewTriangles<'_>,
        losses: &mut Inherited,
    ) -> Result<Self> {
        let flaw = |problem: String| Err(Flaw::saying(&*model.name, problem));
        let count = new.positions.len();
        if let Some(v) = new
            .triangles
            .as_flattened()
            .iter()
            .find(|&&v| v as usize >= count)
        {
            return flaw(format!(
                "a triangle names vertex {v}, but there are {count}"
            ));
        }
        if let Some(x) = new.positions.as_flattened().iter().find(|x| !x.is_finite()) {
            return flaw(format!("a coordinate is {x}, which is no finite number"));
        }
        let needs_sources = !mesh.attributes.is_empty() || !volumes.is_empty();
        let sourced = if needs_sources {
            new.triangles.len()
        } else {
            0
        };
        let sources: Vec<Source> = (0..sourced).map(new.source).collect();
        let count = mesh.triangles.len();
        if let Some(Source { face, .. }) = sources.iter().find(|source| source.face >= count) {
            return flaw(format!("triangle {face} is named, but there are {count}"));
        }
        // Volumes are ranges: triangles stand in the order of those that they came from.
        let mut order: Vec<u32> = (0..new.triangles.len() as u32).collect();
        if needs_sources {
            order.sort_by_key(|&triangle| sources[triangle as usize].face);
        }
        let mut ranges = BTreeMap::new();
        let before =
            |face: u32| order.partition_point(|&t| (sources[t as usize].face as u32) < face) as u32;
        for volume in volumes {
            let [first, last] = [volume.first.value, volume.last.value];
            let (start, end) = (before(first), before(last.saturating_add(1)));
            if start >= end {
                return flaw(format!(
                    "the volume from triangle {first} to {last} has no triangle left"
                ));
            }
            ranges.insert([first, last], [start, end - 1]);
        }
        let prefix = model.prefix.as_str();
        let vertices = between(&model.text[mesh.vertices_at.clone()], |out, lead| {
            for position in new.positions {
                out.extend([lead, "<", prefix, "vertex"]);
                for (name, &x) in [" x=\"", " y=\"", " z=\""].iter().zip(position) {
                    let mut digits = zmij::Buffer::new();
                    let text = digits.format(x);
                    out.extend([name, text.strip_suffix(".0").unwrap_or(text), "\""]);
                }
                out.push_str("/>");
            }
        });
        let triangles = between(&model.text[mesh.triangles_at.clone()], |out, lead| {
            for &number in &order {
                let [a, b, c] = new.triangles[number as usize];
                let corners = format!("triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"");
                out.extend([lead, "<", prefix, &corners]);
                if let Some(source) = sources.get(number as usize)
                    && let Some(at) = mesh.attributes.get(source.face)
                {
                    let text = &model.text[at.start as usize..at.end as usize];
                    properties::inherit(out, text, source, new.keeps, losses);
                }
                out.push_str("/>");
            }
        });
        Ok(Self {
            vertices,
            triangles,
            volumes: ranges,
        })
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

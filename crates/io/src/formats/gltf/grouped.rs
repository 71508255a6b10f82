//! Triangles that come from no document as primitives: one for each material, with a vertex for each vertex of the surface and each combination
//! of values there. v runs downwards in glTF.

use super::edit::geometry::VertexAttribute;
use crate::capacity::{Capacity, Held};
use crate::channels::MATERIAL;
use crate::output::Output;
use limitmesh::mesh::{Channel, Domain, Semantic};
use std::collections::HashMap;

/// The capacity of new documents; one that is edited keeps its own values.
pub(super) fn capacity() -> Capacity {
    let holds = |own: &Channel| {
        let is_by_face = own.domain == Domain::Face;
        match own.semantic {
            Semantic::TextureCoordinates => !is_by_face,
            Semantic::Colour => !is_by_face && [3, 4].contains(&own.arity),
            Semantic::Other => !is_by_face && (1..=4).contains(&own.arity),
            _ => is_by_face && own.name == MATERIAL,
        }
    };
    Capacity {
        coordinates: Held::Single,
        normals: Held::Double,
        ..Capacity::of_channels(holds)
    }
}

/// Triangles by material, in the order in which materials are met.
#[derive(Default)]
pub(super) struct Groups {
    /// Empty for triangles without one.
    pub(super) names: Vec<String>,
    /// The numbers of the names in the channel's list.
    pub(super) labels: Vec<usize>,
    pub(super) triangles: Vec<Vec<usize>>,
}

impl Groups {
    pub(super) fn of(output: &Output<'_>) -> Self {
        let mut groups = Self::default();
        let count = output.surface.triangles.len();
        let is_material = |own: &&Channel| own.name == MATERIAL && own.domain == Domain::Face;
        let Some(channel) = output.channels.iter().find(is_material) else {
            // A mesh needs some triangles.
            if count > 0 {
                groups.push(String::new(), 0);
                groups.triangles[0].extend(0..count);
            }
            return groups;
        };
        let mut numbers = HashMap::new();
        for (triangle, &label) in channel.indices.iter().enumerate() {
            let number = *numbers.entry(label).or_insert_with(|| {
                let value = channel.values[label as usize] as usize;
                // What has no label has no material.
                groups.push(
                    channel.labels.get(value).cloned().unwrap_or_default(),
                    value,
                );
                groups.names.len() - 1
            });
            groups.triangles[number].push(triangle);
        }
        groups
    }

    fn push(&mut self, name: String, label: usize) {
        self.names.push(name);
        self.labels.push(label);
        self.triangles.push(Vec::new());
    }
}

/// A channel that becomes an attribute.
pub(super) struct Attribute<'a> {
    /// In the document.
    pub(super) name: String,
    channel: &'a Channel,
}

/// The channels that become attributes.
pub(super) fn attributes<'a>(output: &Output<'a>) -> Vec<Attribute<'a>> {
    let mut named: Vec<Attribute<'a>> = Vec::new();
    let held = capacity().held(output).into_iter();
    for channel in held.filter(|own| own.domain != Domain::Face && own.value_count() > 0) {
        let numbered = |kind: &str| {
            let all = named.iter().filter(|own| own.name.starts_with(kind));
            let count = all.count();
            format!("{kind}{count}")
        };
        let name = match channel.semantic {
            Semantic::TextureCoordinates => numbered("TEXCOORD_"),
            Semantic::Colour => numbered("COLOR_"),
            _ => own_name(&channel.name),
        };
        if named.iter().all(|known| known.name != name) {
            named.push(Attribute { name, channel });
        }
    }
    named
}

/// A name that is no name of the specification's: these begin with a line below.
fn own_name(name: &str) -> String {
    let plain = |c: char| {
        if c.is_ascii_alphanumeric() {
            c.to_ascii_uppercase()
        } else {
            '_'
        }
    };
    let plain: String = name.chars().map(plain).collect();
    if plain.starts_with('_') {
        plain
    } else {
        format!("_{plain}")
    }
}

/// By vertex of the surface, that a file has none.
pub(super) fn nowhere(output: &Output<'_>) -> Vec<u32> {
    vec![NOWHERE; output.surface.positions.len()]
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
        channels: &[Attribute<'_>],
        triangles: &[usize],
        known: &mut [u32],
    ) -> Self {
        let corners = output.surface.triangles;
        let mut vertices: Vec<u32> = Vec::new();
        let mut values: Vec<Vec<u32>> = vec![Vec::new(); channels.len()];
        // By vertex of the file, another one at the same vertex of the surface; and those with too many others to look at.
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
                if own.all(|(own, values)| values[at as usize] == index(own.channel)) {
                    return at;
                }
                (at, count) = (others[at as usize], count + 1);
            }
            let new = vertices.len() as u32;
            if count < CROWD {
                others.push(std::mem::replace(&mut known[vertex as usize], new));
            } else {
                let own = channels.iter().map(|own| index(own.channel)).collect();
                let at = *crowded.entry((vertex, own)).or_insert(new);
                if at != new {
                    return at;
                }
                others.push(NOWHERE);
            }
            vertices.push(vertex);
            for (own, values) in channels.iter().zip(&mut values) {
                values.push(index(own.channel));
            }
            new
        };
        let all = triangles.iter();
        let triangles = all.map(|&t| [0, 1, 2].map(|corner| number(t, corner)));
        let triangles = triangles.collect();
        for &vertex in vertices.iter() {
            known[vertex as usize] = NOWHERE;
        }
        let attributes = channels.iter().zip(&values);
        let attributes = attributes.map(|(own, values)| attribute(own, values));
        let attributes = attributes.collect();
        Self {
            vertices,
            triangles,
            attributes,
        }
    }
}

fn attribute(attribute: &Attribute<'_>, indices: &[u32]) -> VertexAttribute {
    let channel = attribute.channel;
    let is_texture = channel.semantic == Semantic::TextureCoordinates;
    let width = if is_texture { 2 } else { channel.arity };
    let mut values = Vec::with_capacity(width * indices.len());
    for &index in indices {
        let value = &channel.values[index as usize * channel.arity..][..channel.arity];
        match is_texture {
            // A texture of one number has its other at 0.
            true => values.extend([value[0], 1.0 - value.get(1).copied().unwrap_or(0.0)]),
            false => values.extend(value),
        }
    }
    VertexAttribute::new(&attribute.name, width, values)
}

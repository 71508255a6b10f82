//! Vertices that stand once for each combination of values, for files that hold texture coordinates at vertices as others wrote them:
//! most programs read these there, or as lists of faces, but not both.
//!
//! Takes an output whose corners have the values, gives one whose vertices do. Numbers of vertices stay; copies follow.

use super::Output;
use super::property::{Property, PropertyValues};
use limitmesh::mesh::{Channel, Domain, Semantic, Storage, Triangles};

/// No corner, or no vertex.
const NONE: u32 = u32::MAX;

/// An output's vertices, some of which stand several times.
pub(super) struct Split {
    positions: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    normals: Option<Vec<[f64; 3]>>,
    colours: Option<Vec<[u8; 3]>>,
    quality: Option<Vec<f64>>,
    /// Of vertices' properties, name by name.
    properties: Vec<Numbers>,
    channels: Vec<Channel>,
}

/// Numbers by vertex.
enum Numbers {
    Integers(Vec<u32>),
    Numbers(Vec<f64>),
}

/// Whether PLY files hold a channel as numbers of vertices, as the one did that it came from: it has a name for each.
pub(super) fn is_of_vertices(channel: &Channel) -> bool {
    channel.semantic == Semantic::TextureCoordinates
        && channel.name.split(',').count() == channel.arity
}

/// Whether a PLY file has vertices several times, since channels have texture coordinates that differ between corners there, and did so at
/// vertices in the file that they come from.
pub fn splits_vertices(channels: &[Channel], triangles: &[[u32; 3]], vertices: usize) -> bool {
    let own = channels
        .iter()
        .filter(|own| own.domain == Domain::Corner && is_of_vertices(own));
    let own: Vec<&Channel> = own
        .filter(|own| {
            own.check(vertices, 3 * triangles.len(), triangles.len())
                .is_ok()
        })
        .collect();
    !own.is_empty() && differ(&own, triangles, vertices)
}

/// Whether channels have two values at some vertex.
fn differ(channels: &[&Channel], triangles: &[[u32; 3]], count: usize) -> bool {
    let mut first = vec![NONE; count];
    triangles
        .as_flattened()
        .iter()
        .zip(0..)
        .any(|(&v, corner)| {
            let known = &mut first[v as usize];
            if *known == NONE {
                *known = corner;
            }
            !channels.iter().all(|own| has_same(own, *known, corner))
        })
}

impl Split {
    /// An output's, if a PLY file needs that.
    pub(super) fn of(output: &Output<'_>) -> Option<Self> {
        let Triangles {
            positions,
            triangles,
        } = output.surface;
        if !splits_vertices(output.channels, triangles, positions.len()) {
            return None;
        }
        let is_by_list =
            |own: &Channel| own.semantic == Semantic::TextureCoordinates && !is_of_vertices(own);
        let held = output.channels.iter().filter(|own| {
            own.domain == Domain::Corner
                && crate::holds(crate::Format::Ply, &Default::default(), own)
                && !is_by_list(own)
        });
        let held: Vec<&Channel> = held.collect();
        let (triangles, corners) = divided(&held, triangles, positions.len());
        let sources: Vec<u32> = corners.iter().map(|&(source, _)| source).collect();
        let numbers = |property: &Property<'_>| match property.values {
            PropertyValues::Integers(all) => Numbers::Integers(at(all, &sources)),
            PropertyValues::Numbers(all) => Numbers::Numbers(at(all, &sources)),
        };
        let channel = |own: &Channel| {
            let mut own = own.clone();
            if own.domain == Domain::Vertex {
                own.indices = at(&own.indices, &sources);
            }
            own
        };
        Some(Self {
            positions: at(positions, &sources),
            triangles,
            normals: output.vertex_normals().map(|all| at(all, &sources)),
            colours: output.colours.map(|all| at(all, &sources)),
            quality: output.quality.map(|all| at(all, &sources)),
            properties: output.vertex_properties.iter().map(numbers).collect(),
            channels: output.channels.iter().map(channel).collect(),
        })
    }

    /// The properties of the vertices.
    pub(super) fn properties<'a>(&'a self, output: &Output<'a>) -> Vec<Property<'a>> {
        let own = output.vertex_properties.iter().zip(&self.properties);
        own.map(|(property, numbers)| match numbers {
            Numbers::Integers(all) => Property::integers(property.name, all),
            Numbers::Numbers(all) => Property::numbers(property.name, all),
        })
        .collect()
    }

    /// The output with these vertices, and their properties.
    pub(super) fn output<'a>(
        &'a self,
        output: &Output<'a>,
        properties: &'a [Property<'a>],
    ) -> Output<'a> {
        Output {
            surface: Triangles {
                positions: &self.positions,
                triangles: &self.triangles,
            },
            normals: self.normals.as_deref(),
            corner_normals: None,
            colours: self.colours.as_deref(),
            quality: self.quality.as_deref(),
            vertex_properties: properties,
            channels: &self.channels,
            ..*output
        }
    }
}

/// Triangles of which corners have a vertex of their own for each combination of values; and by vertex what it is a copy of, and the first
/// corner that has it.
fn divided(
    channels: &[&Channel],
    triangles: &[[u32; 3]],
    count: usize,
) -> (Vec<[u32; 3]>, Vec<(u32, u32)>) {
    let is_same = |a: u32, b: u32| channels.iter().all(|own| has_same(own, a, b));
    let mut vertices: Vec<(u32, u32)> = (0..count as u32).map(|v| (v, NONE)).collect();
    // By vertex, the next copy of the same.
    let mut next = vec![NONE; count];
    let mut triangles = triangles.to_vec();
    for (corner, v) in triangles.as_flattened_mut().iter_mut().enumerate() {
        let corner = corner as u32;
        if vertices[*v as usize].1 == NONE {
            vertices[*v as usize].1 = corner;
            continue;
        }
        let source = *v;
        while !is_same(vertices[*v as usize].1, corner) {
            if next[*v as usize] == NONE {
                let new = vertices.len() as u32;
                next[*v as usize] = new;
                next.push(NONE);
                vertices.push((source, corner));
            }
            *v = next[*v as usize];
        }
    }
    (triangles, vertices)
}

/// Whether two corners have the same value in a file.
fn has_same(channel: &Channel, a: u32, b: u32) -> bool {
    let index = |corner: u32| channel.indices[corner as usize];
    let value = |corner: u32| channel.value(corner as usize).iter();
    index(a) == index(b)
        || match channel.storage {
            Storage::Double => value(a).eq(value(b)),
            _ => value(a).map(|&x| x as f32).eq(value(b).map(|&x| x as f32)),
        }
}

fn at<T: Copy>(all: &[T], sources: &[u32]) -> Vec<T> {
    sources.iter().map(|&v| all[v as usize]).collect()
}

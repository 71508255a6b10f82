//! The vertices of an asset's file: one for each vertex of a surface and each combination of values there.

use limitmesh::mesh::{Channel, Semantic};
use limitmesh_io::gltf::VertexAttribute;

use super::weights::{Joints, MOST_JOINTS};

/// The vertices of a file: one for each vertex of a surface and each combination of values there.
pub(super) struct Vertices<'a> {
    channels: &'a [&'a Channel],
    /// By vertex of the surface, the first of the file's; and by these the next of the same.
    first: Vec<u32>,
    next: Vec<u32>,
    /// By vertex of the mesh, what moves it, if anything does.
    moving: Option<&'a [Joints]>,
    /// The attributes of the file's vertices.
    attributes: Vec<VertexAttribute>,
    joints: Vec<f64>,
    weights: Vec<f64>,
}

/// No vertex.
const NONE: u32 = u32::MAX;

impl<'a> Vertices<'a> {
    /// None yet, for a surface with so many vertices.
    pub(super) fn new(
        channels: &'a [&'a Channel],
        moving: Option<&'a [Joints]>,
        count: usize,
    ) -> Self {
        let empty = |channel: &&Channel| VertexAttribute {
            is_integer: channel.semantic == Semantic::Label,
            ..VertexAttribute::new(&channel.name, channel.arity, Vec::new())
        };
        let attributes = channels.iter().map(empty).collect();
        Self {
            channels,
            first: vec![NONE; count],
            next: Vec::new(),
            moving,
            attributes,
            joints: Vec::new(),
            weights: Vec::new(),
        }
    }

    /// All attributes, when there are no more vertices.
    pub(super) fn into_attributes(self) -> Vec<VertexAttribute> {
        let mut all = self.attributes;
        if self.moving.is_some() {
            let attribute = |name: &str, values, is_integer| VertexAttribute {
                is_integer,
                ..VertexAttribute::new(name, MOST_JOINTS, values)
            };
            all.push(attribute("JOINTS_0", self.joints, true));
            all.push(attribute("WEIGHTS_0", self.weights, false));
        }
        all
    }

    /// The file's vertex for a corner of the surface at a vertex, which is one of the mesh; a new one has the next number.
    pub(super) fn number(&mut self, v: u32, corner: usize, of_mesh: u32) -> u32 {
        let new = self.next.len() as u32;
        // As if it were new, until a vertex with these values is found.
        for (channel, attribute) in self.channels.iter().zip(&mut self.attributes) {
            attribute.values.extend_from_slice(channel.value(corner));
        }
        let mut known = self.first[v as usize];
        let mut last = NONE;
        while known != NONE {
            let mut attributes = self.attributes.iter();
            if attributes.all(|attribute| is_same(attribute, known, new)) {
                for attribute in &mut self.attributes {
                    attribute.values.truncate(new as usize * attribute.width);
                }
                return known;
            }
            (last, known) = (known, self.next[known as usize]);
        }
        match last {
            NONE => self.first[v as usize] = new,
            last => self.next[last as usize] = new,
        }
        self.next.push(NONE);
        let moving = self
            .moving
            .iter()
            .flat_map(|moving| moving[of_mesh as usize]);
        for (joint, weight) in moving {
            self.joints.push(f64::from(joint));
            self.weights.push(weight);
        }
        new
    }
}

/// Whether two vertices have the same value in a file.
fn is_same(attribute: &VertexAttribute, a: u32, b: u32) -> bool {
    let width = attribute.width;
    let values = |v: u32| &attribute.values[v as usize * width..][..width];
    let of = |v: u32| values(v).iter().map(|&x| x as f32);
    of(a).eq(of(b))
}

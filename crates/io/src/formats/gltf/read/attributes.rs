//! Attributes of a mesh's corners: texture coordinates, colours, weights, and whatever has a name of its own.
//!
//! Files have one vertex for each combination of values; a mesh that is refined has one for each point of its surface, and
//! values at the corners of its faces. So each attribute becomes a table of values with an index for each corner: corners
//! of one vertex whose values are the same, to the bit, share one, also across primitives. What morph targets add is a table for each
//! target and attribute; positions are moved alike at all corners of a vertex.

use super::kinds::Names;
use super::primitive::{AttributeName, Primitive};
use crate::channels::NORMALS;
use crate::formats::gltf::document::numbers::Numbers;
use limitmesh::mesh::{Channel, Domain, Semantic};
use std::collections::HashMap;

/// A table of values, and which of them each corner of a mesh's soup has.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CornerAttribute {
    /// Its name in the document, such as `TEXCOORD_0`; `targets[2].TEXCOORD_0` for what a morph target adds to it.
    pub name: String,
    /// The number of the morph target that adds it.
    pub target: Option<usize>,
    /// Numbers of a value.
    pub width: usize,
    /// One value after the other.
    pub values: Vec<f64>,
    /// By corner of the soup's faces, its value.
    pub corners: Vec<u32>,
    /// Whether the values are whole numbers that name something, so that nothing lies between them.
    pub is_integer: bool,
    /// By part, whether its primitive has the attribute; the values at corners of others are zeros.
    pub is_in: Vec<bool>,
}

impl CornerAttribute {
    /// Its name without that of a morph target: `TEXCOORD_0`.
    pub fn plain_name(&self) -> &str {
        let added = self.target.and_then(|_| self.name.split_once('.'));
        added.map_or(&self.name, |(_, name)| name)
    }

    /// Whether it says how a morph target moves vertices.
    pub fn is_displacement(&self) -> bool {
        self.target.is_some() && self.plain_name() == "POSITION"
    }
}

/// The normals of the primitives `wanted` at the corners of their faces, zero where there are none; `None` if no primitive has any.
pub(super) fn normals(primitives: &[Primitive], wanted: &[usize]) -> Option<Channel> {
    let has_some = |&part: &usize| !primitives[part].normals.is_empty();
    if !wanted.iter().any(has_some) {
        return None;
    }
    let (mut values, mut indices) = (vec![0.0; 3], Vec::new());
    for &part in wanted {
        let Primitive { normals, faces, .. } = &primitives[part];
        let first = (values.len() / 3) as u32;
        let is_number = |n: &[f64; 3]| n.iter().all(|x| x.is_finite());
        values.extend(
            normals
                .iter()
                .flat_map(|n| if is_number(n) { *n } else { [0.0; 3] }),
        );
        let has_none = normals.is_empty();
        let corners = faces.iter().flatten();
        indices.extend(corners.map(|v| if has_none { 0 } else { first + v }));
    }
    Some(Channel::new(NORMALS, Semantic::Other, Domain::Corner, 3).with(values, indices))
}

/// The tables of all attributes of the primitives `wanted` but positions, normals and tangents, and of what morph targets add to any but the
/// last two; `vertex` gives the soup's vertex of a primitive's.
pub(super) fn tables(
    primitives: &[Primitive],
    names: &[Names],
    wanted: &[usize],
    mut vertex: impl FnMut(usize, u32) -> u32,
) -> Vec<CornerAttribute> {
    let mut kinds: Vec<(&AttributeName, usize)> = Vec::new();
    for (name, numbers) in wanted.iter().flat_map(|&part| &primitives[part].attributes) {
        match kinds.iter_mut().find(|(own, _)| *own == name) {
            Some((_, width)) => *width = (*width).max(numbers.components),
            None => kinds.push((name, numbers.components)),
        }
    }
    let tables = kinds.into_iter().map(|(kind, width)| {
        let of = |part: usize| {
            let mut own = primitives[part].attributes.iter();
            own.find(|own| own.0 == *kind).map(|(_, numbers)| numbers)
        };
        let mut all = (0..primitives.len()).filter_map(of);
        let name = match kind.target {
            Some(target) => format!("targets[{target}].{}", kind.name),
            None => kind.name.clone(),
        };
        let mut table = CornerAttribute {
            name,
            target: kind.target,
            width,
            values: Vec::new(),
            corners: Vec::new(),
            is_integer: kind.name.starts_with('_') && all.all(|numbers| numbers.is_integer),
            is_in: wanted.iter().map(|&part| of(part).is_some()).collect(),
        };
        let is_displacement = table.is_displacement();
        let mut known: HashMap<(u32, Vec<u64>), u32> = HashMap::new();
        for &part in wanted {
            let (primitive, own) = (&primitives[part], of(part));
            // A vertex of the file has the same value at all its corners.
            let mut of_vertex: Vec<Option<u32>> = vec![None; primitive.positions.len()];
            for &v in primitive.faces.iter().flatten() {
                let index = *of_vertex[v as usize].get_or_insert_with(|| {
                    let value = value(kind, own, width, v);
                    let bits = |x: &f64| (x + 0.0).to_bits();
                    let key = if is_displacement { &[] } else { &value[..] };
                    let key = key.iter().map(bits).collect();
                    let at = vertex(part, names[part].of_vertex[v as usize]);
                    let next = (table.values.len() / width) as u32;
                    let index = *known.entry((at, key)).or_insert(next);
                    if index == next {
                        table.values.extend(value);
                    }
                    index
                });
                table.corners.push(index);
            }
        }
        table
    });
    tables.collect()
}

/// The value that a vertex of a primitive with these numbers has.
fn value(kind: &AttributeName, own: Option<&Numbers>, width: usize, v: u32) -> Vec<f64> {
    let own = own.map_or(&[][..], |own| {
        &own.values[v as usize * own.components..][..own.components]
    });
    // Colours without alpha are opaque; what is added to them is not.
    let is_part = kind.target.is_none() && !own.is_empty();
    let mut value = own.to_vec();
    value.resize(width, if is_part { 1.0 } else { 0.0 });
    value
}

//! Attributes of a mesh's corners: texture coordinates, colours, weights, and whatever has a name of its own.
//!
//! Files have one vertex for each combination of values; a mesh that is refined has one for each point of its surface, and
//! values at the corners of its faces. So each attribute becomes a table of values with an index for each corner: corners
//! of one vertex whose values are the same, to the bit, share one, also across primitives.

use super::parts::Names;
use super::primitive::Primitive;
use std::collections::HashMap;

/// A table of values, and which of them each corner of a mesh's soup has.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CornerAttribute {
    /// Its name in the document, such as `TEXCOORD_0`.
    pub name: String,
    /// Numbers of a value.
    pub width: usize,
    /// One value after the other.
    pub values: Vec<f64>,
    /// By face of the soup, the values at its corners.
    pub corners: Vec<[u32; 3]>,
    /// Whether the values are whole numbers that name something, so that nothing lies between them.
    pub is_integer: bool,
    /// By part, whether its primitive has the attribute; the values at corners of others are zeros.
    pub is_in: Vec<bool>,
}

/// The tables of all attributes but positions, normals and tangents; `vertex` gives the soup's vertex of a primitive's.
pub(super) fn tables(
    primitives: &[Primitive],
    names: &[Names],
    mut vertex: impl FnMut(usize, u32) -> u32,
) -> Vec<CornerAttribute> {
    let mut kinds: Vec<(String, usize)> = Vec::new();
    for attribute in primitives.iter().flat_map(|primitive| &primitive.attributes) {
        match kinds.iter_mut().find(|(name, _)| *name == attribute.0) {
            Some((_, width)) => *width = (*width).max(attribute.1.components),
            None => kinds.push((attribute.0.clone(), attribute.1.components)),
        }
    }
    let mut tables = Vec::with_capacity(kinds.len());
    for (name, width) in kinds {
        let mut own =
            primitives.iter().flat_map(|primitive| &primitive.attributes).filter(|own| own.0 == name);
        let is_integer = name.starts_with('_') && own.all(|(_, numbers)| numbers.is_integer);
        let (values, corners, is_in) = (Vec::new(), Vec::new(), Vec::new());
        let mut table = CornerAttribute { name, width, values, corners, is_integer, is_in };
        let mut known: HashMap<(u32, Vec<u64>), u32> = HashMap::new();
        for (part, primitive) in primitives.iter().enumerate() {
            let own =
                primitive.attributes.iter().find(|(name, _)| *name == table.name).map(|(_, numbers)| numbers);
            table.is_in.push(own.is_some());
            for triangle in &primitive.triangles {
                let corners = triangle.map(|v| {
                    let mut value = vec![0.0; table.width];
                    if let Some(own) = own {
                        // Colours without alpha are opaque.
                        value.fill(if own.components < table.width { 1.0 } else { 0.0 });
                        let start = v as usize * own.components;
                        value[..own.components].copy_from_slice(&own.values[start..start + own.components]);
                    }
                    let at = vertex(part, names[part].of_vertex[v as usize]);
                    let bits = value.iter().map(|x| (x + 0.0).to_bits()).collect();
                    let next = (table.values.len() / table.width) as u32;
                    let index = *known.entry((at, bits)).or_insert(next);
                    if index == next {
                        table.values.extend(value);
                    }
                    index
                });
                table.corners.push(corners);
            }
        }
        tables.push(table);
    }
    tables
}

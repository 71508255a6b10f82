//! New geometry for a primitive, as bytes and accessors that are appended to the document.
//!
//! Positions and normals are 32-bit floats; bounds are those of the rounded positions, which the specification asks to be
//! exact. Indices have 16 bits where 65,535 vertices or fewer are named: the highest number of each size is reserved.

use crate::flaw::{Flaw, Result};
use serde_json::{Value, json};
use std::collections::BTreeMap;

const FLOAT: u32 = 5126;
const BYTE: u32 = 5121;
const SHORT: u32 = 5123;
const INT: u32 = 5125;

/// The use of a buffer view.
const OF_VERTICES: u32 = 34962;
const OF_INDICES: u32 = 34963;

/// Triangles that take the place of a primitive's.
#[derive(Clone, Copy, Debug)]
pub struct Geometry<'a> {
    /// Positions of the vertices in the mesh's own coordinates.
    pub positions: &'a [[f64; 3]],
    /// A unit normal for each vertex, or zero where there is none: another takes its place in the file.
    pub normals: Option<&'a [[f64; 3]]>,
    /// Vertex indices of each triangle, counter-clockwise seen from outside.
    pub triangles: &'a [[u32; 3]],
    /// Other attributes of the vertices.
    pub attributes: &'a [VertexAttribute],
    /// By morph target, what it adds to these, to positions and to normals: at least one attribute each.
    pub targets: &'a [Vec<VertexAttribute>],
}

/// Values at vertices, such as texture coordinates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VertexAttribute {
    /// Its name, such as `TEXCOORD_0`, also in a morph target.
    pub name: String,
    /// Numbers of a value: 1 to 4.
    pub width: usize,
    /// A value for each vertex, one after the other.
    pub values: Vec<f64>,
    /// Whether they are whole numbers, which are written as such up to 65,535, and else as 32-bit floats.
    pub is_integer: bool,
}

impl VertexAttribute {
    /// Of numbers that need not be whole.
    pub fn new(name: &str, width: usize, values: Vec<f64>) -> Self {
        Self {
            name: name.to_owned(),
            width,
            values,
            is_integer: false,
        }
    }
}

/// The changes of a document.
#[derive(Clone, Debug, Default)]
pub(crate) struct Changes {
    pub(crate) primitives: BTreeMap<PrimitiveAddress, NewPrimitive>,
    pub(crate) appended: Appended,
}

/// Where a primitive is: the numbers of its mesh, and of the primitive in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct PrimitiveAddress {
    pub(crate) mesh: usize,
    pub(crate) primitive: usize,
}

/// The additions to a document: bytes, and views and accessors that name them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Appended {
    pub(crate) bytes: Vec<u8>,
    pub(crate) views: Vec<NewView>,
    /// By accessor all but its view, which has the accessor's number among these.
    pub(crate) accessors: Vec<Value>,
}

/// A part of the appended bytes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NewView {
    pub(crate) start: usize,
    pub(crate) length: usize,
    pub(crate) target: u32,
    /// From one element to the next, where there is something between.
    pub(crate) stride: Option<usize>,
}

/// By attribute, the number of its accessor among the appended ones.
pub(crate) type NewAttributes = Vec<(String, usize)>;

/// The numbers among the appended ones of a primitive's new accessors.
#[derive(Clone, Debug)]
pub(crate) struct NewPrimitive {
    pub(crate) attributes: NewAttributes,
    /// By morph target.
    pub(crate) targets: Vec<NewAttributes>,
    pub(crate) indices: usize,
}

impl Appended {
    /// Appends a primitive's geometry; `place` names it.
    pub(crate) fn add(&mut self, geometry: &Geometry<'_>, place: &str) -> Result<NewPrimitive> {
        let Geometry {
            positions,
            normals,
            triangles,
            attributes: others,
            targets,
        } = *geometry;
        check(geometry, place)?;
        let rounded: Vec<[f32; 3]> = positions.iter().map(|p| p.map(|x| x as f32)).collect();
        let Bounds { low, high } = bounds(positions.as_flattened(), 3);
        let bounded = json!({"componentType": FLOAT, "count": rounded.len(), "type": "VEC3", "min": low, "max": high});
        let position = self.push(floats(&rounded), OF_VERTICES, bounded);
        let mut attributes = vec![("POSITION".to_owned(), position)];
        if let Some(normals) = normals {
            let directions: Vec<[f32; 3]> = normals.iter().map(|&n| unit(n)).collect();
            let plain = json!({"componentType": FLOAT, "count": directions.len(), "type": "VEC3"});
            let normal = self.push(floats(&directions), OF_VERTICES, plain);
            attributes.push(("NORMAL".to_owned(), normal));
        }
        let mut add = |all: &[VertexAttribute], place: &str| -> Result<NewAttributes> {
            let mut number = |own| self.attribute(own, positions.len(), place);
            let found = all.iter().map(|own| Ok((own.name.clone(), number(own)?)));
            found.collect()
        };
        attributes.extend(add(others, &format!("{place}.attributes"))?);
        let targets = targets.iter().enumerate().map(|(number, target)| {
            let place = format!("{place}.targets[{number}]");
            match target.is_empty() {
                true => Err(Flaw::saying(place, "the target has no attribute")),
                false => add(target, &place),
            }
        });
        let targets = targets.collect::<Result<_>>()?;
        let corners = triangles.as_flattened();
        let is_short = positions.len() <= usize::from(u16::MAX);
        let bytes = match is_short {
            true => corners
                .iter()
                .flat_map(|&v| (v as u16).to_le_bytes())
                .collect(),
            false => corners.iter().flat_map(|&v| v.to_le_bytes()).collect(),
        };
        let component = if is_short { SHORT } else { INT };
        let layout = json!({"componentType": component, "count": corners.len(), "type": "SCALAR"});
        let indices = self.push(bytes, OF_INDICES, layout);
        Ok(NewPrimitive {
            attributes,
            targets,
            indices,
        })
    }

    /// Appends values at vertices.
    fn attribute(
        &mut self,
        attribute: &VertexAttribute,
        vertices: usize,
        place: &str,
    ) -> Result<usize> {
        let VertexAttribute {
            name,
            width,
            values,
            is_integer,
        } = attribute;
        let place = || format!("{place}.{name}");
        let kinds = ["SCALAR", "VEC2", "VEC3", "VEC4"];
        let Some(kind) = width.checked_sub(1).and_then(|at| kinds.get(at)) else {
            return Err(Flaw::new(place(), width, "1 to 4 numbers a value"));
        };
        if values.len() != vertices * width {
            let found = format!("{} for {vertices} vertices", values.len());
            return Err(Flaw::new(
                place(),
                found,
                format!("{width} numbers for each vertex"),
            ));
        }
        if let Some(x) = values.iter().find(|&&x| !(x as f32).is_finite()) {
            return Err(Flaw::new(
                place(),
                x,
                "a number that 32-bit floats can hold",
            ));
        }
        let most = values.iter().fold(0.0f64, |most, x| most.max(*x));
        let is_whole = *is_integer && most <= 65_535.0 && values.iter().all(|x| *x >= 0.0);
        let (component, size) = match is_whole {
            true if most <= 255.0 => (BYTE, 1),
            true => (SHORT, 2),
            false => (FLOAT, 4),
        };
        // Vertices begin at multiples of four bytes.
        let stride = (width * size).next_multiple_of(4);
        let mut bytes = Vec::with_capacity(vertices * stride);
        for value in values.chunks_exact(*width) {
            let end = bytes.len() + stride;
            for &x in value {
                match size {
                    1 => bytes.push(x as u8),
                    2 => bytes.extend((x as u16).to_le_bytes()),
                    _ => bytes.extend((x as f32).to_le_bytes()),
                }
            }
            bytes.resize(end, 0);
        }
        let mut accessor = json!({"componentType": component, "count": vertices, "type": kind});
        if name == "POSITION" {
            let Bounds { low, high } = bounds(values, *width);
            (accessor["min"], accessor["max"]) = (low.into(), high.into());
        }
        let number = self.push(bytes, OF_VERTICES, accessor);
        if stride != width * size {
            self.views[number].stride = Some(stride);
        }
        Ok(number)
    }

    fn push(&mut self, bytes: Vec<u8>, target: u32, accessor: Value) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let (start, length) = (self.bytes.len(), bytes.len());
        self.views.push(NewView {
            start,
            length,
            target,
            stride: None,
        });
        self.bytes.extend(bytes);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}

/// Refuses geometry that does not fit together, or that 32-bit floats cannot hold.
fn check(geometry: &Geometry<'_>, place: &str) -> Result<()> {
    let Geometry {
        positions,
        normals,
        triangles,
        ..
    } = *geometry;
    let count = positions.len();
    let normal_count = normals.map_or(count, <[_]>::len);
    let corners = triangles.as_flattened();
    let problem = if count == 0 || triangles.is_empty() || normal_count != count {
        format!(
            "a primitive needs triangles and a normal for each position; it has {count} positions, {normal_count} normals and {} triangles",
            triangles.len()
        )
    } else if let Some(v) = corners.iter().find(|&&v| v as usize >= count) {
        format!("a triangle names vertex {v}, but there are {count}")
    } else if let Some(v) = positions
        .iter()
        .position(|p| p.iter().any(|&x| !(x as f32).is_finite()))
    {
        let position = positions[v];
        format!("32-bit floats cannot hold the coordinates of vertex {v}: {position:?}")
    } else {
        return Ok(());
    };
    Err(Flaw::saying(place, problem))
}

/// The least and the greatest numbers of values as they are written.
struct Bounds {
    low: Vec<f64>,
    high: Vec<f64>,
}

fn bounds(values: &[f64], width: usize) -> Bounds {
    let mut found = Bounds {
        low: vec![f64::INFINITY; width],
        high: vec![f64::NEG_INFINITY; width],
    };
    for value in values.chunks_exact(width) {
        for (i, &x) in value.iter().enumerate() {
            let x = f64::from(x as f32);
            (found.low[i], found.high[i]) = (found.low[i].min(x), found.high[i].max(x));
        }
    }
    found
}

fn floats(rows: &[[f32; 3]]) -> Vec<u8> {
    let all = rows.as_flattened().iter().flat_map(|x| x.to_le_bytes());
    all.collect()
}

/// Of length 1 after rounding, as near as can be; upwards where there is no direction.
fn unit(n: [f64; 3]) -> [f32; 3] {
    let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
    let has_direction = length > 0.0 && length.is_finite();
    if has_direction {
        n.map(|x| (x / length) as f32)
    } else {
        [0.0, 0.0, 1.0]
    }
}

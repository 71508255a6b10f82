//! Named numbers for each vertex or each triangle, which PLY files hold as scalar properties.

use super::Output;
use super::numbers::Piece;
use crate::error::WriteError;
use crate::format::Format;

/// A named number for each vertex or for each triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Property<'a> {
    /// Its name in the file: visible ASCII characters, none that the file has already.
    pub name: &'a str,
    /// One number for each vertex or triangle.
    pub values: PropertyValues<'a>,
}

/// The numbers of a property.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum PropertyValues<'a> {
    /// Whole numbers, such as indices: `int` in the file, or `uint` if one of them is beyond 2³¹.
    Integers(&'a [u32]),
    /// Finite numbers: `double` in the file.
    Numbers(&'a [f64]),
}

impl<'a> Property<'a> {
    /// Whole numbers under a name.
    pub fn integers(name: &'a str, values: &'a [u32]) -> Self {
        Self {
            name,
            values: PropertyValues::Integers(values),
        }
    }

    /// Numbers under a name.
    pub fn numbers(name: &'a str, values: &'a [f64]) -> Self {
        Self {
            name,
            values: PropertyValues::Numbers(values),
        }
    }

    /// PLY's name of the numbers' type.
    pub(super) fn kind(&self) -> &'static str {
        match self.values {
            // Many readers know signed integers only.
            PropertyValues::Integers(values) if values.iter().all(|&v| v <= i32::MAX as u32) => {
                "int"
            }
            PropertyValues::Integers(_) => "uint",
            PropertyValues::Numbers(_) => "double",
        }
    }

    fn count(&self) -> usize {
        match self.values {
            PropertyValues::Integers(values) => values.len(),
            PropertyValues::Numbers(values) => values.len(),
        }
    }

    /// Writes the little-endian bytes of an element's number.
    #[inline]
    pub(super) fn bytes(&self, out: &mut Piece, element: usize) {
        match self.values {
            // Up to 2³¹ − 1, the bytes of `int` and of `uint` are the same.
            PropertyValues::Integers(values) => out.bytes(&values[element].to_le_bytes()),
            PropertyValues::Numbers(values) => out.bytes(&values[element].to_le_bytes()),
        }
    }

    /// Writes an element's number as text, a blank before it.
    pub(super) fn text(&self, out: &mut Piece, element: usize) {
        match self.values {
            PropertyValues::Integers(values) => out.integer(values[element]),
            PropertyValues::Numbers(values) => out.number(values[element]),
        }
    }
}

/// Names of what the writer puts beside positions.
const VERTEX_NAMES: [&str; 10] = [
    "x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "quality",
];
const FACE_NAMES: [&str; 1] = ["vertex_indices"];

/// Checks names, counts and values of an output's properties.
pub(super) fn check(output: &Output<'_>) -> Result<(), WriteError> {
    let (vertices, triangles) = (
        output.surface.positions.len(),
        output.surface.triangles.len(),
    );
    check_all(
        output.vertex_properties,
        &VERTEX_NAMES,
        vertices,
        "vertices",
    )?;
    check_all(output.face_properties, &FACE_NAMES, triangles, "triangles")
}

fn check_all(
    properties: &[Property<'_>],
    taken: &[&str],
    elements: usize,
    what: &'static str,
) -> Result<(), WriteError> {
    for (i, property) in properties.iter().enumerate() {
        let name = property.name;
        let visible = !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_graphic());
        if !visible
            || taken.contains(&name)
            || properties[..i].iter().any(|other| other.name == name)
        {
            return Err(WriteError::PropertyName {
                name: name.to_owned(),
            });
        }
        if property.count() != elements {
            let (name, count) = (name.to_owned(), property.count());
            return Err(WriteError::PropertyCount {
                name,
                count,
                elements,
                what,
            });
        }
        let PropertyValues::Numbers(values) = property.values else {
            continue;
        };
        if let Some(element) = values.iter().position(|value| !value.is_finite()) {
            let (name, value) = (name.to_owned(), values[element]);
            return Err(WriteError::PropertyNotFinite {
                name,
                element,
                value,
                format: Format::Ply,
            });
        }
    }
    Ok(())
}

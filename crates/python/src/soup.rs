//! From arrays to a soup: each number is looked at and copied once.

use limitmesh::PolygonSoup;
use limitmesh::mesh::{CornerTag, CreaseTag, PolygonFaces};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::channels::ChannelIn;
use crate::errors::{MeshError, OptionError};

/// A mesh as the Python half hands it over: C-contiguous arrays.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct MeshIn<'py> {
    vertices: PyReadonlyArray2<'py, f64>,
    /// Vertices of all polygons, one after the other.
    corners: PyReadonlyArray1<'py, i64>,
    /// Where each polygon starts among these, and the end of the last; none where each has three corners.
    starts: Option<PyReadonlyArray1<'py, i64>>,
    /// Sharp edges and vertices with their sharpness.
    creases: Vec<(i64, i64, f64)>,
    corner_tags: Vec<(i64, f64)>,
    channels: Vec<ChannelIn<'py>>,
}

impl MeshIn<'_> {
    /// The soup.
    ///
    /// # Errors
    /// A vertex that there is not.
    pub(crate) fn soup(&self) -> PyResult<PolygonSoup> {
        let positions = positions(&self.vertices)?;
        let corners = self.corners.as_slice()?;
        let starts = self
            .starts
            .as_ref()
            .map(|starts| starts.as_slice())
            .transpose()?;
        let faces = faces(corners, starts, positions.len())?;
        let count = positions.len();
        let vertex = |v: i64, what: &str, row: usize| match u32::try_from(v) {
            Ok(v) if (v as usize) < count => Ok(v),
            _ => Err(OptionError::new_err(format!(
                "{what}[{row}] names vertex {v}, {}",
                expected(count)
            ))),
        };
        let creases = self
            .creases
            .iter()
            .enumerate()
            .map(|(row, &(a, b, sharpness))| {
                let vertices = [vertex(a, "creases", row)?, vertex(b, "creases", row)?];
                Ok(CreaseTag {
                    vertices,
                    sharpness,
                })
            });
        let tags = self
            .corner_tags
            .iter()
            .enumerate()
            .map(|(row, &(v, sharpness))| {
                Ok(CornerTag {
                    vertex: vertex(v, "corners", row)?,
                    sharpness,
                })
            });
        let channels = self.channels.iter().map(ChannelIn::channel);
        Ok(PolygonSoup {
            creases: creases.collect::<PyResult<_>>()?,
            corners: tags.collect::<PyResult<_>>()?,
            channels: channels.collect::<PyResult<_>>()?,
            positions,
            faces,
            ..PolygonSoup::default()
        })
    }
}

/// Rows of three numbers.
pub(crate) fn positions(array: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<[f64; 3]>> {
    let flat = array.as_slice()?;
    let (rows, rest) = flat.as_chunks::<3>();
    if !rest.is_empty() {
        return Err(MeshError::new_err("rows of three numbers were expected"));
    }
    Ok(rows.to_vec())
}

/// Rows of three numbers as indices, with no more said about them.
pub(crate) fn triangles(array: &PyReadonlyArray2<'_, u32>) -> PyResult<Vec<[u32; 3]>> {
    let (rows, rest) = array.as_slice()?.as_chunks::<3>();
    if !rest.is_empty() {
        return Err(MeshError::new_err("rows of three numbers were expected"));
    }
    Ok(rows.to_vec())
}

fn faces(corners: &[i64], starts: Option<&[i64]>, count: usize) -> PyResult<PolygonFaces> {
    let polygons = starts.map_or(corners.len() / 3, |starts| starts.len().saturating_sub(1));
    if corners.len() > u32::MAX as usize || count > u32::MAX as usize {
        return Err(MeshError::new_err(
            "more vertices or corners than 32 bits can count",
        ));
    }
    let mut faces = PolygonFaces::with_capacity(polygons, corners.len());
    let mut own: Vec<u32> = Vec::new();
    for face in 0..polygons {
        let range = match starts {
            None => 3 * face..3 * face + 3,
            Some(starts) => starts[face] as usize..starts[face + 1] as usize,
        };
        let row = corners
            .get(range)
            .ok_or_else(|| MeshError::new_err("polygons that end beyond the corners"))?;
        own.clear();
        for (column, &v) in row.iter().enumerate() {
            match u32::try_from(v) {
                Ok(v) if (v as usize) < count => own.push(v),
                _ => {
                    return Err(MeshError::new_err(format!(
                        "faces[{face}] names vertex {v} in column {column}, {}",
                        expected(count)
                    )));
                }
            }
        }
        faces.push(&own);
    }
    Ok(faces)
}

fn expected(count: usize) -> String {
    match count {
        0 => "but there are no vertices".to_owned(),
        count => format!("expected 0 to {}", count - 1),
    }
}

/// A soup that nothing is asked of but its triangles: polygons become fans.
pub(crate) fn as_triangles(soup: &PolygonSoup) -> Vec<[u32; 3]> {
    let mut triangles = Vec::with_capacity(soup.faces.len());
    for face in soup.faces.iter() {
        for pair in face.get(1..).unwrap_or_default().windows(2) {
            triangles.push([face[0], pair[0], pair[1]]);
        }
    }
    triangles
}

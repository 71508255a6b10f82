//! From arrays to a soup.

use limitmesh::PolygonSoup;
use limitmesh::mesh::{CornerTag, CreaseTag, PolygonFaces};

use crate::channels::channel;
use crate::failure::Failure;
use crate::inputs::MeshIn;

/// The soup of a mesh.
///
/// # Errors
/// Numbers that are no rows, a vertex that there is not, a name that stands for nothing.
pub(crate) fn soup(mesh: &MeshIn) -> Result<PolygonSoup, Failure> {
    let positions = positions(mesh)?;
    let count = positions.len();
    let channels = mesh.channels();
    Ok(PolygonSoup {
        faces: faces(mesh, count)?,
        creases: creases(mesh, count)?,
        corners: corners(mesh, count)?,
        channels: channels
            .iter()
            .enumerate()
            .map(|(row, own)| channel(row, own))
            .collect::<Result<_, _>>()?,
        positions,
        ..PolygonSoup::default()
    })
}

fn positions(mesh: &MeshIn) -> Result<Vec<[f64; 3]>, Failure> {
    let flat = mesh.positions();
    let (rows, rest) = flat.as_chunks::<3>();
    match rest {
        [] => Ok(rows.to_vec()),
        _ => Err(Failure::mesh(
            "positions",
            format!(
                "positions has {} numbers, expected three a vertex",
                flat.len()
            ),
        )),
    }
}

fn faces(mesh: &MeshIn, count: usize) -> Result<PolygonFaces, Failure> {
    let (corners, size) = (mesh.corners(), mesh.face_size().max(3) as usize);
    let rows = corners.chunks_exact(size);
    if !rows.remainder().is_empty() {
        let message = format!(
            "index has {} numbers, expected {size} a face",
            corners.len()
        );
        return Err(Failure::mesh("index", message));
    }
    check(&corners, "index", count, Failure::mesh)?;
    Ok(rows.collect())
}

fn creases(mesh: &MeshIn, count: usize) -> Result<Vec<CreaseTag>, Failure> {
    let edges = mesh.crease_edges();
    check(&edges, "creases", count, Failure::option)?;
    let pairs = edges.as_chunks::<2>().0.iter();
    let tag = |(&vertices, sharpness)| CreaseTag {
        vertices,
        sharpness,
    };
    Ok(pairs.zip(mesh.crease_sharpness()).map(tag).collect())
}

fn corners(mesh: &MeshIn, count: usize) -> Result<Vec<CornerTag>, Failure> {
    let vertices = mesh.corner_vertices();
    check(&vertices, "corners", count, Failure::option)?;
    let tag = |(vertex, sharpness)| CornerTag { vertex, sharpness };
    Ok(vertices
        .into_iter()
        .zip(mesh.corner_sharpness())
        .map(tag)
        .collect())
}

/// That all of these are vertices.
fn check(
    vertices: &[u32],
    name: &str,
    count: usize,
    failure: impl Fn(String, String) -> Failure,
) -> Result<(), Failure> {
    let Some(row) = vertices.iter().position(|&v| v as usize >= count) else {
        return Ok(());
    };
    let (vertex, place) = (vertices[row], format!("{name}[{row}]"));
    let expected = match count {
        0 => "but there are no vertices".to_owned(),
        count => format!("expected 0 to {}", count - 1),
    };
    let message = format!("{place} names vertex {vertex}, {expected}");
    Err(failure(place, message))
}

/// A soup that nothing is asked of but its triangles: polygons become fans.
pub(crate) fn as_triangles(soup: &PolygonSoup) -> Vec<[u32; 3]> {
    let fan = |face: &[u32]| -> Vec<[u32; 3]> {
        let rest = face.get(1..).unwrap_or_default().windows(2);
        rest.map(|pair| [face[0], pair[0], pair[1]]).collect()
    };
    soup.faces.iter().flat_map(fan).collect()
}

//! How a mesh is shaded: by the normals of its file, or without any by its faces, apart on both sides of sharp edges.

use limitmesh::Mesh;
use limitmesh::mesh::{Channel, MeshError, SplitSurface};

use crate::vector::{cross, dot, minus, vector};

/// Where faces meet at more than so many degrees, an edge looks sharp.
const SHARP: f64 = 30.0;

/// A mesh of a file that has no normals.
///
/// # Errors
/// None: the angle is one.
pub(super) fn without_normals(mesh: &Mesh) -> Result<SplitSurface, MeshError> {
    Ok(SplitSurface::by_faces(
        &mesh.clone().with_creases_above(SHARP.to_radians())?,
    ))
}

/// A mesh with the normals that its file has; with those of its faces where it has none.
pub(super) fn by_normals(mesh: &Mesh, normals: &Channel) -> SplitSurface {
    let by_faces = SplitSurface::by_faces(mesh);
    // The way round says which side is drawn, and may have been mended: normals are those of that side.
    let faces_against = |face: usize| {
        let [a, b, c] = mesh.triangles()[face].map(|v| mesh.positions()[v as usize]);
        let own = cross(minus(b, a), minus(c, a));
        (3 * face..3 * face + 3)
            .map(|corner| dot(own, vector(normals.value(corner))))
            .sum::<f64>()
            < 0.0
    };
    let is_against: Vec<bool> = (0..mesh.face_count()).map(faces_against).collect();
    SplitSurface::new(mesh, |h| {
        let (corner, face) = (h.index(), h.face().index());
        let own = vector(normals.value(corner));
        let length = own.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length > 0.0 && length.is_finite() {
            let length = if is_against[face] { -length } else { length };
            return own.map(|x| x / length);
        }
        by_faces.normals[by_faces.triangles[face][corner % 3] as usize]
    })
}

//! Triangles that are turned over.

use crate::mesh::{FaceParts, Triangles};
use crate::parallel;
use crate::refine::Exact;
use crate::vector::{DVec3, vector};

/// How many triangles of a result are turned over: their normal is more than 90° from the limit normal at one of their corners
/// ([`Exact::inverted_triangles`]), or from the normals of all faces of the mesh that was given that share a vertex with their own.
///
/// The control mesh's faces are `parts` of those of `input`. After edges were collapsed only limit normals are compared.
pub fn turned_over_triangles(input: Triangles<'_>, found: &Exact, parts: &FaceParts) -> usize {
    turned_over(input, found, parts).len()
}

/// These triangles, ascending.
pub(super) fn turned_over(input: Triangles<'_>, found: &Exact, parts: &FaceParts) -> Vec<u32> {
    let mut all = found.turned_over();
    if found.is_collapsed() {
        return all;
    }
    let normal_of = |face: u32| normal(input, face as usize);
    let looks_away = |triangle: u32, face: u32| {
        found
            .mesh
            .scaled_face_normal(triangle as usize)
            .dot(normal_of(face))
            < 0.0
    };
    let whole = |triangle: u32| parts.whole(found.parents[triangle as usize]);
    let pieces = parallel::pieces(found.mesh.face_count(), |triangles| {
        let triangles = triangles.map(|triangle| triangle as u32);
        triangles
            .filter(|&triangle| looks_away(triangle, whole(triangle)))
            .collect::<Vec<_>>()
    });
    let mut suspects = pieces.concat();
    if !suspects.is_empty() {
        let around = Around::of(input);
        suspects.retain(|&triangle| {
            around
                .faces(whole(triangle))
                .all(|face| looks_away(triangle, face))
        });
    }
    all.extend(suspects);
    all.sort_unstable();
    all.dedup();
    all
}

fn normal(mesh: Triangles<'_>, face: usize) -> DVec3 {
    let [a, b, c] = mesh.corners(face).map(vector);
    (b - a).cross(c - a)
}

/// The faces at the vertices of a mesh.
struct Around<'m> {
    mesh: Triangles<'m>,
    /// Where the faces of each vertex start in the list, and its end.
    starts: Vec<u32>,
    faces: Vec<u32>,
}

impl<'m> Around<'m> {
    fn of(mesh: Triangles<'m>) -> Self {
        let corners = || {
            (0..)
                .zip(mesh.triangles)
                .flat_map(|(face, corners)| corners.map(|v| (v as usize, face)))
        };
        let mut starts = vec![0u32; mesh.positions.len() + 1];
        corners().for_each(|(v, _)| starts[v + 1] += 1);
        for v in 0..mesh.positions.len() {
            starts[v + 1] += starts[v];
        }
        let (mut next, mut faces) = (starts.clone(), vec![0; 3 * mesh.triangles.len()]);
        for (v, face) in corners() {
            faces[next[v] as usize] = face;
            next[v] += 1;
        }
        Self {
            mesh,
            starts,
            faces,
        }
    }

    /// The faces that share a vertex with one, and itself.
    fn faces(&self, face: u32) -> impl Iterator<Item = u32> {
        let corners = self.mesh.triangles[face as usize];
        corners.into_iter().flat_map(|v| {
            let [start, end] = [v, v + 1].map(|v| self.starts[v as usize] as usize);
            self.faces[start..end].iter().copied()
        })
    }
}

//! Where the vertices and triangles of an exact refinement came from, as properties of a PLY file.

use limitmesh::mesh::FaceParts;
use limitmesh::refine::Origin;
use limitmesh_io::Property;

/// Columns of numbers, one for each vertex or triangle.
pub(super) struct Provenance {
    /// Of each vertex.
    faces: Vec<u32>,
    barycentric: [Vec<f64>; 3],
    /// Of each triangle; none where triangles reach over several control faces.
    parents: Vec<u32>,
}

impl Provenance {
    /// Takes the origins of the vertices and the parents of the triangles apart; those on parts of faces are told of the
    /// whole ones.
    pub(super) fn new(origins: &[Origin], parents: Vec<u32>, parts: &FaceParts) -> Self {
        let on_whole = |origin: &Origin| parts.on_whole(origin.face, origin.barycentric);
        let column = |corner: usize| origins.iter().map(|origin| on_whole(origin).1[corner]).collect();
        Self {
            faces: origins.iter().map(|origin| parts.whole(origin.face)).collect(),
            barycentric: [0, 1, 2].map(column),
            parents: parents.into_iter().map(|face| parts.whole(face)).collect(),
        }
    }

    /// Properties of the vertices.
    pub(super) fn of_vertices(&self) -> [Property<'_>; 4] {
        let [a, b, c] = &self.barycentric;
        [
            Property::integers("parent_face", &self.faces),
            Property::numbers("parent_a", a),
            Property::numbers("parent_b", b),
            Property::numbers("parent_c", c),
        ]
    }

    /// Properties of the triangles.
    pub(super) fn of_faces(&self) -> Vec<Property<'_>> {
        let parents = Property::integers("parent_face", &self.parents);
        if self.parents.is_empty() { Vec::new() } else { vec![parents] }
    }
}

//! Where the vertices and triangles of an exact refinement came from, as properties of a PLY file.

use limitmesh::mesh::FaceParts;
use limitmesh::refine::Origin;
use limitmesh_io::Property;

/// Columns of numbers, one for each vertex or triangle.
#[derive(Clone)]
pub(super) struct Provenance {
    /// Of each vertex.
    faces: Vec<u32>,
    barycentric: [Vec<f64>; 3],
    /// Of each triangle; none where triangles reach over several control faces.
    parents: Vec<u32>,
    /// The input's faces, as they were counted before any was cut or left out: of each vertex, and of each triangle.
    inputs: [Vec<u32>; 2],
}

impl Provenance {
    /// Takes the origins of the vertices and the parents of the triangles apart; those on parts of faces are told of the
    /// whole ones, and `inputs` is the input's face of each of these.
    pub(super) fn new(
        origins: &[Origin],
        parents: Vec<u32>,
        (inputs, parts): (&[u32], &FaceParts),
    ) -> Self {
        let input = |face: u32| inputs[parts.whole(face) as usize];
        let of_vertices = origins.iter().map(|origin| input(origin.face)).collect();
        let of_triangles = parents.iter().map(|&face| input(face)).collect();
        let on_whole = |origin: &Origin| parts.on_whole(origin.face, origin.barycentric);
        let column = |corner: usize| {
            origins
                .iter()
                .map(|origin| on_whole(origin).1[corner])
                .collect()
        };
        Self {
            faces: origins
                .iter()
                .map(|origin| parts.whole(origin.face))
                .collect(),
            barycentric: [0, 1, 2].map(column),
            parents: parents.into_iter().map(|face| parts.whole(face)).collect(),
            inputs: [of_vertices, of_triangles],
        }
    }

    /// The same where vertices stand several times: by what they are copies of.
    pub(super) fn of(&self, sources: &[u32]) -> Self {
        let whole = |list: &[u32]| sources.iter().map(|&v| list[v as usize]).collect();
        let [of_vertices, of_triangles] = &self.inputs;
        Self {
            faces: whole(&self.faces),
            barycentric: self
                .barycentric
                .each_ref()
                .map(|list| sources.iter().map(|&v| list[v as usize]).collect()),
            parents: self.parents.clone(),
            inputs: [whole(of_vertices), of_triangles.clone()],
        }
    }

    /// Properties of the vertices.
    pub(super) fn of_vertices(&self) -> [Property<'_>; 5] {
        let [a, b, c] = &self.barycentric;
        [
            Property::integers("parent_face", &self.faces),
            Property::numbers("parent_a", a),
            Property::numbers("parent_b", b),
            Property::numbers("parent_c", c),
            Property::integers("input_face", &self.inputs[0]),
        ]
    }

    /// Properties of the triangles.
    pub(super) fn of_faces(&self) -> Vec<Property<'_>> {
        if self.parents.is_empty() {
            return Vec::new();
        }
        let inputs = Property::integers("input_face", &self.inputs[1]);
        vec![Property::integers("parent_face", &self.parents), inputs]
    }
}

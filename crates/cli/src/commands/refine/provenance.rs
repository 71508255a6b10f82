//! Where the vertices and triangles of a refinement came from, as properties of a PLY file.

use limitmesh::mesh::FaceParts;
use limitmesh::refine::Origin;
use limitmesh_io::Property;

/// Columns of numbers, one for each vertex or triangle.
#[derive(Clone)]
pub(super) struct Provenance {
    vertices: Vertices,
    /// Of each triangle; none where triangles reach over several control faces.
    parents: Vec<u32>,
    /// The input's face of each triangle, as it was counted before any was cut or left out.
    inputs: Vec<u32>,
}

/// Columns of the vertices.
#[derive(Clone)]
struct Vertices {
    faces: Vec<u32>,
    barycentric: [Vec<f64>; 3],
    /// The input's faces.
    inputs: Vec<u32>,
}

impl Provenance {
    /// The columns of origins and parents; those on parts of faces name the whole ones, and `inputs` has the input's face of each of
    /// these.
    pub(super) fn new(
        origins: &[Origin],
        parents: &[u32],
        inputs: &[u32],
        parts: &FaceParts,
    ) -> Self {
        let input = |face: u32| inputs[parts.whole(face) as usize];
        let weight = |origin: &Origin, corner: usize| {
            parts.on_whole(origin.face, origin.barycentric).1[corner]
        };
        let column = |corner| origins.iter().map(|own| weight(own, corner)).collect();
        Self {
            vertices: Vertices {
                faces: origins.iter().map(|own| parts.whole(own.face)).collect(),
                barycentric: [0, 1, 2].map(column),
                inputs: origins.iter().map(|own| input(own.face)).collect(),
            },
            parents: parents.iter().map(|&face| parts.whole(face)).collect(),
            inputs: parents.iter().map(|&face| input(face)).collect(),
        }
    }

    /// The columns where vertices stand several times: `sources` says what they are copies of.
    pub(super) fn of_copies(&self, sources: &[u32]) -> Self {
        fn copied<T: Copy>(list: &[T], sources: &[u32]) -> Vec<T> {
            sources.iter().map(|&v| list[v as usize]).collect()
        }
        let own = &self.vertices;
        Self {
            vertices: Vertices {
                faces: copied(&own.faces, sources),
                barycentric: own.barycentric.each_ref().map(|list| copied(list, sources)),
                inputs: copied(&own.inputs, sources),
            },
            ..self.clone()
        }
    }

    /// Properties of the vertices.
    pub(super) fn of_vertices(&self) -> [Property<'_>; 5] {
        let [a, b, c] = &self.vertices.barycentric;
        [
            Property::integers("parent_face", &self.vertices.faces),
            Property::numbers("parent_a", a),
            Property::numbers("parent_b", b),
            Property::numbers("parent_c", c),
            Property::integers("input_face", &self.vertices.inputs),
        ]
    }

    /// Properties of the triangles.
    pub(super) fn of_faces(&self) -> Vec<Property<'_>> {
        if self.parents.is_empty() {
            return Vec::new();
        }
        let inputs = Property::integers("input_face", &self.inputs);
        vec![Property::integers("parent_face", &self.parents), inputs]
    }
}

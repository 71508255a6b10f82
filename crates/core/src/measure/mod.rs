//! Measurement: distances between surfaces, watertightness, triangle quality.

mod bvh;
mod hausdorff;
mod quality;
mod watertight;

pub use bvh::{Bvh, ClosestPoint};
pub use hausdorff::{Hausdorff, OneSided, SamplingOptions, distances_to, hausdorff};
pub use quality::{TriangleQuality, triangle_quality};
pub use watertight::{Watertightness, watertightness};

/// Why something could not be measured.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeasureError {
    /// A surface without triangles has no distance to anything.
    #[error("the {which} surface has no triangles")]
    Empty {
        /// Which of the two.
        which: &'static str,
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {face} of the {which} surface names vertex {vertex}, but there are {count} vertices")]
    VertexOutOfRange {
        /// Which of the two surfaces.
        which: &'static str,
        /// The triangle at fault.
        face: usize,
        /// The index met.
        vertex: u32,
        /// Number of vertices.
        count: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} of the {which} surface: coordinate {axis} is {value}, expected a finite number")]
    NotFinite {
        /// Which of the two surfaces.
        which: &'static str,
        /// The vertex at fault.
        vertex: usize,
        /// 0, 1 or 2 for x, y or z.
        axis: usize,
        /// The value met.
        value: f64,
    },
}

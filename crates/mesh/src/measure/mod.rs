//! Measurement: distances between surfaces, watertightness, triangle quality.
//!
//! Takes [`Triangles`], manifold or not.

mod bvh;
mod certified;
mod climb;
mod frame;
mod hausdorff;
mod quality;
mod samples;
mod watertight;

pub use bvh::{Bvh, ClosestPoint};
pub use certified::certified_known;
pub use certified::{
    Bounds, CertifiedHausdorff, CertifiedOptions, certified_hausdorff, certified_hausdorff_between,
    certified_hausdorff_between_observed, certified_hausdorff_observed,
};
pub(crate) use certified::{Target, Worker};
pub use hausdorff::{
    Hausdorff, OneSided, SamplingOptions, distances_to, distances_to_observed, hausdorff,
    hausdorff_between, hausdorff_between_observed, hausdorff_observed,
};
pub use quality::{TriangleQuality, triangle_quality};
pub use watertight::{Watertightness, watertightness, watertightness_observed};

use crate::error_messages;
use crate::mesh::Triangles;
use crate::parallel;
use crate::progress::Cancelled;

/// An error of a measurement.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum MeasureError {
    /// A surface without triangles has no distance to anything.
    Empty {
        /// Which of the two.
        which: &'static str,
    },
    /// More triangles than `u32` indices can name.
    TooMany {
        /// Which of the two surfaces.
        which: &'static str,
        /// How many there are.
        count: usize,
    },
    /// A triangle names a vertex that does not exist.
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
    /// A coordinate so large that distances could not be represented.
    TooLarge {
        /// Which of the two surfaces.
        which: &'static str,
        /// The value met, without its sign.
        value: f64,
        /// The greatest allowed.
        greatest: f64,
    },
    /// The observer asked to stop.
    Cancelled(Cancelled),
}

error_messages! {
    MeasureError {
        Self::Empty { which } => ("the {which} surface has no triangles"),
        Self::TooMany { which, count } => ("the {which} surface has {count} triangles, at most {} can be measured",
        u32::MAX),
        Self::VertexOutOfRange { which, face, vertex, count } => ("triangle {face} of the {which} surface names vertex {vertex}, but there are {count} vertices"),
        Self::NotFinite { which, vertex, axis, value } => ("vertex {vertex} of the {which} surface: coordinate {axis} is {value}, which is no finite number"),
        Self::TooLarge { which, value, greatest } => ("the {which} surface has a coordinate of {value:e}, at most {greatest:e} can be measured"),
    }
    from { Cancelled(Cancelled) }
}

/// Refuses surfaces without distances: no triangles, an index out of range, a coordinate that is
/// not finite. `which` names the surface in the error.
fn check(surface: Triangles<'_>, which: &'static str) -> Result<(), MeasureError> {
    if surface.triangles.is_empty() {
        return Err(MeasureError::Empty { which });
    }
    if surface.triangles.len() > u32::MAX as usize {
        return Err(MeasureError::TooMany {
            which,
            count: surface.triangles.len(),
        });
    }
    let count = surface.positions.len();
    let out_of_range = |face: usize| surface.triangles[face].iter().any(|&v| v as usize >= count);
    if let Some(face) = parallel::first(surface.triangles.len(), out_of_range) {
        let vertex = surface.triangles[face]
            .into_iter()
            .find(|&v| v as usize >= count)
            .unwrap_or_default();
        return Err(MeasureError::VertexOutOfRange {
            which,
            face,
            vertex,
            count,
        });
    }
    check_finite(surface.positions, which)
}

/// Refuses NaN and infinity, and names the first place.
fn check_finite(points: &[[f64; 3]], which: &'static str) -> Result<(), MeasureError> {
    let not_finite = |vertex: usize| !points[vertex].iter().all(|x| x.is_finite());
    if let Some(vertex) = parallel::first(points.len(), not_finite) {
        let axis = points[vertex]
            .iter()
            .position(|x| !x.is_finite())
            .unwrap_or_default();
        return Err(MeasureError::NotFinite {
            which,
            vertex,
            axis,
            value: points[vertex][axis],
        });
    }
    Ok(())
}

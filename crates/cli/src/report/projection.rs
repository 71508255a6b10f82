//! The report of `limitmesh project`.

use serde::Serialize;

use crate::arguments::SchemeName;

/// All of it. Lengths are in the control mesh's unit.
#[derive(Debug, Serialize)]
pub(crate) struct ProjectionReport {
    pub(crate) version: &'static str,
    pub(crate) points: PointsReport,
    pub(crate) control: ControlReport,
    /// How much nearer the surface may be than what was found.
    pub(crate) tolerance: f64,
    /// What tells the sign of distances: `inside` of a closed surface, or the `normal` of an open one at the closest point.
    pub(crate) sign: &'static str,
    /// Of all points; null without any.
    pub(crate) distance: Option<DistancesReport>,
    pub(crate) seconds: f64,
}

/// The points.
#[derive(Debug, Serialize)]
pub(crate) struct PointsReport {
    /// As given on the command line.
    pub(crate) path: String,
    pub(crate) count: usize,
}

/// The control mesh.
#[derive(Debug, Serialize)]
pub(crate) struct ControlReport {
    /// As given on the command line.
    pub(crate) path: String,
    pub(crate) triangles: usize,
    pub(crate) diagonal: f64,
    pub(crate) scheme: SchemeName,
}

/// Statistics of distances.
#[derive(Debug, Serialize)]
pub(crate) struct DistancesReport {
    /// The mean of the distances without their signs.
    pub(crate) mean: f64,
    pub(crate) root_mean_square: f64,
    /// Half of the points are no farther, without signs.
    pub(crate) median: f64,
    /// 95 of 100 points are no farther, without signs.
    pub(crate) percentile_95: f64,
    /// The mean of the signed distances.
    pub(crate) signed_mean: f64,
    /// The least and the greatest of the signed distances.
    pub(crate) least: f64,
    pub(crate) greatest: f64,
    /// Points with distances below 0.
    pub(crate) negative: usize,
    /// The point that is farthest away.
    pub(crate) farthest: FarthestReport,
}

/// The point that is farthest away.
#[derive(Debug, Serialize)]
pub(crate) struct FarthestReport {
    /// Which one, from 0.
    pub(crate) index: usize,
    pub(crate) point: [f64; 3],
    /// With its sign.
    pub(crate) distance: f64,
    /// No point of the surface is nearer than this.
    pub(crate) lower: f64,
    pub(crate) closest: [f64; 3],
    /// The control mesh's triangle, from 0.
    pub(crate) face: u32,
    pub(crate) barycentric: [f64; 3],
}

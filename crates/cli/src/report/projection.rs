//! The report of `limitmesh project`.

use serde::Serialize;

use crate::arguments::SchemeName;

/// How far points are from a limit surface. Lengths are in the control mesh's unit.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct ProjectionReport {
    /// The program's version.
    pub(crate) version: &'static str,
    /// The points.
    pub(crate) points: PointsReport,
    /// The control mesh.
    pub(crate) control: ControlReport,
    /// How much nearer the surface may be than what was found.
    pub(crate) tolerance: f64,
    /// The source of the sign of distances: `inside` of a closed surface, or the `normal` of an open one at the closest point.
    pub(crate) sign: &'static str,
    /// Of all points; null without any.
    pub(crate) distance: Option<DistancesReport>,
    /// How long it took.
    pub(crate) seconds: f64,
}

/// The points.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct PointsReport {
    /// As given on the command line.
    pub(crate) path: String,
    /// How many points there are.
    pub(crate) count: usize,
}

/// The control mesh.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct ControlReport {
    /// As given on the command line.
    pub(crate) path: String,
    /// Its triangles.
    pub(crate) triangles: usize,
    /// The diagonal of its bounding box.
    pub(crate) diagonal: f64,
    /// The subdivision scheme.
    pub(crate) scheme: SchemeName,
}

/// Statistics of distances.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct DistancesReport {
    /// The mean of the distances without their signs.
    pub(crate) mean: f64,
    /// The root mean square of the distances.
    pub(crate) root_mean_square: f64,
    /// Half of the points are no farther, without signs.
    pub(crate) median: f64,
    /// 95 of 100 points are no farther, without signs.
    pub(crate) percentile_95: f64,
    /// The mean of the signed distances.
    pub(crate) signed_mean: f64,
    /// The least of the signed distances.
    pub(crate) least: f64,
    /// The greatest of the signed distances.
    pub(crate) greatest: f64,
    /// Points with distances below 0.
    pub(crate) negative: usize,
    /// The point that is farthest away.
    pub(crate) farthest: FarthestReport,
}

/// The point that is farthest away.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct FarthestReport {
    /// Which one, from 0.
    pub(crate) index: usize,
    /// Where it is.
    pub(crate) point: [f64; 3],
    /// Its distance, with its sign.
    pub(crate) distance: f64,
    /// No point of the surface is nearer than this.
    pub(crate) lower: f64,
    /// The closest point that was found.
    pub(crate) closest: [f64; 3],
    /// The control mesh's triangle, from 0.
    pub(crate) face: u32,
    /// The weights of that triangle's corners.
    pub(crate) barycentric: [f64; 3],
}

//! What `limitmesh lod` says of its levels.

use serde::Serialize;

use super::InputReport;

/// Levels of detail, the finest first.
#[derive(Debug, Serialize)]
pub(crate) struct LodReport {
    pub(crate) version: &'static str,
    pub(crate) input: InputReport,
    /// Of the control mesh's bounding box, which per cent are of.
    pub(crate) diagonal: f64,
    /// Whether distances are proven.
    pub(crate) certified: bool,
    /// What the distances to switch at are for.
    pub(crate) picture: PictureReport,
    pub(crate) levels: Vec<LevelReport>,
}

/// A picture in which levels are not to be told from the surface.
#[derive(Debug, Serialize)]
pub(crate) struct PictureReport {
    pub(crate) pixels: f64,
    pub(crate) height: f64,
    pub(crate) fov_degrees: f64,
}

/// A level.
#[derive(Debug, Serialize)]
pub(crate) struct LevelReport {
    /// 0 for the finest.
    pub(crate) lod: usize,
    pub(crate) path: String,
    pub(crate) vertices: usize,
    pub(crate) triangles: usize,
    pub(crate) tolerance: f64,
    /// The symmetric Hausdorff distance to the limit surface lies between these.
    pub(crate) lower: f64,
    pub(crate) upper: Option<f64>,
    /// The greatest distance place by place, which textures and geomorphs go by.
    pub(crate) parametric: f64,
    /// How near a camera may come until the level shows as more than so many pixels.
    pub(crate) switching_distance: f64,
    /// The least part of the picture's height that the object takes where the level is shown; 0 for the coarsest.
    pub(crate) least_coverage: f64,
    /// How it grows out of the coarser level; null for the coarsest and without --morph.
    pub(crate) morph: Option<MorphReport>,
    /// See `refine`.
    pub(crate) stop: &'static str,
}

/// A geomorph: from `to_distance` on the coarser level is shown; on the way there the weight of the coarser level grows as the distance.
#[derive(Debug, Serialize)]
pub(crate) struct MorphReport {
    /// The greatest distance, place by place, where the level looks like the coarser one.
    pub(crate) start_parametric: f64,
    pub(crate) from_distance: f64,
    pub(crate) to_distance: f64,
}

//! The report of `limitmesh lod`.

use serde::Serialize;

use super::input::InputReport;

/// Levels of detail, the finest first.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct LodReport {
    /// The program's version.
    pub(crate) version: &'static str,
    /// The file that was read.
    pub(crate) input: InputReport,
    /// Of the control mesh's bounding box, which per cent are of.
    pub(crate) diagonal: f64,
    /// Whether distances are proven.
    pub(crate) certified: bool,
    /// The picture that the distances to switch at are for.
    pub(crate) picture: PictureReport,
    /// The levels, from the finest.
    pub(crate) levels: Vec<LevelReport>,
}

/// A picture in which levels look like the surface.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct PictureReport {
    /// Pixels that a level may differ by.
    pub(crate) pixels: f64,
    /// Height of the picture in pixels.
    pub(crate) height: f64,
    /// Vertical field of view.
    pub(crate) fov_degrees: f64,
}

/// A level.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct LevelReport {
    /// 0 for the finest.
    pub(crate) lod: usize,
    /// The file, or its place in the document.
    pub(crate) path: String,
    /// Its vertices.
    pub(crate) vertices: usize,
    /// Its triangles.
    pub(crate) triangles: usize,
    /// The options.
    pub(crate) tolerance: f64,
    /// The symmetric Hausdorff distance to the limit surface is at least this.
    pub(crate) lower: f64,
    /// The distance is at most this; null where none is known.
    pub(crate) upper: Option<f64>,
    /// The greatest distance place by place, which textures and geomorphs go by.
    pub(crate) parametric: f64,
    /// How near a camera may come until the level shows as more than so many pixels.
    pub(crate) switching_distance: f64,
    /// The least part of the picture's height that the object takes where the level is shown; 0 for the coarsest.
    pub(crate) least_coverage: f64,
    /// How it grows out of the coarser level; null for the coarsest and without --morph.
    pub(crate) morph: Option<MorphReport>,
    /// Why it ended, as `stop` of `refine`.
    pub(crate) stop: &'static str,
}

/// A geomorph: from `to_distance` on the coarser level is shown; on the way there the weight of the coarser level grows as the distance.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct MorphReport {
    /// The greatest distance, place by place, where the level looks like the coarser one.
    pub(crate) start_parametric: f64,
    /// Where the geomorph begins.
    pub(crate) from_distance: f64,
    /// Where it ends.
    pub(crate) to_distance: f64,
}

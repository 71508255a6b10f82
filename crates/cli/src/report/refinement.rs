//! The report of `limitmesh refine`.

use limitmesh::Mesh;
use limitmesh::measure::{triangle_quality, watertightness};
use limitmesh::refine::{StepReport, Stop};
use serde::Serialize;

use super::InputReport;
use super::diagnosis::DiagnosisReport;
use crate::arguments::{Method, SchemeName, Seam};

/// All of it.
#[derive(Debug, Serialize)]
pub(crate) struct RefineReport {
    pub(crate) version: &'static str,
    pub(crate) input: InputReport,
    pub(crate) diagnosis: DiagnosisReport,
    pub(crate) parameters: ParametersReport,
    pub(crate) steps: Vec<StepEntry>,
    /// `levels`: all were done; `satisfied`: no face was divisible any more; `triangle-cap`: the next step would
    /// have passed the cap.
    pub(crate) stop: &'static str,
    /// Triangles that the step left undone would have given; null unless the cap stopped the refinement.
    pub(crate) needed_triangles: Option<usize>,
    pub(crate) output: OutputReport,
    pub(crate) seconds: SecondsReport,
}

/// The name of a stop in the report.
pub(crate) fn stop_name(stop: Stop) -> &'static str {
    match stop {
        Stop::Levels => "levels",
        Stop::Satisfied => "satisfied",
        Stop::TriangleCap { .. } => "triangle-cap",
        _ => "other",
    }
}

/// What was asked for, defaults filled in; null where an option does not apply to the method.
#[derive(Debug, Serialize)]
pub(crate) struct ParametersReport {
    pub(crate) method: Method,
    pub(crate) angle_degrees: Option<f64>,
    pub(crate) levels: usize,
    pub(crate) scheme: SchemeName,
    pub(crate) seam: Option<Seam>,
    pub(crate) view: Option<ViewReport>,
    pub(crate) limit: bool,
    pub(crate) max_triangles: usize,
    /// Distance within which vertices were merged: 0 at equal positions, null for none.
    pub(crate) weld: Option<f64>,
    pub(crate) strict: bool,
}

/// Where the viewer looks from: one of direction and eye.
#[derive(Debug, Serialize)]
pub(crate) struct ViewReport {
    pub(crate) direction: Option<[f64; 3]>,
    pub(crate) eye: Option<[f64; 3]>,
    pub(crate) dilatation: f64,
}

/// What one step did.
#[derive(Debug, Serialize)]
pub(crate) struct StepEntry {
    pub(crate) step: usize,
    pub(crate) faces_before: usize,
    pub(crate) divisible: usize,
    /// Indivisible faces with 0, 1, 2 and 3 split edges.
    pub(crate) closure: [usize; 4],
    pub(crate) faces_after: usize,
    pub(crate) seconds: f64,
}

impl From<&StepReport> for StepEntry {
    fn from(step: &StepReport) -> Self {
        Self {
            step: step.step,
            faces_before: step.faces_before,
            divisible: step.divisible,
            closure: step.closure,
            faces_after: step.faces_after,
            seconds: step.duration.as_secs_f64(),
        }
    }
}

/// The mesh that was written.
#[derive(Debug, Serialize)]
pub(crate) struct OutputReport {
    pub(crate) path: String,
    pub(crate) vertices: usize,
    pub(crate) triangles: usize,
    pub(crate) boundary_edges: usize,
    pub(crate) non_manifold_edges: usize,
    pub(crate) watertight: bool,
    pub(crate) euler_characteristic: i64,
    pub(crate) components: usize,
    pub(crate) t_junctions: usize,
    pub(crate) min_angle_degrees: f64,
    pub(crate) mean_min_angle_degrees: f64,
    /// Triangles with a least angle in [0°, 5°), [5°, 10°) … [55°, 60°].
    pub(crate) angle_histogram: [usize; 12],
}

impl OutputReport {
    /// Examines a mesh.
    pub(crate) fn of(path: String, mesh: &Mesh) -> Self {
        let surface = mesh.as_triangles();
        let tightness = watertightness(surface);
        let quality = triangle_quality(surface);
        Self {
            path,
            vertices: mesh.vertex_count(),
            triangles: mesh.face_count(),
            boundary_edges: tightness.boundary_edges,
            non_manifold_edges: tightness.non_manifold_edges,
            watertight: tightness.is_watertight(),
            euler_characteristic: tightness.euler_characteristic,
            components: tightness.components,
            t_junctions: tightness.t_junctions,
            min_angle_degrees: quality.min_angle_degrees,
            mean_min_angle_degrees: quality.mean_min_angle_degrees,
            angle_histogram: quality.histogram,
        }
    }
}

/// Wall-clock seconds by phase.
#[derive(Debug, Serialize)]
pub(crate) struct SecondsReport {
    pub(crate) read: f64,
    pub(crate) repair: f64,
    pub(crate) refine: f64,
    pub(crate) write: f64,
    /// All four together; the report's own checks and the picture are not in it.
    pub(crate) total: f64,
}

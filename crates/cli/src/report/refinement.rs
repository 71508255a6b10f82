//! The report of `limitmesh refine`.

use limitmesh::Mesh;
use limitmesh::criterion::Camera;
use limitmesh::criterion::Viewpoint;
use limitmesh::measure::watertightness;
use limitmesh::mesh::Weld;
use limitmesh::refine::{ErrorBounds, StepReport, Stop};
use serde::Serialize;

use super::diagnosis::DiagnosisReport;
use super::features::FeaturesReport;
use super::input::InputReport;
use super::interpolation::InterpolationReport;
use super::quality::QualityReport;
use super::whole::{IntervalReport, percent};
use crate::arguments::{ExactArguments, Method, RefineArguments, RefiningScheme};
use crate::bulk::Bulk;
use crate::format::{lower_bound, upper_bound};

/// The report on a mesh that was refined.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct RefineReport {
    /// The program's version.
    pub(crate) version: &'static str,
    #[serde(flatten)]
    pub(crate) of: MeshReport,
    /// How long it took.
    pub(crate) seconds: SecondsReport,
}

/// A mesh before and after its refinement.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct MeshReport {
    /// The input.
    pub(crate) input: InputReport,
    /// Findings and repairs.
    pub(crate) diagnosis: DiagnosisReport,
    /// The options.
    pub(crate) parameters: ParametersReport,
    /// How control points were found; null where the input's vertices are the control points.
    pub(crate) interpolation: Option<InterpolationReport>,
    #[serde(flatten)]
    pub(crate) method: MethodReport,
    /// Area and volume.
    pub(crate) size: SizeReport,
    /// The output.
    pub(crate) output: OutputReport,
}

/// The report on an asset of several meshes.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct AssetReport {
    /// The program's version.
    pub(crate) version: &'static str,
    /// The file that was read, as given on the command line.
    pub(crate) path: String,
    /// Attributes that were left out, by their names in the asset.
    pub(crate) left_out: Vec<String>,
    /// The meshes that were refined.
    pub(crate) meshes: Vec<AssetMeshReport>,
    /// How long it took.
    pub(crate) seconds: SecondsReport,
}

/// The report on a mesh of an asset. All lengths are the scene's.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct AssetMeshReport {
    /// Its number.
    pub(crate) mesh: usize,
    /// How many times larger it appears in the scene than in its own coordinates, at most.
    pub(crate) scale: f64,
    #[serde(flatten)]
    pub(crate) of: MeshReport,
}

/// Area and volume of the mesh that was read and of the one that was written.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct SizeReport {
    /// Of the mesh that was read.
    pub(crate) before: Bulk,
    /// Of the mesh that was written.
    pub(crate) after: Bulk,
}

/// The work of the method, and its result.
#[derive(Debug, Default, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct MethodReport {
    /// Steps of a stepwise method.
    pub(crate) steps: Vec<StepEntry>,
    /// Rounds of the exact method.
    pub(crate) rounds: Vec<RoundEntry>,
    /// Times that the most divided part of a control face was divided.
    pub(crate) levels: usize,
    /// Why it ended. The exact method: `met` (all goals), `triangles` (those asked for are used up), `triangle-cap`, `level-cap`,
    /// `memory-cap`, `rounding` (the tolerance is finer than the numbers) or `cones` (met but for `open_cones`). Others: `levels`
    /// (all steps done), `satisfied` (no face has to be divided any more) or `triangle-cap`.
    pub(crate) stop: &'static str,
    /// Triangles that the step left undone would have given; null unless the cap stopped a stepwise method.
    pub(crate) needed_triangles: Option<usize>,
    /// How far the mesh and the limit surface are from each other; null for the stepwise methods.
    pub(crate) error: Option<ErrorReport>,
    /// How far the mesh is from the one that was read; null where that is not known.
    pub(crate) input_distance: Option<IntervalReport>,
    /// The distance to the limit surface in the cameras' pictures, in pixels at most; null without cameras or where it is not bounded.
    pub(crate) pixels: Option<f64>,
    /// Triangles outside the cone of the exact method's angle; null without one.
    pub(crate) open_cones: Option<usize>,
    /// Goals apart from the shape.
    pub(crate) attributes: Vec<AttributeReport>,
}

impl MethodReport {
    /// Of so many levels or steps that ended so; the rest as of a method that reports nothing else.
    pub(crate) fn new(levels: usize, stop: &'static str) -> Self {
        Self {
            levels,
            stop,
            ..Self::default()
        }
    }
}

/// A goal for what the mesh carries: a channel's values, or the surface that a morph target makes.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct AttributeReport {
    /// The channel's, or `targets[2]`.
    pub(crate) name: String,
    /// In the channel's own unit, or the scene's.
    pub(crate) tolerance: f64,
    /// How far it is off at most, before the file's own rounding; null where it is not bounded.
    pub(crate) upper: Option<f64>,
}

impl AttributeReport {
    /// Whether it is not known to be met.
    pub(crate) fn is_missed(&self) -> bool {
        self.upper.is_none_or(|upper| upper > self.tolerance)
    }
}

/// The name of a stepwise method's stop: all steps were done, no face was divisible any more, or the next step would
/// have passed the cap.
pub(crate) fn stop_name(stop: Stop) -> &'static str {
    match stop {
        Stop::Levels => "levels",
        Stop::Satisfied => "satisfied",
        Stop::TriangleCap { .. } => "triangle-cap",
        _ => "other",
    }
}

/// The options, defaults filled in; null where an option does not apply to the method.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct ParametersReport {
    /// The method.
    pub(crate) method: Method,
    /// The angle of `--angle`.
    pub(crate) angle_degrees: Option<f64>,
    /// Steps of a stepwise method.
    pub(crate) levels: Option<usize>,
    /// The subdivision scheme.
    pub(crate) scheme: RefiningScheme,
    /// Whether the surface was to be rounder where a cage for Catmull–Clark has triangles.
    pub(crate) smooth_triangles: bool,
    /// Where the viewer looks from.
    pub(crate) view: Option<ViewReport>,
    /// Whether vertices were moved to the limit at the end.
    pub(crate) limit: bool,
    #[serde(flatten)]
    pub(crate) features: FeaturesReport,
    /// How near the limit surface is to pass to the input's vertices, in the mesh's unit; null where these are the control points.
    pub(crate) interpolate_within: Option<f64>,
    /// How near the input the result has to be, either way, in the mesh's unit; null where that was not asked for.
    pub(crate) within: Option<f64>,
    /// Triangles at most.
    pub(crate) max_triangles: usize,
    /// Distance within which vertices were merged: 0 at equal positions, null for none.
    pub(crate) weld: Option<f64>,
    /// Whether a mesh that needs repair was to be refused.
    pub(crate) strict: bool,
    /// Goals and caps of the exact method; null for the others.
    pub(crate) exact: Option<ExactParametersReport>,
}

impl ParametersReport {
    /// Of any method: what not all methods have is null.
    ///
    /// # Errors
    /// A length has a unit, and the mesh's is not known.
    pub(crate) fn common(arguments: &RefineArguments) -> anyhow::Result<Self> {
        Ok(Self {
            method: arguments.method,
            angle_degrees: None,
            levels: None,
            scheme: arguments.scheme_name(),
            smooth_triangles: arguments.smooth_triangles,
            view: None,
            limit: false,
            features: (&arguments.features).into(),
            interpolate_within: None,
            within: None,
            max_triangles: arguments.max_triangles(),
            weld: match arguments.build.options()?.weld {
                Weld::Never => None,
                Weld::Within(distance) => Some(distance),
                _ => Some(0.0),
            },
            strict: arguments.build.strict,
            exact: None,
        })
    }
}

/// Goals and caps of the exact method; null where a goal was not set.
#[derive(Debug, Default, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct ExactParametersReport {
    /// The distance to the limit surface at most, in the mesh's unit.
    pub(crate) tolerance: Option<f64>,
    /// In per cent of the control mesh's diagonal.
    pub(crate) tolerance_percent: Option<f64>,
    /// The number of triangles.
    pub(crate) triangles: Option<usize>,
    /// The distance in pixels at most.
    pub(crate) pixels: Option<f64>,
    /// The cameras that these pixels are of.
    pub(crate) cameras: Vec<CameraReport>,
    /// Whether vertices may leave the surface.
    pub(crate) balance: bool,
    /// Whether edges were to be collapsed.
    pub(crate) optimize: bool,
    /// Whether flat regions were divided like the rest.
    pub(crate) divide_flat: bool,
    /// Levels at most.
    pub(crate) max_levels: usize,
    /// Memory at most, in bytes.
    pub(crate) max_memory: Option<usize>,
    /// Whether the file has where vertices and triangles came from.
    pub(crate) provenance: bool,
}

impl ParametersReport {
    /// Of a method whose goals are an angle, a distance in the unit of a mesh with that diagonal, and a number of triangles.
    ///
    /// # Errors
    /// A length has a unit, and the mesh's is not known.
    pub(crate) fn of_goals(
        angle_degrees: Option<f64>,
        tolerance: Option<f64>,
        diagonal: f64,
        max_levels: usize,
        arguments: &RefineArguments,
    ) -> anyhow::Result<Self> {
        let exact = ExactParametersReport::new(tolerance, diagonal, max_levels, &arguments.exact);
        Ok(Self {
            angle_degrees,
            exact: Some(exact),
            ..Self::common(arguments)?
        })
    }
}

impl ExactParametersReport {
    /// Of a method whose goals are a distance, in the unit of a mesh with that diagonal, and a number of triangles alone.
    pub(crate) fn new(
        tolerance: Option<f64>,
        diagonal: f64,
        max_levels: usize,
        arguments: &ExactArguments,
    ) -> Self {
        Self {
            tolerance,
            tolerance_percent: tolerance.map(|tolerance| percent(tolerance, diagonal)),
            triangles: arguments.triangles,
            max_levels,
            provenance: arguments.provenance,
            ..Self::default()
        }
    }
}

/// Where the viewer looks from: one of direction and eye.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct ViewReport {
    /// Direction of sight.
    pub(crate) direction: Option<[f64; 3]>,
    /// The eye.
    pub(crate) eye: Option<[f64; 3]>,
    /// The factor of `--dilatation`.
    pub(crate) dilatation: f64,
}

impl ViewReport {
    /// The view that makes the angle depend on the viewer.
    pub(crate) fn of(arguments: &RefineArguments) -> Option<Self> {
        let view = arguments.viewer()?;
        let (direction, eye) = match view.viewpoint {
            Viewpoint::Direction(direction) => (Some(direction), None),
            Viewpoint::Eye(eye) => (None, Some(eye)),
        };
        Some(Self {
            direction,
            eye,
            dilatation: view.dilatation,
        })
    }
}

/// The work of one step.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct StepEntry {
    /// Its number, from 1.
    pub(crate) step: usize,
    /// Faces before it.
    pub(crate) faces_before: usize,
    /// Faces that were divided.
    pub(crate) divisible: usize,
    /// Indivisible faces with 0, 1, 2 and 3 split edges.
    pub(crate) closure: [usize; 4],
    /// Faces after it.
    pub(crate) faces_after: usize,
    /// How long it took.
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

/// A camera that the distance in pixels is for.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct CameraReport {
    /// The eye.
    pub(crate) eye: [f64; 3],
    /// The point that it looks at.
    pub(crate) target: [f64; 3],
    /// The upward direction.
    pub(crate) up: [f64; 3],
    /// The vertical field of view.
    pub(crate) fov_degrees: f64,
    /// The picture's width in pixels.
    pub(crate) width: u32,
    /// The picture's height in pixels.
    pub(crate) height: u32,
}

impl From<&Camera> for CameraReport {
    fn from(camera: &Camera) -> Self {
        Self {
            eye: camera.eye,
            target: camera.target,
            up: camera.up,
            fov_degrees: camera.fov_degrees,
            width: camera.width,
            height: camera.height,
        }
    }
}

/// The report of a dry run.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct PredictionReport {
    /// The program's version.
    pub(crate) version: &'static str,
    /// The input.
    pub(crate) input: InputReport,
    /// Findings and repairs.
    pub(crate) diagnosis: DiagnosisReport,
    /// The options.
    pub(crate) parameters: ParametersReport,
    /// The prediction.
    pub(crate) estimate: EstimateReport,
}

/// The predicted size of a refinement.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct EstimateReport {
    /// Triangles of the result, about.
    pub(crate) triangles: usize,
    /// Memory in bytes at most, about.
    pub(crate) memory_bytes: usize,
    /// Whether the triangles were counted rather than extrapolated.
    pub(crate) counted: bool,
}

/// The work of one round of the exact method.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct RoundEntry {
    /// Its number, from 1.
    pub(crate) round: usize,
    /// Triangles after it.
    pub(crate) triangles: usize,
}

/// An interval for the symmetric Hausdorff distance between the mesh and the limit surface of the control mesh.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct ErrorReport {
    /// A distance that was found, in the mesh's unit.
    pub(crate) lower: f64,
    /// A distance that is not exceeded, or where it is not certified an estimate; null where none is known.
    pub(crate) upper: Option<f64>,
    /// In per cent of `diagonal`.
    pub(crate) lower_percent: f64,
    /// In per cent of `diagonal`; null as `upper`.
    pub(crate) upper_percent: Option<f64>,
    /// Diagonal of the bounding box of the control mesh.
    pub(crate) diagonal: f64,
    /// A point of the limit surface at the distance `lower` from the mesh.
    pub(crate) at: [f64; 3],
    /// Whether `upper` is proven.
    pub(crate) certified: bool,
    /// The distance that the proof (`--proof`) confirms, where it is not `upper`: what the triangles prove one by one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) proven: Option<f64>,
}

/// A lower bound is reported where the upper one is at most so many times as far.
const NARROW: f64 = 1.25;

impl ErrorReport {
    /// Of a mesh whose control mesh has that diagonal.
    pub(crate) fn new(bounds: &ErrorBounds, diagonal: f64) -> Self {
        Self::of(
            [bounds.lower, bounds.upper],
            diagonal,
            bounds.at,
            bounds.certified,
        )
    }

    /// Of a mesh whose vertices all lie on the limit surface, with a distance that is estimated.
    pub(crate) fn estimated(distance: f64, diagonal: f64, mesh: &Mesh) -> Self {
        let at = mesh.positions().first().copied().unwrap_or_default();
        Self::of([0.0, distance], diagonal, at, false)
    }

    /// Of an interval whose upper end may be proven; one that is not finite is none.
    fn of([lower, upper]: [f64; 2], diagonal: f64, at: [f64; 3], is_proven: bool) -> Self {
        let percent = |length: f64| percent(length, diagonal);
        let upper = Some(upper).filter(|upper| upper.is_finite());
        Self {
            lower,
            upper,
            lower_percent: percent(lower),
            upper_percent: upper.map(percent),
            diagonal,
            at,
            certified: is_proven && upper.is_some(),
            proven: None,
        }
    }

    /// `within 0.0998 % of the diagonal (0.0123) of the limit surface, certified; at least 0.0962 %`, with a unit after
    /// lengths; what it is at least only where that is not far below.
    pub(crate) fn in_words(&self, unit: &str) -> String {
        let extent = |percent: String, length: String| {
            format!("{percent} % of the diagonal ({length}{unit})")
        };
        match (self.upper, self.upper_percent) {
            (Some(upper), Some(percent)) if !self.certified => format!(
                "about {} from the limit surface by samples, not certified",
                extent(upper_bound(percent), upper_bound(upper))
            ),
            (Some(upper), Some(percent)) => {
                let most = extent(upper_bound(percent), upper_bound(upper));
                // Farther below, it says nothing of what is true.
                let least = match upper <= NARROW * self.lower {
                    true => format!("; at least {} %", lower_bound(self.lower_percent)),
                    false => String::new(),
                };
                format!("within {most} of the limit surface, certified{least}")
            }
            _ => format!(
                "at least {} from the limit surface, not certified",
                extent(lower_bound(self.lower_percent), lower_bound(self.lower))
            ),
        }
    }
}

/// The mesh that was written.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct OutputReport {
    /// The file.
    pub(crate) path: String,
    /// Its vertices.
    pub(crate) vertices: usize,
    /// Its triangles, the halves of quads among them.
    pub(crate) triangles: usize,
    /// Quads, each of which holds two of the triangles.
    pub(crate) quads: usize,
    /// Edges with one face.
    pub(crate) boundary_edges: usize,
    /// Edges with more than two faces.
    pub(crate) non_manifold_edges: usize,
    /// Whether every edge has two faces.
    pub(crate) watertight: bool,
    /// Vertices less edges plus triangles.
    pub(crate) euler_characteristic: i64,
    /// Connected parts.
    pub(crate) components: usize,
    /// Vertices inside an edge of another triangle.
    pub(crate) t_junctions: usize,
    /// Triangles whose normal is more than 90° from the limit normal at one of their corners, or with --within from all faces around; null for the stepwise methods.
    pub(crate) inverted_triangles: Option<usize>,
    #[serde(flatten)]
    pub(crate) quality: QualityReport,
}

impl OutputReport {
    /// Examines a mesh.
    pub(crate) fn of(
        path: String,
        mesh: &Mesh,
        quads: usize,
        inverted_triangles: Option<usize>,
    ) -> Self {
        let tightness = watertightness(mesh.as_triangles());
        Self {
            path,
            vertices: mesh.vertex_count(),
            triangles: mesh.face_count(),
            quads,
            boundary_edges: tightness.boundary_edges,
            non_manifold_edges: tightness.non_manifold_edges,
            watertight: tightness.is_watertight(),
            euler_characteristic: tightness.euler_characteristic,
            components: tightness.components,
            t_junctions: tightness.t_junctions,
            inverted_triangles,
            quality: QualityReport::of(mesh),
        }
    }
}

/// Wall-clock seconds by phase.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct SecondsReport {
    /// Reading.
    pub(crate) read: f64,
    /// Repairing, and making the control mesh.
    pub(crate) repair: f64,
    /// Refining.
    pub(crate) refine: f64,
    /// Writing.
    pub(crate) write: f64,
    /// All four together; the report's own checks and the picture are not in it.
    pub(crate) total: f64,
}

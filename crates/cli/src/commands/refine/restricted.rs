//! Refinement over a restricted quadtree by criteria of the literature, to be compared with: planarity (Zorin, Schröder and Sweldens)
//! and vertex errors (Müller and Jaeschke).

use limitmesh::front::{Demand, Front, MOST_LEVELS, Measure, Snapshot};
use limitmesh::mesh::SplitSurface;
use limitmesh::refine::{ExactStop, Origin, Traced};
use limitmesh::scheme::Scheme;
use limitmesh::{FaceId, HalfEdgeId, LimitSurface, Mesh};
use limitmesh_io::Format;

use super::super::channels::Channels;
use super::super::normals::Normals;
use super::carried::Trail;
use super::control::Before;
use super::goals::unit_in_words;
use super::provenance::Provenance;
use super::{Refined, capped};
use crate::arguments::{Extent, Featured, Method, RefineArguments};
use crate::format::{counted, number};
use crate::progress::Progress;
use crate::report::refinement::{ExactParametersReport, exact_stop_name};
use crate::report::{MethodReport, ParametersReport};

/// The angle of planarity where nothing else is asked, in degrees: that of the stepwise methods.
const USUAL_ANGLE: f64 = 10.0;

/// The vertex error where nothing else is asked, in per cent of the diagonal: the exact method's distance.
const USUAL_PERCENT: f64 = 0.1;

/// What is asked, and what of.
struct Goal {
    measure: Measure,
    /// In the measure's unit.
    limit: f64,
    angle_degrees: Option<f64>,
    tolerance: Option<f64>,
}

impl Goal {
    fn of(arguments: &RefineArguments, diagonal: f64) -> anyhow::Result<Self> {
        let (angle, exact) = (arguments.angle, &arguments.exact);
        let length = |extent: Extent| extent.length(diagonal, arguments.build.unit);
        // The most triangles alone are as many as the least limit takes.
        let is_counted = exact.triangles.is_some();
        Ok(match (arguments.method, exact.tolerance) {
            (Method::VertexError, tolerance) => {
                let usual = (!is_counted).then_some(Extent::Percent(USUAL_PERCENT));
                let tolerance = tolerance.or(usual).map(length).transpose()?;
                let limit = tolerance.unwrap_or(0.0);
                Self {
                    measure: Measure::VertexError,
                    limit,
                    angle_degrees: None,
                    tolerance,
                }
            }
            (_, Some(tolerance)) => {
                let tolerance = length(tolerance)?;
                let measure = Measure::PlanarityDistance;
                Self {
                    measure,
                    limit: tolerance,
                    angle_degrees: None,
                    tolerance: Some(tolerance),
                }
            }
            (_, None) => {
                let angle_degrees = angle.or((!is_counted).then_some(USUAL_ANGLE));
                let limit = angle_degrees.unwrap_or(0.0).to_radians();
                Self {
                    measure: Measure::PlanarityAngle,
                    limit,
                    angle_degrees,
                    tolerance: None,
                }
            }
        })
    }

    /// Why there are no more triangles.
    fn stop(&self, front: &Front<'_>, arguments: &RefineArguments) -> ExactStop {
        let asked = arguments.exact.triangles;
        if front.worst() <= self.limit {
            ExactStop::Met
        } else if front.limit() <= self.limit {
            ExactStop::LevelCap
        } else if asked.is_some_and(|asked| asked <= arguments.max_triangles()) {
            ExactStop::Triangles
        } else {
            ExactStop::TriangleCap
        }
    }

    /// What was reached, in words.
    fn in_words(&self, worst: f64, unit: &str) -> String {
        match self.measure {
            Measure::PlanarityAngle => {
                let degrees = number(worst.to_degrees());
                format!(
                    "planar to {degrees}° at corners and middles of edges, by samples; no distance is proven"
                )
            }
            Measure::PlanarityDistance => {
                let worst = number(worst);
                format!(
                    "planar to {worst}{unit} in the middles of edges, by samples; no distance is proven"
                )
            }
            _ => {
                let worst = number(worst);
                format!(
                    "control points are within {worst}{unit} of their limits; no distance is proven"
                )
            }
        }
    }
}

/// What was asked for, defaults filled in.
pub(super) fn parameters(
    arguments: &RefineArguments,
    diagonal: f64,
) -> anyhow::Result<ParametersReport> {
    let goal = Goal::of(arguments, diagonal)?;
    let max_levels = most_levels(arguments) as usize;
    Ok(ParametersReport {
        angle_degrees: goal.angle_degrees,
        exact: Some(ExactParametersReport::new(
            goal.tolerance,
            diagonal,
            max_levels,
            &arguments.exact,
        )),
        ..ParametersReport::common(arguments)
    })
}

/// Levels at most.
fn most_levels(arguments: &RefineArguments) -> u32 {
    arguments
        .exact
        .max_levels
        .map_or(MOST_LEVELS, |levels| levels as u32)
}

/// The limit normals of the control mesh's surface at the vertices, by side where edges are sharp.
fn normals(found: &Snapshot, control: &Mesh, scheme: &dyn Scheme) -> anyhow::Result<Normals> {
    let surface = LimitSurface::new(control, scheme)?;
    let place = |origin: &Origin| (FaceId(origin.face), origin.barycentric);
    if found.mesh.tags().creases.is_empty() {
        let places: Vec<_> = found.origins.iter().map(place).collect();
        let normals = surface
            .at_all(&places)
            .into_iter()
            .map(|point| point.normal);
        return Ok(Normals::ByVertex(normals.collect()));
    }
    // A control face that a corner is not of has no points.
    let nowhere = Origin {
        face: u32::MAX,
        barycentric: [0.0; 3],
    };
    let corners = (0..3 * found.mesh.face_count() as u32).map(HalfEdgeId);
    let origin = |h| {
        found
            .corner_origin(control.triangles(), h)
            .unwrap_or(nowhere)
    };
    let places: Vec<_> = corners.map(|h| place(&origin(h))).collect();
    let points = surface.at_all(&places);
    Ok(Normals::BySide(SplitSurface::new(&found.mesh, |h| {
        points[h.index()].normal
    })))
}

/// Divides nodes until all meet the criterion.
pub(super) fn run(
    (control, before, diagonal): (&Featured, &Before, f64),
    channels: &Channels,
    arguments: &RefineArguments,
    format: Format,
    progress: &Progress,
) -> anyhow::Result<Refined> {
    let goal = Goal::of(arguments, diagonal)?;
    let scheme = arguments.scheme()?;
    progress.stage(format!(
        "refining {}",
        counted(control.mesh.face_count(), "triangle", "triangles")
    ));
    let mut front = Front::measured_by_observed(
        &control.mesh,
        scheme,
        goal.measure,
        &mut progress.observer(),
    )?;
    let most = arguments
        .exact
        .triangles
        .unwrap_or(usize::MAX)
        .min(arguments.max_triangles());
    let demand = Demand::tolerance(goal.limit)
        .triangles(most)
        .max_levels(most_levels(arguments));
    front.update_observed(&demand, &mut progress.observer())?;
    let (worst, levels, stop) = (
        front.worst(),
        front.depth() as usize,
        goal.stop(&front, arguments),
    );
    let found = front.snapshot()?;
    drop(front);
    let channels = channels.refined(&control.mesh, &found, arguments.scheme()?)?;
    let wanted = Normals::are_held(format) || arguments.picture.is_some();
    let normals = if wanted {
        Some(normals(&found, &control.mesh, scheme)?)
    } else {
        None
    };
    let Snapshot {
        mesh,
        origins,
        parents,
        ..
    } = found;
    let places = (&before.faces[..], &control.concave.parts);
    let provenance = arguments
        .exact
        .provenance
        .then(|| Provenance::new(&origins, parents, places));
    Ok(Refined {
        normals,
        channels,
        provenance,
        trail: Trail::default(),
        achieved: vec![goal.in_words(worst, &unit_in_words(arguments.build.unit))],
        inverted: None,
        how: counted(levels, "level", "levels"),
        outcome: capped(&mesh, stop, arguments),
        report: MethodReport::new(levels, exact_stop_name(stop)),
        mesh,
    })
}

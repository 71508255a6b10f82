//! Refinement over a restricted quadtree by criteria of the literature, to be compared with: planarity (Zorin, Schröder and Sweldens)
//! and vertex errors (Müller and Jaeschke).

use anyhow::Context;
use limitmesh::front::{Demand, Front, MOST_LEVELS, Measure, Snapshot};
use limitmesh::mesh::SplitSurface;
use limitmesh::refine::{ExactStop, Origin, Traced};
use limitmesh::{FaceId, HalfEdgeId, LimitSurface};

use super::super::normals::Normals;
use super::refined::{Refined, capped};
use super::task::Task;
use crate::arguments::{Extent, Method, RefineArguments};
use crate::format::{counted, number};
use crate::report::{MethodReport, ParametersReport};

/// The angle of planarity where nothing else is asked, in degrees: that of the stepwise methods.
const USUAL_ANGLE: f64 = 10.0;

/// The vertex error where nothing else is asked, in per cent of the diagonal: the exact method's distance.
const USUAL_PERCENT: f64 = 0.1;

/// The goal.
struct Goal {
    measure: Measure,
    /// In the measure's unit.
    limit: f64,
    angle_degrees: Option<f64>,
    tolerance: Option<f64>,
}

impl Goal {
    fn of(arguments: &RefineArguments, diagonal: f64) -> anyhow::Result<Self> {
        let exact = &arguments.exact;
        // The most triangles alone are as many as the least limit takes.
        let has_usual = exact.triangles.is_none();
        let usual = Some(Extent::Percent(USUAL_PERCENT));
        let tolerance = match arguments.method {
            Method::VertexError => exact.tolerance.or(usual.filter(|_| has_usual)),
            _ => exact.tolerance,
        };
        let tolerance = tolerance
            .map(|extent| extent.length(diagonal, arguments.build.unit))
            .transpose()?;
        let angle = arguments.angle.or(has_usual.then_some(USUAL_ANGLE));
        let (measure, limit, angle_degrees) = match (arguments.method, tolerance) {
            (Method::VertexError, tolerance) => (Measure::VertexError, tolerance, None),
            (_, Some(_)) => (Measure::PlanarityDistance, tolerance, None),
            (_, None) => (Measure::PlanarityAngle, angle.map(f64::to_radians), angle),
        };
        Ok(Self {
            measure,
            limit: limit.unwrap_or(0.0),
            angle_degrees,
            tolerance,
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

    /// The result, in words.
    fn in_words(&self, worst: f64, unit: &str) -> String {
        let length = number(worst);
        let reached = match self.measure {
            Measure::PlanarityAngle => format!(
                "planar to {}° at corners and middles of edges, by samples",
                number(worst.to_degrees())
            ),
            Measure::PlanarityDistance => {
                format!("planar to {length}{unit} in the middles of edges, by samples")
            }
            _ => format!("control points are within {length}{unit} of their limits"),
        };
        format!("{reached}; no distance is proven")
    }
}

/// The options, defaults filled in.
pub(super) fn parameters(
    arguments: &RefineArguments,
    diagonal: f64,
) -> anyhow::Result<ParametersReport> {
    let goal = Goal::of(arguments, diagonal)?;
    let levels = most_levels(arguments) as usize;
    ParametersReport::of_goals(
        goal.angle_degrees,
        goal.tolerance,
        diagonal,
        levels,
        arguments,
    )
}

fn most_levels(arguments: &RefineArguments) -> u32 {
    arguments.levels.map_or(MOST_LEVELS, |levels| levels as u32)
}

/// The limit normals of the control mesh's surface at the vertices, by side where edges are sharp.
fn normals(found: &Snapshot, task: &Task<'_>) -> anyhow::Result<Normals> {
    let surface = LimitSurface::new(task.mesh(), task.scheme()?)?;
    let place = |origin: &Origin| (FaceId(origin.face), origin.barycentric);
    if found.mesh.tags().creases.is_empty() {
        let places: Vec<_> = found.origins.iter().map(place).collect();
        let points = surface.at_all(&places).into_iter();
        return Ok(Normals::ByVertex(
            points.map(|point| point.normal).collect(),
        ));
    }
    let control = task.mesh().triangles();
    let corners = (0..3 * found.mesh.face_count() as u32).map(HalfEdgeId);
    let origins = corners.map(|h| found.corner_origin(control, h));
    let places: Option<Vec<_>> = origins.map(|own| own.as_ref().map(place)).collect();
    debug_assert!(
        places.is_some(),
        "a corner is outside its triangle's control face"
    );
    let places = places.context("a corner is outside its triangle's control face")?;
    let points = surface.at_all(&places);
    Ok(Normals::BySide(SplitSurface::new(&found.mesh, |h| {
        points[h.index()].normal
    })))
}

/// Divides nodes until all meet the criterion.
pub(super) fn run(task: &Task<'_>) -> anyhow::Result<Refined> {
    let arguments = task.arguments;
    let goal = Goal::of(arguments, task.control.diagonal)?;
    let scheme = task.scheme()?;
    task.begin();
    let observer = &mut task.progress.observer();
    let mut front = Front::measured_by_observed(task.mesh(), scheme, goal.measure, observer)?;
    let most = arguments.exact.triangles.unwrap_or(usize::MAX);
    let demand = Demand::tolerance(goal.limit)
        .triangles(most.min(arguments.max_triangles()))
        .max_levels(most_levels(arguments));
    front.update_observed(&demand, observer)?;
    let (worst, levels) = (front.worst(), front.depth() as usize);
    let stop = goal.stop(&front, arguments);
    let found = front.snapshot()?;
    drop(front);
    let normals = task.wants_normals().then(|| normals(&found, task));
    let report = MethodReport::new(levels, stop.name());
    let outcome = capped(&found.mesh, stop, arguments);
    Ok(Refined {
        normals: normals.transpose()?,
        channels: task.channels.refined(task.mesh(), &found, scheme)?,
        provenance: task.provenance(&found.origins, &found.parents),
        achieved: vec![goal.in_words(worst, &task.unit())],
        ..Refined::new(
            found.mesh,
            counted(levels, "level", "levels"),
            report,
            outcome,
        )
    })
}

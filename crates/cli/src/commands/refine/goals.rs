//! The goals of exact refinement: those on the command line with those that hold where none is given, as options of the
//! library, and in words.

use limitmesh::Mesh;
use limitmesh::carry::borders;
use limitmesh::criterion::Camera;
use limitmesh::limit::LimitTable;
use limitmesh::refine::{AngleGoal, Exact, ExactOptions, with_room};

use super::attribute_goals::AttributeGoals;
use super::nearness::Nearness;
use super::rounding::most_rounding;
use super::task::Task;
use crate::arguments::{ConcaveCorners, Extent, RefineArguments};
use crate::bulk::winding;
use crate::failure::usage;
use crate::report::AttributeReport;

/// The distance in pixels where cameras are given without one.
const USUAL_PIXELS: f64 = 1.0;

/// The tolerance where no goal is given: facets can hardly be seen then in a picture a thousand pixels wide.
const USUAL_TOLERANCE: Extent = Extent::Percent(0.1);

/// The goals, with those that hold where none is given.
pub(super) struct Goals {
    /// The greatest distance from the limit surface, in the mesh's unit.
    pub(super) length: Option<f64>,
    /// That distance as a person gave it.
    tolerance: Option<Extent>,
    /// How near the input the result has to be, and the tolerance that this leaves.
    pub(super) near: Option<Nearness>,
    /// How far the output's format may round a vertex.
    rounding: f64,
    pub(super) pixels: Option<f64>,
    pub(super) cameras: Vec<Camera>,
    /// Whether triangles must not reach over several control faces, of whatever values.
    separates_faces: bool,
    /// Edges of the control mesh that no triangle reaches over.
    pub(super) kept_edges: Vec<[u32; 2]>,
    pub(super) attributes: AttributeGoals,
}

impl Goals {
    /// The goals for a control mesh and what it carries.
    ///
    /// # Errors
    /// A file of cameras that cannot be read, a camera inside the mesh, or a channel with a tolerance that does not fit it.
    pub(super) fn new(task: &Task<'_>) -> anyhow::Result<Self> {
        let arguments = task.arguments;
        let (exact, control) = (&arguments.exact, task.mesh());
        let cameras = arguments.cameras()?;
        check_cameras(&cameras, control, arguments)?;
        let near = Nearness::of(arguments, control, task.control.diagonal)?;
        let has_other = near.is_some()
            || exact.triangles.is_some()
            || arguments.angle.is_some()
            || !cameras.is_empty();
        let tolerance = exact.tolerance.or((!has_other).then_some(USUAL_TOLERANCE));
        let length = tolerance
            .map(|tolerance| tolerance.length(task.control.diagonal, arguments.build.unit))
            .transpose()?;
        let channels = task.channels;
        let mut attributes = AttributeGoals::default();
        attributes.add_channels(channels, control, &arguments.channels)?;
        Ok(Self {
            length: length.or(near.map(|near| near.tolerance)),
            tolerance,
            near,
            rounding: most_rounding(arguments, control)?,
            pixels: (!cameras.is_empty()).then(|| exact.pixels.unwrap_or(USUAL_PIXELS)),
            cameras,
            separates_faces: channels.vary_within_faces(),
            kept_edges: borders(channels.all(), control),
            attributes,
        })
    }

    /// How far from the limit surface the result may be, or is where that is farther.
    pub(super) fn expected(&self, upper: Option<f64>) -> f64 {
        self.length.into_iter().chain(upper).fold(0.0, f64::max)
    }

    pub(super) fn options(&self, task: &Task<'_>) -> ExactOptions {
        let arguments = task.arguments;
        let exact = &arguments.exact;
        let has_flat_regions =
            !arguments.divides_flat() && !self.separates_faces && self.near.is_none();
        let is_traced = exact.provenance
            || arguments.proof.is_some()
            || !arguments.shared_topology
            || self.separates_faces
            || task.is_traced;
        let mut options = ExactOptions::default()
            .max_triangles(Some(arguments.max_triangles()))
            .max_memory(exact.max_memory)
            .finish(exact.finish())
            .kept_edges(self.kept_edges.clone())
            .attributes(self.attributes.options())
            .flat_regions(has_flat_regions)
            .unfold(arguments.features.concave_corners() == ConcaveCorners::Fixed)
            .origins(is_traced)
            .for_quads(task.has_quads_out());
        if let Some(pixels) = self.pixels {
            options = options.pixels(pixels, self.cameras.clone());
        }
        if let Some(length) = self.length {
            options = options.tolerance(with_room(length, self.rounding));
        }
        if let Some(degrees) = arguments.angle {
            options.goals.angle = Some(AngleGoal {
                radians: degrees.to_radians(),
                view: arguments.viewer(),
            });
        }
        if let Some(count) = exact.triangles {
            options = options.triangles(count);
        }
        if let Some(levels) = arguments.levels {
            options = options.max_levels(levels);
        }
        options
    }

    /// The goals on quality that were not met, or all where nobody knows which, as a list in words.
    pub(super) fn in_words(&self, found: &Exact, arguments: &RefineArguments) -> String {
        let is_far = self.length.is_some_and(|length| found.error.upper > length);
        let reached = self.attributes.reached(found);
        let is_off = reached.iter().any(AttributeReport::is_missed);
        let tolerance = self.tolerance.filter(|_| is_far || !is_off);
        let attributes = self.attributes.in_words().filter(|_| is_off || !is_far);
        let goals = [
            tolerance.map(|tolerance| match tolerance {
                Extent::Length(length) => {
                    let unit = length
                        .unit
                        .map_or_else(String::new, |unit| format!(" {}", unit.name()));
                    format!("the tolerance of {}{unit}", as_typed(length.value))
                }
                Extent::Percent(percent) => format!("the tolerance of {} %", as_typed(percent)),
            }),
            arguments
                .angle
                .map(|degrees| format!("the angle of {}°", as_typed(degrees))),
            self.pixels
                .map(|pixels| format!("the {} pixels", as_typed(pixels))),
            attributes.map(str::to_owned),
        ];
        let goals: Vec<String> = goals.into_iter().flatten().collect();
        match goals.is_empty() {
            true => "the triangles asked for".to_owned(),
            false => goals.join(" and "),
        }
    }
}

/// Refuses a camera inside a closed mesh: all that it could see are back faces, which are left coarse.
fn check_cameras(
    cameras: &[Camera],
    control: &Mesh,
    arguments: &RefineArguments,
) -> anyhow::Result<()> {
    if cameras.is_empty() || control.topology().boundary_edge_count() > 0 {
        return Ok(());
    }
    // Where there is no limit, refinement says so itself.
    let Ok(limits) = LimitTable::new(arguments.scheme()?).positions(control) else {
        return Ok(());
    };
    let triangles = || control.triangles().iter().copied();
    let is_inside = |camera: &Camera| winding(camera.eye, &limits, triangles()) > 0.5;
    match cameras.iter().position(is_inside) {
        Some(i) => usage(format!(
            "camera {} of {} stands inside the mesh, at {:?}, where it sees nothing but back faces; move its eye outside",
            i + 1,
            cameras.len(),
            cameras[i].eye
        )),
        None => Ok(()),
    }
}

/// The fewest digits that say exactly this number, as a person would write it.
fn as_typed(x: f64) -> String {
    match (1e-6..1e9).contains(&x) {
        true => format!("{x}"),
        false => format!("{x:e}"),
    }
}

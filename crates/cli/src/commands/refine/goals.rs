//! What is asked of exact refinement: the goals on the command line with those that hold where none is given, as options of the
//! library, and in words.

use limitmesh::Mesh;
use limitmesh::carry::borders;
use limitmesh::criterion::Camera;
use limitmesh::refine::{Exact, ExactOptions};
use limitmesh_io::{Format, WriteOptions};

use super::super::channels::Channels;
use super::attribute_goals::AttributeGoals;
use super::nearness::Nearness;
use super::{cameras, view};
use crate::arguments::{ConcaveCorners, Extent, Length, RefineArguments, Unit};
use crate::report::AttributeReport;

/// The distance in pixels where cameras are given without one.
const USUAL_PIXELS: f64 = 1.0;

/// The tolerance where no goal is given: facets can hardly be seen then in a picture a thousand pixels wide.
const USUAL_TOLERANCE: Extent = Extent::Percent(0.1);

/// The goals, with those that hold where none is given.
pub(super) struct Goals {
    /// The greatest distance from the limit surface, in the mesh's unit.
    pub(super) length: Option<f64>,
    /// The same as a person gave it.
    tolerance: Option<Extent>,
    /// How near the input the result has to be, and the tolerance that this leaves.
    pub(super) near: Option<Nearness>,
    /// Of the input's bounding box.
    pub(super) diagonal: f64,
    /// How far the output's format may round a vertex.
    rounding: f64,
    pub(super) angle_degrees: Option<f64>,
    pub(super) triangles: Option<usize>,
    pub(super) pixels: Option<f64>,
    pub(super) cameras: Vec<Camera>,
    /// Whether triangles must not reach over several control faces, of whatever values.
    tells_faces_apart: bool,
    /// Edges of the control mesh that no triangle reaches over.
    kept_edges: Vec<[u32; 2]>,
    /// Whether the result tells where vertices and triangles came from.
    pub(super) keeps_origins: bool,
    pub(super) attributes: AttributeGoals,
}

impl Goals {
    /// `diagonal` is what lengths are given in per cent of.
    ///
    /// # Errors
    /// A file of cameras that cannot be read, or a camera inside the mesh.
    pub(super) fn new(
        arguments: &RefineArguments,
        control: &Mesh,
        diagonal: f64,
    ) -> anyhow::Result<Self> {
        let exact = &arguments.exact;
        let cameras = cameras::all(arguments)?;
        cameras::check(&cameras, control, arguments)?;
        let near = Nearness::of(arguments, control, diagonal)?;
        let none = exact.tolerance.is_none()
            && near.is_none()
            && exact.triangles.is_none()
            && arguments.angle.is_none()
            && cameras.is_empty();
        let tolerance = exact.tolerance.or(none.then_some(USUAL_TOLERANCE));
        let length = tolerance.map(|tolerance| tolerance.length(diagonal, arguments.build.unit));
        Ok(Self {
            length: length.transpose()?.or(near.map(|near| near.tolerance)),
            tolerance,
            near,
            diagonal,
            rounding: most_rounding(arguments, control),
            angle_degrees: arguments.angle,
            triangles: exact.triangles,
            pixels: (!cameras.is_empty()).then(|| exact.pixels.unwrap_or(USUAL_PIXELS)),
            cameras,
            tells_faces_apart: false,
            kept_edges: Vec::new(),
            keeps_origins: false,
            attributes: AttributeGoals::default(),
        })
    }

    /// The same where the control mesh carries channels.
    ///
    /// # Errors
    /// A channel with a tolerance does not fit it.
    pub(super) fn carrying(
        mut self,
        channels: &Channels,
        control: &Mesh,
        arguments: &RefineArguments,
    ) -> anyhow::Result<Self> {
        self.kept_edges = borders(channels.all(), control);
        self.tells_faces_apart = channels.vary_within_faces();
        self.attributes
            .add_channels(channels, control, &arguments.channels)?;
        Ok(self)
    }

    /// The same with goals beside the shape.
    pub(super) fn with_attributes(mut self, attributes: AttributeGoals) -> Self {
        self.attributes = attributes;
        self
    }

    /// How far from the limit surface the result may be, or is where that is farther.
    pub(super) fn expected(&self, upper: Option<f64>) -> f64 {
        self.length.into_iter().chain(upper).fold(0.0, f64::max)
    }

    /// The same, where the result is to tell where vertices and triangles came from, and edges of the control mesh stay along which sides
    /// are told apart.
    pub(super) fn keeping_origins(mut self, kept_edges: Vec<[u32; 2]>) -> Self {
        (self.keeps_origins, self.kept_edges) = (true, kept_edges);
        self
    }

    pub(super) fn options(&self, arguments: &RefineArguments) -> ExactOptions {
        let mut options = ExactOptions::default()
            .max_triangles(Some(arguments.max_triangles()))
            .max_memory(arguments.exact.max_memory)
            .balance(arguments.exact.balance)
            .optimize(arguments.exact.optimize)
            .kept_edges(self.kept_edges.clone())
            .attributes(self.attributes.options())
            .flat_regions(
                !arguments.divides_flat() && !self.tells_faces_apart && self.near.is_none(),
            )
            .unfold(arguments.features.concave_corners() == ConcaveCorners::Divided)
            .origins(
                arguments.exact.provenance
                    || arguments.proof.is_some()
                    || !arguments.exact.no_input_distance
                    || self.tells_faces_apart
                    || self.keeps_origins,
            );
        if let Some(pixels) = self.pixels {
            options = options.pixels(pixels, self.cameras.clone());
        }
        if let Some(view) = view(arguments) {
            options = options.view(view);
        }
        if let Some(length) = self.length {
            options = options.tolerance(with_room(length, self.rounding));
        }
        if let Some(degrees) = self.angle_degrees {
            options = options.angle(degrees.to_radians());
        }
        if let Some(count) = self.triangles {
            options = options.triangles(count);
        }
        if let Some(levels) = arguments.exact.max_levels {
            options = options.max_levels(levels);
        }
        options
    }

    /// The goals on quality that were not met, or all where nobody knows which, as a list in words.
    pub(super) fn in_words(&self, found: &Exact) -> String {
        let is_far = self.length.is_some_and(|length| found.error.upper > length);
        let is_off = self
            .attributes
            .reached(found)
            .iter()
            .any(AttributeReport::is_missed);
        let tolerance =
            self.tolerance
                .filter(|_| is_far || !is_off)
                .map(|tolerance| match tolerance {
                    Extent::Length(Length { value, unit }) => {
                        format!(
                            "the tolerance of {}{}",
                            as_typed(value),
                            unit_in_words(unit)
                        )
                    }
                    Extent::Percent(percent) => format!("the tolerance of {} %", as_typed(percent)),
                });
        let angle = self
            .angle_degrees
            .map(|degrees| format!("the angle of {}°", as_typed(degrees)));
        let pixels = self
            .pixels
            .map(|pixels| format!("the {} pixels", as_typed(pixels)));
        let attributes = self
            .attributes
            .in_words()
            .filter(|_| is_off || !is_far)
            .map(str::to_owned);
        let goals: Vec<String> = [tolerance, angle, pixels, attributes]
            .into_iter()
            .flatten()
            .collect();
        if goals.is_empty() {
            "the triangles asked for".to_owned()
        } else {
            goals.join(" and ")
        }
    }
}

/// What is left of a length where rounding takes of it afterwards, unless that is most of it.
pub(super) fn with_room(length: f64, rounding: f64) -> f64 {
    let room = length - rounding;
    if room > 0.5 * length { room } else { length }
}

/// ` mm`, or nothing where no unit is known.
pub(super) fn unit_in_words(unit: Option<Unit>) -> String {
    unit.map_or_else(String::new, |unit| format!(" {}", unit.name()))
}

/// The fewest digits that say exactly this number, as a person would write it.
fn as_typed(x: f64) -> String {
    if (1e-6..1e9).contains(&x) {
        format!("{x}")
    } else {
        format!("{x:e}")
    }
}

/// The format and options of the output, if there is one.
pub(super) fn written(arguments: &RefineArguments) -> Option<(Format, WriteOptions)> {
    let format = arguments.format().ok().flatten()?;
    Some((format, arguments.write_options()))
}

/// How far the output's format rounds a vertex at most: all lie in the box of the control mesh's.
pub(super) fn most_rounding(arguments: &RefineArguments, control: &Mesh) -> f64 {
    let largest = control
        .positions()
        .as_flattened()
        .iter()
        .fold(0.0f64, |most, x| most.max(x.abs()));
    // Half of the last place of `f32`, and of its least number, along each axis.
    let most = 3f64.sqrt()
        * (largest * f64::from(f32::EPSILON) * 0.5 + 0.5 * f64::from(f32::from_bits(1)));
    let is_rounded = written(arguments).is_some_and(|(format, options)| {
        limitmesh_io::rounding(format, &options, &[[0.1; 3]]) > 0.0
    });
    if is_rounded { most } else { 0.0 }
}

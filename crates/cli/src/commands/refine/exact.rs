//! Exact refinement: from the goals on the command line to the mesh, its certified distance, and what is said of it.

use limitmesh::carry::borders;
use limitmesh::criterion::Camera;
use limitmesh::mesh::FaceParts;
use limitmesh::progress::Stage;
use limitmesh::refine::{Exact, ExactOptions, ExactStop, Origin, exact_observed};
use limitmesh::{Mesh, Triangles};
use limitmesh_io::{Format, WriteOptions};

use super::super::channels::Channels;
use super::super::normals::Normals;
use super::attribute_goals::AttributeGoals;
use super::carried::Trail;
use super::input_distance::InputDistance;
use super::provenance::Provenance;
use super::{INTERPOLATE, Refined, cameras, view, view_report};
use crate::arguments::{ConcaveCorners, Extent, Featured, Length, MOST_EXACT, RefineArguments, Unit};
use crate::dihedral::Dihedrals;
use crate::failure::Outcome;
use crate::format::{bytes, counted, number, thousands, upper_bound};
use crate::progress::{Phases, Progress};
use crate::report::refinement::exact_stop_name;
use crate::report::{
    AttributeReport, CameraReport, ErrorReport, ExactParametersReport, InputDistanceReport, MethodReport,
    ParametersReport, RoundEntry,
};

/// The tolerance where no goal is given: facets can hardly be seen then in a picture a thousand pixels wide.
const USUAL_TOLERANCE: Extent = Extent::Percent(0.1);

/// A part of the distance that rounding makes up and that is told.
const NOTED: f64 = 0.01;

/// The distance in pixels where cameras are given without one.
const USUAL_PIXELS: f64 = 1.0;

/// The goals, with those that hold where none is given.
pub(super) struct Goals {
    /// In the mesh's unit.
    length: Option<f64>,
    /// The same as a person gave it.
    tolerance: Option<Extent>,
    /// Of the input's bounding box.
    diagonal: f64,
    /// How far the output's format may round a vertex.
    rounding: f64,
    angle_degrees: Option<f64>,
    triangles: Option<usize>,
    pixels: Option<f64>,
    cameras: Vec<Camera>,
    /// Whether triangles must not reach over several control faces.
    tells_faces_apart: bool,
    /// Edges of the control mesh along which edges stay when they are collapsed.
    kept_edges: Vec<[u32; 2]>,
    /// Whether the result tells where vertices and triangles came from.
    keeps_origins: bool,
    attributes: AttributeGoals,
}

impl Goals {
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
        self.tells_faces_apart = channels.vary_within_faces() || !self.kept_edges.is_empty();
        self.attributes.add_channels(channels, control, &arguments.channels)?;
        Ok(self)
    }

    /// The same with goals beside the shape.
    pub(super) fn with_attributes(mut self, attributes: AttributeGoals) -> Self {
        self.attributes = attributes;
        self
    }

    /// The greatest distance from the limit surface, if that is asked for.
    pub(super) fn length(&self) -> Option<f64> {
        self.length
    }

    /// `diagonal` is what lengths are given in per cent of.
    ///
    /// # Errors
    /// A file of cameras that cannot be read, or a camera inside the mesh.
    pub(super) fn new(arguments: &RefineArguments, control: &Mesh, diagonal: f64) -> anyhow::Result<Self> {
        let exact = &arguments.exact;
        let cameras = cameras::all(arguments)?;
        cameras::check(&cameras, control, arguments)?;
        let none = exact.tolerance.is_none()
            && exact.triangles.is_none()
            && arguments.angle.is_none()
            && cameras.is_empty();
        let tolerance = exact.tolerance.or(none.then_some(USUAL_TOLERANCE));
        let length = tolerance.map(|tolerance| tolerance.length(diagonal, arguments.build.unit));
        Ok(Self {
            length: length.transpose()?,
            tolerance,
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
            .flat_regions(!arguments.exact.divide_flat && !self.tells_faces_apart)
            .unfold(arguments.features.concave_corners() == ConcaveCorners::Divided)
            .origins(
                arguments.exact.provenance
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
            // What rounding takes afterwards, unless that is most of it.
            let room = length - self.rounding;
            options = options.tolerance(if room > 0.5 * length { room } else { length });
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
    fn in_words(&self, found: &Exact) -> String {
        let is_far = self.length.is_some_and(|length| found.error.upper > length);
        let is_off = self.attributes.reached(found).iter().any(AttributeReport::is_missed);
        let tolerance = self.tolerance.filter(|_| is_far || !is_off).map(|tolerance| match tolerance {
            Extent::Length(Length { value, unit }) => {
                format!("the tolerance of {}{}", as_typed(value), unit_in_words(unit))
            }
            Extent::Percent(percent) => format!("the tolerance of {} %", as_typed(percent)),
        });
        let angle = self.angle_degrees.map(|degrees| format!("the angle of {}°", as_typed(degrees)));
        let pixels = self.pixels.map(|pixels| format!("the {} pixels", as_typed(pixels)));
        let attributes = self.attributes.in_words().filter(|_| is_off || !is_far).map(str::to_owned);
        let goals: Vec<String> = [tolerance, angle, pixels, attributes].into_iter().flatten().collect();
        if goals.is_empty() { "the triangles asked for".to_owned() } else { goals.join(" and ") }
    }
}

/// ` mm`, or nothing where no unit is known.
pub(super) fn unit_in_words(unit: Option<Unit>) -> String {
    unit.map_or_else(String::new, |unit| format!(" {}", unit.name()))
}

/// The fewest digits that say exactly this number, as a person would write it.
fn as_typed(x: f64) -> String {
    if (1e-6..1e9).contains(&x) { format!("{x}") } else { format!("{x:e}") }
}

/// Refines until the goals are met or a cap is reached.
///
/// `before` is the mesh that was read.
pub(super) fn run(
    (Featured { mesh: control, concave, .. }, before, channels): (&Featured, &Before, &Channels),
    goals: &Goals,
    arguments: &RefineArguments,
    progress: &Progress,
) -> anyhow::Result<Refined> {
    let mut rounds: Vec<RoundEntry> = Vec::new();
    let phases = arguments.exact.optimize.then(Phases::default);
    let (mut last, mut show) = (0, progress.observer_in_phases(phases));
    let mut observer = |at: &limitmesh::progress::Progress| {
        // Where refinement tries two ways, the second starts again; the report counts on.
        if at.stage == Stage::Refining && at.done > 0 && at.done != last {
            last = at.done;
            rounds.push(RoundEntry { round: rounds.len() + 1, triangles: at.triangles });
        }
        show(at)
    };
    progress.stage(format!("refining {}", counted(control.face_count(), "triangle", "triangles")));
    let options = goals.options(arguments);
    let mut found = exact_observed(control, arguments.scheme()?, &options, &mut observer)?;
    let mut moved = moved((control, before, &concave.parts), &found, goals, arguments, progress)?;
    if let (Some(moved), Some(BeforeSurface { positions, triangles })) = (&mut moved, &before.surface) {
        let expected = goals.length.into_iter().chain([found.error.upper]).fold(0.0, f64::max);
        let meshes = [Triangles { positions, triangles }, found.mesh.as_triangles()];
        *moved = moved.narrowed(meshes, expected, &mut progress.observer())?;
    }
    let rounding = written(arguments)
        .map_or(0.0, |(format, options)| limitmesh_io::rounding(format, &options, found.mesh.positions()));
    if let Some(note) = round(&mut found, rounding, goals) {
        progress.note(note);
    }
    let moved = moved.map(|moved| {
        let InputDistance { lower, upper } = moved.rounded(rounding);
        InputDistanceReport::new(lower, upper, goals.diagonal)
    });
    let error = ErrorReport::new(&found.error, goals.diagonal);
    let mut achieved = achieved(&found, &error, goals, arguments);
    let attributes = goals.attributes.reached(&found);
    achieved.extend(goals.attributes.achieved(&attributes, &unit_in_words(arguments.build.unit)));
    if let Some(moved) = &moved {
        achieved.extend(moved_in_words(moved, &error, control, goals, arguments));
    }
    let outcome = outcome(&found, control, goals, &achieved, arguments);
    let inverted = found.inverted_triangles();
    let channels = channels.refined(control, &found, arguments.scheme()?)?;
    let wanted = written(arguments).is_some_and(|(format, _)| Normals::are_held(format))
        || arguments.picture.is_some();
    let normals = wanted.then(|| Normals::of_exact(&mut found));
    let Exact {
        mesh, origins, parents, is_optimized, side_origins, pixels, open_cones, stop, levels, ..
    } = found;
    let places = (&before.faces[..], &concave.parts);
    let provenance = arguments.exact.provenance.then(|| Provenance::new(&origins, parents.clone(), places));
    let sides = is_optimized.then_some(side_origins);
    let trail = if goals.keeps_origins { Trail { origins, parents, sides } } else { Trail::default() };
    Ok(Refined {
        mesh,
        normals,
        channels,
        trail,
        provenance,
        achieved,
        inverted: Some(inverted),
        how: counted(levels, "level", "levels"),
        report: MethodReport {
            rounds,
            error: Some(error),
            input_distance: moved,
            pixels: pixels.filter(|pixels| pixels.is_finite()),
            open_cones: goals.angle_degrees.map(|_| open_cones),
            attributes,
            ..MethodReport::new(levels, exact_stop_name(stop))
        },
        outcome,
    })
}

/// The format and options of the output, if there is one.
fn written(arguments: &RefineArguments) -> Option<(Format, WriteOptions)> {
    let format = arguments.format().ok().flatten()?;
    Some((format, WriteOptions::default().ascii(arguments.ascii)))
}

/// How far the output's format rounds a vertex at most: all lie in the box of the control mesh's.
fn most_rounding(arguments: &RefineArguments, control: &Mesh) -> f64 {
    let largest = control.positions().as_flattened().iter().fold(0.0f64, |most, x| most.max(x.abs()));
    // Half of the last place of `f32`, and of its least number, along each axis.
    let most = 3f64.sqrt() * (largest * f64::from(f32::EPSILON) * 0.5 + 0.5 * f64::from(f32::from_bits(1)));
    let is_rounded = written(arguments)
        .is_some_and(|(format, options)| limitmesh_io::rounding(format, &options, &[[0.1; 3]]) > 0.0);
    if is_rounded { most } else { 0.0 }
}

/// Counts what writing rounds among the distance; a note where that is much of it.
fn round(found: &mut Exact, rounding: f64, goals: &Goals) -> Option<String> {
    let proven = found.error.upper;
    found.error.upper += rounding;
    found.error.lower = (found.error.lower - rounding).max(0.0);
    let is_beyond = goals.length.is_some_and(|length| proven <= length && found.error.upper > length);
    if is_beyond && found.stop == ExactStop::Met {
        found.stop = ExactStop::Rounding;
    }
    (rounding > NOTED * found.error.upper).then(|| {
        format!(
            "binary STL and glTF round vertices by up to {}; ASCII STL, PLY, OBJ and OFF keep them as they are",
            upper_bound(rounding)
        )
    })
}

/// A mesh that is off by no more than this share of the diagonal is the surface itself, as files in single precision have it.
const EXACT: f64 = 1e-6;

/// Share of the diagonal that a mesh may be off by that stands for the limit surface, where triangles reach over several control
/// faces.
const STAND_IN: f64 = 5e-4;

/// The mesh that was read, before corners were divided and control points moved.
pub(super) struct Before {
    /// Where somebody asks how far the result is from it.
    pub(super) surface: Option<BeforeSurface>,
    /// The input's face of each face.
    pub(super) faces: Vec<u32>,
    /// How far the limits of the control points are from its vertices at most, where they were moved for that.
    pub(super) residual: Option<f64>,
}

/// Positions and triangles of the mesh that was read.
pub(super) struct BeforeSurface {
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// How far the result is from the mesh that was read.
fn moved(
    (control, before, parts): (&Mesh, &Before, &FaceParts),
    found: &Exact,
    goals: &Goals,
    arguments: &RefineArguments,
    progress: &Progress,
) -> anyhow::Result<Option<InputDistance>> {
    let Some(BeforeSurface { positions, triangles }) = &before.surface else { return Ok(None) };
    let input = Triangles { positions, triangles };
    let residual = before.residual.unwrap_or(0.0);
    let on_whole = |found: &Exact| -> Vec<Origin> {
        let origins = found.origins.iter().map(|origin| parts.on_whole(origin.face, origin.barycentric));
        origins.map(|(face, barycentric)| Origin { face, barycentric }).collect()
    };
    let origins = on_whole(found);
    if let Some(moved) = InputDistance::new(input, (found, &origins), residual)? {
        return Ok(Some(moved));
    }
    if !found.error.certified {
        return Ok(None);
    }
    // Triangles that reach over several control faces: the limit surface lies between, with another mesh near it.
    let options =
        ExactOptions::default().tolerance(STAND_IN * goals.diagonal).max_triangles(Some(MOST_EXACT));
    let between = exact_observed(control, arguments.scheme()?, &options, &mut progress.observer())?;
    let apart = between.error.upper + found.error.upper;
    let moved = InputDistance::new(input, (&between, &on_whole(&between)), residual)?;
    Ok(moved.map(|moved| moved.of_other(input, (found, &origins), apart)).transpose()?)
}

/// How far the result is from the mesh that was read, if that is farther than it is from the limit surface, and what would
/// keep it nearer.
fn moved_in_words(
    moved: &InputDistanceReport,
    error: &ErrorReport,
    control: &Mesh,
    goals: &Goals,
    arguments: &RefineArguments,
) -> Vec<String> {
    let expected = goals.length.into_iter().chain(error.upper).fold(0.0, f64::max);
    if moved.upper <= expected {
        return Vec::new();
    }
    let mut lines = vec![moved.in_words(&unit_in_words(arguments.build.unit))];
    let is_tagged = arguments.features.crease_angle.is_some() || !control.tags().creases.is_empty();
    let dihedrals = (!is_tagged).then(|| Dihedrals::of(control));
    if let Some(Dihedrals { suggested_crease_angle_degrees: Some(angle), sharp_edges, .. }) = dihedrals {
        let edges = counted(sharp_edges, "edge that looks", "edges that look");
        lines.push(format!("(--crease-angle {} would keep {edges} sharp)", number(angle)));
    }
    if arguments
        .interpolation
        .within(goals.diagonal, arguments.build.unit)
        .is_ok_and(|within| within.is_none())
    {
        lines.push(INTERPOLATE.to_owned());
    }
    lines
}

/// What was reached, in sentences of a line each.
fn achieved(found: &Exact, error: &ErrorReport, goals: &Goals, arguments: &RefineArguments) -> Vec<String> {
    let mut lines = error.in_words(&unit_in_words(arguments.build.unit));
    if error.upper.is_none() {
        lines.push(unproven(goals).to_owned());
    } else if !error.certified {
        let scheme = arguments.scheme.in_quarters().map_or("", |name| name.scheme().name());
        lines.push(format!("(nothing is proven for the scheme {scheme}, only for Loop's and Warren's)"));
    }
    let is_exact = error.upper.is_some_and(|upper| upper <= EXACT * goals.diagonal);
    if found.levels == 0
        && !found.is_optimized
        && found.stop == ExactStop::Met
        && goals.length.is_some()
        && !is_exact
    {
        lines.push(
            "(nothing was divided: all is near enough as it is; a smaller --tolerance makes it rounder)"
                .to_owned(),
        );
    }
    lines.extend(found.pixels.map(|pixels| match pixels.is_finite() {
        true => format!("at most {} pixels as the cameras see it", upper_bound(pixels)),
        false => "not bounded as the cameras see it".to_owned(),
    }));
    if found.unfolded > 0 {
        let regions = counted(found.unfolded, "flat region", "flat regions");
        lines.push(format!("{regions} would fold by the scheme's rules: what the rim encloses stands there"));
    }
    if found.refused > 0 {
        let vertices = counted(found.refused, "vertex", "vertices");
        lines.push(format!("{vertices} kept where a collapse was not proven"));
    }
    lines.extend(open_cones(found));
    lines
}

/// How many triangles stay outside the angle, where that is all that was not reached.
pub(super) fn open_cones(found: &Exact) -> Option<String> {
    let triangles = counted(found.open_cones, "triangle stays", "triangles stay");
    (found.stop == ExactStop::Cones).then(|| {
        format!("{triangles} outside the angle, where the surface has no tangent plane or as good as none")
    })
}

/// Why no distance is certified.
fn unproven(goals: &Goals) -> &'static str {
    if goals.length.is_none() && goals.triangles.is_none() {
        "(no distance was asked for, and what is proven is far more than was found: --tolerance proves one)"
    } else {
        "(no bound was found)"
    }
}

/// What was asked for, defaults filled in.
pub(super) fn parameters(arguments: &RefineArguments, goals: &Goals) -> ParametersReport {
    let options = goals.options(arguments);
    ParametersReport {
        angle_degrees: goals.angle_degrees,
        view: view_report(arguments),
        exact: Some(ExactParametersReport {
            pixels: goals.pixels,
            cameras: goals.cameras.iter().map(CameraReport::from).collect(),
            balance: options.balance,
            optimize: options.optimize,
            divide_flat: arguments.exact.divide_flat,
            max_memory: options.max_memory,
            ..ExactParametersReport::new(goals.length, goals.diagonal, options.max_levels, &arguments.exact)
        }),
        ..ParametersReport::common(arguments)
    }
}

/// Whether a cap ended the refinement before the goals were met, and what was reached.
fn outcome(
    found: &Exact,
    control: &Mesh,
    goals: &Goals,
    achieved: &[String],
    arguments: &RefineArguments,
) -> Outcome {
    let triangles = found.mesh.face_count();
    let cap = match found.stop {
        ExactStop::TriangleCap => format!("--max-triangles {}", thousands(arguments.max_triangles())),
        ExactStop::MemoryCap => {
            format!("--max-memory {}", bytes(arguments.exact.max_memory.unwrap_or_default()))
        }
        ExactStop::LevelCap => format!("--max-levels {}", goals.options(arguments).max_levels),
        _ => String::new(),
    };
    let why = match found.stop {
        ExactStop::TriangleCap | ExactStop::MemoryCap if triangles > arguments.max_triangles() => {
            format!("the control mesh has more than {cap} already")
        }
        // What is met with as many triangles as there are in any case.
        ExactStop::Met if triangles > arguments.max_triangles() => {
            let most = thousands(arguments.max_triangles());
            format!("the control mesh has more than --max-triangles {most} already")
        }
        ExactStop::TriangleCap | ExactStop::MemoryCap if triangles == control.face_count() => {
            format!("{} would take more than {cap}, and nothing was divided", goals.in_words(found))
        }
        ExactStop::TriangleCap | ExactStop::MemoryCap | ExactStop::LevelCap => {
            format!("{cap} was reached before {}", goals.in_words(found))
        }
        ExactStop::Triangles if goals.triangles.is_some_and(|wanted| triangles > wanted) => {
            let wanted = thousands(goals.triangles.unwrap_or_default());
            if arguments.exact.optimize {
                format!("no more edges could be collapsed before --triangles {wanted}")
            } else {
                format!(
                    "the control mesh has {} already, more than --triangles {wanted}; --optimize goes below",
                    thousands(control.face_count())
                )
            }
        }
        ExactStop::Rounding => format!("{} is finer than rounding leaves certain", goals.in_words(found)),
        _ => return Outcome::Done,
    };
    let written = format!(
        "{} was written with {}",
        arguments.output_name(),
        counted(triangles, "triangle", "triangles")
    );
    // The first sentence is the distance; the others have been told with the result.
    let lines: Vec<String> = [why, written].into_iter().chain(achieved.first().cloned()).collect();
    Outcome::StoppedShort(lines.join("\n  "))
}

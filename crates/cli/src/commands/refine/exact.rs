//! Exact refinement: from the goals on the command line to the mesh, its certified distance, and what is said of it.

use limitmesh::Mesh;
use limitmesh::criterion::Camera;
use limitmesh::progress::Stage;
use limitmesh::refine::{Exact, ExactOptions, ExactStop, exact_observed};
use limitmesh_io::{Format, WriteOptions};

use super::provenance::Provenance;
use super::{Refined, cameras, view, view_report};
use crate::arguments::{Extent, Featured, RefineArguments};
use crate::failure::Outcome;
use crate::format::{bytes, counted, thousands, upper_bound};
use crate::progress::Progress;
use crate::report::refinement::exact_stop_name;
use crate::report::{
    CameraReport, ErrorReport, ExactParametersReport, MethodReport, ParametersReport, RoundEntry,
};

/// The tolerance where no goal is given: facets can hardly be seen then in a picture a thousand pixels wide.
const USUAL_TOLERANCE: Extent = Extent::Percent(0.1);

/// A part of the distance that rounding makes up and that is told.
const NOTED: f64 = 0.01;

/// The distance in pixels where cameras are given without one.
const USUAL_PIXELS: f64 = 1.0;

/// The goals, with those that hold where none is given.
pub(super) struct Goals {
    tolerance: Option<Extent>,
    /// Of the input's bounding box.
    diagonal: f64,
    /// How far the output's format may round a vertex.
    rounding: f64,
    angle_degrees: Option<f64>,
    triangles: Option<usize>,
    pixels: Option<f64>,
    cameras: Vec<Camera>,
}

impl Goals {
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
        Ok(Self {
            tolerance,
            diagonal,
            rounding: most_rounding(arguments, control),
            angle_degrees: arguments.angle,
            triangles: exact.triangles,
            pixels: (!cameras.is_empty()).then(|| exact.pixels.unwrap_or(USUAL_PIXELS)),
            cameras,
        })
    }

    /// The tolerance in the mesh's unit.
    fn length(&self) -> Option<f64> {
        self.tolerance.map(|tolerance| tolerance.length(self.diagonal))
    }

    pub(super) fn options(&self, arguments: &RefineArguments) -> ExactOptions {
        let mut options = ExactOptions::default()
            .max_triangles(Some(arguments.max_triangles()))
            .max_memory(arguments.exact.max_memory)
            .balance(arguments.exact.balance)
            .optimize(arguments.exact.optimize)
            .flat_regions(!arguments.exact.divide_flat)
            .origins(arguments.exact.provenance);
        if let Some(pixels) = self.pixels {
            options = options.pixels(pixels, self.cameras.clone());
        }
        if let Some(view) = view(arguments) {
            options = options.view(view);
        }
        if let Some(length) = self.length() {
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

    /// The goals on quality, as a list in words.
    fn in_words(&self) -> String {
        let tolerance = self.tolerance.map(|tolerance| match tolerance {
            Extent::Length(length) => format!("the tolerance of {}", as_typed(length)),
            Extent::Percent(percent) => format!("the tolerance of {} %", as_typed(percent)),
        });
        let angle = self.angle_degrees.map(|degrees| format!("the angle of {}°", as_typed(degrees)));
        let pixels = self.pixels.map(|pixels| format!("the {} pixels", as_typed(pixels)));
        let goals: Vec<String> = [tolerance, angle, pixels].into_iter().flatten().collect();
        if goals.is_empty() { "the triangles asked for".to_owned() } else { goals.join(" and ") }
    }
}

/// The fewest digits that say exactly this number, as a person would write it.
fn as_typed(x: f64) -> String {
    if (1e-6..1e9).contains(&x) { format!("{x}") } else { format!("{x:e}") }
}

/// Refines until the goals are met or a cap is reached.
pub(super) fn run(
    Featured { mesh: control, concave }: &Featured,
    goals: &Goals,
    arguments: &RefineArguments,
    progress: &Progress,
) -> anyhow::Result<Refined> {
    let mut rounds: Vec<RoundEntry> = Vec::new();
    let (mut last, mut show) = (0, progress.observer());
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
    let mut found = exact_observed(control, arguments.scheme.scheme(), &options, &mut observer)?;
    if let Some(note) = round(&mut found, goals, arguments) {
        progress.note(note);
    }
    let error = ErrorReport::new(&found.error, goals.diagonal);
    let outcome = outcome(&found, goals, &error, arguments);
    let achieved = achieved(&found, &error);
    let inverted = found.inverted_triangles();
    let Exact { mesh, normals, origins, parents, pixels, open_cones, stop, levels, refused, .. } = found;
    Ok(Refined {
        mesh,
        normals: Some(normals),
        provenance: arguments.exact.provenance.then(|| Provenance::new(&origins, parents, &concave.parts)),
        achieved: Some(achieved),
        inverted: Some(inverted),
        how: how(levels, refused),
        report: MethodReport {
            steps: Vec::new(),
            rounds,
            levels,
            stop: exact_stop_name(stop),
            needed_triangles: None,
            error: Some(error),
            pixels: pixels.filter(|pixels| pixels.is_finite()),
            open_cones: goals.angle_degrees.map(|_| open_cones),
        },
        outcome,
    })
}

/// The format and options of the output, if it has a name.
fn written(arguments: &RefineArguments) -> Option<(Format, WriteOptions)> {
    let format = Format::from_path(arguments.output.as_deref()?).ok()?;
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
fn round(found: &mut Exact, goals: &Goals, arguments: &RefineArguments) -> Option<String> {
    let (format, options) = written(arguments)?;
    let rounding = limitmesh_io::rounding(format, &options, found.mesh.positions());
    let proven = found.error.upper;
    found.error.upper += rounding;
    found.error.lower = (found.error.lower - rounding).max(0.0);
    let is_beyond = goals.length().is_some_and(|length| proven <= length && found.error.upper > length);
    if is_beyond && found.stop == ExactStop::Met {
        found.stop = ExactStop::Rounding;
    }
    (rounding > NOTED * found.error.upper).then(|| {
        format!(
            "binary STL rounds vertices by up to {}; --ascii, PLY, OBJ and OFF keep them as they are",
            upper_bound(rounding)
        )
    })
}

/// What was reached, in words.
fn achieved(found: &Exact, error: &ErrorReport) -> String {
    let pixels = found.pixels.map(|pixels| match pixels.is_finite() {
        true => format!("; at most {} pixels as the cameras see it", upper_bound(pixels)),
        false => "; not bounded as the cameras see it".to_owned(),
    });
    let cones = (found.stop == ExactStop::Cones).then(|| {
        let triangles = counted(found.open_cones, "triangle stays", "triangles stay");
        format!("; {triangles} outside the angle, where the surface has no tangent plane or as good as none")
    });
    [Some(error.in_words()), pixels, cones].into_iter().flatten().collect()
}

/// How the mesh came about, in words.
fn how(levels: usize, refused: usize) -> String {
    let levels = counted(levels, "level", "levels");
    if refused == 0 {
        return levels;
    }
    format!("{levels}; {} kept where a collapse was not proven", counted(refused, "vertex", "vertices"))
}

/// What was asked for, defaults filled in.
pub(super) fn parameters(arguments: &RefineArguments, goals: &Goals) -> ParametersReport {
    let options = goals.options(arguments);
    ParametersReport {
        angle_degrees: goals.angle_degrees,
        view: view_report(arguments),
        exact: Some(ExactParametersReport {
            tolerance: goals.length(),
            tolerance_percent: goals.length().map(|length| 100.0 * length / goals.diagonal),
            triangles: goals.triangles,
            pixels: goals.pixels,
            cameras: goals.cameras.iter().map(CameraReport::from).collect(),
            balance: options.balance,
            optimize: options.optimize,
            divide_flat: arguments.exact.divide_flat,
            max_levels: options.max_levels,
            max_memory: options.max_memory,
            provenance: arguments.exact.provenance,
        }),
        ..ParametersReport::common(arguments)
    }
}

/// Whether a cap ended the refinement before the goals were met, and what was reached.
fn outcome(found: &Exact, goals: &Goals, error: &ErrorReport, arguments: &RefineArguments) -> Outcome {
    let triangles = found.mesh.face_count();
    let written = format!(
        "{} was written with {}, {}",
        arguments.output_name(),
        counted(triangles, "triangle", "triangles"),
        achieved(found, error)
    );
    let cap = match found.stop {
        ExactStop::TriangleCap => format!("--max-triangles {}", thousands(arguments.max_triangles())),
        ExactStop::MemoryCap => {
            format!("--max-memory {}", bytes(arguments.exact.max_memory.unwrap_or_default()))
        }
        ExactStop::LevelCap => {
            format!("--max-levels {}", goals.options(arguments).max_levels)
        }
        ExactStop::Triangles if goals.triangles.is_some_and(|wanted| triangles > wanted) => {
            let wanted = goals.triangles.unwrap_or_default();
            let wanted = thousands(wanted);
            return Outcome::StoppedShort(if arguments.exact.optimize {
                format!("no more edges could be collapsed before --triangles {wanted}; {written}")
            } else {
                format!("the control mesh has more than --triangles {wanted} already; {written}")
            });
        }
        ExactStop::Rounding => {
            return Outcome::StoppedShort(format!(
                "{} is finer than rounding leaves certain; {written}",
                goals.in_words()
            ));
        }
        _ => return Outcome::Done,
    };
    Outcome::StoppedShort(format!("{cap} was reached before {}; {written}", goals.in_words()))
}

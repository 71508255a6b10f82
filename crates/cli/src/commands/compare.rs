//! `limitmesh compare`: the methods side by side at nearly equal triangle counts.

use std::time::{Duration, Instant};

use limitmesh::Mesh;
use limitmesh::criterion::{LimitNormal, NeighbourNormal};
use limitmesh::front::{Demand, Front, Measure};
use limitmesh::measure::{Bvh, SamplingOptions, hausdorff_between, triangle_quality};
use limitmesh::refine::{
    ExactOptions, Finish, StepwiseOptions, Stop, UniformOptions, exact, stepwise, uniform,
};
use limitmesh::sqrt3::{self, Sqrt3Options};
use limitmesh_paper::{match_angle, methods, nearest_level};

use super::limit_control;
use crate::arguments::{
    CompareArguments, ConcaveCorners, LimitArguments, RefiningScheme, SMOOTH_TRIANGLES,
};
use crate::failure::{Outcome, usage};
use crate::format::{counted, number, seconds, table, thousands, upper_bound};
use crate::input;
use crate::output;
use crate::progress::Progress;
use crate::reference::{self, Reference, USUAL_LEVELS};
use crate::report::{ComparedMethod, IntervalReport, LimitReport, percent};

/// Refines by every method and prints how they compare.
pub(crate) fn run(arguments: &CompareArguments, progress: &Progress) -> anyhow::Result<Outcome> {
    if arguments.limit.smooth_triangles {
        return usage(SMOOTH_TRIANGLES);
    }
    let input = input::load(&arguments.input, &arguments.limit.build, &[], progress)?;
    let diagonal = input.mesh.diagonal();
    let prepared = limit_control::as_asked(input, &arguments.limit, progress)?;
    let (control, limit) = (prepared.input.mesh, prepared.limit);
    let scheme = arguments.limit.scheme().scheme();
    // Finer than what is measured against it by two levels, where that can be afforded.
    let wanted = USUAL_LEVELS.max(arguments.levels + 2);
    let levels = reference::affordable_levels(control.face_count(), wanted);
    progress.stage(format!("refining by {levels} levels as the limit surface"));
    let reference = reference::at_level(&control, scheme, levels)?;
    let tree = Bvh::new(reference.mesh.as_triangles())?;
    let own = arguments.limit.scheme().into();
    let judge = Judge {
        arguments,
        limit,
        scheme: own,
        reference: &reference,
        tree: &tree,
        diagonal,
    };

    let mut methods = Vec::with_capacity(11);
    progress.stage("limit-normal");
    let options = StepwiseOptions::default()
        .levels(arguments.levels)
        .max_triangles(Some(MOST_TRIANGLES));
    let criterion = LimitNormal::new(arguments.angle.to_radians());
    let (proposed, took) = timed(|| stepwise(&control, scheme, &criterion, &options))?;
    let (count, stop) = (proposed.mesh.face_count(), proposed.stop);
    methods.push(judge.judge(Given {
        angle_degrees: Some(arguments.angle),
        ..Given::new("limit-normal", &proposed.mesh, proposed.steps.len(), took)
    })?);
    drop(proposed);

    let triangles = thousands(count);
    progress.stage(format!(
        "amresh: finding the angle for {triangles} triangles"
    ));
    // Far too fine attempts are cut off: that they are too fine is all that matters of them.
    let cap = count.saturating_mul(2).max(control.face_count());
    let options = options.max_triangles(Some(cap));
    let matched = match_angle(count, arguments.angle, |angle| {
        let criterion = NeighbourNormal::new(angle.to_radians());
        stepwise(&control, scheme, &criterion, &options)
    })?;
    let found = &matched.refinement;
    methods.push(judge.judge(Given {
        angle_degrees: Some(matched.angle_degrees),
        ..Given::new("amresh", &found.mesh, found.steps.len(), matched.duration)
    })?);
    drop(matched);

    let level = nearest_level(control.face_count(), count);
    for (name, limit) in [("uniform", false), ("uniform-limit", true)] {
        progress.stage(name);
        let options = UniformOptions::default().levels(level).limit(limit);
        let (found, took) = timed(|| uniform(&control, scheme, &options))?;
        methods.push(judge.judge(Given::new(name, &found.mesh, level, took))?);
    }
    let unfolds = limit.features.concave_corners() == ConcaveCorners::Fixed;
    let plain = ExactOptions::default().triangles(count).unfold(unfolds);
    let mut kinds = vec![
        ("exact", plain.clone()),
        ("exact-balance", plain.clone().finish(Finish::Balanced)),
    ];
    if count <= MOST_OPTIMISED {
        kinds.push(("exact-optimize", plain.finish(Finish::Collapsed)));
    }
    for (name, options) in kinds {
        progress.stage(name);
        let (found, took) = timed(|| exact(&control, scheme, &options))?;
        let error = &found.error;
        methods.push(judge.judge(Given {
            certified: error.certified.then_some([error.lower, error.upper]),
            ..Given::new(name, &found.mesh, found.statistics.levels, took)
        })?);
    }
    let mut others: Vec<(&str, anyhow::Result<ComparedMethod>)> = Vec::new();
    for (name, measure) in RESTRICTED {
        progress.stage(name);
        others.push((name, by_restricted(name, measure, &control, count, &judge)));
    }
    let of_part = limit
        .interpolation
        .is_of_part
        .then_some("--crease-angle auto");
    progress.stage("sqrt3");
    let most = reference.mesh.face_count();
    others.push((
        "sqrt3",
        match limit.interpolation.given().or(of_part) {
            Some(option) => Err(anyhow::anyhow!(
                "{option} is for schemes that split triangles in four"
            )),
            None => by_sqrt3(&control, count, most, &judge),
        },
    ));
    for (name, found) in others {
        match found {
            Ok(found) => methods.push(found),
            Err(why) => progress.note(format!("{name} left out: {why}")),
        }
    }
    progress.clear();
    if arguments.json {
        output::print(&output::json(&methods)?)?;
    } else {
        output::print(&in_words(arguments, &judge, &methods))?;
    }
    Ok(match stop {
        Stop::TriangleCap { needed } => Outcome::StoppedShort(format!(
            "the next step by limit normals would have given {}; the comparison is at {}",
            counted(needed, "triangle", "triangles"),
            counted(count, "triangle", "triangles"),
        )),
        _ => Outcome::Done,
    })
}

/// Triangles that a method may give: more would need more memory than most machines have.
const MOST_TRIANGLES: usize = 20_000_000;

/// Criteria of the literature over a restricted quadtree, by their names.
const RESTRICTED: [(&str, Measure); 3] = [
    ("planarity", Measure::PlanarityAngle),
    ("planarity-distance", Measure::PlanarityDistance),
    ("vertex-error", Measure::VertexError),
];

/// A result, and how long it took.
fn timed<T, E>(work: impl FnOnce() -> Result<T, E>) -> Result<(T, Duration), E> {
    let start = Instant::now();
    let found = work()?;
    Ok((found, start.elapsed()))
}

/// A criterion over a restricted quadtree, by the least limit that takes at most so many triangles.
fn by_restricted(
    name: &'static str,
    measure: Measure,
    control: &Mesh,
    count: usize,
    judge: &Judge<'_>,
) -> anyhow::Result<ComparedMethod> {
    let start = Instant::now();
    let scheme = judge.limit.scheme().scheme();
    let mut front = Front::measured_by(control, scheme, measure)?;
    let demand = Demand::tolerance(0.0).triangles(count);
    front.update(&demand.max_levels(methods::DEEPEST))?;
    let mesh = front.mesh()?;
    let (took, levels) = (start.elapsed(), front.depth() as usize);
    let is_angle = measure == Measure::PlanarityAngle;
    judge.judge(Given {
        angle_degrees: is_angle.then(|| front.limit().to_degrees()),
        ..Given::new(name, &mesh, levels, took)
    })
}

/// Adaptive √3-subdivision with so many triangles, against its own limit surface, by as many triangles as the other one at most.
fn by_sqrt3(
    control: &Mesh,
    count: usize,
    most: usize,
    judge: &Judge<'_>,
) -> anyhow::Result<ComparedMethod> {
    let options = Sqrt3Options::default().triangles(Some(count));
    let (found, took) = timed(|| sqrt3::adaptive(control, &options))?;
    let (mesh, levels) = methods::sqrt3_reference(control, 0, most)?;
    let reference = Reference { mesh, levels };
    let tree = Bvh::new(reference.mesh.as_triangles())?;
    let judge = Judge {
        scheme: RefiningScheme::Sqrt3,
        reference: &reference,
        tree: &tree,
        ..*judge
    };
    judge.judge(Given::new("sqrt3", &found.mesh, found.levels, took))
}

/// The result of a method: a mesh after some steps or levels.
struct Given<'a> {
    method: &'static str,
    angle_degrees: Option<f64>,
    mesh: &'a Mesh,
    levels: usize,
    /// Bounds that are proven.
    certified: Option<[f64; 2]>,
    took: Duration,
}

impl<'a> Given<'a> {
    fn new(method: &'static str, mesh: &'a Mesh, levels: usize, took: Duration) -> Self {
        Self {
            method,
            angle_degrees: None,
            mesh,
            levels,
            certified: None,
            took,
        }
    }
}

/// Triangles up to which the optimised mesh is shown too: beyond, it would take minutes.
const MOST_OPTIMISED: usize = 200_000;

/// Measures every method against the same limit surface.
#[derive(Clone, Copy)]
struct Judge<'a> {
    arguments: &'a CompareArguments,
    /// The control mesh of the limit surface, and its scheme.
    limit: LimitArguments,
    scheme: RefiningScheme,
    reference: &'a Reference,
    /// The reference's search tree, built once for all methods.
    tree: &'a Bvh<'a>,
    /// Of the control mesh's bounding box.
    diagonal: f64,
}

impl Judge<'_> {
    /// Measures what a method gave.
    fn judge(&self, given: Given<'_>) -> anyhow::Result<ComparedMethod> {
        let surface = given.mesh.as_triangles();
        let options = SamplingOptions::default().samples(self.arguments.samples);
        let distance = hausdorff_between(&Bvh::new(surface)?, self.tree, &options);
        let quality = triangle_quality(surface);
        let diagonal = self.diagonal.max(f64::MIN_POSITIVE);
        let percent = |length| percent(length, diagonal);
        let interval = |[lower, upper]: [f64; 2]| IntervalReport::new(lower, upper, diagonal);
        let levels = self.reference.levels;
        Ok(ComparedMethod {
            method: given.method,
            angle_degrees: given.angle_degrees,
            levels: given.levels,
            triangles: surface.triangles.len(),
            symmetric: distance.symmetric(),
            symmetric_percent: percent(distance.symmetric()),
            mean_percent: percent(distance.forward.mean),
            rms_percent: percent(distance.forward.rms),
            certified: given.certified.map(interval),
            samples: distance.forward.samples + distance.backward.samples,
            min_angle_degrees: quality.min_angle_degrees,
            mean_min_angle_degrees: quality.mean_min_angle_degrees,
            seconds: given.took.as_secs_f64(),
            reference: LimitReport {
                scheme: self.scheme,
                ..LimitReport::new(&self.limit, self.diagonal, levels)?
            },
            reference_triangles: self.reference.mesh.face_count(),
        })
    }
}

fn in_words(arguments: &CompareArguments, judge: &Judge<'_>, methods: &[ComparedMethod]) -> String {
    let heads = [
        "method",
        "angle",
        "levels",
        "triangles",
        "distance %",
        "proven %",
        "mean %",
        "least angle",
        "time",
    ];
    let mut rows = vec![heads.map(str::to_owned).to_vec()];
    for m in methods {
        rows.push(vec![
            m.method.to_owned(),
            m.angle_degrees
                .map_or_else(|| "-".to_owned(), |angle| format!("{angle:.3}°")),
            m.levels.to_string(),
            thousands(m.triangles),
            number(m.symmetric_percent),
            m.certified
                .as_ref()
                .map_or_else(|| "-".to_owned(), |c| upper_bound(c.upper_percent)),
            number(m.mean_percent),
            format!("{:.2}°", m.min_angle_degrees),
            seconds(m.seconds),
        ]);
    }
    format!(
        "{}, against its limit surface ({}, {} levels)\n\n{}\n\
         Distances are symmetric Hausdorff distances in per cent of the control mesh's diagonal, sampled: lower \
         bounds,\n{} samples a surface, or more where it has more vertices. What is proven is an upper bound.{}\n",
        input::display_name(&arguments.input),
        counted(judge.reference.mesh.face_count(), "triangle", "triangles"),
        judge.reference.levels,
        table(&rows),
        thousands(arguments.samples),
        if methods.iter().any(|m| m.method == "sqrt3") {
            "\nsqrt3 is measured against its own limit surface."
        } else {
            ""
        },
    )
}

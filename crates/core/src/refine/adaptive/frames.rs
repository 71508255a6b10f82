//! One refinement for several positions of a control mesh: the frames of an animation.
//!
//! A node is divided if it has to be for any frame: the plan that the first frame takes is handed from frame to frame, its triangles
//! are looked at among their neighbours on each frame's own surface, and what fails is divided, until a whole round changes
//! nothing. Then each frame is replayed with that plan, and measured as it came out.

use super::demands::Demands;
use super::flat::RimGaps;
use super::judge::Goal;
use super::measure::{Look, measure};
use super::measured::Measured;
use super::result::open_cones;
use super::state::State;
use super::{Engine, Task};
use crate::mesh::Mesh;
use crate::progress::{Observer, Stage};
use crate::refine::exact_options::ExactOptions;
use crate::refine::exact_result::{ErrorBounds, Exact, ExactStop, Statistics};
use crate::refine::replay::{Frame, Replay, ReplayError};
use crate::refine::{RefineError, adaptive::probe};
use crate::scheme::Scheme;

/// The result of several frames.
pub(in crate::refine) struct Found {
    /// With the vertices of the first frame.
    pub(in crate::refine) refined: Exact,
    pub(in crate::refine) replay: Replay,
    /// By frame.
    pub(in crate::refine) errors: Vec<ErrorBounds>,
}

/// Refines for all frames; options have origins and neither flat regions, balance, optimisation, goals for attributes nor a number
/// of triangles.
pub(in crate::refine) fn frames(
    control: &Mesh,
    scheme: &dyn Scheme,
    frames: &[Vec<[f64; 3]>],
    options: &ExactOptions,
    observer: &mut Observer<'_>,
) -> Result<Found, RefineError> {
    let meshes = frames.iter().enumerate().map(|(frame, positions)| {
        let mesh = control.clone().with_positions(positions.clone());
        mesh.map_err(|why| ReplayError::Frame { frame, why })
    });
    let meshes = meshes.collect::<Result<Vec<_>, _>>()?;
    let demands = Demands::default();
    let task = |mesh| Task {
        mesh,
        scheme,
        options,
        demands: &demands,
    };
    let state = task(&meshes[0]).with_engine(observer, |engine| first(engine, options))?;
    let mut state = united(task(control), &meshes, state, observer)?;
    let refined = task(&meshes[0]).with_engine(observer, |engine| {
        let emission = engine.emit_all(&state)?;
        engine.check(&emission)?;
        // Options for frames have no flat regions.
        let mut found = engine.assemble(emission, &mut RimGaps::default())?;
        found.statistics.levels = state.levels(engine.watch)?;
        Ok(found)
    })?;
    let replay = Replay::new_observed(control, scheme, &refined, observer)?;
    let (mut frame, mut all) = (Frame::default(), Vec::with_capacity(frames.len()));
    for mesh in &meshes {
        replay.frame(mesh.positions(), &mut frame)?;
        all.push(task(mesh).with_engine(observer, |engine| {
            proven(engine, &mut state, &refined, &frame, options)
        })?);
    }
    replay.frame(meshes[0].positions(), &mut frame)?;
    let greatest = |of: fn(&Proven) -> f64| all.iter().map(of).fold(0.0, f64::max);
    let worst = greatest(|own| own.worst);
    let open_cones = all.iter().map(|own| own.open_cones).fold(0, usize::max);
    let stop = match () {
        () if state.has_failed || worst > 1.0 + f64::EPSILON => ExactStop::LevelCap,
        () if open_cones > 0 => ExactStop::Cones,
        () => ExactStop::Met,
    };
    let pixels = options
        .goals
        .pixels
        .as_ref()
        .map(|_| greatest(|own| own.pixels));
    let error = all[0].error;
    let refined = Exact {
        error,
        pixels,
        stop,
        statistics: Statistics {
            worst,
            open_cones,
            ..refined.statistics
        },
        ..refined.moved_to(&frame)?
    };
    Ok(Found {
        refined,
        replay,
        errors: all.into_iter().map(|own| own.error).collect(),
    })
}

/// The state of the first frame, of which nothing is taken for granted.
fn first(engine: &Engine<'_>, options: &ExactOptions) -> Result<State, RefineError> {
    let (most, _) = options.budget();
    let goal = Goal::Within(engine.floor(options.goals.tolerance));
    let found = engine
        .refined(goal, most)?
        .ok_or(ReplayError::TooMany { frame: 0, most })?;
    Ok(found.state)
}

/// The state with all that the frames need; the task's mesh is none of them.
fn united(
    task: Task<'_>,
    meshes: &[Mesh],
    mut state: State,
    observer: &mut Observer<'_>,
) -> Result<State, RefineError> {
    let (most, _) = task.options.budget();
    // Frames in a row for which nothing had to be divided.
    let mut settled = 0;
    // Twelve rounds over all frames: each does nothing but what dividing for other frames brought about.
    for frame in (0..meshes.len()).cycle().take(12 * meshes.len()) {
        if settled == meshes.len() {
            break;
        }
        let triangles = state.triangles;
        let mesh = &meshes[frame];
        state = Task { mesh, ..task }.with_engine(observer, |engine| {
            state.forget();
            state.has_fixed_diagonals = true;
            state.goal = Goal::Within(engine.floor(task.options.goals.tolerance));
            let found = engine.verified(state, most)?;
            Ok(found.ok_or(ReplayError::TooMany { frame, most })?.state)
        })?;
        settled = if state.triangles == triangles {
            settled + 1
        } else {
            1
        };
    }
    Ok(state)
}

/// The bounds and normals of a frame.
struct Proven {
    error: ErrorBounds,
    /// How many times over its worst triangle fails.
    worst: f64,
    /// As its cameras see it; 0 without any.
    pixels: f64,
    /// Triangles outside their cones; 0 where no angle is asked for.
    open_cones: usize,
}

/// Measures the refined mesh in the positions of a frame.
fn proven(
    engine: &Engine<'_>,
    state: &mut State,
    refined: &Exact,
    frame: &Frame,
    options: &ExactOptions,
) -> Result<Proven, RefineError> {
    let mut emission = engine.emit_all(state)?;
    emission.positions.copy_from_slice(&frame.positions);
    engine.watch.stage(Stage::Bounding, None)?;
    let floor = engine.floor(options.goals.tolerance);
    let all: Vec<u32> = (0..state.faces()).collect();
    let goal = Goal::Within(floor);
    let look = Look {
        goal: &goal,
        divided_above: 0,
        length: f64::INFINITY,
        changes: None,
        bulges: None,
        trusted: &[],
    };
    state.measured = measure(&engine.sources(state, &emission), engine.watch, &all, &look)?;
    state.is_trusted.fill(false);
    let greatest = |of: fn(&Measured) -> f64| state.measured.iter().map(of).fold(0.0, f64::max);
    let (value, pixels) = (greatest(|face| face.value), greatest(|face| face.pixels));
    let is_met = options.goals.tolerance.is_some() && value <= floor;
    let error = probe::probe(engine, state, &emission, is_met)?;
    engine.check(&emission)?;
    let beyond = options
        .goals
        .tolerance
        .map_or(0.0, |tolerance| error.upper / tolerance);
    let criteria = engine.control.criteria.as_ref();
    let open_cones = match criteria.filter(|_| options.goals.angle.is_some()) {
        Some(criteria) => open_cones(&refined.clone().moved_to(frame)?, criteria, engine.watch)?,
        None => 0,
    };
    let worst = if criteria.is_some() {
        value.max(beyond)
    } else {
        beyond
    };
    Ok(Proven {
        error,
        worst,
        pixels,
        open_cones,
    })
}

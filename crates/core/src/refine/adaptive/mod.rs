//! Exact refinement: triangles within a tolerance of the true limit surface, with all vertices on it.
//!
//! Takes a control mesh, a scheme and goals; gives a conforming mesh, limit normals, where each vertex and triangle
//! came from, and a certified interval for the distance between the mesh and the limit surface.
//!
//! 1. [`divide`]: a quadtree over each control face, by guesses from its piece of the limit surface alone;
//! 2. [`rounds`], the one loop: adjacent leaves at most one level apart ([`balance`]), vertices on control edges ([`chains`]), Figure 5
//!    ([`cover`]), the mesh written or updated where it lies ([`emit`]), vertices moved where asked ([`bulges`], [`offsets`]), and all
//!    triangles among their neighbours ([`measure`]); what fails is split;
//! 3. [`budget`]: for a number of triangles, the least value whose result fits;
//! 4. [`probe`]: the certified interval;
//! 5. [`flat`]: regions whose surface lies in a plane, triangulated from their rims.

mod asking;
mod back_faces;
mod backs;
mod balance;
mod budget;
mod bulges;
mod caps;
mod chains;
mod changes;
mod closing;
mod coarser;
mod control;
mod cover;
mod demands;
mod dirty;
mod divide;
mod edge_curves;
mod emit;
mod emitted;
mod flat;
mod frames;
mod judge;
mod leaf;
mod leaves;
mod measure;
mod measured;
mod neighbours;
mod nested;
mod offsets;
mod probe;
mod quadtree;
mod result;
mod rim;
mod rounds;
mod seen;
mod sides;
mod state;
mod surface;
mod touched;
mod trial;
mod walk;

pub(super) use caps::within;
pub(super) use frames::frames;
pub(super) use nested::nested;
pub(super) use probe::rounding;

use super::RefineError;
use super::exact_options::{ExactOptions, Finish};
use super::exact_result::{Exact, ExactStop};
use super::junctions::join_copies;
use super::kept_faces::KeptFaces;
use crate::criterion::{Criteria, Distance, LimitNormal, Pixels};
use crate::limit::{LimitTable, Stencils};
use crate::math;
use crate::mesh::{Mesh, Sharpness};
use crate::patch::Rules;
use crate::patch::large_rings::LargeRings;
use crate::progress::{Observer, SharedWatch, Stage};
use crate::scheme::Scheme;
use back_faces::BackFaces;
use caps::{may_do_with_fewer, once, without_gaps};
use control::Control;
use demands::{Demands, Functions, Room, surfaces_of};
use flat::regions::FlatRegions;
use judge::Goal;
use quadtree::{Edges, NodeAddress};

/// Triangles that splitting a leaf adds, closing included, on the average.
const ADDED: usize = 6;

/// Refines until the goals are met, or as far as the caps allow.
pub(super) fn adaptive(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    options: &ExactOptions,
    observer: &mut Observer<'_>,
) -> Result<Exact, RefineError> {
    let surfaces = surfaces_of(&options.goals.attributes, scheme)?;
    let functions = Functions::of(&options.goals.attributes, &surfaces);
    let task = Task {
        mesh,
        scheme,
        options,
        demands: &Demands::default(),
    };
    if functions.is_empty() {
        return once(task, observer);
    }
    let (most, cap) = options.budget();
    let room = Room::of(
        mesh,
        options,
        most.saturating_sub(mesh.face_count()) / ADDED,
    );
    let demanded = functions.demands(room, &SharedWatch::new(observer, Stage::Refining))?;
    let fits = demanded.is_some();
    let mut demands = match demanded {
        Some(demands) => demands,
        None => fitting(&functions, room, observer)?,
    };
    loop {
        let mut found = once(
            Task {
                demands: &demands,
                ..task
            },
            observer,
        )?;
        let held = functions.held(mesh, &found, &SharedWatch::new(observer, Stage::Bounding))?;
        let is_met = functions.are_met(&held.bounds);
        found.attribute_bounds = held.bounds;
        if found.stop != ExactStop::Met || is_met {
            return Ok(found);
        }
        let deepest = |place: &NodeAddress| place.level as usize >= options.caps.levels;
        let mut is_new = false;
        for place in held.failing.into_iter().filter(|place| !deepest(place)) {
            is_new |= demands.add(place);
        }
        // Without room for them, or where nothing may be divided any further, that is how far it comes.
        if !fits || !is_new || demands.len() > room.nodes {
            found.stop = if fits && !is_new {
                ExactStop::LevelCap
            } else {
                cap
            };
            return Ok(found);
        }
    }
}

/// The nodes that goals ask for which are as many times coarser, by powers of two, as it takes for there to be no more than there may be;
/// none where no such goals are.
fn fitting(
    functions: &Functions<'_>,
    room: Room,
    observer: &mut Observer<'_>,
) -> Result<Demands, RefineError> {
    // Goals that are 2⁶⁴ times as coarse fit any mesh.
    for halvings in 1..=64 {
        let coarser = functions.coarser(math::exp2(f64::from(halvings)));
        let found = coarser.demands(room, &SharedWatch::new(observer, Stage::Refining))?;
        if let Some(demands) = found {
            return Ok(demands);
        }
    }
    Ok(Demands::default())
}

/// The triangles that goals so many times as coarse take; with angles or pixels but for those of leaves that turn out to fail among
/// their neighbours.
pub(super) fn count(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    options: &ExactOptions,
    times: f64,
    observer: &mut Observer<'_>,
) -> Result<usize, RefineError> {
    let surfaces = surfaces_of(&options.goals.attributes, scheme)?;
    let functions = Functions::of(&options.goals.attributes, &surfaces).coarser(times);
    let room = Room::of(mesh, options, usize::MAX);
    let demands = functions.demands(room, &SharedWatch::new(observer, Stage::Refining))?;
    let Some(demands) = demands else {
        return Ok(usize::MAX);
    };
    let plain = options.clone().finish(Finish::OnSurface);
    // As in [`once`], angles that balanced vertices meet late are met with plain ones.
    let fewest = match options.is_balanced() && options.goals.angle.is_some() {
        true => count(mesh, scheme, &plain, times, observer)?,
        false => usize::MAX,
    };
    let most = options.budget().0;
    let task = Task {
        mesh,
        scheme,
        options,
        demands: &demands,
    };
    let found = without_gaps(task, most, observer, |engine, gaps| {
        let limit = engine.floor(options.goals.tolerance.map(|tolerance| times * tolerance));
        let limit = if engine.control.criteria.is_some() {
            times
        } else {
            limit
        };
        let goal = if engine.is_balanced {
            Goal::Balanced(limit)
        } else {
            Goal::Within(limit)
        };
        let most = if engine.is_balanced {
            fewest
        } else {
            usize::MAX
        };
        let Some(found) = engine.refined(goal, most)? else {
            return Ok(fewest);
        };
        if engine.control.flat.are_none() {
            return Ok(found.state.triangles);
        }
        // Only a run shows which regions cannot be triangulated from their rims.
        Ok(engine.assemble(found.emission, gaps)?.mesh.face_count())
    })?;
    if options.is_balanced()
        && options.goals.angle.is_none()
        && may_do_with_fewer(
            Task {
                options: &plain,
                ..task
            },
            found,
            observer,
        )?
    {
        return Ok(found.min(count(mesh, scheme, &plain, times, observer)?));
    }
    Ok(found)
}

/// The triangles that a distance takes over the first `faces` of a mesh alone, which are divided as among their neighbours.
pub(super) fn count_over_first(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    options: &ExactOptions,
    distance: f64,
    faces: usize,
    observer: &mut Observer<'_>,
) -> Result<usize, RefineError> {
    let task = Task {
        mesh,
        scheme,
        options,
        demands: &Demands::default(),
    };
    task.with_engine(observer, |engine| {
        let mut is_divided = vec![false; mesh.face_count()];
        for h in 0..3 * faces as u32 {
            is_divided[h as usize / 3] = true;
            engine
                .control
                .edges
                .twin(h)
                .into_iter()
                .for_each(|twin| is_divided[twin as usize / 3] = true);
        }
        let goal = Goal::Partly(f64::INFINITY, engine.floor(Some(distance)), is_divided);
        let Some(found) = engine.refined(goal, usize::MAX)? else {
            return Ok(0);
        };
        let state = &found.state;
        let over = |face: u32| {
            let own = state.covers[face as usize].triangles as usize;
            engine
                .control
                .flat
                .count_over(engine.control, &state.chains, face, own)
        };
        Ok((0..faces as u32).map(over).sum())
    })
}

/// The control mesh, the options, and the nodes that are divided in any case.
#[derive(Clone, Copy)]
struct Task<'a> {
    mesh: &'a Mesh,
    scheme: &'a dyn Scheme,
    options: &'a ExactOptions,
    /// The nodes that are divided in any case.
    demands: &'a Demands,
}

impl Task<'_> {
    /// Runs an engine for the task.
    fn with_engine<T>(
        &self,
        observer: &mut Observer<'_>,
        run: impl FnOnce(&Engine<'_>) -> Result<T, RefineError>,
    ) -> Result<T, RefineError> {
        let Self {
            mesh,
            scheme,
            options,
            demands,
        } = *self;
        let watch = SharedWatch::new(observer, Stage::Limits);
        watch.triangles(mesh.face_count());
        let rules = Rules::of(scheme);
        let table = LimitTable::new(scheme);
        let vertices = Some(mesh.vertex_count());
        watch.stage(Stage::Limits, vertices)?;
        let stencils = Stencils::of(&table, mesh, &mut |_| watch.poll())??;
        let mut positions = table.positions_by(&stencils, mesh, &mut |done| watch.done(done))?;
        watch.stage(Stage::Limits, vertices)?;
        let sided = table.sided_normals_by(&stencils, mesh, &mut |done| watch.done(done))?;
        drop(stencils);
        join_copies(&mut positions, &mesh.junctions().vertices);
        let sharpness = Sharpness::of(mesh);
        let infinitely_sharp = sharpness.infinitely_sharp();
        let kept = KeptFaces::of(mesh, &options.kept_edges)?;
        let mut control = Control {
            mesh,
            edges: Edges::of(mesh),
            sharpness: &sharpness,
            large: LargeRings::with_tags_polled(mesh, &sharpness, &rules, &mut |_| watch.poll())?,
            infinitely_sharp: &infinitely_sharp,
            positions,
            sided,
            rules: &rules,
            flat: FlatRegions::default(),
            criteria: None,
            back_faces: BackFaces::default(),
            kept: &kept,
            demands,
            leaves_ask: demands.let_leaves_ask() && !options.for_quads,
        };
        if options.flat_regions
            && (!options.is_balanced() || options.unfold)
            && options.goals.attributes.is_empty()
        {
            control.flat = FlatRegions::of(&control, options, &watch)?;
        }
        let rounding =
            probe::rounding(mesh, options.caps.levels, &watch)? + control.flat.allowance();
        control.criteria = criteria(mesh, options, rounding)?;
        control.back_faces = BackFaces::of(&control, options.is_balanced(), &watch)?;
        let engine = Engine {
            control: &control,
            max_levels: options.caps.levels as u32,
            watch: &watch,
            is_balanced: options.is_balanced(),
            has_origins: options.origins,
            rounding,
        };
        watch.stage(Stage::Refining, None)?;
        run(&engine)
    }
}

/// Runs an engine for Loop's scheme and options alone.
#[cfg(test)]
fn with_engine<T>(
    mesh: &Mesh,
    options: &ExactOptions,
    run: impl FnOnce(&Engine<'_>) -> Result<T, RefineError>,
) -> Result<T, RefineError> {
    let task = Task {
        mesh,
        scheme: &crate::scheme::Loop,
        options,
        demands: &Demands::default(),
    };
    task.with_engine(&mut crate::progress::unobserved, run)
}

/// The criteria of the options; `None` where they ask for nothing but distances and numbers of triangles.
fn criteria(
    mesh: &Mesh,
    options: &ExactOptions,
    rounding: f64,
) -> Result<Option<Criteria>, RefineError> {
    if options.goals.angle.is_none() && options.goals.pixels.is_none() {
        return Ok(None);
    }
    let goals = &options.goals;
    let distance = goals
        .tolerance
        .map(|tolerance| Distance::new(tolerance, rounding));
    let cone = goals.angle.map(|goal| LimitNormal {
        view: goal.view,
        ..LimitNormal::new(goal.radians)
    });
    let is_closed = mesh.topology().boundary_edge_count() == 0;
    let pixels = goals
        .pixels
        .as_ref()
        .map(|goal| Pixels::new(goal.pixels, &goal.cameras, is_closed))
        .transpose()?;
    Ok(Some(Criteria::new(distance, cone, pixels, rounding)?))
}

/// The settings of a run.
#[derive(Clone, Copy)]
struct Engine<'a> {
    control: &'a Control<'a>,
    max_levels: u32,
    watch: &'a SharedWatch<'a>,
    /// Vertices are moved off the surface.
    is_balanced: bool,
    /// Vertices tell where they came from.
    has_origins: bool,
    /// The greatest rounding error of a distance.
    rounding: f64,
}

impl Engine<'_> {
    /// The value that is good enough for all triangles: a distance where nothing else counts, else 1; 0 where nothing is.
    fn floor(&self, tolerance: Option<f64>) -> f64 {
        match (&self.control.criteria, tolerance) {
            (Some(_), _) => 1.0,
            (None, Some(tolerance)) => Distance::new(tolerance, self.rounding).allowed(),
            (None, None) => 0.0,
        }
    }
}

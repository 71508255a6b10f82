//! Exact refinement: triangles within a tolerance of the true limit surface, with all vertices on it.
//!
//! Takes a control mesh, a scheme and goals; gives a conforming mesh, limit normals, where each vertex and triangle
//! came from, and a certified interval for the distance between the mesh and the limit surface.
//!
//! Passes, each a function of what came before, numbered as in ARCHITECTURE.md:
//!
//! 1. `LimitTable`: limit positions and normals of the control vertices;
//! 2. `decide`: a quadtree over each control face, from its piece of the limit surface alone;
//! 3. allowances, by control face, for what triangles count on of those beside them: `Decision::settle` divides
//!    again where they were too small;
//! 4. `balance`: neighbouring leaves at most one level apart;
//! 5. `chains`: the vertices on control edges;
//! 6. `walk` and `close`: the closing triangles, judged and counted; what fails is split, and `carry_out` does 4 to 6 again there;
//! 7. `emit`: vertices, triangles and their connections, written at once, or updated where they lie; `bulges` and `offsets` move vertices
//!    where asked;
//! 8. `settle`, or `measure` for goals beside distances: the triangles among their neighbours; what fails is split, and
//!    4 to 7 are done again;
//! 9. `budget`: for a number of triangles, the least distance whose plan fits: 2 to 8 for each that is tried;
//! 10. `probe`: the certified interval;
//! 11. `flat`: regions whose surface lies in a plane, triangulated from their rims.

mod among;
mod area;
mod backs;
mod balance;
mod budget;
mod bulges;
mod caps;
mod carry_out;
mod chains;
mod changes;
mod close;
mod coarser;
mod control;
mod decide;
mod demands;
mod dirty;
mod emit;
mod emitted;
mod flat;
mod frames;
mod guess;
mod judge;
mod leaf;
mod leaves;
mod measure;
mod measured;
mod nested;
mod offsets;
mod plan;
mod probe;
mod quadtree;
mod result;
mod rim;
mod settle;
mod sides;
mod surface;
mod trial;
mod walk;

pub(super) use nested::nested;

use super::RefineError;
use super::exact_options::ExactOptions;
use super::exact_result::{Exact, ExactStop};
use super::junctions::join_copies;
use super::kept_faces::KeptFaces;
use crate::criterion::{Criteria, Distance, LimitNormal, Pixels};
use crate::limit::{LimitTable, Stencils};
use crate::mesh::{Mesh, Sharpness};
use crate::patch::Rules;
use crate::patch::large_rings::LargeRings;
use crate::progress::{Observer, SharedWatch, Stage};
use crate::scheme::Scheme;
use backs::BackFaces;
pub(super) use caps::within;
use caps::{may_do_with_fewer, once, without_gaps};
use control::Control;
use demands::{Demands, Functions, surfaces_of};
use emit::{Emission, Last, Scope};
use flat::{FlatRegions, Net};
pub(super) use frames::frames;
use judge::Goal;
use plan::Plan;
use quadtree::{Edges, Place};
use result::Outcome;

/// Triangles that splitting a leaf adds, closing included, on the average.
const ADDED: usize = 6;

/// Goals for attributes are tried up to 2 to the power of this times as coarse where there is no room for what they ask.
const COARSEST: u32 = 64;

/// Under a budget with angles or pixels, the part that is kept for leaves that fail among their neighbours (one in so many) where
/// that was too little.
const RESERVE: usize = 100;

/// Under a budget an even division that is nearer is taken where what is proven of it is at most so many times as far.
const PROVEN_ALIKE: f64 = 1.25;

/// Refines until the goals are met, or as far as the caps allow.
pub(super) fn adaptive(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    options: &ExactOptions,
    observer: &mut Observer<'_>,
) -> Result<Exact, RefineError> {
    let surfaces = surfaces_of(&options.attributes, scheme)?;
    let functions = Functions::of(&options.attributes, &surfaces);
    if functions.is_empty() {
        return once(mesh, scheme, (options, &Demands::default()), observer);
    }
    let (most, cap) = options.budget();
    let room = most.saturating_sub(mesh.face_count()) / ADDED;
    let watched = (mesh.face_count(), options.max_levels as u32, room);
    let demanded = functions.demands(watched, &SharedWatch::new(observer, Stage::Refining))?;
    let fits = demanded.is_some();
    let mut demands = match demanded {
        Some(demands) => demands,
        None => fitting(&functions, watched, observer)?,
    };
    loop {
        let mut found = once(mesh, scheme, (options, &demands), observer)?;
        let held = functions.held(mesh, &found, &SharedWatch::new(observer, Stage::Bounding))?;
        let is_met = functions.are_met(&held.bounds);
        found.attribute_bounds = held.bounds;
        if found.stop != ExactStop::Met || is_met {
            return Ok(found);
        }
        let deepest = |place: &Place| place.level as usize >= options.max_levels;
        let mut is_new = false;
        for place in held.failing.into_iter().filter(|place| !deepest(place)) {
            is_new |= demands.add(place);
        }
        // Without room for them, or where nothing may be divided any further, that is how far it comes.
        if !fits || !is_new || demands.len() > room {
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
    watched: (usize, u32, usize),
    observer: &mut Observer<'_>,
) -> Result<Demands, RefineError> {
    for halvings in 1..=COARSEST {
        let coarser = functions.coarser(f64::from(halvings).exp2());
        let found = coarser.demands(watched, &SharedWatch::new(observer, Stage::Refining))?;
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
    let surfaces = surfaces_of(&options.attributes, scheme)?;
    let functions = Functions::of(&options.attributes, &surfaces).coarser(times);
    let watched = (mesh.face_count(), options.max_levels as u32, usize::MAX);
    let demands = functions.demands(watched, &SharedWatch::new(observer, Stage::Refining))?;
    let demands = demands.unwrap_or_default();
    let plain = options.clone().balance(false);
    // As in [`once`], angles that balanced vertices meet late are met with plain ones.
    let fewest = match options.balance && options.angle.is_some() {
        true => Some(count(mesh, scheme, &plain, times, observer)?),
        false => None,
    };
    let most = options.budget().0;
    let found = without_gaps(
        mesh,
        scheme,
        ((options, &demands), most),
        observer,
        |engine| {
            let limit = engine.floor(options.tolerance.map(|tolerance| times * tolerance));
            let limit = if engine.control.criteria.is_some() {
                times
            } else {
                limit
            };
            let plan = if engine.is_balanced {
                engine
                    .balanced(limit, fewest.unwrap_or(usize::MAX))?
                    .map(|outcome| outcome.plan)
            } else {
                engine
                    .without_counting_strips()
                    .plan(Goal::Within(limit), usize::MAX)?
            };
            let Some(mut plan) = plan else {
                return Ok(fewest.unwrap_or(0));
            };
            if engine.control.flat.are_none() {
                return Ok(plan.triangles);
            }
            // Which regions cannot be triangulated from their rims nobody knows before.
            let emission = engine.emit_all(&mut plan)?;
            Ok(engine
                .assemble(emission, plan.levels(engine.watch)?)?
                .mesh
                .face_count())
        },
    )?;
    let may_be_fewer = fewest.is_none() && options.balance;
    if may_be_fewer && may_do_with_fewer(mesh, scheme, (&plain, &demands), found, observer)? {
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
    with_engine(
        mesh,
        scheme,
        (options, &Demands::default()),
        observer,
        |engine| {
            let mut is_divided = vec![false; mesh.face_count()];
            for h in 0..3 * faces as u32 {
                is_divided[h as usize / 3] = true;
                engine
                    .edges
                    .twin(h)
                    .into_iter()
                    .for_each(|twin| is_divided[twin as usize / 3] = true);
            }
            let goal = Goal::Partly(f64::INFINITY, engine.floor(Some(distance)), is_divided);
            let Some(plan) = engine.without_strips().plan(goal, usize::MAX)? else {
                return Ok(0);
            };
            let over = |face: u32| {
                let own = plan.closed[face as usize].triangles as usize;
                engine.control.flat.count_over(
                    (engine.control, &engine.edges),
                    &plan.chains,
                    face,
                    own,
                )
            };
            Ok((0..faces as u32).map(over).sum())
        },
    )
}

fn with_engine<T>(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    (options, demands): (&ExactOptions, &Demands),
    observer: &mut Observer<'_>,
    run: impl FnOnce(&Engine<'_>) -> Result<T, RefineError>,
) -> Result<T, RefineError> {
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
    let lasting = sharpness.lasting();
    let edges = Edges::of(mesh);
    let kept = KeptFaces::of(mesh, &options.kept_edges)?;
    let mut control = Control {
        mesh,
        sharpness: &sharpness,
        large: LargeRings::with_tags_polled(mesh, &sharpness, &rules, &mut |_| watch.poll())?,
        lasting: &lasting,
        positions,
        sided,
        rules: &rules,
        flat: FlatRegions::default(),
        criteria: None,
        back_faces: BackFaces::default(),
        kept: &kept,
        demands,
    };
    if options.flat_regions && (!options.balance || options.unfold) && options.attributes.is_empty()
    {
        control.flat = FlatRegions::of(&control, &edges, options, &watch)?;
    }
    let rounding = probe::rounding(mesh, options.max_levels, &watch)? + control.flat.allowance();
    control.criteria = criteria(mesh, options, rounding)?;
    control.back_faces = BackFaces::of(&control, options.balance, &watch)?;
    let engine = Engine {
        control: &control,
        edges,
        max_levels: options.max_levels as u32,
        watch: &watch,
        is_balanced: options.balance,
        has_origins: options.origins,
        counts_strips: CountsStrips::Always,
        guess: None,
        rounding,
    };
    watch.stage(Stage::Refining, None)?;
    run(&engine)
}

/// What the options ask for; `None` where that is nothing but distances and numbers of triangles.
fn criteria(
    mesh: &Mesh,
    options: &ExactOptions,
    rounding: f64,
) -> Result<Option<Criteria>, RefineError> {
    if options.angle.is_none() && options.pixels.is_none() {
        return Ok(None);
    }
    let distance = options
        .tolerance
        .map(|tolerance| Distance::new(tolerance, rounding));
    let cone = options.angle.map(|angle| LimitNormal {
        view: options.view,
        ..LimitNormal::new(angle)
    });
    let is_closed = mesh.topology().boundary_edge_count() == 0;
    let pixels = options
        .pixels
        .map(|limit| Pixels::new(limit, &options.cameras, is_closed))
        .transpose()?;
    Ok(Some(Criteria::new(distance, cone, pixels, rounding)?))
}

/// When triangles that strips leave are counted, which takes an emission.
#[derive(Clone, Copy, PartialEq, Eq)]
enum CountsStrips {
    Always,
    /// Where there are more than there may be without that.
    WhereTooMany,
    Never,
}

/// What stays the same all the way.
#[derive(Clone)]
pub(super) struct Engine<'a> {
    control: &'a Control<'a>,
    edges: Edges<'a>,
    max_levels: u32,
    watch: &'a SharedWatch<'a>,
    /// Vertices are moved off the surface.
    is_balanced: bool,
    /// Vertices tell where they came from.
    has_origins: bool,
    /// Whether plans tell how many triangles they come to once strips are put together.
    counts_strips: CountsStrips,
    /// A distance that is about right for the budget, as an earlier refinement tells.
    guess: Option<f64>,
    /// What rounding may do to a distance.
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

    /// The finest mesh within a value down to `floor` that has no more triangles than there may be.
    fn finest(
        &self,
        floor: f64,
        (most, cap): (usize, ExactStop),
        options: &ExactOptions,
    ) -> Result<Exact, RefineError> {
        let (mut room, mut reserve) = (most, most / RESERVE + 1);
        loop {
            let (plan, stop) = budget::search(self, floor, room, cap)?;
            let Some(outcome) = self.emit(plan, most, stop != ExactStop::Met)? else {
                // What failed among its neighbours took more triangles than there were left.
                room -= reserve.min(room);
                reserve *= 2;
                continue;
            };
            let is_best = stop == ExactStop::Met || floor > 0.0;
            let even = if is_best {
                None
            } else {
                self.even(outcome.plan.worst(), most)?
            };
            let Some(even) = even else {
                return outcome.finish(self, stop, options);
            };
            // Evenly curved models are best divided evenly, as long as drifts allow to prove about as much of that. Lower
            // bounds are found distances, within some per cent of the truth where all triangles are looked at.
            let worst_first = outcome.looked_at(self)?.finish(self, stop, options)?;
            let even = even.looked_at(self)?.finish(self, stop, options)?;
            let is_better = even.error.lower < worst_first.error.lower
                && even.error.upper <= PROVEN_ALIKE * worst_first.error.upper;
            return Ok(if is_better { even } else { worst_first });
        }
    }

    /// The same for plans of whose numbers of triangles nobody asks more than that they fit.
    fn without_counting_strips(&self) -> Self {
        Self {
            counts_strips: CountsStrips::WhereTooMany,
            ..self.clone()
        }
    }

    /// The same for plans whose strips are not put together.
    fn without_strips(&self) -> Self {
        Self {
            counts_strips: CountsStrips::Never,
            ..self.clone()
        }
    }

    /// Whether triangles are looked at among their neighbours once all are emitted, not before.
    fn is_settled_later(&self) -> bool {
        self.control.criteria.is_some() || self.is_balanced
    }

    /// Emits a plan, dividing what fails among its neighbours; `None` if there are too many triangles.
    fn emit(
        &self,
        plan: Plan,
        most: usize,
        is_budget: bool,
    ) -> Result<Option<Outcome>, RefineError> {
        if self.control.criteria.is_some() {
            let goal = plan.goal.clone();
            return self.emit_among(plan, &goal, (most, is_budget));
        }
        let mut plan = plan;
        let emission = self.emit_all(&mut plan)?;
        Ok(Some(Outcome {
            plan,
            emission,
            measured: None,
        }))
    }

    /// The even division that fits, if it may come within a distance, what is left spent on its worst faces.
    fn even(&self, distance: f64, most: usize) -> Result<Option<Outcome>, RefineError> {
        match budget::even(self, distance, most)? {
            Some(even) => self.emit(even, most, true),
            None => Ok(None),
        }
    }

    /// Emits so much of a plan, beside what was emitted before, of which is copied what is the same.
    fn emit_some(&self, plan: &Plan, scope: Scope<'_>) -> Result<Emission, RefineError> {
        let before = plan
            .emission
            .as_ref()
            .map(|emission| (Last::Kept(emission), &plan.is_touched[..]));
        self.emit_after(plan, scope, before)
    }

    /// The same in place of what was emitted before.
    fn emit_instead(&self, plan: &mut Plan, scope: Scope<'_>) -> Result<Emission, RefineError> {
        let before = plan
            .emission
            .take()
            .map(|emission| Last::Taken(Box::new(emission)));
        let before = before.map(|last| (last, &plan.is_touched[..]));
        self.emit_after(plan, scope, before)
    }

    fn emit_after(
        &self,
        plan: &Plan,
        scope: Scope<'_>,
        before: Option<(Last<'_>, &[bool])>,
    ) -> Result<Emission, RefineError> {
        let chains = (&plan.decision, &plan.chains);
        let has_origins = self.has_origins && !matches!(scope, Scope::Areas(_));
        let spare = if self.is_balanced {
            emit::SPARE_BALANCED
        } else {
            emit::SPARE
        };
        let extend = (scope, has_origins, spare);
        emit::emit(
            (self.control, self.watch),
            &self.edges,
            chains,
            &plan.closed,
            extend,
            before,
        )
    }

    /// Emits all of a plan.
    fn emit_all(&self, plan: &mut Plan) -> Result<Emission, RefineError> {
        self.watch.stage(Stage::Assembling, None)?;
        let mut emission = match plan
            .emission
            .take_if(|emission| emission.is_complete(&plan.is_touched))
        {
            Some(emission) => emission,
            None => self.emit_instead(plan, Scope::All)?,
        };
        plan.is_touched.fill(false);
        let junctions = sides::junctions(
            (self.control, self.watch),
            &self.edges,
            &plan.chains,
            &emission,
        )?;
        join_copies(&mut emission.positions, &junctions.vertices);
        emission.junctions = junctions;
        Ok(emission)
    }

    /// Triangles that a plan comes to at most: strips may be put together.
    fn triangles_at_most(&self, plan: &Plan) -> usize {
        let own = |face: u32| plan.closed[face as usize].triangles as usize;
        self.control
            .flat
            .count((self.control, &self.edges), &plan.chains, own)
    }

    /// Triangles that a plan comes to.
    fn triangles(&self, plan: &mut Plan) -> Result<usize, RefineError> {
        let (count, flat) = (self.triangles_at_most(plan), &self.control.flat);
        if !flat.has_strips() {
            return Ok(count);
        }
        let emission = match self.is_settled_later() {
            true => self.emit_some(plan, Scope::All)?,
            false => self.emit_instead(plan, Scope::All)?,
        };
        let sharp = settle::sharp_edges(&emission, self.watch)?;
        let Emission {
            positions,
            triangles,
            twins,
            parents,
            starts,
            ..
        } = &emission;
        let corners = self.control.mesh.vertex_count();
        let kept = self.control.kept;
        let net = Net {
            positions,
            triangles,
            twins,
            parents,
            starts,
            sharp: &sharp,
            kept,
            corners,
        };
        let saved = flat.saved(&net, self.watch)?;
        // Whoever emits it next need not write it again, but for those who look at what was changed since the last time.
        if !self.is_settled_later() {
            plan.emission = Some(emission);
            plan.is_touched.fill(false);
        }
        Ok(count - saved.min(count))
    }
}

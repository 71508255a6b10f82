//! What a few control faces come to, taken anew: against a mesh over these and what is around them that is nearer to the surface.
//!
//! What a triangle comes to by itself, or with its neighbours' help, can be far above its distance: where neighbours are turned much,
//! where nets at irregular vertices are long. Where that is so of few control faces, F, a mesh N is made whose triangles over F and around it
//! come within e of the surface, and distances between N and the triangles over F are searched for, as
//! [`crate::measure::certified_hausdorff`] does. By [`crate::certificate`]
//! * a point of the surface over F is within e of a triangle of N over F or of one beside such a triangle: these are measured to the mesh;
//! * a point of a triangle of N is within e of the surface where its neighbours are bounded, too: to such triangles alone are those of the
//!   mesh over F measured. So are those beside them, since what covers these may be a part of the surface over F.
//!
//! Everything else keeps its bounds. The farthest points that were found raise the lower bound, too.

use std::collections::HashMap;

use super::super::area::Areas;
use super::super::emit::{Emission, Scope};
use super::super::judge::Goal;
use super::super::measure::measure;
use super::super::{Engine, Plan};
use super::nearest_triangle::Nearest;
use crate::geometry::nearer;
use crate::measure::{Bvh, MeasureError, certified_from_known};
use crate::mesh::{NONE, Triangles};
use crate::progress::{Cancelled, Observer, SharedWatch};
use crate::refine::RefineError;
use crate::refine::exact_result::ErrorBounds;
use crate::vector::vector;

/// The part of the distance that the nearer mesh may be off by: with less it has more triangles, with more less is gained.
const SHARE: f64 = 0.1;

/// It is of no use where it is off by more than this part: no more than its points may be off as those of the surface ([`ErrorBounds::at`]).
const MOST_OFF: f64 = 0.125;

/// What is found is known to this part of the distance: the search takes little of the time.
const GAP: f64 = 0.04;

/// Bounds so many times what was found are those of needles: to prove less of them takes triangles as short as they are wide.
const NEEDLES: f64 = 32.0;

/// Triangles over F at most: so many in any case, and one for so many of the mesh, but no more than that. Others would take longer than
/// all that was done before.
const IN_ANY_CASE: usize = 200;
const FOR_SO_MANY: usize = 16;
const MOST: usize = 2_000;

/// Triangles of the nearer mesh at most: so many in any case, and for each of the other one over the same control faces.
const NEARER_IN_ANY_CASE: usize = 10_000;
const NEARER_FOR_EACH: usize = 100;

/// What these control faces come to, and a lower bound that is no less than there was; `None` where that would take too long, or
/// where more counts than the distances of triangles. `known` bounds the distance of the whole mesh, `lower` is what counts as found.
pub(super) fn anew(
    engine: &Engine<'_>,
    (plan, emission, mesh): (&Plan, &Emission, &Nearest<'_>),
    faces: &[u32],
    (known, lower): (&ErrorBounds, f64),
) -> Result<Option<ErrorBounds>, RefineError> {
    let (control, watch) = (engine.control, engine.watch);
    let count: usize = faces
        .iter()
        .map(|&face| emission.triangles_of(face).len())
        .sum();
    let most = (IN_ANY_CASE + emission.triangles.len() / FOR_SO_MANY).min(MOST);
    let is_worth_while =
        count <= most && control.criteria.is_none() && known.upper <= NEEDLES * lower;
    let first = faces.first().filter(|_| is_worth_while);
    let Some(&first) = first else { return Ok(None) };
    // Of what gives way to triangulations of rims nothing but these is known. All around that is sharp, so nobody counts on it.
    let is_within_rim = |face: &u32| control.flat.is_within_rim(*face);
    if faces.iter().any(is_within_rim) {
        return Ok(None);
    }
    let mut is_around = around(engine, faces);
    (0..)
        .zip(&mut is_around)
        .for_each(|(face, is_around)| *is_around = *is_around && !is_within_rim(&face));
    let is_wanted = |face: &u32| is_around[*face as usize];
    let wanted: Vec<u32> = (0..is_around.len() as u32).filter(is_wanted).collect();
    let Some(close) = NearerMesh::of(engine, plan, (&wanted, &is_around), emission, SHARE * lower)?
    else {
        return Ok(None);
    };
    let off = close.off;
    if off > MOST_OFF * lower {
        return Ok(None);
    }
    let mut observer = watch.observer();
    let mut distance = |from: Vec<usize>, of: &Emission, to: Vec<usize>, other: &Emission| {
        let parts = [Part::of(of, &from), Part::of(other, &to)];
        let trees = [parts[0].tree(&mut observer)?, parts[1].tree(&mut observer)?];
        certified_from_known(
            [&trees[0], &trees[1]],
            lower - off,
            GAP * lower,
            &mut observer,
        )
    };
    let nearer = &close.emission;
    let is_known = |face: &u32| is_wanted(face) || is_within_rim(face);
    let is_bounded =
        |triangle: &usize| beside(nearer, *triangle).all(|other| is_known(&nearer.parents[other]));
    let bounded = over(nearer, &wanted).filter(is_bounded).collect();
    let measured = |emission: &Emission| {
        let found = with_beside(emission, faces).into_iter();
        found
            .filter(|&triangle| !is_within_rim(&emission.parents[triangle]))
            .collect()
    };
    let forward = distance(measured(emission), emission, bounded, nearer)?;
    let over_wanted = over(emission, &wanted).collect();
    let backward = distance(measured(nearer), nearer, over_wanted, emission)?;
    let mut found = ErrorBounds {
        upper: (forward.upper.max(backward.upper) + off).next_up(),
        ..*known
    };
    // The point is that far from the surface, at most.
    let point = vector(backward.at);
    let distance = engine.watch.long_pieces(1, 1, |_, is_stopped| {
        mesh.distance(point, first, is_stopped)
    })?;
    let from_surface = distance.into_iter().fold(0.0, f64::max) - off;
    if from_surface > found.lower {
        (found.lower, found.at) = (from_surface, backward.at);
    }
    if forward.lower - off > found.lower && !control.flat.has_rims_alone() {
        let from_mesh = to_surface(
            forward.at,
            (&close, emission),
            (&is_around, known.upper),
            watch,
        )?;
        if from_mesh > found.lower {
            (found.lower, found.at) = (from_mesh, forward.at);
        }
    }
    Ok(Some(found))
}

/// How far a point is from the surface at least: the one over what is around is near to the nearer mesh, all other surface to the
/// other one, of whose triangles it may be near to those beside its own, too.
fn to_surface(
    point: [f64; 3],
    (close, emission): (&NearerMesh, &Emission),
    (is_around, upper): (&[bool], f64),
    watch: &SharedWatch<'_>,
) -> Result<f64, Cancelled> {
    let is_outer = |triangle: usize| !is_around[emission.parents[triangle] as usize];
    let others = (0..emission.triangles.len())
        .filter(|&triangle| is_outer(triangle) || beside(emission, triangle).any(is_outer));
    let all = 0..close.emission.triangles.len();
    let to_nearer = least_distance(point, &close.emission, all, watch)? - close.off;
    Ok(to_nearer.min(least_distance(point, emission, others, watch)? - upper))
}

/// A mesh that is near to the surface over some control faces.
struct NearerMesh {
    /// What is there over these, and over those beside them.
    emission: Emission,
    /// As far as its triangles over these are off at most.
    off: f64,
}

impl NearerMesh {
    /// Divides what is wanted until it is that near; `None` where that takes too many triangles.
    fn of(
        engine: &Engine<'_>,
        plan: &Plan,
        (wanted, is_wanted): (&[u32], &[bool]),
        emission: &Emission,
        near: f64,
    ) -> Result<Option<Self>, RefineError> {
        let (engine, watch) = (&engine.without_strips(), engine.watch);
        let count: usize = wanted
            .iter()
            .map(|&face| emission.triangles_of(face).len())
            .sum();
        let most = engine.triangles_at_most(plan) + NEARER_IN_ANY_CASE + NEARER_FOR_EACH * count;
        let goal = Goal::Partly(f64::INFINITY, near, is_wanted.to_vec());
        let Some(mut finer) = engine.finer(plan, goal, wanted, most)? else {
            return Ok(None);
        };
        // Nobody asks what others come to.
        let others = (0..).zip(is_wanted).filter(|(_, is_wanted)| !**is_wanted);
        watch.each(others, |(face, _)| finer.settled.settle(face))?;
        if !engine.settle(&mut finer, most)? {
            return Ok(None);
        }
        let mut areas = Areas::default();
        for &face in wanted {
            let beyond = (3 * face..3 * face + 3)
                .filter_map(|h| engine.edges.twin(h))
                .map(|twin| twin / 3);
            for face in beyond.chain([face]) {
                areas.0.entry(face).or_default();
            }
        }
        let emission = engine.emit_some(&finer, Scope::Faces(&areas))?;
        let sources = engine.sources(&finer, &emission);
        let nothing = Goal::Within(f64::INFINITY);
        let measured = measure(&sources, watch, (&nothing, near), (wanted, None, None))?;
        let off = measured.iter().map(|face| face.worst.0).fold(0.0, f64::max);
        Ok(Some(Self { emission, off }))
    }
}

/// Which control faces share a corner with one of some.
fn around(engine: &Engine<'_>, faces: &[u32]) -> Vec<bool> {
    let mesh = engine.control.mesh;
    let mut is_corner = vec![false; mesh.vertex_count()];
    let corners = faces
        .iter()
        .flat_map(|&face| mesh.triangles()[face as usize]);
    corners.for_each(|corner| is_corner[corner as usize] = true);
    mesh.triangles()
        .iter()
        .map(|face| face.iter().any(|&corner| is_corner[corner as usize]))
        .collect()
}

/// The triangles over control faces.
fn over<'a>(emission: &'a Emission, faces: &'a [u32]) -> impl Iterator<Item = usize> + 'a {
    faces.iter().flat_map(|&face| emission.triangles_of(face))
}

/// The triangles beyond a triangle's edges.
fn beside(emission: &Emission, triangle: usize) -> impl Iterator<Item = usize> + '_ {
    let twins = emission.twins[3 * triangle..3 * triangle + 3]
        .iter()
        .filter(|&&twin| twin != NONE);
    twins.map(|&twin| twin as usize / 3)
}

/// The triangles over control faces, and those beside them.
fn with_beside(emission: &Emission, faces: &[u32]) -> Vec<usize> {
    let mut found: Vec<usize> = over(emission, faces).collect();
    found.extend(over(emission, faces).flat_map(|triangle| beside(emission, triangle)));
    found.sort_unstable();
    found.dedup();
    found
}

/// The least distance of a point to some triangles.
fn least_distance(
    point: [f64; 3],
    emission: &Emission,
    triangles: impl Iterator<Item = usize>,
    watch: &SharedWatch<'_>,
) -> Result<f64, Cancelled> {
    let (point, mut least) = (vector(point), f64::INFINITY);
    watch.each(triangles, |triangle| {
        let corners = emission.triangles[triangle];
        least = nearer(
            least,
            corners.map(|vertex| vector(emission.positions[vertex as usize]) - point),
        );
    })?;
    Ok(least.sqrt())
}

/// Some triangles of a mesh, with the vertices that they have.
struct Part {
    positions: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Part {
    fn of(emission: &Emission, triangles: &[usize]) -> Self {
        let (mut numbers, mut positions) = (HashMap::new(), Vec::new());
        let mut number = |vertex: u32| {
            *numbers.entry(vertex).or_insert_with(|| {
                positions.push(emission.positions[vertex as usize]);
                positions.len() as u32 - 1
            })
        };
        let triangles = triangles
            .iter()
            .map(|&triangle| emission.triangles[triangle].map(&mut number));
        let triangles = triangles.collect();
        Self {
            positions,
            triangles,
        }
    }

    fn tree(&self, observer: &mut Observer<'_>) -> Result<Bvh<'_>, MeasureError> {
        Bvh::new_observed(
            Triangles {
                positions: &self.positions,
                triangles: &self.triangles,
            },
            observer,
        )
    }
}

#[cfg(test)]
mod tests;

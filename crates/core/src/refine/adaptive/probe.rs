//! The certified interval for the whole mesh.
//!
//! Above stand the bounds of what was let pass. Below stand distances that were found: from points of the surface over the
//! worst leaves to the nearest triangle of the mesh, which is looked for in all control faces whose points come near.

use super::emit::Emission;
use super::quadtree::Place;
use super::surface::{Surface, child_corners, with_patch};
use super::{Engine, Plan};
use crate::certificate::TriangleFrame;
use crate::geometry::closest_to_origin;
use crate::index::VertexId;
use crate::mesh::Mesh;
use crate::patch::LimitPoint;
use crate::refine::exact::ErrorBounds;
use crate::vector::{DVec3, vector};

/// Leaves with the greatest bounds that are looked at for a lower bound.
const PROBED: usize = 64;

/// Levels below a leaf whose vertices are sampled: the greatest distance is met within some per cent.
const SAMPLED_LEVELS: usize = 3;

/// Levels below which edges have no length left.
const MOST_LEVELS: usize = 64;

/// Control faces whose samples are measured where nothing is certain.
const MOST_MEASURED: usize = 2_000;

/// Levels that are sampled there.
const MOST_SAMPLED_LEVELS: usize = 6;

/// A lower bound beyond this part of the upper one is good enough.
const NARROW: f64 = 0.99;

/// The certified interval.
pub(super) fn probe(engine: &Engine<'_>, plan: &Plan, emission: &Emission, rounding: f64) -> ErrorBounds {
    let mut worst: Vec<(f64, Place)> = plan.worst_leaves().collect();
    worst.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then((a.1.face, a.1.path).cmp(&(b.1.face, b.1.path))));
    let upper = worst.first().map_or(0.0, |&(bound, _)| bound);
    let mut best =
        ErrorBounds { lower: 0.0, upper, at: [0.0; 3], certified: engine.control.rules.is_certified() };
    let mesh = Nearest::of(engine, emission);
    for &(bound, place) in worst.iter().take(PROBED) {
        if bound <= best.lower || best.lower > NARROW * upper {
            break;
        }
        let Some(point) = highest(engine, place) else { continue };
        let distance = mesh.distance(point, place.face);
        if distance > best.lower {
            (best.lower, best.at) = (distance, point.to_array());
        }
    }
    if !best.certified {
        best.upper = estimated(engine, plan, &mesh, &mut best);
    }
    best.upper = best.upper.max(best.lower) + rounding;
    best.lower = (best.lower - rounding).max(0.0);
    best
}

/// Where nothing is certain: the greatest distance of samples over the faces that may be worse than what was found; after
/// many of them the next estimate.
fn estimated(engine: &Engine<'_>, plan: &Plan, mesh: &Nearest<'_>, best: &mut ErrorBounds) -> f64 {
    let control = engine.control;
    let mut bounds = vec![0.0f64; plan.closed.len()];
    for (bound, place) in plan.worst_leaves() {
        bounds[place.face as usize] = bounds[place.face as usize].max(bound);
    }
    let mut order: Vec<(f64, u32)> = bounds.into_iter().zip(0..).collect();
    order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    for (count, &(bound, face)) in order.iter().enumerate() {
        if bound <= best.lower || count >= MOST_MEASURED {
            return bound.max(best.lower);
        }
        let trees = &plan.decision.trees;
        let levels = trees.depth(trees.root(face)) as usize + SAMPLED_LEVELS;
        let mut points = Vec::new();
        with_patch(&control.patch(face), control.corners(face), 0, &mut |surface| {
            sample(engine, surface, levels.min(MOST_SAMPLED_LEVELS), &mut points);
        });
        for point in points {
            let distance = mesh.distance(point, face);
            if distance > best.lower {
                (best.lower, best.at) = (distance, point.to_array());
            }
        }
    }
    best.lower
}

impl Plan {
    /// The worst leaves of the control faces, with their bounds.
    pub(super) fn worst_leaves(&self) -> impl Iterator<Item = (f64, Place)> + '_ {
        let closed = self.closed.iter().filter_map(|face| face.extent.as_ref());
        self.decision
            .extents()
            .chain(closed)
            .filter_map(|extent| Some((extent.bound, extent.worst?)))
            .chain(self.settled.iter().flatten().copied())
    }
}

/// The point of the surface over a node that stands highest over its triangle.
fn highest(engine: &Engine<'_>, place: Place) -> Option<DVec3> {
    let control = engine.control;
    let mut found: Option<(f64, DVec3)> = None;
    with_patch(&control.patch(place.face), control.corners(place.face), 0, &mut |surface| {
        descend(engine, surface, control.corners(place.face), place, 0, &mut |surface, corners| {
            let frame = TriangleFrame::new(corners.map(|corner| corner.position));
            let mut points = Vec::new();
            sample(engine, surface, SAMPLED_LEVELS, &mut points);
            for point in points {
                let height = frame.height(point).abs();
                if found.is_none_or(|(known, _)| height > known) {
                    found = Some((height, point));
                }
            }
        });
    });
    found.map(|(_, point)| point)
}

/// Goes down to a place.
fn descend(
    engine: &Engine<'_>,
    surface: &Surface<'_>,
    corners: [LimitPoint; 3],
    place: Place,
    level: u32,
    take: &mut dyn FnMut(&Surface<'_>, [LimitPoint; 3]),
) {
    if level == place.level {
        return take(surface, corners);
    }
    let child = place.digit(level);
    let middles = surface.middles(engine.control.rules);
    let own = child_corners(corners, middles, child);
    surface.with_parts(engine.control.rules, |part| {
        part(child, &mut |surface| descend(engine, surface, own, place, level + 1, take));
    });
}

/// Points of a surface.
fn sample(engine: &Engine<'_>, surface: &Surface<'_>, levels: usize, points: &mut Vec<DVec3>) {
    points.extend(surface.middles(engine.control.rules).map(|middle| middle.position));
    if levels > 1 {
        surface.with_parts(engine.control.rules, |part| {
            (0..4).for_each(|child| part(child, &mut |surface| sample(engine, surface, levels - 1, points)));
        });
    }
}

/// The nearest points of the emitted triangles.
struct Nearest<'a> {
    emission: &'a Emission,
    /// Boxes that hold the surface over each control face, and so the corners of its triangles.
    boxes: Vec<(DVec3, DVec3)>,
    /// By control face, its first triangle.
    starts: Vec<u32>,
}

impl<'a> Nearest<'a> {
    fn of(engine: &Engine<'_>, emission: &'a Emission) -> Self {
        let mesh = engine.control.mesh;
        let mut starts = vec![0u32; mesh.face_count() + 1];
        emission.parents.iter().for_each(|&face| starts[face as usize + 1] += 1);
        (0..mesh.face_count()).for_each(|face| starts[face + 1] += starts[face]);
        let boxes = (0..mesh.face_count()).map(|face| {
            let own = &emission.triangles[starts[face] as usize..starts[face + 1] as usize];
            let corners =
                own.as_flattened().iter().map(|&vertex| vector(emission.positions[vertex as usize]));
            corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
        });
        Self { emission, boxes: boxes.collect(), starts }
    }

    /// The distance of a point to the mesh; `face` is likely to be nearest.
    fn distance(&self, point: DVec3, face: u32) -> f64 {
        let mut least = f64::INFINITY;
        self.within(face, point, &mut least);
        for (other, &(low, high)) in (0..).zip(&self.boxes) {
            let gap = (low - point).max(point - high).max(DVec3::ZERO).length_squared();
            if gap < least && other != face {
                self.within(other, point, &mut least);
            }
        }
        least.sqrt()
    }

    fn within(&self, face: u32, point: DVec3, least: &mut f64) {
        let own = self.starts[face as usize] as usize..self.starts[face as usize + 1] as usize;
        for triangle in &self.emission.triangles[own] {
            let [a, b, c] = triangle.map(|vertex| vector(self.emission.positions[vertex as usize]) - point);
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            if low.max(-high).max(DVec3::ZERO).length_squared() < *least {
                *least = least.min(closest_to_origin(a, b, c).squared);
            }
        }
    }
}

/// What rounding can have done to a distance: positions are convex combinations of convex combinations, one for
/// each level, and each adds a few units in the last place of the coordinates' size; those of a control vertex add one for
/// each neighbour. Points near an edge of a triangle count as on it ([`TriangleFrame::on_edge`]), on either side.
pub(super) fn rounding(control: &Mesh, max_levels: usize) -> f64 {
    let size = control.positions().as_flattened().iter().fold(0.0f64, |size, x| size.max(x.abs()));
    let topology = control.topology();
    let valence = |v: u32| topology.valence_and_openness(VertexId(v)).0;
    let most = (0..control.vertex_count() as u32).map(valence).max().unwrap_or(0);
    let units = 32.0 + 8.0 * max_levels.min(MOST_LEVELS) as f64 + f64::from(most);
    (units * f64::EPSILON + 4.0 * TriangleFrame::ROUNDING) * size
}

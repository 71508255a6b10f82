//! The points of the surface that are likely to be farthest from the mesh: what lower bounds are found with.
//!
//! What was said of leaves is of no use here: neighbours may have had them split since, so that vertices of the mesh lie where the
//! surface stood highest over them.

use super::super::close::lies_along;
use super::super::decide::child_open;
use super::super::emit::Emission;
use super::super::emitted::{Beholder, Emitted, Over};
use super::super::quadtree::Place;
use super::super::surface::Surface;
use super::super::{Engine, Plan};
use crate::certificate::TriangleFrame;
use crate::geometry::closest_to_origin;
use crate::patch::Rules;
use crate::patch::child_corners;
use crate::progress::Cancelled;
use crate::vector::{DVec3, vector};

/// Levels below a leaf whose vertices are sampled: the greatest distance is met within some per cent.
pub(super) const SAMPLED_LEVELS: usize = 3;

/// The point of the surface over a leaf that is farthest from its triangles; over the one that bends most of a control face's where
/// none is given. Where vertices were moved, those that stand highest and lowest, and the corners.
pub(super) fn farthest(
    engine: &Engine<'_>,
    plan: &Plan,
    emission: &Emission,
    face: u32,
    leaf: Option<Place>,
) -> Result<Vec<DVec3>, Cancelled> {
    let is_moved = !emission.offsets.is_empty();
    let (place, triangles) = match leaf {
        Some(place) if is_moved => (place, Vec::new()),
        _ => {
            let sources = engine.sources(plan, emission);
            let found = engine.watch.long_pieces(1, 1, |_, is_stopped| {
                let mut found =
                    Finder { emission, leaf, bend: -1.0, place: Place::root(face), triangles: Vec::new() };
                sources.show(face, is_stopped, &mut found);
                (found.place, found.triangles)
            })?;
            found.into_iter().next().unwrap_or((Place::root(face), Vec::new()))
        }
    };
    let control = engine.control;
    let piece = control.piece(face);
    let (mut surface, mut corners) = (piece.surface(control.rules), control.corners(face));
    for level in 0..place.level {
        let child = place.digit(level);
        corners = child_corners(corners, surface.middles(), child);
        surface = surface.child(child);
    }
    let mut points = Vec::new();
    if control.flat.is_its_rim(face) {
        let open = control.open(face);
        let open = [0, 1, 2].map(|edge| open[edge] && lies_along(place, edge));
        sample_rim(surface, open, SAMPLED_LEVELS, &mut points);
    } else {
        sample(surface, SAMPLED_LEVELS, &mut points);
    }
    if is_moved {
        let frame = TriangleFrame::new(corners.map(|corner| corner.position));
        let by_height = |a: &&DVec3, b: &&DVec3| frame.height(**a).total_cmp(&frame.height(**b));
        let ends = [points.iter().max_by(by_height), points.iter().min_by(by_height)];
        let corners = corners.map(|corner| corner.position);
        return Ok(ends.into_iter().flatten().copied().chain(corners).collect());
    }
    let squared = |point: DVec3| {
        let to = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|vertex| vector(emission.positions[vertex as usize]) - point);
            closest_to_origin(a, b, c).squared
        };
        triangles.iter().map(to).fold(f64::INFINITY, f64::min)
    };
    let farthest = points.into_iter().map(|point| (squared(point), point)).max_by(|a, b| a.0.total_cmp(&b.0));
    Ok(farthest.map(|(_, point)| point).into_iter().collect())
}

/// Points of a surface.
pub(super) fn sample(surface: Surface<'_>, levels: usize, points: &mut Vec<DVec3>) {
    points.extend(surface.middles().map(|middle| middle.position));
    if levels > 1 {
        (0..4).for_each(|child| sample(surface.child(child), levels - 1, points));
    }
}

/// Points of a surface's curves over its open edges.
fn sample_rim(surface: Surface<'_>, open: [bool; 3], levels: usize, points: &mut Vec<DVec3>) {
    if levels == 0 || open == [false; 3] {
        return;
    }
    let middles = surface.middles();
    points.extend((0..3).filter(|&edge| open[edge]).map(|edge| middles[edge].position));
    (0..4).for_each(|child| sample_rim(surface.child(child), child_open(open, child), levels - 1, points));
}

/// Finds the triangles of a leaf, or of the one with the triangle over which the surface bends most.
struct Finder<'a> {
    emission: &'a Emission,
    leaf: Option<Place>,
    /// About the surface's greatest height over a triangle.
    bend: f64,
    place: Place,
    triangles: Vec<[u32; 3]>,
}

impl Beholder for Finder<'_> {
    fn triangle<'p>(&mut self, emitted: &Emitted, _: Over<'_, 'p>, _: &'p Rules<'p>) {
        let is_wanted = match self.leaf {
            Some(leaf) => emitted.place == leaf,
            None => self.bends_more(emitted) || emitted.place == self.place && !self.triangles.is_empty(),
        };
        if is_wanted {
            if emitted.place != self.place {
                (self.place, self.triangles) = (emitted.place, Vec::new());
            }
            self.triangles.push(emitted.vertices);
        }
    }
}

impl Finder<'_> {
    /// Whether the surface bends more over a triangle than over those before, as far as the normals at its corners tell.
    fn bends_more(&mut self, emitted: &Emitted) -> bool {
        let at = |list: &[[f64; 3]], corner: usize| vector(list[emitted.vertices[corner % 3] as usize]);
        let Emission { positions, normals, .. } = self.emission;
        let bend = |edge: usize| {
            let along = at(positions, edge + 1) - at(positions, edge);
            (at(normals, edge + 1) - at(normals, edge)).dot(along).abs()
        };
        let bend = 0.125 * bend(0).max(bend(1)).max(bend(2));
        let is_more = bend > self.bend;
        if is_more {
            self.bend = bend;
        }
        is_more
    }
}

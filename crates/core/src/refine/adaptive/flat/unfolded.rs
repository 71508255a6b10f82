//! Whether the surface over a flat region lies within what its rim encloses.
//!
//! Where a map into a plane turns no part over, each point is covered as often as the rim winds round it: what the rim does not
//! enclose is not covered. A regular piece turns nothing over where the Bézier coefficients of its normals' parts across the plane are not
//! below zero ([`crate::patch::normal_net`]). Pieces at irregular vertices are refined until no more is left than adds nothing to
//! a distance: all points of that are as near to the vertex, which the region has in any case.

use super::super::control::Control;
use super::regions::Plane;
use crate::patch::Patch;
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::normal_net::{cross_products, tangents};
use crate::vector::DVec3;

/// Faces that may take some tenths of a millisecond each.
pub(super) const MOST_UNFOLDED: usize = 4096;

/// Heights over a plane are known to this part of the greatest coordinate.
pub(super) const HEIGHT_ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Halvings of a regular piece whose coefficients are not all above zero.
const HALVINGS: usize = 4;

/// Coefficients may be as far below zero as this part of the greatest: rounding does that.
const ROUNDING: f64 = 1e-12;

/// Whether the surface over a face is turned over nowhere, but for pieces smaller than `least`.
pub(super) fn is_unfolded(control: &Control<'_>, face: u32, plane: &Plane, least: f64) -> bool {
    // Pieces at irregular vertices are refined 40 times at most.
    is_piece_unfolded(control, &control.patch(face), plane, least, 40)
}

fn is_piece_unfolded(
    control: &Control<'_>,
    patch: &Patch,
    plane: &Plane,
    least: f64,
    levels: usize,
) -> bool {
    if let Patch::Regular(points) = patch {
        return is_net_unfolded(&BezierTriangle::of(points), plane, HALVINGS);
    }
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    patch.for_each_hull_point(|point| (low, high) = (low.min(point), high.max(point)));
    if (high - low).length() <= least {
        return true;
    }
    if levels == 0 {
        return false;
    }
    let refined = patch.refined(control.rules);
    (0..4).all(|child| is_piece_unfolded(control, &refined.part(child), plane, least, levels - 1))
}

fn is_net_unfolded(net: &BezierTriangle, plane: &Plane, halvings: usize) -> bool {
    let across = cross_products(&tangents(net)).map(|normal| normal.dot(plane.normal));
    let greatest = across
        .iter()
        .fold(0.0f64, |greatest, part| greatest.max(part.abs()));
    let has_area = greatest > 0.0 && greatest.is_finite();
    if has_area && across.iter().all(|&part| part >= -ROUNDING * greatest) {
        return true;
    }
    // The corners' coefficients are normals of the surface itself.
    if !has_area || halvings == 0 {
        return false;
    }
    let [a, b, c] = net.corners();
    let lengths = [
        a.distance_squared(b),
        b.distance_squared(c),
        c.distance_squared(a),
    ];
    let longest = (1..3).fold(0, |longest, edge| {
        if lengths[edge] > lengths[longest] {
            edge
        } else {
            longest
        }
    });
    net.halves(longest)
        .iter()
        .all(|half| is_net_unfolded(half, plane, halvings - 1))
}

/// How far the surface over a face is off a plane at most; `None` where that is more than `most`.
pub(super) fn height_over(
    control: &Control<'_>,
    face: u32,
    plane: &Plane,
    most: f64,
) -> Option<f64> {
    // The vertices around a face, which are among its control points, decide nearly all faces.
    let open = control.open(face);
    let is_off = |h: u32| {
        let twin = control.edges.twin(h).filter(|_| !open[h as usize % 3]);
        twin.is_some_and(|twin| plane.height(control.opposite(twin)).abs() > most)
    };
    if (3 * face..3 * face + 3).any(is_off) {
        return None;
    }
    let mut height = 0.0f64;
    control
        .patch(face)
        .for_each_hull_point(|point| height = height.max(plane.height(point).abs()));
    (height <= most).then_some(height)
}

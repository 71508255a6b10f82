//! The angles between a triangle and its neighbours, and the limits of tangential displacements by
//! them: the arguments of [`super::Deviation::bound`] once the triangles are known.

use crate::vector::DVec3;

/// A slope beyond all that can be met.
pub(crate) const STEEP: f64 = f64::MAX;

/// The chords and the slopes next to a triangle without a plane: they leave only the bound that needs no
/// neighbours.
const UNSETTLED: ([f64; 3], [f64; 3]) = ([2.0; 3], [0.0; 3]);

/// The chords of the angles between the planes of a triangle and its neighbours, given by their corners opposite, and the
/// greatest slopes at which points may move tangentially over them, by edge. No neighbour turns by nothing.
pub(crate) fn around(own: [DVec3; 3], opposite: &[Option<DVec3>; 3]) -> ([f64; 3], [f64; 3]) {
    let edges = [own[1] - own[0], own[2] - own[1], own[0] - own[2]];
    let Some((normal, area)) = plane(edges[0], edges[1]) else {
        return UNSETTLED;
    };
    let lengths = edges.map(DVec3::length);
    // Half of the complement to π of a corner's angle, at most π/2: its tangent is the cotangent of
    // half the angle.
    let free = [0, 1, 2].map(|corner| {
        let before = (corner + 2) % 3;
        (lengths[corner] * lengths[before] - edges[corner].dot(edges[before])) / area
    });
    let (mut chords, mut slopes) = ([0.0; 3], [STEEP; 3]);
    for edge in 0..3 {
        let Some(opposite) = opposite[edge] else {
            continue;
        };
        let out = opposite - own[edge];
        // The neighbour runs along the edge the other way.
        let Some((other, area)) = plane(out, edges[edge]) else {
            return UNSETTLED;
        };
        chords[edge] = normal.distance(other);
        // Tangents of the neighbour's angles at both ends: the lesser is that of the greater product.
        let at_start = out.dot(edges[edge]);
        let product = at_start.max(lengths[edge] * lengths[edge] - at_start);
        slopes[edge] = free[edge].min(free[(edge + 1) % 3]).min(area / product);
    }
    (chords, slopes)
}

/// The unit vector at right angles to two edges, and the area of their parallelogram; `None` if that is nothing, or
/// so small or great that rounding decides it.
fn plane(a: DVec3, b: DVec3) -> Option<(DVec3, f64)> {
    let across = a.cross(b);
    let squared = across.length_squared();
    let area = squared.sqrt();
    (1e-290..1e290)
        .contains(&squared)
        .then(|| (across / area, area))
}

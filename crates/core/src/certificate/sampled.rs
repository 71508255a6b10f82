//! Points of a piece of any limit surface, and a triangle's distance from them: an estimate where
//! there is no proof.
//!
//! The piece is refined a few times, and the limits of its vertices are taken. They are on a
//! lattice of barycentric coordinates, so that those over each part of the piece are known exactly.

use super::deviation::Deviation;
use super::hull_points::DeviationBound;
use super::sub_triangle::SubTriangle;
use crate::patch::Rules;
use crate::patch::mesh_form::{GridPoint, SAMPLED_LEVELS};
use crate::patch::mesh_patch::MeshPatch;
use crate::vector::DVec3;

/// The sum of the coordinates of each place.
const UNIT: i32 = 1 << SAMPLED_LEVELS;

/// Limit points of a piece.
pub(crate) struct Samples(Vec<(GridPoint, DVec3)>);

fn middle(a: GridPoint, b: GridPoint) -> GridPoint {
    [0, 1, 2].map(|i| (a[i] + b[i]) / 2)
}

impl Samples {
    pub(crate) fn of(piece: &MeshPatch, rules: &Rules<'_>) -> Self {
        Self(piece.samples(rules))
    }

    /// The deviation, by the points over a part, of the triangle that approximates it.
    pub(crate) fn deviation(&self, part: SubTriangle, bound: &DeviationBound<'_>) -> Deviation {
        let corners = places_of(part, UNIT);
        let mut deviation = Deviation::default();
        for &(place, point) in &self.0 {
            let within =
                [0, 1, 2].map(|i| determinant([place, corners[(i + 1) % 3], corners[(i + 2) % 3]]));
            if within.iter().any(|&x| x < 0) {
                continue;
            }
            match within.map(|x| x == 0) {
                [false, false, false] => bound.inner_point(point, &mut deviation),
                [false, false, true] => bound.curve_point(0, point, &mut deviation),
                [true, false, false] => bound.curve_point(1, point, &mut deviation),
                [false, true, false] => bound.curve_point(2, point, &mut deviation),
                // A corner.
                _ => {}
            }
        }
        deviation
    }
}

/// The places of the corners of a part.
fn places_of(part: SubTriangle, unit: i32) -> [GridPoint; 3] {
    let whole = [[unit, 0, 0], [0, unit, 0], [0, 0, unit]];
    let on = |edge: usize| middle(whole[edge % 3], whole[(edge + 1) % 3]);
    let mut corners = whole;
    match part {
        SubTriangle::Whole => {}
        SubTriangle::Half { edge, second } => corners[(edge + usize::from(!second)) % 3] = on(edge),
        SubTriangle::Child(3) => corners = [on(1), on(2), on(0)],
        SubTriangle::Child(child) => {
            corners[(child + 1) % 3] = on(child);
            corners[(child + 2) % 3] = on(child + 2);
        }
        SubTriangle::Quarter { edge, at_end } => {
            let from = if at_end { edge + 1 } else { edge };
            corners = [whole[from % 3], on(edge + 1), on(edge + 2)];
        }
    }
    corners
}

fn determinant([a, b, c]: [GridPoint; 3]) -> i64 {
    let [a, b, c] = [a, b, c].map(|place| place.map(i64::from));
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Parts are turned like the whole, and their areas add up as they should.
    #[test]
    fn parts_have_their_share_of_the_area() {
        let whole = determinant(places_of(SubTriangle::Whole, 8));
        let mut shares = Vec::new();
        for i in 0..3 {
            for flag in [false, true] {
                shares.push((
                    SubTriangle::Half {
                        edge: i,
                        second: flag,
                    },
                    2,
                ));
                shares.push((
                    SubTriangle::Quarter {
                        edge: i,
                        at_end: flag,
                    },
                    4,
                ));
            }
            shares.push((SubTriangle::Child(i), 4));
        }
        shares.push((SubTriangle::Child(3), 4));
        for (part, share) in shares {
            assert_eq!(share * determinant(places_of(part, 8)), whole, "{part:?}");
        }
    }
}

//! Places over a face, handed down to its parts as these are refined, and their values.

use core::array::from_fn;
use core::ops::Range;

use super::{SurfacePoint, regular};
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::bicubic::Bicubic;
use crate::patch::quartic::{coefficients, values_at};
use crate::patch::{self, Limit, LimitPoint};
use crate::vector::{self, DVec3};

/// Places that are evaluated together.
const LANES: usize = 8;

/// The last few are evaluated in smaller groups.
const HALF: usize = LANES / 2;

/// A place in a part, by its weights of the second and third corner, and the number of its point.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Place {
    at: u32,
    u: f64,
    v: f64,
}

/// The number of parts of a face.
const PARTS: usize = 4;

impl Place {
    /// Barycentric coordinates are cut off so that they are in order.
    pub(crate) fn of(at: usize, [_, u, v]: [f64; 3]) -> Self {
        let [u, v] = [u, v].map(|weight| if weight > 0.0 { weight.min(1.0) } else { 0.0 });
        Self {
            at: at as u32,
            u,
            v: v.min(1.0 - u),
        }
    }

    fn first_weight(self) -> f64 {
        1.0 - self.u - self.v
    }

    /// The corner that it is at.
    fn corner(self) -> Option<usize> {
        match self {
            Self { u: 1.0, .. } => Some(1),
            Self { v: 1.0, .. } => Some(2),
            _ => (self.first_weight() == 1.0).then_some(0),
        }
    }

    /// The corner that is nearest.
    fn nearest(self) -> usize {
        let weights = [self.first_weight(), self.u, self.v];
        (0..3)
            .max_by(|&a, &b| weights[a].total_cmp(&weights[b]))
            .unwrap_or(0)
    }

    /// The part of four that it is in, those at the corners and the middle one.
    fn part(self) -> usize {
        // The part of a point by the corners that are no farther than the middles of the edges. A
        // table avoids branches that cannot be predicted.
        const PARTS: [usize; 8] = [3, 0, 1, 0, 2, 0, 1, 0];
        let is_near = [self.first_weight() >= 0.5, self.u >= 0.5, self.v >= 0.5].map(usize::from);
        PARTS[is_near[0] | is_near[1] << 1 | is_near[2] << 2]
    }

    /// Where it is in that part.
    fn in_part(self, part: usize) -> Self {
        const FACTORS: [f64; PARTS] = [2.0, 2.0, 2.0, -2.0];
        const SHIFTS: [[f64; 2]; PARTS] = [[0.0, 0.0], [-1.0, 0.0], [0.0, -1.0], [1.0, 1.0]];
        let (factor, [along, across]) = (FACTORS[part], SHIFTS[part]);
        Self {
            at: self.at,
            u: factor * self.u + along,
            v: factor * self.v + across,
        }
    }
}

/// The corners of each part among those of the face and the middles of its edges.
const CORNERS: [[usize; 3]; PARTS] = [[0, 3, 5], [3, 1, 4], [5, 4, 2], [4, 5, 3]];

/// Hands places to the four parts of a face, into `parted`, which is as long; those at corners of parts, which are the face's and the
/// middles of its edges and whose limits are given, are answered. Gives where the places of each part are.
pub(super) fn parted<A: Answers>(
    places: &[Place],
    parted: &mut [Place],
    corners: [A::Limit; 3],
    middles: [A::Limit; 3],
    found: &mut A,
) -> [Range<usize>; PARTS] {
    let limits = [
        corners[0], corners[1], corners[2], middles[0], middles[1], middles[2],
    ];
    let mut counts = [0; PARTS];
    places.iter().for_each(|place| counts[place.part()] += 1);
    let mut start = 0;
    let mut ranges = counts.map(|count| {
        start += count;
        start - count..start - count
    });
    for place in places {
        let part = place.part();
        let place = place.in_part(part);
        match place.corner() {
            Some(corner) => found.is(place.at, limits[CORNERS[part][corner]]),
            None => {
                parted[ranges[part].end] = place;
                ranges[part].end += 1;
            }
        }
    }
    ranges
}

/// Takes the places at the corners of a whole face, whose limits are given, out of them.
pub(super) fn take_corners<A: Answers>(
    corners: [A::Limit; 3],
    places: &mut Vec<Place>,
    found: &mut A,
) {
    places.retain(|place| {
        let corner = place.corner();
        corner.inspect(|&corner| found.is(place.at, corners[corner]));
        corner.is_none()
    });
}

/// Gives up places for the nearest corners.
pub(super) fn take_nearest<A: Answers>(corners: [A::Limit; 3], places: &[Place], found: &mut A) {
    places
        .iter()
        .for_each(|place| found.is(place.at, corners[place.nearest()]));
}

/// The values computed at points.
pub(crate) trait Answers {
    /// The limit that is computed at corners.
    type Limit: Limit;

    /// The point of that number.
    fn is(&mut self, at: u32, point: Self::Limit);

    /// Points on a regular piece, by its twelve points.
    fn are_on(&mut self, piece: &patch::Points, places: &[Place]);

    /// Points on a half of a bicubic piece.
    fn are_on_bicubic(&mut self, piece: &Bicubic, places: &[Place]) {
        for place in places {
            let at = piece.part.at([place.u, place.v]);
            let limit = Self::Limit::of(piece.point(at), || piece.limit(at).normal);
            self.is(place.at, limit);
        }
    }
}

/// The weights of up to `N` places, zeros beyond.
fn lanes<const N: usize>(places: &[Place]) -> [[f64; N]; 2] {
    let mut weights = [[0.0; N]; 2];
    for (lane, place) in places.iter().enumerate() {
        [weights[0][lane], weights[1][lane]] = [place.u, place.v];
    }
    weights
}

/// The first coordinates of points, up to 3.
pub(crate) struct Coordinates<'a, const AXES: usize>(pub &'a mut [[f64; AXES]]);

impl<const AXES: usize> Coordinates<'_, AXES> {
    fn some_on<const N: usize>(&mut self, piece: &[[f64; 15]; AXES], places: &[Place]) {
        let [u, v] = lanes::<N>(places);
        let points = piece
            .each_ref()
            .map(|coefficients| values_at(coefficients, &u, &v));
        for (lane, place) in places.iter().enumerate() {
            self.0[place.at as usize] = from_fn(|axis| points[axis][lane]);
        }
    }
}

impl<const AXES: usize> Answers for Coordinates<'_, AXES> {
    type Limit = DVec3;

    fn is(&mut self, at: u32, point: DVec3) {
        self.0[at as usize] = from_fn(|axis| point[axis]);
    }

    fn are_on(&mut self, piece: &patch::Points, places: &[Place]) {
        let net = BezierTriangle::of(&piece.map(vector::Coordinates::<AXES>::of));
        let coefficients = coefficients(&net, 0);
        let by_axis = from_fn(|axis| coefficients.map(|own| own.0[axis]));
        for some in places.chunks(LANES) {
            match some.len() > HALF {
                true => self.some_on::<LANES>(&by_axis, some),
                false => self.some_on::<HALF>(&by_axis, some),
            }
        }
    }
}

/// Points with their normals.
pub(crate) struct Points<'a> {
    pub(super) with_normals: bool,
    pub(super) points: &'a mut [SurfacePoint],
}

impl Answers for Points<'_> {
    type Limit = LimitPoint;

    fn is(&mut self, at: u32, point: LimitPoint) {
        self.points[at as usize] = SurfacePoint {
            position: point.position.to_array(),
            normal: point.normal.to_array(),
        };
    }

    fn are_on(&mut self, piece: &patch::Points, places: &[Place]) {
        let piece = regular(piece);
        for some in places.chunks(HALF) {
            let [u, v] = lanes::<HALF>(some);
            let [points, normals] = match self.with_normals {
                true => piece.points_and_normals_at(&u, &v),
                false => [piece.points_at(&u, &v, 3), [[0.0; HALF]; 3]],
            };
            for (lane, place) in some.iter().enumerate() {
                let [position, normal] =
                    [points, normals].map(|by_axis| by_axis.map(|axis| axis[lane]));
                self.points[place.at as usize] = SurfacePoint { position, normal };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::child_corners;

    /// A place in a part, seen from the part's corners, is where it was, to the bit where weights are dyadic.
    #[test]
    fn places_stay_where_they_are() {
        let face = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let middles = [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]];
        let limits = [
            face[0], face[1], face[2], middles[0], middles[1], middles[2],
        ];
        for (u, v) in (0..=16)
            .flat_map(|i| (0..=16 - i).map(move |j| (f64::from(i) / 16.0, f64::from(j) / 16.0)))
        {
            let place = Place::of(7, [1.0 - u - v, u, v]);
            let part = place.part();
            let own = place.in_part(part);
            let corners = child_corners(face, middles, part);
            assert_eq!(CORNERS[part].map(|corner| limits[corner]), corners);
            assert!(
                own.u >= 0.0 && own.v >= 0.0 && own.first_weight() >= 0.0,
                "{place:?}: {own:?}"
            );
            let weights = [own.first_weight(), own.u, own.v];
            let there = [0, 1, 2].map(|i| {
                (0..3)
                    .map(|corner| weights[corner] * corners[corner][i])
                    .sum::<f64>()
            });
            assert_eq!((there, own.at), ([1.0 - u - v, u, v], 7), "{place:?}");
        }
    }
}

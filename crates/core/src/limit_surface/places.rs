//! Places over a face, handed down to its parts as these are refined, and what is answered for them.

use core::array::from_fn;
use core::ops::Range;

use super::SurfacePoint;
use crate::patch::{LimitPoint, Quartic};

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

/// As many parts as a face has.
const PARTS: usize = 4;

impl Place {
    /// Barycentric coordinates are cut off so that they are in order.
    pub(super) fn of(at: usize, [_, u, v]: [f64; 3]) -> Self {
        let [u, v] = [u, v].map(|weight| if weight > 0.0 { weight.min(1.0) } else { 0.0 });
        Self { at: at as u32, u, v: v.min(1.0 - u) }
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
        (0..3).max_by(|&a, &b| weights[a].total_cmp(&weights[b])).unwrap_or(0)
    }

    /// The part of four that it is in, those at the corners and the middle one, and where it is there.
    fn in_part(self) -> (usize, Self) {
        let Self { at, u, v } = self;
        let part = match () {
            () if self.first_weight() >= 0.5 => 0,
            () if u >= 0.5 => 1,
            () if v >= 0.5 => 2,
            () => 3,
        };
        let [u, v] = match part {
            0 => [2.0 * u, 2.0 * v],
            1 => [2.0 * u - 1.0, 2.0 * v],
            2 => [2.0 * u, 2.0 * v - 1.0],
            _ => [1.0 - 2.0 * u, 1.0 - 2.0 * v],
        };
        (part, Self { at, u, v })
    }
}

/// Hands places to the four parts of a face, into `parted`, which is as long; those at corners of parts, whose limits are given, are
/// answered. Gives where the places of each part are.
pub(super) fn parted(
    places: &[Place],
    parted: &mut [Place],
    corners: &[[LimitPoint; 3]; PARTS],
    found: &mut impl Answers,
) -> [Range<usize>; PARTS] {
    let mut counts = [0; PARTS];
    places.iter().for_each(|place| counts[place.in_part().0] += 1);
    let mut start = 0;
    let mut ranges = counts.map(|count| {
        start += count;
        start - count..start - count
    });
    for place in places {
        let (part, place) = place.in_part();
        match place.corner() {
            Some(corner) => found.is(place.at, &corners[part][corner]),
            None => {
                parted[ranges[part].end] = place;
                ranges[part].end += 1;
            }
        }
    }
    ranges
}

/// Takes the places at the corners of a whole face, whose limits are given, out of them.
pub(super) fn take_corners(corners: [LimitPoint; 3], places: &mut Vec<Place>, found: &mut impl Answers) {
    places.retain(|place| {
        let corner = place.corner();
        corner.inspect(|&corner| found.is(place.at, &corners[corner]));
        corner.is_none()
    });
}

/// Gives up places for the nearest corners.
pub(super) fn take_nearest(corners: [LimitPoint; 3], places: &[Place], found: &mut impl Answers) {
    places.iter().for_each(|place| found.is(place.at, &corners[place.nearest()]));
}

/// What is computed of points.
pub(super) trait Answers {
    /// The point of that number.
    fn is(&mut self, at: u32, point: &LimitPoint);

    /// Points on a regular piece.
    fn are_on(&mut self, piece: &Quartic, places: &[Place]);
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
pub(super) struct Coordinates<'a, const AXES: usize>(pub(super) &'a mut [[f64; AXES]]);

impl<const AXES: usize> Coordinates<'_, AXES> {
    fn some_on<const N: usize>(&mut self, piece: &Quartic, places: &[Place]) {
        let [u, v] = lanes::<N>(places);
        let points = piece.points_at(&u, &v, AXES);
        for (lane, place) in places.iter().enumerate() {
            self.0[place.at as usize] = from_fn(|axis| points[axis][lane]);
        }
    }
}

impl<const AXES: usize> Answers for Coordinates<'_, AXES> {
    fn is(&mut self, at: u32, point: &LimitPoint) {
        self.0[at as usize] = from_fn(|axis| point.position[axis]);
    }

    fn are_on(&mut self, piece: &Quartic, places: &[Place]) {
        for some in places.chunks(LANES) {
            match some.len() > HALF {
                true => self.some_on::<LANES>(piece, some),
                false => self.some_on::<HALF>(piece, some),
            }
        }
    }
}

/// Points with their normals.
pub(super) struct Points<'a> {
    pub(super) with_normals: bool,
    pub(super) points: &'a mut [SurfacePoint],
}

impl Answers for Points<'_> {
    fn is(&mut self, at: u32, point: &LimitPoint) {
        self.points[at as usize] =
            SurfacePoint { position: point.position.to_array(), normal: point.normal.to_array() };
    }

    fn are_on(&mut self, piece: &Quartic, places: &[Place]) {
        for some in places.chunks(HALF) {
            let [u, v] = lanes::<HALF>(some);
            let [points, normals] = match self.with_normals {
                true => piece.points_and_normals_at(&u, &v),
                false => [piece.points_at(&u, &v, 3), [[0.0; HALF]; 3]],
            };
            for (lane, place) in some.iter().enumerate() {
                let [position, normal] = [points, normals].map(|by_axis| by_axis.map(|axis| axis[lane]));
                self.points[place.at as usize] = SurfacePoint { position, normal };
            }
        }
    }
}

//! Which way a regular piece looks, by the signs of coefficients.
//!
//! Its normals N have a net ([`crate::patch::normal_net`]), of degree 6 for a quartic, so `−d·N` has 28
//! coefficients, and all of the piece shows its front in the direction of sight d if they are
//! above 0. `(E − S)·N`, whose sign is the side of the tangent planes on which an eye E is, has
//! a net of degree 10, of 66 coefficients that follow from those of S and of N. Over half a quad the degrees are 10 and 16.

use super::{Look, Side};
use crate::patch::normal_net::{DECIC, SEXTIC, products, size};
use crate::patch::polynomial::{Net, Normals};
use crate::vector::DVec3;
use smallvec::SmallVec;

const QUARTIC: usize = size(4);

/// Coefficients of the greatest degree.
const MOST: usize = size(16);

static WITH_POINTS: [[(u8, f64); SEXTIC]; QUARTIC] = products::<QUARTIC, SEXTIC, DECIC>(4, 6);
static WITH_POINTS_OF_HALVES: [[(u8, f64); DECIC]; SEXTIC] = products::<SEXTIC, DECIC, MOST>(6, 10);

/// The places of the values at the corners.
const fn corners(n: usize) -> [usize; 3] {
    [0, n, size(n) - 1]
}

/// Net points are off by no more than this part of their greatest coordinate: sums of a dozen terms, after some levels.
const POINT_ROUNDING: f64 = 256.0 * f64::EPSILON;

/// Cross products of differences up to 1 and their sums are off by no more than this, and by
/// [`CROSS_ROUNDING`] times the error of the differences.
const SUM_ROUNDING: f64 = 64.0 * f64::EPSILON;

/// See [`SUM_ROUNDING`]: two products of two factors, one of which is up to √3 long.
const CROSS_ROUNDING: f64 = 8.0;

/// Normals are sums of cross products of vectors up to √3 long.
const LONGEST: f64 = 3.0;

/// The normals of a regular piece, scaled so that the greatest coordinate of a difference of neighbouring net points is 1.
#[derive(Clone, Debug)]
pub(crate) struct NormalNet {
    /// The degree of the piece.
    degree: usize,
    pub(super) normals: Normals,
    /// The greatest rounding error of the normals.
    pub(super) rounding: f64,
    /// The net's points, scaled, and their rounding error.
    points: SmallVec<[DVec3; QUARTIC]>,
    point_rounding: f64,
    scale: f64,
}

impl NormalNet {
    /// `None` where all points are one or none is finite.
    pub(crate) fn of<N: Net>(net: &N) -> Option<Self> {
        let differences = net.tangents();
        let greatest = |points: &[DVec3]| {
            points
                .iter()
                .fold(DVec3::ZERO, |greatest, point| greatest.max(point.abs()))
                .max_element()
        };
        let [along, across] = differences.each_ref().map(|net| greatest(net.as_ref()));
        let scale = along.max(across).recip();
        let point_rounding = POINT_ROUNDING * (greatest(net.points()) * scale).max(1.0);
        if !(scale > 0.0 && scale.is_finite() && point_rounding.is_finite()) {
            return None;
        }
        let normals = N::normals(differences, scale);
        let rounding = CROSS_ROUNDING * 2.0 * point_rounding + SUM_ROUNDING;
        Some(Self {
            degree: N::DEGREE,
            normals,
            rounding,
            points: net.points().iter().map(|point| point * scale).collect(),
            point_rounding,
            scale,
        })
    }

    /// The side seen along a unit direction of sight.
    pub(super) fn along(&self, sight: DVec3) -> Look {
        let sides: SmallVec<[f64; SEXTIC]> = self
            .normals
            .iter()
            .map(|normal| -sight.dot(*normal))
            .collect();
        let rounding = self.rounding + LONGEST * SUM_ROUNDING;
        Look::by_signs(&sides, corners(2 * self.degree - 2), rounding)
    }

    /// The side seen from an eye.
    pub(super) fn from(&self, eye: DVec3) -> Look {
        let eye = self.scale * eye;
        let mut sides = [0.0; MOST];
        let mut farthest = 0.0f64;
        let table = match self.degree {
            4 => WITH_POINTS.as_flattened(),
            _ => WITH_POINTS_OF_HALVES.as_flattened(),
        };
        let rows = table.chunks(self.normals.len());
        for (point, row) in self.points.iter().zip(rows) {
            let sight = eye - point;
            farthest = farthest.max(sight.length_squared());
            for (normal, &(at, part)) in self.normals.iter().zip(row) {
                sides[usize::from(at)] += part * sight.dot(*normal);
            }
        }
        let degree = 3 * self.degree - 2;
        let rounding = self.rounding_of(eye, farthest.sqrt());
        Look::by_signs(&sides[..size(degree)], corners(degree), rounding)
    }

    /// Whether it shows its back to an eye, decided by a ball around its points where that is possible.
    pub(super) fn is_back_from(&self, eye: DVec3) -> bool {
        let scaled = self.scale * eye;
        let sum: DVec3 = self.points.iter().sum();
        let centre = sum / self.points.len() as f64;
        let squared = |point: &DVec3| point.distance_squared(centre);
        let radius = self.points.iter().map(squared).fold(0.0, f64::max).sqrt();
        let sight = scaled - centre;
        let rounding = self.rounding_of(scaled, sight.length() + radius);
        let is_back = |normal: &DVec3| sight.dot(*normal) + radius * normal.length() < -rounding;
        self.normals.iter().all(is_back) || self.from(eye) == Look::All(Side::Back)
    }

    /// The greatest rounding error of products of normals and vectors up to this length towards an
    /// eye.
    fn rounding_of(&self, eye: DVec3, farthest: f64) -> f64 {
        let of_sight = self.point_rounding + 8.0 * f64::EPSILON * eye.abs().max_element();
        let of_normals = self.rounding + LONGEST * SUM_ROUNDING;
        2.0 * (LONGEST * of_sight + farthest * of_normals)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facing::test_nets::piece;
    use crate::patch::Quartic;
    use crate::patch::bezier_triangle::BezierTriangle;
    use crate::patch::normal_net::place;
    use limitmesh_testing::Random;

    /// A form by de Casteljau's algorithm.
    fn value(n: usize, net: &[DVec3], u: f64, v: f64) -> DVec3 {
        let mut points = net.to_vec();
        for degree in (0..n).rev() {
            let mut next = vec![DVec3::ZERO; size(degree)];
            for k in 0..=degree {
                for j in 0..=degree - k {
                    let at = |j, k| points[place(degree + 1, j, k)];
                    next[place(degree, j, k)] =
                        (1.0 - u - v) * at(j, k) + u * at(j + 1, k) + v * at(j, k + 1);
                }
            }
            points = next;
        }
        points[0]
    }

    fn in_triangle(random: &mut Random) -> (f64, f64) {
        let (u, v) = (random.signed().abs(), random.signed().abs());
        if u + v > 1.0 {
            (1.0 - u, 1.0 - v)
        } else {
            (u, v)
        }
    }

    #[test]
    fn the_net_is_that_of_the_normals() {
        let mut random = Random::new(3);
        for _ in 0..50 {
            let net = piece(&mut random, 0.5);
            let (normals, quartic) = (NormalNet::of(&net).unwrap(), Quartic::of(&net, 0));
            for _ in 0..20 {
                let (u, v) = in_triangle(&mut random);
                let [by_u, by_v] = quartic.tangents(u, v);
                let expected = by_u.cross(by_v) / 16.0 * normals.scale * normals.scale;
                assert!(value(6, &normals.normals, u, v).distance(expected) < 1e-13);
            }
        }
    }

    /// Signs agree with those of many points, and only nets that are mixed, or nearly, are left undecided.
    #[test]
    fn sides_are_those_of_all_points() {
        let mut random = Random::new(5);
        let (mut counts, mut undecided) = ([0; 3], 0);
        for _ in 0..1500 {
            let net = piece(&mut random, 0.25);
            let (normals, quartic) = (NormalNet::of(&net).unwrap(), Quartic::of(&net, 0));
            let eye = 3.0 * random.vector();
            let (mut fronts, mut all) = (0, 0);
            for i in 0..=12 {
                for j in 0..=12 - i {
                    let (u, v) = (f64::from(i) / 12.0, f64::from(j) / 12.0);
                    let [by_u, by_v] = quartic.tangents(u, v);
                    fronts += usize::from(by_u.cross(by_v).dot(eye - quartic.point(u, v)) > 0.0);
                    all += 1;
                }
            }
            let truth = if fronts == all {
                0
            } else {
                1 + usize::from(fronts > 0)
            };
            counts[truth] += 1;
            match normals.from(eye) {
                Look::All(Side::Front) => assert_eq!(truth, 0),
                Look::All(Side::Back) => assert_eq!(truth, 1),
                Look::Both => assert_eq!(truth, 2),
                Look::Unknown => {
                    undecided += usize::from(truth != 2);
                }
            }
        }
        let [front, back, mixed] = counts;
        assert!(front > 300 && back > 300 && mixed > 100, "{counts:?}");
        assert!(undecided < 60, "{undecided}");
    }

    #[test]
    fn pieces_without_extent_have_no_net() {
        assert!(NormalNet::of(&BezierTriangle([DVec3::ONE; 15])).is_none());
        assert!(NormalNet::of(&BezierTriangle([DVec3::NAN; 15])).is_none());
        let net = BezierTriangle(
            [DVec3::splat(1e300), DVec3::ZERO, DVec3::ONE]
                .repeat(5)
                .try_into()
                .unwrap(),
        );
        assert!(NormalNet::of(&net).is_some_and(|net| net.along(DVec3::X) == Look::Unknown));
    }
}

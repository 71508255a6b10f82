//! Cones of normals (Shirman, Abi-Ezzi, "The Cone of Normals Technique for Fast Processing of Curved Patches", 1993).
//!
//! Normals are combinations of a net's with weights that are not negative, so a cone around an axis
//! a with a half angle θ below 90° that holds the net's holds them all. An eye E sees the front
//! alone where its direction from every point of the piece is within 90° − θ of a:
//! `(E − p)·a ≥ |E − p| sin θ`. The difference of both sides is concave in p, so the points of a
//! hull decide. The *truncated cone* puts them behind two apexes: with heights `h_p = (p − c)·a`
//! and distances r_p from the axis through c these are `c + a max(h_p + r_p tan θ)` and
//! `c + a min(h_p − r_p tan θ)`, and one product decides for each.

use super::viewpoint::Viewpoint;
use super::{Facing, Look, NormalNet, Side};
use crate::math;
use crate::vector::{DVec3, unit_or_zero, vector};

/// Steps of an axis towards the normal that is farthest from it: each does less.
const STEPS: usize = 12;

/// The rounding error of a sine, and of the unit length of an axis.
const SINE_ROUNDING: f64 = 1e-14;

/// Points and eyes are off by no more than this part of their coordinates.
const POINT_ROUNDING: f64 = 256.0 * f64::EPSILON;

/// A cone that holds all normals of a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cone {
    /// Of unit length.
    pub(crate) axis: DVec3,
    /// The sine of its half angle, which is below 90°.
    pub(crate) sine: f64,
}

impl Cone {
    /// The cone of a regular piece; `None` where none is narrow enough.
    pub(crate) fn of(net: &NormalNet) -> Option<Self> {
        Self::around(&net.normals, net.rounding)
    }

    /// A narrow cone around directions, of any length, that are off by up to `rounding` each.
    pub(super) fn around(directions: &[DVec3], rounding: f64) -> Option<Self> {
        let sum =
            |unit: fn(DVec3) -> DVec3| directions.iter().map(|&direction| unit(direction)).sum();
        let mut axis = unit_or_zero(sum(unit_or_zero));
        let (mut best, mut farthest) = (axis, DVec3::ZERO);
        let mut greatest = -1.0;
        for step in 0..=STEPS {
            let cosine = |direction: &DVec3| axis.dot(unit_or_zero(*direction));
            let mut least = 1.0f64;
            for direction in directions {
                let cosine = cosine(direction);
                if cosine < least {
                    (least, farthest) = (cosine, unit_or_zero(*direction));
                }
            }
            if least > greatest {
                (greatest, best) = (least, axis);
            }
            axis = unit_or_zero(axis + (farthest - axis) / (step + 2) as f64);
        }
        let mut sine = 0.0f64;
        for direction in directions {
            let length = direction.length();
            let (along, across) = (
                best.dot(*direction),
                best.cross(*direction).length() + rounding,
            );
            // An error within a ball's radius turns a direction by less than the sine of its angle.
            if !(along > rounding && length > rounding) {
                return None;
            }
            sine = sine.max(across / length + rounding / length);
        }
        (sine < 1.0 - SINE_ROUNDING).then_some(Self {
            axis: best,
            sine: sine + SINE_ROUNDING,
        })
    }

    /// A cone that holds two; `None` where it would not be below 90°.
    pub(super) fn with(self, other: Self) -> Option<Self> {
        let [a, b] = [self.sine, other.sine].map(math::asin);
        let between = self.axis.distance(other.axis);
        let between = 2.0 * math::asin((0.5 * between).min(1.0));
        if between + b <= a {
            return Some(self);
        }
        if between + a <= b {
            return Some(other);
        }
        let half = 0.5 * (a + b + between);
        // The axis of the other stands `between` from here, and that of both `half − a`.
        let part = (half - a) / between;
        let axis = unit_or_zero(
            (math::sin((1.0 - part) * between) * self.axis
                + math::sin(part * between) * other.axis)
                / math::sin(between),
        );
        let sine = math::sin(half) + 4.0 * SINE_ROUNDING;
        let is_one = axis != DVec3::ZERO && half < core::f64::consts::FRAC_PI_2 && sine < 1.0;
        is_one.then_some(Self { axis, sine })
    }

    /// How points in the hull of these with normals in the cone look from there.
    pub(super) fn look(&self, points: impl Iterator<Item = DVec3>, viewpoint: &Viewpoint) -> Look {
        let (mut front, mut back) = (true, true);
        let mut add = |sight: DVec3, rounding: f64| {
            let (along, least) = (sight.dot(self.axis), self.sine * sight.length() + rounding);
            front &= along > least;
            back &= along < -least;
        };
        match *viewpoint {
            Viewpoint::Direction(sight) => add(-unit_or_zero(vector(sight)), SINE_ROUNDING),
            Viewpoint::Eye(eye) => points.for_each(|point| {
                let eye = vector(eye);
                // Scaled first: squares of very large or small coordinates overflow or vanish.
                add(
                    (eye - point) / eye.abs().max(point.abs()).max_element(),
                    POINT_ROUNDING,
                );
            }),
        }
        match (front, back) {
            (true, false) => Look::All(Side::Front),
            (false, true) => Look::All(Side::Back),
            _ => Look::Unknown,
        }
    }

    /// The apexes of the truncated cone around points: eyes in front of the first within 90° − θ of the axis see the front alone, eyes
    /// behind the second the back.
    pub(super) fn apexes(&self, points: impl Iterator<Item = DVec3> + Clone) -> [DVec3; 2] {
        let count = points.clone().count().max(1) as f64;
        let centre = points.clone().map(|point| point / count).sum::<DVec3>();
        let slope = self.sine / (1.0 - self.sine * self.sine).sqrt();
        let greatest = points
            .clone()
            .fold(centre.abs(), |greatest, point| greatest.max(point.abs()));
        // Scaled: squares of very large or small coordinates overflow or vanish.
        let size = greatest.max_element().max(f64::MIN_POSITIVE);
        let (mut front, mut back) = (f64::NEG_INFINITY, f64::INFINITY);
        for point in points {
            let from = (point - centre) / size;
            let (height, off) = (from.dot(self.axis), from.cross(self.axis).length());
            front = front.max(height + off * slope);
            back = back.min(height - off * slope);
        }
        let rounding = POINT_ROUNDING * (1.0 + slope);
        [
            centre + (front + rounding) * size * self.axis,
            centre + (back - rounding) * size * self.axis,
        ]
    }
}

/// A cone that holds all normals of the surface over a control face, and the truncated cone that holds its points, too.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct NormalCone {
    /// Of unit length, on the side from which the face's corners run counter-clockwise.
    pub axis: [f64; 3],
    /// Half angle in radians, below π/2.
    pub half_angle: f64,
    /// A viewer seen from here at less than π/2 − `half_angle` off the axis sees only the surface's
    /// front.
    pub front_apex: [f64; 3],
    /// A viewer seen from here at less than π/2 − `half_angle` off the opposite of the axis sees
    /// only its back.
    pub back_apex: [f64; 3],
}

impl NormalCone {
    pub(crate) fn of(cone: &Cone, points: impl Iterator<Item = DVec3> + Clone) -> Self {
        let [front, back] = cone.apexes(points);
        let half_angle = math::asin(cone.sine) + SINE_ROUNDING;
        Self {
            axis: cone.axis.to_array(),
            half_angle,
            front_apex: front.to_array(),
            back_apex: back.to_array(),
        }
    }

    /// How the surface looks from there, by one product a side: never wrong, and now and then
    /// [undecided](Facing::Undecided) where [`LimitSurface::facing`](crate::LimitSurface::facing) is not.
    pub fn facing(&self, viewpoint: &Viewpoint) -> Facing {
        let cone = Cone {
            axis: vector(self.axis),
            sine: math::sin(self.half_angle) + SINE_ROUNDING,
        };
        let apexes = [self.front_apex, self.back_apex].map(vector);
        let [front, back] = apexes.map(|apex| cone.look(core::iter::once(apex), viewpoint));
        match (front, back) {
            (Look::All(Side::Front), _) => Facing::Front,
            (_, Look::All(Side::Back)) => Facing::Back,
            _ => Facing::Undecided,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facing::test_nets::piece;
    use crate::patch::Quartic;
    use limitmesh_testing::Random;

    fn angle(a: DVec3, b: DVec3) -> f64 {
        a.cross(b).length().atan2(a.dot(b))
    }

    /// Half angles compared with those of many sampled normals around one axis.
    #[test]
    fn cones_hold_all_normals_and_are_narrow() {
        let mut random = Random::new(11);
        let (mut ratios, mut wide) = (Vec::new(), 0);
        for _ in 0..300 {
            let net = piece(&mut random, 0.15);
            let Some(cone) = NormalNet::of(&net).and_then(|net| Cone::of(&net)) else {
                wide += 1;
                continue;
            };
            let quartic = Quartic::of(&net, 0);
            let mut sampled = 0.0f64;
            for i in 0..=24 {
                for j in 0..=24 - i {
                    let normal = quartic.normal(f64::from(i) / 24.0, f64::from(j) / 24.0);
                    sampled = sampled.max(angle(normal, cone.axis));
                }
            }
            let own = cone.sine.asin();
            assert!(sampled <= own, "{sampled} {own}");
            ratios.push(own / sampled);
        }
        ratios.sort_by(f64::total_cmp);
        assert!(ratios.len() > 200 && wide < 60, "{wide}");
        assert!(
            ratios[ratios.len() / 2] < 1.1,
            "{}",
            ratios[ratios.len() / 2]
        );
    }

    #[test]
    fn cones_of_two_hold_both() {
        let mut random = Random::new(17);
        let mut found = 0;
        for _ in 0..2000 {
            let mut cone = || Cone {
                axis: unit_or_zero(random.vector()),
                sine: 0.5 * random.signed().abs(),
            };
            let (a, b) = (cone(), cone());
            let Some(both) = a.with(b) else { continue };
            found += 1;
            for part in [a, b] {
                assert!(angle(part.axis, both.axis) + part.sine.asin() <= both.sine.asin() + 1e-12);
            }
        }
        assert!(found > 400, "{found}");
    }
}

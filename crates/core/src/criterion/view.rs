//! View-dependent adaptation (the paper's section 3.3, equations 11 to 13).

use core::f64::consts::PI;

use super::region::{cosine_of, sum_of_angles};
use super::{CriterionError, Region};
use crate::facing::Viewpoint;
use crate::vector::{DVec3, unit_or_zero, vector};

/// A view, and the additional tolerance of faces towards the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The position of the viewer.
    pub viewpoint: Viewpoint,
    /// The paper's dilatant factor k (1 in most of its experiments): the greater, the coarser the
    /// faces towards the viewer.
    pub dilatation: f64,
}

/// The effect of a face's position in the view on the cone's angle α.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AngleLimit {
    /// The face is turned away: never divided (α f(β) = π).
    Never,
    /// The face is seen edge-on: always divided (α f(β) = 0).
    Always,
    /// Divided where its normal deviates by more than this angle, in radians, from a limit normal.
    Angle(f64),
}

impl View {
    /// `α·f(β)` of equations (11) and (12), with `f(β) = π/α` for `β < π/2` and `k·cos(π − β)` from there on,
    /// clamped to [0, π].
    ///
    /// `cosine` is that of β, the angle between the direction of sight and the face's normal. For sight along
    /// −z it is −z of the unit normal, and this is equation (13).
    pub fn limit(&self, angle: f64, cosine: f64) -> AngleLimit {
        if cosine > 0.0 {
            return AngleLimit::Never;
        }
        let scaled = angle * self.dilatation * -cosine;
        if scaled > 0.0 {
            AngleLimit::Angle(scaled.min(PI))
        } else {
            AngleLimit::Always
        }
    }

    /// The least of the limits of all faces whose centroid is in the region's ball and whose normal is in its cone.
    pub(crate) fn least_limit(&self, angle: f64, region: &Region) -> AngleLimit {
        let (sight, spread) = match self.viewpoint {
            Viewpoint::Direction(direction) => (unit_or_zero(vector(direction)), 0.0),
            Viewpoint::Eye(eye) => {
                let sight = region.centre - vector(eye);
                let distance = sight.length();
                let spread = if distance > region.radius {
                    region.radius / distance
                } else {
                    1.0
                };
                (unit_or_zero(sight), spread)
            }
        };
        let spread = sum_of_angles(region.sine, spread);
        if spread >= 1.0 || region.axis == DVec3::ZERO {
            return AngleLimit::Always;
        }
        let (cosine, sine) = (sight.dot(region.axis), sight.cross(region.axis).length());
        // β is at most that of the axis and the spread: all face away.
        if cosine * cosine_of(spread) - sine * spread > 0.0 {
            return AngleLimit::Never;
        }
        // And at least the difference; limits fall towards the right angle, which is the silhouette.
        self.limit(angle, (cosine * cosine_of(spread) + sine * spread).min(0.0))
    }

    /// Refuses a dilatation below 0, a direction without length, and NaN.
    pub(crate) fn check(&self) -> Result<(), CriterionError> {
        let bad = |name, value, expected| {
            Err(CriterionError::BadParameter {
                name,
                value,
                expected,
            })
        };
        if !(self.dilatation >= 0.0 && self.dilatation.is_finite()) {
            return bad(
                "dilatation",
                self.dilatation,
                "a finite number of at least 0",
            );
        }
        let (name, place) = match self.viewpoint {
            Viewpoint::Direction(direction) => ("direction of sight", direction),
            Viewpoint::Eye(eye) => ("eye point", eye),
        };
        if let Some(&value) = place.iter().find(|x| !x.is_finite()) {
            return bad(name, value, "finite coordinates");
        }
        if matches!(self.viewpoint, Viewpoint::Direction([0.0, 0.0, 0.0])) {
            return bad(name, 0.0, "a vector other than 0");
        }
        Ok(())
    }

    /// The unit direction of sight towards a face with that centroid.
    pub(crate) fn direction(&self, centroid: DVec3) -> DVec3 {
        match self.viewpoint {
            Viewpoint::Direction(direction) => unit_or_zero(vector(direction)),
            Viewpoint::Eye(eye) => unit_or_zero(centroid - vector(eye)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEGREE: f64 = PI / 180.0;

    fn view(dilatation: f64) -> View {
        View {
            viewpoint: Viewpoint::Direction([0.0, 0.0, -1.0]),
            dilatation,
        }
    }

    /// Equation (13) as the paper prints it for sight along −z.
    fn equation_13(z: f64, angle: f64, k: f64) -> f64 {
        angle * if z < 0.0 { PI / angle } else { k * z }
    }

    #[test]
    fn the_general_form_is_the_simplified_one_along_z() {
        for i in -20..=20 {
            let z = f64::from(i) / 20.0;
            for k in [0.5, 1.0, 3.0] {
                let expected = equation_13(z, 10.0 * DEGREE, k);
                let found = match view(k).limit(10.0 * DEGREE, -z) {
                    AngleLimit::Never => PI,
                    AngleLimit::Always => 0.0,
                    AngleLimit::Angle(a) => a,
                };
                assert!(
                    (found - expected).abs() < 1e-15,
                    "z {z}, k {k}: {found} {expected}"
                );
            }
        }
    }

    #[test]
    fn back_faces_never_and_the_silhouette_always() {
        assert_eq!(view(1.0).limit(0.1, 1e-300), AngleLimit::Never);
        assert_eq!(view(1.0).limit(0.1, 0.0), AngleLimit::Always);
        assert_eq!(view(1.0).limit(0.1, -0.0), AngleLimit::Always);
    }

    #[test]
    fn a_large_dilatation_does_not_wrap_round() {
        assert_eq!(view(1e6).limit(0.1, -1.0), AngleLimit::Angle(PI));
    }
}

//! How fast the surface around an irregular vertex settles to an affine image of the characteristic map.
//!
//! Let A take the n + 6 points of an [`ExtraordinaryPatch`] to those after one refinement, and let λ be the eigenvalue of the
//! characteristic map χ. The points are p + t₁χ₁ + t₂χ₂ + r, where the limit p and the tangents t are those of A's left eigenvectors,
//! which are 0 on the outer points; so r is of the form Pr, where the projection P takes the three away, and AP = PA. Let D take points to
//! the differences of neighbouring net points of the three regular pieces that one refinement gives. After j levels those of what
//! differs from the map are, at the map's own size, λ⁻ʲDAʲPr, none longer than ‖DAʲP‖ λ⁻ʲ times the longest of r (the norm is the
//! greatest sum of a row's absolute values). Once ‖AᵐP‖ λ⁻ᵐ is below 1, no m levels add to what is longest: so the greatest of the first
//! m factors is never exceeded.

use super::Neighbours;
use super::Patch;
use super::bezier_triangle::BezierTriangle;
use super::characteristic::Characteristic;
use super::extraordinary::ExtraordinaryPatch;
use super::normal_net::tangents;
use crate::math;
use crate::vector::DVec3;

/// Levels after which it is given up.
const MOST_LEVELS: usize = 400;

/// The greatest factor by rounding.
const ROUNDING: f64 = 1.0 + 1e-9;

/// How long the differences from the characteristic map are at most, at any level and at the map's size, where the longest of its
/// points is 1: `None` if it is not known.
/// `beta` is the weight of each neighbour of the vertex.
pub(super) fn growth(map: &Characteristic, beta: f64) -> Option<f64> {
    let valence = map.control.ring.len();
    let eigenvalue = 0.375 + 0.25 * math::cos(core::f64::consts::TAU / valence as f64);
    let left = |patch: ExtraordinaryPatch| {
        let [limit, t1, t2] = settled(&patch, beta);
        let left = |(point, at): (DVec3, DVec3)| point - (limit + at.x * t1 + at.y * t2);
        let pairs = patch.points().zip(map.control.points());
        pairs.map(left).collect()
    };
    let step = |points: &[DVec3]| {
        let refined = patch_of(points).refined(beta);
        let nets = [1, 2, 3].map(|part| tangents(&BezierTriangle::of(&refined.regular(part))));
        let Patch::Extraordinary(next) = refined.part(0) else {
            return None;
        };
        let differences = nets.as_flattened().as_flattened().to_vec();
        Some((next.points().collect(), differences))
    };
    let left = |points: Vec<DVec3>| left(patch_of(&points));
    greatest_growth(valence + 6, eigenvalue, left, step)
}

/// The greatest growth at any level, given the number of points, λ, P, and what gives the points after a step and the differences in the
/// regular pieces.
pub(crate) fn greatest_growth(
    count: usize,
    eigenvalue: f64,
    left: impl Fn(Vec<DVec3>) -> Vec<DVec3>,
    step: impl Fn(&[DVec3]) -> Option<(Vec<DVec3>, Vec<DVec3>)>,
) -> Option<f64> {
    // A column of P and of what refinements make of it for each point, three at a time.
    let column = |first: usize| {
        let mut points = vec![DVec3::ZERO; count];
        [DVec3::X, DVec3::Y, DVec3::Z]
            .into_iter()
            .zip(3 * first..count)
            .for_each(|(e, at)| points[at] = e);
        left(points)
    };
    let mut columns: Vec<Vec<DVec3>> = (0..count.div_ceil(3)).map(column).collect();
    let (mut greatest, mut scale) = (0.0f64, 1.0);
    for level in 0..MOST_LEVELS {
        let (mut of_points, mut of_differences) = (vec![0.0; count], Vec::new());
        for column in &mut columns {
            let sum = |(row, point): (&mut f64, &DVec3)| *row += point.abs().element_sum();
            of_points.iter_mut().zip(&*column).for_each(sum);
            let (next, differences) = step(column)?;
            of_differences.resize(differences.len(), 0.0);
            of_differences.iter_mut().zip(&differences).for_each(sum);
            *column = next;
        }
        let factor = |rows: &[f64]| ROUNDING * scale * rows.iter().copied().fold(0.0, f64::max);
        if level > 0 && factor(&of_points) < 1.0 {
            return Some(greatest);
        }
        greatest = greatest.max(factor(&of_differences));
        scale /= eigenvalue;
    }
    None
}

/// The limit of an irregular vertex, and the tangents that go with its characteristic map.
pub(crate) fn settled(patch: &ExtraordinaryPatch, beta: f64) -> [DVec3; 3] {
    let valence = patch.ring.len() as f64;
    let share = 1.0 / (valence + 0.375 / beta);
    let (mut sum, mut along, mut across) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
    for (slot, &point) in patch.ring.iter().enumerate() {
        let (sine, cosine) = math::sin_cos(core::f64::consts::TAU * slot as f64 / valence);
        let from = point - patch.at;
        sum += from;
        along += cosine * from;
        across += sine * from;
    }
    [
        patch.at + share * sum,
        2.0 / valence * along,
        2.0 / valence * across,
    ]
}

/// The points of a patch at its first corner, in their order.
fn patch_of(points: &[DVec3]) -> ExtraordinaryPatch {
    let ring: Neighbours = points[1..points.len() - 5].iter().copied().collect();
    let mut outer = [DVec3::ZERO; 5];
    outer.copy_from_slice(&points[points.len() - 5..]);
    ExtraordinaryPatch {
        corner: 0,
        at: points[0],
        ring,
        outer,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::Rules;
    use crate::scheme::Loop;

    /// Brute force: points at random, refined many times.
    #[test]
    fn what_is_left_never_grows_beyond() {
        let rules = Rules::of(&Loop);
        for valence in (3..32).filter(|&n| n != 6) {
            let map = rules.characteristic(valence).unwrap();
            let (beta, growth) = (rules.beta(valence), rules.settling(valence).unwrap());
            assert!((0.05..4.0).contains(&growth), "{valence}: {growth}");
            let eigenvalue = 0.375 + 0.25 * (core::f64::consts::TAU / valence as f64).cos();
            let points: Vec<DVec3> = (0..valence + 6)
                .map(|i| {
                    let t = (i * valence) as f64;
                    DVec3::new((t * 1.7).sin(), (t * t * 0.31).cos(), (t * 2.9 + 0.4).sin())
                })
                .collect();
            let mut patch = patch_of(&points);
            let [limit, t1, t2] = settled(&patch, beta);
            let left = |patch: &ExtraordinaryPatch, scale: f64| {
                let pairs = patch.points().zip(map.control.points());
                let lengths =
                    pairs.map(|(p, at)| (p - limit - scale * (at.x * t1 + at.y * t2)).length());
                lengths.fold(0.0, f64::max)
            };
            let (first, mut scale) = (left(&patch, 1.0), 1.0);
            for level in 0..12 {
                let refined = patch.refined(beta);
                let nets = [map.control.refined(0.0), patch.refined(beta)].map(|refined| {
                    [1, 2, 3].map(|part| tangents(&BezierTriangle::of(&refined.regular(part))))
                });
                let [of_map, own] = nets.map(|nets| nets.as_flattened().concat());
                for (of_map, own) in of_map.into_iter().zip(own) {
                    let beside = own / scale - of_map.x * t1 - of_map.y * t2;
                    assert!(
                        beside.length() <= growth * first + 1e-9,
                        "{valence}, level {level}"
                    );
                }
                let Patch::Extraordinary(next) = refined.part(0) else {
                    panic!()
                };
                (patch, scale) = (*next, scale * eigenvalue);
            }
            assert!(left(&patch, scale) / scale < first, "{valence}");
        }
    }
}

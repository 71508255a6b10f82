//! Normals at an irregular vertex inside the surface, of triangles or of quads.
//!
//! The part at the vertex consists of three regular pieces a level, at all levels. At level j their
//! points are p + λʲ(t₁χ₁ + t₂χ₂) + r_j, χ being the characteristic map's three regular pieces. A
//! difference of neighbouring net points is then λʲ(t₁∂χ₁ + t₂∂χ₂) up to λʲρ, with ρ bounded by
//! [`crate::patch::settling`], so that the normals' net is
//!
//! > `λ²ʲ (J_t · t₁ × t₂ + e_t)`, `|e_t| ≤ 2ρτ + ρ²`,
//!
//! J_t being the net of the map's Jacobian, which is positive, and τ the greatest
//! `|t₁||∂χ₁| + |t₂||∂χ₂|`. So all normals are within the angle of sine `|e|/(J |t₁ × t₂|)` of t₁ ×
//! t₂. As a piece is refined, ρ falls relative to t: from some level on there is a cone.

use super::Cone;
use crate::patch::extraordinary::ExtraordinaryPatch;
use crate::patch::quad::QuadPatch;
use crate::patch::settling::settled;
use crate::patch::{Patch, Rules};
use crate::row::sum;
use crate::vector::{DVec3, unit_or_zero};

/// Sines of cones above which a part's own parts are tested.
pub(super) const NARROW: f64 = 0.25;

/// Points are off by no more than this part of their greatest coordinate.
const POINT_ROUNDING: f64 = 1024.0 * f64::EPSILON;

/// A cone that holds all normals of a piece at an irregular vertex but that of the vertex itself,
/// which is its axis; `None` where the vanishing term is still too great.
pub(super) fn cone(patch: &Patch, rules: &Rules<'_>) -> Option<Cone> {
    match patch {
        Patch::Extraordinary(patch) => at_triangles(patch, rules),
        Patch::Quad(patch) => at_quads(patch, rules),
        _ => None,
    }
}

fn at_triangles(patch: &ExtraordinaryPatch, rules: &Rules<'_>) -> Option<Cone> {
    let valence = patch.ring.len();
    let (map, growth) = (rules.characteristic(valence)?, rules.settling(valence)?);
    let bounds = Bounds {
        growth,
        least_jacobian: map.least_jacobian,
        steepest: map.steepest,
    };
    let points = patch.points().zip(map.control.points());
    around(points, settled(patch, rules.beta(valence)), bounds)
}

fn at_quads(patch: &QuadPatch, rules: &Rules<'_>) -> Option<Cone> {
    let settling = patch.settling(rules)?;
    let bounds = Bounds {
        growth: settling.growth,
        least_jacobian: settling.least_jacobian,
        steepest: settling.steepest,
    };
    let own = patch.points();
    let points = own.iter().copied().zip(settling.map.iter().copied());
    let limits = settling.functionals.each_ref();
    around(points, limits.map(|row| sum(row, own)), bounds)
}

/// What is known of a characteristic map: how many times as long as the difference of control points from its image ρ can get, the least
/// Jacobian J, and the greatest derivatives ∂χ.
struct Bounds {
    growth: f64,
    least_jacobian: f64,
    steepest: [f64; 2],
}

/// The cone by points, each with that of the map, and their limit and tangents.
fn around(
    points: impl Iterator<Item = (DVec3, DVec3)>,
    [limit, t1, t2]: [DVec3; 3],
    map: Bounds,
) -> Option<Cone> {
    let mut longest = 0.0f64;
    let mut greatest = limit.abs();
    for (point, at) in points {
        longest = longest.max((point - limit - at.x * t1 - at.y * t2).abs().max_element());
        greatest = greatest.max(point.abs());
    }
    // A vector is at most √3 times as long as its greatest coordinate.
    let left = map.growth * 3f64.sqrt() * (longest + POINT_ROUNDING * greatest.max_element());
    // Scaled: products of very large or small tangents overflow or vanish.
    let scale = t1.abs().max(t2.abs()).max_element().recip();
    let (t1, t2, left) = (scale * t1, scale * t2, scale * left);
    let (normal, steepest) = (
        t1.cross(t2),
        t1.length() * map.steepest[0] + t2.length() * map.steepest[1],
    );
    let off = left * (2.0 * steepest + left);
    let axis = unit_or_zero(normal);
    let sine = off / (map.least_jacobian * normal.length());
    // A cone with a NaN is none.
    let is_one =
        scale > 0.0 && axis != DVec3::ZERO && map.least_jacobian > 0.0 && sine < 1.0 - 1e-9;
    is_one.then_some(Cone {
        axis,
        sine: sine + 1e-12,
    })
}

//! Which schemes the exact pieces are for: those that are Loop's but for the weights of irregular vertices.
//!
//! They share the quartic box spline on regular pieces and the cubic B-spline on boundaries and creases, and all
//! their masks are convex combinations, so that a piece lies in the hull of its points.

use std::sync::OnceLock;

use super::characteristic::Characteristic;
use crate::ring::{EdgeShape, RingShape};
use crate::scheme::{Scheme, Support};

/// Valences whose weights are kept.
const KEPT: usize = 32;

/// The weights of a scheme of Loop's family.
pub(crate) struct Rules<'s> {
    scheme: &'s dyn Scheme,
    betas: [f64; KEPT],
    characteristics: [OnceLock<Characteristic>; KEPT],
}

impl<'s> Rules<'s> {
    /// The rules of `scheme`; `None` if it is not of the family.
    pub(crate) fn of(scheme: &'s dyn Scheme) -> Option<Self> {
        let rules = Self {
            scheme,
            betas: core::array::from_fn(|k| if k < 2 { 0.0 } else { beta(scheme, k) }),
            characteristics: [const { OnceLock::new() }; KEPT],
        };
        let kept = (2..KEPT).all(|k| (0.0..=1.0 / k as f64).contains(&rules.betas[k]));
        (scheme.support() == Support::OneRing && kept && is_regular_loop(scheme)).then_some(rules)
    }

    /// The weight of each neighbour of a smooth vertex.
    #[inline]
    pub(crate) fn beta(&self, valence: usize) -> f64 {
        match self.betas.get(valence) {
            Some(&beta) => beta,
            None => beta(self.scheme, valence),
        }
    }
}

impl Rules<'_> {
    /// The characteristic map of a valence; `None` for those that are not kept.
    pub(crate) fn characteristic(&self, valence: usize) -> Option<&Characteristic> {
        let kept = self.characteristics.get(valence).filter(|_| valence >= 3)?;
        Some(kept.get_or_init(|| Characteristic::of(valence)))
    }
}

fn beta(scheme: &dyn Scheme, valence: usize) -> f64 {
    scheme.vertex_mask(RingShape::interior(valence as u32)).ring[0]
}

/// Whether the masks of regular rings are the box spline's, with B-spline curves as boundaries.
fn is_regular_loop(scheme: &dyn Scheme) -> bool {
    let (inside, rim) = (RingShape::interior(6), RingShape::boundary(4));
    let inner = scheme.vertex_mask(inside);
    let outer = scheme.vertex_mask(rim);
    let edge = scheme.edge_mask(EdgeShape::between(inside, inside));
    let along = scheme.edge_mask(EdgeShape { origin: rim, origin_slot: 0, target: rim, target_slot: 3 });
    let ends = [edge.origin + edge.target_ring[0], edge.target + edge.origin_ring[0]];
    let sides = [edge.origin_ring[1] + edge.target_ring[5], edge.origin_ring[5] + edge.target_ring[1]];
    let elsewhere = edge.origin_ring[2..5].iter().chain(&edge.target_ring[2..5]).all(|&w| w == 0.0);
    inner.centre == 0.625
        && inner.ring.iter().all(|&w| w == 0.0625)
        && (outer.centre, &outer.ring[..]) == (0.75, &[0.125, 0.0, 0.0, 0.125])
        && (ends, sides, elsewhere) == ([0.375; 2], [0.125; 2], true)
        && [along.origin + along.target_ring[3], along.target + along.origin_ring[0]] == [0.5; 2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scheme::{Loop, LoopWarren, ModifiedButterfly};

    #[test]
    fn the_family_is_recognised() {
        assert!(Rules::of(&Loop).is_some_and(|rules| rules.beta(6) == 0.0625 && rules.beta(100) > 0.0));
        assert!(Rules::of(&LoopWarren).is_some_and(|rules| rules.beta(3) == 0.1875));
        assert!(Rules::of(&ModifiedButterfly).is_none());
    }
}

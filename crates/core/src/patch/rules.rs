//! What the pieces of a surface need to know of its scheme, and whether it is one of Loop's family: those that are Loop's
//! but for the weights of irregular vertices.
//!
//! The family shares the quartic box spline on regular pieces and the cubic B-spline on boundaries and creases, and all
//! its masks are convex combinations, so that a piece lies in the hull of its points.

use std::sync::OnceLock;

use super::characteristic::Characteristic;
use crate::limit::LimitTable;
use crate::refine::RefineError;
use crate::ring::{EdgeShape, RingShape};
use crate::scheme::{Scheme, Support};

/// Valences whose weights are kept.
const KEPT: usize = 32;

/// A scheme, and its weights if it is of Loop's family.
pub(crate) struct Rules<'s> {
    scheme: &'s dyn Scheme,
    table: LimitTable<'s>,
    is_certified: bool,
    /// What went wrong first.
    failure: OnceLock<RefineError>,
    betas: [f64; KEPT],
    characteristics: [OnceLock<Characteristic>; KEPT],
}

impl<'s> Rules<'s> {
    /// The rules of `scheme`.
    pub(crate) fn of(scheme: &'s dyn Scheme) -> Self {
        let is_candidate = scheme.support() == Support::OneRing && is_regular_loop(scheme);
        let betas = core::array::from_fn(|k| if k < 2 || !is_candidate { 0.0 } else { beta(scheme, k) });
        Self {
            scheme,
            table: LimitTable::new(scheme),
            is_certified: is_candidate && (2..KEPT).all(|k| (0.0..=1.0 / k as f64).contains(&betas[k])),
            failure: OnceLock::new(),
            betas,
            characteristics: [const { OnceLock::new() }; KEPT],
        }
    }

    /// The scheme.
    pub(crate) fn scheme(&self) -> &'s dyn Scheme {
        self.scheme
    }

    /// The scheme's limit stencils.
    pub(crate) fn table(&self) -> &LimitTable<'s> {
        &self.table
    }

    /// Whether the scheme is of Loop's family: what does not fade has a form of its own, and bounds hold.
    #[inline]
    pub(crate) fn is_certified(&self) -> bool {
        self.is_certified
    }

    /// The rings of faces around a face that decide the surface over it.
    pub(crate) fn rings(&self) -> usize {
        if self.is_certified { 1 } else { 2 }
    }

    /// Keeps a failure, for whoever looks at results: what is computed after it means nothing.
    #[cold]
    pub(crate) fn fail(&self, why: RefineError) {
        // The first counts.
        let _ = self.failure.set(why);
    }

    /// The failure, if there was one.
    pub(crate) fn failure(&self) -> Option<&RefineError> {
        self.failure.get()
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
        let (rules, warren) = (Rules::of(&Loop), Rules::of(&LoopWarren));
        assert!(rules.is_certified() && rules.beta(6) == 0.0625 && rules.beta(100) > 0.0);
        assert!(warren.is_certified() && warren.beta(3) == 0.1875);
        assert!(!Rules::of(&ModifiedButterfly).is_certified());
    }
}

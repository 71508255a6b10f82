//! Masks spelled out over named points: turns a scheme's answer for a ring shape into (point, weight) pairs.
//!
//! Takes rings whose neighbours carry labels (indices of a canonical neighbourhood, or vertices of a mesh) and
//! gives each weight with its label. The labels of a ring may repeat (a closed ring of two edges names each
//! neighbour of a neighbour twice); weights of one label add up.

use crate::ring::{EdgeShape, RingShape};
use crate::scheme::{EdgeMask, Scheme};

/// A vertex and its neighbours by label, in counter-clockwise order.
#[derive(Clone, Debug)]
pub(super) struct Ring<L> {
    pub(super) centre: L,
    pub(super) shape: RingShape,
    pub(super) neighbours: Vec<L>,
}

impl<L: Copy> Ring<L> {
    /// Where a scheme is told that slot `slot` of this ring stands: closed rings are turned to start there.
    fn slot_for_scheme(&self, slot: usize) -> u32 {
        if self.shape.open { slot as u32 } else { 0 }
    }

    /// The neighbours as the scheme lists them for an edge at `slot`, without end for a closed ring.
    fn for_scheme(&self, slot: usize) -> impl Iterator<Item = L> + '_ {
        let start = if self.shape.open { 0 } else { slot };
        self.neighbours[start..].iter().chain(&self.neighbours[..start]).copied()
    }
}

/// The shape of the edge from `origin` to its neighbour at `origin_slot`, who sees it at `target_slot`.
pub(super) fn edge_shape<L: Copy>(
    (origin, origin_slot): (&Ring<L>, usize),
    (target, target_slot): (&Ring<L>, usize),
) -> EdgeShape {
    EdgeShape {
        origin: origin.shape,
        origin_slot: origin.slot_for_scheme(origin_slot),
        target: target.shape,
        target_slot: target.slot_for_scheme(target_slot),
    }
}

/// Calls `visit` for every weight that is not zero of the new position of the ring's centre.
pub(super) fn vertex_weights<L: Copy>(scheme: &dyn Scheme, ring: &Ring<L>, mut visit: impl FnMut(L, f64)) {
    let mask = scheme.vertex_mask(ring.shape);
    let pairs = ring.neighbours.iter().copied().zip(mask.ring);
    for (label, weight) in core::iter::once((ring.centre, mask.centre)).chain(pairs) {
        if weight != 0.0 {
            visit(label, weight);
        }
    }
}

/// Calls `visit` for every weight of `mask`, the mask of the edge given by two rings and slots, that is not zero.
pub(super) fn edge_weights<L: Copy>(
    mask: &EdgeMask,
    (origin, origin_slot): (&Ring<L>, usize),
    (target, target_slot): (&Ring<L>, usize),
    mut visit: impl FnMut(L, f64),
) {
    let ends = [(origin.centre, mask.origin), (target.centre, mask.target)];
    let around_origin = origin.for_scheme(origin_slot).zip(mask.origin_ring.iter().copied());
    let around_target = target.for_scheme(target_slot).zip(mask.target_ring.iter().copied());
    for (label, weight) in ends.into_iter().chain(around_origin).chain(around_target) {
        if weight != 0.0 {
            visit(label, weight);
        }
    }
}

//! The views of a vertex or an edge for a scheme: rings with named points, cut at sharp edges.
//!
//! Takes rings whose neighbours carry labels (points of a canonical neighbourhood, or vertices of a
//! mesh) and the sharpness of their edges; gives the rings that the scheme's masks are for, each
//! with the share that it has in the result. There is one, unless a semi-sharp tag is about to end:
//! then the rules before and after are mixed. The labels of a ring may repeat (a closed ring of two
//! edges names each neighbour of a neighbour twice); weights of one label add up.

use crate::ring::{EdgeShape, RingShape, SharpRing};

/// A vertex, its neighbours by label, counter-clockwise, and the sharpness of its edges.
#[derive(Clone, Debug)]
pub(crate) struct LabelledRing<L> {
    pub(crate) centre: L,
    pub(crate) neighbours: Vec<L>,
    pub(crate) sharp: SharpRing,
}

/// A ring as a scheme sees it.
#[derive(Clone, Debug)]
pub(crate) struct View<L> {
    pub(crate) centre: L,
    pub(crate) shape: RingShape,
    pub(crate) neighbours: Vec<L>,
}

/// An edge as a scheme sees it: both ends' rings.
#[derive(Clone, Debug)]
pub(crate) struct EdgeView<L> {
    pub(crate) shape: EdgeShape,
    pub(crate) origin: View<L>,
    pub(crate) target: View<L>,
}

/// One end of an edge: its view and the slot of the edge in it.
type End<L> = (View<L>, usize);

/// On which side of an edge, seen from one of its ends, the sector lies whose rules it takes.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    Left,
    Right,
}

impl<L: Copy> LabelledRing<L> {
    /// `count` neighbours from slot `first` on, round and round.
    fn from(&self, first: usize, count: usize) -> Vec<L> {
        let before = &self.neighbours[..first];
        self.neighbours[first..]
            .iter()
            .chain(before)
            .copied()
            .cycle()
            .take(count)
            .collect()
    }

    fn view(&self, first: usize, shape: RingShape) -> View<L> {
        let neighbours = self.from(first, shape.valence as usize);
        View {
            centre: self.centre,
            shape: RingShape {
                dart: false,
                ..shape
            },
            neighbours,
        }
    }

    /// The ring whose vertex mask applies when it is as sharp as `sharp`. The curve of a crease is the same for
    /// both sides.
    fn vertex_view(&self, sharp: &SharpRing) -> View<L> {
        let whole = RingShape {
            open: self.sharp.open,
            ..RingShape::interior(self.neighbours.len() as u32)
        };
        let first = sharp
            .sectors()
            .first()
            .map_or((0, whole), |sector| (sector.first, sector.shape));
        self.view(first.0, first.1)
    }

    /// The ring that the edge at `slot` is part of when it is as sharp as `sharp`.
    fn edge_view(&self, slot: usize, sharp: &SharpRing, side: Side) -> End<L> {
        let k = self.neighbours.len();
        let is_sharp = sharp.is_sharp(slot);
        for sector in sharp.sectors() {
            let (valence, place) = (sector.shape.valence as usize, (slot + k - sector.first) % k);
            if !sector.shape.open {
                if !is_sharp {
                    return (self.view(slot, sector.shape), 0);
                }
                // Where a crease ends, the ring is cut along it; the curve has no point beyond.
                let cut = RingShape {
                    corner: true,
                    ..RingShape::boundary(k as u32 + 1)
                };
                return (self.view(slot, cut), if side == Side::Left { 0 } else { k });
            }
            let here = match (is_sharp, side) {
                (false, _) => (place + 1 < valence).then_some(place),
                (true, Side::Left) => (place == 0).then_some(0),
                // Both ends of a sector that goes all round are one edge.
                (true, Side::Right) => {
                    ((sector.first + valence - 1) % k == slot).then_some(valence - 1)
                }
            };
            if let Some(here) = here {
                return (self.view(sector.first, sector.shape), here);
            }
        }
        (self.view(slot, RingShape::interior(k as u32)), 0)
    }

    /// The views of an end of an edge that is equally sharp, or smooth, before and after the next refinement.
    fn steady_edge_views(&self, slot: usize, side: Side) -> Vec<(f64, End<L>)> {
        let now = self.sharp.present_weight();
        let mut views = vec![(now, self.edge_view(slot, &self.sharp, side))];
        if now < 1.0 {
            views.push((1.0 - now, self.edge_view(slot, &self.sharp.refined(), side)));
        }
        views
    }
}

/// The rings whose masks make up the new position of a vertex, and their shares.
pub(crate) fn vertex_views<L: Copy>(ring: &LabelledRing<L>) -> Vec<(f64, View<L>)> {
    let now = ring.sharp.present_weight();
    let refined = ring.sharp.refined();
    if now == 1.0 || ring.sharp.rule() == refined.rule() {
        return vec![(1.0, ring.vertex_view(&ring.sharp))];
    }
    vec![
        (now, ring.vertex_view(&ring.sharp)),
        (1.0 - now, ring.vertex_view(&refined)),
    ]
}

/// The edges whose masks make up the new point on an edge, and their shares. Each end is given by its ring and the
/// slot of the edge in it.
///
/// A sharp edge takes the rules of the sector on its left, seen from the origin; those of the other give the same.
pub(crate) fn edge_views<L: Copy>(
    (origin, origin_slot): (&LabelledRing<L>, usize),
    (target, target_slot): (&LabelledRing<L>, usize),
) -> Vec<(f64, EdgeView<L>)> {
    let is_last = origin.sharp.open && origin_slot + 1 == origin.neighbours.len();
    let sides = if is_last {
        [Side::Right, Side::Left]
    } else {
        [Side::Left, Side::Right]
    };
    let sharpness = origin.sharp.spokes.get(origin_slot).copied().unwrap_or(0.0);
    if sharpness > 0.0 && sharpness <= 1.0 {
        let as_sharp_as = |from: &SharpRing, to: &SharpRing| {
            EdgeView::between(
                origin.edge_view(origin_slot, from, sides[0]),
                target.edge_view(target_slot, to, sides[1]),
            )
        };
        let mut views = vec![(sharpness, as_sharp_as(&origin.sharp, &target.sharp))];
        if sharpness < 1.0 {
            views.push((
                1.0 - sharpness,
                as_sharp_as(&origin.sharp.refined(), &target.sharp.refined()),
            ));
        }
        return views;
    }
    let mut views = Vec::new();
    for (share, from) in origin.steady_edge_views(origin_slot, sides[0]) {
        for (other_share, to) in target.steady_edge_views(target_slot, sides[1]) {
            views.push((share * other_share, EdgeView::between(from.clone(), to)));
        }
    }
    views
}

impl<L: Copy> EdgeView<L> {
    fn between((origin, origin_slot): End<L>, (target, target_slot): End<L>) -> Self {
        let shape = EdgeShape {
            origin: origin.shape,
            origin_slot: origin_slot as u32,
            target: target.shape,
            target_slot: target_slot as u32,
        };
        Self {
            shape,
            origin,
            target,
        }
    }
}

impl<L: Copy> View<L> {
    /// Each point with its weight, the vertex first.
    pub(crate) fn weighted<'v>(
        &'v self,
        centre: f64,
        ring: &'v [f64],
    ) -> impl Iterator<Item = (L, f64)> + use<'v, L> {
        let around = self.neighbours.iter().copied().zip(ring.iter().copied());
        core::iter::once((self.centre, centre))
            .chain(around)
            .filter(|&(_, weight)| weight != 0.0)
    }
}

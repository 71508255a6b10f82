//! Bézier nets of parts of regular pieces, with the position of their edges relative to the
//! triangle.

use super::borders::{ALL, Borders};
use super::hull_points::HullPoint;
use super::sub_triangle::SubTriangle;
use crate::patch::bezier_triangle::BezierTriangle;
use crate::vector::{Blend, DVec3};

/// The net of a part of a regular piece.
pub(crate) struct NetPart<V = DVec3> {
    pub(super) net: BezierTriangle<V>,
    pub(super) borders: Borders,
}

impl<V: Blend> NetPart<V> {
    /// A part of a piece with its net; one of a refinement is that part's own net.
    pub(super) fn of(net: &BezierTriangle<V>, part: SubTriangle, borders: Borders) -> Self {
        match part {
            SubTriangle::Whole | SubTriangle::Child(_) => Self { net: *net, borders },
            SubTriangle::Half { edge, second } => Self {
                net: net.half(edge, second),
                borders,
            },
            SubTriangle::Quarter { edge, at_end } => {
                let (net, borders) = quarter(net, edge, at_end, borders);
                Self { net, borders }
            }
        }
    }
}

impl NetPart {
    /// The part of a triangle's own piece.
    pub(crate) fn own(net: &BezierTriangle, part: SubTriangle) -> Self {
        Self::of(net, part, ALL)
    }

    /// The net, whose corners may be in another order than the part's.
    pub(crate) fn net(&self) -> &BezierTriangle {
        &self.net
    }

    /// The net as the points of a bound.
    pub(super) fn seen<P: HullPoint>(&self, frame: &P::Frame) -> BezierTriangle<P> {
        BezierTriangle(self.net.0.map(|point| P::of(frame, point)))
    }
}

/// The net of a quarter, and its borders in the order of the net's edges.
fn quarter<V: Blend>(
    net: &BezierTriangle<V>,
    edge: usize,
    at_end: bool,
    borders: Borders,
) -> (BezierTriangle<V>, Borders) {
    let (end, tip) = ((edge + 1) % 3, (edge + 2) % 3);
    // Away from the other end first, then away from the corner opposite.
    let (quarter, order) = if at_end {
        (net.half(tip, false).half(end, false), [end, tip, edge])
    } else {
        (net.half(end, true).half(tip, true), [edge, end, tip])
    };
    let mut turned = borders;
    order
        .into_iter()
        .zip(borders)
        .for_each(|(at, border)| turned[at] = border);
    (quarter, turned)
}

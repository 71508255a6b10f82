//! Bézier nets as the search sees them, whatever their degree.

use super::borders::{Borders, Corner, INSIDE, corner};
use super::deviation::Deviation;
use super::greater;
use super::hull_points::{DeviationBound, HullPoint};
use crate::patch::bezier_triangle::BezierTriangle;
use crate::patch::sextic::{SEXTIC_EDGES, SEXTIC_INNER, SexticTriangle};
use smallvec::SmallVec;

/// A triangular net whose hull holds a piece, and the nets of its edges the curves over them.
pub(super) trait Net<P: HullPoint>: Sized {
    /// How often corners are arguments of a point's blossom.
    const DEGREE: usize;

    fn corners(&self) -> [P; 3];

    /// The points b_ijk, i + j + k being the degree, by k, then by j.
    fn points(&self) -> &[P];

    /// Both halves, cut from the middle of an edge.
    fn halves(&self, edge: usize) -> [Self; 2];

    /// The deviation of its points, and a height that the piece itself attains.
    fn deviation(&self, bound: &DeviationBound<'_, P>, borders: Borders) -> (Deviation, f64);
}

impl<P: HullPoint> Net<P> for BezierTriangle<P> {
    const DEGREE: usize = 4;

    fn points(&self) -> &[P] {
        &self.0
    }

    fn corners(&self) -> [P; 3] {
        self.corners()
    }

    fn halves(&self, edge: usize) -> [Self; 2] {
        self.halves(edge)
    }

    fn deviation(&self, bound: &DeviationBound<'_, P>, borders: Borders) -> (Deviation, f64) {
        bound.net(self, borders)
    }
}

impl<P: HullPoint> Net<P> for SexticTriangle<P> {
    const DEGREE: usize = 6;

    fn points(&self) -> &[P] {
        &self.0
    }

    fn corners(&self) -> [P; 3] {
        self.corners()
    }

    fn halves(&self, edge: usize) -> [Self; 2] {
        self.halves(edge)
    }

    fn deviation(&self, bound: &DeviationBound<'_, P>, borders: Borders) -> (Deviation, f64) {
        let mut inner: SmallVec<[P; 28]> = SEXTIC_INNER.iter().map(|&at| self.0[at]).collect();
        let mut curves = SmallVec::<[(usize, P); 24]>::new();
        for (edge, own) in SEXTIC_EDGES.iter().enumerate() {
            let border = borders[edge];
            let points = own[1..6].iter().map(|&at| self.0[at]);
            match border {
                INSIDE => inner.extend(points),
                _ => curves.extend(points.map(|point| (usize::from(border), point))),
            }
            match corner(borders, edge) {
                Corner::Own => {}
                Corner::On(border) => curves.push((border, self.0[own[0]])),
                Corner::Inside => inner.push(self.0[own[0]]),
            }
        }
        let heights = self.middles().map(|point| point.height(bound.frame).abs());
        let attained = heights.into_iter().fold(0.0, greater);
        (bound.points(&inner, &curves), attained)
    }
}

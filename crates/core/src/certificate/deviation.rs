//! How far a triangle and its piece of the surface can be from each other, in the parts that the bounds of [`super::bounds`] are made of.

use super::greater;
use crate::criterion::Apart;
use crate::vector::hypotenuse;

/// The square of the greatest chord of the angle between neighbours that help each other, 2√3: 137°. Where they meet in
/// a sharper fold, both may reach beyond the surface (see [`super::bounds`]).
pub(super) const SHARPEST: f64 = 3.464;

/// How far a triangle and its piece of the surface can be from each other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Deviation {
    /// The bound that needs no neighbours.
    pub(crate) own: f64,
    /// The greatest height over the triangle's plane, and distance to edges without a neighbour.
    pub(crate) height: f64,
    /// The greatest height of the curves over edges with a neighbour, and of what reaches over these, by edge.
    pub(crate) edge_heights: [f64; 3],
    /// How far that reaches over them.
    pub(crate) displacements: [f64; 3],
    /// The greatest ratio of that to the distance from the edge's ends, by edge.
    pub(crate) slopes: [f64; 3],
    /// How much of the height may point in any direction rather than along normals.
    pub(crate) across: f64,
    /// How far points near corners that were moved may be, and how far these were moved along the plane.
    pub(crate) at_corners: f64,
    pub(crate) aside: f64,
}

/// The greater of each.
fn greater_each(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|edge| greater(a[edge], b[edge]))
}

impl Deviation {
    /// The greater of each.
    pub(crate) fn max(self, other: Self) -> Self {
        Self {
            own: greater(self.own, other.own),
            height: greater(self.height, other.height),
            edge_heights: greater_each(self.edge_heights, other.edge_heights),
            displacements: greater_each(self.displacements, other.displacements),
            slopes: greater_each(self.slopes, other.slopes),
            across: greater(self.across, other.across),
            at_corners: greater(self.at_corners, other.at_corners),
            aside: greater(self.aside, other.aside),
        }
    }

    /// The deviation of a piece at this distance from the triangle, its curves from their edges,
    /// without its neighbours.
    pub(crate) fn alone(own: f64) -> Self {
        Self {
            own,
            height: own,
            edge_heights: [own; 3],
            displacements: [0.0; 3],
            slopes: [0.0; 3],
            across: own,
            at_corners: 0.0,
            aside: 0.0,
        }
    }

    /// The deviation of a triangle whose corners were moved off the surface by up to `moved`, up to
    /// `aside` of that along its plane.
    ///
    /// At such a corner the projections on the planes around it lie up to `aside` from it, and up
    /// to twice that apart; points near it that they leave uncovered are that far from the
    /// projection of the surface's corner. Curves may reach by `aside` over other edges there.
    ///
    /// What a point of a curve counts is a convex function of it: greatest at a corner, or at another of the points whose heights are known.
    pub(crate) fn off(self, moved: f64, aside: f64) -> Self {
        if moved == 0.0 {
            return self;
        }
        let farther = |height: f64| hypotenuse(height, 2.0 * aside);
        let height = farther(greater(self.height, moved));
        let across = self.across + 2.0 * aside;
        Self {
            own: greater(self.own, moved),
            height,
            edge_heights: self.edge_heights.map(farther),
            displacements: self.displacements.map(|reach| reach + aside),
            across,
            at_corners: farther(moved),
            aside,
            ..self
        }
    }

    /// The deviation of a piece each of whose points is within `distance` of this one, and the
    /// other way round: so pieces at irregular vertices are bounded ([`super::bounds`]).
    pub(crate) fn grown(self, distance: f64) -> Self {
        let Self {
            own,
            height,
            edge_heights,
            across,
            at_corners,
            ..
        } = self;
        Self {
            own: own + distance,
            height: height + distance,
            edge_heights: edge_heights.map(|height| height + distance),
            across: across + distance,
            at_corners: at_corners + distance,
            ..self
        }
    }

    /// The greatest of the slopes.
    #[inline]
    pub(crate) fn steepest(&self) -> f64 {
        self.slopes.into_iter().fold(0.0, greater)
    }

    /// Whether all slopes are known to be within limits.
    #[inline]
    pub(crate) fn is_within(&self, slopes: [f64; 3]) -> bool {
        (0..3).all(|edge| self.slopes[edge] <= slopes[edge])
    }

    /// The bound where the neighbours' planes are turned by angles with these chords (2 sin(θ/2)) at most, and `slopes`
    /// are the greatest that are allowed, by edge.
    #[inline]
    pub(crate) fn bound(&self, chords: [f64; 3], slopes: [f64; 3]) -> f64 {
        self.among_neighbours(chords, slopes)
            .map_or(self.own, |bound| self.own.min(bound))
    }

    /// The part of the bound that takes help of the neighbours; `None` where they can't help.
    #[inline]
    fn among_neighbours(&self, chords: [f64; 3], slopes: [f64; 3]) -> Option<f64> {
        let can_help =
            self.is_within(slopes) && chords.iter().all(|chord| chord * chord <= SHARPEST);
        let at_edge = |edge: usize| {
            let (chord, height) = (chords[edge], self.edge_heights[edge].min(self.height));
            let times = 1.0 + 0.5 * chord * chord;
            let inside = height * times + chord * self.displacements[edge];
            greater(inside, self.at_corners * times + chord * self.aside)
        };
        can_help.then(|| (0..3).map(at_edge).fold(self.height, greater))
    }

    /// The height for which that would be no more than this.
    pub(crate) fn height_within(&self, limit: f64, chords: [f64; 3]) -> f64 {
        let by_edge = (0..3).map(|edge| {
            let chord = chords[edge];
            let most = (limit - chord * self.displacements[edge]) / (1.0 + 0.5 * chord * chord);
            if self.edge_heights[edge] <= most {
                limit
            } else {
                most
            }
        });
        by_edge.fold(limit, f64::min)
    }

    /// The bounds with and without neighbours, and which part of the former is along normals.
    ///
    /// The distance along normals is the part that stems from heights over the planes of the
    /// triangle and its neighbours and from tangential displacements over edges between them: the
    /// point that covers a point is within [`super::bounds`]' |h| + σg along the normals of both
    /// planes and the chord between them; and where it is a strip that covers, at most the tangent
    /// of half their angle outside, all within that angle of the triangle's own normal or counted
    /// as little.
    pub(crate) fn apart(&self, chords: [f64; 3], slopes: [f64; 3]) -> Apart {
        let bound = self
            .among_neighbours(chords, slopes)
            .unwrap_or(f64::INFINITY);
        let across = if bound.is_finite() {
            self.across.min(bound)
        } else {
            self.own
        };
        let height = if bound.is_finite() {
            bound - across
        } else {
            0.0
        };
        Apart {
            own: self.own,
            height,
            across,
        }
    }
}

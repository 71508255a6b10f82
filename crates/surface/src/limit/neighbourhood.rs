//! The canonical neighbourhood of a vertex and its refinement: the ring matrix S (the paper's equation 3) of any
//! scheme, from its masks alone.
//!
//! The central vertex has the ring shape in question; every other vertex is regular, as all vertices around it
//! are after one refinement. Where edges at the vertex are sharp, they go on straight beyond their other ends, and
//! so do the rows. Points are numbered as follows, with k the valence and f the number of faces:
//!
//! ```text
//! 0                 the vertex V
//! 1 … k             its ring P_j, counter-clockwise
//! k+1 … 2k          the points C_j beyond P_j on the line V P_j       (two-ring schemes only)
//! 2k+1 … 2k+f       the points M_j opposite V across the edge P_j P_{j+1}   (two-ring schemes only)
//! ```
//!
//! After refinement these points are: V moved, the edge points of the spokes V P_j, the P_j moved,
//! and the edge points of the link edges P_j P_{j+1}.

use super::LimitError;
use crate::masks::views::{LabelledRing, edge_views, vertex_views};
use crate::ring::{RingShape, SharpRing};
use crate::scheme::{Family, Scheme, Support};

/// How far the weights of a mask may sum from 1: rounding of a thousand weights stays well below.
const SUM_TOLERANCE: f64 = 1e-10;

/// Weights below this are rounding noise of the scheme's formulas (a sine of π, say) and count as zero: they
/// would otherwise tie points together that do not depend on one another.
const NOISE: f64 = 1e-14;

/// A vertex with regular surroundings, seen by one scheme.
pub(super) struct Neighbourhood<'s> {
    pub(super) scheme: &'s dyn Scheme,
    /// The shape of the ring; where it is cut into sectors, that of all of it.
    pub(super) shape: RingShape,
    pub(super) support: Support,
    /// The ring with the sharpness of its edges.
    sharp: SharpRing,
}

impl<'s> Neighbourhood<'s> {
    /// The neighbourhood of a vertex with the ring `shape`, as large as the scheme's support.
    ///
    /// # Errors
    /// The ring has fewer than two edges, or is closed and so long that indices overflow.
    pub(crate) fn new(scheme: &'s dyn Scheme, shape: RingShape) -> Result<Self, LimitError> {
        if shape.valence < 2 || shape.valence > u32::MAX / 4 {
            let what = format!(
                "a ring has at least two edges (and at most {}), not {}",
                u32::MAX / 4,
                shape.valence
            );
            return Err(LimitError::unsuitable(scheme, shape, what));
        }
        Ok(Self {
            scheme,
            shape,
            support: scheme.support(),
            sharp: SharpRing::of(shape),
        })
    }

    /// The neighbourhood of a vertex whose edges have some sharpness.
    ///
    /// # Errors
    /// Those of [`Self::new`].
    pub(super) fn of_sharp(scheme: &'s dyn Scheme, sharp: SharpRing) -> Result<Self, LimitError> {
        let shape = RingShape {
            open: sharp.open,
            ..RingShape::interior(sharp.spokes.len() as u32)
        };
        Ok(Self {
            sharp,
            ..Self::new(scheme, shape)?
        })
    }

    pub(super) fn valence(&self) -> usize {
        self.shape.valence as usize
    }

    /// Number of points, the vertex included.
    pub(super) fn len(&self) -> usize {
        match self.support {
            Support::OneRing => 1 + self.valence(),
            Support::TwoRing => 1 + 2 * self.valence() + self.shape.faces() as usize,
        }
    }

    fn ring_point(&self, j: usize) -> usize {
        1 + j % self.valence()
    }

    fn beyond(&self, j: usize) -> usize {
        1 + self.valence() + j % self.valence()
    }

    fn across(&self, j: usize) -> usize {
        1 + 2 * self.valence() + j % self.valence()
    }

    /// Points on the boundary curve through the vertex; none in a closed ring.
    pub(super) fn is_on_boundary(&self, point: usize) -> bool {
        let last = self.valence() - 1;
        self.shape.open
            && (point == 0
                || [0, last]
                    .iter()
                    .any(|&j| point == self.ring_point(j) || point == self.beyond(j)))
    }

    /// The ring of the vertex.
    fn central_ring(&self) -> LabelledRing<usize> {
        let neighbours = (0..self.valence()).map(|j| self.ring_point(j)).collect();
        LabelledRing {
            centre: 0,
            neighbours,
            sharp: self.sharp.clone(),
        }
    }

    /// The ring of P_j, and in it the slots of V, of P_{j−1} and of P_{j+1}.
    fn outer_ring(&self, j: usize) -> (LabelledRing<usize>, [usize; 3]) {
        let k = self.valence();
        let (previous, next) = (j + k - 1, j + 1);
        let centre = self.ring_point(j);
        let on_boundary = SharpRing::of(RingShape::boundary(4));
        if self.shape.open && j == 0 {
            let neighbours = vec![self.beyond(0), self.across(0), self.ring_point(1), 0];
            return (
                LabelledRing {
                    centre,
                    neighbours,
                    sharp: on_boundary,
                },
                [3, 3, 2],
            );
        }
        if self.shape.open && j == k - 1 {
            let neighbours = vec![
                0,
                self.ring_point(previous),
                self.across(previous),
                self.beyond(j),
            ];
            return (
                LabelledRing {
                    centre,
                    neighbours,
                    sharp: on_boundary,
                },
                [0, 1, 0],
            );
        }
        let neighbours = vec![
            0,
            self.ring_point(previous),
            self.across(previous),
            self.beyond(j),
            self.across(j),
            self.ring_point(next),
        ];
        // A sharp edge goes on beyond its end.
        let spoke = self.sharp.spokes[j];
        let spokes = vec![spoke, 0.0, 0.0, spoke, 0.0, 0.0];
        let sharp = SharpRing {
            open: false,
            vertex: 0.0,
            spokes,
        };
        (
            LabelledRing {
                centre,
                neighbours,
                sharp,
            },
            [0, 1, 5],
        )
    }

    /// Row `point` of S: the weights of that point after refinement, over all points.
    ///
    /// # Errors
    /// The mask has a wrong size, weights that are not finite or do not sum to 1, or reaches outside the
    /// neighbourhood.
    pub(super) fn row(&self, point: usize) -> Result<Vec<f64>, LimitError> {
        let k = self.valence();
        match point {
            0 => self.vertex_row(&self.central_ring()),
            _ if point <= k => {
                let (outer, [to_centre, ..]) = self.outer_ring(point - 1);
                self.edge_row((&self.central_ring(), point - 1), (&outer, to_centre))
            }
            _ if point <= 2 * k => self.vertex_row(&self.outer_ring(point - 1 - k).0),
            _ => {
                let j = point - 1 - 2 * k;
                let (from, [_, _, to_next]) = self.outer_ring(j);
                let (to, [_, to_previous, _]) = self.outer_ring((j + 1) % k);
                self.edge_row((&from, to_next), (&to, to_previous))
            }
        }
    }

    /// Weights on the points after a refinement, as weights on those before it.
    ///
    /// # Errors
    /// Those of [`Self::row`].
    pub(super) fn pulled_back(&self, weights: &[f64]) -> Result<Vec<f64>, LimitError> {
        let mut before = vec![0.0; weights.len()];
        let is_family = matches!(self.scheme.family(), Some(Family::Loop(_)));
        for (point, &weight) in weights
            .iter()
            .enumerate()
            .filter(|&(_, &weight)| weight != 0.0)
        {
            if is_family && point > 0 {
                // Rings of very many edges have no room for whole rows.
                self.spoke_row(point - 1)
                    .into_iter()
                    .for_each(|(at, entry)| before[at] += weight * entry);
            } else {
                before
                    .iter_mut()
                    .zip(self.row(point)?)
                    .for_each(|(sum, entry)| *sum += weight * entry);
            }
        }
        Ok(before)
    }

    /// The non-zero weights of the new point on the edge to P_j, by the masks of the Loop family.
    fn spoke_row(&self, j: usize) -> [(usize, f64); 4] {
        let k = self.valence();
        let is_boundary = self.shape.open && (j == 0 || j + 1 == k);
        let sharp = if is_boundary {
            1.0
        } else {
            self.sharp.spokes[j].clamp(0.0, 1.0)
        };
        let (ends, others) = (sharp * 0.5 + (1.0 - sharp) * 0.375, (1.0 - sharp) * 0.125);
        let [at, previous, next] = [j, j + k - 1, j + 1].map(|j| self.ring_point(j));
        [(0, ends), (at, ends), (previous, others), (next, others)]
    }

    fn vertex_row(&self, ring: &LabelledRing<usize>) -> Result<Vec<f64>, LimitError> {
        let mut row = vec![0.0; self.len()];
        let mut outside = None;
        for (share, view) in vertex_views(ring) {
            let mask = self.scheme.vertex_mask(view.shape);
            let (size, expected) = (mask.ring.len(), view.neighbours.len());
            if size != expected {
                let shape = view.shape;
                return Err(self.unsuitable(format!(
                    "the vertex mask at {shape:?} has {size} weights, expected {expected}"
                )));
            }
            for (point, weight) in view.weighted(mask.centre, &mask.ring) {
                self.add(&mut row, &mut outside, point, share * weight);
            }
        }
        self.checked(row, outside)
    }

    fn edge_row(
        &self,
        origin: (&LabelledRing<usize>, usize),
        target: (&LabelledRing<usize>, usize),
    ) -> Result<Vec<f64>, LimitError> {
        let mut row = vec![0.0; self.len()];
        let mut outside = None;
        for (share, view) in edge_views(origin, target) {
            let mask = self.scheme.edge_mask(view.shape);
            let sizes = [mask.origin_ring.len(), mask.target_ring.len()];
            let expected = [view.origin.neighbours.len(), view.target.neighbours.len()];
            if sizes != expected {
                let shape = view.shape;
                return Err(self.unsuitable(format!(
                    "the mask of {shape:?} has {sizes:?} weights, expected {expected:?}"
                )));
            }
            let at_origin = view.origin.weighted(mask.origin, &mask.origin_ring);
            for (point, weight) in
                at_origin.chain(view.target.weighted(mask.target, &mask.target_ring))
            {
                self.add(&mut row, &mut outside, point, share * weight);
            }
        }
        self.checked(row, outside)
    }

    fn add(&self, row: &mut [f64], outside: &mut Option<f64>, point: usize, weight: f64) {
        match row.get_mut(point) {
            Some(slot) => *slot += weight,
            None if weight.abs() > NOISE => *outside = Some(weight),
            None => {}
        }
    }

    fn checked(&self, mut row: Vec<f64>, outside: Option<f64>) -> Result<Vec<f64>, LimitError> {
        if let Some(weight) = outside {
            let what = format!(
                "an edge mask has the weight {weight} outside the one-ring, but the support is OneRing"
            );
            return Err(self.unsuitable(what));
        }
        let sum: f64 = row.iter().sum();
        if sum.is_nan() || (sum - 1.0).abs() > SUM_TOLERANCE {
            return Err(self.unsuitable(format!("the weights of a mask sum to {sum}, expected 1")));
        }
        for weight in row.iter_mut().filter(|weight| weight.abs() <= NOISE) {
            *weight = 0.0;
        }
        Ok(row)
    }

    pub(super) fn unsuitable(&self, what: impl Into<String>) -> LimitError {
        LimitError::unsuitable(self.scheme, self.shape, what)
    }
}

/// The ring matrix S of `scheme` around a vertex of the given shape (the paper's equation 3), row by row: new
/// points as weights of the old ones, the vertex first, then its ring counter-clockwise.
///
/// For a scheme with [`Support::TwoRing`] there follow the points beyond the ring's (one for each edge) and those
/// across the ring's edges (one for each face).
///
/// # Errors
/// The masks have wrong sizes, do not sum to 1 or reach farther than the scheme's support.
pub fn ring_matrix(scheme: &dyn Scheme, shape: RingShape) -> Result<Vec<Vec<f64>>, LimitError> {
    let neighbourhood = Neighbourhood::new(scheme, shape)?;
    (0..neighbourhood.len())
        .map(|point| neighbourhood.row(point))
        .collect()
}

/// The difference matrix D (the paper's equation 6) of a ring matrix: `D[i][j] = S[i+1][j+1] − S[0][j+1]`, acting
/// on the differences of the points to the vertex.
pub fn difference_matrix(ring_matrix: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let Some((centre, rest)) = ring_matrix.split_first() else {
        return Vec::new();
    };
    rest.iter()
        .map(|row| {
            row.iter()
                .zip(centre)
                .skip(1)
                .map(|(&a, &b)| a - b)
                .collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scheme::{Loop, LoopWarren};

    /// The short rows are those that the family's masks give.
    #[test]
    fn spoke_rows_are_those_of_the_masks() {
        let sharpness = [0.0, 0.3, 1.0, 1.6, f64::INFINITY];
        for case in 0..400usize {
            let (k, open, scheme) = (
                3 + case % 7,
                case % 3 == 0,
                if case % 2 == 0 { &Loop } else { &LoopWarren },
            );
            let spokes = (0..k).map(|j| match case % 5 {
                0 => 0.0,
                _ => sharpness[(case / 5 + j * j * (1 + case % 4)) % 5],
            });
            let mut sharp = SharpRing {
                open,
                vertex: 0.0,
                spokes: spokes.collect(),
            };
            if open {
                (sharp.spokes[0], sharp.spokes[k - 1]) = (f64::INFINITY, f64::INFINITY);
            }
            let neighbourhood = Neighbourhood::of_sharp(scheme, sharp.clone()).unwrap();
            for j in 0..k {
                let mut row = vec![0.0; k + 1];
                neighbourhood
                    .spoke_row(j)
                    .into_iter()
                    .for_each(|(at, entry)| row[at] += entry);
                for (found, expected) in row.iter().zip(neighbourhood.row(1 + j).unwrap()) {
                    assert!(
                        (found - expected).abs() < 1e-15,
                        "{sharp:?}, {j}: {found} {expected}"
                    );
                }
            }
        }
    }
}

//! What is looked at of control faces: the leaves that pass on conditions, with those around them.
//!
//! An area is kept as cells of a grid over the face's domain, which hold it and more. What is beside a leaf is at most twice as large
//! (neighbouring leaves are at most a level apart), so two of the leaf's own sizes around it hold all triangles that share an edge with
//! its own, also across an edge of the control face.

use std::collections::BTreeMap;

use super::quadtree::{Edges, Place};
use crate::patch::Spot;

/// Cells of the grid along u and along v.
const CELLS: u32 = u32::BITS;

/// A part of a control face's domain.
#[derive(Clone, Default)]
pub(super) struct Area {
    /// By cell along v, a bit for each along u.
    rows: [u32; CELLS as usize],
}

/// The parts of control faces that are looked at, by face.
#[derive(Default)]
pub(super) struct Areas(pub(super) BTreeMap<u32, Area>);

/// The cells that hold what is no farther from some points, along u and along v, than given: the rows, and the bits in each.
fn cells<const N: usize>(
    points: [[f64; 2]; N],
    around: f64,
) -> (core::ops::RangeInclusive<usize>, u32) {
    let cell = |at: f64| ((at * f64::from(CELLS)).max(0.0) as u32).min(CELLS - 1);
    let [u, v] = [0, 1].map(|axis| {
        let along = points.map(|point| point[axis]);
        let (least, most) = (
            along.into_iter().fold(f64::INFINITY, f64::min),
            along.into_iter().fold(0.0, f64::max),
        );
        [cell(least - around), cell(most + around)]
    });
    (
        v[0] as usize..=v[1] as usize,
        (u32::MAX << u[0]) & (u32::MAX >> (CELLS - 1 - u[1])),
    )
}

impl Area {
    /// Adds what is no farther from some points, along u and along v, than given.
    fn add<const N: usize>(&mut self, points: [[f64; 2]; N], around: f64) {
        let (rows, bits) = cells(points, around);
        self.rows[rows].iter_mut().for_each(|row| *row |= bits);
    }

    /// Whether the rectangle around some points may meet it.
    pub(super) fn meets<const N: usize>(&self, points: [[f64; 2]; N]) -> bool {
        let (rows, bits) = cells(points, 0.0);
        self.rows[rows].iter().any(|row| row & bits != 0)
    }

    /// How much of the face that is at most.
    pub(super) fn share(&self) -> f64 {
        let cells: u32 = self.rows.iter().map(|row| row.count_ones()).sum();
        (2.0 * f64::from(cells) / f64::from(CELLS * CELLS)).min(1.0)
    }
}

impl Areas {
    /// Adds a leaf and what is beside it, also in the faces beyond the control edges that are not `open`.
    pub(super) fn add(&mut self, edges: &Edges<'_>, place: Place, open: [bool; 3]) {
        let spot = (0..place.level).fold(Spot::WHOLE, |spot, level| spot.child(place.digit(level)));
        let (corners, around) = (spot.corners(), 2.0 * spot.size.abs());
        self.0.entry(place.face).or_default().add(corners, around);
        for edge in (0..3).filter(|&edge| !open[edge] && place.lies_along(edge)) {
            let Some(beyond) = edges.twin(3 * place.face + edge as u32) else {
                continue;
            };
            // The edge runs the other way there.
            let [from, to] = [edge, (edge + 1) % 3].map(|corner| {
                let [u, v] = corners[corner];
                1.0 - [u, v, 1.0 - v][edge]
            });
            let ends = [from, to].map(|at| Spot::WHOLE.along(beyond as usize % 3, at));
            self.0.entry(beyond / 3).or_default().add(ends, around);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// By brute force over places.
    #[test]
    fn an_area_holds_what_was_added() {
        let mut random = Random::new(3);
        let mut left_out = 0;
        for _ in 0..300 {
            let mut area = Area::default();
            let added: Vec<([f64; 2], f64)> = (0..3)
                .map(|_| ([random.unit(), random.unit()], 0.1 * random.unit()))
                .collect();
            added
                .iter()
                .for_each(|&(at, around)| area.add([at], around));
            for _ in 0..50 {
                let at = [random.unit(), random.unit()];
                let is_in = |&([u, v], around): &([f64; 2], f64)| {
                    (at[0] - u).abs() <= around && (at[1] - v).abs() <= around
                };
                let is_held = area.meets([at]);
                assert!(is_held || !added.iter().any(is_in), "{at:?}, {added:?}");
                left_out += usize::from(!is_held);
            }
        }
        assert!(left_out > 10_000, "{left_out}");
    }
}

//! The position of a piece's edges and corners relative to its triangle.

use crate::patch::bezier_triangle::{EDGES, INNER};

/// For each edge of a piece the edge of the triangle that it is part of, or [`INSIDE`].
pub(super) type Borders = [u8; 3];

/// The edge lies inside the triangle's piece of surface.
pub(super) const INSIDE: u8 = 3;

/// The piece of the whole triangle.
pub(super) const ALL: Borders = [0, 1, 2];

/// The position of a piece's corner relative to the triangle.
#[derive(Clone, Copy)]
pub(super) enum Corner {
    /// One of its own, which lies on the surface.
    Own,
    /// A point of the curve over an edge.
    On(usize),
    /// A point like others.
    Inside,
}

/// The position of the corner at which an edge of a piece starts.
#[inline]
pub(super) fn corner(borders: Borders, edge: usize) -> Corner {
    match (borders[(edge + 2) % 3], borders[edge]) {
        (INSIDE, INSIDE) => Corner::Inside,
        (INSIDE, on) | (on, INSIDE) => Corner::On(on as usize),
        (last, next) if last == next => Corner::On(next as usize),
        _ => Corner::Own,
    }
}

/// The points of a piece's net that bound the surface rather than its curve over an edge of the
/// triangle, one bit each.
#[inline]
pub(super) fn inner_points(borders: Borders) -> u16 {
    let inside = (0..3).fold(0, |bits, edge| {
        bits | usize::from(borders[edge] == INSIDE) << edge
    });
    INNER_POINTS[inside]
}

/// These points by which edges are [`INSIDE`], one bit each.
const INNER_POINTS: [u16; 8] = {
    let mut all = [0; 8];
    let mut inside = 0;
    while inside < 8 {
        all[inside] = 1 << INNER[0] | 1 << INNER[1] | 1 << INNER[2];
        let mut edge = 0;
        while edge < 3 {
            let [start, second, middle, fourth, _] = EDGES[edge];
            if inside & 1 << edge != 0 {
                all[inside] |= 1 << second | 1 << middle | 1 << fourth;
                if inside & 1 << ((edge + 2) % 3) != 0 {
                    all[inside] |= 1 << start;
                }
            }
            edge += 1;
        }
        inside += 1;
    }
    all
};

//! Few parts of a regular piece, tested together, one after the other instead of row by row: short
//! rows would be mostly empty.

use core::array::from_fn;

use super::super::quartic_cell::quadratic;
use super::RowBlock;
use super::part_bounds::{Parts, Slices, above};
use crate::vector::{DVec3, Extremes};

/// Divisions that give so few parts that rows of them would be mostly empty.
pub(super) const FEW_DIVISIONS: u32 = 2;

/// The parts that these give.
pub(super) const FEW: usize = 1 << (2 * FEW_DIVISIONS);

/// Their corners, with room for a whole register.
const FEW_CORNERS: usize = 16;

/// Numbers by axis and part.
type Few = [[f32; FEW]; 3];

/// Numbers by axis and corner of few parts.
type Corners = [[f64; FEW_CORNERS]; 3];

/// Few parts, one after the other instead of row by row: all upright ones, then the inverted ones.
#[derive(Default)]
pub(super) struct FewParts {
    edges: [Few; 2],
    normals: [Few; 3],
    bends: [Few; 3],
    /// A bound of the sums of the absolute coordinates.
    size: f32,
    /// Column, row, and whether the part is inverted.
    pub(super) places: [(usize, usize, bool); FEW],
}

impl FewParts {
    /// The parts of a node whose edges are cut into n, in a unit that makes so much of lengths.
    pub(super) fn fill(&mut self, block: &RowBlock<'_>, n: usize, scale: f64) {
        let step = block.size / n as f64;
        let [mut u, mut v] = block.at.map(|at| [at; FEW_CORNERS]);
        let mut count = 0;
        for j in 0..=n {
            for i in 0..=n - j {
                (u[count], v[count]) =
                    (block.at[0] + step * i as f64, block.at[1] + step * j as f64);
                count += 1;
            }
        }
        let [mut points, mut normals] = [[[0.0; FEW_CORNERS]; 3]; 2];
        let fours = u
            .as_chunks::<4>()
            .0
            .iter()
            .zip(v.as_chunks::<4>().0)
            .enumerate();
        for (four, (u, v)) in fours.take(count.div_ceil(4)) {
            let [at, normal] = block.piece.points_and_normals_at(u, v);
            for axis in 0..3 {
                points[axis][4 * four..4 * four + 4].copy_from_slice(&at[axis]);
                normals[axis][4 * four..4 * four + 4].copy_from_slice(&normal[axis]);
            }
        }
        let corner = |i: usize, j: usize| j * (n + 1) - j * j.saturating_sub(1) / 2 + i;
        let mut number = 0;
        for j in 0..n {
            for i in 0..n - j {
                self.places[number] = (i, j, false);
                self.set_corners(
                    number,
                    [corner(i, j), corner(i + 1, j), corner(i, j + 1)],
                    &points,
                    &normals,
                    scale,
                );
                number += 1;
            }
        }
        self.set_bends(block, step, scale, number, [&u, &v], corner);
        let upright = |i: usize, j: usize| j * n - j * j.saturating_sub(1) / 2 + i;
        for j in 0..n - 1 {
            for i in 0..n - 1 - j {
                self.places[number] = (i, j, true);
                self.set_corners(
                    number,
                    [corner(i + 1, j + 1), corner(i, j + 1), corner(i + 1, j)],
                    &points,
                    &normals,
                    scale,
                );
                let adjacent = [upright(i, j + 1), upright(i, j), upright(i + 1, j)];
                for (bends, from) in self.bends.iter_mut().zip(adjacent) {
                    bends
                        .iter_mut()
                        .for_each(|bends| bends[number] = bends[from]);
                }
                number += 1;
            }
        }
    }

    fn set_corners(
        &mut self,
        number: usize,
        corners: [usize; 3],
        points: &Corners,
        normals: &Corners,
        scale: f64,
    ) {
        for axis in 0..3 {
            let [first, second, third] = corners.map(|corner| points[axis][corner]);
            self.edges[0][axis][number] = ((second - first) * scale) as f32;
            self.edges[1][axis][number] = ((third - first) * scale) as f32;
            for (own, &corner) in self.normals.iter_mut().zip(&corners) {
                own[axis][number] = normals[axis][corner] as f32;
            }
        }
    }

    /// The second derivatives along the edges of the upright parts, of which there are `number`.
    fn set_bends(
        &mut self,
        block: &RowBlock<'_>,
        step: f64,
        scale: f64,
        number: usize,
        [u, v]: [&[f64; FEW_CORNERS]; 2],
        corner: impl Fn(usize, usize) -> usize,
    ) {
        let [uu, uv, vv] = block.jet.second();
        let across: [DVec3; 6] = from_fn(|i| uu[i] - 2.0 * uv[i] + vv[i]);
        self.size = 0.0;
        let edges = [(uu, [0.5, 0.0]), (&across, [0.5, 0.5]), (vv, [0.0, 0.5])];
        for (at, &(i, j, _)) in self.places.iter().enumerate().take(number) {
            let first = corner(i, j);
            for (edge, (derivative, [s, t])) in edges.iter().enumerate() {
                let place = [u[first] + s * step, v[first] + t * step];
                let bend = quadratic(derivative, place) * (step * step * scale);
                self.size = self.size.larger(above(bend.abs().element_sum()));
                for axis in 0..3 {
                    self.bends[edge][axis][at] = bend[axis] as f32;
                }
            }
        }
    }

    pub(super) fn parts(&self) -> Parts<'_> {
        Parts {
            edges: self.edges.each_ref().map(slices),
            is_turned: false,
            normals: self.normals.each_ref().map(slices),
            bends: self.bends.each_ref().map(slices),
            size: self.size,
        }
    }
}

fn slices([x, y, z]: &Few) -> Slices<'_> {
    [x, y, z]
}

//! The surface of an implicit body, by marching tetrahedra on a grid.
//!
//! Each cell is cut into the six tetrahedra around its diagonal (Kuhn's subdivision), which match across cells, so
//! the result is manifold whatever the field does between the nodes.

use super::{Field, Surface};
use glam::DVec3;

/// A grid of cubical cells that starts in the plane x = 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    low: DVec3,
    cell: f64,
    cells: [usize; 3],
}

impl Grid {
    /// The grid with cells of edge `cell` that covers x from 0 to `high.x`, y and z from `low` to `high`.
    pub(crate) fn new(low: [f64; 2], high: [f64; 3], cell: f64) -> Self {
        let low = DVec3::new(0.0, low[0], low[1]);
        let cells = ((DVec3::from_array(high) - low) / cell)
            .ceil()
            .to_array()
            .map(|n| n as usize);
        Self { low, cell, cells }
    }

    fn position(&self, [x, y, z]: [usize; 3]) -> DVec3 {
        self.low + DVec3::new(x as f64, y as f64, z as f64) * self.cell
    }

    fn node(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * (self.cells[1] + 1) + y) * (self.cells[0] + 1) + x
    }
}

/// Crossings keep this far (as a part of the edge) from the nodes, so that no triangle shrinks to nothing; the
/// vertices are put on the surface exactly once the mesh is coarse.
const LEAST_PART: f64 = 0.15;

/// The six chains of cell corners from 0 to 7 (bits x, y, z); each is a tetrahedron.
const CHAINS: [[usize; 4]; 6] = [
    [0, 1, 3, 7],
    [0, 2, 6, 7],
    [0, 4, 5, 7],
    [0, 3, 2, 7],
    [0, 6, 4, 7],
    [0, 5, 1, 7],
];

struct Contour<'a> {
    grid: &'a Grid,
    values: Vec<f64>,
    /// The vertex on the edge from each node in each of the seven directions, `u32::MAX` before it is made.
    crossings: Vec<[u32; 7]>,
    surface: Surface,
}

/// The surface where `field` is zero, oriented outwards, open only where the grid cuts it.
pub(super) fn contour(field: Field<'_>, grid: &Grid) -> Surface {
    let [nx, ny, nz] = grid.cells;
    let mut values = Vec::with_capacity((nx + 1) * (ny + 1) * (nz + 1));
    for z in 0..=nz {
        for y in 0..=ny {
            values.extend((0..=nx).map(|x| field(grid.position([x, y, z]))));
        }
    }
    let crossings = vec![[u32::MAX; 7]; values.len()];
    let mut contour = Contour {
        grid,
        values,
        crossings,
        surface: Surface::default(),
    };
    for z in 0..nz {
        for y in 0..ny {
            for x in 0..nx {
                contour.cell([x, y, z]);
            }
        }
    }
    contour.surface
}

impl Contour<'_> {
    fn cell(&mut self, cell: [usize; 3]) {
        let corners: [[usize; 3]; 8] =
            core::array::from_fn(|c| core::array::from_fn(|axis| cell[axis] + (c >> axis & 1)));
        let nodes = corners.map(|c| self.grid.node(c));
        let inside = nodes.map(|n| self.values[n] < 0.0);
        if inside == [inside[0]; 8] {
            return;
        }
        for chain in CHAINS {
            let mut sides = [Vec::new(), Vec::new()];
            chain
                .iter()
                .for_each(|&c| sides[usize::from(inside[c])].push(c));
            let [outer, inner] = sides;
            let mut vertex = |a: usize, b: usize| self.crossing(&corners, a.min(b), a.max(b));
            let polygon: Vec<u32> = match (&inner[..], &outer[..]) {
                (&[a], rest) => rest.iter().map(|&b| vertex(a, b)).collect(),
                (rest, &[b]) => rest.iter().map(|&a| vertex(a, b)).collect(),
                (&[a, b], &[c, d]) => vec![vertex(a, c), vertex(a, d), vertex(b, d), vertex(b, c)],
                _ => continue,
            };
            let centre = |side: &[usize]| {
                side.iter()
                    .map(|&c| self.grid.position(corners[c]))
                    .sum::<DVec3>()
                    / side.len() as f64
            };
            self.fan(&polygon, centre(&outer) - centre(&inner));
        }
    }

    /// Adds the polygon as triangles that look along `outwards`.
    fn fan(&mut self, polygon: &[u32], outwards: DVec3) {
        for i in 1..polygon.len() - 1 {
            let [a, b, c] = [polygon[0], polygon[i], polygon[i + 1]];
            let [p, q, r] = [a, b, c].map(|v| self.surface.positions[v as usize]);
            let faces_outwards = (q - p).cross(r - p).dot(outwards) > 0.0;
            self.surface
                .triangles
                .push(if faces_outwards { [a, b, c] } else { [a, c, b] });
        }
    }

    /// The vertex where the surface crosses the edge between two corners of a cell, `a` a subset of `b`.
    fn crossing(&mut self, corners: &[[usize; 3]; 8], a: usize, b: usize) -> u32 {
        let (node_a, node_b) = (self.grid.node(corners[a]), self.grid.node(corners[b]));
        let slot = &mut self.crossings[node_a][(a ^ b) - 1];
        if *slot == u32::MAX {
            let (value_a, value_b) = (self.values[node_a], self.values[node_b]);
            let part = (value_a / (value_a - value_b)).clamp(LEAST_PART, 1.0 - LEAST_PART);
            let position = self
                .grid
                .position(corners[a])
                .lerp(self.grid.position(corners[b]), part);
            *slot = self.surface.positions.len() as u32;
            self.surface.positions.push(position);
        }
        *slot
    }
}

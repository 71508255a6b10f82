//! The vertices of a region in the coordinates of its plane, and the areas of its triangles there.

use std::collections::HashMap;

use super::regions::Plane;
use crate::geometry::planar;
use crate::parallel::{IsStopped, asking};
use crate::vector::{DVec3, vector};

/// The vertices of a region in its plane.
pub(super) struct Flattened<'a> {
    plane: &'a Plane,
    axes: [DVec3; 2],
    off_plane: f64,
    positions: &'a [[f64; 3]],
    numbers: HashMap<u32, u32>,
    vertices: Vec<u32>,
    /// The greatest coordinate of a triangle's corner so far.
    size: f64,
}

impl<'a> Flattened<'a> {
    pub(super) fn new(plane: &'a Plane, off_plane: f64, positions: &'a [[f64; 3]]) -> Self {
        let along = plane.normal.any_orthonormal_vector();
        let axes = [along, plane.normal.cross(along)];
        Self {
            plane,
            axes,
            off_plane,
            positions,
            numbers: HashMap::new(),
            vertices: Vec::new(),
            size: 0.0,
        }
    }

    fn offset(&self, vertex: u32) -> DVec3 {
        vector(self.positions[vertex as usize]) - self.plane.point
    }

    fn at(&self, vertex: u32) -> [f64; 2] {
        let offset = self.offset(vertex);
        self.axes.map(|axis| axis.dot(offset))
    }

    /// Twice the area of a triangle, below zero where it is turned over; `None` where it is not in the plane.
    pub(super) fn area(&mut self, triangle: [u32; 3]) -> Option<f64> {
        let is_apart =
            |vertex: &u32| self.plane.normal.dot(self.offset(*vertex)).abs() > 1.5 * self.off_plane;
        if triangle.iter().any(is_apart) {
            return None;
        }
        let [[ax, ay], [bx, by], [cx, cy]] = triangle.map(|vertex| self.at(vertex));
        self.size = [ax, ay, bx, by, cx, cy]
            .into_iter()
            .fold(self.size, |size, x| size.max(x.abs()));
        Some((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))
    }

    /// Whether such an area is above zero, but for rounding.
    pub(super) fn is_positive(&self, area: f64) -> bool {
        // Rounding takes twice the area of a triangle below zero by no more than this part of the region's squared size.
        area >= -1e-14 * self.size * self.size
    }

    /// The number of a vertex among those of the region.
    pub(super) fn number(&mut self, vertex: u32) -> u32 {
        let next = self.vertices.len() as u32;
        let number = *self.numbers.entry(vertex).or_insert(next);
        if number == next {
            self.vertices.push(vertex);
        }
        number
    }

    /// Triangles that cover what lies to the left of rim edges, given by numbers, and twice their area; `None` where there are none, some are turned over, or
    /// vertices are left over, as beyond the rim.
    pub(super) fn triangulated(
        &mut self,
        rim: &[[u32; 2]],
        is_stopped: &IsStopped<'_>,
    ) -> Option<(Vec<[u32; 3]>, f64)> {
        let mut triangles = planar::triangulated(&self.points()?, rim, is_stopped)?;
        let (mut area, mut is_used) = (0.0, vec![false; self.vertices.len()]);
        for triangle in asking(&mut triangles, is_stopped) {
            triangle
                .iter()
                .for_each(|&number| is_used[number as usize] = true);
            *triangle = triangle.map(|number| self.vertices[number as usize]);
            area += self
                .area(*triangle)
                .filter(|&part| self.is_positive(part))?;
        }
        is_used
            .iter()
            .all(|&is_used| is_used)
            .then_some((triangles, area))
    }

    /// All of them, no coordinate greater than one; `None` where there is no telling them apart.
    fn points(&self) -> Option<Vec<[f64; 2]>> {
        let is_sized = self.size.is_normal();
        is_sized.then(|| {
            self.vertices
                .iter()
                .map(|&vertex| self.at(vertex).map(|x| x / self.size))
                .collect()
        })
    }
}

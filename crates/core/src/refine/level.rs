//! A level of detail: its mesh, its distance from the limit surface, and how it grows out of the
//! coarser one.

use super::exact_result::Exact;
use crate::math;
use crate::mesh::SplitSurface;
use crate::vector::vector;

/// One of several nested meshes of one surface.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Level {
    /// The mesh and its bounds. Control vertices keep their numbers on all levels.
    pub exact: Exact,
    /// The tolerance of its refinement.
    pub tolerance: f64,
    /// The greatest distance of a point of the limit surface from the point of the mesh with the
    /// same place on the control mesh: more than the distance between both, by a half and more. It
    /// also bounds how far a texture slides. Proven where
    /// [`ErrorBounds::certified`](super::ErrorBounds::certified) says so of the distance.
    pub parametric: f64,
    /// Its geomorph from the coarser level; `None` for the coarsest, and if not requested.
    pub geomorph: Option<Geomorph>,
}

/// The positions of a level's vertices on the coarser level (Hoppe's geomorph): the triangles of
/// the level, with its vertices there, are the coarser level's surface; moving them straight to the
/// level's own positions gives the level.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Geomorph {
    /// By vertex, its place on the coarser mesh.
    pub positions: Vec<[f64; 3]>,
    /// By vertex, the coarser mesh's normal there for shading: linear between the normals of its
    /// corners, not of unit length.
    pub normals: Vec<[f64; 3]>,
    /// The normals of triangles' corners at sharp edges, as in [`Exact::sides`].
    pub sides: Vec<(u32, [f64; 3])>,
    /// The distance of the mesh from the limit surface at the start, by place as in
    /// [`Level::parametric`].
    pub start: f64,
}

impl Level {
    /// The positions of the vertices at a moment of the geomorph, from 0 (the coarser level) to 1 (this one).
    pub fn positions_at(&self, t: f64) -> Vec<[f64; 3]> {
        let own = self.exact.mesh.positions();
        let Some(morph) = &self.geomorph else {
            return own.to_vec();
        };
        let between =
            |(from, to): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|i| (1.0 - t) * from[i] + t * to[i]);
        morph.positions.iter().zip(own).map(between).collect()
    }

    /// The greatest distance between mesh and limit surface, both ways and by place, at a moment of
    /// the geomorph (module [`levels_of_detail`](super::levels_of_detail()) has the proof).
    pub fn deviation_at(&self, t: f64) -> f64 {
        let start = self
            .geomorph
            .as_ref()
            .map_or(self.parametric, |morph| morph.start);
        (1.0 - t) * start + t * self.parametric
    }

    /// The mesh with a vertex for each side of sharp edges, each with its limit normal and, where there is a geomorph, with its own
    /// normal on the coarser level.
    pub fn split_surface(&self) -> (SplitSurface, Vec<[f64; 3]>) {
        let split = self.exact.split_surface();
        let Some(morph) = &self.geomorph else {
            return (split, Vec::new());
        };
        let mut normals: Vec<[f64; 3]> = split
            .sources
            .iter()
            .map(|&v| morph.normals[v as usize])
            .collect();
        for &(corner, normal) in &morph.sides {
            let vertex = split.triangles.as_flattened()[corner as usize];
            normals[vertex as usize] = normal;
        }
        (split, normals)
    }
}

/// The least distance of a camera from a surface at which a deviation covers at most `pixels`
/// pixels, in the middle of a picture `height` pixels high with the vertical `field_of_view` in
/// radians: `deviation · height / (2 tan(field of view / 2) · pixels)`.
pub fn switching_distance(deviation: f64, pixels: f64, height: f64, field_of_view: f64) -> f64 {
    deviation * height / (2.0 * math::tan(0.5 * field_of_view) * pixels)
}

/// The sum of vectors times weights, of which those of zero do not count.
pub(super) fn combined(points: [[f64; 3]; 3], weights: [f64; 3]) -> [f64; 3] {
    let parts = points
        .into_iter()
        .zip(weights)
        .filter(|&(_, weight)| weight != 0.0);
    parts
        .map(|(point, weight)| weight * vector(point))
        .reduce(|sum, part| sum + part)
        .unwrap_or_default()
        .to_array()
}

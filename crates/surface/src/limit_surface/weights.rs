//! The weights of control points at places of the limit surface, which depends linearly on them.
//!
//! The surface over a face depends on the face and a few rings of faces around it. That part is cut out and evaluated as a mesh of its own,
//! once for every three of its vertices, one of which has the first unit vector as its position, one the second and one the third, and all
//! others zero: coordinates are weights then.

use super::LimitSurface;
use super::places::{Coordinates, Place};
use crate::catmull_clark::quads::{Connected, MeshQuads, of_face};
use crate::index::{FaceId, HalfEdgeId, VertexId};
use crate::limit::LimitError;
use crate::limit::quads::QuadLimits;
use crate::parallel;
use crate::patch::quad::QuadPatch;
use crate::patch::submesh::submesh_of;
use crate::vector::DVec3;

/// Places whose weights are found together.
const BLOCK: usize = 64;

/// Rings of faces that decide the surface over a face for the Loop family, and for others.
const RINGS: [usize; 2] = [1, 2];

impl LimitSurface<'_> {
    /// The weights of control points at a place of a control face, in the order of their numbers,
    /// those that are 0 left out: the point there is the sum of the control points, each times its
    /// weight. They add up to 1; for the Loop family none is below 0 except by rounding. The place
    /// is used as by [`Self::at`]; a face that does not exist has no weights.
    ///
    /// ```
    /// use limitmesh_surface::{FaceId, LimitSurface, Mesh, VertexId, scheme::Loop};
    ///
    /// let mesh = Mesh::from_triangles(
    ///     vec![[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]],
    ///     vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
    /// )?;
    /// // At a vertex of valence 3 Loop's limit is 2/5 of it and 1/5 of each neighbour.
    /// let weights = LimitSurface::new(&mesh, &Loop)?.weights(FaceId(0), [1.0, 0.0, 0.0])?;
    /// assert_eq!(weights.len(), 4);
    /// assert!(weights[0].0 == VertexId(0) && (weights[0].1 - 0.4).abs() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The scheme has no limit at the shape of some ring.
    pub fn weights(
        &self,
        face: FaceId,
        barycentric: [f64; 3],
    ) -> Result<Vec<(VertexId, f64)>, LimitError> {
        Ok(self
            .weights_over(face, &[barycentric])?
            .pop()
            .unwrap_or_default())
    }

    /// [`Self::weights`] at places of many faces, in order, on all threads. Consecutive places of
    /// one face share its work.
    ///
    /// # Errors
    /// Those of [`Self::weights`].
    pub fn weights_at(
        &self,
        places: &[(FaceId, [f64; 3])],
    ) -> Result<Vec<Vec<(VertexId, f64)>>, LimitError> {
        let of_faces: Vec<&[(FaceId, [f64; 3])]> = places.chunk_by(|a, b| a.0 == b.0).collect();
        let blocks = parallel::pieces_of(of_faces.len(), BLOCK, |block| {
            let over = |face: usize| {
                let at: Vec<[f64; 3]> = of_faces[face].iter().map(|&(_, at)| at).collect();
                self.weights_over(of_faces[face][0].0, &at)
            };
            block.map(over).collect::<Result<Vec<_>, _>>()
        });
        let blocks: Result<Vec<_>, LimitError> = blocks.into_iter().collect();
        Ok(blocks?.into_iter().flatten().flatten().collect())
    }

    fn weights_over(
        &self,
        face: FaceId,
        places: &[[f64; 3]],
    ) -> Result<Vec<Vec<(VertexId, f64)>>, LimitError> {
        let mut found = vec![Vec::new(); places.len()];
        if face.index() >= self.mesh.face_count() {
            return Ok(found);
        }
        if self.mesh.topology().has_quads() {
            return Ok(self.weights_on_quad(face, places));
        }
        let rings = RINGS[usize::from(!self.rules.are_of_loop_family())];
        let (small, sources) = submesh_of(
            self.mesh,
            &self.sharpness,
            &[HalfEdgeId::of(face, 0)],
            rings,
        );
        for first in (0..sources.len()).step_by(3) {
            let mut positions = vec![[0.0; 3]; sources.len()];
            positions[first..]
                .iter_mut()
                .take(3)
                .enumerate()
                .for_each(|(axis, at)| at[axis] = 1.0);
            // All positions are finite.
            let Ok(units) = small.clone().with_positions(positions) else {
                continue;
            };
            let surface = LimitSurface::by_rules(&units, self.rules.sharing())?;
            for (found, point) in found.iter_mut().zip(surface.over(FaceId(0), places)) {
                let own = sources[first..]
                    .iter()
                    .zip(point.position)
                    .filter(|&(_, weight)| weight != 0.0);
                found.extend(own.map(|(&vertex, weight)| (vertex, weight)));
            }
            if let Some(error) = surface.failure() {
                return Err(error.clone());
            }
        }
        found.iter_mut().for_each(joined);
        Ok(found)
    }

    /// The weights over half of a quad, by pieces of the unit vectors.
    fn weights_on_quad(&self, face: FaceId, places: &[[f64; 3]]) -> Vec<Vec<(VertexId, f64)>> {
        let (mesh, sharpness) = (self.mesh, &self.sharpness);
        let (own, sources) = MeshQuads { mesh, sharpness }.surroundings(of_face(face));
        let form = self.rules.quad_forms().of(own);
        let limits = QuadLimits::of(mesh, sharpness);
        let corners = mesh.triangles()[face.index()].map(|v| limits.row(VertexId(v)));
        let mut found = vec![Vec::new(); places.len()];
        for (three, own) in sources.chunks(3).enumerate() {
            let mut units = vec![DVec3::ZERO; sources.len()];
            (0..own.len()).for_each(|axis| units[3 * three + axis][axis] = 1.0);
            let corners = corners.each_ref().map(|row| {
                let mut limit = DVec3::ZERO;
                for &(vertex, weight) in row {
                    let axis = own.iter().position(|&source| source == vertex);
                    axis.into_iter().for_each(|axis| limit[axis] = weight);
                }
                limit
            });
            let of = |(at, &weights): (usize, &[f64; 3])| Place::of(at, weights);
            let mut places = places.iter().enumerate().map(of).collect();
            let mut points = vec![[0.0; 3]; found.len()];
            let patch = || QuadPatch::piece(form.clone(), units);
            let answers = &mut Coordinates(&mut points);
            self.find_on(patch, corners, &mut places, &mut Vec::new(), answers);
            for (found, point) in found.iter_mut().zip(points) {
                let own = own.iter().map(|&vertex| VertexId(vertex)).zip(point);
                found.extend(own.filter(|&(_, weight)| weight != 0.0));
            }
        }
        found.iter_mut().for_each(joined);
        found
    }
}

/// In the order of the vertices; one that occurs several times on the rim counts once.
fn joined(weights: &mut Vec<(VertexId, f64)>) {
    weights.sort_by_key(|&(vertex, _)| vertex);
    weights.dedup_by(|next, own| {
        let is_same = next.0 == own.0;
        own.1 += if is_same { next.1 } else { 0.0 };
        is_same
    });
}

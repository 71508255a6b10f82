//! The weights of control points at places of the limit surface, which depends linearly on them.
//!
//! The surface over a face depends on the face and a few rings of faces around it. That part is cut out and evaluated as a mesh of its own,
//! once for every three of its vertices, one of which has the first unit vector as its position, one the second and one the third, and all
//! others zero: coordinates are weights then.

use super::LimitSurface;
use crate::index::{FaceId, HalfEdgeId, VertexId};
use crate::limit::LimitError;
use crate::parallel;
use crate::patch::submesh::submesh_of;

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

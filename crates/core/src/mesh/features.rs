//! Tags by rule: creases where faces meet at a sharp angle, and what happens at boundaries.
//!
//! Takes a mesh, gives it with more tags; every method then honours them alike.

use super::{CornerTag, CreaseTag, Mesh, MeshError};
use crate::index::{HalfEdgeId, VertexId};
use crate::parallel;

/// The shape of a surface's boundary. The edges along which a mesh was cut into sheets are boundaries of these.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
#[non_exhaustive]
pub enum BoundaryRule {
    /// Smooth all along: with Loop's scheme the cubic B-spline of the boundary polygon.
    #[default]
    Smooth,
    /// Smooth but for the vertices that are in one face only, which keep their place.
    Corners,
    /// The boundary polygon itself: all its vertices keep their place.
    Fixed,
}

impl Mesh {
    /// The mesh with the corner tags that make its boundary what `rule` says; those that it has stay.
    ///
    /// ```
    /// use limitmesh::Mesh;
    /// use limitmesh::mesh::BoundaryRule;
    ///
    /// let square = Mesh::from_triangles(
    ///     vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
    ///     vec![[0, 1, 2], [0, 2, 3]],
    /// )?;
    /// assert_eq!(square.clone().with_boundary(BoundaryRule::Corners).tags().corners.len(), 2);
    /// assert_eq!(square.with_boundary(BoundaryRule::Fixed).tags().corners.len(), 4);
    /// # Ok::<(), limitmesh::mesh::MeshError>(())
    /// ```
    pub fn with_boundary(mut self, rule: BoundaryRule) -> Self {
        if rule == BoundaryRule::Smooth {
            return self;
        }
        let topology = &self.topology;
        let is_kept = |v: VertexId| {
            let (valence, open) = topology.valence_and_openness(v);
            open && (rule == BoundaryRule::Fixed || valence == 2)
        };
        let kept = topology.vertices().filter(|&v| is_kept(v));
        let corner = |v: VertexId| CornerTag { vertex: v.0, sharpness: f64::INFINITY };
        let corners: Vec<CornerTag> = kept.map(corner).collect();
        self.tags.add_corners(corners);
        self.tags = self.tags.joined(&self.topology, &self.junctions);
        self
    }

    /// The mesh with creases that never fade along all edges whose faces' normals differ by more than `angle`
    /// (radians); the tags that it has stay. Faces without area have no normal and give no crease.
    ///
    /// # Errors
    /// The angle is not within 0 … π.
    pub fn with_creases_above(mut self, angle: f64) -> Result<Self, MeshError> {
        if !(0.0..=core::f64::consts::PI).contains(&angle) {
            let (name, expected) = ("the crease angle", "radians from 0 to π");
            return Err(MeshError::BadOption { name, value: angle, expected });
        }
        let normals = parallel::map(self.face_count(), |face| self.unit_face_normal(face));
        let topology = &self.topology;
        let is_sharp = |h: HalfEdgeId| {
            let Some(twin) = topology.twin(h).filter(|&twin| h < twin) else { return false };
            let [a, b] = [h, twin].map(|h| normals[h.face().index()]);
            // Two zeros give 0, which is not above any angle.
            a.cross(b).length().atan2(a.dot(b)) > angle
        };
        let crease =
            |h: HalfEdgeId| CreaseTag { vertices: topology.ends(h).map(|v| v.0), sharpness: f64::INFINITY };
        let creases: Vec<CreaseTag> = topology.half_edges().filter(|&h| is_sharp(h)).map(crease).collect();
        self.tags.creases.extend(creases);
        self.tags = self.tags.joined(&self.topology, &self.junctions);
        Ok(self)
    }
}

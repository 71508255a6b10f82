//! Tags by rule: creases where faces meet at a sharp angle, and corners of boundaries.
//!
//! Takes a mesh, gives it with more tags, which every method follows.

use super::needles::SharpEdges;
use super::{CornerTag, CreaseTag, Mesh, MeshError};
use crate::index::{HalfEdgeId, VertexId};
use crate::parallel;

/// The rule of a surface's boundary. The edges along which a mesh was cut into sheets are
/// boundaries of these.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
#[non_exhaustive]
pub enum BoundaryRule {
    /// Smooth: with Loop's scheme the cubic B-spline of the boundary polygon.
    #[default]
    Smooth,
    /// Smooth, except for the vertices that are in one face only: they are corners.
    Corners,
    /// The boundary polygon itself: all its vertices are corners.
    Fixed,
}

impl Mesh {
    /// The mesh with the corner tags that `rule` gives its boundary; existing tags stay.
    ///
    /// ```
    /// use limitmesh_mesh::Mesh;
    /// use limitmesh_mesh::mesh::BoundaryRule;
    ///
    /// let square = Mesh::from_triangles(
    ///     vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
    ///     vec![[0, 1, 2], [0, 2, 3]],
    /// )?;
    /// assert_eq!(square.clone().with_boundary(BoundaryRule::Corners).tags().corners.len(), 2);
    /// assert_eq!(square.with_boundary(BoundaryRule::Fixed).tags().corners.len(), 4);
    /// # Ok::<(), limitmesh_mesh::mesh::MeshError>(())
    /// ```
    pub fn with_boundary(self, rule: BoundaryRule) -> Self {
        if rule == BoundaryRule::Smooth {
            return self;
        }
        let topology = &self.topology;
        let is_kept = |v: VertexId| {
            let spokes = topology
                .outgoing_ring(v)
                .filter(|&h| !topology.is_diagonal(h));
            topology.is_boundary(v) && (rule == BoundaryRule::Fixed || spokes.count() == 1)
        };
        let kept: Vec<VertexId> = topology.vertices().filter(|&v| is_kept(v)).collect();
        self.with_corners(&kept)
    }

    /// The mesh with infinitely sharp corners at these vertices; existing tags stay.
    pub fn with_corners(mut self, vertices: &[VertexId]) -> Self {
        let corners = vertices.iter().map(|v| CornerTag {
            vertex: v.0,
            sharpness: f64::INFINITY,
        });
        self.tags.add_corners(corners);
        self.tags = self.tags.joined(&self.topology, &self.junctions);
        self
    }

    /// The mesh with infinitely sharp creases along the edges of [`Self::creases_above`]; existing
    /// tags stay.
    ///
    /// # Errors
    /// The angle is not within 0 … π.
    pub fn with_creases_above(self, angle: f64) -> Result<Self, MeshError> {
        let CreasesAbove { edges, .. } = self.creases_above(angle)?;
        Ok(self.with_creases(&edges))
    }

    /// The mesh with infinitely sharp creases along these edges; existing tags stay.
    pub fn with_creases(mut self, edges: &[HalfEdgeId]) -> Self {
        let ends = edges.iter().map(|&h| self.topology.ends(h).map(|v| v.0));
        let creases: Vec<CreaseTag> = ends
            .map(|vertices| CreaseTag {
                vertices,
                sharpness: f64::INFINITY,
            })
            .collect();
        self.tags.creases.extend(creases);
        self.tags = self.tags.joined(&self.topology, &self.junctions);
        self
    }

    /// The edges whose faces' normals differ by more than `angle` (radians). Faces without area have no normal and give none.
    ///
    /// Where two of them are the sides of a needle, a triangle with a tip of less than 45°, and no
    /// other edge is sharp at the tip, the faces beyond them are compared instead: they give the
    /// sharper of the two edges, or none. The normal of a needle is unreliable, and a crease that
    /// turned back at its tip would fold the surface over.
    ///
    /// # Errors
    /// The angle is not within 0 … π.
    pub fn creases_above(&self, angle: f64) -> Result<CreasesAbove, MeshError> {
        if !(0.0..=core::f64::consts::PI).contains(&angle) {
            let (name, expected) = ("the crease angle", "radians from 0 to π");
            return Err(MeshError::BadOption {
                name,
                value: angle,
                expected,
            });
        }
        let normals = parallel::map(self.face_count(), |face| self.unit_polygon_normal(face));
        let others = self
            .tags
            .creases
            .iter()
            .filter(|tag| tag.sharpness > 0.0)
            .map(|tag| tag.vertices);
        let all = SharpEdges::above(angle, (&self.topology, &self.positions, &normals), others);
        let count = all.edges().count();
        let edges: Vec<HalfEdgeId> = all.without_needles(angle).edges().collect();
        Ok(CreasesAbove {
            along_needles: count - edges.len(),
            edges,
        })
    }
}

/// The result of [`Mesh::creases_above`].
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct CreasesAbove {
    /// The edges, once each.
    pub edges: Vec<HalfEdgeId>,
    /// Edges along needles that are above the angle and not among them.
    pub along_needles: usize,
}

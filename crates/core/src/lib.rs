//! Adaptive subdivision of triangle meshes by limit surface normals, with exact limits and measured error.
//!
//! ```text
//! soup ─▶ control mesh ─▶ limit surface ─▶ refinement ─▶ triangles
//!       mesh           scheme, limit    criterion,     measure
//!                                       refine, emit
//! ```

pub mod criterion;
pub mod emit;
pub mod index;
pub mod limit;
pub mod measure;
pub mod mesh;
pub mod models;
mod parallel;
pub mod refine;
pub mod ring;
pub mod scheme;
mod vector;

pub use index::{FaceId, HalfEdgeId, VertexId};
pub use mesh::{Mesh, PolygonSoup, Triangles};

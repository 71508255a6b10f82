//! Triangle meshes: building, measuring, simplifying.
//!
//! A [`Mesh`] is made from any soup of polygons: it is welded, repaired, triangulated, connected and
//! oriented, with a report of all that was repaired. Distances between meshes are sampled
//! ([`measure::hausdorff`]) or proven ([`measure::certified_hausdorff`]). [`simplify`](mod@simplify)
//! collapses edges within a proven distance. This crate knows nothing of subdivision; the crate
//! `limitmesh` refines meshes and re-exports all of this.
//!
//! ```
//! use limitmesh_mesh::Mesh;
//! use limitmesh_mesh::measure::{CertifiedOptions, certified_hausdorff};
//!
//! let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
//! let flat = Mesh::from_triangles(corners, vec![[0, 1, 2], [0, 2, 3]])?;
//! let lifted = flat.positions().iter().map(|&[x, y, _]| [x, y, 0.25]).collect();
//! let lifted = flat.clone().with_positions(lifted)?;
//! let distance =
//!     certified_hausdorff(flat.as_triangles(), lifted.as_triangles(), &CertifiedOptions::default())?;
//! assert!(distance.lower() <= 0.25 && 0.25 <= distance.upper());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Hidden modules and items are shared by the crates of this workspace; they promise no stability.

// Results are the same on every platform.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod error_messages;
#[doc(hidden)]
pub mod geometry;
pub mod index;
#[doc(hidden)]
pub mod math;
pub mod measure;
pub mod mesh;
#[doc(hidden)]
pub mod options;
#[doc(hidden)]
pub mod parallel;
pub mod progress;
pub mod ring;
pub mod simplify;
#[doc(hidden)]
pub mod vector;

pub use index::{FaceId, HalfEdgeId, VertexId};
pub use mesh::{Mesh, PolygonSoup, Triangles};

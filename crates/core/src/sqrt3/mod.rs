//! √3-subdivision (Kobbelt 2000): a scheme that triples the triangles at each step instead of taking them times four.
//!
//! Takes a control mesh; gives the mesh of a uniform level ([`uniform()`]), or one that is divided where that is needed
//! ([`adaptive()`]), with vertices on the limit surface. Its splits are not those of [`crate::scheme::Scheme`], whose triangles are divided in four, so it is a method of its own
//! and no scheme of theirs: a step puts a vertex into each triangle and flips all the old edges.
//!
//! ```
//! use limitmesh::Mesh;
//! use limitmesh::refine::UniformOptions;
//! use limitmesh::sqrt3;
//!
//! let corners = vec![[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
//! let tetrahedron = Mesh::from_triangles(corners, vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])?;
//! let refined = sqrt3::uniform(&tetrahedron, &UniformOptions::default().levels(4).limit(true))?;
//! assert_eq!(refined.mesh.face_count(), 4 * 81);
//! // The limit of a corner is known in closed form.
//! assert!(refined.mesh.positions()[0].iter().all(|x| (x - 1.0 / 6.0).abs() < 1e-15));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod adaptive;
mod criteria;
mod forest;
mod masks;
mod options;
mod origins;
mod sharp_edges;
mod step;
mod uniform;

pub use adaptive::{Sqrt3, adaptive, adaptive_observed};
pub use options::Sqrt3Options;
pub use uniform::{limit_normals, limit_positions, tangent_plane, uniform, uniform_observed};

//! Limit positions and limit normals of any scheme, by eigen-analysis of its ring matrix (the paper's
//! section 3.2, with left eigenvectors).
//!
//! Takes a scheme's masks and the shape of a ring; gives weights ([`LimitStencil`]), tabulated by shape and built
//! once on demand ([`LimitTable`]), and with them positions and normals of the vertices of a mesh.
//!
//! # Theory
//!
//! A refinement takes the points around a vertex to new points around it by the **ring matrix** S
//! (equation 3, [`ring_matrix`]), and their differences to the vertex by the **difference matrix**
//! D (equation 6, [`difference_matrix`]). After n refinements a linear functional that is a *left*
//! eigenvector, x·S = λx, is multiplied by λⁿ. Hence
//!
//! * the limit position is given by the left eigenvector of S for the eigenvalue 1, with weights that sum to 1;
//! * differences tend to the plane of the two dominant left eigenvectors u, w of D, and the normal to
//!   `N = (Σ u_i d_i) × (Σ w_i d_i)`. For a complex pair u and w are real and imaginary part.
//!
//! The paper refines the bivectors d_i × d_j by the second compound ΛD, of size k(k−1)/2, and takes an eigenvector
//! of that (equation 10). By the Cauchy–Binet formula `(u·d) × (w·d) = Σ_{i<j} (u_i w_j − u_j w_i) d_i × d_j`: the
//! dominant left eigenvector of ΛD is the wedge of the two of D, and the large problem need never be solved. The
//! eigenvector must be the left one. As printed, with ΛD = V⁻¹AV, equation (10) takes the right one, a column of
//! V⁻¹; for Loop's interior rings both are the same, on its boundary rings the printed formula is wrong. An
//! eigenvector's sign is arbitrary; here it makes N point outwards for counter-clockwise rings.
//!
//! A plane exists where the two dominant eigenvalues are greater in modulus than all the others. Where they are
//! not (two edges inside, cone points, see [`TangentPlane`]) the normal is the area-weighted average of the
//! faces', and zero where that vanishes. At boundary vertices with seven or more edges Loop's surface is not
//! smooth: the normal there is that of the ribbon along the boundary, to which the two boundary faces tend.
//!
//! Schemes with [`Support::TwoRing`](crate::scheme::Support::TwoRing) are analysed on the two-ring
//! with regular neighbours. On a mesh, whose neighbours may be irregular, the vertex's
//! neighbourhood is refined once by the actual masks, after which it has this shape; the limit does
//! not change, so this is exact.
//!
//! # Your own scheme
//!
//! Masks are all that is needed. Here Loop's edges with another weight for vertices, with its limits checked
//! against plain iteration:
//!
//! ```
//! use limitmesh_surface::limit::{LimitTable, ring_matrix};
//! use limitmesh_surface::ring::{EdgeShape, RingShape, VertexKind};
//! use limitmesh_surface::scheme::{EdgeMask, Loop, Scheme, Support, VertexMask};
//!
//! struct Heavier;
//!
//! impl Scheme for Heavier {
//!     fn name(&self) -> &str {
//!         "heavier"
//!     }
//!     fn support(&self) -> Support {
//!         Support::OneRing
//!     }
//!     fn vertex_mask(&self, shape: RingShape) -> VertexMask {
//!         if shape.kind() != VertexKind::Interior {
//!             return Loop.vertex_mask(shape);
//!         }
//!         let k = shape.valence as usize;
//!         VertexMask { centre: 0.55, ring: vec![0.45 / k as f64; k] }
//!     }
//!     fn edge_mask(&self, shape: EdgeShape) -> EdgeMask {
//!         Loop.edge_mask(shape)
//!     }
//! }
//!
//! let shape = RingShape::interior(7);
//! let table = LimitTable::new(&Heavier);
//! let stencil = table.stencil(shape)?;
//!
//! // A vertex and seven neighbours; weights applied to them.
//! let ring: Vec<[f64; 3]> = (0..8).map(|i| [(i * i % 5) as f64, (i * 3 % 7) as f64, (i % 3) as f64]).collect();
//! let sum = |weights: &[f64], points: &[[f64; 3]]| {
//!     [0, 1, 2].map(|axis| weights.iter().zip(points).map(|(w, p)| w * p[axis]).sum::<f64>())
//! };
//! let difference = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
//! let normal_of = |a: [f64; 3], b: [f64; 3]| {
//!     let n = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
//!     let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
//!     n.map(|x| x / length)
//! };
//! let position = sum(stencil.position_weights(), &ring);
//! let tangents = stencil.tangent_weights().expect("the ring has a tangent plane");
//! let differences: Vec<[f64; 3]> = ring[1..].iter().map(|&p| difference(p, ring[0])).collect();
//! let tangent = |which: usize| sum(&tangents.iter().map(|t| t[which]).collect::<Vec<_>>(), &differences);
//! let normal = normal_of(tangent(0), tangent(1));
//!
//! // Forty refinements: the position stands still, and the normal of a face is the limit normal.
//! let matrix = ring_matrix(&Heavier, shape)?;
//! let mut points = ring;
//! for _ in 0..40 {
//!     points = matrix.iter().map(|row| sum(row, &points)).collect();
//! }
//! let face = normal_of(difference(points[1], points[0]), difference(points[2], points[0]));
//! for axis in 0..3 {
//!     assert!((points[0][axis] - position[axis]).abs() < 1e-9);
//!     assert!((face[axis] - normal[axis]).abs() < 1e-4);
//! }
//! # Ok::<(), limitmesh_surface::limit::LimitError>(())
//! ```

mod closed;
mod complex;
mod dart;
mod eigen;
mod error;
mod evaluate;
mod matrix;
mod neighbourhood;
mod open;
pub(crate) mod quads;
mod refined;
mod rows;
mod sharp;
mod sides;
mod stencil;
mod table;
mod vertex_stencils;

pub use error::{LimitError, suits};
pub use evaluate::Stencils;
pub use neighbourhood::{difference_matrix, ring_matrix};
pub(crate) use rows::LimitRows;
pub use sharp::{SharpSide, SharpStencil};
pub use sides::{SidedNormals, area_weighted_normal};
pub use stencil::{LimitStencil, TangentPlane};
pub use table::LimitTable;
pub use vertex_stencils::{VertexStencil, VertexStencils};

#[cfg(test)]
mod tests;

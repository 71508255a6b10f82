//! Adaptive subdivision of triangle meshes by limit surface normals, with exact limits and measured error.
//!
//! ```text
//! soup ─▶ control mesh ─▶ limit surface ─▶ refinement ─▶ triangles
//!       mesh           scheme, limit    criterion,     measure
//!                                       refine, emit
//! ```
//!
//! ```
//! use limitmesh::criterion::LimitNormal;
//! use limitmesh::measure::{SamplingOptions, hausdorff, limit_reference};
//! use limitmesh::refine::{StepwiseOptions, stepwise};
//! use limitmesh::scheme::Loop;
//! use limitmesh::{Mesh, models};
//!
//! // A control mesh from whatever a file held; here a built-in model.
//! let soup = models::find("torus").ok_or("no such model")?.soup();
//! let (control, diagnosis) = Mesh::from_soup(&soup, &Default::default())?;
//! assert!(diagnosis.is_clean());
//!
//! // Divide faces whose normal is more than 10° off a limit normal of their vertices, three times at most.
//! let criterion = LimitNormal::new(10f64.to_radians());
//! let refined = stepwise(&control, &Loop, &criterion, &StepwiseOptions::default().levels(3))?;
//! assert_eq!(refined.mesh.topology().boundary_edge_count(), 0);
//!
//! // How far is it from the limit surface?
//! let limit = limit_reference(&control, &Loop, 4)?;
//! let samples = SamplingOptions::default().samples(10_000);
//! let distance = hausdorff(refined.mesh.as_triangles(), limit.as_triangles(), &samples)?;
//! assert!(distance.symmetric_percent() < 1.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | module | what it is for |
//! |---|---|
//! | [`mesh`] | control meshes: building from any soup, repair, half-edge topology |
//! | [`scheme`] | subdivision schemes as masks on ring shapes |
//! | [`limit`] | limit positions and normals of any scheme from its masks |
//! | [`criterion`] | which faces are to be divided |
//! | [`refine`] | uniform and stepwise adaptive refinement |
//! | [`measure`] | distances, watertightness, triangle quality |
//! | [`models`] | built-in control meshes |

pub mod criterion;
pub mod emit;
pub mod index;
pub mod limit;
mod masks;
pub mod measure;
pub mod mesh;
pub mod models;
mod parallel;
pub mod refine;
pub mod ring;
pub mod scheme;
mod surface;
mod vector;

pub use index::{FaceId, HalfEdgeId, VertexId};
pub use mesh::{Mesh, PolygonSoup, Triangles};

#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;

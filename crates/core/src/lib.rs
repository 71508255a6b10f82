//! Adaptive subdivision of triangle meshes to a tolerance, with exact limits and a proven distance.
//!
//! ```text
//! soup ─▶ control mesh ─▶ limit surface ─▶ refinement ─▶ triangles
//!       mesh           scheme, limit    criterion,     measure
//!                                   refine, closure
//! ```
//!
//! ```
//! use limitmesh::measure::{SamplingOptions, hausdorff};
//! use limitmesh::refine::{ExactOptions, exact, limit_reference};
//! use limitmesh::scheme::Loop;
//! use limitmesh::Mesh;
//!
//! // A control mesh from whatever a file held; here a model from the crate limitmesh-models.
//! let soup = limitmesh_models::find("torus").ok_or("no such model")?.soup();
//! let (control, diagnosis) = Mesh::from_soup(&soup, &Default::default())?;
//! assert!(diagnosis.is_clean());
//!
//! // Triangles within 0.2 % of the limit surface, proven.
//! let tolerance = 0.002 * control.diagonal();
//! let refined = exact(&control, &Loop, &ExactOptions::default().tolerance(tolerance))?;
//! assert_eq!(refined.mesh.topology().boundary_edge_count(), 0);
//! assert!(refined.error.upper <= tolerance);
//!
//! // Samples agree, against the surface five levels on.
//! let limit = limit_reference(&control, &Loop, 5)?;
//! let samples = SamplingOptions::default().samples(10_000);
//! let distance = hausdorff(refined.mesh.as_triangles(), limit.as_triangles(), &samples)?;
//! assert!(distance.symmetric() <= refined.error.upper);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`guide`] shows the ten things people do, each with an example.
//!
//! | module | what it is for |
//! |---|---|
//! | [`mesh`] | control meshes: building from any soup, repair, half-edge topology |
//! | [`scheme`] | subdivision schemes as masks on ring shapes |
//! | [`limit`] | limit positions and normals of any scheme from its masks |
//! | [`mod@interpolate`] | control meshes whose limit surface passes through the vertices of a mesh |
//! | [`part`] | which meshes look like parts with intended sharp edges, and how they keep their size |
//! | [`criterion`] | which faces are to be divided |
//! | [`carry`] | textures, colours and names from a control mesh to what it was refined to |
//! | [`mod@closure`] | the paper's Figure 5: triangles whose edges are split, covered without cracks |
//! | [`front`] | triangles that are refined and coarsened from one demand to the next |
//! | [`refine`] | exact refinement to a goal, uniform and the paper's stepwise refinement |
//! | [`mod@simplify`] | edge collapse within a proven distance |
//! | [`sqrt3`] | √3-subdivision: uniform and adaptive, with exact limits |
//! | [`progress`] | what long functions report while they work, and how they are cancelled |
//! | [`measure`] | distances, sampled and certified, watertightness, triangle quality |
//!
//! At the root stand [`Mesh`], and the limit surface as an object: [`LimitSurface`], [`Proximity`]
//! and [`RayCaster`].
//!
//! | feature | what it does |
//! |---|---|
//! | `parallel` (default) | runs long loops on rayon's current thread pool; the results are the same bytes without it |
//! | `serde` | writes and reads results of measurements |

// Results are the same on every platform.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod carry;
mod certificate;
mod clock;
pub mod closure;
pub mod criterion;
pub mod front;
pub mod guide;
mod node;
pub mod part;
pub mod refine;
pub mod sqrt3;

#[doc(hidden)]
pub use limitmesh_mesh::math;
use limitmesh_mesh::{error_messages, geometry, options, parallel, vector};
pub use limitmesh_mesh::{index, measure, mesh, progress, ring, simplify};
use limitmesh_surface::{facing, limit_surface, masks, patch, value_mesh};
pub use limitmesh_surface::{interpolate, limit, scheme};

pub use limitmesh_mesh::{FaceId, HalfEdgeId, Mesh, PolygonSoup, Triangles, VertexId};
pub use limitmesh_surface::{
    BarycentricError, Closest, Crossing, Curvature, Derivatives, Facing, Hit, LimitSurface,
    Membership, NormalCone, Proximity, ProximityError, QuadControl, QuadOptions, Ray, RayCaster,
    RayError, RayOptions, SurfacePoint, barycentric,
};

#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;

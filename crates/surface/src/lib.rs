//! The limit surface of subdivision as an object: it refines nothing, and knows no tolerance.
//!
//! [`LimitSurface`] gives the point over any place of a control face, exactly, with its normal,
//! derivatives and curvature. [`Proximity`] finds closest points and what is inside, certified;
//! [`RayCaster`] finds where rays hit. [`mod@interpolate`] makes control meshes whose surface passes
//! through given points. [`limit`] has limit positions and normals of any scheme from its masks. The
//! crate `limitmesh` refines meshes towards this surface and re-exports all of this.
//!
//! ```
//! use limitmesh_surface::mesh::Mesh;
//! use limitmesh_surface::scheme::Loop;
//! use limitmesh_surface::{FaceId, LimitSurface, Proximity, Ray, RayCaster, RayOptions};
//!
//! let mesh = Mesh::from_triangles(
//!     vec![[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]],
//!     vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
//! )?;
//! let surface = LimitSurface::new(&mesh, &Loop)?;
//! // Over the middle of a face, from the weights of its corners.
//! let middle = surface.at(FaceId(0), [1.0 / 3.0; 3]);
//! assert!(middle.normal[0] > 0.57);
//! let closest = Proximity::new(&surface)?.closest(&[[1.0; 3]], 1e-9)?[0];
//! // From that point's side a ray hits the surface there.
//! let ray = Ray { origin: [1.0; 3], direction: [-1.0; 3] };
//! let hit = RayCaster::new(&surface)?.first(&ray, &RayOptions::default()).ok_or("no hit")?;
//! assert!((0..3).all(|axis| (hit.position[axis] - closest.point[axis]).abs() < 1e-6));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Hidden modules and items are shared by the crates of this workspace; they promise no stability.

// Results are the same on every platform.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

#[doc(hidden)]
pub mod catmull_clark;
#[doc(hidden)]
pub mod facing;
#[cfg(test)]
mod finer;
pub mod interpolate;
pub mod limit;
#[doc(hidden)]
pub mod limit_surface;
#[doc(hidden)]
pub mod masks;
#[doc(hidden)]
pub mod patch;
#[doc(hidden)]
pub mod proximity;
#[doc(hidden)]
pub mod rays;
mod row;
pub mod scheme;
#[doc(hidden)]
pub mod value_mesh;

pub use catmull_clark::{QuadControl, QuadOptions};
pub use facing::{Facing, NormalCone, Viewpoint};
pub use limit_surface::{
    BarycentricError, Curvature, Derivatives, LimitSurface, SurfacePoint, barycentric,
};
pub use limitmesh_mesh::{FaceId, HalfEdgeId, Mesh, PolygonSoup, Triangles, VertexId};
pub use limitmesh_mesh::{
    error_messages, geometry, index, math, mesh, options, parallel, progress, ring, vector,
};
pub use proximity::{Closest, Membership, Proximity, ProximityError};
pub use rays::{Crossing, Hit, Ray, RayCaster, RayError, RayOptions};

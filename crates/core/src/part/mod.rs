//! Parts: meshes whose sharp edges are meant, and how their surface keeps its size.
//!
//! Takes a mesh; [`Look::of`] says whether it looks like a part, and which of its edges are then sharp. [`interpolate_unfolded`] gives
//! a control mesh whose limit surface passes through the vertices, but for those around which it would fold.
//!
//! ```
//! use limitmesh::Mesh;
//! use limitmesh::part::{Look, interpolate_unfolded};
//! use limitmesh::scheme::Loop;
//!
//! // A box of triangles is a part; the same cube of squares is a cage that is meant to become round.
//! let soup = limitmesh_models::find("cube").ok_or("no such model")?.soup();
//! let (mesh, _, trace) = Mesh::from_soup_traced(&soup, &Default::default())?;
//! assert!(matches!(Look::of(&mesh, &trace.faces), Look::Cage));
//! let Look::Part(part) = Look::of(&mesh, &[]) else { return Err("a box is a part".into()) };
//! assert_eq!((part.degrees, part.creases.edges.len()), (30.0, 12));
//! let sharp = part.on(mesh);
//! assert!(interpolate_unfolded(&sharp, &Loop)?.folded.is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bends;
mod facets;
mod look;
mod sharp;
mod unfolded;

pub use look::Look;
pub use sharp::Part;
pub use unfolded::{
    FoldedRegion, Unfolded, UnfoldedError, interpolate_unfolded, interpolate_unfolded_observed,
};

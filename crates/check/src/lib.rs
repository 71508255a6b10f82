//! Checks proofs that a mesh is within a distance of the limit surface of a control mesh, and the surface within that distance of the mesh.
//!
//! What is promised, what is checked, and why that suffices is in docs/certificate.md; names here are those of that page. Nothing here is shared
//! with the program that makes the proofs.
//!
//! Data flow: [`read`] and [`proof`] read files; [`tiling`] makes sure that the parts of the result's triangles cover the control mesh;
//! [`pieces`] makes the surface over a control face ([`quartic`] where it is polynomial); [`triangle`] has the conditions; [`verdict`] goes
//! through all triangles with them.
#![expect(missing_docs, reason = "a program; its library is for tests")]

pub mod mesh;
pub mod pieces;
pub mod proof;
pub mod quartic;
pub mod read;
pub mod sha256;
pub mod tiling;
pub mod triangle;
pub mod vector;
pub mod verdict;

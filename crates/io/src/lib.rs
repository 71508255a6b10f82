//! OBJ, PLY, STL, OFF, glTF and 3MF files: read into a [`PolygonSoup`], written from triangles, pairs of which may be quads.
//!
//! The format is chosen by the file's extension and checked against its content. Reading keeps every number
//! at the precision the file has it; a damaged file is an [error](ReadError) that names the line or byte, the
//! element, what was met there and what was expected. Writing is whole or not at all: a failed write leaves an
//! earlier file of that name as it was.
//!
//! | | read | written |
//! |---|---|---|
//! | OBJ | polygons, relative indices, texture coordinates, colours, objects, groups, materials, smoothing groups, `t crease` and `t corner` tags | `f64` digits, normals, and all of these |
//! | PLY | ASCII and binary of both byte orders, triangle strips; numbers of vertices and faces, texture coordinates by corner | `f64`, binary (or ASCII), normals, colours, quality, named properties, and all of these |
//! | STL | ASCII and binary, several solids with their names, attributes of facets; three vertices a facet, not merged | `f32` binary with attributes (or ASCII with `f64` digits and names) |
//! | OFF | polygons; colours of vertices and faces, normals and texture coordinates of vertices | `f64` digits, normals, and colours |
//! | glTF | what the scene shows, all instances, in its coordinates, with attributes and names of materials; polygons of `FB_ngon_encoding` and `EXT_mesh_polygon`; Draco and meshopt | `f32`, normals: one mesh |
//! | 3MF | what the build has, all items, in its coordinates | all digits: one object |
//!
//! A glTF [`Asset`] and a 3MF [`Package`] can be edited, too: meshes are taken out one by one and replaced, and everything else stays.
//!
//! ```
//! use limitmesh_io::{Format, Output, WriteOptions, read_bytes, write_to};
//!
//! let soup = read_bytes(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", Format::Obj)?;
//! let (mesh, _) = limitmesh::Mesh::from_soup(&soup, &Default::default())?;
//! let mut bytes = Vec::new();
//! write_to(&mut bytes, Format::Ply, &Output::new(mesh.as_triangles()), &WriteOptions::default())?;
//! assert_eq!(read_bytes(&bytes, Format::Ply)?.positions, soup.positions);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`PolygonSoup`]: limitmesh::mesh::PolygonSoup

// Results are the same on every platform.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod affine;
mod capacity;
pub mod channels;
mod codec;
mod content;
mod error;
mod faces;
mod files;
mod flaw;
mod format;
mod formats;
mod mtl;
mod names;
mod output;
mod pieces;
mod proof;
mod read;
mod reading;
mod scan;
mod unit;
mod whole;
mod write;

pub use channels::{MATERIAL, TEXTURE};
pub use error::{ReadError, WriteError};
pub use flaw::{Flaw, Place};
pub use format::{Format, UnknownFormat};
pub use formats::gltf::Asset;
pub use formats::threemf::Package;
pub use formats::{gltf, splits_vertices, threemf};
pub use mtl::{Material, MaterialLibraries, Picture, Problem};
pub use output::{Output, Property, PropertyValues, WriteOptions};
pub use proof::{Proof, ProofError};
pub use read::{read, read_as, read_bytes};
pub use whole::{
    Abandoned, abandon_unfinished, check_writable, finished_files, write_whole, write_whole_with,
};
pub use write::{holds, rounding, values_lost, write, write_as, write_to};

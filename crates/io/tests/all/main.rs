//! Files read and written, in one program but for the test of memory, which needs an allocator of its own.

#![allow(
    clippy::panic,
    clippy::unwrap_used,
    reason = "helpers of tests fail as the tests do"
)]

mod control_meshes;
mod corner_normals;
mod formats;
mod gltf;
mod limits;
mod malformed;
mod models;
mod ply_seams;
mod ply_types;
mod support;
mod threemf;
mod writing;

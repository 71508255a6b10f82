//! Files read and written, in one program but for the test of memory, which needs an allocator of its own.

mod control_meshes;
mod corner_normals;
mod formats;
mod gltf;
mod limits;
mod malformed;
mod models;
mod ply_seams;
mod ply_types;
mod threemf;
mod writing;

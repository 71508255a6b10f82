//! glTF 2.0: a document is opened, the triangles of its meshes are taken out and replaced, and everything else stays as
//! it was written.
//!
//! ```text
//! file ─▶ Container ─▶ Source ─▶ Primitive ─▶ MeshSoup ─▶ (refinement) ─▶ Geometry ─▶ Appended ─▶ Changes ─▶ files
//!         GLB, text    buffers   accessors    joined                      bytes                   edited text
//! ```
//!
//! An asset is far more than its triangles: nodes, materials, animations, cameras, extras, extensions that nobody here has
//! heard of. So documents are *edited, never written anew*: the JSON text is kept, new buffers, views and accessors are
//! appended to its arrays, and of a primitive only `attributes`, `indices`, `targets` and `mode` change. What says how
//! geometry was stored goes when none is stored so any more, what extensions say of triangles by number goes with these, and bytes that
//! nothing names go from a buffer that is written anew, so that offsets of views change. All other bytes of the text are those that were read. The
//! JSON is read by serde_json, and found again in its text by serde_json's raw values; a crate that has a document model of its own would write that model, not the text.
//!
//! The numbers that a document states of itself are not believed: every count, offset and index is checked before room is made for
//! what it names, files are reached below the document's folder only, and a flaw names its place as JavaScript would.

mod asset;
mod contents;
mod document;
mod edit;
mod embedded;
mod fresh;
mod gone;
mod grouped;
mod levels;
mod looks;
mod read;
mod save;
mod tangents;

pub use asset::Asset;
pub use contents::{AssetContents, MeshContents, PrimitiveContents};
pub use edit::geometry::{Geometry, VertexAttribute};
pub use embedded::with_images;
pub use levels::{DetailLevel, write_levels};
pub use read::Joining;
pub use read::attributes::CornerAttribute;
pub use read::materials::{BaseColour, BaseTexture};
pub use read::parts::{KeptApart, MeshSoup, Part};
pub use tangents::WithTangents;

use crate::codec::Codec;
use crate::format::Format;

pub(super) const CODEC: Codec = Codec {
    begins: |bytes| bytes.starts_with(b"glTF") || bytes.starts_with(b"{"),
    capacity: |_| grouped::capacity(),
    read: |bytes, folder| Asset::from_bytes(bytes, folder)?.scene_soup(),
    write: |writer, output, options| fresh::write(writer, Format::Gltf, output, options),
    write_file: Some(|path, output, options| {
        fresh::write_file(path, Format::Gltf, output, options)
    }),
};

pub(super) const GLB_CODEC: Codec = Codec {
    write: |writer, output, options| fresh::write(writer, Format::Glb, output, options),
    write_file: Some(|path, output, options| fresh::write_file(path, Format::Glb, output, options)),
    ..CODEC
};

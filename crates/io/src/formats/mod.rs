//! The formats, each of which declares what it can do.

pub mod gltf;
mod obj;
mod off;
mod ply;
pub(crate) mod stl;
pub mod threemf;

pub use ply::splits_vertices;

use crate::codec::Codec;
use crate::format::Format;

/// The declaration of a format.
pub(crate) fn codec(format: Format) -> Codec {
    match format {
        Format::Obj => obj::CODEC,
        Format::Ply => ply::CODEC,
        Format::Stl => stl::CODEC,
        Format::Off => off::CODEC,
        Format::Gltf => gltf::CODEC,
        Format::Glb => gltf::GLB_CODEC,
        Format::ThreeMf => threemf::CODEC,
    }
}

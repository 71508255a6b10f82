//! Compressed geometry: Draco (`KHR_draco_mesh_compression`) and meshopt (`EXT_meshopt_compression`).
//!
//! The only place that knows the crate draco-gltf, of which only the two decoders are used: documents, accessors and
//! files are this module's own, because they are edited rather than written anew, because accessors without a view are
//! zeros, and because errors name places. It costs half a minute of building and the crates draco-core and
//! bytemuck; without it a good part of the assets on the web could not be read.

use super::json::At;
use super::numbers::{Component, Layout, Numbers};
use crate::flaw::{Flaw, Result};
use draco_gltf::{
    DecodeLimits, DracoPrimitiveContract, DracoPrimitiveExtension, JsonValue, MeshoptFilter,
    MeshoptMode,
};
use std::collections::BTreeMap;

/// Vertices and faces at most for each byte of a Draco stream.
const MOST_PER_BYTE: u64 = 256;

/// More bytes than these become of one compressed byte in no stream; and of no bytes at all.
const MOST_RATIO: usize = 4096;

/// The bytes of a compressed buffer view; `take_room` is asked before they are given any.
pub(crate) fn meshopt(
    at: &At<'_>,
    source: &[u8],
    take_room: impl FnOnce(usize) -> Result<()>,
) -> Result<Vec<u8>> {
    let (counted, strided) = (at.require("count")?, at.require("byteStride")?);
    let (count, stride) = (counted.count()?, strided.count()?);
    let mode = at.require("mode")?;
    let kind = MeshoptMode::from_name(mode.text()?).map_err(|_| mode.unexpected("a known mode"))?;
    let filter = match at.get("filter") {
        None => MeshoptFilter::None,
        Some(at) => {
            MeshoptFilter::from_name(at.text()?).map_err(|_| at.unexpected("a known filter"))?
        }
    };
    let strides_fit = match kind {
        MeshoptMode::Attributes => (1..=64).contains(&(stride / 4)) && stride.is_multiple_of(4),
        MeshoptMode::Triangles | MeshoptMode::Indices => matches!(stride, 2 | 4),
    };
    if !strides_fit {
        return Err(strided.unexpected("2 or 4 for indices, else a multiple of 4 up to 256"));
    }
    if kind == MeshoptMode::Triangles && !count.is_multiple_of(3) {
        return Err(counted.unexpected("a multiple of 3"));
    }
    let most = source.len().saturating_mul(MOST_RATIO);
    let size = count
        .checked_mul(stride)
        .filter(|&size| size <= most)
        .ok_or_else(|| {
            let there = source.len();
            let problem =
                format!("a stream of {there} bytes cannot hold {count} elements of {stride} bytes");
            Flaw::saying(at.place(), problem)
        })?;
    take_room(size)?;
    let mut bytes = vec![0; size];
    let decode = draco_gltf::meshopt::decode_buffer_view;
    let decoded = decode(&mut bytes, source, kind, filter, count, stride);
    let damaged = |error| format!("the meshopt stream is damaged: {error}");
    decoded.map_err(|error| Flaw::saying(at.place(), damaged(error)))?;
    Ok(bytes)
}

/// The contents of a Draco stream.
pub(crate) struct Compressed {
    pub(crate) attributes: BTreeMap<String, Numbers>,
    /// Vertex indices of triangles.
    pub(crate) indices: Vec<u32>,
}

/// Decodes the stream of a primitive, whose extension stands at `at`; each attribute is named with whether it `is_normalized`.
pub(crate) fn draco(
    at: &At<'_>,
    stream: &[u8],
    is_normalized: &BTreeMap<&str, bool>,
    room: usize,
) -> Result<Compressed> {
    let failed = |error: &dyn std::fmt::Display| {
        Flaw::saying(at.place(), format!("the Draco stream is damaged: {error}"))
    };
    let value = JsonValue::parse(at.to_string().as_bytes()).map_err(|error| failed(&error))?;
    let extension = DracoPrimitiveExtension::from_json(&value).map_err(|error| failed(&error))?;
    let mut limits = DecodeLimits::default();
    // A stream has about a bit for each triangle at least.
    let most = (stream.len() as u64).saturating_mul(MOST_PER_BYTE);
    (limits.max_points, limits.max_faces) = (most, most);
    limits.max_decoded_bytes = room as u64;
    let mut contract = DracoPrimitiveContract::new().with_limits(limits);
    for (&name, &is_normalized) in is_normalized {
        contract = contract.with_attribute(name, 0, is_normalized);
    }
    let geometry = extension.decode(stream, &contract);
    let geometry = geometry.map_err(|error| failed(&error))?;
    let mut attributes = BTreeMap::new();
    for own in geometry.attributes() {
        let component = Component::of(own.component_type().to_gltf() as usize)
            .ok_or_else(|| failed(&"numbers of a kind that glTF does not have"))?;
        let layout = Layout {
            count: own.count(),
            components: usize::from(own.components()),
            component,
            is_normalized: own.normalized(),
        };
        let values = layout.decode(own.bytes(), layout.size());
        attributes.insert(own.semantic().to_owned(), layout.numbers(values));
    }
    let found = geometry.indices();
    let bytes = found.map_or(&[][..], |indices| indices.bytes());
    let indices = bytes.as_chunks::<4>().0.iter();
    let indices = indices.map(|&four| u32::from_le_bytes(four)).collect();
    Ok(Compressed {
        attributes,
        indices,
    })
}

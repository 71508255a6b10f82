//! Compressed geometry: Draco (`KHR_draco_mesh_compression`) and meshopt (`EXT_meshopt_compression`).
//!
//! The only place that knows the crate draco-gltf, of which only the two decoders are used: documents, accessors and
//! files are this module's own, because they are edited rather than written anew, because accessors without a view are
//! zeros, and because errors name places. It costs half a minute of building and the crates draco-core and
//! bytemuck; without it a good part of the assets on the web could not be read.

use super::accessor::{self, Component, Numbers};
use super::flaw::{GltfFlaw, Result};
use super::json::At;
use draco_gltf::{
    DecodeLimits, DracoPrimitiveContract, DracoPrimitiveExtension, JsonValue, MeshoptFilter,
    MeshoptMode,
};

/// Vertices and faces at most for each byte of a Draco stream.
const MOST_PER_BYTE: u64 = 256;

/// More bytes than these become of one compressed byte in no stream; and of no bytes at all.
const MOST_RATIO: usize = 4096;

/// The bytes of a compressed buffer view; `take_room` is asked before they are given any.
pub(super) fn meshopt(
    at: &At<'_>,
    source: &[u8],
    take_room: impl FnOnce(usize) -> Result<()>,
) -> Result<Vec<u8>> {
    let (count, stride) = (
        at.require("count")?.count()?,
        at.require("byteStride")?.count()?,
    );
    let mode = at.require("mode")?;
    let filter = at.get("filter");
    let kind = MeshoptMode::from_name(mode.text()?).map_err(|_| mode.unexpected("a known mode"))?;
    let filter = match &filter {
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
        return Err(at
            .require("byteStride")?
            .unexpected("2 or 4 for indices, else a multiple of 4 up to 256"));
    }
    if kind == MeshoptMode::Triangles && !count.is_multiple_of(3) {
        return Err(at.require("count")?.unexpected("a multiple of 3"));
    }
    let most = source.len().saturating_mul(MOST_RATIO);
    let size = count
        .checked_mul(stride)
        .filter(|&size| size <= most)
        .ok_or_else(|| {
            let there = source.len();
            let problem =
                format!("a stream of {there} bytes cannot hold {count} elements of {stride} bytes");
            GltfFlaw::saying(at.place(), problem)
        })?;
    take_room(size)?;
    let mut bytes = vec![0; size];
    draco_gltf::meshopt::decode_buffer_view(&mut bytes, source, kind, filter, count, stride)
        .map_err(|error| {
            GltfFlaw::saying(
                at.place(),
                format!("the meshopt stream is damaged: {error}"),
            )
        })?;
    Ok(bytes)
}

/// What a Draco stream holds.
pub(super) struct Compressed {
    /// Attributes by name.
    pub(super) attributes: Vec<(String, Numbers)>,
    /// Vertex indices of triangles.
    pub(super) indices: Vec<u32>,
}

/// Decodes the stream of a primitive, whose extension stands at `at`.
pub(super) fn draco(
    at: &At<'_>,
    stream: &[u8],
    normalized: &[(String, bool)],
    room: usize,
) -> Result<Compressed> {
    let failed = |error: &dyn std::fmt::Display| {
        GltfFlaw::saying(at.place(), format!("the Draco stream is damaged: {error}"))
    };
    let value = JsonValue::parse(at.to_string().as_bytes()).map_err(|error| failed(&error))?;
    let extension = DracoPrimitiveExtension::from_json(&value).map_err(|error| failed(&error))?;
    let mut limits = DecodeLimits::default();
    // A stream has about a bit for each triangle at least.
    let most = (stream.len() as u64).saturating_mul(MOST_PER_BYTE);
    limits.max_points = most;
    limits.max_faces = most;
    limits.max_decoded_bytes = room as u64;
    let contract = normalized.iter().fold(
        DracoPrimitiveContract::new().with_limits(limits),
        |contract, (name, is)| contract.with_attribute(name.as_str(), 0, *is),
    );
    let geometry = extension
        .decode(stream, &contract)
        .map_err(|error| failed(&error))?;
    let attributes = geometry.attributes().iter().map(|attribute| {
        let component = Component::of(attribute.component_type().to_gltf() as usize)
            .ok_or_else(|| failed(&"numbers of a kind that glTF does not have"))?;
        let components = usize::from(attribute.components());
        let is_integer = component != Component::F32 && !attribute.normalized();
        let values = accessor::decode(
            attribute.bytes(),
            attribute.count(),
            components,
            components * component.size(),
            (component, attribute.normalized()),
        );
        Ok((
            attribute.semantic().to_owned(),
            Numbers {
                components,
                values,
                is_integer,
            },
        ))
    });
    let attributes = attributes.collect::<Result<_>>()?;
    let indices = geometry
        .indices()
        .map_or(&[][..], |indices| indices.bytes());
    let indices = indices
        .chunks_exact(4)
        .map(|four| u32::from_le_bytes([four[0], four[1], four[2], four[3]]));
    Ok(Compressed {
        attributes,
        indices: indices.collect(),
    })
}

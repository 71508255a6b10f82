//! A GLB that needs no other file: with the images that it names in it.

use std::path::Path;

use serde_json::{Map, Value, json};

use super::document::container::Container;
use super::document::uri::{self, Uri};
use crate::error::WriteError;
use crate::flaw::Flaw;

/// What the first bytes of an image say that it is.
const KINDS: [(&[u8], &str); 4] = [
    (b"\x89PNG", "image/png"),
    (b"\xff\xd8", "image/jpeg"),
    (b"RIFF", "image/webp"),
    (b"\xabKTX 20", "image/ktx2"),
];

/// Puts images that a GLB names as files of a folder into it. Those that are not there, or are no images, stay as they are named.
///
/// # Errors
/// It is no GLB, or would be larger than one can be.
pub fn with_images(glb: &[u8], folder: &Path) -> Result<Vec<u8>, WriteError> {
    let mut container = Container::parse(glb)?;
    let flaw = |problem: String| Flaw::saying("the JSON text", problem);
    let read: serde_json::Result<Map<String, Value>> = serde_json::from_str(&container.text);
    let mut document = read.map_err(|error| flaw(error.to_string()))?;
    let mut bin = container.bin.take().unwrap_or_default();
    let mut images = taken(&mut document, "images");
    let mut views = taken(&mut document, "bufferViews");
    let before = views.len();
    for image in images.iter_mut().filter_map(Value::as_object_mut) {
        let uri = image.get("uri").and_then(Value::as_str);
        let Some((bytes, kind)) = uri.and_then(|uri| found(uri, folder)) else {
            continue;
        };
        bin.resize(bin.len().next_multiple_of(4), 0);
        image.remove("uri");
        image.insert("bufferView".to_owned(), views.len().into());
        image.insert("mimeType".to_owned(), kind.into());
        views.push(json!({ "buffer": 0, "byteOffset": bin.len(), "byteLength": bytes.len() }));
        bin.extend(bytes);
    }
    if views.len() == before {
        return Ok(glb.to_vec());
    }
    let mut buffers = taken(&mut document, "buffers");
    let length = json!(bin.len());
    match buffers.first_mut().and_then(Value::as_object_mut) {
        Some(first) if first.contains_key("uri") => {
            return Err(flaw("its first buffer is a file".to_owned()).into());
        }
        Some(first) => drop(first.insert("byteLength".to_owned(), length)),
        None => buffers.push(json!({ "byteLength": length })),
    }
    for (name, list) in [
        ("images", images),
        ("bufferViews", views),
        ("buffers", buffers),
    ] {
        if !list.is_empty() {
            document.insert(name.to_owned(), list.into());
        }
    }
    container.text = Value::from(document).to_string();
    container.bin = (!bin.is_empty()).then_some(bin);
    let large = || Flaw::saying("the GLB", "it would have 4 GiB or more");
    Ok(container.to_glb().ok_or_else(large)?)
}

/// A list of the document, which it no longer has.
fn taken(document: &mut Map<String, Value>, name: &str) -> Vec<Value> {
    match document.remove(name) {
        Some(Value::Array(list)) => list,
        _ => Vec::new(),
    }
}

/// An image in a file of the folder, and its kind.
fn found(uri: &str, folder: &Path) -> Option<(Vec<u8>, &'static str)> {
    let Ok(Uri::File(file)) = uri::parse(uri) else {
        return None;
    };
    let bytes = std::fs::read(folder.join(file)).ok()?;
    let (_, kind) = KINDS.iter().find(|(start, _)| bytes.starts_with(start))?;
    Some((bytes, kind))
}

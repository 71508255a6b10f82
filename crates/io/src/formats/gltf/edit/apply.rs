//! From the document that was read and what was appended to the document that is written: text, bytes, and the files
//! that it names.

use super::geometry::{Changes, NewAttributes, PrimitiveAddress};
use super::idle::Idle;
use super::rest::{Extensions, Rest};
use super::unused::Unused;
use crate::flaw::{Flaw, Result};
use crate::formats::gltf::document::container::Container;
use crate::formats::gltf::document::extensions::items;
use crate::formats::gltf::document::json::At;
use crate::formats::gltf::document::source::Source;
use crate::formats::gltf::document::text::{Edits, Members, quoted};
use crate::formats::gltf::document::uri::{self, Uri};
use serde_json::{Value, json};
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// Where the new bytes go.
pub(crate) enum Place<'a> {
    /// To the binary chunk of a GLB, after what was the first buffer.
    Chunk,
    /// To a file of this name.
    File(&'a str),
    /// Into the document.
    Inside,
}

/// The files and bytes that are written.
pub(crate) struct Written {
    pub(crate) container: Container,
    /// The contents of the file that was named, if one was.
    pub(crate) file: Option<Vec<u8>>,
}

impl Changes {
    /// The document with the changes; `way` is put before the names of images.
    pub(crate) fn apply(
        &self,
        source: &Source,
        place: &Place<'_>,
        way: Option<&str>,
    ) -> Result<Written> {
        let text = &source.container.text;
        let top = Members::of(text)?;
        let mut edits = Edits::new(text);
        let rest = Rest::of(&source.json, self);
        let is_anew = matches!(place, Place::Chunk) || source.is_in_chunk();
        let unused = match is_anew && !self.primitives.is_empty() {
            true => Unused::of(&source.json, &rest.json),
            false => Unused::default(),
        };
        let idle = Idle::of(source, self, &rest, &unused);
        let mut new = Cow::Borrowed(self.appended.bytes.as_slice());
        let mut starts = idle.append_to(&mut new);
        let Placed {
            buffer,
            start,
            bytes,
        } = place_bytes(&new, source, &unused, place, &top, &mut edits)?;
        starts.iter_mut().for_each(|own| *own += start);
        idle.edit(&top, &mut edits, buffer, &starts)?;
        unused.edit(&top, &mut edits, |view| idle.makes_plain(view))?;
        let [views, accessors] =
            ["bufferViews", "accessors"].map(|key| items(&source.json, key).len());
        let new_views = self.appended.views.iter().map(|view| {
            let mut members = json!({
                "buffer": buffer,
                "byteOffset": start + view.start,
                "byteLength": view.length,
                "target": view.target,
            });
            if let Some(stride) = view.stride {
                members["byteStride"] = Value::from(stride);
            }
            members.to_string()
        });
        append(&mut edits, &top, "bufferViews", new_views.collect())?;
        let new_accessors = self
            .appended
            .accessors
            .iter()
            .zip(views..)
            .map(|(own, view)| {
                let mut accessor = own.clone();
                accessor["bufferView"] = Value::from(view);
                accessor.to_string()
            });
        append(&mut edits, &top, "accessors", new_accessors.collect())?;
        self.edit_primitives(&top, &mut edits, accessors, &rest)?;
        rest.edit(&top, &mut edits)?;
        if let Some(way) = way.filter(|way| !way.is_empty()) {
            link_images(&top, &mut edits, way)?;
        }
        let mut container = Container {
            text: edits.apply(),
            ..Container::default()
        };
        let mut bytes = Some(bytes).filter(|bytes| !bytes.is_empty());
        if let Place::Chunk = place {
            container.bin = bytes.take();
            container.others.clone_from(&source.container.others);
        }
        let file = bytes.filter(|_| matches!(place, Place::File(_)));
        Ok(Written { container, file })
    }

    /// Writes new attributes, indices and modes of primitives; `first` is the number of the first new accessor.
    fn edit_primitives<'a>(
        &self,
        top: &Members<'a>,
        edits: &mut Edits<'a>,
        first: usize,
        rest: &Rest,
    ) -> Result<()> {
        let meshes = top.items("meshes")?;
        let object = |all: &NewAttributes| {
            let named = all
                .iter()
                .map(|(name, own)| format!("{}:{}", quoted(name), first + own));
            format!("{{{}}}", named.collect::<Vec<_>>().join(","))
        };
        for (&PrimitiveAddress { mesh, primitive }, new) in &self.primitives {
            let missing = || {
                let place = format!("meshes[{mesh}].primitives[{primitive}]");
                Flaw::saying(place, "there is no such primitive")
            };
            let found = Members::of(meshes.get(mesh).ok_or_else(missing)?)?.items("primitives")?;
            let old = found.get(primitive).copied().ok_or_else(missing)?;
            let members = Members::of(old)?;
            let targets: Vec<String> = new.targets.iter().map(object).collect();
            let targets = (!targets.is_empty()).then(|| format!("[{}]", targets.join(",")));
            let mut changes = vec![
                ("attributes", Some(object(&new.attributes))),
                ("indices", Some((first + new.indices).to_string())),
                ("targets", targets),
            ];
            // Triangles are what a primitive without a mode has.
            if members.get("mode").is_some_and(|mode| mode != "4") {
                changes.push(("mode", Some("4".to_owned())));
            }
            let stays = &rest.json["meshes"][mesh]["primitives"][primitive];
            match Rest::extensions(stays, &members)? {
                Extensions::Same => {}
                Extensions::Gone => changes.push(("extensions", None)),
                Extensions::New(text) => changes.push(("extensions", Some(text))),
            }
            edits.replace(old, members.with(&changes));
        }
        Ok(())
    }
}

/// Where the new bytes are.
struct Placed {
    /// The number of the buffer that has them.
    buffer: usize,
    /// Where they start in it.
    start: usize,
    /// All that goes to the place.
    bytes: Vec<u8>,
}

/// Puts the new bytes in their place, and says so in the document.
fn place_bytes<'a>(
    new: &[u8],
    source: &'a Source,
    unused: &Unused,
    place: &Place<'_>,
    top: &Members<'a>,
    edits: &mut Edits<'a>,
) -> Result<Placed> {
    let buffers = top.items("buffers")?;
    let uri = |bytes: &[u8]| match place {
        Place::Chunk => None,
        Place::File(name) => Some(quoted(&uri::escaped(name))),
        Place::Inside => {
            let data = uri::to_base64(bytes);
            Some(quoted(&format!(
                "data:application/octet-stream;base64,{data}"
            )))
        }
    };
    // The first buffer is the chunk's, or was and has to go elsewhere.
    let is_taken = matches!(place, Place::Chunk) || source.is_in_chunk();
    if let Some(&first) = buffers.first().filter(|_| is_taken) {
        let mut bytes = unused.cut(source.first_buffer()?);
        if !new.is_empty() {
            bytes.resize(bytes.len().next_multiple_of(4), 0);
        }
        let start = bytes.len();
        bytes.extend(new);
        let members = Members::of(first)?;
        let (length, uri) = (bytes.len().to_string(), uri(&bytes));
        if members.get("uri").is_none() && uri.is_none() {
            if let Some(old) = members.get("byteLength") {
                edits.replace(old, length);
            }
        } else {
            let changes = [("uri", uri), ("byteLength", Some(length))];
            edits.replace(first, members.with(&changes));
        }
        return Ok(Placed {
            buffer: 0,
            start,
            bytes,
        });
    }
    if !new.is_empty() {
        let uri = uri(new).map_or_else(String::new, |uri| format!("\"uri\":{uri},"));
        let item = format!("{{{uri}\"byteLength\":{}}}", new.len());
        append(edits, top, "buffers", vec![item])?;
    }
    Ok(Placed {
        buffer: buffers.len(),
        start: 0,
        bytes: new.to_vec(),
    })
}

/// Puts a way before the names of image files.
fn link_images<'a>(top: &Members<'a>, edits: &mut Edits<'a>, way: &str) -> Result<()> {
    for image in top.items("images")? {
        if let Some(text) = Members::of(image)?.get("uri")
            && let Ok(Value::String(name)) = serde_json::from_str(text)
            && let Ok(Uri::File(_)) = uri::parse(&name)
        {
            edits.replace(text, quoted(&format!("{way}{name}")));
        }
    }
    Ok(())
}

/// Adds items to one of the document's arrays, which is made if there is none.
fn append<'a>(
    edits: &mut Edits<'a>,
    top: &Members<'a>,
    key: &str,
    items: Vec<String>,
) -> Result<()> {
    match top.get(key) {
        _ if items.is_empty() => Ok(()),
        Some(array) => edits.append(array, &items),
        None => edits.insert(edits.document(), key, &format!("[{}]", items.join(","))),
    }
}

impl Source {
    /// Whether the first buffer is a GLB's binary chunk.
    pub(crate) fn is_in_chunk(&self) -> bool {
        let first = items(&self.json, "buffers").first();
        self.container.bin.is_some() && first.is_some_and(|first| first.get("uri").is_none())
    }

    /// The bytes of the first buffer.
    fn first_buffer(&self) -> Result<&[u8]> {
        self.buffer(&At::root(&Value::from(0)))
    }

    /// Files below the folder that a `uri` anywhere in the document names, but for that of the first buffer if it `is_taken`, and for
    /// those of images if they `are_linked`.
    pub(crate) fn files(&self, is_taken: bool, are_linked: bool) -> BTreeSet<PathBuf> {
        let mut found = BTreeSet::new();
        let first = items(&self.json, "buffers").iter();
        let first = first.take(usize::from(is_taken));
        let images = items(&self.json, "images").iter().filter(|_| are_linked);
        let passed_over: Vec<&Value> = first.chain(images).collect();
        let mut waiting = vec![&self.json];
        while let Some(value) = waiting.pop() {
            match value {
                Value::Array(items) => waiting.extend(items),
                Value::Object(members)
                    if !passed_over.iter().any(|own| std::ptr::eq(*own, value)) =>
                {
                    if let Some(Value::String(uri)) = members.get("uri")
                        && let Ok(Uri::File(file)) = uri::parse(uri)
                    {
                        found.insert(file);
                    }
                    waiting.extend(members.values());
                }
                _ => {}
            }
        }
        found
    }
}

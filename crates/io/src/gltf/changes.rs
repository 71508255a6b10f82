//! From the document that was read and what was appended to the document that is written: text, bytes, and the files
//! beside it.

use super::container::Container;
use super::edit::{Edits, Members, items_of, quoted};
use super::flaw::{GltfFlaw, Result};
use super::geometry::{Appended, NewPrimitive};
use super::idle::Idle;
use super::json::At;
use super::rest::Rest;
use super::source::Source;
use super::unused::Unused;
use super::uri::{self, Uri};
use serde_json::{Value, json};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// What is changed in a document.
#[derive(Clone, Debug, Default)]
pub(super) struct Changes {
    /// By mesh and primitive.
    pub(super) primitives: BTreeMap<(usize, usize), NewPrimitive>,
    pub(super) appended: Appended,
}

/// Where the new bytes go.
pub(super) enum Place<'a> {
    /// To the binary chunk of a GLB, after what was the first buffer.
    Chunk,
    /// To a file of this name.
    File(&'a str),
    /// Into the document.
    Inside,
}

/// What is written.
pub(super) struct Written {
    pub(super) container: Container,
    /// What the file has that was named, if one was.
    pub(super) beside: Option<Vec<u8>>,
}

impl Changes {
    /// The document with the changes; `way` is put before the names of images.
    pub(super) fn apply(
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
        let idle = Idle::of(source, (self, &rest, &unused));
        let mut new = Cow::from(&self.appended.bytes);
        let starts = if idle.has_views() {
            idle.append_to(new.to_mut())
        } else {
            Vec::new()
        };
        let (buffer, start, bytes) = buffer(&new, (source, &unused), place, (&top, &mut edits))?;
        let starts: Vec<usize> = starts.into_iter().map(|own| start + own).collect();
        idle.edit((text, &top), &mut edits, (buffer, &starts))?;
        unused.edit(&top, &mut edits, |view| idle.makes_plain(view))?;
        let count = |key: &str| {
            source
                .json
                .get(key)
                .and_then(Value::as_array)
                .map_or(0, Vec::len)
        };
        let (views, accessors) = (count("bufferViews"), count("accessors"));
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
        append(&mut edits, text, &top, "bufferViews", new_views.collect())?;
        let new_accessors = self
            .appended
            .accessors
            .iter()
            .enumerate()
            .map(|(i, accessor)| {
                let mut accessor = accessor.clone();
                accessor["bufferView"] = Value::from(views + i);
                accessor.to_string()
            });
        append(&mut edits, text, &top, "accessors", new_accessors.collect())?;
        self.primitives_in(&top, &mut edits, (accessors, &rest))?;
        rest.edit(&top, &mut edits)?;
        if let Some(way) = way.filter(|way| !way.is_empty()) {
            link_images(&top, &mut edits, way)?;
        }
        let mut container = Container {
            text: edits.apply(),
            ..Container::default()
        };
        let beside = match place {
            Place::Chunk => {
                container.bin = (!bytes.is_empty()).then_some(bytes);
                container.others.clone_from(&source.container.others);
                None
            }
            Place::File(_) => (!bytes.is_empty()).then_some(bytes),
            Place::Inside => None,
        };
        Ok(Written { container, beside })
    }

    /// New attributes, indices and modes of primitives; `first` is the number of the first new accessor.
    fn primitives_in<'a>(
        &self,
        top: &Members<'a>,
        edits: &mut Edits<'a>,
        (first, rest): (usize, &Rest),
    ) -> Result<()> {
        let meshes = top.get("meshes").map_or_else(|| Ok(Vec::new()), items_of)?;
        for (&(mesh, primitive), new) in &self.primitives {
            let missing = || {
                GltfFlaw::saying(
                    format!("meshes[{mesh}].primitives[{primitive}]"),
                    "there is no such primitive",
                )
            };
            let primitives = Members::of(meshes.get(mesh).ok_or_else(missing)?)?;
            let primitives = items_of(primitives.get("primitives").ok_or_else(missing)?)?;
            let old = primitives.get(primitive).copied().ok_or_else(missing)?;
            let members = Members::of(old)?;
            let named = |(name, accessor): &(String, usize)| {
                format!("{}:{}", quoted(name), first + accessor)
            };
            let object = |all: &Vec<(String, usize)>| {
                format!(
                    "{{{}}}",
                    all.iter().map(named).collect::<Vec<_>>().join(",")
                )
            };
            let targets: Vec<String> = new.targets.iter().map(object).collect();
            let mut changes = vec![
                ("attributes", Some(object(&new.attributes))),
                ("indices", Some((first + new.indices).to_string())),
                (
                    "targets",
                    (!targets.is_empty()).then(|| format!("[{}]", targets.join(","))),
                ),
            ];
            // Triangles are what a primitive without a mode has.
            if members.get("mode").is_some_and(|mode| mode != "4") {
                changes.push(("mode", Some("4".to_owned())));
            }
            let stays = &rest.json["meshes"][mesh]["primitives"][primitive];
            changes.extend(Rest::extensions(stays, &members)?.map(|new| ("extensions", new)));
            edits.replace(old, members.with(&changes));
        }
        Ok(())
    }
}

/// The number of the buffer with the new bytes, where they start in it, and all of what goes to the place.
fn buffer<'a>(
    new: &[u8],
    (source, unused): (&'a Source, &Unused),
    place: &Place<'_>,
    (top, edits): (&Members<'a>, &mut Edits<'a>),
) -> Result<(usize, usize, Vec<u8>)> {
    let text = &source.container.text;
    let buffers = top
        .get("buffers")
        .map_or_else(|| Ok(Vec::new()), items_of)?;
    let uri = |bytes: &[u8]| match place {
        Place::Chunk => None,
        Place::File(name) => Some(quoted(&uri::escaped(name))),
        Place::Inside => Some(quoted(&format!(
            "data:application/octet-stream;base64,{}",
            uri::to_base64(bytes)
        ))),
    };
    // The first buffer is the chunk's, or was and has to go elsewhere.
    let is_in_chunk = source.is_in_chunk();
    if let (Some(&first), true) = (
        buffers.first(),
        matches!(place, Place::Chunk) || is_in_chunk,
    ) {
        let mut bytes = unused.cut(source.first_buffer()?);
        if !new.is_empty() {
            bytes.resize(bytes.len().next_multiple_of(4), 0);
        }
        let start = bytes.len();
        bytes.extend(new);
        let members = Members::of(first)?;
        let length = bytes.len().to_string();
        let uri = uri(&bytes);
        if members.get("uri").is_none() && uri.is_none() {
            if let Some(old) = members.get("byteLength") {
                edits.replace(old, length);
            }
        } else {
            edits.replace(
                first,
                members.with(&[("uri", uri), ("byteLength", Some(length))]),
            );
        }
        return Ok((0, start, bytes));
    }
    if !new.is_empty() {
        let uri = uri(new)
            .map(|uri| format!("\"uri\":{uri},"))
            .unwrap_or_default();
        let item = format!("{{{uri}\"byteLength\":{}}}", new.len());
        append(edits, text, top, "buffers", vec![item])?;
    }
    Ok((buffers.len(), 0, new.to_vec()))
}

/// Puts a way before the names of image files.
fn link_images<'a>(top: &Members<'a>, edits: &mut Edits<'a>, way: &str) -> Result<()> {
    for image in top.get("images").map_or_else(|| Ok(Vec::new()), items_of)? {
        let Some(text) = Members::of(image)?.get("uri") else {
            continue;
        };
        if let Ok(Value::String(name)) = serde_json::from_str(text)
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
    text: &'a str,
    top: &Members<'a>,
    key: &str,
    items: Vec<String>,
) -> Result<()> {
    match top.get(key) {
        _ if items.is_empty() => Ok(()),
        Some(array) => edits.append(array, &items),
        None => edits.insert(
            text.trim_ascii_end(),
            key,
            &format!("[{}]", items.join(",")),
        ),
    }
}

impl Source {
    /// Whether the first buffer is a GLB's binary chunk.
    pub(super) fn is_in_chunk(&self) -> bool {
        let first = self.json.get("buffers").and_then(|buffers| buffers.get(0));
        self.container.bin.is_some() && first.is_some_and(|first| first.get("uri").is_none())
    }

    /// The bytes of the first buffer.
    fn first_buffer(&self) -> Result<&[u8]> {
        let zero = Value::from(0);
        self.buffer(&At::root(&zero))
    }

    /// Files below the folder that a `uri` anywhere in the document names, but for that of the first buffer if it `is_taken`, and for
    /// those of images if they `are_linked`.
    pub(super) fn files(&self, is_taken: bool, are_linked: bool) -> BTreeSet<PathBuf> {
        let mut found = BTreeSet::new();
        let first = self
            .json
            .get("buffers")
            .and_then(|buffers| buffers.get(0))
            .filter(|_| is_taken);
        let linked = self
            .json
            .get("images")
            .and_then(Value::as_array)
            .filter(|_| are_linked);
        let is_linked = |value: &Value| {
            linked.is_some_and(|all| all.iter().any(|own| std::ptr::eq(own, value)))
        };
        let mut waiting = vec![&self.json];
        while let Some(value) = waiting.pop() {
            match value {
                Value::Array(items) => waiting.extend(items),
                Value::Object(members)
                    if !is_linked(value)
                        && !first.is_some_and(|first| std::ptr::eq(first, value)) =>
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

//! Bytes of the first buffer that nothing in a document names after an edit, and the document without them, where that buffer is written
//! anew anyway.
//!
//! Takes the document that is left; gives the accessors that nothing names, the views that only these name, and the bytes that only such views
//! have. Accessors and views keep their numbers: such accessors become ones without a view, such views ones of a byte, and of views behind
//! the bytes that go only the offset changes. What nobody here knows, extensions and extras, is taken to name whatever has a number that
//! stands in it; where it may name buffers or bytes themselves, all stay.

use super::used::{used_accessors, views_of};
use crate::flaw::Result;
use crate::formats::gltf::document::extensions::{
    DRACO, LOD, MESHOPT, extension, index, items, primitives,
};
use crate::formats::gltf::document::text::{Edits, Members};
use serde_json::Value;
use std::collections::BTreeSet;
use std::ops::Range;

/// The greatest alignment of bytes, in views of any kind: kept bytes are moved by multiples of this.
const ALIGNMENT: usize = 16;

/// Beginnings of the names of extensions that name textures, nodes and numbers, but neither accessors nor views.
const HARMLESS: [&str; 5] = [
    "KHR_materials_",
    "KHR_texture_",
    "KHR_lights_",
    "EXT_texture_",
    LOD,
];

/// Members of a document that the specification knows, but for those that may hold anything.
const KNOWN: [&str; 17] = [
    "accessors",
    "animations",
    "asset",
    "bufferViews",
    "buffers",
    "cameras",
    "extensionsRequired",
    "extensionsUsed",
    "images",
    "materials",
    "meshes",
    "nodes",
    "samplers",
    "scene",
    "scenes",
    "skins",
    "textures",
];

/// The parts that nothing names.
#[derive(Debug, Default)]
pub(crate) struct Unused {
    accessors: BTreeSet<usize>,
    views: BTreeSet<usize>,
    /// The ranges of the first buffer that go, in order.
    cuts: Vec<Range<usize>>,
}

impl Unused {
    /// The parts that nothing names in the document `rest` that is left of another, `json`; nothing where that cannot be known.
    pub(crate) fn of(json: &Value, rest: &Value) -> Self {
        Self::found(json, rest).unwrap_or_default()
    }

    fn found(json: &Value, rest: &Value) -> Option<Self> {
        let mut named = Mentioned::default();
        named.in_document(rest);
        let first = items(rest, "buffers").first()?;
        if named.is_all || first.get("extensions").is_some_and(|own| !is_meshopt(own)) {
            return None;
        }
        let (all, views) = (items(rest, "accessors"), items(rest, "bufferViews"));
        let mut used = used_accessors(rest, &primitives(rest).collect::<Vec<_>>());
        used.extend(&named.numbers);
        let of = |used: &BTreeSet<usize>| -> BTreeSet<usize> {
            let own = used.iter().filter_map(|&i| all.get(i)).flat_map(views_of);
            own.collect()
        };
        let mut needed = of(&used);
        let images = items(rest, "images").iter();
        needed.extend(images.filter_map(|image| index(image.get("bufferView")?)));
        needed.extend(&named.numbers);
        let unused: BTreeSet<usize> = (0..all.len()).filter(|i| !used.contains(i)).collect();
        let mut free = of(&unused);
        let compressed =
            primitives(json).filter_map(|own| extension(own, DRACO)?.get("bufferView"));
        free.extend(compressed.filter_map(index));
        // Where none of its bytes are in the first buffer, nothing is gained.
        let is_in_first =
            |view: &Value| parts(view).is_some_and(|all| all.iter().any(|part| part.buffer == 0));
        free.retain(|i| !needed.contains(i) && views.get(*i).is_some_and(is_in_first));
        let has_free = |i: &usize| views_of(&all[*i]).any(|view| free.contains(&view));
        let accessors = unused.into_iter().filter(has_free).collect();
        let cuts = cuts(views, &free, index(first.get("byteLength")?)?)?;
        Some(Self {
            accessors,
            views: free,
            cuts,
        })
    }

    /// Whether a view is one of a byte.
    pub(crate) fn has_view(&self, view: usize) -> bool {
        self.views.contains(&view)
    }

    /// The bytes of the first buffer that stay.
    pub(crate) fn cut(&self, bytes: &[u8]) -> Vec<u8> {
        let mut left = Vec::with_capacity(bytes.len());
        let mut at = 0;
        for cut in &self.cuts {
            left.extend(&bytes[at..cut.start.max(at)]);
            at = cut.end;
        }
        left.extend(&bytes[at..]);
        left
    }

    /// Where a byte of the first buffer is after the cuts.
    fn moved(&self, at: usize) -> usize {
        let before = self.cuts.iter();
        let before = before.map(|cut| at.min(cut.end) - at.min(cut.start));
        at - before.sum::<usize>()
    }

    /// Changes accessors and views; those of `made_plain` are looked after elsewhere.
    pub(crate) fn edit<'a>(
        &self,
        top: &Members<'a>,
        edits: &mut Edits<'a>,
        made_plain: impl Fn(usize) -> bool,
    ) -> Result<()> {
        if self.views.is_empty() {
            return Ok(());
        }
        let accessors = top.items("accessors")?;
        for &i in &self.accessors {
            let gone = ["bufferView", "byteOffset", "sparse", "min", "max"].map(|key| (key, None));
            edits.replace(accessors[i], Members::of(accessors[i])?.with(&gone));
        }
        for (i, view) in top.items("bufferViews")?.into_iter().enumerate() {
            let members = Members::of(view)?;
            if self.views.contains(&i) {
                let changes = [
                    ("buffer", Some("0".to_owned())),
                    ("byteLength", Some("1".to_owned())),
                    ("byteOffset", None),
                    ("byteStride", None),
                    ("target", None),
                    ("extensions", members.extensions_without(&MESHOPT)?),
                ];
                edits.replace(view, members.with(&changes));
            } else if !made_plain(i) {
                self.shift(&members, edits);
                let Some(Ok(own)) = members.get("extensions").map(Members::of) else {
                    continue;
                };
                for text in MESHOPT.iter().filter_map(|name| own.get(name)) {
                    self.shift(&Members::of(text)?, edits);
                }
            }
        }
        Ok(())
    }

    /// Changes the offset of a part of the first buffer.
    fn shift<'a>(&self, part: &Members<'a>, edits: &mut Edits<'a>) {
        let number = |key: &str| part.get(key)?.parse::<usize>().ok();
        if let (Some(0), Some(at)) = (number("buffer"), number("byteOffset"))
            && let Some(text) = part.get("byteOffset").filter(|_| self.moved(at) != at)
        {
            edits.replace(text, self.moved(at).to_string());
        }
    }
}

/// The ranges of the first buffer that go: bytes of the views `free` and of no others; `None` if a view cannot be understood.
fn cuts(views: &[Value], free: &BTreeSet<usize>, length: usize) -> Option<Vec<Range<usize>>> {
    // Beginnings and ends, of views that are free, and of others.
    let mut ends: Vec<(usize, [isize; 2])> = Vec::new();
    for (i, view) in views.iter().enumerate() {
        for Part { bytes, .. } in parts(view)?.into_iter().filter(|part| part.buffer == 0) {
            let own = if free.contains(&i) { [1, 0] } else { [0, 1] };
            ends.push((bytes.start.min(length), own));
            ends.push((bytes.end.min(length), own.map(|x| -x)));
        }
    }
    ends.sort_unstable();
    let (mut cuts, mut open): (Vec<Range<usize>>, [isize; 2]) = (Vec::new(), [0; 2]);
    for pair in ends.windows(2) {
        (0..2).for_each(|i| open[i] += pair[0].1[i]);
        let between = pair[0].0..pair[1].0;
        if open[0] > 0 && open[1] == 0 && !between.is_empty() {
            match cuts.last_mut().filter(|last| last.end == between.start) {
                Some(last) => last.end = between.end,
                None => cuts.push(between),
            }
        }
    }
    for cut in &mut cuts {
        *cut = cut.start.next_multiple_of(ALIGNMENT)..cut.end / ALIGNMENT * ALIGNMENT;
    }
    cuts.retain(|cut| !cut.is_empty());
    Some(cuts)
}

/// Bytes of a buffer.
struct Part {
    buffer: usize,
    bytes: Range<usize>,
}

/// The parts of buffers that a view has, those of its compressed form included; `None` if they cannot be understood.
fn parts(view: &Value) -> Option<Vec<Part>> {
    let part = |own: &Value| {
        let start = own.get("byteOffset").map_or(Some(0), index)?;
        let end = start.checked_add(index(own.get("byteLength")?)?)?;
        Some(Part {
            buffer: index(own.get("buffer")?)?,
            bytes: start..end,
        })
    };
    let compressed = MESHOPT.iter().filter_map(|name| extension(view, name));
    std::iter::once(view).chain(compressed).map(part).collect()
}

/// Whether extensions are those of compression alone.
fn is_meshopt(extensions: &Value) -> bool {
    let own = extensions.as_object();
    own.is_some_and(|own| own.keys().all(|name| MESHOPT.contains(&&name[..])))
}

/// The parts that members of unknown meaning name.
#[derive(Default)]
struct Mentioned {
    numbers: BTreeSet<usize>,
    /// Whether anything may be.
    is_all: bool,
}

impl Mentioned {
    /// Looks through a document.
    fn in_document(&mut self, json: &Value) {
        for (key, value) in json.as_object().into_iter().flatten() {
            match &key[..] {
                "extensions" => self.in_extensions(value),
                key if KNOWN.contains(&key) => self.in_known(value),
                _ => self.in_unknown(value),
            }
        }
    }

    /// Looks through what the specification knows.
    fn in_known(&mut self, value: &Value) {
        match value {
            Value::Object(members) => {
                for (key, value) in members {
                    match &key[..] {
                        "extensions" => self.in_extensions(value),
                        "extras" => self.in_unknown(value),
                        _ => self.in_known(value),
                    }
                }
            }
            Value::Array(items) => items.iter().for_each(|item| self.in_known(item)),
            _ => {}
        }
    }

    fn in_extensions(&mut self, value: &Value) {
        for (name, own) in value.as_object().into_iter().flatten() {
            if HARMLESS.iter().any(|start| name.starts_with(start)) {
                self.in_known(own);
            } else if !MESHOPT.contains(&&name[..]) {
                self.in_unknown(own);
            }
        }
    }

    /// Looks through what may name anything.
    fn in_unknown(&mut self, value: &Value) {
        match value {
            Value::Object(members) => {
                for (key, value) in members {
                    self.word(key);
                    self.is_all |= key == "buffer" || key == "buffers" || key.starts_with("byte");
                    self.in_unknown(value);
                }
            }
            Value::Array(items) => items.iter().for_each(|item| self.in_unknown(item)),
            Value::Number(_) => self.numbers.extend(index(value)),
            Value::String(text) => self.word(text),
            _ => {}
        }
    }

    /// A name, or the way to something.
    fn word(&mut self, text: &str) {
        self.numbers.extend(text.parse::<usize>());
        self.is_all |= ["/accessors", "/buffer"]
            .iter()
            .any(|way| text.contains(way));
    }
}

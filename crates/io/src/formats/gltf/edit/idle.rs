//! Extensions of how geometry is stored that nothing in an edited document uses any more: programs that lack the decoders would refuse it
//! for nothing.
//!
//! New geometry is never compressed, quantised or encoded as polygons, so names go from the document's lists where no primitive that
//! stays needs them. Views that meshopt compressed stay, as something that nobody here knows may name them; where nothing
//! that is known does, and the extension is required, they become plain views of what they hold, so that the document
//! says the same as before to a program without the decoder; but for those of which it is known that nothing names them (`unused.rs`).

use super::geometry::Changes;
use super::rest::{Rest, STORING};
use super::unused::Unused;
use super::used::{Named, attributes, used_accessors, views_of};
use crate::flaw::Result;
use crate::formats::gltf::document::extensions::{
    LISTS, MESHOPT, extension, index, items, primitives,
};
use crate::formats::gltf::document::json::At;
use crate::formats::gltf::document::source::Source;
use crate::formats::gltf::document::text::{Edits, Members, items_of, quoted};
use serde_json::Value;
use std::borrow::Cow;
use std::collections::BTreeSet;

/// The extension that allows vertices' attributes of other types than the specification does.
const QUANTIZATION: &str = "KHR_mesh_quantization";

const FLOAT: u64 = 5126;

/// In the place of a buffer that never had bytes.
const ONE_BYTE: &str = "\"data:application/octet-stream;base64,AA==\"";

/// The parts that nothing uses any more.
pub(crate) struct Idle {
    /// Names that the document's lists lose.
    names: Vec<String>,
    /// Compressed views that become plain.
    views: Vec<PlainView>,
    /// Buffers of these that have no bytes.
    hollow: Vec<usize>,
}

/// A view that becomes plain.
struct PlainView {
    number: usize,
    bytes: Vec<u8>,
}

impl Idle {
    /// The parts of a document in which primitives are replaced that nothing uses any more.
    pub(crate) fn of(source: &Source, changes: &Changes, rest: &Rest, unused: &Unused) -> Self {
        let json = &rest.json;
        let names = rest.gone.iter().cloned().collect();
        let mut idle = Self {
            names,
            views: Vec::new(),
            hollow: Vec::new(),
        };
        if changes.primitives.is_empty() {
            return idle;
        }
        let kept: Vec<&Value> = primitives(json).collect();
        let used = used_accessors(json, &kept);
        let used = used
            .into_iter()
            .filter_map(|number| items(json, "accessors").get(number));
        let used_views: BTreeSet<usize> = used.flat_map(views_of).collect();
        let known = STORING.into_iter().chain([QUANTIZATION]).chain(MESHOPT);
        let is_in = |list: &&str, name: &str| items(json, list).iter().any(|own| own == name);
        for name in known.filter(|name| LISTS.iter().any(|list| is_in(list, name))) {
            let is_used = match name {
                QUANTIZATION => kept.iter().any(|primitive| is_quantized(json, primitive)),
                _ if STORING.contains(&name) => {
                    kept.iter().any(|own| extension(own, name).is_some())
                }
                _ => !idle.make_plain(source, name, &used_views, unused),
            };
            if !is_used {
                idle.names.push(name.to_owned());
            }
        }
        idle
    }

    /// Finds the bytes of views that meshopt compressed; `false` if the extension is still needed or there are none to be had.
    fn make_plain(
        &mut self,
        source: &Source,
        name: &str,
        used: &BTreeSet<usize>,
        unused: &Unused,
    ) -> bool {
        let json = &source.json;
        let (views, buffers) = (items(json, "bufferViews"), items(json, "buffers"));
        let has = |object: &Value| extension(object, name).is_some();
        let is_hollow = |buffer: &Value| buffer.get("uri").is_none();
        let needs = |&i: &usize| has(&views[i]) && !unused.has_view(i);
        let compressed: Vec<usize> = (0..views.len()).filter(needs).collect();
        if buffers
            .iter()
            .any(|buffer| has(buffer) && !is_hollow(buffer))
        {
            return false;
        }
        let hollow: Vec<usize> = (0..buffers.len()).filter(|&i| has(&buffers[i])).collect();
        if compressed.is_empty() && hollow.is_empty() {
            return true;
        }
        let is_read_plainly = |i: usize| {
            let of = views[i].get("buffer").and_then(index);
            let is_of_hollow = of.is_some_and(|buffer| hollow.contains(&buffer));
            !has(&views[i]) && !unused.has_view(i) && is_of_hollow
        };
        let is_required = items(json, LISTS[1]).iter().any(|own| own == name);
        if !is_required
            || compressed.iter().any(|view| used.contains(view))
            || (0..views.len()).any(is_read_plainly)
        {
            return false;
        }
        let plain = compressed.into_iter().map(|number| {
            let found = source.view(&At::root(&Value::from(number))).ok()?.bytes;
            let bytes = found.to_vec();
            Some(PlainView { number, bytes })
        });
        let Some(plain) = plain.collect::<Option<Vec<_>>>() else {
            return false;
        };
        self.views.extend(plain);
        self.hollow.extend(hollow);
        true
    }

    /// Appends the bytes of views that become plain; gives where each starts.
    pub(crate) fn append_to(&self, bytes: &mut Cow<'_, [u8]>) -> Vec<usize> {
        let mut append = |own: &PlainView| {
            let bytes = bytes.to_mut();
            bytes.resize(bytes.len().next_multiple_of(4), 0);
            let start = bytes.len();
            bytes.extend(&own.bytes);
            start
        };
        self.views.iter().map(&mut append).collect()
    }

    /// Whether a view becomes plain.
    pub(crate) fn makes_plain(&self, view: usize) -> bool {
        self.views.iter().any(|own| own.number == view)
    }

    /// Takes names from the document's lists, and makes views plain, whose bytes start at these places of a buffer.
    pub(crate) fn edit<'a>(
        &self,
        top: &Members<'a>,
        edits: &mut Edits<'a>,
        buffer: usize,
        starts: &[usize],
    ) -> Result<()> {
        let views = top.items("bufferViews")?;
        for (own, start) in self.views.iter().zip(starts) {
            let members = Members::of(views[own.number])?;
            let changes = [
                ("buffer", Some(buffer.to_string())),
                ("byteOffset", Some(start.to_string())),
                ("byteLength", Some(own.bytes.len().to_string())),
                ("extensions", members.extensions_without(&MESHOPT)?),
            ];
            edits.replace(views[own.number], members.with(&changes));
        }
        let buffers = top.items("buffers")?;
        let is_hollow = |&i: &usize| self.hollow.contains(&i);
        let mut ends = (1..=buffers.len()).rev();
        let end = ends.find(|end| *end == 1 || !is_hollow(&(end - 1)));
        let end = end.unwrap_or(buffers.len());
        // None is appended where the new bytes are in the first: numbers stay.
        let is_cut = buffer == 0 && end < buffers.len();
        if is_cut {
            edits.truncate(&buffers, end);
        }
        for &i in self.hollow.iter().filter(|&&i| !is_cut || i < end) {
            let members = Members::of(buffers[i])?;
            let changes = [
                ("uri", Some(ONE_BYTE.to_owned())),
                ("byteLength", Some("1".to_owned())),
                ("extensions", members.extensions_without(&MESHOPT)?),
            ];
            edits.replace(buffers[i], members.with(&changes));
        }
        let mut empty = Vec::new();
        for key in LISTS {
            let Some(list) = top.get(key) else { continue };
            // Whatever else stands there is not ours to judge.
            let Ok(names) = items_of(list) else { continue };
            let is_kept = |own: &&str| !self.names.iter().any(|name| **own == quoted(name));
            let kept: Vec<&str> = names.iter().copied().filter(is_kept).collect();
            match kept.len() {
                same if same == names.len() => {}
                // An empty list is not allowed.
                0 => empty.push(key),
                _ => edits.replace(list, format!("[{}]", kept.join(","))),
            }
        }
        edits.remove(edits.document(), &empty)
    }
}

/// Whether a primitive has attributes that only [`QUANTIZATION`] allows.
fn is_quantized(json: &Value, primitive: &Value) -> bool {
    attributes(primitive).any(
        |Named {
             name,
             accessor,
             is_of_target,
         }| {
            let accessor = index(accessor).and_then(|number| items(json, "accessors").get(number));
            let Some(accessor) = accessor else {
                return false;
            };
            // What is broken is not quantised.
            let kind = accessor.get("componentType").and_then(Value::as_u64);
            let kind = kind.unwrap_or(FLOAT);
            let is_normalized = accessor.get("normalized").is_some_and(|own| own == true);
            match name.split_once('_').map_or(name, |(kind, _)| kind) {
                "POSITION" | "NORMAL" | "TANGENT" => kind != FLOAT,
                // Unsigned fractions are in the specification itself, for targets signed ones, too.
                "TEXCOORD" => {
                    let is_fraction =
                        is_normalized && (is_of_target || matches!(kind, 5121 | 5123));
                    kind != FLOAT && !is_fraction
                }
                _ => false,
            }
        },
    )
}

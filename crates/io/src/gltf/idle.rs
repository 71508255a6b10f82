//! Extensions of how geometry is stored that nothing in an edited document uses any more: programs that lack the decoders would refuse it
//! for nothing.
//!
//! What is written is never compressed, quantised or encoded as polygons, so names go from the document's lists where no primitive that
//! stays needs them. Views that meshopt compressed stay, as something that nobody here knows may name them; where nothing
//! that is known does, and the extension is required, they become plain views of what they hold, so that the document
//! says the same as before to a program without the decoder; but for those of which it is known that nothing names them (`unused.rs`).

use super::changes::Changes;
use super::edit::{Edits, Members, items_of, quoted};
use super::flaw::Result;
use super::json::At;
use super::rest::{Rest, STORING};
use super::source::{MESHOPT, Source};
use super::unused::Unused;
use serde_json::Value;
use std::collections::BTreeSet;

/// The extension that allows vertices' attributes of other types than the specification does.
const QUANTIZATION: &str = "KHR_mesh_quantization";

/// The document's lists of extensions.
const LISTS: [&str; 2] = ["extensionsUsed", "extensionsRequired"];

/// What instances of a mesh are placed by.
const INSTANCING: &str = "EXT_mesh_gpu_instancing";

const FLOAT: u64 = 5126;

/// In the place of a buffer that never had bytes.
const ONE_BYTE: &str = "\"data:application/octet-stream;base64,AA==\"";

/// What nothing uses any more.
pub(super) struct Idle {
    /// Names that the document's lists lose.
    names: Vec<String>,
    /// Compressed views that become plain: their numbers, and their bytes.
    views: Vec<(usize, Vec<u8>)>,
    /// Buffers of these that have no bytes.
    hollow: Vec<usize>,
}

impl Idle {
    /// What nothing uses any more of a document in which primitives are replaced.
    pub(super) fn of(source: &Source, (changes, rest, unused): (&Changes, &Rest, &Unused)) -> Self {
        let json = &rest.json;
        let mut idle = Self {
            names: rest.gone.iter().cloned().collect(),
            views: Vec::new(),
            hollow: Vec::new(),
        };
        if changes.primitives.is_empty() {
            return idle;
        }
        let kept: Vec<&Value> = items(json, "meshes")
            .iter()
            .flat_map(|mesh| items(mesh, "primitives"))
            .collect();
        let used = used_views(json, &kept);
        for name in listed(json) {
            let is_used = match name {
                QUANTIZATION => kept.iter().any(|primitive| is_quantized(json, primitive)),
                _ if STORING.contains(&name) => kept.iter().any(|primitive| has(primitive, name)),
                _ => !idle.make_plain(source, name, (&used, unused)),
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
        (used, unused): (&BTreeSet<usize>, &Unused),
    ) -> bool {
        let json = &source.json;
        let (views, buffers) = (items(json, "bufferViews"), items(json, "buffers"));
        let needs = |&i: &usize| has(&views[i], name) && !unused.has_view(i);
        let compressed: Vec<usize> = (0..views.len()).filter(needs).collect();
        let hollow: Vec<usize> = (0..buffers.len())
            .filter(|&i| has(&buffers[i], name) && buffers[i].get("uri").is_none())
            .collect();
        if buffers
            .iter()
            .any(|buffer| has(buffer, name) && buffer.get("uri").is_some())
        {
            return false;
        }
        if compressed.is_empty() && hollow.is_empty() {
            return true;
        }
        let is_read_plainly = |i: usize| {
            let (view, of) = (&views[i], views[i].get("buffer").and_then(index));
            !has(view, name)
                && !unused.has_view(i)
                && of.is_some_and(|buffer| hollow.contains(&buffer))
        };
        let is_required = items(json, LISTS[1]).iter().any(|own| own == name);
        if !is_required
            || compressed.iter().any(|view| used.contains(view))
            || (0..views.len()).any(is_read_plainly)
        {
            return false;
        }
        let bytes = |i: usize| {
            let number = Value::from(i);
            Some((i, source.view(&At::root(&number)).ok()?.bytes.to_vec()))
        };
        let Some(plain) = compressed
            .into_iter()
            .map(bytes)
            .collect::<Option<Vec<_>>>()
        else {
            return false;
        };
        self.views.extend(plain);
        self.hollow.extend(hollow);
        true
    }

    /// Appends the bytes of views that become plain; gives where each starts.
    pub(super) fn append_to(&self, bytes: &mut Vec<u8>) -> Vec<usize> {
        let mut append = |own: &[u8]| {
            bytes.resize(bytes.len().next_multiple_of(4), 0);
            let start = bytes.len();
            bytes.extend(own);
            start
        };
        self.views.iter().map(|(_, own)| append(own)).collect()
    }

    /// Whether a view becomes plain.
    pub(super) fn makes_plain(&self, view: usize) -> bool {
        self.views.iter().any(|(own, _)| *own == view)
    }

    /// Whether views become plain.
    pub(super) fn has_views(&self) -> bool {
        !self.views.is_empty()
    }

    /// Takes names from the document's lists, and makes views plain, whose bytes start at these places of a buffer.
    pub(super) fn edit<'a>(
        &self,
        (text, top): (&'a str, &Members<'a>),
        edits: &mut Edits<'a>,
        (buffer, starts): (usize, &[usize]),
    ) -> Result<()> {
        let texts = |key: &str| top.get(key).map_or_else(|| Ok(Vec::new()), items_of);
        let views = texts("bufferViews")?;
        for ((i, bytes), start) in self.views.iter().zip(starts) {
            let members = Members::of(views[*i])?;
            let changes = [
                ("buffer", Some(buffer.to_string())),
                ("byteOffset", Some(start.to_string())),
                ("byteLength", Some(bytes.len().to_string())),
                ("extensions", without(&members, &MESHOPT)?),
            ];
            edits.replace(views[*i], members.with(&changes));
        }
        let buffers = texts("buffers")?;
        let is_hollow = |&i: &usize| self.hollow.contains(&i);
        let end = (1..=buffers.len())
            .rev()
            .find(|end| *end == 1 || !is_hollow(&(end - 1)))
            .unwrap_or(0);
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
                ("extensions", without(&members, &MESHOPT)?),
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
        edits.remove(text.trim_ascii(), &empty)
    }
}

/// The extensions of an object without some of them; `None` where none is left.
pub(super) fn without(members: &Members<'_>, names: &[&str]) -> Result<Option<String>> {
    let Some(text) = members.get("extensions") else {
        return Ok(None);
    };
    let own = Members::of(text)?;
    let changes: Vec<(&str, Option<String>)> = names.iter().map(|&name| (name, None)).collect();
    let is_left = own.0.iter().any(|(key, _)| !names.contains(&&key[..]));
    Ok(is_left.then(|| own.with(&changes)))
}

/// Extensions that are looked after here and that one of the document's lists has.
fn listed(json: &Value) -> Vec<&'static str> {
    let known = STORING.into_iter().chain([QUANTIZATION]).chain(MESHOPT);
    let is_listed = |name: &&str| {
        LISTS
            .iter()
            .any(|list| items(json, list).iter().any(|own| own == name))
    };
    known.filter(is_listed).collect()
}

/// Views that accessors name which these primitives, animations, skins and instances do.
fn used_views(json: &Value, primitives: &[&Value]) -> BTreeSet<usize> {
    let accessors =
        used_accessors(json, primitives).filter_map(|number| items(json, "accessors").get(number));
    accessors.flat_map(views_of).collect()
}

/// Accessors that these primitives, animations, skins and instances name.
pub(super) fn used_accessors(json: &Value, primitives: &[&Value]) -> impl Iterator<Item = usize> {
    let mut accessors: Vec<&Value> = Vec::new();
    for primitive in primitives {
        accessors.extend(primitive.get("indices"));
        accessors.extend(attributes(primitive).map(|(_, accessor, _)| accessor));
    }
    for animation in items(json, "animations") {
        let samplers = items(animation, "samplers").iter();
        accessors.extend(
            samplers
                .flat_map(|sampler| ["input", "output"].map(|key| sampler.get(key)))
                .flatten(),
        );
    }
    accessors.extend(
        items(json, "skins")
            .iter()
            .filter_map(|skin| skin.get("inverseBindMatrices")),
    );
    for node in items(json, "nodes") {
        let instances = node
            .get("extensions")
            .and_then(|own| own.get(INSTANCING)?.get("attributes")?.as_object());
        accessors.extend(instances.into_iter().flat_map(|own| own.values()));
    }
    let numbers: Vec<usize> = accessors.into_iter().filter_map(index).collect();
    numbers.into_iter()
}

/// The views that an accessor names.
pub(super) fn views_of(accessor: &Value) -> impl Iterator<Item = usize> {
    let sparse = |key: &str| accessor.get("sparse")?.get(key)?.get("bufferView");
    let views = [
        accessor.get("bufferView"),
        sparse("indices"),
        sparse("values"),
    ];
    views.into_iter().flatten().filter_map(index)
}

/// By attribute of a primitive and of its morph targets: name, accessor, and whether it is a target's.
fn attributes(primitive: &Value) -> impl Iterator<Item = (&str, &Value, bool)> {
    let own = primitive
        .get("attributes")
        .into_iter()
        .map(|own| (own, false));
    let all = own.chain(items(primitive, "targets").iter().map(|own| (own, true)));
    all.flat_map(|(own, is_target)| {
        let members = own.as_object().into_iter().flatten();
        members.map(move |(name, accessor)| (&name[..], accessor, is_target))
    })
}

/// Whether a primitive has attributes that only [`QUANTIZATION`] allows.
fn is_quantized(json: &Value, primitive: &Value) -> bool {
    attributes(primitive).any(|(name, number, is_target)| {
        let accessor = index(number).and_then(|number| items(json, "accessors").get(number));
        let Some(accessor) = accessor else {
            return false;
        };
        let kind = accessor
            .get("componentType")
            .and_then(Value::as_u64)
            .unwrap_or(FLOAT);
        let is_normalized = accessor.get("normalized").is_some_and(|own| own == true);
        match name.split_once('_').map_or(name, |(kind, _)| kind) {
            "POSITION" | "NORMAL" | "TANGENT" => kind != FLOAT,
            // Unsigned fractions are in the specification itself, for targets signed ones, too.
            "TEXCOORD" => {
                kind != FLOAT && !(is_normalized && (is_target || matches!(kind, 5121 | 5123)))
            }
            _ => false,
        }
    })
}

/// Whether an object has an extension.
fn has(object: &Value, name: &str) -> bool {
    object
        .get("extensions")
        .is_some_and(|own| own.get(name).is_some())
}

/// The items of an array; none where there is none.
pub(super) fn items<'a>(object: &'a Value, key: &str) -> &'a [Value] {
    object
        .get(key)
        .and_then(Value::as_array)
        .map_or(&[], Vec::as_slice)
}

/// A number of an item, if it is one.
pub(super) fn index(value: &Value) -> Option<usize> {
    usize::try_from(value.as_u64()?).ok()
}

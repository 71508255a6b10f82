//! Extensions that say something of nodes, meshes, skins, animations, cameras and scenes, of a document that has others in their places.
//!
//! Their contents go with them. What the document's own `extensions` hold stays unless it has a member that is called as if it
//! named some: what that would name now is another, or none. A name goes from the document's lists where nothing that stays has it.

use super::document::extensions::{LOD, names_in};
use super::document::text::Members;
use crate::flaw::Result;
use serde_json::Value;
use std::collections::BTreeSet;

/// The arrays that the document has others of.
const ARRAYS: [&str; 6] = [
    "nodes",
    "meshes",
    "skins",
    "animations",
    "cameras",
    "scenes",
];

/// Parts of the names, in whatever case, of members that name items of these, or bones.
const NAMING: [&str; 8] = [
    "node",
    "mesh",
    "skin",
    "animation",
    "camera",
    "scene",
    "joint",
    "bone",
];

/// The parts that go.
#[derive(Default)]
pub(super) struct Gone {
    /// Extensions of the document itself.
    root: Vec<String>,
    /// Names that its lists lose.
    pub(super) names: BTreeSet<String>,
}

impl Gone {
    /// The parts of a document that go.
    pub(super) fn of(json: &Value) -> Self {
        let own = json.get("extensions").and_then(Value::as_object);
        let own = own.into_iter().flatten();
        let (root, kept): (Vec<_>, Vec<_>) = own.partition(|(_, value)| names_some(value));
        let root: Vec<String> = root.into_iter().map(|(name, _)| name.clone()).collect();
        let mut names: BTreeSet<String> = root.iter().cloned().chain([LOD.to_owned()]).collect();
        let mut needed = BTreeSet::new();
        for (name, value) in kept {
            needed.insert(name.clone());
            names_in(value, &mut needed);
        }
        let members = json.as_object().into_iter().flatten();
        for (key, value) in members.filter(|(key, _)| *key != "extensions") {
            let goes = ARRAYS.contains(&&key[..]);
            names_in(value, if goes { &mut names } else { &mut needed });
        }
        Self {
            root,
            names: &names - &needed,
        }
    }

    /// The document's own extensions without those that go; `None` where none is left.
    pub(super) fn left_of_root(&self, top: &Members<'_>) -> Result<Option<String>> {
        let names: Vec<&str> = self.root.iter().map(|name| &name[..]).collect();
        top.extensions_without(&names)
    }
}

/// Whether a value has a member, however deep, that is called as if it named some.
fn names_some(value: &Value) -> bool {
    match value {
        Value::Object(members) => members.iter().any(|(key, value)| {
            let key = key.to_ascii_lowercase();
            NAMING.iter().any(|name| key.contains(name)) || names_some(value)
        }),
        Value::Array(items) => items.iter().any(names_some),
        _ => false,
    }
}

//! The rest of a document whose primitives are replaced: the document without their geometry, and without what extensions say of
//! triangles and vertices that are no more.
//!
//! Takes the document and the numbers of the primitives; gives the JSON that is left, which is looked at and never written, what is reported
//! of it, and the extensions of a mesh, a primitive or a scene as they are written. Extensions of how geometry was stored go unreported, as
//! nothing is lost with them.

use super::geometry::{Changes, PrimitiveAddress};
use crate::flaw::Result;
use crate::formats::gltf::document::extensions::{
    DRACO, LOOPS, NGONS, extension, index, items, items_mut, names_in,
};
use crate::formats::gltf::document::text::{Edits, Members, items_of};
use serde_json::Value;
use std::collections::BTreeSet;

/// Extensions of how the triangles and polygons of a primitive are stored.
pub(crate) const STORING: [&str; 3] = [DRACO, NGONS, LOOPS];

/// Extensions that name vertices, edges or triangles of a primitive or of a mesh by their numbers, wherever they stand.
const NAMING: [&str; 5] = [
    "CESIUM_mesh_vector",
    "CESIUM_primitive_outline",
    "EXT_mesh_bmesh",
    "EXT_mesh_manifold",
    "EXT_mesh_primitive_edge_visibility",
];

/// Extensions of a mesh that have other indices for several of its primitives together; as a mark of a primitive, that its indices have
/// gaps.
const RESTART: [&str; 2] = ["EXT_mesh_primitive_restart", "KHR_mesh_primitive_restart"];

/// The extension of a mesh whose vertices follow those of another.
const LINKING: &str = "MPEG_mesh_linking";

/// The extension of a scene that counts its vertices and triangles.
const COUNTING: &str = "FB_geometry_metadata";

/// The extension of a primitive that says what its vertices belong to: by an attribute, by a texture, or else by their numbers.
const FEATURES: &str = "EXT_mesh_features";

/// The rest of the document.
#[derive(Debug, Default)]
pub(crate) struct Rest {
    /// The document without what goes.
    pub(crate) json: Value,
    /// Extensions that go with what they said, and nothing that stays has any more.
    pub(crate) gone: BTreeSet<String>,
    /// The parts that go, for people.
    pub(crate) left_out: BTreeSet<String>,
}

impl Rest {
    /// The rest of a document in which primitives are replaced.
    pub(crate) fn of(json: &Value, changes: &Changes) -> Self {
        let mut rest = Self {
            json: json.clone(),
            ..Self::default()
        };
        if changes.primitives.is_empty() {
            return rest;
        }
        let is_new = |mesh, primitive| {
            changes
                .primitives
                .contains_key(&PrimitiveAddress { mesh, primitive })
        };
        let is_changed = |mesh: usize| changes.primitives.keys().any(|own| own.mesh == mesh);
        let mut removed = BTreeSet::new();
        for (i, mesh) in items_mut(&mut rest.json, "meshes").iter_mut().enumerate() {
            for (j, primitive) in items_mut(mesh, "primitives").iter_mut().enumerate() {
                if !is_new(i, j) {
                    continue;
                }
                if let Some(members) = primitive.as_object_mut() {
                    let geometry = ["attributes", "indices", "targets"];
                    members.retain(|key, _| !geometry.contains(&&key[..]));
                }
                take(primitive, |name, _| STORING.contains(&name));
                removed.extend(take(primitive, |name, _| is_stale(name)));
                rest.left_out.extend(without_numbered(primitive));
            }
            removed.extend(take(mesh, |name, own| match name {
                LINKING => is_changed(i) || own.get("mesh").and_then(index).is_some_and(is_changed),
                name if RESTART.contains(&name) => grouped(own).any(|j| is_new(i, j)),
                name => is_changed(i) && NAMING.contains(&name),
            }));
        }
        for scene in items_mut(&mut rest.json, "scenes") {
            removed.extend(take(scene, |name, _| name == COUNTING));
        }
        let mut left = BTreeSet::new();
        names_in(&rest.json, &mut left);
        rest.gone = &removed - &left;
        rest.left_out.extend(removed);
        rest
    }

    /// The new text of a mesh's, a primitive's or a scene's extensions, given its members and what stays of it.
    pub(crate) fn extensions(rest: &Value, members: &Members<'_>) -> Result<Extensions> {
        // Whatever else stands there is not ours to judge.
        let Some(Ok(own)) = members.get("extensions").map(Members::of) else {
            return Ok(Extensions::Same);
        };
        let mut changes = Vec::new();
        for (name, text) in &own.0 {
            match extension(rest, name) {
                None => changes.push((&name[..], None)),
                Some(rest) if name == FEATURES => {
                    changes.extend(numbered_taken(rest, text)?.map(|new| (FEATURES, Some(new))));
                }
                Some(_) => {}
            }
        }
        let goes = |name: &str| changes.contains(&(name, None));
        Ok(match changes.is_empty() {
            true => Extensions::Same,
            false if own.0.iter().all(|(name, _)| goes(name)) => Extensions::Gone,
            false => Extensions::New(own.with(&changes)),
        })
    }

    /// Takes what goes from the extensions of meshes and scenes.
    pub(crate) fn edit<'a>(&self, top: &Members<'a>, edits: &mut Edits<'a>) -> Result<()> {
        if self.left_out.is_empty() {
            return Ok(());
        }
        for key in ["meshes", "scenes"] {
            for (i, item) in top.items(key)?.into_iter().enumerate() {
                let members = Members::of(item)?;
                match Self::extensions(&self.json[key][i], &members)? {
                    Extensions::Same => {}
                    Extensions::Gone => edits.remove(item, &["extensions"])?,
                    Extensions::New(new) => {
                        if let Some(old) = members.get("extensions") {
                            edits.replace(old, new);
                        }
                    }
                }
            }
        }
        Ok(())
    }
}

/// The fate of the extensions of an object.
pub(crate) enum Extensions {
    Same,
    /// None is left.
    Gone,
    New(String),
}

/// Whether an extension of a primitive says something of its triangles or vertices by their numbers.
fn is_stale(name: &str) -> bool {
    NAMING.contains(&name) || RESTART.contains(&name) || name == LINKING
}

/// Takes from an object the extensions that are to go; gives their names.
fn take(object: &mut Value, goes: impl Fn(&str, &Value) -> bool) -> Vec<String> {
    let Some(own) = object.get_mut("extensions").and_then(Value::as_object_mut) else {
        return Vec::new();
    };
    let names = own.iter().filter(|(name, own)| goes(name, own));
    let names: Vec<String> = names.map(|(name, _)| name.clone()).collect();
    names.iter().for_each(|name| drop(own.remove(name)));
    names
}

/// The numbers of the primitives in the groups of a mesh.
fn grouped(extension: &Value) -> impl Iterator<Item = usize> {
    let groups = items(extension, "primitiveGroups").iter();
    let all = groups.flat_map(|group| items(group, "primitives"));
    all.filter_map(index)
}

/// Takes from a primitive the sets of features that go by the numbers of its vertices, and the extension if it has no others; gives what is
/// reported.
fn without_numbered(primitive: &mut Value) -> Option<String> {
    let features = primitive.get_mut("extensions")?.get_mut(FEATURES)?;
    let sets = features.get_mut("featureIds")?.as_array_mut()?;
    let before = sets.len();
    sets.retain(|set| !is_numbered(set));
    let (is_changed, is_empty) = (sets.len() < before, sets.is_empty());
    if is_changed && is_empty {
        take(primitive, |name, _| name == FEATURES);
    }
    is_changed.then(|| format!("{FEATURES} by vertex number"))
}

/// Whether a set of features goes by the numbers of vertices.
fn is_numbered(set: &Value) -> bool {
    set.is_object() && set.get("attribute").is_none() && set.get("texture").is_none()
}

/// The text of an extension without the sets that go by numbers, if it had any.
fn numbered_taken(rest: &Value, text: &str) -> Result<Option<String>> {
    let members = Members::of(text)?;
    let Some(list) = members.get("featureIds") else {
        return Ok(None);
    };
    let sets = items_of(list)?;
    let stay = rest.get("featureIds").and_then(Value::as_array);
    if stay.is_none_or(|stay| stay.len() == sets.len()) {
        return Ok(None);
    }
    let is_kept = |set: &&str| serde_json::from_str(set).is_ok_and(|set: Value| !is_numbered(&set));
    let kept: Vec<&str> = sets.into_iter().filter(is_kept).collect();
    let kept = format!("[{}]", kept.join(","));
    Ok(Some(members.with(&[("featureIds", Some(kept))])))
}

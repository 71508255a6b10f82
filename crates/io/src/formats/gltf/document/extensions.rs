//! Values of a document without their places, for those who only look whether something is there; and the extensions that several know.

use serde_json::Value;
use std::collections::BTreeSet;

/// Of primitives that are compressed.
pub(crate) const DRACO: &str = "KHR_draco_mesh_compression";

/// Of primitives whose triangles stand in the order of polygons.
pub(crate) const NGONS: &str = "FB_ngon_encoding";

/// Of primitives that name the loops of polygons.
pub(crate) const LOOPS: &str = "EXT_mesh_polygon";

/// Names under which meshopt compression of views is known.
pub(crate) const MESHOPT: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// The extension that places instances of a mesh.
pub(crate) const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// The extension that shifts, turns and scales texture coordinates, or names others.
pub(crate) const TRANSFORM: &str = "KHR_texture_transform";

/// Levels of detail.
pub(crate) const LOD: &str = "MSFT_lod";

/// The document's lists of extensions.
pub(crate) const LISTS: [&str; 2] = ["extensionsUsed", "extensionsRequired"];

/// The items of an array; none where there is none.
pub(crate) fn items<'a>(object: &'a Value, key: &str) -> &'a [Value] {
    let found = object.get(key).and_then(Value::as_array);
    found.map_or(&[], Vec::as_slice)
}

/// The items of an array, to be changed; none where there is none.
pub(crate) fn items_mut<'a>(object: &'a mut Value, key: &str) -> &'a mut [Value] {
    let found = object.get_mut(key).and_then(Value::as_array_mut);
    found.map_or(&mut [], Vec::as_mut_slice)
}

/// The primitives of all meshes.
pub(crate) fn primitives(json: &Value) -> impl Iterator<Item = &Value> {
    let all = items(json, "meshes").iter();
    all.flat_map(|mesh| items(mesh, "primitives"))
}

/// A number of an item, if it is one.
pub(crate) fn index(value: &Value) -> Option<usize> {
    usize::try_from(value.as_u64()?).ok()
}

/// The value of an extension of an object.
pub(crate) fn extension<'a>(object: &'a Value, name: &str) -> Option<&'a Value> {
    object.get("extensions")?.get(name)
}

/// Adds the names of all extensions of a value and of what is in it.
pub(crate) fn names_in(value: &Value, names: &mut BTreeSet<String>) {
    match value {
        Value::Object(members) => {
            for (key, value) in members {
                if let ("extensions", Value::Object(own)) = (&key[..], value) {
                    names.extend(own.keys().cloned());
                }
                names_in(value, names);
            }
        }
        Value::Array(items) => items.iter().for_each(|item| names_in(item, names)),
        _ => {}
    }
}

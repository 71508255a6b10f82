//! Which accessors and views a document's own members name, whatever its extensions say.

use crate::formats::gltf::document::extensions::{INSTANCING, extension, index, items};
use serde_json::Value;
use std::collections::BTreeSet;

/// An attribute of a primitive, or of one of its morph targets.
pub(super) struct Named<'a> {
    pub(super) name: &'a str,
    /// Its accessor, as the document names it.
    pub(super) accessor: &'a Value,
    pub(super) is_of_target: bool,
}

/// The attributes of a primitive and of its morph targets.
pub(super) fn attributes(primitive: &Value) -> impl Iterator<Item = Named<'_>> {
    let all = primitive.get("attributes").into_iter();
    let own = all.map(|own| (own, false));
    let all = own.chain(items(primitive, "targets").iter().map(|own| (own, true)));
    all.flat_map(|(own, is_of_target)| {
        let members = own.as_object().into_iter().flatten();
        members.map(move |(name, accessor)| Named {
            name,
            accessor,
            is_of_target,
        })
    })
}

/// Accessors that these primitives, animations, skins and instances name.
pub(super) fn used_accessors(json: &Value, primitives: &[&Value]) -> BTreeSet<usize> {
    let mut accessors: Vec<&Value> = Vec::new();
    for primitive in primitives {
        accessors.extend(primitive.get("indices"));
        accessors.extend(attributes(primitive).map(|own| own.accessor));
    }
    for sampler in items(json, "animations")
        .iter()
        .flat_map(|own| items(own, "samplers"))
    {
        accessors.extend(
            ["input", "output"]
                .iter()
                .filter_map(|key| sampler.get(key)),
        );
    }
    accessors.extend(
        items(json, "skins")
            .iter()
            .filter_map(|own| own.get("inverseBindMatrices")),
    );
    for node in items(json, "nodes") {
        let instances = extension(node, INSTANCING).and_then(|own| own.get("attributes"));
        let instances = instances.and_then(Value::as_object).into_iter().flatten();
        accessors.extend(instances.map(|(_, accessor)| accessor));
    }
    accessors.into_iter().filter_map(index).collect()
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

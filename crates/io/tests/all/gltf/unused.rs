//! Bytes of geometry that was replaced and that nothing names are gone from files that are written anew; everything else is where its
//! numbers say.

use super::support::{TRIANGLE, glb, parts};
use crate::support::shared;
use limitmesh_io::{Asset, Format};
use serde_json::{Value, json};

/// Bytes of the triangle: three positions, and three indices of two bytes with what fills them up to a multiple of four.
const NEW: usize = 36 + 8;

/// Text and first buffer after some primitives got a triangle.
fn edited(bytes: &[u8], is_replaced: impl Fn(usize, usize) -> bool) -> (Value, Vec<u8>) {
    let mut asset = Asset::from_bytes(bytes, None).unwrap();
    let contents = asset.contents().unwrap();
    for (i, mesh) in contents.meshes.iter().enumerate() {
        for j in (0..mesh.primitives.len()).filter(|&j| is_replaced(i, j)) {
            asset.replace(i, j, &TRIANGLE).unwrap();
        }
    }
    let (text, bin) = parts(&asset.to_bytes(Format::Glb).unwrap());
    (serde_json::from_str(&text).unwrap(), bin)
}

fn number(object: &Value, key: &str) -> usize {
    object
        .get(key)
        .map_or(0, |own| own.as_u64().unwrap() as usize)
}

fn view<'a>(document: &Value, bin: &'a [u8], number_of: usize) -> &'a [u8] {
    let view = &document["bufferViews"][number_of];
    let start = number(view, "byteOffset");
    &bin[start..start + number(view, "byteLength")]
}

/// Two primitives with positions and indices of their own, an image between their bytes, and an animation behind them.
fn document() -> (Value, Vec<u8>) {
    let lengths = [640, 321, 100, 480, 60, 32];
    let mut bin = Vec::new();
    let mut views = Vec::new();
    for (i, &length) in lengths.iter().enumerate() {
        bin.resize(bin.len().next_multiple_of(4), 0xee);
        views.push(
            json!({"buffer": 0, "byteOffset": bin.len(), "byteLength": length, "name": format!("view {i}")}),
        );
        bin.extend((0..length).map(|at| (i * 40 + at % 37) as u8));
    }
    let accessor = |view: usize, kind: usize, count: usize, shape: &str| {
        let [view, kind, count] = [view, kind, count].map(Value::from);
        json!({"bufferView": view, "componentType": kind, "count": count, "type": shape})
    };
    let mut position = accessor(0, 5126, 53, "VEC3");
    (position["min"], position["max"]) = (json!([0, 0, 0]), json!([1, 1, 1]));
    let document = json!({
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": bin.len(), "name": "all"}],
        "bufferViews": views,
        "accessors": [
            position, accessor(2, 5121, 99, "SCALAR"), accessor(3, 5126, 40, "VEC3"), accessor(4, 5121, 60, "SCALAR"),
            accessor(5, 5126, 8, "SCALAR"),
        ],
        "images": [{"bufferView": 1, "mimeType": "image/png"}],
        "meshes": [{"primitives": [
            {"attributes": {"POSITION": 0}, "indices": 1}, {"attributes": {"POSITION": 2}, "indices": 3},
        ]}],
        "animations": [{"channels": [], "samplers": [{"input": 4, "output": 4}]}],
    });
    (document, bin)
}

#[test]
fn bytes_that_nothing_names_are_gone_and_others_are_where_they_are_said_to_be() {
    let (old, old_bin) = document();
    let file = glb(&old.to_string(), &old_bin);
    let (new, bin) = edited(&file, |_, primitive| primitive == 0);
    for kept in [1, 3, 4, 5] {
        assert_eq!(
            view(&new, &bin, kept),
            view(&old, &old_bin, kept),
            "view {kept}"
        );
        assert_eq!(number(&new["bufferViews"][kept], "byteOffset") % 4, 0);
        assert_eq!(
            new["bufferViews"][kept]["name"],
            old["bufferViews"][kept]["name"]
        );
    }
    // Numbers stay, and what is not needed is as small as can be.
    assert_eq!(
        (
            new["accessors"].as_array().unwrap().len(),
            new["bufferViews"].as_array().unwrap().len()
        ),
        (7, 8)
    );
    for (gone, accessor) in [(0, 0), (2, 1)] {
        assert_eq!(
            new["bufferViews"][gone],
            json!({"buffer": 0, "byteLength": 1, "name": format!("view {gone}")})
        );
        for key in ["bufferView", "min", "max"] {
            assert!(new["accessors"][accessor].get(key).is_none(), "{new}");
        }
    }
    assert_eq!(
        new["accessors"].as_array().unwrap()[2..5],
        old["accessors"].as_array().unwrap()[2..]
    );
    // All of the first view; of the other what alignment leaves.
    let saved = old_bin.len() + NEW - bin.len();
    assert!((716..=724).contains(&saved), "{saved}");
    let (new, bin) = edited(&file, |_, _| true);
    for kept in [1, 5] {
        assert_eq!(
            view(&new, &bin, kept),
            view(&old, &old_bin, kept),
            "view {kept}"
        );
    }
    assert_eq!(edited(&file, |_, _| false), (old, old_bin));
}

#[test]
fn what_something_unknown_may_name_stays() {
    let (old, old_bin) = document();
    let length = |change: &dyn Fn(&mut Value)| {
        let mut document = old.clone();
        change(&mut document);
        let file = glb(&document.to_string(), &old_bin);
        let (new, bin) = edited(&file, |_, primitive| primitive == 0);
        (new, old_bin.len() + NEW - bin.len())
    };
    // An accessor by its number, and with it its view.
    let (new, saved) = length(&|document| {
        document["nodes"] = json!([{"extensions": {"ODD_thing": {"of": [[0]]}}}])
    });
    assert!(
        new["accessors"][0] == old["accessors"][0]
            && new["bufferViews"][0] == old["bufferViews"][0],
        "{new}"
    );
    assert!((64..100).contains(&saved), "{saved}");
    // A view; by a key; anything, by a way or in bytes.
    let all: [(&str, Value); 4] = [
        ("extras", json!({"view": 0, "other": 2})),
        ("extras", json!({"0": true, "2": true})),
        ("extensions", json!({"ODD_thing": {"at": "/accessors/0"}})),
        (
            "extensions",
            json!({"ODD_thing": {"buffer": 0, "byteOffset": 4}}),
        ),
    ];
    for (key, value) in all {
        let (new, saved) = length(&|document| document[key] = value.clone());
        assert!(saved <= 3, "{key} {value}: {saved}");
        assert_eq!(new["bufferViews"][0], old["bufferViews"][0]);
    }
    // Materials name textures.
    let material = json!([{"extensions": {"KHR_materials_ior": {"ior": 0}}}]);
    assert!(length(&|document| document["materials"] = material.clone()).1 > 700);
    // Another accessor that has a part of the same bytes.
    let (new, saved) = length(&|document| document["accessors"][2]["bufferView"] = json!(0));
    assert!(
        saved < 100 && new["accessors"][0] == old["accessors"][0],
        "{saved}: {new}"
    );
}

#[test]
fn real_assets_keep_what_they_use() {
    let names = [
        "duck.glb",
        "assets/BoxTextured.glb",
        "assets/BoxMeshopt.glb",
        "assets/pirate.glb",
        "assets/monkey.glb",
    ];
    for name in names {
        let Some(path) = shared(name) else { continue };
        let file = std::fs::read(path).unwrap();
        let (text, old_bin) = parts(&file);
        let old: Value = serde_json::from_str(&text).unwrap();
        let (new, bin) = edited(&file, |_, _| true);
        let images = new
            .get("images")
            .and_then(Value::as_array)
            .into_iter()
            .flatten();
        let mut used = 0;
        for image in images.filter(|image| image.get("bufferView").is_some()) {
            let at = number(image, "bufferView");
            assert_eq!(view(&new, &bin, at), view(&old, &old_bin, at), "{name}");
            used += view(&new, &bin, at).len();
        }
        for view in new["bufferViews"]
            .as_array()
            .unwrap()
            .iter()
            .filter(|view| view["buffer"] == 0)
        {
            assert!(
                number(view, "byteOffset") + number(view, "byteLength") <= bin.len(),
                "{name}: {view}"
            );
        }
        println!(
            "{name}: {} bytes became {}, {used} in use",
            old_bin.len(),
            bin.len()
        );
        if name == "duck.glb" {
            assert!(bin.len() < used + NEW + 64, "{} bytes", bin.len());
        }
    }
}

//! Extensions of how geometry is stored leave an edited document's lists when nothing uses them any more, and not before.

use super::support::{TRIANGLE, floats, glb, parts};
use crate::support::shared;
use limitmesh_io::{Asset, Format};
use serde_json::{Value, json};

/// The asset after these primitives got another triangle.
fn replaced(mut asset: Asset, primitives: &[(usize, usize)]) -> Asset {
    for &(mesh, primitive) in primitives {
        asset.replace(mesh, primitive, &TRIANGLE).unwrap();
    }
    asset
}

fn edited(asset: Asset, primitives: &[(usize, usize)]) -> String {
    parts(&replaced(asset, primitives).to_bytes(Format::Glb).unwrap()).0
}

fn of_json(document: &Value, primitives: &[(usize, usize)]) -> Value {
    let asset = Asset::from_bytes(&glb(&document.to_string(), &floats(&[0.0; 9])), None).unwrap();
    serde_json::from_str(&edited(asset, primitives)).unwrap()
}

/// Two meshes that need extensions, and a third that does not.
fn two() -> Value {
    let names = [
        "KHR_texture_transform",
        "KHR_mesh_quantization",
        "FB_ngon_encoding",
    ];
    let polygons = json!({"FB_ngon_encoding": {}, "ODD_thing": {"a": 1}});
    json!({
        "asset": {"version": "2.0"},
        "extensionsUsed": names, "extensionsRequired": ["KHR_mesh_quantization"],
        "buffers": [{"byteLength": 36}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [
            {"componentType": 5126, "count": 3, "type": "VEC3", "bufferView": 0},
            {"componentType": 5122, "count": 3, "type": "VEC3"},
            {"componentType": 5123, "normalized": true, "count": 3, "type": "VEC2"},
            {"componentType": 5120, "count": 3, "type": "VEC2"},
        ],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": 1}, "extensions": polygons}]},
            {"primitives": [
                {"attributes": {"POSITION": 0}, "targets": [{"NORMAL": 1}], "extensions": {"FB_ngon_encoding": {}}},
            ]},
            {"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 2}}]},
        ],
    })
}

#[test]
fn names_go_with_the_last_primitive_that_needs_them() {
    let document = two();
    for kept in [[(0, 0), (2, 0)], [(1, 0), (2, 0)]] {
        let new = of_json(&document, &kept);
        assert_eq!(new["extensionsUsed"], document["extensionsUsed"]);
        assert_eq!(new["extensionsRequired"], document["extensionsRequired"]);
    }
    let new = of_json(&document, &[(0, 0), (1, 0)]);
    assert_eq!(new["extensionsUsed"], json!(["KHR_texture_transform"]));
    assert!(new.get("extensionsRequired").is_none(), "{new}");
    // What speaks of the old triangles is gone, all else is there.
    assert_eq!(
        new["meshes"][0]["primitives"][0]["extensions"],
        json!({"ODD_thing": {"a": 1}})
    );
    assert!(
        new["meshes"][1]["primitives"][0]
            .get("extensions")
            .is_none(),
        "{new}"
    );
    // Texture coordinates of signed whole numbers are quantised, those of unsigned fractions are not.
    let mut other = document.clone();
    other["meshes"][2]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(3);
    assert_eq!(
        of_json(&other, &[(0, 0), (1, 0)])["extensionsRequired"],
        json!(["KHR_mesh_quantization"])
    );
    // Something that is no list is left alone.
    other = document.clone();
    other["extensionsUsed"] = json!({});
    let new = of_json(&other, &[(0, 0), (1, 0)]);
    assert!(
        new["extensionsUsed"] == json!({}) && new.get("extensionsRequired").is_none(),
        "{new}"
    );
    // Points and lines are used as triangles are.
    other = document.clone();
    other["meshes"][2]["primitives"][0] = json!({"mode": 0, "attributes": {"POSITION": 1}});
    assert_eq!(
        of_json(&other, &[(0, 0), (1, 0)])["extensionsRequired"],
        json!(["KHR_mesh_quantization"])
    );
}

#[test]
fn the_rest_of_the_text_stays() {
    let text = r#" {"extensionsRequired" : [ "KHR_mesh_quantization" ] , "asset":{"version" :"2.0"},
        "extensionsUsed":["A" , "KHR_mesh_quantization"],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"componentType":5122,"count":3,"type":"VEC3"}], "extras":1.0}"#;
    let asset = Asset::from_bytes(&glb(text, &[]), None).unwrap();
    let new = edited(asset, &[(0, 0)]);
    assert!(
        new.starts_with(r#" {  "asset":{"version" :"2.0"},"#),
        "{new}"
    );
    assert!(
        new.contains("\n        \"extensionsUsed\":[\"A\"],\"meshes\""),
        "{new}"
    );
    assert!(new.contains(r#"], "extras":1.0"#), "{new}");
    let asset = Asset::from_bytes(&glb(text, &[]), None).unwrap();
    assert_eq!(edited(asset, &[]).trim_end(), text);
}

/// A box that gltfpack quantised and compressed.
fn compressed() -> Option<(Value, Vec<u8>)> {
    let (text, bin) = parts(&std::fs::read(shared("assets/BoxMeshopt.glb")?).unwrap());
    Some((serde_json::from_str(&text).unwrap(), bin))
}

fn edit(document: &Value, bin: &[u8]) -> (Value, Vec<u8>) {
    let asset = Asset::from_bytes(&glb(&document.to_string(), bin), None).unwrap();
    let (text, bin) = parts(&replaced(asset, &[(0, 0)]).to_bytes(Format::Glb).unwrap());
    (serde_json::from_str(&text).unwrap(), bin)
}

#[test]
fn views_that_were_compressed_can_be_read_without_a_decoder() {
    let Some((mut document, old_bin)) = compressed() else {
        return;
    };
    // Where nothing could name them they would be gone.
    document["extras"] = json!({"of whom": [0, 1, 2]});
    let (new, bin) = edit(&document, &old_bin);
    assert!(!new.to_string().contains("extensions"), "{new}");
    // The buffer that never had bytes is gone; it has one where another follows it, so that numbers stay.
    assert_eq!(new["buffers"].as_array().unwrap().len(), 1);
    let asset = Asset::from_bytes(&glb(&document.to_string(), &old_bin), None).unwrap();
    let text =
        String::from_utf8(replaced(asset, &[(0, 0)]).to_bytes(Format::Gltf).unwrap()).unwrap();
    let apart: Value = serde_json::from_str(&text).unwrap();
    assert!(!text.contains("extensions"), "{text}");
    assert_eq!(apart["buffers"].as_array().unwrap().len(), 1);
    let mut three = document.clone();
    three["buffers"]
        .as_array_mut()
        .unwrap()
        .push(json!({"byteLength": 1, "uri": "data:,a"}));
    let (three, _) = edit(&three, &old_bin);
    let hollow = json!({"byteLength": 1, "uri": "data:application/octet-stream;base64,AA=="});
    assert_eq!(three["buffers"][1], hollow);
    assert_eq!(three["buffers"][2]["uri"], "data:,a");
    for view in new["bufferViews"].as_array().unwrap() {
        let [start, length] =
            ["byteOffset", "byteLength"].map(|key| view[key].as_u64().unwrap() as usize);
        assert!(
            view["buffer"] == 0 && start % 4 == 0 && start + length <= bin.len(),
            "{view}"
        );
    }
    // The old accessors are those of a box: corners at the ends of the range of 14 bits, normals along axes.
    let view = |i: usize| {
        let (old, own) = (&document["bufferViews"][i], &new["bufferViews"][i]);
        for key in ["byteLength", "byteStride", "target"] {
            assert_eq!(old[key], own[key], "{key}");
        }
        let start = own["byteOffset"].as_u64().unwrap() as usize;
        bin[start..start + own["byteLength"].as_u64().unwrap() as usize].to_vec()
    };
    assert_eq!(
        document["accessors"],
        Value::from(new["accessors"].as_array().unwrap()[..3].to_vec())
    );
    let words = |bytes: &[u8]| -> Vec<u16> {
        bytes
            .as_chunks::<2>()
            .0
            .iter()
            .map(|&two| u16::from_le_bytes(two))
            .collect()
    };
    let corners: std::collections::BTreeSet<Vec<u16>> = view(1)
        .chunks_exact(8)
        .map(|eight| words(&eight[..6]))
        .collect();
    assert_eq!(corners.len(), 8);
    assert!(
        corners.iter().flatten().all(|x| [0, 16_383].contains(x)),
        "{corners:?}"
    );
    let normals: std::collections::BTreeSet<Vec<u8>> = view(0)
        .chunks_exact(4)
        .map(|four| four[..3].to_vec())
        .collect();
    assert_eq!(normals.len(), 6);
    assert!(
        normals
            .iter()
            .all(|n| n.iter().filter(|&&x| x != 0).count() == 1),
        "{normals:?}"
    );
    let mut indices = words(&view(2));
    indices.sort_unstable();
    indices.dedup();
    assert_eq!(indices, (0..24).collect::<Vec<u16>>());
}

#[test]
fn compression_stays_while_something_needs_it() {
    let Some((mut document, bin)) = compressed() else {
        return;
    };
    let both = json!(["KHR_mesh_quantization", "EXT_meshopt_compression"]);
    let one = json!(["EXT_meshopt_compression"]);
    // An animation, and then another mesh.
    document["extras"] = json!([0, 1, 2]);
    document["animations"] = json!([{"channels": [], "samplers": [{"input": 2, "output": 0}]}]);
    let (new, _) = edit(&document, &bin);
    assert_eq!(
        (&new["extensionsUsed"], &new["extensionsRequired"]),
        (&one, &one)
    );
    assert_eq!(
        new["bufferViews"].as_array().unwrap()[..3],
        document["bufferViews"].as_array().unwrap()[..]
    );
    assert_eq!(new["buffers"][1], document["buffers"][1]);
    document.as_object_mut().unwrap().remove("animations");
    let mesh = document["meshes"][0].clone();
    document["meshes"].as_array_mut().unwrap().push(mesh);
    let (new, _) = edit(&document, &bin);
    assert_eq!(
        (&new["extensionsUsed"], &new["extensionsRequired"]),
        (&both, &both)
    );
    // Where it is not required, it can be read without a decoder as it is; views that nothing names are gone nevertheless.
    document.as_object_mut().unwrap().remove("extras");
    document["meshes"].as_array_mut().unwrap().pop();
    document["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let (new, _) = edit(&document, &bin);
    assert_eq!(new["extensionsUsed"], one);
    assert!(new.get("extensionsRequired").is_none(), "{new}");
}

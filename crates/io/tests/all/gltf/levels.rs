//! Levels of detail in one document: what does not fit together is refused, and what the asset had that names what is gone goes, too.

use std::path::{Path, PathBuf};

use limitmesh::mesh::{Channel, Domain, Semantic};
use limitmesh_io::gltf::{DetailLevel, write_levels};
use limitmesh_io::{Asset, Format, MATERIAL, Output, WriteError, read};
use serde_json::{Value, json};

use super::support::{floats, glb, parts};
use crate::support::{output, triangles};

/// A square of two triangles; its first is the coarser level's place of all.
const SQUARE: [[f64; 3]; 4] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
];
const FACES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];
const UP: [[f64; 3]; 4] = [[0.0, 0.0, 1.0]; 4];

fn square() -> Output<'static> {
    output(&SQUARE, &FACES)
}

fn written(
    levels: &[DetailLevel<'_>],
    of: Option<&Asset>,
) -> Result<(tempfile::TempDir, PathBuf), WriteError> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("levels.glb");
    write_levels(&path, Format::Glb, "square", levels, of, None).map(|()| (folder, path))
}

#[track_caller]
fn complaint(level: DetailLevel<'_>) -> String {
    let levels = [DetailLevel::new(square()), level];
    written(&levels, None)
        .expect_err("levels that do not fit together")
        .to_string()
}

fn document(path: &Path) -> Value {
    serde_json::from_str(&parts(&std::fs::read(path).expect("a file")).0).expect("JSON")
}

#[test]
fn what_does_not_fit_together_is_refused() {
    let beyond = output(&SQUARE, &[[0, 1, 4]]);
    assert_eq!(
        complaint(DetailLevel::new(beyond)),
        "triangle 0 names vertex 4, but there are 4"
    );
    assert!(
        complaint(DetailLevel::new(square().normals(&UP[1..])))
            .starts_with("there are 3 normals for 4 vertices")
    );
    let places = complaint(DetailLevel::new(square()).coarser(&SQUARE[1..], &UP));
    assert!(
        places.starts_with("there are 3 places on the coarser level for 4 vertices"),
        "{places}"
    );
    let normals = complaint(DetailLevel::new(square().normals(&UP)).coarser(&SQUARE, &UP[..2]));
    assert!(
        normals.starts_with("there are 2 normals on the coarser level for 4 vertices"),
        "{normals}"
    );
    let mut heat =
        Channel::new("heat", Semantic::Other, Domain::Vertex, 1).with(vec![0.5], vec![0; 3]);
    let of = |heat: &Channel| {
        complaint(DetailLevel::new(
            square().channels(std::slice::from_ref(heat)),
        ))
    };
    assert!(of(&heat).contains("heat"), "{}", of(&heat));
    heat.indices = vec![0, 0, 0, 7];
    assert!(of(&heat).contains("heat"), "{}", of(&heat));
    let far = [[0.0; 3], [1e39, 0.0, 0.0], [1.0; 3], [2.0; 3]];
    let place = complaint(DetailLevel::new(square()).coarser(&far, &UP));
    assert!(place.contains("32-bit floats"), "{place}");
}

/// As for other documents: normals of corners are nothing that glTF holds.
#[test]
fn normals_of_corners_are_left_out() {
    let normals = [[0.0, 0.0, 1.0]];
    let level =
        DetailLevel::new(square().normals_of_corners(&normals, &[[0; 3]; 2])).coarser(&SQUARE, &UP);
    let (_folder, path) = written(&[level], None).expect("written");
    let primitive = &document(&path)["meshes"][0]["primitives"][0];
    assert!(primitive["attributes"]["NORMAL"].is_null(), "{primitive}");
    assert!(primitive["targets"][0]["NORMAL"].is_null(), "{primitive}");
    assert!(primitive["targets"][0]["POSITION"].is_u64(), "{primitive}");
}

/// An asset with whatever names its nodes: a skin, an animation, a camera, instances, and an avatar's bones.
fn rigged() -> Asset {
    let mut bin = floats(&SQUARE.map(|p| p.map(|x| x as f32)).concat());
    bin.extend(floats(&[1.0, 2.0, 3.0]));
    let primitive = |material: usize| json!({"attributes": {"POSITION": 0}, "material": material});
    let transform = json!({"KHR_texture_transform": {"scale": [2, 2]}});
    let text = json!({
        "asset": {"version": "2.0", "generator": "someone's"},
        "extensionsUsed": ["VRM", "KHR_texture_transform", "EXT_mesh_gpu_instancing", "KHR_lights_punctual",
            "KHR_materials_unlit", "OF_nobody_here", "KHR_node_visibility"],
        "extensionsRequired": ["EXT_mesh_gpu_instancing", "KHR_texture_transform"],
        "extensions": {
            "VRM": {"humanoid": {"humanBones": [{"bone": "hips", "node": 1}]}},
            "KHR_lights_punctual": {"lights": [{"type": "point"}]},
        },
        "scene": 0,
        "scenes": [{"nodes": [0, 1, 2]}],
        "nodes": [
            {"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1}}}},
            {"name": "bone", "extensions": {"KHR_node_visibility": {"visible": true}}},
            {"camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}},
        ],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}],
        "skins": [{"joints": [1]}],
        "animations": [{"channels": [], "samplers": []}],
        "materials": [
            {"name": "cloth", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions": transform}}},
            {"name": "skin", "extensions": {"KHR_materials_unlit": {}}},
        ],
        "textures": [{"source": 0}],
        "images": [{"uri": "data:image/png;base64,AA=="}],
        "meshes": [{"primitives": [primitive(0), primitive(1)]}],
        "accessors": [
            {"count": 3, "type": "VEC3", "componentType": 5126, "bufferView": 0},
            {"count": 1, "type": "VEC3", "componentType": 5126, "bufferView": 1},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 12},
        ],
        "buffers": [{"byteLength": bin.len()}],
    });
    Asset::from_bytes(&glb(&text.to_string(), &bin), None).expect("an asset")
}

#[test]
fn an_assets_materials_come_along_and_nothing_that_names_its_nodes() {
    let asset = rigged();
    let mut materials =
        Channel::new(MATERIAL, Semantic::Label, Domain::Face, 1).with(vec![1.0, 2.0], vec![1, 0]);
    materials.labels = ["", "cloth", "skin"].map(str::to_owned).to_vec();
    let channels = [materials];
    let levels = [DetailLevel::new(square().channels(&channels)); 2];
    let (_folder, path) = written(&levels, Some(&asset)).expect("written");
    let document = document(&path);
    assert_eq!(document["materials"][0]["name"], "cloth");
    assert_eq!(document["materials"][1]["name"], "skin");
    assert_eq!(document["materials"].as_array().map(Vec::len), Some(2));
    for mesh in document["meshes"].as_array().expect("meshes") {
        let of: Vec<_> = mesh["primitives"]
            .as_array()
            .expect("primitives")
            .iter()
            .collect();
        assert_eq!(
            [&of[0]["material"], &of[1]["material"]],
            [1, 0],
            "in the order of the triangles"
        );
    }
    assert_eq!(document["nodes"].as_array().map(Vec::len), Some(2));
    for gone in ["skins", "animations", "cameras"] {
        assert!(document[gone].is_null(), "{gone}");
    }
    // Lights are named by nodes and name nothing; an avatar names nodes.
    assert_eq!(
        document["extensions"],
        json!({"KHR_lights_punctual": {"lights": [{"type": "point"}]}})
    );
    let kept = [
        "KHR_texture_transform",
        "KHR_lights_punctual",
        "KHR_materials_unlit",
        "OF_nobody_here",
        "MSFT_lod",
    ];
    assert_eq!(document["extensionsUsed"], json!(kept));
    assert_eq!(
        document["extensionsRequired"],
        json!(["KHR_texture_transform"])
    );
    let again = read(&path).expect("a document that is read again");
    assert_eq!(again.faces.len(), 2, "the finest level alone is shown");
    let material = again
        .channels
        .iter()
        .find(|own| own.name == MATERIAL)
        .expect("materials");
    let names: Vec<&str> = [0, 1]
        .map(|face| &*material.labels[material.value(face)[0] as usize])
        .to_vec();
    assert_eq!(names, ["skin", "cloth"]);
}

/// Names are no more than names: materials without one, or with an empty one, stay what they are.
#[test]
fn materials_need_no_names() {
    let bin = floats(&SQUARE.map(|p| p.map(|x| x as f32)).concat());
    let primitive = |material: usize| json!({"attributes": {"POSITION": 0}, "material": material});
    let text = json!({
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "materials": [{"name": "", "doubleSided": true}, {"alphaMode": "BLEND"}],
        "meshes": [{"primitives": [primitive(1), primitive(0)]}],
        "accessors": [{"count": 3, "type": "VEC3", "componentType": 5126, "bufferView": 0}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": bin.len()}],
    });
    let asset = Asset::from_bytes(&glb(&text.to_string(), &bin), None).expect("an asset");
    let soup = asset.scene_soup().expect("two triangles");
    let triangles = triangles(&soup);
    let own = output(&soup.positions, &triangles);
    let level = DetailLevel::new(own.channels(&soup.channels));
    let (_folder, path) = written(&[level], Some(&asset)).expect("written");
    let document = document(&path);
    assert_eq!(document["materials"], text["materials"]);
    let primitives = document["meshes"][0]["primitives"]
        .as_array()
        .expect("primitives");
    assert_eq!(
        [&primitives[0]["material"], &primitives[1]["material"]],
        [1, 0],
        "{document:#}"
    );
}

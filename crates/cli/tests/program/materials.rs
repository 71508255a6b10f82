//! Materials of OBJ files: their base colours and pictures come along to glTF documents and to OBJ files in other folders.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use tempfile::TempDir;

use crate::common::{file, folder, run};
use crate::glb::Glb;

/// The bytes that tell a PNG file, and others that make it one of its own.
fn picture(other: &[u8]) -> Vec<u8> {
    [b"\x89PNG\r\n\x1a\n", other].concat()
}

const OBJ: &str = "mtllib paint.mtl\nv 0 0 0\nv 4 0 0\nv 4 3 1\nv 0 3 0\nv 2 5 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
    usemtl wood\nf 1/1 2/2 3/3\nusemtl glass\nf 1/1 3/3 4/4\nusemtl odd\nf 4/4 3/3 5/1\n";

const MTL: &str = "# painted\nnewmtl wood\nKa 1 1 1\nKd 0.5 0.25 1 # dull\nmap_Kd -s 1 1 1 -clamp on skin/my wood.png\n\
    map_Bump -bm 0.5 skin\\bumps.png\nnewmtl glass\nKd 0.125\nTr 0.75\nillum 2\nnewmtl odd\nd 0.5\nmap_Kd odd.tga\n";

/// An OBJ file with its library and pictures.
fn painted(folder: &TempDir) -> PathBuf {
    std::fs::create_dir(folder.path().join("skin")).expect("a folder");
    std::fs::write(folder.path().join("skin/my wood.png"), picture(b"wood")).expect("written");
    std::fs::write(folder.path().join("skin/bumps.png"), picture(b"bumps")).expect("written");
    file(folder, "odd.tga", "a picture of another kind");
    file(folder, "paint.mtl", MTL);
    file(folder, "in.obj", OBJ)
}

/// Checks what a document says of the materials; the picture is the only image.
#[track_caller]
fn has_materials(json: &Value) {
    let expected = json!([
        {"name": "wood", "pbrMetallicRoughness":
            {"baseColorFactor": [0.5, 0.25, 1.0, 1.0], "metallicFactor": 0, "baseColorTexture": {"index": 0}}},
        {"name": "glass", "alphaMode": "BLEND", "pbrMetallicRoughness":
            {"baseColorFactor": [0.125, 0.125, 0.125, 0.25], "metallicFactor": 0}},
        {"name": "odd", "alphaMode": "BLEND", "pbrMetallicRoughness":
            {"baseColorFactor": [1.0, 1.0, 1.0, 0.5], "metallicFactor": 0}},
    ]);
    assert_eq!(json["materials"], expected);
    assert_eq!(json["textures"], json!([{"source": 0}]));
    assert_eq!(json["images"].as_array().map(Vec::len), Some(1));
    let primitives = json["meshes"][0]["primitives"].as_array().expect("primitives");
    let materials: Vec<&Value> = primitives.iter().map(|own| &own["material"]).collect();
    assert_eq!(materials, [0, 1, 2]);
    assert!(primitives.iter().all(|own| own["attributes"]["TEXCOORD_0"].is_u64()));
}

#[test]
fn colours_and_pictures_come_to_documents() {
    let folder = folder();
    let input = painted(&folder);
    let output = folder.path().join("out.glb");
    // Once refined, once in levels of detail.
    for command in ["refine {} -o {}", "lod {} -o {} --levels 1"] {
        run(command, &[&input, &output]).expect(0).saying("odd.tga: left out: neither PNG nor JPEG");
        let glb = Glb::read(&output);
        has_materials(&glb.json);
        let image = &glb.json["images"][0];
        assert_eq!(image["mimeType"], "image/png");
        let view = &glb.json["bufferViews"][image["bufferView"].as_u64().expect("a view") as usize];
        let [start, length] =
            ["byteOffset", "byteLength"].map(|key| view[key].as_u64().unwrap_or(0) as usize);
        assert_eq!(glb.bytes()[start..start + length], picture(b"wood"));
        // The geometry is still where its accessors say.
        assert_eq!(glb.triangles(0).len(), glb.numbers(&glb.primitive(0)["indices"]).len() / 3);
    }
    // As text, the picture is a file beside it.
    let other = folder.path().join("other");
    std::fs::create_dir(&other).expect("a folder");
    let output = other.join("out.gltf");
    run("refine {} -o {}", &[&input, &output]).expect(0);
    let text = Glb::text(&output);
    has_materials(&text.json);
    assert_eq!(text.json["images"][0], json!({"uri": "skin/my%20wood.png"}));
    assert_eq!(std::fs::read(other.join("skin/my wood.png")).expect("a copy"), picture(b"wood"));
}

#[test]
fn libraries_and_pictures_come_to_other_folders() {
    let folder = folder();
    let input = painted(&folder);
    let other = folder.path().join("other");
    std::fs::create_dir(&other).expect("a folder");
    run("refine {} -o {}", &[&input, &other.join("out.obj")]).expect(0);
    for name in ["paint.mtl", "skin/my wood.png", "skin/bumps.png", "odd.tga"] {
        let [was, is] = [folder.path(), &other].map(|folder| std::fs::read(folder.join(name)).expect(name));
        assert_eq!(was, is, "{name}");
    }
    let text = std::fs::read_to_string(other.join("out.obj")).expect("written");
    assert!(text.contains("mtllib paint.mtl\n") && text.contains("usemtl glass\n"));
    // Twice is as well as once.
    run("refine {} -o {}", &[&input, &other.join("out.obj")]).expect(0);
}

#[test]
fn what_is_missing_or_elsewhere_is_told() {
    let outside = folder();
    file(&outside, "secret.png", "\u{0}");
    std::fs::write(outside.path().join("secret.png"), picture(b"secret")).expect("written");
    let inside = outside.path().join("inside");
    std::fs::create_dir(&inside).expect("a folder");
    let input = inside.join("in.obj");
    let output = inside.join("out.glb");
    std::fs::write(&input, OBJ).expect("written");
    run("refine {} -o {}", &[&input, &output]).expect(0).saying("paint.mtl: left out: No such file");
    let names: Vec<Value> = ["wood", "glass", "odd"].map(|name| json!({ "name": name })).into();
    assert_eq!(Glb::read(&output).json["materials"], Value::from(names));
    let secret = outside.path().join("secret.png");
    let away = [Path::new("../secret.png"), &secret, Path::new("none.png"), Path::new("http://a/b.png")];
    for name in away {
        let library =
            format!("newmtl wood\nKd 1 x\nd\nmap_Kd\nmap_Kd {}\nKd 0 0 0.5\n\u{fffd}\n", name.display());
        std::fs::write(inside.join("paint.mtl"), library).expect("written");
        run("refine {} -o {}", &[&input, &output])
            .expect(0)
            .saying(&format!("{}: left out:", name.display()));
        let json = Glb::read(&output).json;
        assert!(json.get("images").is_none() && json.get("textures").is_none(), "{json}");
        assert_eq!(
            json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"],
            json!([0.0, 0.0, 0.5, 1.0])
        );
    }
}

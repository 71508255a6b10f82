//! Materials of OBJ files: their base colours and pictures come along to glTF documents and to OBJ files in other folders.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use tempfile::TempDir;

use crate::common::{bytes, count, done, file, folder, list, names, run, text, words};
use crate::glb::Glb;

/// The bytes that begin a PNG file, and others that make it unique.
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
    let primitives = list(&json["meshes"][0]["primitives"]);
    let materials: Vec<&Value> = primitives.iter().map(|own| &own["material"]).collect();
    assert_eq!(materials, [0, 1, 2]);
    assert!(
        primitives
            .iter()
            .all(|own| own["attributes"]["TEXCOORD_0"].is_u64())
    );
}

/// The kind and the bytes of the first image.
fn image(glb: &Glb) -> (&str, &[u8]) {
    let image = &glb.json["images"][0];
    let view = &glb.json["bufferViews"][count(&image["bufferView"]) as usize];
    let [start, length] =
        ["byteOffset", "byteLength"].map(|key| view[key].as_u64().unwrap_or(0) as usize);
    (
        words(&image["mimeType"]),
        &glb.bytes()[start..start + length],
    )
}

#[test]
fn colours_and_pictures_come_to_documents() {
    let folder = folder();
    let input = painted(&folder);
    let output = folder.path().join("out.glb");
    // Once refined, once in levels of detail.
    for command in ["refine {} -o {}", "lod {} -o {} --levels 1"] {
        done(command, &[&input, &output]).saying("odd.tga: left out: neither PNG nor JPEG");
        let glb = Glb::read(&output);
        has_materials(&glb.json);
        assert_eq!(image(&glb), ("image/png", picture(b"wood").as_slice()));
        // The geometry is still where its accessors say.
        assert_eq!(
            glb.triangles(0).len(),
            glb.numbers(&glb.primitive(0)["indices"]).len() / 3
        );
    }
    let piped = done("refine {} -o - --to gltf", &[&input]);
    let json: Value = serde_json::from_str(&piped.stdout).expect("JSON");
    has_materials(&json);
    assert_eq!(
        json["images"][0]["uri"],
        "data:image/png;base64,iVBORw0KGgp3b29k"
    );
    // As text, the picture is a file of its own.
    let other = folder.path().join("other");
    std::fs::create_dir(&other).expect("a folder");
    let output = other.join("out.gltf");
    done("refine {} -o {}", &[&input, &output]);
    let text = Glb::text(&output);
    has_materials(&text.json);
    assert_eq!(text.json["images"][0], json!({"uri": "skin/my%20wood.png"}));
    assert_eq!(bytes(other.join("skin/my wood.png")), picture(b"wood"));
}

#[test]
fn libraries_and_pictures_come_to_other_folders() {
    let folder = folder();
    let input = painted(&folder);
    let other = folder.path().join("other");
    std::fs::create_dir(&other).expect("a folder");
    done("refine {} -o {}", &[&input, &other.join("out.obj")]);
    for name in ["paint.mtl", "skin/my wood.png", "skin/bumps.png", "odd.tga"] {
        let [was, is] = [folder.path(), &other].map(|folder| bytes(folder.join(name)));
        assert_eq!(was, is, "{name}");
    }
    let text = text(other.join("out.obj"));
    assert!(text.contains("mtllib paint.mtl\n") && text.contains("usemtl glass\n"));
    // Twice is as well as once.
    done("refine {} -o {}", &[&input, &other.join("out.obj")]);
}

/// Writes a library for [`OBJ`], and gives the material `wood` of the document that comes of it, and what was said.
fn wood(folder: &Path, library: &str) -> (Value, String) {
    let input = folder.join("in.obj");
    std::fs::write(&input, OBJ).expect("written");
    std::fs::write(folder.join("paint.mtl"), library).expect("written");
    let output = folder.join("out.glb");
    let said = done("refine {} -o {}", &[&input, &output]).stderr;
    (
        Glb::read(&output).json["materials"][0]["pbrMetallicRoughness"].take(),
        said,
    )
}

#[test]
fn nothing_is_replaced() {
    let folder = folder();
    let input = painted(&folder);
    let state = || {
        let of = |name: &str| (name.to_owned(), bytes(folder.path().join(name)));
        [
            "in.obj",
            "paint.mtl",
            "skin/my wood.png",
            "skin/bumps.png",
            "odd.tga",
        ]
        .map(of)
    };
    let before = state();
    for name in ["out.obj", "out.gltf"] {
        done("refine {} -o {}", &[&input, &folder.path().join(name)]);
        assert_eq!(state(), before, "{name}");
    }
    // Another file in the way is kept, and then nothing is written.
    let other = folder.path().join("other");
    std::fs::create_dir_all(other.join("skin")).expect("folders");
    std::fs::write(other.join("skin/my wood.png"), "another").expect("written");
    for name in ["out.obj", "out.gltf"] {
        run("refine {} -o {}", &[&input, &other.join(name)])
            .expect(1)
            .saying("it is there already, and not the same");
        assert_eq!(names(&other), ["skin"], "{name}");
        assert_eq!(names(&other.join("skin")), ["my wood.png"], "{name}");
    }
}

#[test]
fn what_is_missing_or_elsewhere_is_named() {
    let outside = folder();
    std::fs::write(outside.path().join("secret.png"), picture(b"secret")).expect("written");
    let inside = outside.path().join("inside");
    std::fs::create_dir(&inside).expect("a folder");
    let input = inside.join("in.obj");
    let output = inside.join("out.glb");
    std::fs::write(&input, OBJ).expect("written");
    done("refine {} -o {}", &[&input, &output]).saying("paint.mtl: left out: No such file");
    let bare: Vec<Value> = ["wood", "glass", "odd"]
        .map(|name| json!({ "name": name }))
        .into();
    assert_eq!(Glb::read(&output).json["materials"], Value::from(bare));
    let secret = outside.path().join("secret.png");
    std::fs::create_dir(inside.join("folder.png")).expect("a folder");
    let away = [
        "../secret.png",
        "C:\\secret.png",
        "none.png",
        "http://a/b.png",
        "folder.png",
    ];
    for name in away.map(Path::new).into_iter().chain([secret.as_path()]) {
        let name = name.display();
        let (material, said) = wood(
            &inside,
            &format!("newmtl wood\nmap_Kd\nmap_Kd {name}\nKd 0 0 0.5\n"),
        );
        assert!(said.contains(&format!("{name}: left out:")), "{said}");
        assert_eq!(
            material,
            json!({"baseColorFactor": [0.0, 0.0, 0.5, 1.0], "metallicFactor": 0})
        );
    }
}

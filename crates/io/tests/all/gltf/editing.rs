//! Edited documents: new triangles, and all else as it was, to the byte.

use super::support::{document, floats, glb, parts, plain, triangles_of};
use crate::support::{output, written};
use limitmesh_io::gltf::{Geometry, VertexAttribute};
use limitmesh_io::{Asset, Format, read_bytes};
use std::fs;

const SQUARE: [[f64; 3]; 4] = [
    [0.0, 0.0, 0.1],
    [1.0, 0.0, 0.2],
    [1.0, 1.0, 0.3],
    [0.0, 1.0, -0.4],
];
const HALVES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

fn geometry() -> Geometry<'static> {
    const UP: [[f64; 3]; 4] = [[0.0, 0.0, 2.0], [0.0, 3.0, 4.0], [0.0; 3], [1.0, 0.0, 0.0]];
    Geometry {
        positions: &SQUARE,
        normals: Some(&UP),
        triangles: &HALVES,
        attributes: &[],
        targets: &[],
    }
}

/// A triangle amid things that nobody knows, and that may name its accessor, spelt in ways that no writer would.
fn odd() -> String {
    let top = r#" "buffers" : [ {"byteLength":36, "name":"b"} ],
	"bufferViews":[{"buffer":0,"byteLength":36}], "accessors":[{"count":3,"type":"VEC3","componentType":5126,"bufferView":0}],
	"nodes":[{"mesh":0,"translation":[1.0e+0,0.10,-0]}],"extensions":{"ODD_thing":{"b":[0,2, 3],"a":"\u00e9\/"}},
	"extras":{"z":1.000000000000000000001,"a":12345678901234567890123}, "materials":[{}]"#;
    document(
        top,
        r#""extras":{"y":1.50},"material":0,"mode":4,"attributes":{"POSITION":0}"#,
    )
}

#[test]
fn all_but_a_primitive_stays_to_the_byte() {
    let text = odd();
    let mut asset = Asset::from_bytes(&glb(&text, &floats(&[0.0; 9])), None).unwrap();
    asset.replace(0, 0, &geometry()).unwrap();
    let written = asset.to_bytes(Format::Glb).unwrap();
    let (new, bin) = parts(&written);
    let old = text
        .replace(
            r#""byteLength":36, "name""#,
            &format!(r#""byteLength":{}, "name""#, 36 + 48 + 48 + 12),
        )
        .replace(
            r#""attributes":{"POSITION":0}"#,
            r#""attributes":{"POSITION":1,"NORMAL":2},"indices":3"#,
        );
    // What is appended stands at the end of the arrays.
    let at = |key: &str, in_text: &str| in_text.find(key).unwrap();
    assert_eq!(
        new[..at("\"bufferViews\"", &new)],
        old[..at("\"bufferViews\"", &old)]
    );
    assert_eq!(
        new[at("\"nodes\"", &new)..].trim_end(),
        &old[at("\"nodes\"", &old)..]
    );
    assert!(new.contains(r#""bufferViews":[{"buffer":0,"byteLength":36},{"#));
    assert_eq!(bin[..36], floats(&[0.0; 9]));
    let single = |v: u32| SQUARE[v as usize].map(|x| x as f32);
    assert_eq!(
        triangles_of(&written, 0, 0),
        HALVES.map(|corners| corners.map(single))
    );
    // Normals have length 1, also where there was no direction.
    let normals: Vec<f32> = bin[84..132]
        .chunks_exact(4)
        .map(|b| f32::from_le_bytes(b.try_into().unwrap()))
        .collect();
    assert_eq!(
        normals,
        [0.0, 0.0, 1.0, 0.0, 0.6, 0.8, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0]
    );
    // And it can be read again.
    assert_eq!(read_bytes(&written, Format::Glb).unwrap().faces.len(), 2);
}

#[test]
fn without_changes_the_file_is_the_same() {
    let bytes = glb(&odd(), &floats(&[0.0; 9]));
    let asset = Asset::from_bytes(&bytes, None).unwrap();
    assert_eq!(asset.to_bytes(Format::Glb).unwrap(), bytes);
}

#[test]
fn short_indices_end_at_65535_vertices() {
    let bytes = glb(&odd(), &floats(&[0.0; 9]));
    for (vertices, kind) in [(65_535usize, 5123), (65_536, 5125)] {
        let positions: Vec<[f64; 3]> = (0..vertices).map(|v| [v as f64, 0.0, 0.0]).collect();
        let triangles = [[0, 1, vertices as u32 - 1]];
        let mut asset = Asset::from_bytes(&bytes, None).unwrap();
        asset.replace(0, 0, &plain(&positions, &triangles)).unwrap();
        let written = asset.to_bytes(Format::Glb).unwrap();
        assert!(parts(&written).0.contains(&format!(
            "\"componentType\":{kind},\"count\":3,\"type\":\"SCALAR\""
        )));
        assert_eq!(triangles_of(&written, 0, 0)[0][2][0], vertices as f32 - 1.0);
    }
}

#[test]
fn geometry_that_does_not_fit_is_refused() {
    let mut asset = Asset::from_bytes(&glb(&odd(), &floats(&[0.0; 9])), None).unwrap();
    let mut refused = |change: &dyn Fn(&mut Geometry<'_>), words: &str| {
        let mut own = geometry();
        change(&mut own);
        let said = asset.replace(0, 0, &own).expect_err("a flaw").to_string();
        assert!(said.contains(words), "{said}");
    };
    let beyond = "a triangle names vertex 4, but there are 4";
    refused(&|own| own.triangles = &[[0, 1, 4]], beyond);
    refused(&|own| own.triangles = &[], "a primitive needs triangles");
    refused(
        &|own| own.positions = &[[1e39, 0.0, 0.0]; 4],
        "32-bit floats",
    );
    refused(&|own| own.normals = Some(&[]), "0 normals");
}

#[test]
fn text_documents_get_a_file_of_bytes_and_copies_of_what_they_name() {
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (folder.path().join("from"), folder.path().join("to"));
    fs::create_dir_all(from.join("pictures")).unwrap();
    fs::create_dir(&to).unwrap();
    let text = odd()
        .replace(
            r#""byteLength":36, "name":"b""#,
            r#""byteLength":36,"uri":"out.bin""#,
        )
        .replace(
            r#""materials":[{}]"#,
            r#""materials":[{}],"images":[{"uri":"pictures/a%20b.png"},{"uri":"gone.png"}]"#,
        );
    fs::write(from.join("in.gltf"), &text).unwrap();
    fs::write(from.join("out.bin"), floats(&[0.0; 9])).unwrap();
    fs::write(from.join("pictures/a b.png"), b"a picture").unwrap();
    let mut asset = Asset::open(&from.join("in.gltf")).unwrap();
    asset.replace(0, 0, &geometry()).unwrap();
    let missing = asset.write(&to.join("out.gltf"), Format::Gltf).unwrap();
    assert_eq!(missing, [std::path::PathBuf::from("gone.png")]);
    // The document's own buffer has the first name.
    assert_eq!(fs::read(to.join("out.bin")).unwrap(), floats(&[0.0; 9]));
    assert_eq!(fs::read(to.join("out-2.bin")).unwrap().len(), 48 + 48 + 12);
    assert_eq!(fs::read(to.join("pictures/a b.png")).unwrap(), b"a picture");
    let again = Asset::open(&to.join("out.gltf")).unwrap();
    assert_eq!(again.scene_soup().unwrap().faces.len(), 2);
    // As one file, the first buffer moves in.
    asset.write(&to.join("out.glb"), Format::Glb).unwrap();
    let (new, bin) = parts(&fs::read(to.join("out.glb")).unwrap());
    assert!(new.contains(r#"[ {"byteLength":144} ]"#) && bin.len() == 144);
    // And back to text, out of the GLB.
    let apart = folder.path().join("apart");
    fs::create_dir(&apart).unwrap();
    Asset::open(&to.join("out.glb"))
        .unwrap()
        .write(&apart.join("x.gltf"), Format::Gltf)
        .unwrap();
    assert_eq!(fs::read(apart.join("x.bin")).unwrap(), bin);
    // Another file that is there already is not replaced.
    fs::write(to.join("pictures/a b.png"), b"another").unwrap();
    let refused = asset
        .write(&to.join("out.gltf"), Format::Gltf)
        .expect_err("another file")
        .to_string();
    assert!(
        refused.contains("it is there already, and not the same"),
        "{refused}"
    );
    assert_eq!(fs::read(to.join("pictures/a b.png")).unwrap(), b"another");
}

#[test]
fn links_do_not_lead_out_of_the_folder() {
    #[cfg(unix)]
    {
        let folder = tempfile::tempdir().unwrap();
        let inside = folder.path().join("inside");
        fs::create_dir(&inside).unwrap();
        fs::write(folder.path().join("secret.bin"), floats(&[0.0; 9])).unwrap();
        std::os::unix::fs::symlink(folder.path().join("secret.bin"), inside.join("b.bin")).unwrap();
        let text = odd().replace(r#""name":"b""#, r#""uri":"b.bin""#);
        fs::write(inside.join("in.gltf"), text).unwrap();
        let error = Asset::open(&inside.join("in.gltf"))
            .unwrap()
            .scene_soup()
            .expect_err("a link")
            .to_string();
        assert!(
            error.contains("it leads out of the document's folder"),
            "{error}"
        );
    }
}

#[test]
fn triangles_from_elsewhere_become_a_document() {
    for format in [Format::Glb, Format::Gltf] {
        let bytes = written(format, &output(&SQUARE, &HALVES), false);
        let soup = read_bytes(&bytes, format).unwrap();
        assert_eq!(
            soup.positions,
            SQUARE.map(|p| p.map(|x| f64::from(x as f32)))
        );
        assert_eq!(
            soup.faces.iter().collect::<Vec<_>>(),
            HALVES.each_ref().map(|t| &t[..])
        );
    }
}

#[test]
fn morph_targets_are_replaced_and_counted() {
    let text = odd().replace(
        r#""attributes":{"POSITION":0}"#,
        r#""attributes":{"POSITION":0},"targets":[{"POSITION":0},{"NORMAL":0}]"#,
    );
    let mut asset = Asset::from_bytes(&glb(&text, &floats(&[0.0; 9])), None).unwrap();
    let added = |name: &str, width: usize| VertexAttribute {
        name: name.to_owned(),
        width,
        values: (0..4 * width).map(|i| i as f64 - 2.5).collect(),
        is_integer: false,
    };
    let targets = [
        vec![added("POSITION", 3), added("TEXCOORD_0", 2)],
        vec![added("NORMAL", 3)],
    ];
    let mut own = geometry();
    own.targets = &targets;
    asset.replace(0, 0, &own).unwrap();
    let (new, bin) = parts(&asset.to_bytes(Format::Glb).unwrap());
    assert!(
        new.contains(r#""targets":[{"POSITION":3,"TEXCOORD_0":4},{"NORMAL":5}]"#),
        "{new}"
    );
    let json: serde_json::Value = serde_json::from_str(&new).unwrap();
    let accessor = &json["accessors"][3];
    assert_eq!(accessor["min"], serde_json::json!([-2.5, -1.5, -0.5]));
    assert_eq!(accessor["max"], serde_json::json!([6.5, 7.5, 8.5]));
    let view = &json["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
    let start = view["byteOffset"].as_u64().unwrap() as usize;
    assert_eq!(bin[start..start + 8], floats(&[-2.5, -1.5]));
    let refused = |targets: &[Vec<VertexAttribute>]| {
        let mut asset = Asset::from_bytes(&glb(&odd(), &floats(&[0.0; 9])), None).unwrap();
        let own = Geometry {
            targets,
            ..geometry()
        };
        asset.replace(0, 0, &own).expect_err("a flaw").to_string()
    };
    assert!(
        refused(&[vec![]])
            .contains("meshes[0].primitives[0].targets[0]: the target has no attribute")
    );
    let short = VertexAttribute {
        values: vec![0.0; 9],
        ..added("POSITION", 3)
    };
    assert!(refused(&[vec![short]]).contains(
        "meshes[0].primitives[0].targets[0].POSITION: expected 3 numbers for each vertex, found 9"
    ));
}

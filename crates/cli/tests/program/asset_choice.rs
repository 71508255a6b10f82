//! Which meshes of a glTF asset are refined, and what stays: by names, by diagonals, and by links.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use tempfile::TempDir;

use crate::common::{bytes, done, folder, list, run, text, usage_error, words};
use crate::glb::{Builder, Glb};

/// A cube of which the top has another material than the rest, and a second mesh, an octahedron ten times as large.
fn asset(folder: &TempDir) -> PathBuf {
    let mut builder = Builder::new();
    let corners: Vec<[f32; 3]> = (0..8u32)
        .map(|i| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -1.0 } else { 1.0 }))
        .collect();
    let position = builder.points(&corners);
    let sides = [
        [0u32, 2, 3, 1],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [4, 5, 7, 6],
    ];
    let halves: Vec<[u32; 3]> = sides
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
        .collect();
    for (triangles, material) in [(&halves[..10], 0), (&halves[10..], 1)] {
        let indices = builder.indices(triangles);
        builder.primitive(
            json!({"attributes": {"POSITION": position}, "indices": indices, "material": material}),
        );
    }
    let points: Vec<[f32; 3]> = (0..6)
        .map(|i| {
            [0, 1, 2].map(|axis| {
                if i / 2 == axis {
                    [-10.0, 10.0][i % 2]
                } else {
                    0.0
                }
            })
        })
        .collect();
    let position = builder.points(&points);
    let faces = (0..8u32).map(|i| {
        let [x, y, z] = [0, 1, 2].map(|axis| 2 * axis + (i >> axis & 1));
        if i.count_ones() % 2 == 1 {
            [x, y, z]
        } else {
            [x, z, y]
        }
    });
    let indices = builder.indices(&faces.collect::<Vec<_>>());
    let large = json!({"name": "Large", "primitives": [{"attributes": {"POSITION": position}, "indices": indices}]});
    builder.json["meshes"]
        .as_array_mut()
        .expect("meshes")
        .push(large);
    builder.json["meshes"][0]["name"] = json!("Box");
    builder.json["materials"] = json!([{"name": "body"}, {"name": "lid"}]);
    builder.json["nodes"] = json!([{"mesh": 0, "children": [1]}, {"mesh": 1}]);
    let input = folder.path().join("in.glb");
    builder.write(&input);
    input
}

/// Which primitives are others than before, by mesh and number.
fn replaced(input: &Path, output: &Path) -> Vec<(usize, usize)> {
    let [before, after] = [input, output].map(|path| Glb::read(path).json);
    let mut found = Vec::new();
    for (mesh, old) in list(&before["meshes"]).iter().enumerate() {
        for (i, old) in list(&old["primitives"]).iter().enumerate() {
            if after["meshes"][mesh]["primitives"][i] != *old {
                found.push((mesh, i));
            }
        }
    }
    found
}

#[test]
fn what_has_a_name_is_refined_and_all_else_stays() {
    let folder = folder();
    let (input, output) = (asset(&folder), folder.path().join("out.glb"));
    for (options, expected) in [
        ("", vec![(0, 0), (0, 1), (1, 0)]),
        ("--mesh Box", vec![(0, 0), (0, 1)]),
        ("--mesh Large --mesh Box", vec![(0, 0), (0, 1), (1, 0)]),
        ("--material lid", vec![(0, 1)]),
        ("--material body --mesh Box", vec![(0, 0)]),
    ] {
        let line = format!("refine {{}} -o {{}} --tolerance 1% {options}");
        done(&line, &[&input, &output]);
        assert_eq!(replaced(&input, &output), expected, "{options}");
    }
    let refused = |options: &str, words: &str| {
        let line = format!("refine {{}} -o {{}} {options}");
        run(&line, &[&input, &output]).expect(1).saying(words);
    };
    refused(
        "--mesh box",
        "no mesh is called 'box'; there is 'Box', 'Large'",
    );
    refused(
        "--material top",
        "no material is called 'top'; there is 'body', 'lid'",
    );
    refused(
        "--material lid --mesh Large",
        "no mesh that was named has a primitive of a material that was",
    );
    usage_error(
        "refine builtin:cube -o {} --material lid",
        &[&output],
        "--material is for glTF assets",
    );
}

#[test]
fn images_are_copied_or_linked() {
    let folder = folder();
    let input = asset(&folder);
    let glb = Glb::read(&input);
    let mut json = glb.json.clone();
    json["images"] = json!([{"uri": "pictures/a%20b.png"}, {"uri": "data:image/png;base64,AAAA"}]);
    json["buffers"] =
        json!([{"byteLength": glb.json["buffers"][0]["byteLength"], "uri": "in.bin"}]);
    let [from, to] = ["from here", "to/there"].map(|name| folder.path().join(name));
    std::fs::create_dir_all(from.join("pictures")).expect("a folder");
    std::fs::create_dir_all(&to).expect("a folder");
    let input = from.join("in.gltf");
    std::fs::write(&input, json.to_string()).expect("writable");
    std::fs::write(from.join("in.bin"), glb.bytes()).expect("writable");
    std::fs::write(from.join("pictures/a b.png"), b"a picture").expect("writable");
    let output = to.join("out.gltf");
    let uri = |output: &Path| -> String {
        let text = text(output);
        let json: Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(json["images"][1]["uri"], "data:image/png;base64,AAAA");
        words(&json["images"][0]["uri"]).to_owned()
    };
    done(
        "refine {} -o {} --tolerance 5% --link-resources",
        &[&input, &output],
    );
    assert_eq!(uri(&output), "../../from%20here/pictures/a%20b.png");
    // Buffers are read, and stay with the document.
    assert!(to.join("in.bin").exists() && !to.join("pictures").exists());
    // In the folder of the input there is nothing to say.
    let beside = from.join("out.gltf");
    done(
        "refine {} -o {} --tolerance 5% --link-resources",
        &[&input, &beside],
    );
    assert_eq!(uri(&beside), "pictures/a%20b.png");
    done("refine {} -o {} --tolerance 5%", &[&input, &output]);
    assert_eq!(uri(&output), "pictures/a%20b.png");
    assert_eq!(bytes(to.join("pictures/a b.png")), b"a picture");
    done(
        "refine {} -o {} --tolerance 5% --link-resources",
        &[&input, &to.join("out.glb")],
    );
    let linked = Glb::read(&to.join("out.glb")).json;
    assert_eq!(
        linked["images"][0]["uri"],
        "../../from%20here/pictures/a%20b.png"
    );
}

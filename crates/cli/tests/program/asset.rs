//! glTF assets: lengths are the scene's, borders between materials stay, and what cannot be carried along is reported.

use std::path::{Path, PathBuf};

use serde_json::Value;
use tempfile::TempDir;

use crate::common::{
    count, counts, done, file, folder, is_png, json_of, number, run, soup, usage_error,
};

/// A text document with its buffer in it: positions of eight corners of a cube (accessor 0), and indices of its sides but the top,
/// of the top, and of a line; joints and weights of the corners (4 and 5), which are the first joint's below and the second's above.
/// Its triangles have `more` attributes.
pub(crate) fn cube(folder: &TempDir, name: &str, nodes: &str, more: &str) -> PathBuf {
    let mut bytes: Vec<u8> = Vec::new();
    for corner in 0..8u32 {
        let side = |bit: u32| if corner >> bit & 1 == 0 { -1f32 } else { 1.0 };
        (0..3).for_each(|bit| bytes.extend(side(bit).to_le_bytes()));
    }
    let sides = [
        [0u8, 2, 3, 1],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [4, 5, 7, 6],
    ];
    bytes.extend(sides.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]));
    bytes.extend([0, 7, 0, 0]);
    (0..8u8).for_each(|corner| bytes.extend([corner >> 2, 9, 0, 0]));
    (0..8).for_each(|_| {
        [1f32, 0.0, 0.0, 0.0]
            .iter()
            .for_each(|weight| bytes.extend(weight.to_le_bytes()))
    });
    let hex: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    let data = base64(&hex);
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{},"uri":"data:application/octet-stream;base64,{data}"}}],
        "bufferViews":[{{"buffer":0,"byteLength":96}},{{"buffer":0,"byteOffset":96,"byteLength":38}},
            {{"buffer":0,"byteOffset":136,"byteLength":32}},{{"buffer":0,"byteOffset":168,"byteLength":128}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3","min":[-1,-1,-1],"max":[1,1,1]}},
            {{"bufferView":1,"componentType":5121,"count":30,"type":"SCALAR"}},
            {{"bufferView":1,"byteOffset":30,"componentType":5121,"count":6,"type":"SCALAR"}},
            {{"bufferView":1,"byteOffset":36,"componentType":5121,"count":2,"type":"SCALAR"}},
            {{"bufferView":2,"componentType":5121,"count":8,"type":"VEC4"}},
            {{"bufferView":3,"componentType":5126,"count":8,"type":"VEC4"}}],
        "materials":[{{"name":"body"}},{{"name":"lid","extras":{{"k":1.50}}}}],
        "meshes":[{{"name":"Box","primitives":[{{"attributes":{{"POSITION":0{more}}},"indices":1,"material":0}},
            {{"attributes":{{"POSITION":0{more}}},"indices":2,"material":1}},
            {{"attributes":{{"POSITION":0}},"indices":3,"mode":1}}]}}],
        "nodes":[{nodes}]}}"#,
        bytes.len()
    );
    file(folder, name, &text)
}

/// Base 64 of bytes in hexadecimal digits, three at a time.
fn base64(hex: &str) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for six in hex.as_bytes().chunks(6) {
        let digits = std::str::from_utf8(six).expect("digits");
        let word = u32::from_str_radix(&format!("{digits:0<6}"), 16).expect("a number");
        for letter in 0..4 {
            let digit = (word >> (18 - 6 * letter) & 63) as usize;
            text.push(if letter * 3 < digits.len() * 2 {
                char::from(LETTERS[digit])
            } else {
                '='
            });
        }
    }
    text
}

#[test]
fn tolerances_are_the_scenes() {
    let folder = folder();
    let output = folder.path().join("out.glb");
    let mut triangles = Vec::new();
    for nodes in [
        r#"{"mesh":0}"#,
        r#"{"mesh":0,"scale":[0.001,0.001,0.001]}"#,
        r#"{"scale":[1000,1000,1000],"children":[1]},{"mesh":0,"translation":[3,4,5]}"#,
    ] {
        let input = cube(&folder, "in.gltf", nodes, "");
        // Per cent of the scene: the same mesh at every scale.
        let report = json_of(
            "refine {} -o {} --tolerance 1% --report - --crease-angle none",
            &[&input, &output],
        );
        let mesh = &report["meshes"][0];
        triangles.push(count(&mesh["output"]["triangles"]));
        let upper = number(&mesh["error"]["upper"]);
        // The file's scene as another command reads it.
        let measured = json_of(
            "measure {} --limit-of {} --certified --json --crease-angle none",
            &[&output, &input],
        );
        let found = number(&measured["hausdorff"]["lower"]);
        let most = number(&measured["hausdorff"]["upper"]);
        at_most!(found, upper);
        at_least!(most, 0.5 * upper);
        let size = number(&mesh["error"]["diagonal"]);
        assert!(upper <= 0.01 * size * (1.0 + 1e-9), "{upper} of {size}");
    }
    assert!(triangles[0] == triangles[1]);
    assert!(triangles[1] == triangles[2]);
    // A length holds in the scene, too: 1000 times larger needs more triangles for the same.
    let small = cube(&folder, "small.gltf", r#"{"mesh":0}"#, "");
    let large = cube(
        &folder,
        "large.gltf",
        r#"{"mesh":0},{"mesh":0,"scale":[1,30,1]}"#,
        "",
    );
    let [few, many] = [small, large].map(|input: PathBuf| {
        done(
            "refine {} -o {} --tolerance 0.05 --crease-angle none",
            &[&input, &output],
        );
        let soup = soup(&output);
        soup.faces.len()
    });
    assert!(many > 4 * few, "{many} and {few}");
}

#[test]
fn materials_keep_their_border_and_stay_joined() {
    let folder = folder();
    let input = cube(&folder, "in.gltf", r#"{"mesh":0}"#, "");
    for (output, options) in [
        ("out.glb", "--tolerance 2%"),
        ("few.glb", "--tolerance 2% --optimize"),
        ("steps.glb", "--method uniform --levels 2"),
        ("sharp.gltf", "--tolerance 2% --crease-angle 30"),
    ] {
        let output = folder.path().join(output);
        let line = format!("refine {{}} -o {{}} {options}");
        done(&line, &[&input, &output]);
        // Read back, joined again along the border: closed.
        let whole = json_of("info {} --json", &[&output]);
        assert_eq!(whole["mesh"]["watertight"], true);
        let primitives = &whole["asset"]["meshes"][0]["primitives"];
        assert_eq!(
            (&primitives[0]["material"], &primitives[1]["material"]),
            (&"body".into(), &"lid".into())
        );
        assert_eq!(
            (&primitives[2]["mode"], &primitives[2]["indices"]),
            (&"lines".into(), &2.into())
        );
        if !options.contains("crease") {
            continue;
        }
        // With sharp edges the cube is itself, and the lid is what is on top.
        let asset = limitmesh_io::Asset::open(&output).expect("an asset");
        let mesh = asset
            .mesh(0, limitmesh_io::gltf::Joining::Never)
            .expect("a mesh");
        let height = |face: usize| {
            let corners = mesh.soup.faces.get(face).iter();
            corners
                .map(|&v| mesh.soup.positions[v as usize][2])
                .fold(f64::INFINITY, f64::min)
        };
        assert!(
            mesh.parts[1]
                .faces
                .clone()
                .all(|face| (height(face) - 1.0).abs() < 1e-6)
        );
        assert!(mesh.parts[0].faces.clone().all(|face| height(face) < 0.999));
    }
}

/// The mesh of a file, read by the library's other half.
pub(crate) fn first_mesh(path: &Path) -> limitmesh_io::gltf::MeshSoup {
    let asset = limitmesh_io::Asset::open(path).expect("an asset");
    asset
        .mesh(0, limitmesh_io::gltf::Joining::Never)
        .expect("a mesh")
}

#[test]
fn what_has_no_meaning_for_a_scene_is_refused() {
    let folder = folder();
    let input = cube(&folder, "in.gltf", r#"{"mesh":0}"#, "");
    let output = folder.path().join("out.glb");
    let refused = |options: &str, words: &str| {
        let line = format!("refine {{}} -o {{}} {options}");
        usage_error(&line, &[&input, &output], words);
    };
    refused("--view 0,0,5,0,0,0,0,1,0,45,100x100", "look at one mesh");
    refused("--angle 5 --view 0,0,1", "look at one mesh");
    refused("--provenance", "PLY");
    assert!(!output.exists());
    let broken = file(
        &folder,
        "broken.gltf",
        r#"{"asset":{"version":"2.0"},"nodes":[{"children":[0]}]}"#,
    );
    run("refine {} -o {}", &[&broken, &output])
        .expect(1)
        .saying("nodes[0]: the node is below itself");
    let empty = file(&folder, "empty.gltf", r#"{"asset":{"version":"2.0"}}"#);
    run("refine {} -o {}", &[&empty, &output])
        .expect(1)
        .saying("shows no triangles");
}

#[test]
fn assets_are_predicted_drawn_and_stand_for_meshes() {
    let folder = folder();
    let input = cube(
        &folder,
        "in.gltf",
        r#"{"mesh":0,"translation":[10,0,0]}"#,
        "",
    );
    let run_dry = done("refine {} --tolerance 1% --dry-run", &[&input]);
    says!(run_dry.stdout, "meshes[0] 'Box': ");
    says!(run_dry.stdout, "nothing was written");
    let (output, picture) = (
        folder.path().join("out.gltf"),
        folder.path().join("out.png"),
    );
    done("refine {} -o {} --picture {}", &[&input, &output, &picture]);
    is_png(&picture);
    // To a format without scenes: what is shown, in the scene's coordinates.
    let plain = folder.path().join("out.ply");
    done("refine {} -o {}", &[&input, &plain]);
    assert!(soup(&plain).positions.iter().all(|p| p[0] > 8.0));
    // And from one.
    let from = folder.path().join("from.glb");
    done("refine builtin:cube -o {} --tolerance 1%", &[&from]);
    let read = soup(&from);
    assert_eq!(
        (
            counts(&read).boundary_edges,
            counts(&read).euler_characteristic
        ),
        (0, 2)
    );
    measured_within(&from, "builtin:cube", 0.01);
}

/// The certified distance of a file to a limit surface is that share of its diagonal at most.
fn measured_within(path: &Path, control: &str, share: f64) {
    let command = format!("measure {{}} --limit-of {control} --certified --json");
    let report: Value = json_of(&command, &[path]);
    let percent = number(&report["hausdorff"]["upper_percent"]);
    assert!(percent <= 100.0 * share * 1.02, "{percent} %");
}

//! glTF assets: lengths are the scene's, borders between materials stay, and what cannot be carried along is told.

use std::path::{Path, PathBuf};

use serde_json::Value;
use tempfile::TempDir;

use crate::common::{counts, file, folder, run, soup};
use crate::glb::Glb;

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
        let report = run(
            "refine {} -o {} --tolerance 1% --report - --crease-angle none",
            &[&input, &output],
        )
        .expect(0)
        .json();
        let mesh = &report["meshes"][0];
        triangles.push(mesh["output"]["triangles"].as_u64().expect("a number"));
        let upper = mesh["error"]["upper"].as_f64().expect("a number");
        // The file's scene as another command reads it.
        let measured = run(
            "measure {} --limit-of {} --certified --json --crease-angle none",
            &[&output, &input],
        )
        .expect(0)
        .json();
        let found = measured["hausdorff"]["lower"].as_f64().expect("a number");
        let most = measured["hausdorff"]["upper"].as_f64().expect("a number");
        assert!(
            found <= upper && most >= 0.5 * upper,
            "{found} to {most}, told {upper}"
        );
        let size = mesh["error"]["diagonal"].as_f64().expect("a number");
        assert!(upper <= 0.01 * size * (1.0 + 1e-9), "{upper} of {size}");
    }
    assert!(
        triangles[0] == triangles[1] && triangles[1] == triangles[2],
        "{triangles:?}"
    );
    // A length holds in the scene, too: 1000 times larger needs more triangles for the same.
    let small = cube(&folder, "small.gltf", r#"{"mesh":0}"#, "");
    let large = cube(
        &folder,
        "large.gltf",
        r#"{"mesh":0},{"mesh":0,"scale":[1,30,1]}"#,
        "",
    );
    let [few, many] = [small, large].map(|input: PathBuf| {
        run(
            "refine {} -o {} --tolerance 0.05 --crease-angle none",
            &[&input, &output],
        )
        .expect(0);
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
        run(
            &format!("refine {{}} -o {{}} {options}"),
            &[&input, &output],
        )
        .expect(0);
        // Read back, joined again along the border: closed.
        let whole = run("info {} --json", &[&output]).expect(0).json();
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

/// What a file's mesh has, read by the library's other half.
pub(crate) fn first_mesh(path: &Path) -> limitmesh_io::gltf::MeshSoup {
    let asset = limitmesh_io::Asset::open(path).expect("an asset");
    asset
        .mesh(0, limitmesh_io::gltf::Joining::Never)
        .expect("a mesh")
}

#[test]
fn values_are_linear_on_the_faces_they_come_from() {
    let folder = folder();
    let output = folder.path().join("out.glb");
    // The cube's own positions as values: wherever vertices move, these stay on the cube and cover it once.
    let input = cube(
        &folder,
        "in.gltf",
        r#"{"mesh":0}"#,
        r#","_HEAT":0,"_SIDE":4"#,
    );
    for options in [
        "",
        "--crease-angle 30",
        "--crease-angle 100 --boundary corners",
    ] {
        let command = format!("refine {{}} -o {{}} --tolerance 1% {options} --report -");
        let report = run(&command, &[&input, &output]).expect(0).json();
        assert_eq!(report["left_out"], serde_json::json!([]));
        let mesh = first_mesh(&output);
        let table = |name: &str| {
            mesh.attributes
                .iter()
                .find(|table| table.name == name)
                .expect("a table")
        };
        let (heat, side) = (table("_HEAT"), table("_SIDE"));
        let point = |v: u32| -> [f64; 3] {
            heat.values[3 * v as usize..][..3]
                .try_into()
                .expect("three numbers")
        };
        let mut area = 0.0;
        for corners in &heat.corners {
            let [a, b, c] = corners.map(point);
            let is_on =
                |axis: usize| a[axis].abs() == 1.0 && a[axis] == b[axis] && a[axis] == c[axis];
            assert!((0..3).any(is_on), "{a:?} {b:?} {c:?} on no side");
            let [u, v] = [b, c].map(|p| [0, 1, 2].map(|i| p[i] - a[i]));
            let normal = [0, 1, 2]
                .map(|i| u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3]);
            area += 0.5 * normal.iter().map(|x| x * x).sum::<f64>().sqrt();
        }
        assert!((area - 24.0).abs() < 1e-5, "{area}");
        // Whole numbers are never blended.
        assert!(
            side.is_integer
                && side
                    .values
                    .chunks(4)
                    .all(|id| id[0] <= 1.0 && id[1..] == [9.0, 0.0, 0.0])
        );
    }
    // Where triangles reach over many faces, too, values are those of the faces that their corners are from.
    let single = cube(&folder, "single.gltf", r#"{"mesh":0}"#, r#","_HEAT":0"#);
    let text = std::fs::read_to_string(&single)
        .expect("text")
        .replace(r#""count":30"#, r#""count":36"#);
    let (before, rest) = text
        .split_once(r#"{"attributes":{"POSITION":0,"_HEAT":0},"indices":2"#)
        .expect("the lid");
    let rest = rest.split_once("},").expect("the line").1;
    let single = file(&folder, "single.gltf", &format!("{before}{rest}"));
    let told = run(
        "refine {} -o {} --optimize --tolerance 1%",
        &[&single, &output],
    )
    .expect(0)
    .stderr;
    assert!(!told.contains("left out"), "{told}");
    let mesh = first_mesh(&output);
    let heat = mesh
        .attributes
        .iter()
        .find(|table| table.name == "_HEAT")
        .expect("a table");
    assert!(
        heat.values
            .chunks(3)
            .all(|p| p.iter().any(|x| x.abs() == 1.0)),
        "points of the cube"
    );
}

#[test]
fn skins_are_carried_along() {
    let folder = folder();
    let output = folder.path().join("out.glb");
    let nodes = r#"{"mesh":0,"skin":0},{},{"translation":[0,0,5]}],"skins":[{"joints":[1,2]}"#;
    let input = cube(&folder, "in.gltf", nodes, r#","JOINTS_0":4,"WEIGHTS_0":5"#);
    for options in [
        "--tolerance 1% --optimize --crease-angle none",
        "--method uniform --limit",
        "--tolerance 1%",
    ] {
        run(
            &format!("refine {{}} -o {{}} {options}"),
            &[&input, &output],
        )
        .expect(0);
        check_weights(&first_mesh(&output));
    }
    // In its pose it is longer by as much as its second joint is away.
    let soup = soup(&output);
    let height = soup.positions.iter().fold(0.0f64, |most, p| most.max(p[2]));
    assert!(height > 4.5, "{height}");
}

fn check_weights(mesh: &limitmesh_io::gltf::MeshSoup) {
    assert_eq!(mesh.influences.len(), mesh.soup.positions.len());
    // Weights are the height of the corners, so they are the height of the surface.
    for (p, influences) in mesh.soup.positions.iter().zip(&mesh.influences) {
        let up = 0.5 * (p[2] + 1.0);
        let weight = |joint: u32| {
            let own = influences.iter().find(|(own, _)| *own == joint);
            own.map_or(0.0, |&(_, weight)| weight)
        };
        assert!((weight(1) - up).abs() < 1e-6 && (weight(0) + weight(1) - 1.0).abs() < 1e-6);
    }
}

/// A target that moves vertices by where they are moves those of the result by where these are.
#[test]
fn targets_are_carried_through_collapses_and_steps() {
    let folder = folder();
    let output = folder.path().join("out.glb");
    let input = cube(&folder, "in.gltf", r#"{"mesh":0}"#, "");
    let text = std::fs::read_to_string(&input).expect("text");
    let input = file(
        &folder,
        "in.gltf",
        &text.replace(r#""indices":"#, r#""targets":[{"POSITION":0}],"indices":"#),
    );
    for options in [
        "--tolerance 1% --optimize --crease-angle none",
        "--method uniform --limit",
    ] {
        run(
            &format!("refine {{}} -o {{}} {options}"),
            &[&input, &output],
        )
        .expect(0);
        let found = Glb::read(&output);
        let primitive = found.primitive(0);
        let [at, moved] = [&primitive["attributes"], &primitive["targets"][0]]
            .map(|all| found.points(&all["POSITION"]));
        assert!(at.len() > 30 && at.len() == moved.len());
        for (p, q) in at.iter().zip(&moved) {
            assert!((0..3).all(|i| (p[i] - q[i]).abs() < 1e-6), "{p:?} {q:?}");
        }
    }
}

#[test]
fn what_has_no_meaning_for_a_scene_is_refused() {
    let folder = folder();
    let input = cube(&folder, "in.gltf", r#"{"mesh":0}"#, "");
    let output = folder.path().join("out.glb");
    let refused = |options: &str, words: &str| {
        run(
            &format!("refine {{}} -o {{}} {options}"),
            &[&input, &output],
        )
        .expect(2)
        .saying(words);
    };
    refused("--camera 0,0,5,0,0,0,0,1,0,45,100x100", "look at one mesh");
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
    let run_dry = run("refine {} --tolerance 1% --dry-run", &[&input]).expect(0);
    assert!(
        run_dry.stdout.contains("meshes[0] 'Box': ")
            && run_dry.stdout.contains("nothing was written")
    );
    let (output, picture) = (
        folder.path().join("out.gltf"),
        folder.path().join("out.png"),
    );
    run("refine {} -o {} --picture {}", &[&input, &output, &picture]).expect(0);
    assert!(
        std::fs::read(&picture)
            .expect("a picture")
            .starts_with(b"\x89PNG")
    );
    // To a format without scenes: what is shown, in the scene's coordinates.
    let plain = folder.path().join("out.ply");
    run("refine {} -o {}", &[&input, &plain]).expect(0);
    assert!(soup(&plain).positions.iter().all(|p| p[0] > 8.0));
    // And from one.
    let from = folder.path().join("from.glb");
    run("refine builtin:cube -o {} --tolerance 1%", &[&from]).expect(0);
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
    let report: Value = run(&command, &[path]).expect(0).json();
    let percent = report["hausdorff"]["upper_percent"]
        .as_f64()
        .expect("a number");
    assert!(percent <= 100.0 * share * 1.02, "{percent} %");
}

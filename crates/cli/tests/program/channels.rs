//! `--channel NAME=MODE`: what a mesh carries comes out as it was asked for.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use limitmesh::mesh::Channel;
use serde_json::Value;
use tempfile::TempDir;

use crate::asset::{cube, first_mesh};
use crate::common::{done, file, folder, json_of, refuses, soup, text, usage_error};

/// An octahedron in PLY, whose vertices have their x as `heat` and twice that as the whole number `id`.
fn octahedron(folder: &TempDir) -> PathBuf {
    let mut text = "ply\nformat ascii 1.0\nelement vertex 6\n".to_owned();
    for (kind, name) in [
        ("double", "x"),
        ("double", "y"),
        ("double", "z"),
        ("double", "heat"),
        ("int", "id"),
    ] {
        writeln!(text, "property {kind} {name}").expect("text");
    }
    text += "element face 8\nproperty list uchar int vertex_indices\nend_header\n";
    for [x, y, z] in [
        [1, 0, 0],
        [-1, 0, 0],
        [0, 1, 0],
        [0, -1, 0],
        [0, 0, 1],
        [0, 0, -1],
    ] {
        writeln!(text, "{x} {y} {z} {x} {}", 2 * x).expect("text");
    }
    for [a, b] in [[0, 2], [2, 1], [1, 3], [3, 0]] {
        writeln!(text, "3 {a} {b} 4\n3 {b} {a} 5").expect("text");
    }
    file(folder, "octahedron.ply", &text)
}

/// The numbers of a channel at the corners of a file, with x there.
fn beside_x(path: &Path, name: &str) -> Vec<(f64, f64)> {
    let soup = soup(path);
    let own: &Channel = soup
        .channels
        .iter()
        .find(|channel| channel.name == name)
        .expect("the channel");
    (0..soup.positions.len())
        .map(|v| (own.value(v)[0], soup.positions[v][0]))
        .collect()
}

#[test]
fn channels_are_carried_as_asked() {
    let folder = folder();
    let input = octahedron(&folder);
    let output = folder.path().join("out.ply");
    let refine = |options: &str| -> Value {
        let command = format!("refine {{}} -o {{}} --tolerance 1% --report - {options}");
        json_of(&command, &[&input, &output])
    };
    // What is smooth follows the surface as x does, whole numbers too.
    let report = refine("--channel heat=smooth --channel id=smooth");
    assert_eq!(report["input"]["channels"][0]["interpolation"], "smooth");
    assert!(
        beside_x(&output, "heat")
            .iter()
            .all(|&(heat, x)| (heat - x).abs() < 1e-12)
    );
    assert!(
        beside_x(&output, "id")
            .iter()
            .all(|&(id, x)| (id - 2.0 * x).abs() < 1e-12)
    );
    // Linear, as usual for such numbers: the octahedron's vertices keep theirs, though they move inwards.
    for options in [
        "",
        "--channel id=linear",
        "--channel heat=smooth --channel heat=linear --channel id=linear",
    ] {
        let report = refine(options);
        assert_eq!(
            report["input"]["channels"][0]["interpolation"], "linear",
            "{options}"
        );
        let heat = beside_x(&output, "heat");
        assert!(
            heat.iter().any(|&(heat, x)| heat == 1.0 && x < 0.9),
            "{options}"
        );
        assert!(
            heat.iter().any(|&(heat, _)| heat.fract() != 0.0),
            "{options}"
        );
        if !options.is_empty() {
            let id = beside_x(&output, "id");
            assert!(
                heat.iter()
                    .zip(&id)
                    .all(|((heat, _), (id, _))| (2.0 * heat - id).abs() < 1e-12)
            );
        }
    }
    // Never blended.
    refine("--channel heat=nearest");
    assert!(
        beside_x(&output, "heat")
            .iter()
            .all(|&(heat, _)| [-1.0, 0.0, 1.0].contains(&heat))
    );
    assert!(
        beside_x(&output, "id")
            .iter()
            .all(|&(id, _)| [-2.0, 0.0, 2.0].contains(&id))
    );
}

#[test]
fn channels_are_left_out_on_demand() {
    let folder = folder();
    let input = octahedron(&folder);
    let output = folder.path().join("out.ply");
    let found = done(
        "refine {} -o {} --channel heat=drop --report -",
        &[&input, &output],
    );
    assert_eq!(
        found.json()["input"]["channels"][0]["interpolation"],
        "drop"
    );
    found.saying("left out: heat (by --channel)");
    // Normals are in every PLY file.
    let names = soup(&output)
        .channels
        .into_iter()
        .map(|own| own.name)
        .filter(|name| name != "normals");
    let names: Vec<String> = names.collect();
    assert_eq!(names, ["id"]);
    // Where no channel is left, nothing distinguishes faces: flat regions are triangulated from their rims.
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nusemtl a\nf 4 3 2 1\nf 5 6 7 8\n\
                usemtl b\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    let cube = file(&folder, "cube.obj", cube);
    let output = folder.path().join("out.obj");
    done(
        "refine {} -o {} --crease-angle 30 --channel materials=drop",
        &[&cube, &output],
    );
    let written = text(&output);
    assert!(!written.contains("usemtl"), "{written}");
}

#[test]
fn what_cannot_be_done_is_refused() {
    let folder = folder();
    let input = octahedron(&folder);
    let output = folder.path().join("out.ply");
    refuses(
        &[("input", &input), ("output", &output)],
        "
        2 | refine {input} -o {output} --channel hat=drop | octahedron.ply has no channel 'hat'; there are: heat; id
        2 | refine {input} --dry-run --channel hat=drop | no channel 'hat'
        2 | refine builtin:cup -o {output} --channel heat=drop | there is none
        2 | refine {input} -o {output} --channel heat | has no =
        2 | refine {input} -o {output} --channel heat=blend | 'blend' is none of",
    );
    let labelled = file(
        &folder,
        "in.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n",
    );
    usage_error(
        "refine {} -o {} --channel materials=linear",
        &[&labelled, &output],
        "'materials' has one value a face; it can be nearest or drop",
    );
    // Names may have blanks.
    let blank = Path::new("texture coordinates=linear");
    done("refine {} -o {} --channel {}", &[&labelled, &output, blank]);
}

#[test]
fn attributes_of_assets_are_carried_as_asked() {
    let folder = folder();
    let output = folder.path().join("out.glb");
    let input = cube(
        &folder,
        "in.gltf",
        r#"{"mesh":0}"#,
        r#","_HEAT":0,"_SIDE":4"#,
    );
    let command =
        "refine {} -o {} --tolerance 1% --channel _HEAT=smooth --channel _SIDE=drop --report -";
    let report = done(command, &[&input, &output])
        .saying("left out: _SIDE")
        .json();
    assert_eq!(
        report["meshes"][0]["input"]["channels"][0]["interpolation"],
        "smooth"
    );
    assert_eq!(
        report["meshes"][0]["input"]["channels"][1]["interpolation"],
        "drop"
    );
    // Positions as values go where positions go.
    let mesh = first_mesh(&output);
    let [heat] = &mesh.attributes[..] else {
        panic!("{:?}", mesh.attributes.len())
    };
    for (&v, &value) in mesh.soup.faces.iter().flatten().zip(&heat.corners) {
        let (p, q) = (
            mesh.soup.positions[v as usize],
            &heat.values[3 * value as usize..][..3],
        );
        assert!(
            p.iter().zip(q).all(|(a, b)| (a - b).abs() < 1e-6),
            "{p:?} {q:?}"
        );
    }
    usage_error(
        "refine {} -o {} --channel HEAT=drop",
        &[&input, &output],
        "no channel 'HEAT'; there are: _HEAT; _SIDE",
    );
}

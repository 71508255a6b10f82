//! Morph targets of glTF assets: at any weights the refined mesh is the limit of the control mesh at these weights.

use std::path::PathBuf;

use limitmesh::Triangles;
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::common::{count, done, folder, list, usage_error};
use crate::glb::{Builder, Glb, distances, limit};

type Points = Vec<[f32; 3]>;

/// The sides of a long box with vertices of its own each, as files have them: positions, normals, triangles.
fn sides() -> (Points, Points, Vec<[u32; 3]>) {
    let (mut points, mut normals, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for side in 0..6 {
        let (axis, sign) = (side / 2, if side % 2 == 0 { 1.0 } else { -1.0 });
        for (u, v) in [(-1f32, -1f32), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            let mut point = [0.0; 3];
            (point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3]) = (sign, sign * u, v);
            points.push([point[0], point[1], 2.0 * point[2]]);
            let mut normal = [0.0; 3];
            normal[axis] = sign;
            normals.push(normal);
        }
        let first = 4 * side as u32;
        triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    (points, normals, triangles)
}

/// The displacements of the targets of the asset below: a bend; nothing; one corner moved; and nothing again.
fn moved(target: usize, [x, y, z]: [f32; 3]) -> [f32; 3] {
    match target {
        0 => [0.25 * z * z, 0.1 * x * z, -0.3 * y],
        2 if [x, y, z] == [1.0, 1.0, 2.0] => [0.5, 0.25, 1.0],
        _ => [0.0; 3],
    }
}

const TARGETS: usize = 4;

/// The box with these targets: plain, without a view, sparse without a view, and tangents alone.
fn asset(folder: &TempDir, has_normals: bool) -> PathBuf {
    let (points, normals, triangles) = sides();
    let mut builder = Builder::new();
    let (position, normal) = (builder.points(&points), builder.points(&normals));
    let indices = builder.indices(&triangles);
    let bend = builder.points(&points.iter().map(|&p| moved(0, p)).collect::<Vec<_>>());
    let zeros = json!({"componentType": 5126, "count": 24, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 0]});
    let none = builder.accessor(zeros.clone());
    let corners: Vec<usize> = (0..24)
        .filter(|&v| moved(2, points[v]) != [0.0; 3])
        .collect();
    let places = builder.view(corners.iter().map(|&v| v as u8));
    let values = builder.view(
        corners
            .iter()
            .flat_map(|&v| moved(2, points[v]))
            .flat_map(f32::to_le_bytes),
    );
    let mut sparse = zeros;
    sparse["max"] = json!([0.5, 0.25, 1.0]);
    sparse["sparse"] = json!({"count": corners.len(), "indices": {"bufferView": places, "componentType": 5121},
        "values": {"bufferView": values}});
    let corner = builder.accessor(sparse);
    let texture = builder.floats(
        &points.iter().flat_map(|p| [p[0], p[2]]).collect::<Vec<_>>(),
        2,
    );
    let slide = builder.floats(
        &points
            .iter()
            .flat_map(|p| [0.25, 0.5 * p[2]])
            .collect::<Vec<_>>(),
        2,
    );
    let mut primitive = json!({"attributes": {"POSITION": position, "NORMAL": normal, "TEXCOORD_0": texture},
        "indices": indices, "extras": {"kept": [1, 2]},
        "targets": [{"POSITION": bend, "NORMAL": none, "TEXCOORD_0": slide}, {"POSITION": none},
            {"POSITION": corner}, {"TANGENT": none}]});
    if !has_normals {
        primitive["attributes"]
            .as_object_mut()
            .expect("attributes")
            .remove("NORMAL");
        primitive["targets"][0]
            .as_object_mut()
            .expect("a target")
            .remove("NORMAL");
    }
    builder.primitive(primitive);
    builder.json["meshes"][0]["weights"] = json!([0.5, 0, 0.25, 0]);
    builder.json["meshes"][0]["extras"] =
        json!({"targetNames": ["bend", "none", "corner", "tangents"]});
    let input = folder.path().join("in.glb");
    builder.write(&input);
    input
}

fn blended(base: &[[f64; 3]], added: &[Vec<[f64; 3]>], weights: &[f64]) -> Vec<[f64; 3]> {
    let mut positions = base.to_vec();
    for (added, weight) in added.iter().zip(weights) {
        for (p, d) in positions.iter_mut().zip(added) {
            (0..3).for_each(|i| p[i] += weight * d[i]);
        }
    }
    positions
}

#[test]
fn refined_morphs_are_limits_of_morphs() {
    let folder = folder();
    let (input, output) = (asset(&folder, true), folder.path().join("out.glb"));
    done(
        "refine {} -o {} --tolerance 0.2% --crease-angle none",
        &[&input, &output],
    )
    .saying("left out: TANGENT of morph targets");
    let glb = Glb::read(&output);
    let primitive = glb.primitive(0);
    let targets = list(&primitive["targets"]);
    let names = |target: &Value| {
        target
            .as_object()
            .expect("names")
            .keys()
            .cloned()
            .collect::<Vec<_>>()
    };
    let found: Vec<Vec<String>> = targets.iter().map(names).collect();
    let expected: [&[&str]; TARGETS] = [
        &["NORMAL", "POSITION", "TEXCOORD_0"],
        &["POSITION"],
        &["NORMAL", "POSITION"],
        &["POSITION"],
    ];
    assert_eq!(found, expected);
    let before = Glb::read(&input);
    for key in ["weights", "extras"] {
        assert_eq!(glb.json["meshes"][0][key], before.json["meshes"][0][key]);
    }
    assert_eq!(primitive["extras"], json!({"kept": [1, 2]}));

    let base = glb.points(&primitive["attributes"]["POSITION"]);
    let added: Vec<Vec<[f64; 3]>> = targets
        .iter()
        .map(|target| glb.points(&target["POSITION"]))
        .collect();
    let triangles = glb.triangles(0);
    let (control, _, control_triangles) = sides();
    let control_added: Vec<Vec<[f64; 3]>> = (0..TARGETS)
        .map(|k| {
            control
                .iter()
                .map(|&p| moved(k, p).map(f64::from))
                .collect()
        })
        .collect();
    let control: Vec<[f64; 3]> = control.iter().map(|p| p.map(f64::from)).collect();
    for weights in [
        [0.0; 4],
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 1.0, 1.0],
        [-0.5, 0.0, 0.75, 0.0],
    ] {
        let posed = blended(&base, &added, &weights);
        let reference = limit(
            &blended(&control, &control_added, &weights),
            &control_triangles,
            2e-5,
        );
        let surface = Triangles {
            positions: &posed,
            triangles: &triangles,
        };
        let [from, to] = distances(surface, reference.as_triangles());
        // Vertices are on the limit, and triangles come near all of it: the base's are within 0.002 of its size.
        let diagonal = reference.diagonal();
        below!(from, 2.1e-5 * diagonal, "{weights:?}");
        below!(to, 0.004 * diagonal, "{weights:?}");
    }
    // Texture coordinates slide as said: linear in what is carried with positions, constant along u.
    let slide = glb.numbers(&targets[0]["TEXCOORD_0"]);
    assert!(slide.iter().step_by(2).all(|&u| (u - 0.25).abs() < 1e-6));
    let texture = glb.numbers(&primitive["attributes"]["TEXCOORD_0"]);
    assert!(
        slide
            .chunks(2)
            .zip(texture.chunks(2))
            .all(|(d, t)| (d[1] - 0.5 * t[1]).abs() < 1e-6)
    );
}

#[test]
fn what_moves_apart_is_told_and_can_be_joined() {
    let folder = folder();
    let (points, _, triangles) = sides();
    let mut builder = Builder::new();
    let (position, indices) = (builder.points(&points), builder.indices(&triangles));
    // The first side opens like a lid, and three of its corners have other weights.
    let lid: Vec<[f32; 3]> = (0..24)
        .map(|v| if v == 0 { [0.0, 0.0, 0.5] } else { [0.0; 3] })
        .collect();
    let lid = builder.points(&lid);
    let joints = builder.joints(&[[0, 1, 0, 0]; 24]);
    let weights: Vec<f32> = (0..24)
        .flat_map(|v| {
            if v < 3 {
                [1.0, 0.0, 0.0, 0.0]
            } else {
                [0.5, 0.5, 0.0, 0.0]
            }
        })
        .collect();
    let weights = builder.floats(&weights, 4);
    builder.primitive(
        json!({"attributes": {"POSITION": position, "JOINTS_0": joints, "WEIGHTS_0": weights},
        "indices": indices, "targets": [{"POSITION": lid}]}),
    );
    builder.json["nodes"] = json!([{"mesh": 0, "skin": 0}, {}, {}]);
    builder.json["skins"] = json!([{"joints": [1, 2]}]);
    let (input, output) = (folder.path().join("in.glb"), folder.path().join("out.glb"));
    builder.write(&input);
    let open_edges = |options: &str, words: &str| {
        let command = format!("refine {{}} -o {{}} --tolerance 2% --report - {options}");
        let run = done(&command, &[&input, &output]);
        let run = if words.is_empty() {
            run
        } else {
            run.saying(words)
        };
        assert!(
            !words.is_empty() || !run.stderr.contains("apart"),
            "{}",
            run.stderr
        );
        count(&run.json()["meshes"][0]["output"]["boundary_edges"])
    };
    // Vertex 0 has both another displacement and another weight; 1 and 2 another weight.
    let all = "3 vertices kept apart where others stand, because of their joints and weights";
    let apart = open_edges("", all);
    assert!(apart > 0);
    assert_eq!(open_edges("--weld-ignores morphs", all), apart);
    let less = open_edges(
        "--weld-ignores skin",
        "1 vertex kept apart where others stand, because of morph targets",
    );
    assert!(less < apart, "{less} and {apart}");
    assert_eq!(open_edges("--weld-ignores skin,morphs", ""), 0);
    usage_error(
        "refine builtin:cube -o {} --weld-ignores skin",
        &[&output],
        "glTF assets",
    );
}

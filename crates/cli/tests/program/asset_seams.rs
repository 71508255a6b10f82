//! Seams of glTF assets whose two sides differ by rounding: what closes them is said, and done where it is asked for.

use std::path::PathBuf;

use serde_json::json;
use tempfile::TempDir;

use crate::common::{data, folder, run};
use crate::glb::{Builder, Glb};

#[test]
fn nearly_closed_seams_are_told_and_can_be_welded() {
    let folder = folder();
    let (input, output) = (data("web_sphere.glb"), folder.path().join("out.glb"));
    let told = run("refine {} -o {}", &[&input, &output]).expect(0);
    let advice = told
        .stderr
        .split("all of them would close with --weld ")
        .nth(1)
        .expect("advice");
    let distance = advice.split(',').next().expect("a distance");
    for distance in [distance, "1e-5"] {
        let command = format!("refine {{}} -o {{}} --tolerance 0.1% --report - --weld {distance}");
        let run = run(&command, &[&input, &output]).expect(0);
        assert!(!run.stderr.contains("would close"), "{}", run.stderr);
        let report = run.json();
        let written = &report["meshes"][0]["output"];
        assert_eq!(
            (&written["boundary_edges"], &written["euler_characteristic"]),
            (&json!(0), &json!(2))
        );
        // No notch: all vertices are as far out as a sphere's limit is, and the texture's seam is still there.
        let glb = Glb::read(&output);
        let attributes = &glb.primitive(0)["attributes"];
        let points = glb.points(&attributes["POSITION"]);
        let radii: Vec<f64> = points
            .iter()
            .map(|p| p.iter().map(|x| x * x).sum::<f64>().sqrt())
            .collect();
        let [least, most] = [
            radii.iter().copied().fold(f64::MAX, f64::min),
            radii.iter().copied().fold(0.0, f64::max),
        ];
        assert!(least > 0.93 && most < 1.0, "radii from {least} to {most}");
        let texture = glb.numbers(&attributes["TEXCOORD_0"]);
        let across = glb
            .triangles(0)
            .into_iter()
            .map(|t| t.map(|v| texture[2 * v as usize]));
        assert!(
            across
                .clone()
                .all(|[a, b, c]| a.max(b).max(c) - a.min(b).min(c) < 0.5)
        );
    }
}

/// Two triangles of a scene twice as large, 2e-6 apart along an edge there, the second with this displacement and this weight at the edge.
fn gap(folder: &TempDir, [lift, weight]: [f32; 2]) -> PathBuf {
    let mut builder = Builder::new();
    let points = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, -1e-6, 0.0],
        [0.0, -1e-6, 0.0],
        [0.0, -1.0, 0.0f32],
    ];
    let (position, indices) = (
        builder.points(&points),
        builder.indices(&[[0, 1, 2], [3, 4, 5]]),
    );
    let lifted: Vec<[f32; 3]> = (0..6)
        .map(|v| [0.0, 0.0, if v < 3 { 0.5 } else { lift }])
        .collect();
    let target = builder.points(&lifted);
    let joints = builder.joints(&[[0, 1, 0, 0]; 6]);
    let weights: Vec<f32> = (0..6)
        .map(|v| if v < 3 { 0.5 } else { weight })
        .flat_map(|first| [first, 1.0 - first, 0.0, 0.0])
        .collect();
    let weights = builder.floats(&weights, 4);
    builder.primitive(
        json!({"attributes": {"POSITION": position, "JOINTS_0": joints, "WEIGHTS_0": weights},
        "indices": indices, "targets": [{"POSITION": target}]}),
    );
    builder.json["nodes"] =
        json!([{"mesh": 0, "skin": 0}, {"scale": [2, 2, 2]}, {"scale": [2, 2, 2]}]);
    builder.json["skins"] = json!([{"joints": [1, 2]}]);
    let input = folder.path().join("in.glb");
    builder.write(&input);
    input
}

#[test]
fn what_moves_apart_is_not_welded() {
    let folder = folder();
    let output = folder.path().join("out.glb");
    let vertices = |differences: [f32; 2], options: &str| {
        let input = gap(&folder, differences);
        let command = format!("refine {{}} -o {{}} --tolerance 5% --report - {options}");
        let run = run(&command, &[&input, &output]).expect(0);
        run.json()["meshes"][0]["input"]["vertices"]
            .as_u64()
            .expect("a number")
    };
    // Both differ by rounding; the distance is the scene's.
    let rounding = [0.5 + 1e-7, 0.5 + 1e-7];
    assert_eq!(vertices(rounding, ""), 6);
    assert_eq!(vertices(rounding, "--weld 1e-6"), 6);
    assert_eq!(vertices(rounding, "--weld 1e-5"), 4);
    assert_eq!(vertices([0.6, 0.5], "--weld 1e-5"), 6);
    assert_eq!(vertices([0.5, 0.6], "--weld 1e-5"), 6);
    assert_eq!(vertices([0.6, 0.5], "--weld 1e-5 --weld-ignores morphs"), 4);
    assert_eq!(vertices([0.5, 0.6], "--weld 1e-5 --weld-ignores skin"), 4);
}

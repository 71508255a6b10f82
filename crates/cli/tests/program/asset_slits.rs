//! Lips and lids of glTF assets: faces without area at rest that morph targets and joints open are faces.

use std::path::Path;

use limitmesh::Triangles;
use serde_json::json;

use crate::common::{Run, data, folder, run};
use crate::glb::{Builder, Glb, distances, limit};

/// The number before the words that say how near all morph targets are.
fn told(run: &Run) -> f64 {
    let line = run
        .stderr
        .lines()
        .find(|line| line.contains("each morph target within"));
    let words = line.expect("morph targets are told").split_whitespace();
    words
        .filter_map(|word| word.parse().ok())
        .next()
        .expect("a number")
}

/// The only primitive of an asset.
struct Morphs {
    glb: Glb,
    base: Vec<[f64; 3]>,
    /// By target, what it adds to positions.
    added: Vec<Vec<[f64; 3]>>,
}

fn morphs(path: &Path) -> Morphs {
    let glb = Glb::read(path);
    let primitive = glb.primitive(0);
    let base = glb.points(&primitive["attributes"]["POSITION"]);
    let targets = primitive["targets"].as_array().into_iter().flatten();
    let added = targets
        .map(|target| glb.points(&target["POSITION"]))
        .collect();
    Morphs { glb, base, added }
}

fn plus(base: &[[f64; 3]], added: &[[f64; 3]]) -> Vec<[f64; 3]> {
    base.iter()
        .zip(added)
        .map(|(p, d)| [0, 1, 2].map(|i| p[i] + d[i]))
        .collect()
}

#[test]
fn lips_that_a_target_opens_stay_two() {
    let folder = folder();
    let (input, output) = (data("slit_morph.glb"), folder.path().join("out.glb"));
    let run = run("refine {} -o {} --tolerance 1%", &[&input, &output]).expect(0);
    assert!(!run.stderr.contains("without area"), "{}", run.stderr);
    let bound = told(&run);
    // At weight 1 the control mesh has area everywhere: its limit needs no repair.
    let Morphs {
        glb: control,
        base,
        added,
    } = morphs(&input);
    let reference = limit(&plus(&base, &added[0]), &control.triangles(0), 1e-4);
    let Morphs {
        glb: refined,
        base,
        added,
    } = morphs(&output);
    let triangles = refined.triangles(0);
    let posed = plus(&base, &added[0]);
    let both = distances(
        Triangles {
            positions: &posed,
            triangles: &triangles,
        },
        reference.as_triangles(),
    );
    for distance in both {
        assert!(
            distance <= bound + 1e-4 * reference.diagonal(),
            "{distance} where {bound} is told"
        );
    }
    assert!(bound < 0.01 * 3.4642, "{bound}");
}

/// Loop's limit of an inner vertex of valence 4: 31/220 of each neighbour's value and the rest of its own, by Loop's weight
/// β = (5/8 − (3/8 + cos(2π/4)/4)²)/4 = 31/256 and 1/(3/(8β) + 4).
fn limit_of_four(own: f64, neighbours: [f64; 4]) -> f64 {
    (96.0 * own + 31.0 * neighbours.iter().sum::<f64>()) / 220.0
}

#[test]
fn lids_between_two_lips_are_faces() {
    let folder = folder();
    let (input, output) = (data("mouth_morph.glb"), folder.path().join("out.glb"));
    run(
        "refine {} -o {} --tolerance 1% --boundary fixed",
        &[&input, &output],
    )
    .expect(0);
    let Morphs { base, added, .. } = morphs(&output);
    // The lips' control points are moved by -0.2 and 0.4; each has the other as a neighbour, and three that stay.
    for (at, by, other, y) in [(0.0, -0.2, 0.4, -1.0), (0.0, 0.4, -0.2, 1.0)] {
        let rest = limit_of_four(at, [0.0, 0.0, 0.0, y]);
        let moved = limit_of_four(by, [0.0, 0.0, 0.0, other]);
        let near = |p: &[f64; 3]| (p[0] - 1.0).abs() < 1e-6 && (p[1] - rest).abs() < 1e-6;
        let found = base
            .iter()
            .position(near)
            .expect("a lip where its limit is");
        assert!(
            (added[0][found][1] - moved).abs() < 1e-6,
            "{:?} and {moved}",
            added[0][found]
        );
    }
}

#[test]
fn lips_that_joints_open_stay_two() {
    let folder = folder();
    let Morphs {
        glb: source,
        base,
        added,
    } = morphs(&data("slit_morph.glb"));
    // Each lip has a joint of its own, all else a third: by moving the joints, the lips go where the target takes them.
    let joint = |v: usize| match added[0][v][1] {
        y if y > 0.0 => 1u8,
        y if y < 0.0 => 2,
        _ => 0,
    };
    let mut builder = Builder::new();
    let points: Vec<[f32; 3]> = base.iter().map(|p| p.map(|x| x as f32)).collect();
    let position = builder.points(&points);
    let indices = builder.indices(&source.triangles(0));
    let joints: Vec<[u8; 4]> = (0..base.len()).map(|v| [joint(v), 0, 0, 0]).collect();
    let joints = builder.joints(&joints);
    let weights = builder.floats(&[1.0, 0.0, 0.0, 0.0].repeat(base.len()), 4);
    builder.primitive(
        json!({"attributes": {"POSITION": position, "JOINTS_0": joints, "WEIGHTS_0": weights},
        "indices": indices}),
    );
    builder.json["nodes"] = json!([{"mesh": 0, "skin": 0}, {}, {}, {}]);
    builder.json["skins"] = json!([{"joints": [1, 2, 3]}]);
    let (input, output) = (folder.path().join("in.glb"), folder.path().join("out.glb"));
    builder.write(&input);
    run("refine {} -o {} --tolerance 0.5%", &[&input, &output]).expect(0);
    let refined = Glb::read(&output);
    let attributes = &refined.primitive(0)["attributes"];
    let rest = refined.points(&attributes["POSITION"]);
    let (joints, weights) = (
        refined.numbers(&attributes["JOINTS_0"]),
        refined.numbers(&attributes["WEIGHTS_0"]),
    );
    let moves = [[0.0; 3], [0.0, 0.5, 0.2], [0.0, -0.5, 0.2]];
    let posed: Vec<[f64; 3]> = rest
        .iter()
        .zip(joints.chunks(4).zip(weights.chunks(4)))
        .map(|(p, (joints, weights))| {
            [0, 1, 2].map(|i| {
                p[i] + (0..4)
                    .map(|k| weights[k] * moves[joints[k] as usize][i])
                    .sum::<f64>()
            })
        })
        .collect();
    let reference = limit(&plus(&base, &added[0]), &source.triangles(0), 1e-4);
    let triangles = refined.triangles(0);
    let both = distances(
        Triangles {
            positions: &posed,
            triangles: &triangles,
        },
        reference.as_triangles(),
    );
    // Weights are blended exactly at vertices; between them nothing is promised of poses.
    assert!(both[0] < 2e-3 && both[1] < 0.05, "{both:?}");
}

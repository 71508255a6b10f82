//! `--attribute-tolerance` and `--morph-tolerance`: what is reached, and what is refused.

use std::path::PathBuf;

use serde_json::{Value, json};
use tempfile::TempDir;

use crate::common::{bytes, count, done, file, folder, list, number, refuses, run};
use crate::glb::{Builder, Glb, distances, limit};

/// A flat square of 5 × 5 vertices whose texture is as wrinkled as can be, and a number for each vertex.
fn wrinkled(folder: &TempDir) -> PathBuf {
    let mut text =
        "ply\nformat ascii 1.0\nelement vertex 25\nproperty float x\nproperty float y\nproperty float z\n\
        property float s\nproperty float t\nproperty float heat\nproperty int part\nelement face 32\n\
        property list uchar int vertex_indices\nend_header\n"
            .to_owned();
    for (i, j) in (0..5).flat_map(|j| (0..5).map(move |i| (i, j))) {
        let (s, t) = (
            f64::from((7 * i + 3 * j) % 5) / 5.0,
            f64::from((2 * i + 5 * j) % 7) / 7.0,
        );
        text += &format!("{i} {j} 0 {s} {t} {} 3\n", (i * j) % 3);
    }
    for (i, j) in (0..4).flat_map(|j| (0..4).map(move |i| (i, j))) {
        let a = 5 * j + i;
        text += &format!("3 {a} {} {}\n3 {a} {} {}\n", a + 1, a + 6, a + 6, a + 5);
    }
    file(folder, "wrinkled.ply", &text)
}

fn report(folder: &TempDir) -> Value {
    let text = bytes(folder.path().join("report.json"));
    serde_json::from_slice(&text).expect("JSON")
}

#[test]
fn texture_coordinates_are_within_their_tolerance() {
    let folder = folder();
    let (input, output) = (wrinkled(&folder), folder.path().join("out.ply"));
    let json = folder.path().join("report.json");
    let mut triangles = Vec::new();
    for tolerance in ["0.02", "10.24@1k", "0.005"] {
        done(
            &format!("refine {{}} -o {{}} --report {{}} --attribute-tolerance uv={tolerance}"),
            &[&input, &output, &json],
        )
        .saying("s,t: within ");
        let report = report(&folder);
        let [goal] = list(&report["attributes"]) else {
            panic!("{report:#}")
        };
        assert_eq!(goal["name"], "s,t");
        let (asked, upper) = (number(&goal["tolerance"]), goal["upper"].as_f64());
        assert!(
            upper.is_some_and(|upper| upper > 0.1 * asked && upper <= asked),
            "{goal}"
        );
        triangles.push(count(&report["output"]["triangles"]));
    }
    // The square is flat: all of this is for the texture's sake.
    above!(triangles[0], 4 * 32);
    above!(2 * triangles[2], 3 * triangles[1]);
    assert!(triangles[1] >= triangles[0]);
    done(
        "refine {} -o {} --channel uv=linear --attribute-tolerance uv=1e-6",
        &[&input, &output],
    )
    .saying("s,t: exact, being linear on each face");
    done(
        "refine {} -o {} --channel heat=smooth --attribute-tolerance heat=0.01",
        &[&input, &output],
    )
    .saying("heat: within ");
    // The goal that was missed is reported, and what was reached.
    run(
        "refine {} -o {} --attribute-tolerance uv=1e-4 --max-triangles 2000 --report {}",
        &[&input, &output, &json],
    )
    .expect(3)
    .saying("was reached before the channels' tolerances");
    assert!(number(&report(&folder)["attributes"][0]["upper"]) > 1e-4);
    // As far as there is room: not a coarse mesh because a fine one is too much.
    assert!(count(&report(&folder)["output"]["triangles"]) > 500);
    done(
        "refine {} --dry-run -o {} --attribute-tolerance uv=0.005",
        &[&input, &output],
    );
}

#[test]
fn tolerances_that_nothing_can_meet_are_refused() {
    let folder = folder();
    let (input, output) = (wrinkled(&folder), folder.path().join("out.ply"));
    let stl = folder.path().join("out.stl");
    refuses(
        &[("input", &input), ("stl", &stl), ("output", &output)],
        "
        2 | refine {input} -o {output} --attribute-tolerance uv=0.01 --optimize | --attribute-tolerance divides until it is met
        2 | refine {input} -o {output} --attribute-tolerance uv=0.01 --triangles 500 | that does not go with --triangles
        2 | refine {input} -o {output} --attribute-tolerance s,t=0.01 --balance | --attribute-tolerance divides until it is met
        2 | refine {input} -o {output} --attribute-tolerance uv=0.01 --method uniform | --attribute-tolerance
        2 | refine {input} -o {output} --attribute-tolerance cold=1 | has no channel 'cold'; those that come out are: s,t; heat; part
        2 | refine {input} -o {output} --attribute-tolerance part=1 | 'part' is inherited
        2 | refine {input} -o {output} --attribute-tolerance uv=0.01 --channel s,t=drop | has no channel 'uv'; those that come out are
        2 | refine {input} -o {output} --morph-tolerance 1% | --morph-tolerance is for glTF assets
        2 | refine {input} -o {stl} --attribute-tolerance uv=0.01 | none comes out
        2 | refine {input} -o {output} --attribute-tolerance uv=1@0 |",
    );
}

/// A flat square, and a target that makes a wave of it.
fn wave(folder: &TempDir) -> PathBuf {
    let points: Vec<[f32; 3]> = (0..25)
        .map(|v| [(v % 5) as f32, (v / 5) as f32, 0.0])
        .collect();
    let mut triangles = Vec::new();
    for v in (0..20u32).filter(|v| v % 5 < 4) {
        triangles.extend([[v, v + 1, v + 6], [v, v + 6, v + 5]]);
    }
    let mut builder = Builder::new();
    let (position, indices) = (builder.points(&points), builder.indices(&triangles));
    let up = builder.points(
        &points
            .iter()
            .map(|p| [0.0, 0.0, added(*p)])
            .collect::<Vec<_>>(),
    );
    let texture = builder.floats(
        &points
            .iter()
            .flat_map(|p| [p[0] / 4.0, p[1] / 4.0])
            .collect::<Vec<_>>(),
        2,
    );
    builder.primitive(
        json!({"attributes": {"POSITION": position, "TEXCOORD_0": texture}, "indices": indices,
        "targets": [{"POSITION": up}]}),
    );
    let input = folder.path().join("wave.glb");
    builder.write(&input);
    input
}

fn added([x, y, _]: [f32; 3]) -> f32 {
    if (x + y) % 2.0 == 0.0 { 0.8 } else { -0.8 }
}

#[test]
fn morph_targets_are_within_the_tolerance_unless_something_else_is_said() {
    let folder = folder();
    let (input, output) = (wave(&folder), folder.path().join("out.glb"));
    let before = Glb::read(&input);
    let control = before.points(&before.primitive(0)["attributes"]["POSITION"]);
    let moved: Vec<[f64; 3]> = control
        .iter()
        .map(|p| [p[0], p[1], f64::from(added(p.map(|x| x as f32)))])
        .collect();
    let reference = limit(&moved, &before.triangles(0), 2e-5);
    let apart = |options: &str| {
        let line = format!("refine {{}} -o {{}} {options}");
        done(&line, &[&input, &output]);
        let glb = Glb::read(&output);
        let primitive = glb.primitive(0);
        let base = glb.points(&primitive["attributes"]["POSITION"]);
        let added = glb.points(&primitive["targets"][0]["POSITION"]);
        let posed: Vec<[f64; 3]> = base
            .iter()
            .zip(added)
            .map(|(p, d)| [0, 1, 2].map(|i| p[i] + d[i]))
            .collect();
        let triangles = glb.triangles(0);
        let surface = limitmesh::Triangles {
            positions: &posed,
            triangles: &triangles,
        };
        let [from, to] = distances(surface, reference.as_triangles());
        (from.max(to), triangles.len())
    };
    // The diagonal of the square is 4 √2; the reference is 2e-5 of the wave's off.
    let diagonal = 32f64.sqrt();
    let (usual, _) = apart("--tolerance 0.5%");
    assert!(usual < (0.005 + 3e-5) * diagonal, "{usual}");
    let (finer, more) = apart("--tolerance 0.5% --morph-tolerance 0.1%");
    below!(finer, (0.001 + 3e-5) * diagonal);
    below!(finer, usual);
    let (flat, least) = apart("--tolerance 0.5% --morph-tolerance none");
    above!(flat, 0.006 * diagonal);
    below!(4 * least, more);
}

//! Real and defective files: each runs through `info`, `refine` and `measure` with the outcome written below.
//!
//! Reads the folder that the variable `LIMITMESH_MODELS` names, and passes over the test without it. A file in the
//! folder that the table does not know fails the test, so that no file goes without an expectation.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crate::common::{claimed, count, counts, folder, json_of, list, names, number, run, soup};
use serde_json::Value;

/// By file: faces as stored; vertices, triangles, Euler characteristic, boundary loops and components of the control mesh, `cut` where
/// sheets are cut apart, which may split faces adjacent to the cut; findings that are not zero, `any` where their number depends on
/// which of several equal repairs is made. Of files that cannot be read, words of the message.
///
/// From the models' own table, which was computed by other programs, and by hand for the defective files.
const EXPECTED: &str = "\
beetle.obj 2053 cut non_manifold_edges=47
bob_cage.obj 334 334,668,0,0,1 polygons=334 twisted_polygons=2
boot_684.off 684 344,684,2,0,1
bunny_1k.off 1000 502,1000,2,0,1
bunny_3674.obj 3674 1839,3674,2,0,1
cup_standin.obj 720 360,720,0,0,1
cusp_standin.obj 480 242,480,2,0,1
defects/deg_faces.obj 4 5,3,1,1,1 collapsed_faces=1 isolated_vertices=1
defects/extra_vertex.obj 3 9,3,3,3,3 isolated_vertices=1
defects/fan3.obj 3 9,3,3,3,3 non_manifold_edges=1
defects/hourglass_ico.obj 40 24,40,4,0,2 bow_tie_vertices=1
defects/inf_nan.obj unreadable line_1 vertex_0 inf finite
defects/mannequin_flipped.off 839 428,839,1,1,1 flipped_faces=any
defects/moebius.obj 224 cut polygons=224 flipped_faces=any non_orientable_faces=any
defects/sphere_truncated.ply unreadable byte_4411 face_174 end_of_the_file
defects/spider_ascii.stl 1368 722,1312,30,6,18 welded_vertices=3382 collapsed_faces=56 flipped_faces=any
defects/triple_vierbein.obj 108 cut non_manifold_edges=20 flipped_faces=any
duck.glb 4212 2108,4212,2,0,1
featuretype.stl 3476 2010,3476,-16,16,1 welded_vertices=8418
fish_cage.obj 112 112,220,2,0,1 polygons=104 twisted_polygons=4
gcanyon_530k.ply 530450 266256,530450,1,1,1
goathead_be.ply 5522 2763,5522,2,0,1
loop_icos_semisharp.obj 80 48,80,8,0,4
loop_pole64.obj 192 129,192,1,1,1
loop_saddle_edgecorner.obj 4 6,4,1,1,1
mannequin.off 839 428,839,1,1,1
mannequin_142.off 142 79,142,1,1,1
mechpart_creased.obj 238 115,238,-4,0,1
monsterfrog.obj 2584 1308,2584,16,0,9
plane_holes.obj 16747 8519,16747,-25,27,1
radish_standin.obj 640 322,640,2,0,1
rgb_cube.gltf 12 8,12,2,0,1
rook_creased.obj 1510 768,1510,1,1,1
skull_low.obj 10312 5154,10312,-2,0,1
sphere_320.ply 320 162,320,2,0,1
sphere_360.obj 360 182,360,2,0,1
teapot.obj 6320 cut welded_vertices=403 bow_tie_vertices=any
teddy.obj 3192 1598,3192,2,0,1";

/// Above so many faces, one level is enough to see the file through.
const LARGE: u64 = 10_000;

/// Files of the folder and its `defects`, documents aside.
fn files(models: &Path) -> BTreeSet<String> {
    let inside = |prefix: &str| {
        let names = names(&models.join(prefix)).into_iter();
        names
            .map(|name| format!("{prefix}{name}"))
            .collect::<Vec<_>>()
    };
    let all = [inside(""), inside("defects/")].concat().into_iter();
    all.filter(|name| models.join(name).is_file() && !name.ends_with(".md"))
        .collect()
}

#[test]
fn every_file_has_the_outcome_expected_of_it() {
    let Some(models) = std::env::var_os("LIMITMESH_MODELS") else {
        return;
    };
    let models = Path::new(&models);
    let rows = EXPECTED
        .lines()
        .map(|line| line.split(' ').collect::<Vec<_>>());
    let rows: Vec<Vec<&str>> = rows.collect();
    let listed: BTreeSet<String> = rows.iter().map(|row| row[0].to_owned()).collect();
    assert_eq!(
        files(models),
        listed,
        "the table knows every file, and every file is there"
    );
    for row in rows {
        let (name, path) = (row[0], models.join(row[0]));
        match row[1].parse() {
            Ok(faces) => {
                let info = examines(name, &path, faces, row[2], &row[3..]);
                refines(name, &path, faces, &info);
            }
            Err(_) => refuses(name, &path, &row[2..]),
        }
    }
}

/// Every command ends with code 1, the words, and no file.
fn refuses(name: &str, path: &Path, words: &[&str]) {
    let folder = folder();
    let output = folder.path().join("out.ply");
    for command in ["info {}", "refine {} -o {}", "measure {} builtin:cube"] {
        let mut run = run(command, &[path, &output]).expect(1);
        assert_eq!(run.stdout, "", "{name}");
        for word in words {
            run = run.saying(&word.replace('_', " "));
        }
    }
    assert_eq!(names(folder.path()), [""; 0], "{name}");
}

/// `info` finds what is expected; gives its report.
fn examines(name: &str, path: &Path, faces: u64, shape: &str, findings: &[&str]) -> Value {
    let info = json_of("info {} --json", &[path]);
    assert_eq!(info["input"]["faces"].as_u64(), Some(faces), "{name}");
    let keys = [
        "vertices",
        "triangles",
        "euler_characteristic",
        "boundary_loops",
        "components",
    ];
    let found = keys.map(|key| info["mesh"][key].to_string()).join(",");
    assert!(shape == "cut" || found == shape, "{name}: {found}");
    let findings = findings
        .iter()
        .filter_map(|finding| finding.split_once('='));
    let findings: BTreeMap<&str, &str> = findings.collect();
    let diagnosis = info["diagnosis"].as_object().expect("an object");
    for (key, value) in diagnosis.iter().filter(|(key, _)| *key != "clean") {
        let count = value["count"].to_string();
        match findings.get(key.as_str()) {
            Some(&"any") => assert_ne!(count, "0", "{name}: {key}"),
            expected => assert_eq!(&count, expected.unwrap_or(&"0"), "{name}: {key}"),
        }
        let first = list(&value["first"]);
        assert_eq!(first.is_empty(), count == "0", "{name}: {key}");
    }
    info
}

/// `refine` writes a mesh of the control mesh's topology without gaps, and `measure` finds it near its limit surface.
fn refines(name: &str, path: &Path, faces: u64, info: &Value) {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let levels = if faces > LARGE { 1 } else { 2 };
    let control = &info["mesh"];
    let own = |key: &str| count(&control[key]);
    for method in ["limit-normal", "uniform"] {
        let command = format!(
            "refine {{}} -o {{}} --method {method} --levels {levels} --scheme loop --report -"
        );
        let report = json_of(&command, &[path, &output]);
        let (result, written) = (&report["output"], counts(&soup(&output)));
        assert_eq!(written, claimed(result), "{name} {method}");
        assert_eq!(written.non_manifold_edges, 0, "{name} {method}");
        for key in ["euler_characteristic", "components", "watertight"] {
            assert_eq!(result[key], control[key], "{name} {method}");
        }
        if method == "uniform" {
            assert_eq!(
                written.triangles,
                own("triangles") << (2 * levels),
                "{name}"
            );
            assert_eq!(
                written.boundary_edges,
                own("boundary_edges") << levels,
                "{name}"
            );
        }
    }
    let command = format!(
        "measure {{}} --limit-of {{}} --reference-levels {levels} --samples 2000 --scheme loop --json"
    );
    let report = json_of(&command, &[&output, path]);
    let percent = number(&report["hausdorff"]["symmetric_percent"]);
    assert!((0.0..25.0).contains(&percent), "{name}: {percent} %");
    bounds_distances(name, &output, path);
}

/// The certified distance of two meshes is found, and what sampling finds lies within it.
fn bounds_distances(name: &str, a: &Path, b: &Path) {
    let distance = |options: &str| {
        let command = format!("measure {{}} {{}} --json {options}");
        json_of(&command, &[a, b])["hausdorff"].clone()
    };
    let (certified, sampled) = (distance("--certified"), distance("--samples 20000"));
    let least = 1e-6 * number(&certified["diagonal"]);
    for direction in ["forward", "backward"] {
        let [lower, upper] = ["lower", "upper"].map(|end| number(&certified[direction][end]));
        let found = number(&sampled[direction]);
        at_most!(found, upper * (1.0 + 1e-12), "{name} {direction}");
        let is_narrow = upper - lower <= least.max(0.01 * lower);
        assert!(is_narrow, "{name} {direction}: {lower} to {upper}");
    }
}

//! `lod`: levels of detail as files and in one document.

use limitmesh::refine::{LimitDistanceOptions, limit_distance};
use limitmesh::scheme::Loop;
use limitmesh::{Mesh, Triangles};
use limitmesh_io::read;

use crate::common::{folder, has_keys, run};

fn control(name: &str) -> Mesh {
    let soup = limitmesh_models::find(name).expect("a model").soup();
    Mesh::from_soup(&soup, &Default::default()).expect("a mesh").0
}

/// Distances by another search, and each level's first vertices are the coarser level's.
#[test]
fn files_are_within_their_tolerances_and_nested() {
    let folder = folder();
    let (out, report) = (folder.path().join("torus.ply"), folder.path().join("torus.json"));
    let done = run("lod builtin:torus -o {} --tolerances 2%,0.5% --report {}", &[&out, &report]).expect(0);
    assert!(done.stdout.contains("LOD1") || done.stderr.contains("LOD1"), "{}{}", done.stdout, done.stderr);
    let report: serde_json::Value =
        serde_json::from_slice(&std::fs::read(&report).expect("a report")).expect("JSON");
    let levels = report["levels"].as_array().expect("a list");
    assert_eq!(levels.len(), 2);
    let control = control("torus");
    let mut distances = Vec::new();
    for (lod, (level, percent)) in levels.iter().zip([0.5, 2.0]).enumerate() {
        has_keys(level, "lod path vertices triangles tolerance lower upper parametric switching_distance");
        let soup = read(&folder.path().join(format!("torus_LOD{lod}.ply"))).expect("a mesh");
        let mesh = Mesh::from_soup(&soup, &Default::default()).expect("a mesh").0;
        assert_eq!(mesh.face_count() as u64, level["triangles"].as_u64().expect("a number"));
        assert_eq!(mesh.topology().boundary_edge_count(), 0);
        let options = LimitDistanceOptions::default().gap(Some(1e-4 * control.diagonal()));
        let found = limit_distance(mesh.as_triangles(), &control, &Loop, &options).expect("a distance");
        assert!(found.distance.upper() <= (0.01 * percent + 2e-4) * control.diagonal());
        distances.push(level["switching_distance"].as_f64().expect("a number"));
    }
    assert!(distances[0] < distances[1], "{distances:?}");
    let count = |lod: usize| levels[lod]["triangles"].as_u64().expect("a number");
    assert!(count(0) > count(1));
}

/// At their beginning vertices are on the coarser mesh.
#[test]
fn morphs_begin_on_the_coarser_level() {
    let folder = folder();
    let out = folder.path().join("cup.ply");
    run("lod builtin:cup -o {} --levels 2 --tolerance 0.5% --morph", &[&out]).expect(0);
    let [fine, coarse] =
        [0, 1].map(|lod| read(&folder.path().join(format!("cup_LOD{lod}.ply"))).expect("a mesh"));
    let axis = |name: &str| fine.channels.iter().find(|channel| channel.name == name).expect("a property");
    let axes = ["coarse_x", "coarse_y", "coarse_z"].map(axis);
    let places: Vec<[f64; 3]> =
        (0..fine.positions.len()).map(|vertex| axes.map(|axis| axis.value(vertex)[0])).collect();
    let triangles: Vec<[u32; 3]> = coarse.faces.iter().map(|face| [face[0], face[1], face[2]]).collect();
    let surface = Triangles { positions: &coarse.positions, triangles: &triangles };
    let tree = limitmesh::measure::Bvh::new(surface).expect("triangles");
    let farthest = places.iter().map(|&place| tree.closest(place).distance).fold(0.0, f64::max);
    assert!(farthest < 1e-6, "{farthest}");
    assert!(places.iter().zip(&fine.positions).any(|(a, b)| a != b));
}

#[test]
fn one_document_has_all_levels() {
    let folder = folder();
    let out = folder.path().join("cup.gltf");
    run("lod builtin:cup -o {} --levels 3 --tolerance 0.1% --morph", &[&out]).expect(0);
    let text = std::fs::read_to_string(&out).expect("a document");
    let document: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(document["meshes"].as_array().expect("meshes").len(), 3);
    assert!(document["extensionsUsed"].as_array().is_some_and(|used| used.contains(&"MSFT_lod".into())));
    let nodes = document["nodes"].as_array().expect("nodes");
    let shown = document["scenes"][0]["nodes"].as_array().expect("a scene");
    assert_eq!(shown.len(), 1);
    let finest = &nodes[shown[0].as_u64().expect("a number") as usize];
    assert_eq!(finest["extensions"]["MSFT_lod"]["ids"].as_array().expect("ids").len(), 2);
    let coverage = finest["extras"]["MSFT_screencoverage"].as_array().expect("coverage");
    let coverage: Vec<f64> = coverage.iter().map(|x| x.as_f64().expect("a number")).collect();
    assert!(coverage.len() == 3 && coverage.windows(2).all(|pair| pair[0] > pair[1]), "{coverage:?}");
    let targets = |mesh: usize| &document["meshes"][mesh]["primitives"][0]["targets"];
    assert_eq!((0..3).filter(|&mesh| targets(mesh).is_array()).count(), 2);
}

#[test]
fn what_cannot_be_is_told() {
    let folder = folder();
    let out = folder.path().join("cup.obj");
    run("lod builtin:cup -o {} --tolerances 1%,2%", &[&out]).expect(2);
    run("lod builtin:cup -o {} --levels 0", &[&out]).expect(2);
    run("lod builtin:none -o {}", &[&out]).expect(1).saying("none");
}

/// Levels that would be as coarse as the control mesh allows are told and left out, and whoever goes away meets levels in order.
#[test]
fn distances_grow_from_level_to_level() {
    for words in [
        "builtin:cup -o {}",
        "builtin:cup -o {} --tolerances 20%,10%,1%,0.5%,0.1% --morph",
        "builtin:head -o {} --levels 5",
    ] {
        let folder = folder();
        let output = folder.path().join("out.glb");
        let found = run(&format!("lod {words} --report -"), &[&output]).expect(0);
        let report = found.json();
        let levels = report["levels"].as_array().expect("a list");
        let numbers = |key: &str| -> Vec<f64> {
            levels.iter().map(|level| level[key].as_f64().expect("a number")).collect()
        };
        let (triangles, distances, coverage) =
            (numbers("triangles"), numbers("switching_distance"), numbers("least_coverage"));
        assert!(triangles.windows(2).all(|pair| pair[0] > pair[1]), "{words}: {triangles:?}");
        assert!(distances.windows(2).all(|pair| pair[0] < pair[1]), "{words}: {distances:?}");
        assert!(coverage.windows(2).all(|pair| pair[0] > pair[1]), "{words}: {coverage:?}");
        for level in levels.iter().filter(|level| !level["morph"].is_null()) {
            assert!(
                level["morph"]["from_distance"].as_f64() < level["morph"]["to_distance"].as_f64(),
                "{level}"
            );
        }
    }
    let folder = folder();
    run("lod builtin:cup -o {} --tolerances 20%,10%,1%", &[&folder.path().join("out.glb")])
        .expect(0)
        .saying("left out: the next finer one");
}

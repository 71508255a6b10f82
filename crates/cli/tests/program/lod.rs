//! `lod`: levels of detail as files and in one document.

use std::collections::BTreeSet;

use limitmesh::refine::{LimitDistanceOptions, limit_distance};
use limitmesh::scheme::Loop;
use limitmesh::{Mesh, Triangles};
use limitmesh_io::read;

use crate::common::{
    count, done, file, folder, json_file, list, names, number, refuses, run, text, usage_error,
};

fn control(name: &str) -> Mesh {
    let soup = limitmesh_models::find(name).expect("a model").soup();
    Mesh::from_soup(&soup, &Default::default())
        .expect("a mesh")
        .0
}

/// Distances by another search, and each level's first vertices are the coarser level's.
#[test]
fn files_are_within_their_tolerances_and_nested() {
    let folder = folder();
    let (out, report) = (
        folder.path().join("torus.ply"),
        folder.path().join("torus.json"),
    );
    done(
        "lod builtin:torus -o {} --tolerances 2%,0.5% --report {}",
        &[&out, &report],
    )
    .saying("LOD1");
    let report = json_file(&report);
    let levels = list(&report["levels"]);
    assert_eq!(levels.len(), 2);
    let control = control("torus");
    let (mut distances, mut vertices) = (Vec::new(), Vec::new());
    for (lod, (level, percent)) in levels.iter().zip([0.5, 2.0]).enumerate() {
        let soup = read(folder.path().join(format!("torus_LOD{lod}.ply"))).expect("a mesh");
        let mesh = Mesh::from_soup(&soup, &Default::default())
            .expect("a mesh")
            .0;
        assert_eq!(mesh.face_count() as u64, count(&level["triangles"]));
        assert_eq!(mesh.topology().boundary_edge_count(), 0);
        let options = LimitDistanceOptions::default().gap(Some(1e-4 * control.diagonal()));
        let found =
            limit_distance(mesh.as_triangles(), &control, &Loop, &options).expect("a distance");
        assert!(found.distance.upper() <= (0.01 * percent + 2e-4) * control.diagonal());
        distances.push(number(&level["switching_distance"]));
        vertices.push(
            soup.positions
                .iter()
                .map(|p| p.map(f64::to_bits))
                .collect::<BTreeSet<_>>(),
        );
    }
    assert!(
        vertices[0].is_superset(&vertices[1]),
        "vertices of the coarser level are the finer one's"
    );
    assert!(distances[0] < distances[1], "{distances:?}");
    let count = |lod: usize| count(&levels[lod]["triangles"]);
    assert!(count(0) > count(1));
}

/// At their beginning vertices are on the coarser mesh.
#[test]
fn morphs_begin_on_the_coarser_level() {
    let folder = folder();
    let out = folder.path().join("cup.ply");
    done(
        "lod builtin:cup -o {} --levels 2 --tolerance 0.5% --morph",
        &[&out],
    );
    let [fine, coarse] =
        [0, 1].map(|lod| read(folder.path().join(format!("cup_LOD{lod}.ply"))).expect("a mesh"));
    let axis = |name: &str| {
        fine.channels
            .iter()
            .find(|channel| channel.name == name)
            .expect("a property")
    };
    let axes = ["coarse_x", "coarse_y", "coarse_z"].map(axis);
    let places: Vec<[f64; 3]> = (0..fine.positions.len())
        .map(|vertex| axes.map(|axis| axis.value(vertex)[0]))
        .collect();
    let triangles: Vec<[u32; 3]> = coarse
        .faces
        .iter()
        .map(|face| [face[0], face[1], face[2]])
        .collect();
    let surface = Triangles {
        positions: &coarse.positions,
        triangles: &triangles,
    };
    let tree = limitmesh::measure::Bvh::new(surface).expect("triangles");
    let farthest = places
        .iter()
        .map(|&place| tree.closest(place).distance)
        .fold(0.0, f64::max);
    assert!(farthest < 1e-6, "{farthest}");
    assert!(places.iter().zip(&fine.positions).any(|(a, b)| a != b));
}

#[test]
fn one_document_has_all_levels() {
    let folder = folder();
    let out = folder.path().join("cup.gltf");
    done(
        "lod builtin:cup -o {} --levels 3 --tolerance 0.1% --morph",
        &[&out],
    );
    let text = text(&out);
    let document: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(list(&document["meshes"]).len(), 3);
    assert!(
        document["extensionsUsed"]
            .as_array()
            .is_some_and(|used| used.contains(&"MSFT_lod".into()))
    );
    let nodes = list(&document["nodes"]);
    let shown = list(&document["scenes"][0]["nodes"]);
    assert_eq!(shown.len(), 1);
    let finest = &nodes[count(&shown[0]) as usize];
    assert_eq!(list(&finest["extensions"]["MSFT_lod"]["ids"]).len(), 2);
    let coverage = list(&finest["extras"]["MSFT_screencoverage"]);
    let coverage: Vec<f64> = coverage.iter().map(|x| number(x)).collect();
    assert_eq!(coverage.len(), 3);
    assert!(coverage.windows(2).all(|pair| pair[0] > pair[1]));
    let targets = |mesh: usize| &document["meshes"][mesh]["primitives"][0]["targets"];
    assert_eq!((0..3).filter(|&mesh| targets(mesh).is_array()).count(), 2);
}

#[test]
fn what_cannot_be_is_told() {
    let folder = folder();
    let out = folder.path().join("cup.obj");
    refuses(
        &[("out", &out)],
        "
        2 | lod builtin:sphere -o {out} --tolerances 3,1,2 | number 3 is 2 in the mesh's unit, after 1
        2 | lod builtin:cup -o - | not to standard output
        2 | lod builtin:cup -o {out} --levels 0 |
        1 | lod builtin:none -o {out} | none",
    );
    let stl = folder.path().join("cup.stl");
    usage_error("lod builtin:cup -o {} --morph", &[&stl], "cup.stl")
        .saying("STL files have no place");
}

#[test]
fn a_cap_that_ends_the_levels_is_named() {
    let folder = folder();
    let out = folder.path().join("out.glb");
    run(
        "lod builtin:sphere -o {} --tolerances 5%,1%,0.1% --max-triangles 1000",
        &[&out],
    )
    .expect(3)
    .saying("--max-triangles 1,000 was reached before level 3 of 3");
}

/// A square with a texture and two materials that a library describes.
const PAINTED: &str = "mtllib paint.mtl\nv 0 0 0\nv 4 0 0\nv 4 3 1\nv 0 3 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl red\n\
    f 1/1 2/2 3/3\nusemtl blue\nf 1/1 3/3 4/4\n";

/// Before any work, and of the files that are written, not of the name that they are called after.
#[test]
fn files_in_the_way_and_options_without_effect_are_refused() {
    let folder = folder();
    let input = file(&folder, "rock_LOD0.obj", PAINTED);
    let rock = folder.path().join("rock.obj");
    usage_error(
        "lod {} -o {}",
        &[&input, &rock],
        "rock_LOD0.obj is an input",
    );
    assert_eq!(text(&input), PAINTED);
    usage_error(
        "lod {} -o {} --report {}",
        &[&input, &folder.path().join("a.glb"), &input],
        "rock_LOD0.obj is an input",
    );
    let own = folder.path().join("a_LOD1.obj");
    usage_error(
        "lod {} -o {} --report {}",
        &[&input, &folder.path().join("a.obj"), &own],
        "a_LOD1.obj would be written twice",
    );
    std::fs::create_dir(folder.path().join("b_LOD3.obj")).expect("a folder");
    run("lod {} -o {}", &[&input, &folder.path().join("b.obj")])
        .expect(1)
        .saying("it is a folder");
    let nowhere = folder.path().join("none/report.json");
    run(
        "lod {} -o {} --report {}",
        &[&input, &folder.path().join("c.obj"), &nowhere],
    )
    .expect(1)
    .saying("no folder");
    for (option, value) in [
        ("--attribute-tolerance", "uv=0.1"),
        ("--attribute-tolerance", "heat=1"),
    ] {
        usage_error(
            &format!("lod {{}} -o {{}} {option} {value}"),
            &[&input, &folder.path().join("d.obj")],
            &format!("{option} is for `refine`"),
        );
    }
    assert_eq!(
        names(folder.path()),
        ["b_LOD3.obj", "rock_LOD0.obj"],
        "nothing is written"
    );
}

//! Real and defective files: each runs through `info`, `refine` and `measure` with the outcome written below.
//!
//! Reads the folder that the variable `LIMITMESH_MODELS` names, and passes over the test without it. A file in the
//! folder that the table does not know fails the test, so that no file goes without an expectation.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::common::{claimed, counts, folder, names, run, soup};
use serde_json::Value;

/// What is expected of a file.
enum Expected {
    /// It becomes this control mesh.
    Mesh {
        /// Faces as stored.
        faces: u64,
        /// Triangles, vertices and boundary loops, components and Euler characteristic of the control mesh; `None`
        /// where sheets are cut, which may split faces beside the cut.
        shape: Option<Shape>,
        /// Findings that are not zero.
        findings: &'static [(&'static str, u64)],
    },
    /// It cannot be read; the message has these words.
    Unreadable(&'static [&'static str]),
}

/// Vertices, triangles, Euler characteristic, boundary loops, components.
type Shape = [i64; 5];

use Expected::{Mesh, Unreadable};

const fn clean(faces: u64, shape: Shape) -> Expected {
    Mesh {
        faces,
        shape: Some(shape),
        findings: &[],
    }
}

const fn found(faces: u64, shape: Shape, findings: &'static [(&'static str, u64)]) -> Expected {
    Mesh {
        faces,
        shape: Some(shape),
        findings,
    }
}

const fn cut(faces: u64, findings: &'static [(&'static str, u64)]) -> Expected {
    Mesh {
        faces,
        shape: None,
        findings,
    }
}

/// From the models' own table, which was computed by other programs, and by hand for the defective files.
const EXPECTED: &[(&str, Expected)] = &[
    ("beetle.obj", cut(2053, &[("non_manifold_edges", 47)])),
    (
        "bob_cage.obj",
        found(
            334,
            [334, 668, 0, 0, 1],
            &[("polygons", 334), ("twisted_polygons", 2)],
        ),
    ),
    ("boot_684.off", clean(684, [344, 684, 2, 0, 1])),
    ("bunny_1k.off", clean(1000, [502, 1000, 2, 0, 1])),
    ("bunny_3674.obj", clean(3674, [1839, 3674, 2, 0, 1])),
    ("cup_standin.obj", clean(720, [360, 720, 0, 0, 1])),
    ("cusp_standin.obj", clean(480, [242, 480, 2, 0, 1])),
    // One face is removed because it repeats a vertex; the vertex that it alone used stays over, beside the one
    // that no face used.
    (
        "defects/deg_faces.obj",
        found(
            4,
            [5, 3, 1, 1, 1],
            &[("collapsed_faces", 1), ("isolated_vertices", 1)],
        ),
    ),
    (
        "defects/extra_vertex.obj",
        found(3, [9, 3, 3, 3, 3], &[("isolated_vertices", 1)]),
    ),
    // Three triangles on one edge: none of them continues another, so each becomes a sheet.
    (
        "defects/fan3.obj",
        found(3, [9, 3, 3, 3, 3], &[("non_manifold_edges", 1)]),
    ),
    (
        "defects/hourglass_ico.obj",
        found(40, [24, 40, 4, 0, 2], &[("bow_tie_vertices", 1)]),
    ),
    (
        "defects/inf_nan.obj",
        Unreadable(&["line 1", "vertex 0", "inf", "finite"]),
    ),
    (
        "defects/mannequin_flipped.off",
        Mesh {
            faces: 839,
            shape: Some([428, 839, 1, 1, 1]),
            findings: FLIPPED,
        },
    ),
    (
        "defects/moebius.obj",
        cut(
            224,
            &[
                ("polygons", 224),
                ("flipped_faces", ANY),
                ("non_orientable_faces", ANY),
            ],
        ),
    ),
    (
        "defects/sphere_truncated.ply",
        Unreadable(&["byte 4411", "face 174", "end of the file"]),
    ),
    // Of the 56 faces without three different corners, 36 repeat one another, which no longer matters.
    (
        "defects/spider_ascii.stl",
        found(
            1368,
            [722, 1312, 30, 6, 18],
            &[
                ("welded_vertices", 3382),
                ("collapsed_faces", 56),
                ("flipped_faces", ANY),
            ],
        ),
    ),
    (
        "defects/triple_vierbein.obj",
        cut(108, &[("non_manifold_edges", 20), ("flipped_faces", ANY)]),
    ),
    ("duck.glb", clean(4212, [2108, 4212, 2, 0, 1])),
    (
        "featuretype.stl",
        found(3476, [2010, 3476, -16, 16, 1], &[("welded_vertices", 8418)]),
    ),
    (
        "fish_cage.obj",
        found(
            112,
            [112, 220, 2, 0, 1],
            &[("polygons", 104), ("twisted_polygons", 4)],
        ),
    ),
    (
        "gcanyon_530k.ply",
        clean(530_450, [266_256, 530_450, 1, 1, 1]),
    ),
    ("goathead_be.ply", clean(5522, [2763, 5522, 2, 0, 1])),
    ("loop_icos_semisharp.obj", clean(80, [48, 80, 8, 0, 4])),
    ("loop_pole64.obj", clean(192, [129, 192, 1, 1, 1])),
    ("loop_saddle_edgecorner.obj", clean(4, [6, 4, 1, 1, 1])),
    ("mannequin.off", clean(839, [428, 839, 1, 1, 1])),
    ("mannequin_142.off", clean(142, [79, 142, 1, 1, 1])),
    ("mechpart_creased.obj", clean(238, [115, 238, -4, 0, 1])),
    ("monsterfrog.obj", clean(2584, [1308, 2584, 16, 0, 9])),
    ("plane_holes.obj", clean(16_747, [8519, 16_747, -25, 27, 1])),
    ("radish_standin.obj", clean(640, [322, 640, 2, 0, 1])),
    ("rgb_cube.gltf", clean(12, [8, 12, 2, 0, 1])),
    ("rook_creased.obj", clean(1510, [768, 1510, 1, 1, 1])),
    ("skull_low.obj", clean(10_312, [5154, 10_312, -2, 0, 1])),
    ("sphere_320.ply", clean(320, [162, 320, 2, 0, 1])),
    ("sphere_360.obj", clean(360, [182, 360, 2, 0, 1])),
    // 403 vertices repeat a position; one place where the lid meets itself at a point remains.
    (
        "teapot.obj",
        cut(6320, &[("welded_vertices", 403), ("bow_tie_vertices", ANY)]),
    ),
    ("teddy.obj", clean(3192, [1598, 3192, 2, 0, 1])),
];

/// A finding whose number depends on which of several equal repairs is made; it must not be zero.
const ANY: u64 = u64::MAX;

/// A fifth of the faces were reversed; an even cut between the two halves may turn either part.
const FLIPPED: &[(&str, u64)] = &[("flipped_faces", ANY)];

/// Above so many faces, one level is enough to see the file through.
const LARGE: u64 = 10_000;

fn models() -> Option<PathBuf> {
    let folder = std::env::var_os("LIMITMESH_MODELS").map(PathBuf::from);
    if folder.is_none() {
        // Written directly: the test harness keeps what macros print to itself.
        let _ = std::io::Write::write_all(
            &mut std::io::stderr(),
            b"skipped: LIMITMESH_MODELS does not name the folder with the shared models\n",
        );
    }
    folder
}

/// Files of the folder and its `defects`, documents aside.
fn files(models: &Path) -> BTreeSet<String> {
    let inside = |prefix: &str| {
        let names = names(&models.join(prefix));
        names
            .into_iter()
            .map(|name| format!("{prefix}{name}"))
            .collect::<Vec<_>>()
    };
    let all = [inside(""), inside("defects/")].concat();
    all.into_iter()
        .filter(|name| models.join(name).is_file() && !name.ends_with(".md"))
        .collect()
}

#[test]
fn every_file_has_the_outcome_expected_of_it() {
    let Some(models) = models() else { return };
    let listed: BTreeSet<String> = EXPECTED
        .iter()
        .map(|(name, _)| (*name).to_owned())
        .collect();
    assert_eq!(
        files(&models),
        listed,
        "the table knows every file, and every file is there"
    );
    for (name, expected) in EXPECTED {
        let path = models.join(name);
        match expected {
            Unreadable(words) => refuses(name, &path, words),
            Mesh {
                faces,
                shape,
                findings,
            } => {
                let info = examines(name, &path, *faces, *shape, findings);
                refines(name, &path, *faces, &info);
            }
        }
    }
}

/// Every command ends with code 1, the words, and no file.
fn refuses(name: &str, path: &Path, words: &[&str]) {
    let folder = folder();
    let output = folder.path().join("out.ply");
    for command in [
        "info {}",
        "refine {} -o {}",
        "measure {} builtin:cube",
        "measure builtin:cube {}",
    ] {
        let run = run(command, &[path, &output]).expect(1);
        assert_eq!(run.stdout, "", "{name}");
        for word in words {
            assert!(
                run.stderr.contains(word),
                "{name}: expected '{word}' in: {}",
                run.stderr
            );
        }
    }
    assert_eq!(names(folder.path()), [""; 0], "{name}");
}

/// `info` finds what is expected; gives its report.
fn examines(
    name: &str,
    path: &Path,
    faces: u64,
    shape: Option<Shape>,
    findings: &[(&str, u64)],
) -> Value {
    let info = run("info {} --json", &[path]).expect(0).json();
    assert_eq!(info["input"]["faces"].as_u64(), Some(faces), "{name}");
    let mesh = &info["mesh"];
    if let Some(shape) = shape {
        let keys = [
            "vertices",
            "triangles",
            "euler_characteristic",
            "boundary_loops",
            "components",
        ];
        let found = keys.map(|key| mesh[key].as_i64().expect("a number"));
        assert_eq!(found, shape, "{name}");
    } else {
        assert!(mesh["triangles"].as_u64() >= Some(faces), "{name}");
    }
    let diagnosis = info["diagnosis"].as_object().expect("an object");
    for (key, value) in diagnosis.iter().filter(|(key, _)| *key != "clean") {
        let count = value["count"].as_u64().expect("a count");
        let expected = findings
            .iter()
            .find(|(name, _)| name == key)
            .map_or(0, |&(_, count)| count);
        if expected == ANY {
            assert!(count > 0, "{name}: {key}");
        } else {
            assert_eq!(count, expected, "{name}: {key}");
        }
        let first = value["first"].as_array().expect("a list").len() as u64;
        assert!(
            first <= count && (first > 0) == (count > 0),
            "{name}: {key}"
        );
    }
    info
}

/// `refine` writes a mesh of the control mesh's topology without gaps, and `measure` finds it near its limit surface.
fn refines(name: &str, path: &Path, faces: u64, info: &Value) {
    let folder = folder();
    let output = folder.path().join("out.ply");
    let levels = if faces > LARGE { 1 } else { 2 };
    let control = &info["mesh"];
    run(
        "refine {} -o {} --method uniform --levels 0",
        &[path, &output],
    )
    .expect(0);
    let open_edges = open_edges(&output);
    for method in ["limit-normal", "uniform"] {
        let command = format!("refine {{}} -o {{}} --method {method} --levels {levels} --report -");
        let report = run(&command, &[path, &output]).expect(0).json();
        let result = &report["output"];
        let written = counts(&soup(&output));
        assert_eq!(written, claimed(result), "{name} {method}");
        assert!(
            Some(written.triangles) >= control["triangles"].as_u64(),
            "{name} {method}"
        );
        assert_eq!(written.non_manifold_edges, 0, "{name} {method}");
        assert_eq!(
            result["euler_characteristic"], control["euler_characteristic"],
            "{name} {method}"
        );
        assert_eq!(
            result["components"], control["components"],
            "{name} {method}"
        );
        assert_eq!(
            result["watertight"], control["watertight"],
            "{name} {method}"
        );
        if method == "uniform" {
            let quadrupled = control["triangles"].as_u64().map(|n| n * 4u64.pow(levels));
            assert_eq!(Some(written.triangles), quadrupled, "{name}");
            let doubled = control["boundary_edges"]
                .as_u64()
                .map(|n| n * 2u64.pow(levels));
            assert_eq!(Some(written.boundary_edges), doubled, "{name}");
            assert_eq!(
                self::open_edges(&output),
                open_edges << levels,
                "{name}: sheets stay together"
            );
        } else {
            let possible = open_edges..=open_edges << levels;
            assert!(
                possible.contains(&self::open_edges(&output)),
                "{name}: sheets stay together"
            );
        }
    }
    let command =
        format!("measure {{}} --limit-of {{}} --reference-levels {levels} --samples 2000 --json");
    let report = run(&command, &[&output, path]).expect(0).json();
    let percent = report["hausdorff"]["symmetric_percent"]
        .as_f64()
        .expect("a number");
    assert!((0.0..25.0).contains(&percent), "{name}: {percent} %");
    bounds_distances(name, &output, path);
}

/// The certified distance of two meshes is found, and what sampling finds lies within it.
fn bounds_distances(name: &str, a: &Path, b: &Path) {
    let certified = &run("measure {} {} --certified --json", &[a, b])
        .expect(0)
        .json()["hausdorff"];
    let sampled = &run("measure {} {} --samples 20000 --json", &[a, b])
        .expect(0)
        .json()["hausdorff"];
    let number = |value: &Value| value.as_f64().expect("a number");
    let least = 1e-6 * number(&certified["diagonal"]);
    for direction in ["forward", "backward"] {
        let (lower, upper) = (
            number(&certified[direction]["lower"]),
            number(&certified[direction]["upper"]),
        );
        let found = number(&sampled[direction]);
        assert!(
            found <= upper * (1.0 + 1e-12),
            "{name} {direction}: {found} above {upper}"
        );
        assert!(
            upper - lower <= least.max(0.01 * lower),
            "{name} {direction}: {lower} to {upper}"
        );
    }
}

/// Edges with one face once vertices at one place are one: where sheets that were cut came apart, there are more.
fn open_edges(path: &Path) -> u64 {
    let mut soup = soup(path);
    let mut first = std::collections::HashMap::<[u64; 3], u32>::new();
    let places: Vec<u32> = (0u32..)
        .zip(&soup.positions)
        .map(|(i, p)| *first.entry(p.map(|x| (x + 0.0).to_bits())).or_insert(i))
        .collect();
    let welded = soup
        .faces
        .iter()
        .map(|face| face.iter().map(|&v| places[v as usize]).collect::<Vec<_>>());
    let welded: Vec<Vec<u32>> = welded.collect();
    soup.faces = welded.iter().map(Vec::as_slice).collect();
    counts(&soup).boundary_edges
}

/// What files look like, the angle that is suggested, and the edges beyond it: those that have any.
const SHARP: &[(&str, &str, f64, u64)] = &[
    ("loop_saddle_edgecorner.obj", "part", 30.0, 2),
    ("mechpart_creased.obj", "part", 60.0, 117),
    ("rook_creased.obj", "part", 55.0, 400),
    ("featuretype.stl", "part", 30.0, 1_435),
    ("rgb_cube.gltf", "part", 30.0, 12),
    ("parts/L.stl", "part", 30.0, 18),
    ("parts/cyl16.stl", "part", 30.0, 32),
    ("parts/cyl32.stl", "part", 30.0, 64),
    ("parts/notch.stl", "part", 30.0, 108),
    ("parts/notch_fine.stl", "part", 30.0, 126),
    ("parts/plate.stl", "part", 30.0, 24),
    ("assets/AnimatedMorphCube.gltf", "part", 30.0, 12),
    ("assets/BoxDraco.gltf", "part", 30.0, 12),
    ("assets/BoxInterleaved.glb", "part", 30.0, 12),
    ("assets/BoxMeshopt.glb", "part", 30.0, 12),
    ("assets/BoxTextured.glb", "part", 30.0, 12),
    ("assets/BoxVertexColors.glb", "part", 30.0, 12),
    ("assets/DracoSparseMesh.gltf", "part", 55.0, 20),
    ("assets/MorphStressTest.gltf", "part", 30.0, 12),
    ("assets/ShapeCollection.glb", "part", 55.0, 108),
    ("assets/TwoCubes.glb", "part", 30.0, 24),
    ("assets/cubevc.glb", "part", 30.0, 24),
    ("assets/fuzz.glb", "part", 30.0, 12),
    ("assets/nested.glb", "part", 30.0, 36),
    ("assets/groups.obj", "part", 30.0, 52),
    ("assets/BoxTextured.ply", "part", 30.0, 12),
    ("assets/cube_blender_uv.ply", "cage", 30.0, 12),
    ("assets/cube_blender_uv_meshlab.ply", "part", 30.0, 12),
    ("assets/featuretype.3MF", "part", 30.0, 1_106),
    ("assets/pyramids.3mf", "part", 30.0, 1_721),
];

/// Files where no edges stand out: shapes that are smooth all over, or flat.
const SMOOTH: &[&str] = &[
    "beetle.obj",
    "bob_cage.obj",
    "bunny_3674.obj",
    "cup_standin.obj",
    "cusp_standin.obj",
    "fish_cage.obj",
    "loop_pole64.obj",
    "monsterfrog.obj",
    "plane_holes.obj",
    "radish_standin.obj",
    "skull_low.obj",
    "sphere_360.obj",
    "teapot.obj",
    "teddy.obj",
    "boot_684.off",
    "bunny_1k.off",
    "mannequin.off",
    "mannequin_142.off",
    "gcanyon_530k.ply",
    "goathead_be.ply",
    "sphere_320.ply",
    "duck.glb",
    "defects/deg_faces.obj",
    "defects/extra_vertex.obj",
    "defects/fan3.obj",
    "defects/mannequin_flipped.off",
    "defects/moebius.obj",
    "defects/spider_ascii.stl",
    "defects/triple_vierbein.obj",
    "assets/FeatureIdAttribute.gltf",
    "assets/MultipleFeatureIdsAndProperties.gltf",
    "assets/TextureTransformTest.gltf",
    "assets/monkey.glb",
    "assets/pirate.glb",
    "assets/quad_skin.glb",
    "assets/simple_skin.gltf",
    "assets/texcoord_crash.gltf",
    "assets/capsule.obj",
    "assets/fuze.obj",
    "assets/ico4uv.obj",
];

/// Coarse cages, sharp everywhere.
const CAGES: &[&str] = &["loop_icos_semisharp.obj", "defects/hourglass_ico.obj"];

/// The confusion table: what is to be a part by what it is, and what is found.
#[test]
fn parts_and_nothing_else_look_like_parts() {
    let Some(models) = models() else { return };
    let sharp = SHARP
        .iter()
        .map(|&(name, look, angle, edges)| (name, look, Some(angle), edges));
    let smooth = SMOOTH.iter().map(|&name| (name, "smooth", None, 0));
    let cages = CAGES.iter().map(|&name| (name, "cage", None, 0));
    let known: Vec<_> = sharp.chain(smooth).chain(cages).collect();
    let unknown = files(&models).into_iter().find(|name| {
        let is_readable = !EXPECTED
            .iter()
            .any(|(own, expected)| own == name && matches!(expected, Unreadable(_)));
        is_readable && !known.iter().any(|(own, ..)| own == name)
    });
    assert_eq!(unknown, None);
    for (name, look, angle, edges) in known {
        let found = run("info {} --json", &[&models.join(name)])
            .expect(0)
            .json();
        let found = &found["mesh"]["dihedrals"];
        let told = (
            found["look"].as_str(),
            found["suggested_crease_angle_degrees"].as_f64(),
            found["sharp_edges"].as_u64(),
        );
        assert_eq!(told, (Some(look), angle, Some(edges)), "{name}");
    }
}

//! `--creases-from`: edges that normals, smoothing groups or materials say are sharp; the witness is a cube, which stays itself where
//! all its edges are sharp and gets round where none is.

use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::common::{done, file, folder, json_of, number, usage_error};

pub(crate) const CORNERS: [[i32; 3]; 8] = [
    [-1, -1, -1],
    [1, -1, -1],
    [1, 1, -1],
    [-1, 1, -1],
    [-1, -1, 1],
    [1, -1, 1],
    [1, 1, 1],
    [-1, 1, 1],
];

/// Sides by their corners, with their normals.
pub(crate) const SIDES: [([usize; 4], [i32; 3]); 6] = [
    ([0, 3, 2, 1], [0, 0, -1]),
    ([4, 5, 6, 7], [0, 0, 1]),
    ([0, 1, 5, 4], [0, -1, 0]),
    ([1, 2, 6, 5], [1, 0, 0]),
    ([2, 3, 7, 6], [0, 1, 0]),
    ([3, 0, 4, 7], [-1, 0, 0]),
];

/// A cube, whose corners have normal 1 to 6 of their side where `normals`, and `before` what stands before each side.
fn cube(folder: &TempDir, normals: bool, before: &dyn Fn(usize) -> String) -> PathBuf {
    let mut text = String::new();
    CORNERS
        .iter()
        .for_each(|[x, y, z]| text += &format!("v {x} {y} {z}\n"));
    SIDES
        .iter()
        .for_each(|(_, [x, y, z])| text += &format!("vn {x} {y} {z}\n"));
    for (side, (corners, _)) in SIDES.iter().enumerate() {
        text += &before(side);
        let normal = if normals {
            format!("//{}", side + 1)
        } else {
            String::new()
        };
        let corners: Vec<String> = corners
            .iter()
            .map(|corner| format!("{}{normal}", corner + 1))
            .collect();
        text += &format!("f {}\n", corners.join(" "));
    }
    file(folder, "cube.obj", &text)
}

/// The volume of what is refined from a file.
fn volume(input: &Path, options: &str) -> f64 {
    let output = input.with_extension("ply");
    let command = format!("refine {{}} -o {{}} --tolerance 0.5% --report - {options}");
    let report = json_of(&command, &[input, &output]);
    number(&report["size"]["after"]["volume"])
}

#[test]
fn normals_say_where_edges_are_sharp() {
    let folder = folder();
    let input = cube(&folder, true, &|_| String::new());
    done("refine {} -o {}", &[&input, &input.with_extension("stl")])
        .saying("12 edges have different normals on both sides; --creases-from normals");
    assert!(volume(&input, "") < 5.0);
    assert!((volume(&input, "--creases-from normals") - 8.0).abs() < 1e-9);
    // The distance is to the surface with the same edges.
    let output = input.with_extension("ply");
    let command = "measure {} --limit-of {} --creases-from normals --certified --json";
    let measured = json_of(command, &[&output, &input]);
    assert!(number(&measured["hausdorff"]["upper"]) < 1e-9);
    assert_eq!(measured["reference"]["limit"]["creases_from"], "normals");
    // A vertex for each side, as PLY and STL have them: welded, and the normals kept apart.
    let mut text = "ply\nformat ascii 1.0\nelement vertex 24\n".to_owned();
    ["x", "y", "z", "nx", "ny", "nz"]
        .iter()
        .for_each(|name| text += &format!("property float {name}\n"));
    text += "element face 6\nproperty list uchar int vertex_indices\nend_header\n";
    for (corners, [u, v, w]) in SIDES {
        corners.iter().for_each(|&corner| {
            let [x, y, z] = CORNERS[corner];
            // Not all of length 1.
            text += &format!("{x} {y} {z} {} {} {}\n", 2 * u, 2 * v, 2 * w);
        });
    }
    (0..6).for_each(|side| {
        text += &format!(
            "4 {} {} {} {}\n",
            4 * side,
            4 * side + 1,
            4 * side + 2,
            4 * side + 3
        )
    });
    let input = file(&folder, "split.ply", &text);
    let output = folder.path().join("out.obj");
    let report = json_of(
        "refine {} -o {} --creases-from normals --report -",
        &[&input, &output],
    );
    assert!((number(&report["size"]["after"]["volume"]) - 8.0).abs() < 1e-9);
}

#[test]
fn groups_and_materials_say_so_too() {
    let folder = folder();
    for off in ["off", "0"] {
        let input = cube(&folder, false, &|side| {
            if side == 0 {
                format!("s {off}\n")
            } else {
                String::new()
            }
        });
        assert!((volume(&input, "--creases-from smoothing-groups") - 8.0).abs() < 1e-9);
    }
    let one = cube(&folder, false, &|side| {
        if side == 0 {
            "s 1\n".to_owned()
        } else {
            String::new()
        }
    });
    assert!(volume(&one, "--creases-from smoothing-groups") < 5.0);
    let each = cube(&folder, false, &|side| {
        format!("s {}\nusemtl m{}\n", side + 1, side.min(1))
    });
    assert!((volume(&each, "--creases-from smoothing-groups") - 8.0).abs() < 1e-9);
    // The bottom's four edges: its rim stays in its plane.
    let (bottom, none) = (volume(&each, "--creases-from materials"), volume(&each, ""));
    assert!(1.2 * none < bottom && bottom < 7.9, "{bottom} and {none}");
    let bare = cube(&folder, false, &|_| String::new());
    let output = folder.path().join("out.ply");
    for (from, what) in [
        ("normals", "no normals"),
        ("smoothing-groups", "no smoothing groups"),
        ("materials", "no materials"),
    ] {
        let command = format!("refine {{}} -o {{}} --creases-from {from}");
        usage_error(&command, &[&bare, &output], what);
    }
    let package = folder.path().join("a.3mf");
    done("refine builtin:cube -o {}", &[&package]);
    let again = folder.path().join("b.3mf");
    usage_error(
        "refine {} -o {} --creases-from normals",
        &[&package, &again],
        "is for OBJ, PLY",
    );
}

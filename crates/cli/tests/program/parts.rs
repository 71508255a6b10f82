//! Parts stay parts: what looks like one keeps its sharp edges and its size by default, in every command that has a limit surface.
//! Witnesses are exact shapes, and volumes by formulas.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;
use std::path::{Path, PathBuf};

use limitmesh::PolygonSoup;
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::common::{Run, done, file, folder, json_of, number, soup, usage_error};

type Point = [f64; 3];

/// Triangles by their corners, as STL files have them.
#[derive(Default)]
struct Solid(Vec<[Point; 3]>);

impl Solid {
    fn quad(&mut self, [a, b, c, d]: [Point; 4]) {
        self.0.extend([[a, b, c], [a, c, d]]);
    }

    /// A box with its faces outwards.
    fn cuboid([x, y, z]: Point) -> Self {
        let at = |i: usize| {
            [
                if i & 1 > 0 { x } else { 0.0 },
                if i & 2 > 0 { y } else { 0.0 },
                if i & 4 > 0 { z } else { 0.0 },
            ]
        };
        let mut solid = Self::default();
        for side in [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ] {
            solid.quad(side.map(at));
        }
        solid
    }

    /// A peg between flat ends.
    fn peg(facets: usize, radius: f64, height: f64) -> Self {
        let at = |i: usize, z: f64| {
            let (sine, cosine) = (TAU * (i % facets) as f64 / facets as f64).sin_cos();
            [radius * cosine, radius * sine, z]
        };
        let mut solid = Self::default();
        for i in 0..facets {
            solid.quad([at(i, 0.0), at(i + 1, 0.0), at(i + 1, height), at(i, height)]);
        }
        for i in 1..facets - 1 {
            solid.0.push([at(0, 0.0), at(i + 1, 0.0), at(i, 0.0)]);
            solid
                .0
                .push([at(0, height), at(i, height), at(i + 1, height)]);
        }
        solid
    }

    fn stl(&self, folder: &TempDir, name: &str) -> PathBuf {
        let mut text = "solid part\n".to_owned();
        for corners in &self.0 {
            text += "facet normal 0 0 0\nouter loop\n";
            corners
                .iter()
                .for_each(|[x, y, z]| writeln!(text, "vertex {x} {y} {z}").expect("text"));
            text += "endloop\nendfacet\n";
        }
        file(folder, name, &(text + "endsolid part\n"))
    }
}

/// The volume of a closed surface, a sixth of a determinant for each triangle.
fn volume(soup: &PolygonSoup) -> f64 {
    let of = |face: &[u32]| {
        let [a, b, c] = [0, 1, 2].map(|i| soup.positions[face[i] as usize]);
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    soup.faces.iter().map(of).sum::<f64>() / 6.0
}

fn refine(input: &Path, options: &str) -> (Run, PolygonSoup, Value) {
    let output = input.with_extension("out.ply");
    let line = format!("refine {{}} -o {{}} --report - {options}");
    let run = done(&line, &[input, &output]);
    let report = run.json();
    (run, soup(&output), report)
}

const KEPT: &str = "kept sharp, surface led through the vertices; --crease-angle none smooths them";

#[test]
fn a_box_is_itself_and_says_so_first() {
    let folder = folder();
    let input = Solid::cuboid([40.0, 20.0, 5.0]).stl(&folder, "box.stl");
    let (run, found, report) = refine(&input, "");
    assert_eq!(
        run.stderr.lines().next(),
        Some(&*format!(
            "looks like a part: 12 edges sharper than 30° {KEPT}"
        )),
        "{}",
        run.stderr
    );
    assert!((volume(&found) - 4000.0).abs() < 1e-6, "{}", volume(&found));
    let parameters = &report["parameters"];
    assert_eq!(
        (
            &parameters["crease_angle_degrees"],
            &parameters["crease_angle_auto"]
        ),
        (&json!(30.0), &json!(true))
    );
    assert_eq!(parameters["interpolate_within"], 0.0);
    assert_eq!(parameters["concave_corners"], "fixed");
    assert_eq!(report["interpolation"]["folded_regions"], 0);

    let (run, found, report) = refine(&input, "--crease-angle none");
    below!(volume(&found), 2000.0);
    silent!(run.stderr, "looks like");
    assert_eq!(report["parameters"]["crease_angle_auto"], false);
    // An angle that is given means what it meant.
    let (run, _, report) = refine(&input, "--crease-angle 40");
    assert!(!run.stderr.contains("looks like"), "{}", run.stderr);
    assert_eq!(
        (
            &report["parameters"]["crease_angle_degrees"],
            &report["interpolation"]
        ),
        (&json!(40.0), &Value::Null)
    );
    let (run, _, report) = refine(&input, "--interpolate=0.1");
    says!(run.stderr, "kept sharp; --crease-angle none smooths them");
    assert_eq!(report["parameters"]["interpolate_within"], 0.1);
    // Methods that are compared with keep their rules, unless they are asked.
    let (run, found, _) = refine(&input, "--method uniform");
    below!(volume(&found), 2000.0);
    silent!(run.stderr, "looks like");
    let (_, found, _) = refine(&input, "--method uniform --crease-angle auto");
    assert!((volume(&found) - 4000.0).abs() < 1e-3, "{}", volume(&found));
    let (_, found, _) = refine(&input, "--scheme sqrt3 --crease-angle auto --angle 20");
    assert!((volume(&found) - 4000.0).abs() < 1e-3, "{}", volume(&found));
    let output = folder.path().join("x.ply");
    crate::common::usage_error(
        "refine {} -o {} --crease-angle 0",
        &[&input, &output],
        "'auto' or 'none'",
    );
}

/// One surface in all commands: what is refined by default is at its tolerance from the surface that others speak of by default.
#[test]
fn all_commands_speak_of_one_surface() {
    let folder = folder();
    let input = Solid::peg(16, 5.0, 8.0).stl(&folder, "part.stl");
    let output = folder.path().join("out.ply");
    done("refine {} -o {} --tolerance 0.02", &[&input, &output]);
    let measured = |options: &str| {
        let line = format!("measure {{}} --limit-of {{}} --json {options}");
        let run = done(&line, &[&output, &input]);
        (number(&run.json()["hausdorff"]["symmetric"]), run)
    };
    let (near, found) = measured("--samples 20000");
    found.saying("looks like a part");
    let (far, _) = measured("--samples 20000 --crease-angle none");
    assert!(near < 0.021 && far > 1.0, "{near} {far}");
    let line = "measure {} --limit-of {} --certified --json";
    let certified = json_of(line, &[&output, &input]);
    assert!(
        number(&certified["hausdorff"]["lower"]) <= 0.02,
        "{certified}"
    );
    assert_eq!(certified["reference"]["limit"]["crease_angle_auto"], true);

    let peg = Solid::peg(16, 5.0, 8.0).stl(&folder, "peg.stl");
    // The first facet's corner at (5, 0, 0).
    let found = done("evaluate {} --at 0,1,0,0 --json", &[&peg])
        .saying("looks like a part")
        .json();
    let point = [0, 1, 2].map(|i| number(&found[0]["point"][i]));
    below!((point[0] - 5.0).abs(), 1e-9);
    below!(point[1].abs(), 1e-9);
    below!(point[2].abs(), 1e-9);
    let at = file(&folder, "points.csv", "5,0,0\n0,5,8\n");
    let found = done("project {} --onto {} --json", &[&at, &peg])
        .saying("looks like a part")
        .json();
    assert!(number(&found["distance"]["greatest"]) < 1e-6, "{found}");
    let levels = folder.path().join("levels.ply");
    done("lod {} -o {} --levels 2", &[&peg, &levels]).saying("looks like a part");
    let finest = soup(&folder.path().join("levels_LOD0.ply"));
    below!((volume(&finest) / (PI * 200.0) - 1.0).abs(), 5e-3);
    let picture = folder.path().join("peg.png");
    done("render {} -o {} --exact --size 60x60", &[&peg, &picture]).saying("looks like a part");
    usage_error(
        "render {} -o {} --crease-angle auto",
        &[&peg, &picture],
        "--exact",
    );
    // Comparisons keep their rules.
    let compared = done("compare {} --levels 1 --samples 1000 --json", &[&peg]);
    silent!(compared.stderr, "looks like");
}

/// Packages and assets: by mesh.
#[test]
fn meshes_of_assets_and_packages_are_looked_at_one_by_one() {
    let folder = folder();
    let input = Solid::cuboid([40.0, 20.0, 5.0]).stl(&folder, "box.stl");
    for (name, unit) in [("box.3mf", "--unit mm"), ("box.glb", "")] {
        let [plain, fine] =
            [name.to_owned(), format!("fine_{name}")].map(|name| folder.path().join(name));
        let line = format!("refine {{}} -o {{}} --method uniform --levels 0 {unit}");
        done(&line, &[&input, &plain]);
        done("refine {} -o {}", &[&plain, &fine]).saying("looks like a part: 12 edges");
        let found = json_of("info {} --json", &[&fine]);
        assert!(
            (number(&found["mesh"]["volume"]) - 4000.0).abs() < 1e-2,
            "{name}: {}",
            found["mesh"]["volume"]
        );
        done("refine {} -o {} --crease-angle none", &[&plain, &fine]);
        let found = json_of("info {} --json", &[&fine]);
        below!(number(&found["mesh"]["volume"]), 2000.0, "{name}");
    }
}

/// A box as OBJ, each triangle with what stands before it and its corners with normals by its sides, if any.
fn obj(
    folder: &TempDir,
    tags: &str,
    before: &dyn Fn(usize) -> &'static str,
    normals: &dyn Fn(usize) -> Option<Point>,
) -> PathBuf {
    let mut text = String::new();
    for (i, corners) in Solid::cuboid([4.0, 2.0, 1.0]).0.iter().enumerate() {
        corners
            .iter()
            .for_each(|[x, y, z]| writeln!(text, "v {x} {y} {z}").expect("text"));
        let normal = normals(i / 2);
        normal
            .iter()
            .for_each(|[x, y, z]| writeln!(text, "vn {x} {y} {z}").expect("text"));
        let corner = |k: usize| {
            if normal.is_some() {
                format!("{}//{}", 3 * i + k, i + 1)
            } else {
                format!("{}", 3 * i + k)
            }
        };
        writeln!(
            text,
            "{}f {} {} {}",
            before(i / 2),
            corner(1),
            corner(2),
            corner(3)
        )
        .expect("text");
    }
    file(folder, "box.obj", &(text + tags))
}

#[test]
fn files_with_sharpness_of_their_own_are_not_looked_at() {
    let folder = folder();
    let none = |_: usize| None;
    let is_part = |input: &Path| {
        let (run, found, _) = refine(input, "--tolerance 1%");
        let is_kept = (volume(&found) - 8.0).abs() < 1e-5;
        assert_eq!(
            run.stderr.contains("looks like a part"),
            is_kept,
            "{}",
            run.stderr
        );
        is_kept
    };
    assert!(is_part(&obj(&folder, "", &|_| "", &none)));
    assert!(!is_part(&obj(
        &folder,
        "t crease 2/1/0 0 1 10\n",
        &|_| "",
        &none
    )));
    assert!(!is_part(&obj(
        &folder,
        "t corner 1/1/0 0 10\n",
        &|_| "",
        &none
    )));
    // One smoothing group, or none, says nothing.
    assert!(!is_part(&obj(
        &folder,
        "",
        &|side| if side == 0 { "s 1\n" } else { "s 2\n" },
        &none
    )));
    assert!(is_part(&obj(&folder, "", &|_| "s 1\n", &none)));
    assert!(is_part(&obj(&folder, "", &|_| "s off\n", &none)));
    // Facets that are shaded flat say nothing.
    let sides = [
        [0.0, 0.0, -1.0],
        [0.0, 0.0, 1.0],
        [0.0, -1.0, 0.0],
        [0.0, 1.0, 0.0],
        [-1.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
    ];
    assert!(is_part(&obj(&folder, "", &|_| "", &|side| Some(
        sides[side]
    ))));
    // A cage of quadrilaterals is meant to become round.
    let quads = "v 0 0 0\nv 4 0 0\nv 0 2 0\nv 4 2 0\nv 0 0 1\nv 4 0 1\nv 0 2 1\nv 4 2 1\n\
        f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    assert!(!is_part(&file(&folder, "cage.obj", quads)));
}

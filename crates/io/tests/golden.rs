//! Results are the same bytes on every processor: those whose hashes `golden/manifest.txt` lists.
//!
//! A line is a built-in model, options, the number of triangles (of bytes for a file), and the SHA-256 of the positions as 64-bit numbers
//! and of the triangles as 32-bit ones, little-endian. The tests of the npm package compare what WebAssembly makes with the same lines,
//! and `.ci/arm64` runs this test on an emulated processor.
//!
//! `LIMITMESH_MOST_FACES=200` leaves out greater models, of which an emulator would take minutes. `LIMITMESH_REWRITE=1` writes the manifest.
//! `LIMITMESH_NUMBERS="cup scheme=loop tolerance=1%"` prints the numbers of one line instead, so that two processors' can be compared.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use limitmesh::interpolate::{InterpolateOptions, interpolate};
use limitmesh::mesh::BuildOptions;
use limitmesh::refine::{ExactOptions, Finish, UniformOptions, exact, uniform};
use limitmesh::scheme::{CatmullClark, Loop, LoopWarren, ModifiedButterfly, Scheme};
use limitmesh::{Mesh, PolygonSoup, QuadControl, QuadOptions, sqrt3};
use limitmesh_io::{Format, Output, WriteOptions, write_to};
use sha2::{Digest, Sha256};

/// Of every model. Names and defaults are those of the npm package, whose calls begin with `scheme`.
const GOALS: [&str; 13] = [
    "scheme=loop tolerance=1%",
    "scheme=loop tolerance=0.1%",
    "scheme=loop tolerance=0.02%",
    "scheme=loop triangles=2000",
    "scheme=loop angle=10",
    "scheme=loop tolerance=1% interpolate=true",
    "scheme=loop tolerance=0.5% balance=true",
    "scheme=loop tolerance=2% optimize=true",
    "scheme=loop tolerance=0.5% creaseAngle=30 concaveCorners=as-tagged",
    "scheme=loop-warren tolerance=0.5%",
    "scheme=catmull-clark tolerance=2%",
    "uniform=butterfly levels=2",
    "uniform=sqrt3 levels=3",
];

/// Of some models, as files.
const FILES: [&str; 8] = [
    "file=obj",
    "file=ply",
    "file=ply-ascii",
    "file=stl",
    "file=stl-ascii",
    "file=off",
    "file=glb",
    "file=3mf",
];
const IN_FILES: [&str; 5] = ["cup", "bunny", "cube", "torus", "radish"];

#[test]
fn results_are_those_of_every_processor() {
    if let Some(line) = std::env::var_os("LIMITMESH_NUMBERS") {
        let line = line.to_str().expect("a line of the manifest");
        let (model, options) = line.split_once(' ').expect("a model and options");
        let model = limitmesh_models::find(model).expect("a model");
        result(&model.soup(), options).print();
        return;
    }
    let most: Option<usize> = std::env::var("LIMITMESH_MOST_FACES")
        .ok()
        .map(|most| most.parse().expect("a number of faces"));
    let (mut lines, mut left_out) = (String::new(), Vec::new());
    for model in limitmesh_models::all() {
        let soup = model.soup();
        if most.is_some_and(|most| soup.faces.len() > most) {
            left_out.push(model.name);
            continue;
        }
        let files = FILES.iter().filter(|_| IN_FILES.contains(&model.name));
        for options in GOALS.iter().chain(files) {
            let found = result(&soup, options);
            let (count, hash) = (found.count(), found.hash());
            writeln!(lines, "{} {options} {count} {hash}", model.name).expect("a line");
        }
    }
    let path = manifest();
    if std::env::var_os("LIMITMESH_REWRITE").is_some_and(|value| value == "1") {
        assert!(left_out.is_empty(), "all models are written, or none");
        std::fs::write(&path, &lines).expect("the manifest");
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    let is_asked = |line: &&str| {
        !left_out
            .iter()
            .any(|name| line.split(' ').next() == Some(name))
    };
    let kept: Vec<&str> = kept.lines().filter(is_asked).collect();
    let found: Vec<&str> = lines.lines().collect();
    let others = found.iter().filter(|line| !kept.contains(line));
    let others: Vec<&str> = others.copied().collect();
    assert!(
        found == kept,
        "{} results of {} are not those of golden/manifest.txt, or it has others:\n{}",
        others.len(),
        found.len(),
        others.join("\n")
    );
}

fn manifest() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../golden/manifest.txt")
}

enum Found {
    Mesh(Box<Mesh>),
    File(Vec<u8>),
}

impl Found {
    fn count(&self) -> usize {
        match self {
            Self::Mesh(mesh) => mesh.face_count(),
            Self::File(bytes) => bytes.len(),
        }
    }

    fn hash(&self) -> String {
        let mut hash = Sha256::new();
        match self {
            Self::Mesh(mesh) => {
                for x in mesh.positions().as_flattened() {
                    hash.update(x.to_le_bytes());
                }
                for v in mesh.triangles().as_flattened() {
                    hash.update(v.to_le_bytes());
                }
            }
            Self::File(bytes) => hash.update(bytes),
        }
        let bytes = hash.finalize();
        bytes.iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// One number a line, with all of its bits.
    fn print(&self) {
        match self {
            Self::Mesh(mesh) => {
                for (at, x) in mesh.positions().as_flattened().iter().enumerate() {
                    println!(
                        "vertex {} {} {:016x} {x:e}",
                        at / 3,
                        ["x", "y", "z"][at % 3],
                        x.to_bits()
                    );
                }
                for (at, [a, b, c]) in mesh.triangles().iter().enumerate() {
                    println!("triangle {at} {a} {b} {c}");
                }
            }
            Self::File(bytes) => {
                for (at, byte) in bytes.iter().enumerate() {
                    println!("byte {at} {byte:02x}");
                }
            }
        }
    }
}

/// What becomes of a soup with the options of a line.
fn result(soup: &PolygonSoup, options: &str) -> Found {
    let value = |key: &str| {
        let mut words = options
            .split(' ')
            .map(|word| word.split_once('=').expect("key=value"));
        words.find(|(own, _)| *own == key).map(|(_, value)| value)
    };
    if let Some(format) = value("file") {
        return Found::File(file(
            &refined(soup, &|key| (key == "tolerance").then_some("1%")),
            format,
        ));
    }
    let Some(method) = value("uniform") else {
        return Found::Mesh(Box::new(refined(soup, &value)));
    };
    let control = built(soup, None);
    let levels = value("levels").expect("levels").parse().expect("a number");
    let goal = UniformOptions::default().levels(levels);
    let refined = match method {
        "sqrt3" => sqrt3::uniform(&control, &goal),
        _ => uniform(&control, &ModifiedButterfly, &goal),
    };
    Found::Mesh(Box::new(refined.expect("a refined mesh").mesh))
}

fn built(soup: &PolygonSoup, crease_angle: Option<f64>) -> Mesh {
    let (mesh, _) = Mesh::from_soup(soup, &BuildOptions::default()).expect("a mesh");
    match crease_angle {
        Some(degrees) => mesh
            .with_creases_above(degrees.to_radians())
            .expect("creases"),
        None => mesh,
    }
}

/// A soup refined by the exact engine.
fn refined<'v>(soup: &PolygonSoup, value: &dyn Fn(&str) -> Option<&'v str>) -> Mesh {
    let number = |key: &str| value(key).map(|text| text.parse::<f64>().expect("a number"));
    let scheme: &dyn Scheme = match value("scheme") {
        Some("loop-warren") => &LoopWarren,
        Some("catmull-clark") => &CatmullClark,
        _ => &Loop,
    };
    let control = match value("scheme") {
        Some("catmull-clark") => {
            let (quads, _) = QuadControl::from_soup_with(
                soup,
                &BuildOptions::default(),
                &QuadOptions::default(),
            )
            .expect("a cage");
            quads.mesh
        }
        _ => built(soup, number("creaseAngle")),
    };
    // Parts of the diagonal of what was given, however the control mesh was moved.
    let diagonal = control.diagonal();
    let control = match value("interpolate") {
        Some(_) => {
            interpolate(&control, scheme, &InterpolateOptions::default())
                .expect("control points")
                .mesh
        }
        None => control,
    };
    let mut goal = ExactOptions::default().origins(false).finish(
        match (value("balance"), value("optimize")) {
            (Some(_), _) => Finish::Balanced,
            (_, Some(_)) => Finish::Collapsed,
            _ => Finish::OnSurface,
        },
    );
    if let Some(share) = value("tolerance") {
        let share: f64 = share.trim_end_matches('%').parse().expect("per cent");
        goal = goal.tolerance(share / 100.0 * diagonal);
    }
    if let Some(degrees) = number("angle") {
        goal = goal.angle(degrees.to_radians());
    }
    if let Some(count) = number("triangles") {
        goal = goal.triangles(count as usize);
    }
    exact(&control, scheme, &goal).expect("a refined mesh").mesh
}

/// A mesh as the bytes of a file.
fn file(mesh: &Mesh, format: &str) -> Vec<u8> {
    let (name, ascii) = match format.split_once('-') {
        Some((name, _)) => (name, true),
        None => (format, false),
    };
    let format = Format::from_path(Path::new(&format!("mesh.{name}"))).expect("a format");
    let mut bytes = Vec::new();
    let options = WriteOptions::default().ascii(ascii);
    write_to(
        &mut bytes,
        format,
        &Output::new(mesh.as_triangles()),
        &options,
    )
    .expect("a file");
    bytes
}

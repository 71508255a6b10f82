//! Polygons of glTF assets: refined as those of OBJ files are, with all that the asset holds.

use std::f64::consts::FRAC_PI_4;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use limitmesh::mesh::{Channel, Semantic};
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::common::{done, file, folder, list, soup, usage_error};
use crate::glb::{Builder, Glb};

/// Points, which 32-bit floats hold unless they are moved, and polygons.
struct Cage {
    points: Vec<[f64; 3]>,
    faces: Vec<Vec<u32>>,
}

fn rounded(p: [f64; 3]) -> [f64; 3] {
    p.map(|x| f64::from(x as f32))
}

/// A tube of quads along z, closed by two octagons if it has caps.
fn tube(has_caps: bool) -> Cage {
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for row in 0..4u32 {
        for i in 0..8u32 {
            let (x, y) = (FRAC_PI_4 * f64::from(i) + 0.1).sin_cos();
            points.push(rounded([x, y, f64::from(row) + 0.2 * x]));
            if row > 0 {
                let next = (i + 1) % 8;
                let [below, above] = [8 * (row - 1), 8 * row];
                faces.push(vec![below + next, below + i, above + i, above + next]);
            }
        }
    }
    if has_caps {
        faces.extend([(0..8).collect(), (24..32).rev().collect()]);
    }
    Cage { points, faces }
}

/// A bent cube with a roof of four triangles on one side.
fn house() -> Cage {
    let corner = |i: u8| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -1.0 } else { 1.0 });
    let bent = |[x, y, z]: [f64; 3]| rounded([x + 0.1 * y, y + 0.07 * z * x, z + 0.05 * x]);
    let corners = (0..8).map(|i| bent(corner(i)));
    let points = corners.chain([rounded([0.1, 0.2, 2.0])]).collect();
    let quads = [
        [0, 2, 3, 1],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let roof = [[4, 5, 8], [5, 7, 8], [7, 6, 8], [6, 4, 8]];
    let quads = quads.iter().map(|own| own.to_vec());
    let faces = quads.chain(roof.iter().map(|own| own.to_vec())).collect();
    Cage { points, faces }
}

/// How an asset has polygons.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Encoding {
    Fans,
    Loops,
    /// By triangles alone.
    Nothing,
}

impl Cage {
    fn corners(&self) -> impl Iterator<Item = usize> {
        self.faces.iter().flatten().map(|&v| v as usize)
    }

    /// Its points moved by a small part of a displacement.
    fn moved(&self, displacement: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        let added = |p: [f64; 3]| [0, 1, 2].map(|i| p[i] + SMALL * displacement(p)[i]);
        Self {
            points: self.points.iter().map(|&p| added(p)).collect(),
            faces: self.faces.clone(),
        }
    }

    /// An OBJ file of it, with texture coordinates at corners.
    fn obj(&self, folder: &TempDir, name: &str) -> PathBuf {
        let mut text = String::new();
        for [x, y, z] in &self.points {
            writeln!(text, "v {x} {y} {z}").expect("text");
        }
        for point in &self.points {
            for [u, v] in [0, 1].map(|face| texture(face, point)) {
                writeln!(text, "vt {u} {}", 1.0 - v).expect("text");
            }
        }
        for (number, face) in self.faces.iter().enumerate() {
            text.push('f');
            for v in face {
                let coordinates = 2 * v + 1 + u32::from(number > 0);
                write!(text, " {}/{coordinates}", v + 1).expect("text");
            }
            text.push('\n');
        }
        file(folder, name, &text)
    }

    /// The same as an asset, which has a vertex for each corner. Other members of the primitive are given by the corners' vertices.
    fn asset(
        &self,
        folder: &TempDir,
        encoding: Encoding,
        more: impl FnOnce(&mut Builder, &[usize]) -> Value,
    ) -> PathBuf {
        let mut builder = Builder::new();
        let corners: Vec<usize> = self.corners().collect();
        let points = corners.iter().map(|&v| self.points[v].map(|x| x as f32));
        let points: Vec<[f32; 3]> = points.collect();
        let faces = self.faces.iter().enumerate();
        let coordinates = faces.flat_map(|(number, face)| {
            let own = face.iter().map(move |&v| (number, v as usize));
            own.flat_map(|(number, v)| texture(number, &self.points[v]))
        });
        let coordinates: Vec<f32> = coordinates.map(|x| x as f32).collect();
        let mut attributes = json!({"POSITION": builder.points(&points), "TEXCOORD_0": builder.floats(&coordinates, 2)});
        let (mut fans, mut loops) = (Vec::new(), Vec::new());
        let (mut fan_starts, mut loop_starts) = (Vec::new(), Vec::new());
        let mut first = 0;
        for face in &self.faces {
            fan_starts.push(3 * fans.len() as u32);
            loop_starts.push(loops.len() as u32);
            let end = first + face.len() as u32;
            loops.extend((first..end).chain([0xFFFF]));
            fans.extend((first + 2..end).map(|v| [first, v - 1, v]));
            first = end;
        }
        let triangles = builder.indices(&fans);
        let mut shorts = |all: Vec<u32>| {
            let view = builder.view(all.iter().flat_map(|&v| (v as u16).to_le_bytes()));
            let layout = json!({"bufferView": view, "componentType": 5123, "count": all.len(), "type": "SCALAR"});
            builder.accessor(layout)
        };
        let (name, extension) = match encoding {
            Encoding::Nothing => ("OTHER_thing", json!({})),
            Encoding::Fans => ("FB_ngon_encoding", json!({})),
            Encoding::Loops => (
                "EXT_mesh_polygon",
                json!({"count": self.faces.len(), "indicesOffsets": shorts(fan_starts),
                    "loopIndices": shorts(loops), "loopIndicesOffsets": shorts(loop_starts)}),
            ),
        };
        let mut primitive = more(&mut builder, &corners);
        let own = attributes.as_object_mut().expect("an object");
        own.extend(
            primitive["attributes"]
                .as_object()
                .cloned()
                .unwrap_or_default(),
        );
        primitive["attributes"] = attributes;
        primitive["indices"] = json!(triangles);
        primitive["extensions"] = json!({(name): extension, "ODD_thing": 7});
        builder.primitive(primitive);
        builder.json["extensionsUsed"] = json!([name, "ODD_thing"]);
        builder.json["extensionsRequired"] = json!([name]);
        let input = folder.path().join("in.glb");
        builder.write(&input);
        input
    }

    fn plain_asset(&self, folder: &TempDir, encoding: Encoding) -> PathBuf {
        self.asset(folder, encoding, |_, _| json!({}))
    }
}

/// Texture coordinates at a point, as glTF has them; those of the first face are apart.
fn texture(face: usize, [x, y, z]: &[f64; 3]) -> [f64; 2] {
    let first = if face == 0 { 1.0 } else { 0.0 };
    [x * y + first, z * z / 8.0 - x]
}

/// What was refined, and `said` on the way.
fn refined(input: &Path, output: &str, options: &str, said: &str) -> PathBuf {
    let output = input.with_file_name(output);
    let line = format!("refine {{}} -o {{}} {options}");
    let run = done(&line, &[input, &output]);
    if !said.is_empty() {
        run.saying(said);
    }
    output
}

/// The number of the point that is here but for rounding.
fn place_of(points: &[[f64; 3]], p: [f64; 3]) -> usize {
    let is_near = |own: &[f64; 3]| (0..3).all(|i| (own[i] - p[i]).abs() < 1e-6);
    let found = points.iter().position(is_near);
    assert!(found.is_some(), "nothing is at {p:?}");
    found.unwrap_or_default()
}

fn positions(glb: &Glb) -> Vec<[f64; 3]> {
    glb.points(&glb.primitive(0)["attributes"]["POSITION"])
}

const UNIFORM: &str = "--method uniform --levels 2 --limit --faces triangles";

#[test]
fn assets_of_polygons_are_refined_as_obj_files_are() {
    let folder = folder();
    let ways = [
        (UNIFORM, "so that --scheme catmull-clark holds"),
        (
            "--tolerance 0.02 --faces triangles --divide-flat",
            "meshes[0]: its faces are quads for the most part, so that --scheme catmull-clark holds",
        ),
    ];
    for (cage, encoding) in [
        (tube(false), Encoding::Fans),
        (tube(true), Encoding::Loops),
        (house(), Encoding::Fans),
    ] {
        let (obj, asset) = (
            cage.obj(&folder, "in.obj"),
            cage.plain_asset(&folder, encoding),
        );
        for (options, said) in ways {
            let expected = soup(&refined(&obj, "out.obj", options, ""));
            let glb = Glb::read(&refined(&asset, "out.glb", options, said));
            let (triangles, points) = (glb.triangles(0), positions(&glb));
            assert_eq!(triangles.len(), expected.faces.len(), "{options}");
            let mut is_met = vec![false; expected.positions.len()];
            for &p in &points {
                is_met[place_of(&expected.positions, p)] = true;
            }
            assert!(is_met.into_iter().all(|is| is), "{options}");
            assert_same_texture(&expected, &glb);
            // Nothing is left of the extension.
            let primitive = glb.primitive(0);
            assert_eq!(primitive["extensions"], json!({"ODD_thing": 7}));
            assert_eq!(glb.json["extensionsUsed"], json!(["ODD_thing"]));
            assert!(glb.json.get("extensionsRequired").is_none());
        }
    }
}

/// Each corner of an asset's triangles has texture coordinates that the other has there.
fn assert_same_texture(expected: &limitmesh::PolygonSoup, glb: &Glb) {
    let is_texture = |own: &&Channel| own.semantic == Semantic::TextureCoordinates;
    let channel = expected.channels.iter().find(is_texture).expect("some");
    let mut at = vec![Vec::new(); expected.positions.len()];
    for (corner, &v) in expected.faces.iter().flatten().enumerate() {
        at[v as usize].push(channel.value(corner));
    }
    let points = positions(glb);
    let coordinates = glb.numbers(&glb.primitive(0)["attributes"]["TEXCOORD_0"]);
    for (p, own) in points.iter().zip(coordinates.chunks(2)) {
        let here = &at[place_of(&expected.positions, *p)];
        let is_same = |other: &&&[f64]| {
            (own[0] - other[0]).abs() < 1e-6 && (own[1] - (1.0 - other[1])).abs() < 1e-6
        };
        assert!(
            here.iter().any(|other| is_same(&other)),
            "{own:?} at {p:?}, not {here:?}"
        );
    }
}

#[test]
fn by_loops_scheme_the_triangles_of_the_file_count() {
    let folder = folder();
    let uniform = "--method uniform --levels 1 --limit --scheme loop";
    for options in [uniform, "--within 1%"] {
        let written = |encoding| {
            let asset = tube(true).plain_asset(&folder, encoding);
            let glb = Glb::read(&refined(&asset, "out.glb", options, ""));
            (positions(&glb), glb.triangles(0))
        };
        let plain = written(Encoding::Nothing);
        for encoding in [Encoding::Fans, Encoding::Loops] {
            assert!(written(encoding) == plain, "{options} {encoding:?}");
        }
    }
    // So they do on the way to other formats.
    let written = |encoding| {
        let asset = tube(true).plain_asset(&folder, encoding);
        std::fs::read(refined(&asset, "out.obj", uniform, "")).expect("written")
    };
    assert!(written(Encoding::Fans) == written(Encoding::Nothing));
}

/// So small that no polygon is cut otherwise for it.
const SMALL: f64 = 1e-4;

/// Weights of three joints that are neither linear in space nor alike.
fn weights([x, y, z]: [f64; 3]) -> [f64; 3] {
    let all = [1.5 + x * y, 0.5 + z * z, 2.0 + (3.0 * x).sin() + 0.3 * z];
    let total: f64 = all.iter().sum();
    all.map(|own| own / total)
}

fn displacement([x, y, z]: [f64; 3]) -> [f64; 3] {
    [0.3 * z * z, x * y, 0.2 * y]
}

/// Weights and morph targets go where the scheme takes them: as what is added to an OBJ file's points does.
#[test]
fn skins_and_morph_targets_follow_the_polygons() {
    let folder = folder();
    for cage in [tube(false), tube(true), house()] {
        let asset = cage.asset(&folder, Encoding::Fans, |builder, corners| {
            let own = || corners.iter().map(|&v| cage.points[v]);
            let of_joints = own().flat_map(|p| weights(p).into_iter().chain([0.0]));
            let of_joints: Vec<f32> = of_joints.map(|x| x as f32).collect();
            let moved = own().map(|p| displacement(p).map(|x| x as f32));
            let moved: Vec<[f32; 3]> = moved.collect();
            let joints = builder.joints(&vec![[0, 1, 2, 0]; corners.len()]);
            builder.json["nodes"] = json!([{"mesh": 0, "skin": 0}, {}, {}, {}]);
            builder.json["skins"] = json!([{"joints": [1, 2, 3]}]);
            json!({"attributes": {"JOINTS_0": joints, "WEIGHTS_0": builder.floats(&of_joints, 4)},
                "targets": [{"POSITION": builder.points(&moved)}]})
        });
        let glb = Glb::read(&refined(&asset, "out.glb", UNIFORM, "catmull-clark holds"));
        let surface = |cage: &Cage| {
            let obj = cage.obj(&folder, "in.obj");
            let options = format!("{UNIFORM} --scheme catmull-clark");
            soup(&refined(&obj, "out.obj", &options, "")).positions
        };
        let base = surface(&cage);
        let added = |displacement: fn([f64; 3]) -> [f64; 3]| {
            let moved = surface(&cage.moved(displacement));
            let all = moved.iter().zip(&base);
            let all = all.map(|(moved, base)| [0, 1, 2].map(|i| (moved[i] - base[i]) / SMALL));
            all.collect::<Vec<[f64; 3]>>()
        };
        let (expected_weights, expected_moves) = (added(weights), added(displacement));
        let attributes = &glb.primitive(0)["attributes"];
        let joints = glb.numbers(&attributes["JOINTS_0"]);
        let of_joints = glb.numbers(&attributes["WEIGHTS_0"]);
        let moves = glb.points(&list(&glb.primitive(0)["targets"])[0]["POSITION"]);
        for (number, &p) in positions(&glb).iter().enumerate() {
            let place = place_of(&base, p);
            for i in 4 * number..4 * number + 3 {
                let expected = expected_weights[place][joints[i] as usize];
                below!((of_joints[i] - expected).abs(), 1e-6);
            }
            below!(of_joints[4 * number + 3], 1e-6);
            for (found, expected) in moves[number].iter().zip(expected_moves[place]) {
                below!((found - expected).abs(), 1e-5);
            }
        }
    }
}

#[test]
fn polygons_of_other_assets_are_told_apart() {
    let folder = folder();
    // Triangles alone are none, and a scheme for polygons is not for them.
    let mut builder = Builder::new();
    let points: Vec<[f32; 3]> = house().points.iter().map(|p| p.map(|x| x as f32)).collect();
    let position = builder.points(&points);
    let indices = builder.indices(&[[0, 2, 3], [0, 3, 1], [0, 1, 5]]);
    builder.primitive(json!({"attributes": {"POSITION": position}, "indices": indices}));
    let (input, output) = (folder.path().join("t.glb"), folder.path().join("out.glb"));
    builder.write(&input);
    usage_error(
        "refine {} -o {} --scheme catmull-clark",
        &[&input, &output],
        "has none but triangles",
    );
    // A fan that is none is said to be.
    let indices = builder.indices(&[[0, 2, 3], [0, 1, 5]]);
    let primitive = &mut builder.json["meshes"][0]["primitives"][0];
    primitive["extensions"] = json!({"FB_ngon_encoding": {}});
    primitive["indices"] = json!(indices);
    builder.write(&input);
    done("refine {} -o {}", &[&input, &output]).saying("meshes[0]: left out: polygons with holes");
    // What is for triangles cuts quads into these.
    let asset = house().plain_asset(&folder, Encoding::Fans);
    done("refine {} -o {} --within 1%", &[&asset, &output])
        .saying("meshes[0]: its quads are cut into triangles, as --within is for these");
    done("info {}", &[&asset]);
    let told = crate::common::json_of("info {} --json", &[&asset]);
    assert_eq!(told["input"]["faces"], 9, "{told}");
}

//! Tangents of glTF assets: along the texture on every triangle, whatever the program found them by.

use std::path::PathBuf;

use serde_json::json;
use tempfile::TempDir;

use crate::common::{folder, run};
use crate::glb::{Builder, Glb};

/// Vertices of the grid along a side.
const SIDE: usize = 7;

/// A bowl over the square between -1 and 1 whose texture lies upright as seen from above, as v runs downwards: u = 2x, or |x|, and
/// v = -y. A morph target turns it by a quarter about the z axis; its tangents are asked for, too.
fn bowl(folder: &TempDir, is_mirrored: bool, has_texture: bool) -> PathBuf {
    let at = |i: usize| 2.0 * i as f32 / (SIDE - 1) as f32 - 1.0;
    let points: Vec<[f32; 3]> = (0..SIDE * SIDE)
        .map(|v| [at(v % SIDE), at(v / SIDE)])
        .map(|[x, y]| [x, y, 0.4 * (x * x + y * y)])
        .collect();
    let mut triangles = Vec::new();
    for v in (0..SIDE * (SIDE - 1))
        .filter(|v| v % SIDE + 1 < SIDE)
        .map(|v| v as u32)
    {
        let above = v + SIDE as u32;
        triangles.extend([[v, v + 1, above + 1], [v, above + 1, above]]);
    }
    let texture: Vec<f32> = points
        .iter()
        .flat_map(|&[x, y, _]| [if is_mirrored { x.abs() } else { 2.0 * x }, -y])
        .collect();
    let mut builder = Builder::new();
    let position = builder.points(&points);
    let turned = builder.points(
        &points
            .iter()
            .map(|&[x, y, _]| [-y - x, x - y, 0.0])
            .collect::<Vec<_>>(),
    );
    let (texture, indices) = (builder.floats(&texture, 2), builder.indices(&triangles));
    let along = builder.floats(&[1.0, 0.0, 0.0, 1.0].repeat(points.len()), 4);
    let none = builder.points(&vec![[0.0; 3]; points.len()]);
    let mut attributes = json!({"POSITION": position, "NORMAL": none, "TANGENT": along});
    if has_texture {
        attributes["TEXCOORD_1"] = texture.into();
    }
    builder.primitive(
        json!({"attributes": attributes, "indices": indices, "material": 0,
        "targets": [{"POSITION": turned, "NORMAL": none, "TANGENT": none}]}),
    );
    let map = json!({"index": 0, "texCoord": 7, "extensions": {"KHR_texture_transform": {"texCoord": 1}}});
    builder.json["materials"] = json!([{"normalTexture": map}]);
    let input = folder.path().join("in.glb");
    builder.write(&input);
    input
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    a.map(|x| x / dot(a, a).sqrt())
}

/// Which ways a triangle runs where u grows and v stays, and where v falls and u stays: from its edges alone.
fn ways(points: [[f64; 3]; 3], places: [[f64; 2]; 3]) -> [[f64; 3]; 2] {
    let [e, f] = [1, 2].map(|i| [0, 1, 2].map(|k| points[i][k] - points[0][k]));
    let [[a, c], [b, d]] = [1, 2].map(|i| [0, 1].map(|k| places[i][k] - places[0][k]));
    let area = a * d - b * c;
    let along = [0, 1, 2].map(|k| (d * e[k] - c * f[k]) / area);
    let up = [0, 1, 2].map(|k| (b * e[k] - a * f[k]) / area);
    [unit(along), unit(up)]
}

/// The worst cosines of tangents and bitangents with the ways of their triangles, of the mesh with so much of its target.
fn worst(glb: &Glb, weight: f64) -> [f64; 2] {
    let primitive = glb.primitive(0);
    let blended = |name: &str| -> Vec<[f64; 3]> {
        let own = glb.numbers(&primitive["attributes"][name]);
        let width = if name == "TANGENT" { 4 } else { 3 };
        let added = glb.points(&primitive["targets"][0][name]);
        let rows = own.chunks(width).zip(added);
        rows.map(|(x, d)| [0, 1, 2].map(|i| x[i] + weight * d[i]))
            .collect()
    };
    let (points, normals, tangents) = (blended("POSITION"), blended("NORMAL"), blended("TANGENT"));
    let signs: Vec<f64> = glb
        .numbers(&primitive["attributes"]["TANGENT"])
        .chunks(4)
        .map(|tangent| tangent[3])
        .collect();
    let places = glb.numbers(&primitive["attributes"]["TEXCOORD_1"]);
    let mut found = [1.0f64; 2];
    for corners in glb.triangles(0) {
        let corners = corners.map(|v| v as usize);
        let ways = ways(
            corners.map(|v| points[v]),
            corners.map(|v| [places[2 * v], places[2 * v + 1]]),
        );
        for v in corners {
            assert!(
                (dot(tangents[v], tangents[v]) - 1.0).abs() < 1e-5,
                "{:?}",
                tangents[v]
            );
            assert!(
                dot(tangents[v], normals[v]).abs() < 1e-5,
                "a tangent stands on the surface"
            );
            let bitangent = cross(normals[v], tangents[v]).map(|x| signs[v] * x);
            found = [
                found[0].min(dot(tangents[v], ways[0])),
                found[1].min(dot(bitangent, ways[1])),
            ];
        }
    }
    found
}

#[test]
fn tangents_run_along_the_texture_also_of_morphs() {
    let folder = folder();
    let (input, output) = (bowl(&folder, false, true), folder.path().join("out.glb"));
    let run = run(
        "refine {} -o {} --tolerance 0.05% --uv none",
        &[&input, &output],
    )
    .expect(0);
    assert!(!run.stderr.contains("TANGENT"), "{}", run.stderr);
    let glb = Glb::read(&output);
    for weight in [0.0, 1.0] {
        let worst = worst(&glb, weight).map(|cosine| cosine.acos().to_degrees());
        // Ways across a slanted surface are not at right angles to each other; MikkTSpace's are to the normal alone.
        assert!(worst[0] < 12.0 && worst[1] < 25.0, "{worst:?} degrees");
    }
}

/// Where a texture is mirrored, vertices are divided: both halves have their own tangents and their own sense.
#[test]
fn mirrored_halves_have_their_own_tangents() {
    let folder = folder();
    let (input, output) = (bowl(&folder, true, true), folder.path().join("out.glb"));
    run(
        "refine {} -o {} --tolerance 0.05% --uv none",
        &[&input, &output],
    )
    .expect(0);
    let glb = Glb::read(&output);
    let worst = worst(&glb, 0.0).map(|cosine| cosine.acos().to_degrees());
    assert!(worst[0] < 12.0 && worst[1] < 25.0, "{worst:?} degrees");
    let primitive = glb.primitive(0);
    let tangents = glb.numbers(&primitive["attributes"]["TANGENT"]);
    let points = glb.points(&primitive["attributes"]["POSITION"]);
    for (point, tangent) in points.iter().zip(tangents.chunks(4)) {
        let is_on_seam = point[0].abs() < 1e-6;
        assert!(
            is_on_seam || tangent[3] == point[0].signum(),
            "{point:?}: {tangent:?}"
        );
    }
    let on_seam = points.iter().filter(|point| point[0].abs() < 1e-6).count();
    let places: std::collections::BTreeSet<[u64; 3]> =
        points.iter().map(|p| p.map(f64::to_bits)).collect();
    assert_eq!(
        points.len() - places.len(),
        on_seam / 2,
        "no others are divided"
    );
    assert!(on_seam > 8);
}

#[test]
fn tangents_without_their_texture_coordinates_are_left_out_and_told() {
    let folder = folder();
    let (input, output) = (bowl(&folder, false, false), folder.path().join("out.glb"));
    run("refine {} -o {} --tolerance 0.2%", &[&input, &output])
        .expect(0)
        .saying("TANGENT (there is no TEXCOORD_1 that it could follow)")
        .saying("TANGENT of morph targets");
    let glb = Glb::read(&output);
    let attributes = &glb.primitive(0)["attributes"];
    assert!(attributes.get("TANGENT").is_none(), "{attributes}");
}

/// What another program wrote for a cube whose sides stay flat is what is found for it: directions and senses.
#[test]
fn another_program_s_tangents_are_found_again() {
    let Some(models) = std::env::var_os("LIMITMESH_MODELS") else {
        println!("skipped: LIMITMESH_MODELS names no folder");
        return;
    };
    let folder = folder();
    let input = PathBuf::from(models).join("assets").join("cubevc.glb");
    let output = folder.path().join("out.glb");
    run(
        "refine {} -o {} --tolerance 0.5% --crease-angle 30",
        &[&input, &output],
    )
    .expect(0);
    let sides = |glb: &Glb| {
        let attributes = &glb.primitive(0)["attributes"];
        let rounded = |x: &f64| (100.0 * x).round() as i64;
        let (normals, tangents) = (
            glb.numbers(&attributes["NORMAL"]),
            glb.numbers(&attributes["TANGENT"]),
        );
        let pairs = normals.chunks(3).zip(tangents.chunks(4));
        let pairs = pairs.map(|(normal, tangent)| {
            normal
                .iter()
                .chain(tangent)
                .map(rounded)
                .collect::<Vec<i64>>()
        });
        pairs.collect::<std::collections::BTreeSet<_>>()
    };
    let [theirs, ours] = [&input, &output].map(|path| sides(&Glb::read(path)));
    assert_eq!(theirs.len(), 6);
    assert_eq!(theirs, ours);
}

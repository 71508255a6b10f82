//! Tangents of glTF assets: along the texture on every triangle, whatever the program found them by.

use std::path::PathBuf;

use serde_json::json;
use tempfile::TempDir;

use crate::common::{done, folder};
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

#[test]
fn tangents_without_their_texture_coordinates_are_left_out_and_told() {
    let folder = folder();
    let (input, output) = (bowl(&folder, false, false), folder.path().join("out.glb"));
    done("refine {} -o {} --tolerance 0.2%", &[&input, &output])
        .saying("TANGENT (there is no TEXCOORD_1 that it could follow)")
        .saying("TANGENT of morph targets");
    let glb = Glb::read(&output);
    let attributes = &glb.primitive(0)["attributes"];
    assert!(attributes.get("TANGENT").is_none(), "{attributes}");
}

/// The tangents that another program wrote for a cube with flat sides are found again: directions and senses.
#[test]
fn another_program_s_tangents_are_found_again() {
    let Some(models) = std::env::var_os("LIMITMESH_MODELS") else {
        println!("skipped: LIMITMESH_MODELS names no folder");
        return;
    };
    let folder = folder();
    let input = PathBuf::from(models).join("assets").join("cubevc.glb");
    let output = folder.path().join("out.glb");
    done(
        "refine {} -o {} --tolerance 0.5% --crease-angle 30",
        &[&input, &output],
    );
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

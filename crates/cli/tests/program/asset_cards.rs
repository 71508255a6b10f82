//! Cards of glTF assets, whose front and back are triangles at one place: each side is refined as if alone.

use std::path::Path;

use limitmesh::Triangles;
use serde_json::json;

use crate::common::{data, folder, run};
use crate::glb::{Builder, Glb, distances, limit};

/// Triangles of a primitive, and the corners' positions and normals.
struct Side {
    positions: Vec<[f64; 3]>,
    normals: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

fn side(glb: &Glb, primitive: usize) -> Side {
    let attributes = &glb.primitive(primitive)["attributes"];
    Side {
        positions: glb.points(&attributes["POSITION"]),
        normals: glb.points(&attributes["NORMAL"]),
        triangles: glb.triangles(primitive),
    }
}

/// Twice the vector area of a triangle.
fn area(positions: &[[f64; 3]], triangle: [u32; 3]) -> [f64; 3] {
    let [a, b, c] = triangle.map(|v| positions[v as usize]);
    let [u, v] = [b, c].map(|p| [0, 1, 2].map(|i| p[i] - a[i]));
    [0, 1, 2].map(|i| u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3])
}

/// Checks that triangles stand for the limit of the card's front, which its back has, too.
#[track_caller]
fn is_limit_of_front(positions: &[[f64; 3]], triangles: &[[u32; 3]]) {
    let front = Glb::read(&data("card_two_materials.glb"));
    let control = front.points(&front.primitive(0)["attributes"]["POSITION"]);
    let reference = limit(&control, &front.triangles(0), 1e-4);
    let both = distances(
        Triangles {
            positions,
            triangles,
        },
        reference.as_triangles(),
    );
    // 1 % of the card's diagonal.
    assert!(both.iter().all(|&distance| distance < 0.0284), "{both:?}");
}

#[test]
fn sides_of_two_materials_are_refined_as_if_alone() {
    let folder = folder();
    let (input, output) = (
        data("card_two_materials.glb"),
        folder.path().join("out.glb"),
    );
    run("refine {} -o {} --tolerance 1%", &[&input, &output])
        .expect(0)
        .saying("8 faces are the backs of others: both sides are kept");
    let glb = Glb::read(&output);
    for (primitive, up) in [(0, 1.0), (1, -1.0)] {
        let own = side(&glb, primitive);
        assert_eq!(own.triangles.len(), 56);
        is_limit_of_front(&own.positions, &own.triangles);
        assert!(
            own.triangles
                .iter()
                .all(|&t| up * area(&own.positions, t)[2] > 0.0)
        );
        assert!(own.normals.iter().all(|n| up * n[2] > 0.0));
    }
}

#[test]
fn sides_of_one_primitive_keep_their_own_texture() {
    let folder = folder();
    let (input, output) = (
        data("card_one_primitive.glb"),
        folder.path().join("out.glb"),
    );
    run("refine {} -o {} --tolerance 1%", &[&input, &output]).expect(0);
    let glb = Glb::read(&output);
    let own = side(&glb, 0);
    let texture = glb.numbers(&glb.primitive(0)["attributes"]["TEXCOORD_0"]);
    let (front, back): (Vec<[u32; 3]>, Vec<[u32; 3]>) = own
        .triangles
        .iter()
        .partition(|&&t| area(&own.positions, t)[2] > 0.0);
    for (triangles, up, texture_from) in [(front, 1.0, 0.0), (back, -1.0, 0.5)] {
        assert_eq!(triangles.len(), 56);
        is_limit_of_front(&own.positions, &triangles);
        for &v in triangles.as_flattened() {
            assert!(up * own.normals[v as usize][2] > 0.0);
            let u = texture[2 * v as usize] - texture_from;
            assert!((-1e-6..=0.5 + 1e-6).contains(&u), "u of the other side");
        }
    }
}

/// A strip of squares along x, cut along one diagonal or the other, seen from above or from below.
fn strip(along: std::ops::Range<u32>, other_diagonal: bool, from_below: bool) -> Vec<[u32; 3]> {
    let squares = along.map(|x| [x, x + 1, x + 8, x + 7]);
    let halves = squares.flat_map(|[a, b, c, d]| {
        if other_diagonal {
            [[a, b, d], [b, c, d]]
        } else {
            [[a, b, c], [a, c, d]]
        }
    });
    halves
        .map(|[a, b, c]| if from_below { [b, a, c] } else { [a, b, c] })
        .collect()
}

/// Writes an asset of some primitives over the same vertices, 7 along x and 2 along y.
fn write(path: &Path, primitives: &[Vec<[u32; 3]>]) {
    let mut builder = Builder::new();
    let points: Vec<[f32; 3]> = (0..14u8)
        .map(|v| [f32::from(v % 7), f32::from(v / 7), 0.0])
        .collect();
    let position = builder.points(&points);
    for triangles in primitives {
        let indices = builder.indices(triangles);
        builder.primitive(json!({"attributes": {"POSITION": position}, "indices": indices}));
    }
    builder.write(path);
}

#[test]
fn a_sheet_with_a_back_on_a_part_of_it_stays_whole() {
    let folder = folder();
    let (input, output) = (folder.path().join("in.glb"), folder.path().join("out.glb"));
    let refined = |primitives: &[Vec<[u32; 3]>]| {
        write(&input, primitives);
        let run = run(
            "refine {} -o {} --tolerance 0.03 --report -",
            &[&input, &output],
        )
        .expect(0);
        let open = &run.json()["meshes"][0]["output"]["boundary_edges"];
        (
            open.as_u64().expect("a number"),
            run.stderr.contains("4 faces are the backs"),
            area_of(&output),
        )
    };
    let whole = strip(0..6, false, false);
    let (border, _, alone) = refined(std::slice::from_ref(&whole));
    let (small_border, _, small) = refined(&[strip(2..4, false, false)]);
    for other_diagonal in [false, true] {
        let back = strip(2..4, other_diagonal, true);
        let together = [whole.clone(), back.clone()].concat();
        // In one primitive over the same vertices, the back first, and in two.
        let backwards = [back.clone(), whole.clone()].concat();
        for primitives in [vec![together], vec![backwards], vec![whole.clone(), back]] {
            let (open, is_told, area) = refined(&primitives);
            assert!(is_told);
            if !other_diagonal {
                assert_eq!(open, border + small_border);
            }
            assert!(
                (area - alone - small).abs() < 0.01 * alone,
                "{area} of {alone} and {small}"
            );
        }
    }
}

/// The area of all that was written.
fn area_of(path: &Path) -> f64 {
    let glb = Glb::read(path);
    let count = glb.json["meshes"][0]["primitives"]
        .as_array()
        .expect("primitives")
        .len();
    let sides = (0..count).map(|primitive| side(&glb, primitive));
    sides
        .map(|own| {
            let areas = own.triangles.iter().map(|&t| area(&own.positions, t));
            areas
                .map(|n| 0.5 * n.iter().map(|x| x * x).sum::<f64>().sqrt())
                .sum::<f64>()
        })
        .sum()
}

#[test]
fn what_encloses_something_stays_closed() {
    let folder = folder();
    let (input, output) = (folder.path().join("in.glb"), folder.path().join("out.glb"));
    let closed = |builder: Builder| {
        builder.write(&input);
        let run = run(
            "refine {} -o {} --tolerance 5% --report -",
            &[&input, &output],
        )
        .expect(0);
        assert_eq!(
            run.json()["meshes"][0]["output"]["boundary_edges"],
            0,
            "{}",
            run.stderr
        );
    };
    // A low pyramid: the vertices of its base are all among those of its sides.
    let mut builder = Builder::new();
    let base = [
        [-1.0, -1.0, 0.0],
        [1.0, -1.0, 0.0],
        [1.0, 1.0, 0.0],
        [-1.0, 1.0, 0.0f32],
    ];
    let points = [&base[..], &[[0.0, 0.0, 0.05]]].concat();
    let position = builder.points(&points);
    for triangles in [
        &[[0, 2, 1], [0, 3, 2]][..],
        &[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
    ] {
        let indices = builder.indices(triangles);
        builder.primitive(json!({"attributes": {"POSITION": position}, "indices": indices}));
    }
    closed(builder);
    // A pouch, flat at rest, that a morph target blows up.
    let mut builder = Builder::new();
    let points = [&base[..], &[[0.0; 3], [0.0; 3]]].concat();
    let (position, indices) = (
        builder.points(&points),
        builder.indices(&[
            [0, 1, 4],
            [1, 2, 4],
            [2, 3, 4],
            [3, 0, 4],
            [1, 0, 5],
            [2, 1, 5],
            [3, 2, 5],
            [0, 3, 5],
        ]),
    );
    let blown = [&[[0.0; 3]; 4][..], &[[0.0, 0.0, 1.0], [0.0, 0.0, -1.0f32]]].concat();
    let blown = builder.points(&blown);
    builder.primitive(
        json!({"attributes": {"POSITION": position}, "indices": indices,
        "targets": [{"POSITION": blown}]}),
    );
    closed(builder);
}

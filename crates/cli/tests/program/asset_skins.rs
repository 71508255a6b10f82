//! Skins of glTF assets: weights are as smooth as the surface, and poses of the refined mesh are smooth, too.

use std::collections::HashMap;
use std::f64::consts::{PI, TAU};
use std::path::PathBuf;

use limitmesh::Triangles;
use serde_json::json;
use tempfile::TempDir;

use crate::common::{folder, run};
use crate::glb::{Builder, Glb, distances, limit};

const AROUND: u32 = 8;
const ROWS: u32 = 9;

/// A tube along z from −2 to 2: positions, and triangles.
fn tube() -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for row in 0..ROWS {
        for i in 0..AROUND {
            let angle = TAU * f64::from(i) / f64::from(AROUND);
            let z = 4.0 * f64::from(row) / f64::from(ROWS - 1) - 2.0;
            points.push([0.25 * angle.cos(), 0.25 * angle.sin(), z].map(|x| x as f32));
            if row > 0 {
                let next = (i + 1) % AROUND;
                let [a, b] = [row - 1, row].map(|row| row * AROUND);
                triangles.extend([[a + i, a + next, b + next], [a + i, b + next, b + i]]);
            }
        }
    }
    (points, triangles)
}

/// The tube with joints' weights by height; `_LINEAR` has the first four as values that are linear on each face.
fn asset(folder: &TempDir, weights: impl Fn(f64) -> Vec<(u8, f64)>) -> PathBuf {
    let (points, triangles) = tube();
    let mut builder = Builder::new();
    let (position, indices) = (builder.points(&points), builder.indices(&triangles));
    let lists: Vec<Vec<(u8, f64)>> = points.iter().map(|p| weights(f64::from(p[2]))).collect();
    let numbers = |at: usize| {
        let joints: Vec<[u8; 4]> = lists
            .iter()
            .map(|list| {
                std::array::from_fn(|i| list.get(4 * at + i).map_or(0, |&(joint, _)| joint))
            })
            .collect();
        let weights = lists.iter().flat_map(|list| {
            std::array::from_fn::<f32, 4, _>(|i| {
                list.get(4 * at + i)
                    .map_or(0.0, |&(_, weight)| weight as f32)
            })
        });
        (joints, weights.collect::<Vec<f32>>())
    };
    let dense = |joint: u8| {
        move |list: &Vec<(u8, f64)>| {
            list.iter()
                .filter(|own| own.0 == joint)
                .map(|own| own.1 as f32)
                .sum::<f32>()
        }
    };
    let linear: Vec<f32> = lists
        .iter()
        .flat_map(|list| [0, 1, 2, 3].map(|joint| dense(joint)(list)))
        .collect();
    let mut attributes = json!({"POSITION": position, "_LINEAR": builder.floats(&linear, 4)});
    for set in 0..2 {
        let (joints, weights) = numbers(set);
        attributes[format!("JOINTS_{set}")] = builder.joints(&joints).into();
        attributes[format!("WEIGHTS_{set}")] = builder.floats(&weights, 4).into();
    }
    builder.primitive(json!({"attributes": attributes, "indices": indices}));
    builder.json["nodes"] = json!([{"mesh": 0, "skin": 0}, {}, {}, {}, {}, {}, {}]);
    builder.json["skins"] = json!([{"joints": [1, 2, 3, 4, 5, 6]}]);
    let input = folder.path().join("in.glb");
    builder.write(&input);
    input
}

/// By vertex of what was written, its joints and their weights.
fn influences(glb: &Glb) -> Vec<Vec<(u8, f64)>> {
    let attributes = &glb.primitive(0)["attributes"];
    assert!(attributes.get("JOINTS_1").is_none());
    let (joints, weights) = (
        glb.numbers(&attributes["JOINTS_0"]),
        glb.numbers(&attributes["WEIGHTS_0"]),
    );
    let pairs = joints
        .iter()
        .zip(weights)
        .map(|(&joint, weight)| (joint as u8, weight));
    let all: Vec<(u8, f64)> = pairs.collect();
    all.chunks(4).map(<[_]>::to_vec).collect()
}

/// Where joints put a point: the first leaves it, the second turns it by 90° about the x-axis.
fn posed([x, y, z]: [f64; 3], weights: [f64; 2]) -> [f64; 3] {
    [
        weights[0] * x + weights[1] * x,
        weights[0] * y - weights[1] * z,
        weights[0] * z + weights[1] * y,
    ]
}

/// The greatest angle between the normals of triangles at an edge, in degrees.
fn worst_dihedral(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> f64 {
    let mut normals: HashMap<[u32; 2], [f64; 3]> = HashMap::new();
    let mut worst = 1.0f64;
    for corners in triangles {
        let [a, b, c] = corners.map(|v| positions[v as usize]);
        let [u, v] = [b, c].map(|p| [0, 1, 2].map(|i| p[i] - a[i]));
        let normal =
            [0, 1, 2].map(|i| u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3]);
        let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
        let normal = normal.map(|x| x / length);
        for i in 0..3 {
            let edge = [corners[i], corners[(i + 1) % 3]];
            if let Some(other) = normals.get(&[edge[1], edge[0]]) {
                worst = worst.min((0..3).map(|i| other[i] * normal[i]).sum());
            }
            normals.insert(edge, normal);
        }
    }
    worst.clamp(-1.0, 1.0).acos() * 180.0 / PI
}

#[test]
fn weights_that_are_linear_in_space_stay_so() {
    // Masks keep affine functions, so that what is one of the control points' height is the same one of the limit's.
    let folder = folder();
    let input = asset(&folder, |z| vec![(0, 0.5 - 0.2 * z), (2, 0.5 + 0.2 * z)]);
    let output = folder.path().join("out.glb");
    for options in [
        "",
        "--scheme loop-warren",
        "--crease-angle 40",
        "--boundary corners",
        "--crease-angle 95",
    ] {
        run(
            &format!("refine {{}} -o {{}} --tolerance 0.5% {options}"),
            &[&input, &output],
        )
        .expect(0);
        let glb = Glb::read(&output);
        let points = glb.points(&glb.primitive(0)["attributes"]["POSITION"]);
        for (p, list) in points.iter().zip(influences(&glb)) {
            let of = |joint: u8| {
                list.iter()
                    .filter(|own| own.0 == joint)
                    .map(|own| own.1)
                    .sum::<f64>()
            };
            assert!(
                (of(0) - (0.5 - 0.2 * p[2])).abs() < 1e-6
                    && (of(2) - (0.5 + 0.2 * p[2])).abs() < 1e-6
            );
        }
    }
}

#[test]
fn a_bent_tube_is_smooth() {
    let folder = folder();
    let weight = |z: f64| {
        if z < -0.1 {
            0.0
        } else if z > 0.1 {
            1.0
        } else {
            0.5
        }
    };
    let input = asset(&folder, |z| vec![(0, 1.0 - weight(z)), (1, weight(z))]);
    let output = folder.path().join("out.glb");
    run(
        "refine {} -o {} --tolerance 0.002% --crease-angle none",
        &[&input, &output],
    )
    .expect(0);
    let glb = Glb::read(&output);
    let attributes = &glb.primitive(0)["attributes"];
    let (points, triangles) = (glb.points(&attributes["POSITION"]), glb.triangles(0));
    let smooth: Vec<[f64; 3]> = points
        .iter()
        .zip(influences(&glb))
        .map(|(&p, list)| {
            let of = |joint: u8| {
                list.iter()
                    .filter(|own| own.0 == joint)
                    .map(|own| own.1)
                    .sum()
            };
            posed(p, [of(0), of(1)])
        })
        .collect();
    let linear = glb.numbers(&attributes["_LINEAR"]);
    let linear: Vec<[f64; 3]> = points
        .iter()
        .zip(linear.chunks(4))
        .map(|(&p, w)| posed(p, [w[0], w[1]]))
        .collect();
    let (smooth_angle, linear_angle) = (
        worst_dihedral(&smooth, &triangles),
        worst_dihedral(&linear, &triangles),
    );
    println!("worst dihedral angles: {smooth_angle:.1}° smooth, {linear_angle:.1}° linear");
    assert!(
        smooth_angle < 0.5 * linear_angle,
        "{smooth_angle}° and {linear_angle}°"
    );

    // Beside the limit of the control mesh in that pose: the same where one joint alone moves it. Where two do, products of limits are
    // near the limit of products alone.
    let (control, faces) = tube();
    let control: Vec<[f64; 3]> = control
        .iter()
        .map(|p| p.map(f64::from))
        .map(|p| posed(p, [1.0 - weight(p[2]), weight(p[2])]))
        .collect();
    let reference = limit(&control, &faces, 1e-4);
    let surface = Triangles {
        positions: &smooth,
        triangles: &triangles,
    };
    let found = distances(surface, reference.as_triangles());
    println!("to the limit of the posed control mesh: {found:?}");
    let bounds = |points: &[[f64; 3]]| {
        [f64::min, f64::max].map(|of: fn(f64, f64) -> f64| {
            [0, 1, 2].map(|i| points.iter().map(|p| p[i]).reduce(of).expect("points"))
        })
    };
    let (own, expected) = (bounds(&smooth), bounds(reference.positions()));
    for (own, expected) in own.as_flattened().iter().zip(expected.as_flattened()) {
        assert!(
            (own - expected).abs() < 0.01 * reference.diagonal(),
            "{own} and {expected}"
        );
    }
    assert!(
        found
            .iter()
            .all(|&distance| distance < 0.05 * reference.diagonal()),
        "{found:?}"
    );
    let far: Vec<[f64; 3]> = smooth
        .iter()
        .zip(&points)
        .filter(|(_, p)| p[2].abs() > 1.1)
        .map(|(&p, _)| p)
        .collect();
    let off = limitmesh::measure::distances_to(&far, reference.as_triangles()).expect("distances");
    assert!(off.into_iter().fold(0.0, f64::max) < 2e-4 * reference.diagonal());
}

#[test]
fn the_four_greatest_weights_are_kept() {
    let folder = folder();
    // Six joints everywhere, in two sets.
    let input = asset(&folder, |z| {
        let all = [1.0, 2.0 + z, 3.0, 4.0 - z, 5.0, 6.0 + z];
        let total: f64 = all.iter().sum();
        all.iter()
            .zip(0..)
            .map(|(weight, joint)| (joint, weight / total))
            .collect()
    });
    let output = folder.path().join("out.glb");
    run("refine {} -o {} --tolerance 1%", &[&input, &output])
        .expect(0)
        .saying("4 joints move a vertex at most");
    let glb = Glb::read(&output);
    let points = glb.points(&glb.primitive(0)["attributes"]["POSITION"]);
    for (p, list) in points.iter().zip(influences(&glb)) {
        assert!((list.iter().map(|own| own.1).sum::<f64>() - 1.0).abs() < 1e-6);
        assert!(list.windows(2).all(|pair| pair[0].1 >= pair[1].1));
        // Well inside, the weights are those of the height there, as they are nearly linear: the two least are left out.
        let mut all = [1.0, 2.0 + p[2], 3.0, 4.0 - p[2], 5.0, 6.0 + p[2]]
            .into_iter()
            .zip(0u8..)
            .collect::<Vec<_>>();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        if all[3].0 - all[4].0 > 0.1 {
            let mut kept: Vec<u8> = all[..4].iter().map(|own| own.1).collect();
            let mut found: Vec<u8> = list.iter().map(|own| own.0).collect();
            kept.sort_unstable();
            found.sort_unstable();
            assert_eq!(found, kept, "at height {}", p[2]);
        }
    }
}

#[test]
fn weights_below_0_are_counted() {
    let folder = folder();
    let input = asset(&folder, |z| {
        vec![
            (0, f64::from(u8::from(z < 0.0))),
            (1, f64::from(u8::from(z >= 0.0))),
        ]
    });
    let output = folder.path().join("out.glb");
    let loops = run(
        "refine {} -o {} --tolerance 0.05% --crease-angle none",
        &[&input, &output],
    )
    .expect(0);
    assert!(!loops.stderr.contains("below 0"), "{}", loops.stderr);
    let command = "refine {} -o {} --tolerance 0.05% --scheme butterfly --crease-angle none";
    run(command, &[&input, &output])
        .expect(0)
        .saying("weights below 0 count as 0 at");
    assert!(
        influences(&Glb::read(&output))
            .iter()
            .flatten()
            .all(|&(_, weight)| (0.0..=1.0).contains(&weight))
    );
}

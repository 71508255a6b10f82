//! Skins of glTF assets: weights are as smooth as the surface, and poses of the refined mesh are smooth, too.

use std::f64::consts::TAU;
use std::path::PathBuf;

use serde_json::json;
use tempfile::TempDir;

use crate::common::{done, folder};
use crate::glb::{Builder, Glb};

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
        let line = format!("refine {{}} -o {{}} --tolerance 0.5% {options}");
        done(&line, &[&input, &output]);
        let glb = Glb::read(&output);
        let points = glb.points(&glb.primitive(0)["attributes"]["POSITION"]);
        for (p, list) in points.iter().zip(influences(&glb)) {
            let of = |joint: u8| {
                list.iter()
                    .filter(|own| own.0 == joint)
                    .map(|own| own.1)
                    .sum::<f64>()
            };
            below!((of(0) - (0.5 - 0.2 * p[2])).abs(), 1e-6);
            below!((of(2) - (0.5 + 0.2 * p[2])).abs(), 1e-6);
        }
    }
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
    done("refine {} -o {} --tolerance 1%", &[&input, &output])
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

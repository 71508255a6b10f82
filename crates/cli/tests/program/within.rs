//! `--within`: the smoothest result near the input, in every format, against the ball that voxels were made of and the distance to their
//! squares.

use std::collections::HashMap;
use std::fmt::Write;
use std::path::Path;

use crate::common::{done, file, folder, json_of, number, run, soup, usage_error};

/// Squares of voxels, by their low and high corners.
type Square = [[f64; 3]; 2];

/// The ball of voxels of size 1 and a radius, as OFF, and its squares.
fn ball(radius: i32) -> (String, Vec<Square>) {
    let is_inside = |p: [i32; 3]| p.iter().map(|x| x * x).sum::<i32>() <= radius * radius;
    let (mut numbers, mut corners): (HashMap<[i32; 3], usize>, _) = (HashMap::new(), Vec::new());
    let (mut faces, mut squares) = (Vec::new(), Vec::new());
    let range = || -radius..=radius;
    for point in range().flat_map(|x| range().flat_map(move |y| range().map(move |z| [x, y, z]))) {
        for (axis, side) in (0..3).flat_map(|axis| [(axis, -1), (axis, 1)]) {
            let mut beyond = point;
            beyond[axis] += side;
            if !is_inside(point) || is_inside(beyond) {
                continue;
            }
            let face = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(|[u, v]| {
                let mut twice = point.map(|x| 2 * x);
                twice[axis] += side;
                twice[(axis + 1) % 3] += u;
                twice[(axis + 2) % 3] += v * side;
                *numbers.entry(twice).or_insert_with(|| {
                    corners.push(twice.map(|x| 0.5 * f64::from(x)));
                    corners.len() - 1
                })
            });
            let own = face.map(|corner| corners[corner]);
            let end = |pick: fn(f64, f64) -> f64| {
                own.into_iter()
                    .reduce(|a, b| [0, 1, 2].map(|i| pick(a[i], b[i])))
                    .expect("corners")
            };
            squares.push([end(f64::min), end(f64::max)]);
            faces.push(face);
        }
    }
    let mut text = format!("OFF\n{} {} 0\n", corners.len(), faces.len());
    corners
        .iter()
        .for_each(|[x, y, z]| writeln!(text, "{x} {y} {z}").expect("text"));
    faces
        .iter()
        .for_each(|[a, b, c, d]| writeln!(text, "4 {a} {b} {c} {d}").expect("text"));
    (text, squares)
}

/// The greatest distance of vertices from the nearest square.
fn distance(positions: &[[f64; 3]], squares: &[Square]) -> f64 {
    let to = |p: [f64; 3], [low, high]: &Square| {
        (0..3)
            .map(|i| (low[i] - p[i]).max(p[i] - high[i]).max(0.0).powi(2))
            .sum::<f64>()
    };
    let nearest = |&p: &[f64; 3]| {
        squares
            .iter()
            .map(|own| to(p, own))
            .fold(f64::INFINITY, f64::min)
            .sqrt()
    };
    positions.iter().map(nearest).fold(0.0, f64::max)
}

/// Standard deviation of the distances from the origin.
fn deviation(positions: &[[f64; 3]]) -> f64 {
    let radii: Vec<f64> = positions
        .iter()
        .map(|p| p.iter().map(|x| x * x).sum::<f64>().sqrt())
        .collect();
    let mean = radii.iter().sum::<f64>() / radii.len() as f64;
    (radii.iter().map(|r| (r - mean).powi(2)).sum::<f64>() / radii.len() as f64).sqrt()
}

#[test]
fn voxels_become_round_within_the_distance_in_every_format() {
    let folder = folder();
    let (text, squares) = ball(10);
    let input = file(&folder, "ball.off", &text);
    for name in ["round.ply", "round.stl", "round.obj", "round.off"] {
        let output = folder.path().join(name);
        let run = done(
            "refine {} -o {} --within 0.87mm --unit mm --report -",
            &[&input, &output],
        );
        let report = run.json();
        assert_eq!(report["parameters"]["within"], 0.87);
        let found = &report["input_distance"];
        let ends = ["lower", "upper"].map(|end| number(&found[end]));
        assert!(ends[0] <= ends[1] && ends[1] <= 0.87, "{name}: {found}");
        let positions = soup(&output).positions;
        let farthest = distance(&positions, &squares);
        at_most!(farthest, ends[1], "{name}");
        at_most!(deviation(&positions), 0.07, "{name}");
        let size = &report["size"];
        let volumes = ["before", "after"].map(|when| number(&size[when]["volume"]));
        assert!(
            (volumes[1] / volumes[0] - 1.0).abs() < 0.01,
            "{name}: {volumes:?}"
        );
        says!(run.stderr, "mm) of the input, either way, certified");
    }
    let output = folder.path().join("percent.ply");
    let report = json_of("refine {} -o {} --within 4% --report -", &[&input, &output]);
    let within = number(&report["parameters"]["within"]);
    let diagonal = number(&report["error"]["diagonal"]);
    assert!(
        (within / diagonal - 0.04).abs() < 1e-12,
        "{within} of {diagonal}"
    );
    assert!(distance(&soup(&output).positions, &squares) <= within);
}

#[test]
fn what_cannot_be_smooth_stays_sharp_and_what_cannot_be_kept_ends_with_3() {
    let folder = folder();
    let input = file(&folder, "ball.off", &ball(3).0);
    let output = folder.path().join("out.ply");
    // A tiny distance neither takes many triangles nor is it missed.
    done(
        "refine {} -o {} --within 1e-7 --max-triangles 20k --strict",
        &[&input, &output],
    )
    .saying("edges stay sharp");
    // A box of twelve triangles has no smooth surface so near.
    let corners: String = (0..8)
        .map(|c| {
            format!(
                "v {} {} {}\n",
                40 * (c & 1),
                20 * (c >> 1 & 1),
                5 * (c >> 2)
            )
        })
        .collect();
    let sides = "f 1 3 4\nf 1 4 2\nf 5 6 8\nf 5 8 7\nf 1 2 6\nf 1 6 5\nf 3 7 8\nf 3 8 4\nf 1 5 7\nf 1 7 3\nf 2 4 8\nf 2 8 6\n";
    let box_of_twelve = file(&folder, "box.obj", &(corners + sides));
    done("refine {} -o {} --within 0.04", &[&box_of_twelve, &output]).saying("12 edges stay sharp");
    let positions = soup(&output).positions;
    let is_on_box = |p: &[f64; 3]| {
        let beyond = [40.0, 20.0, 5.0]
            .iter()
            .zip(p)
            .map(|(size, x)| (-x).max(x - size));
        beyond.fold(f64::MIN, f64::max).abs() <= 0.04
    };
    assert!(positions.len() >= 8 && positions.iter().all(is_on_box));
    // With few triangles it is not near, either.
    run(
        "refine {} -o {} --within 0.5 --max-triangles 300",
        &[&input, &output],
    )
    .expect(3);
}

#[test]
fn what_does_not_go_with_it_is_refused() {
    let output = Path::new("out.ply");
    for options in [
        "--tolerance 1",
        "--interpolate",
        "--interpolate=1",
        "--method uniform",
        "--method planarity",
        "--scheme sqrt3",
        "--scheme butterfly",
    ] {
        let line = format!("refine builtin:cup -o {{}} --within 1 {options}");
        usage_error(&line, &[output], "--within");
    }
    for length in ["0", "-1", "nonsense", "0%", "101%"] {
        let line = format!("refine builtin:cup -o {{}} --within {length}");
        run(&line, &[output]).expect(2);
    }
}

//! `evaluate`: the limit surface itself, at places.

use crate::common::{OCTAHEDRON, done, file, folder, json_of, list, number, refuses};

#[track_caller]
fn near(found: &serde_json::Value, expected: f64) {
    let found = number(found);
    assert!((found - expected).abs() < 1e-9, "{found} and {expected}");
}

/// Rational values follow by hand from Loop's masks; the others from a computation that shares no code with this.
#[test]
fn places_of_an_octahedron() {
    let folder = folder();
    let control = file(&folder, "octahedron.obj", OCTAHEDRON);
    let places = file(
        &folder,
        "places.txt",
        "\u{feff}# an edge's middle, a face's centre\n4 0.5 0.5 0\n\n7,0.3333333333333333, 0.3333333333333333 0.3333333333333334\n",
    );
    let command = "evaluate {} --at 0,0.5,0.3,0.2 --at 0,1,0,0 --at {} --json";
    let found = json_of(command, &[&control, &places]);
    let [place, corner, edge, centre] = list(&found) else {
        panic!("{found}")
    };
    assert_eq!(
        (&place["face"], &place["barycentric"][1]),
        (&0.into(), &0.3.into())
    );
    for (axis, expected) in [0.32634375, 0.20559375, 0.144].into_iter().enumerate() {
        near(&place["point"][axis], expected);
    }
    // The limit of a vertex of valence 4, which has no curvature.
    near(&corner["point"][0], 24.0 / 55.0);
    near(&corner["normal"][0], 1.0);
    assert!(corner["curvature"].is_null() && corner["derivatives"].is_null());
    // By symmetry the surface leaves it along the axes, first towards the face's next corner.
    for (tangent, expected) in [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].into_iter().enumerate() {
        (0..3).for_each(|axis| near(&corner["tangents"][tangent][axis], expected[axis]));
    }
    // Elsewhere they are the directions of the derivatives.
    for (tangent, name) in ["u", "v"].into_iter().enumerate() {
        let by: Vec<f64> = (0..3)
            .filter_map(|axis| place["derivatives"][name][axis].as_f64())
            .collect();
        let length = by.iter().map(|x| x * x).sum::<f64>().sqrt();
        (0..3).for_each(|axis| near(&place["tangents"][tangent][axis], by[axis] / length));
    }
    for (found, [gaussian, mean]) in [
        (edge, [5.983379501385, -2.531187639857]),
        (centre, [3.848001180091, -1.961632274431]),
    ] {
        near(&found["curvature"]["gaussian"], gaussian);
        near(&found["curvature"]["mean"], mean);
        let [most, least] = [0, 1].map(|i| number(&found["curvature"]["principal"][i]));
        assert!(most >= least && (most * least - gaussian).abs() < 1e-9);
    }
    let text = done("evaluate {} --at 0,0.5,0.3,0.2", &[&control]).stdout;
    says!(text, "0.326");
    says!(text, "Gaussian");
}

#[test]
fn sharp_edges_have_a_normal_on_each_side() {
    // The middle of an edge of a cube, seen from both of its faces.
    let cube = "evaluate builtin:cube --crease-angle 30 --json --at";
    let mut normals = Vec::new();
    for face in 0..12 {
        let found = json_of(&format!("{cube} {face},0.25,0.25,0.5"), &[]);
        let normal: Vec<f64> = list(&found[0]["normal"])
            .iter()
            .filter_map(|x| x.as_f64())
            .collect();
        assert_eq!(
            normal.iter().filter(|x| x.abs() > 1.0 - 1e-12).count(),
            1,
            "{normal:?}"
        );
        near(&found[0]["curvature"]["gaussian"], 0.0);
        normals.push(normal);
    }
    normals.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    normals.dedup_by(|a, b| a.iter().zip(&**b).all(|(a, b)| (a - b).abs() < 1e-9));
    assert_eq!(normals.len(), 6);
}

#[test]
fn places_that_are_none_are_errors() {
    let folder = folder();
    let control = file(&folder, "octahedron.obj", OCTAHEDRON);
    let bad = file(&folder, "bad.txt", "0 1 0 0\n1 0.5 0.5\n");
    let empty = file(&folder, "empty.txt", "# nothing\n");
    refuses(
        &[("control", &control), ("bad", &bad), ("empty", &empty)],
        "
        1 | evaluate {control} --at 8,1,0,0 | no face 8: the control mesh has 8 triangles
        2 | evaluate {control} --at 0,0.5,0.5,0.5 | '0,0.5,0.5,0.5': the weights add up to 1.5 rather than 1
        2 | evaluate {control} --at 0,0.333,0.333,0.333 | add up to 0.999
        2 | evaluate {control} --at 0,1.5,-0.5,0 | the weight -0.5 is below 0
        2 | evaluate {control} --at 0,1,0 | 2 of three weights
        1 | evaluate {control} --at {bad} | line 2: '1 0.5 0.5' has 2 of three weights
        1 | evaluate {control} --at {empty} | no places
        1 | evaluate {control} --at 0,1,0,x | '0,1,0,x' is no place
        1 | evaluate {control} --at nowhere.txt | nowhere.txt
        2 | evaluate {control} | --at",
    );
}

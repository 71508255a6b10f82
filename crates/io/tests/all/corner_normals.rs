//! Normals by corner: OBJ holds them, other formats leave them out, and what does not fit is refused.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail as the tests do")]

use limitmesh::mesh::Triangles;
use limitmesh_io::{Format, Output, WriteError, WriteOptions, write_to};

/// Two triangles that share an edge, folded by a right angle.
const FOLDED: Triangles<'_> = Triangles {
    positions: &[
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, -1.0],
    ],
    triangles: &[[0, 1, 2], [1, 0, 3]],
};

const NORMALS: [[f64; 3]; 2] = [[0.0, 0.0, 1.0], [0.0, -1.0, 0.0]];

const CORNERS: [[u32; 3]; 2] = [[0; 3], [1; 3]];

fn written(format: Format, output: &Output<'_>) -> Result<String, WriteError> {
    let mut bytes = Vec::new();
    write_to(
        &mut bytes,
        format,
        output,
        &WriteOptions::default().ascii(true),
    )?;
    Ok(String::from_utf8(bytes).unwrap())
}

#[test]
fn each_corner_names_its_normal() {
    let output = Output::new(FOLDED).normals_of_corners(&NORMALS, &CORNERS);
    let text = written(Format::Obj, &output).unwrap();
    let lines: Vec<&str> = text
        .lines()
        .filter(|line| !line.starts_with("v "))
        .collect();
    assert_eq!(
        lines,
        [
            "vn 0 0 1",
            "vn 0 -1 0",
            "f 1//1 2//1 3//1",
            "f 2//2 1//2 4//2"
        ]
    );
    let plain = Output::new(FOLDED);
    for format in [Format::Ply, Format::Off, Format::Stl] {
        assert_eq!(
            written(format, &output).unwrap(),
            written(format, &plain).unwrap()
        );
    }
}

#[test]
fn corners_without_a_normal_are_refused() {
    let refused = |corners: &[[u32; 3]]| {
        written(
            Format::Obj,
            &Output::new(FOLDED).normals_of_corners(&NORMALS, corners),
        )
        .unwrap_err()
        .to_string()
    };
    assert_eq!(
        refused(&CORNERS[..1]),
        "there are 1 corner normals for 2 triangles: each needs one"
    );
    assert_eq!(
        refused(&[[0; 3], [0, 2, 0]]),
        "triangle 1 names normal 2, but there are 2"
    );
}

//! Normals by corner: OBJ holds them, other formats leave them out, and what does not fit is refused.

use super::support::{output, text, unwritten};
use limitmesh_io::Format;

/// Two triangles that share an edge, folded by a right angle.
const POSITIONS: [[f64; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]];
const TRIANGLES: [[u32; 3]; 2] = [[0, 1, 2], [1, 0, 3]];

const NORMALS: [[f64; 3]; 2] = [[0.0, 0.0, 1.0], [0.0, -1.0, 0.0]];
const CORNERS: [[u32; 3]; 2] = [[0; 3], [1; 3]];

#[test]
fn each_corner_names_its_normal() {
    let plain = output(&POSITIONS, &TRIANGLES);
    let own = plain.normals_of_corners(&NORMALS, &CORNERS);
    let file = text(Format::Obj, &own);
    let lines: Vec<&str> = file
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
    for format in [Format::Ply, Format::Off, Format::Stl] {
        assert_eq!(text(format, &own), text(format, &plain));
    }
}

#[test]
fn corners_without_a_normal_are_refused() {
    for (corners, message) in [
        (
            &CORNERS[..1],
            "there are 1 corner normals for 2 triangles: each needs one",
        ),
        (
            &[[0; 3], [0, 2, 0]],
            "triangle 1 names normal 2, but there are 2",
        ),
    ] {
        let own = output(&POSITIONS, &TRIANGLES).normals_of_corners(&NORMALS, corners);
        assert_eq!(unwritten(Format::Obj, &own), message);
    }
}

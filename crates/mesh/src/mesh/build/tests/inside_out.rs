//! Closed components that are inside out, and those that only look so.

use super::*;
use crate::vector::{DVec3, vector};

/// A cube from one corner to the opposite one, and whether its normals point inwards.
type Cube = (f64, f64, bool);

fn cubes(cubes: &[Cube]) -> PolygonSoup {
    let mut soup = PolygonSoup::default();
    for &(low, high, points_inwards) in cubes {
        let first = soup.positions.len() as u32;
        let side = |bit: u32| if bit == 0 { low } else { high };
        soup.positions
            .extend((0..8u32).map(|c| [side(c & 1), side(c >> 1 & 1), side(c >> 2)]));
        for mut face in [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ] {
            if points_inwards {
                face.reverse();
            }
            soup.faces.push(&face.map(|corner| first + corner));
        }
    }
    soup
}

/// Whether the normals of each cube point inwards: a face of it whose normal leads to its middle.
fn inwards(mesh: &Mesh, cubes: &[Cube]) -> Vec<bool> {
    let point_inwards = |(at, &(low, high, _)): (usize, &Cube)| {
        let face = mesh.triangles()[12 * at];
        let [a, b, c] = face.map(|v| vector(mesh.positions()[v as usize]));
        let middle = DVec3::splat(0.5 * (low + high));
        (b - a).cross(c - a).dot(middle - a) > 0.0
    };
    cubes.iter().enumerate().map(point_inwards).collect()
}

#[test]
fn components_are_turned_with_what_is_in_them_but_cavities_stay() {
    let cases: [(&[Cube], &[bool], &[u32]); 7] = [
        (&[(0.0, 1.0, false)], &[false], &[]),
        (&[(0.0, 1.0, true)], &[false], &[0]),
        // A cavity, and the whole part mirrored.
        (&[(0.0, 4.0, false), (1.0, 2.0, true)], &[false, true], &[]),
        (
            &[(1.0, 2.0, false), (0.0, 4.0, true)],
            &[true, false],
            &[0, 6],
        ),
        // Apart.
        (
            &[(0.0, 1.0, false), (2.0, 3.0, true), (4.0, 5.0, true)],
            &[false; 3],
            &[6, 12],
        ),
        // A body in a cavity.
        (
            &[(0.0, 9.0, false), (1.0, 8.0, true), (2.0, 3.0, true)],
            &[false, true, false],
            &[12],
        ),
        // Two bodies, one in the other, are no defect.
        (
            &[(0.0, 9.0, false), (1.0, 8.0, false)],
            &[false, false],
            &[],
        ),
    ];
    for (parts, expected, named) in cases {
        let soup = cubes(parts);
        let (mesh, diagnosis) = build_soup(&soup);
        assert_eq!(inwards(&mesh, parts), expected, "{parts:?}");
        assert_eq!(diagnosis.inside_out_components, finding(named), "{parts:?}");
        assert_eq!(diagnosis.is_clean(), named.is_empty());
        let strict = Mesh::from_soup(&soup, &BuildOptions::default().strict(true));
        assert_eq!(strict.is_ok(), named.is_empty());
        let (kept, _) =
            Mesh::from_soup(&soup, &BuildOptions::default().keep_windings(true)).unwrap();
        let asked: Vec<bool> = parts.iter().map(|part| part.2).collect();
        assert_eq!(inwards(&kept, parts), asked);
    }
}

#[test]
fn what_encloses_nothing_is_left_as_it_is() {
    // A square of two triangles and its back.
    let positions = [
        [0.0, 0.0, 0.1],
        [1.0, 0.0, 0.1],
        [1.0, 1.0, 0.1],
        [0.0, 1.0, 0.1],
    ];
    let (_, diagnosis) = build_soup(&soup(
        &positions,
        &[&[0, 1, 2], &[0, 2, 3], &[0, 2, 1], &[0, 3, 2]],
    ));
    assert!(diagnosis.inside_out_components.is_empty());
    // An open box.
    let mut open = cubes(&[(0.0, 1.0, true)]);
    open.faces = (0..5)
        .map(|face| open.faces.get(face).to_vec())
        .collect::<Vec<_>>()
        .iter()
        .map(Vec::as_slice)
        .collect();
    assert!(build_soup(&open).1.inside_out_components.is_empty());
}

#[test]
fn corners_and_tags_follow_what_is_turned() {
    let mut soup = cubes(&[(0.0, 1.0, true)]);
    soup.creases.push(CreaseTag {
        vertices: [0, 1],
        sharpness: 2.0,
    });
    let (mesh, _, trace) = Mesh::from_soup_traced(&soup, &BuildOptions::default()).unwrap();
    assert_eq!(mesh.tags().creases.len(), 1);
    let corners: Vec<u32> = soup.faces.iter().flatten().copied().collect();
    for (&corner, &v) in trace.corners.iter().zip(mesh.triangles().as_flattened()) {
        assert_eq!(
            soup.positions[corners[corner as usize] as usize],
            mesh.positions()[v as usize]
        );
    }
}

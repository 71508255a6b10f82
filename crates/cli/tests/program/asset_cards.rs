//! Cards of glTF assets, whose front and back are triangles at one place: each side is refined as if alone.

use limitmesh::Triangles;

use crate::common::{data, done, folder};
use crate::glb::{Glb, distances, limit};

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

/// Checks that triangles approximate the limit of the card's front, which its back has, too.
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
    done("refine {} -o {} --tolerance 1%", &[&input, &output])
        .saying("8 faces are the backs of others: both sides are kept");
    let glb = Glb::read(&output);
    for (primitive, up) in [(0, 1.0), (1, -1.0)] {
        let own = side(&glb, primitive);
        assert_eq!(own.triangles.len(), 40);
        is_limit_of_front(&own.positions, &own.triangles);
        assert!(
            own.triangles
                .iter()
                .all(|&t| up * area(&own.positions, t)[2] > 0.0)
        );
        assert!(own.normals.iter().all(|n| up * n[2] > 0.0));
    }
}

//! Control meshes: closed, open, with creases that end, cross and close.

use limitmesh::Mesh;
use limitmesh::mesh::{BuildOptions, CornerTag, PolygonSoup, Tags};

use crate::support::{Point, crease, lumpy, octahedron, sheet, torus};

pub(crate) fn tetrahedron() -> Mesh {
    let corners = vec![
        [1.0, 1.0, 1.0],
        [1.0, -1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
    ];
    Mesh::from_triangles(corners, vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]).unwrap()
}

/// Unit radius.
pub(crate) fn icosahedron() -> Mesh {
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let length = (1.0 + golden * golden).sqrt();
    let mut positions: Vec<Point> = Vec::new();
    for (a, b) in [
        (1.0, golden),
        (-1.0, golden),
        (1.0, -golden),
        (-1.0, -golden),
    ] {
        positions.extend([[0.0, a, b], [a, b, 0.0], [b, 0.0, a]].map(|p| p.map(|x| x / length)));
    }
    let near = |i: usize, j: usize| {
        let d: f64 = (0..3)
            .map(|k| (positions[i][k] - positions[j][k]).powi(2))
            .sum();
        i != j && d < 1.2
    };
    let mut triangles = Vec::new();
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if near(i, j) && near(j, k) && near(k, i) {
                    let [a, b, c] = [i, j, k].map(|v| positions[v]);
                    let outside = a[0] * (b[1] * c[2] - b[2] * c[1])
                        + a[1] * (b[2] * c[0] - b[0] * c[2])
                        + a[2] * (b[0] * c[1] - b[1] * c[0]);
                    let [i, j, k] = [i, j, k].map(|v| v as u32);
                    triangles.push(if outside > 0.0 { [i, j, k] } else { [i, k, j] });
                }
            }
        }
    }
    Mesh::from_triangles(positions, triangles).unwrap()
}

/// One triangle: all its faces of even levels have boundaries.
pub(crate) fn single() -> Mesh {
    let corners = vec![[0.0, 0.0, 0.0], [3.0, 0.5, 0.2], [0.7, 2.0, -0.4]];
    Mesh::from_triangles(corners, vec![[0, 1, 2]]).unwrap()
}

pub(crate) fn creased(mesh: Mesh, edges: &[[u32; 2]], corners: &[u32]) -> Mesh {
    let sharpness = f64::INFINITY;
    let creases = edges
        .iter()
        .map(|&vertices| crease(vertices, sharpness))
        .collect();
    let corners = corners
        .iter()
        .map(|&vertex| CornerTag { vertex, sharpness })
        .collect();
    mesh.with_tags(Tags { creases, corners }).unwrap()
}

/// Meshes without sharp edges but boundaries.
pub(crate) fn smooth() -> Vec<(&'static str, Mesh)> {
    vec![
        ("tetrahedron", tetrahedron()),
        ("octahedron", octahedron()),
        ("icosahedron", icosahedron()),
        ("torus", torus(5, 4)),
        ("lumpy", lumpy(12, 7)),
        ("sheet", sheet(3, 3, 3)),
        ("strip", sheet(1, 4, 5)),
        ("single", single()),
    ]
}

/// Meshes with creases: round a closed curve, ending inside, crossing, ending at a boundary; with corners.
pub(crate) fn sharp() -> Vec<(&'static str, Mesh)> {
    let equator = [[0, 2], [2, 1], [1, 3], [3, 0]];
    let sheet = || sheet(4, 4, 3);
    vec![
        ("equator", creased(octahedron(), &equator, &[])),
        ("dart", creased(octahedron(), &[[0, 2], [2, 1]], &[])),
        ("one edge", creased(octahedron(), &[[0, 2]], &[])),
        (
            "crossing",
            creased(octahedron(), &[[0, 2], [2, 1], [4, 2], [2, 5]], &[]),
        ),
        ("tip", creased(octahedron(), &[], &[4])),
        (
            "corners",
            creased(sheet(), &[[11, 12], [12, 13], [13, 14]], &[0, 12, 20]),
        ),
        (
            "boundary",
            creased(sheet(), &[[10, 11], [11, 12], [12, 17]], &[2]),
        ),
    ]
}

/// Three sheets that meet in one edge, cut apart.
pub(crate) fn junction() -> Mesh {
    let positions = vec![
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, 2.0],
        [1.0, 0.0, 0.3],
        [1.0, 0.1, 1.4],
        [-0.5, 0.9, 0.4],
        [-0.6, 0.8, 1.5],
        [-0.5, -0.9, 0.2],
        [-0.4, -0.8, 1.6],
    ];
    let faces = vec![
        vec![0, 3, 1],
        vec![1, 3, 4],
        vec![1, 4, 2],
        vec![0, 5, 1],
        vec![1, 5, 6],
        vec![1, 6, 2],
        vec![0, 7, 1],
        vec![1, 7, 8],
        vec![1, 8, 2],
    ];
    let faces = faces.iter().map(|face| &face[..]).collect();
    let soup = PolygonSoup {
        positions,
        faces,
        ..PolygonSoup::default()
    };
    let (mesh, _) = Mesh::from_soup(&soup, &BuildOptions::default()).unwrap();
    assert!(!mesh.junctions().is_empty());
    mesh
}

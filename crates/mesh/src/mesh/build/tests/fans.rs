//! Polygons as fans: nothing but the polygons themselves can coincide, and findings name the input's faces.

use super::*;

fn fans_of(soup: &PolygonSoup) -> (Fans, Diagnosis) {
    let (fans, diagnosis) = Mesh::fans_from_soup(soup, &BuildOptions::default()).unwrap();
    check_mesh(&fans.mesh);
    (fans, diagnosis)
}

/// The polygons of fans, from the lowest corner on, in the soup's numbers.
fn polygons(fans: &Fans, soup: &PolygonSoup) -> Vec<Vec<u32>> {
    let topology = fans.mesh.topology();
    let vertices = fans.trace.vertices(soup);
    let mut found: Vec<Vec<u32>> = (fans.centres.clone())
        .map(|centre| {
            let first = fans
                .side(topology.outgoing(VertexId(centre)).face())
                .unwrap();
            let sides: Vec<HalfEdgeId> = fans.sides(first).collect();
            assert_eq!(sides.len(), topology.ring(VertexId(centre)).count());
            let mut own: Vec<u32> = sides.iter().map(|h| vertices[h.index()]).collect();
            let lowest = (0..own.len()).min_by_key(|&at| own[at]).unwrap();
            own.rotate_left(lowest);
            own
        })
        .collect();
    found.sort_unstable();
    found
}

const SQUARE: [[f64; 3]; 4] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
];

#[test]
fn polygons_that_share_two_edges_both_stay() {
    let positions = [&SQUARE[..], &[[0.5, 0.5, 1.0]]].concat();
    let cage = soup(&positions, &[&[0, 1, 2, 3], &[2, 1, 0, 4]]);
    let (fans, diagnosis) = fans_of(&cage);
    assert_eq!(found(&diagnosis), []);
    assert_eq!(polygons(&fans, &cage), [[0, 1, 2, 3], [0, 4, 2, 1]]);
    assert_eq!(fans.trace.faces, [0, 0, 0, 0, 1, 1, 1, 1]);
    assert_eq!(fans.mesh.positions()[5], [0.5, 0.5, 0.0]);
}

#[test]
fn repeated_and_collapsed_polygons_are_named() {
    let faces: [&[u32]; 6] = [
        &[0, 1, 2, 3],
        &[2, 1, 0, 3],
        &[0, 2, 0, 2],
        &[3, 0, 1, 2],
        &[0, 2, 1, 3],
        &[1, 1],
    ];
    let cage = soup(&SQUARE, &faces);
    let (fans, diagnosis) = fans_of(&cage);
    assert_eq!(diagnosis.repeated_faces, finding(&[1, 3]));
    assert_eq!(diagnosis.collapsed_faces, finding(&[2, 5]));
    assert_eq!(fans.trace.faces, [0, 0, 0, 0, 4, 4, 4, 4]);
}

#[test]
fn polygons_without_area_stay_and_those_that_visit_a_vertex_twice_are_cut() {
    let line: Vec<[f64; 3]> = (0..4).map(|x| [f64::from(x), 0.0, 0.0]).collect();
    let cage = soup(&line, &[&[0, 1, 3, 2]]);
    let (fans, diagnosis) = fans_of(&cage);
    assert_eq!(found(&diagnosis), []);
    assert_eq!(polygons(&fans, &cage), [[0, 1, 3, 2]]);
    let positions = [&SQUARE[..], &[[2.0, 0.0, 0.0], [2.0, 1.0, 0.0]]].concat();
    let pinched = soup(&positions, &[&[0, 1, 2, 4, 5, 2, 3]]);
    let (fans, diagnosis) = fans_of(&pinched);
    assert_eq!(diagnosis.polygons, finding(&[0]));
    assert_eq!(polygons(&fans, &pinched), [[0, 1, 3], [1, 2, 3], [2, 4, 5]]);
    assert_eq!(diagnosis.bow_tie_vertices, finding(&[2]));
    assert!(fans.trace.faces.iter().all(|&face| face == 0));
}

#[test]
fn orientation_and_edges_of_many_faces_are_told_in_the_input_s_faces() {
    let positions = [&SQUARE[..], &[[2.0, 0.0, 0.0], [2.0, 1.0, 0.0]]].concat();
    let (_, diagnosis) = fans_of(&soup(&positions, &[&[0, 1, 2, 3], &[1, 2, 5, 4]]));
    assert_eq!(found(&diagnosis), [("flipped_faces", finding(&[1]))]);
    let fin = [&positions[..], &[[1.0, 0.0, 1.0], [1.0, 1.0, 1.0]]].concat();
    let mut cage = soup(&fin, &[&[0, 1, 2, 3], &[1, 4, 5, 2], &[1, 2, 7, 6]]);
    cage.creases = vec![CreaseTag {
        vertices: [2, 1],
        sharpness: 2.0,
    }];
    let (fans, diagnosis) = fans_of(&cage);
    assert_eq!(diagnosis.non_manifold_edges, finding(&[1]));
    assert_eq!(diagnosis.dropped_tags, finding(&[]));
    assert_eq!(fans.mesh.junctions().edges.len(), 1);
    // A crease along a diagonal is one of no polygon.
    let mut cage = soup(&SQUARE, &[&[0, 1, 2, 3]]);
    cage.creases = vec![CreaseTag {
        vertices: [0, 2],
        sharpness: 2.0,
    }];
    assert_eq!(fans_of(&cage).1.dropped_tags, finding(&[0]));
}

//! Edges with more than two faces, bow-ties, one-sided components.

use super::*;

fn groups(groups: &crate::mesh::Groups) -> Vec<Vec<u32>> {
    groups.iter().map(<[u32]>::to_vec).collect()
}

fn fixed(mesh: &Mesh) -> Vec<u32> {
    mesh.tags()
        .corners
        .iter()
        .filter(|tag| tag.sharpness == f64::INFINITY)
        .map(|tag| tag.vertex)
        .collect()
}

#[test]
fn three_pages_on_one_edge() {
    let p = [
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0],
        [-1.0, 1.0, 0.0],
        [-1.0, -1.0, 0.0],
    ];
    let (mesh, diagnosis) = build_soup(&soup(&p, &[&[0, 1, 2], &[0, 1, 3], &[1, 0, 4]]));
    assert_eq!(found(&diagnosis), [("non_manifold_edges", finding(&[0]))]);
    assert_eq!(mesh.vertex_count(), 9);
    assert_eq!(mesh.topology().euler_characteristic(), 3);
    assert_eq!(mesh.junctions().edges.len(), 1);
    assert_eq!(groups(&mesh.junctions().edges), [[0, 3, 6]]);
    // Each copy's other boundary neighbour is another one: all stay where they are.
    assert_eq!(mesh.junctions().vertices.len(), 2);
    assert_eq!(fixed(&mesh).len(), 6);
}

/// The inner vertices of the line along which the fin stands move with the cut; its ends stay.
#[test]
fn a_fin_on_a_sheet() {
    // A sheet of 7 by 3 vertices; the fin is on the middle row from column 1 to column 5.
    let (columns, rows) = (7u32, 3u32);
    let mut p: Vec<[f64; 3]> = Vec::new();
    for y in 0..rows {
        for x in 0..columns {
            p.push([f64::from(x), f64::from(y), 0.0]);
        }
    }
    let at = |x: u32, y: u32| y * columns + x;
    let mut faces: Vec<Vec<u32>> = Vec::new();
    for y in 0..rows - 1 {
        for x in 0..columns - 1 {
            faces.push(vec![at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)]);
        }
    }
    let fin: Vec<u32> = (1..6).map(|x| at(x, 1)).collect();
    let top = p.len() as u32;
    p.extend((1..6).map(|x| [f64::from(x), 1.0, 1.0]));
    for i in 0..4 {
        faces.push(vec![fin[i], fin[i + 1], top + i as u32 + 1, top + i as u32]);
    }
    let faces: Vec<&[u32]> = faces.iter().map(Vec::as_slice).collect();
    let (mesh, diagnosis) = build_soup(&soup(&p, &faces));
    assert_eq!(diagnosis.non_manifold_edges, finding(&[8, 9, 10, 11]));
    assert!(diagnosis.bow_tie_vertices.is_empty());
    assert_eq!(mesh.face_count(), 2 * faces.len());
    assert_eq!(mesh.junctions().edges.len(), 4);
    assert!(mesh.junctions().edges.iter().all(|group| group.len() == 3));
    // The ends of the slit have two copies, sheet and fin; between them sheet, sheet and fin.
    let mut sizes: Vec<(u32, usize)> = mesh
        .junctions()
        .vertices
        .iter()
        .map(|g| (g[0], g.len()))
        .collect();
    sizes.sort_unstable();
    assert_eq!(sizes, [(8, 2), (9, 3), (10, 3), (11, 3), (12, 2)]);
    // Only the ends must be held.
    let ends: Vec<u32> = mesh
        .junctions()
        .vertices
        .iter()
        .filter(|g| g.len() == 2)
        .flatten()
        .copied()
        .collect();
    let mut ends_sorted = ends.clone();
    ends_sorted.sort_unstable();
    assert_eq!(fixed(&mesh), ends_sorted);
}

#[test]
fn a_fin_on_one_edge_of_a_closed_surface() {
    // An octahedron and a triangle on the edge 0-2: the slit's ends both lie inside the octahedron.
    let mut p = vec![
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
    ];
    p.push([2.0, 2.0, 0.0]);
    let faces: [&[u32]; 9] = [
        &[0, 2, 4],
        &[2, 1, 4],
        &[1, 3, 4],
        &[3, 0, 4],
        &[2, 0, 5],
        &[1, 2, 5],
        &[3, 1, 5],
        &[0, 3, 5],
        &[0, 2, 6],
    ];
    let mut tagged = soup(&p, &faces);
    tagged.creases = vec![CreaseTag {
        vertices: [2, 0],
        sharpness: 4.0,
    }];
    let (mesh, diagnosis) = build_soup(&tagged);
    assert_eq!(found(&diagnosis), [("non_manifold_edges", finding(&[0]))]);
    // Each of the three faces along the edge is split in its middle.
    assert_eq!(mesh.face_count(), 12);
    let middles: Vec<usize> = (0..mesh.vertex_count())
        .filter(|&v| mesh.positions()[v] == [0.5, 0.5, 0.0])
        .collect();
    assert_eq!(middles.len(), 3);
    assert_eq!(
        groups(&mesh.junctions().edges)
            .iter()
            .map(Vec::len)
            .collect::<Vec<_>>(),
        [3, 3]
    );
    // The middles move alike along the edge; its ends are held.
    assert!(
        middles
            .iter()
            .all(|&v| !mesh.tags().is_corner(VertexId(v as u32)))
    );
    assert_eq!(fixed(&mesh).len(), 4);
    // The slit makes the octahedron a disc; the fin is another.
    assert_eq!(mesh.topology().euler_characteristic(), 2);
    assert_eq!(mesh.tags().creases.len(), 6);
    assert!(mesh.tags().creases.iter().all(|tag| tag.sharpness == 4.0));
}

#[test]
fn two_tetrahedra_at_a_vertex() {
    let p = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [-1.0, 0.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, -1.0],
    ];
    let mut faces: Vec<&[u32]> = vec![&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]];
    faces.extend([&[0u32, 4, 5][..], &[0, 6, 4], &[4, 6, 5], &[5, 6, 0]]);
    let (mesh, diagnosis) = build_soup(&soup(&p, &faces));
    assert_eq!(found(&diagnosis), [("bow_tie_vertices", finding(&[0]))]);
    assert_eq!(mesh.vertex_count(), 8);
    assert_eq!(groups(&mesh.junctions().vertices), [[0, 7]]);
    assert!(mesh.junctions().edges.is_empty());
    assert_eq!(fixed(&mesh), [0, 7]);
    assert_eq!(mesh.topology().boundary_edge_count(), 0);
    assert_eq!(mesh.topology().euler_characteristic(), 4);
}

#[test]
fn a_moebius_strip_is_cut_once() {
    // The strip of five triangles on five vertices.
    let p: Vec<[f64; 3]> = (0..5)
        .map(|i| f64::from(i) * 0.4 * core::f64::consts::PI)
        .map(|t| [t.cos(), t.sin(), (2.0 * t).sin()])
        .collect();
    let faces: [&[u32]; 5] = [&[0, 1, 2], &[1, 2, 3], &[2, 3, 4], &[3, 4, 0], &[4, 0, 1]];
    let (mesh, diagnosis) = build_soup(&soup(&p, &faces));
    assert_eq!(diagnosis.non_orientable_faces.count, 2);
    assert!(diagnosis.non_manifold_edges.is_empty() && diagnosis.bow_tie_vertices.is_empty());
    assert_eq!(mesh.face_count(), 5);
    assert_eq!(mesh.topology().euler_characteristic(), 1);
    assert_eq!(mesh.vertex_count(), 7);
    assert_eq!(groups(&mesh.junctions().edges).len(), 1);
}

/// A square of two triangles, one of which shows its other side, next to a third that agrees with
/// the first.
#[test]
fn windings_that_count_are_kept_and_cut_apart() {
    let p = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
    ];
    let faces: [&[u32]; 3] = [&[0, 1, 2], &[0, 3, 2], &[0, 4, 1]];
    let options = BuildOptions::default().keep_windings(true);
    let (mesh, diagnosis) = Mesh::from_soup(&soup(&p, &faces), &options).unwrap();
    assert!(diagnosis.flipped_faces.is_empty());
    assert_eq!(diagnosis.non_orientable_faces, finding(&[0, 1]));
    let places = |face: usize| mesh.triangles()[face].map(|v| mesh.positions()[v as usize]);
    for (face, corners) in faces.iter().enumerate() {
        let mut corners: Vec<[f64; 3]> = corners.iter().map(|&v| p[v as usize]).collect();
        let first = corners
            .iter()
            .position(|&at| at == places(face)[0])
            .unwrap();
        corners.rotate_left(first);
        assert_eq!(corners, places(face));
    }
    // Both halves of the diagonal stay together when they are refined.
    assert_eq!(groups(&mesh.junctions().edges).len(), 1);
    let (turned, diagnosis) = build_soup(&soup(&p, &faces));
    assert_eq!(
        (
            diagnosis.flipped_faces.count,
            turned.junctions().edges.is_empty()
        ),
        (1, true)
    );
}

#[test]
fn tags_go_to_all_copies() {
    let p = [
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0],
        [-1.0, 1.0, 0.0],
        [-1.0, -1.0, 0.0],
    ];
    let mut pages = soup(&p, &[&[0, 1, 2], &[0, 1, 3], &[1, 0, 4]]);
    pages.creases.push(CreaseTag {
        vertices: [0, 1],
        sharpness: 3.0,
    });
    pages.corners.push(CornerTag {
        vertex: 1,
        sharpness: 2.0,
    });
    pages.corners.push(CornerTag {
        vertex: 2,
        sharpness: 2.0,
    });
    let (mesh, diagnosis) = build_soup(&pages);
    assert!(diagnosis.dropped_tags.is_empty());
    assert_eq!(mesh.tags().creases.len(), 3);
    // The copies are held at all levels, more than those of the tag; vertex 2 has only its own.
    assert_eq!(fixed(&mesh).len(), 6);
    let own: Vec<_> = mesh
        .tags()
        .corners
        .iter()
        .filter(|tag| tag.sharpness == 2.0)
        .collect();
    assert_eq!(
        own,
        [&CornerTag {
            vertex: 2,
            sharpness: 2.0
        }]
    );
}

#[test]
fn crowded_places_take_little_time() {
    let n = 200_000u32;
    let circle = |n: u32| (0..n).map(move |i| f64::from(i) / f64::from(n) * core::f64::consts::TAU);
    let rim: Vec<[f64; 3]> = circle(n).map(|t| [t.cos(), t.sin(), 0.0]).collect();
    // A vertex with many faces, all of whose edges are creased.
    let mut fan = PolygonSoup {
        positions: rim.clone(),
        ..PolygonSoup::default()
    };
    fan.positions.push([0.0, 0.0, 1.0]);
    for i in 0..n {
        fan.faces.push(&[i, (i + 1) % n, n]);
        fan.creases.push(CreaseTag {
            vertices: [n, i],
            sharpness: 1.0,
        });
    }
    let (mesh, diagnosis) = build_soup(&fan);
    assert!(diagnosis.is_clean());
    assert_eq!(mesh.tags().creases.len(), n as usize);
    // An edge with many faces.
    let mut book = PolygonSoup {
        positions: rim,
        ..PolygonSoup::default()
    };
    book.positions.extend([[0.0, 0.0, 1.0], [0.0, 0.0, 2.0]]);
    (0..n).for_each(|i| book.faces.push(&[i, n, n + 1]));
    let (mesh, diagnosis) = build_soup(&book);
    assert_eq!(diagnosis.non_manifold_edges, finding(&[n]));
    assert_eq!(mesh.vertex_count(), 3 * n as usize);
    // Many equal faces.
    let mut equal = soup(&book.positions[..3], &[]);
    (0..n).for_each(|i| {
        equal.faces.push(if i.is_multiple_of(2) {
            &[0, 1, 2]
        } else {
            &[0, 2, 1]
        })
    });
    assert_eq!(build_soup(&equal).1.repeated_faces.count, n as usize - 1);
}

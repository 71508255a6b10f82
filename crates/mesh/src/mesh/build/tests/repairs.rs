//! Errors, welding, and faces that are dropped or turned.

use super::*;
use limitmesh_testing::Random;

const TETRAHEDRON: [[f64; 3]; 4] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
];
const SIDES: [&[u32]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]];

#[test]
fn a_clean_mesh_is_left_as_it_is() {
    let (mesh, diagnosis) = build_soup(&soup(&TETRAHEDRON, &SIDES));
    assert_eq!(mesh.positions(), TETRAHEDRON);
    assert_eq!(mesh.triangles(), SIDES.map(|f| [f[0], f[1], f[2]]));
    assert!(mesh.junctions().is_empty() && mesh.tags().is_empty());
    assert!(diagnosis.is_clean() && found(&diagnosis).is_empty());
    assert_eq!((diagnosis.input_vertices, diagnosis.input_faces), (4, 4));
    assert_eq!(diagnosis.to_string(), "");
}

#[test]
fn bad_input_is_named() {
    let error =
        |soup: &PolygonSoup, options: BuildOptions| Mesh::from_soup(soup, &options).unwrap_err();
    let plain = BuildOptions::default();
    let mut faces = SIDES;
    faces[2] = &[1, 9, 3];
    assert_eq!(
        error(&soup(&TETRAHEDRON, &faces), plain),
        MeshError::VertexOutOfRange {
            face: 2,
            vertex: 9,
            count: 4
        }
    );
    for bad in [f64::INFINITY, f64::NEG_INFINITY] {
        let mut positions = TETRAHEDRON.to_vec();
        positions.push([0.0, 0.0, bad]);
        let expected = MeshError::NotFinite {
            vertex: 4,
            axis: 2,
            value: bad,
        };
        assert_eq!(error(&soup(&positions, &SIDES), plain), expected);
    }
    let mut positions = TETRAHEDRON;
    positions[1][1] = f64::NAN;
    let text = error(&soup(&positions, &SIDES), plain).to_string();
    assert_eq!(
        text,
        "coordinate y of vertex 1 is NaN, which is no finite number"
    );
    let text = error(&PolygonSoup::default(), plain).to_string();
    assert_eq!(text, "no face is left: the input has none");
    let text = error(&soup(&TETRAHEDRON, &[&[0, 1], &[2, 2, 3]]), plain).to_string();
    assert!(
        text.contains("2 faces with fewer than three different corners (face 0, 1)"),
        "{text}"
    );
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        let options = plain.weld(Weld::Within(bad));
        assert!(matches!(
            error(&soup(&TETRAHEDRON, &SIDES), options),
            MeshError::BadOption { .. }
        ));
    }
}

#[test]
fn faces_that_open_elsewhere_are_kept() {
    // An octahedron whose top vertex stands twice, as lips do, with two faces without area between.
    let mut positions: Vec<[f64; 3]> = Vec::new();
    for axis in 0..3 {
        positions.extend(
            [1.0, -1.0].map(|sign| std::array::from_fn(|i| if i == axis { sign } else { 0.0 })),
        );
    }
    positions.push([0.0, 0.0, 1.0]);
    let faces: [&[u32]; 10] = [
        &[0, 2, 4],
        &[2, 1, 4],
        &[1, 3, 6],
        &[3, 0, 6],
        &[2, 0, 5],
        &[1, 2, 5],
        &[3, 1, 5],
        &[0, 3, 5],
        &[0, 4, 6],
        &[4, 1, 6],
    ];
    let options = BuildOptions::default().weld(Weld::Never);
    let built = |opening: &[u32]| {
        let soup = PolygonSoup {
            opening: opening.to_vec(),
            ..soup(&positions, &faces)
        };
        let (mesh, diagnosis) = Mesh::from_soup(&soup, &options).unwrap();
        check_mesh(&mesh);
        (
            mesh.face_count(),
            mesh.topology().boundary_edge_count(),
            diagnosis.zero_area_faces,
        )
    };
    assert_eq!(built(&[8, 9]), (10, 0, Finding::default()));
    // One of them goes where nothing opens it.
    assert_eq!(built(&[8]).2, finding(&[9]));
    assert_eq!(built(&[]), (8, 0, finding(&[8, 9])));
}

#[test]
fn strict_refuses_defects_and_nothing_else() {
    let strict = BuildOptions::default().strict(true);
    let mut faces = SIDES.to_vec();
    faces.extend([&[0u32, 1, 2][..], &[3, 3, 1]]);
    let error = Mesh::from_soup(&soup(&TETRAHEDRON, &faces), &strict).unwrap_err();
    let summary =
        "1 face with fewer than three different corners (face 5); 1 face that repeats another (face 4)"
            .to_owned();
    assert_eq!(error, MeshError::NeedsRepair { summary });
    // Two quads that share a side by position alone.
    let p = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, -0.0, 0.0],
        [2.0, 0.0, 0.0],
        [2.0, 1.0, 0.0],
        [1.0, 1.0, -0.0],
    ];
    let quads = soup(&p, &[&[0, 1, 2, 3], &[4, 5, 6, 7]]);
    let (mesh, diagnosis) = Mesh::from_soup(&quads, &strict).unwrap();
    assert_eq!(mesh.vertex_count(), 6);
    assert_eq!(
        found(&diagnosis),
        [
            ("polygons", finding(&[0, 1])),
            ("welded_vertices", finding(&[4, 7]))
        ]
    );
    assert_eq!(
        diagnosis.to_string(),
        "2 faces with more than three corners: cut into triangles (face 0, 1)\n\
         2 vertices at the place of another: merged (vertex 4, 7)"
    );
}

#[test]
fn welding_reaches_as_far_as_asked() {
    // Three triangles side by side; the second's corners are 0.1 off, the third's 0.2 further.
    let p = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.1, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.1, 1.0, 0.0],
        [1.3, 0.0, 0.0],
        [2.0, 1.0, 0.0],
        [1.0, 1.05, 0.0],
    ];
    let triangles: [&[u32]; 3] = [&[0, 1, 2], &[3, 4, 5], &[6, 7, 8]];
    let welded = |weld: Weld| {
        let (mesh, diagnosis) =
            Mesh::from_soup(&soup(&p, &triangles), &BuildOptions::default().weld(weld)).unwrap();
        check_mesh(&mesh);
        diagnosis.welded_vertices
    };
    assert_eq!(welded(Weld::Never), finding(&[]));
    assert_eq!(welded(Weld::Exact), finding(&[]));
    assert_eq!(welded(Weld::Within(0.0)), finding(&[]));
    assert_eq!(welded(Weld::Within(0.07)), finding(&[8]));
    assert_eq!(welded(Weld::Within(0.11)), finding(&[3, 5, 8]));
    // 1 and 6 are 0.3 apart, with 3 between them.
    assert_eq!(welded(Weld::Within(0.21)), finding(&[3, 5, 6, 8]));
}

/// Welding against a comparison of all pairs.
#[test]
fn welding_finds_what_comparing_all_pairs_finds() {
    let mut random = Random::new(1);
    let mut next = || (random.bits() >> 40) as f64 / (1u64 << 24) as f64;
    let positions: Vec<[f64; 3]> = (0..400).map(|_| [next(), next(), next() * 0.2]).collect();
    let used = vec![true; positions.len()];
    for distance in [1e-300, 0.01, 0.03, 0.05, 0.08, 0.2, 3.0, 1e300] {
        let near = |a: usize, b: usize| {
            let d: f64 = (0..3)
                .map(|i| (positions[a][i] - positions[b][i]).powi(2))
                .sum();
            d.sqrt() <= distance
        };
        let mut expected = vec![u32::MAX; positions.len()];
        for v in 0..positions.len() {
            if expected[v] != u32::MAX {
                continue;
            }
            let mut left = vec![v];
            while let Some(u) = left.pop() {
                if expected[u] == u32::MAX {
                    expected[u] = v as u32;
                    left.extend(
                        (0..positions.len()).filter(|&w| expected[w] == u32::MAX && near(u, w)),
                    );
                }
            }
        }
        assert_eq!(
            weld::within(&positions, &used, distance).unwrap(),
            expected,
            "within {distance}"
        );
    }
}

#[test]
fn isolated_vertices_are_those_of_the_input() {
    let mut p = TETRAHEDRON.to_vec();
    p.insert(0, [9.0, 9.0, 9.0]);
    // A duplicate of a used vertex without a face, a vertex that only a collapsed face uses.
    p.extend([TETRAHEDRON[0], [7.0, 7.0, 7.0]]);
    let mut faces: Vec<Vec<u32>> = SIDES
        .iter()
        .map(|f| f.iter().map(|v| v + 1).collect())
        .collect();
    faces.push(vec![6, 6, 6]);
    let faces: Vec<&[u32]> = faces.iter().map(Vec::as_slice).collect();
    let (mesh, diagnosis) = build_soup(&soup(&p, &faces));
    assert_eq!(mesh.positions(), TETRAHEDRON);
    assert_eq!(
        found(&diagnosis),
        [
            ("collapsed_faces", finding(&[4])),
            ("isolated_vertices", finding(&[0, 5]))
        ]
    );
}

#[test]
fn repeated_faces_keep_the_first() {
    let mut faces = SIDES.to_vec();
    faces.splice(1..1, [&[2u32, 1, 0][..], &[0, 1, 2]]);
    let (mesh, diagnosis) = build_soup(&soup(&TETRAHEDRON, &faces));
    assert_eq!(mesh.triangles(), SIDES.map(|f| [f[0], f[1], f[2]]));
    assert_eq!(found(&diagnosis), [("repeated_faces", finding(&[1, 2]))]);
}

#[test]
fn zero_area_faces_go_without_a_slit() {
    // A closed tetrahedron; face 3's side of the edge from 0 to 1 has two more vertices, 4 and 5, and flat faces
    // 1 and 2 fill the slit between them and face 0's side.
    let mut p = TETRAHEDRON.to_vec();
    p.extend([[0.25, 0.0, 0.0], [0.5, 0.0, 0.0]]);
    let faces: [&[u32]; 8] = [
        &[0, 2, 1],
        &[0, 1, 5],
        &[0, 5, 4],
        &[0, 4, 3],
        &[4, 5, 3],
        &[5, 1, 3],
        &[1, 2, 3],
        &[2, 0, 3],
    ];
    let (mesh, diagnosis) = build_soup(&soup(&p, &faces));
    assert_eq!(found(&diagnosis), [("zero_area_faces", finding(&[1, 2]))]);
    assert_eq!(mesh.topology().boundary_edge_count(), 0);
    assert_eq!(mesh.topology().euler_characteristic(), 2);
    assert_eq!(mesh.vertex_count(), 6);
    assert_eq!(mesh.face_count(), 8);
    let twice_area = |face| {
        mesh.face_normal(crate::FaceId(face))
            .iter()
            .map(|x| x * x)
            .sum::<f64>()
            .sqrt()
    };
    let least = (0..8).map(twice_area).fold(1.0, f64::min);
    assert!(least > 1e-3, "a flat face is left");
}

#[test]
fn a_zero_area_face_on_a_boundary_is_dropped() {
    let p = [
        [0.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [2.0, 1.0, 0.0],
    ];
    let (mesh, diagnosis) = build_soup(&soup(&p, &[&[0, 1, 2], &[0, 2, 3], &[2, 1, 4]]));
    assert_eq!(diagnosis.zero_area_faces, finding(&[0]));
    assert_eq!(mesh.face_count(), 2);
    // Points on a line in a direction whose coordinates are not exact.
    let p = [
        [0.1, 0.2, 0.3],
        [0.4, 0.8, 1.2],
        [0.2, 0.4, 0.6],
        [1.0, 0.0, 0.0],
    ];
    let (_, diagnosis) = build_soup(&soup(&p, &[&[0, 1, 2], &[0, 2, 3]]));
    assert_eq!(diagnosis.zero_area_faces, finding(&[0]));
    // Thin but real: one part in 10¹².
    let p = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 1e-12, 0.0]];
    assert!(build_soup(&soup(&p, &[&[0, 1, 2]])).1.is_clean());
    // Large coordinates must not be taken for flat because products overflow.
    let p = [[0.0, 0.0, 0.0], [2e200, 0.0, 0.0], [1e200, 1e199, 0.0]];
    assert!(build_soup(&soup(&p, &[&[0, 1, 2]])).1.is_clean());
}

/// Flat triangles often fill T-junctions: closed in, closed out.
#[test]
fn closed_meshes_with_flat_strips_stay_closed() {
    // As above with n vertices, all triangles of the slit from one end.
    for n in [1u32, 2, 3, 10, 100] {
        let mut p = TETRAHEDRON.to_vec();
        p.extend((1..=n).map(|i| [f64::from(i) / f64::from(n + 1), 0.0, 0.0]));
        let chain: Vec<u32> = [0].into_iter().chain(4..4 + n).chain([1]).collect();
        let mut faces: Vec<Vec<u32>> = vec![vec![0, 2, 1], vec![1, 2, 3], vec![2, 0, 3]];
        for pair in chain.windows(2) {
            faces.push(vec![pair[0], pair[1], 3]);
        }
        for k in 1..chain.len() - 1 {
            faces.push(vec![0, chain[k + 1], chain[k]]);
        }
        let faces: Vec<&[u32]> = faces.iter().map(Vec::as_slice).collect();
        let (mesh, diagnosis) = build_soup(&soup(&p, &faces));
        assert_eq!(diagnosis.zero_area_faces.count, n as usize);
        assert_eq!(mesh.topology().boundary_edge_count(), 0);
        assert_eq!(mesh.topology().euler_characteristic(), 2);
        assert_eq!(mesh.face_count(), faces.len());
    }
}

#[test]
fn the_smaller_part_is_turned() {
    let mut faces = SIDES;
    faces[2] = &[3, 2, 1];
    let (mesh, diagnosis) = build_soup(&soup(&TETRAHEDRON, &faces));
    assert_eq!(found(&diagnosis), [("flipped_faces", finding(&[2]))]);
    assert_eq!(mesh.topology().boundary_edge_count(), 0);
    assert_eq!(mesh.triangles()[0], [0, 2, 1]);
    // The lowest face is in the smaller part.
    let mut faces = SIDES;
    faces[0] = &[0, 1, 2];
    assert_eq!(
        build_soup(&soup(&TETRAHEDRON, &faces)).1.flipped_faces,
        finding(&[0])
    );
    // Two against two: the part with the lowest face stays, which is inside out here.
    let faces: [&[u32]; 4] = [&[0, 1, 2], &[0, 3, 1], &[1, 2, 3], &[2, 0, 3]];
    let (mesh, diagnosis) = build_soup(&soup(&TETRAHEDRON, &faces));
    assert_eq!(diagnosis.flipped_faces, finding(&[2, 3]));
    assert_eq!(diagnosis.inside_out_components, finding(&[0]));
    assert_eq!(mesh.triangles()[0], [0, 2, 1]);
}

#[test]
fn tags_follow_their_vertices() {
    // Two quads welded along 1-2 = 4-7.
    let p = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [2.0, 1.0, 0.0],
        [1.0, 1.0, 0.0],
    ];
    let mut quads = soup(&p, &[&[0, 1, 2, 3], &[4, 5, 6, 7]]);
    let crease = |a, b, sharpness| CreaseTag {
        vertices: [a, b],
        sharpness,
    };
    let corner = |vertex, sharpness| CornerTag { vertex, sharpness };
    quads.creases = vec![
        crease(5, 6, 2.0),
        crease(7, 4, 3.0),
        crease(1, 2, 1.0),
        crease(0, 5, 1.0),
        crease(1, 4, 1.0),
        crease(1, 99, 1.0),
        crease(0, 1, f64::NAN),
    ];
    quads.corners = vec![
        corner(4, 1.0),
        corner(1, 5.0),
        corner(0, 10.0),
        corner(50, 1.0),
        corner(3, -1.0),
    ];
    let (mesh, diagnosis) = build_soup(&quads);
    assert_eq!(diagnosis.dropped_tags, finding(&[3, 4, 5, 6, 10, 11]));
    let ends = |tag: &CreaseTag| {
        let mut ends = tag.vertices;
        ends.sort_unstable();
        (ends, tag.sharpness)
    };
    let creases: Vec<_> = mesh.tags().creases.iter().map(ends).collect();
    assert_eq!(creases, [([4, 5], 2.0), ([1, 2], 3.0)]);
    assert_eq!(mesh.tags().corners, [corner(0, 10.0), corner(1, 5.0)]);
}

/// Squares of coordinates that vanish or overflow say nothing about a face's area.
#[test]
fn tiny_and_huge_faces_have_an_area() {
    for size in [1e-305, 1e-300, 1e-160, 1e-120, 1.0, 1e120, 1e160, 1e300] {
        let positions = TETRAHEDRON.map(|p| p.map(|x| x * size));
        let (mesh, diagnosis) = build_soup(&soup(&positions, &SIDES));
        assert!(
            diagnosis.is_clean() && mesh.triangles().len() == 4,
            "{size}: {:?}",
            found(&diagnosis)
        );
        // The middle of an edge takes nothing from that: it is on one line with the ends.
        let mut positions = positions.to_vec();
        positions.push([0.5 * size, 0.0, 0.0]);
        let faces = [SIDES.as_slice(), &[&[0, 4, 1]]].concat();
        let (_, diagnosis) = build_soup(&soup(&positions, &faces));
        assert_eq!(diagnosis.zero_area_faces, finding(&[4]), "{size}");
    }
}

#[test]
fn faces_know_which_of_the_input_they_are_from() {
    let trace =
        |soup: &PolygonSoup| Mesh::from_soup_traced(soup, &BuildOptions::default()).unwrap();
    // A line, a square, a face that is turned round, one that repeats it.
    let positions = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [2.0, 0.0, 0.0],
    ];
    let faces: [&[u32]; 4] = [&[0, 0, 1], &[0, 1, 2, 3], &[1, 2, 4], &[4, 2, 1]];
    assert_eq!(trace(&soup(&positions, &faces)).2.faces, [1, 1, 2]);
    // Three sheets along an edge, closed so that the edge lies inside each: cut, and split in its middle.
    let mut positions = vec![[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]];
    let mut faces: Vec<Vec<u32>> = Vec::new();
    for i in 0..3u32 {
        let angle = f64::from(i) * 2.0;
        positions.push([angle.cos(), angle.sin(), 0.0]);
        faces.push(vec![0, 1, 2 + i]);
    }
    for (a, b) in [(2, 3), (3, 4)] {
        faces.extend([vec![0, a, b], vec![1, b, a]]);
    }
    let slices: Vec<&[u32]> = faces.iter().map(Vec::as_slice).collect();
    let (mesh, _, trace) = trace(&soup(&positions, &slices));
    let inputs = trace.faces;
    assert_eq!(inputs.len(), mesh.face_count());
    for (face, &input) in inputs.iter().enumerate() {
        // Each corner, or for the middle of an edge its ends, are corners of the input's face.
        let corners: Vec<[f64; 3]> = faces[input as usize]
            .iter()
            .map(|&v| positions[v as usize])
            .collect();
        let plane = |p: [f64; 3]| {
            let [a, b, c] = [0, 1, 2].map(|i| vector(corners[i]));
            (vector(p) - a).dot((b - a).cross(c - a))
        };
        assert!(
            mesh.as_triangles()
                .corners(face)
                .iter()
                .all(|&p| plane(p).abs() < 1e-12),
            "{face}"
        );
    }
}

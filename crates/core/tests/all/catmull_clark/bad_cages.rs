//! Cages as files have them: bent, twisted, doubled and torn ones give the surface of their polygons, or a report that names what is not
//! in it. The witness is plain subdivision of the file's own polygons.

use limitmesh::QuadOptions;
use limitmesh::mesh::{BoundaryRule, Diagnosis, Finding, Weld};

use super::*;

/// The control mesh of a cage, and what was found; each face of the file is in it or named by a finding that says so.
fn built(soup: &PolygonSoup) -> (QuadControl, Diagnosis) {
    let (control, found) = QuadControl::from_soup(soup, &BuildOptions::default()).unwrap();
    control.mesh.validate().unwrap();
    let dropped = [&found.collapsed_faces, &found.repeated_faces];
    let named = dropped.iter().flat_map(|finding| &finding.first);
    let mut all: Vec<u32> = named.chain(&control.trace.faces).copied().collect();
    all.sort_unstable();
    all.dedup();
    assert_eq!(all, (0..soup.faces.len() as u32).collect::<Vec<_>>());
    (control, found)
}

/// A cage without defects, whose surface is that of its polygons.
fn sound(name: &str, soup: &PolygonSoup) {
    let (_, found) = built(soup);
    assert!(
        found.repairs().is_empty() && found.polygons.is_empty(),
        "{name}: {found}"
    );
    check(name, soup, 4, 1e-2);
}

fn named(finding: &Finding) -> &[u32] {
    assert_eq!(finding.count, finding.first.len());
    &finding.first
}

/// The cube with some of its corners elsewhere.
fn bent_cube(moved: &[(usize, Point)]) -> PolygonSoup {
    let mut soup = cube();
    for &(v, to) in moved {
        soup.positions[v] = to;
    }
    soup
}

/// A prism over polygons with this rim, of quads around.
fn prism(rim: &[[f64; 2]]) -> PolygonSoup {
    let n = rim.len() as u32;
    let at = |z: f64| rim.iter().map(move |&[x, y]| [x, y, z]);
    let positions: Vec<Point> = at(0.0).chain(at(1.0)).collect();
    let mut prism = soup(&positions, &[]);
    prism.faces.push(&(0..n).rev().collect::<Vec<_>>());
    prism.faces.push(&(n..2 * n).collect::<Vec<_>>());
    for i in 0..n {
        let next = (i + 1) % n;
        prism.faces.push(&[i, next, n + next, n + i]);
    }
    prism
}

#[test]
fn polygons_of_any_shape_have_their_surface() {
    sound("bent quads", &bent_cube(&[(7, [2.0, 0.5, 0.2])]));
    // Two corners have changed places: two of the faces are bow-ties.
    let twisted = [(5, [1.0, 1.0, 1.0]), (7, [1.0, -1.0, 1.0])];
    sound("bow-ties", &bent_cube(&twisted));
    sound(
        "a dart",
        &bent_cube(&[(3, [0.0, 0.0, -1.0]), (7, [0.0, 0.0, 1.0])]),
    );
    let arrow = [[0.0, 0.0], [2.0, -1.0], [1.0, 0.0], [2.0, 1.0], [1.8, 1.8]];
    sound("concave pentagons", &prism(&arrow));
    let straight = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    sound("collinear corners", &prism(&straight));
    let circle = (0..40).map(|i| f64::from(i) * std::f64::consts::TAU / 40.0);
    sound(
        "forty corners",
        &prism(&circle.map(|a| [a.cos(), a.sin()]).collect::<Vec<_>>()),
    );
    // A quad between two others that has its corners on one line.
    let line = |y: f64, bend: f64| [-1.0, -0.3, 0.4, 1.0].map(|x| [x, y, bend * x * x]);
    let positions = [
        &line(0.0, 0.0)[..],
        &line(1.0, 0.3),
        &[[-1.0, -1.0, 0.3], [1.0, -1.0, 0.3]],
    ];
    let faces: [&[u32]; 5] = [
        &[8, 9, 3, 0],
        &[0, 3, 2, 1],
        &[0, 1, 5, 4],
        &[1, 2, 6, 5],
        &[2, 3, 7, 6],
    ];
    let flat = soup(&positions.concat(), &faces);
    sound("a quad without area", &flat);
}

#[test]
fn fans_with_quads_and_open_cages_with_tags_have_their_surface() {
    let rim = (0..7).map(|i| f64::from(i) * std::f64::consts::TAU / 7.0);
    let mut positions: Vec<Point> = rim.map(|a| [a.cos(), a.sin(), 0.0]).collect();
    positions.extend([[0.0, 0.0, 1.0], [2.0, 0.2, -1.0], [1.2, 1.6, -1.0]]);
    let mut fan = soup(&positions, &[&[0, 8, 9, 1]]);
    (0..7).for_each(|i| fan.faces.push(&[7, i, (i + 1) % 7]));
    sound("a fan with a quad", &fan);
    for (vertices, sharpness) in [([7, 0], 1.5), ([7, 3], 10.0), ([0, 8], 10.0), ([2, 3], 0.3)] {
        fan.creases.push(CreaseTag {
            vertices,
            sharpness,
        });
    }
    let [first, last] =
        [(9, 10.0), (1, 1.2)].map(|(vertex, sharpness)| CornerTag { vertex, sharpness });
    fan.corners.extend([first, last]);
    sound("tags of a fan", &fan);
}

/// Pairs of polygons around vertices of two edges.
#[test]
fn polygons_that_share_two_edges_have_their_surface() {
    // Each corner of a tetrahedron's base is joined to a vertex beneath, but for one of the three.
    let positions = [
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0],
        [-0.5, 0.9, 0.0],
        [-0.5, -0.9, 0.0],
        [0.0, 0.0, -1.0],
        [0.2, 0.1, 0.4],
    ];
    // Vertex 5 is between 0 and 1, with two faces alone.
    let cage = soup(
        &positions,
        &[
            &[0, 5, 1, 2],
            &[0, 3, 1, 5],
            &[0, 2, 3],
            &[1, 4, 2],
            &[1, 3, 4],
            &[2, 4, 3],
        ],
    );
    sound("triangles and quads", &cage);
    // Three quads around an axis, two of which share two edges.
    let quads = soup(
        &positions[..5],
        &[&[2, 1, 4, 0], &[4, 1, 3, 0], &[3, 1, 2, 0]],
    );
    sound("three quads", &quads);
    let (control, _) = built(&quads);
    assert_eq!(control.mesh.face_count(), 6);
}

/// The corners of the first quad are joined crosswise by edges of others: a diagonal of it would be a second edge there.
#[test]
fn quads_whose_diagonals_are_edges_of_others_have_their_surface() {
    let mut random = Random::new(5);
    let positions: Vec<Point> = (0..10).map(|_| [0; 3].map(|_| random.signed())).collect();
    let faces: [&[u32]; 6] = [
        &[0, 1, 2, 3],
        &[1, 0, 5, 6],
        &[2, 1, 7, 4],
        &[5, 0, 2, 4],
        &[7, 1, 3, 8],
        &[3, 2, 9, 8],
    ];
    sound("crosswise", &soup(&positions, &faces));
}

#[test]
fn what_repeats_collapses_or_is_turned_is_named() {
    let clean = built(&cube()).0;
    let with = |extra: &[&[u32]]| {
        let mut soup = cube();
        extra.iter().for_each(|face| soup.faces.push(face));
        soup
    };
    // From another corner, and the other way round.
    let (control, found) = built(&with(&[
        &[3, 1, 0, 2],
        &[4, 6, 7, 5],
        &[0, 1, 0, 1],
        &[2, 2, 6],
    ]));
    assert_eq!(named(&found.repeated_faces), [6, 7]);
    assert_eq!(named(&found.collapsed_faces), [8, 9]);
    assert_eq!(control.mesh, clean.mesh);
    let mut turned = cube();
    turned.faces = Default::default();
    let turns = |face: usize| face == 2 || face == 4;
    for (face, corners) in cube().faces.iter().enumerate() {
        let own = corners.iter().copied();
        match turns(face) {
            true => turned.faces.push(&own.rev().collect::<Vec<_>>()),
            false => turned.faces.push(&own.collect::<Vec<_>>()),
        }
    }
    turned.positions.push([9.0; 3]);
    let (control, found) = built(&turned);
    assert_eq!(named(&found.flipped_faces), [2, 4]);
    assert_eq!(named(&found.isolated_vertices), [8]);
    let (sampled, rest) = from_plain(&uniform_of(&control, 3), &cube(), 4);
    assert!(sampled <= 2.0 * rest, "{sampled} {rest}");
}

fn uniform_of(control: &QuadControl, levels: usize) -> Mesh {
    let options = UniformOptions::default().levels(levels);
    uniform(&control.mesh, &CatmullClark, &options)
        .unwrap()
        .mesh
}

/// Along an edge of three faces the sheets are cut apart, and stay together under refinement.
#[test]
fn edges_with_more_than_two_faces_are_named_and_stay_together() {
    let mut fin = cube();
    fin.positions
        .extend([[-1.0, -3.0, -1.0], [1.0, -3.0, -1.0]]);
    // The edge from 0 to 1 has a third face.
    fin.faces.push(&[0, 1, 9, 8]);
    fin.creases.push(CreaseTag {
        vertices: [0, 2],
        sharpness: 10.0,
    });
    let (control, found) = built(&fin);
    assert_eq!(named(&found.non_manifold_edges), [0]);
    assert!(found.repeated_faces.is_empty() && found.dropped_tags.is_empty());
    let found = exact(
        &control.mesh,
        &CatmullClark,
        &ExactOptions::default().tolerance(0.01),
    )
    .unwrap();
    assert!(found.error.certified && found.error.upper <= 0.01);
    found.mesh.validate().unwrap();
    assert!(!found.mesh.junctions().is_empty());
}

/// A polygon with a hole visits the ends of a slit twice; it becomes triangles, which the report says.
#[test]
fn polygons_that_visit_a_vertex_twice_become_triangles() {
    let square = |r: f64| [[-r, -r, 0.0], [r, -r, 0.0], [r, r, 0.0], [-r, r, 0.0]];
    let positions = [square(2.0), square(1.0)].concat();
    let holed = soup(
        &positions,
        &[&[4, 5, 6, 7], &[0, 1, 2, 3, 0, 4, 7, 6, 5, 4]],
    );
    let (control, found) = built(&holed);
    assert_eq!(named(&found.polygons), [1]);
    assert!(found.is_clean());
    // What is within a plane boundary has the area that the boundary says: no part is lost.
    let fine = uniform_of(&control, 4);
    let mut plain = Plain::of(&soup(&square(2.0), &[&[0, 1, 2, 3]]));
    (0..5).for_each(|_| plain = plain.refined());
    let (points, triangles) = plain.mesh();
    let own = area(fine.positions(), fine.triangles());
    assert!((own - area(&points, &triangles)).abs() < 1e-12 * own);
    assert_eq!(fine.topology().boundary_edge_count(), 4 << 5);
}

/// The area of triangles in the plane of x and y, less that of those that are turned over.
fn area(points: &[Point], triangles: &[[u32; 3]]) -> f64 {
    let own = |&triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|v| points[v as usize]);
        0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
    };
    triangles.iter().map(own).sum()
}

/// Vertices of the boundary that a rule keeps are where they were, whether a step was needed or not.
#[test]
fn boundaries_of_polygons_keep_what_they_are_asked_to() {
    let square = [
        [0.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [2.0, 2.0, 0.0],
        [0.0, 2.0, 0.0],
    ];
    let positions = [&square[..], &[[1.0, 3.0, 0.0]]].concat();
    let house = soup(&positions, &[&[0, 1, 2, 3], &[2, 4, 3]]);
    for (rule, kept) in [
        (BoundaryRule::Corners, &[0, 1, 4][..]),
        (BoundaryRule::Fixed, &[0, 1, 2, 3, 4]),
    ] {
        for cage in [&house, &soup(&square, &[&[0, 1, 2, 3]])] {
            let rules = QuadOptions::default().boundary(rule);
            let (control, _) =
                QuadControl::from_soup_with(cage, &BuildOptions::default(), &rules).unwrap();
            let limits = LimitTable::new(&CatmullClark)
                .positions(&control.mesh)
                .unwrap();
            for &v in kept.iter().filter(|&&v| v < cage.positions.len()) {
                assert!(limits.contains(&cage.positions[v]), "{rule:?}: {v}");
            }
        }
    }
}

/// Any polygons over few vertices, some at one place: there is a surface within the tolerance or a reason why not, never a broken mesh.
#[test]
fn any_polygons_have_a_surface_or_a_report() {
    let (mut found, mut same) = (0, 0);
    for seed in 0..300 {
        let mut random = Random::new(seed);
        let mut junk = PolygonSoup::default();
        let vertices = 4 + random.below(9);
        for _ in 0..vertices {
            let coordinate = |random: &mut Random| random.below(4) as f64;
            junk.positions.push([0; 3].map(|_| coordinate(&mut random)));
        }
        for _ in 0..1 + random.below(8) {
            let corners = 2 + random.below(6);
            let face: Vec<u32> = (0..corners)
                .map(|_| random.below(vertices) as u32)
                .collect();
            junk.faces.push(&face);
            if random.below(3) == 0 {
                let sharpness = [0.4, 1.0, 2.3, 10.0][random.below(4)];
                junk.creases.push(CreaseTag {
                    vertices: [face[0], face[1]],
                    sharpness,
                });
                junk.corners.push(CornerTag {
                    vertex: face[1],
                    sharpness,
                });
            }
        }
        let weld = [Weld::Exact, Weld::Never][random.below(2)];
        let options = BuildOptions::default().weld(weld);
        let rules = QuadOptions::default().smooth_triangles(seed % 3 == 0);
        let Ok((control, diagnosis)) = QuadControl::from_soup_with(&junk, &options, &rules) else {
            continue;
        };
        control.mesh.validate().unwrap();
        // What is carried takes the same step as positions do.
        let values = junk.positions.as_flattened().to_vec();
        let places = Channel::new("places", Semantic::Displacement, Domain::Vertex, 3)
            .with(values, (0..vertices as u32).collect());
        let places = control.channel(&junk, &places).unwrap();
        for (corner, &v) in control.mesh.triangles().as_flattened().iter().enumerate() {
            let place: Point = places.value(corner).try_into().unwrap();
            let own = control.mesh.positions()[v as usize];
            // Sheets that many faces share an edge of may be cut apart at vertices that the file has not.
            let is_there = diagnosis.non_manifold_edges.is_empty();
            assert!(near(place, own, 1e-12) || !is_there, "{seed}");
            same += usize::from(is_there);
        }
        let goal = ExactOptions::default().tolerance(0.02 * control.mesh.diagonal());
        match exact(&control.mesh, &CatmullClark, &goal) {
            Ok(mesh) => {
                mesh.mesh.validate().unwrap();
                found += usize::from(mesh.error.certified);
            }
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
    assert!(found > 200 && same > 1000, "{found} {same}");
}

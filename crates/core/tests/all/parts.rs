//! Shapes that are parts by construction, or are not; and surfaces of parts that pass through their
//! vertices without folding, whose triangles are tested alone.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

use limitmesh::interpolate::InterpolateOptions;
use limitmesh::part::{Look, Part, Unfolded, interpolate_unfolded};
use limitmesh::refine::limit_reference;

use crate::support::{exact, within};
use limitmesh::scheme::Loop;
use limitmesh::{Mesh, PolygonSoup, VertexId};

use super::support::{Point, cross, distance, dot, minus, octahedron, torus};

/// Triangles by the places of their corners.
fn mesh(triangles: Vec<[Point; 3]>) -> Mesh {
    let mut soup = PolygonSoup::default();
    for corners in triangles {
        let first = soup.positions.len() as u32;
        soup.positions.extend(corners);
        soup.faces.push(&[first, first + 1, first + 2]);
    }
    Mesh::from_soup(&soup, &Default::default()).unwrap().0
}

fn quad([a, b, c, d]: [Point; 4]) -> [[Point; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

/// The faces of cubes of size 1 that are not between two of them.
fn voxels(cells: &BTreeSet<[i32; 3]>) -> Mesh {
    let mut triangles = Vec::new();
    for cell in cells {
        for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, 1)]) {
            let mut beyond = *cell;
            beyond[axis] += 2 * side - 1;
            if cells.contains(&beyond) {
                continue;
            }
            let corner = |i: i32, j: i32| {
                let mut place = *cell;
                place[axis] += side;
                place[(axis + 1) % 3] += i;
                place[(axis + 2) % 3] += j;
                place.map(f64::from)
            };
            let mut corners = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            if side == 0 {
                corners.reverse();
            }
            triangles.extend(quad(corners));
        }
    }
    mesh(triangles)
}

fn cells(size: [i32; 3], is_own: impl Fn([i32; 3]) -> bool) -> BTreeSet<[i32; 3]> {
    let [x, y, z] = size.map(|n| -n..n);
    let all = x
        .flat_map(|i| y.clone().map(move |j| [i, j]))
        .flat_map(|[i, j]| z.clone().map(move |k| [i, j, k]));
    all.filter(|&cell| is_own(cell)).collect()
}

fn ball(radius: f64) -> BTreeSet<[i32; 3]> {
    let n = radius as i32 + 1;
    cells([n; 3], |cell| {
        cell.map(|x| (f64::from(x) + 0.5).powi(2))
            .iter()
            .sum::<f64>()
            < radius * radius
    })
}

/// A cylinder with rings of vertices at some turns and heights, between flat ends.
fn peg(turns: &[f64], heights: &[f64], radius: f64) -> Mesh {
    let n = turns.len();
    let at = |i: usize, z: f64| {
        let (sine, cosine) = (TAU * turns[i % n]).sin_cos();
        [radius * cosine, radius * sine, z]
    };
    let mut triangles = Vec::new();
    for pair in heights.windows(2) {
        for i in 0..n {
            triangles.extend(quad([
                at(i, pair[0]),
                at(i + 1, pair[0]),
                at(i + 1, pair[1]),
                at(i, pair[1]),
            ]));
        }
    }
    let (low, high) = (heights[0], heights[heights.len() - 1]);
    for i in 1..n - 1 {
        triangles.extend([
            [at(0, low), at(i + 1, low), at(i, low)],
            [at(0, high), at(i, high), at(i + 1, high)],
        ]);
    }
    mesh(triangles)
}

fn facets(n: usize) -> Vec<f64> {
    (0..n).map(|i| i as f64 / n as f64).collect()
}

/// The angle and the number of sharp edges of a part.
#[track_caller]
fn part(mesh: &Mesh) -> (f64, usize) {
    match Look::of(mesh, &[]) {
        Look::Part(Part {
            degrees, creases, ..
        }) => (degrees, creases.edges.len()),
        other => panic!("{other:?}"),
    }
}

#[test]
fn boxes_pegs_and_brackets_are_parts() {
    let solid = |size: [i32; 3]| voxels(&cells(size, |_| true));
    // Twelve edges, however many vertices stand on them.
    assert_eq!(part(&solid([1, 1, 1])), (30.0, 24));
    assert_eq!(part(&solid([10, 5, 2])), (30.0, 4 * (20 + 10 + 4)));
    // An L has 18 edges: two of its sides are extruded.
    let bracket = voxels(&cells([10, 5, 5], |[x, _, z]| z < -2 || x < -7));
    assert_eq!(
        part(&bracket),
        (30.0, 2 * (20 + 3 + 17 + 7 + 3 + 10) + 6 * 10)
    );
    for (n, degrees) in [(8, 65.0), (12, 55.0), (16, 30.0), (32, 30.0), (100, 30.0)] {
        assert_eq!(
            part(&peg(&facets(n), &[0.0, 8.0], 5.0)),
            (degrees, 2 * n),
            "{n}"
        );
    }
    // A nut keeps its six edges.
    assert_eq!(part(&peg(&facets(6), &[0.0, 3.0], 5.0)), (30.0, 18));
    // A plate with 100 square holes.
    let plate = voxels(&cells([11, 11, 1], |[x, y, z]| {
        z == 0 && (x.rem_euclid(2) == 1 || y.rem_euclid(2) == 1)
    }));
    assert_eq!(part(&plate).0, 30.0);
}

#[test]
fn cages_and_smooth_shapes_are_none() {
    assert_eq!(Look::of(&octahedron(), &[]), Look::Cage);
    for name in ["tetrahedron", "cube"] {
        let soup = limitmesh_models::find(name).unwrap().soup();
        let (mesh, _, trace) = Mesh::from_soup_traced(&soup, &Default::default()).unwrap();
        assert_eq!(Look::of(&mesh, &trace.faces), Look::Cage, "{name}");
    }
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let corners: Vec<Point> = (0..12)
        .map(|i| {
            let (one, long) = ([1.0, -1.0][i & 1], [golden, -golden][i >> 1 & 1]);
            [[0.0, one, long], [one, long, 0.0], [long, 0.0, one]][i >> 2]
        })
        .collect();
    let is_near = |a: usize, b: usize| distance(corners[a], corners[b]) < 2.1;
    let mut triangles = Vec::new();
    for (a, b, c) in
        (0..12).flat_map(|a| (a + 1..12).flat_map(move |b| (b + 1..12).map(move |c| (a, b, c))))
    {
        if is_near(a, b) && is_near(b, c) && is_near(a, c) {
            let own = [corners[a], corners[b], corners[c]];
            let outwards = dot(cross(minus(own[1], own[0]), minus(own[2], own[0])), own[0]) > 0.0;
            triangles.push(if outwards {
                own
            } else {
                [own[0], own[2], own[1]]
            });
        }
    }
    assert_eq!(triangles.len(), 20);
    assert_eq!(Look::of(&mesh(triangles), &[]), Look::Cage);
    for model in limitmesh_models::all()
        .iter()
        .filter(|model| !["cube", "tetrahedron"].contains(&model.name))
    {
        let mesh = Mesh::from_soup(&model.soup(), &Default::default())
            .unwrap()
            .0;
        assert_eq!(Look::of(&mesh, &[]), Look::Smooth, "{}", model.name);
    }
    // Flat, and flat from both sides.
    let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    assert_eq!(
        Look::of(&mesh(quad(square(0.0)).to_vec()), &[]),
        Look::Smooth
    );
    let middle = [0.3, 0.4, 0.0];
    let sides = (0..4).flat_map(|i| {
        let [a, b] = [square(0.0)[i], square(0.0)[(i + 1) % 4]];
        [[a, b, middle], [b, a, [0.6, 0.5, 0.0]]]
    });
    assert_eq!(Look::of(&mesh(sides.collect()), &[]), Look::Smooth);
}

/// A cone's surface is straight from its rim to its tip, and its volume is a third of that of the cylinder around it.
#[test]
fn tips_of_cones_are_sharp() {
    for n in [8, 12, 16, 32] {
        let at = |turn: f64| [3.0 * (TAU * turn).cos(), 3.0 * (TAU * turn).sin(), 0.0];
        let rim: Vec<Point> = facets(n).into_iter().map(at).collect();
        let mut triangles: Vec<_> = (0..n)
            .map(|i| [rim[i], rim[(i + 1) % n], [0.0, 0.0, 4.0]])
            .collect();
        triangles.extend((1..n - 1).map(|i| [rim[0], rim[i + 1], rim[i]]));
        let cone = mesh(triangles);
        let Look::Part(found) = Look::of(&cone, &[]) else {
            panic!("{n}")
        };
        let tips: Vec<Point> = found
            .tips
            .iter()
            .map(|v| cone.positions()[v.index()])
            .collect();
        assert_eq!(
            (found.creases.edges.len(), &tips[..]),
            (n, &[[0.0, 0.0, 4.0]][..]),
            "{n}"
        );
        let (fine, _) = smooth(cone);
        let volume: f64 = fine
            .triangles()
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|v| fine.positions()[v as usize]);
                dot(a, cross(b, c)) / 6.0
            })
            .sum();
        // The sides of few facets are hollow by a little.
        let bound = if n < 12 { 0.03 + 0.12 } else { 0.06 };
        assert!((volume / (12.0 * PI) - 1.0).abs() < bound, "{n}: {volume}");
        let outside = fine
            .positions()
            .iter()
            .map(|p| p[0].hypot(p[1]) - 3.0 * (1.0 - p[2] / 4.0));
        assert!(outside.fold(0.0, f64::max) < 0.05, "{n}");
    }
    // The side of a rod has none, with a ring of vertices on it or without.
    for heights in [vec![0.0, 8.0], vec![0.0, 1.0, 8.0]] {
        let Look::Part(found) = Look::of(&peg(&facets(16), &heights, 5.0), &[]) else {
            panic!()
        };
        assert!(found.tips.is_empty());
    }
}

/// A solid between two copies of an outline that goes counter-clockwise, each with a fan around its first corner.
fn prism(outline: &[[f64; 2]], length: f64) -> Mesh {
    let n = outline.len();
    let at = |i: usize, y: f64| [outline[i % n][0], y, outline[i % n][1]];
    let mut triangles: Vec<_> = (0..n)
        .flat_map(|i| quad([at(i, length), at(i + 1, length), at(i + 1, 0.0), at(i, 0.0)]))
        .collect();
    for i in 1..n - 1 {
        triangles.extend([
            [at(0, 0.0), at(i, 0.0), at(i + 1, 0.0)],
            [at(0, length), at(i + 1, length), at(i, length)],
        ]);
    }
    mesh(triangles)
}

/// Roofs meet their walls at the angle of an octagon's facets; but an octagon's facets come in rows, each between two like it.
#[test]
fn edges_at_45_degrees_are_facets_only_in_rows() {
    let house = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.5], [1.0, 2.5], [0.0, 1.5]];
    assert_eq!(part(&prism(&house, 3.0)), (30.0, 15));
    let (c, l) = (0.2, 1.8);
    let chamfered = [
        [c, 0.0],
        [l, 0.0],
        [2.0, c],
        [2.0, l],
        [l, 2.0],
        [c, 2.0],
        [0.0, l],
        [0.0, c],
    ];
    assert_eq!(part(&prism(&chamfered, 3.0)), (30.0, 24));
    let octagon: Vec<[f64; 2]> = facets(8)
        .iter()
        .map(|turn| (TAU * turn).sin_cos())
        .map(|(s, c)| [c, s])
        .collect();
    assert_eq!(part(&prism(&octagon, 3.0)), (65.0, 16));
    // An open tube of eight facets is as round as a closed one.
    let tube = prism(&octagon, 3.0);
    let sides: Vec<[Point; 3]> = tube.triangles()[..16]
        .iter()
        .map(|t| t.map(|v| tube.positions()[v as usize]))
        .collect();
    assert_eq!(Look::of(&mesh(sides), &[]), Look::Smooth);
}

/// A damaged coordinate draws a vertex away, and its edges are longer than all others together.
#[test]
fn one_far_vertex_does_not_decide_what_a_mesh_looks_like() {
    let round = torus(20, 10);
    let block = voxels(&cells([6, 6, 6], |[x, y, z]| x < 5 && y < 5 && z < 5));
    let far = |mesh: &Mesh| {
        let mut positions = mesh.positions().to_vec();
        positions[0] = [0.0, 0.0, 1e6];
        mesh.clone().with_positions(positions).unwrap()
    };
    assert_eq!(
        [&round, &far(&round)].map(|mesh| Look::of(mesh, &[])),
        [Look::Smooth, Look::Smooth]
    );
    assert_eq!(
        [&block, &far(&block)].map(|mesh| part(mesh).0),
        [30.0, 30.0]
    );
}

#[test]
fn voxels_of_round_shapes_are_stairs() {
    for radius in [3.0, 5.0, 10.0, 15.0] {
        assert_eq!(
            Look::of(&voxels(&ball(radius)), &[]),
            Look::Stairs,
            "{radius}"
        );
    }
    let vessel = cells([30, 12, 12], |cell| {
        let [x, y, z] = cell.map(|x| f64::from(x) + 0.5);
        (y - 3.0 * (x / 9.0).sin()).powi(2) + (z - 2.0 * (x / 11.0).cos()).powi(2) < 16.0
    });
    assert_eq!(Look::of(&voxels(&vessel), &[]), Look::Stairs);
    // Real stairs are a part.
    assert_eq!(
        part(&voxels(&cells([10, 10, 10], |[x, _, z]| z <= x))).0,
        30.0
    );
}

/// The surface of a part by default.
fn smooth(mesh: Mesh) -> (Mesh, Unfolded) {
    let Look::Part(part) = Look::of(&mesh, &[]) else {
        panic!("a part")
    };
    let mesh = mesh.with_creases(&part.creases.edges);
    let found = interpolate_unfolded(&mesh, &Loop).unwrap();
    (mesh, found)
}

/// Triangles of a finely refined surface that look away from the face that they are over: four levels of it, in order.
fn turned_over(mesh: &Mesh, control: &Mesh) -> usize {
    let fine = limit_reference(control, &Loop, 4).unwrap();
    let normal = |[a, b, c]: [Point; 3]| cross(minus(b, a), minus(c, a));
    let looks_away = |part: &usize| {
        let own = normal(fine.as_triangles().corners(*part));
        let whole = normal(mesh.as_triangles().corners(part / 256));
        dot(own, whole) < -1e-9 * dot(whole, whole)
    };
    (0..fine.face_count()).filter(looks_away).count()
}

#[test]
fn rings_close_together_would_fold_and_do_not() {
    let even = facets(16);
    let beside = |by: f64| [even.clone(), vec![even[3] + by, even[3] + 2.0 * by]].concat();
    let sorted = |mut turns: Vec<f64>| {
        turns.sort_by(f64::total_cmp);
        turns
    };
    let cases = [
        (even.clone(), vec![0.0, 3.95, 4.05, 8.0]),
        (even.clone(), vec![0.0, 3.995, 4.005, 8.0]),
        (sorted(beside(0.003)), vec![0.0, 3.0, 4.0, 8.0]),
        (sorted(beside(0.0008)), vec![0.0, 3.0, 4.0, 8.0]),
    ];
    for (turns, heights) in cases {
        let (mesh, found) = smooth(peg(&turns, &heights, 5.0));
        let through =
            limitmesh::interpolate::interpolate(&mesh, &Loop, &InterpolateOptions::default())
                .unwrap();
        assert!(turned_over(&mesh, &through.mesh) > 0);
        let Unfolded {
            interpolated,
            folded,
            ..
        } = found;
        assert_eq!(turned_over(&mesh, &interpolated.mesh), 0);
        let refined = exact(&interpolated.mesh, &Loop, &within(0.01)).unwrap();
        assert_eq!(refined.inverted_triangles(), 0);
        // The regions have the faces that fold, and every vertex is passed through or named.
        let limits = limitmesh::limit::LimitTable::new(&Loop)
            .positions(&interpolated.mesh)
            .unwrap();
        for (v, (limit, vertex)) in limits.iter().zip(mesh.positions()).enumerate() {
            let is_passed_by = interpolated.relaxed.contains(&VertexId(v as u32));
            assert!(is_passed_by || distance(*limit, *vertex) < 1e-9, "{v}");
        }
        assert!(!folded.is_empty());
        let [low, high] = folded[0].bounding_box;
        assert!(low[2] >= 0.0 && high[2] <= 8.0 && low[2] < high[2]);
        // Where whole rings fold, the rims keep their radius: they are curves of their own.
        let is_on_rim = |v: &VertexId| [0.0, 8.0].contains(&mesh.positions()[v.index()][2]);
        if turns.len() == 16 {
            assert!(!interpolated.relaxed.iter().any(is_on_rim), "{heights:?}");
        }
    }
}

/// Two pegs in one mesh: the one that folds does not take the other's radius.
#[test]
fn what_folds_does_not_change_the_rest() {
    let (even, folding) = (
        peg(&facets(16), &[0.0, 8.0], 5.0),
        peg(&facets(16), &[0.0, 3.95, 4.05, 8.0], 5.0),
    );
    let corners = |mesh: &Mesh, x: f64| -> Vec<[Point; 3]> {
        let moved = |face: usize| {
            mesh.as_triangles()
                .corners(face)
                .map(|p| [p[0] + x, p[1], p[2]])
        };
        (0..mesh.face_count()).map(moved).collect()
    };
    let (mesh, found) = smooth(mesh(
        [corners(&even, 0.0), corners(&folding, 20.0)].concat(),
    ));
    assert!(!found.folded.is_empty());
    let surface = exact(&found.interpolated.mesh, &Loop, &within(1e-3)).unwrap();
    let volume = |is_own: &dyn Fn(Point) -> bool| {
        let own =
            (0..surface.mesh.face_count()).map(|face| surface.mesh.as_triangles().corners(face));
        own.filter(|corners| is_own(corners[0]))
            .map(|[a, b, c]| dot(a, cross(b, c)))
            .sum::<f64>()
            / 6.0
    };
    assert!((volume(&|p| p[0] < 10.0) / (PI * 200.0) - 1.0).abs() < 1e-3);
    let relaxed = &found.interpolated.relaxed;
    assert!(
        !relaxed.is_empty()
            && relaxed
                .iter()
                .all(|v| mesh.positions()[v.index()][0] > 10.0)
    );
}

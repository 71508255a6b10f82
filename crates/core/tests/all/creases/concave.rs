//! Corners of 180° and more, against exact shapes: prisms over polygons, whose surface is known.

use std::f64::consts::TAU;

use limitmesh::Mesh;
use limitmesh::PolygonSoup;
use limitmesh::VertexId;
use limitmesh::limit::LimitTable;
use limitmesh::mesh::{BoundaryRule, BuildOptions, ConcaveCorners, CreaseTag, PolygonFaces};
use limitmesh::refine::{Exact, UniformOptions, limit_reference, uniform};

use crate::support::exact;
use limitmesh::scheme::{Loop, LoopWarren, ModifiedButterfly, Scheme};

use crate::support::*;

const DEGREE: f64 = TAU / 360.0;

type Outline = Vec<[f64; 2]>;

/// Twice the area of a triangle, or a polygon, counter-clockwise.
fn twice_area(outline: &[[f64; 2]]) -> f64 {
    let next = outline.iter().cycle().skip(1);
    outline
        .iter()
        .zip(next)
        .map(|(a, b)| a[0] * b[1] - a[1] * b[0])
        .sum()
}

/// How far a point is outside a polygon; 0 inside.
fn outside(p: [f64; 2], outline: &[[f64; 2]]) -> f64 {
    let (mut winding, mut nearest) = (0.0, f64::MAX);
    for (a, b) in outline.iter().zip(outline.iter().cycle().skip(1)) {
        let [u, v] = [[a[0] - p[0], a[1] - p[1]], [b[0] - p[0], b[1] - p[1]]];
        winding += (u[0] * v[1] - u[1] * v[0]).atan2(u[0] * v[0] + u[1] * v[1]);
        let d = [b[0] - a[0], b[1] - a[1]];
        let t = (-(u[0] * d[0] + u[1] * d[1]) / (d[0] * d[0] + d[1] * d[1])).clamp(0.0, 1.0);
        nearest = nearest.min((u[0] + t * d[0]).hypot(u[1] + t * d[1]));
    }
    if winding.abs() > 0.5 * TAU {
        0.0
    } else {
        nearest
    }
}

/// The prism over a polygon from z = 0 to z = 1: its caps as one polygon each.
fn prism(outline: &[[f64; 2]]) -> Mesh {
    let n = outline.len() as u32;
    let at = |z: f64| outline.iter().map(move |p| [p[0], p[1], z]);
    let mut faces = PolygonFaces::default();
    faces.push(&(0..n).rev().collect::<Vec<u32>>());
    faces.push(&(n..2 * n).collect::<Vec<u32>>());
    for i in 0..n {
        let j = (i + 1) % n;
        faces.push(&[i, j, n + j, n + i]);
    }
    let soup = PolygonSoup {
        positions: at(0.0).chain(at(1.0)).collect(),
        faces,
        ..PolygonSoup::default()
    };
    Mesh::from_soup(&soup, &BuildOptions::default()).unwrap().0
}

/// Whether triangles are the surface of the prism, each part of it covered once and the right way round: all are on it, none
/// is turned over, and their area is that of the prism.
fn assert_is_prism(mesh: &Mesh, outline: &[[f64; 2]], name: &str) {
    const EPSILON: f64 = 1e-9;
    let lengths = outline.iter().zip(outline.iter().cycle().skip(1));
    let perimeter: f64 = lengths.map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).sum();
    let mut areas = [0.0; 3];
    for t in mesh.triangles() {
        let p = t.map(|v| mesh.positions()[v as usize]);
        let flat = p.map(|p| [p[0], p[1]]);
        for corner in flat {
            assert!(
                outside(corner, outline) < EPSILON,
                "{name}: {corner:?} is outside"
            );
        }
        let is_on = |z: f64| p.iter().all(|p| (p[2] - z).abs() < EPSILON);
        let up = twice_area(&flat);
        if is_on(0.0) || is_on(1.0) {
            let turned = if is_on(0.0) { -up } else { up };
            assert!(turned > -EPSILON, "{name}: {p:?} on a cap is turned over");
            areas[usize::from(is_on(1.0))] += 0.5 * turned;
            continue;
        }
        assert!(
            up.abs() < EPSILON,
            "{name}: {p:?} is neither on a cap nor upright"
        );
        // Upright: seen from outside where its middle, a step to its right, is outside.
        let [u, v] = [1, 2].map(|i| [0, 1, 2].map(|axis| p[i][axis] - p[0][axis]));
        let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2]];
        let size = normal[0].hypot(normal[1]);
        areas[2] += 0.5 * size;
        if size > EPSILON {
            let step = |sign: f64| {
                [0, 1].map(|axis| {
                    (flat[0][axis] + flat[1][axis] + flat[2][axis]) / 3.0
                        + sign * 1e-6 * normal[axis] / size
                })
            };
            assert!(
                outside(step(1.0), outline) > 0.0,
                "{name}: {p:?} on a side is turned over"
            );
            assert!(
                outside(step(-1.0), outline) == 0.0,
                "{name}: {p:?} is inside"
            );
        }
    }
    let expected = [
        0.5 * twice_area(outline),
        0.5 * twice_area(outline),
        perimeter,
    ];
    for (area, expected) in areas.iter().zip(expected) {
        assert!(
            (area - expected).abs() < EPSILON * (1.0 + expected),
            "{name}: {areas:?} for {expected}"
        );
    }
}

fn divided(mesh: Mesh) -> (Mesh, ConcaveCorners) {
    let (mesh, concave) = mesh.with_divided_concave_corners().unwrap();
    mesh.validate().unwrap();
    (mesh, concave)
}

fn creased(mesh: Mesh) -> Mesh {
    mesh.with_creases_above(30.0 * DEGREE).unwrap()
}

fn refined(mesh: &Mesh) -> Exact {
    exact(mesh, &Loop, &within(1e-3 * mesh.diagonal())).unwrap()
}

fn l_shape() -> Outline {
    vec![
        [0.0, 0.0],
        [2.0, 0.0],
        [2.0, 1.0],
        [1.0, 1.0],
        [1.0, 2.0],
        [0.0, 2.0],
    ]
}

/// The prism over an L, its caps as fans around the vertex opposite to the concave corner.
fn l_prism() -> Mesh {
    let fan = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
    let mut triangles: Vec<[u32; 3]> = fan.map(|[a, b, c]| [a, c, b]).to_vec();
    triangles.extend(fan.map(|t| t.map(|v| v + 6)));
    for (i, j) in (0..6).map(|i| (i, (i + 1) % 6)) {
        triangles.extend([[i, j, j + 6], [i, j + 6, i + 6]]);
    }
    let at = |z: f64| l_shape().into_iter().map(move |p| [p[0], p[1], z]);
    Mesh::from_triangles(at(0.0).chain(at(1.0)).collect(), triangles).unwrap()
}

#[test]
fn an_l_stays_itself_and_as_it_is_tagged_it_folds() {
    let control = creased(l_prism());
    let folded = refined(&control);
    assert!(folded.inverted_triangles() > 0);
    let beyond = folded
        .mesh
        .positions()
        .iter()
        .map(|p| outside([p[0], p[1]], &l_shape()))
        .fold(0.0, f64::max);
    assert!(beyond > 0.02, "only {beyond} outside");

    let (control, concave) = divided(control);
    assert_eq!((concave.corners.count, concave.edges), (2, 2));
    assert!(concave.parts.is_empty());
    let refined = refined(&control);
    assert_is_prism(&refined.mesh, &l_shape(), "L");
    assert_eq!(refined.mesh.face_count(), control.face_count());
    assert_eq!(refined.inverted_triangles(), 0);
    for scheme in [&Loop as &dyn Scheme, &LoopWarren, &ModifiedButterfly] {
        let options = UniformOptions::default().levels(4).limit(true);
        let mesh = uniform(&control, scheme, &options).unwrap().mesh;
        assert_is_prism(&mesh, &l_shape(), scheme.name());
    }
}

/// A polygon that a ray from the origin meets once in each direction, with corners either way.
fn star(random: &mut Random) -> Outline {
    let n = 5 + random.below(9);
    (0..n)
        .map(|i| {
            let angle = TAU * (i as f64 + 0.35 * random.signed()) / n as f64;
            let radius = 1.0 + 0.7 * random.signed();
            [radius * angle.cos(), radius * angle.sin()]
        })
        .collect()
}

#[test]
fn prisms_over_random_polygons_stay_themselves() {
    let mut random = Random::new(8);
    let mut concave_corners = 0;
    for trial in 0..60 {
        let outline = star(&mut random);
        // All edges of the outline are sharp, however little it turns there.
        let control = prism(&outline).with_creases_above(1e-3).unwrap();
        let (control, concave) = divided(control);
        concave_corners += concave.corners.count;
        let mesh = limit_reference(&control, &Loop, 3).unwrap();
        assert_is_prism(&mesh, &outline, &format!("trial {trial}"));
    }
    assert!(concave_corners > 200, "{concave_corners}");
}

/// A square with a round hole of so many vertices, extruded: caps of triangles from rim to square.
fn square_with_hole(segments: u32) -> Mesh {
    let corners = [[2.0, 2.0], [-2.0, 2.0], [-2.0, -2.0], [2.0, -2.0]];
    let hole = (0..segments).map(|i| {
        let (sine, cosine) = (TAU * (f64::from(i) + 0.5) / f64::from(segments)).sin_cos();
        [cosine, sine]
    });
    let outline: Outline = corners.into_iter().chain(hole).collect();
    let n = outline.len() as u32;
    let rim = |i: u32| 4 + i % segments;
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    let quarter = segments / 4;
    for side in 0..4 {
        for i in 0..quarter {
            triangles.push([side, rim(side * quarter + i + 1), rim(side * quarter + i)]);
        }
        triangles.push([side, (side + 1) % 4, rim((side + 1) * quarter)]);
    }
    let top = triangles.clone();
    triangles.iter_mut().for_each(|t| t.swap(1, 2));
    triangles.extend(top.iter().map(|t| t.map(|v| v + n)));
    let mut wall = |a: u32, b: u32| triangles.extend([[a, b, n + b], [a, n + b, n + a]]);
    (0..4).for_each(|i| wall(i, (i + 1) % 4));
    (0..segments).for_each(|i| wall(rim(i + 1), rim(i)));
    let at = |z: f64| outline.iter().map(move |p| [p[0], p[1], z]);
    Mesh::from_triangles(at(0.0).chain(at(1.0)).collect(), triangles).unwrap()
}

#[test]
fn round_rims_stay_as_they_are() {
    // No vertex of the rim of a round hole is a corner, however wide its sector: none becomes one.
    let control = creased(square_with_hole(16));
    let (same, concave) = divided(control.clone());
    assert_eq!(concave, ConcaveCorners::default());
    assert_eq!(same, control);
}

/// A plane sheet in the shape of a fan around the origin, with the given directions and lengths; the angle between the first
/// and the last is left open.
fn fan(spokes: &[(f64, f64)]) -> Mesh {
    let ends = spokes.iter().map(|&(degrees, length)| {
        let (sine, cosine) = (degrees * DEGREE).sin_cos();
        [length * cosine, length * sine, 0.0]
    });
    let positions = core::iter::once([0.0; 3]).chain(ends).collect();
    Mesh::from_triangles(
        positions,
        (1..spokes.len() as u32).map(|i| [0, i, i + 1]).collect(),
    )
    .unwrap()
}

/// Spokes that leave a quarter open, an uneven number of them.
fn round_rim() -> Vec<(f64, f64)> {
    (0..10)
        .map(|i| (30.0 * f64::from(i), 1.0 + 0.1 * f64::from(i % 2)))
        .collect()
}

#[test]
fn edges_are_divided_where_a_rim_goes_on_smoothly_at_their_other_end() {
    // The corner alone is tagged: at the other ends the boundary is smooth and is to stay so.
    let sheet = fan(&round_rim());
    let corners = vec![crate::support::corner(0, f64::INFINITY)];
    let tagged = sheet
        .clone()
        .with_tags(crate::support::corners(corners))
        .unwrap();
    let (control, concave) = divided(tagged.clone());
    assert_eq!((concave.corners.count, concave.edges), (1, 1));
    assert_eq!(control.face_count(), sheet.face_count() + 6);
    let middle = sheet.vertex_count() as u32;
    assert_eq!(
        control.tags().creases,
        [CreaseTag {
            vertices: [0, middle],
            sharpness: f64::INFINITY
        }]
    );
    // The rim is the curve that it was.
    let table = LimitTable::new(&Loop);
    for v in 1..middle {
        let [before, now] =
            [&tagged, &control].map(|mesh| table.position(mesh, VertexId(v)).unwrap());
        assert!(distance(before, now) < 1e-15, "vertex {v}");
    }
    // Nothing is turned over.
    let mesh = limit_reference(&control, &Loop, 5).unwrap();
    let least = mesh.triangles().iter().map(|t| {
        let p = t.map(|v| mesh.positions()[v as usize]);
        twice_area(&p.map(|p| [p[0], p[1]]))
    });
    assert!(least.fold(f64::MAX, f64::min) > 0.0);
    assert_eq!(refined(&control).inverted_triangles(), 0);
}

#[test]
fn faces_keep_their_numbers_and_parts_know_theirs() {
    let sheet = fan(&[(0.0, 1.0), (130.0, 1.2), (200.0, 0.7), (270.0, 1.0)]);
    let corners = vec![crate::support::corner(0, f64::INFINITY)];
    let tagged = sheet
        .clone()
        .with_tags(crate::support::corners(corners))
        .unwrap();
    let (control, concave) = divided(tagged.clone());
    assert!(control.face_count() > sheet.face_count());
    let at = |mesh: &Mesh, face: u32, weights: [f64; 3]| -> Point {
        let corners = mesh.triangles()[face as usize].map(|v| mesh.positions()[v as usize]);
        core::array::from_fn(|axis| (0..3).map(|i| weights[i] * corners[i][axis]).sum())
    };
    let mut areas = vec![0.0; sheet.face_count()];
    for face in 0..control.face_count() as u32 {
        for weights in [
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.5, 0.25, 0.25],
        ] {
            let (whole, on_whole) = concave.parts.on_whole(face, weights);
            assert_eq!(whole, concave.parts.whole(face));
            assert!((face as usize) >= sheet.face_count() || whole == face);
            assert!((on_whole.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            let off = distance(at(&control, face, weights), at(&sheet, whole, on_whole));
            assert!(off < 1e-15, "face {face} is {off} from where it was");
        }
        areas[concave.parts.whole(face) as usize] +=
            distance(control.face_normal(limitmesh::FaceId(face)), [0.0; 3]);
    }
    for (face, area) in areas.iter().enumerate() {
        let whole = distance(sheet.face_normal(limitmesh::FaceId(face as u32)), [0.0; 3]);
        assert!((area - whole).abs() < 1e-14, "face {face}");
    }
}

#[test]
fn corners_of_boundaries_are_divided_too() {
    let outline = l_shape();
    let positions = outline.iter().map(|p| [p[0], p[1], 0.0]).collect();
    let flat =
        Mesh::from_triangles(positions, vec![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]]).unwrap();
    let (control, concave) = divided(flat.with_boundary(BoundaryRule::Fixed));
    assert_eq!(concave.corners.first, [3]);
    let refined = refined(&control);
    let area: f64 = refined
        .mesh
        .triangles()
        .iter()
        .map(|t| {
            let area = 0.5
                * twice_area(
                    &t.map(|v| refined.mesh.positions()[v as usize])
                        .map(|p| [p[0], p[1]]),
                );
            assert!(area > 0.0);
            area
        })
        .sum();
    assert!((area - 3.0).abs() < 1e-12);
    assert!(
        refined
            .mesh
            .positions()
            .iter()
            .all(|p| outside([p[0], p[1]], &outline) < 1e-12)
    );
}

/// A corner of 270° on a saddle: the sheet z = bend · x y, in two rings around the corner.
fn saddle(bend: f64) -> Mesh {
    let spokes = [0.0, 67.0, 135.0, 203.0, 270.0].map(|degrees| (degrees * DEGREE).sin_cos());
    let ring = |radius: f64| spokes.map(|(sine, cosine)| [radius * cosine, radius * sine]);
    let flat = core::iter::once([0.0; 2]).chain(ring(1.0)).chain(ring(2.0));
    let positions = flat.map(|[x, y]| [x, y, bend * x * y]).collect();
    let sectors = (1..5).flat_map(|i| [[0, i, i + 1], [i, i + 5, i + 6], [i, i + 6, i + 1]]);
    let corners = vec![crate::support::corner(0, f64::INFINITY)];
    let sheet = Mesh::from_triangles(positions, sectors.collect()).unwrap();
    sheet.with_tags(crate::support::corners(corners)).unwrap()
}

#[test]
fn a_curved_sector_that_is_divided_has_one_normal_at_its_corner() {
    for bend in [0.1, 0.2, 0.4] {
        let (control, concave) = divided(saddle(bend));
        assert_eq!((concave.edges, control.tags().creases.len()), (1, 1));
        let refined = refined(&control);
        assert_eq!(refined.inverted_triangles(), 0);
        // The normals of both sides are one at the corner, and differ as the saddle is bent along the line.
        let mesh = &refined.mesh;
        let (mut at_corner, mut most) = (f64::MAX, 0.0f64);
        for tag in &mesh.tags().creases {
            let [a, b] = tag.vertices.map(VertexId);
            let h = mesh.topology().edge_between(a, b).unwrap();
            let Some(twin) = mesh.topology().twin(h) else {
                continue;
            };
            for (left, right) in [(h, twin.next()), (h.next(), twin)] {
                let normals = [left, right].map(|corner| refined.corner_normal(corner));
                let degrees = 2.0 * (0.5 * distance(normals[0], normals[1])).asin() / DEGREE;
                most = most.max(degrees);
                if mesh.topology().origin(left).0 == 0 {
                    at_corner = degrees;
                }
            }
        }
        assert!(at_corner < 1e-6, "bend {bend}: {at_corner}° at the corner");
        assert!(most < 40.0 * bend, "bend {bend}: {most}° across the line");
    }
}

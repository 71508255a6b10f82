//! The limit surface as an object, against closed forms, differences of points, and the theorem of Gauss and Bonnet.

#![allow(missing_docs, clippy::unwrap_used)]

use crate::support::{crease, mapped, octahedron};
use limitmesh::mesh::BuildOptions;
use limitmesh::scheme::{CatmullClark, Loop, ModifiedButterfly, Scheme};
use limitmesh::{FaceId, LimitSurface, Mesh, PolygonSoup, QuadControl};

#[track_caller]
fn near(found: f64, expected: f64, within: f64) {
    assert!(
        (found - expected).abs() <= within * expected.abs().max(1.0),
        "{found} and {expected}"
    );
}

/// The corners of a solid, each face counter-clockwise from outside.
fn solid(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> Mesh {
    Mesh::from_triangles(positions.to_vec(), triangles.to_vec()).unwrap()
}

fn tetrahedron() -> Mesh {
    let positions = [
        [1.0, 1.0, 1.0],
        [1.0, -1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
    ];
    solid(&positions, &[[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
}

fn icosahedron() -> Mesh {
    let golden = 0.5 * (1.0 + 5f64.sqrt());
    let mut positions: Vec<[f64; 3]> = Vec::new();
    for axis in 0..3 {
        for [a, b] in [
            [1.0, golden],
            [1.0, -golden],
            [-1.0, golden],
            [-1.0, -golden],
        ] {
            let mut position = [0.0; 3];
            (position[(axis + 1) % 3], position[(axis + 2) % 3]) = (a, b);
            positions.push(position);
        }
    }
    // Its edges are 2 long.
    let from =
        |a: u32, b: u32| [0, 1, 2].map(|i| positions[b as usize][i] - positions[a as usize][i]);
    let is_edge =
        |a: u32, b: u32| (from(a, b).iter().map(|x| x * x).sum::<f64>() - 4.0).abs() < 1e-9;
    let mut triangles = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in (b + 1..12).filter(|&c| is_edge(a, b) && is_edge(b, c) && is_edge(c, a)) {
                let ([u, v], p) = ([from(a, b), from(a, c)], positions[a as usize]);
                let cross = [0, 1, 2]
                    .map(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
                let is_outwards = (0..3).map(|k| cross[k] * p[k]).sum::<f64>() > 0.0;
                triangles.push(if is_outwards { [a, b, c] } else { [a, c, b] });
            }
        }
    }
    solid(&positions, &triangles)
}

/// A lattice of unit triangles, with control heights.
fn lattice(height: impl Fn(f64, f64) -> f64) -> Mesh {
    const SIDE: u32 = 7;
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for j in 0..SIDE {
        for i in 0..SIDE {
            let (x, y) = (
                f64::from(i) - 3.0 + 0.5 * (f64::from(j) - 3.0),
                0.75f64.sqrt() * (f64::from(j) - 3.0),
            );
            positions.push([x, y, height(x, y)]);
            if i + 1 < SIDE && j + 1 < SIDE {
                let at = j * SIDE + i;
                triangles.push([at, at + 1, at + SIDE]);
                triangles.push([at + 1, at + SIDE + 1, at + SIDE]);
            }
        }
    }
    Mesh::from_triangles(positions, triangles).unwrap()
}

/// Places that are spread over a triangle, away from its corners.
fn places() -> Vec<[f64; 3]> {
    (0..60)
        .map(|i| {
            let [u, v] = [0.618_033_988_75, 0.754_877_666_25]
                .map(|step| (0.5 + step * f64::from(i)).fract());
            let [u, v] = if u + v > 1.0 {
                [1.0 - u, 1.0 - v]
            } else {
                [u, v]
            };
            [1.0 - u - v, u, v]
        })
        .collect()
}

/// Polynomials up to the third degree have simple control heights on a regular lattice (differences of the box spline's moments).
#[test]
fn polynomials_are_reproduced_with_their_derivatives() {
    // x² + y², xy, x³ and x²y.
    type Height = fn(f64, f64) -> f64;
    type Second = fn(f64, f64) -> [f64; 3];
    let cases: [(Height, Height, Second); 4] = [
        (
            |x, y| x * x + y * y - 0.5,
            |x, y| x * x + y * y,
            |_, _| [2.0, 0.0, 2.0],
        ),
        (|x, y| x * y, |x, y| x * y, |_, _| [0.0, 1.0, 0.0]),
        (
            |x, _| x * x * x - 0.75 * x,
            |x, _| x * x * x,
            |x, _| [6.0 * x, 0.0, 0.0],
        ),
        (
            |x, y| x * x * y - 0.25 * y,
            |x, y| x * x * y,
            |x, y| [2.0 * y, 2.0 * x, 0.0],
        ),
    ];
    for (control, height, second) in cases {
        let mesh = lattice(control);
        let surface = LimitSurface::new(&mesh, &Loop).unwrap();
        let inner = (0..mesh.face_count() as u32).filter(|&face| {
            mesh.triangles()[face as usize]
                .iter()
                .all(|&v| (2..5).contains(&(v % 7)) && (2..5).contains(&(v / 7)))
        });
        for face in inner {
            for at in places() {
                let found = surface.derivatives(FaceId(face), at).unwrap();
                let [x, y, z] = found.position;
                near(z, height(x, y), 1e-13);
                // Positions in the plane are affine, so that second derivatives of heights follow by the chain rule.
                let [xx, xy, yy] = second(x, y);
                let [a, b] = found.first.map(|first| [first[0], first[1]]);
                let of = |a: [f64; 2], b: [f64; 2]| {
                    a[0] * b[0] * xx + (a[0] * b[1] + a[1] * b[0]) * xy + a[1] * b[1] * yy
                };
                for (found, expected) in found.second.iter().zip([of(a, a), of(a, b), of(b, b)]) {
                    near(found[0], 0.0, 1e-12);
                    near(found[1], 0.0, 1e-12);
                    near(found[2], expected, 1e-11);
                }
            }
        }
    }
}

#[test]
fn a_paraboloid_bends_as_it_does() {
    let mesh = lattice(|x, y| x * x + y * y - 0.5);
    let surface = LimitSurface::new(&mesh, &Loop).unwrap();
    for at in places() {
        let found = surface.derivatives(FaceId(2 * (3 * 6 + 3)), at).unwrap();
        let [x, y, _] = found.position;
        let squared = x * x + y * y;
        let curvature = found.curvature().unwrap();
        near(
            curvature.gaussian,
            4.0 / (1.0 + 4.0 * squared).powi(2),
            1e-12,
        );
        near(
            curvature.mean,
            (2.0 + 4.0 * squared) / (1.0 + 4.0 * squared).powf(1.5),
            1e-12,
        );
        let [most, least] = curvature.principal;
        near(most * least, curvature.gaussian, 1e-12);
        near(most + least, 2.0 * curvature.mean, 1e-12);
        // Around the axis it bends by 2/√(1 + 4r²), along the way there by less.
        near(most, 2.0 / (1.0 + 4.0 * squared).sqrt(), 1e-12);
        let around = [-y, x].map(|part| part / squared.sqrt());
        near(
            (curvature.directions[0][0] * around[0] + curvature.directions[0][1] * around[1]).abs(),
            1.0,
            1e-9,
        );
        let normal = found.normal().unwrap();
        for direction in curvature.directions {
            near((0..3).map(|i| direction[i] * normal[i]).sum(), 0.0, 1e-12);
        }
    }
}

/// Expected values: rational ones by hand from the masks, others from a computation in higher precision that shares no code with this.
#[test]
fn solids_bend_as_they_should() {
    let cases = [
        (
            icosahedron(),
            [2.029360270416, -1.433382573510],
            [1.762285960192, -1.327511190232],
        ),
        (
            octahedron(),
            [5.983379501385, -2.531187639857],
            [3.848001180091, -1.961632274431],
        ),
    ];
    for (mesh, edge, centre) in cases {
        let surface = LimitSurface::new(&mesh, &Loop).unwrap();
        let size = mesh.positions()[0]
            .iter()
            .map(|x| x * x)
            .sum::<f64>()
            .sqrt();
        for face in 0..mesh.face_count() as u32 {
            for (at, [gaussian, mean]) in [
                ([0.5, 0.5, 0.0], edge),
                ([0.0, 0.5, 0.5], edge),
                ([1.0 / 3.0; 3], centre),
            ] {
                let found = surface
                    .derivatives(FaceId(face), at)
                    .unwrap()
                    .curvature()
                    .unwrap();
                near(found.gaussian * size * size, gaussian, 1e-10);
                near(found.mean * size, mean, 1e-10);
            }
        }
    }
    let mesh = tetrahedron();
    let surface = LimitSurface::new(&mesh, &Loop).unwrap();
    let edge = surface
        .derivatives(FaceId(0), [0.5, 0.0, 0.5])
        .unwrap()
        .curvature()
        .unwrap();
    near(edge.gaussian, 15.75, 1e-11);
    near(edge.mean, -4.625, 1e-11);
    let mesh = octahedron();
    let found = LimitSurface::new(&mesh, &Loop)
        .unwrap()
        .derivatives(FaceId(0), [0.5, 0.3, 0.2])
        .unwrap();
    for (found, expected) in found
        .position
        .into_iter()
        .zip([0.32634375, 0.20559375, 0.144])
    {
        near(found, expected, 1e-15);
    }
}

/// Volumes and areas of unit solids: extrapolated from uniform refinements by other code, whose last digits agree.
#[test]
fn volumes_and_areas() {
    let cases = [
        (octahedron(), 0.303_854_909_279),
        (tetrahedron(), 0.102_993_114_295),
    ];
    for (mesh, volume) in cases {
        let found = LimitSurface::new(&mesh, &Loop).unwrap().volume().unwrap();
        near(found / volume, 1.0, 1e-10);
        // It is the same far from the origin, and grows with the third power of lengths whatever they are.
        for (scale, power) in [(1e100, 1e300), (1e-100, 1e-300)] {
            let scaled = mapped(&mesh, |p| p.map(|x| x * scale));
            let surface = LimitSurface::new(&scaled, &Loop).unwrap();
            near(surface.volume().unwrap() / power / found, 1.0, 1e-12);
            let area = LimitSurface::new(&mesh, &Loop).unwrap().area().unwrap();
            near(surface.area().unwrap() / scale / scale / area, 1.0, 1e-12);
        }
        let huge = mapped(&mesh, |p| p.map(|x| x * 1e200));
        assert_eq!(LimitSurface::new(&huge, &Loop).unwrap().volume(), None);
        let moved = mapped(&mesh, |p| p.map(|x| x + 2f64.powi(40)));
        near(
            LimitSurface::new(&moved, &Loop).unwrap().volume().unwrap(),
            found,
            1e-9,
        );
    }
    let mesh = icosahedron();
    let size = mesh.positions()[0]
        .iter()
        .map(|x| x * x)
        .sum::<f64>()
        .sqrt();
    let surface = LimitSurface::new(&mesh, &Loop).unwrap();
    near(surface.volume().unwrap() / size.powi(3), 1.45042605, 2e-8);
    // Compared with triangles between points of the surface, which are below it by a quarter with
    // each level.
    let area = |levels: u32| -> f64 {
        let n = 1u32 << levels;
        let at = |i: u32, j: u32| {
            let [u, v] = [i, j].map(|x| f64::from(x) / f64::from(n));
            [1.0 - u - v, u, v]
        };
        let mut sum = 0.0;
        for i in 0..n {
            for j in 0..n - i {
                let mut add = |places: [[f64; 3]; 3]| {
                    let [a, b, c] = places.map(|place| surface.at(FaceId(0), place).position);
                    let [u, v] = [b, c].map(|p| [0, 1, 2].map(|k| p[k] - a[k]));
                    let cross = [0, 1, 2]
                        .map(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
                    sum += 0.5 * cross.iter().map(|x| x * x).sum::<f64>().sqrt();
                };
                add([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 2 <= n {
                    add([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
        20.0 * sum
    };
    let (coarse, fine) = (area(5), area(6));
    let expected = fine + (fine - coarse) / 3.0;
    near(surface.area().unwrap() / expected, 1.0, 1e-6);

    let sheet = lattice(|_, _| 0.0);
    let flat = LimitSurface::new(&sheet, &Loop).unwrap();
    assert_eq!(flat.volume(), None);
    // Control points of a sheet without bends keep the surface in its plane; its smooth boundary rounds the two sharp corners off.
    assert!(flat.area().unwrap() < 36.0 * 0.75f64.sqrt());
    let other = LimitSurface::new(&mesh, &ModifiedButterfly).unwrap();
    assert_eq!(
        (
            other.area(),
            other.volume(),
            other.derivatives(FaceId(0), [1.0 / 3.0; 3])
        ),
        (None, None, None)
    );
}

/// ∫ K dA = 4π over a sphere, whatever its shape: a test of second derivatives and areas as a whole.
#[test]
fn curvature_adds_up_to_the_sphere() {
    for mesh in [octahedron(), icosahedron()] {
        let surface = LimitSurface::new(&mesh, &Loop).unwrap();
        // The midpoint rule at places whose density grows towards the corners, as curvature does not.
        let n = 48;
        let mut total = 0.0;
        let mut area = 0.0;
        for face in 0..mesh.face_count() as u32 {
            for i in 0..n {
                for j in 0..n {
                    let (x, y) = (
                        (f64::from(i) + 0.5) / f64::from(n),
                        (f64::from(j) + 0.5) / f64::from(n),
                    );
                    let at = [1.0 - x, x * (1.0 - y), x * y];
                    let found = surface.derivatives(FaceId(face), at).unwrap();
                    let [u, v] = found.first;
                    let cross = [0, 1, 2]
                        .map(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
                    let density =
                        x * cross.iter().map(|x| x * x).sum::<f64>().sqrt() / f64::from(n * n);
                    area += density;
                    total += density * found.curvature().unwrap().gaussian;
                }
            }
        }
        near(total / (4.0 * core::f64::consts::PI), 1.0, 2e-3);
        near(area / surface.area().unwrap(), 1.0, 2e-3);
    }
}

/// A fan around a vertex of that valence, and two rings more, bent.
fn fan(valence: u32) -> Mesh {
    let mut positions = vec![[0.0, 0.0, 0.3]];
    let mut triangles = Vec::new();
    for ring in 1..4u32 {
        for i in 0..valence * ring {
            let angle = core::f64::consts::TAU * f64::from(i) / f64::from(valence * ring);
            let (x, y) = (f64::from(ring) * angle.cos(), f64::from(ring) * angle.sin());
            positions.push([
                x,
                y,
                0.3 - 0.1 * (x * x + 0.4 * y * y) + 0.03 * x * y + 0.02 * x,
            ]);
        }
    }
    let start = |ring: u32| {
        if ring == 0 {
            0
        } else {
            1 + valence * ring * (ring - 1) / 2
        }
    };
    let at = |ring: u32, i: u32| {
        if ring == 0 {
            0
        } else {
            start(ring) + i % (valence * ring)
        }
    };
    for ring in 0..3 {
        for sector in 0..valence {
            for i in 0..=ring {
                let (outer, inner) = (sector * (ring + 1) + i, sector * ring + i);
                triangles.push([
                    at(ring, inner),
                    at(ring + 1, outer),
                    at(ring + 1, outer + 1),
                ]);
                if i < ring {
                    triangles.push([
                        at(ring, inner),
                        at(ring + 1, outer + 1),
                        at(ring, inner + 1),
                    ]);
                }
            }
        }
    }
    Mesh::from_triangles(positions, triangles).unwrap()
}

#[test]
fn derivatives_are_limits_of_differences() {
    for valence in [3, 4, 5, 7, 8, 12] {
        let mesh = fan(valence);
        let surface = LimitSurface::new(&mesh, &Loop).unwrap();
        for face in 0..valence + 4 {
            for at in places()
                .into_iter()
                .filter(|at| at.iter().all(|&weight| weight > 0.02))
            {
                let found = surface.derivatives(FaceId(face), at).unwrap();
                let h = 1e-4;
                let moved = |u: f64, v: f64| {
                    surface
                        .derivatives(FaceId(face), [at[0] - u - v, at[1] + u, at[2] + v])
                        .unwrap()
                };
                for axis in 0..3 {
                    near(
                        found.position[axis],
                        surface.at(FaceId(face), at).position[axis],
                        1e-14,
                    );
                    for (k, [u, v]) in [[h, 0.0], [0.0, h]].into_iter().enumerate() {
                        let (after, before) = (moved(u, v), moved(-u, -v));
                        near(
                            found.first[k][axis],
                            (after.position[axis] - before.position[axis]) / (2.0 * h),
                            1e-6,
                        );
                        near(
                            found.second[k][axis],
                            (after.first[0][axis] - before.first[0][axis]) / (2.0 * h),
                            1e-4,
                        );
                        near(
                            found.second[k + 1][axis],
                            (after.first[1][axis] - before.first[1][axis]) / (2.0 * h),
                            1e-4,
                        );
                    }
                }
            }
        }
    }
}

/// Normals keep all their digits however near an irregular vertex they are.
#[test]
fn normals_beside_irregular_vertices_are_exact() {
    for valence in [3, 4, 5, 7, 8] {
        let mesh = fan(valence);
        let surface = LimitSurface::new(&mesh, &Loop).unwrap();
        for face in 0..valence {
            let corner = mesh.triangles()[face as usize]
                .iter()
                .position(|&v| v == 0)
                .unwrap();
            let limit = surface
                .at(
                    FaceId(face),
                    core::array::from_fn(|i| f64::from(u8::from(i == corner))),
                )
                .normal;
            let mut at = [0.0; 3];
            (at[corner], at[(corner + 1) % 3], at[(corner + 2) % 3]) =
                (1.0, 0.3 * 2f64.powi(-100), 0.4 * 2f64.powi(-100));
            let found = surface.derivatives(FaceId(face), at).unwrap();
            for (found, limit) in found.normal().unwrap().into_iter().zip(limit) {
                near(found, limit, 1e-13);
            }
            assert!(
                surface
                    .derivatives(
                        FaceId(face),
                        core::array::from_fn(|i| f64::from(u8::from(i == corner)))
                    )
                    .is_none()
            );
        }
    }
}

#[test]
fn both_sides_of_an_edge_agree() {
    let mesh = fan(7);
    let surface = LimitSurface::new(&mesh, &Loop).unwrap();
    let topology = mesh.topology();
    for h in topology.half_edges() {
        let Some(twin) = topology.twin(h) else {
            continue;
        };
        let at = |corner: usize, weight: f64| {
            let mut at = [0.0; 3];
            (at[corner], at[(corner + 1) % 3]) = (1.0 - weight, weight);
            at
        };
        let one = surface
            .derivatives(h.face(), at(h.corner(), 0.375))
            .unwrap();
        let other = surface
            .derivatives(twin.face(), at(twin.corner(), 0.625))
            .unwrap();
        let (normals, positions) = (
            [one, other].map(|it| it.normal().unwrap()),
            [one, other].map(|it| it.position),
        );
        for axis in 0..3 {
            near(positions[0][axis], positions[1][axis], 1e-13);
            near(normals[0][axis], normals[1][axis], 1e-13);
        }
    }
}

#[test]
fn places_that_are_none_have_no_derivatives() {
    let mesh = octahedron();
    let surface = LimitSurface::new(&mesh, &Loop).unwrap();
    let inf = f64::INFINITY;
    for at in [
        [-0.1, 0.6, 0.5],
        [f64::NAN, 0.5, 0.5],
        [inf, 0.0, 0.0],
        [0.9, 0.9, 0.9],
        [0.0; 3],
    ] {
        assert_eq!(surface.derivatives(FaceId(0), at), None, "{at:?}");
    }
    assert_eq!(surface.derivatives(FaceId(8), [1.0 / 3.0; 3]), None);
    let all = [
        (FaceId(0), [1.0 / 3.0; 3]),
        (FaceId(8), [1.0 / 3.0; 3]),
        (FaceId(3), [0.2, 0.3, 0.5]),
    ];
    let found = surface.derivatives_at(&all);
    assert_eq!(found, all.map(|(face, at)| surface.derivatives(face, at)));
}

/// The point is the weighted sum of control points, by another mesh's points as well: weights do not know positions.
#[test]
fn weights_give_the_points() {
    let spread = [FaceId(0), FaceId(3), FaceId(6)];
    for name in ["cup", "sheet", "spike", "tetrahedron"] {
        let soup = limitmesh_models::find(name).unwrap().soup();
        let mesh = Mesh::from_soup(&soup, &Default::default()).unwrap().0;
        let [a, b, _] = mesh.triangles()[0];
        let creases = vec![crease([a, b], 1.5)];
        let tagged = mesh
            .clone()
            .with_tags(crate::support::creases(creases))
            .unwrap();
        for mesh in [mesh, tagged] {
            let faces = spread
                .into_iter()
                .filter(|face| face.index() < mesh.face_count());
            let at: Vec<(FaceId, [f64; 3])> = faces
                .flat_map(|face| places().into_iter().take(9).map(move |at| (face, at)))
                .collect();
            let bent = |p: &[f64; 3]| {
                [
                    p[0] + 0.2 * p[1] * p[1],
                    p[1] - 0.3 * p[2] * p[0],
                    0.7 * p[2],
                ]
            };
            let moved = mesh
                .clone()
                .with_positions(mesh.positions().iter().map(bent).collect())
                .unwrap();
            for scheme in [&Loop as &dyn Scheme, &ModifiedButterfly] {
                let surface = LimitSurface::new(&mesh, scheme).unwrap();
                let elsewhere = LimitSurface::new(&moved, scheme).unwrap();
                let all = surface.weights_at(&at).unwrap();
                assert_eq!(all.len(), at.len());
                for (&(face, place), weights) in at.iter().zip(&all) {
                    assert!(weights.windows(2).all(|pair| pair[0].0 < pair[1].0));
                    near(weights.iter().map(|&(_, weight)| weight).sum(), 1.0, 1e-12);
                    for (mesh, surface) in [(&mesh, &surface), (&moved, &elsewhere)] {
                        let point = surface.at(face, place).position;
                        for (axis, &expected) in point.iter().enumerate() {
                            let sum = weights
                                .iter()
                                .map(|&(v, weight)| weight * mesh.positions()[v.index()][axis])
                                .sum();
                            near(sum, expected, 1e-12);
                        }
                    }
                    if scheme.name() == Loop.name() {
                        assert!(
                            weights.iter().all(|&(_, weight)| weight > -1e-15),
                            "{name}: {weights:?}"
                        );
                    }
                }
            }
        }
    }
}

/// The direction in which the surface leaves a vertex over an edge is that of differences, nearer and nearer to it.
#[test]
fn tangents_at_irregular_vertices_are_where_the_surface_goes() {
    let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
    let unit = |a: [f64; 3]| a.map(|x| x / dot(a, a).sqrt());
    for valence in [3, 4, 5, 7, 12] {
        let triangles = fan(valence);
        let mut soup = PolygonSoup {
            positions: triangles.positions().to_vec(),
            ..PolygonSoup::default()
        };
        triangles
            .triangles()
            .iter()
            .for_each(|t| soup.faces.push(t));
        let (quads, _) = QuadControl::from_soup(&soup, &BuildOptions::default()).unwrap();
        let quads = quads.mesh;
        for (mesh, scheme) in [
            (&triangles, &Loop as &dyn Scheme),
            (&triangles, &ModifiedButterfly),
            (&quads, &CatmullClark),
        ] {
            let surface = LimitSurface::new(mesh, scheme).unwrap();
            for face in mesh.topology().faces() {
                let corners = mesh.triangles()[face.index()];
                let Some(corner) = (0..3).find(|&i| corners[i] == 0) else {
                    continue;
                };
                let place = |share: f64, step: usize| {
                    let mut weights = [0.0; 3];
                    (weights[corner], weights[(corner + step) % 3]) = (1.0 - share, share);
                    weights
                };
                let [along, across] = surface.tangents_at_corner(face, place(0.0, 1)).unwrap();
                let at = surface.at(face, place(0.0, 1));
                let towards = |share: f64, step: usize| {
                    let beside = surface.at(face, place(share, step)).position;
                    unit([0, 1, 2].map(|i| beside[i] - at.position[i]))
                };
                // Both are in the plane, and turn as its normal says.
                near(dot(along, at.normal), 0.0, 1e-12);
                near(dot(across, at.normal), 0.0, 1e-12);
                let cross = [0, 1, 2].map(|i| {
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    along[j] * across[k] - along[k] * across[j]
                });
                assert!(dot(cross, at.normal) > 0.0, "{valence}");
                // The rest of the next pattern falls by a constant factor a level: over quads slowly, and only later alone.
                let off = |levels: i32| 1.0 - dot(along, towards(0.5f64.powi(levels), 1));
                below!(off(16), 1e-4, "{valence}");
                let [near, nearer] = if mesh.topology().has_quads() {
                    [16, 24]
                } else {
                    [8, 16]
                };
                below!(off(nearer), 0.6 * off(near) + 1e-9, "{valence}");
                // The other edge of the face leaves to the left of the first.
                assert!(dot(across, towards(0.5f64.powi(16), 2)) > 0.0, "{valence}");
            }
        }
    }
    let mesh = octahedron();
    let surface = LimitSurface::new(&mesh, &Loop).unwrap();
    assert_eq!(surface.tangents_at_corner(FaceId(0), [0.5, 0.5, 0.0]), None);
    assert_eq!(surface.tangents_at_corner(FaceId(8), [1.0, 0.0, 0.0]), None);
}

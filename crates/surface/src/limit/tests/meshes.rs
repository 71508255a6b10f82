//! Positions and normals on whole meshes: orientation, fallbacks, size, threads, and errors.

use super::{distance, unit};
use crate::index::VertexId;
use crate::limit::{LimitError, LimitTable};
use crate::mesh::{CornerTag, INFINITELY_SHARP, Mesh, Tags};
use crate::ring::{EdgeShape, RingShape};
use crate::scheme::{EdgeMask, Loop, LoopWarren, ModifiedButterfly, Scheme, Support, VertexMask};
use limitmesh_testing::Random;

const SCHEMES: [&dyn Scheme; 3] = [&Loop, &LoopWarren, &ModifiedButterfly];

/// Two poles of valence `around` and `rings` circles between them, on the unit sphere.
fn sphere(around: u32, rings: u32) -> Mesh {
    let mut positions = vec![[0.0, 0.0, 1.0]];
    for ring in 1..=rings {
        let (sine, cosine) =
            (core::f64::consts::PI * f64::from(ring) / f64::from(rings + 1)).sin_cos();
        for j in 0..around {
            let turn =
                core::f64::consts::TAU * (f64::from(j) + 0.5 * f64::from(ring)) / f64::from(around);
            positions.push([sine * turn.cos(), sine * turn.sin(), cosine]);
        }
    }
    let south = positions.len() as u32;
    positions.push([0.0, 0.0, -1.0]);
    let at = |ring: u32, j: u32| 1 + ring * around + j % around;
    let mut triangles = Vec::new();
    for j in 0..around {
        triangles.push([0, at(0, j), at(0, j + 1)]);
        triangles.push([south, at(rings - 1, j + 1), at(rings - 1, j)]);
        for ring in 0..rings - 1 {
            triangles.push([at(ring, j), at(ring + 1, j), at(ring, j + 1)]);
            triangles.push([at(ring + 1, j), at(ring + 1, j + 1), at(ring, j + 1)]);
        }
    }
    Mesh::from_triangles(positions, triangles).unwrap()
}

/// A hilly sheet of n × n cells.
fn sheet(n: u32) -> Mesh {
    let mut random = Random::new(u64::from(n));
    let height = |i: u32, j: u32, wobble: f64| {
        (f64::from(i) * 0.7).sin() + (f64::from(j) * 0.4).cos() + 0.1 * wobble
    };
    let positions = (0..=n)
        .flat_map(|j| (0..=n).map(move |i| (i, j)))
        .map(|(i, j)| [f64::from(i), f64::from(j), height(i, j, random.signed())])
        .collect();
    let at = |i: u32, j: u32| j * (n + 1) + i;
    let cells = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
    let triangles = cells
        .flat_map(|(i, j)| {
            [
                [at(i, j), at(i + 1, j), at(i + 1, j + 1)],
                [at(i, j), at(i + 1, j + 1), at(i, j + 1)],
            ]
        })
        .collect();
    Mesh::from_triangles(positions, triangles).unwrap()
}

#[test]
fn normals_of_a_sphere_point_outside() {
    for scheme in SCHEMES {
        for mesh in [sphere(6, 5), sphere(3, 3), sphere(17, 9)] {
            let table = LimitTable::new(scheme);
            let positions = table.positions(&mesh).unwrap();
            for (v, normal) in table.normals(&mesh).unwrap().into_iter().enumerate() {
                let outside = unit(positions[v]);
                let along: f64 = (0..3).map(|axis| outside[axis] * normal[axis]).sum();
                assert!(along > 0.9, "{} vertex {v}: {along}", scheme.name());
                assert!((normal.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-14);
            }
        }
    }
}

/// The butterfly interpolates; Loop's limit of a sphere's vertices lies inside.
#[test]
fn positions_of_a_sphere() {
    let mesh = sphere(8, 7);
    assert_eq!(
        LimitTable::new(&ModifiedButterfly)
            .positions(&mesh)
            .unwrap(),
        mesh.positions()
    );
    for position in LimitTable::new(&Loop).positions(&mesh).unwrap() {
        let radius = distance(position, [0.0; 3]);
        assert!(radius < 1.0 && radius > 0.8, "{radius}");
    }
}

/// One vertex at a time gives the limits of the whole mesh, with irregular neighbours, boundaries
/// and corners.
#[test]
fn single_vertices_agree_with_the_mesh() {
    for scheme in SCHEMES {
        for mesh in [sphere(7, 4), sheet(6), with_corners(sheet(5))] {
            let table = LimitTable::new(scheme);
            let (positions, normals) = (
                table.positions(&mesh).unwrap(),
                table.normals(&mesh).unwrap(),
            );
            for v in 0..mesh.vertex_count() {
                let vertex = VertexId(v as u32);
                assert_eq!(
                    table.position(&mesh, vertex).unwrap(),
                    positions[v],
                    "{}",
                    scheme.name()
                );
                assert_eq!(
                    table.normal(&mesh, vertex).unwrap(),
                    normals[v],
                    "{}",
                    scheme.name()
                );
            }
        }
    }
}

fn with_corners(mesh: Mesh) -> Mesh {
    let corner = |vertex| CornerTag {
        vertex,
        sharpness: INFINITELY_SHARP,
    };
    // Two corners of the sheet, a point of its boundary, and one inside.
    let corners = [0, 2, 14, 35].map(corner).to_vec();
    mesh.with_tags(Tags {
        creases: Vec::new(),
        corners,
    })
    .unwrap()
}

#[test]
fn corners_keep_their_place() {
    let mesh = with_corners(sheet(5));
    for scheme in SCHEMES {
        let positions = LimitTable::new(scheme).positions(&mesh).unwrap();
        for v in [0, 2, 14, 35] {
            assert_eq!(positions[v], mesh.positions()[v]);
        }
    }
}

/// Where there is no tangent plane: the average of the faces' normals, weighted by area.
#[test]
fn cones_fall_back_to_the_faces() {
    let mesh = with_corners(sheet(5));
    let normal = LimitTable::new(&Loop).normal(&mesh, VertexId(14)).unwrap();
    let mut sum = [0.0; 3];
    for h in mesh.topology().outgoing_ring(VertexId(14)) {
        let face = mesh.face_normal(h.face());
        (0..3).for_each(|axis| sum[axis] += face[axis]);
    }
    assert!(distance(normal, unit(sum)) < 1e-14);
}

/// Tiny and huge meshes lose nothing; a mesh shrunk to a point has no normals, and nothing goes wrong.
#[test]
fn normals_do_not_depend_on_size() {
    for scheme in SCHEMES {
        let mesh = sheet(4);
        let table = LimitTable::new(scheme);
        let expected = table.normals(&mesh).unwrap();
        for scale in [1e-200, 1e-30, 1e30, 1e200] {
            let scaled = mesh
                .positions()
                .iter()
                .map(|p| p.map(|x| x * scale))
                .collect();
            let scaled = mesh.clone().with_positions(scaled).unwrap();
            for (met, expected) in table.normals(&scaled).unwrap().into_iter().zip(&expected) {
                assert!(
                    distance(met, *expected) < 1e-12,
                    "{} {scale:e}",
                    scheme.name()
                );
            }
        }
        let point = mesh
            .clone()
            .with_positions(vec![[3.0, 1.0, 2.0]; mesh.vertex_count()])
            .unwrap();
        assert!(
            table
                .normals(&point)
                .unwrap()
                .iter()
                .all(|normal| *normal == [0.0; 3])
        );
        let line = (0..mesh.vertex_count())
            .map(|v| [v as f64, 0.0, 0.0])
            .collect();
        let line = mesh.with_positions(line).unwrap();
        assert!(
            table
                .normals(&line)
                .unwrap()
                .iter()
                .all(|normal| *normal == [0.0; 3])
        );
    }
}

/// Two triangles glued along all their edges: every ring has two edges, the least a closed mesh can have.
#[test]
fn pillows_are_survived() {
    let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let mesh = Mesh::from_triangles(positions, vec![[0, 1, 2], [0, 2, 1]]).unwrap();
    for scheme in SCHEMES {
        let table = LimitTable::new(scheme);
        assert!(
            table
                .positions(&mesh)
                .unwrap()
                .iter()
                .flatten()
                .all(|x| x.is_finite())
        );
        assert!(
            table
                .normals(&mesh)
                .unwrap()
                .iter()
                .all(|normal| *normal == [0.0; 3])
        );
    }
}

/// A single triangle has its own normal at all three tips.
#[test]
fn single_triangle() {
    let positions = vec![[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 2.0, 1.0]];
    let mesh = Mesh::from_triangles(positions, vec![[0, 1, 2]]).unwrap();
    for scheme in SCHEMES {
        for normal in LimitTable::new(scheme).normals(&mesh).unwrap() {
            assert!(
                distance(normal, [0.0, 0.0, 1.0]) < 1e-14,
                "{}: {normal:?}",
                scheme.name()
            );
        }
    }
}

/// Loop's masks, broken in one way each.
struct Broken(&'static str);

impl Scheme for Broken {
    fn name(&self) -> &str {
        self.0
    }

    fn support(&self) -> Support {
        Support::OneRing
    }

    fn vertex_mask(&self, shape: RingShape) -> VertexMask {
        let mut mask = Loop.vertex_mask(shape);
        match self.0 {
            "sum" => mask.centre += 0.01,
            "size" => mask.ring.push(0.0),
            "turn" => (mask.ring[0], mask.ring[1]) = (mask.ring[0] + 0.1, mask.ring[1] - 0.1),
            "boundary" if shape.open => {
                (mask.centre, mask.ring[1]) = (mask.centre - 0.1, mask.ring[1] + 0.1)
            }
            "grow" if !shape.open => {
                mask.ring.iter_mut().for_each(|weight| *weight -= 1.0);
                mask.centre += f64::from(shape.valence);
            }
            "nan" => mask.centre = f64::NAN,
            "corner" if shape.corner => (mask.centre, mask.ring[0]) = (0.9, 0.1),
            _ => {}
        }
        mask
    }

    fn edge_mask(&self, shape: EdgeShape) -> EdgeMask {
        let mut mask = Loop.edge_mask(shape);
        if self.0 == "reach" && shape.target.valence > 4 {
            (mask.target_ring[3], mask.origin) = (0.1, mask.origin - 0.1);
        }
        mask
    }
}

#[test]
fn masks_that_break_the_contract_are_named() {
    let corner = RingShape {
        corner: true,
        ..RingShape::boundary(4)
    };
    let cases = [
        ("sum", RingShape::interior(5), "sum to"),
        ("size", RingShape::interior(5), "weights, expected"),
        ("turn", RingShape::interior(5), "same weight"),
        ("boundary", RingShape::boundary(5), "boundary vertices only"),
        ("grow", RingShape::interior(5), "must shrink"),
        ("nan", RingShape::interior(5), "sum to"),
        ("corner", corner, "keep its place"),
        ("reach", RingShape::interior(5), "outside the one-ring"),
    ];
    for (name, shape, expected) in cases {
        let scheme = Broken(name);
        let error = LimitTable::new(&scheme).stencil(shape).unwrap_err();
        let LimitError::Unsuitable {
            scheme,
            shape: met,
            what,
        } = &error
        else {
            panic!("{name}: {error}");
        };
        assert!(
            scheme == name && *met == shape && what.contains(expected),
            "{name}: {error}"
        );
    }
    for valence in [0, 1] {
        for shape in [
            RingShape::interior(valence),
            RingShape {
                valence,
                open: true,
                corner: false,
                dart: false,
            },
        ] {
            assert!(LimitTable::new(&Loop).stencil(shape).is_err());
        }
    }
}

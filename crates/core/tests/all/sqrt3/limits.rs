use limitmesh::limit::TangentPlane;
use limitmesh::refine::UniformOptions;
use limitmesh::sqrt3::{limit_normals, limit_positions, tangent_plane, uniform};
use limitmesh::{HalfEdgeId, Mesh, VertexId};

use crate::sqrt3::models::{creased, icosahedron, sharp, smooth, tetrahedron};
use crate::sqrt3::uniform::levels;
use crate::support::{Point, distance, octahedron};

/// A hexagonal patch of the regular lattice with unit edges, with heights over it.
pub(crate) fn lattice(radius: i32, height: impl Fn(f64, f64) -> f64) -> Mesh {
    let mut positions = Vec::new();
    let mut number = std::collections::BTreeMap::new();
    for i in -radius..=radius {
        for j in -radius..=radius {
            if (i + j).abs() <= radius {
                let (x, y) = (
                    f64::from(i) + 0.5 * f64::from(j),
                    0.75f64.sqrt() * f64::from(j),
                );
                number.insert((i, j), positions.len() as u32);
                positions.push([x, y, height(x, y)]);
            }
        }
    }
    let mut triangles = Vec::new();
    for (i, j) in (-radius..radius).flat_map(|i| (-radius..radius).map(move |j| (i, j))) {
        for corners in [
            [(i, j), (i + 1, j), (i, j + 1)],
            [(i + 1, j), (i + 1, j + 1), (i, j + 1)],
        ] {
            let found: Vec<u32> = corners
                .iter()
                .filter_map(|place| number.get(place))
                .copied()
                .collect();
            if let [a, b, c] = found[..] {
                triangles.push([a, b, c]);
            }
        }
    }
    Mesh::from_triangles(positions, triangles).unwrap()
}

/// A fan of `faces` triangles around vertex 0 on the rim of a bent sheet.
fn rim_fan(faces: usize) -> Mesh {
    let spoke = |j: usize| {
        let angle = std::f64::consts::PI * j as f64 / faces as f64;
        [
            angle.cos(),
            angle.sin(),
            0.3 * (2.0 * angle).sin() + 0.1 * (j % 3) as f64,
        ]
    };
    let mut positions = vec![[0.0, 0.0, 0.2]];
    positions.extend((0..=faces).map(spoke));
    let triangles = (1..=faces as u32).map(|j| [0, j, j + 1]).collect();
    Mesh::from_triangles(positions, triangles).unwrap()
}

fn angle_between(a: Point, b: Point) -> f64 {
    let dot: f64 = (0..3).map(|i| a[i] * b[i]).sum();
    let cross: Point =
        std::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
    cross.iter().map(|x| x * x).sum::<f64>().sqrt().atan2(dot)
}

#[test]
fn the_solids_have_their_known_limits() {
    let radius = |p: &Point| distance(*p, [0.0; 3]);
    for limit in limit_positions(&icosahedron()).unwrap() {
        assert!((radius(&limit) - (0.470074581 + 5.0 * 0.105985084 / 5f64.sqrt())).abs() < 1e-8);
    }
    for limit in limit_positions(&octahedron()).unwrap() {
        assert!((radius(&limit) - 3.0 / 7.0).abs() < 1e-15);
    }
    for (limit, corner) in limit_positions(&tetrahedron())
        .unwrap()
        .iter()
        .zip(tetrahedron().positions())
    {
        assert!(distance(*limit, corner.map(|x| x / 6.0)) < 1e-15);
    }
}

/// Quadratics that the scheme reproduces: heights that are less by 1/2 of their mean curvature's share.
#[test]
fn quadratics_are_reproduced_on_the_lattice() {
    let bowl = lattice(6, |x, y| x * x + y * y - 0.5);
    let saddle = lattice(6, |x, y| x * y);
    let (limits, normals) = (
        limit_positions(&bowl).unwrap(),
        limit_normals(&bowl).unwrap(),
    );
    let flat = limit_positions(&saddle).unwrap();
    let mut compared = 0;
    for v in bowl
        .topology()
        .vertices()
        .filter(|&v| !bowl.topology().is_boundary(v))
    {
        let [x, y, z] = limits[v.index()];
        assert!((z - (x * x + y * y)).abs() < 1e-12);
        assert!(angle_between(normals.by_vertex()[v.index()], [-2.0 * x, -2.0 * y, 1.0]) < 1e-12);
        let [x, y, z] = flat[v.index()];
        assert!((z - x * y).abs() < 1e-12);
        compared += 1;
    }
    assert_eq!(compared, 91);
    // And at all levels, as far from the boundary as the step's masks reach.
    for level in 1..=4 {
        let refined = uniform(&bowl, &UniformOptions::default().levels(level).limit(true))
            .unwrap()
            .mesh;
        for [x, y, z] in refined
            .positions()
            .iter()
            .copied()
            .filter(|p| p[0].hypot(p[1]) < 2.5)
        {
            assert!((z - (x * x + y * y)).abs() < 1e-12, "level {level}");
        }
    }
}

/// The limit of a vertex is the same at every level, of which the steps know nothing.
#[test]
fn limits_do_not_change_with_the_level() {
    for (name, mesh) in smooth().into_iter().chain(sharp()) {
        let expected = limit_positions(&mesh).unwrap();
        for level in 1..=5 {
            let refined = uniform(&mesh, &UniformOptions::default().levels(level).limit(true))
                .unwrap()
                .mesh;
            for (v, &limit) in expected.iter().enumerate() {
                let off = distance(limit, refined.positions()[v]);
                assert!(off < 1e-13, "{name}, level {level}, vertex {v}: {off}");
            }
        }
        // The positions of the steps themselves.
        let deep = levels(&mesh, 6).mesh;
        for (v, &limit) in expected.iter().enumerate() {
            let (near, far) = (
                distance(limit, deep.positions()[v]),
                distance(limit, mesh.positions()[v]),
            );
            at_most!(near, 0.06 * far + 1e-13, "{name}, vertex {v}");
        }
    }
}

#[test]
fn normals_do_not_change_with_the_level() {
    for (name, mesh) in smooth().into_iter().chain(sharp()) {
        let expected = limit_normals(&mesh).unwrap();
        let all: Vec<Mesh> = (0..=4).map(|level| levels(&mesh, level).mesh).collect();
        for level in 1..=4 {
            let options = UniformOptions::default().levels(level).normals(true);
            let refined = uniform(&mesh, &options).unwrap();
            let normals = refined.normals.unwrap();
            for h in mesh.topology().half_edges() {
                let vertex = mesh.topology().origin(h);
                let planes = tangent_plane(&mesh, vertex).unwrap();
                if planes.iter().any(|&plane| plane != TangentPlane::Surface) {
                    continue;
                }
                // Half-edges keep their sides: 3h + 0 leaves from the same corner.
                let mut own = h;
                for pair in all[..=level].windows(2) {
                    let smooth = [Some(own), pair[0].topology().twin(own.previous())];
                    let leaves = |h: HalfEdgeId| pair[1].triangles()[h.index()][0] == vertex.0;
                    own = HalfEdgeId(
                        3 * smooth.into_iter().flatten().find(|&h| leaves(h)).unwrap().0,
                    );
                }
                let found = normals.at(refined.mesh.topology(), own);
                let off = angle_between(found, expected.at(mesh.topology(), h));
                assert!(off < 1e-9, "{name}, level {level}, {h}: {off}");
            }
        }
    }
}

/// The weights across a boundary in closed form: x on both boundary neighbours, sin(jθ) inside.
#[test]
fn normals_on_rims_are_those_of_the_closed_form() {
    for k in 3..=6usize {
        let mesh = rim_fan(k - 1);
        let at = |j: usize| mesh.positions()[j];
        let theta = std::f64::consts::PI / (k - 1) as f64;
        let sigma = 1.0 / (theta / 2.0).tan();
        let x = (3.0 * theta.sin() - 4.0 * sigma) / (3.0 * (1.0 + 2.0 * theta.cos()));
        let along: Point = std::array::from_fn(|i| at(1)[i] - at(k)[i]);
        let across: Point = std::array::from_fn(|i| {
            let inner: f64 = (1..=k - 2)
                .map(|j| (j as f64 * theta).sin() * at(j + 1)[i])
                .sum();
            inner + x * (at(1)[i] + at(k)[i]) + (-2.0 * x - sigma) * at(0)[i]
        });
        let expected: Point = std::array::from_fn(|i| {
            along[(i + 1) % 3] * across[(i + 2) % 3] - along[(i + 2) % 3] * across[(i + 1) % 3]
        });
        let found = limit_normals(&mesh).unwrap().by_vertex()[0];
        assert!(angle_between(found, expected) < 1e-9, "k = {k}");
        let position: Point = std::array::from_fn(|i| (at(1)[i] + 4.0 * at(0)[i] + at(k)[i]) / 6.0);
        assert!(distance(limit_positions(&mesh).unwrap()[0], position) < 1e-15);
        assert_eq!(
            tangent_plane(&mesh, VertexId(0)).unwrap(),
            [TangentPlane::Surface]
        );
    }
    // From seven edges on, patterns inside shrink no faster than the boundary.
    for k in 7..=10 {
        let planes = tangent_plane(&rim_fan(k - 1), VertexId(0)).unwrap();
        assert_ne!(planes, [TangentPlane::Surface], "k = {k}");
    }
}

/// A corner of three faces: the plane of its two sharp edges. A tip without edges has no plane.
#[test]
fn corners_have_the_plane_of_their_edges_or_none() {
    let mesh = creased(octahedron(), &[[0, 2], [2, 1], [4, 2], [2, 5]], &[]);
    let planes = tangent_plane(&mesh, VertexId(2)).unwrap();
    assert_eq!(planes, [TangentPlane::Surface; 4]);
    let normals = limit_normals(&mesh).unwrap();
    for h in mesh.topology().outgoing_ring(VertexId(2)) {
        let [a, b, c] = mesh.as_triangles().corners(h.face().index());
        let edge = |p: Point| -> Point { std::array::from_fn(|i| p[i] - a[i]) };
        let (p, q) = (edge(b), edge(c));
        let face: Point = std::array::from_fn(|i| {
            p[(i + 1) % 3] * q[(i + 2) % 3] - p[(i + 2) % 3] * q[(i + 1) % 3]
        });
        assert!(angle_between(normals.at(mesh.topology(), h), face) < 1e-12);
    }
    let tip = creased(octahedron(), &[], &[4]);
    assert_eq!(
        tangent_plane(&tip, VertexId(4)).unwrap(),
        [TangentPlane::None]
    );
}

/// Face normals far down tend to the limit normals.
#[test]
fn face_normals_tend_to_the_limit_normals() {
    for (name, mesh) in [
        ("icosahedron", icosahedron()),
        ("octahedron", octahedron()),
        ("torus", crate::support::torus(5, 4)),
    ] {
        let expected = limit_normals(&mesh).unwrap();
        let deep = levels(&mesh, 8).mesh;
        for v in mesh.topology().vertices() {
            let h = deep.topology().outgoing(v);
            let normal = deep.face_normal(h.face());
            let off = angle_between(normal, expected.by_vertex()[v.index()]);
            assert!(off < 0.1, "{name}, {v}: {off}");
        }
    }
}

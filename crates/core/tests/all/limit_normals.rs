//! Limit normals and positions against brute-force subdivision of real meshes with extraordinary vertices among
//! irregular neighbours, inside and on a boundary.
//!
//! The subdivision here is its own: it applies the masks face by face through the mesh's public interface and
//! crops the mesh round one vertex after each step. Rules commute with linear maps: after each step the vertex is
//! moved to the origin and its surroundings are mapped to a frame of two of their own directions, so that no
//! digits are lost to shrinking, and the map's inverse brings the normal back.

// Helpers of a test fail it by panicking.
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;

use limitmesh::limit::{LimitTable, TangentPlane};
use limitmesh::ring::EdgeShape;
use limitmesh::scheme::{Loop, LoopWarren, ModifiedButterfly, Scheme};
use limitmesh::{HalfEdgeId, Mesh, VertexId};

type Vector = [f64; 3];

fn add(a: Vector, b: Vector, weight: f64) -> Vector {
    [0, 1, 2].map(|axis| a[axis] + weight * b[axis])
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(a: Vector) -> Vector {
    a.map(|x| x / dot(a, a).sqrt())
}

/// The ring of a vertex, a closed one turned to start at `start`.
fn ring(mesh: &Mesh, vertex: VertexId, start: Option<VertexId>) -> Vec<VertexId> {
    let mut ring: Vec<VertexId> = mesh.topology().ring(vertex).collect();
    if let (Some(start), false) = (start, mesh.topology().is_boundary(vertex)) {
        let slot = ring.iter().position(|&u| u == start).unwrap();
        ring.rotate_left(slot);
    }
    ring
}

fn vertex_point(mesh: &Mesh, scheme: &dyn Scheme, vertex: VertexId) -> Vector {
    let mask = scheme.vertex_mask(mesh.ring_shape(vertex));
    let at = |v: VertexId| mesh.positions()[v.index()];
    let start = add([0.0; 3], at(vertex), mask.centre);
    ring(mesh, vertex, None)
        .into_iter()
        .zip(mask.ring)
        .fold(start, |sum, (u, weight)| add(sum, at(u), weight))
}

fn edge_point(mesh: &Mesh, scheme: &dyn Scheme, edge: HalfEdgeId) -> Vector {
    let [from, to] = mesh.topology().ends(edge);
    let (around_from, around_to) = (ring(mesh, from, Some(to)), ring(mesh, to, Some(from)));
    let slot = |ring: &[VertexId], other| ring.iter().position(|&u| u == other).unwrap() as u32;
    let mask = scheme.edge_mask(EdgeShape {
        origin: mesh.ring_shape(from),
        origin_slot: slot(&around_from, to),
        target: mesh.ring_shape(to),
        target_slot: slot(&around_to, from),
    });
    let at = |v: VertexId| mesh.positions()[v.index()];
    let mut sum = add(add([0.0; 3], at(from), mask.origin), at(to), mask.target);
    let weights = mask.origin_ring.iter().chain(&mask.target_ring);
    for (&u, &weight) in around_from.iter().chain(&around_to).zip(weights) {
        sum = add(sum, at(u), weight);
    }
    sum
}

/// One step of subdivision; vertex 0 stays vertex 0.
fn subdivided(mesh: &Mesh, scheme: &dyn Scheme) -> Mesh {
    let topology = mesh.topology();
    let mut positions: Vec<Vector> = topology
        .vertices()
        .map(|v| vertex_point(mesh, scheme, v))
        .collect();
    let mut new = BTreeMap::new();
    for h in topology.half_edges() {
        let [a, b] = topology.ends(h);
        new.entry((a.min(b), a.max(b))).or_insert_with(|| {
            positions.push(edge_point(mesh, scheme, h));
            positions.len() as u32 - 1
        });
    }
    let mut triangles = Vec::new();
    for &[a, b, c] in mesh.triangles() {
        let on = |p: u32, q: u32| new[&(VertexId(p.min(q)), VertexId(p.max(q)))];
        let (ab, bc, ca) = (on(a, b), on(b, c), on(c, a));
        triangles.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
    }
    Mesh::from_triangles(positions, triangles).unwrap()
}

/// The faces within `radius` edges of vertex 0, which stays vertex 0.
fn cropped(mesh: &Mesh, radius: usize) -> Mesh {
    let mut distance = vec![usize::MAX; mesh.vertex_count()];
    distance[0] = 0;
    for step in 1..=radius {
        for v in 0..mesh.vertex_count() {
            if distance[v] == step - 1 {
                for u in mesh.topology().ring(VertexId(v as u32)) {
                    distance[u.index()] = distance[u.index()].min(step);
                }
            }
        }
    }
    let mut index = vec![u32::MAX; mesh.vertex_count()];
    let mut positions = Vec::new();
    for v in 0..mesh.vertex_count() {
        if distance[v] <= radius {
            index[v] = positions.len() as u32;
            positions.push(mesh.positions()[v]);
        }
    }
    let inside = |t: &&[u32; 3]| t.iter().all(|&v| index[v as usize] != u32::MAX);
    let triangles = mesh
        .triangles()
        .iter()
        .filter(inside)
        .map(|t| t.map(|v| index[v as usize]))
        .collect();
    Mesh::from_triangles(positions, triangles).unwrap()
}

/// A hilly fan round vertex 0: circles of `k` vertices each, joined by strips; half circles where `open`. The
/// neighbours of vertex 0 have five edges (on the boundary three or four), the next ones six.
fn fan(k: u32, open: bool, seed: f64) -> Mesh {
    const CIRCLES: u32 = 5;
    let whole = if open { 3.0 } else { core::f64::consts::TAU };
    let parts = if open { k - 1 } else { k };
    let mut positions = vec![[0.1, -0.2, 0.3]];
    for circle in 1..=CIRCLES {
        for j in 0..k {
            let n = f64::from(circle * 31 + j * 7) + seed;
            let angle = whole * (f64::from(j) + 0.2 * (n * 1.7).sin()) / f64::from(parts);
            let radius = f64::from(circle) * (1.0 + 0.1 * (n * 2.3).sin());
            positions.push([
                radius * angle.cos(),
                radius * angle.sin(),
                0.5 * (n * 3.1).sin(),
            ]);
        }
    }
    let at = |circle: u32, j: u32| 1 + (circle - 1) * k + j % k;
    let mut triangles = Vec::new();
    for j in 0..parts {
        triangles.push([0, at(1, j), at(1, j + 1)]);
        for circle in 1..CIRCLES {
            triangles.push([at(circle, j), at(circle + 1, j), at(circle + 1, j + 1)]);
            triangles.push([at(circle, j), at(circle + 1, j + 1), at(circle, j + 1)]);
        }
    }
    Mesh::from_triangles(positions, triangles).unwrap()
}

/// Directions of the frame: along the boundary, or any; and across it.
fn frame(mesh: &Mesh) -> [Vector; 3] {
    let ring = ring(mesh, VertexId(0), None);
    let at = |v: VertexId| add(mesh.positions()[v.index()], mesh.positions()[0], -1.0);
    let (first, second) = if mesh.topology().is_boundary(VertexId(0)) {
        (
            add(at(ring[0]), at(ring[ring.len() - 1]), -1.0),
            at(ring[ring.len() / 2]),
        )
    } else {
        (at(ring[0]), at(ring[1.max(ring.len() / 4)]))
    };
    // The third of their size, so that heights shrink in it as they do next to them.
    let third = cross(first, second);
    [
        first,
        second,
        third.map(|x| x / dot(third, third).powf(0.25)),
    ]
}

/// Limit position of vertex 0 and normals of its faces, after `steps` steps.
fn brute_force(mesh: &Mesh, scheme: &dyn Scheme, steps: usize) -> (Vector, Vec<Vector>) {
    let mut mesh = mesh.clone();
    // A point x of the first mesh is now rows · (x − origin).
    let (mut origin, mut rows) = (
        [0.0; 3],
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    );
    let mut columns = rows;
    for _ in 0..steps {
        mesh = cropped(&subdivided(&mesh, scheme), 5);
        let shift = mesh.positions()[0];
        for axis in 0..3 {
            origin = add(origin, columns[axis], shift[axis]);
        }
        let [a, b, c] = frame(&mesh);
        let volume = dot(a, cross(b, c));
        let map = [cross(b, c), cross(c, a), cross(a, b)].map(|row| row.map(|x| x / volume));
        let mapped = |p: Vector| map.map(|row| dot(row, add(p, shift, -1.0)));
        let positions = mesh.positions().iter().map(|&p| mapped(p)).collect();
        mesh = mesh.with_positions(positions).unwrap();
        let combined =
            |row: Vector| (0..3).fold([0.0; 3], |sum, axis| add(sum, rows[axis], row[axis]));
        rows = map.map(combined);
        columns =
            [a, b, c].map(|d| (0..3).fold([0.0; 3], |sum, axis| add(sum, columns[axis], d[axis])));
    }
    let normals = mesh.topology().outgoing_ring(VertexId(0)).map(|h| {
        let normal = mesh.face_normal(h.face());
        // Normals go back by the transposed map.
        unit((0..3).fold([0.0; 3], |sum, axis| add(sum, rows[axis], normal[axis])))
    });
    (origin, normals.collect())
}

fn check(scheme: &dyn Scheme, k: u32, open: bool, steps: usize) {
    let mesh = fan(k, open, f64::from(k) + 0.5);
    let table = LimitTable::new(scheme);
    let (normal, position) = (
        table.normal(&mesh, VertexId(0)).unwrap(),
        table.position(&mesh, VertexId(0)).unwrap(),
    );
    let plane = table
        .stencil(mesh.ring_shape(VertexId(0)))
        .unwrap()
        .tangent_plane();
    let (met, faces) = brute_force(&mesh, scheme, steps);
    let place = format!("{} k={k} open={open}", scheme.name());
    let apart = add(met, position, -1.0);
    assert!(
        dot(apart, apart).sqrt() < 1e-10,
        "{place}: position {met:?}, {position:?}"
    );
    let ends = [faces[0], faces[faces.len() - 1]];
    let faces = if plane == TangentPlane::BoundaryRibbon {
        ends.to_vec()
    } else {
        faces
    };
    for face in faces {
        let apart = add(face, normal, -1.0);
        assert!(
            dot(apart, apart).sqrt() < 1e-10,
            "{place}: normal {face:?}, {normal:?}"
        );
    }
}

#[test]
fn extraordinary_boundary_vertices() {
    for scheme in [&Loop as &dyn Scheme, &LoopWarren] {
        check(scheme, 3, true, 80);
        check(scheme, 5, true, 110);
        check(scheme, 9, true, 330);
    }
    check(&ModifiedButterfly, 3, true, 60);
    check(&ModifiedButterfly, 4, true, 60);
    check(&ModifiedButterfly, 7, true, 60);
}

#[test]
fn extraordinary_interior_vertices() {
    for scheme in [&Loop as &dyn Scheme, &LoopWarren] {
        check(scheme, 4, false, 60);
        check(scheme, 9, false, 120);
    }
    for k in [4, 5, 6, 8] {
        check(&ModifiedButterfly, k, false, 60);
    }
}

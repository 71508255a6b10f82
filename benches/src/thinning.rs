//! Thinning a closed mesh by quadrics (Garland and Heckbert 1997) with half-edge collapses, so that the vertices that are left
//! are where they were.

use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

use anyhow::Result;
use limitmesh::Mesh;

pub(crate) type Point = [f64; 3];

/// A squared distance to planes by area: the upper half of a symmetric 4 by 4 matrix.
type Quadric = [f64; 10];

fn quadric(corners: [Point; 3]) -> Quadric {
    let normal = normal(corners);
    let area = length(normal).max(f64::MIN_POSITIVE);
    let [x, y, z] = normal.map(|n| n / area);
    let w = -dot([x, y, z], corners[0]);
    [x * x, x * y, x * z, x * w, y * y, y * z, y * w, z * z, z * w, w * w].map(|q| area * q)
}

fn at(q: &Quadric, [x, y, z]: Point) -> f64 {
    q[0] * x * x
        + 2.0 * (q[1] * x * y + q[2] * x * z + q[3] * x)
        + q[4] * y * y
        + 2.0 * (q[5] * y * z + q[6] * y)
        + q[7] * z * z
        + 2.0 * q[8] * z
        + q[9]
}

/// A closed mesh with so many triangles left, its vertices some of those before.
pub(crate) fn thinned(mesh: &Mesh, triangles: usize) -> Result<Mesh> {
    let positions = mesh.positions();
    let mut faces: Vec<Option<[u32; 3]>> = mesh.triangles().iter().copied().map(Some).collect();
    let mut around: Vec<BTreeSet<u32>> = vec![BTreeSet::new(); positions.len()];
    let mut quadrics = vec![[0.0; 10]; positions.len()];
    for (f, face) in mesh.triangles().iter().enumerate() {
        let own = quadric(face.map(|v| positions[v as usize]));
        for &v in face {
            around[v as usize].insert(f as u32);
            quadrics[v as usize].iter_mut().zip(own).for_each(|(sum, q)| *sum += q);
        }
    }
    let ring = |v: u32, faces: &[Option<[u32; 3]>], around: &[BTreeSet<u32>]| -> BTreeSet<u32> {
        let corners = around[v as usize].iter().filter_map(|&f| faces[f as usize]).flatten();
        corners.filter(|&u| u != v).collect()
    };
    let mut version = vec![0u32; positions.len()];
    let mut queue = BinaryHeap::new();
    let cost = |from: u32, to: u32, quadrics: &[Quadric]| {
        let p = positions[to as usize];
        (at(&quadrics[from as usize], p) + at(&quadrics[to as usize], p)).max(0.0).to_bits()
    };
    for v in 0..positions.len() as u32 {
        for u in ring(v, &faces, &around) {
            queue.push(Reverse((cost(v, u, &quadrics), v, u, 0u32, 0u32)));
        }
    }
    let mut left = faces.len();
    while left > triangles
        && let Some(Reverse((_, from, to, a, b))) = queue.pop()
    {
        if [a, b] != [version[from as usize], version[to as usize]] {
            continue;
        }
        let (near, far) = (ring(from, &faces, &around), ring(to, &faces, &around));
        let moved: Vec<u32> = around[from as usize]
            .iter()
            .copied()
            .filter(|&f| faces[f as usize].is_some_and(|face| !face.contains(&to)))
            .collect();
        let turns = moved.iter().any(|&f| {
            let before = faces[f as usize].unwrap_or_default();
            let after = before.map(|v| if v == from { to } else { v });
            let [p, q] = [before, after].map(|face| face.map(|v| positions[v as usize]));
            let [n, m] = [normal(p), normal(q)];
            let longest =
                (0..3).map(|i| length([0, 1, 2].map(|k| q[i][k] - q[(i + 1) % 3][k]))).fold(0.0, f64::max);
            dot(n, m) < 0.3 * length(n) * length(m) || length(m) < 0.12 * longest * longest
        });
        if near.intersection(&far).count() != 2 || moved.len() + 2 != around[from as usize].len() || turns {
            continue;
        }
        for f in std::mem::take(&mut around[from as usize]) {
            let Some(face) = faces[f as usize] else { continue };
            if face.contains(&to) {
                face.iter().for_each(|&v| {
                    around[v as usize].remove(&f);
                });
                faces[f as usize] = None;
                left -= 1;
            } else {
                faces[f as usize] = Some(face.map(|v| if v == from { to } else { v }));
                around[to as usize].insert(f);
            }
        }
        let gone = quadrics[from as usize];
        quadrics[to as usize].iter_mut().zip(gone).for_each(|(sum, q)| *sum += q);
        let changed: Vec<u32> = ring(to, &faces, &around).into_iter().chain([to]).collect();
        changed.iter().for_each(|&v| version[v as usize] += 1);
        for &v in &changed {
            for u in ring(v, &faces, &around) {
                for [v, u] in [[v, u], [u, v]] {
                    queue.push(Reverse((
                        cost(v, u, &quadrics),
                        v,
                        u,
                        version[v as usize],
                        version[u as usize],
                    )));
                }
            }
        }
    }
    let mut name = vec![u32::MAX; positions.len()];
    let mut kept = Vec::new();
    let triangles = faces.into_iter().flatten().map(|face| {
        face.map(|v| {
            if name[v as usize] == u32::MAX {
                name[v as usize] = kept.len() as u32;
                kept.push(positions[v as usize]);
            }
            name[v as usize]
        })
    });
    let triangles = triangles.collect();
    Ok(Mesh::from_triangles(kept, triangles)?)
}

/// Twice the area of a triangle times its normal.
pub(crate) fn normal([a, b, c]: [Point; 3]) -> Point {
    let [u, v] = [b, c].map(|p| [0, 1, 2].map(|i| p[i] - a[i]));
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

/// The scalar product.
pub(crate) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The length of a vector.
pub(crate) fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}

//! Thinning a closed mesh by quadrics (Garland and Heckbert 1997) with half-edge collapses, so that the vertices that are left
//! are where they were.
//!
//! Apart from `limitmesh::simplify`, which keeps its vertices in place as well: for the least distance it makes triangles long
//! where a surface bends one way, good ones to draw and bad ones to subdivide. Here triangles keep their shape, as in a control
//! mesh. (Through the vertices of what `simplify` leaves, the greatest distance is 1.1 to 2.0 times as great on the five models
//! of `through`.) The sculptor of `limitmesh-models` moves what it keeps, and knows halves of symmetric bodies only.

use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

use anyhow::Result;
use glam::DVec3;
use limitmesh::Mesh;

/// A squared distance to planes by area: the upper half of a symmetric 4 by 4 matrix.
type Quadric = [f64; 10];

fn quadric(corners: [DVec3; 3]) -> Quadric {
    let normal = normal(corners);
    let area = normal.length().max(f64::MIN_POSITIVE);
    let normal = normal / area;
    let ([x, y, z], w) = (normal.to_array(), -normal.dot(corners[0]));
    [
        x * x,
        x * y,
        x * z,
        x * w,
        y * y,
        y * z,
        y * w,
        z * z,
        z * w,
        w * w,
    ]
    .map(|q| area * q)
}

fn at(q: &Quadric, p: DVec3) -> f64 {
    let [x, y, z] = p.to_array();
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
    let positions: Vec<DVec3> = mesh
        .positions()
        .iter()
        .copied()
        .map(DVec3::from_array)
        .collect();
    let mut faces: Vec<Option<[u32; 3]>> = mesh.triangles().iter().copied().map(Some).collect();
    let mut around: Vec<BTreeSet<u32>> = vec![BTreeSet::new(); positions.len()];
    let mut quadrics = vec![[0.0; 10]; positions.len()];
    for (f, face) in mesh.triangles().iter().enumerate() {
        let own = quadric(face.map(|v| positions[v as usize]));
        for &v in face {
            around[v as usize].insert(f as u32);
            quadrics[v as usize]
                .iter_mut()
                .zip(own)
                .for_each(|(sum, q)| *sum += q);
        }
    }
    let ring = |v: u32, faces: &[Option<[u32; 3]>], around: &[BTreeSet<u32>]| -> BTreeSet<u32> {
        let corners = around[v as usize]
            .iter()
            .filter_map(|&f| faces[f as usize])
            .flatten();
        corners.filter(|&u| u != v).collect()
    };
    let mut version = vec![0u32; positions.len()];
    let mut queue = BinaryHeap::new();
    let cost = |from: u32, to: u32, quadrics: &[Quadric]| {
        let p = positions[to as usize];
        (at(&quadrics[from as usize], p) + at(&quadrics[to as usize], p))
            .max(0.0)
            .to_bits()
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
            let longest = (0..3)
                .map(|i| q[i].distance_squared(q[(i + 1) % 3]))
                .fold(0.0, f64::max);
            n.dot(m) < 0.3 * n.length() * m.length() || m.length() < 0.12 * longest
        });
        if near.intersection(&far).count() != 2
            || moved.len() + 2 != around[from as usize].len()
            || turns
        {
            continue;
        }
        for f in std::mem::take(&mut around[from as usize]) {
            let Some(face) = faces[f as usize] else {
                continue;
            };
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
        quadrics[to as usize]
            .iter_mut()
            .zip(gone)
            .for_each(|(sum, q)| *sum += q);
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
                kept.push(positions[v as usize].to_array());
            }
            name[v as usize]
        })
    });
    let triangles = triangles.collect();
    Ok(Mesh::from_triangles(kept, triangles)?)
}

/// Twice the area of a triangle times its normal.
pub(crate) fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

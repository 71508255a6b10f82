//! √3-subdivision from maps of edges alone: it shares no code, no numbering and no formula of two steps with the library.

use std::collections::BTreeMap;

use crate::support::Point;

/// Positions and triangles of a mesh without creases.
#[derive(Clone)]
pub(crate) struct Plain {
    pub(crate) positions: Vec<Point>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

fn combine(terms: &[(f64, Point)]) -> Point {
    std::array::from_fn(|axis| terms.iter().map(|(w, p)| w * p[axis]).sum())
}

/// One step; `cuts` in the second, fourth, … . Old vertices keep their numbers.
pub(crate) fn step(mesh: &Plain, cuts: bool) -> Plain {
    let old = &mesh.positions;
    // By directed edge, the face to its left.
    let mut left: BTreeMap<[u32; 2], usize> = BTreeMap::new();
    for (face, &[a, b, c]) in mesh.triangles.iter().enumerate() {
        for edge in [[a, b], [b, c], [c, a]] {
            assert!(left.insert(edge, face).is_none());
        }
    }
    let is_boundary = |[a, b]: [u32; 2]| left.contains_key(&[a, b]) && !left.contains_key(&[b, a]);
    let before = |v: u32| {
        left.keys()
            .copied()
            .find(|&edge| edge[1] == v && is_boundary(edge))
            .map(|[a, _]| a)
    };
    let after = |v: u32| {
        left.keys()
            .copied()
            .find(|&edge| edge[0] == v && is_boundary(edge))
            .map(|[_, b]| b)
    };

    let mut positions: Vec<Point> = Vec::new();
    for v in 0..old.len() as u32 {
        let here = old[v as usize];
        positions.push(match (before(v), after(v)) {
            (Some(p), Some(q)) if cuts => {
                let [p, q] = [old[p as usize], old[q as usize]];
                combine(&[(4.0 / 27.0, p), (19.0 / 27.0, here), (4.0 / 27.0, q)])
            }
            (Some(_), Some(_)) => here,
            _ => {
                let ring: Vec<u32> = left
                    .keys()
                    .filter(|edge| edge[0] == v)
                    .map(|edge| edge[1])
                    .collect();
                let n = ring.len() as f64;
                let alpha = (4.0 - 2.0 * (2.0 * std::f64::consts::PI / n).cos()) / 9.0;
                let mut terms = vec![(1.0 - alpha, here)];
                terms.extend(ring.iter().map(|&u| (alpha / n, old[u as usize])));
                combine(&terms)
            }
        });
    }
    // Faces become fans around their centre, or three triangles from the corner opposite the boundary.
    let mut parts: Vec<[u32; 3]> = Vec::new();
    for &[a, b, c] in &mesh.triangles {
        let turned = [[a, b, c], [b, c, a], [c, a, b]]
            .into_iter()
            .find(|&[a, b, _]| cuts && is_boundary([a, b]));
        let new = positions.len() as u32;
        if let Some([a, b, c]) = turned {
            let [p, q] = [before(a).unwrap(), after(b).unwrap()].map(|v| old[v as usize]);
            let [pa, pb] = [a, b].map(|v| old[v as usize]);
            positions.push(combine(&[
                (1.0 / 27.0, p),
                (16.0 / 27.0, pa),
                (10.0 / 27.0, pb),
            ]));
            positions.push(combine(&[
                (10.0 / 27.0, pa),
                (16.0 / 27.0, pb),
                (1.0 / 27.0, q),
            ]));
            parts.extend([[a, new, c], [new, new + 1, c], [new + 1, b, c]]);
        } else {
            positions.push(combine(&[a, b, c].map(|v| (1.0 / 3.0, old[v as usize]))));
            parts.extend([[a, b, new], [b, c, new], [c, a, new]]);
        }
    }
    // Every old edge with a face on either side is flipped.
    let mut opposite: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    for &[a, b, c] in &parts {
        opposite.extend([([a, b], c), ([b, c], a), ([c, a], b)]);
    }
    let mut triangles = Vec::new();
    for &[a, b, c] in &parts {
        let old_edge = [[a, b, c], [b, c, a], [c, a, b]]
            .into_iter()
            .find(|&[a, b, _]| left.contains_key(&[a, b]) && left.contains_key(&[b, a]));
        match old_edge {
            Some([a, b, c]) => {
                triangles.push([a, opposite[&[b, a]], c]);
            }
            _ => triangles.push([a, b, c]),
        }
    }
    Plain {
        positions,
        triangles,
    }
}

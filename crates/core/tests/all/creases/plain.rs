//! Loop's scheme with creases and corners, plainly from edge maps: it shares no code with the library.

use std::collections::BTreeMap;

use limitmesh::Mesh;
use limitmesh::mesh::Tags;

use crate::support::{Point, Random, corner, crease};

/// A tagged mesh by maps.
#[derive(Clone)]
pub(crate) struct Plain {
    pub(crate) positions: Vec<Point>,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) creases: BTreeMap<[u32; 2], f64>,
    pub(crate) corners: BTreeMap<u32, f64>,
}

fn ends(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

fn less(sharpness: f64) -> f64 {
    if sharpness >= 10.0 {
        sharpness
    } else {
        (sharpness - 1.0).max(0.0)
    }
}

impl Plain {
    pub(crate) fn of(mesh: &Mesh) -> Self {
        let tags = mesh.tags();
        Self {
            positions: mesh.positions().to_vec(),
            triangles: mesh.triangles().to_vec(),
            creases: tags
                .creases
                .iter()
                .map(|t| (ends(t.vertices[0], t.vertices[1]), t.sharpness))
                .collect(),
            corners: tags
                .corners
                .iter()
                .map(|t| (t.vertex, t.sharpness))
                .collect(),
        }
    }

    fn combine(&self, terms: &[(f64, u32)]) -> Point {
        std::array::from_fn(|axis| {
            terms
                .iter()
                .map(|&(w, v)| w * self.positions[v as usize][axis])
                .sum()
        })
    }

    /// One level.
    pub(crate) fn refined(&self) -> Self {
        let mut opposite: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
        for &[a, b, c] in &self.triangles {
            for [p, q, r] in [[a, b, c], [b, c, a], [c, a, b]] {
                opposite.entry(ends(p, q)).or_default().push(r);
            }
        }
        let sharpness = |edge: &[u32; 2]| match opposite[edge].len() {
            1 => f64::INFINITY,
            _ => self.creases.get(edge).copied().unwrap_or(0.0),
        };
        let mut edges_at = vec![Vec::new(); self.positions.len()];
        for edge in opposite.keys() {
            for (from, to) in [(edge[0], edge[1]), (edge[1], edge[0])] {
                edges_at[from as usize].push((to, sharpness(edge)));
            }
        }
        let mut positions: Vec<Point> = Vec::new();
        for (v, edges) in (0u32..).zip(&edges_at) {
            let own = self.corners.get(&v).copied().unwrap_or(0.0);
            let rule = |own: f64, fade: &dyn Fn(f64) -> f64| -> Point {
                let sharp: Vec<u32> = edges
                    .iter()
                    .filter(|&&(_, s)| fade(s) > 0.0)
                    .map(|&(to, _)| to)
                    .collect();
                if own > 0.0 || sharp.len() > 2 {
                    return self.positions[v as usize];
                }
                if let [a, b] = sharp[..] {
                    return self.combine(&[(0.75, v), (0.125, a), (0.125, b)]);
                }
                let k = edges.len() as f64;
                let c = 3.0 / 8.0 + (std::f64::consts::TAU / k).cos() / 4.0;
                let beta = (5.0 / 8.0 - c * c) / k;
                let around = edges.iter().map(|&(to, _)| (beta, to));
                self.combine(&around.chain([(1.0 - k * beta, v)]).collect::<Vec<_>>())
            };
            let now = rule(own, &|s| s);
            let after = rule(less(own), &less);
            // The sharpness of tags that end in this step: above 0 and not above 1.
            let fading: Vec<f64> = edges
                .iter()
                .map(|&(_, s)| s)
                .chain([own])
                .filter(|&s| s > 0.0 && s <= 1.0)
                .collect();
            let share = if fading.is_empty() {
                1.0
            } else {
                fading.iter().sum::<f64>() / fading.len() as f64
            };
            positions.push(std::array::from_fn(|axis| {
                share * now[axis] + (1.0 - share) * after[axis]
            }));
        }
        let (mut on, mut creases) = (BTreeMap::new(), BTreeMap::new());
        for (edge, faces) in &opposite {
            let &[a, b] = edge;
            let new = positions.len() as u32;
            on.insert(*edge, new);
            let middle = self.combine(&[(0.5, a), (0.5, b)]);
            positions.push(match faces[..] {
                [c, d] => {
                    let smooth = self.combine(&[(0.375, a), (0.375, b), (0.125, c), (0.125, d)]);
                    let share = sharpness(edge).min(1.0);
                    std::array::from_fn(|axis| share * middle[axis] + (1.0 - share) * smooth[axis])
                }
                _ => middle,
            });
            let left = self.creases.get(edge).map_or(0.0, |&s| less(s));
            if left > 0.0 {
                creases.extend([([a, new], left), ([b, new], left)]);
            }
        }
        let split = |&[a, b, c]: &[u32; 3]| {
            let [ab, bc, ca] = [on[&ends(a, b)], on[&ends(b, c)], on[&ends(c, a)]];
            [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
        };
        let triangles = self.triangles.iter().flat_map(split).collect();
        let corners = self
            .corners
            .iter()
            .map(|(&v, &s)| (v, less(s)))
            .filter(|&(_, s)| s > 0.0)
            .collect();
        Self {
            positions,
            triangles,
            creases,
            corners,
        }
    }
}

/// `mesh` with tags of all kinds on some of its edges and vertices.
pub(crate) fn randomly_tagged(mesh: Mesh, one_in: usize, seed: u64) -> Mesh {
    let mut random = Random::new(seed);
    let topology = mesh.topology();
    let mut sharpness = || match random.below(one_in) {
        0 => [0.4, 0.5, 1.0, 1.5, 2.3, 3.7, 9.9, 10.0, f64::INFINITY][random.below(9)],
        _ => 0.0,
    };
    let mut tags = Tags::default();
    for h in topology
        .half_edges()
        .filter(|&h| topology.twin(h).is_none_or(|twin| h < twin))
    {
        let sharpness = sharpness();
        if sharpness > 0.0 {
            tags.creases
                .push(crease(topology.ends(h).map(|v| v.0), sharpness));
        }
    }
    for vertex in topology.vertices() {
        let sharpness = sharpness();
        if sharpness > 0.0 {
            tags.corners.push(corner(vertex.0, sharpness));
        }
    }
    mesh.with_tags(tags).unwrap()
}

//! Control meshes refined by plain Loop subdivision, each new vertex with its place, and proofs of that.

use std::collections::{BTreeMap, BTreeSet};

use limitmesh_check::mesh::Mesh;
use limitmesh_check::proof::Proof;
use limitmesh_check::vector::{Vector, add, scale};

pub(crate) const WHOLE: u32 = 1 << 30;

/// A mesh over a control mesh.
#[derive(Clone)]
pub(crate) struct Cage {
    pub(crate) control: Mesh,
    pub(crate) mesh: Mesh,
    /// By triangle, its parent and the weights of its corners there.
    pub(crate) parts: Vec<(u32, [[u32; 3]; 3])>,
}

pub(crate) fn octahedron() -> Mesh {
    let positions = [0, 1, 2].into_iter().flat_map(|axis| {
        [1.0, -1.0].map(|sign| std::array::from_fn(|i| if i == axis { sign } else { 0.0 }))
    });
    let triangles = [
        [0, 2, 4],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ];
    Mesh {
        positions: positions.collect(),
        triangles: triangles.to_vec(),
    }
}

/// A fan around a vertex that bends up and down, open.
pub(crate) fn fan() -> Mesh {
    let mut positions = vec![[0.0, 0.0, 0.4]];
    let angle = |i: u32| 4.0 * f64::from(i) / 5.0;
    positions.extend((0..=5).map(|i| [angle(i).cos(), angle(i).sin(), 0.3 * f64::from(i % 2)]));
    Mesh {
        positions,
        triangles: (1..=5).map(|i| [0, i, i + 1]).collect(),
    }
}

impl Cage {
    pub(crate) fn new(control: Mesh) -> Self {
        let whole = [[WHOLE, 0, 0], [0, WHOLE, 0], [0, 0, WHOLE]];
        let parts = (0..control.triangles.len() as u32)
            .map(|face| (face, whole))
            .collect();
        Self {
            mesh: control.clone(),
            control,
            parts,
        }
    }

    /// One step of Loop's scheme, borders included.
    pub(crate) fn refined(&self) -> Self {
        let Self { mesh, parts, .. } = self;
        let mut opposite: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
        for triangle in &mesh.triangles {
            for i in 0..3 {
                let [a, b, c] = [0, 1, 2].map(|j| triangle[(i + j) % 3]);
                opposite.entry([a.min(b), a.max(b)]).or_default().push(c);
            }
        }
        let at = |v: u32| mesh.positions[v as usize];
        let mean = |points: &[(Vector, f64)]| {
            points
                .iter()
                .fold([0.0; 3], |sum, &(p, w)| add(sum, scale(p, w)))
        };
        let mut positions: Vec<Vector> = (0..mesh.positions.len() as u32)
            .map(|v| {
                let around: Vec<&[u32; 2]> =
                    opposite.keys().filter(|edge| edge.contains(&v)).collect();
                let other = |edge: &[u32; 2]| edge[0] + edge[1] - v;
                let border: Vec<u32> = around
                    .iter()
                    .filter(|&&edge| opposite[edge].len() == 1)
                    .map(|edge| other(edge))
                    .collect();
                if let [a, b] = border[..] {
                    return mean(&[(at(v), 0.75), (at(a), 0.125), (at(b), 0.125)]);
                }
                let k = around.len() as f64;
                let beta = (0.625 - (0.375 + 0.25 * (std::f64::consts::TAU / k).cos()).powi(2)) / k;
                let mut all = vec![(at(v), 1.0 - k * beta)];
                all.extend(around.iter().map(|edge| (at(other(edge)), beta)));
                mean(&all)
            })
            .collect();
        let mut middle = BTreeMap::new();
        for (&edge, across) in &opposite {
            let [a, b] = edge.map(at);
            middle.insert(edge, positions.len() as u32);
            positions.push(match across[..] {
                [c, d] => mean(&[(a, 0.375), (b, 0.375), (at(c), 0.125), (at(d), 0.125)]),
                _ => mean(&[(a, 0.5), (b, 0.5)]),
            });
        }
        let mut refined = Self {
            control: self.control.clone(),
            mesh: Mesh {
                positions,
                ..Mesh::default()
            },
            parts: Vec::new(),
        };
        for (&[a, b, c], &(face, [p, q, r])) in mesh.triangles.iter().zip(parts) {
            let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[v, w]| middle[&[v.min(w), v.max(w)]]);
            let half = |p: [u32; 3], q: [u32; 3]| [0, 1, 2].map(|i| p[i] / 2 + q[i] / 2);
            let [pq, qr, rp] = [half(p, q), half(q, r), half(r, p)];
            for (triangle, part) in [
                ([a, ab, ca], [p, pq, rp]),
                ([ab, b, bc], [pq, q, qr]),
                ([ca, bc, c], [rp, qr, r]),
                ([bc, ca, ab], [qr, rp, pq]),
            ] {
                refined.mesh.triangles.push(triangle);
                refined.parts.push((face, part));
            }
        }
        refined
    }

    /// The same with so many further steps for the positions of its vertices alone: near their limits.
    pub(crate) fn settled(mut self, steps: usize) -> Self {
        let count = self.mesh.positions.len();
        let further = (0..steps).fold(self.clone(), |cage, _| cage.refined());
        self.mesh
            .positions
            .copy_from_slice(&further.mesh.positions[..count]);
        self
    }

    /// The bytes of a proof.
    pub(crate) fn proof(&self, within: f64) -> Vec<u8> {
        let [control, result] = [&self.control, &self.mesh].map(Mesh::digest);
        let head = format!(
            "limitmesh proof 1\nscheme loop\nwithin {within}\ncontrol {control}\nresult {result}\nend\n"
        );
        let mut bytes = [head.as_bytes(), &[0, 0, 0, 0]].concat();
        for face in 0..self.control.triangles.len() as u32 {
            varint(
                &mut bytes,
                2 * self
                    .parts
                    .iter()
                    .filter(|&&(parent, _)| parent == face)
                    .count() as u32,
            );
        }
        let mut known = BTreeSet::new();
        for (triangle, (_, part)) in self.mesh.triangles.iter().zip(&self.parts) {
            for (v, weights) in triangle.iter().zip(part) {
                if known.insert(v) {
                    bytes.extend([255, 30]);
                    weights[1..]
                        .iter()
                        .for_each(|&weight| varint(&mut bytes, weight));
                }
            }
        }
        bytes
    }

    /// What is refused at a length.
    pub(crate) fn refused(&self, within: f64) -> Result<Vec<(u32, &'static str)>, String> {
        let proof = Proof::read(&self.proof(within))?;
        limitmesh_check::verdict::refused(&self.control, &self.mesh, &proof, within)
    }
}

fn varint(bytes: &mut Vec<u8>, mut value: u32) {
    while value > 127 {
        bytes.push(value as u8 | 128);
        value >>= 7;
    }
    bytes.push(value as u8);
}

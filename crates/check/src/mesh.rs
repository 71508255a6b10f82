//! Triangle meshes: which triangle is beyond an edge, and the rings of a control mesh's vertices.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use crate::pieces::{Corner, Ring};
use crate::sha256;
use crate::vector::Vector;

/// No half-edge.
pub const NONE: u32 = u32::MAX;

/// Positions and triangles. Half-edge 3 t + i goes from corner i of triangle t to the next.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    pub positions: Vec<Vector>,
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// An error where a triangle names a vertex twice or one that isn't there, or a coordinate is no number.
    pub fn check(&self) -> Result<(), String> {
        if let Some(v) = self
            .positions
            .iter()
            .position(|p| !p.iter().all(|x| x.is_finite()))
        {
            return Err(format!("vertex {v} has no position"));
        }
        let is_there = |v: &u32| (*v as usize) < self.positions.len();
        let is_good =
            |t: &[u32; 3]| t.iter().all(is_there) && t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
        match self.triangles.iter().position(|t| !is_good(t)) {
            Some(t) => Err(format!(
                "triangle {t} names a vertex twice, or one that is not there"
            )),
            None => Ok(()),
        }
    }

    /// The digest by which proofs know the mesh.
    pub fn digest(&self) -> String {
        let counts = [self.positions.len() as u32, self.triangles.len() as u32];
        let mut bytes: Vec<u8> = counts.iter().flat_map(|n| n.to_le_bytes()).collect();
        bytes.extend(
            self.positions
                .iter()
                .flatten()
                .flat_map(|x| (x + 0.0).to_le_bytes()),
        );
        bytes.extend(
            self.triangles
                .iter()
                .flatten()
                .flat_map(|v| v.to_le_bytes()),
        );
        sha256::digest(&bytes)
    }

    /// The vertex that a half-edge leaves.
    pub fn origin(&self, h: u32) -> u32 {
        self.triangles[h as usize / 3][h as usize % 3]
    }

    /// By half-edge, the one that goes the other way, [`NONE`] at a border; or one that runs along another one in the same direction.
    pub fn twins(&self) -> Result<Vec<u32>, u32> {
        let ends = |h: u32| [self.origin(h), self.origin(next(h))];
        let all = 0..3 * self.triangles.len() as u32;
        let mut twins = vec![NONE; all.len()];
        let mut edges: Vec<([u32; 2], u32)> = all.map(|h| (sorted(ends(h)), h)).collect();
        edges.sort_unstable();
        for edge in edges.chunk_by(|a, b| a.0 == b.0) {
            match *edge {
                [] | [_] => {}
                [(_, g), (_, h)] if self.origin(g) != self.origin(h) => {
                    (twins[g as usize], twins[h as usize]) = (h, g);
                }
                [(_, h), ..] => return Err(h),
            }
        }
        Ok(twins)
    }
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The next half-edge of the same triangle.
pub fn next(h: u32) -> u32 {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

/// A control mesh with what is sharp.
pub struct Control {
    pub mesh: Mesh,
    pub twins: Vec<u32>,
    creases: HashMap<[u32; 2], f64>,
    corners: HashMap<u32, f64>,
}

impl Control {
    /// An error where the mesh isn't one.
    pub fn new(
        mesh: Mesh,
        creases: &[([u32; 2], f64)],
        corners: &[(u32, f64)],
    ) -> Result<Self, String> {
        mesh.check()?;
        let twins = mesh.twins();
        let twins = twins.map_err(|h| {
            format!(
                "triangle {} of the control mesh has an edge of another one",
                h / 3
            )
        })?;
        let mut sharpness = creases
            .iter()
            .map(|&(_, s)| s)
            .chain(corners.iter().map(|&(_, s)| s));
        if sharpness.any(|s| s.is_nan() || s < 0.0) {
            return Err("a sharpness is no number of at least zero".into());
        }
        let edges = (0..twins.len() as u32).map(|h| sorted([h, next(h)].map(|h| mesh.origin(h))));
        let edges: HashSet<[u32; 2]> = edges.filter(|_| !creases.is_empty()).collect();
        let is_there = creases
            .iter()
            .all(|&(ends, _)| edges.contains(&sorted(ends)));
        if !is_there
            || corners
                .iter()
                .any(|&(v, _)| v as usize >= mesh.positions.len())
        {
            return Err("an edge or a vertex is sharp that the control mesh does not have".into());
        }
        let creases = creases.iter().map(|&(ends, s)| (sorted(ends), s));
        Ok(Self {
            twins,
            creases: sharpest(creases),
            corners: sharpest(corners.iter().copied()),
            mesh,
        })
    }

    /// The greatest number of triangles at a vertex.
    pub fn valence(&self) -> usize {
        let mut count = vec![0; self.mesh.positions.len()];
        self.mesh
            .triangles
            .iter()
            .flatten()
            .for_each(|&v| count[v as usize] += 1);
        count.into_iter().max().unwrap_or(0)
    }

    /// The corner that a half-edge leaves, with its ring.
    pub fn corner(&self, h: u32) -> Corner {
        let Self { mesh, twins, .. } = self;
        let twin = |h: u32| Some(twins[h as usize]).filter(|&twin| twin != NONE);
        let at = |h: u32| mesh.positions[mesh.origin(h) as usize];
        // Counter-clockwise to the border, or all round; where there is a border, clockwise as well.
        let after = |&spoke: &u32| twin(next(next(spoke))).filter(|&after| after != h);
        let mut spokes: Vec<u32> = std::iter::successors(Some(h), after).collect();
        let last = spokes.last().map_or(h, |&last| next(next(last)));
        let is_open = twin(last).is_none();
        let before = std::iter::successors(twin(h).map(next), |&spoke| twin(spoke).map(next));
        let before: Vec<u32> = before.take_while(|_| is_open).collect();
        let slot = before.len();
        spokes.splice(0..0, before.into_iter().rev());
        let ends = |spoke: u32| [spoke, next(spoke)].map(|h| mesh.origin(h));
        let sharpness = |&spoke: &u32| match twin(spoke) {
            Some(_) => self
                .creases
                .get(&sorted(ends(spoke)))
                .copied()
                .unwrap_or(0.0),
            None => f64::INFINITY,
        };
        let mut around: Vec<Vector> = spokes.iter().map(|&spoke| at(next(spoke))).collect();
        let mut sharp: Vec<f64> = spokes.iter().map(sharpness).collect();
        if is_open {
            around.push(at(last));
            sharp.push(f64::INFINITY);
        }
        let own = self.corners.get(&mesh.origin(h)).copied().unwrap_or(0.0);
        Corner {
            ring: Rc::new(Ring {
                at: at(h),
                around,
                sharp,
                own,
                is_open,
            }),
            slot,
        }
    }
}

/// Of several the sharpest counts.
fn sharpest<K: std::hash::Hash + Eq>(all: impl Iterator<Item = (K, f64)>) -> HashMap<K, f64> {
    let mut sharpest = HashMap::new();
    for (key, s) in all {
        let known = sharpest.entry(key).or_insert(s);
        *known = s.max(*known);
    }
    sharpest
}

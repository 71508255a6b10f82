//! Proofs of distances as files, for the program `limitmesh-check`: which length is claimed, of which meshes, and where the vertices of the result
//! come from. Written here alone, and read by that program alone; docs/certificate.md describes the form.

use limitmesh::refine::Origin;
use limitmesh::scheme::{LoopFamily, Scheme as _};
use limitmesh::{Mesh, Triangles};
use sha2::{Digest, Sha256};

/// Weights are multiples of one in so many.
const WHOLE: f64 = (1u64 << 30) as f64;

/// The byte of a place adjacent to two that are known, and sixths of the edge between them and of that edge turned by 60°.
const ADJACENT: [(u8, [i64; 2]); 6] = [
    (153, [0, 6]),
    (154, [3, 3]),
    (155, [0, 12]),
    (156, [4, 4]),
    (157, [2, 2]),
    (158, [0, 3]),
];

/// The byte before a place that is written in full.
const IN_FULL: u8 = 255;

/// A result of refinement whose distance from the limit surface is to be proven.
#[derive(Clone, Copy)]
pub struct Proof<'a> {
    /// Whose limit surface.
    pub control: &'a Mesh,
    /// Whether the proof holds the control mesh. Otherwise it is in a file of its own, with the same vertices and triangles.
    pub holds_control: bool,
    /// The scheme.
    pub scheme: LoopFamily,
    /// The result as its file has it.
    pub result: Triangles<'a>,
    /// Where each of its vertices comes from.
    pub origins: &'a [Origin],
    /// The control face of each of its triangles, ascending.
    pub parents: &'a [u32],
}

/// Why there can be no proof of a result.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProofError {
    /// A triangle is not over one control face alone.
    #[error("triangle {0} reaches over several control faces")]
    SeveralFaces(usize),
    /// A vertex is not where 30 levels of refinement could put it.
    #[error(
        "a corner of triangle {0} is in the control face where more than 30 levels would put it"
    )]
    TooDeep(usize),
}

impl Proof<'_> {
    /// The file, if mesh and surface are `within` so much of each other.
    ///
    /// # Errors
    /// See [`ProofError`].
    pub fn to_bytes(&self, within: f64) -> Result<Vec<u8>, ProofError> {
        let control = self.control.as_triangles();
        let head = format!(
            "limitmesh proof 1\nscheme {}\nwithin {within}\ncontrol {}\nresult {}\nend\n",
            self.scheme.name(),
            digest(control),
            digest(self.result),
        );
        let mut bytes = head.into_bytes();
        if self.holds_control {
            varint(&mut bytes, control.positions.len() as u64);
            varint(&mut bytes, control.triangles.len() as u64);
            bytes.extend(numbers(control));
        } else {
            bytes.extend([0, 0]);
        }
        let tags = self.control.tags();
        varint(&mut bytes, tags.creases.len() as u64);
        for tag in &tags.creases {
            varint(&mut bytes, tag.vertices[0].into());
            varint(&mut bytes, tag.vertices[1].into());
            bytes.extend(tag.sharpness.to_le_bytes());
        }
        varint(&mut bytes, tags.corners.len() as u64);
        for tag in &tags.corners {
            varint(&mut bytes, tag.vertex.into());
            bytes.extend(tag.sharpness.to_le_bytes());
        }
        self.add_parents(&mut bytes);
        self.add_places(&mut bytes)?;
        Ok(bytes)
    }

    fn add_parents(&self, bytes: &mut Vec<u8>) {
        let mut counts = vec![0u64; self.control.face_count()];
        for &parent in self.parents.iter() {
            counts[parent as usize] += 1;
        }
        for run in counts.chunk_by(|a, b| a == b) {
            match run.len() {
                1 => varint(bytes, 2 * run[0]),
                length => {
                    varint(bytes, 2 * run[0] + 1);
                    varint(bytes, length as u64);
                }
            }
        }
    }

    fn add_places(&self, bytes: &mut Vec<u8>) -> Result<(), ProofError> {
        let faces = self.control.as_triangles().triangles;
        let mut is_known = vec![false; self.result.positions.len()];
        for (t, (triangle, &parent)) in self.result.triangles.iter().zip(self.parents).enumerate() {
            let place = |v: u32| {
                let found = self.origins.get(v as usize);
                let origin = found.and_then(|origin| origin.in_face(faces, parent));
                let origin = origin.ok_or(ProofError::SeveralFaces(t))?;
                let weights = [1, 2].map(|i| origin.barycentric[i] * WHOLE);
                match weights.iter().all(|weight| weight.fract() == 0.0) {
                    true => Ok(weights.map(|weight| weight as i64)),
                    false => Err(ProofError::TooDeep(t)),
                }
            };
            let [a, b, c] = *triangle;
            let places = [place(a)?, place(b)?, place(c)?];
            for corner in 0..3 {
                let corners = [0, 1, 2].map(|i| (corner + i) % 3);
                let [v, a, b] = corners.map(|corner| triangle[corner] as usize);
                if std::mem::replace(&mut is_known[v], true) {
                    continue;
                }
                let [own, next, last] = corners.map(|corner| places[corner]);
                let are_known = is_known[a] && is_known[b];
                let code = if are_known {
                    adjacent(own, next, last)
                } else {
                    None
                };
                match code.or_else(|| in_sixteenths(own)) {
                    Some(code) => bytes.push(code),
                    None => in_full(bytes, own),
                }
            }
        }
        Ok(())
    }
}

/// The byte of a place adjacent to two others, if there is one.
fn adjacent(place: [i64; 2], a: [i64; 2], b: [i64; 2]) -> Option<u8> {
    let [i, j] = [b[0] - a[0], b[1] - a[1]];
    let sixths = [6 * (place[0] - a[0]), 6 * (place[1] - a[1])];
    let is_there = |&&(_, [p, q]): &&(u8, [i64; 2])| sixths == [p * i - q * j, p * j + q * (i + j)];
    ADJACENT.iter().find(is_there).map(|&(code, _)| code)
}

/// The byte of a place whose weights are sixteenths.
fn in_sixteenths(place: [i64; 2]) -> Option<u8> {
    let unit = WHOLE as i64 / 16;
    let [i, j] = place.map(|weight| weight / unit);
    // Before row i stand rows of 17, 16, … places.
    (place == [i * unit, j * unit]).then(|| (i * (35 - i) / 2 + j) as u8)
}

fn in_full(bytes: &mut Vec<u8>, place: [i64; 2]) {
    let spare = (place[0] | place[1]).trailing_zeros().min(30);
    bytes.extend([IN_FULL, 30 - spare as u8]);
    varint(bytes, (place[0] >> spare) as u64);
    varint(bytes, (place[1] >> spare) as u64);
}

fn varint(bytes: &mut Vec<u8>, mut value: u64) {
    while value > 127 {
        bytes.push(value as u8 | 128);
        value >>= 7;
    }
    bytes.push(value as u8);
}

/// The little-endian bytes of a mesh's coordinates and corners.
fn numbers(mesh: Triangles<'_>) -> impl Iterator<Item = u8> {
    let coordinates = mesh.positions.iter().flatten();
    let corners = mesh.triangles.iter().flatten();
    let coordinates = coordinates.flat_map(|x| x.to_le_bytes());
    coordinates.chain(corners.flat_map(|v| v.to_le_bytes()))
}

/// How proofs know meshes.
fn digest(mesh: Triangles<'_>) -> String {
    let mut hash = Sha256::new();
    for count in [mesh.positions.len(), mesh.triangles.len()] {
        hash.update((count as u32).to_le_bytes());
    }
    for x in mesh.positions.as_flattened() {
        // Zero is written without its sign.
        hash.update((x + 0.0).to_le_bytes());
    }
    for v in mesh.triangles.as_flattened() {
        hash.update(v.to_le_bytes());
    }
    let bytes = hash.finalize();
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

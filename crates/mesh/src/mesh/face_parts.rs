//! Faces divided in the middle of some of their edges, and the faces of which they are parts.
//!
//! Takes a mesh and the edges to divide, each with the position of its new vertex; gives the mesh
//! with the parts of the faces on both sides. Points of the parts are found again on the whole
//! faces by their barycentric coordinates, `b = Σ bᵢ cᵢ` with cᵢ those of the part's corners.

use std::collections::BTreeMap;

use super::{CreaseTag, Mesh, MeshError, Topology};
use crate::index::HalfEdgeId;
use crate::vector::{DVec3, vector};

/// A triangle that is part of a face of another mesh.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Part {
    face: u32,
    whole: u32,
    /// The barycentric coordinates of its corners in the whole face.
    corners: [[f64; 3]; 3],
}

/// The barycentric coordinates of a face's own corners.
const WHOLE: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The original face of each face of a mesh some of whose faces were divided. Undivided faces keep
/// their numbers.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct FaceParts {
    /// By ascending face; faces that are whole are not among them.
    parts: Vec<Part>,
}

impl FaceParts {
    /// Whether no face was divided.
    pub fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// The original face of `face`, which is itself or the face that was divided.
    pub fn whole(&self, face: u32) -> u32 {
        self.part(face).map_or(face, |part| part.whole)
    }

    /// A point of a face, by its barycentric coordinates, on the whole face.
    pub fn on_whole(&self, face: u32, barycentric: [f64; 3]) -> (u32, [f64; 3]) {
        let Some(part) = self.part(face) else {
            return (face, barycentric);
        };
        let coordinate = |i: usize| {
            (0..3)
                .map(|corner| barycentric[corner] * part.corners[corner][i])
                .sum()
        };
        (part.whole, core::array::from_fn(coordinate))
    }

    /// Of a mesh all of whose faces are parts: of which face each is one, and where its corners are in that.
    #[doc(hidden)]
    pub fn of_all(parts: impl Iterator<Item = (u32, [[f64; 3]; 3])>) -> Self {
        let part = |(face, (whole, corners))| Part {
            face,
            whole,
            corners,
        };
        Self {
            parts: (0..).zip(parts).map(part).collect(),
        }
    }

    /// The faces as parts of those that were divided before.
    pub fn after(&self, before: &Self) -> Self {
        let of_first = |part: &Part| {
            let corners = part
                .corners
                .map(|corner| before.on_whole(part.whole, corner).1);
            Part {
                whole: before.whole(part.whole),
                corners,
                ..*part
            }
        };
        let left = before
            .parts
            .iter()
            .filter(|part| self.part(part.face).is_none())
            .copied();
        let mut parts: Vec<Part> = self.parts.iter().map(of_first).chain(left).collect();
        parts.sort_unstable_by_key(|part| part.face);
        Self { parts }
    }

    fn part(&self, face: u32) -> Option<&Part> {
        self.parts
            .binary_search_by_key(&face, |part| part.face)
            .ok()
            .map(|place| &self.parts[place])
    }
}

/// A point at which an edge is divided.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    /// One of the edge's half-edges.
    pub(super) edge: HalfEdgeId,
    /// The position of the new vertex. New vertices inside the adjacent faces move by half its
    /// distance from the edge's middle.
    pub(super) position: [f64; 3],
}

/// Divides edges, each once at most, and their faces, each into the triangles around a point
/// inside, so that the new vertices have neighbours near them on either side. Old vertices keep
/// their numbers, new ones on edges follow in the order of their cuts, then those inside faces; a
/// divided face's first part keeps its number, and the others follow all faces. Edges along which
/// sheets were cut apart are not to be divided.
///
/// # Errors
/// The mesh gets more elements than can be numbered.
pub(super) fn divided(mesh: &Mesh, cuts: &[Cut]) -> Result<(Mesh, FaceParts), MeshError> {
    let topology = mesh.topology();
    let mut positions = mesh.positions().to_vec();
    // The new vertices on the sides of faces, and on edges by their ends.
    let mut on_sides: BTreeMap<u32, [Option<u32>; 3]> = BTreeMap::new();
    let mut middles: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    for cut in cuts {
        let middle = positions.len() as u32;
        positions.push(cut.position);
        for h in [Some(cut.edge), topology.twin(cut.edge)]
            .into_iter()
            .flatten()
        {
            on_sides.entry(h.face().0).or_default()[h.corner()] = Some(middle);
        }
        middles.insert(sorted(topology.ends(cut.edge).map(|v| v.0)), middle);
    }
    let mut triangles = mesh.triangles().to_vec();
    let mut parts = Vec::new();
    // Where half-edges of divided faces that were not divided themselves are now.
    let mut moved: BTreeMap<u32, u32> = BTreeMap::new();
    for (&face, on_sides) in &on_sides {
        let corners = triangles[face as usize];
        let inside = inside(on_sides);
        let hub = positions.len() as u32;
        let mut at: DVec3 = (0..3)
            .map(|i| inside[i] * vector(mesh.positions()[corners[i] as usize]))
            .sum();
        for (side, middle) in on_sides.iter().enumerate() {
            let ends =
                [side, (side + 1) % 3].map(|i| vector(mesh.positions()[corners[i] as usize]));
            if let &Some(middle) = middle {
                at += 0.5 * (vector(positions[middle as usize]) - 0.5 * (ends[0] + ends[1]));
            }
        }
        positions.push(at.to_array());
        let mut add = |from: (u32, [f64; 3]), to: (u32, [f64; 3])| {
            let is_first = parts.last().is_none_or(|last: &Part| last.whole != face);
            let number = if is_first {
                face
            } else {
                triangles.len() as u32
            };
            let triangle = [from.0, to.0, hub];
            if is_first {
                triangles[face as usize] = triangle;
            } else {
                triangles.push(triangle);
            }
            parts.push(Part {
                face: number,
                whole: face,
                corners: [from.1, to.1, inside],
            });
            number
        };
        for (side, &middle) in on_sides.iter().enumerate() {
            let next = (side + 1) % 3;
            let (from, to) = ((corners[side], WHOLE[side]), (corners[next], WHOLE[next]));
            match middle {
                Some(middle) => {
                    let half = core::array::from_fn(|i| 0.5 * (from.1[i] + to.1[i]));
                    add(from, (middle, half));
                    add((middle, half), to);
                }
                None => {
                    moved.insert(3 * face + side as u32, 3 * add(from, to));
                }
            }
        }
    }
    parts.sort_unstable_by_key(|part| part.face);
    super::check_finite(&positions)?;
    let mut tags = mesh.tags().clone();
    tags.creases = mesh
        .tags()
        .creases
        .iter()
        .flat_map(|tag| halves(tag, &middles))
        .flatten()
        .collect();
    let mut junctions = mesh.junctions().clone();
    junctions
        .edges
        .rename(|h| moved.get(&h).copied().unwrap_or(h));
    let topology = Topology::from_triangles(triangles, positions.len())?;
    Ok((
        Mesh::from_parts(topology, positions, tags, junctions),
        FaceParts { parts },
    ))
}

/// The barycentric coordinates of the point inside a face around which it is divided: near the sides that are divided.
fn inside(on_sides: &[Option<u32>; 3]) -> [f64; 3] {
    let is_cut = on_sides.map(|middle| f64::from(u8::from(middle.is_some())));
    let cuts: f64 = is_cut.iter().sum();
    core::array::from_fn(|i| 0.25 + (is_cut[i] + is_cut[(i + 2) % 3]) / (8.0 * cuts))
}

/// A crease tag on both halves of an edge that was divided; unchanged on others.
fn halves(tag: &CreaseTag, middles: &BTreeMap<[u32; 2], u32>) -> [Option<CreaseTag>; 2] {
    let [a, b] = tag.vertices;
    match middles.get(&sorted([a, b])) {
        Some(&middle) => {
            [[a, middle], [middle, b]].map(|vertices| Some(CreaseTag { vertices, ..*tag }))
        }
        None => [Some(*tag), None],
    }
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

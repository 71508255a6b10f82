//! Watertightness: boundary edges, non-manifold edges, T-junctions, Euler characteristic.
//!
//! Takes any triangles, manifold or not, and reads their connections off the vertex indices: edges are sorted, so
//! that all faces of an edge lie side by side. Positions matter only to T-junctions.

use super::bvh::Bvh;
use crate::mesh::Triangles;
use crate::parallel;
use crate::vector::vector;

/// How near to a boundary edge, as a share of its length, a vertex counts as lying on it, and how far from its ends
/// it must be to lie inside. Wide enough for midpoints rounded to single precision in edges down to about a hundredth
/// of the model; a gap this narrow cannot be told from a crack.
const ON_EDGE: f64 = 1e-5;

/// What keeps a surface from being a closed, conforming manifold.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Watertightness {
    /// Edges with one face.
    pub boundary_edges: usize,
    /// Edges with more than two faces.
    pub non_manifold_edges: usize,
    /// Edges with two faces that run along it the same way.
    pub inconsistent_edges: usize,
    /// Vertices that lie inside a boundary edge of which they are no end: within 1e-5 of its length from it and
    /// farther than that from its ends. Vertices of different index at one place are no T-junction by themselves.
    pub t_junctions: usize,
    /// Triangles that name a vertex twice. They are no part of the other counts.
    pub degenerate_faces: usize,
    /// Number of connected components, joined through edges.
    pub components: usize,
    /// Vertices in use − edges + faces.
    pub euler_characteristic: i64,
}

impl Watertightness {
    /// Whether the surface encloses a volume: no boundary, no non-manifold and no inconsistent edge.
    pub fn is_watertight(&self) -> bool {
        self.boundary_edges == 0 && self.non_manifold_edges == 0 && self.inconsistent_edges == 0
    }
}

/// Examines a surface by its indices and, for T-junctions, its positions.
///
/// Indices that name no position are counted like any other, but lie on no edge.
pub fn watertightness(surface: Triangles<'_>) -> Watertightness {
    let sides = sorted_sides(surface.triangles);
    let mut components = Components::new(surface.triangles.len());
    let mut result = Watertightness {
        boundary_edges: 0,
        non_manifold_edges: 0,
        inconsistent_edges: 0,
        t_junctions: 0,
        degenerate_faces: surface.triangles.iter().filter(|t| is_degenerate(t)).count(),
        components: 0,
        euler_characteristic: 0,
    };
    let mut edges = 0;
    let mut boundary = Vec::new();
    for uses in sides.chunk_by(|a, b| a.edge == b.edge) {
        edges += 1;
        for pair in uses.windows(2) {
            components.join(pair[0].face(), pair[1].face());
        }
        match uses {
            [_] => boundary.push(uses[0].ends()),
            [a, b] => result.inconsistent_edges += usize::from(a.runs_up() == b.runs_up()),
            _ => result.non_manifold_edges += 1,
        }
    }
    drop(sides);
    result.boundary_edges = boundary.len();
    let faces = surface.triangles.len() - result.degenerate_faces;
    result.components = faces - components.joins;
    let vertices = used_vertices(surface.triangles);
    result.euler_characteristic = vertices.len() as i64 - edges + faces as i64;
    result.t_junctions = t_junctions(surface.positions, vertices, &boundary);
    result
}

/// Whether a triangle names a vertex twice.
fn is_degenerate([a, b, c]: &[u32; 3]) -> bool {
    a == b || b == c || c == a
}

/// One side of a face.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    /// The lesser vertex in the high half, the greater in the low one.
    edge: u64,
    /// Twice the face, plus one if the side runs from the lesser to the greater vertex.
    face_and_way: u64,
}

impl Side {
    fn new(from: u32, to: u32, face: usize) -> Self {
        let edge = (from.min(to) as u64) << 32 | from.max(to) as u64;
        Self { edge, face_and_way: (face as u64) << 1 | u64::from(from < to) }
    }

    fn ends(&self) -> [u32; 2] {
        [(self.edge >> 32) as u32, self.edge as u32]
    }

    fn face(&self) -> usize {
        (self.face_and_way >> 1) as usize
    }

    fn runs_up(&self) -> bool {
        self.face_and_way & 1 == 1
    }
}

/// The sides of all faces, those of one edge side by side.
fn sorted_sides(triangles: &[[u32; 3]]) -> Vec<Side> {
    let mut sides = Vec::with_capacity(3 * triangles.len());
    for (face, corners) in triangles.iter().enumerate() {
        if !is_degenerate(corners) {
            let [a, b, c] = *corners;
            sides.extend([Side::new(a, b, face), Side::new(b, c, face), Side::new(c, a, face)]);
        }
    }
    sort(&mut sides);
    sides
}

/// Sorts distinct elements, on several threads where there are any.
fn sort<T: Ord + Send>(elements: &mut [T]) {
    #[cfg(feature = "parallel")]
    {
        use rayon::slice::ParallelSliceMut;
        elements.par_sort_unstable();
    }
    #[cfg(not(feature = "parallel"))]
    elements.sort_unstable();
}

/// The vertices of faces, each once, ascending.
fn used_vertices(triangles: &[[u32; 3]]) -> Vec<u32> {
    let faces = || triangles.iter().filter(|corners| !is_degenerate(corners)).flatten().copied();
    let greatest = faces().max().map_or(0, |v| v as usize + 1);
    // Indices far beyond the number of corners must not make the list of flags as long as the greatest of them.
    if greatest / 8 > 3 * triangles.len() {
        let mut vertices: Vec<u32> = faces().collect();
        vertices.sort_unstable();
        vertices.dedup();
        return vertices;
    }
    let mut used = vec![false; greatest];
    for v in faces() {
        used[v as usize] = true;
    }
    (0..greatest as u32).filter(|&v| used[v as usize]).collect()
}

/// Sets of faces joined through edges (union-find with path halving; the lesser root stays).
struct Components {
    parent: Vec<u32>,
    joins: usize,
}

impl Components {
    fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).collect(), joins: 0 }
    }

    fn root(&mut self, mut face: usize) -> usize {
        while self.parent[face] as usize != face {
            self.parent[face] = self.parent[self.parent[face] as usize];
            face = self.parent[face] as usize;
        }
        face
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        if a != b {
            self.parent[a.max(b)] = a.min(b) as u32;
            self.joins += 1;
        }
    }
}

/// Number of `vertices` that lie inside an edge of `boundary`.
///
/// Vertices at one place are looked up once and edges between the same two places are kept once, so that soups of
/// unconnected triangles, where many meet in a point, take no longer than others.
fn t_junctions(positions: &[[f64; 3]], mut vertices: Vec<u32>, boundary: &[[u32; 2]]) -> usize {
    let place = |v: u32| positions.get(v as usize).filter(|p| p.iter().all(|x| x.is_finite()));
    // Adding zero makes both zeros the same place.
    let bits = |v: u32| positions[v as usize].map(|x| (x + 0.0).to_bits());
    let mut edges: Vec<[u32; 3]> = boundary
        .iter()
        .filter(|[a, b]| place(*a).is_some() && place(*b).is_some())
        .map(|&[a, b]| if bits(a) <= bits(b) { [a, b, b] } else { [b, a, a] })
        .collect();
    edges.sort_unstable_by_key(|&[a, b, _]| (bits(a), bits(b)));
    edges.dedup_by_key(|&mut [a, b, _]| (bits(a), bits(b)));
    if edges.is_empty() {
        return 0;
    }
    vertices.retain(|&v| place(v).is_some());
    vertices.sort_unstable_by_key(|&v| (bits(v), v));
    let places: Vec<&[u32]> = vertices.chunk_by(|&a, &b| bits(a) == bits(b)).collect();
    let tree = Bvh::padded(Triangles { positions, triangles: &edges }, ON_EDGE);
    let counts = parallel::pieces(places.len(), |range| {
        let inside = |vertices: &&&[u32]| {
            let at = vector(positions[vertices[0] as usize]);
            tree.any_around(at, |[a, b, _], p| {
                let along = b - a;
                let t = (p - a).dot(along) / along.length_squared();
                let apart = (p - a - along * t).length_squared();
                t > ON_EDGE && t < 1.0 - ON_EDGE && apart <= ON_EDGE * ON_EDGE * along.length_squared()
            })
        };
        places[range].iter().filter(inside).map(|vertices| vertices.len()).sum::<usize>()
    });
    counts.into_iter().sum()
}

#[cfg(test)]
mod tests;

//! Neighbours across edges, and an orientation that all of them agree on.
//!
//! Takes triangles in any orientation; gives twins, and the edges along which faces had to be cut
//! apart: those with more than two faces, and those where neighbours run against each other: in a
//! one-sided component, or because none is to be turned.

use core::ops::Range;

use super::triangulate::Faces;
use crate::geometry::{NONE, every_edge};
use crate::index::{FaceId, HalfEdgeId};
use crate::mesh::{Diagnosis, Groups};

/// The face across each half-edge, and the edges that were cut apart.
pub(super) struct Neighbours {
    /// The half-edge of the one other face at the edge, or [`NONE`].
    pub(super) twins: Vec<u32>,
    /// The half-edges along each cut edge.
    pub(super) cuts: Groups,
}

/// Connects faces that alone share an edge; `name` gives a vertex's number in the input.
pub(super) fn connect(
    triangles: &[[u32; 3]],
    vertex_count: usize,
    name: impl Fn(u32) -> u32,
    diagnosis: &mut Diagnosis,
) -> Neighbours {
    let mut twins = limitmesh_pages::filled(NONE, 3 * triangles.len());
    let mut cuts = Groups::default();
    let mut named = Vec::new();
    every_edge(triangles, vertex_count, |lower, edge| match edge {
        [_] => {}
        [a, b] => (twins[a.side as usize], twins[b.side as usize]) = (b.side, a.side),
        _ => {
            cuts.push(edge.iter().map(|side| side.side));
            named.push(name(lower));
        }
    });
    diagnosis.non_manifold_edges.add_all(named);
    Neighbours { twins, cuts }
}

/// Faces that are joined through edges.
pub(super) struct Components {
    /// All faces, those of a component next to each other.
    faces: Vec<u32>,
    /// Where each component begins.
    starts: Vec<usize>,
}

impl Components {
    /// The faces of each component.
    pub(super) fn iter(&self) -> impl Iterator<Item = &[u32]> {
        let ends = self
            .starts
            .iter()
            .skip(1)
            .copied()
            .chain([self.faces.len()]);
        self.starts
            .iter()
            .zip(ends)
            .map(|(&start, end)| &self.faces[start..end])
    }
}

/// Turns faces so that neighbours run opposite ways along their edge. In each component the smaller part is
/// turned; of two equal ones that without the lowest face. Vertices from `centres` on are in the middles of polygons, whose triangles
/// around them turn together.
pub(super) fn orient(
    faces: &mut Faces,
    neighbours: &mut Neighbours,
    centres: u32,
    diagnosis: &mut Diagnosis,
) -> Components {
    let (components, turned) = faces_to_turn(&faces.triangles, &neighbours.twins, centres);
    if turned.contains(&true) {
        let named = faces
            .inputs
            .iter()
            .zip(&turned)
            .filter(|(_, turned)| **turned);
        let mut named: Vec<u32> = named.map(|(&input, _)| input).collect();
        named.sort_unstable();
        named.dedup();
        diagnosis.flipped_faces.add_all(named);
        turn(&mut faces.triangles, neighbours, &turned);
    }
    components
}

/// Breadth-first from the lowest face of each component.
fn faces_to_turn(triangles: &[[u32; 3]], twins: &[u32], centres: u32) -> (Components, Vec<bool>) {
    let origins = triangles.as_flattened();
    let mut visited = vec![false; triangles.len()];
    let mut turned = vec![false; triangles.len()];
    let mut order: Vec<u32> = Vec::with_capacity(triangles.len());
    let mut starts = Vec::new();
    for root in 0..triangles.len() {
        if visited[root] {
            continue;
        }
        let start = order.len();
        starts.push(start);
        let mut next = start;
        let mut turned_here = 0;
        let own = together(triangles, root, centres);
        visited[own.clone()].fill(true);
        order.extend(own.map(|face| face as u32));
        while let Some(&face) = order.get(next) {
            next += 1;
            for corner in 0..3 {
                let h = HalfEdgeId::of(FaceId(face), corner).index();
                let twin = twins[h];
                if twin == NONE || visited[(twin / 3) as usize] {
                    continue;
                }
                let other = (twin / 3) as usize;
                let against = origins[h] == origins[twin as usize];
                let turns = turned[face as usize] != against;
                let own = together(triangles, other, centres);
                visited[own.clone()].fill(true);
                turned[own.clone()].fill(turns);
                turned_here += if turns { own.len() } else { 0 };
                order.extend(own.map(|face| face as u32));
            }
        }
        let component = &order[start..];
        if turned_here > component.len() - turned_here {
            component
                .iter()
                .for_each(|&face| turned[face as usize] ^= true);
        }
    }
    (
        Components {
            faces: order,
            starts,
        },
        turned,
    )
}

/// The faces that turn with one: those of its polygon, which stand next to each other and have its centre last.
fn together(triangles: &[[u32; 3]], face: usize, centres: u32) -> Range<usize> {
    let centre = triangles[face][2];
    if centre < centres {
        return face..face + 1;
    }
    let is_own = |triangle: &&[u32; 3]| triangle[2] == centre;
    let before = triangles[..face].iter().rev().take_while(is_own).count();
    let from = triangles[face..].iter().take_while(is_own).count();
    face - before..face + from
}

/// Swaps the last two corners of the marked faces, and renames their half-edges.
pub(super) fn turn(triangles: &mut [[u32; 3]], neighbours: &mut Neighbours, turned: &[bool]) {
    // Half-edge 0 ran from corner 0 to corner 1, which is now corner 2.
    let renamed = |h: u32| {
        if turned[(h / 3) as usize] {
            h - h % 3 + (2 - h % 3)
        } else {
            h
        }
    };
    for (face, triangle) in triangles.iter_mut().enumerate() {
        if turned[face] {
            triangle.swap(1, 2);
            neighbours.twins.swap(3 * face, 3 * face + 2);
        }
    }
    for twin in neighbours.twins.iter_mut().filter(|twin| **twin != NONE) {
        *twin = renamed(*twin);
    }
    neighbours.cuts.rename(renamed);
}

/// Cuts apart the neighbours that still run in one direction along their edge.
pub(super) fn cut_opposed(faces: &Faces, neighbours: &mut Neighbours, diagnosis: &mut Diagnosis) {
    let origins = faces.triangles.as_flattened();
    let mut named = Vec::new();
    for h in 0..origins.len() {
        let twin = neighbours.twins[h];
        if twin == NONE || origins[h] != origins[twin as usize] {
            continue;
        }
        neighbours.twins[h] = NONE;
        neighbours.twins[twin as usize] = NONE;
        neighbours.cuts.push([h as u32, twin]);
        named.extend([h as u32, twin].map(|h| faces.inputs[(h / 3) as usize]));
    }
    named.sort_unstable();
    named.dedup();
    diagnosis.non_orientable_faces.add_all(named);
}

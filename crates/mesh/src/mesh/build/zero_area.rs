//! Faces of zero area with three different corners: removed without opening a slit.
//!
//! The face's longest side has the third corner on it. The neighbour across that side is split there, which
//! takes the face's place; this is the same as flipping the shared edge. The longest such faces go first:
//! their neighbours are then proper, or share that same longest side, and the remaining sides get shorter.

use std::collections::{BinaryHeap, HashMap};

use super::repeated::for_each_repetition;
use super::triangulate::{Faces, Flatness};
use crate::mesh::Diagnosis;
use crate::vector::vector;

/// Splits allowed for each face of zero area. One is enough for a single face, and a row of n along
/// one line needs few each; coincident vertices that were not welded can need ever more.
const SPLITS_A_FACE: usize = 64;

/// Removes faces of zero area; by `polygon_sizes` input faces that are polygons are known, whose
/// own straight corners are no defect.
pub(super) fn remove_zero_area(
    faces: &mut Faces,
    flatness: Flatness<'_>,
    vertex_count: usize,
    is_polygon: impl Fn(u32) -> bool,
    diagnosis: &mut Diagnosis,
) {
    let flat: Vec<u32> = (0..faces.triangles.len() as u32)
        .filter(|&face| flatness.is_flat(faces, face))
        .collect();
    if flat.is_empty() {
        return;
    }
    count_inputs(faces, &flat, is_polygon, diagnosis);
    let mut removal = Removal::new(faces, flatness, &flat);
    removal.run(flat.len());
    let mut marked = removal.dropped;
    let split = removal.split;
    cancel_folds(faces, vertex_count, &split, &mut marked, diagnosis);
    faces.drop_marked(&marked);
}

/// Counts the input faces that have no area at all: a triangle, or a polygon with all its triangles.
fn count_inputs(
    faces: &Faces,
    flat: &[u32],
    is_polygon: impl Fn(u32) -> bool,
    diagnosis: &mut Diagnosis,
) {
    let mut flat = flat.iter().copied().peekable();
    let mut found = Vec::new();
    // The triangles of one input face stand next to each other.
    let mut face = 0u32;
    for group in faces.inputs.chunk_by(|a, b| a == b) {
        let end = face + group.len() as u32;
        let mut flat_ones = 0;
        while flat.next_if(|&f| f < end).is_some() {
            flat_ones += 1;
        }
        if flat_ones > 0 && (flat_ones == group.len() || !is_polygon(group[0])) {
            found.push(group[0]);
        }
        face = end;
    }
    diagnosis.zero_area_faces.add_all(found);
}

/// The faces at an edge: how many, and the exclusive or of their ids, which names the other one of two.
#[derive(Clone, Copy, Default)]
struct EdgeFaces {
    count: u32,
    ids: u32,
}

/// A face of zero area, longest first and among equals the lower id first.
#[derive(PartialEq)]
struct Candidate {
    length: f64,
    face: u32,
}

impl Eq for Candidate {}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<core::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> core::cmp::Ordering {
        self.length
            .total_cmp(&other.length)
            .then(other.face.cmp(&self.face))
    }
}

struct Removal<'a> {
    faces: &'a mut Faces,
    flatness: Flatness<'a>,
    edges: HashMap<[u32; 2], EdgeFaces>,
    queue: BinaryHeap<Candidate>,
    dropped: Vec<bool>,
    split: Vec<u32>,
}

impl<'a> Removal<'a> {
    fn new(faces: &'a mut Faces, flatness: Flatness<'a>, flat: &[u32]) -> Self {
        let dropped = vec![false; faces.triangles.len()];
        let edges = HashMap::with_capacity(faces.triangles.len() * 3 / 2);
        let mut removal = Self {
            faces,
            flatness,
            edges,
            queue: BinaryHeap::new(),
            dropped,
            split: Vec::new(),
        };
        for face in 0..removal.dropped.len() as u32 {
            removal.connect(face);
        }
        for &face in flat {
            removal.enqueue(face);
        }
        removal
    }

    fn sides(&self, face: u32) -> [[u32; 2]; 3] {
        let [a, b, c] = self.faces.triangles[face as usize];
        [[a, b], [b, c], [c, a]].map(|[u, v]| [u.min(v), u.max(v)])
    }

    fn connect(&mut self, face: u32) {
        for side in self.sides(face) {
            let at = self.edges.entry(side).or_default();
            at.count += 1;
            at.ids ^= face;
        }
    }

    fn disconnect(&mut self, face: u32) {
        for side in self.sides(face) {
            if let Some(at) = self.edges.get_mut(&side) {
                at.count -= 1;
                at.ids ^= face;
            }
        }
    }

    /// The corner at which the longest side starts, and that side's length.
    fn longest_side(&self, face: u32) -> (usize, f64) {
        let p = self.faces.triangles[face as usize]
            .map(|v| vector(self.flatness.positions[v as usize]) * 0.5);
        // Divided by the largest coordinate, so that squares neither overflow nor vanish.
        let sides = [p[1] - p[0], p[2] - p[1], p[0] - p[2]];
        let size = sides
            .iter()
            .fold(0.0, |size: f64, side| size.max(side.abs().max_element()));
        let length = |i: usize| {
            if size > 0.0 {
                (sides[i] / size).length() * size
            } else {
                0.0
            }
        };
        (0..3).map(|i| (i, length(i))).fold(
            (0, -1.0),
            |best, side| if side.1 > best.1 { side } else { best },
        )
    }

    fn enqueue(&mut self, face: u32) {
        let (_, length) = self.longest_side(face);
        self.queue.push(Candidate { length, face });
    }

    fn run(&mut self, flat: usize) {
        let mut left = flat.saturating_mul(SPLITS_A_FACE);
        while let Some(Candidate { length, face }) = self.queue.pop() {
            // A face may have changed since it was queued; its new state was queued as well.
            if self.dropped[face as usize]
                || self.longest_side(face).1 != length
                || !self.flatness.is_flat(self.faces, face)
            {
                continue;
            }
            if left == 0 || !self.flip(face) {
                self.disconnect(face);
                self.dropped[face as usize] = true;
            }
            left = left.saturating_sub(1);
        }
    }

    /// Splits the neighbour across the longest side; false if there is no single one.
    fn flip(&mut self, face: u32) -> bool {
        let triangle = self.faces.triangles[face as usize];
        let (start, _) = self.longest_side(face);
        let middle = triangle[(start + 2) % 3];
        let side = self.sides(face)[start];
        let at = self.edges.get(&side).copied().unwrap_or_default();
        if at.count != 2 {
            return false;
        }
        let neighbour = at.ids ^ face;
        let other = self.faces.triangles[neighbour as usize];
        let corner = (0..3).find(|&i| !side.contains(&other[i]));
        let Some(corner) = corner.filter(|&i| other[i] != middle) else {
            return false;
        };
        let (apex, from, to) = (
            other[corner],
            other[(corner + 1) % 3],
            other[(corner + 2) % 3],
        );
        self.disconnect(face);
        self.disconnect(neighbour);
        self.faces.triangles[face as usize] = [apex, from, middle];
        self.faces.triangles[neighbour as usize] = [apex, middle, to];
        // The faces keep their order, so that the one with area names the input face of both.
        self.faces.inputs[face as usize] = self.faces.inputs[neighbour as usize];
        for changed in [face, neighbour] {
            self.connect(changed);
            self.split.push(changed);
            if self.flatness.is_flat(self.faces, changed) {
                self.enqueue(changed);
            }
        }
        true
    }
}

/// Splitting a neighbour that was folded over a third face leaves two faces back to back: both are
/// dropped, so that a closed surface stays closed.
fn cancel_folds(
    faces: &Faces,
    vertex_count: usize,
    split: &[u32],
    marked: &mut [bool],
    diagnosis: &mut Diagnosis,
) {
    if split.is_empty() {
        return;
    }
    let mut is_split = vec![false; faces.triangles.len()];
    split
        .iter()
        .for_each(|&face| is_split[face as usize] = true);
    let mut cancelled = Vec::new();
    for_each_repetition(&faces.triangles, vertex_count, |group| {
        let mut left: Vec<u32> = group
            .iter()
            .copied()
            .filter(|&face| !marked[face as usize])
            .collect();
        if left.iter().any(|&face| is_split[face as usize]) {
            // An odd one out stays.
            left.truncate(left.len() / 2 * 2);
            left.iter().for_each(|&face| marked[face as usize] = true);
            cancelled.extend(left);
        }
    });
    let inputs = cancelled
        .iter()
        .map(|&face| faces.inputs[face as usize])
        .collect();
    diagnosis.repeated_faces.add_all(inputs);
}

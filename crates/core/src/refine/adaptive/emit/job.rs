//! A share of an emission: some control faces, and the parts of the arrays that are theirs.

use crate::patch::LimitPoint;
use crate::refine::exact_result::Origin;

/// Consecutive control faces, and the parts of the arrays that are theirs.
pub(super) struct Job<'a> {
    pub(super) is_new: bool,
    pub(super) faces: core::ops::Range<u32>,
    pub(super) on_edges: Vertices<'a>,
    pub(super) inside: Vertices<'a>,
    pub(super) first_triangle: u32,
    pub(super) triangles: &'a mut [[u32; 3]],
    pub(super) twins: &'a mut [u32],
    pub(super) parents: &'a mut [u32],
    pub(super) borders: &'a mut [u32],
}

/// A run of vertices to be written: the first's number, then positions, normals, and origins where they are asked for.
pub(super) struct Vertices<'a> {
    pub(super) first: u32,
    pub(super) positions: &'a mut [[f64; 3]],
    pub(super) normals: &'a mut [[f64; 3]],
    pub(super) origins: &'a mut [Origin],
}

impl<'a> Vertices<'a> {
    /// Takes the first `count` off.
    pub(super) fn take(&mut self, count: usize) -> Vertices<'a> {
        let (positions, normals) = (
            split_off(&mut self.positions, count),
            split_off(&mut self.normals, count),
        );
        let all = self.origins.len();
        let origins = split_off(&mut self.origins, count.min(all));
        let first = self.first;
        self.first += count as u32;
        Vertices {
            first,
            positions,
            normals,
            origins,
        }
    }

    pub(super) fn set(&mut self, vertex: u32, point: LimitPoint, origin: Origin) {
        let at = (vertex - self.first) as usize;
        self.positions[at] = point.position.to_array();
        self.normals[at] = point.normal.to_array();
        if let Some(known) = self.origins.get_mut(at) {
            *known = origin;
        }
    }
}

pub(super) fn split_off<'a, T>(slice: &mut &'a mut [T], count: usize) -> &'a mut [T] {
    let (head, tail) = core::mem::take(slice).split_at_mut(count);
    *slice = tail;
    head
}

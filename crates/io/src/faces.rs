//! The faces of a file that holds polygons: triangles, and the quads that replace pairs of them.

use crate::output::Output;
use limitmesh::HalfEdgeId;

/// No quad.
const NONE: u32 = u32::MAX;

/// The faces of an output, each in the place of its first triangle.
pub(crate) struct Faces<'a> {
    quads: &'a [[HalfEdgeId; 2]],
    /// By face, its triangle, and the quad that it is the first of, or [`NONE`]; empty where all faces are triangles.
    order: Vec<[u32; 2]>,
    triangles: usize,
}

/// The corners of a face: 3t + i is corner i of triangle t.
pub(crate) struct Corners {
    all: [usize; 4],
    count: usize,
}

impl<'a> Faces<'a> {
    pub(crate) fn of(output: &Output<'a>) -> Self {
        let (quads, triangles) = (output.quads, output.surface.triangles.len());
        let mut order = Vec::new();
        if !quads.is_empty() {
            let mut quad_of = vec![[NONE; 2]; triangles];
            for (quad, halves) in (0..).zip(quads) {
                let [first, second] = halves.map(|h| h.face().index());
                quad_of[first.min(second)] = [quad, first.min(second) as u32];
                quad_of[first.max(second)] = [quad, first.min(second) as u32];
            }
            let each = (0..).zip(quad_of);
            let firsts = each.filter(|&(face, [quad, first])| quad == NONE || first == face);
            order = firsts.map(|(face, [quad, _])| [face, quad]).collect();
        }
        Self {
            quads,
            order,
            triangles,
        }
    }

    pub(crate) fn count(&self) -> usize {
        match self.quads {
            [] => self.triangles,
            _ => self.order.len(),
        }
    }

    /// The triangle whose values a face has.
    pub(crate) fn triangle(&self, face: usize) -> usize {
        self.order.get(face).map_or(face, |own| own[0] as usize)
    }

    /// The corners of a face, in its order.
    pub(crate) fn corners(&self, face: usize) -> Corners {
        let quad = self.order.get(face).map_or(NONE, |own| own[1]);
        match self.quads.get(quad as usize) {
            None => {
                let first = 3 * self.triangle(face);
                Corners {
                    all: [first, first + 1, first + 2, 0],
                    count: 3,
                }
            }
            Some(&[h, twin]) => {
                let around = [twin.next(), twin.previous(), h.next(), h.previous()];
                Corners {
                    all: around.map(|h| h.0 as usize),
                    count: 4,
                }
            }
        }
    }
}

impl core::ops::Deref for Corners {
    type Target = [usize];

    fn deref(&self) -> &[usize] {
        &self.all[..self.count]
    }
}

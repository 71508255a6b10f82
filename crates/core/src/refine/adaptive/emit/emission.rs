//! The emitted mesh, and the numbers of its vertices.

use super::super::chains::Chains;
use super::super::control::Control;
use super::super::cover::Cover;
use super::super::quadtree::FULL;
use crate::mesh::{Junctions, NONE};
use crate::progress::{Cancelled, SharedWatch};
use crate::refine::exact_result::Origin;
use crate::vector::{DVec3, vector};

/// The emitted mesh.
pub(in super::super) struct Emission {
    pub(in super::super) positions: Vec<[f64; 3]>,
    pub(in super::super) normals: Vec<[f64; 3]>,
    /// Empty where they are not wanted.
    pub(in super::super) origins: Vec<Origin>,
    pub(in super::super) triangles: Vec<[u32; 3]>,
    pub(in super::super) twins: Vec<u32>,
    pub(in super::super) parents: Vec<u32>,
    /// By control face, its first triangle; one more than there are faces.
    pub(in super::super) starts: Vec<u32>,
    /// How far each vertex was moved along its normal; empty where none was.
    pub(in super::super) offsets: Vec<f64>,
    /// The half-edges along each control half-edge, from its start.
    pub(in super::super) borders: Borders,
    /// By control half-edge along a sharp edge, the normals on its side of the vertices inside it.
    pub(in super::super) sharp: Vec<(u32, Vec<[f64; 3]>)>,
    /// Copies of vertices and edges of cut sheets.
    pub(in super::super) junctions: Junctions,
    /// Where the vertices lay before they were moved; empty where none was.
    pub(super) bases: Vec<[f64; 3]>,
    /// How the vertices of control faces that were kept were moved before.
    pub(super) before: Moves,
    pub(super) numbers: Numbers,
    /// By control face, whether it was written anew, not kept.
    pub(super) is_new: Vec<bool>,
}

/// How far vertices were moved, and where they lie since; empty where none was.
#[derive(Default)]
pub(super) struct Moves {
    pub(super) offsets: Vec<f64>,
    pub(super) positions: Vec<[f64; 3]>,
}

/// The numbers of vertices.
pub(super) struct Numbers {
    /// By half-edge, the first of its own; one more than there are half-edges.
    pub(super) on_edges: Vec<u32>,
    /// By control face, the first inside it; one more than there are faces.
    pub(super) inside: Vec<u32>,
}

impl Emission {
    /// The numbers of a control face's triangles.
    pub(in super::super) fn triangles_of(&self, face: u32) -> core::ops::Range<usize> {
        self.starts[face as usize] as usize..self.starts[face as usize + 1] as usize
    }

    /// The vertices inside a control face.
    pub(in super::super) fn vertices_inside(&self, face: u32) -> core::ops::Range<usize> {
        self.numbers.inside[face as usize] as usize..self.numbers.inside[face as usize + 1] as usize
    }

    /// Whether a control face was written anew, not kept.
    pub(in super::super) fn is_new(&self, face: u32) -> bool {
        self.is_new[face as usize]
    }

    /// The vertices of a control face; some more than once.
    pub(in super::super) fn vertices_of(&self, face: u32) -> impl Iterator<Item = u32> {
        let half_edges = (3 * face..3 * face + 3).flat_map(|h| self.borders.along(h));
        let starts = half_edges.map(|&h| self.triangles[h as usize / 3][h as usize % 3]);
        self.vertices_inside(face)
            .map(|vertex| vertex as u32)
            .chain(starts)
    }

    /// How far the vertices of control faces that were kept were moved before; of others that is not known. `None` where all are
    /// new, or none was moved.
    pub(in super::super) fn offsets_before(&mut self) -> Option<Vec<f64>> {
        let offsets = core::mem::take(&mut self.before.offsets);
        (!offsets.is_empty()).then_some(offsets)
    }

    /// Moves the vertices along their normals. Only those of some control faces are moved otherwise than before.
    pub(in super::super) fn shift(
        &mut self,
        offsets: Vec<f64>,
        faces: &[u32],
        watch: &SharedWatch<'_>,
    ) -> Result<(), Cancelled> {
        self.offsets = offsets;
        let mut moved = core::mem::take(&mut self.before.positions);
        let at =
            |vertex: u32| (vector(self.positions[vertex as usize]) + self.step(vertex)).to_array();
        if moved.is_empty() {
            moved = limitmesh_pages::with_capacity(self.positions.len());
            watch.each(0..self.positions.len() as u32, |vertex| {
                moved.push(at(vertex))
            })?;
        } else {
            watch.each(faces, |&face| {
                self.vertices_of(face)
                    .for_each(|vertex| moved[vertex as usize] = at(vertex));
            })?;
            let copies = self.junctions.vertices.iter().flatten();
            copies.for_each(|&vertex| moved[vertex as usize] = at(vertex));
        }
        self.bases = core::mem::replace(&mut self.positions, moved);
        Ok(())
    }

    /// How far the corners of a triangle were moved.
    pub(in super::super) fn offsets_of(&self, triangle: usize) -> [f64; 3] {
        self.triangles[triangle]
            .map(|vertex| self.offsets.get(vertex as usize).copied().unwrap_or(0.0))
    }

    /// How far a vertex was moved, and in which direction.
    pub(in super::super) fn step(&self, vertex: u32) -> DVec3 {
        let offset = self.offsets.get(vertex as usize).copied().unwrap_or(0.0);
        offset * vector(self.normals[vertex as usize])
    }
}

/// The emitted half-edges along the edges of control faces.
pub(in super::super) struct Borders {
    pub(super) starts: Vec<u32>,
    pub(super) half_edges: Vec<u32>,
}

impl Borders {
    /// Along a control half-edge, from its start.
    pub(in super::super) fn along(&self, h: u32) -> &[u32] {
        &self.half_edges[self.starts[h as usize] as usize..self.starts[h as usize + 1] as usize]
    }
}

pub(super) const NOWHERE: Origin = Origin {
    face: NONE,
    barycentric: [0.0; 3],
};

impl Numbers {
    pub(super) fn of(control: &Control<'_>, chains: &Chains, covers: &[Cover]) -> Self {
        let first = (control.mesh.vertex_count() + chains.count()) as u32;
        let inside = covers.iter().scan(first, |next, cover| {
            *next += cover.vertices;
            Some(*next)
        });
        let inside = core::iter::once(first).chain(inside);
        let on_edges = (0..3 * covers.len() as u32)
            .map(|h| chains.own(h).0)
            .chain([first]);
        Self {
            on_edges: on_edges.collect(),
            inside: inside.collect(),
        }
    }
}

pub(super) fn fraction(at: u32) -> f64 {
    f64::from(at) / f64::from(FULL)
}

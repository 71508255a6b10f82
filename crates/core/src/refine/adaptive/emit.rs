//! Emits the leaves as a conforming mesh: vertices and their limits, triangles, twins, parents, origins.
//!
//! Vertices stand in this order: those of the control mesh, those on its edges, those inside its faces; triangles face
//! by face, in the order of the walk. Where each face begins follows from the counts, so faces are written at once
//! by as many threads as there are, each into its own parts of the arrays. Faces that were emitted before and have not changed
//! since stay in the arrays, and are numbered anew ([`kept`]).

mod arrays;
mod emission;
mod emitter;
mod job;
mod jobs;
mod kept;
mod leaf_writer;

use limitmesh_pages::defaults;

use super::chains::first_of;
use super::quadtree::FULL;
use crate::mesh::{Junctions, MAX_FACES, MeshError, NONE};
use crate::parallel;
use crate::progress::{Cancelled, SharedWatch};
use crate::refine::RefineError;
use crate::refine::exact_result::Origin;
use crate::vector::{DVec3, unit_or_zero, vector};
use arrays::{Arrays, Lengths, Shifts};
pub(super) use emission::Emission;
use emission::{Borders, Numbers};
pub(super) use emitter::Emitter;
use jobs::{jobs, on_edge, write};
use kept::Kept;

impl Emitter<'_> {
    /// Emits the leaves into the arrays of what was emitted before, if anything was.
    pub(super) fn emit(
        &self,
        before: Option<Emission>,
        watch: &SharedWatch<'_>,
    ) -> Result<Emission, RefineError> {
        let Self {
            control,
            chains,
            covers,
            ..
        } = *self;
        let faces = control.mesh.face_count();
        let total: usize = covers.iter().map(|cover| cover.triangles as usize).sum();
        let inside: usize = covers.iter().map(|cover| cover.vertices as usize).sum();
        let on_edges = control.mesh.vertex_count() + chains.count();
        if total > MAX_FACES || on_edges + inside >= NONE as usize {
            return Err(MeshError::TooMany {
                what: "triangles",
                count: total,
                limit: MAX_FACES,
            }
            .into());
        }
        // Normals on sharp edges are averages by now.
        let is_new = |(face, &is_changed): (u32, &bool)| {
            before.is_none() || is_changed || control.open(face) != [false; 3]
        };
        let is_new: Vec<bool> = (0..).zip(self.is_changed).map(is_new).collect();
        let mut starts = defaults::<u32>(3 * faces + 1);
        watch.each(0..3 * faces, |h| {
            starts[h + 1] = starts[h] + chains.along(&control.edges, h as u32) as u32 + 1
        })?;
        let mut next = 0;
        let first_triangles = covers.iter().map(|cover| {
            next += cover.triangles;
            next - cover.triangles
        });
        let first_triangles: Vec<u32> = first_triangles.chain([total as u32]).collect();
        let numbers = Numbers::of(control, chains, covers);
        let length = Lengths {
            vertices: on_edges + inside,
            triangles: total,
        };
        let mut before = before;
        let arrays = match &mut before {
            Some(before) => {
                let mut arrays = Arrays::taken(before);
                let shifts = self.shifts(before, &is_new, &numbers, &first_triangles, watch)?;
                arrays.rearrange(length, &shifts.0, &shifts.1, watch)?;
                arrays
            }
            None => {
                // One in so many elements is kept free for later divisions, since arrays that become too short are copied. With balanced
                // vertices a sixth is divided later, with others a tenth.
                let spare = if self.is_balanced { 4 } else { 8 };
                Arrays::fresh(length, spare, self.has_origins, watch)?
            }
        };
        let Arrays {
            positions,
            normals,
            origins,
            triangles,
            twins,
            parents,
            moves,
        } = arrays;
        let mut emission = Emission {
            positions,
            normals,
            origins,
            triangles,
            twins,
            parents,
            starts: first_triangles,
            offsets: Vec::new(),
            borders: Borders {
                half_edges: defaults(starts[3 * faces] as usize),
                starts,
            },
            sharp: Vec::new(),
            junctions: Junctions::default(),
            bases: Vec::new(),
            before: moves,
            numbers,
            is_new,
        };
        self.corners(&mut emission, watch)?;
        let jobs = jobs(self, &mut emission, watch)?;
        let kept = before.as_ref().map(|before| Kept {
            before,
            control,
            chains,
        });
        parallel::each_long_polled(jobs, &mut |_| watch.poll(), |job, is_stopped| {
            write(self, kept.as_ref(), job, is_stopped);
        })?;
        self.join(&mut emission, watch)?;
        self.sharp_edges(&mut emission, watch)?;
        Ok(emission)
    }

    /// Where the vertices and triangles of control faces that are kept stood before, and where they stand now.
    fn shifts(
        &self,
        before: &Emission,
        is_new: &[bool],
        now: &Numbers,
        starts: &[u32],
        watch: &SharedWatch<'_>,
    ) -> Result<(Shifts, Shifts), Cancelled> {
        let (mut vertices, mut triangles) = (Shifts::default(), Shifts::default());
        vertices.push(0..self.control.mesh.vertex_count(), 0);
        let was = &before.numbers;
        watch.each(0..3 * is_new.len(), |h| {
            if !is_new[h / 3] {
                vertices.push(
                    was.on_edges[h] as usize..was.on_edges[h + 1] as usize,
                    now.on_edges[h] as usize,
                );
            }
        })?;
        watch.each(0..is_new.len(), |face| {
            if !is_new[face] {
                vertices.push(
                    before.vertices_inside(face as u32),
                    now.inside[face] as usize,
                );
                triangles.push(before.triangles_of(face as u32), starts[face] as usize);
            }
        })?;
        Ok((vertices, triangles))
    }

    /// The control vertices.
    fn corners(&self, emission: &mut Emission, watch: &SharedWatch<'_>) -> Result<(), Cancelled> {
        let control = self.control;
        let count = control.mesh.vertex_count();
        emission.positions[..count].copy_from_slice(&control.positions);
        emission.normals[..count].copy_from_slice(control.sided.by_vertex());
        if emission.origins.is_empty() {
            return Ok(());
        }
        watch.each((0..).zip(control.mesh.triangles()), |(face, triangle)| {
            for (corner, &vertex) in triangle.iter().enumerate() {
                let origin = &mut emission.origins[vertex as usize];
                if origin.face == NONE {
                    let mut barycentric = [0.0; 3];
                    barycentric[corner] = 1.0;
                    *origin = Origin { face, barycentric };
                }
            }
        })
    }

    /// Makes the half-edges on both sides of control edges twins.
    fn join(&self, emission: &mut Emission, watch: &SharedWatch<'_>) -> Result<(), Cancelled> {
        let Emission { borders, twins, .. } = emission;
        watch.each(0..borders.starts.len() as u32 - 1, |h| {
            match self.control.edges.twin(h) {
                Some(twin) if h < twin => {
                    for (&a, &b) in borders
                        .along(h)
                        .iter()
                        .zip(borders.along(twin).iter().rev())
                    {
                        (twins[a as usize], twins[b as usize]) = (b, a);
                    }
                }
                Some(_) => {}
                None => borders
                    .along(h)
                    .iter()
                    .for_each(|&a| twins[a as usize] = NONE),
            }
        })
    }

    /// Normals on both sides of sharp edges: a vertex has their average.
    fn sharp_edges(
        &self,
        emission: &mut Emission,
        watch: &SharedWatch<'_>,
    ) -> Result<(), Cancelled> {
        let Self {
            control, chains, ..
        } = *self;
        if control.infinitely_sharp.is_empty() {
            return Ok(());
        }
        for face in 0..control.mesh.face_count() as u32 {
            let open = control.open(face);
            if open != [false; 3] || face.is_multiple_of(1 << 12) {
                watch.poll()?;
            }
            for edge in (0..3).filter(|&edge| open[edge]) {
                let h = 3 * face + edge as u32;
                let Some(twin) = control.edges.twin(h) else {
                    continue;
                };
                let (number, places) = chains.own(first_of(&control.edges, h));
                let mut normals = vec![[0.0; 3]; places.len()];
                if h < twin {
                    normals.copy_from_slice(
                        &emission.normals[number as usize..number as usize + places.len()],
                    );
                } else {
                    let turned: Vec<u32> = places.iter().rev().map(|&at| FULL - at).collect();
                    let piece = control.piece(face);
                    on_edge(
                        face,
                        edge,
                        &turned,
                        piece.surface(control.rules),
                        |i, point, _| {
                            normals[i] = point.normal.to_array();
                        },
                    );
                }
                emission.sharp.push((h, normals));
            }
        }
        watch.each(&emission.sharp, |(h, normals)| {
            let owner = first_of(&control.edges, *h);
            if owner != *h {
                let number = chains.own(owner).0;
                for (vertex, normal) in (number..).zip(normals.iter().rev()) {
                    let known = &mut emission.normals[vertex as usize];
                    let sum: DVec3 = vector(*known) + vector(*normal);
                    *known = unit_or_zero(sum).to_array();
                }
            }
        })
    }
}

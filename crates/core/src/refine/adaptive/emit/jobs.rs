//! The faces of an emission in shares, each with the parts of the arrays that are its own, and how a share is written.

use super::super::quadtree::is_split;
use super::super::rim::Rim;
use super::super::surface::Surface;
use super::super::walk::Walk;
use super::emission::{Emission, fraction};
use super::emitter::Emitter;
use super::job::{Job, Vertices, split_off};
use super::kept::Kept;
use super::leaf_writer::Writer;
use crate::mesh::NONE;
use crate::parallel::IsStopped;
use crate::patch::LimitPoint;
use crate::progress::{Cancelled, SharedWatch};
use crate::refine::exact_result::Origin;

pub(super) fn jobs<'a>(
    emitter: &Emitter<'_>,
    emission: &'a mut Emission,
    watch: &SharedWatch<'_>,
) -> Result<Vec<Job<'a>>, Cancelled> {
    let Emitter { chains, covers, .. } = *emitter;
    let count = emitter.control.mesh.vertex_count();
    let Emission {
        positions,
        normals,
        origins,
        triangles,
        twins,
        parents,
        borders,
        is_new,
        ..
    } = emission;
    let first = count as u32;
    let origins = origins.get_mut(count..).unwrap_or_default();
    let (positions, normals) = (&mut positions[count..], &mut normals[count..]);
    let mut inside = Vertices {
        first,
        positions,
        normals,
        origins,
    };
    let mut on_edges = inside.take(chains.count());
    let mut rest = (
        &mut triangles[..],
        &mut twins[..],
        &mut parents[..],
        &mut borders.half_edges[..],
    );
    let (mut jobs, mut from, mut first_triangle) = (Vec::new(), 0u32, 0u32);
    let (mut triangles, mut own, mut vertices, mut segments) = (0u32, 0usize, 0usize, 0usize);
    let faces = covers.len() as u32;
    watch.each((0..).zip(covers), |(face, cover)| {
        triangles += cover.triangles;
        vertices += cover.vertices as usize;
        for h in 3 * face..3 * face + 3 {
            own += chains.own(h).1.len();
            segments += chains.along(&emitter.control.edges, h) + 1;
        }
        let own_is_new = is_new[face as usize];
        let is_last = face + 1 == faces || own_is_new != is_new[face as usize + 1];
        // A call writes about so many triangles.
        if triangles >= 8192 || is_last {
            jobs.push(Job {
                is_new: own_is_new,
                faces: from..face + 1,
                on_edges: on_edges.take(own),
                inside: inside.take(vertices),
                first_triangle,
                triangles: split_off(&mut rest.0, triangles as usize),
                twins: split_off(&mut rest.1, 3 * triangles as usize),
                parents: split_off(&mut rest.2, triangles as usize),
                borders: split_off(&mut rest.3, segments),
            });
            first_triangle += triangles;
            from = face + 1;
            (triangles, own, vertices, segments) = (0, 0, 0, 0);
        }
    })?;
    Ok(jobs)
}

/// Writes the faces of a job.
pub(super) fn write(
    emitter: &Emitter<'_>,
    kept: Option<&Kept<'_>>,
    mut job: Job<'_>,
    is_stopped: &IsStopped<'_>,
) {
    let Emitter {
        control,
        trees,
        chains,
        covers,
        ..
    } = *emitter;
    if let Some(kept) = kept.filter(|_| !job.is_new) {
        return kept.renumber(covers, job, is_stopped);
    }
    job.twins.fill(NONE);
    let mut walk = Walk::new(trees, Vec::new(), job.inside.first, is_stopped);
    let mut writer = Writer {
        face: 0,
        diagonals: &[],
        next_triangle: job.first_triangle,
        inside: job.inside,
        first_triangle: job.first_triangle,
        triangles: job.triangles,
        twins: job.twins,
        rim: Rim::default(),
        below: Vec::new(),
        places: Vec::new(),
        rows: Default::default(),
        is_stopped,
    };
    for face in job.faces {
        let word = trees.root(face);
        if !is_split(word) && chains.are_none(&control.edges, face) {
            let first = writer.push(control.mesh.triangles()[face as usize]);
            job.parents[(first / 3 - job.first_triangle) as usize] = face;
            let own = split_off(&mut job.borders, 3);
            (first..).zip(own).for_each(|(h, border)| *border = h);
            continue;
        }
        walk.edge_vertices.clear();
        let sides = chains.sides(control.mesh, &control.edges, face, &mut walk.edge_vertices);
        (writer.face, writer.diagonals) = (face, &covers[face as usize].diagonals);
        let before = writer.next_triangle - job.first_triangle;
        let own = [0, 1, 2].map(|edge| chains.own(3 * face + edge));
        if !is_split(word) && own.iter().all(|(_, places)| places.is_empty()) {
            // No vertex is its own.
            walk.face(face, sides, Surface::Unknown, &mut writer);
        } else {
            let piece = control.piece(face);
            let surface = piece.surface(control.rules);
            for (edge, (number, places)) in own.into_iter().enumerate() {
                on_edge(face, edge, places, surface, |i, point, origin| {
                    job.on_edges.set(number + i as u32, point, origin);
                });
            }
            walk.face(face, sides, surface, &mut writer);
        }
        let after = writer.next_triangle - job.first_triangle;
        job.parents[before as usize..after as usize].fill(face);
        for side in sides {
            let own = split_off(&mut job.borders, side.segments());
            for (i, border) in own.iter_mut().enumerate() {
                *border = walk.edge_vertices[side.segment(i)].half_edge;
            }
        }
    }
}

/// Evaluates the vertices at the given places along an edge of a control face.
pub(super) fn on_edge(
    face: u32,
    edge: usize,
    places: &[u32],
    surface: Surface<'_>,
    mut found: impl FnMut(usize, LimitPoint, Origin),
) {
    if places.is_empty() {
        return;
    }
    let places: Vec<f64> = places.iter().map(|&at| fraction(at)).collect();
    surface.along(edge, &places, &mut |i, point| {
        let mut barycentric = [0.0; 3];
        (barycentric[edge], barycentric[(edge + 1) % 3]) = (1.0 - places[i], places[i]);
        found(i, point, Origin { face, barycentric });
    });
}

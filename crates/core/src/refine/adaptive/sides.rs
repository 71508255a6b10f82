//! The emitted mesh along sharp and cut edges: normals by side, tags, copies.

use super::chains::Chains;
use super::control::Control;
use super::emit::Emission;
use crate::index::HalfEdgeId;
use crate::mesh::{CreaseTag, Groups, INFINITELY_SHARP, Junctions, NONE, Tags};
use crate::parallel;
use crate::progress::{Cancelled, SharedWatch};

/// The normals of the corners of emitted triangles at vertices on sharp edges, by the half-edge that leaves the corner,
/// ascending.
pub(super) fn sides(
    control: &Control<'_>,
    watch: &SharedWatch<'_>,
    emission: &Emission,
) -> Result<Vec<(u32, [f64; 3])>, Cancelled> {
    let mut sides = Vec::new();
    if control.infinitely_sharp.is_empty() {
        return Ok(sides);
    }
    let mut around = |from: u32, to: u32, normal: [f64; 3]| {
        // Counter-clockwise from the half-edge that leaves the vertex to the one that comes in.
        let mut h = from;
        loop {
            sides.push((h, normal));
            let before = if h.is_multiple_of(3) { h + 2 } else { h - 1 };
            if before == to {
                break;
            }
            h = emission.twins[before as usize];
            if h == NONE || h == from {
                break;
            }
        }
    };
    watch.each(&emission.sharp, |(h, normals)| {
        let along = emission.borders.along(*h);
        for (ends, &normal) in along.windows(2).zip(normals) {
            around(ends[1], ends[0], normal);
        }
    })?;
    let topology = control.mesh.topology();
    let mut is_tagged = vec![false; control.mesh.vertex_count()];
    control
        .infinitely_sharp
        .tagged_vertices()
        .for_each(|vertex| is_tagged[vertex.index()] = true);
    watch.each(
        (0..3 * control.mesh.face_count() as u32).map(HalfEdgeId),
        |h| {
            if is_tagged[topology.origin(h).index()] {
                let (own, before) = (
                    emission.borders.along(h.0),
                    emission.borders.along(h.previous().0),
                );
                if let (Some(&from), Some(&to)) = (own.first(), before.last()) {
                    around(from, to, control.sided.at(topology, h));
                }
            }
        },
    )?;
    parallel::sort_polled(&mut sides, &mut |_| watch.poll(), |a, b| a.0.cmp(&b.0))?;
    Ok(sides)
}

/// The tags of the emitted mesh: creases along those of the control mesh, and its corners.
pub(super) fn tags(
    control: &Control<'_>,
    watch: &SharedWatch<'_>,
    emission: &Emission,
) -> Result<Tags, Cancelled> {
    let corners = control
        .mesh
        .tags()
        .corners
        .iter()
        .filter(|tag| tag.sharpness >= INFINITELY_SHARP);
    let mut tags = Tags {
        corners: corners.copied().collect(),
        ..Tags::default()
    };
    watch.each(&emission.sharp, |(h, _)| {
        for &h in emission.borders.along(*h) {
            // Each is met from both sides.
            if h < emission.twins[h as usize] {
                let triangle = emission.triangles[h as usize / 3];
                let ends = [0, 1].map(|i| triangle[(h as usize + i) % 3]);
                tags.creases.push(CreaseTag {
                    vertices: ends,
                    sharpness: INFINITELY_SHARP,
                });
            }
        }
    })?;
    Ok(tags)
}

/// The copies of vertices and edges of cut sheets.
pub(super) fn junctions(
    control: &Control<'_>,
    watch: &SharedWatch<'_>,
    chains: &Chains,
    emission: &Emission,
) -> Result<Junctions, Cancelled> {
    let mut junctions = Junctions {
        vertices: control.mesh.junctions().vertices.clone(),
        edges: Groups::default(),
    };
    let edges = &control.edges;
    watch.each(0..edges.group_count(), |group| {
        let members = edges.members(group);
        let Some(&(first, _)) = members.first() else {
            return;
        };
        let places = chains.own(first).1.len();
        let at = |turned: bool, count: usize, place: usize| {
            if turned { count - 1 - place } else { place }
        };
        for place in 0..places {
            let copy =
                |&(h, turned): &(u32, bool)| chains.own(h).0 + at(turned, places, place) as u32;
            junctions.vertices.push(members.iter().map(copy));
        }
        for place in 0..=places {
            let copy = |&(h, turned): &(u32, bool)| {
                emission.borders.along(h)[at(turned, places + 1, place)]
            };
            junctions.edges.push(members.iter().map(copy));
        }
    })?;
    Ok(junctions)
}

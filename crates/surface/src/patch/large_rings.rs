//! The vertices of very many edges of a mesh, so that the pieces of their faces are made without looking at all of them.
//!
//! Takes a mesh; gives, for a face at such a vertex, the neighbours near the face and what the rules ask of the others. What tags make of rings
//! is found once for each vertex, if it is asked for; else what is tagged has to be looked at as a whole.

use std::sync::Arc;

use super::Neighbours;
use super::Rules;
use super::pole::{KEPT, LARGEST_RING};
use super::sector::{Centre, Far, VertexSector};
use super::semi_sharp::WholeRing;
use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::{Mesh, Sharpness, Topology};
use crate::parallel::Poll;
use crate::progress::{Cancelled, uncancelled};
use crate::vector::{DVec3, vector};

/// The vertices of very many edges, ascending.
#[derive(Clone, Debug, Default)]
pub struct LargeRings(Vec<(VertexId, Ring)>);

#[derive(Clone, Debug)]
struct Ring {
    /// The number of neighbours, and their mean; of an open ring the first and the last.
    valence: usize,
    mean: DVec3,
    ends: Option<[VertexId; 2]>,
    /// Its levels of refinement, where tags count.
    whole: Option<Arc<WholeRing>>,
}

impl LargeRings {
    /// The large rings of `mesh`, with their refined rings where tags count.
    pub fn with_tags(mesh: &Mesh, sharpness: &Sharpness<'_>, rules: &Rules<'_>) -> Self {
        uncancelled(|_| Self::with_tags_polled(mesh, sharpness, rules, &mut |_| Ok(())))
    }

    /// [`Self::with_tags`] that can be cancelled, between the levels on which a ring is semi-sharp.
    pub fn with_tags_polled(
        mesh: &Mesh,
        sharpness: &Sharpness<'_>,
        rules: &Rules<'_>,
        poll: &mut Poll<'_>,
    ) -> Result<Self, Cancelled> {
        let mut large = Self::of(mesh);
        if sharpness.is_empty() || !rules.are_of_loop_family() {
            return Ok(large);
        }
        let levels = sharpness.semi_sharp_levels();
        // A semi-sharp tag may be adjacent to any of them.
        for (vertex, ring) in large
            .0
            .iter_mut()
            .filter(|(v, _)| levels > 0 || sharpness.is_tagged(*v))
        {
            ring.whole =
                WholeRing::of(mesh, sharpness, *vertex, levels, rules, poll)?.map(Arc::new);
        }
        Ok(large)
    }

    /// The refined rings of a vertex, if it is one of them and tags count.
    pub(super) fn whole(&self, vertex: VertexId) -> Option<&Arc<WholeRing>> {
        let number = self
            .0
            .binary_search_by_key(&vertex, |&(vertex, _)| vertex)
            .ok()?;
        self.0[number].1.whole.as_ref()
    }

    /// Those of `mesh`, whatever its tags.
    pub fn of(mesh: &Mesh) -> Self {
        let topology = mesh.topology();
        let mut faces = vec![0u32; mesh.vertex_count()];
        mesh.triangles()
            .as_flattened()
            .iter()
            .for_each(|&v| faces[v as usize] += 1);
        let large = topology
            .vertices()
            .filter(|v| faces[v.index()] as usize > LARGEST_RING);
        Self(
            large
                .map(|vertex| (vertex, Ring::of(mesh, vertex)))
                .collect(),
        )
    }

    /// The sector of the origin of `h` on the side of its face, if it is one of them.
    pub(super) fn sector(&self, mesh: &Mesh, h: HalfEdgeId) -> Option<VertexSector> {
        let near = self.near(mesh.topology(), h)?;
        let at = |v: VertexId| vector(mesh.positions()[v.index()]);
        let neighbours: Neighbours = near.neighbours.into_iter().map(at).collect();
        let (centre, slot, far) = (near.centre, near.slot, near.far);
        Some(VertexSector {
            at: at(mesh.topology().origin(h)),
            neighbours,
            centre,
            slot,
            far,
        })
    }

    /// The neighbours of which [`Self::sector`] is made.
    pub(super) fn near(&self, topology: &Topology, h: HalfEdgeId) -> Option<Near> {
        let vertex = topology.origin(h);
        let number = self
            .0
            .binary_search_by_key(&vertex, |&(vertex, _)| vertex)
            .ok()?;
        let ring = &self.0[number].1;
        // The neighbour after the face's next corner is there too.
        let after = KEPT / 2;
        let forward = core::iter::successors(Some(h), |h| topology.twin(h.previous()));
        let on = forward.take(after).map(|h| topology.opposite(h));
        let back =
            core::iter::successors(Some(h), |&h| topology.twin(h).map(HalfEdgeId::next)).skip(1);
        let before: Vec<VertexId> = back
            .take(KEPT - after - 1)
            .map(|h| topology.target(h))
            .collect();
        let mut neighbours = Vec::with_capacity(KEPT + 2);
        let Some([first, last]) = ring.ends else {
            neighbours.push(topology.target(h));
            neighbours.extend(on);
            neighbours.extend(before.into_iter().rev());
            let far = Far::Mean {
                valence: ring.valence,
                mean: ring.mean,
            };
            let centre = Centre::Smooth { sharp: None };
            return Some(Near {
                neighbours,
                centre,
                slot: 0,
                far,
                number,
            });
        };
        let after_first = before.len() + 1 == KEPT - after;
        neighbours.extend(after_first.then_some(first));
        neighbours.extend(before.into_iter().rev());
        let slot = neighbours.len();
        neighbours.push(topology.target(h));
        neighbours.extend(on);
        let before_last = neighbours.len() - slot == after + 1;
        neighbours.extend(before_last.then_some(last));
        let far = Far::Ends {
            after_first,
            before_last,
        };
        Some(Near {
            neighbours,
            centre: Centre::Crease,
            slot,
            far,
            number,
        })
    }

    /// The vertices, in the order of their numbers.
    pub fn vertices(&self) -> impl Iterator<Item = VertexId> + '_ {
        self.0.iter().map(|&(vertex, _)| vertex)
    }

    /// Sets the mean of a ring, by the vertex's number.
    pub fn set_mean(&mut self, number: usize, mean: DVec3) {
        self.0[number].1.mean = mean;
    }
}

/// The neighbours of a vertex of very many edges that are near a face, and what they are to the rules.
pub(super) struct Near {
    pub(super) neighbours: Vec<VertexId>,
    pub(super) centre: Centre,
    pub(super) slot: usize,
    pub(super) far: Far,
    /// The vertex's number among those of very many edges.
    pub(super) number: usize,
}

impl Ring {
    fn of(mesh: &Mesh, vertex: VertexId) -> Self {
        let ring: Vec<VertexId> = mesh.topology().ring(vertex).collect();
        let sum: DVec3 = ring
            .iter()
            .map(|v| vector(mesh.positions()[v.index()]))
            .sum();
        let ends = ring
            .first()
            .zip(ring.last())
            .filter(|_| mesh.topology().is_boundary(vertex));
        let ends = ends.map(|(&a, &b)| [a, b]);
        Self {
            valence: ring.len(),
            mean: sum / ring.len() as f64,
            ends,
            whole: None,
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::index::FaceId;
    use crate::patch::{Patch, root_patch};
    use crate::scheme::Loop;

    /// A fan of so many faces around vertex 0, closed or not, over an uneven rim with a second fan around it.
    pub(in crate::patch) fn fan(faces: usize, is_closed: bool) -> Mesh {
        let rim = if is_closed { faces } else { faces + 1 };
        let turn = if is_closed {
            core::f64::consts::TAU
        } else {
            3.0
        };
        let point = |i: usize, radius: f64| {
            let angle = turn * i as f64 / faces as f64;
            let radius = radius * (1.0 + 0.2 * (7.0 * angle).sin());
            [
                radius * angle.cos(),
                radius * angle.sin(),
                0.3 * (3.0 * angle + radius).sin(),
            ]
        };
        let mut positions = vec![[0.1, -0.1, 0.4]];
        positions.extend(
            (0..rim)
                .map(|i| point(i, 1.0))
                .chain((0..rim).map(|i| point(i, 1.5))),
        );
        let mut triangles = Vec::new();
        for i in 0..faces {
            let [a, b] = [i, (i + 1) % rim].map(|i| 1 + i as u32);
            let [c, d] = [a, b].map(|v| v + rim as u32);
            triangles.extend([[0, a, b], [a, c, d], [a, d, b]]);
        }
        Mesh::from_triangles(positions, triangles).unwrap()
    }

    /// The limits of the middles of all edges some levels down, in the same order for the same face.
    pub(in crate::patch) fn limits(
        patch: &Patch,
        rules: &Rules<'_>,
        levels: usize,
        found: &mut Vec<DVec3>,
    ) {
        let refined = patch.refined(rules);
        (0..3).for_each(|edge| found.push(refined.middle(edge).position));
        if levels > 0 {
            // Only what is at the old corners stays irregular.
            (0..3).for_each(|part| limits(&refined.part(part), rules, levels - 1, found));
        }
    }

    /// With and without all neighbours the surface is the same, near the ends of a fan too.
    #[test]
    fn the_surface_does_not_ask_for_neighbours_far_away() {
        let rules = Rules::of(&Loop);
        for (faces, is_closed) in [
            (LARGEST_RING + 1, true),
            (500, true),
            (LARGEST_RING + 1, false),
            (LARGEST_RING + 4, false),
            (500, false),
        ] {
            let mesh = fan(faces, is_closed);
            let (sharpness, large) = (Sharpness::of(&mesh), LargeRings::of(&mesh));
            assert_eq!(large.0.len(), 1);
            for face in [
                0,
                1,
                2,
                KEPT / 2 - 1,
                KEPT / 2,
                KEPT / 2 + 1,
                faces / 2,
                faces - 2,
                faces - 1,
            ] {
                let [near, whole] = [&large, &LargeRings::default()].map(|large| {
                    let mut found = Vec::new();
                    let patch =
                        root_patch(&mesh, &sharpness, large, FaceId(3 * face as u32), &rules);
                    if faces == 500 {
                        let mut points = 0;
                        patch.for_each_hull_point(|_| points += 1);
                        assert_eq!(points < KEPT + 20, !large.0.is_empty(), "{points} points");
                    }
                    limits(&patch, &rules, 4, &mut found);
                    // Far down at the vertex itself.
                    let mut deep = patch;
                    for _ in 0..100 {
                        let refined = deep.refined(&rules);
                        found.push(refined.middle(0).position);
                        deep = refined.part(0);
                    }
                    found
                });
                for (a, b) in near.iter().zip(&whole) {
                    assert!(
                        a.distance(*b) < 1e-12,
                        "{faces} {is_closed} {face}: {a} {b}"
                    );
                }
            }
        }
    }
}

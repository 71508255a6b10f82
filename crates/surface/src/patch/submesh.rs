//! Cuts a few faces with the rings of faces around them out of a mesh, with their tags.
//!
//! Takes a mesh, faces and a number of rings; gives a mesh of its own, small, and refines it. Its rim is a boundary where the mesh goes
//! on, so what is computed there is false: the number of rings is to be such that nothing that is used depends on it.

use std::collections::{HashMap, HashSet};

use crate::index::{FaceId, HalfEdgeId, VertexId};
use crate::mesh::{
    CornerTag, CreaseTag, Junctions, Mesh, NONE, Sharpness, Tags, Topology, outgoing_half_edges,
};

/// The faces of the half-edges in `seeds` and `rings` rings around them. Face `i` of the result is that of seed `i`, its
/// first half-edge the seed; the others follow.
pub fn submesh(mesh: &Mesh, sharpness: &Sharpness<'_>, seeds: &[HalfEdgeId], rings: usize) -> Mesh {
    submesh_of(mesh, sharpness, seeds, rings).0
}

/// [`submesh`], and the vertex of the mesh that each of its vertices is: some on the rim may be several.
pub fn submesh_of(
    mesh: &Mesh,
    sharpness: &Sharpness<'_>,
    seeds: &[HalfEdgeId],
    rings: usize,
) -> (Mesh, Vec<VertexId>) {
    let cut = Cut::around(mesh.topology(), seeds, rings);
    let count = 3 * cut.firsts.len() as u32;
    let twins: Vec<u32> = (0..count)
        .map(|h| {
            cut.topology
                .twin(cut.source(h))
                .map_or(NONE, |twin| cut.place(twin))
        })
        .collect();
    let (triangles, sources) = cut.vertices(&twins);
    let corners = (0..)
        .zip(&sources)
        .map(|(vertex, &source)| (vertex, sharpness.vertex(source)));
    let corners = corners.filter(|&(_, sharpness)| sharpness > 0.0);
    let tags = Tags {
        creases: cut.creases(sharpness, &triangles, &twins),
        corners: corners
            .map(|(vertex, sharpness)| CornerTag { vertex, sharpness })
            .collect(),
    };
    let positions = sources
        .iter()
        .map(|source| mesh.positions()[source.index()])
        .collect();
    let outgoing = outgoing_half_edges(&triangles, &twins, sources.len());
    let topology = Topology::from_parts(triangles, twins, outgoing);
    (
        Mesh::from_parts(topology, positions, tags, Junctions::default()),
        sources,
    )
}

/// The connectivity of a small mesh after one step of uniform refinement, the half-edges on which its new vertices stand, and its tags. Face `i`
/// becomes the faces from `4i` on, those at its corners and then the middle one, which starts at the new vertex on the first edge.
pub fn quartered(mesh: &Mesh) -> (Topology, Vec<HalfEdgeId>, Tags) {
    let topology = mesh.topology();
    let edges: Vec<HalfEdgeId> = topology
        .half_edges()
        .filter(|&h| topology.twin(h).is_none_or(|twin| h < twin))
        .collect();
    let mut on_edge = vec![NONE; topology.half_edge_count()];
    for (vertex, &h) in (mesh.vertex_count() as u32..).zip(&edges) {
        on_edge[h.index()] = vertex;
        topology
            .twin(h)
            .into_iter()
            .for_each(|twin| on_edge[twin.index()] = vertex);
    }
    let on = |face: usize, edge: usize| on_edge[3 * face + edge];
    let quartered = |(face, &[a, b, c]): (usize, &[u32; 3])| {
        let [d, e, f] = [0, 1, 2].map(|edge| on(face, edge));
        [[a, d, f], [b, e, d], [c, f, e], [d, e, f]]
    };
    let triangles: Vec<[u32; 3]> = mesh
        .triangles()
        .iter()
        .enumerate()
        .flat_map(quartered)
        .collect();
    // The halves of a half-edge, by the face at each of its ends.
    let halves = |h: HalfEdgeId| {
        let (face, edge) = (4 * h.face().0, h.corner() as u32);
        [3 * (face + edge), 3 * (face + (edge + 1) % 3) + 2]
    };
    let mut twins = limitmesh_pages::filled(NONE, 3 * triangles.len());
    for h in topology.half_edges() {
        if let Some(twin) = topology.twin(h) {
            let ([first, second], [other_first, other_second]) = (halves(h), halves(twin));
            (twins[first as usize], twins[second as usize]) = (other_second, other_first);
        }
        // Between the part at the corner and the middle one.
        let (face, corner) = (4 * h.face().0, h.corner() as u32);
        let (outer, inner) = (3 * (face + corner) + 1, 3 * (face + 3) + (corner + 2) % 3);
        (twins[outer as usize], twins[inner as usize]) = (inner, outer);
    }
    let tags = mesh.tags().refined(|a, b| {
        let h = topology.edge_between(a, b)?;
        Some(on_edge[h.index()])
    });
    let outgoing = outgoing_half_edges(&triangles, &twins, mesh.vertex_count() + edges.len());
    (
        Topology::from_parts(triangles, twins, outgoing),
        edges,
        tags,
    )
}

/// The faces that are cut out.
struct Cut<'m> {
    topology: &'m Topology,
    /// The first half-edge of each.
    firsts: Vec<HalfEdgeId>,
    /// Where each stands among them.
    places: HashMap<FaceId, u32>,
}

impl<'m> Cut<'m> {
    /// The numbering follows from the seeds and from what is around them, not from how the mesh is numbered.
    fn around(topology: &'m Topology, seeds: &[HalfEdgeId], rings: usize) -> Self {
        let places = (0..)
            .zip(seeds)
            .map(|(place, seed)| (seed.face(), place))
            .collect();
        let mut cut = Self {
            topology,
            firsts: seeds.to_vec(),
            places,
        };
        let (mut met, mut from) = (HashSet::new(), 0);
        for _ in 0..rings {
            let end = cut.firsts.len();
            for h in 3 * from..3 * end {
                let own = cut.source(h as u32);
                let vertex = topology.origin(own);
                if met.insert(vertex) {
                    let is_boundary = topology.is_boundary(vertex);
                    let first = if is_boundary {
                        topology.outgoing(vertex)
                    } else {
                        own
                    };
                    topology
                        .outgoing_from(first)
                        .for_each(|around| cut.add(around));
                }
            }
            from = end;
        }
        cut
    }

    fn add(&mut self, first: HalfEdgeId) {
        let place = self.firsts.len() as u32;
        if *self.places.entry(first.face()).or_insert(place) == place {
            self.firsts.push(first);
        }
    }

    /// The half-edge of the mesh that half-edge `h` of the result is.
    fn source(&self, h: u32) -> HalfEdgeId {
        let first = self.firsts[h as usize / 3];
        HalfEdgeId::of(first.face(), (first.corner() + h as usize % 3) % 3)
    }

    /// The half-edge of the result that a half-edge of the mesh becomes; [`NONE`] if its face is not among them.
    fn place(&self, h: HalfEdgeId) -> u32 {
        let place = |&place: &u32| {
            let first = self.firsts[place as usize];
            3 * place + ((h.corner() + 3 - first.corner()) % 3) as u32
        };
        self.places.get(&h.face()).map_or(NONE, place)
    }

    /// The triangles over new vertices, and the vertex of the mesh that each is. A vertex on the rim whose faces do not
    /// hang together any more becomes several.
    fn vertices(&self, twins: &[u32]) -> (Vec<[u32; 3]>, Vec<VertexId>) {
        let mut corners = vec![NONE; twins.len()];
        let mut sources = Vec::new();
        for h in 0..twins.len() as u32 {
            if corners[h as usize] != NONE {
                continue;
            }
            let vertex = sources.len() as u32;
            sources.push(self.topology.origin(self.source(h)));
            let mut give = |mut h: HalfEdgeId, turn: fn(&[u32], HalfEdgeId) -> u32| {
                loop {
                    corners[h.index()] = vertex;
                    h = HalfEdgeId(turn(twins, h));
                    if h.0 == NONE || corners[h.index()] != NONE {
                        return;
                    }
                }
            };
            give(HalfEdgeId(h), |twins, h| twins[h.previous().index()]);
            give(HalfEdgeId(h), |twins, h| match twins[h.index()] {
                NONE => NONE,
                twin => HalfEdgeId(twin).next().0,
            });
        }
        let triangles = corners
            .chunks_exact(3)
            .map(|face| [face[0], face[1], face[2]]);
        (triangles.collect(), sources)
    }

    fn creases(
        &self,
        sharpness: &Sharpness<'_>,
        triangles: &[[u32; 3]],
        twins: &[u32],
    ) -> Vec<CreaseTag> {
        if sharpness.is_empty() {
            return Vec::new();
        }
        let corners = triangles.as_flattened();
        let inner = (0..twins.len()).filter(|&h| twins[h] != NONE && h < twins[h] as usize);
        let tags = inner.map(|h| CreaseTag {
            vertices: [corners[h], corners[HalfEdgeId(h as u32).next().index()]],
            sharpness: sharpness.edge(self.source(h as u32)),
        });
        tags.filter(|tag| tag.sharpness > 0.0).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use limitmesh_testing::models;

    fn model(name: &str) -> Mesh {
        models::model(name)
    }

    /// Crops are meshes, and rings that lie inside are as they were.
    #[test]
    fn rings_inside_are_kept() {
        for name in ["cup", "sheet", "spike", "tetrahedron", "head"] {
            let mesh = model(name);
            let tags = Tags {
                creases: vec![CreaseTag {
                    vertices: [0, 1],
                    sharpness: 2.0,
                }],
                corners: vec![],
            };
            let tagged = mesh
                .topology()
                .edge_between(VertexId(0), VertexId(1))
                .is_some();
            let mesh = if tagged {
                mesh.with_tags(tags).unwrap()
            } else {
                mesh
            };
            let sharpness = Sharpness::of(&mesh);
            for rings in [1, 2] {
                for face in mesh.topology().faces().step_by(7) {
                    let seeds = [HalfEdgeId::of(face, 1)];
                    let small = submesh(&mesh, &sharpness, &seeds, rings);
                    small.validate().unwrap();
                    let small_sharpness = Sharpness::of(&small);
                    for corner in 0..3 {
                        let (old, new) = (
                            HalfEdgeId::of(face, (corner + 1) % 3),
                            HalfEdgeId::of(FaceId(0), corner),
                        );
                        let (old, new) =
                            (mesh.topology().origin(old), small.topology().origin(new));
                        assert_eq!(mesh.ring_shape(old), small.ring_shape(new), "{name}");
                        let at = |mesh: &Mesh, v| {
                            let ring = mesh.topology().ring(v).map(|u| mesh.positions()[u.index()]);
                            let mut points: Vec<_> = ring.map(|p| p.map(f64::to_bits)).collect();
                            points.sort_unstable();
                            points
                        };
                        assert_eq!(at(&mesh, old), at(&small, new), "{name}");
                        let edges = |sharpness: &Sharpness<'_>, v| sharpness.spokes(v).sum::<f64>();
                        assert_eq!(
                            edges(&sharpness, old),
                            edges(&small_sharpness, new),
                            "{name}"
                        );
                    }
                }
            }
        }
    }

    /// A face touched at two far corners of its ring only does not join what lies apart.
    #[test]
    fn vertices_of_the_rim_fall_apart() {
        let mesh = model("tetrahedron");
        let small = submesh(&mesh, &Sharpness::of(&mesh), &[HalfEdgeId(0)], 0);
        assert_eq!((small.face_count(), small.vertex_count()), (1, 3));
        let whole = submesh(&mesh, &Sharpness::of(&mesh), &[HalfEdgeId(0)], 1);
        assert_eq!((whole.face_count(), whole.vertex_count()), (4, 4));
    }
}

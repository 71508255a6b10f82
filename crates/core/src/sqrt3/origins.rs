//! Where the vertices and triangles of √3-subdivision came from on the control mesh.
//!
//! Two steps split a face in nine, so every vertex has its place in a control face, with coordinates that are multiples of a
//! power of 1/3. After an odd number of steps triangles lie across the edges of faces; each is counted to the one whose
//! half-edge gave it.

use crate::geometry::NONE;
use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::refine::Origin;

/// The origin of a vertex of a step.
#[derive(Clone, Copy, Debug)]
pub(super) enum Made {
    /// The centre of a face.
    Centre(u32),
    /// On a sharp edge of a face, next to the origin of its half-edge.
    NearOrigin(HalfEdgeId),
    /// On a sharp edge of a face, next to the target of its half-edge.
    NearTarget(HalfEdgeId),
}

/// Origins of vertices and control faces of triangles, from step to step.
pub(super) struct Origins<'m> {
    control: &'m Mesh,
    vertices: Vec<Origin>,
    parents: Vec<u32>,
}

impl<'m> Origins<'m> {
    /// Of a control mesh itself.
    pub(super) fn of(control: &'m Mesh) -> Self {
        let vertices = control
            .topology()
            .vertices()
            .map(|v| of_control(control, v))
            .collect();
        Self {
            control,
            vertices,
            parents: (0..control.face_count() as u32).collect(),
        }
    }

    /// Goes on by the step that made new vertices of the mesh `before` it.
    ///
    /// `straddles` says which faces lie across an edge of the level before: after an odd step all but those on sharp edges.
    pub(super) fn advance(
        &mut self,
        before: &Mesh,
        made: &[Made],
        straddles: impl Fn(usize) -> bool,
    ) {
        let topology = before.topology();
        for &made in made {
            let (face, ends) = match made {
                Made::Centre(face) if straddles(face as usize) => {
                    // (A, apex, apex) across the former edge from A to B.
                    let between = HalfEdgeId(3 * face + 1);
                    let b = topology.twin(between).map_or(between, HalfEdgeId::previous);
                    (
                        face,
                        [HalfEdgeId(3 * face), b].map(|h| topology.origin(h).0),
                    )
                }
                Made::Centre(face) => {
                    let corners =
                        before.triangles()[face as usize].map(|v| self.in_parent(v, face));
                    let barycentric = [0, 1, 2]
                        .map(|i| corners.iter().map(|corner| corner[i]).sum::<f64>() / 3.0);
                    self.vertices.push(Origin {
                        face: self.parents[face as usize],
                        barycentric,
                    });
                    continue;
                }
                Made::NearOrigin(h) => (h.face().0, topology.ends(h).map(|v| v.0)),
                Made::NearTarget(h) => (h.face().0, [topology.target(h).0, topology.origin(h).0]),
            };
            let origin = third(ends.map(|v| self.in_parent(v, face)));
            self.vertices.push(Origin {
                face: self.parents[face as usize],
                barycentric: origin,
            });
        }
        let parent = |h: HalfEdgeId| {
            // (A, apex, apex): the second is in the face across the edge, and so are the children
            // of its edges.
            let across = (h.corner() < 2 && straddles(h.face().index()))
                .then(|| topology.twin(HalfEdgeId::of(h.face(), 1)))
                .flatten();
            self.parents[across.unwrap_or(h).face().index()]
        };
        self.parents = topology.half_edges().map(parent).collect();
    }

    /// The origins at the end.
    pub(super) fn finish(self) -> (Vec<Origin>, Vec<u32>) {
        (self.vertices, self.parents)
    }

    /// The place of a vertex in the control face of a face.
    fn in_parent(&self, vertex: u32, face: u32) -> [f64; 3] {
        let parent = self.parents[face as usize];
        let own = self.vertices[vertex as usize].in_face(self.control.triangles(), parent);
        own.map_or([0.0; 3], |origin| origin.barycentric)
    }
}

/// The place a third of the way from the first to the second.
pub(super) fn third([near, far]: [[f64; 3]; 2]) -> [f64; 3] {
    [0, 1, 2].map(|i| (2.0 * near[i] + far[i]) / 3.0)
}

/// A control vertex in its first face.
pub(super) fn of_control(control: &Mesh, vertex: VertexId) -> Origin {
    let h = control.topology().outgoing(vertex);
    let mut barycentric = [0.0; 3];
    if h.0 == NONE {
        return Origin {
            face: 0,
            barycentric,
        };
    }
    barycentric[h.corner()] = 1.0;
    Origin {
        face: h.face().0,
        barycentric,
    }
}

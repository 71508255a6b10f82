//! Where the vertices and triangles of meshes that are refined step by step came from on the control mesh.

use super::Origin;
use super::quad_order::part_before;
use super::split::SplitTopology;
use crate::geometry::NONE;
use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::Mesh;
use crate::parallel;

/// A refined mesh that knows where on its control mesh it is.
pub trait Traced {
    /// The refined mesh.
    fn mesh(&self) -> &Mesh;

    /// Where each vertex came from; empty if that is not known.
    fn origins(&self) -> &[Origin];

    /// The control face of each triangle, of several one; empty if that is not known.
    fn parents(&self) -> &[u32];

    /// The origin of the corner that a half-edge leaves, in a control face on its own triangle's
    /// side of edges with distinct sides. `control` are the control mesh's triangles. `None` where
    /// that is not known.
    fn corner_origin(&self, control: &[[u32; 3]], corner: HalfEdgeId) -> Option<Origin> {
        let origin = self
            .origins()
            .get(self.mesh().topology().origin(corner).index())?;
        origin.in_face(control, *self.parents().get(corner.face().index())?)
    }
}

/// Origins and control faces of a mesh, from step to step.
pub(super) struct Lineage<'a> {
    control: &'a Mesh,
    origins: Vec<Origin>,
    parents: Vec<u32>,
}

impl<'a> Lineage<'a> {
    /// Of a control mesh itself.
    pub(super) fn of(control: &'a Mesh) -> Self {
        let topology = control.topology();
        let origin = |v: usize| {
            let h = topology.outgoing(VertexId(v as u32));
            // A vertex of no face came from nowhere.
            if h.0 == NONE {
                return Origin {
                    face: 0,
                    barycentric: [0.0; 3],
                };
            }
            let mut barycentric = [0.0; 3];
            barycentric[h.corner()] = 1.0;
            Origin {
                face: h.face().0,
                barycentric,
            }
        };
        let origins = (0..control.vertex_count()).map(origin).collect();
        Self {
            control,
            origins,
            parents: (0..control.face_count() as u32).collect(),
        }
    }

    /// Goes on by a step that numbered the elements of the mesh `before` it anew: vertices on edges are halfway between their ends.
    pub(super) fn advance(&mut self, before: &Mesh, numbered: &SplitTopology) {
        let control = self.control.triangles();
        let new = parallel::map(numbered.edges.len(), |edge| {
            let h = numbered.edges[edge];
            let face = self.parents[h.face().index()];
            let ends = before.topology().ends(h).map(|v| {
                let own = self.origins[v.index()].in_face(control, face);
                own.map_or([0.0; 3], |origin| origin.barycentric)
            });
            Origin {
                face,
                barycentric: [0, 1, 2].map(|i| 0.5 * (ends[0][i] + ends[1][i])),
            }
        });
        self.origins.extend(new);
        let children = self.parents.iter().zip(numbered.starts.windows(2));
        self.parents = children
            .flat_map(|(&parent, range)| {
                std::iter::repeat_n(parent, (range[1] - range[0]) as usize)
            })
            .collect();
        if before.topology().has_quads() {
            let parents = (0..self.parents.len()).map(|face| self.parents[part_before(face)]);
            self.parents = parents.collect();
        }
    }

    /// The origins at the end.
    pub(super) fn finish(self) -> (Vec<Origin>, Vec<u32>) {
        (self.origins, self.parents)
    }
}

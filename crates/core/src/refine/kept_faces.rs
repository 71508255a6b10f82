//! Edges of a control mesh with distinct sides, such as borders of materials: collapses keep them,
//! and no triangle crosses one.

use std::collections::HashSet;

use super::{Exact, RefineError};
use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::{Mesh, MeshError};

/// Pairs of control faces that meet in edges that are kept.
pub(super) struct KeptFaces(HashSet<[u32; 2]>);

impl KeptFaces {
    /// The edges with these ends.
    ///
    /// # Errors
    /// One of them is no edge of the control mesh.
    pub(super) fn of(control: &Mesh, kept: &[[u32; 2]]) -> Result<Self, RefineError> {
        let topology = control.topology();
        let exists = |v: u32| (v as usize) < topology.vertex_count();
        let mut pairs = HashSet::new();
        for &[a, b] in kept {
            let edge =
                (exists(a) && exists(b)).then(|| topology.edge_between(VertexId(a), VertexId(b)));
            let Some(edge) = edge.flatten() else {
                let place = format!("edge from vertex {a} to vertex {b}");
                return Err(MeshError::Broken {
                    place,
                    what: "an edge that is kept is one of the control mesh",
                }
                .into());
            };
            if let Some(twin) = topology.twin(edge) {
                pairs.insert(ordered(edge.face().0, twin.face().0));
            }
        }
        Ok(Self(pairs))
    }

    /// Whether two faces meet in an edge that is kept.
    #[inline]
    pub(super) fn part(&self, face: u32, other: u32) -> bool {
        !self.0.is_empty() && self.0.contains(&ordered(face, other))
    }

    /// The edges of a refined mesh along those, each of whose triangles comes from one control face.
    pub(super) fn edges(&self, fine: &Exact) -> Vec<[u32; 2]> {
        if self.0.is_empty() {
            return Vec::new();
        }
        let topology = fine.mesh.topology();
        let is_kept = |h: HalfEdgeId| {
            let Some(twin) = topology.twin(h).filter(|twin| h.0 < twin.0) else {
                return false;
            };
            let [one, other] = [h, twin].map(|h| fine.parents[h.face().index()]);
            one != other && self.0.contains(&ordered(one, other))
        };
        topology
            .half_edges()
            .filter(|&h| is_kept(h))
            .map(|h| topology.ends(h).map(|v| v.0))
            .collect()
    }
}

fn ordered(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

//! The connections of sheets that were cut apart.
//!
//! A non-manifold edge or a bow-tie vertex is cut so that each sheet is a manifold of its own. The copies of
//! a vertex, and the boundary half-edges that run along one original edge, are remembered here: refinement
//! splits the copies of an edge together, and the building gives all copies of a vertex rules with the same
//! outcome, so that no gap opens between the sheets.

use std::collections::HashMap;

use super::{MeshError, Topology};
use crate::index::HalfEdgeId;

/// Disjoint groups of indices of elements.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Groups {
    /// Start of each group in `members`, and its end as a last entry; empty without groups.
    starts: Vec<u32>,
    members: Vec<u32>,
}

impl Groups {
    /// Number of groups.
    pub fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Whether there is no group.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Adds a group.
    pub fn push(&mut self, members: impl IntoIterator<Item = u32>) {
        if self.starts.is_empty() {
            self.starts.push(0);
        }
        self.members.extend(members);
        self.starts.push(self.members.len() as u32);
    }

    /// Replaces each member.
    #[doc(hidden)]
    pub fn rename(&mut self, name: impl Fn(u32) -> u32) {
        self.members
            .iter_mut()
            .for_each(|member| *member = name(*member));
    }

    /// The groups, in the order they were added.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> {
        self.starts
            .windows(2)
            .map(|w| &self.members[w[0] as usize..w[1] as usize])
    }
}

/// Copies of vertices and edges, in groups of one original each.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Junctions {
    /// Groups of vertices at one position.
    pub vertices: Groups,
    /// Groups of boundary half-edges along one edge.
    pub edges: Groups,
}

impl Junctions {
    /// Whether the mesh was never cut.
    pub fn is_empty(&self) -> bool {
        self.vertices.is_empty() && self.edges.is_empty()
    }

    /// For each vertex that is a copy, the first of its group.
    #[doc(hidden)]
    pub fn first_copies(&self) -> HashMap<u32, u32> {
        let groups = self.vertices.iter();
        groups
            .flat_map(|group| group.iter().map(|&v| (v, group[0])))
            .collect()
    }

    /// Checks that copies have equal positions and that grouped half-edges are boundaries with the
    /// same ends.
    pub(crate) fn validate(
        &self,
        topology: &Topology,
        positions: &[[f64; 3]],
    ) -> Result<(), MeshError> {
        let broken = |place: String, what| Err(MeshError::Broken { place, what });
        for group in self.vertices.iter() {
            for &v in group {
                if v as usize >= positions.len() {
                    return broken(
                        format!("vertex {v}"),
                        "a junction names a vertex of the mesh",
                    );
                }
                if positions[v as usize] != positions[group[0] as usize] {
                    return broken(
                        format!("vertices {} and {v}", group[0]),
                        "copies of a cut vertex stand at one place",
                    );
                }
            }
        }
        for group in self.edges.iter() {
            let mut first: Option<[[f64; 3]; 2]> = None;
            for &h in group {
                if h as usize >= topology.half_edge_count() {
                    return broken(
                        format!("half-edge {h}"),
                        "a junction names a half-edge of the mesh",
                    );
                }
                let h = HalfEdgeId(h);
                if topology.twin(h).is_some() {
                    return broken(h.to_string(), "a cut edge is a boundary of its sheet");
                }
                let mut ends = topology.ends(h).map(|v| positions[v.index()]);
                ends.sort_by(|a, b| a.partial_cmp(b).unwrap_or(core::cmp::Ordering::Equal));
                if *first.get_or_insert(ends) != ends {
                    return broken(h.to_string(), "copies of a cut edge have the same ends");
                }
            }
        }
        Ok(())
    }
}

//! Crease and corner tags with their sharpness.

use std::collections::BTreeMap;

use super::{Junctions, MeshError, Topology};
use crate::index::VertexId;
use crate::ring::{INFINITELY_SHARP, decremented};

/// The tag of a sharp edge.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct CreaseTag {
    /// The ends of the edge, in any order.
    pub vertices: [u32; 2],
    /// 0 is smooth, [`INFINITELY_SHARP`] and above infinitely sharp; between them the tag is sharp
    /// for that many levels.
    pub sharpness: f64,
}

/// The tag of a vertex that keeps its position.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct CornerTag {
    /// The vertex.
    pub vertex: u32,
    /// Levels of refinement for which the tag holds; see [`CreaseTag::sharpness`].
    pub sharpness: f64,
}

/// The tags of a mesh: edges and vertices that stay sharp where the surface would be smooth.
///
/// The rules are OpenSubdiv's (see [`crate::ring::SharpRing`]). Refinement hands the tags on to the
/// parts of their edges and vertices, less sharp by one; several tags on one edge count as the
/// sharpest of them.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Tags {
    /// Sharp edges.
    pub creases: Vec<CreaseTag>,
    /// Sharp vertices, by ascending vertex.
    pub corners: Vec<CornerTag>,
}

impl Tags {
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.creases.is_empty() && self.corners.is_empty()
    }

    /// The tags after a step of refinement: less sharp by one, and on both halves of their edges. `middle` gives the new vertex between
    /// two; creases without one are left out.
    #[doc(hidden)]
    pub fn refined(&self, middle: impl Fn(VertexId, VertexId) -> Option<u32>) -> Self {
        let left = |sharpness: f64| Some(decremented(sharpness)).filter(|&left| left > 0.0);
        let halves = |tag: &CreaseTag| {
            let [a, b] = tag.vertices;
            let (sharpness, middle) = (left(tag.sharpness)?, middle(VertexId(a), VertexId(b))?);
            Some([[a, middle], [middle, b]].map(|vertices| CreaseTag {
                vertices,
                sharpness,
            }))
        };
        let corner = |tag: &CornerTag| {
            Some(CornerTag {
                sharpness: left(tag.sharpness)?,
                ..*tag
            })
        };
        Self {
            creases: self.creases.iter().filter_map(halves).flatten().collect(),
            corners: self.corners.iter().filter_map(corner).collect(),
        }
    }

    /// Whether `vertex` is an infinitely sharp corner.
    #[inline]
    pub fn is_corner(&self, vertex: VertexId) -> bool {
        if self.corners.is_empty() {
            return false;
        }
        self.corners
            .binary_search_by_key(&vertex.0, |tag| tag.vertex)
            .is_ok_and(|i| self.corners[i].sharpness >= INFINITELY_SHARP)
    }

    /// Adds corners; where a vertex has one already, the sharper counts.
    #[doc(hidden)]
    pub fn add_corners(&mut self, corners: impl IntoIterator<Item = CornerTag>) {
        self.corners.extend(corners);
        self.corners.sort_unstable_by(|a, b| {
            a.vertex
                .cmp(&b.vertex)
                .then(b.sharpness.total_cmp(&a.sharpness))
        });
        self.corners.dedup_by_key(|tag| tag.vertex);
    }

    /// The tags with the same outcome for all copies of a vertex that was cut: each is as sharp as
    /// the sharpest, and where an edge inside one of the sheets is sharp, which makes its copy a
    /// corner, all are corners for one level more than that edge is sharp.
    pub(crate) fn joined(mut self, topology: &Topology, junctions: &Junctions) -> Self {
        if self.is_empty() || junctions.vertices.is_empty() {
            return self;
        }
        let mut sharpest: BTreeMap<u32, f64> = BTreeMap::new();
        let mut sharpen = |vertex: u32, sharpness: f64| {
            let most = sharpest.entry(vertex).or_insert(0.0);
            *most = most.max(sharpness);
        };
        self.corners
            .iter()
            .for_each(|tag| sharpen(tag.vertex, tag.sharpness));
        for tag in self.creases.iter().filter(|tag| tag.sharpness > 0.0) {
            let [a, b] = tag.vertices.map(VertexId);
            let is_inside = topology
                .edge_between(a, b)
                .is_some_and(|h| topology.twin(h).is_some());
            if is_inside {
                // By then the last fraction of the edge has faded, whose share differs from sheet to sheet.
                tag.vertices
                    .iter()
                    .for_each(|&v| sharpen(v, tag.sharpness.ceil() + 1.0));
            }
        }
        let most = |group: &[u32]| {
            group
                .iter()
                .filter_map(|v| sharpest.get(v))
                .copied()
                .fold(0.0, f64::max)
        };
        let corners = junctions
            .vertices
            .iter()
            .map(|group| (group, most(group)))
            .filter(|&(_, s)| s > 0.0);
        let corners: Vec<CornerTag> = corners
            .flat_map(|(group, sharpness)| {
                group
                    .iter()
                    .map(move |&vertex| CornerTag { vertex, sharpness })
            })
            .collect();
        self.add_corners(corners);
        self
    }

    /// Checks that every tag names something that exists, with a sharpness that is a number ≥ 0.
    pub(crate) fn check(&self, topology: &Topology) -> Result<(), MeshError> {
        let broken = |place: String, what| Err(MeshError::Broken { place, what });
        for pair in self.corners.windows(2) {
            if pair[0].vertex >= pair[1].vertex {
                return broken(
                    format!("corner tag of vertex {}", pair[1].vertex),
                    "corner tags stand in ascending order of their vertices, one for each",
                );
            }
        }
        for tag in &self.corners {
            if tag.vertex as usize >= topology.vertex_count() {
                return broken(
                    format!("corner tag of vertex {}", tag.vertex),
                    "a corner tag names a vertex of the mesh",
                );
            }
            if tag.sharpness.is_nan() || tag.sharpness < 0.0 {
                return broken(
                    format!(
                        "corner tag of vertex {} with sharpness {}",
                        tag.vertex, tag.sharpness
                    ),
                    "a sharpness is a number of at least 0",
                );
            }
        }
        for tag in &self.creases {
            let [a, b] = tag.vertices;
            let exists = |v: u32| (v as usize) < topology.vertex_count();
            if !exists(a) || !exists(b) || topology.edge_between(VertexId(a), VertexId(b)).is_none()
            {
                return broken(
                    format!("crease tag from vertex {a} to vertex {b}"),
                    "a crease tag names an edge of the mesh",
                );
            }
            if tag.sharpness.is_nan() || tag.sharpness < 0.0 {
                return broken(
                    format!(
                        "crease tag from vertex {a} to vertex {b} with sharpness {}",
                        tag.sharpness
                    ),
                    "a sharpness is a number of at least 0",
                );
            }
        }
        Ok(())
    }
}

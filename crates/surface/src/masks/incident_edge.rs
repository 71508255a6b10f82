//! Steps around a vertex from any of its edges, either way: the neighbours of an edge are found
//! without going round a large ring.

use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::Topology;

/// An edge as seen from one of its ends, the vertex in the middle.
#[derive(Clone, Copy)]
pub(super) enum IncidentEdge {
    /// The half-edge that leaves the vertex.
    Leaving(HalfEdgeId),
    /// The last edge of an open ring: only its other half-edge exists, which arrives at the vertex.
    Arriving(HalfEdgeId),
}

impl IncidentEdge {
    /// The edge of `h` as its origin sees it.
    pub(super) fn from_origin(h: HalfEdgeId) -> Self {
        Self::Leaving(h)
    }

    /// The edge of `h` as its target sees it.
    pub(super) fn from_target(topology: &Topology, h: HalfEdgeId) -> Self {
        topology.twin(h).map_or(Self::Arriving(h), Self::Leaving)
    }

    /// The vertex at the other end.
    pub(super) fn neighbour(self, topology: &Topology) -> VertexId {
        match self {
            Self::Leaving(h) => topology.target(h),
            Self::Arriving(h) => topology.origin(h),
        }
    }

    /// The next edge counter-clockwise; none after the last of an open ring.
    pub(super) fn next(self, topology: &Topology) -> Option<Self> {
        match self {
            Self::Leaving(h) => Some(Self::from_target(topology, h.previous())),
            Self::Arriving(_) => None,
        }
    }

    /// The next edge clockwise; none before the first of an open ring.
    pub(super) fn previous(self, topology: &Topology) -> Option<Self> {
        match self {
            Self::Leaving(h) => topology.twin(h).map(|twin| Self::Leaving(twin.next())),
            Self::Arriving(h) => Some(Self::Leaving(h.next())),
        }
    }
}

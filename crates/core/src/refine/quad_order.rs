//! The order of the parts of quads after a step: the halves of a quad are split like any triangles, and their parts are halves of smaller
//! quads, which stand together again from there on.

use crate::index::HalfEdgeId;
use crate::mesh::Topology;
use crate::parallel;
use crate::progress::{Cancelled, Watch};

/// The parts of a quad's two halves, which come in fours, in the order of the quads that they are halves of, and the corner of each that
/// comes first: the one at the right angle. Quads stand in the order of the corners that they keep.
const ORDER: [(u32, u32); 8] = [
    (0, 0),
    (3, 1),
    (1, 2),
    (6, 1),
    (4, 0),
    (7, 1),
    (2, 1),
    (5, 2),
];

/// Where each of those parts comes to stand.
const PLACES: [(u32, u32); 8] = {
    let mut places = [(0, 0); 8];
    let mut place = 0;
    while place < 8 {
        let (part, turn) = ORDER[place];
        places[part as usize] = (place as u32, turn);
        place += 1;
    }
    places
};

/// Where a half-edge of parts in the order of their halves comes to stand.
pub(super) fn moved(h: u32) -> u32 {
    let (place, turn) = PLACES[(h / 3 % 8) as usize];
    24 * (h / 24) + 3 * place + (h % 3 + 3 - turn) % 3
}

/// The half-edge that comes to stand at a place.
fn before(h: u32) -> u32 {
    let (part, turn) = ORDER[(h / 3 % 8) as usize];
    24 * (h / 24) + 3 * part + (h % 3 + turn) % 3
}

/// The part that comes to stand at a place.
pub(super) fn part_before(face: usize) -> usize {
    8 * (face / 8) + ORDER[face % 8].0 as usize
}

/// Parts in the order of their quads.
pub(super) fn in_order(topology: Topology, watch: &mut Watch<'_>) -> Result<Topology, Cancelled> {
    let poll = &mut |_| watch.poll();
    let origin = |h: u32| topology.origin(HalfEdgeId(h)).0;
    let triangles = parallel::map_polled(topology.face_count(), poll, |face| {
        [0, 1, 2].map(|corner| origin(before(3 * face as u32 + corner)))
    })?;
    let twins = parallel::map_polled(topology.half_edge_count(), poll, |h| {
        let twin = topology.twin(HalfEdgeId(before(h as u32)));
        twin.map_or(crate::mesh::NONE, |twin| moved(twin.0))
    })?;
    let outgoing = parallel::map_polled(topology.vertex_count(), poll, |v| {
        let h = topology.outgoing(crate::index::VertexId(v as u32)).0;
        if h == crate::mesh::NONE { h } else { moved(h) }
    })?;
    Ok(Topology::from_parts(triangles, twins, outgoing))
}

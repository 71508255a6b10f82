//! Crease and corner tags through a step: each goes to the parts of its edge or vertex.

use super::split::{SplitEdges, SplitTopology};
use crate::index::VertexId;
use crate::mesh::{CornerTag, CreaseTag, Mesh, Tags};
use crate::ring::decremented;

/// The tags after a step: both halves of a split edge take over its crease, and the sharpness of
/// semi-sharp tags falls by one. `moves` marks the old vertices that take their new position; the
/// tags of others keep their sharpness. Old vertices keep their numbers.
pub(super) fn refined_tags(
    mesh: &Mesh,
    split: &SplitEdges,
    numbered: &SplitTopology,
    moves: Option<&[bool]>,
) -> Tags {
    let tags = mesh.tags();
    let corner = |tag: &CornerTag| match moves {
        Some(moves) if !moves[tag.vertex as usize] => Some(*tag),
        _ => Some(CornerTag {
            sharpness: less_sharp(tag.sharpness)?,
            ..*tag
        }),
    };
    let creases = tags.creases.iter().flat_map(|crease| {
        let [a, b] = crease.vertices;
        let middle = mesh
            .topology()
            .edge_between(VertexId(a), VertexId(b))
            .filter(|&h| split.contains(h))
            .map(|h| numbered.vertex_on(h));
        let halves = middle
            .zip(less_sharp(crease.sharpness))
            .map(|(middle, sharpness)| {
                [[a, middle], [middle, b]].map(|vertices| CreaseTag {
                    vertices,
                    sharpness,
                })
            });
        let whole = middle.is_none().then_some(*crease);
        halves.into_iter().flatten().chain(whole)
    });
    Tags {
        creases: creases.collect(),
        corners: tags.corners.iter().filter_map(corner).collect(),
    }
}

/// The sharpness one level on; `None` once the tag has faded.
pub(super) fn less_sharp(sharpness: f64) -> Option<f64> {
    Some(decremented(sharpness)).filter(|&left| left > 0.0)
}

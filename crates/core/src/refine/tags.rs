//! Crease and corner tags through a step: each goes to the pieces of what it names.

use super::split::{SplitEdges, SplitTopology};
use crate::index::VertexId;
use crate::mesh::{CornerTag, CreaseTag, INFINITELY_SHARP, Mesh, Tags};

/// The tags after a step: both halves of a split edge take over its crease, and sharpness falls by one where a tag
/// does not last for ever. Old vertices keep their numbers.
pub(super) fn refined_tags(mesh: &Mesh, split: &SplitEdges, numbered: &SplitTopology) -> Tags {
    let tags = mesh.tags();
    let corner = |tag: &CornerTag| Some(CornerTag { sharpness: less_sharp(tag.sharpness)?, ..*tag });
    let creases = tags.creases.iter().flat_map(|crease| {
        let [a, b] = crease.vertices;
        let middle = mesh
            .topology()
            .edge_between(VertexId(a), VertexId(b))
            .filter(|&h| split.contains(h))
            .map(|h| numbered.vertex_on(h));
        let halves = middle.zip(less_sharp(crease.sharpness)).map(|(middle, sharpness)| {
            [[a, middle], [middle, b]].map(|vertices| CreaseTag { vertices, sharpness })
        });
        let whole = middle.is_none().then_some(*crease);
        halves.into_iter().flatten().chain(whole)
    });
    Tags { creases: creases.collect(), corners: tags.corners.iter().filter_map(corner).collect() }
}

/// The sharpness one level on; `None` once the tag has faded.
fn less_sharp(sharpness: f64) -> Option<f64> {
    if sharpness >= INFINITELY_SHARP {
        return Some(sharpness);
    }
    Some(sharpness - 1.0).filter(|&left| left > 0.0)
}

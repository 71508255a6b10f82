//! The given mesh, its faces divided in four in their planes: the surface is unchanged, with more
//! points that can be moved.

use crate::index::{HalfEdgeId, VertexId};
use crate::mesh::{CornerTag, FaceParts, Mesh, Sharpness, VertexRule};
use crate::progress::Observer;
use crate::refine::input_distance::place;
use crate::refine::{Origin, RefineError, UniformOptions, uniform_observed};
use crate::ring::INFINITELY_SHARP;
use crate::scheme::Loop;

/// A mesh whose faces are parts of those of the mesh that was given.
pub(super) struct Finer {
    pub(super) mesh: Mesh,
    pub(super) parts: FaceParts,
}

impl Finer {
    /// The faces of a mesh, divided so often.
    pub(super) fn new(
        mesh: &Mesh,
        levels: usize,
        observer: &mut Observer<'_>,
    ) -> Result<Self, RefineError> {
        if levels == 0 {
            return Ok(Self {
                mesh: mesh.clone(),
                parts: FaceParts::default(),
            });
        }
        // The scheme gives only the connections of faces, and the tags.
        let options = UniformOptions::default().levels(levels).origins(true);
        let divided = uniform_observed(mesh, &Loop, &options, observer)?;
        let positions = divided
            .origins
            .iter()
            .map(|origin| place(mesh.as_triangles(), origin).to_array());
        let finer = divided.mesh.with_positions(positions.collect())?;
        let sharpness = Sharpness::of(mesh);
        let kept = (mesh.vertex_count()..finer.vertex_count())
            .filter(|&v| is_kept(mesh, &sharpness, &divided.origins[v]))
            .map(|v| CornerTag {
                vertex: v as u32,
                sharpness: f64::INFINITY,
            });
        let mut tags = finer.tags().clone();
        tags.corners.extend(kept);
        let finer = finer.with_tags(tags)?;
        let corners = |(face, &parent): (usize, &u32)| {
            let inside = |v: u32| {
                let origin = divided.origins[v as usize].in_face(mesh.triangles(), parent);
                origin.map_or([0.0; 3], |origin| origin.barycentric)
            };
            (parent, finer.triangles()[face].map(inside))
        };
        let parts = FaceParts::of_all(divided.parents.iter().enumerate().map(corners));
        Ok(Self { mesh: finer, parts })
    }
}

/// Whether a new vertex is on a sharp edge or a boundary between vertices that keep their place: the surface is straight there.
fn is_kept(mesh: &Mesh, sharpness: &Sharpness<'_>, origin: &Origin) -> bool {
    let Some(opposite) = origin.barycentric.iter().position(|&weight| weight == 0.0) else {
        return false;
    };
    let edge = HalfEdgeId(3 * origin.face + (opposite as u32 + 1) % 3);
    let is_corner = |v: VertexId| sharpness.rule(v) == VertexRule::Corner;
    sharpness.edge(edge) >= INFINITELY_SHARP
        && mesh.topology().ends(edge).into_iter().all(is_corner)
}

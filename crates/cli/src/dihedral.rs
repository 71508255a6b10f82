//! Angles between the faces at edges, and whether some edges stand out as sharp.

use limitmesh::part::Look;
use limitmesh::{FaceId, Mesh};
use serde::Serialize;

use crate::vector::{cross, dot, length};

/// Steps of the histogram, of ten degrees each.
const STEPS: usize = 18;

/// Edges between faces, by the angle between these faces' normals.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(crate) struct Dihedrals {
    /// Edges with an angle in [0°, 10°), [10°, 20°) … [170°, 180°].
    pub(crate) histogram: [usize; STEPS],
    /// The angle that parts sharp edges from smooth ones; null where none stand out.
    pub(crate) suggested_crease_angle_degrees: Option<f64>,
    /// Edges beyond that angle.
    pub(crate) sharp_edges: usize,
    /// `part`, `cage` (of polygons, or sharp everywhere), `stairs` (of voxels) or `smooth`.
    pub(crate) look: &'static str,
}

impl Dihedrals {
    /// Of a mesh, with the input's faces that its own are from; none where these are not known.
    pub(crate) fn of(mesh: &Mesh, faces: &[u32]) -> Self {
        let mut histogram = [0; STEPS];
        let topology = mesh.topology();
        for h in topology.half_edges() {
            let twin = topology.twin(h).filter(|twin| h.0 < twin.0);
            if let Some(degrees) = twin.and_then(|twin| angle(mesh, h.face(), twin.face())) {
                histogram[(degrees / 10.0) as usize] += 1;
            }
        }
        let part = |look: Look| {
            if let Look::Part(part) = look {
                Some(part)
            } else {
                None
            }
        };
        let suggested = part(Look::of(mesh, &[]));
        Self {
            histogram,
            suggested_crease_angle_degrees: suggested.as_ref().map(|part| part.degrees),
            sharp_edges: suggested.map_or(0, |part| part.creases.edges.len()),
            look: look_name(&Look::of(mesh, faces)),
        }
    }
}

/// The name of what a mesh looks like.
fn look_name(look: &Look) -> &'static str {
    match look {
        Look::Part(_) => "part",
        Look::Smooth => "smooth",
        Look::Cage => "cage",
        Look::Stairs => "stairs",
        _ => "other",
    }
}

/// The angle between the normals of two faces in degrees, below 180; `None` where one has none.
fn angle(mesh: &Mesh, a: FaceId, b: FaceId) -> Option<f64> {
    let [m, n] = [a, b].map(|face| mesh.face_normal(face));
    let degrees = length(cross(m, n)).atan2(dot(m, n)).to_degrees();
    (dot(m, m) > 0.0 && dot(n, n) > 0.0).then_some(degrees.min(180f64.next_down()))
}

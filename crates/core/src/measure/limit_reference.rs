//! The reference that the paper measures against: a control mesh refined uniformly, its vertices on the limit
//! surface.

use crate::mesh::Mesh;
use crate::refine::{RefineError, UniformOptions, uniform};
use crate::scheme::Scheme;

/// The limit surface of `control` under `scheme`, as triangles after `levels` uniform refinements with all vertices on
/// the surface: what the paper measures distances to (section 5).
///
/// Each level has four times the triangles of the one before; the chords still leave the surface by about a
/// quarter of what they did a level earlier, which bounds what a distance to this reference can tell.
///
/// # Errors
/// See [`RefineError`].
pub fn limit_reference(control: &Mesh, scheme: &dyn Scheme, levels: usize) -> Result<Mesh, RefineError> {
    Ok(uniform(control, scheme, &UniformOptions::default().levels(levels).limit(true))?.mesh)
}

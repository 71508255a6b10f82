//! Exact refinement: triangles within a tolerance of the true limit surface. What is asked is checked here, brought to a
//! middling size, and handed to the engine ([`super::adaptive`]) or to the collapse of a finer mesh
//! ([`super::simplified`]).

mod estimate;
mod scale;

pub use estimate::exact_estimate;

use super::RefineError;
use super::adaptive::adaptive;
use super::exact_options::ExactOptions;
use super::exact_result::Exact;
use super::simplified::simplified;
use crate::mesh::Mesh;
use crate::scheme::Scheme;

/// Refines `control` until the goals are met: each distance, angle or pixel goal everywhere, or as many triangles as
/// allowed, whichever comes first.
///
/// # Errors
/// A goal that is no positive number, a vertex without a limit,
/// more elements than can be numbered, or the observer's wish to stop.
pub fn exact(control: &Mesh, scheme: &dyn Scheme, options: &ExactOptions<'_>) -> Result<Exact, RefineError> {
    options.check()?;
    if let Some(factor) = scale::factor(control) {
        let scaled = exact(&scale::mesh(control, factor)?, scheme, &scale::options(options, factor))?;
        return scale::result(scaled, factor);
    }
    if options.optimize {
        return simplified(control, scheme, options);
    }
    adaptive(control, scheme, options)
}

/// Whether the distances that [`exact`] reports for a scheme are proven: those of the Loop family are
/// ([`Scheme::loop_family`]), others are estimated from samples.
pub fn is_certified(scheme: &dyn Scheme) -> bool {
    scheme.loop_family().is_some()
}

//! Exact refinement: triangles within a tolerance of the true limit surface. Options are checked
//! here, the mesh is scaled to a middling size, and both are handed to the engine
//! ([`super::adaptive`]) or to the collapse of a finer mesh ([`super::simplified`]).

mod estimate;
mod frames;
mod quads;
pub(super) mod scale;
mod tighter;

pub use estimate::{exact_estimate, exact_estimate_observed};
pub use frames::{Frames, exact_frames, exact_frames_observed};
pub use quads::{quads, quads_observed};

use super::RefineError;
use super::adaptive::adaptive;
use super::exact_options::ExactOptions;
use super::exact_result::{Exact, ExactStop, Statistics};
use super::simplified::simplified;
use crate::mesh::Mesh;
use crate::progress::{Observer, unobserved};
use crate::scheme::Scheme;

/// Refines `control` until the goals are met: each distance, angle or pixel goal everywhere, or the
/// number of triangles, whichever comes first.
///
/// # Errors
/// A goal that is no positive number, a vertex without a limit, or more elements than can be numbered.
pub fn exact(
    control: &Mesh,
    scheme: &dyn Scheme,
    options: &ExactOptions,
) -> Result<Exact, RefineError> {
    exact_observed(control, scheme, options, &mut unobserved)
}

/// [`exact`], with an observer.
///
/// # Errors
/// Those of [`exact`], or the observer asked to stop. The latter comes without a mesh: to close and measure
/// an unfinished one would take as long as the rest.
pub fn exact_observed(
    control: &Mesh,
    scheme: &dyn Scheme,
    options: &ExactOptions,
    observer: &mut Observer<'_>,
) -> Result<Exact, RefineError> {
    options.check(control)?;
    if let Some((scaled, options, factor)) = scale::scaled(control, options)? {
        return scale::result(exact_observed(&scaled, scheme, &options, observer)?, factor);
    }
    let mut found = match options.is_collapsed() {
        true => simplified(control, scheme, options, observer)?,
        false => adaptive(control, scheme, options, observer)?,
    };
    if options.tightens {
        let surface = (found.mesh.as_triangles(), &found.within_rims[..]);
        found.error = tighter::tighter(found.error, surface, (control, scheme), options, observer)?;
    }
    let upper = found.error.upper;
    Ok(met(found, upper, options))
}

/// The result, marked as met where a tolerance is the only goal and `upper` shows that it is met:
/// the sum of the bounds of single triangles can be greater.
fn met(found: Exact, upper: f64, options: &ExactOptions) -> Exact {
    match options.goals.tolerance {
        Some(tolerance) if upper <= tolerance && options.goals.are_distances() => Exact {
            stop: ExactStop::Met,
            statistics: Statistics {
                worst: found.statistics.worst.min(upper / tolerance),
                ..found.statistics
            },
            ..found
        },
        _ => found,
    }
}

/// Whether the distances that [`exact`] reports for a scheme are proven: those of known schemes are ([`Scheme::family`]), for others
/// they are estimated from samples.
pub fn is_certified(scheme: &dyn Scheme) -> bool {
    scheme.family().is_some()
}

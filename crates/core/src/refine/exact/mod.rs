//! Exact refinement: triangles within a tolerance of the true limit surface, with all vertices on it.
//!
//! Takes a control mesh, a scheme and goals; gives a conforming mesh, limit normals, where each vertex and triangle
//! came from, and a certified interval for the distance between the mesh and the limit surface.
//!
//! The sequence of refined meshes of the *original* control mesh is never altered: a forest of quadtrees over its
//! faces says how far each part of it is looked at, the limit surface over a node follows
//! from its patch, and the paper's closure (Figure 5) happens when triangles are emitted and is never refined.
//! Rounds of "evaluate what changed, split what fails, worst first" go on until the goals are met.

mod balance;
mod blocks;
mod emit;
mod estimate;
mod evaluate;
mod forest;
mod grow;
pub(super) mod leaf;
mod options;
mod probe;
mod scale;
mod settle;
mod sides;

pub use estimate::exact_estimate;
pub(in crate::refine) use options::MOST_LEVELS;
pub use options::{
    ErrorBounds, Estimate, Exact, ExactObserver, ExactOptions, ExactProgress, ExactStop, Origin,
};

use super::RefineError;
use crate::mesh::Mesh;
use crate::patch::Rules;
use crate::scheme::Scheme;
use grow::Growth;

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
        return super::simplified::simplified(control, scheme, options);
    }
    if options.is_of_distance() {
        return super::adaptive::adaptive(control, scheme, options);
    }
    let rules = Rules::of(scheme);
    let grown = |levels: usize| {
        let mut growth = Growth::new(control, &rules, options)?;
        growth.split_all(levels)?;
        let (stop, emission) = growth.run()?;
        growth.finish(stop, emission)
    };
    let worst_first = grown(0)?;
    // Evenly curved models are best divided evenly: then all that is left of the budget brings nothing.
    match options.uniform_levels(control.face_count()) {
        0 => Ok(worst_first),
        levels => {
            let evenly = grown(levels)?;
            // Lower bounds are found distances, within some per cent of the truth.
            let is_better = evenly.error.lower < worst_first.error.lower;
            Ok(if is_better { evenly } else { worst_first })
        }
    }
}

/// Whether the distances that [`exact`] reports for a scheme are proven: those of the Loop family are
/// ([`Scheme::loop_family`]), others are estimated from samples.
pub fn is_certified(scheme: &dyn Scheme) -> bool {
    scheme.loop_family().is_some()
}

//! Exact refinement followed by edge collapse: the fewest triangles for a tolerance.
//!
//! A mesh finer than asked for, certified against the limit surface, is collapsed with proof of how far the result is from
//! it; both distances add up.

use super::{ErrorBounds, Exact, ExactOptions, ExactStop, RefineError, exact};
use crate::measure::distances_to;
use crate::mesh::{Mesh, MeshError};
use crate::scheme::Scheme;
use crate::simplify::{Features, SimplifyOptions, simplify};

/// The part of the tolerance that the fine mesh takes: less leaves more to the collapse and costs more triangles to
/// collapse.
const FINE_SHARE: f64 = 0.2;

/// Triangles of the fine mesh for each triangle asked for: with half as many its own error is felt.
const FINE_TIMES: usize = 16;

/// Collapse that leaves more than this part of the fine triangles (one in so many) was not worth it.
const FEW: usize = 6;

/// Refines and collapses.
pub(super) fn simplified(
    control: &Mesh,
    scheme: &dyn Scheme,
    options: &ExactOptions<'_>,
) -> Result<Exact, RefineError> {
    let mut fine_options = ExactOptions { optimize: false, triangles: None, ..options.clone() };
    match options.tolerance {
        Some(tolerance) => fine_options.tolerance = Some(FINE_SHARE * tolerance),
        None => {
            fine_options.triangles = options.triangles.map(|count| count.saturating_mul(FINE_TIMES));
        }
    }
    let fine = exact(control, scheme, &fine_options)?;
    let allowance = options.tolerance.map(|tolerance| tolerance - fine.error.upper);
    if allowance.is_some_and(|left| left <= 0.0) {
        // A cap ended the refinement before there was anything to collapse.
        return Ok(fine);
    }
    let goals = SimplifyOptions::default().tolerance(allowance).triangles(options.triangles);
    let collapsed = simplify(&fine.mesh, &Features::default(), &goals)?;
    // Where the proof failed again and again little is collapsed; then refinement alone needs fewer triangles.
    if options.tolerance.is_some() && collapsed.mesh.face_count() > fine.mesh.face_count() / FEW {
        let plain = exact(control, scheme, &ExactOptions { optimize: false, ..options.clone() })?;
        if plain.stop == ExactStop::Met && plain.mesh.face_count() <= collapsed.mesh.face_count() {
            return Ok(plain);
        }
    }
    let (lower, at) = farthest(&fine.mesh, &collapsed.mesh)?;
    let upper = collapsed.bound.unwrap_or(f64::INFINITY) + fine.error.upper;
    let count = collapsed.mesh.face_count();
    let stop = match (options.tolerance, options.triangles) {
        (Some(tolerance), _) if upper <= tolerance && fine.stop == ExactStop::Met => ExactStop::Met,
        (_, Some(goal)) if count <= goal => ExactStop::Triangles,
        _ => fine.stop,
    };
    Ok(Exact {
        normals: collapsed.vertices.iter().map(|&v| fine.normals[v as usize]).collect(),
        origins: collapsed.vertices.iter().map(|&v| fine.origins[v as usize]).collect(),
        sides: Vec::new(),
        parents: Vec::new(),
        error: ErrorBounds { lower, upper, at, certified: fine.error.certified },
        pixels: None,
        open_cones: 0,
        worst: options.tolerance.map_or(0.0, |tolerance| upper / tolerance),
        stop,
        levels: fine.levels,
        mesh: collapsed.mesh,
    })
}

/// The greatest distance of a fine mesh's vertices, which are points of the surface, to another mesh, and where.
fn farthest(fine: &Mesh, coarse: &Mesh) -> Result<(f64, [f64; 3]), RefineError> {
    let broken = |why: crate::measure::MeasureError| MeshError::Broken {
        place: why.to_string(),
        what: "an optimised mesh can be measured",
    };
    let distances = distances_to(fine.positions(), coarse.as_triangles()).map_err(broken)?;
    let farthest = distances.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
    Ok(farthest.map_or((0.0, [0.0; 3]), |(v, &distance)| (distance, fine.positions()[v])))
}

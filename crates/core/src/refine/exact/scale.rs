//! Very large and very small models, brought to a middling size by a power of two, which changes no digit.
//!
//! Distances are found by squares and products of squares; beyond coordinates of 1e±40 or so these overflow or vanish.

use crate::criterion::{Camera, View, Viewpoint};
use crate::math;
use crate::mesh::Mesh;
use crate::refine::RefineError;
use crate::refine::exact_options::{AngleGoal, ExactOptions, Goals, PixelGoal};
use crate::refine::exact_result::{ErrorBounds, Exact, Statistics};

/// Sizes with binary exponents up to this are unchanged: their eighth powers are finite.
const MIDDLING: i32 = 100;

/// A mesh and goals of a middling size and the factor that brings them there; `None` where they are middling already.
pub(super) fn scaled(
    control: &Mesh,
    goals: &ExactOptions,
) -> Result<Option<(Mesh, ExactOptions, f64)>, RefineError> {
    let Some(factor) = factor(control) else {
        return Ok(None);
    };
    Ok(Some((
        mesh(control, factor)?,
        options(goals, factor),
        factor,
    )))
}

/// Positions with their coordinates multiplied.
pub(super) fn positions(positions: &[[f64; 3]], factor: f64) -> Vec<[f64; 3]> {
    positions.iter().map(|p| p.map(|x| x * factor)).collect()
}

/// The power of two that brings a mesh's coordinates near 1; `None` where they are middling already.
pub(in crate::refine) fn factor(mesh: &Mesh) -> Option<f64> {
    let greatest = mesh
        .positions()
        .iter()
        .flatten()
        .fold(0.0f64, |greatest, x| greatest.max(x.abs()));
    if greatest == 0.0 || !greatest.is_finite() {
        return None;
    }
    let exponent = math::log2(greatest).floor() as i32;
    // One step short of the ends of the range, where the factor itself would not be a number.
    (exponent.abs() > MIDDLING).then(|| math::powi(2.0, (-exponent).clamp(-1020, 1020)))
}

/// A mesh with its coordinates multiplied.
pub(in crate::refine) fn mesh(mesh: &Mesh, factor: f64) -> Result<Mesh, RefineError> {
    Ok(mesh
        .clone()
        .with_positions(positions(mesh.positions(), factor))?)
}

/// A tolerance for the multiplied mesh: one that vanishes or overflows still is one.
pub(in crate::refine) fn length(length: f64, factor: f64) -> f64 {
    (length * factor).clamp(f64::MIN_POSITIVE, f64::MAX)
}

/// Goals for the multiplied mesh.
fn options(options: &ExactOptions, factor: f64) -> ExactOptions {
    let point = |p: [f64; 3]| p.map(|x| x * factor);
    let camera = |camera: &Camera| Camera {
        eye: point(camera.eye),
        target: point(camera.target),
        ..*camera
    };
    let view = |view: View| match view.viewpoint {
        Viewpoint::Eye(eye) => View {
            viewpoint: Viewpoint::Eye(point(eye)),
            ..view
        },
        Viewpoint::Direction(_) => view,
    };
    let goals = &options.goals;
    ExactOptions {
        goals: Goals {
            tolerance: goals.tolerance.map(|tolerance| length(tolerance, factor)),
            angle: goals.angle.map(|goal| AngleGoal {
                view: goal.view.map(view),
                ..goal
            }),
            pixels: goals.pixels.as_ref().map(|goal| PixelGoal {
                pixels: goal.pixels,
                cameras: goal.cameras.iter().map(camera).collect(),
            }),
            ..goals.clone()
        },
        ..options.clone()
    }
}

/// The result at the original size.
pub(in crate::refine) fn result(result: Exact, factor: f64) -> Result<Exact, RefineError> {
    let error = bounds(result.error, factor);
    let statistics = Statistics {
        off_planes: result.statistics.off_planes / factor,
        ..result.statistics
    };
    Ok(Exact {
        mesh: mesh(&result.mesh, 1.0 / factor)?,
        error,
        statistics,
        ..result
    })
}

/// A distance at the original size.
pub(super) fn bounds(error: ErrorBounds, factor: f64) -> ErrorBounds {
    let ErrorBounds {
        lower,
        upper,
        at,
        certified,
    } = error;
    ErrorBounds {
        lower: lower / factor,
        upper: upper / factor,
        at: at.map(|x| x / factor),
        certified,
    }
}

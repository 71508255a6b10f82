//! Exact refinement of an animation: one set of triangles for all frames, each frame within the
//! goals.

use super::{met, scale, tighter};
use crate::mesh::{Mesh, MeshError, Triangles};
use crate::progress::{Observer, unobserved};
use crate::refine::RefineError;
use crate::refine::adaptive::frames;
use crate::refine::exact_options::ExactOptions;
use crate::refine::exact_result::{ErrorBounds, Exact};
use crate::refine::replay::{Frame, Replay};
use crate::scheme::Scheme;

/// A refinement for several frames.
#[derive(Debug)]
#[non_exhaustive]
pub struct Frames {
    /// The refined mesh, with the vertices of the first frame by [`Self::replay`].
    /// [`Statistics::worst`](super::Statistics::worst), [`Exact::pixels`] and
    /// [`Statistics::open_cones`](super::Statistics::open_cones) are the greatest of any frame,
    /// and [`Exact::stop`] holds for all of them.
    pub refined: Exact,
    /// Computes the vertices of all frames.
    pub replay: Replay,
    /// By frame, bounds of the distance between the triangles, with the vertices of the replay, and
    /// the frame's limit surface.
    pub errors: Vec<ErrorBounds>,
}

/// Refines `control` so that the goals are met for all frames, with one set of triangles: a part is
/// divided if it has to be in any frame. A frame is the positions of the control vertices; those of
/// `control` itself are ignored, its tags hold for all. Channels do not change with frames, nor do
/// the origins of vertices: channels are carried once, from the control mesh to
/// [`Frames::refined`].
///
/// Supported goals are a tolerance, an angle and pixels. Flat regions are divided like others.
///
/// ```
/// use limitmesh::refine::{ExactOptions, Frame, exact_frames};
/// use limitmesh::{Mesh, scheme::Loop};
///
/// let mesh = Mesh::from_triangles(
///     vec![[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]],
///     vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
/// )?;
/// let stretched: Vec<[f64; 3]> = mesh.positions().iter().map(|&[x, y, z]| [x, y, 2.0 * z]).collect();
/// let frames = [mesh.positions().to_vec(), stretched];
/// let found = exact_frames(&mesh, &Loop, &frames, &ExactOptions::default().tolerance(0.01))?;
/// assert!(found.errors.iter().all(|error| error.certified && error.upper <= 0.01));
///
/// // A third frame, of which nothing was proven.
/// let mut frame = Frame::default();
/// let bent: Vec<[f64; 3]> = frames[1].iter().map(|&[x, y, z]| [x + 0.1 * z * z, y, z]).collect();
/// found.replay.frame(&bent, &mut frame)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Goals out of range, goals and options that frames do not support, a frame that is none of the
/// mesh's, a scheme whose surfaces are not made of polynomials, a cap that any frame exceeds, or an error of
/// [`exact`](super::exact).
pub fn exact_frames(
    control: &Mesh,
    scheme: &dyn Scheme,
    frames: &[Vec<[f64; 3]>],
    options: &ExactOptions,
) -> Result<Frames, RefineError> {
    exact_frames_observed(control, scheme, frames, options, &mut unobserved)
}

/// [`exact_frames`], with an observer.
///
/// # Errors
/// Those of [`exact_frames`], or the observer asked to stop.
pub fn exact_frames_observed(
    control: &Mesh,
    scheme: &dyn Scheme,
    all: &[Vec<[f64; 3]>],
    options: &ExactOptions,
    observer: &mut Observer<'_>,
) -> Result<Frames, RefineError> {
    options.check(control)?;
    check(all, options)?;
    let options = ExactOptions {
        flat_regions: false,
        origins: true,
        ..options.clone()
    };
    let control = match all[0].len() == control.vertex_count() {
        true => control.clone().with_positions(all[0].clone())?,
        false => control.clone(),
    };
    let Some((scaled, options, factor)) = scale::scaled(&control, &options)? else {
        return middling((&control, scheme), all, &options, observer);
    };
    let all: Vec<_> = all
        .iter()
        .map(|frame| scale::positions(frame, factor))
        .collect();
    let Frames {
        refined,
        replay,
        errors,
    } = middling((&scaled, scheme), &all, &options, observer)?;
    let errors = errors
        .into_iter()
        .map(|error| scale::bounds(error, factor))
        .collect();
    Ok(Frames {
        refined: scale::result(refined, factor)?,
        replay,
        errors,
    })
}

/// Exact refinement of frames scaled to a middling size.
fn middling(
    (control, scheme): (&Mesh, &dyn Scheme),
    all: &[Vec<[f64; 3]>],
    options: &ExactOptions,
    observer: &mut Observer<'_>,
) -> Result<Frames, RefineError> {
    let mut found = frames(control, scheme, all, options, observer)?;
    let mut frame = Frame::default();
    for (positions, error) in all.iter().zip(&mut found.errors) {
        let control = control.clone().with_positions(positions.clone())?;
        if !tighter::is_loose(error, &control) {
            continue;
        }
        found.replay.frame(positions, &mut frame)?;
        let triangles = found.refined.mesh.triangles();
        let surface = (
            Triangles {
                positions: &frame.positions,
                triangles,
            },
            &[][..],
        );
        *error = tighter::tighter(*error, surface, (&control, scheme), options, observer)?;
    }
    let upper = found
        .errors
        .iter()
        .map(|error| error.upper)
        .fold(0.0, f64::max);
    let refined = met(
        Exact {
            error: found.errors[0],
            ..found.refined
        },
        upper,
        options,
    );
    Ok(Frames {
        refined,
        replay: found.replay,
        errors: found.errors,
    })
}

/// Refuses options that have no meaning for frames.
fn check(frames: &[Vec<[f64; 3]>], options: &ExactOptions) -> Result<(), RefineError> {
    let refused = [
        (
            "number of frames",
            frames.len(),
            frames.is_empty(),
            "at least one",
        ),
        (
            "number of triangles",
            options.goals.triangles.unwrap_or(0),
            options.goals.triangles.is_some(),
            "none, for frames",
        ),
        ("balance", 1, options.is_balanced(), "none, for frames"),
        (
            "optimisation",
            1,
            options.is_collapsed(),
            "none, for frames",
        ),
        (
            "number of goals for attributes",
            options.goals.attributes.len(),
            !options.goals.attributes.is_empty(),
            "none, for frames",
        ),
    ];
    for (name, value, is_refused, expected) in refused {
        if is_refused {
            return Err(MeshError::BadOption {
                name,
                value: value as f64,
                expected,
            }
            .into());
        }
    }
    Ok(())
}

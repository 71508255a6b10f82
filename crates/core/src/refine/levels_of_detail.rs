//! Levels of detail: meshes of one limit surface, each nested in the next, and the geomorphs between them.
//!
//! Takes a control mesh, a scheme and tolerances from coarse to fine; gives a [`Level`] for each.
//! Everything is exact refinement, so each level has the certified distance that a refinement to
//! its tolerance has; nodes that the coarser level divides are divided here as well, so that its
//! triangles are unions of the finer ones but for those that close gaps.
//!
//! **Geomorphs** (Hoppe, "Progressive Meshes", 1996; "View-Dependent Refinement of Progressive Meshes", 1997). Each vertex of a level
//! M knows its place u on the control mesh, so also its point c on the coarser mesh C: on C's triangle that holds u, by u's barycentric
//! coordinates there. At the moment t it is at (1 − t) c + t S(u), with S(u) its own position, on the limit surface S. At t = 1 that is
//! M. At t = 0 all vertices are on C, and the surface is C itself, but where triangles of M lie across the edges of C's closing triangles: C is
//! folded there by no more than the height of a split edge's middle over the straight edge, and M cuts across.
//!
//! **Certified at every moment.** On a triangle T of M, of which u runs over the places, let `M₀` be linear with the values c at T's
//! corners and `M₁` with the values S. The mesh at t is `M_t(u) = (1 − t) M₀(u) + t M₁(u)`, for it is linear on T and agrees at the corners. So
//!
//! ```text
//! |M_t(u) − S(u)| = |(1 − t) (M₀(u) − S(u)) + t (M₁(u) − S(u))| ≤ (1 − t) P₀ + t P₁,    Pᵢ = max |Mᵢ(u) − S(u)|,
//! ```
//!
//! over all u of all triangles. As u runs over the whole control mesh, M_t over the whole mesh and
//! S over the whole limit surface, that is a bound for both directed distances. Distances from set
//! to set are no such thing: they are not convex in t. Both P₀ and P₁ are bounded over the pieces
//! of S (`certificate/interpolation.rs`), on the triangles of M: nothing is lost to closing
//! triangles except where one ends at an irregular vertex, where the bound of the leaf and the
//! height of its split edges add up.
//!
//! With geomorphs tolerances are for P: a level's P₁ is within its own tolerance and its P₀ within the coarser's, so that the mesh
//! is within the coarser level's tolerance at every moment.

use super::RefineError;
use super::adaptive::nested;
use super::exact::scale;
use super::exact_options::{Caps, ExactOptions};
use super::level::{Geomorph, Level};
use crate::limit_surface::LimitSurface;
use crate::mesh::{Mesh, MeshError};
use crate::progress::{Observer, unobserved};
use crate::scheme::Scheme;

/// The goals of levels of detail, and their caps.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LodOptions {
    /// By level, from the coarsest to the finest, the greatest distance between mesh and limit surface, either way, as a length; each below the one
    /// before. With [`Self::geomorphs`] it holds place by place ([`Level::parametric`]).
    pub tolerances: Vec<f64>,
    /// Whether to compute how each level grows out of the coarser one ([`Level::geomorph`]), within
    /// the coarser one's tolerance at every moment. Default: yes.
    pub geomorphs: bool,
    /// Where a level ends though its tolerance is not met.
    pub caps: Caps,
}

impl LodOptions {
    /// Levels within these distances, coarse to fine.
    pub fn new(tolerances: Vec<f64>) -> Self {
        Self {
            tolerances,
            geomorphs: true,
            caps: Caps::default(),
        }
    }

    /// Sets [`Self::geomorphs`].
    pub fn geomorphs(mut self, geomorphs: bool) -> Self {
        self.geomorphs = geomorphs;
        self
    }

    /// Sets [`Self::caps`].
    pub fn caps(mut self, caps: Caps) -> Self {
        self.caps = caps;
        self
    }

    fn check(&self) -> Result<(), RefineError> {
        let bad = |name, value, expected| {
            Err(MeshError::BadOption {
                name,
                value,
                expected,
            }
            .into())
        };
        if self.tolerances.is_empty() {
            return bad("number of levels", 0.0, "at least one");
        }
        if let Some(pair) = self.tolerances.windows(2).find(|pair| pair[1] >= pair[0]) {
            return bad("tolerance", pair[1], "one below that of the coarser level");
        }
        Ok(())
    }

    /// The options of the engine.
    fn exact(&self, tolerance: f64) -> ExactOptions {
        ExactOptions {
            caps: self.caps,
            ..ExactOptions::default()
                .tolerance(tolerance)
                .flat_regions(false)
        }
    }
}

/// Levels of detail, from the coarsest to the finest, each nested in the next: a level for each
/// tolerance, or up to the first that could not be reached, by the last one's
/// [`stop`](super::Exact::stop). None has fewer triangles than the control mesh.
///
/// ```
/// use limitmesh::refine::{LodOptions, levels_of_detail};
/// use limitmesh::{Mesh, scheme::Loop};
///
/// let mesh = Mesh::from_triangles(
///     vec![[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]],
///     vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
/// )?;
/// let levels = levels_of_detail(&mesh, &Loop, &LodOptions::new(vec![0.1, 0.01]))?;
/// let [coarse, fine] = &levels[..] else { panic!("two levels") };
/// assert!(fine.exact.mesh.face_count() > coarse.exact.mesh.face_count());
/// // Halfway between them:
/// let (positions, bound) = (fine.positions_at(0.5), fine.deviation_at(0.5));
/// assert!(positions.len() == fine.exact.mesh.vertex_count() && bound < 0.1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Tolerances that are no positive numbers or do not fall, a vertex without a limit, or more elements than can be numbered.
pub fn levels_of_detail(
    control: &Mesh,
    scheme: &dyn Scheme,
    options: &LodOptions,
) -> Result<Vec<Level>, RefineError> {
    levels_of_detail_observed(control, scheme, options, &mut unobserved)
}

/// [`levels_of_detail`], with an observer, called level by level.
///
/// # Errors
/// Those of [`levels_of_detail`], or the observer asked to stop; nothing comes with that.
pub fn levels_of_detail_observed(
    control: &Mesh,
    scheme: &dyn Scheme,
    options: &LodOptions,
    observer: &mut Observer<'_>,
) -> Result<Vec<Level>, RefineError> {
    options.check()?;
    for &tolerance in &options.tolerances {
        options.exact(tolerance).check(control)?;
    }
    let Some(factor) = scale::factor(control) else {
        return all(control, scheme, options, observer);
    };
    let tolerances = options
        .tolerances
        .iter()
        .map(|&length| scale::length(length, factor))
        .collect();
    let scaled = LodOptions {
        tolerances,
        ..options.clone()
    };
    let levels = all(&scale::mesh(control, factor)?, scheme, &scaled, observer)?;
    levels
        .into_iter()
        .map(|level| rescaled(level, factor))
        .collect()
}

fn all(
    control: &Mesh,
    scheme: &dyn Scheme,
    options: &LodOptions,
    observer: &mut Observer<'_>,
) -> Result<Vec<Level>, RefineError> {
    let surface = LimitSurface::without_normals(control, scheme)?;
    let mut levels: Vec<Level> = Vec::with_capacity(options.tolerances.len());
    for &tolerance in &options.tolerances {
        let level = nested(
            &surface,
            scheme,
            &options.exact(tolerance),
            tolerance,
            levels.last(),
            options.geomorphs,
            observer,
        )?;
        let is_met = level.exact.stop == super::ExactStop::Met;
        levels.push(level);
        if !is_met {
            break;
        }
    }
    Ok(levels)
}

/// A level at the original size.
fn rescaled(level: Level, factor: f64) -> Result<Level, RefineError> {
    let Level {
        exact,
        tolerance,
        parametric,
        geomorph,
    } = level;
    let geomorph = geomorph.map(|morph| Geomorph {
        positions: morph
            .positions
            .iter()
            .map(|p| p.map(|x| x / factor))
            .collect(),
        start: morph.start / factor,
        ..morph
    });
    let exact = scale::result(exact, factor)?;
    Ok(Level {
        exact,
        tolerance: tolerance / factor,
        parametric: parametric / factor,
        geomorph,
    })
}

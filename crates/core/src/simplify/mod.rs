//! Fewer triangles at the same distance: edge collapses of a fine mesh whose vertices lie on the surface.
//!
//! Takes a fine mesh, features to keep and a goal; gives a mesh whose vertices are some of the fine mesh's, exactly where
//! they were. Closed meshes stay closed, manifolds stay manifolds of the same genus, boundaries and creases stay along
//! their lines, and no triangle folds over.
//!
//! Each collapse is judged by the distance that it would leave between the coarse mesh and the surface, in both
//! directions and locally: the vertices that are gone are samples of the surface, each cared for by the face nearest to
//! it (`fine_samples.rs`); points of the new faces are measured from the tangent planes of the samples around (`backward_error.rs`); and
//! where samples are few, the normals at the ends of an edge tell how far the surface bulges over it (`reference.rs`). Where
//! the surface is curved more in one direction than in the other, long triangles come out of this by themselves.
//!
//! How good the result can be is known: a smooth surface with Gaussian curvature K needs about
//! 0.19245·∫√|K| dA / ε vertices for inscribed triangles within a distance ε where K > 0 (and fewer where K < 0).

mod backward_error;
mod compaction;
mod edge_collapse;
mod edge_flip;
mod editable_mesh;
mod fine_samples;
mod kept_features;
mod proof;
mod reference;
mod star_region;
#[cfg(test)]
mod tests;
mod triangle_plane;
mod vertex_star;

pub use kept_features::Features;

use crate::index::VertexId;
use crate::measure::{Bvh, MeasureError};
use crate::mesh::{Mesh, MeshError};
use crate::parallel;
use crate::vector::{DVec3, unit_or_zero, vector};
use edge_collapse::Collapser;
use editable_mesh::EditableMesh;
use fine_samples::FineSamples;
use proof::Certifier;
use reference::{LEAST_AGREEMENT, Reference};

/// Why a mesh could not be simplified.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimplifyError {
    /// An option is out of range, or a feature is none of the mesh's.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A distance could not be measured.
    #[error(transparent)]
    Measure(#[from] MeasureError),
}

/// When to stop: at whichever goal is reached first.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SimplifyOptions {
    /// The greatest distance between the result and the fine mesh, in the mesh's units, in either direction. Without this
    /// and without [`Self::triangles`] it is [`Self::DEFAULT_SHARE`] of the bounding box's diagonal.
    pub tolerance: Option<f64>,
    /// Stop once there are no more triangles than this.
    pub triangles: Option<usize>,
    /// Prove the distance, and keep the tolerance where the samples' estimate proves too low; `true` by default. Without
    /// it the result is faster, and a few per cent over the tolerance in places.
    pub certify: bool,
}

impl Default for SimplifyOptions {
    fn default() -> Self {
        Self { tolerance: None, triangles: None, certify: true }
    }
}

impl SimplifyOptions {
    /// The tolerance where none is given, as a share of the bounding box's diagonal: hardly to be seen on a model that
    /// fills the screen.
    pub const DEFAULT_SHARE: f64 = 0.001;

    /// Sets [`Self::tolerance`].
    pub fn tolerance(mut self, tolerance: Option<f64>) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// Sets [`Self::triangles`].
    pub fn triangles(mut self, triangles: Option<usize>) -> Self {
        self.triangles = triangles;
        self
    }

    /// Sets [`Self::certify`].
    pub fn certify(mut self, certify: bool) -> Self {
        self.certify = certify;
        self
    }

    fn goals(&self, fine: &Mesh) -> Result<Goals, MeshError> {
        if let Some(value) = self.tolerance.filter(|t| !t.is_finite() || *t < 0.0) {
            let expected = "a finite number of at least 0";
            return Err(MeshError::BadOption { name: "tolerance", value, expected });
        }
        if self.triangles == Some(0) {
            return Err(MeshError::BadOption { name: "triangles", value: 0.0, expected: "at least 1" });
        }
        Ok(match (self.tolerance, self.triangles) {
            (None, None) => Goals { tolerance: Self::DEFAULT_SHARE * fine.diagonal(), triangles: 0 },
            (tolerance, triangles) => {
                Goals { tolerance: tolerance.unwrap_or(f64::MAX), triangles: triangles.unwrap_or(0) }
            }
        })
    }
}

/// The tolerance, [`f64::MAX`] for none, and the number of triangles to stop at, 0 for none.
#[derive(Clone, Copy)]
struct Goals {
    tolerance: f64,
    triangles: usize,
}

/// What is left of the tolerance for the width of the certified interval and for what falls between the samples: more costs
/// triangles everywhere, less costs attempts.
const HEADROOM: f64 = 0.02;

/// Up to this share of the tolerance collapses are taken for granted at first, and not undone where the tolerance is not kept.
const SURE: f64 = 0.3;

/// With so many times as many triangles as asked for they are likewise.
const EARLY: usize = 3;

/// The certified distance over the estimate at which the errors of a mesh with a given number of triangles are held to be
/// even: no place is much worse than the collapses were meant to leave behind.
const EVEN: f64 = 1.05;

/// How often at most a mesh with a given number of triangles is made, to see whether its errors get more even.
const MOST_EVENING_ATTEMPTS: u32 = 3;

/// What is left of the tolerance from attempt to attempt once the places found at fault were not all: a mesh made anew has
/// new ones, where the fine mesh is so coarse that estimates are wrong all over.
const LESS: f64 = 0.93;

/// How often collapses are done again with less of the tolerance where it was not kept. Each attempt leaves fewer such
/// places; what is left after these is a mesh that is rough wherever one looks.
const MOST_ATTEMPTS: u32 = 14;

/// From this attempt on nothing is taken for granted.
const FROM_THE_START: u32 = 8;

/// Errors up to this share of the diagonal are taken for rounding: some ten thousand units in the last place.
const ROUNDING: f64 = 1e-12;

/// A mesh with fewer triangles.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Simplified {
    /// The mesh, with the tags and junctions of the fine one.
    pub mesh: Mesh,
    /// For each of its vertices the fine mesh's vertex that it is.
    pub vertices: Vec<u32>,
    /// The greatest distance between the mesh and the surface that was found while collapsing: an estimate, since only
    /// samples were measured.
    pub estimate: f64,
    /// The greatest distance between the mesh and the fine one, in both directions, is certainly no more than this;
    /// `None` if no proof was asked for.
    pub bound: Option<f64>,
}

/// Collapses edges of `fine` until a goal is reached.
///
/// Where no more edges can go, the result has more triangles than asked for.
///
/// ```
/// use limitmesh::measure::limit_reference;
/// use limitmesh::simplify::{Features, SimplifyOptions, simplify};
/// use limitmesh::scheme::Loop;
/// use limitmesh::Mesh;
///
/// let soup = limitmesh_models::find("torus").expect("a built-in model").soup();
/// let (control, _) = Mesh::from_soup(&soup, &Default::default())?;
/// let fine = limit_reference(&control, &Loop, 3)?;
/// let options = SimplifyOptions::default().triangles(Some(2000));
/// let coarse = simplify(&fine, &Features::default(), &options)?;
/// assert!(coarse.mesh.face_count() <= 2000);
/// assert_eq!(coarse.mesh.positions()[7], fine.positions()[coarse.vertices[7] as usize]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Options out of range, features that the mesh does not have.
pub fn simplify(
    fine: &Mesh,
    features: &Features,
    options: &SimplifyOptions,
) -> Result<Simplified, SimplifyError> {
    let goals = options.goals(fine)?;
    let mut surface = EditableMesh::new(fine.topology());
    let kinds = kept_features::kinds(fine, features, &mut surface)?;
    let (normals, agreed): (Vec<DVec3>, Vec<bool>) = normals(fine).into_iter().unzip();
    let ground = Reference { kinds: &kinds, normals: &normals, agreed: &agreed, fine };
    let samples = FineSamples::new(fine.positions().iter().copied().map(vector).collect(), fine.face_count());
    let flat = ROUNDING * fine.diagonal();
    let mut collapser = Collapser::new(surface, samples, ground, flat);
    if options.certify {
        return certified(&mut collapser, &Certifier::new(fine, flat)?, goals);
    }
    collapser.run(goals);
    result(&collapser)
}

/// Collapses edges until a goal is reached, with proof. Where estimates prove wrong, it tries again with that in reserve:
/// until the tolerance is kept; and where the number of triangles stops it, until the errors are even.
fn certified(
    collapser: &mut Collapser<'_>,
    certifier: &Certifier<'_>,
    goals: Goals,
) -> Result<Simplified, SimplifyError> {
    let tolerance = goals.tolerance;
    let mut target = Goals { tolerance: tolerance * (1.0 - HEADROOM), ..goals };
    let early =
        Goals { tolerance: target.tolerance * SURE, triangles: target.triangles.saturating_mul(EARLY) };
    let mut reserves = vec![0.0; collapser.ground.fine.vertex_count()];
    let fresh = collapser.snapshot();
    let mut sure = None;
    let mut best: Option<Simplified> = None;
    for attempt in 0..MOST_ATTEMPTS {
        if attempt == 0 || attempt >= FROM_THE_START {
            collapser.collapse_up_to(early, target);
            sure.get_or_insert_with(|| collapser.snapshot());
        }
        collapser.run(target);
        let counted = collapser.surface.faces_left() <= goals.triangles;
        let coarse = result(collapser)?;
        let hierarchy = Bvh::new(coarse.mesh.as_triangles())?;
        let proof = certifier.certify(&hierarchy)?;
        let (upper, estimate) = (proof.upper(), coarse.estimate);
        let kept = upper <= tolerance;
        let last = !counted || upper <= EVEN * estimate || attempt + 1 >= MOST_EVENING_ATTEMPTS;
        if !(kept && last) {
            let level = if counted { estimate.min(tolerance) } else { tolerance };
            certifier.raise_reserves(&hierarchy, &proof, (attempt, level), collapser, &mut reserves);
        }
        let earlier_bound = best.as_ref().and_then(|best| best.bound);
        if kept && earlier_bound.is_none_or(|bound| counted && upper < bound) {
            best = Some(Simplified { bound: Some(upper), ..coarse });
        }
        if (kept && last) || earlier_bound.is_some_and(|_| !kept) {
            break;
        }
        if attempt >= FROM_THE_START && !kept {
            target.tolerance *= LESS;
        }
        let earlier = sure.as_ref().filter(|_| attempt + 1 < FROM_THE_START).unwrap_or(&fresh);
        collapser.restore(earlier, &reserves);
    }
    if let Some(best) = best {
        return Ok(best);
    }
    // The fine mesh itself is at no distance.
    collapser.restore(&fresh, &reserves);
    Ok(Simplified { bound: Some(0.0), ..result(collapser)? })
}

/// Normals of the vertices, as the areas of the faces around weigh them (those of a fine mesh on a smooth surface are off
/// by the square of its edge length at most), and whether all the faces around agree with them.
fn normals(fine: &Mesh) -> Vec<(DVec3, bool)> {
    parallel::map(fine.vertex_count(), |v| {
        let around = || fine.topology().outgoing_ring(VertexId(v as u32)).map(|h| h.face().index());
        let normal = unit_or_zero(around().map(|face| fine.face_normal_vector(face)).sum());
        let agrees = |face: usize| fine.unit_face_normal(face).dot(normal) >= LEAST_AGREEMENT;
        (normal, around().all(agrees))
    })
}

fn result(collapser: &Collapser<'_>) -> Result<Simplified, SimplifyError> {
    let Collapser { surface, samples, ground, .. } = collapser;
    let (mesh, vertices) = compaction::mesh(ground.fine, surface, ground.kinds)?;
    let errors = surface.faces().map(|face| samples.error(face));
    Ok(Simplified { mesh, vertices, estimate: errors.fold(collapser.reached, f64::max), bound: None })
}

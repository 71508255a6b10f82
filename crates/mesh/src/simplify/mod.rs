//! Fewer triangles at the same distance: edge collapses of a fine mesh whose vertices lie on the surface.
//!
//! Takes a fine mesh, features to keep and a goal; gives a mesh whose vertices are some of the fine
//! mesh's, at their exact positions. Closed meshes stay closed, manifolds stay manifolds of the
//! same genus, boundaries and creases stay along their lines, and no triangle folds over.
//!
//! The cost of a collapse is estimated from samples, locally and in both directions: the vertices
//! that are gone are points of the surface, each assigned to the face nearest to it
//! (`fine_samples.rs`); points of the new faces are measured from the tangent planes of the samples
//! around (`backward_error.rs`); and where samples are few, the normals at the ends of an edge give
//! the height of the surface over it (`reference.rs`). Where the surface is curved more in one
//! direction than in the other, this gives long triangles.
//!
//! A collapse is proven before it happens, for the faces that it touches (`proof.rs`,
//! `fine_face.rs`). Where there is no proof the edge stays.
//!
//! The best possible result is known: a smooth surface with Gaussian curvature K needs about
//! 0.19245·∫√|K| dA / ε vertices for inscribed triangles within a distance ε where K > 0 (and fewer
//! where K < 0).

mod backward_error;
mod compaction;
mod edge_collapse;
mod edge_flip;
mod editable_mesh;
mod fine_face;
mod fine_samples;
mod history;
mod kept_features;
mod proof;
mod reference;
mod star_region;
#[cfg(test)]
mod tests;
mod triangle_plane;
mod vertex_star;

pub use kept_features::Features;

use crate::error_messages;
use crate::index::VertexId;
use crate::measure::{Bvh, MeasureError, Target};
use crate::mesh::{Mesh, MeshError};
use crate::parallel;
use crate::progress::{Observer, Stage, Watch, unobserved};
use crate::vector::{DVec3, unit_or_zero, vector};
use edge_collapse::Collapser;
use editable_mesh::EditableMesh;
use fine_samples::FineSamples;
use proof::Prover;
use reference::{LEAST_AGREEMENT, Reference};

/// An error of simplification.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum SimplifyError {
    /// An option is out of range, or a feature does not fit the mesh.
    Mesh(MeshError),
    /// A distance could not be measured.
    Measure(MeasureError),
    /// The observer asked to stop. This is the mesh by then: as valid as any result, with more
    /// triangles.
    Cancelled(Box<Simplified>),
}

error_messages! {
    SimplifyError {
        Self::Cancelled(_) => ("cancelled by the observer"),
    }
    from { Mesh(MeshError), Measure(MeasureError) }
}

/// The goals of simplification, which ends at the first one reached.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SimplifyOptions {
    /// The greatest distance between the result and the fine mesh, in the mesh's units, in either direction. Without this
    /// and without [`Self::triangles`] it is [`Self::DEFAULT_SHARE`] of the bounding box's diagonal.
    pub tolerance: Option<f64>,
    /// The number of triangles at which to stop.
    pub triangles: Option<usize>,
    /// Whether to prove the distance, and keep the tolerance where the samples' estimate proves too
    /// low; `true` by default. Without it the result is faster, and a few per cent over the
    /// tolerance in places.
    pub certify: bool,
}

impl Default for SimplifyOptions {
    fn default() -> Self {
        Self {
            tolerance: None,
            triangles: None,
            certify: true,
        }
    }
}

impl SimplifyOptions {
    /// The default tolerance, as a share of the bounding box's diagonal: hardly visible on a model
    /// that fills the screen.
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
            return Err(MeshError::BadOption {
                name: "tolerance",
                value,
                expected,
            });
        }
        if self.triangles == Some(0) {
            return Err(MeshError::BadOption {
                name: "triangles",
                value: 0.0,
                expected: "at least 1",
            });
        }
        Ok(match (self.tolerance, self.triangles) {
            (None, None) => Goals {
                tolerance: Self::DEFAULT_SHARE * fine.diagonal(),
                triangles: 0,
            },
            (tolerance, triangles) => Goals {
                tolerance: tolerance.unwrap_or(f64::MAX),
                triangles: triangles.unwrap_or(0),
            },
        })
    }
}

/// The tolerance, [`f64::MAX`] for none, and the number of triangles to stop at, 0 for none.
#[derive(Clone, Copy)]
struct Goals {
    tolerance: f64,
    triangles: usize,
}

/// Collapses whose estimate is up to this share of the tolerance are proven in the end only: most
/// of them are changed again before, and estimates are rarely wrong by this factor. Where they are,
/// changes are taken back.
const SURE: f64 = 0.35;

/// Errors up to this share of the diagonal are taken for rounding: some ten thousand units in the last place.
const ROUNDING: f64 = 1e-12;

/// A mesh with fewer triangles.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Simplified {
    /// The mesh, with the tags and junctions of the fine one.
    pub mesh: Mesh,
    /// For each of its vertices the vertex of the fine mesh.
    pub vertices: Vec<u32>,
    /// The greatest distance between the mesh and the surface that was found while collapsing: an estimate, since only
    /// samples were measured.
    pub estimate: f64,
    /// The greatest distance between the mesh and the fine one, in both directions, is certainly no
    /// more than this; `None` if no proof was requested, or if the observer stopped before there
    /// was one.
    pub bound: Option<f64>,
    /// The number of vertices that stayed only because their collapse was not proven to keep the
    /// goal, although the samples allowed it; mostly it would have exceeded the goal a little.
    pub refused: usize,
}

/// Collapses edges of `fine` until a goal is reached.
///
/// Where no more edges can be collapsed, the result has more triangles than requested.
///
/// ```
/// use limitmesh::refine::limit_reference;
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
    simplify_observed(fine, features, options, &mut unobserved)
}

/// [`simplify`] with an observer.
///
/// # Errors
/// Those of [`simplify`], or the observer asked to stop; what there was by then comes with the error.
pub fn simplify_observed(
    fine: &Mesh,
    features: &Features,
    options: &SimplifyOptions,
    observer: &mut Observer<'_>,
) -> Result<Simplified, SimplifyError> {
    let goals = options.goals(fine)?;
    let mut surface = EditableMesh::new(fine.topology());
    let kinds = kept_features::kinds(fine, features, &mut surface)?;
    let (normals, agreed): (Vec<DVec3>, Vec<bool>) = normals(fine).into_iter().unzip();
    let reference = Reference {
        kinds: &kinds,
        normals: &normals,
        agreed: &agreed,
        fine,
    };
    let hierarchy = options
        .certify
        .then(|| Bvh::new_observed(fine.as_triangles(), observer))
        .transpose();
    let hierarchy = match hierarchy {
        Err(MeasureError::Cancelled(_)) => {
            return Err(SimplifyError::Cancelled(Box::new(untouched(fine))));
        }
        hierarchy => hierarchy?,
    };
    let target = hierarchy
        .as_ref()
        .map(|bvh| Target::of_mesh(bvh, fine.topology()))
        .transpose()?;
    let mut watch = Watch::new(observer, Stage::Simplifying);
    // If the number alone stops the collapses, it is unknown which vertices are far from the limit.
    let sure = if goals.tolerance < f64::MAX {
        SURE * goals.tolerance
    } else {
        0.0
    };
    for sure in [sure, 0.0] {
        let positions = fine.positions().iter().copied().map(vector).collect();
        let samples = FineSamples::new(positions, fine.face_count());
        let prover = target.as_ref().map(|target| Prover::new(fine, target));
        let flat = ROUNDING * fine.diagonal();
        let mut collapser = Collapser::new(surface.clone(), samples, reference, flat, prover, sure);
        let outcome = collapser.run(goals, &mut watch);
        let outcome = outcome.and_then(|()| collapser.finish(goals, &mut watch));
        let simplified = result(&collapser)?;
        if outcome.is_err() {
            return Err(SimplifyError::Cancelled(Box::new(simplified)));
        }
        // Where the fine mesh is so rough that estimates are wrong far from the limit, no proof is
        // put off.
        if simplified.bound.is_some() || !options.certify || sure == 0.0 {
            return Ok(simplified);
        }
    }
    Err(MeshError::Broken {
        place: "the simplified mesh".to_owned(),
        what: "what was proven has a bound",
    }
    .into())
}

/// Normals of the vertices, as the areas of the faces around weigh them (those of a fine mesh on a smooth surface are off
/// by the square of its edge length at most), and whether all the faces around agree with them.
fn normals(fine: &Mesh) -> Vec<(DVec3, bool)> {
    parallel::map(fine.vertex_count(), |v| {
        let around = || {
            fine.topology()
                .outgoing_ring(VertexId(v as u32))
                .map(|h| h.face().index())
        };
        let normal = unit_or_zero(around().map(|face| fine.face_normal_vector(face)).sum());
        let agrees = |face: usize| fine.unit_face_normal(face).dot(normal) >= LEAST_AGREEMENT;
        (normal, around().all(agrees))
    })
}

/// The fine mesh as its own result.
fn untouched(fine: &Mesh) -> Simplified {
    let vertices = (0..fine.vertex_count() as u32).collect();
    Simplified {
        mesh: fine.clone(),
        vertices,
        estimate: 0.0,
        bound: Some(0.0),
        refused: 0,
    }
}

fn result(collapser: &Collapser<'_, '_, '_>) -> Result<Simplified, SimplifyError> {
    let Collapser {
        surface,
        samples,
        reference,
        ..
    } = collapser;
    let (mesh, vertices) = compaction::mesh(reference.fine, surface, reference.kinds)?;
    let errors = surface.faces().map(|face| samples.error(face));
    let estimate = errors.fold(collapser.reached, f64::max);
    Ok(Simplified {
        mesh,
        vertices,
        estimate,
        bound: collapser.bound(),
        refused: collapser.refused(),
    })
}

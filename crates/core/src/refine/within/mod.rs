//! Meshes that are proven to be within a distance of the given mesh, and as smooth as that allows.
//!
//! Vertices are taken for measured points within this distance of the truth, as those of scans and
//! of voxels are. The surface is the fairest whose limits stay within a reach of the vertices
//! ([`mod@crate::interpolate`]), shifted along its normals so that closed parts keep their volume
//! (`volume.rs`). The surface between the vertices is found by refinement: where a triangle is
//! farther from its partner on the given mesh ([`InputDistance`]) than it may be, or turned over,
//! the reach of the vertices around is made smaller, and all is solved again from there. So the
//! bound costs smoothness only where it must.
//!
//! A surface through all vertices leaves large faces by some part of their size. Where that is too
//! much, faces are divided in four in their planes (`finer.rs`), which halves it. Where that would
//! be needed too often, or does not help, edges become sharp (`sharper.rs`), and at worst faces
//! stay flat triangles: the mesh itself is within any distance. So a box of twelve triangles gets
//! round edges within a tenth of its size, and stays a box within a hundredth.
//!
//! **Coarse first.** A part that is far too far off shows on a coarse result as well. Results get
//! finer as long as no part is too far off, so that a tiny distance does not take millions of
//! triangles before it is given up.
//!
//! **Near and fair.** A plate's energy alone is least where a surface is least curved: it would use
//! the whole reach, close thin tubes and swell thick ones. So the distance of limits from their
//! vertices counts, too, as ε|y|² in addition to |Bx|² on edges of the length h. Waves of the
//! length ℓ are bent by (πh/ℓ)², so that with ε = (πh/ℓ)⁴ those of less than ℓ are smoothed and
//! longer ones kept. ℓ is 20 times the distance, as far as steps of its height reach on slopes that
//! are hardly inclined, and at least 18 edges. On a ball of voxels of the radius 10, within 0.87,
//! the radius has a standard deviation of 0.05; with ε near 0 it has 0.055, and within 3 it has
//! 0.15, where the bound does not hold the surface any more.
//!
//! ```
//! use limitmesh::refine::{WithinOptions, within};
//! use limitmesh::{Mesh, scheme::Loop};
//!
//! let (mesh, _) = Mesh::from_soup(&limitmesh_models::find("torus").ok_or("no such model")?.soup(), &Default::default())?;
//! let length = 0.01 * mesh.diagonal();
//! let smooth = within(&mesh, &Loop, &WithinOptions::default().within(length))?;
//! assert!(smooth.is_kept() && smooth.distance.upper <= length);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod finer;
mod sharper;
mod turned;
mod volume;

pub use turned::turned_over_triangles;

use super::input_distance::{InputDistance, place};
use super::{Exact, ExactOptions, RefineError, exact_observed, is_certified};
use crate::geometry::closest_to_origin;
use crate::interpolate::NearVertices;
use crate::math;
use crate::mesh::{FaceParts, Mesh, MeshError};
use crate::options;
use crate::parallel::{self, Poll};
use crate::progress::{Cancelled, Observer, Stage, Watch, unobserved};
use crate::scheme::Scheme;
use crate::vector::{DVec3, vector};
use core::f64::consts::PI;
use finer::Finer;
use sharper::Sharper;
use turned::turned_over;
use volume::Shift;

/// The part of the distance that refining may take, and the part of the mesh's diagonal: facets are hardly seen then.
const OF_DISTANCE: f64 = 0.1;
const OF_DIAGONAL: f64 = 1e-3;

/// Waves that are longer than this many times the distance, and than this many edges, are kept.
const DISTANCES: f64 = 20.0;
const EDGES: f64 = 18.0;

/// The least that being near counts, so that there is one answer.
const LEAST_NEARNESS: f64 = 1e-6;

/// How many times the surface is solved for at most.
const MOST_ROUNDS: usize = 12;

/// The factor by which the limits around a triangle are brought nearer than its excess requires: a
/// rest would take further rounds.
const NEARER: f64 = 1.5;

/// How far limits are left where they turn triangles over, from one time to the next, and the part of the room below which they are left at
/// their vertices.
const UNFOLDED: f64 = 0.5;
const LEAST_REACH: f64 = 0.05;

/// How often faces are divided at most, and how many there are then; more where they are divided once.
const MOST_LEVELS: usize = 5;
const MOST_FACES: usize = 1 << 16;
const MOST_ONCE: usize = 1 << 18;

/// How much finer results get, from one to the next.
const FINER: f64 = 8.0;

/// How often faces are divided at most where triangles are turned over though all is near.
const MOST_UNFOLDING: usize = 2;

options! {
    /// The options of a mesh near another.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct WithinOptions {
        /// The greatest distance between the result and the given mesh, either way, as a length
        /// above 0. Default: 0, which is refused.
        pub within: f64 = 0.0,
        /// The part of it for refinement: the greatest distance of the result from its own limit
        /// surface, as a length. Default: [`Self::usual_tolerance`].
        pub tolerance: Option<f64> = None,
        /// The most triangles, as a cap. Default: 50 million.
        pub max_triangles: Option<usize> = Some(50_000_000),
    }
}

impl WithinOptions {
    /// The default distance of a result from its own limit surface, for a distance and a mesh with
    /// this diagonal: a tenth of the distance, and at most a thousandth of the diagonal.
    pub fn usual_tolerance(within: f64, diagonal: f64) -> f64 {
        (OF_DISTANCE * within).min(OF_DIAGONAL * diagonal)
    }
}

/// A smooth mesh near the given one.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Within {
    /// The control mesh. Another refinement of it to [`WithinOptions::tolerance`] is about as near.
    pub control: Mesh,
    /// Its faces as parts of the given mesh's; empty where they are those.
    pub parts: FaceParts,
    /// The result: the control mesh refined.
    pub refined: Exact,
    /// The distance of the result from the given mesh.
    pub distance: InputDistance,
    /// The requested distance.
    pub within: f64,
    /// Triangles of the result that are turned over ([`turned_over_triangles`]).
    pub inverted: usize,
    /// Edges of the given mesh that became sharp, because no smooth surface stays near there.
    pub sharpened: usize,
}

impl Within {
    /// Whether the result is proven to be within the requested distance: unless triangles are
    /// capped, or rounding is more than the distance.
    pub fn is_kept(&self) -> bool {
        self.distance.upper <= self.within
    }
}

/// The smoothest mesh that is proven to be within a distance of `mesh`, in both directions; closed
/// parts keep their volume as far as the distance allows.
///
/// # Errors
/// A distance that is not above 0, an interpolating scheme, or an error of refinement.
pub fn within(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    options: &WithinOptions,
) -> Result<Within, RefineError> {
    within_observed(mesh, scheme, options, &mut unobserved)
}

/// [`within`], with an observer.
///
/// # Errors
/// Those of [`within`], or the observer asked to stop.
pub fn within_observed(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    options: &WithinOptions,
    observer: &mut Observer<'_>,
) -> Result<Within, RefineError> {
    let bound = Bound::new(mesh, scheme, options)?;
    let mut sharper = Sharper::new(mesh);
    let mut levels = 0;
    let (
        Smoothed {
            control, refined, ..
        },
        parts,
        distance,
    ) = loop {
        let Finer { mesh: finer, parts } = Finer::new(&sharper.mesh, levels, observer)?;
        let smoothed = smoothed(&finer, scheme, &bound, observer)?;
        let known = match smoothed.is_wrong(&bound) {
            true => None,
            false => Some(smoothed.input_distance(mesh, &finer, &bound, observer)?),
        };
        if let Some(distance) = known.filter(|distance| distance.upper <= bound.within) {
            break (smoothed, parts, distance);
        }
        let more = smoothed.missing_levels(&bound, levels);
        let is_far = smoothed.farthest(|fault| fault.distance) > bound.within;
        if more > 0 && is_affordable(mesh, levels + more) {
            levels += more;
        } else if sharper.sharpen(&smoothed.faulty(&bound, &parts, mesh.face_count()), is_far)? {
            levels = if is_far { 0 } else { levels };
        } else {
            let distance = match known {
                Some(distance) => distance,
                None => smoothed.input_distance(mesh, &finer, &bound, observer)?,
            };
            break (smoothed, parts, distance);
        }
    };
    let inverted = turned_over_triangles(mesh.as_triangles(), &refined, &parts);
    let sharpened = sharper.edges;
    Ok(Within {
        control,
        parts,
        refined,
        distance,
        within: bound.within,
        inverted,
        sharpened,
    })
}

/// Whether the faces of a mesh may be divided so often.
fn is_affordable(mesh: &Mesh, levels: usize) -> bool {
    let most = if levels == 1 { MOST_ONCE } else { MOST_FACES };
    levels <= MOST_LEVELS && mesh.face_count() <= most >> (2 * levels)
}

/// How near the result has to be.
struct Bound {
    within: f64,
    /// The part of it that refining may take.
    tolerance: f64,
    max_triangles: Option<usize>,
}

impl Bound {
    fn new(mesh: &Mesh, scheme: &dyn Scheme, options: &WithinOptions) -> Result<Self, RefineError> {
        let &WithinOptions {
            within,
            tolerance,
            max_triangles,
        } = options;
        if !(within > 0.0 && within.is_finite()) {
            let (name, expected) = ("the distance from the mesh", "a length above 0");
            return Err(MeshError::BadOption {
                name,
                value: within,
                expected,
            }
            .into());
        }
        let tolerance =
            tolerance.unwrap_or(WithinOptions::usual_tolerance(within, mesh.diagonal()));
        if !(tolerance > 0.0 && tolerance < within) {
            let (name, expected) = (
                "the tolerance",
                "a length above 0, below the distance from the mesh",
            );
            return Err(MeshError::BadOption {
                name,
                value: tolerance,
                expected,
            }
            .into());
        }
        if !is_certified(scheme) {
            return Err(RefineError::NotSmoothing {
                scheme: scheme.name().to_owned(),
            });
        }
        Ok(Self {
            within,
            tolerance,
            max_triangles,
        })
    }

    /// The greatest distance of limits from vertices: the rest is left to refinement.
    fn room(&self) -> f64 {
        self.within - self.tolerance
    }
}

/// The smoothest control mesh with given faces.
struct Smoothed {
    control: Mesh,
    refined: Exact,
    /// By face.
    faults: Vec<Fault>,
}

impl Smoothed {
    fn farthest(&self, distance: impl Fn(&Fault) -> f64) -> f64 {
        self.faults.iter().map(distance).fold(0.0, f64::max)
    }

    /// Whether a triangle is turned over, or farther from its face than allowed: not only from its
    /// partner.
    fn is_wrong(&self, bound: &Bound) -> bool {
        self.farthest(|fault| fault.off) > bound.within
            || self.faults.iter().any(|fault| fault.is_inverted)
    }

    /// How much more often than `levels` times faces have to be divided, as it looks: not at all where that does not help.
    fn missing_levels(&self, bound: &Bound, levels: usize) -> usize {
        let off = self.farthest(|fault| fault.off);
        let farthest = if off > bound.within {
            off
        } else {
            self.farthest(|fault| fault.distance)
        };
        match farthest > bound.within {
            true => math::log2(farthest / bound.room()).ceil() as usize,
            false => usize::from(levels < MOST_UNFOLDING),
        }
    }

    /// Over which of the faces of the mesh that was given something is wrong.
    fn faulty(&self, bound: &Bound, parts: &FaceParts, faces: usize) -> Vec<bool> {
        let mut is_faulty = vec![false; faces];
        let is_wrong = self.is_wrong(bound);
        for (face, fault) in (0..).zip(&self.faults) {
            let distance = if is_wrong { fault.off } else { fault.distance };
            is_faulty[parts.whole(face) as usize] |= distance > bound.within || fault.is_inverted;
        }
        is_faulty
    }

    /// How far the result is from the mesh that was given.
    fn input_distance(
        &self,
        mesh: &Mesh,
        finer: &Mesh,
        bound: &Bound,
        observer: &mut Observer<'_>,
    ) -> Result<InputDistance, RefineError> {
        let meshes = [mesh.as_triangles(), self.refined.mesh.as_triangles()];
        Ok(
            match InputDistance::new(
                finer.as_triangles(),
                &self.refined,
                &self.refined.origins,
                0.0,
            )? {
                Some(distance) => distance.decided(meshes, bound.within, observer)?,
                None => InputDistance {
                    lower: 0.0,
                    upper: f64::INFINITY,
                },
            },
        )
    }
}

fn smoothed(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    bound: &Bound,
    observer: &mut Observer<'_>,
) -> Result<Smoothed, RefineError> {
    let exact = ExactOptions::default()
        .flat_regions(false)
        .max_triangles(bound.max_triangles);
    let mut watch = Watch::new(observer, Stage::Interpolating);
    watch.triangles(mesh.face_count());
    let mut near = NearVertices::new(mesh, scheme, &mut watch)?;
    let mut shift = Shift::new(mesh, &mut |_| watch.poll())?;
    let nearness = nearness(mesh, bound.within);
    let mut reach = vec![bound.room(); mesh.vertex_count()];
    let mut away = vec![DVec3::ZERO; mesh.vertex_count()];
    let mut tolerance = bound.tolerance.max(OF_DIAGONAL * mesh.diagonal());
    let mut is_solved = false;
    let mut rounds = 0;
    loop {
        if !is_solved {
            away = near.fairest(&reach, nearness, &away, &mut watch)?;
        }
        rounds += 1;
        let shifted = shift.applied(mesh, &away, &reach, |v| near.is_free(v));
        let control = near.control(&shifted, &mut watch)?;
        let refined = exact_observed(
            &control,
            scheme,
            &exact.clone().tolerance(tolerance),
            &mut watch.observer(),
        )?;
        let poll: &mut Poll<'_> = &mut |_| watch.poll();
        let faults = faults(mesh, &refined, poll)?;
        is_solved = !reduced(mesh, &mut reach, &shifted, &faults, bound);
        let is_shifted = shift.corrected(&refined, 2.0 * bound.room(), poll)?;
        let found = Smoothed {
            control,
            refined,
            faults,
        };
        let is_wrong = found.is_wrong(bound);
        if (is_solved && (!is_shifted || is_wrong)) || rounds == MOST_ROUNDS {
            if tolerance == bound.tolerance || is_wrong {
                return Ok(found);
            }
            tolerance = bound.tolerance.max(tolerance / FINER);
            rounds = rounds.min(MOST_ROUNDS - 1);
        }
    }
}

/// The weight of nearness relative to fairness.
fn nearness(mesh: &Mesh, within: f64) -> f64 {
    let sum: f64 = (0..mesh.face_count())
        .map(|face| perimeter(mesh, face))
        .sum();
    let edge = sum / (3.0 * mesh.face_count() as f64);
    let longest = (DISTANCES * within).max(EDGES * edge);
    math::powi(PI * edge / longest, 4).max(LEAST_NEARNESS)
}

fn perimeter(mesh: &Mesh, face: usize) -> f64 {
    let [a, b, c] = mesh.as_triangles().corners(face).map(vector);
    a.distance(b) + b.distance(c) + c.distance(a)
}

/// The fault of the triangles over a face.
#[derive(Clone, Copy, Default)]
struct Fault {
    /// How far they are from their partners, and from the face itself.
    distance: f64,
    off: f64,
    is_inverted: bool,
}

/// By face, the faults of the refined mesh.
fn faults(mesh: &Mesh, refined: &Exact, poll: &mut Poll<'_>) -> Result<Vec<Fault>, Cancelled> {
    let (input, positions) = (mesh.as_triangles(), refined.mesh.positions());
    let partners =
        parallel::map_polled(positions.len(), poll, |v| place(input, &refined.origins[v]))?;
    let mut faults = vec![Fault::default(); mesh.face_count()];
    for (triangle, &parent) in refined.mesh.triangles().iter().zip(&refined.parents) {
        let fault = &mut faults[parent as usize];
        for v in triangle.map(|v| v as usize) {
            let at = vector(positions[v]);
            let distance = at.distance(partners[v]);
            if distance > fault.distance.min(fault.off) {
                fault.distance = fault.distance.max(distance);
                let [a, b, c] = input
                    .corners(parent as usize)
                    .map(|corner| vector(corner) - at);
                fault.off = fault.off.max(closest_to_origin(a, b, c).squared.sqrt());
            }
        }
    }
    for face in turned_over(mesh.as_triangles(), refined, &FaceParts::default()) {
        faults[refined.parents[face as usize] as usize].is_inverted = true;
    }
    Ok(faults)
}

/// Reduces the reach of vertices of faces with faults, from where their limits are; says whether any could be reduced.
fn reduced(
    mesh: &Mesh,
    reach: &mut [f64],
    away: &[DVec3],
    faults: &[Fault],
    bound: &Bound,
) -> bool {
    // Half of the refinement's tolerance is for the difference to another refinement of the
    // surface.
    let most = bound.room() + 0.5 * bound.tolerance;
    let mut is_reduced = false;
    for (triangle, fault) in mesh.triangles().iter().zip(faults) {
        let is_far = fault.distance > most;
        for v in triangle
            .iter()
            .map(|&v| v as usize)
            .filter(|_| is_far || fault.is_inverted)
        {
            let now = away[v].length();
            let near = if is_far {
                now - NEARER * (fault.distance - bound.room())
            } else {
                now
            };
            let kept = if fault.is_inverted {
                near.min(UNFOLDED * now)
            } else {
                near
            };
            let kept = if kept < LEAST_REACH * bound.room() {
                0.0
            } else {
                kept
            };
            if kept < reach[v] {
                reach[v] = kept;
                is_reduced = true;
            }
        }
    }
    is_reduced
}

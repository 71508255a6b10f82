//! Control meshes whose limit surface passes through the vertices of a mesh.
//!
//! A limit surface lies inside its control mesh: it shrinks, a scan by some thousandths of its
//! size, a coarse cylinder by hundredths. Here the vertices of a mesh are taken for points of the
//! surface, and control points are found whose limits they are: a function from mesh to mesh, with
//! the same faces and tags, which is then used as any control mesh (Halstead, Kass and DeRose,
//! *Efficient, Fair Interpolation using Catmull–Clark Surfaces*, 1993; here for any scheme whose
//! limit positions are known).
//!
//! # The system
//! The limit position of a vertex is a weighted sum of control points, row by row a sparse matrix A
//! with A·x = v. Points that depend on each other in a circle are found together, the others in the
//! order in which they depend on one another (`blocks.rs`): corners keep their positions, each line
//! of a crease or a boundary is a system of its own, and then each region between them, with the
//! lines fixed.
//!
//! At a smooth vertex with k edges Loop's limit weights are 1 for the neighbours and a =
//! 3/(8β(k)) for the vertex, divided by a + k (Loop 1987). So diag(a + k)·A = diag(a) +
//! (adjacency) is symmetric, and it is positive definite at all valences: the sum over the
//! triangles of (x_p + x_q + x_r)² is Σ k x² + 2·xᵀ(adjacency)x and not negative, whence the
//! adjacency is at least −k/2; and a > k/2, as k·β(k) is below 3/4 for Loop's weights and
//! Warren's (0.61 at most, at valence 2). So there is a solution for every mesh, and with the
//! diagonal as preconditioner the condition number is at most that of (1 + k/a)/(1 − k/2a): 4
//! for six edges, 10 for three, 14 for two. That takes some thirty steps of conjugate gradients
//! at any size. Lines have 4 on the diagonal and two neighbours. No length enters: slivers do
//! not matter.
//!
//! Where a dart or a semi-sharp tag gives the neighbours of a vertex weights of their own, and for
//! schemes outside the Loop family, the system may not be symmetric: conjugate gradients on the
//! normal equations take its place, and where there is no solution they give the least squares
//! answer. [`Interpolated::method`] is the method used.
//!
//! # Lines whose edges are of very different lengths
//! Along a crease or boundary a vertex adjacent to a much longer edge is relaxed: the curve passes
//! near it, not through it. `spacing.rs` gives the rule and its reason. Inside a region that lies
//! in a plane and that sharp lines close off it keeps its place as a control point; the surface
//! passes through it as through all of the plane (`planes.rs`).
//!
//! # Near rather than through
//! A surface that passes through every vertex undulates where vertices are out of line.
//! [`InterpolateOptions::within`] allows limits at this distance from their vertices, and gives the
//! fairest surface of those: the control net of least thin-plate energy (`fairness.rs`). It is as
//! curved as it must be and no more, which uses all of the distance where the surface is curved.
//! [`Interpolated::fairness`] compares the energy with a lower bound.
//!
//! ```
//! use limitmesh_surface::interpolate::{InterpolateOptions, interpolate};
//! use limitmesh_surface::limit::LimitTable;
//! use limitmesh_surface::scheme::Loop;
//! use limitmesh_surface::Mesh;
//!
//! let soup = limitmesh_models::find("sphere").ok_or("no such model")?.soup();
//! let (mesh, _) = Mesh::from_soup(&soup, &Default::default())?;
//! let control = interpolate(&mesh, &Loop, &InterpolateOptions::default())?.mesh;
//! for (limit, vertex) in LimitTable::new(&Loop).positions(&control)?.iter().zip(mesh.positions()) {
//!     assert!((0..3).all(|axis| (limit[axis] - vertex[axis]).abs() < 1e-12));
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod blocks;
mod control_points;
mod fairness;
mod near;
mod planes;
mod spacing;
mod sparse;
mod system;

pub use fairness::Fairness;
pub use near::NearVertices;

use crate::error_messages;
use crate::index::VertexId;
use crate::limit::{LimitError, LimitTable};
use crate::mesh::{Mesh, MeshError};
use crate::options;
use crate::progress::{Cancelled, Observer, Stage, Watch, unobserved};
use crate::scheme::Scheme;
use crate::vector::{DVec3, diagonal, vector};
use control_points::{ControlPoints, Limits, Near};
use system::Solver;

/// Limits farther from their vertices than this share of the bounding box's diagonal are not at them.
const THROUGH: f64 = 1e-10;

/// The tolerance of limits beyond the requested distance, as a share of the bounding box's
/// diagonal.
const NEAR: f64 = 1e-12;

/// Vertices between two calls of the observer: some milliseconds.
const POLLED: u32 = 1 << 12;

/// After this many attempts to keep vertices in planes, the surface passes through all.
const MOST_ATTEMPTS: usize = 4;

/// An error of interpolation.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum InterpolateError {
    /// A limit position does not exist.
    Limit(LimitError),
    /// A control point would not be finite, or an option is out of range.
    Mesh(MeshError),
    /// No limits that are near enough were found.
    TooFar {
        /// The vertex at fault.
        vertex: VertexId,
        /// The distance that was reached.
        distance: f64,
        /// The requested distance.
        within: f64,
    },
    /// The observer asked to stop.
    Cancelled(Cancelled),
}

error_messages! {
    InterpolateError {
        Self::TooFar { vertex, distance, within } => ("the limit of {vertex} is at least {distance} from it, but may be at most {within}"),
    }
    from { Limit(LimitError), Mesh(MeshError), Cancelled(Cancelled) }
}

options! {
    /// The options of interpolation.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct InterpolateOptions {
        /// The greatest distance of a limit from its vertex, as a length; the result is the fairest
        /// control mesh that keeps it. Default: 0, the surface passes through the vertices.
        pub within: f64 = 0.0,
    }
}

/// The method of solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum InterpolationMethod {
    /// No system was solved: all limits are the vertices themselves, as with a scheme that
    /// interpolates, or vertices of flat faces.
    Unchanged,
    /// Conjugate gradients on systems that are symmetric and positive definite.
    ConjugateGradients,
    /// Conjugate gradients on the normal equations, for some part of the mesh at least.
    NormalEquations,
    /// No control points have these limits: the sum of the squared distances of limits from
    /// vertices is the least, for some part of the mesh.
    LeastSquares,
}

/// A control mesh and a report.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Interpolated {
    /// The control mesh, with the faces and tags of the given mesh.
    pub mesh: Mesh,
    /// The method of solution.
    pub method: InterpolationMethod,
    /// Steps of conjugate gradients, in the part of the mesh that took most; where limits may leave their vertices, those of the
    /// last solution.
    pub iterations: usize,
    /// The greatest distance of a limit from its vertex, except for those
    /// [relaxed](Self::relaxed), and from its plane where the surface fills that. It is the
    /// rounding error, unless limits may leave their vertices or the answer is one of least
    /// squares.
    pub residual: f64,
    /// The relaxed vertices. On creases and boundaries these are vertices adjacent to edges much
    /// longer than their neighbours: the curve passes near them, at a distance smaller than its
    /// turn there; a curve through them would leave the mesh and come back. Others keep their
    /// control point so that the surface does not fold.
    pub relaxed: Vec<VertexId>,
    /// The greatest distance of a control point from its vertex: the greater, the likelier the
    /// surface undulates in between.
    pub displacement: f64,
    /// The vertex of [`Self::displacement`].
    pub most_displaced: VertexId,
    /// Its fairness, where limits may leave their vertices.
    pub fairness: Option<Fairness>,
}

/// The control mesh whose limit surface passes through the vertices of `mesh`, or as near as the options say.
///
/// Vertices whose limit is their own position keep it: corners, and all vertices with an
/// interpolating scheme. Copies of a vertex where sheets were cut apart stay together, bit for bit.
///
/// # Errors
/// A vertex has no limit, a control point would not be finite, or the requested distance is
/// negative, NaN, or not reached.
pub fn interpolate(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    options: &InterpolateOptions,
) -> Result<Interpolated, InterpolateError> {
    interpolate_observed(mesh, scheme, options, &mut unobserved)
}

/// [`interpolate`] with an observer.
///
/// # Errors
/// Those of [`interpolate`], or the observer asked to stop.
pub fn interpolate_observed(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    options: &InterpolateOptions,
    observer: &mut Observer<'_>,
) -> Result<Interpolated, InterpolateError> {
    interpolate_but(mesh, scheme, options, &[], observer)
}

/// [`interpolate_observed`], except for `kept` vertices, which stay control points; the surface
/// passes near them.
#[doc(hidden)]
pub fn interpolate_but(
    mesh: &Mesh,
    scheme: &dyn Scheme,
    options: &InterpolateOptions,
    kept: &[VertexId],
    observer: &mut Observer<'_>,
) -> Result<Interpolated, InterpolateError> {
    let within = options.within;
    if !(within >= 0.0 && within.is_finite()) {
        let (name, expected) = (
            "the distance of limits from vertices",
            "a length of at least 0",
        );
        return Err(MeshError::BadOption {
            name,
            value: within,
            expected,
        }
        .into());
    }
    let mut watch = Watch::new(observer, Stage::Interpolating);
    watch.triangles(mesh.face_count());
    watch.stage(Stage::Interpolating, Some(mesh.vertex_count()))?;
    let table = LimitTable::new(scheme);
    let rows = table.position_rows(mesh, &mut |_| watch.poll())??;
    let mut points = ControlPoints::new(mesh, rows, kept, &mut |_| watch.poll())?;
    if points.is_solved() {
        return Ok(Interpolated {
            mesh: mesh.clone(),
            method: InterpolationMethod::Unchanged,
            iterations: 0,
            residual: 0.0,
            relaxed: points.relaxed(),
            displacement: 0.0,
            most_displaced: VertexId(0),
            fairness: None,
        });
    }
    let (nowhere, reach) = (
        vec![DVec3::ZERO; mesh.vertex_count()],
        vec![within; mesh.vertex_count()],
    );
    let near = Near {
        reach: &reach,
        nearness: fairness::NEARNESS,
        nothing: fairness::NOTHING,
        from: &nowhere,
    };
    let asked = if within > 0.0 {
        Limits::Near(&near)
    } else {
        Limits::At(&nowhere)
    };
    let mut attempt = 0;
    let (moved, control, limits) = loop {
        let moved = points.solve(&asked, &mut watch)?;
        let positions = moved
            .by
            .iter()
            .enumerate()
            .map(|(v, &by)| points.position(v, by))
            .collect();
        let control = mesh.clone().with_positions(positions)?;
        watch.stage(Stage::Limits, Some(mesh.vertex_count()))?;
        let limits = table.positions_polled(&control, &mut |done| watch.done(done))??;
        let most = within + points.rounding() + THROUGH * mesh.diagonal();
        attempt += 1;
        if !points.lead_through(&limits, (most, attempt >= MOST_ATTEMPTS), &mut |_| {
            watch.poll()
        })? {
            break (moved, control, limits);
        }
        watch.stage(Stage::Interpolating, Some(mesh.vertex_count()))?;
    };
    let relaxed = points.relaxed();
    let (residual, vertex) = farthest(&limits, mesh.positions(), |v, away| points.missed(v, away));
    let rounding = points.rounding();
    let nearest = within + rounding + NEAR * mesh.diagonal();
    if within > 0.0 && residual > nearest {
        // The fairest mesh is not found where the rows of limits are nearly singular, as those of a cube of quads are.
        let through = InterpolateOptions::default();
        let found = interpolate_but(mesh, scheme, &through, kept, &mut watch.observer())?;
        return match found.residual <= nearest {
            true => Ok(found),
            false => Err(InterpolateError::TooFar {
                vertex,
                distance: residual,
                within,
            }),
        };
    }
    let (displacement, most_displaced) =
        farthest(control.positions(), mesh.positions(), |_, away| away);
    let method = match moved.solver {
        _ if residual > within + rounding + THROUGH * mesh.diagonal() => {
            InterpolationMethod::LeastSquares
        }
        Solver::Symmetric => InterpolationMethod::ConjugateGradients,
        Solver::Normal => InterpolationMethod::NormalEquations,
    };
    Ok(Interpolated {
        mesh: control,
        method,
        iterations: moved.steps,
        residual,
        relaxed,
        displacement,
        most_displaced,
        fairness: moved.energies.map(|energies| energies.fairness()),
    })
}

/// The greatest distance between points of the same number, of which a part counts, and the first of those.
fn farthest(
    a: &[[f64; 3]],
    b: &[[f64; 3]],
    counts: impl Fn(usize, DVec3) -> DVec3,
) -> (f64, VertexId) {
    let distance = |(v, (&a, &b)): (usize, (&[f64; 3], &[f64; 3]))| {
        let away = counts(v, vector(a) - vector(b));
        (
            v as u32,
            diagonal(away.min(DVec3::ZERO), away.max(DVec3::ZERO)),
        )
    };
    let most = |most: (f64, VertexId), (v, distance): (u32, f64)| {
        if distance > most.0 {
            (distance, VertexId(v))
        } else {
            most
        }
    };
    a.iter()
        .zip(b)
        .enumerate()
        .map(distance)
        .fold((0.0, VertexId(0)), most)
}

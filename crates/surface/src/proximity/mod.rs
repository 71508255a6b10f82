//! The closest point of a limit surface, certified, and whether a point is inside.
//!
//! Takes a [`LimitSurface`] of the Loop family or Catmull–Clark and any points. The surface over a control face is
//! in the hull of control points (`pieces`), so that no point of it is farther from the triangle
//! of its limit corners than the hull's points are; boxes of hulls are in a tree. A search
//! (`nearest`) skips a box by its distance, and where the squared distance bends little over a
//! piece (`convexity`), its value and derivatives at one place bound it. The winding number
//! decides whether a point is inside (`winding`).

mod convexity;
mod nearest;
mod pieces;
mod winding;

use crate::error_messages;
use crate::geometry::SurfaceFrame;
use crate::geometry::box_tree::BoxTree;
use crate::index::FaceId;
use crate::limit_surface::LimitSurface;
use crate::parallel;
use crate::progress::{Cancelled, Observer, Stage, Watch, uncancelled, unobserved};
use crate::vector::vector;
use nearest::Query;
use pieces::FacePieces;
use winding::Chains;

/// Control faces up to which their pieces are kept, some ten kilobytes a face; those of larger
/// meshes are made when visited.
const MOST_KEPT: usize = 40_000;

/// Control faces whose pieces are made together.
const FACES: usize = 16;

/// Points that are looked for together.
const POINTS: usize = 64;

/// Points up to this part of the surface's size from it are neither inside nor outside.
const NEAR: f64 = 1e-9;

/// The least part of the surface's size that a tolerance can be: smaller ones are within rounding.
const LEAST_TOLERANCE: f64 = 1e-13;

/// An error of proximity.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ProximityError {
    /// Bounds exist only for schemes of Loop's family and for Catmull–Clark.
    Scheme {
        /// The scheme's name.
        name: String,
    },
    /// A mesh without faces has no surface.
    Empty,
    /// A limit stencil failed.
    Limit(crate::limit::LimitError),
    /// An open surface has no inside.
    Open {
        /// Where the first boundary edge begins.
        from: u32,
        /// Where it ends.
        to: u32,
    },
    /// A point is not finite.
    NotFinite {
        /// Which of those that were given.
        index: usize,
        /// Its coordinates.
        point: [f64; 3],
    },
    /// A point whose squared distance overflows.
    TooFar {
        /// Which of those that were given.
        index: usize,
        /// Its coordinates.
        point: [f64; 3],
    },
    /// A tolerance is out of range.
    Tolerance {
        /// The given value.
        tolerance: f64,
    },
    /// The observer asked to stop.
    Cancelled(Cancelled),
}

error_messages! {
    ProximityError {
        Self::Scheme { name } => ("closest points are found on surfaces of the Loop family and Catmull–Clark, not of the scheme '{name}'"),
        Self::Empty => ("the control mesh has no faces"),
        Self::Open { from, to } => ("the surface has no inside: the edge from vertex {from} to vertex {to} is on its boundary"),
        Self::NotFinite { index, point } => ("point {index} is not finite: ({}, {}, {})", point[0], point[1], point[2]),
        Self::TooFar { index, point } => ("point {index} at ({}, {}, {}) is too far from the surface for its distance, by the surface's size, to be squared",
        point[0], point[1], point[2]),
        Self::Tolerance { tolerance } => ("the tolerance must be a length above 0, but is {tolerance}"),
    }
    from { Limit(crate::limit::LimitError), Cancelled(Cancelled) }
}

/// The point of a limit surface that is closest to a given one.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Closest {
    /// Its position, in the control mesh's units.
    pub point: [f64; 3],
    /// Its control face.
    pub face: FaceId,
    /// The weights of that face's corners.
    pub barycentric: [f64; 3],
    /// Its distance from the given point.
    pub distance: f64,
    /// No point of the surface is nearer than this, to rounding: not below `distance` by more than the tolerance.
    pub lower: f64,
}

/// The position of a point relative to a closed surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Membership {
    /// The surface winds around it.
    Inside,
    /// The surface does not wind around it.
    Outside,
    /// It is within about 1e-9 of the surface's size of the surface, or NaN.
    Near,
}

/// A limit surface, prepared for queries of points.
///
/// ```
/// use limitmesh_surface::{LimitSurface, Membership, Mesh, Proximity, scheme::Loop};
///
/// let mesh = Mesh::from_triangles(
///     vec![[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]],
///     vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
/// )?;
/// let surface = LimitSurface::new(&mesh, &Loop)?;
/// let proximity = Proximity::new(&surface)?;
///
/// // Beyond a corner, the limit of which is (1, 1, 1) / 5.
/// let [closest] = proximity.closest(&[[1.0, 1.0, 1.0]], 1e-9)?[..] else { unreachable!() };
/// assert!(closest.point.iter().all(|x| (x - 0.2).abs() < 1e-7));
/// assert!(closest.lower <= closest.distance && closest.distance < closest.lower + 1e-9);
/// assert_eq!(proximity.membership([0.0; 3])?, Membership::Inside);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Proximity<'a> {
    surface: &'a LimitSurface<'a>,
    frame: SurfaceFrame,
    /// Over the boxes of the control faces' pieces.
    tree: BoxTree,
    /// By control face; empty where they are made when they are needed.
    faces: Vec<FacePieces>,
    chains: Result<Chains, ProximityError>,
}

impl<'a> Proximity<'a> {
    /// Prepares the surface.
    ///
    /// # Errors
    /// The scheme is neither of the Loop family nor Catmull–Clark, the mesh has no faces, or a stencil failed.
    pub fn new(surface: &'a LimitSurface<'a>) -> Result<Self, ProximityError> {
        Self::new_observed(surface, &mut unobserved)
    }

    /// [`Self::new`] with an observer.
    ///
    /// # Errors
    /// Those of [`Self::new`], or the observer asked to stop.
    pub fn new_observed(
        surface: &'a LimitSurface<'a>,
        observer: &mut Observer<'_>,
    ) -> Result<Self, ProximityError> {
        if !surface.is_certified() {
            return Err(ProximityError::Scheme {
                name: surface.scheme().name().to_owned(),
            });
        }
        let mesh = surface.control();
        let bounds = mesh
            .as_triangles()
            .bounding_box()
            .ok_or(ProximityError::Empty)?;
        if mesh.face_count() == 0 {
            return Err(ProximityError::Empty);
        }
        let frame = SurfaceFrame::of(bounds.map(vector));
        let mut watch = Watch::new(observer, Stage::Indexing);
        watch.triangles(mesh.face_count());
        watch.stage(Stage::Indexing, Some(mesh.face_count()))?;
        let is_kept = mesh.face_count() <= MOST_KEPT;
        let made = parallel::pieces_polled(
            mesh.face_count(),
            FACES,
            &mut |done| watch.done(done),
            |block| {
                let face = |face: usize| {
                    let face = FaceId(face as u32);
                    match is_kept {
                        true => {
                            let pieces = FacePieces::of(surface, &frame, face);
                            (pieces.bounds(), Some(pieces))
                        }
                        false => (pieces::bounds(surface, &frame, face), None),
                    }
                };
                block.map(face).collect::<Vec<_>>()
            },
        )?;
        let (boxes, faces): (Vec<_>, Vec<_>) = made.into_iter().flatten().unzip();
        if let Some(error) = surface.failure() {
            return Err(error.clone().into());
        }
        let tree = BoxTree::of(&boxes);
        watch.poll()?;
        let chains = Chains::of(surface, &frame, &tree);
        Ok(Self {
            surface,
            frame,
            tree,
            faces: faces.into_iter().flatten().collect(),
            chains,
        })
    }

    /// The surface.
    pub fn surface(&self) -> &'a LimitSurface<'a> {
        self.surface
    }

    /// The closest points of the surface to given ones, in their order, on all threads; each
    /// distance is within the tolerance (a length in the control mesh's unit) of the least. The
    /// least tolerance is about 1e-13 of the surface's size.
    ///
    /// A point with many equally close ones, such as the middle of a sphere, takes long: the search
    /// visits the whole surface, in pieces with an error below the tolerance.
    ///
    /// # Errors
    /// A point or the tolerance is not finite, or the tolerance is not above 0.
    pub fn closest(
        &self,
        points: &[[f64; 3]],
        tolerance: f64,
    ) -> Result<Vec<Closest>, ProximityError> {
        self.closest_observed(points, tolerance, &mut unobserved)
    }

    /// [`Self::closest`] with an observer.
    ///
    /// # Errors
    /// Those of [`Self::closest`], or the observer asked to stop.
    pub fn closest_observed(
        &self,
        points: &[[f64; 3]],
        tolerance: f64,
        observer: &mut Observer<'_>,
    ) -> Result<Vec<Closest>, ProximityError> {
        if !(tolerance > 0.0 && tolerance.is_finite()) {
            return Err(ProximityError::Tolerance { tolerance });
        }
        check(points)?;
        let mut watch = Watch::new(observer, Stage::Sampling);
        watch.stage(Stage::Sampling, Some(points.len()))?;
        let tolerance = self.frame.length_inside(tolerance).max(LEAST_TOLERANCE);
        let poll = &mut |done| watch.done(done);
        let found =
            parallel::long_pieces_polled(points.len(), POINTS, poll, |block, is_stopped| {
                let mut query = Query::new(self, tolerance, is_stopped);
                points[block]
                    .iter()
                    .map(|&point| query.closest(point))
                    .collect::<Vec<_>>()
            })?;
        let found = found.concat();
        match found
            .iter()
            .position(|closest| !closest.distance.is_finite())
        {
            Some(index) => Err(ProximityError::TooFar {
                index,
                point: points[index],
            }),
            None => Ok(found),
        }
    }

    /// The winding number of a closed surface around a point, counter-clockwise as seen from
    /// outside; `None` where the point is too near to decide.
    ///
    /// # Errors
    /// The surface is open, or the point is not finite.
    pub fn winding_number(&self, point: [f64; 3]) -> Result<Option<i32>, ProximityError> {
        check(&[point])?;
        let chains = self.chains.as_ref().map_err(Clone::clone)?;
        Ok(chains.winding_number(self, self.frame.inside(vector(point))))
    }

    /// Whether a point is inside: the surface winds around it, whichever way its normals point.
    ///
    /// # Errors
    /// Those of [`Self::winding_number`].
    pub fn membership(&self, point: [f64; 3]) -> Result<Membership, ProximityError> {
        Ok(match self.winding_number(point)? {
            None => Membership::Near,
            Some(0) => Membership::Outside,
            Some(_) => Membership::Inside,
        })
    }

    /// [`Self::membership`] of many points, in their order, on all threads.
    ///
    /// # Errors
    /// Those of [`Self::winding_number`].
    pub fn memberships(&self, points: &[[f64; 3]]) -> Result<Vec<Membership>, ProximityError> {
        uncancelled(
            |observer| match self.memberships_observed(points, observer) {
                Err(ProximityError::Cancelled(cancelled)) => Err(cancelled),
                other => Ok(other),
            },
        )
    }

    /// [`Self::memberships`] with an observer.
    ///
    /// # Errors
    /// Those of [`Self::winding_number`], or the observer asked to stop.
    pub fn memberships_observed(
        &self,
        points: &[[f64; 3]],
        observer: &mut Observer<'_>,
    ) -> Result<Vec<Membership>, ProximityError> {
        check(points)?;
        self.chains.as_ref().map_err(Clone::clone)?;
        let mut watch = Watch::new(observer, Stage::Sampling);
        watch.stage(Stage::Sampling, Some(points.len()))?;
        let poll = &mut |done| watch.done(done);
        let found = parallel::pieces_polled(points.len(), POINTS, poll, |block| {
            points[block]
                .iter()
                .map(|&point| self.membership(point))
                .collect::<Result<Vec<_>, _>>()
        })?;
        let found: Result<Vec<Vec<Membership>>, ProximityError> = found.into_iter().collect();
        Ok(found?.concat())
    }

    /// Calls something with the pieces of a face.
    fn with_pieces<T>(&self, face: u32, then: impl FnOnce(&FacePieces) -> T) -> T {
        match self.faces.get(face as usize) {
            Some(kept) => then(kept),
            None => then(&FacePieces::of(self.surface, &self.frame, FaceId(face))),
        }
    }
}

fn check(points: &[[f64; 3]]) -> Result<(), ProximityError> {
    match points
        .iter()
        .position(|point| !point.iter().all(|x| x.is_finite()))
    {
        Some(index) => Err(ProximityError::NotFinite {
            index,
            point: points[index],
        }),
        None => Ok(()),
    }
}

//! The hits of rays on a limit surface (Kobbelt, Daubert, Seidel, "Ray Tracing of Subdivision
//! Surfaces", 1998).
//!
//! Their envelopes of the control mesh become hulls of pieces: a ray that misses the hull of a
//! piece's control points misses the piece. A regular piece whose projection along the ray is
//! injective (`planar`) is met once at most, and Newton's method finds the hit; any other is
//! divided, until it is missed, or met for certain, or so small that it counts as grazed. Nothing
//! else is skipped, so no hit is missed. Boxes of pieces are in a tree.

mod merge;
mod pieces;
mod planar;
mod search;

use crate::error_messages;
use crate::geometry::SurfaceFrame;
use crate::geometry::box_tree::{Bounds, BoxTree, NO_BOUNDS, grown};
use crate::index::FaceId;
use crate::limit_surface::LimitSurface;
use crate::progress::{Cancelled, Observer, SharedWatch, Stage, uncancelled, unobserved};
use crate::vector::vector;
use pieces::Piece;
use search::{Found, RayFrame, RaySearch};

/// Control faces whose pieces are made together, and rays that are followed together.
const BLOCK: usize = 64;

/// The least part of the surface's size that a tolerance can be: smaller ones are within rounding.
const LEAST_TOLERANCE: f64 = 1e-12;

/// The default tolerance, as a part of the surface's size.
const TOLERANCE: f64 = 1e-10;

/// A half line: all `origin + t · direction` with t from 0 on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The origin, in the control mesh's units.
    pub origin: [f64; 3],
    /// The direction, of any length but 0.
    pub direction: [f64; 3],
}

/// Options of the queries of a ray: which hits count, and the tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RayOptions {
    /// The least t that counts; may be below 0. Default: 0.
    pub from: f64,
    /// The greatest t that counts. Default: infinite.
    pub to: f64,
    /// A length in the control mesh's units: a ray that touches the surface without certainly
    /// crossing it, within this distance, grazes it. Default: 1e-10 of the control mesh's diagonal.
    pub tolerance: Option<f64>,
}

impl Default for RayOptions {
    fn default() -> Self {
        Self {
            from: 0.0,
            to: f64::INFINITY,
            tolerance: None,
        }
    }
}

impl RayOptions {
    /// Sets the range of t that counts.
    pub fn between(self, from: f64, to: f64) -> Self {
        Self { from, to, ..self }
    }

    /// Sets [`Self::tolerance`].
    pub fn tolerance(self, tolerance: f64) -> Self {
        Self {
            tolerance: Some(tolerance),
            ..self
        }
    }
}

/// The kind of a hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Crossing {
    /// Through the front, where a face's corners run counter-clockwise.
    Entering,
    /// Through the back.
    Leaving,
    /// It touches the surface, or comes within a few tolerances of it, or crosses it and back
    /// within this distance; or it meets a vertex at which the surface has no tangent plane.
    Grazing,
}

/// A point where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Hit {
    /// The distance along the ray, in lengths of its direction.
    pub t: f64,
    /// The control face, one of those that share the point.
    pub face: FaceId,
    /// The place on the face, as weights of its corners.
    pub barycentric: [f64; 3],
    /// The point of the surface, in the control mesh's units.
    pub position: [f64; 3],
    /// The surface's unit normal there, on the side of the face; zero where there is none.
    pub normal: [f64; 3],
    /// The kind of the hit.
    pub crossing: Crossing,
}

/// An error of rays.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RayError {
    /// Hulls exist only for schemes of Loop's family and for Catmull–Clark.
    Scheme {
        /// The scheme's name.
        name: String,
    },
    /// A limit stencil failed.
    Limit(crate::limit::LimitError),
    /// The observer asked to stop.
    Cancelled(Cancelled),
}

error_messages! {
    RayError {
        Self::Scheme { name } => ("rays are followed to surfaces of the Loop family and Catmull–Clark, not of the scheme '{name}'"),
    }
    from { Limit(crate::limit::LimitError), Cancelled(Cancelled) }
}

/// A limit surface, ready for many rays.
///
/// ```
/// use limitmesh_surface::{Crossing, LimitSurface, Mesh, Ray, RayCaster, scheme::Loop};
///
/// let mesh = Mesh::from_triangles(
///     vec![[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]],
///     vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
/// )?;
/// let surface = LimitSurface::new(&mesh, &Loop)?;
/// let rays = RayCaster::new(&surface)?;
/// let hits = rays.intersections(&Ray { origin: [0.0, 0.0, 5.0], direction: [0.0, 0.0, -1.0] }, &Default::default());
/// // Through the middles of two opposite edges, which are 7/24 from the tetrahedron's centre.
/// assert_eq!(hits.len(), 2);
/// assert!((hits[0].t - (5.0 - 7.0 / 24.0)).abs() < 1e-9 && hits[0].crossing == Crossing::Entering);
/// assert!((hits[1].t - (5.0 + 7.0 / 24.0)).abs() < 1e-9 && hits[1].crossing == Crossing::Leaving);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct RayCaster<'a> {
    surface: &'a LimitSurface<'a>,
    frame: SurfaceFrame,
    pieces: Vec<Piece>,
    tree: BoxTree,
}

impl<'a> RayCaster<'a> {
    /// Prepares the search: some kilobytes a control face.
    ///
    /// # Errors
    /// A scheme but the Loop family and Catmull–Clark; a stencil that failed.
    pub fn new(surface: &'a LimitSurface<'a>) -> Result<Self, RayError> {
        Self::new_observed(surface, &mut unobserved)
    }

    /// [`Self::new`] with an observer.
    ///
    /// # Errors
    /// Those of [`Self::new`], or the observer asked to stop.
    pub fn new_observed(
        surface: &'a LimitSurface<'a>,
        observer: &mut Observer<'_>,
    ) -> Result<Self, RayError> {
        if !surface.is_certified() {
            return Err(RayError::Scheme {
                name: surface.rules().scheme().name().to_owned(),
            });
        }
        let mesh = surface.control();
        let frame = SurfaceFrame::of(
            mesh.positions()
                .iter()
                .map(|&p| vector(p))
                .fold(NO_BOUNDS, grown),
        );
        let faces = mesh.face_count();
        let of_faces = |face: usize| pieces::pieces(surface, &frame, FaceId(face as u32), faces);
        let watch = SharedWatch::new(observer, Stage::Indexing);
        watch.triangles(faces);
        watch.stage(Stage::Indexing, Some(faces))?;
        let blocks = watch.pieces(faces, BLOCK, |block| {
            block.flat_map(of_faces).collect::<Vec<_>>()
        })?;
        watch.done(faces)?;
        let (boxes, pieces): (Vec<Bounds>, Vec<Piece>) = blocks.into_iter().flatten().unzip();
        if let Some(why) = surface.failure() {
            return Err(why.clone().into());
        }
        Ok(Self {
            surface,
            frame,
            tree: BoxTree::of(&boxes),
            pieces,
        })
    }

    /// All points where a ray meets the surface, in their order along it. None is missed; a hit on
    /// an edge or a vertex is reported once. Rays without a direction, or that are not finite, have
    /// no hits.
    pub fn intersections(&self, ray: &Ray, options: &RayOptions) -> Vec<Hit> {
        let Some((search, tolerance)) = self.searched(ray, options, false) else {
            return Vec::new();
        };
        let frame = search.frame;
        let found = merge::merged(search.found, self.surface.control().triangles(), tolerance);
        found.iter().map(|found| self.hit(found, &frame)).collect()
    }

    /// The first of the [`Self::intersections`], found without the others.
    pub fn first(&self, ray: &Ray, options: &RayOptions) -> Option<Hit> {
        let (search, _) = self.searched(ray, options, true)?;
        let least = |a: &&Found, b: &&Found| a.depth.total_cmp(&b.depth).then(a.face.cmp(&b.face));
        search
            .found
            .iter()
            .min_by(least)
            .map(|found| self.hit(found, &search.frame))
    }

    /// [`Self::first`] of many rays, in order, on all threads.
    pub fn first_of_all(&self, rays: &[Ray], options: &RayOptions) -> Vec<Option<Hit>> {
        uncancelled(|observer| self.first_of_all_observed(rays, options, observer))
    }

    /// [`Self::first_of_all`] with an observer.
    ///
    /// # Errors
    /// It was cancelled.
    pub fn first_of_all_observed(
        &self,
        rays: &[Ray],
        options: &RayOptions,
        observer: &mut Observer<'_>,
    ) -> Result<Vec<Option<Hit>>, Cancelled> {
        let blocks = self.of_all(rays, observer, |ray| self.first(ray, options))?;
        Ok(blocks.concat())
    }

    /// [`Self::intersections`] of many rays, in order, on all threads.
    pub fn intersections_of_all(&self, rays: &[Ray], options: &RayOptions) -> Vec<Vec<Hit>> {
        uncancelled(|observer| self.intersections_of_all_observed(rays, options, observer))
    }

    /// [`Self::intersections_of_all`] with an observer.
    ///
    /// # Errors
    /// It was cancelled.
    pub fn intersections_of_all_observed(
        &self,
        rays: &[Ray],
        options: &RayOptions,
        observer: &mut Observer<'_>,
    ) -> Result<Vec<Vec<Hit>>, Cancelled> {
        let blocks = self.of_all(rays, observer, |ray| self.intersections(ray, options))?;
        Ok(blocks.into_iter().flatten().collect())
    }

    /// The results for each ray, in blocks of rays.
    fn of_all<T: Send>(
        &self,
        rays: &[Ray],
        observer: &mut Observer<'_>,
        of: impl Fn(&Ray) -> T + Sync,
    ) -> Result<Vec<Vec<T>>, Cancelled> {
        let watch = SharedWatch::new(observer, Stage::Casting);
        watch.triangles(self.surface.control().face_count());
        watch.stage(Stage::Casting, Some(rays.len()))?;
        let blocks = watch.pieces(rays.len(), BLOCK, |block| {
            rays[block].iter().map(&of).collect::<Vec<_>>()
        })?;
        watch.done(rays.len())?;
        Ok(blocks)
    }

    fn searched(
        &self,
        ray: &Ray,
        options: &RayOptions,
        is_first_enough: bool,
    ) -> Option<(RaySearch<'_>, f64)> {
        let frame = RayFrame::of(ray, &self.frame)?;
        let asked = options
            .tolerance
            .map_or(TOLERANCE, |tolerance| self.frame.length_inside(tolerance));
        let tolerance = if asked > LEAST_TOLERANCE {
            asked
        } else {
            LEAST_TOLERANCE
        };
        let of = (self.surface, &self.frame, &self.pieces[..]);
        let mut search = RaySearch::new(of, frame, options, tolerance, is_first_enough);
        self.tree.search(&mut search);
        Some((search, tolerance))
    }

    fn hit(&self, found: &Found, frame: &RayFrame) -> Hit {
        let face = FaceId(found.face);
        let point = self.surface.at(face, found.weights);
        Hit {
            t: frame.parameter(found.depth),
            face,
            barycentric: found.weights,
            position: point.position,
            normal: point.normal,
            crossing: found.crossing,
        }
    }
}

impl LimitSurface<'_> {
    /// All points where a ray meets the surface, as by [`RayCaster::intersections`]: for a few
    /// rays, since each call prepares the search anew.
    ///
    /// # Errors
    /// Those of [`RayCaster::new`].
    pub fn intersections(&self, ray: &Ray, options: &RayOptions) -> Result<Vec<Hit>, RayError> {
        Ok(RayCaster::new(self)?.intersections(ray, options))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scheme::Loop;
    use limitmesh_testing::Random;

    /// The number of pieces that rays test; docs/paper.md has the printed numbers.
    #[test]
    fn rays_look_at_few_pieces() {
        let mesh = limitmesh_testing::models::model("head");
        let surface = LimitSurface::new(&mesh, &Loop).unwrap();
        let rays = RayCaster::new(&surface).unwrap();
        let (mut pieces, mut hits, mut random) = (0, 0, Random::new(7));
        let count = 500;
        for _ in 0..count {
            let origin = (rays.frame.size * random.vector() + rays.frame.middle).to_array();
            let ray = Ray {
                origin,
                direction: random.vector().to_array(),
            };
            let all = RayOptions::default().between(f64::NEG_INFINITY, f64::INFINITY);
            let (search, _) = rays.searched(&ray, &all, false).unwrap();
            (pieces, hits) = (pieces + search.looked_at, hits + search.found.len());
        }
        println!(
            "{:.1} pieces a line, {:.2} hits",
            pieces as f64 / count as f64,
            hits as f64 / count as f64
        );
        assert!(hits > count / 4 && pieces < 40 * count, "{pieces} {hits}");
    }
}

//! The proven distance of a refined mesh from the given mesh.
//!
//! Exact refinement knows the origin of each vertex on the control mesh, and its triangles are of
//! pieces that tile the control faces. So each triangle has a piece of the given mesh's surface as
//! its partner, point by point; as both are flat, no two partners are farther apart than those at
//! the corners. The greatest distance between a vertex and its origin bounds the Hausdorff
//! distance, in both directions.
//!
//! Regions that lie in a plane are triangulated from their rims alone, which have partners as all
//! edges have. A point of one region that is not in the other lies on a segment between partners of
//! the rims: moved along these, the one rim must pass it to become the other. So the rims bound the
//! distance, up to the distances of both from the plane.
//!
//! The lower bounds are true distances of the points that were moved most along normals: vertices
//! move along the surface where triangles are of different sizes, and the interval is wide there.
//! Of a mesh that is not too large the two are measured then, by the certified search.

use super::{Exact, Origin};
use crate::measure::{Bvh, CertifiedOptions, MeasureError, certified_hausdorff_between_observed};
use crate::mesh::Triangles;
use crate::parallel;
use crate::progress::Observer;
use crate::vector::{DVec3, vector};

/// Points whose distance is measured.
const MEASURED: usize = 4;

/// An interval is wide where its upper end is more than this many times the lower one.
const WIDE: f64 = 1.25;

/// How narrow it is to be then, the work for that, about a second, and the triangles of both meshes at most.
const NARROW: f64 = 0.1;
const MOST_WORK: u64 = 20_000_000;
const MOST_TRIANGLES: usize = 200_000;

/// How narrow it is to be where a bound is to be kept that lies inside.
const NARROWEST: f64 = 0.01;

/// The rounding error of a computed point or distance, as a share of the greatest coordinate: some
/// hundred units in the last place.
const ROUNDING: f64 = 2e-14;

/// An interval for the symmetric Hausdorff distance between the given mesh and the refined one, in
/// the mesh's unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InputDistance {
    /// A distance that some point of one has from the other.
    pub lower: f64,
    /// A proven upper bound.
    pub upper: f64,
}

impl InputDistance {
    /// The distance of a refined mesh whose triangles each belong to one face of the control mesh,
    /// by the origins of its vertices on the given mesh ([`Exact::origins`], where that has the
    /// control mesh's faces); `None` where triangles cover parts of several faces, or origins are
    /// missing.
    ///
    /// Where the surface lies in a plane, the given mesh's vertices are within `residual` of it.
    ///
    /// # Errors
    /// Coordinates too large to be measured.
    pub fn new(
        input: Triangles<'_>,
        found: &Exact,
        origins: &[Origin],
        residual: f64,
    ) -> Result<Option<Self>, MeasureError> {
        let is_known = origins.len() == found.mesh.vertex_count();
        if !is_known || found.is_collapsed() {
            return Ok(None);
        }
        let moved = Moves::of(input, found, origins);
        let rounding = ROUNDING * greatest(input);
        let lower = lower(input, (found, origins), &moved)? - rounding;
        let off_planes = if found.statistics.off_planes > 0.0 {
            2.0 * found.statistics.off_planes + residual
        } else {
            0.0
        };
        Ok(Some(Self {
            lower: lower.max(0.0),
            upper: moved.greatest + off_planes + rounding,
        }))
    }

    /// The distance of another mesh that approximates the limit surface of this one, where these
    /// are within `apart` of each other.
    ///
    /// # Errors
    /// Coordinates too large to be measured.
    pub fn of_other(
        self,
        input: Triangles<'_>,
        found: &Exact,
        origins: &[Origin],
        apart: f64,
    ) -> Result<Self, MeasureError> {
        let lower = lower(input, (found, origins), &Moves::of(input, found, origins))?;
        Ok(Self {
            lower: (lower - ROUNDING * greatest(input)).max(0.0),
            upper: (self.upper + apart).next_up(),
        })
    }

    /// The distance, measured anew where the interval is wide and reaches beyond the `expected`
    /// distance.
    ///
    /// # Errors
    /// Coordinates too large to be measured, or the observer asked to stop.
    pub fn narrowed(
        self,
        meshes: [Triangles<'_>; 2],
        expected: f64,
        observer: &mut Observer<'_>,
    ) -> Result<Self, MeasureError> {
        let is_wide = self.upper > expected && self.upper > WIDE * self.lower;
        if is_wide {
            self.measured(meshes, NARROW, observer)
        } else {
            Ok(self)
        }
    }

    /// The distance, measured anew where the interval contains a bound.
    ///
    /// # Errors
    /// Coordinates too large to be measured, or the observer asked to stop.
    pub fn decided(
        self,
        meshes: [Triangles<'_>; 2],
        bound: f64,
        observer: &mut Observer<'_>,
    ) -> Result<Self, MeasureError> {
        let is_open = self.lower <= bound && bound < self.upper;
        if is_open {
            self.measured(meshes, NARROWEST, observer)
        } else {
            Ok(self)
        }
    }

    fn measured(
        self,
        [input, found]: [Triangles<'_>; 2],
        gap: f64,
        observer: &mut Observer<'_>,
    ) -> Result<Self, MeasureError> {
        if input.triangles.len() + found.triangles.len() > MOST_TRIANGLES {
            return Ok(self);
        }
        let (from, to) = (
            Bvh::new_observed(found, observer)?,
            Bvh::new_observed(input, observer)?,
        );
        let options = CertifiedOptions::default()
            .relative_gap(gap)
            .max_work(MOST_WORK);
        let measured = certified_hausdorff_between_observed(&from, &to, &options, observer)?;
        Ok(Self {
            lower: self.lower.max(measured.lower()),
            upper: self.upper.min(measured.upper()),
        })
    }

    /// The distance after vertices were rounded by at most `rounding`.
    pub fn rounded(self, rounding: f64) -> Self {
        Self {
            lower: (self.lower - rounding).max(0.0),
            upper: self.upper + rounding,
        }
    }
}

fn greatest(mesh: Triangles<'_>) -> f64 {
    mesh.positions
        .as_flattened()
        .iter()
        .fold(0.0, |greatest, x| greatest.max(x.abs()))
}

/// Where a vertex came from.
pub(super) fn place(input: Triangles<'_>, origin: &Origin) -> DVec3 {
    let corners = input.corners(origin.face as usize);
    origin
        .barycentric
        .iter()
        .zip(corners)
        .map(|(&weight, corner)| weight * vector(corner))
        .sum()
}

/// How far vertices are from where they came from.
struct Moves {
    /// The greatest.
    greatest: f64,
    /// The points that were moved most along normals, in their order.
    most: Vec<usize>,
}

impl Moves {
    fn of(input: Triangles<'_>, found: &Exact, origins: &[Origin]) -> Self {
        let positions = found.mesh.positions();
        let parts = parallel::pieces(origins.len(), |vertices| {
            let (mut greatest, mut most) = (0.0f64, Vec::with_capacity(MEASURED + 1));
            for vertex in vertices {
                let step = vector(positions[vertex]) - place(input, &origins[vertex]);
                greatest = greatest.max(step.length());
                insert(
                    &mut most,
                    (step.dot(vector(found.normals[vertex])).abs(), vertex),
                );
            }
            (greatest, most)
        });
        let mut all = Self {
            greatest: 0.0,
            most: Vec::new(),
        };
        let mut most = Vec::new();
        for (greatest, of_part) in parts {
            all.greatest = all.greatest.max(greatest);
            of_part.into_iter().for_each(|one| insert(&mut most, one));
        }
        all.most.extend(most.into_iter().map(|(_, vertex)| vertex));
        all.most.sort_unstable();
        all
    }
}

/// Puts a number and its vertex into a short list of the greatest, of equal ones behind those that are there.
fn insert(most: &mut Vec<(f64, usize)>, one: (f64, usize)) {
    let at = most.partition_point(|known| known.0 >= one.0);
    if at < MEASURED {
        most.insert(at, one);
        most.truncate(MEASURED);
    }
}

/// The greatest true distance among the vertices that were moved most along normals, to the input, and of where they came from,
/// to the result.
fn lower(
    input: Triangles<'_>,
    (found, origins): (&Exact, &[Origin]),
    moved: &Moves,
) -> Result<f64, MeasureError> {
    let result = found.mesh.as_triangles();
    let (here, there): (Vec<_>, Vec<_>) = moved
        .most
        .iter()
        .map(|&vertex| {
            let (here, there) = (
                vector(found.mesh.positions()[vertex]),
                place(input, &origins[vertex]),
            );
            let far = here.distance(there);
            ((here, far), (there, far))
        })
        .unzip();
    Ok(greatest_distance(&here, input)?.max(greatest_distance(&there, result)?))
}

/// The greatest distance of some points from a surface that comes within a reach of each.
fn greatest_distance(points: &[(DVec3, f64)], surface: Triangles<'_>) -> Result<f64, MeasureError> {
    // Only triangles that come so near can be the closest.
    let reached = points.iter().map(|&(point, reach)| {
        let reach = reach * (1.0 + ROUNDING) + f64::MIN_POSITIVE;
        (point - reach, point + reach)
    });
    let reached: Vec<(DVec3, DVec3)> = reached.collect();
    let is_near = |[a, b, c]: [DVec3; 3], &(from, to): &(DVec3, DVec3)| {
        a.min(b).min(c).cmple(to).all() && from.cmple(a.max(b).max(c)).all()
    };
    let near = parallel::pieces(surface.triangles.len(), |faces| {
        let mut near = vec![Vec::new(); points.len()];
        for corners in faces.map(|face| surface.corners(face)) {
            for (near, reached) in near.iter_mut().zip(&reached) {
                if is_near(corners.map(vector), reached) {
                    near.push(corners);
                }
            }
        }
        near
    });
    let mut greatest = 0.0f64;
    for (at, &(point, _)) in points.iter().enumerate() {
        let near: Vec<[f64; 3]> = near
            .iter()
            .flat_map(|near| near[at].as_flattened())
            .copied()
            .collect();
        if near.is_empty() {
            continue;
        }
        let triangles: Vec<_> = (0..near.len() as u32 / 3)
            .map(|i| [3 * i, 3 * i + 1, 3 * i + 2])
            .collect();
        let near = Bvh::new(Triangles {
            positions: &near,
            triangles: &triangles,
        })?;
        greatest = greatest.max(near.closest(point.to_array()).distance);
    }
    Ok(greatest)
}

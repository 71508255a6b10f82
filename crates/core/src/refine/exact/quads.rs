//! Quads of a refined mesh of quads: pairs of triangles over one quad of the control mesh that are as near to the surface when they are
//! cut by their other diagonal.

use core::ops::Range;

use super::super::adaptive::rounding;
use super::super::exact_result::Exact;
use super::super::{RefineError, Traced};
use crate::certificate::{QuadPieces, exceeds};
use crate::index::{FaceId, HalfEdgeId};
use crate::limit_surface::LimitSurface;
use crate::mesh::Mesh;
use crate::progress::{Observer, SharedWatch, Stage, unobserved};
use crate::scheme::Scheme;
use crate::vector::{DVec3, vector};

/// The greatest cosine of a corner's angle, on either side: that of 30° and of 150°.
const FLATTEST: f64 = 0.866_025_403_784_438_6;

/// Control quads of one call between two looks at the observer.
const POLLED: usize = 64;

/// Pairs of triangles that quads can replace, by the two half-edges between them: each pair lies over one quad of the control mesh, and
/// cut by its other diagonal it is within [`ErrorBounds::upper`](super::super::ErrorBounds::upper), too. The bilinear surface of a quad
/// lies between both. Of several ways to pair triangles, quads of the control mesh's own directions come first, then those with
/// the best angles. Other goals than distances, such as angles, are met by the triangles alone.
///
/// `exact` is a result for `control` and `scheme`, with origins. There are none without them, without quads in the control mesh, and where
/// edges were collapsed.
///
/// ```
/// use limitmesh::mesh::{BuildOptions, PolygonSoup};
/// use limitmesh::refine::{ExactOptions, exact, quads};
/// use limitmesh::{QuadControl, scheme::CatmullClark};
///
/// let corner = |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -1.0 } else { 1.0 });
/// let mut cube = PolygonSoup { positions: (0..8).map(corner).collect(), ..Default::default() };
/// let faces = [[0u32, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
/// faces.iter().for_each(|face| cube.faces.push(face));
/// let control = QuadControl::from_soup(&cube, &BuildOptions::default())?.0.mesh;
/// let refined = exact(&control, &CatmullClark, &ExactOptions::default().tolerance(0.05))?;
/// assert!(!quads(&refined, &control, &CatmullClark)?.is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A control vertex has no limit.
pub fn quads(
    exact: &Exact,
    control: &Mesh,
    scheme: &dyn Scheme,
) -> Result<Vec<[HalfEdgeId; 2]>, RefineError> {
    quads_observed(exact, control, scheme, &mut unobserved)
}

/// [`quads`], with an observer.
///
/// # Errors
/// Those of [`quads`], or the observer asked to stop.
pub fn quads_observed(
    exact: &Exact,
    control: &Mesh,
    scheme: &dyn Scheme,
    observer: &mut Observer<'_>,
) -> Result<Vec<[HalfEdgeId; 2]>, RefineError> {
    let is_known = exact.parents.len() == exact.mesh.face_count() && !exact.origins.is_empty();
    if !control.topology().has_quads() || exact.is_collapsed() || !is_known {
        return Ok(Vec::new());
    }
    let watch = SharedWatch::new(observer, Stage::Bounding);
    let rounding = rounding(control, exact.statistics.levels, &watch)?;
    let pairing = Pairing {
        exact,
        triangles: control.triangles(),
        surface: LimitSurface::without_normals(control, scheme)?,
        limit: exact.error.upper - rounding,
    };
    let mut faces: Vec<[u32; 2]> = (0..)
        .zip(&exact.parents)
        .map(|(face, parent)| [parent / 2, face])
        .collect();
    faces.sort_unstable();
    let groups: Vec<&[[u32; 2]]> = faces.chunk_by(|a, b| a[0] == b[0]).collect();
    let found = watch.long_pieces(groups.len(), POLLED, |some: Range<usize>, is_stopped| {
        let some = some.take_while(|_| !is_stopped());
        some.flat_map(|at| pairing.of_quad(groups[at]))
            .collect::<Vec<_>>()
    })?;
    Ok(found.concat())
}

struct Pairing<'a> {
    exact: &'a Exact,
    triangles: &'a [[u32; 3]],
    surface: LimitSurface<'a>,
    /// The greatest bound of the triangles beyond the other diagonal.
    limit: f64,
}

/// Two triangles that share an edge, with their corners, from one end of the edge on.
struct Pair {
    between: [HalfEdgeId; 2],
    places: [[f64; 2]; 4],
    points: [DVec3; 4],
    /// Whether its edges run along the control quad's directions.
    is_cell: bool,
    /// The greatest cosine of an angle.
    flatness: f64,
}

impl Pairing<'_> {
    /// The pairs over a control quad, whose triangles these are.
    fn of_quad(&self, faces: &[[u32; 2]]) -> Vec<[HalfEdgeId; 2]> {
        let corners = faces
            .iter()
            .flat_map(|&[_, face]| [0, 1, 2].map(|corner| HalfEdgeId::of(FaceId(face), corner)));
        let mut pairs: Vec<Pair> = corners.filter_map(|h| self.pair(h)).collect();
        // Bits of numbers that are not below 0 have their order.
        pairs.sort_by_key(|pair| (!pair.is_cell, pair.flatness.to_bits(), pair.between[0]));
        let Some(&[quad, _]) = faces.first() else {
            return Vec::new();
        };
        let halves = [0, 1].map(|half| self.surface.patch(FaceId(2 * quad + half)));
        let pieces = QuadPieces { halves };
        let off = self.off(quad, faces);
        let mut is_free = vec![true; faces.len()];
        let mut found = Vec::new();
        for pair in pairs {
            let place = |h: HalfEdgeId| faces.partition_point(|&[_, face]| face < h.face().0);
            let [first, second] = pair.between.map(place);
            let is_on = !exceeds(off[first].max(off[second]), self.limit);
            if is_on && is_free[first] && is_free[second] && self.is_near(&pair, &pieces) {
                (is_free[first], is_free[second]) = (false, false);
                found.push(pair.between);
            }
        }
        found
    }

    /// The pair beside an edge, from its half-edge with the smaller number: convex on the control quad and in space.
    fn pair(&self, h: HalfEdgeId) -> Option<Pair> {
        let (mesh, parents) = (&self.exact.mesh, &self.exact.parents);
        let twin = mesh.topology().twin(h).filter(|&twin| h < twin)?;
        let [own, other] = [h, twin].map(|h| parents[h.face().index()] / 2);
        if own != other {
            return None;
        }
        let corners = [twin.next(), twin.next().next(), h.next(), h.next().next()];
        let [a, b, c, d] = corners.map(|corner| self.place(corner));
        let places = [a?, b?, c?, d?];
        let points = corners.map(|corner| {
            let vertex = mesh.topology().origin(corner);
            vector(mesh.positions()[vertex.index()])
        });
        let is_convex = |i: usize| {
            let [before, at, after] = [i + 3, i, i + 1].map(|i| places[i % 4]);
            let ([x, y], [u, v]) = (minus(at, before), minus(after, at));
            x * v > y * u
        };
        let mut normals = [DVec3::ZERO; 4];
        let mut flatness = 0.0f64;
        for (i, normal) in normals.iter_mut().enumerate() {
            let [to, from] = [1, 3].map(|step| points[(i + step) % 4] - points[i]);
            *normal = to.cross(from);
            flatness = flatness.max((to.dot(from) / (to.length() * from.length())).abs());
        }
        let mean: DVec3 = normals.iter().sum();
        let is_folded = normals.iter().any(|normal| exceeds(0.0, normal.dot(mean)));
        if !(0..4).all(is_convex) || is_folded || exceeds(flatness, FLATTEST) {
            return None;
        }
        let is_along = |i: usize| minus(places[(i + 1) % 4], places[i]).contains(&0.0);
        Some(Pair {
            between: [h, twin],
            places,
            points,
            is_cell: (0..4).all(is_along),
            flatness,
        })
    }

    /// The place of a corner on its control quad.
    fn place(&self, corner: HalfEdgeId) -> Option<[f64; 2]> {
        let origin = self.exact.corner_origin(self.triangles, corner)?;
        let [_, u, v] = origin.barycentric;
        Some(match origin.face % 2 {
            0 => [u, v],
            _ => [1.0 - u, 1.0 - v],
        })
    }

    /// By triangle over a control quad, the greatest distance of its corners from their places on the surface.
    fn off(&self, quad: u32, faces: &[[u32; 2]]) -> Vec<f64> {
        let mut off = vec![0.0f64; faces.len()];
        for half in [2 * quad, 2 * quad + 1] {
            let (mut corners, mut places) = (Vec::new(), Vec::new());
            let own = faces.iter().enumerate();
            for (at, &[_, face]) in
                own.filter(|(_, own)| self.exact.parents[own[1] as usize] == half)
            {
                for h in [0, 1, 2].map(|corner| HalfEdgeId::of(FaceId(face), corner)) {
                    if let Some(origin) = self.exact.corner_origin(self.triangles, h) {
                        corners.push((at, self.exact.mesh.topology().origin(h)));
                        places.push(origin.barycentric);
                    }
                }
            }
            let points = self.surface.over(FaceId(half), &places);
            for ((at, vertex), point) in corners.into_iter().zip(points) {
                let own = vector(self.exact.mesh.positions()[vertex.index()]);
                off[at] = off[at].max(own.distance(vector(point.position)));
            }
        }
        off
    }

    /// Whether the surface is near to a pair that is cut by the other diagonal.
    fn is_near(&self, pair: &Pair, pieces: &QuadPieces) -> bool {
        [[0, 1, 3], [1, 2, 3]].into_iter().all(|half: [usize; 3]| {
            let triangle = half.map(|i| pair.points[i]);
            let places = half.map(|i| pair.places[i]);
            let bound = pieces.bound(triangle, places, self.limit, self.surface.rules());
            !exceeds(bound, self.limit)
        })
    }
}

fn minus([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
    [a - c, b - d]
}

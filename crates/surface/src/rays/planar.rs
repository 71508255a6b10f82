//! A regular piece relative to a ray: whether the ray can meet it, at most once, and where.
//!
//! Points are in the ray's frame: x and y across, z along it, so the ray is the z axis, and all is
//! decided in the plane.

use crate::geometry::box_tree::{NO_BOUNDS, grown};
use crate::math;
use crate::patch::polynomial::{Net, Polynomial};
use crate::vector::DVec3;

/// Points are off by this part of the surface's size at most.
pub(super) const ROUNDING: f64 = 1e-14;

/// Products of differences are off by this part of their greatest at most.
const PRODUCT_ROUNDING: f64 = 1e-12;

/// Newton's steps before a piece is divided.
const MOST_STEPS: usize = 12;

/// Places count as of a piece up to so far outside, as weights: those of two neighbours overlap, so that nothing gets lost between them.
const OUTSIDE: f64 = 1e-9;

/// Whether a line in the plane has all points of a net on one side, and the origin on the other. Lines along the axes and the
/// diagonals are tried, and along the sides of a triangle.
pub(super) fn is_beside(
    points: impl Iterator<Item = DVec3> + Clone,
    corners: Option<[DVec3; 3]>,
) -> bool {
    let (mut low, mut high) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
    for p in points.clone() {
        for (way, along) in [p.x, p.y, p.x + p.y, p.x - p.y].into_iter().enumerate() {
            (low[way], high[way]) = (low[way].min(along), high[way].max(along));
        }
    }
    if (0..4).any(|way| low[way] > ROUNDING || high[way] < -ROUNDING) {
        return true;
    }
    let Some(corners) = corners else { return false };
    (0..3).any(|edge| {
        let [a, b] = [corners[edge], corners[(edge + 1) % 3]];
        let across = DVec3::new(b.y - a.y, a.x - b.x, 0.0);
        let rounding = 4.0 * ROUNDING * across.abs().max_element();
        let along = points.clone().map(|p| p.x * across.x + p.y * across.y);
        let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        low > rounding || high < -rounding
    })
}

/// How the projection along the ray treats a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Projection {
    /// No two places fall on one point, so the ray meets it once at most.
    Injective,
    /// The projection is a line within rounding.
    EdgeOn,
    /// It may fold over.
    Any,
}

/// By cross products of the derivatives' nets: a difference between two places of a piece is a sum of averages of both, so that it
/// does not vanish where all products have one sign.
pub(super) fn projection(net: &impl Net) -> Projection {
    let tangents = net.tangents();
    let [along, across] = tangents.each_ref().map(|net| net.as_ref());
    let greatest = |net: &[DVec3]| {
        net.iter()
            .map(|by| by.x.abs().max(by.y.abs()).max(by.z.abs()))
            .fold(0.0, f64::max)
    };
    let rounding = PRODUCT_ROUNDING * greatest(along) * greatest(across) + ROUNDING * ROUNDING;
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for a in along {
        for b in across {
            let product = a.x * b.y - a.y * b.x;
            (low, high) = (low.min(product), high.max(product));
        }
    }
    match () {
        () if low > rounding || high < -rounding => Projection::Injective,
        () if low >= -rounding && high <= rounding => Projection::EdgeOn,
        () => Projection::Any,
    }
}

/// Where the ray meets a piece.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting {
    /// The weights of the piece's second and third corner.
    pub(super) at: [f64; 2],
    /// Along the ray.
    pub(super) depth: f64,
    /// Whether the front is met.
    pub(super) is_front: bool,
}

/// Where the ray meets an injective piece with these corners, by Newton's method; `None` where that does not converge
/// to a point of the piece, which does not prove that there is none.
pub(super) fn meeting(polynomial: &Polynomial, corners: [DVec3; 3]) -> Option<Meeting> {
    let [mut u, mut v] = on_triangle(corners).unwrap_or([1.0 / 3.0; 2]);
    for _ in 0..MOST_STEPS {
        let point = polynomial.point(u, v);
        let [by_u, by_v] = polynomial.tangents(u, v);
        let jacobian = by_u.x * by_v.y - by_u.y * by_v.x;
        let (du, dv) = (
            (point.x * by_v.y - point.y * by_v.x) / jacobian,
            (by_u.x * point.y - by_u.y * point.x) / jacobian,
        );
        if !(du.is_finite() && dv.is_finite()) {
            return None;
        }
        (u, v) = (u - du, v - dv);
        if du.abs().max(dv.abs()) < 1e-12 {
            let inside = u.min(v).min(1.0 - u - v) >= -OUTSIDE;
            let (u, v) = (u.clamp(0.0, 1.0), v.clamp(0.0, 1.0));
            let v = v.min(1.0 - u);
            let depth = polynomial.point(u, v).z;
            // The ray runs along z: normals against it are those of the front.
            return inside.then_some(Meeting {
                at: [u, v],
                depth,
                is_front: jacobian < 0.0,
            });
        }
        // Far outside the polynomial says nothing of the piece.
        if !(-1.0..=2.0).contains(&u) || !(-1.0..=2.0).contains(&v) {
            return None;
        }
    }
    None
}

/// Where the ray meets a triangle's plane, as weights of the second and third corner, if that is in the triangle.
fn on_triangle([a, b, c]: [DVec3; 3]) -> Option<[f64; 2]> {
    let (ab, ac) = (b - a, c - a);
    let area = ab.x * ac.y - ab.y * ac.x;
    let (u, v) = (
        (a.y * ac.x - a.x * ac.y) / area,
        (a.x * ab.y - a.y * ab.x) / area,
    );
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then_some([u, v])
}

/// The greatest side of a box around points.
pub(super) fn extent(points: impl Iterator<Item = DVec3>) -> f64 {
    let [low, high] = points.fold(NO_BOUNDS, grown);
    (high - low).max_element()
}

/// The place on the edges of a triangle that is nearest to the ray, where several are the first along it: its weights of the second and the third
/// corner, how far along the ray, and how far from it.
pub(super) fn nearest_on_edges(corners: [DVec3; 3], rounding: f64) -> ([f64; 2], f64, f64) {
    let mut best = ([0.0; 2], f64::INFINITY, f64::INFINITY);
    for edge in 0..3 {
        let (from, to) = (corners[edge], corners[(edge + 1) % 3]);
        let way = to - from;
        let squared = way.x * way.x + way.y * way.y;
        let part = if squared > 0.0 {
            -(from.x * way.x + from.y * way.y) / squared
        } else {
            0.0
        };
        let part = part.clamp(0.0, 1.0);
        let point = from + part * way;
        let distance = math::hypot(point.x, point.y);
        let is_better =
            distance < best.2 - rounding || distance < best.2 + rounding && point.z < best.1;
        if is_better {
            let mut weights = [0.0; 3];
            (weights[edge], weights[(edge + 1) % 3]) = (1.0 - part, part);
            best = ([weights[1], weights[2]], point.z, distance);
        }
    }
    best
}

//! A triangle of the result among its neighbours: section 2 of docs/certificate.md, and the conditions of section 3.

use std::f64::consts::PI;

use crate::mesh::{Mesh, NONE, next};
use crate::vector::{Vector, add, cross, dot, length, middle, scale, sub};

/// Unit roundoff.
pub const ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// Base angles of flaps are at most so large, and by this part smaller than they may be, for rounding; and the least tangent of one.
const MOST_ANGLE: f64 = 80.0 / 180.0 * PI;
const SHRINK: f64 = 1e-4;
const LEAST_TAN: f64 = 1.0 / 256.0;

/// How often a curve is halved at most.
const MOST_HALVINGS: usize = 24;

/// What the triangles of a mesh have in common.
pub struct Frames<'a> {
    pub result: &'a Mesh,
    pub twins: &'a [u32],
    /// The length that is claimed, and what rounding may do to the points of hulls.
    pub within: f64,
    pub rounding: f64,
}

/// A triangle with its flaps.
pub struct Triangle {
    pub corners: [Vector; 3],
    /// What points must be within.
    within: f64,
    /// None of a triangle without area.
    plane: Option<Plane>,
    edges: [Edge; 3],
    /// The corners of Q.
    flaps: Vec<Vector>,
}

struct Plane {
    normal: Vector,
    /// What rounding may do to distances from it.
    rounding: f64,
}

struct Edge {
    length: f64,
    along: Vector,
    outwards: Vector,
    joined: Option<Fold>,
}

/// The other triangle at a joined edge.
struct Fold {
    normal: Vector,
    outwards: Vector,
    /// The tangents of the base angles, at the start and the end of the edge: of this triangle's flap, and of the other's.
    out: [f64; 2],
    back: [f64; 2],
    sigma: f64,
    /// cos(θ/2).
    half_cos: f64,
    /// What rounding may do to distances from either plane.
    rounding: f64,
    /// What points of the curve must be within as Lemma 3 sees them, and how far they may leave the lens.
    within: f64,
    slack: f64,
}

impl Frames<'_> {
    fn corners(&self, t: u32) -> [Vector; 3] {
        self.result.triangles[t as usize].map(|v| self.result.positions[v as usize])
    }

    fn plane(&self, [a, b, c]: [Vector; 3]) -> Option<Plane> {
        let longest = [sub(b, a), sub(c, b), sub(a, c)].map(length).into_iter().fold(0.0, f64::max);
        let normal = cross(sub(b, a), sub(c, b));
        let area = length(normal);
        let rounding = 64.0 * ROUNDOFF * (longest + self.within) * longest * longest / area;
        (rounding <= self.within / 64.0).then(|| Plane { normal: scale(normal, 1.0 / area), rounding })
    }

    /// The angle at a half-edge's origin.
    fn angle(&self, h: u32) -> f64 {
        let corners = self.corners(h / 3);
        let [v, b, c] = [h, next(h), next(next(h))].map(|h| corners[h as usize % 3]);
        let (to_b, to_c) = (sub(b, v), sub(c, v));
        length(cross(to_b, to_c)).atan2(dot(to_b, to_c))
    }

    /// A triangle of the result.
    pub fn triangle(&self, t: u32) -> Triangle {
        let corners = self.corners(t);
        let plane = self.plane(corners);
        let mut flaps = Vec::with_capacity(6);
        let edges = [0, 1, 2].map(|i: u32| {
            let from = corners[i as usize];
            let way = sub(corners[next(i) as usize], from);
            let along = scale(way, 1.0 / length(way));
            let outwards = plane.as_ref().map_or([0.0; 3], |plane| cross(along, plane.normal));
            let joined = plane.as_ref().and_then(|plane| self.fold(3 * t + i, plane, way));
            flaps.push(from);
            if let Some(fold) = &joined {
                let tip = length(way) * fold.out[1] / (fold.out[0] + fold.out[1]);
                flaps.push(add(from, scale(add(along, scale(outwards, fold.out[0])), tip)));
            }
            Edge { length: length(way), along, outwards, joined }
        });
        let own = plane.as_ref().map_or(0.0, |plane| plane.rounding);
        let folds = edges.iter().filter_map(|edge: &Edge| Some(edge.joined.as_ref()?.rounding));
        let within = self.within - self.rounding - folds.fold(own, f64::max);
        Triangle { corners, within, plane, edges, flaps }
    }

    /// The fold at a half-edge of a triangle, if that is joined.
    fn fold(&self, h: u32, plane: &Plane, way: Vector) -> Option<Fold> {
        let twin = Some(self.twins[h as usize]).filter(|&twin| twin != NONE)?;
        let Plane { normal, rounding } = self.plane(self.corners(twin / 3))?;
        let cos = dot(plane.normal, normal);
        let angles = [h, next(h), next(twin), twin].map(|h| self.angle(h));
        let tan = |i: usize| {
            let (own, others) = (angles[i], angles[(i + 2) % 4]);
            (others.min((PI - own) / 2.0).min(MOST_ANGLE) * (1.0 - SHRINK)).tan()
        };
        let (out, back) = ([tan(0), tan(1)], [tan(2), tan(3)]);
        let least = out[0].min(out[1]).min(back[0]).min(back[1]);
        let most = out[0].max(out[1]).max(back[0]).max(back[1]);
        let rounding = rounding.max(plane.rounding);
        let slack = 2.0 * (self.rounding + rounding) * (1.0 + most);
        let is_wide = least >= LEAST_TAN && length(way) * least * SHRINK >= 8.0 * slack;
        (cos > 0.0 && is_wide).then(|| Fold {
            normal,
            outwards: cross(normal, scale(way, 1.0 / length(way))),
            out,
            back,
            sigma: length(sub(normal, plane.normal)),
            half_cos: (0.5 + 0.5 * cos).sqrt(),
            rounding,
            within: self.within - self.rounding - rounding - slack / least,
            slack,
        })
    }
}

/// The point of a line segment that is nearest to a point.
fn on_segment(p: Vector, a: Vector, b: Vector) -> Vector {
    let way = sub(b, a);
    let share = dot(sub(p, a), way) / dot(way, way);
    if share > 0.0 { add(a, scale(way, share.min(1.0))) } else { a }
}

/// The point of a convex polygon, counter-clockwise around the normal, that is nearest to a point of its plane.
fn on_polygon(p: Vector, corners: &[Vector], normal: Vector) -> Vector {
    let sides = (0..corners.len()).map(|i| (corners[i], corners[(i + 1) % corners.len()]));
    let is_left = |(a, b): (Vector, Vector)| dot(cross(sub(b, a), sub(p, a)), normal) >= 0.0;
    if sides.clone().all(is_left) {
        return p;
    }
    let feet = sides.map(|(a, b)| on_segment(p, a, b));
    feet.min_by(|&a, &b| length(sub(p, a)).total_cmp(&length(sub(p, b)))).unwrap_or(p)
}

impl Triangle {
    /// Whether the gauge is small enough for some z in Q.
    pub fn is_inside(&self, p: Vector) -> bool {
        let Some(Plane { normal, .. }) = self.plane else {
            return (0..3).any(|edge| self.distance_to_edge(edge, p) <= self.within);
        };
        let height = dot(sub(p, self.corners[0]), normal);
        let beyond = |i: usize, z: Vector| dot(sub(z, self.corners[i]), self.edges[i].outwards);
        if height.abs() > self.within || (0..3).all(|i| beyond(i, p) <= 0.0) {
            return height.abs() <= self.within;
        }
        let foot = sub(p, scale(normal, height));
        let turned = |i: usize, z: Vector| {
            self.edges[i].joined.as_ref().map_or(0.0, |fold| fold.sigma * beyond(i, z).max(0.0))
        };
        let gauge = |z: Vector| length(sub(p, z)) + turned(0, z) + turned(1, z) + turned(2, z);
        length(sub(p, on_polygon(foot, &self.corners, normal))) <= self.within
            || gauge(on_polygon(foot, &self.flaps, normal)) <= self.within
    }

    /// Whether a curve whose hull these points are is near enough to an edge, in one of the two ways.
    pub fn is_along(&self, edge: usize, points: &[Vector]) -> bool {
        let fold = self.edges[edge].joined.as_ref();
        fold.is_some_and(|fold| points.iter().all(|&p| self.is_across(edge, fold, p)))
            || points.iter().all(|&p| self.distance_to_edge(edge, p) <= self.within)
    }

    /// The same for a curve by its Bézier points, halved as long as that helps.
    pub fn is_curve_along(&self, edge: usize, points: &[Vector; 5], halvings: usize) -> bool {
        let is_end_along = |i: usize| self.is_along(edge, &points[i..=i]);
        if self.is_along(edge, points) || halvings >= MOST_HALVINGS || !is_end_along(0) || !is_end_along(4) {
            return self.is_along(edge, points);
        }
        let (mut work, mut first, mut second) = (*points, *points, *points);
        for step in 1..5 {
            (0..5 - step).for_each(|i| work[i] = middle(work[i], work[i + 1]));
            (first[step], second[4 - step]) = (work[0], work[4 - step]);
        }
        [first, second].iter().all(|half| self.is_curve_along(edge, half, halvings + 1))
    }

    fn distance_to_edge(&self, edge: usize, p: Vector) -> f64 {
        length(sub(p, on_segment(p, self.corners[edge], self.corners[(edge + 1) % 3])))
    }

    /// The conditions of Lemma 3.
    fn is_across(&self, edge: usize, fold: &Fold, p: Vector) -> bool {
        let (from, edge, plane) = (sub(p, self.corners[edge]), &self.edges[edge], self.plane.as_ref());
        let along = dot(from, edge.along);
        let wide = |tan: [f64; 2]| (tan[0] * along).min(tan[1] * (edge.length - along)) + fold.slack;
        let is_good = |normal: Vector, outwards: Vector, out: [f64; 2], back: [f64; 2]| {
            let (height, beyond) = (dot(from, normal).abs(), dot(from, outwards));
            beyond <= wide(out)
                && -beyond <= wide(back)
                && height + fold.sigma * beyond.max(0.0) <= fold.within
                && height <= fold.within * fold.half_cos
        };
        plane.is_some_and(|plane| is_good(plane.normal, edge.outwards, fold.out, fold.back))
            && is_good(fold.normal, fold.outwards, fold.back, fold.out)
    }

    /// Whether a corner is near enough to where the surface has it.
    pub fn is_at_corner(&self, corner: usize, p: Vector) -> bool {
        length(sub(p, self.corners[corner])) <= self.within
    }
}

//! A triangle of the result among its neighbours: section 2 of docs/certificate.md, and the conditions of section 3.

use crate::mesh::{Mesh, NONE, next};
use crate::vector::{Vector, add, cross, dot, length, middle, scale, sub};

/// Unit roundoff.
pub const ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// The greatest tangent of a base angle, that of 80°; by which part they are smaller than they may be, for rounding; and the least.
const MOST_TAN: f64 = 5.67;
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

/// A joined edge.
struct Fold {
    /// As this triangle sees the edge, and the other one.
    sides: [Side; 2],
    sigma: f64,
    /// cos(θ/2).
    half_cos: f64,
    /// What rounding may do to distances from either plane.
    rounding: f64,
    /// What points of the curve must be within as Lemma 3 sees them, and how far they may leave the lens.
    within: f64,
    slack: f64,
}

struct Side {
    normal: Vector,
    outwards: Vector,
    /// The tangents of the base angles at the start and the end of the edge: of this side's flap, and of the other's.
    out: [f64; 2],
    back: [f64; 2],
}

impl Frames<'_> {
    fn corners(&self, t: u32) -> [Vector; 3] {
        self.result.triangles[t as usize].map(|v| self.result.positions[v as usize])
    }

    fn plane(&self, [a, b, c]: [Vector; 3]) -> Option<Plane> {
        let longest = [sub(b, a), sub(c, b), sub(a, c)]
            .map(length)
            .into_iter()
            .fold(0.0, f64::max);
        // In units of the longest edge, so that no square is too large or too small; and of no such edge.
        let normal = cross(
            scale(sub(b, a), 1.0 / longest),
            scale(sub(c, b), 1.0 / longest),
        );
        let area = length(normal);
        let rounding = 64.0 * ROUNDOFF * (longest + self.within) / area;
        let is_good = (1e-120..1e120).contains(&longest) && rounding <= self.within / 64.0;
        is_good.then(|| Plane {
            normal: scale(normal, 1.0 / area),
            rounding,
        })
    }

    /// The tangents of the angle at a half-edge's origin, and of half of what it leaves of 180°.
    fn tangents(&self, h: u32) -> [f64; 2] {
        let corners = self.corners(h / 3);
        let [v, b, c] = [h, next(h), next(next(h))].map(|h| corners[h as usize % 3]);
        let [to_b, to_c] = [sub(b, v), sub(c, v)].map(|way| scale(way, 1.0 / length(way)));
        let (sine, cosine) = (length(cross(to_b, to_c)), dot(to_b, to_c));
        let own = if cosine > 0.0 {
            sine / cosine
        } else {
            f64::INFINITY
        };
        [own, (1.0 + cosine) / sine]
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
            let outwards = plane
                .as_ref()
                .map_or([0.0; 3], |plane| cross(along, plane.normal));
            let joined = plane
                .as_ref()
                .and_then(|plane| self.fold(3 * t + i, plane, way));
            flaps.push(from);
            if let Some(fold) = &joined {
                let [start, end] = fold.sides[0].out;
                let tip = add(along, scale(outwards, start));
                flaps.push(add(from, scale(tip, length(way) * end / (start + end))));
            }
            Edge {
                length: length(way),
                along,
                outwards,
                joined,
            }
        });
        let own = plane.as_ref().map_or(0.0, |plane| plane.rounding);
        let folds = edges
            .iter()
            .filter_map(|edge: &Edge| Some(edge.joined.as_ref()?.rounding));
        let within = self.within - self.rounding - folds.fold(own, f64::max);
        Triangle {
            corners,
            within,
            plane,
            edges,
            flaps,
        }
    }

    /// The fold at a half-edge of a triangle, if that is joined.
    fn fold(&self, h: u32, plane: &Plane, way: Vector) -> Option<Fold> {
        let twin = Some(self.twins[h as usize]).filter(|&twin| twin != NONE)?;
        let Plane { normal, rounding } = self.plane(self.corners(twin / 3))?;
        let cos = dot(plane.normal, normal);
        let tangents = [h, next(h), next(twin), twin].map(|h| self.tangents(h));
        let tan =
            |i: usize| tangents[(i + 2) % 4][0].min(tangents[i][1]).min(MOST_TAN) * (1.0 - SHRINK);
        let (out, back) = ([tan(0), tan(1)], [tan(2), tan(3)]);
        let least = [1, 2, 3].iter().fold(tan(0), |least, &i| least.min(tan(i)));
        let along = scale(way, 1.0 / length(way));
        let rounding = rounding.max(plane.rounding);
        let slack = 2.0 * (self.rounding + rounding) * (1.0 + MOST_TAN);
        let is_wide = least >= LEAST_TAN && length(way) * least * SHRINK >= 8.0 * slack;
        let own = Side {
            normal: plane.normal,
            outwards: cross(along, plane.normal),
            out,
            back,
        };
        let other = Side {
            normal,
            outwards: cross(normal, along),
            out: back,
            back: out,
        };
        (cos > 0.0 && is_wide).then(|| Fold {
            sides: [own, other],
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
    if share > 0.0 {
        add(a, scale(way, share.min(1.0)))
    } else {
        a
    }
}

/// The point of a convex polygon, counter-clockwise around the normal, that is nearest to a point of its plane.
fn on_polygon(p: Vector, corners: &[Vector], normal: Vector) -> Vector {
    let sides = (0..corners.len()).map(|i| (corners[i], corners[(i + 1) % corners.len()]));
    let is_left = |(a, b): (Vector, Vector)| dot(cross(sub(b, a), sub(p, a)), normal) >= 0.0;
    if sides.clone().all(is_left) {
        return p;
    }
    let feet = sides.map(|(a, b)| on_segment(p, a, b));
    feet.min_by(|&a, &b| length(sub(p, a)).total_cmp(&length(sub(p, b))))
        .unwrap_or(p)
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
            self.edges[i]
                .joined
                .as_ref()
                .map_or(0.0, |fold| fold.sigma * beyond(i, z).max(0.0))
        };
        let gauge = |z: Vector| length(sub(p, z)) + turned(0, z) + turned(1, z) + turned(2, z);
        length(sub(p, on_polygon(foot, &self.corners, normal))) <= self.within
            || gauge(on_polygon(foot, &self.flaps, normal)) <= self.within
    }

    /// Whether a curve whose hull these points are is near enough to an edge, in one of the two ways.
    pub fn is_along(&self, edge: usize, points: &[Vector]) -> bool {
        let fold = self.edges[edge].joined.as_ref();
        fold.is_some_and(|fold| points.iter().all(|&p| self.is_across(edge, fold, p)))
            || points
                .iter()
                .all(|&p| self.distance_to_edge(edge, p) <= self.within)
    }

    /// The same for a curve by its Bézier points, halved as long as that helps.
    pub fn is_curve_along(&self, edge: usize, points: &[Vector; 5], halvings: usize) -> bool {
        let is_end_along = |i: usize| self.is_along(edge, &points[i..=i]);
        if self.is_along(edge, points) {
            return true;
        }
        if halvings >= MOST_HALVINGS || !is_end_along(0) || !is_end_along(4) {
            return false;
        }
        let (mut work, mut first, mut second) = (*points, *points, *points);
        for step in 1..5 {
            (0..5 - step).for_each(|i| work[i] = middle(work[i], work[i + 1]));
            (first[step], second[4 - step]) = (work[0], work[4 - step]);
        }
        [first, second]
            .iter()
            .all(|half| self.is_curve_along(edge, half, halvings + 1))
    }

    fn distance_to_edge(&self, edge: usize, p: Vector) -> f64 {
        length(sub(
            p,
            on_segment(p, self.corners[edge], self.corners[(edge + 1) % 3]),
        ))
    }

    /// The conditions of Lemma 3.
    fn is_across(&self, edge: usize, fold: &Fold, p: Vector) -> bool {
        let (from, edge) = (sub(p, self.corners[edge]), &self.edges[edge]);
        let along = dot(from, edge.along);
        let wide =
            |tan: [f64; 2]| (tan[0] * along).min(tan[1] * (edge.length - along)) + fold.slack;
        fold.sides.iter().all(|side| {
            let (height, beyond) = (dot(from, side.normal).abs(), dot(from, side.outwards));
            beyond <= wide(side.out)
                && -beyond <= wide(side.back)
                && height + fold.sigma * beyond.max(0.0) <= fold.within
                && height <= fold.within * fold.half_cos
        })
    }

    /// Whether a corner is near enough to where the surface has it.
    pub fn is_at_corner(&self, corner: usize, p: Vector) -> bool {
        length(sub(p, self.corners[corner])) <= self.within
    }
}

//! The characteristic map of an irregular vertex inside the surface: the shape that every piece there tends to, but for
//! an affine map.
//!
//! It is the limit of the subdominant eigenvectors of refinement. For valence k, w = e^(2πi/k) and
//! λ = 3/8 + cos(2π/k)/4 the ring stands at the powers of w and the vertex at 0; the vertex a opposite to it beyond
//! the edge from 1 to w obeys λa = (3/8)(1 + w) + a/8, and the one b beyond 1 obeys
//! λb = 10/16 + (w + w̄ + a + aw̄ + b)/16. The map is mirrored by each edge and by each bisector, so that these run
//! straight; it scales by λ from level to level, so that a sector is its outer three regular pieces, their copies
//! shrunk by powers of λ, and 0: the hull of 0 and the outer pieces' Bézier points holds it all.

use super::bezier_triangle::{BezierTriangle, EDGES};
use super::extraordinary::ExtraordinaryPatch;
use super::normal_net::{cross_products, tangents};
use crate::math;
use crate::vector::DVec3;

/// The map over one face of a vertex, with points in the plane z = 0.
#[derive(Clone, Debug)]
pub struct Characteristic {
    /// The control points as one refinement scales them by λ.
    pub control: ExtraordinaryPatch,
    /// The face's sector, and its halves on either side of the bisector.
    pub sectors: [MapSector; 3],
    /// The greatest sum of the weights of the five control points beyond the ring, anywhere over the face.
    pub outer_share: f64,
    /// The least coefficient of the Jacobian of its three regular pieces, by differences of their nets.
    pub(crate) least_jacobian: f64,
    /// The greatest coordinates of these differences.
    pub(crate) steepest: [f64; 2],
}

/// Points that hold the map over a sector.
#[derive(Clone, Debug, Default)]
pub struct MapSector {
    /// Their hull holds all of it but 0.
    pub hull: Vec<DVec3>,
    /// Their hull holds the rim, the edge opposite to the vertex.
    pub rim: Vec<DVec3>,
    /// From 0 to here runs the edge at which the sector starts, counter-clockwise.
    pub start: DVec3,
    /// From 0 to here runs the edge at which the sector ends.
    pub end: DVec3,
}

impl Characteristic {
    /// The map for a valence of at least 3.
    pub fn of(valence: usize) -> Self {
        let turn = core::f64::consts::TAU / valence as f64;
        let power = |j: f64| DVec3::new(math::cos(turn * j), math::sin(turn * j), 0.0);
        let eigenvalue = 0.375 + 0.25 * math::cos(turn);
        let between = 0.375 * (power(0.0) + power(1.0)) / (eigenvalue - 0.125);
        let rotated = |p: DVec3, j: f64| {
            let by = power(j);
            DVec3::new(p.x * by.x - p.y * by.y, p.x * by.y + p.y * by.x, 0.0)
        };
        let around = power(1.0) + power(-1.0) + between + rotated(between, -1.0);
        let past = (0.625 * power(0.0) + 0.0625 * around) / (eigenvalue - 0.0625);
        let control = ExtraordinaryPatch {
            corner: 0,
            at: DVec3::ZERO,
            ring: (0..valence).map(|j| power(j as f64)).collect(),
            outer: [
                rotated(between, -1.0),
                past,
                between,
                rotated(past, 1.0),
                rotated(between, 1.0),
            ],
        };
        // The vertex stays at 0 whatever its weights are.
        let refined = control.refined(0.0);
        let [first, second, middle] =
            [1, 2, 3].map(|part| BezierTriangle::of(&refined.regular(part)));
        let (mut least_jacobian, mut steepest) = (f64::INFINITY, DVec3::ZERO);
        for net in [&first, &second, &middle] {
            let tangents = tangents(net);
            steepest = tangents
                .as_flattened()
                .iter()
                .fold(steepest, |most, by| most.max(by.abs()));
            let jacobian = cross_products(&tangents).into_iter().map(|normal| normal.z);
            least_jacobian = jacobian.fold(least_jacobian, f64::min);
        }
        let rim = |net: &BezierTriangle| EDGES[1].map(|at| net.0[at]);
        let directions = [power(0.0), power(0.5), power(1.0)];
        let sector = |nets: &[&BezierTriangle], rim: Vec<DVec3>, start: DVec3, end: DVec3| {
            let points: Vec<DVec3> = nets.iter().flat_map(|net| net.0).collect();
            let along = |direction: DVec3| {
                let on_line = points
                    .iter()
                    .filter(|p| direction.cross(**p).length() < ON_LINE);
                on_line.map(|p| p.dot(direction)).fold(0.0, f64::max) * direction
            };
            MapSector {
                start: along(start),
                end: along(end),
                rim,
                hull: hull(&points),
            }
        };
        let sectors = [
            sector(
                &[&first, &middle, &second],
                [rim(&first), rim(&second)].concat(),
                directions[0],
                directions[2],
            ),
            sector(
                &[&first, &middle.half(1, true)],
                rim(&first).to_vec(),
                directions[0],
                directions[1],
            ),
            sector(
                &[&middle.half(1, false), &second],
                rim(&second).to_vec(),
                directions[1],
                directions[2],
            ),
        ];
        let outer_share = outer_share(valence);
        Self {
            control,
            sectors,
            outer_share,
            least_jacobian,
            steepest: [steepest.x, steepest.y],
        }
    }
}

/// A bound of what the five control points beyond the ring weigh together. Their weights are the function with control points of 1 there
/// and 0 elsewhere: no more than the net points of the three regular pieces, nor than the control points of what is left at the vertex,
/// whatever the weights of the vertex are, as all of its ring are 0.
fn outer_share(valence: usize) -> f64 {
    let ring = (0..valence).map(|_| DVec3::ZERO).collect();
    let weights = ExtraordinaryPatch {
        corner: 0,
        at: DVec3::ZERO,
        ring,
        outer: [DVec3::X; 5],
    };
    let refined = weights.refined(0.0);
    let nets = [1, 2, 3].map(|part| BezierTriangle::of(&refined.regular(part)));
    let points = nets
        .iter()
        .flat_map(|net| net.0)
        .chain(refined.own().points());
    ROUNDED_UP * points.map(|point| point.x).fold(0.0, f64::max)
}

/// More than rounding takes away.
const ROUNDED_UP: f64 = 1.0 + 1e-12;

/// Points of the map within this of a line through 0 lie on it, but for rounding.
const ON_LINE: f64 = 1e-9;

/// The corners of the hull of points in the plane and 0, without 0 (Andrew's monotone chain).
fn hull(points: &[DVec3]) -> Vec<DVec3> {
    let mut sorted: Vec<DVec3> = points.iter().copied().chain([DVec3::ZERO]).collect();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let mut chain: Vec<DVec3> = Vec::new();
    for turn in 0..2 {
        let start = chain.len();
        for at in 0..sorted.len() {
            let next = sorted[if turn == 0 { at } else { sorted.len() - 1 - at }];
            while let [.., a, b] = chain[start..]
                && (b - a).cross(next - a).z <= 0.0
            {
                chain.pop();
            }
            chain.push(next);
        }
        chain.pop();
    }
    chain.retain(|&corner| corner != DVec3::ZERO);
    chain
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::Patch;

    /// Brute force: the eigenvector is refined by the masks alone.
    #[test]
    fn refinement_scales_the_control_points() {
        for valence in 3..40 {
            let map = Characteristic::of(valence);
            let eigenvalue = 0.375 + 0.25 * (core::f64::consts::TAU / valence as f64).cos();
            let Patch::Extraordinary(refined) = map.control.refined(0.0).part(0) else {
                panic!()
            };
            for (fine, coarse) in refined.points().zip(map.control.points()) {
                assert!(
                    fine.distance(eigenvalue * coarse) < 1e-13,
                    "valence {valence}"
                );
            }
        }
    }

    /// Whether a point lies in the hull of 0 and the corners, which go round it.
    fn holds(sector: &MapSector, point: DVec3) -> bool {
        let corners: Vec<DVec3> = [DVec3::ZERO]
            .into_iter()
            .chain(sector.hull.iter().copied())
            .collect();
        let n = corners.len();
        let mut turned = corners.clone();
        // The chain starts at the least point; 0 may stand anywhere in it.
        turned.sort_by(|a, b| {
            let centre = corners.iter().sum::<DVec3>() / n as f64;
            let angle = |p: &DVec3| (p.y - centre.y).atan2(p.x - centre.x);
            angle(a).total_cmp(&angle(b))
        });
        (0..n).all(|i| (turned[(i + 1) % n] - turned[i]).cross(point - turned[i]).z > -1e-9)
    }

    /// Brute force: what the outer points weigh at dense places, by refinement alone.
    #[test]
    fn outer_points_weigh_no_more_than_their_share() {
        let rules = crate::patch::Rules::of(&crate::scheme::Loop);
        for valence in (3..32).filter(|&valence| valence != 6) {
            let share = Characteristic::of(valence).outer_share;
            let ring = (0..valence).map(|_| DVec3::ZERO).collect();
            let weights = ExtraordinaryPatch {
                corner: 0,
                at: DVec3::ZERO,
                ring,
                outer: [DVec3::X; 5],
            };
            let mut pieces = vec![Patch::Extraordinary(Box::new(weights))];
            let mut greatest = 0.0f64;
            for _ in 0..5 {
                let mut next = Vec::new();
                for piece in &pieces {
                    let refined = piece.refined(&rules);
                    (0..3)
                        .for_each(|edge| greatest = greatest.max(refined.middle(edge).position.x));
                    next.extend((0..4).map(|part| refined.part(part)));
                }
                pieces = next;
            }
            assert!(
                greatest <= share && greatest > 0.8 * share,
                "valence {valence}: {greatest} {share}"
            );
        }
    }

    #[test]
    fn sectors_hold_the_map() {
        for valence in 3..30 {
            let map = Characteristic::of(valence);
            let mut patch = map.control.clone();
            for _ in 0..6 {
                let refined = patch.refined(0.0);
                for part in 1..4 {
                    let net = BezierTriangle::of(&refined.regular(part));
                    let corners = net.corners();
                    for corner in corners {
                        assert!(holds(&map.sectors[0], corner), "valence {valence}");
                        let [first, second] = [1, 2].map(|half| holds(&map.sectors[half], corner));
                        assert!(first || second, "valence {valence}");
                    }
                }
                let Patch::Extraordinary(next) = refined.part(0) else {
                    panic!()
                };
                patch = *next;
            }
            // Edges and bisectors run straight, and the outer ends are the farthest points.
            let [whole, first, second] = &map.sectors;
            assert_eq!((whole.start, whole.end), (first.start, second.end));
            assert!(first.end.distance(second.start) < 1e-12);
            assert!(first.end.length() > 0.1 && first.start.y == 0.0);
            assert!(whole.hull.len() < 16, "{}", whole.hull.len());
            assert!(
                map.least_jacobian > 0.0,
                "valence {valence}: {}",
                map.least_jacobian
            );
        }
    }
}

//! Single precision against the same quantities of each part alone in double precision, by other
//! code.

use super::*;
use crate::certificate::TriangleFrame;
use crate::certificate::quartic_cell::quadratic_height;
use crate::vector::DVec3;
use limitmesh_testing::Random;

/// A part: its corners, the limit normals there, and the second derivatives along its edges.
struct Part {
    corners: [DVec3; 3],
    normals: [DVec3; 3],
    bends: [DVec3; 3],
}

impl Part {
    /// Any shape but the thinnest; bends of a quadratic that may be nearly of one direction.
    fn random(random: &mut Random, case: usize, size: f64) -> Self {
        let thin = 10f64.powi(-(case as i32 % 5));
        let first = random.vector();
        let along = random.vector().normalize();
        let across = along.cross(random.vector()).normalize();
        let second = first + along;
        let third = first + random.signed() * along + thin * (0.6 + 0.5 * random.signed()) * across;
        let corners = if case.is_multiple_of(2) {
            [first, second, third]
        } else {
            [second, third, first]
        };
        let normal = (corners[1] - corners[0])
            .cross(corners[2] - corners[0])
            .normalize();
        let edges = [0, 1, 2].map(|edge| corners[(edge + 1) % 3] - corners[edge]);
        // By a quadratic form within the plane, one of whose directions may bend next to nothing.
        let size = size * thin;
        let less = [1.0, -0.5, 1e-3, 1e-5, 1e-7, 1e-9, 0.0][case % 7] * random.signed();
        let turn = (3.0 * random.signed()).sin_cos();
        let directions = [
            along * turn.0 + across * turn.1,
            across * turn.0 - along * turn.1,
        ];
        let aside = 3.0 * random.vector().reject_from_normalized(normal);
        let bends = edges.map(|edge| {
            let [x, y] = directions.map(|direction| direction.dot(edge));
            size * ((x * x + less * y * y) * normal + x * y * aside)
        });
        let normal_deviation = 0.05 * random.signed();
        let normals = [0; 3].map(|_| (normal + normal_deviation * random.vector()).normalize());
        Self {
            corners,
            normals,
            bends,
        }
    }
}

/// The rows of some parts.
fn rows(parts: &[Part], is_turned: bool) -> [[[f32; WIDTH]; 3]; 8] {
    let mut rows = [[[0.0; WIDTH]; 3]; 8];
    for (
        i,
        Part {
            corners: [a, b, c],
            normals,
            bends,
        },
    ) in parts.iter().enumerate()
    {
        let edges = if is_turned {
            [a - b, a - c]
        } else {
            [b - a, c - a]
        };
        let all = edges.into_iter().chain(*normals).chain(*bends);
        for (row, vector) in rows.iter_mut().zip(all) {
            (0..3).for_each(|axis| row[axis][i] = vector[axis] as f32);
        }
    }
    rows
}

#[test]
fn single_precision_is_on_the_safe_side() {
    let mut random = Random::new(3);
    let (mut compared, mut round_ones, mut tight) = (0, 0, 0);
    for round in 0..3000 {
        // Parts of a row are much alike.
        let size = 10f64.powf(-3.0 + 2.0 * random.signed());
        let parts: Vec<Part> = (0..8)
            .map(|i| Part::random(&mut random, 35 * i + round, size))
            .collect();
        let rows = rows(&parts, round % 2 == 1);
        let slices = |row: usize| rows[row].each_ref().map(|axis| &axis[..]);
        let input = Parts {
            edges: [slices(0), slices(1)],
            is_turned: round % 2 == 1,
            normals: [slices(2), slices(3), slices(4)],
            bends: [slices(5), slices(6), slices(7)],
            size: above(
                parts
                    .iter()
                    .flat_map(|part| part.bends)
                    .map(|w| w.abs().element_sum())
                    .fold(0.0, f64::max),
            ),
        };
        let rest = Remainder {
            height: 1e-6,
            curve: 2e-7,
            steep: 1e-6,
            first: 3e-6,
        };
        let target = RowTarget {
            distance: 1.0,
            range_share: 0.0,
            normal_deviation: 0.1,
            slope: f64::INFINITY,
            displacement_share: 0.41,
        };
        let mut found = Found::default();
        measure(8, &input, &rest, &target, &mut found);
        for (
            i,
            Part {
                corners,
                normals,
                bends,
            },
        ) in parts.iter().enumerate()
        {
            let frame = TriangleFrame::new(*corners);
            let height = quadratic_height(bends.map(|bend| bend.dot(frame.normal())));
            let normal_deviation = normals
                .iter()
                .map(|n| n.distance(frame.normal()))
                .fold(0.0, f64::max);
            let (mut displacement, mut displacement_slope, mut reach) = (0.0f64, 0.0f64, 0.0f64);
            for (edge, bend) in bends.iter().enumerate() {
                let out = -bend.dot(frame.outward(edge));
                let along = bend.dot(frame.along(edge)).abs();
                let steep = f64::from(rest.steep);
                let room = frame.length(edge) - 0.5 * along - steep;
                displacement = displacement.max(0.125 * out);
                reach = reach.max(0.125 * out * frame.length(edge));
                let slope = if room > 0.0 {
                    (0.5 * out.abs() + steep) / room
                } else {
                    f64::INFINITY
                };
                displacement_slope = displacement_slope.max(slope);
            }
            let chord = normal_deviation + target.normal_deviation;
            let seen = bends.map(|bend| bend.dot(frame.normal()).abs());
            let bend = seen.into_iter().fold(0.0, f64::max);
            // What reaches over an edge has at most this share of the corner opposite.
            let value = |displacement: f64, share: f64| {
                let height = height + f64::from(rest.height);
                let (reach, curve) = (displacement + f64::from(rest.curve), f64::from(rest.curve));
                let at_edges = 0.125 * bend + curve + share * (bend + f64::from(rest.first));
                let among = at_edges.min(height) * (1.0 + 0.5 * chord * chord) + chord * reach;
                among.max(height)
            };
            let lengths = [0, 1, 2].map(|edge| frame.length(edge));
            let shortest = lengths.into_iter().fold(f64::INFINITY, f64::min);
            let lowest = (0..3)
                .map(|edge| frame.altitude(edge))
                .fold(f64::INFINITY, f64::min);
            let bound = f64::from(found.bound[i]);
            if bound == f64::INFINITY {
                continue;
            }
            compared += 1;
            let least = value(displacement, displacement / lowest.max(shortest));
            assert!(
                bound >= least,
                "round {round}, {i}: {bound:e}, not {least:e}"
            );
            assert!(
                f64::from(found.normal_deviation[i]) >= normal_deviation
                    && f64::from(found.slope[i]) <= frame.least_slope()
            );
            assert!(
                f64::from(found.displacement_slope[i]) >= displacement_slope,
                "round {round}, {i}"
            );
            // And not far off.
            if round % 5 == 0 {
                round_ones += 1;
                tight += usize::from(
                    bound <= 1.05 * value(reach / shortest, 2.0 * reach / shortest / lowest)
                        && f64::from(found.low[i]) >= 0.99 * height - 1.1e-6,
                );
            }
        }
    }
    assert!(
        compared > 10_000 && tight > round_ones * 9 / 10,
        "{compared}, {tight} of {round_ones}"
    );
}

/// The greatest height of a quadratic, by all places where it can be, is never above the reported
/// one.
#[test]
fn heights_of_nearly_cylindrical_quadratics_are_no_less_than_they_are() {
    let mut random = Random::new(7);
    for case in 0..200_000 {
        let small = 10f64.powf(-(case as f64 % 9.0)) * random.signed();
        let (x, y) = (random.signed(), random.signed());
        let form = |[s, t]: [f64; 2]| (x * s + y * t).powi(2) + small * (y * s - x * t).powi(2);
        let sign = if case % 2 == 0 { 1.0 } else { -1.0 };
        let bends = [[1.0, 0.0], [-1.0, 1.0], [0.0, -1.0]].map(|edge| (sign * form(edge)) as f32);
        let expected = quadratic_height(bends.map(f64::from));
        let (low, high) = heights(bends.map(f32x4::splat));
        let [low, high] = [low, high].map(|height| f64::from(height.to_array()[0]));
        assert!(high >= expected, "{bends:?}: {high:e}, not {expected:e}");
        assert!(
            low <= expected * 1.001 && high <= expected * 1.02,
            "{bends:?} {low} {high} {expected}"
        );
    }
}

/// Nor is NaN.
#[test]
fn what_has_no_bound_is_within_nothing() {
    for distance in [1.0, f64::MAX, f64::INFINITY] {
        let target = RowTarget {
            distance,
            range_share: 0.0,
            normal_deviation: 0.1,
            slope: f64::INFINITY,
            displacement_share: 0.41,
        };
        let mut found = Found::default();
        (found.bound[0], found.bound[1]) = (f32::INFINITY, f32::NAN);
        let (mut extent, mut marks) = (RowExtent::NONE, [Mark::Passes; 3]);
        found.mark(1e30, &target, &mut extent, &mut marks);
        assert_eq!(marks, [Mark::Open, Mark::Open, Mark::Passes], "{distance}");
    }
}

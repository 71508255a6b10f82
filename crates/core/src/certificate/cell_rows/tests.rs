//! Rows against dense samples of each part alone.

use super::*;
use crate::certificate::TriangleFrame;
use crate::patch::bezier_triangle::BezierTriangle;
use limitmesh_testing::Random;

/// A bent piece over a sheared triangle.
fn piece(random: &mut Random, noise: f64) -> Quartic {
    let mut points = [DVec3::ZERO; 15];
    let mut at = 0;
    for k in 0..5 {
        for j in 0..5 - k {
            let stir = random.vector() * noise;
            let (x, y) = (j as f64 / 4.0 + 0.2 * k as f64 / 4.0, k as f64 / 4.0);
            points[at] = DVec3::new(x, y, 0.2 * (x * x + 0.5 * x * y - y * y)) + stir;
            at += 1;
        }
    }
    Quartic::of(&BezierTriangle(points), 0)
}

#[test]
fn samples_of_parts_that_pass_lie_within_the_target() {
    samples_lie_within(0.0);
}

/// The ranges of heights, where these count in addition to the greatest.
#[test]
fn ranges_of_heights_of_parts_that_pass_lie_within_the_target() {
    samples_lie_within(0.95);
}

fn samples_lie_within(range_share: f64) {
    let mut random = Random::new(5);
    let mut uneven = 0;
    let (mut passed, mut failed, mut open) = (0, 0, 0);
    for round in 0..60 {
        let piece = piece(&mut random, [0.0, 0.01, 0.03][round % 3]);
        let jet = QuarticJet::of(&piece);
        let (at, size) = if round % 2 == 0 {
            ([0.0, 0.0], 1.0)
        } else {
            ([0.5, 0.5], -0.5)
        };
        let block = RowBlock::of(&piece, &jet, at, size);
        let divisions = 1 + (round % 4) as u32;
        let n = 1usize << divisions;
        let step = size / n as f64;
        let distance = 0.03 * (1.0 + range_share) * step * step * (1.0 + 0.5 * random.signed());
        let target = RowTarget {
            distance,
            range_share,
            normal_deviation: 0.2,
            slope: f64::INFINITY,
            displacement_share: 0.3,
        };
        let mut extent = RowExtent::NONE;
        let mut marks = Marks::default();
        CellRows::default().test(&block, divisions, &target, &mut extent, &mut marks);
        for j in 0..n {
            for i in 0..n - j {
                for is_inverted in [false, true] {
                    if is_inverted && i + j + 1 >= n {
                        continue;
                    }
                    let (i, j) = (i as f64, j as f64);
                    let corners = if is_inverted {
                        [[i + 1.0, j + 1.0], [i, j + 1.0], [i + 1.0, j]]
                    } else {
                        [[i, j], [i + 1.0, j], [i, j + 1.0]]
                    };
                    let domain = corners.map(|[i, j]| [at[0] + step * i, at[1] + step * j]);
                    let frame = TriangleFrame::new(domain.map(|[u, v]| piece.point(u, v)));
                    let (mut low, mut high, mut at_edges) = (0.0f64, 0.0f64, Vec::new());
                    for a in 0..=12 {
                        for b in 0..=12 - a {
                            let (b, c) = (f64::from(a) / 12.0, f64::from(b) / 12.0);
                            let place = [0, 1].map(|x| {
                                domain[0][x]
                                    + b * (domain[1][x] - domain[0][x])
                                    + c * (domain[2][x] - domain[0][x])
                            });
                            let point = piece.point(place[0], place[1]);
                            let height = frame.height(point);
                            (low, high) = (low.min(height), high.max(height));
                            // The weights of the corners opposite to the edges.
                            for (edge, weight) in [c, 1.0 - b - c, b].into_iter().enumerate() {
                                let outside = frame.edge_position(edge, point).outside;
                                if weight < 1e-9 || outside > 0.0 {
                                    at_edges.push((height.abs(), outside.max(0.0)));
                                }
                            }
                        }
                    }
                    let (highest, range) = (high.max(-low), range_share * (high - low));
                    let normal_deviations =
                        domain.map(|[u, v]| piece.normal(u, v).distance(frame.normal()));
                    let normal_deviation = normal_deviations.into_iter().fold(0.0, f64::max);
                    match marks.at(i as usize, j as usize, is_inverted) {
                        Mark::Passes => {
                            passed += 1;
                            let chord = normal_deviation + target.normal_deviation;
                            let at_edge = |&(height, outside): &(f64, f64)| {
                                height * (1.0 + 0.5 * chord * chord) + chord * outside
                            };
                            let value = at_edges.iter().map(at_edge).fold(highest, f64::max);
                            assert!(value <= distance, "round {round}: {value} of {distance}");
                            // Of ranges only the quadratic part is used.
                            let rest = 2.0 * block.rest(step.abs());
                            assert!(
                                range <= 1.001 * distance + rest,
                                "round {round}: {range}, {distance}"
                            );
                            assert!(
                                normal_deviation <= extent.normal_deviation
                                    && frame.least_slope() >= extent.slope * (1.0 - 1e-9)
                            );
                        }
                        Mark::Fails => {
                            let rest = 2.0 * block.rest(step.abs());
                            failed += 1;
                            uneven += usize::from(highest < 0.98 * distance);
                            let counted = if highest < 0.98 * distance {
                                range + rest
                            } else {
                                highest
                            };
                            assert!(
                                counted > 0.98 * distance,
                                "round {round}: {counted} of {distance}"
                            );
                        }
                        Mark::Open => open += 1,
                    }
                }
            }
        }
    }
    assert!(
        passed > 500 && failed > 500 && open > 0,
        "{passed} {failed} {open}"
    );
    if range_share > 0.0 {
        assert!(uneven > 100, "{uneven}")
    } else {
        assert_eq!(uneven, 0)
    }
}

/// The bound of their rounding holds against the polynomial in double precision, at sizes from 1e-9
/// to 1e9.
#[test]
fn bends_are_off_by_ten_roundings_of_their_size_at_most() {
    let mut random = Random::new(11);
    let (mut greatest, ten) = (0.0f64, 10.0 / f64::from(1u32 << 24));
    for round in 0..400 {
        let size = 10f64.powi(round % 19 - 9);
        let c: [DVec3; 6] = from_fn(|_| size * random.vector().powf(3.0));
        let (u, v) = (random.signed(), random.signed());
        let (step, count) = (0.1 * random.signed(), 1 + round as usize % 65);
        let mut bends = Bends {
            along: [[0.0; WIDTH]; 3],
            size: 0.0,
        };
        bends.fill(&c, [u, v], step, count, 0.3);
        let most = f64::from(bends.size);
        for i in 0..count {
            let expected = 0.3 * quadratic(&c, [u + step * i as f64, v]);
            let found = DVec3::from_array([0, 1, 2].map(|axis| f64::from(bends.along[axis][i])));
            assert!(
                expected.abs().element_sum() <= most * (1.0 + 1e-6),
                "round {round}"
            );
            greatest = greatest.max((found - expected).abs().element_sum() / most);
        }
    }
    assert!(greatest <= ten, "{greatest:e}");
    assert!(greatest > 0.01 * ten, "{greatest:e}");
}

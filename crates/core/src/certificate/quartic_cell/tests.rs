//! Bounds of parts of regular pieces against dense samples, and proofs of the two constants.

use super::heights::halved;
use super::*;
use crate::patch::bezier_triangle::BezierTriangle;
use limitmesh_testing::Random;

/// A piece whose points are the unit triangle's, stirred and bent.
fn piece(random: &mut Random, noise: f64) -> Quartic {
    Quartic::of(&stirred_triangle(random, noise), 0)
}

fn stirred_triangle(random: &mut Random, noise: f64) -> BezierTriangle {
    let mut points = [DVec3::ZERO; 15];
    let mut at = 0;
    for k in 0..5 {
        for j in 0..5 - k {
            let stir = random.vector() * noise;
            points[at] =
                DVec3::new(j as f64 / 4.0 + 0.3 * k as f64 / 4.0, k as f64 / 4.0, 0.0) + stir;
            at += 1;
        }
    }
    BezierTriangle(points)
}

fn cell(random: &mut Random) -> Cell {
    let size = 0.5f64.powi((4.0 * random.signed().abs()) as i32);
    let [u, v] = [0.4 * random.signed().abs(), 0.4 * random.signed().abs()];
    let turned = if random.signed() > 0.0 { 1.0 } else { -1.0 };
    let corners = [[u, v], [u + turned * size, v], [u, v + turned * size]];
    match (4.0 * random.signed().abs()) as u32 {
        0 => Cell([corners[0], corners[1], halfway(corners[1], corners[2])]),
        1 => Cell([
            halfway(corners[0], corners[2]),
            corners[1],
            halfway(corners[1], corners[2]),
        ]),
        _ => Cell(corners),
    }
}

const GRID: usize = 60;

/// Barycentric coordinates all over a triangle.
fn grid(n: usize) -> impl Iterator<Item = [f64; 3]> {
    (0..=n).flat_map(move |j| {
        (0..=n - j).map(move |i| {
            let (b, c) = (i as f64 / n as f64, j as f64 / n as f64);
            [1.0 - b - c, b, c]
        })
    })
}

fn place(cell: &Cell, weights: [f64; 3]) -> Domain {
    [0, 1].map(|axis| (0..3).map(|i| weights[i] * cell.0[i][axis]).sum())
}

#[test]
fn dense_samples_lie_within_the_bounds() {
    let mut random = Random::new(3);
    let (mut tight, mut counted, mut closer) = (0, 0, 0);
    // Edges whose curves are lower than the surface inside, and those whose bounds are not far above the truth.
    let (mut lower, mut near) = (0, 0);
    for round in 0..3000 {
        let piece = piece(&mut random, [0.002, 0.02, 0.1, 0.4][round % 4]);
        let (jet, cell) = (QuarticJet::of(&piece), cell(&mut random));
        let frame = TriangleFrame::new(cell.0.map(|[u, v]| piece.point(u, v)));
        if frame.is_flat() {
            continue;
        }
        let heights = jet.heights(&cell, frame.normal());
        let (low, high) = heights.range();
        let refined = heights.refined(2, 0.0);
        let open = [false, true, false];
        let at_first = jet.edge_bounds(&cell, &frame, open);
        let edges = [
            at_first,
            jet.closer_edge_bounds(&at_first, &cell, &frame, open),
        ];
        closer += usize::from(edges[0].is_loose() && !edges[1].is_loose());
        let deviation = edges[usize::from(round % 3 > 0)].deviation(high.min(refined));
        let (mut highest, mut farthest) = (0.0f64, 0.0f64);
        // By edge, how far points reach over it, and how high these and those of the curve stand.
        let (mut outside, mut at_edges) = ([0.0f64; 3], [0.0f64; 3]);
        for weights in grid(GRID) {
            let [u, v] = place(&cell, weights);
            let point = piece.point(u, v);
            highest = highest.max(frame.height(point).abs());
            farthest = farthest.max(frame.squared(point).sqrt());
            for edge in 0..3 {
                let beyond = frame.edge_position(edge, point).outside;
                outside[edge] = outside[edge].max(beyond);
                if beyond > 0.0 || weights[(edge + 2) % 3] == 0.0 {
                    at_edges[edge] = at_edges[edge].max(frame.height(point).abs());
                }
                // A point of the curve.
                if weights[(edge + 2) % 3] == 0.0 {
                    let from_edge = frame.squared_to_edge(edge, point).sqrt();
                    assert!(
                        from_edge <= deviation.own + 1e-12,
                        "round {round}, edge {edge}"
                    );
                    if edge == 1 {
                        assert!(
                            from_edge <= deviation.height + 1e-12,
                            "round {round}, open edge"
                        );
                    }
                }
            }
        }
        let slack = 1e-12;
        assert!(
            highest <= high + slack && highest <= refined + slack,
            "round {round}: {highest} {high}"
        );
        assert!(
            low <= highest * 1.003 + slack,
            "round {round}: {low} {highest}"
        );
        assert!(
            farthest <= deviation.own + slack,
            "round {round}: {farthest} {deviation:?}"
        );
        if deviation.steepest().is_finite() {
            for edge in [0, 2] {
                let case =
                    format!("round {round}, edge {edge}: {outside:?} {at_edges:?} {deviation:?}");
                assert!(
                    outside[edge] <= deviation.displacements[edge] + slack,
                    "{case}"
                );
                assert!(
                    at_edges[edge] <= deviation.edge_heights[edge] + slack,
                    "{case}"
                );
                lower += usize::from(at_edges[edge] < 0.9 * deviation.height);
                near += usize::from(deviation.edge_heights[edge] <= 1.2 * at_edges[edge] + 1e-9);
            }
        }
        counted += 1;
        tight += usize::from(refined.min(high) <= 1.06 * highest + 1e-9);
    }
    assert!(
        counted > 2500 && tight * 10 > counted * 9,
        "{tight} of {counted}"
    );
    assert!(closer > 100, "{closer}");
    assert!(lower > 2000 && near > 1200, "{lower} {near}");
}

/// Where a part is said not to fold, its projection on the triangle's plane keeps its orientation everywhere, for slim triangles too;
/// and where it does not keep it, the part is said to fold.
#[test]
fn parts_that_do_not_fold_keep_their_orientation() {
    let mut random = Random::new(23);
    let (mut plain, mut bent, mut folding) = (0, 0, 0);
    for round in 0..4000 {
        let BezierTriangle(points) =
            stirred_triangle(&mut random, [0.0, 0.002, 0.01, 0.1][round % 4]);
        let slim = [1.0, 0.3, 0.05][round % 3];
        // Bends that keep their size all over the piece, relative to the random part.
        let bend: [[f64; 3]; 3] =
            core::array::from_fn(|_| core::array::from_fn(|_| 0.6 * random.signed()));
        let points = points.map(|point| {
            let squares = [point.x * point.x, point.x * point.y, point.y * point.y];
            let along = |axis: usize| (0..3).map(|i| bend[axis][i] * squares[i]).sum::<f64>();
            DVec3::new(
                point.x + along(0),
                slim * (point.y + along(1)),
                point.z + along(2),
            )
        });
        let piece = Quartic::of(&BezierTriangle(points), 0);
        let (jet, cell) = (QuarticJet::of(&piece), cell(&mut random));
        let frame = TriangleFrame::new(cell.0.map(|[u, v]| piece.point(u, v)));
        if frame.is_flat() {
            continue;
        }
        // Upright parts and inverted ones turn alike.
        let least = grid(24).map(|weights| {
            let [u, v] = place(&cell, weights);
            let [by_u, by_v] = piece.tangents(u, v);
            by_u.cross(by_v).dot(frame.normal())
        });
        let Cell([at, second, last]) = cell;
        let (s, r) = (minus(second, at), minus(last, at));
        let turn = (s[0] * r[1] - s[1] * r[0]).signum();
        let least = least.map(|area| turn * area).fold(f64::INFINITY, f64::min);
        let edges = [0, 1, 2].map(|edge| (cell.0[edge], cell.0[(edge + 1) % 3]));
        let bends = edges.map(|(from, to)| jet.bend(halfway(from, to), minus(to, from)));
        let reach = s
            .iter()
            .chain(&r)
            .fold(0.0f64, |reach, x| reach.max(x.abs()));
        let (third, fourth) = jet.most(reach.max((s[0] - r[0]).abs()).max((s[1] - r[1]).abs()));
        let rest = frame.stretch() * (0.5 * third + QUARTIC_SLOPE * fourth);
        let is_plain = jet.part(&cell).inside(&frame, &bends).turn < NEARLY_ONE;
        assert!(!is_plain || least > 0.0, "round {round}: {least}");
        assert!(
            is_plain || super::turn(&frame, &bends, rest) >= NEARLY_ONE,
            "round {round}: closer, but less sure"
        );
        plain += usize::from(is_plain);
        folding += usize::from(least <= 0.0);
        let [a, b, c] = cell.0.map(|[u, v]| piece.point(u, v));
        let even = (b - a).cross(c - a).length() / (s[0] * r[1] - s[1] * r[0]).abs();
        bent += usize::from(is_plain && least < 0.6 * even);
    }
    // Many of each kind, and many that are decided though they are far from even.
    assert!(
        plain > 800 && folding > 400 && bent > 40,
        "{plain} plain, {bent} of them bent, {folding} folding"
    );
}

/// Triangles whose corners were moved off the surface: heights over their planes, and how far the surface is from them, against
/// points of the surface.
#[test]
fn triangles_off_the_surface_are_bounded() {
    let mut random = Random::new(8);
    let (mut tight, mut counted) = (0, 0);
    for round in 0..2000 {
        let piece = piece(&mut random, [0.002, 0.02, 0.1][round % 3]);
        let (jet, cell) = (QuarticJet::of(&piece), cell(&mut random));
        let bases = cell.0.map(|[u, v]| piece.point(u, v));
        let size = 0.1 * bases[0].distance(bases[1]);
        let steps = bases.map(|_| random.vector() * size);
        let frame = TriangleFrame::new([0, 1, 2].map(|i| bases[i] + steps[i]));
        if frame.is_flat() {
            continue;
        }
        let heights = jet.heights(&cell, frame.normal());
        let lifts = steps.map(|step| -frame.normal().dot(step));
        let bound = heights.lifted(lifts, 2, 0.0);
        let aside = steps.map(|step| (step - frame.normal().dot(step) * frame.normal()).length());
        let aside = aside.into_iter().fold(0.0, f64::max);
        let moved = steps.map(DVec3::length).into_iter().fold(0.0, f64::max);
        let deviation = jet
            .edge_bounds(&cell, &frame, [false; 3])
            .deviation_off(bound, moved, aside);
        let (mut highest, mut farthest) = (0.0f64, 0.0f64);
        for weights in grid(GRID) {
            let [u, v] = place(&cell, weights);
            let point = piece.point(u, v);
            highest = highest.max(frame.height(point).abs());
            farthest = farthest.max(frame.squared(point).sqrt());
        }
        assert!(highest <= bound + 1e-12, "round {round}: {highest} {bound}");
        assert!(
            farthest <= deviation.own + 1e-12,
            "round {round}: {farthest} {deviation:?}"
        );
        counted += 1;
        tight += usize::from(bound <= 1.06 * highest);
    }
    assert!(
        counted > 1700 && tight * 10 > counted * 9,
        "{tight} of {counted}"
    );
}

/// The range over a plane off the corners: no point is beyond it, and some point is near to it.
#[test]
fn ranges_over_planes_off_the_corners_hold() {
    let mut random = Random::new(11);
    let mut tight = 0;
    for round in 0..3000 {
        let piece = piece(&mut random, [0.002, 0.02, 0.1, 0.4][round % 4]);
        let (jet, cell) = (QuarticJet::of(&piece), cell(&mut random));
        let frame = TriangleFrame::new(cell.0.map(|[u, v]| piece.point(u, v)));
        if frame.is_flat() {
            continue;
        }
        let heights = jet.heights(&cell, frame.normal());
        let size = [0.0, 1.0, 0.3][round % 3] * heights.range().1;
        let lifts = [0.0; 3].map(|_: f64| size * random.signed());
        let ((most, rest), (low, high, _)) = (heights.lifted_range(lifts), heights.about());
        let sampled = heights.sampled();
        for weights in grid(4) {
            let [u, v] = place(&cell, weights);
            let height = frame.height(piece.point(u, v));
            assert!(
                height <= sampled.1 + 1e-12 && height >= sampled.0 - 1e-12,
                "round {round}: {sampled:?}"
            );
        }
        let mut highest = 0.0f64;
        for weights in grid(GRID) {
            let [u, v] = place(&cell, weights);
            let height = frame.height(piece.point(u, v));
            let lift: f64 = (0..3).map(|i| weights[i] * lifts[i]).sum();
            highest = highest.max((height + lift).abs());
            assert!(
                low - rest - 1e-12 <= height && height <= high + rest + 1e-12,
                "round {round}"
            );
        }
        assert!(
            highest <= most + rest + 1e-12,
            "round {round}: {highest} {most} {rest}"
        );
        assert!(
            most - rest <= 1.003 * highest + 1e-12,
            "round {round}: {highest} {most} {rest}"
        );
        tight += usize::from(rest < 0.1 * most);
    }
    assert!(tight > 300, "{tight}");
}

/// The coefficients in Bernstein's basis of a polynomial of fourth degree at most, by its values: no more than rounding is lost.
fn net(value: impl Fn([f64; 3]) -> f64) -> [f64; 15] {
    let places: Vec<[f64; 3]> = grid(4).collect();
    let factorial = |n: f64| (1..=n as u32).map(f64::from).product::<f64>();
    let basis = |[a, b, c]: [f64; 3], [i, j, k]: [f64; 3]| {
        let [i, j, k] = [i, j, k].map(|x| (4.0 * x).round());
        24.0 / (factorial(i) * factorial(j) * factorial(k)) * a.powf(i) * b.powf(j) * c.powf(k)
    };
    let matrix =
        nalgebra::SMatrix::<f64, 15, 15>::from_fn(|row, of| basis(places[row], places[of]));
    let values = nalgebra::SVector::<f64, 15>::from_fn(|row, _| value(places[row]));
    let found = matrix.lu().solve(&values).unwrap();
    core::array::from_fn(|of| found[of])
}

/// Divisions of nets, whose coefficients bound polynomials: they are within some thousandths of them then.
const DIVISIONS: u32 = 5;

/// The rounding error of the sizes of coefficients here.
const SLACK: f64 = 1e-9;

/// The cubic part's constant: where the coordinates are in order the sum is a polynomial, and it is
/// equal in any order, so one sixth of the triangle decides.
#[test]
fn the_cubic_constant_holds() {
    let sum = |[a, b, c]: [f64; 3]| {
        [(a, b), (b, c), (c, a)]
            .into_iter()
            .map(|(x, y)| x * y * f64::abs(y - x))
            .sum::<f64>()
            / 12.0
    };
    let sixth = |[u, v, w]: [f64; 3]| sum([u / 3.0, u / 3.0 + 0.5 * v, u / 3.0 + 0.5 * v + w]);
    let net = net(sixth);
    for [u, v, w] in grid(9) {
        let turned = sum([u / 3.0 + 0.5 * v + w, u / 3.0, u / 3.0 + 0.5 * v]);
        assert!((turned - sixth([u, v, w])).abs() < 1e-15);
    }
    let most = halved(&net, 2 * DIVISIONS, 0.0);
    let greatest = grid(200).map(sum).fold(0.0, f64::max);
    assert!(
        greatest <= most && most + SLACK <= CUBIC,
        "{greatest} {most}"
    );
}

/// The quartic part's constant: r is linear in the five fourth derivatives, so at each place it is greatest in a vertex of the
/// polytope in which all six pairs are within ±1; and over the triangle the coefficients of each vertex's r bound it.
#[test]
fn the_quartic_constant_holds() {
    let forms = |f: [f64; 5]| {
        let [ssss, sssr, ssrr, srrr, rrrr] = f;
        let heights = Heights {
            ss: 0.0,
            sr: 0.0,
            rr: 0.0,
            sss: 0.0,
            ssr: 0.0,
            srr: 0.0,
            rrr: 0.0,
            ssss: ssss / 24.0,
            sssr: sssr / 6.0,
            ssrr: ssrr / 4.0,
            srrr: srrr / 6.0,
            rrrr: rrrr / 24.0,
        };
        let pairs = [
            ssss,
            rrrr,
            ssss - 4.0 * sssr + 6.0 * ssrr - 4.0 * srrr + rrrr,
            ssrr,
            ssss - 2.0 * sssr + ssrr,
            rrrr - 2.0 * srrr + ssrr,
        ];
        (heights, pairs)
    };
    // r of a unit of each fourth derivative: the polynomial without its quadratic and cubic part,
    // by the same formulas written for points.
    let rest = |f: [f64; 5], [_, s, r]: [f64; 3]| remainder(&forms(f).0, s, r);
    let units: [[f64; 5]; 5] =
        core::array::from_fn(|i| core::array::from_fn(|j| f64::from(u8::from(i == j))));
    let matrix: Vec<[f64; 5]> = (0..6)
        .map(|row| units.map(|unit| forms(unit).1[row]))
        .collect();
    let mut vertices = Vec::new();
    for left_out in 0..6 {
        let rows: Vec<&[f64; 5]> = (0..6)
            .filter(|&row| row != left_out)
            .map(|row| &matrix[row])
            .collect();
        for signs in 0..32u32 {
            let a = nalgebra::Matrix5::from_fn(|i, j| rows[i][j]);
            let b = nalgebra::Vector5::from_fn(|i, _| if signs >> i & 1 == 0 { 1.0 } else { -1.0 });
            let Some(x) = a.lu().solve(&b) else { continue };
            let f: [f64; 5] = core::array::from_fn(|i| x[i]);
            if forms(f).1.iter().all(|pair| pair.abs() <= 1.0 + 1e-9) {
                vertices.push(f);
            }
        }
    }
    assert!(vertices.len() >= 20, "{}", vertices.len());
    let (mut most, mut greatest, mut steepest) = (0.0f64, 0.0f64, 0.0f64);
    for &f in &vertices {
        // The derivative along an edge: differences like these are those of quartics.
        for [x, y] in [[1.0, 0.0], [-1.0, 1.0], [0.0, -1.0]] {
            let slope = |[_, s, r]: [f64; 3]| {
                let at = |step: f64| rest(f, [0.0, s + step * x, r + step * y]);
                (8.0 * (at(0.5) - at(-0.5)) - (at(1.0) - at(-1.0))) / 6.0
            };
            steepest = steepest.max(halved(&net(slope), 2 * DIVISIONS, 0.0));
        }
        most = most.max(halved(&net(|place| rest(f, place)), 2 * DIVISIONS, 0.0));
        greatest = grid(60)
            .map(|place| rest(f, place).abs())
            .fold(greatest, f64::max);
    }
    assert!(
        greatest <= most + SLACK && most + SLACK <= QUARTIC,
        "{greatest} {most}"
    );
    assert!(greatest > 0.9 * QUARTIC, "{greatest}");
    assert!(
        steepest + SLACK <= QUARTIC_SLOPE && steepest > 0.99 * QUARTIC_SLOPE,
        "{steepest}"
    );
}

/// Coefficients from values are those of the polynomial: cut finer, they close in on its greatest size.
#[test]
fn nets_are_of_their_polynomials() {
    let mut random = Random::new(21);
    for _ in 0..50 {
        let x: [f64; 5] = core::array::from_fn(|_| random.signed());
        let value = |[a, b, c]: [f64; 3]| {
            x[0] * a * a * b * c + x[1] * b.powi(4) + x[2] * a * c.powi(3) + x[3] * b * c + x[4] * a
        };
        let greatest = grid(64).map(|place| value(place).abs()).fold(0.0, f64::max);
        let most = halved(&net(value), 2 * DIVISIONS, 0.0);
        assert!(
            greatest <= most + SLACK && most <= 1.02 * greatest,
            "{greatest} {most}"
        );
    }
}

/// f − q − c at (s, r), the parts as the module's page gives them.
fn remainder(heights: &Heights, s: f64, r: f64) -> f64 {
    let Heights {
        ss,
        sr,
        rr,
        sss,
        ssr,
        srr,
        rrr,
        ssss,
        sssr,
        ssrr,
        srrr,
        rrrr,
    } = *heights;
    let (cs, cr) = (-(ss + sss + ssss), -(rr + rrr + rrrr));
    let f = cs * s
        + cr * r
        + ss * s * s
        + sr * s * r
        + rr * r * r
        + sss * s.powi(3)
        + ssr * s * s * r
        + srr * s * r * r
        + rrr * r.powi(3)
        + ssss * s.powi(4)
        + sssr * s.powi(3) * r
        + ssrr * s * s * r * r
        + srrr * s * r.powi(3)
        + rrrr * r.powi(4);
    // Derivatives by central differences of the polynomial would round; these are its own.
    let second = |[a, b]: [f64; 2], [s, r]: [f64; 2]| {
        let by_ss = 2.0 * ss
            + 6.0 * sss * s
            + 2.0 * ssr * r
            + 12.0 * ssss * s * s
            + 6.0 * sssr * s * r
            + 2.0 * ssrr * r * r;
        let by_rr = 2.0 * rr
            + 6.0 * rrr * r
            + 2.0 * srr * s
            + 12.0 * rrrr * r * r
            + 6.0 * srrr * s * r
            + 2.0 * ssrr * s * s;
        let by_sr = sr
            + 2.0 * ssr * s
            + 2.0 * srr * r
            + 3.0 * sssr * s * s
            + 4.0 * ssrr * s * r
            + 3.0 * srrr * r * r;
        a * a * by_ss + 2.0 * a * b * by_sr + b * b * by_rr
    };
    let third = |x: [f64; 2], y: [f64; 2], z: [f64; 2]| {
        let (s, r) = (1.0 / 3.0, 1.0 / 3.0);
        let by = [
            6.0 * sss + 24.0 * ssss * s + 6.0 * sssr * r,
            2.0 * ssr + 6.0 * sssr * s + 4.0 * ssrr * r,
            2.0 * srr + 4.0 * ssrr * s + 6.0 * srrr * r,
            6.0 * rrr + 6.0 * srrr * s + 24.0 * rrrr * r,
        ];
        let mut sum = 0.0;
        for i in 0..2 {
            for j in 0..2 {
                for k in 0..2 {
                    sum += by[i + j + k] * x[i] * y[j] * z[k];
                }
            }
        }
        sum
    };
    let edges = [[1.0, 0.0], [-1.0, 1.0], [0.0, -1.0]];
    let middles = [[0.5, 0.0], [0.5, 0.5], [0.0, 0.5]];
    let l = [1.0 - s - r, s, r];
    let mut rest = f;
    for i in 0..3 {
        let (a, b) = (l[i], l[(i + 1) % 3]);
        rest += 0.5 * a * b * second(edges[i], middles[i]);
        rest += third(edges[i], edges[i], edges[i]) / 12.0 * a * b * (b - a);
    }
    let [e1, e2, e3] = edges;
    let bubble = 0.25 * (third(e1, e1, e3) - third(e1, e1, e2))
        + (third(e2, e2, e2) - third(e3, e3, e3)) / 12.0;
    rest - bubble * l[0] * l[1] * l[2]
}

/// The decomposition is one: cubics leave no remainder.
#[test]
fn cubics_have_no_rest() {
    let mut random = Random::new(11);
    for _ in 0..100 {
        let mut x = || random.signed();
        let heights = Heights {
            ss: x(),
            sr: x(),
            rr: x(),
            sss: x(),
            ssr: x(),
            srr: x(),
            rrr: x(),
            ssss: 0.0,
            sssr: 0.0,
            ssrr: 0.0,
            srrr: 0.0,
            rrrr: 0.0,
        };
        for [_, s, r] in grid(9) {
            assert!(remainder(&heights, s, r).abs() < 1e-14);
        }
    }
}

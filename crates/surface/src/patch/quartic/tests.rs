use super::*;
use crate::patch::Patch;
use crate::patch::Rules;
use crate::patch::box_spline::Points;
use crate::scheme::Loop;

fn arbitrary(seed: f64) -> Points {
    from_fn(|i| {
        let t = i as f64 + seed;
        DVec3::new((t * 1.7).sin(), (t * t * 0.31).cos(), (t * 2.9 + 0.4).sin())
    })
}

/// A gently curved piece, whose normals are nowhere near vanishing.
fn gentle(seed: f64) -> Points {
    let bump = arbitrary(seed);
    from_fn(|i| {
        let (row, before) = [(0, 0), (1, 3), (2, 7), (3, 10)]
            .into_iter()
            .rfind(|&(_, first)| first <= i)
            .unwrap();
        let column = (i - before) as f64 - if row == 0 { 0.0 } else { 1.0 };
        DVec3::new(column, f64::from(row) - 1.0, 0.0) + 0.15 * bump[i]
    })
}

/// Parameters over the triangle, on its edges too.
fn places() -> impl Iterator<Item = (f64, f64)> {
    (0..=7).flat_map(|j| (0..=7 - j).map(move |i| (f64::from(i) / 7.0, f64::from(j) / 7.0)))
}

/// The point of a net by Bernstein's polynomials; `weights` by corner.
fn bernstein(net: &BezierTriangle, weights: [f64; 3]) -> DVec3 {
    let factorial = |n: usize| (1..=n).product::<usize>() as f64;
    let mut points = net.0.iter();
    let mut sum = DVec3::ZERO;
    for k in 0..5 {
        for j in 0..5 - k {
            let powers = [4 - j - k, j, k];
            let term = |corner: usize| {
                weights[corner].powi(powers[corner] as i32) / factorial(powers[corner])
            };
            sum += 24.0 * term(0) * term(1) * term(2) * *points.next().unwrap();
        }
    }
    sum
}

/// `[w, u, v]` counted from corner `first`, by the net's corners.
fn weights(first: usize, u: f64, v: f64) -> [f64; 3] {
    let mut weights = [1.0 - u - v, u, v];
    weights.rotate_right(first);
    weights
}

#[test]
fn points_are_those_of_the_net() {
    for seed in 0..5 {
        let net = BezierTriangle::of(&arbitrary(f64::from(seed)));
        for first in 0..3 {
            let quartic = Quartic::of(&net, first);
            for (u, v) in places() {
                let expected = bernstein(&net, weights(first, u, v));
                assert!(
                    quartic.point(u, v).distance(expected) < 3e-15,
                    "first {first} at {u}, {v}"
                );
            }
        }
    }
}

/// Limits of the new vertices of four refinements, by their masks.
#[test]
fn points_and_normals_are_limits_of_vertices() {
    let rules = Rules::of(&Loop);
    let points = gentle(0.0);
    let quartics = [0, 1, 2].map(|first| Quartic::of(&BezierTriangle::of(&points), first));
    let mut parts = vec![(
        Patch::Regular(points),
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    )];
    let half = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] { from_fn(|i| 0.5 * (a[i] + b[i])) };
    for _ in 0..4 {
        let mut next = Vec::new();
        for (patch, corners) in &parts {
            let refined = patch.refined(&rules);
            let middles: [_; 3] = from_fn(|edge| half(corners[edge], corners[(edge + 1) % 3]));
            for (edge, middle) in middles.iter().enumerate() {
                let expected = refined.middle(edge);
                for (first, quartic) in quartics.iter().enumerate() {
                    let [u, v] = [1, 2].map(|i| middle[(first + i) % 3]);
                    assert!(quartic.point(u, v).distance(expected.position) < 3e-15);
                    assert!(quartic.normal(u, v).distance(expected.normal) < 1e-12);
                }
            }
            for part in 0..4 {
                let of_part = if part == 3 {
                    [middles[1], middles[2], middles[0]]
                } else {
                    from_fn(|i| half(corners[part], corners[i]))
                };
                next.push((refined.part(part), of_part));
            }
        }
        parts = next;
    }
}

/// Five-point differences have no error on quartics.
#[test]
fn derivatives_are_differences() {
    const H: f64 = 0.25;
    let slope = |f: &dyn Fn(f64) -> DVec3| {
        (f(-2.0 * H) - 8.0 * f(-H) + 8.0 * f(H) - f(2.0 * H)) / (12.0 * H)
    };
    let bend = |f: &dyn Fn(f64) -> DVec3| {
        (16.0 * (f(-H) + f(H)) - (f(-2.0 * H) + f(2.0 * H)) - 30.0 * f(0.0)) / (12.0 * H * H)
    };
    let quartic = Quartic::of(&BezierTriangle::of(&arbitrary(3.0)), 1);
    for (u, v) in places() {
        let along_u = |t: f64| quartic.point(u + t, v);
        let along_v = |t: f64| quartic.point(u, v + t);
        let both = slope(&|t| slope(&|s| quartic.point(u + s, v + t)));
        let [by_u, by_v] = quartic.tangents(u, v);
        let near = |a: DVec3, b: DVec3| assert!(a.distance(b) < 1e-12, "{a} and {b} at {u}, {v}");
        near(by_u, slope(&along_u));
        near(by_v, slope(&along_v));
        let [by_uu, by_uv, by_vv] = quartic.second_derivatives(u, v);
        near(by_uu, bend(&along_u));
        near(by_uv, both);
        near(by_vv, bend(&along_v));
        let cross = slope(&along_u).cross(slope(&along_v));
        near(quartic.normal(u, v), cross / cross.length());
    }
}

#[test]
fn rows_are_points_bit_for_bit() {
    let quartic = Quartic::of(&BezierTriangle::of(&arbitrary(1.0)), 2);
    let bits = |p: [f64; 3]| p.map(f64::to_bits);
    for v in [0.0, 0.3, 0.8125] {
        for count in 0..70 {
            let (start, step) = (0.0625, 1.0 / 64.0);
            let mut bare = vec![[f64::NAN; 3]; count];
            let (mut points, mut normals) = (bare.clone(), bare.clone());
            quartic.points_along(v, start, step, &mut bare);
            quartic.points_and_normals_along(v, start, step, &mut points, &mut normals);
            for i in 0..count {
                let u = start + i as f64 * step;
                let (point, normal) = (
                    quartic.point(u, v).to_array(),
                    quartic.normal(u, v).to_array(),
                );
                assert_eq!(
                    [bare[i], points[i], normals[i]].map(bits),
                    [point, point, normal].map(bits),
                    "{i} of {count}"
                );
            }
        }
    }
}

#[test]
fn points_here_and_there_are_points_of_rows_bit_for_bit() {
    for factor in [1.0, 1e-90, 1e90] {
        let piece = Quartic::of(&BezierTriangle::of(&gentle(0.7).map(|p| factor * p)), 1);
        let places: Vec<_> = places().collect();
        for four in places.as_chunks::<4>().0 {
            let (u, v) = (four.map(|place| place.0), four.map(|place| place.1));
            let [points, normals] = piece.points_and_normals_at(&u, &v);
            for l in 0..4 {
                let (point, normal) = (piece.point(u[l], v[l]), piece.normal(u[l], v[l]));
                for axis in 0..3 {
                    assert_eq!(points[axis][l].to_bits(), point[axis].to_bits());
                    assert_eq!(normals[axis][l].to_bits(), normal[axis].to_bits());
                }
            }
        }
    }
}

#[test]
fn nets_of_parts_give_the_same_points() {
    for first in 0..3 {
        let piece = Quartic::of(&BezierTriangle::of(&arbitrary(2.0)), first);
        for (at, size) in [
            ([0.0, 0.0], 1.0),
            ([0.25, 0.5], 0.25),
            ([0.75, 0.5], -0.5),
            ([0.5, 0.125], 0.0625),
        ] {
            let net = piece.net(at, size);
            for (s, t) in places() {
                let expected = piece.point(at[0] + s * size, at[1] + t * size);
                assert!(bernstein(&net, [1.0 - s - t, s, t]).distance(expected) < 1e-13);
            }
        }
    }
}

#[test]
fn without_a_plane_there_is_no_normal() {
    let direction = DVec3::new(0.3, 1.7, -0.9);
    let on_a_line = |from: DVec3| {
        Quartic::of(
            &BezierTriangle::of(&arbitrary(5.0).map(|p| from + p.x * direction)),
            0,
        )
    };
    let to_a_point = Quartic::of(&BezierTriangle::of(&[DVec3::new(0.1, 0.2, 0.3); 12]), 0);
    // Curved, but standing on edge over a line.
    let folded = Quartic::of(
        &BezierTriangle::of(&gentle(2.0).map(|p| DVec3::new(p.x, 0.7 * p.x, 0.1 * p.x))),
        1,
    );
    let all = [
        on_a_line(DVec3::ZERO),
        on_a_line(DVec3::new(1e6, -3e5, 2e6)),
        to_a_point,
        folded,
    ];
    for (quartic, (u, v)) in all
        .iter()
        .flat_map(|q| places().map(move |place| (q, place)))
    {
        assert_eq!(quartic.normal(u, v), DVec3::ZERO);
    }
}

/// Squares of such coordinates vanish or overflow; a power of two changes no digit.
#[test]
fn normals_do_not_depend_on_size() {
    let points = gentle(4.0);
    let expected = Quartic::of(&BezierTriangle::of(&points), 0);
    for size in [
        2f64.powi(-900),
        2f64.powi(-300),
        2f64.powi(300),
        2f64.powi(900),
    ] {
        let quartic = Quartic::of(&BezierTriangle::of(&points.map(|p| size * p)), 0);
        for (u, v) in places() {
            assert_eq!(quartic.normal(u, v), expected.normal(u, v), "size {size}");
        }
    }
}

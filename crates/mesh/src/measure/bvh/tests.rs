//! Closest points against brute force over all triangles, by a method of its own.

use proptest::prelude::*;

use super::*;

/// The distance to a triangle by another way than the library's: to its plane, if the projection is
/// inside by the signs of three areas, else to its three sides.
fn distance_to_triangle(p: DVec3, corners: [DVec3; 3]) -> f64 {
    // Seen from the corner with the angle nearest 90°: from the tip of a needle rounding decides the plane.
    let sine = |first: usize| {
        let [a, b, c] = [0, 1, 2].map(|i| corners[(first + i) % 3]);
        (b - a)
            .normalize_or_zero()
            .cross((c - a).normalize_or_zero())
            .length()
    };
    let first = (1..3).fold(0, |known, first| {
        if sine(first) > sine(known) {
            first
        } else {
            known
        }
    });
    let [a, b, c] = [0, 1, 2].map(|i| corners[(first + i) % 3]);
    let to_segment = |a: DVec3, b: DVec3| {
        let along = b - a;
        let t = (p - a).dot(along) / along.length_squared();
        if t.is_finite() {
            p.distance(a + along * t.clamp(0.0, 1.0))
        } else {
            p.distance(a).min(p.distance(b))
        }
    };
    let sides = to_segment(a, b).min(to_segment(b, c)).min(to_segment(c, a));
    let Some(normal) = (b - a).cross(c - a).try_normalize() else {
        return sides;
    };
    let height = (p - a).dot(normal);
    let projection = p - normal * height;
    let area = |a: DVec3, b: DVec3| (a - projection).cross(b - projection).dot(normal);
    // Above the inside the height is the least; the normal of a needle far from the origin may be off by much.
    if area(a, b) > 0.0 && area(b, c) > 0.0 && area(c, a) > 0.0 {
        height.abs().min(sides)
    } else {
        sides
    }
}

fn brute_force(surface: Triangles<'_>, p: DVec3) -> f64 {
    (0..surface.triangles.len())
        .map(|face| distance_to_triangle(p, surface.corners(face).map(vector)))
        .fold(f64::INFINITY, f64::min)
}

/// Checks one answer: the distance is the least, the point is that far away, and it lies on its triangle.
fn check_answer(surface: Triangles<'_>, p: [f64; 3], answer: ClosestPoint, scale: f64) {
    let expected = brute_force(surface, vector(p));
    let tolerance = 1e-12 * (scale + expected);
    assert!(
        (answer.distance - expected).abs() <= tolerance,
        "{answer:?}, expected {expected} from {p:?}"
    );
    let away = vector(p).distance(vector(answer.point));
    assert!(
        (away - expected).abs() <= 1e-9 * (scale + expected),
        "{answer:?} is {away} from {p:?}"
    );
    let off = distance_to_triangle(
        vector(answer.point),
        surface.corners(answer.face as usize).map(vector),
    );
    assert!(off <= 1e-12 * scale, "{answer:?} is {off} off its triangle");
}

/// Coordinates of which many are equal, so that triangles without area and points at equal distances are common.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![3 => -1.0..1.0, 1 => (-2i32..=2).prop_map(f64::from), 1 => (-1.0..1.0).prop_map(|x: f64| x * 1e-9)]
}

fn point() -> impl Strategy<Value = [f64; 3]> {
    [coordinate(), coordinate(), coordinate()]
}

/// Triangle soups: free ones, slivers and ones that share vertices.
fn soup() -> impl Strategy<Value = (Vec<[f64; 3]>, Vec<[u32; 3]>)> {
    prop::collection::vec(point(), 1..60).prop_flat_map(|positions| {
        let vertex = 0..positions.len() as u32;
        let triangle = [vertex.clone(), vertex.clone(), vertex];
        (Just(positions), prop::collection::vec(triangle, 1..80))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn closest_is_closest(
        (positions, triangles) in soup(),
        queries in prop::collection::vec((point(), prop_oneof![Just(1.0), Just(1e3), Just(1e6)]), 1..20),
        (exponent, offset) in (prop_oneof![Just(0i32), -30..30], prop_oneof![Just(0.0), -1e3..1e3]),
    ) {
        let scale = 10f64.powi(exponent);
        let place = |p: [f64; 3]| p.map(|x| (x + offset) * scale);
        let positions: Vec<_> = positions.into_iter().map(place).collect();
        let surface = Triangles { positions: &positions, triangles: &triangles };
        let bvh = Bvh::new(surface).unwrap();
        for (query, far) in queries {
            let query = place(query.map(|x| x * far));
            let answer = bvh.closest(query);
            check_answer(surface, query, answer, scale * (2.0 + f64::abs(offset)));
            for guess in [0, triangles.len() as u32 / 2, u32::MAX] {
                prop_assert_eq!(bvh.closest_from(query, guess), answer);
            }
        }
    }
}

/// A wavy sheet of 2 n² triangles over the unit square.
fn sheet(n: u32) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let at = |k: u32| f64::from(k) / f64::from(n);
    let positions = (0..=n)
        .flat_map(|i| (0..=n).map(move |j| (i, j)))
        .map(|(i, j)| {
            [
                at(i),
                at(j),
                0.1 * (at(i) * 7.0).sin() * (at(j) * 5.0).cos(),
            ]
        })
        .collect();
    let vertex = |i: u32, j: u32| i * (n + 1) + j;
    let triangles = (0..n)
        .flat_map(|i| (0..n).map(move |j| (i, j)))
        .flat_map(|(i, j)| {
            let (a, b, c, d) = (
                vertex(i, j),
                vertex(i + 1, j),
                vertex(i + 1, j + 1),
                vertex(i, j + 1),
            );
            [[a, b, c], [a, c, d]]
        })
        .collect();
    (positions, triangles)
}

#[test]
fn sheets_of_every_size_of_tree() {
    for n in [1, 2, 3, 5, 8, 11, 23, 40] {
        let (positions, triangles) = sheet(n);
        let surface = Triangles {
            positions: &positions,
            triangles: &triangles,
        };
        let bvh = Bvh::new(surface).unwrap();
        let mut guess = 0;
        for k in 0..200 {
            let p = [0.618, 0.414, 0.732].map(|step| (step * f64::from(k)).fract() * 1.4 - 0.2);
            let answer = bvh.closest_from(p, guess);
            check_answer(surface, p, answer, 1.0);
            assert_eq!(bvh.closest(p), answer);
            guess = answer.face;
        }
    }
}

#[test]
fn ties_go_to_the_least_index() {
    // One triangle many times over, and a query with an equal distance to all.
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let triangles = [[0, 1, 2]; 100];
    let bvh = Bvh::new(Triangles {
        positions: &positions,
        triangles: &triangles,
    })
    .unwrap();
    for guess in [0, 7, 99] {
        assert_eq!(bvh.closest_from([0.2, 0.2, 3.0], guess).face, 0);
    }
    // The middle of a cube is as far from all its faces.
    let cube: Vec<[f64; 3]> = (0..8)
        .map(|k| [k & 1, k >> 1 & 1, k >> 2].map(f64::from))
        .collect();
    let faces = [
        [0, 1, 3],
        [0, 3, 2],
        [4, 6, 7],
        [4, 7, 5],
        [0, 4, 5],
        [0, 5, 1],
        [2, 3, 7],
        [2, 7, 6],
    ];
    let bvh = Bvh::new(Triangles {
        positions: &cube,
        triangles: &faces,
    })
    .unwrap();
    for guess in 0..8 {
        let answer = bvh.closest_from([0.5; 3], guess);
        assert_eq!((answer.distance, answer.face), (0.5, 0));
    }
}

#[test]
fn extreme_scales_neither_overflow_nor_vanish() {
    let triangles = [[0, 1, 2]];
    for scale in [1e-300, 1e-160, 1e160, 1e300] {
        let positions = [[0.0, 0.0, 0.0], [scale, 0.0, 0.0], [0.0, scale, 0.0]];
        let bvh = Bvh::new(Triangles {
            positions: &positions,
            triangles: &triangles,
        })
        .unwrap();
        let answer = bvh.closest([0.25 * scale, 0.25 * scale, 2.0 * scale]);
        assert!((answer.distance / scale - 2.0).abs() < 1e-14, "{answer:?}");
        assert!((answer.point[0] / scale - 0.25).abs() < 1e-14);
    }
    let positions = [[0.0, 0.0, 0.0], [1e-300, 0.0, 0.0], [0.0, 1e-300, 0.0]];
    let bvh = Bvh::new(Triangles {
        positions: &positions,
        triangles: &triangles,
    })
    .unwrap();
    let answer = bvh.closest([3e250, -4e250, 0.0]);
    assert!((answer.distance / 5e250 - 1.0).abs() < 1e-14, "{answer:?}");
    // The greatest numbers there are, on both sides of the origin.
    let positions = [[f64::MAX; 3], [-f64::MAX; 3], [f64::MAX, -f64::MAX, 0.0]];
    let bvh = Bvh::new(Triangles {
        positions: &positions,
        triangles: &triangles,
    })
    .unwrap();
    assert_eq!(bvh.closest([f64::MAX; 3]).distance, 0.0);
}

#[test]
fn a_single_point_far_from_the_origin() {
    let positions = [[1e300; 3]];
    let bvh = Bvh::new(Triangles {
        positions: &positions,
        triangles: &[[0, 0, 0]],
    })
    .unwrap();
    let answer = bvh.closest([1e300, 1e300, 0.0]);
    assert!((answer.distance / 1e300 - 1.0).abs() < 1e-14);
    assert_eq!(answer.point, [1e300; 3]);
}

#[test]
fn queries_that_are_not_finite_have_no_distance() {
    let (positions, triangles) = sheet(2);
    let bvh = Bvh::new(Triangles {
        positions: &positions,
        triangles: &triangles,
    })
    .unwrap();
    for bad in [f64::NAN, f64::INFINITY] {
        assert!(bvh.closest([0.0, bad, 0.0]).distance.is_nan());
    }
}

#[test]
fn surfaces_that_cannot_be_measured() {
    let refused = |positions: &[[f64; 3]], triangles: &[[u32; 3]]| {
        Bvh::new(Triangles {
            positions,
            triangles,
        })
        .err()
        .unwrap()
    };
    let which = "reference";
    assert_eq!(refused(&[[0.0; 3]], &[]), MeasureError::Empty { which });
    assert_eq!(
        refused(&[[0.0; 3]], &[[0, 0, 0], [0, 1, 0]]),
        MeasureError::VertexOutOfRange {
            which,
            face: 1,
            vertex: 1,
            count: 1
        }
    );
    let error = refused(&[[0.0; 3], [0.0, f64::INFINITY, 0.0]], &[[0, 0, 0]]);
    assert_eq!(
        error,
        MeasureError::NotFinite {
            which,
            vertex: 1,
            axis: 1,
            value: f64::INFINITY
        }
    );
}

#[test]
fn memory_stays_small() {
    let (positions, triangles) = sheet(200);
    let bvh = Bvh::new(Triangles {
        positions: &positions,
        triangles: &triangles,
    })
    .unwrap();
    assert!(
        bvh.memory() <= 50 * triangles.len(),
        "{} bytes for {}",
        bvh.memory(),
        triangles.len()
    );
}

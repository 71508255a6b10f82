//! Distances between shapes for which they are known.

use super::*;

struct Shape {
    positions: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Shape {
    fn as_triangles(&self) -> Triangles<'_> {
        Triangles {
            positions: &self.positions,
            triangles: &self.triangles,
        }
    }

    fn moved(&self, by: [f64; 3], scale: f64) -> Self {
        let place = |p: &[f64; 3]| core::array::from_fn(|axis| p[axis] * scale + by[axis]);
        Self {
            positions: self.positions.iter().map(place).collect(),
            triangles: self.triangles.clone(),
        }
    }
}

/// The unit square in 2 n² triangles.
fn square(n: u32) -> Shape {
    let vertex = |i: u32, j: u32| i * (n + 1) + j;
    let cells = || (0..n).flat_map(move |i| (0..n).map(move |j| (i, j)));
    Shape {
        positions: (0..=n)
            .flat_map(|i| {
                (0..=n).map(move |j| {
                    [
                        f64::from(i) / f64::from(n),
                        f64::from(j) / f64::from(n),
                        0.0,
                    ]
                })
            })
            .collect(),
        triangles: cells()
            .flat_map(|(i, j)| {
                let (a, b, c, d) = (
                    vertex(i, j),
                    vertex(i + 1, j),
                    vertex(i + 1, j + 1),
                    vertex(i, j + 1),
                );
                [[a, b, c], [a, c, d]]
            })
            .collect(),
    }
}

/// An octahedron split `levels` times, its vertices on the unit sphere.
fn sphere(levels: u32) -> Shape {
    let corners = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut faces: Vec<[[f64; 3]; 3]> = (0..8)
        .map(|octant| {
            let mut face = corners;
            for (axis, corner) in face.iter_mut().enumerate() {
                if octant >> axis & 1 == 1 {
                    corner[axis] = -1.0;
                }
            }
            if [0, 3, 5, 6].contains(&octant) {
                face
            } else {
                [face[1], face[0], face[2]]
            }
        })
        .collect();
    for _ in 0..levels {
        let middle =
            |a: [f64; 3], b: [f64; 3]| ((vector(a) + vector(b)) / 2.0).normalize().to_array();
        faces = faces
            .into_iter()
            .flat_map(|[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    Shape {
        triangles: (0..faces.len() as u32)
            .map(|f| [3 * f, 3 * f + 1, 3 * f + 2])
            .collect(),
        positions: faces.into_flattened(),
    }
}

fn measure(a: &Shape, b: &Shape, samples: usize) -> Hausdorff {
    hausdorff(
        a.as_triangles(),
        b.as_triangles(),
        &SamplingOptions::default().samples(samples),
    )
    .unwrap()
}

#[test]
fn a_surface_and_itself() {
    for shape in [
        square(7),
        sphere(3),
        sphere(2).moved([1e6, -3.0, 0.1], 1e-3),
    ] {
        let distance = measure(&shape, &shape, 20_000);
        let size = vector(shape.positions[0]).length() + shape.as_triangles().diagonal();
        assert!(distance.symmetric() <= 1e-15 * size, "{distance:?}");
        // Vertices are found exactly.
        let at_vertices = distances_to(&shape.positions, shape.as_triangles()).unwrap();
        assert!(at_vertices.iter().all(|&d| d == 0.0));
    }
}

#[test]
fn parallel_squares() {
    let (a, b) = (square(3), square(5).moved([0.0, 0.0, 0.25], 1.0));
    let distance = measure(&a, &b, 5_000);
    for side in [distance.forward, distance.backward] {
        for value in [side.max, side.mean, side.rms] {
            assert!((value - 0.25).abs() < 1e-15, "{side:?}");
        }
        assert_eq!((side.at[2] - side.to[2]).abs(), 0.25);
    }
    assert!((distance.symmetric_percent() - 25.0 / 2f64.sqrt()).abs() < 1e-12);
}

#[test]
fn a_larger_square_is_farther_one_way() {
    // From the large square [-1, 2]² to the unit square: the corners are √2 away; in the other
    // direction all is 0.
    let (small, large) = (square(4), square(4).moved([-1.0, -1.0, 0.0], 3.0));
    let distance = measure(&large, &small, 200_000);
    assert!((distance.forward.max - 2f64.sqrt()).abs() < 1e-15);
    assert!(distance.backward.max < 1e-15);
    assert_eq!(
        distance.symmetric(),
        distance.forward.max.max(distance.backward.max)
    );
    // ∫d over the frame: four strips of 1 × 1 with mean 1/2, four corner squares with the mean distance from a
    // corner of a unit square, (√2 + asinh 1) / 3.
    let corner = (2f64.sqrt() + 1f64.asinh()) / 3.0;
    let mean = (4.0 * 0.5 + 4.0 * corner) / 9.0;
    assert!(
        (distance.forward.mean / mean - 1.0).abs() < 1e-3,
        "{} {mean}",
        distance.forward.mean
    );
    // ∫d²: the strips have 1/3, the corners 2/3.
    let rms = ((4.0 / 3.0 + 4.0 * 2.0 / 3.0) / 9.0f64).sqrt();
    assert!(
        (distance.forward.rms / rms - 1.0).abs() < 1e-3,
        "{} {rms}",
        distance.forward.rms
    );
}

#[test]
fn nested_spheres() {
    let (inner, outer) = (sphere(4), sphere(5).moved([0.0; 3], 1.5));
    let distance = measure(&inner, &outer, 100_000);
    // A point of a facet is at most its longest edge / √3 from a corner, and so no deeper below the
    // sphere than the middle of a chord of twice that.
    let depth = |shape: &Shape, radius: f64| {
        let sides = (0..shape.triangles.len()).flat_map(|face| {
            let [a, b, c] = shape.as_triangles().corners(face).map(vector);
            [a.distance(b), b.distance(c), c.distance(a)]
        });
        let longest = sides.fold(0.0, f64::max);
        radius - (radius * radius - longest * longest / 3.0).sqrt()
    };
    let slack = depth(&inner, 1.0).max(depth(&outer, 1.5));
    for side in [distance.forward, distance.backward] {
        assert!(
            (side.max - 0.5).abs() <= slack && side.max >= 0.5 - 1e-3,
            "{side:?} {slack}"
        );
        assert!((side.mean - 0.5).abs() <= slack && side.mean <= side.rms && side.rms <= side.max);
    }
    // At a radius in the direction of a common vertex the distance is exact.
    assert!(distance.backward.max >= 0.5);
}

#[test]
fn a_spike_is_found_from_its_own_side_only() {
    let flat = square(10);
    let mut spiked = square(10);
    let peak = 5 * 11 + 5;
    spiked.positions[peak][2] = 0.7;
    let distance = measure(&spiked, &flat, 100);
    assert_eq!(distance.forward.max, 0.7);
    assert_eq!(
        (distance.forward.at, distance.forward.to),
        ([0.5, 0.5, 0.7], [0.5, 0.5, 0.0])
    );
    assert!(distance.backward.max < 0.1);
    assert_eq!(distance.symmetric(), 0.7);
}

#[test]
fn the_greatest_distance_is_found_where_no_sample_falls() {
    // A needle ten long against its two ends: the point farthest from both is at an irrational place of the long side,
    // where a handful of samples misses it by about a tenth.
    let place = 10.0 / 2f64.sqrt();
    let needle = Shape {
        positions: vec![[0.0, 0.0, 0.0], [2.0 * place, 0.0, 0.0], [3.0, 1e-6, 0.0]],
        triangles: vec![[0, 1, 2]],
    };
    let ends = Shape {
        positions: vec![[0.0; 3], [2.0 * place, 0.0, 0.0]],
        triangles: vec![[0, 0, 0], [1, 1, 1]],
    };
    let distance = measure(&needle, &ends, 20);
    let bvh = Bvh::new(needle.as_triangles()).unwrap();
    let samples = Samples::new(&bvh, 20);
    let mut sampled = 0.0f64;
    samples.visit(0..samples.len(), |p| {
        sampled = sampled.max(p.x.min(2.0 * place - p.x))
    });
    assert!(
        place - sampled > 0.01,
        "the samples alone must miss it: {sampled}"
    );
    assert!(
        (distance.forward.max - place).abs() < 0.01 && distance.forward.max <= place + 1e-12,
        "{distance:?}"
    );
    let (at, to) = (vector(distance.forward.at), vector(distance.forward.to));
    assert!((at.distance(to) - distance.forward.max).abs() < 1e-12);
}

#[test]
fn all_vertices_count_and_few_samples_are_enough_for_a_mean() {
    let shape = square(30);
    let distance = measure(&shape, &shape.moved([0.0, 0.0, 2.0], 1.0), 100);
    assert_eq!(distance.forward.samples, 31 * 31 + 25);
    assert!((distance.forward.mean - 2.0).abs() < 1e-15);
    assert_eq!(measure(&shape, &shape, 5_000).forward.samples, 5_000);
    assert_eq!(measure(&shape, &shape, 0).forward.samples, 31 * 31 + 1);
}

#[test]
fn samples_are_spread_evenly() {
    // Each cell of a 10 × 10 grid over the square gets its share of the points inside, whatever the triangles: here
    // two of very different size.
    let shape = Shape {
        positions: vec![
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.9, 1.0, 0.0],
        ],
        triangles: vec![[0, 1, 4], [1, 2, 4], [0, 4, 3]],
    };
    let bvh = Bvh::new(shape.as_triangles()).unwrap();
    let samples = Samples::new(&bvh, 20_000);
    let mut cells = [0usize; 100];
    let insides = samples.insides();
    let share = insides.len() as f64 / 100.0;
    samples.visit(insides, |p| {
        cells[((p.y * 10.0) as usize).min(9) * 10 + ((p.x * 10.0) as usize).min(9)] += 1
    });
    assert!(
        cells.iter().all(|&n| (n as f64 / share - 1.0).abs() < 0.15),
        "{cells:?}"
    );
}

#[test]
fn surfaces_without_area_are_measured_by_their_vertices_and_sides() {
    let needle = Shape {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.5, 0.0, 0.0]],
        triangles: vec![[0, 1, 2]],
    };
    let dot = Shape {
        positions: vec![[0.0, 2.0, 0.0]],
        triangles: vec![[0, 0, 0]],
    };
    let distance = measure(&needle, &dot, 100);
    assert!((distance.forward.max - 5f64.sqrt()).abs() < 1e-15);
    assert!(distance.forward.mean > 2.0 && distance.forward.mean < distance.forward.max);
    assert_eq!((distance.backward.max, distance.backward.mean), (2.0, 2.0));
}

#[test]
fn huge_and_tiny_surfaces() {
    for scale in [1e-250, 1e-100, 1e100, 1e250] {
        let (a, b) = (
            square(3).moved([0.0; 3], scale),
            square(3).moved([0.0, 0.0, 2.0 * scale], scale),
        );
        let distance = measure(&a, &b, 1000);
        for value in [
            distance.forward.max,
            distance.forward.mean,
            distance.backward.rms,
        ] {
            assert!((value / scale - 2.0).abs() < 1e-12, "{scale}: {distance:?}");
        }
    }
}

#[test]
fn heat_map_distances() {
    let points = [[0.5, 0.5, 3.0], [2.0, 0.5, 0.0], [0.5, 0.5, 0.0]];
    assert_eq!(
        distances_to(&points, square(4).as_triangles()).unwrap(),
        [3.0, 1.0, 0.0]
    );
    assert_eq!(
        distances_to(&[], square(4).as_triangles()).unwrap(),
        Vec::<f64>::new()
    );
    assert!(matches!(
        distances_to(&[[0.0; 3], [0.0, f64::NAN, 0.0]], square(4).as_triangles()),
        Err(MeasureError::NotFinite {
            which: "measured",
            vertex: 1,
            axis: 1,
            ..
        })
    ));
}

#[test]
fn errors_name_the_surface() {
    let good = square(1);
    let empty = Shape {
        positions: vec![[0.0; 3]],
        triangles: vec![],
    };
    let options = SamplingOptions::default();
    let error = hausdorff(good.as_triangles(), empty.as_triangles(), &options).unwrap_err();
    assert_eq!(error, MeasureError::Empty { which: "reference" });
    let error = hausdorff(empty.as_triangles(), good.as_triangles(), &options).unwrap_err();
    assert_eq!(error, MeasureError::Empty { which: "measured" });
}

#[cfg(feature = "parallel")]
#[test]
fn the_same_bytes_on_any_number_of_threads() {
    let (a, b) = (sphere(5), sphere(6).moved([0.01, 0.0, 0.0], 1.02));
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            (
                measure(&a, &b, 30_000),
                distances_to(&a.positions, b.as_triangles()).unwrap(),
            )
        })
    };
    let one = on(1);
    for threads in [2, 4] {
        assert_eq!(one, on(threads));
    }
}

/// Over a sheet that rises evenly from 0 to h above a plane, distances are spread evenly between.
#[test]
fn the_95th_percentile_of_a_rising_sheet() {
    let plane = square(1).moved([-1.0, -1.0, 0.0], 3.0);
    for (n, height) in [(1, 0.4), (7, 1e-120), (3, 1e120)] {
        let mut sheet = square(n);
        sheet
            .positions
            .iter_mut()
            .for_each(|p| p[2] = height * p[0]);
        let (sheet, plane) = (sheet.moved([0.0; 3], 1.0), &plane);
        let wide = if height > 1.0 { 1e121 } else { 1.0 };
        let found = measure(&sheet, &plane.moved([0.0; 3], wide), 40_000);
        assert!(
            (found.forward.percentile_95 / height - 0.95).abs() < 0.01,
            "{n}, {height}: {found:?}"
        );
    }
    // A surface without area has its vertices and sides measured.
    let line = Shape {
        positions: vec![[0.0, 0.0, 2.0]; 3],
        triangles: vec![[0, 1, 2]],
    };
    assert_eq!(measure(&line, &plane, 100).forward.percentile_95, 2.0);
    assert_eq!(
        [
            percentile_95(&mut []),
            percentile_95(&mut [3.0]),
            percentile_95(&mut [2.0, 1.0])
        ],
        [0.0, 3.0, 2.0]
    );
    let mut hundred: Vec<f64> = (1..=100).rev().map(f64::from).collect();
    assert_eq!(percentile_95(&mut hundred), 95.0);
}

//! Intervals against distances that are known, and against dense sampling by brute force.

use proptest::prelude::*;

use super::*;
use crate::measure::{SamplingOptions, hausdorff};
use crate::vector::DVec3;

#[derive(Clone, Debug)]
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

    /// Every position through `place`.
    fn mapped(&self, place: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        Self {
            positions: self.positions.iter().map(|&p| place(p)).collect(),
            triangles: self.triangles.clone(),
        }
    }

    fn scaled(&self, scale: f64) -> Self {
        self.mapped(|p| p.map(|x| x * scale))
    }
}

/// The unit square in 2 n² triangles, `height` high.
fn square(n: u32, height: impl Fn(f64, f64) -> f64) -> Shape {
    let vertex = |i: u32, j: u32| i * (n + 1) + j;
    let place = |i: u32| f64::from(i) / f64::from(n);
    let mut shape = Shape {
        positions: vec![],
        triangles: vec![],
    };
    for i in 0..=n {
        shape
            .positions
            .extend((0..=n).map(|j| [place(i), place(j), height(place(i), place(j))]));
    }
    for i in 0..n {
        for j in 0..n {
            let (a, b, c, d) = (
                vertex(i, j),
                vertex(i + 1, j),
                vertex(i + 1, j + 1),
                vertex(i, j + 1),
            );
            shape.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    shape
}

/// An octahedron with its corners at a distance of 1, each face split into n².
fn octahedron(n: u32) -> Shape {
    let mut shape = Shape {
        positions: vec![],
        triangles: vec![],
    };
    let mut known = std::collections::BTreeMap::new();
    for octant in 0..8u32 {
        let sign: [i64; 3] =
            core::array::from_fn(|axis| if octant >> axis & 1 == 1 { -1 } else { 1 });
        let mut vertex = |i: u32, j: u32| {
            let weights = [i, j, n - i - j].map(i64::from);
            let key: [i64; 3] = core::array::from_fn(|axis| sign[axis] * weights[axis]);
            *known.entry(key).or_insert_with(|| {
                shape.positions.push(key.map(|x| x as f64 / f64::from(n)));
                shape.positions.len() as u32 - 1
            })
        };
        for i in 0..n {
            for j in 0..n - i {
                shape
                    .triangles
                    .push([vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)]);
                if i + j + 2 <= n {
                    shape.triangles.push([
                        vertex(i + 1, j),
                        vertex(i + 1, j + 1),
                        vertex(i, j + 1),
                    ]);
                }
            }
        }
    }
    shape
}

fn sphere(n: u32, radius: f64) -> Shape {
    octahedron(n).mapped(|p| (vector(p).normalize() * radius).to_array())
}

fn certify(a: &Shape, b: &Shape, options: &CertifiedOptions) -> CertifiedHausdorff {
    certified_hausdorff(a.as_triangles(), b.as_triangles(), options).unwrap()
}

fn narrow() -> CertifiedOptions {
    CertifiedOptions::default().relative_gap(1e-4)
}

/// The interval holds the truth, is as narrow as requested, and its distance is attained at its
/// points.
fn holds(bounds: &Bounds, truth: f64, gap: f64) {
    assert!(
        bounds.lower <= truth && truth <= bounds.upper,
        "{truth} {bounds:?}"
    );
    assert!(
        bounds.converged && bounds.upper - bounds.lower <= gap,
        "{truth} {bounds:?}"
    );
    let reached = vector(bounds.at).distance(vector(bounds.to));
    assert!(
        (reached - bounds.lower).abs() <= 1e-10 * (1.0 + reached),
        "{bounds:?}"
    );
}

/// The distance of a point to a triangle: to the plane if its projection is inside, else to a side.
fn point_to_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let side = |a: DVec3, b: DVec3| {
        let t = (p - a).dot(b - a) / (b - a).length_squared();
        (a + (b - a)
            * if t.is_finite() {
                t.clamp(0.0, 1.0)
            } else {
                0.0
            })
        .distance(p)
    };
    let normal = (b - a).cross(c - a);
    let projection = p - normal * ((p - a).dot(normal) / normal.length_squared());
    let inside = [(a, b), (b, c), (c, a)]
        .iter()
        .all(|&(a, b)| (b - a).cross(projection - a).dot(normal) >= 0.0);
    if inside {
        projection.distance(p)
    } else {
        side(a, b).min(side(b, c)).min(side(c, a))
    }
}

fn brute_distance(p: DVec3, shape: &Shape) -> f64 {
    let corners = |face: usize| shape.as_triangles().corners(face).map(vector);
    (0..shape.triangles.len())
        .map(|face| point_to_triangle(p, corners(face)))
        .fold(f64::INFINITY, f64::min)
}

/// The greatest distance at a lattice of points with `steps` steps along each side of every triangle.
fn brute_sampled(from: &Shape, to: &Shape, steps: u32) -> f64 {
    let mut most = 0.0f64;
    for face in 0..from.triangles.len() {
        let [a, b, c] = from.as_triangles().corners(face).map(vector);
        for i in 0..=steps {
            for j in 0..=steps - i {
                let [u, v, w] = [i, j, steps - i - j].map(|x| f64::from(x) / f64::from(steps));
                most = most.max(brute_distance(a * u + b * v + c * w, to));
            }
        }
    }
    most
}

/// One direction against brute force: nothing sampled is farther than the upper bound, and the place of the lower one
/// is on the surface and as far away as it says.
fn agrees(bounds: &Bounds, from: &Shape, to: &Shape, steps: u32) {
    let size = from
        .positions
        .iter()
        .chain(&to.positions)
        .flatten()
        .fold(0.0f64, |size, x| size.max(x.abs()));
    let sampled = brute_sampled(from, to, steps);
    assert!(
        sampled <= bounds.upper + 1e-14 * size,
        "{sampled} sampled, {bounds:?}"
    );
    let at = vector(bounds.at);
    assert!(brute_distance(at, from) <= 1e-13 * size, "{bounds:?}");
    assert!(brute_distance(at, to) >= bounds.lower, "{bounds:?}");
}

fn agree(a: &Shape, b: &Shape, options: &CertifiedOptions, steps: u32) -> CertifiedHausdorff {
    let found = certify(a, b, options);
    agrees(&found.forward, a, b, steps);
    agrees(&found.backward, b, a, steps);
    for side in [&found.forward, &found.backward] {
        let gap = (options.relative_gap * side.lower)
            .max(options.gap.unwrap_or(1e-6 * found.reference_diagonal))
            .max(1e-9 * found.reference_diagonal);
        assert!(
            side.converged && side.upper - side.lower <= gap * 1.000_001,
            "{gap} {side:?}"
        );
    }
    found
}

#[test]
fn parallel_squares() {
    for (n, m) in [(1, 1), (1, 7), (7, 1), (5, 8)] {
        let found = certify(&square(n, |_, _| 0.0), &square(m, |_, _| 0.25), &narrow());
        holds(&found.forward, 0.25, 2.5e-5);
        holds(&found.backward, 0.25, 2.5e-5);
        let wide = square(m, |_, _| 0.25).mapped(|[x, y, z]| [2.0 * x, y, z]);
        let found = certify(&square(n, |_, _| 0.0), &wide, &narrow());
        holds(&found.forward, 0.25, 2.5e-5);
        holds(&found.backward, 1.0625f64.sqrt(), 1.1e-4);
        assert_eq!(
            found.symmetric_interval(),
            [found.backward.lower, found.backward.upper]
        );
    }
}

impl CertifiedHausdorff {
    fn symmetric_interval(&self) -> [f64; 2] {
        [self.lower(), self.upper()]
    }
}

#[test]
fn nested_octahedra() {
    for (n, m) in [(1, 1), (4, 9), (9, 4)] {
        let found = certify(&octahedron(n), &octahedron(m).scaled(2.0), &narrow());
        holds(&found.forward, 1.0 / 3f64.sqrt(), 6e-5);
        holds(&found.backward, 1.0, 1e-4);
    }
}

#[test]
fn nested_spheres() {
    // Between the same triangulation at two radii, the farthest points are the outer vertices.
    let found = certify(&sphere(16, 1.0), &sphere(16, 1.001), &narrow());
    holds(&found.backward, 0.001, 1e-6 * 4.0);
    assert!(
        found.forward.upper <= 0.001 + 4e-6 && found.forward.lower > 0.00098,
        "{found:?}"
    );
}

#[test]
fn a_mesh_that_stands_for_another_surface_widens_the_interval() {
    // Against the unit sphere itself, for which a mesh stands as well as its flattest point is near.
    let reference = sphere(20, 1.0);
    let middles = (0..reference.triangles.len()).map(|face| {
        let [a, b, c] = reference.as_triangles().corners(face).map(vector);
        let normal = (b - a).cross(c - a);
        1.0 - (a.dot(normal) / normal.length()).abs()
    });
    let error = middles.fold(0.0, f64::max);
    let found = certify(&sphere(3, 1.1), &reference, &narrow());
    let wider = found.widened(error);
    assert!(
        wider.forward.lower <= 0.1 && 0.1 <= wider.forward.upper && wider.lower() > 0.0,
        "{wider:?}"
    );
    assert!((wider.upper() - found.upper() - error).abs() <= 1e-15 && wider.converged());
    assert_eq!(found.widened(10.0).lower(), 0.0);
}

#[test]
fn a_tent_over_a_plane() {
    let tent = Shape {
        positions: vec![
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.5, 0.5, 0.7],
        ],
        triangles: vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
    };
    for n in [1, 2, 9] {
        let found = certify(&tent, &square(n, |_, _| 0.0), &narrow());
        holds(&found.forward, 0.7, 7e-5);
        assert_eq!(found.forward.at, [0.5, 0.5, 0.7]);
        // From the middle of the base straight to each of the four sides, which rise 0.7 on 0.5.
        holds(&found.backward, 0.35 / 0.74f64.sqrt(), 5e-5);
    }
}

#[test]
fn the_farthest_point_inside_a_triangle_between_several_others() {
    // The point of a triangle farthest from its own corners is the centre of its circumscribed circle.
    let corners = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, 3.0, 0.0]];
    let triangle = Shape {
        positions: corners.to_vec(),
        triangles: vec![[0, 1, 2]],
    };
    let points = Shape {
        positions: corners.to_vec(),
        triangles: vec![[0, 0, 0], [1, 1, 1], [2, 2, 2]],
    };
    let found = certify(&triangle, &points, &narrow());
    let [a, b, c] = corners.map(vector);
    let (ab, bc, ca) = (a.distance(b), b.distance(c), c.distance(a));
    holds(
        &found.forward,
        ab * bc * ca / (2.0 * (b - a).cross(c - a).length()),
        5e-4,
    );
    assert!(found.backward.upper < 1e-10 && found.backward.lower == 0.0);
}

#[test]
fn identical_surfaces() {
    let open = square(9, |x, y| (3.0 * x).sin() * y);
    for shape in [
        &open,
        &octahedron(5),
        &sphere(12, 3.0),
        &open.scaled(1e150),
        &open.scaled(1e-150),
    ] {
        let found = certify(shape, shape, &CertifiedOptions::default().gap(Some(0.0)));
        assert!(found.converged(), "{found:?}");
        for side in [found.forward, found.backward] {
            assert_eq!(side.lower, 0.0);
            assert!(side.upper <= 1e-10 * found.reference_diagonal, "{side:?}");
        }
    }
}

#[test]
fn degenerate_triangles() {
    let needle = Shape {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.5, 0.0, 0.0]],
        triangles: vec![[0, 1, 2]],
    };
    let dot = Shape {
        positions: vec![[0.0, 2.0, 0.0]],
        triangles: vec![[0, 0, 0]],
    };
    let found = certify(&needle, &dot, &narrow());
    holds(&found.forward, 5f64.sqrt(), 1e-3);
    holds(&found.backward, 2.0, 1e-3);
    let found = certify(&dot, &dot, &narrow());
    assert!(found.converged() && found.upper() < 1e-10, "{found:?}");
    // A sheet with slivers, repeated triangles, one turned round and one that names a vertex twice.
    let mut dirty = square(6, |x, _| 0.01 * x);
    let middle = dirty.positions.len() as u32;
    dirty.positions.push([0.5, 0.25, 0.005]);
    dirty.triangles.extend([
        [3, 3, 4],
        [0, 7, middle],
        [8, 9, 16],
        [9, 8, 16],
        [20, 20, 20],
    ]);
    dirty.triangles[5].swap(0, 1);
    agree(&dirty, &square(4, |_, _| 0.0), &narrow(), 6);
}

#[test]
fn coordinates_of_any_size() {
    let (a, b) = (square(3, |_, _| 0.0), square(4, |x, y| 0.1 + 0.01 * x * y));
    let plain = certify(&a, &b, &narrow());
    for exponent in [-1000, -500, -30, 500, 990] {
        let scale = 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2);
        let found = certify(&a.scaled(scale), &b.scaled(scale), &narrow());
        let near = |x: f64, y: f64| (x / scale - y).abs() <= 1e-3 * y;
        assert!(
            found.converged() && near(found.lower(), plain.lower()),
            "{exponent} {found:?}"
        );
        assert!(near(found.upper(), plain.upper()), "{exponent} {found:?}");
    }
    // A small surface next to a huge one, and far from the origin.
    let found = certify(&a, &b.scaled(1e200), &CertifiedOptions::default());
    assert!(
        found.lower() >= 1e199 && found.upper() <= 1.02e200 * 3f64.sqrt(),
        "{found:?}"
    );
    let far = |shape: &Shape| shape.mapped(|[x, y, z]| [x + 1e6, y, z]);
    let found = certify(&far(&a), &far(&b), &narrow());
    assert!(
        (found.lower() - plain.lower()).abs() < 1e-4 && found.converged(),
        "{found:?}"
    );
    assert!(matches!(
        certified_hausdorff(
            a.as_triangles(),
            b.scaled(1e302).as_triangles(),
            &CertifiedOptions::default()
        ),
        Err(MeasureError::TooLarge {
            which: "reference",
            ..
        })
    ));
}

#[test]
fn errors_name_the_surface() {
    let (good, empty) = (
        square(1, |_, _| 0.0),
        Shape {
            positions: vec![],
            triangles: vec![],
        },
    );
    let options = CertifiedOptions::default();
    assert_eq!(
        certified_hausdorff(good.as_triangles(), empty.as_triangles(), &options),
        Err(MeasureError::Empty { which: "reference" })
    );
    assert_eq!(
        certified_hausdorff(empty.as_triangles(), good.as_triangles(), &options),
        Err(MeasureError::Empty { which: "measured" })
    );
}

#[test]
fn an_interval_cut_short_is_wider_and_still_right() {
    // Two sheets between which the middle one must be split along the line where both are equally near.
    let one = square(1, |_, _| 0.0);
    let mut two = square(1, |x, _| 0.2 + x);
    let other = square(1, |x, _| x - 1.2);
    two.triangles
        .extend(other.triangles.iter().map(|t| t.map(|v| v + 4)));
    two.positions.extend(other.positions);
    let whole = certify(&one, &two, &narrow().relative_gap(1e-5));
    assert!(whole.converged());
    let options = narrow().relative_gap(1e-5).max_work(1);
    let short = certify(&one, &two, &options);
    assert!(
        !short.forward.converged && short.forward.upper > whole.forward.upper,
        "{short:?} {whole:?}"
    );
    assert!(
        short.forward.lower <= whole.forward.upper && whole.forward.lower <= short.forward.upper
    );
}

/// Flat strips of unit length in `parts`, each drawn from one point of the plane y = 0 to another.
fn strips(parts: u32, profiles: &[[[f64; 2]; 2]]) -> Shape {
    let mut shape = Shape {
        positions: vec![],
        triangles: vec![],
    };
    for [from, to] in profiles {
        let first = shape.positions.len() as u32;
        for i in 0..=parts {
            let y = f64::from(i) / f64::from(parts);
            shape
                .positions
                .extend([[from[0], y, from[1]], [to[0], y, to[1]]]);
        }
        let at = |i: u32| first + 2 * i;
        shape.triangles.extend(
            (0..parts).flat_map(|i| [[at(i), at(i) + 1, at(i) + 3], [at(i), at(i) + 3, at(i) + 2]]),
        );
    }
    shape
}

/// Turned by some angles, so that no edge is along an axis.
fn turned(shape: &Shape) -> Shape {
    let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 1.1, -0.7);
    shape.mapped(|p| (turn * vector(p)).to_array())
}

/// The farthest points fill a whole line, or the whole surface.
#[test]
fn work_grows_with_the_logarithm_of_the_gap_where_the_maximum_is_not_one_point() {
    let wide = |height: f64| [[-1.0, height], [1.0, height]];
    let ribs: Vec<[[f64; 2]; 2]> = (-2..=2)
        .map(|i| [[0.5 * f64::from(i), -1.0], [0.5 * f64::from(i), 0.0]])
        .collect();
    let shingles: Vec<[[f64; 2]; 2]> = (-4..4)
        .map(|i| [[0.25 * f64::from(i), 0.0], [0.25 * f64::from(i + 1), 0.0]])
        .collect();
    let cases = [
        // Between two sheets next to it, and over the slot between them.
        (
            "ridge",
            vec![wide(0.0)],
            vec![[[-2.0, 0.0], [-1.0, 0.0]], [[1.0, 0.0], [2.0, 0.0]]],
            1.0,
        ),
        (
            "slot",
            vec![wide(0.5)],
            vec![[[-2.0, 0.0], [-0.3, 0.0]], [[0.3, 0.0], [2.0, 0.0]]],
            0.34f64.sqrt(),
        ),
        // In the middle between two walls, and between two that lean: the distances fall from its middle line.
        (
            "walls",
            vec![wide(0.0)],
            vec![[[-1.0, -1.0], [-1.0, 1.0]], [[1.0, -1.0], [1.0, 1.0]]],
            1.0,
        ),
        (
            "roof",
            vec![wide(0.0)],
            vec![[[-3.0, -1.0], [0.0, 2.0]], [[0.0, 2.0], [3.0, -1.0]]],
            2f64.sqrt(),
        ),
        // Over the edges of ribs that are half as far from each other as it is long, and through their middles.
        (
            "ribs below",
            vec![wide(0.5)],
            ribs.clone(),
            0.3125f64.sqrt(),
        ),
        ("ribs", vec![wide(-0.5)], ribs, 0.25),
        // Over sheets that touch each other without being connected, so that all of it is as far away.
        ("shingles", vec![wide(0.25)], shingles, 0.25),
        // An edge and a plane: where they are equally far is a parabola.
        (
            "edge and plane",
            vec![wide(0.0)],
            vec![[[-1.0, 0.0], [-3.0, 0.0]], [[1.0, -3.0], [1.0, 3.0]]],
            1.0,
        ),
    ];
    for (name, from, to, truth) in &cases {
        for (own, others) in [(1, 1), (1, 5), (5, 1), (3, 4)] {
            let (from, to) = (turned(&strips(own, from)), turned(&strips(others, to)));
            let measured = |gap: f64| {
                let options = CertifiedOptions::default().gap(Some(gap)).relative_gap(0.0);
                let found = certify(&from, &to, &options);
                holds(&found.forward, *truth, gap);
                found.work
            };
            // Two digits more of the gap add no more work than the two before: it grows with the logarithm, or not at all.
            let work = [1e-4, 1e-6, 1e-8].map(measured);
            let added = [
                work[1].saturating_sub(work[0]),
                work[2].saturating_sub(work[1]),
            ];
            assert!(
                added[1] <= added[0] + 500,
                "{name}, {own} and {others} parts: {work:?}"
            );
        }
    }
}

#[test]
fn nearly_coincident_surfaces_take_little_work() {
    // The upper bound follows from sheets: a few units for each triangle, however near the surfaces are.
    let height = |x: f64, y: f64| 0.3 * (4.0 * x).sin() * (3.0 * y).cos();
    let fine = square(128, height);
    for n in [16, 32] {
        let found = certify(&square(n, height), &fine, &CertifiedOptions::default());
        let triangles = (fine.triangles.len() + 2 * (n * n) as usize) as u64;
        assert!(
            found.converged() && found.work < 12 * triangles,
            "{n}: {} {triangles}",
            found.work
        );
    }
}

#[test]
fn sampled_distances_lie_within() {
    let pairs = [
        (sphere(8, 1.0), sphere(20, 1.02)),
        (
            square(12, |x, y| 0.1 * (9.0 * x).sin() * y),
            square(5, |x, y| 0.1 * (9.0 * x).sin() * y),
        ),
        (octahedron(6), sphere(6, 0.8)),
    ];
    for (a, b) in &pairs {
        let found = certify(a, b, &narrow());
        let sampled = hausdorff(
            a.as_triangles(),
            b.as_triangles(),
            &SamplingOptions::default(),
        )
        .unwrap();
        for (certified, sampled) in [
            (found.forward, sampled.forward),
            (found.backward, sampled.backward),
        ] {
            assert!(
                certified.upper >= sampled.max && certified.converged,
                "{certified:?} {sampled:?}"
            );
            assert!(
                certified.lower >= sampled.max * (1.0 - 1e-4) - 1e-6,
                "{certified:?} {sampled:?}"
            );
        }
    }
}

/// A flat sheet under a ridge whose top lies over no vertex of it: the farthest points are on its
/// base line, and c / √(1 + s²) away.
fn sheet_and_ridge() -> (Shape, Shape, f64) {
    let (height, slope) = (0.1, 0.25f64);
    let ridge = square(230, |x, _| height - slope * (x - 0.5).abs());
    (square(225, |_, _| 0.0), ridge, height / slope.hypot(1.0))
}

#[test]
fn large_surfaces_beside_finer_ones_are_sampled_first() {
    let (sheet, ridge, truth) = sheet_and_ridge();
    assert!(sheet.triangles.len() > 100_000 && ridge.triangles.len() > sheet.triangles.len());
    let mut samples = Vec::new();
    let found = certified_hausdorff_observed(
        sheet.as_triangles(),
        ridge.as_triangles(),
        &CertifiedOptions::default()
            .gap(Some(1e-9))
            .relative_gap(0.0),
        &mut |progress| {
            if progress.stage == Stage::Sampling && samples.last() != Some(&progress.total) {
                samples.push(progress.total);
            }
            core::ops::ControlFlow::Continue(())
        },
    );
    holds(&found.unwrap().forward, truth, 2e-9);
    let counts: Vec<usize> = samples.into_iter().flatten().collect();
    assert!(
        matches!(counts[..], [from, to] if from > sheet.positions.len() + 10_000 && to == ridge.positions.len()),
        "{counts:?}"
    );
}

#[cfg(feature = "parallel")]
#[test]
fn the_same_bytes_on_any_number_of_threads() {
    let (sheet, ridge, _) = sheet_and_ridge();
    for (a, b) in [(sphere(40, 1.0), sphere(23, 1.003)), (sheet, ridge)] {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| certify(&a, &b, &narrow()))
        };
        let one = on(1);
        for threads in [2, 4] {
            assert_eq!(one, on(threads));
        }
    }
}

fn point() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-1.0..1.0f64)
}

/// Triangles without any order, some of them sharing vertices, some without area.
fn soup() -> impl Strategy<Value = Shape> {
    (
        prop::collection::vec(point(), 3..12),
        prop::collection::vec(prop::array::uniform3(0..1000u32), 1..12),
    )
        .prop_map(|(positions, triangles)| {
            let count = positions.len() as u32;
            Shape {
                positions,
                triangles: triangles
                    .into_iter()
                    .map(|t| t.map(|v| v % count))
                    .collect(),
            }
        })
}

/// A sheet over the square with random heights, some triangles missing, some turned round.
fn sheet(roughness: f64) -> impl Strategy<Value = Shape> {
    (
        1..7u32,
        prop::collection::vec(-1.0..1.0f64, 200),
        prop::collection::vec(0..40u32, 100),
    )
        .prop_map(move |(n, noise, fate)| {
            let mut shape = square(n, |x, y| 0.2 * (2.0 * x + y).sin());
            for (p, noise) in shape.positions.iter_mut().flatten().zip(&noise) {
                *p += roughness * noise / f64::from(n);
            }
            let fates = || fate.iter().cycle();
            for (triangle, fate) in shape.triangles.iter_mut().zip(fates()) {
                if *fate == 1 {
                    triangle.swap(0, 2);
                }
            }
            let mut fates = fates();
            let all = shape.triangles.clone();
            shape.triangles.retain(|_| fates.next() != Some(&0));
            if shape.triangles.is_empty() {
                Shape {
                    triangles: all,
                    ..shape
                }
            } else {
                shape
            }
        })
}

/// A closed surface, its vertices thrown about so far that it may fold and cut itself.
fn crumpled(amount: f64) -> impl Strategy<Value = Shape> {
    (1..4u32, prop::collection::vec(-1.0..1.0f64, 3 * 38)).prop_map(move |(n, noise)| {
        let mut shape = sphere(n, 1.0);
        for (p, noise) in shape.positions.iter_mut().flatten().zip(&noise) {
            *p += amount * noise;
        }
        shape
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn soups_agree_with_brute_force(a in soup(), b in soup()) {
        agree(&a, &b, &CertifiedOptions::default(), 14);
    }

    #[test]
    fn sheets_agree_with_brute_force(a in sheet(0.1), b in sheet(0.1)) {
        agree(&a, &b, &CertifiedOptions::default(), 5);
    }

    #[test]
    fn rough_sheets_agree_with_brute_force(a in sheet(0.9), b in sheet(0.9)) {
        agree(&a, &b, &CertifiedOptions::default(), 5);
    }

    #[test]
    fn crumpled_surfaces_agree_with_brute_force(a in crumpled(0.6), b in crumpled(0.2)) {
        agree(&a, &b, &CertifiedOptions::default(), 5);
    }
}

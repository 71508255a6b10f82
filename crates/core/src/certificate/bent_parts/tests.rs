//! Four triangles together against each alone by other code, and against dense samples of the
//! surface.

use super::*;
use crate::certificate::{Cell, TriangleFrame, around};
use crate::patch::Quartic;
use crate::patch::bezier_triangle::BezierTriangle;
use limitmesh_testing::Random;

/// A piece whose points are a triangle's, stirred and bent, in a unit of its own.
fn piece(random: &mut Random, noise: f64, unit: f64) -> Quartic {
    let mut points = [DVec3::ZERO; 15];
    let places = (0..5).flat_map(|k| (0..5 - k).map(move |j| (0.25 * j as f64, 0.25 * k as f64)));
    let bend = random.vector() * 0.3;
    for (point, (u, v)) in points.iter_mut().zip(places) {
        let bulge = bend.x * u * u + bend.y * u * v + bend.z * v * v;
        *point = unit * (DVec3::new(u + 0.3 * v, v, bulge) + noise * random.vector());
    }
    Quartic::of(&BezierTriangle(points), 0)
}

/// Four parts of a piece, even ones or any, and triangles over them with their corners moved, among others.
struct Case {
    piece: Quartic,
    cells: [Cell; FOUR],
    bent: Bent,
    moved: MovedFour,
    scale: f64,
}

impl Case {
    /// What the bound of a part among neighbours is of by [`super::super::bounds`], in a few places: of points inside their heights, of
    /// others what they count over an edge; or their distances, if these are less.
    fn sampled(&self, l: usize, frame: &TriangleFrame, chords: [f64; 3]) -> f64 {
        let Cell([a, b, c]) = self.cells[l];
        let (mut among, mut own) = (0.0f64, 0.0f64);
        for (i, j) in (0..=GRID).flat_map(|j| (0..=GRID - j).map(move |i| (i, j))) {
            let (s, r) = (i as f64 / GRID as f64, j as f64 / GRID as f64);
            let [u, v]: [f64; 2] =
                from_fn(|axis| a[axis] + s * (b[axis] - a[axis]) + r * (c[axis] - a[axis]));
            let point = self.piece.point(u, v);
            let height = frame.height(point).abs();
            own = own.max(frame.squared(point).sqrt());
            among = among.max(height);
            // By edge, whether the point is on its curve.
            let is_on = [j == 0, i + j == GRID, i == 0];
            for edge in 0..3 {
                let (chord, outside) = (chords[edge], frame.edge_position(edge, point).outside);
                if is_on[edge] {
                    among = among.max(height * (1.0 + 0.5 * chord * chord) + chord * outside);
                } else if outside > 0.0 {
                    among = among.max(height + chord * outside);
                }
            }
        }
        among.min(own)
    }

    fn random(random: &mut Random, round: usize) -> Self {
        let unit = [1.0, 1e-70, 1e50][round % 3];
        let piece = piece(random, [0.001, 0.01, 0.1][round / 3 % 3], unit);
        let is_even = round.is_multiple_of(2);
        let spots: [[f64; 3]; FOUR] = from_fn(|_| {
            let size = 0.5f64.powi(1 + (4.0 * random.signed().abs()) as i32);
            let [u, v] = [0.25 + 0.24 * random.signed(), 0.25 + 0.24 * random.signed()];
            if random.signed() > 0.0 {
                [u, v, size]
            } else {
                [u + size, v + size, -size]
            }
        });
        let cells = spots.map(|[u, v, size]| {
            let [a, b, c] = [[u, v], [u + size, v], [u, v + size]];
            let half = [u + 0.5 * size, v + 0.5 * size];
            if is_even {
                Cell([a, b, c])
            } else {
                Cell([a, b, half])
            }
        });
        let jet = QuarticJet::of(&piece);
        let bender = Bender::of(&jet);
        let bent = if is_even {
            let [u, v, size] = from_fn(|i| f64x4::new(spots.map(|spot| spot[i])));
            bender.even([u, v], size)
        } else {
            bender.any(from_fn(|i| {
                from_fn(|axis| f64x4::new(cells.map(|cell| cell.0[i][axis])))
            }))
        };
        let mut moved = MovedFour::default();
        for (l, cell) in cells.iter().enumerate() {
            let size = (cell.0[0][0] - cell.0[1][0]).abs() * unit;
            let far = [0.0, 0.01, 0.03][round % 3] * size;
            let steps: [DVec3; 3] = from_fn(|i| {
                let [u, v] = cell.0[i];
                let [by_u, by_v] = piece.tangents(u, v);
                (1.0 + 0.3 * random.signed()) * far * (by_u / unit).cross(by_v / unit).normalize()
            });
            let corners: [DVec3; 3] =
                from_fn(|i| piece.point(cell.0[i][0], cell.0[i][1]) + steps[i]);
            for i in 0..3 {
                let [start, end, other] = [0, 1, 2].map(|k| corners[(i + k) % 3]);
                let opposite = start + end - other + 0.1 * size * random.vector();
                for axis in 0..3 {
                    moved.corners[i][axis][l] = corners[i][axis];
                    moved.steps[i][axis][l] = steps[i][axis];
                    moved.opposite[i][axis][l] = opposite[axis];
                }
            }
        }
        Self {
            piece,
            cells,
            bent,
            moved,
            scale: crate::patch::reciprocal_power(unit),
        }
    }

    fn vectors(rows: &[[[f64; FOUR]; 3]; 3], l: usize) -> [DVec3; 3] {
        from_fn(|i| DVec3::from_array(from_fn(|axis| rows[i][axis][l])))
    }

    /// The corners of a triangle, how they were moved, and those opposite.
    fn triangle(&self, l: usize) -> [[DVec3; 3]; 3] {
        [&self.moved.corners, &self.moved.steps, &self.moved.opposite]
            .map(|rows| Self::vectors(rows, l))
    }
}

/// Steps of the places at which parts are sampled.
const GRID: usize = 24;

#[test]
fn four_at_once_are_bounded_like_each() {
    let mut random = Random::new(11);
    let (mut bounded, mut tight) = (0, 0);
    for round in 0..2000 {
        let case = Case::random(&mut random, round);
        let jet = QuarticJet::of(&case.piece);
        let found = case.moved.bounds(&case.bent.kept(case.scale), case.scale);
        for l in 0..FOUR {
            let [corners, steps, opposite] = case.triangle(l);
            let frame = TriangleFrame::new(corners);
            let lifts = steps.map(|step| -frame.normal().dot(step));
            let aside = steps.map(|step| step.reject_from_normalized(frame.normal()).length());
            let (height, rest) = jet
                .heights(&case.cells[l], frame.normal())
                .lifted_range(lifts);
            let open = [false; 3];
            let by_piece = jet.edge_bounds(&case.cells[l], &frame, open);
            let edges = jet.closer_edge_bounds(&by_piece, &case.cells[l], &frame, open);
            let aside = aside.into_iter().fold(0.0, f64::max);
            let moved = steps.map(DVec3::length).into_iter().fold(0.0, f64::max);
            let (chords, slopes) = around(corners, &opposite.map(Some));
            let expected = case.sampled(l, &frame, chords);
            let loosely = by_piece.deviation_off(height + rest, moved, aside);
            let loosely = loosely.bound(chords, slopes);
            let unit = 1.0 / case.scale;
            assert!(
                (found.height[l] - height).abs() <= 1e-6 * unit,
                "round {round}: {found:?} {height}"
            );
            assert!(
                found.least[l] <= height - rest + 1e-12 * unit,
                "round {round}: {found:?}"
            );
            if found.bound[l].is_infinite() {
                continue;
            }
            assert!(!edges.is_loose(), "round {round}");
            assert!(
                found.bound[l] >= expected - 1e-12 * unit,
                "round {round}: {found:?} {expected}"
            );
            bounded += 1;
            tight += usize::from(found.bound[l] <= 1.05 * loosely + 1e-6 * unit);
        }
    }
    assert!(
        bounded > 4000 && tight * 10 > bounded * 8,
        "{tight} of {bounded}"
    );
}

#[test]
fn dense_samples_lie_within_the_bounds_of_moved_triangles() {
    let mut random = Random::new(5);
    let mut counted = 0;
    for round in 0..300 {
        let mut case = Case::random(&mut random, round);
        // Neighbours as slim as this do not count.
        for l in 0..FOUR {
            let [corners, ..] = case.triangle(l);
            for i in 0..3 {
                let along = corners[(i + 1) % 3] - corners[i];
                let inwards = corners[(i + 2) % 3] - corners[i];
                let opposite = corners[i] + 0.5 * along - 1e-9 * inwards;
                (0..3).for_each(|axis| case.moved.opposite[i][axis][l] = opposite[axis]);
            }
        }
        let found = case.moved.bounds(&case.bent.kept(case.scale), case.scale);
        for l in (0..FOUR).filter(|&l| found.bound[l].is_finite()) {
            let [corners, ..] = case.triangle(l);
            let (unit, Cell([a, b, c])) = (1.0 / case.scale, case.cells[l]);
            let frame = TriangleFrame::new(corners.map(|corner| corner * case.scale));
            for (i, j) in (0..=GRID).flat_map(|j| (0..=GRID - j).map(move |i| (i, j))) {
                let (s, r) = (i as f64 / GRID as f64, j as f64 / GRID as f64);
                let [u, v]: [f64; 2] =
                    from_fn(|axis| a[axis] + s * (b[axis] - a[axis]) + r * (c[axis] - a[axis]));
                let point = case.piece.point(u, v) * case.scale;
                let distance = frame.squared(point).sqrt() * unit;
                assert!(
                    distance <= found.bound[l] + 1e-12 * unit,
                    "round {round}: {distance} {found:?}"
                );
                assert!(
                    i + j > 0 || found.least[l] <= found.height[l],
                    "round {round}"
                );
            }
            counted += 1;
        }
    }
    assert!(counted > 600, "{counted}");
}

/// NaN and values beyond single precision have no bound.
#[test]
fn what_is_no_number_has_no_bound() {
    let mut random = Random::new(2);
    for bad in [f64::NAN, f64::INFINITY] {
        let mut case = Case::random(&mut random, 0);
        let kept = case.bent.kept(case.scale);
        let known = case.moved.bounds(&kept, case.scale);
        assert!(known.bound[1].is_finite());
        for at in 0..3 {
            for rows in 0..3 {
                let mut moved = case.moved;
                [&mut moved.corners, &mut moved.steps, &mut moved.opposite][rows][at][1][1] = bad;
                if rows == 1 {
                    moved.corners[at][1][1] = bad;
                }
                let found = moved.bounds(&kept, case.scale);
                assert!(found.bound[1] == f64::INFINITY && found.bound[0] == known.bound[0]);
                assert!(rows == 2 || found.least[1] == 0.0, "{found:?}");
            }
        }
        case.bent.bends[1][2] = f64x4::new([0.0, bad, 0.0, 0.0]);
        let found = case.moved.bounds(&case.bent.kept(case.scale), case.scale);
        let fails = found.least[1] > 0.0;
        assert!(found.bound[1] == f64::INFINITY && !fails, "{found:?}");
        let unknown = case.moved.bounds(&BentFour::UNKNOWN, case.scale);
        assert!(
            unknown.bound == [f64::INFINITY; FOUR]
                && unknown.least.iter().all(|&least| least <= 0.0)
        );
        let overflowing = Case::random(&mut random, 0).bent.kept(1e40);
        assert_eq!(overflowing.rest, [f32::INFINITY; FOUR]);
    }
}

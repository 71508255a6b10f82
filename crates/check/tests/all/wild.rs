//! Meshes whose vertices are moved about at random: folded, slivers, turned over. What is confirmed is never below the true distance.

use limitmesh_check::mesh::Mesh;
use limitmesh_check::vector::{Vector, add, cross, dot, length, scale, sub};

use crate::cage::{Cage, fan, octahedron};

/// A sequence that looks random, by a linear congruence.
struct Random(u64);

impl Random {
    /// A number from 0 to 1.
    fn unit(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn vector(&mut self) -> Vector {
        [0; 3].map(|_| 2.0 * self.unit() - 1.0)
    }
}

/// The corners of triangles.
fn corners(mesh: &Mesh) -> Vec<[Vector; 3]> {
    mesh.triangles
        .iter()
        .map(|t| t.map(|v| mesh.positions[v as usize]))
        .collect()
}

fn from_segment(p: Vector, a: Vector, b: Vector) -> f64 {
    let way = sub(b, a);
    let share = (dot(sub(p, a), way) / dot(way, way)).clamp(0.0, 1.0);
    length(sub(p, add(a, scale(way, share))))
}

fn from_triangle(p: Vector, [a, b, c]: [Vector; 3]) -> f64 {
    let normal = cross(sub(b, a), sub(c, a));
    let sides = [(a, b), (b, c), (c, a)];
    if sides
        .iter()
        .all(|&(a, b)| dot(cross(sub(b, a), sub(p, a)), normal) >= 0.0)
        && length(normal) > 0.0
    {
        return dot(sub(p, a), normal).abs() / length(normal);
    }
    sides
        .iter()
        .map(|&(a, b)| from_segment(p, a, b))
        .fold(f64::INFINITY, f64::min)
}

/// The greatest distance of points of the one from the other.
fn one_way(from: &[[Vector; 3]], to: &[[Vector; 3]], steps: u32) -> f64 {
    let points = from.iter().flat_map(|&[a, b, c]| {
        (0..=steps)
            .flat_map(move |i| (0..=steps - i).map(move |j| (i, j)))
            .map(move |(i, j)| {
                let [i, j] = [i, j].map(|x| f64::from(x) / f64::from(steps));
                add(add(scale(a, 1.0 - i - j), scale(b, i)), scale(c, j))
            })
    });
    points
        .map(|p| {
            to.iter()
                .map(|&t| from_triangle(p, t))
                .fold(f64::INFINITY, f64::min)
        })
        .fold(0.0, f64::max)
}

#[test]
fn nothing_is_confirmed_below_the_true_distance() {
    let mut random = Random(7);
    let (mut least, mut confirmed) = (f64::INFINITY, 0);
    for case in 0..80 {
        let mut control = if case % 2 == 0 { octahedron() } else { fan() };
        let noise = 0.4 * random.unit();
        control
            .positions
            .iter_mut()
            .for_each(|p| *p = add(*p, scale(random.vector(), noise)));
        let cage = Cage::new(control);
        // The surface is within a thousandth of this mesh.
        let surface = (0..4)
            .fold(cage.clone(), |cage, _| cage.refined())
            .settled(1);
        let mut moved = if case % 3 == 0 {
            cage.settled(4)
        } else {
            cage.refined().settled(4)
        };
        let (far, share) = ([0.02, 0.1, 0.4, 1.0][case / 2 % 4], random.unit());
        for p in &mut moved.mesh.positions {
            if random.unit() < share {
                *p = add(*p, scale(random.vector(), far));
            }
        }
        let [surface, mesh] = [&surface.mesh, &moved.mesh].map(corners);
        let distance = one_way(&mesh, &surface, 6).max(one_way(&surface, &mesh, 1));
        let below = 0.99 * distance - 0.004;
        assert!(
            below < 0.0 || !moved.refused(below).unwrap().is_empty(),
            "case {case}: {below} of {distance}"
        );
        let enough = (0..60)
            .map(|i| distance * 1.1f64.powi(i))
            .find(|&within| moved.refused(within).unwrap().is_empty());
        if let Some(within) = enough {
            confirmed += 1;
            least = least.min(within / distance);
        }
    }
    // It is tight, too.
    assert!(
        confirmed > 70 && least < 1.2,
        "{confirmed} confirmed, at best at {least} times the distance"
    );
}

/// Two triangles at an angle, each the part of one of two control faces that are flat: nearly folded ones lie far beyond the surface.
#[test]
fn folds_are_not_taken_for_flat() {
    for degrees in [10.0f64, 59.0, 61.0, 89.0, 91.0, 120.0, 179.0] {
        let angle = degrees.to_radians();
        let flat = |fold: f64| Mesh {
            positions: vec![
                [0.0, 0.0, 0.0],
                [1.0, 0.0, 0.0],
                [0.5, 0.8, 0.0],
                [0.5, -0.8 * fold.cos(), 0.8 * fold.sin()],
            ],
            triangles: vec![[0, 1, 2], [1, 0, 3]],
        };
        let mut cage = Cage::new(flat(0.0));
        let surface = (0..5)
            .fold(cage.clone(), |cage, _| cage.refined())
            .settled(1);
        cage.mesh = flat(angle);
        let [surface, mesh] = [&surface.mesh, &cage.mesh].map(corners);
        let distance = one_way(&mesh, &surface, 20).max(one_way(&surface, &mesh, 1));
        assert!(
            !cage.refused(0.99 * distance - 0.002).unwrap().is_empty(),
            "{degrees}"
        );
        // All places are nearer than that.
        assert!(cage.refused(2.0).unwrap().is_empty(), "{degrees}");
    }
}

/// A place that is beyond a line where the piece is divided by next to nothing is looked at all the same.
#[test]
fn corners_a_little_beyond_a_line_count() {
    let good = Cage::new(octahedron()).refined().refined().settled(5);
    let within = 0.1;
    assert!(good.refused(within).unwrap().is_empty());
    for v in 6..good.mesh.positions.len() {
        for nudge in [[1, -1, 0], [0, 1, -1], [-1, 0, 1], [2, -1, -1]] {
            let mut cage = good.clone();
            for (triangle, (_, part)) in cage.mesh.triangles.iter().zip(&mut cage.parts) {
                for (&corner, weights) in triangle.iter().zip(part) {
                    if corner as usize == v && weights.iter().all(|&weight| weight > 0) {
                        *weights = [0, 1, 2].map(|i| weights[i].wrapping_add_signed(nudge[i]));
                    }
                }
            }
            assert!(
                cage.refused(1.1 * within).unwrap().is_empty(),
                "{v} {nudge:?}"
            );
            let up = cage.mesh.positions[v];
            cage.mesh.positions[v] = add(up, scale(up, 2.0 * within / length(up)));
            assert!(
                !cage.refused(1.1 * within).unwrap().is_empty(),
                "{v} {nudge:?}, moved"
            );
        }
    }
}

/// Whatever the unit: squares of very large and very small lengths must not make a plane of nothing.
#[test]
fn units_change_nothing() {
    let good = Cage::new(octahedron()).settled(6);
    let least = |unit: f64| {
        let mut cage = good.clone();
        let all = cage
            .control
            .positions
            .iter_mut()
            .chain(&mut cage.mesh.positions);
        all.for_each(|p| *p = scale(*p, unit));
        let within = |i: i32| 0.01 * unit * 1.02f64.powi(i);
        // Out of range is no confirmation either.
        (0..250).find(|&i| {
            cage.refused(within(i))
                .is_ok_and(|refused| refused.is_empty())
        })
    };
    let usual = least(1.0).unwrap();
    for exponent in (-360..=360).step_by(8) {
        let found = least(2f64.powi(exponent));
        assert!(
            found.is_none_or(|found| found == usual),
            "2^{exponent}: {found:?}, not {usual}"
        );
        assert!(
            found.is_some() || !(-270..270).contains(&exponent),
            "2^{exponent}"
        );
    }
}

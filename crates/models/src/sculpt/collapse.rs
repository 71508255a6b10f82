//! Coarsening by edge collapses under quadric error metrics (Garland and Heckbert 1997), to an exact count.
//!
//! The plane x = 0 is a mirror: vertices in it stay in it, and the boundary there counts as its own image.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::Surface;
use glam::DMat3;
use glam::DVec3;

/// Weight of the pull towards the middle of the collapsed edge: far below the error of any real feature, it
/// decides on flat ground, where every position is equally right.
const PULL: f64 = 1e-3;

/// The least ratio of a new triangle's area to that of the equilateral one on its longest edge.
const LEAST_SHAPE: f64 = 0.12;

/// The least cosine between a triangle's normals before and after a collapse.
const LEAST_TURN: f64 = 0.3;

/// More edges than this at a vertex make flat fans that a subdivision scheme smooths badly.
const MOST_NEIGHBOURS: usize = 9;

/// A squared distance to a set of planes: pᵀAp − 2b·p + c, times their areas.
#[derive(Clone, Copy)]
struct Quadric {
    matrix: DMat3,
    vector: DVec3,
    constant: f64,
    area: f64,
}

impl Quadric {
    const ZERO: Self = Self {
        matrix: DMat3::ZERO,
        vector: DVec3::ZERO,
        constant: 0.0,
        area: 0.0,
    };

    fn of_triangle([a, b, c]: [DVec3; 3]) -> Self {
        let cross = (b - a).cross(c - a);
        let normal = cross.normalize_or_zero();
        let area = 0.5 * cross.length();
        let offset = normal.dot(a);
        let matrix = DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z);
        Self {
            matrix: matrix * area,
            vector: normal * (offset * area),
            constant: offset * offset * area,
            area,
        }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            matrix: self.matrix + other.matrix,
            vector: self.vector + other.vector,
            constant: self.constant + other.constant,
            area: self.area + other.area,
        }
    }

    fn at(&self, p: DVec3) -> f64 {
        p.dot(self.matrix * p) - 2.0 * p.dot(self.vector) + self.constant
    }

    /// The position of least error with a pull towards `middle`; in the plane x = 0 where `flat`.
    fn best(&self, middle: DVec3, flat: bool) -> DVec3 {
        let pull = PULL * self.area;
        let mut matrix = self.matrix + DMat3::from_diagonal(DVec3::splat(pull));
        let mut vector = self.vector + middle * pull;
        if flat {
            // Without the coupling between x and the rest, the solution has x = 0.
            matrix.x_axis = DVec3::X;
            matrix.y_axis.x = 0.0;
            matrix.z_axis.x = 0.0;
            vector.x = 0.0;
        }
        let mut best = matrix.inverse() * vector;
        if flat {
            best.x = 0.0;
        }
        best
    }
}

/// A possible collapse; the order is by cost, then by index, so that ties fall the same way everywhere.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Candidate {
    /// Bits of the cost, which is never negative: their order is that of the numbers.
    cost: u64,
    from: u32,
    to: u32,
    /// Versions of both ends when the cost was taken; a later one outdates the candidate.
    versions: [u32; 2],
}

struct Collapser<'a> {
    surface: &'a mut Surface,
    faces: Vec<Vec<u32>>,
    alive: Vec<bool>,
    quadrics: Vec<Quadric>,
    versions: Vec<u32>,
    queue: BinaryHeap<Reverse<Candidate>>,
    left: usize,
}

/// Collapses edges of a half, open along x = 0, until `triangles` are left or no edge may go.
pub(super) fn collapse_to(half: &mut Surface, triangles: usize) {
    let mut collapser = Collapser::new(half);
    while collapser.left > triangles {
        let Some(Reverse(candidate)) = collapser.queue.pop() else {
            break;
        };
        let Candidate {
            from, to, versions, ..
        } = candidate;
        if versions == [from, to].map(|v| collapser.versions[v as usize]) {
            collapser.try_collapse(from, to, triangles);
        }
    }
    let alive = collapser.alive;
    let mut keep = alive.iter();
    half.triangles
        .retain(|_| keep.next().copied().unwrap_or(false));
    half.drop_unused_vertices();
}

impl<'a> Collapser<'a> {
    fn new(surface: &'a mut Surface) -> Self {
        let faces = surface.faces_at_vertices();
        let mut quadrics = vec![Quadric::ZERO; surface.positions.len()];
        for t in &surface.triangles {
            let quadric = Quadric::of_triangle(t.map(|v| surface.positions[v as usize]));
            t.iter()
                .for_each(|&v| quadrics[v as usize] = quadrics[v as usize].plus(quadric));
        }
        let mut collapser = Self {
            alive: vec![true; surface.triangles.len()],
            versions: vec![0; surface.positions.len()],
            left: surface.triangles.len(),
            queue: BinaryHeap::new(),
            surface,
            faces,
            quadrics,
        };
        for v in 0..collapser.surface.positions.len() as u32 {
            collapser.queue_edges(v, |other| other > v);
        }
        collapser
    }

    fn position(&self, v: u32) -> DVec3 {
        self.surface.positions[v as usize]
    }

    fn in_mirror(&self, v: u32) -> bool {
        self.position(v).x == 0.0
    }

    fn neighbours(&self, v: u32) -> Vec<u32> {
        let mut others: Vec<u32> = self.faces[v as usize]
            .iter()
            .flat_map(|&face| self.surface.triangles[face as usize])
            .filter(|&other| other != v)
            .collect();
        others.sort_unstable();
        others.dedup();
        others
    }

    /// Where the two ends of an edge would meet, and at what cost.
    fn meeting_point(&self, a: u32, b: u32) -> (DVec3, f64) {
        let quadric = self.quadrics[a as usize].plus(self.quadrics[b as usize]);
        let (p, q) = (self.position(a), self.position(b));
        let flat = self.in_mirror(a) || self.in_mirror(b);
        let middle = match (self.in_mirror(a), self.in_mirror(b)) {
            (true, false) => p,
            (false, true) => q,
            _ => p.midpoint(q),
        };
        let best = quadric.best(middle, flat);
        let cost = quadric.at(best).max(0.0) + PULL * PULL * quadric.area * p.distance_squared(q);
        (best, cost)
    }

    fn queue_edges(&mut self, v: u32, wanted: impl Fn(u32) -> bool) {
        for other in self.neighbours(v) {
            if wanted(other) {
                let cost = self.meeting_point(v, other).1.to_bits();
                let versions = [v, other].map(|v| self.versions[v as usize]);
                self.queue.push(Reverse(Candidate {
                    cost,
                    from: v,
                    to: other,
                    versions,
                }));
            }
        }
    }

    fn try_collapse(&mut self, a: u32, b: u32, triangles: usize) {
        let around = |v: u32| self.neighbours(v);
        let (of_a, of_b) = (around(a), around(b));
        let shared_faces: Vec<u32> = self.faces[a as usize]
            .iter()
            .copied()
            .filter(|face| self.faces[b as usize].contains(face))
            .collect();
        let shared = of_a.iter().filter(|v| of_b.contains(v)).count();
        // The link condition: exactly the opposite vertices are shared, and two boundary vertices meet only along
        // the boundary.
        let along_boundary = shared_faces.len() == 1;
        let both_in_mirror = self.in_mirror(a) && self.in_mirror(b);
        if shared != shared_faces.len() || both_in_mirror != along_boundary {
            return;
        }
        // The merged vertex has the neighbours of both, without the two themselves and the shared ones.
        let merged = of_a.len() + of_b.len() - 2 - shared;
        let most = MOST_NEIGHBOURS.max(of_a.len()).max(of_b.len());
        if self.left - shared_faces.len() < triangles || merged > most {
            return;
        }
        let (target, _) = self.meeting_point(a, b);
        if target.x < 0.0 || !self.stays_sound(a, b, target) || !self.stays_sound(b, a, target) {
            return;
        }
        self.commit(a, b, target, &shared_faces);
    }

    /// Whether the faces of `v` that do not touch `other` stay well shaped and keep their side with `v` at
    /// `target`.
    fn stays_sound(&self, v: u32, other: u32, target: DVec3) -> bool {
        self.faces[v as usize].iter().all(|&face| {
            let triangle = self.surface.triangles[face as usize];
            if triangle.contains(&other) {
                return true;
            }
            let before = triangle.map(|u| self.position(u));
            let after = triangle.map(|u| if u == v { target } else { self.position(u) });
            // A triangle with all its corners in the mirror plane would lie on its own image.
            if after.iter().all(|p| p.x == 0.0) {
                return false;
            }
            let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
            let (old, new) = (normal(before), normal(after));
            let turned = old.dot(new) < LEAST_TURN * old.length() * new.length();
            !turned && (shape(after) >= LEAST_SHAPE || shape(after) >= shape(before))
        })
    }

    fn commit(&mut self, a: u32, b: u32, target: DVec3, shared_faces: &[u32]) {
        self.surface.positions[a as usize] = target;
        self.quadrics[a as usize] = self.quadrics[a as usize].plus(self.quadrics[b as usize]);
        for &face in shared_faces {
            self.alive[face as usize] = false;
            for v in self.surface.triangles[face as usize] {
                self.faces[v as usize].retain(|&f| f != face);
            }
        }
        self.left -= shared_faces.len();
        for face in core::mem::take(&mut self.faces[b as usize]) {
            for v in &mut self.surface.triangles[face as usize] {
                if *v == b {
                    *v = a;
                }
            }
            self.faces[a as usize].push(face);
        }
        self.faces[a as usize].sort_unstable();
        self.versions[b as usize] += 1;
        self.versions[a as usize] += 1;
        self.queue_edges(a, |_| true);
    }
}

/// Area over that of the equilateral triangle on the longest edge: 1 at best, 0 for a sliver.
pub(super) fn shape([a, b, c]: [DVec3; 3]) -> f64 {
    let longest = a
        .distance_squared(b)
        .max(b.distance_squared(c))
        .max(c.distance_squared(a));
    let doubled_area = (b - a).cross(c - a).length();
    // An equilateral triangle of edge s has doubled area s²·√3/2.
    doubled_area / (longest * 0.866_025_403_784_438_6)
}

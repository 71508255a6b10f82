//! The table of a replay, and its evaluation.
//!
//! A *job* gathers the control points that the surface over a control face depends on, once, and evaluates the face's vertices from
//! their differences to the first: each by three weighted sums, its position and two tangents, whose weights faces of the same shape
//! share; or, where many stand on one polynomial, all of them by its coefficients, which are weighted sums, too. Control vertices are
//! jobs of one place. What a job gives fills consecutive *slots*; each vertex knows its own.

use crate::limit::area_weighted_normal;
use crate::parallel;
use crate::patch::quartic::{Quartic, normals};
use crate::progress::uncancelled;
use crate::vector::{DVec3, unit_or_zero, vector};

/// Weights that are multiplied together.
pub(super) const LANES: usize = 4;

/// The sums of a row: of the position and of both tangents.
pub(super) const SUMS: usize = 3;

/// The coefficients of a polynomial.
pub(super) const COEFFICIENTS: usize = 15;

/// Places on polynomials are multiples of one over this.
pub(super) const WHOLE: f64 = 32768.0;

/// Slots that one call fills, about.
const SLOTS: usize = 2048;

/// Vertices that are taken from their slots together.
const TAKEN: usize = 1 << 14;

/// Rounding leaves no more of a cross product of tangents that is zero than this, by the square of the points' size.
const CROSS_ROUNDING: f64 = 1e-13;

/// Sizes of jobs whose fourth powers neither vanish nor overflow.
const SAFE_SIZES: core::ops::Range<f64> = 1e-60..1e60;

/// What is evaluated together.
#[derive(Clone, Copy, Debug)]
pub(super) struct Job {
    /// Control points.
    pub(super) points: u32,
    /// Places by rows of their own.
    pub(super) rows: u32,
    /// Polynomials.
    pub(super) pieces: u32,
}

/// A polynomial with many places.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// Where the weights of the coefficients start, in groups of [`LANES`].
    pub(super) weights: u32,
    pub(super) places: u32,
}

/// Where a run of jobs starts in each list.
#[derive(Clone, Copy, Debug, Default)]
struct At {
    job: usize,
    point: usize,
    row: usize,
    piece: usize,
    place: usize,
    slot: usize,
}

/// All that does not change from frame to frame.
#[derive(Debug, Default)]
pub(super) struct Table {
    /// Those of control vertices first.
    pub(super) jobs: Vec<Job>,
    pub(super) corner_jobs: usize,
    /// The control points of jobs; from the number of control vertices on the means of rings.
    pub(super) points: Vec<u32>,
    /// By place, where its weights start, in groups of [`LANES`].
    pub(super) rows: Vec<u32>,
    pub(super) pieces: Vec<Piece>,
    /// In multiples of 1 / [`WHOLE`].
    pub(super) places: Vec<[u16; 2]>,
    /// Of all points of a job but the first, filled up with zeros to whole groups.
    pub(super) weights: Vec<[f64; LANES]>,
    /// By start of a control vertex's weights, ascending, the first edge and the number of faces of its side.
    pub(super) sides: Vec<(u32, [u32; 2])>,
    /// Each vertex's slot.
    pub(super) slots: Vec<u32>,
    runs: Vec<At>,
}

/// Positions to be gathered.
pub(super) struct Inputs<'a> {
    pub(super) positions: &'a [[f64; 3]],
    pub(super) means: &'a [[f64; 3]],
}

impl Inputs<'_> {
    #[inline]
    fn at(&self, point: u32) -> DVec3 {
        let point = point as usize;
        vector(match self.positions.get(point) {
            Some(&position) => position,
            None => self.means[point - self.positions.len()],
        })
    }
}

/// The points of a job.
#[derive(Default)]
struct Gathered {
    first: DVec3,
    /// The differences of the others to it, by group and axis.
    differences: Vec<[[f64; LANES]; 3]>,
    /// Tangents are multiplied by this.
    scale: f64,
    /// Cross products whose squared length is not above this have no direction.
    least_square: f64,
}

impl Gathered {
    #[inline]
    fn gather(&mut self, points: &[u32], inputs: &Inputs<'_>) {
        let Some((&first, others)) = points.split_first() else { return };
        self.first = inputs.at(first);
        self.differences.clear();
        let mut greatest = DVec3::ZERO;
        for group in others.chunks(LANES) {
            let mut by_axis = [[0.0; LANES]; 3];
            for (lane, &point) in group.iter().enumerate() {
                let difference = inputs.at(point) - self.first;
                greatest = greatest.max(difference.abs());
                [by_axis[0][lane], by_axis[1][lane], by_axis[2][lane]] = difference.to_array();
            }
            self.differences.push(by_axis);
        }
        let size = greatest.max_element();
        self.scale = if SAFE_SIZES.contains(&size) { 1.0 } else { reciprocal(size) };
        let scaled = self.scale * size;
        // Coordinates far from the origin have fewer digits to spare for differences.
        let least = CROSS_ROUNDING * scaled * (scaled + self.scale * self.first.abs().max_element());
        self.least_square = least * least;
    }

    /// A weighted sum of the differences.
    #[inline]
    fn sum(&self, weights: &[[f64; LANES]]) -> [f64; 3] {
        let mut sums = [[0.0; LANES]; 3];
        for (weights, differences) in weights.iter().zip(&self.differences) {
            for (sums, differences) in sums.iter_mut().zip(differences) {
                for lane in 0..LANES {
                    sums[lane] += weights[lane] * differences[lane];
                }
            }
        }
        sums.map(|[a, b, c, d]| (a + b) + (c + d))
    }
}

/// The reciprocal of a size, as far as that is a number.
fn reciprocal(size: f64) -> f64 {
    let reciprocal = size.recip();
    if reciprocal.is_normal() { reciprocal } else { 1.0 }
}

impl Table {
    /// Cuts the jobs into runs, once they are all there.
    pub(super) fn finish(&mut self) {
        self.runs.clear();
        let mut at = At::default();
        let mut since = SLOTS;
        for (number, job) in self.jobs.iter().enumerate() {
            if since >= SLOTS {
                self.runs.push(At { job: number, ..at });
                since = 0;
            }
            let slot = at.slot;
            at.point += job.points as usize;
            at.row += job.rows as usize;
            at.slot += job.rows as usize;
            for piece in &self.pieces[at.piece..at.piece + job.pieces as usize] {
                at.place += piece.places as usize;
                at.slot += piece.places as usize;
            }
            at.piece += job.pieces as usize;
            since += at.slot - slot;
        }
        self.runs.push(At { job: self.jobs.len(), ..at });
    }

    /// Slots in all.
    pub(super) fn slot_count(&self) -> usize {
        self.runs.last().map_or(0, |end| end.slot)
    }

    /// Bytes that it takes.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.jobs[..])
            + size_of_val(&self.points[..])
            + size_of_val(&self.rows[..])
            + size_of_val(&self.pieces[..])
            + size_of_val(&self.places[..])
            + size_of_val(&self.weights[..])
            + size_of_val(&self.sides[..])
            + size_of_val(&self.slots[..])
            + size_of_val(&self.runs[..])
    }

    /// Fills all slots: positions, and normals where there is room for them.
    pub(super) fn fill(&self, inputs: &Inputs<'_>, positions: &mut [[f64; 3]], normals: &mut [[f64; 3]]) {
        let with_normals = !normals.is_empty();
        let (mut positions, mut normals) = (positions, normals);
        let mut runs = Vec::with_capacity(self.runs.len());
        for ends in self.runs.windows(2) {
            let count = ends[1].slot - ends[0].slot;
            let own = split_off(&mut positions, count);
            let own_normals = split_off(&mut normals, if with_normals { count } else { 0 });
            runs.push((ends[0], ends[1].job, own, own_normals));
        }
        let run = |(at, last, positions, normals): (At, usize, &mut [_], &mut [_])| match with_normals {
            true => self.run::<true>(inputs, (at, last), positions, normals),
            false => self.run::<false>(inputs, (at, last), positions, normals),
        };
        uncancelled(|_| parallel::each_polled(runs, &mut |_| Ok(()), run));
    }

    fn run<const NORMALS: bool>(
        &self,
        inputs: &Inputs<'_>,
        (from, last): (At, usize),
        positions: &mut [[f64; 3]],
        normals: &mut [[f64; 3]],
    ) {
        let (mut at, mut gathered) = (from, Gathered::default());
        for (number, job) in (from.job..).zip(&self.jobs[from.job..last]) {
            let points = &self.points[at.point..at.point + job.points as usize];
            gathered.gather(points, inputs);
            at.point += points.len();
            let rows = &self.rows[at.row..at.row + job.rows as usize];
            at.row += rows.len();
            let slots = at.slot - from.slot..at.slot - from.slot + rows.len();
            let own = if NORMALS { &mut normals[slots.clone()] } else { &mut [][..] };
            self.rows::<NORMALS>(&gathered, rows, &mut positions[slots], own);
            if NORMALS && number < self.corner_jobs {
                for (normal, &row) in own.iter_mut().zip(rows).filter(|(normal, _)| **normal == [0.0; 3]) {
                    *normal = self.average(row, points, inputs).to_array();
                }
            }
            at.slot += rows.len();
            for piece in &self.pieces[at.piece..at.piece + job.pieces as usize] {
                let places = &self.places[at.place..at.place + piece.places as usize];
                let slots = at.slot - from.slot..at.slot - from.slot + places.len();
                let own = if NORMALS { &mut normals[slots.clone()] } else { &mut [][..] };
                self.piece::<NORMALS>(&gathered, piece.weights, places, &mut positions[slots], own);
                at.place += places.len();
                at.slot += places.len();
            }
            at.piece += job.pieces as usize;
        }
    }

    /// Places by rows of their own.
    #[inline]
    fn rows<const NORMALS: bool>(
        &self,
        gathered: &Gathered,
        rows: &[u32],
        positions: &mut [[f64; 3]],
        unit: &mut [[f64; 3]],
    ) {
        let groups = gathered.differences.len();
        let first = gathered.first.to_array();
        for (start, rows) in (0..).step_by(LANES).zip(rows.chunks(LANES)) {
            let [mut s, mut t] = [[[0.0; LANES]; 3]; 2];
            for (lane, &row) in rows.iter().enumerate() {
                let weights = &self.weights[row as usize..][..SUMS * groups];
                let (of_position, of_tangents) = weights.split_at(groups);
                let difference = gathered.sum(of_position);
                positions[start + lane] = [0, 1, 2].map(|axis| first[axis] + difference[axis]);
                if NORMALS {
                    let (of_first, of_second) = of_tangents.split_at(groups);
                    let [by_u, by_v] = [gathered.sum(of_first), gathered.sum(of_second)];
                    for axis in 0..3 {
                        s[axis][lane] = gathered.scale * by_u[axis];
                        t[axis][lane] = gathered.scale * by_v[axis];
                    }
                }
            }
            if NORMALS {
                let [x, y, z] = normals(&s, &t, gathered.least_square);
                for (lane, normal) in unit[start..].iter_mut().take(rows.len()).enumerate() {
                    *normal = [x[lane], y[lane], z[lane]];
                }
            }
        }
    }

    /// Places on a polynomial.
    #[inline]
    fn piece<const NORMALS: bool>(
        &self,
        gathered: &Gathered,
        weights: u32,
        places: &[[u16; 2]],
        positions: &mut [[f64; 3]],
        unit: &mut [[f64; 3]],
    ) {
        const TOGETHER: usize = 2 * LANES;
        let groups = gathered.differences.len();
        let weights = &self.weights[weights as usize..][..COEFFICIENTS * groups];
        let mut coefficients = [DVec3::ZERO; COEFFICIENTS];
        for (i, coefficient) in coefficients.iter_mut().enumerate() {
            *coefficient = vector(gathered.sum(&weights[i * groups..(i + 1) * groups]));
        }
        coefficients[0] += gathered.first;
        let piece = Quartic::with_scale(coefficients);
        for (start, places) in (0..).step_by(TOGETHER).zip(places.chunks(TOGETHER)) {
            let [mut u, mut v] = [[0.0; TOGETHER]; 2];
            for (lane, place) in places.iter().enumerate() {
                [u[lane], v[lane]] = place.map(|weight| f64::from(weight) / WHOLE);
            }
            let [points, found] = match NORMALS {
                true => piece.points_and_normals_at(&u, &v),
                false => [piece.points_at(&u, &v, 3), [[0.0; TOGETHER]; 3]],
            };
            for lane in 0..places.len() {
                positions[start + lane] = points.map(|axis| axis[lane]);
                if NORMALS {
                    unit[start + lane] = found.map(|axis| axis[lane]);
                }
            }
        }
    }

    /// What stands for the normal at a control vertex without a tangent plane: the average of the faces' on its side.
    #[cold]
    fn average(&self, row: u32, points: &[u32], inputs: &Inputs<'_>) -> DVec3 {
        let Ok(at) = self.sides.binary_search_by_key(&row, |&(row, _)| row) else { return DVec3::ZERO };
        let [first, faces] = self.sides[at].1;
        let Some((&vertex, ring)) = points.split_first() else { return DVec3::ZERO };
        let centre = inputs.at(vertex);
        let edge = |slot: u32| inputs.at(ring[slot as usize % ring.len()]) - centre;
        let faces: Vec<[DVec3; 2]> =
            (first..first + faces).map(|slot| [edge(slot), edge(slot + 1)]).collect();
        area_weighted_normal(&faces)
    }

    /// The vertices' values, from their slots.
    pub(super) fn take(&self, slots: &[[f64; 3]], vertices: &mut [[f64; 3]]) {
        parallel::for_each_chunk(vertices, TAKEN, |chunk, vertices| {
            let own = &self.slots[chunk * TAKEN..];
            vertices.iter_mut().zip(own).for_each(|(vertex, &slot)| *vertex = slots[slot as usize]);
        });
    }
}

/// The unit vector along the sum of some, zero where it vanishes.
pub(super) fn average(normals: impl Iterator<Item = [f64; 3]>) -> [f64; 3] {
    unit_or_zero(normals.map(vector).sum()).to_array()
}

fn split_off<'a, T>(slice: &mut &'a mut [T], count: usize) -> &'a mut [T] {
    let (head, tail) = core::mem::take(slice).split_at_mut(count);
    *slice = tail;
    head
}

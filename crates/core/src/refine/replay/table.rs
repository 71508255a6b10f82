//! The table of a replay, and its evaluation.
//!
//! A *job* gathers the control points that the surface over a control face depends on, once, and
//! evaluates the face's vertices from their differences to the first: each by three weighted sums,
//! its position and two tangents, whose weights faces of the same shape share; or, where many are
//! on one polynomial, all of them by its coefficients, which are weighted sums, too. Control
//! vertices are jobs of one place. The results of a job fill consecutive *slots*; each vertex has
//! the number of its slot.

use crate::limit::area_weighted_normal;
use crate::parallel;
use crate::patch::Quartic;
use crate::progress::uncancelled;
use crate::vector::{DVec3, unit_or_zero, vector};
use wide::f64x4;

/// Weights that are multiplied together.
pub(super) const LANES: usize = 4;

/// The sums of a row: of the position and of both tangents.
pub(super) const SUMS: usize = 3;

/// The coefficients of a polynomial.
pub(super) const COEFFICIENTS: usize = 15;

/// Places on polynomials are multiples of one over this.
pub(super) const WHOLE: f64 = 32768.0;

/// Places whose polynomials are evaluated together, and normals that are divided by their lengths together.
const TOGETHER: usize = 2 * LANES;

/// Slots that one call fills, about.
const SLOTS: usize = 2048;

/// Vertices that are taken from their slots together.
const TAKEN: usize = 1 << 14;

/// Rounding leaves no more of a cross product of tangents that is zero than this, by the square of the points' size.
const CROSS_ROUNDING: f64 = 1e-13;

/// Sizes of jobs whose fourth powers neither vanish nor overflow.
const SAFE_SIZES: core::ops::Range<f64> = 1e-60..1e60;

/// The places that are evaluated together.
#[derive(Clone, Copy, Debug)]
pub(super) struct Job {
    /// Control points.
    pub(super) points: u32,
    /// Places by rows of their own.
    pub(super) rows: u32,
    /// Polynomials.
    pub(super) pieces: u32,
}

impl Job {
    /// Its points with those that fill groups up.
    fn slots(&self) -> usize {
        1 + LANES * groups(self.points as usize)
    }
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
    /// The jobs, those of control vertices first.
    pub(super) jobs: Vec<Job>,
    pub(super) corner_jobs: usize,
    /// The control points of jobs, each but the first in groups that are filled up with the first, where weights are zero; from the
    /// number of control vertices on the means of rings.
    pub(super) points: Vec<u32>,
    /// By place, where its weights start, in groups of [`LANES`].
    pub(super) rows: Vec<u32>,
    pub(super) pieces: Vec<Piece>,
    /// In multiples of 1 / [`WHOLE`].
    pub(super) places: Vec<[u16; 2]>,
    /// Of all points of a job but the first, filled up with zeros to whole groups.
    pub(super) weights: Vec<[f64; LANES]>,
    /// By start of a control vertex's weights, ascending, the first edge and the number of faces of its side, and the vertex's edges.
    pub(super) sides: Vec<(u32, [u32; 3])>,
    /// Each vertex's slot.
    pub(super) slots: Vec<u32>,
    runs: Vec<At>,
}

/// Positions to be gathered, those of the control vertices and then the means of rings, with a zero behind each.
pub(super) type Inputs = [[f64; LANES]];

/// A point of the inputs.
#[inline]
fn input(inputs: &Inputs, point: u32) -> DVec3 {
    let [x, y, z, _] = inputs[point as usize];
    DVec3::new(x, y, z)
}

/// Groups of the weights of points, except for the first.
pub(super) fn groups(points: usize) -> usize {
    points.saturating_sub(1).div_ceil(LANES)
}

/// The points of a job.
#[derive(Default)]
struct Gathered {
    first: [f64; 3],
    /// The differences of the others to it, by group and axis.
    differences: Vec<[f64x4; 3]>,
    /// Tangents are multiplied by this.
    scale: f64,
    /// Cross products whose squared length is not above this have no direction.
    least_square: f64,
}

impl Gathered {
    /// Takes the first of the points and the differences of all others to it, in whole groups.
    #[inline]
    fn gather<const NORMALS: bool>(&mut self, points: &[u32], inputs: &Inputs) {
        let Some((&first, others)) = points.split_first() else {
            return;
        };
        let first = f64x4::from(inputs[first as usize]);
        let [x, y, z, _] = first.to_array();
        self.first = [x, y, z];
        self.differences.clear();
        let mut greatest = f64x4::ZERO;
        for group in others.as_chunks::<LANES>().0 {
            let differences = group.map(|point| f64x4::from(inputs[point as usize]) - first);
            if NORMALS {
                let [a, b, c, d] = differences.map(f64x4::abs);
                greatest = greatest.fast_max(a.fast_max(b).fast_max(c.fast_max(d)));
            }
            let [x, y, z, _] = f64x4::transpose(differences);
            self.differences.push([x, y, z]);
        }
        if NORMALS {
            self.measure(greatest, first.abs());
        }
    }

    /// The factor of tangents, and the bound below which they span no plane, by the greatest
    /// differences and their common point.
    #[inline]
    fn measure(&mut self, differences: f64x4, first: f64x4) {
        let [size, first] = [differences, first].map(|of| {
            let [x, y, z, _] = of.to_array();
            x.max(y).max(z)
        });
        self.scale = if SAFE_SIZES.contains(&size) {
            1.0
        } else {
            reciprocal(size)
        };
        let scaled = self.scale * size;
        // Coordinates far from the origin have fewer digits to spare for differences.
        let least = CROSS_ROUNDING * scaled * (scaled + self.scale * first);
        self.least_square = least * least;
    }

    /// A weighted sum of the differences. The compiler would pair axes instead of weights if it were left to it, which takes half as
    /// long again.
    #[inline]
    fn sum(&self, weights: &[[f64; LANES]]) -> [f64; 3] {
        let mut sums = [f64x4::ZERO; 3];
        for (&weights, differences) in weights.iter().zip(&self.differences) {
            let weights = f64x4::from(weights);
            for (sum, &difference) in sums.iter_mut().zip(differences) {
                *sum += weights * difference;
            }
        }
        sums.map(|sum| {
            let [a, b, c, d] = sum.to_array();
            (a + c) + (b + d)
        })
    }
}

/// A place, by the weights of its position and both tangents.
struct Row<'a> {
    gathered: &'a Gathered,
    position: &'a [[f64; LANES]],
    tangents: (&'a [[f64; LANES]], &'a [[f64; LANES]]),
}

impl Row<'_> {
    #[inline]
    fn position(&self) -> [f64; 3] {
        let ([a, b, c], [x, y, z]) = (self.gathered.first, self.gathered.sum(self.position));
        [a + x, b + y, c + z]
    }

    /// The cross product of the tangents, with the square of its length; `None` where they span no
    /// plane.
    #[inline]
    fn cross_product(&self) -> Option<([f64; 3], f64)> {
        let scale = self.gathered.scale;
        let s = self.gathered.sum(self.tangents.0).map(|s| scale * s);
        let t = self.gathered.sum(self.tangents.1).map(|t| scale * t);
        let [x, y, z] = [
            s[1] * t[2] - s[2] * t[1],
            s[2] * t[0] - s[0] * t[2],
            s[0] * t[1] - s[1] * t[0],
        ];
        let square = x * x + y * y + z * z;
        (square > self.gathered.least_square).then_some(([x, y, z], square))
    }
}

/// Normals that wait to be divided by their lengths, together.
#[derive(Default)]
struct Pending {
    slots: [usize; TOGETHER],
    by_axis: [[f64; TOGETHER]; 3],
    squares: [f64; TOGETHER],
    count: usize,
}

impl Pending {
    #[inline]
    fn add(&mut self, slot: usize, cross: [f64; 3], square: f64, normals: &mut [[f64; 3]]) {
        let at = self.count % TOGETHER;
        self.slots[at] = slot;
        self.squares[at] = square;
        for (lanes, value) in self.by_axis.iter_mut().zip(cross) {
            lanes[at] = value;
        }
        self.count = at + 1;
        if self.count == TOGETHER {
            self.divide(normals);
        }
    }

    fn divide(&mut self, normals: &mut [[f64; 3]]) {
        let factors = self.squares.map(|square| 1.0 / square.sqrt());
        let [x, y, z] = self.by_axis;
        for (at, &slot) in self.slots[..self.count].iter().enumerate() {
            normals[slot] = [
                x[at] * factors[at],
                y[at] * factors[at],
                z[at] * factors[at],
            ];
        }
        self.count = 0;
    }
}

/// The reciprocal of a size, as far as that is a number.
fn reciprocal(size: f64) -> f64 {
    let reciprocal = size.recip();
    if reciprocal.is_normal() {
        reciprocal
    } else {
        1.0
    }
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
            at.point += job.slots();
            at.row += job.rows as usize;
            at.slot += job.rows as usize;
            for piece in &self.pieces[at.piece..at.piece + job.pieces as usize] {
                at.place += piece.places as usize;
                at.slot += piece.places as usize;
            }
            at.piece += job.pieces as usize;
            since += at.slot - slot;
        }
        self.runs.push(At {
            job: self.jobs.len(),
            ..at
        });
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
    pub(super) fn fill(
        &self,
        inputs: &Inputs,
        positions: &mut [[f64; 3]],
        normals: &mut [[f64; 3]],
    ) {
        let with_normals = !normals.is_empty();
        let (mut positions, mut normals) = (positions, normals);
        let mut runs = Vec::with_capacity(self.runs.len());
        for ends in self.runs.windows(2) {
            let count = ends[1].slot - ends[0].slot;
            let own = split_off(&mut positions, count);
            let own_normals = split_off(&mut normals, if with_normals { count } else { 0 });
            runs.push((ends[0], ends[1].job, own, own_normals));
        }
        let run =
            |(at, last, positions, normals): (At, usize, &mut [_], &mut [_])| match with_normals {
                true => self.run::<true>(inputs, at, last, positions, normals),
                false => self.run::<false>(inputs, at, last, positions, normals),
            };
        uncancelled(|_| parallel::each_polled(runs, &mut |_| Ok(()), run));
    }

    fn run<const NORMALS: bool>(
        &self,
        inputs: &Inputs,
        from: At,
        last: usize,
        positions: &mut [[f64; 3]],
        normals: &mut [[f64; 3]],
    ) {
        let (mut at, mut gathered, mut pending) = (from, Gathered::default(), Pending::default());
        for (number, job) in (from.job..).zip(&self.jobs[from.job..last]) {
            let points = &self.points[at.point..at.point + job.slots()];
            gathered.gather::<NORMALS>(points, inputs);
            at.point += points.len();
            for &row in &self.rows[at.row..at.row + job.rows as usize] {
                let slot = at.slot - from.slot;
                let sums = self.row(&gathered, row);
                positions[slot] = sums.position();
                if NORMALS {
                    match sums.cross_product() {
                        Some((cross, square)) => pending.add(slot, cross, square, normals),
                        None if number < self.corner_jobs => {
                            normals[slot] = self
                                .average(row, &points[..job.points as usize], inputs)
                                .to_array();
                        }
                        None => normals[slot] = [0.0; 3],
                    }
                }
                at.slot += 1;
            }
            at.row += job.rows as usize;
            for piece in &self.pieces[at.piece..at.piece + job.pieces as usize] {
                let places = &self.places[at.place..at.place + piece.places as usize];
                let slots = at.slot - from.slot..at.slot - from.slot + places.len();
                let own = if NORMALS {
                    &mut normals[slots.clone()]
                } else {
                    &mut [][..]
                };
                self.piece::<NORMALS>(&gathered, piece.weights, places, &mut positions[slots], own);
                at.place += places.len();
                at.slot += places.len();
            }
            at.piece += job.pieces as usize;
        }
        pending.divide(normals);
    }

    /// The sums of a place with a row of its own.
    #[inline]
    fn row<'a>(&'a self, gathered: &'a Gathered, row: u32) -> Row<'a> {
        let groups = gathered.differences.len();
        let (position, tangents) = self.weights[row as usize..][..SUMS * groups].split_at(groups);
        Row {
            gathered,
            position,
            tangents: tangents.split_at(groups),
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
        let groups = gathered.differences.len();
        let weights = &self.weights[weights as usize..][..COEFFICIENTS * groups];
        let mut coefficients = [DVec3::ZERO; COEFFICIENTS];
        for (i, coefficient) in coefficients.iter_mut().enumerate() {
            *coefficient = vector(gathered.sum(&weights[i * groups..(i + 1) * groups]));
        }
        coefficients[0] += vector(gathered.first);
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

    /// The normal at a control vertex without a tangent plane: the average of the faces' on its
    /// side.
    #[cold]
    fn average(&self, row: u32, points: &[u32], inputs: &Inputs) -> DVec3 {
        let Ok(at) = self.sides.binary_search_by_key(&row, |&(row, _)| row) else {
            return DVec3::ZERO;
        };
        let [first, faces, edges] = self.sides[at].1;
        let Some((&vertex, ring)) = points.split_first() else {
            return DVec3::ZERO;
        };
        let centre = input(inputs, vertex);
        let edge = |slot: u32| input(inputs, ring[(slot % edges) as usize]) - centre;
        let faces: Vec<[DVec3; 2]> = (first..first + faces)
            .map(|slot| [edge(slot), edge(slot + 1)])
            .collect();
        area_weighted_normal(&faces)
    }

    /// The vertices' values, from their slots.
    pub(super) fn take(&self, slots: &[[f64; 3]], vertices: &mut [[f64; 3]]) {
        parallel::for_each_chunk(vertices, TAKEN, |chunk, vertices| {
            let own = &self.slots[chunk * TAKEN..];
            vertices
                .iter_mut()
                .zip(own)
                .for_each(|(vertex, &slot)| *vertex = slots[slot as usize]);
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

//! The system of control points for given limits over the whole mesh, solved block by block.
//!
//! Unknown is the displacement d of the control points; with the limit weights A and the mesh's
//! vertices v, A·(v + d) = v + y, where y is the offset of limits from the vertices: zero, if the
//! surface passes through them. As the weights of a row sum to 1, the right side v − A·v + y is a
//! sum of differences of neighbours and does not lose digits to coordinates far from the origin.
//!
//! Copies of a vertex on sheets that were cut apart are one unknown, that of the first of them.

use super::blocks::Blocks;
use super::fairness::{self, Bounds, Energies, Energy, Found};
use super::planes::kept_in_planes;
use super::spacing::even;
use super::sparse::{Sparse, greatest};
use super::system::{Solution, Solver, System};
use crate::index::VertexId;
use crate::limit::LimitRows;
use crate::math;
use crate::mesh::{Mesh, Sharpness};
use crate::parallel::{self, Poll};
use crate::progress::{Cancelled, Watch};
use crate::row::summed;
use crate::vector::{DVec3, vector};
use std::collections::{HashMap, HashSet};

/// Residuals below this, relative to the greatest distance of a limit from its vertex, are zero.
const ACCURACY: f64 = 1e-14;

/// Residuals below this, relative to the greatest coordinate, are within rounding.
const ROUNDING: f64 = 1e-17;

/// Units in the last place that rounding the control points and adding up a limit can make.
const ROUNDINGS: f64 = 16.0;

/// Unknowns of blocks of one between two calls of the observer.
const SINGLES: usize = 1 << 12;

/// How far control points are moved, and how that was found.
pub(super) struct Moved {
    /// By vertex.
    pub(super) by: Vec<DVec3>,
    /// By vertex, how far its limit was to be from it, or was chosen to be.
    pub(super) away: Vec<DVec3>,
    pub(super) solver: Solver,
    /// Steps of conjugate gradients for the block that took most.
    pub(super) steps: usize,
    /// Where limits may leave their vertices.
    pub(super) energies: Option<Energies>,
}

/// Where the limits of vertices are to be.
pub(super) enum Limits<'a> {
    /// At these offsets from them, by vertex.
    At(&'a [DVec3]),
    /// Within a reach of each, and as fair as they can be.
    Near(&'a Near<'a>),
}

/// How far limits may be from their vertices.
pub(super) struct Near<'a> {
    /// By vertex.
    pub(super) reach: &'a [f64],
    /// The weight of nearness relative to fairness.
    pub(super) nearness: f64,
    /// How much less fair than possible they may be, relative to limits at the vertices.
    pub(super) nothing: f64,
    /// By vertex, how far limits are from them to begin with.
    pub(super) from: &'a [DVec3],
}

/// How blocks are solved.
enum Way<'a> {
    /// For limits at these offsets from their vertices.
    At(&'a [DVec3]),
    /// For the fairest.
    Near {
        near: &'a Near<'a>,
        reaches: Vec<f64>,
        energies: BlockEnergies,
    },
}

/// The system of a mesh, its lengths multiplied by `unit`.
pub(super) struct ControlPoints<'m> {
    mesh: &'m Mesh,
    sharpness: Sharpness<'m>,
    /// The first copy of each vertex.
    first_copy: Vec<u32>,
    /// Where some vertices keep their place, the rows of all.
    rows: Option<Sparse>,
    matrix: Sparse,
    /// First copies of the kept vertices, whatever their limits.
    kept: HashSet<u32>,
    /// The relaxed vertices, and first copies whose rows are for an adjacent edge that is shorter
    /// than theirs.
    relaxed: HashSet<u32>,
    /// First copies that keep their place though their limit is elsewhere in its plane, with the unit normal of that.
    planes: HashMap<u32, DVec3>,
    points: Vec<DVec3>,
    unit: f64,
}

impl<'m> ControlPoints<'m> {
    pub(crate) fn new(
        mesh: &'m Mesh,
        rows: LimitRows,
        kept: &[VertexId],
        poll: &mut Poll<'_>,
    ) -> Result<Self, Cancelled> {
        let mut first_copy: Vec<u32> = (0..mesh.vertex_count() as u32).collect();
        for group in mesh.junctions().vertices.iter() {
            let first = group.iter().copied().min().unwrap_or(0);
            group
                .iter()
                .for_each(|&copy| first_copy[copy as usize] = first);
        }
        let kept: HashSet<u32> = kept.iter().map(|v| first_copy[v.index()]).collect();
        let mut rows = of_first_copies(rows, &first_copy);
        if !kept.is_empty() {
            rows = keeping(&rows, |v| kept.contains(&v));
        }
        let sharpness = Sharpness::of(mesh);
        let planes = kept_in_planes(&rows, mesh, &sharpness, poll)?;
        let unit = unit(mesh);
        let points = mesh.positions().iter().map(|&p| vector(p) * unit).collect();
        let (matrix, relaxed) = (Sparse::empty(), HashSet::new());
        let mut found = Self {
            mesh,
            sharpness,
            first_copy,
            rows: None,
            matrix,
            kept,
            relaxed,
            planes,
            points,
            unit,
        };
        found.set(rows, poll)?;
        Ok(found)
    }

    /// Sets the system, the rows of all first copies given.
    fn set(&mut self, rows: Sparse, poll: &mut Poll<'_>) -> Result<(), Cancelled> {
        (self.matrix, self.rows) = match self.planes.is_empty() {
            true => (rows, None),
            false => (keeping(&rows, |v| self.planes.contains_key(&v)), Some(rows)),
        };
        self.relaxed = even(&mut self.matrix, self.mesh, &self.sharpness, poll)?;
        self.relaxed.extend(&self.kept);
        Ok(())
    }

    /// Vertices that keep their place though the surface is not in their plane, which is more than `most` away from them, are led through from
    /// now on, in the last attempt all; says whether there were any.
    pub(super) fn lead_through(
        &mut self,
        limits: &[[f64; 3]],
        (most, is_last): (f64, bool),
        poll: &mut Poll<'_>,
    ) -> Result<bool, Cancelled> {
        let before = self.planes.len();
        let off = |v: u32| vector(limits[v as usize]) - vector(self.mesh.positions()[v as usize]);
        self.planes
            .retain(|&v, normal| off(v).dot(*normal).abs() <= most);
        if self.planes.len() == before {
            return Ok(false);
        }
        if is_last {
            self.planes.clear();
        }
        if let Some(rows) = self.rows.take() {
            self.set(rows, poll)?;
        }
        Ok(true)
    }

    /// The distance of the surface from a vertex whose limit is at this offset: only across its
    /// plane where its control point is kept, and zero where it is relaxed.
    pub(super) fn missed(&self, v: usize, away: DVec3) -> DVec3 {
        let first = self.first_copy[v];
        match self.planes.get(&first) {
            _ if self.relaxed.contains(&first) => DVec3::ZERO,
            Some(&normal) => away.dot(normal) * normal,
            None => away,
        }
    }

    /// The relaxed vertices, ascending.
    pub(super) fn relaxed(&self) -> Vec<VertexId> {
        if self.relaxed.is_empty() {
            return Vec::new();
        }
        let all = (0..)
            .zip(&self.first_copy)
            .filter(|(_, first)| self.relaxed.contains(first));
        all.map(|(v, _)| VertexId(v)).collect()
    }

    /// Whether all limits are the vertices themselves, so that there is nothing to do.
    pub(super) fn is_solved(&self) -> bool {
        (0..self.matrix.rows()).all(|v| self.stays(v))
    }

    /// Whether a vertex and all its copies keep their place.
    pub(super) fn is_fixed(&self, v: usize) -> bool {
        self.stays(self.first_copy[v] as usize)
    }

    /// Whether a limit position is the vertex itself, whatever the others. Further copies have no
    /// row.
    fn stays(&self, v: usize) -> bool {
        self.first_copy[v] != v as u32 || self.matrix.row(v).eq([(v as u32, 1.0)])
    }

    /// Solves for the control points of given limits, or of the fairest near the vertices.
    pub(crate) fn solve(
        &self,
        limits: &Limits<'_>,
        watch: &mut Watch<'_>,
    ) -> Result<Moved, Cancelled> {
        let n = self.points.len();
        let poll: &mut Poll<'_> = &mut |_| watch.poll();
        let to_vertices = parallel::map_polled(n, poll, |v| self.to_vertex(v))?;
        let farthest = greatest(n, poll, |v| to_vertices[v].abs().max_element())?;
        let goal = (ACCURACY * farthest).max(ROUNDING);
        let blocks = Blocks::of(&self.matrix);
        let way = match *limits {
            Limits::At(away) => Way::At(away),
            Limits::Near(near) => Way::Near {
                near,
                reaches: self.reaches(near),
                energies: BlockEnergies::new(self.mesh, &self.first_copy, &blocks),
            },
        };
        let energies = matches!(way, Way::Near { .. }).then(Energies::default);
        let nowhere = vec![DVec3::ZERO; n];
        let mut moved = Moved {
            by: nowhere.clone(),
            away: nowhere,
            solver: Solver::Symmetric,
            steps: 0,
            energies,
        };
        let mut done = 0;
        for (number, block) in blocks.iter().enumerate() {
            done += block.len();
            if let [v] = *block
                && self.stays(v as usize)
            {
                if done.is_multiple_of(SINGLES) {
                    watch.done(done)?;
                }
                continue;
            }
            let system = self.system_of(block, &blocks, &to_vertices, &moved.by);
            let poll: &mut Poll<'_> = &mut |_| watch.poll();
            let found =
                self.solve_block((number, &blocks), (&way, system), &moved.by, goal, poll)?;
            let Found {
                solution: Solution { x, steps, solver },
                away,
                energies,
            } = found;
            for ((&v, by), away) in block.iter().zip(x).zip(away) {
                (moved.by[v as usize], moved.away[v as usize]) = (by, away / self.unit);
            }
            moved.energies.iter_mut().for_each(|all| all.add(energies));
            moved.steps = moved.steps.max(steps);
            moved.solver = moved.solver.max(solver);
            watch.done(done)?;
        }
        for v in 0..n {
            let first = self.first_copy[v] as usize;
            (moved.by[v], moved.away[v]) = (moved.by[first], moved.away[first]);
        }
        Ok(moved)
    }

    /// Solves the system of a block, whose right side is that of limits at the vertices. Earlier
    /// blocks are moved `by` known offsets.
    fn solve_block(
        &self,
        (number, blocks): (usize, &Blocks),
        (way, (system, mut right)): (&Way<'_>, (System, Vec<DVec3>)),
        by: &[DVec3],
        goal: f64,
        poll: &mut Poll<'_>,
    ) -> Result<Found, Cancelled> {
        let block = blocks.block(number);
        let scaled = |away: &[DVec3]| {
            block
                .iter()
                .map(|&v| self.unit * away[v as usize])
                .collect()
        };
        match way {
            Way::At(away) => {
                let away: Vec<DVec3> = scaled(away);
                right
                    .iter_mut()
                    .zip(&away)
                    .for_each(|(b, &away)| *b += away);
                let solution = system.solve(&right, vec![DVec3::ZERO; block.len()], goal, poll)?;
                Ok(Found {
                    solution,
                    away,
                    energies: Energies::default(),
                })
            }
            Way::Near {
                near,
                reaches,
                energies,
            } => {
                let energy = energies.of(number, blocks, &self.points, by);
                let reach: Vec<f64> = block.iter().map(|&v| reaches[v as usize]).collect();
                let bounds = Bounds {
                    reach: &reach,
                    nearness: near.nearness,
                    nothing: near.nothing,
                };
                fairness::solve(
                    &system,
                    &energy,
                    &right,
                    (&bounds, scaled(near.from)),
                    goal,
                    poll,
                )
            }
        }
    }

    /// By first copy, how far the limits of all copies may be from them, in the system's unit.
    fn reaches(&self, near: &Near<'_>) -> Vec<f64> {
        let mut reaches = vec![f64::INFINITY; near.reach.len()];
        for (&first, reach) in self.first_copy.iter().zip(near.reach) {
            let of_first = &mut reaches[first as usize];
            *of_first = of_first.min(reach * self.unit);
        }
        reaches
    }

    /// The system of a block, and its right side with the known offsets of earlier blocks.
    fn system_of(
        &self,
        block: &[u32],
        blocks: &Blocks,
        away: &[DVec3],
        by: &[DVec3],
    ) -> (System, Vec<DVec3>) {
        let number = block.first().map_or(0, |&v| blocks.number(v));
        let mut inside = Sparse::empty();
        let mut right = Vec::with_capacity(block.len());
        for &v in block {
            let is_inside = |&(u, _): &(u32, f64)| blocks.number(u) == number;
            let row = self.matrix.row(v as usize);
            let known = row
                .clone()
                .filter(|entry| !is_inside(entry))
                .map(|(u, w)| w * by[u as usize]);
            right.push(away[v as usize] - known.sum::<DVec3>());
            inside.push(row.filter(is_inside).map(|(u, w)| (blocks.place(u), w)));
        }
        (System::new(inside), right)
    }

    /// From the limit of a vertex, as the mesh is, to the vertex.
    fn to_vertex(&self, v: usize) -> DVec3 {
        let towards = |(u, weight): (u32, f64)| weight * (self.points[v] - self.points[u as usize]);
        self.matrix.row(v).map(towards).sum()
    }

    /// The rounding error of limits at their vertices: some units in the last place of the greatest
    /// coordinate.
    pub(super) fn rounding(&self) -> f64 {
        ROUNDINGS * f64::EPSILON / self.unit
    }

    /// The position of a control point.
    pub(super) fn position(&self, v: usize, by: DVec3) -> [f64; 3] {
        let from = self.mesh.positions()[v];
        // A vertex that does not move keeps its bits.
        if by == DVec3::ZERO {
            from
        } else {
            (vector(from) + by / self.unit).to_array()
        }
    }
}

/// A power of two that brings coordinates near 1, so that no square overflows or vanishes.
fn unit(mesh: &Mesh) -> f64 {
    let greatest = mesh
        .positions()
        .as_flattened()
        .iter()
        .fold(0.0f64, |most, x| most.max(x.abs()));
    if greatest == 0.0 {
        return 1.0;
    }
    // One step short of the ends of the range, where the factor itself would not be a number.
    math::powi(
        2.0,
        (-math::log2(greatest).floor() as i32).clamp(-1020, 1020),
    )
}

/// The rows of the first copies, on first copies; those of others are empty.
fn of_first_copies(rows: LimitRows, first_copy: &[u32]) -> Sparse {
    let rows = Sparse::from(rows);
    let mut matrix = Sparse::empty();
    for (v, &first) in (0..).zip(first_copy) {
        if first != v {
            matrix.push([]);
            continue;
        }
        matrix.push(summed(
            rows.row(v as usize)
                .map(|(u, w)| (first_copy[u as usize], w))
                .collect(),
        ));
    }
    matrix
}

/// The rows, except for vertices that keep their control point.
fn keeping(rows: &Sparse, is_kept: impl Fn(u32) -> bool) -> Sparse {
    let mut matrix = Sparse::empty();
    for v in 0..rows.rows() as u32 {
        match is_kept(v) {
            true => matrix.push([(v, 1.0)]),
            false => matrix.push(rows.row(v as usize)),
        }
    }
    matrix
}

/// The rows of the energy by the block in which their last point is found.
struct BlockEnergies {
    rows: Sparse,
    starts: Vec<u32>,
    by_block: Vec<u32>,
}

impl BlockEnergies {
    fn new(mesh: &Mesh, first_copy: &[u32], blocks: &Blocks) -> Self {
        let rows = fairness::rows(mesh, first_copy);
        let last = |row: u32| {
            rows.columns(row as usize)
                .iter()
                .map(|&u| blocks.number(u) as usize)
                .max()
        };
        let mut starts = vec![0u32; blocks.len() + 1];
        (0..rows.rows() as u32)
            .filter_map(last)
            .for_each(|block| starts[block + 1] += 1);
        for block in 0..blocks.len() {
            starts[block + 1] += starts[block];
        }
        let mut next = starts.clone();
        let mut by_block = vec![0; starts[blocks.len()] as usize];
        for row in 0..rows.rows() as u32 {
            if let Some(block) = last(row) {
                by_block[next[block] as usize] = row;
                next[block] += 1;
            }
        }
        Self {
            rows,
            starts,
            by_block,
        }
    }

    /// The energy of a block, those before it known.
    fn of(&self, number: usize, blocks: &Blocks, points: &[DVec3], by: &[DVec3]) -> Energy {
        let (mut inside, mut known) = (Sparse::empty(), Vec::new());
        for &row in &self.by_block[self.starts[number] as usize..self.starts[number + 1] as usize] {
            let row = self.rows.row(row as usize);
            // The weights of a row sum to 0: only differences count.
            let origin = row
                .clone()
                .next()
                .map_or(DVec3::ZERO, |(u, _)| points[u as usize]);
            let is_inside = |u: u32| blocks.number(u) as usize == number;
            let weighted = |(u, weight): (u32, f64)| {
                let moved = if is_inside(u) {
                    DVec3::ZERO
                } else {
                    by[u as usize]
                };
                weight * (points[u as usize] - origin + moved)
            };
            known.push(row.clone().map(weighted).sum());
            inside.push(
                row.filter(|&(u, _)| is_inside(u))
                    .map(|(u, w)| (blocks.place(u), w)),
            );
        }
        Energy::new(inside, known, blocks.block(number).len())
    }
}

//! The fairest control points whose limits are near given points: a convex problem with a certificate.
//!
//! The energy is that of a thin plate over the control net, ½ Σ |Bx|²: at a smooth vertex (Bx) is
//! the mean of the neighbours less the vertex, on a crease or a boundary the mean of the two
//! neighbours along it less the vertex, and corners have none. Each row counts in the block where
//! its last point is found, so that lines are as fair as they can be alone, and regions with the
//! lines fixed.
//!
//! Unknown is y, the offsets of limits from their vertices, |yᵢ| ≤ Tᵢ; control points follow from
//! it by A·x = v + y. So f(y) = ½|Bx|² + ½ε|y|² is to be least over a product of balls, to which
//! projection is exact: accelerated projected gradients (Beck and Teboulle 2009) with restarts
//! (O'Donoghue and Candès 2015). The gradient is A⁻ᵀBᵀBx + εy. All is affine in y, so that the
//! values at which the method looks ahead follow from the iterates without solving again. ε makes
//! the answer unique: of equally fair ones that nearest to the vertices.
//!
//! For any feasible y the least energy is at least f(y) − (g·y + Σ Tᵢ|gᵢ|), since f is convex (the
//! gap of Frank and Wolfe; Jaggi 2013). The iteration ends where that gap is small, and reports it.

use super::sparse::{Sparse, greatest, sum, update};
use super::system::{Solution, System};
use crate::index::VertexId;
use crate::mesh::{Mesh, Sharpness, VertexRule};
use crate::parallel::Poll;
use crate::progress::Cancelled;
use crate::vector::DVec3;

/// An ε that is far below the curvature of the energy in any but the longest waves.
pub(super) const NEARNESS: f64 = 1e-6;

/// The sufficient gap, relative to the energy and to the possible gain.
const GAP: f64 = 1e-2;

/// A negligible energy, relative to that of limits at the vertices.
pub(super) const NOTHING: f64 = 1e-9;

/// Steps of the projected gradient at most.
const MOST_STEPS: usize = 500;

/// The greatest curvature of the energy that is tried first; doubled where that is too little.
const CURVATURE: f64 = 8.0;

/// Residuals of the systems on the way, relative to their changes.
const ACCURACY: f64 = 1e-7;

/// How fair a control mesh is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Fairness {
    /// The energy, relative to that of the control points whose limits are the vertices: 1 where
    /// nothing was gained.
    pub energy: f64,
    /// A lower bound of the least energy, relative to the energy at which [`Self::energy`] is 1:
    /// the answer is good where both are close.
    pub least_energy: f64,
    /// Steps of the projected gradient, in the part of the mesh that took most.
    pub steps: usize,
}

/// Energies of all blocks together.
#[derive(Clone, Copy, Default)]
pub(super) struct Energies {
    through: f64,
    reached: f64,
    least: f64,
    steps: usize,
}

impl Energies {
    pub(super) fn add(&mut self, other: Self) {
        self.through += other.through;
        self.reached += other.reached;
        self.least += other.least;
        self.steps = self.steps.max(other.steps);
    }

    pub(super) fn fairness(&self) -> Fairness {
        let share = |energy: f64| {
            if self.through > 0.0 {
                energy / self.through
            } else {
                1.0
            }
        };
        Fairness {
            energy: share(self.reached),
            least_energy: share(self.least),
            steps: self.steps,
        }
    }
}

/// The rows of B for a mesh, on the first copies of its vertices; those of corners and of further copies are empty.
pub(super) fn rows(mesh: &Mesh, first_copy: &[u32]) -> Sparse {
    let (topology, sharpness) = (mesh.topology(), Sharpness::of(mesh));
    let mut rows = Sparse::empty();
    for v in 0..mesh.vertex_count() as u32 {
        let vertex = VertexId(v);
        let ring = topology.ring(vertex).map(|u| first_copy[u.index()]);
        let ends: Vec<u32> = match sharpness.rule(vertex) {
            _ if first_copy[v as usize] != v => Vec::new(),
            VertexRule::Corner => Vec::new(),
            VertexRule::Smooth | VertexRule::Dart => ring.collect(),
            VertexRule::Crease => {
                let is_sharp = sharpness.spokes(vertex).map(|sharpness| sharpness > 0.0);
                ring.zip(is_sharp)
                    .filter(|&(_, is_sharp)| is_sharp)
                    .map(|(u, _)| u)
                    .collect()
            }
        };
        let own = (!ends.is_empty()).then_some((v, -1.0));
        let share = 1.0 / ends.len() as f64;
        rows.push(ends.into_iter().map(|u| (u, share)).chain(own));
    }
    rows
}

/// ½|B·d + known|² of a block's unknowns.
pub(super) struct Energy {
    rows: Sparse,
    transposed: Sparse,
    known: Vec<DVec3>,
}

impl Energy {
    pub(crate) fn new(rows: Sparse, known: Vec<DVec3>, unknowns: usize) -> Self {
        let transposed = rows.transposed(unknowns);
        Self {
            rows,
            transposed,
            known,
        }
    }
}

/// An iterate: limits, control points, B·d + known, gradient without εy.
#[derive(Clone)]
struct State {
    y: Vec<DVec3>,
    d: Vec<DVec3>,
    bent: Vec<DVec3>,
    gradient: Vec<DVec3>,
}

impl State {
    /// `self + along·(self − before)`.
    fn beyond(&self, before: &Self, along: f64, poll: &mut Poll<'_>) -> Result<Self, Cancelled> {
        let mut next = self.clone();
        update(&mut next.y, poll, |i, y| *y += along * (*y - before.y[i]))?;
        update(&mut next.d, poll, |i, d| *d += along * (*d - before.d[i]))?;
        update(&mut next.bent, poll, |i, b| {
            *b += along * (*b - before.bent[i])
        })?;
        update(&mut next.gradient, poll, |i, g| {
            *g += along * (*g - before.gradient[i])
        })?;
        Ok(next)
    }
}

/// How far limits may be from their vertices.
pub(crate) struct Bounds<'a> {
    /// By unknown, the Tᵢ.
    pub(super) reach: &'a [f64],
    /// ε.
    pub(super) nearness: f64,
    /// The gap that is sufficient in any case, relative to the energy of limits at the vertices.
    pub(super) nothing: f64,
}

impl Bounds<'_> {
    /// Limits, those that are too far from their vertices brought as near as they have to be.
    fn kept(&self, mut y: Vec<DVec3>, poll: &mut Poll<'_>) -> Result<Vec<DVec3>, Cancelled> {
        update(&mut y, poll, |i, y| *y = y.clamp_length_max(self.reach[i]))?;
        Ok(y)
    }
}

/// A block's problem.
struct Problem<'a> {
    system: &'a System,
    energy: &'a Energy,
    /// A·d less y.
    right: &'a [DVec3],
    bounds: &'a Bounds<'a>,
    /// The greatest of the bounds.
    most: f64,
}

impl Problem<'_> {
    fn slope(&self, state: &State, i: usize) -> DVec3 {
        state.gradient[i] + self.bounds.nearness * state.y[i]
    }

    fn value(&self, state: &State, poll: &mut Poll<'_>) -> Result<f64, Cancelled> {
        let bent = sum(state.bent.len(), poll, |i| state.bent[i] * state.bent[i])?;
        let away = sum(state.y.len(), poll, |i| state.y[i] * state.y[i])?;
        Ok(0.5 * (bent.element_sum() + self.bounds.nearness * away.element_sum()))
    }

    /// How far the least value can be below that of a feasible state.
    fn gap(&self, state: &State, poll: &mut Poll<'_>) -> Result<f64, Cancelled> {
        let gap = sum(state.y.len(), poll, |i| {
            let slope = self.slope(state, i);
            DVec3::X * (slope.dot(state.y[i]) + self.bounds.reach[i] * slope.length())
        })?;
        Ok(gap.x.max(0.0))
    }

    /// The state of given limits; the iteration starts from that of `near`.
    fn state(&self, y: Vec<DVec3>, near: State, poll: &mut Poll<'_>) -> Result<State, Cancelled> {
        let mut right = self.right.to_vec();
        update(&mut right, poll, |i, b| *b += y[i])?;
        let d = self
            .system
            .solve(&right, near.d, ACCURACY * self.most, poll)?
            .x;
        let mut bent = self.energy.known.clone();
        update(&mut bent, poll, |i, b| {
            *b += self.energy.rows.row_times(i, &d)
        })?;
        let pull = self.energy.transposed.times(&bent, poll)?;
        let goal = ACCURACY * greatest(pull.len(), poll, |i| pull[i].abs().max_element())?;
        let gradient = self
            .system
            .solve_transposed(&pull, near.gradient, goal, poll)?
            .x;
        Ok(State {
            y,
            d,
            bent,
            gradient,
        })
    }

    /// A step against the slope from `from` into the balls.
    fn step(
        &self,
        from: &State,
        curvature: f64,
        poll: &mut Poll<'_>,
    ) -> Result<Vec<DVec3>, Cancelled> {
        let mut y = from.y.clone();
        update(&mut y, poll, |i, y| *y -= self.slope(from, i) / curvature)?;
        self.bounds.kept(y, poll)
    }
}

/// The result for a block.
pub(super) struct Found {
    pub(super) solution: Solution,
    /// How far limits are from their vertices.
    pub(super) away: Vec<DVec3>,
    pub(super) energies: Energies,
}

/// The fairest control points of a block, from limits that are `away` from their vertices on.
pub(super) fn solve(
    system: &System,
    energy: &Energy,
    right: &[DVec3],
    (bounds, away): (&Bounds<'_>, Vec<DVec3>),
    goal: f64,
    poll: &mut Poll<'_>,
) -> Result<Found, Cancelled> {
    let n = right.len();
    let most = bounds.reach.iter().copied().fold(0.0, f64::max);
    let problem = Problem {
        system,
        energy,
        right,
        bounds,
        most,
    };
    let nothing = vec![DVec3::ZERO; n];
    let origin = State {
        y: nothing.clone(),
        d: nothing.clone(),
        bent: Vec::new(),
        gradient: nothing.clone(),
    };
    let mut now = problem.state(nothing, origin, poll)?;
    let through = problem.value(&now, poll)?;
    if away.iter().any(|&away| away != DVec3::ZERO) {
        now = problem.state(bounds.kept(away, poll)?, now, poll)?;
    }
    let (mut ahead, mut momentum, mut curvature) = (now.clone(), 1.0f64, CURVATURE);
    let (mut value, mut gap, mut steps) = (problem.value(&now, poll)?, problem.gap(&now, poll)?, 0);
    while steps < MOST_STEPS
        && gap > (GAP * value.min(through - value + gap)).max(bounds.nothing * through)
    {
        steps += 1;
        let from = problem.value(&ahead, poll)?;
        let (next, next_value) = loop {
            let y = problem.step(&ahead, curvature, poll)?;
            let next = problem.state(y, ahead.clone(), poll)?;
            let model = sum(n, poll, |i| {
                let by = next.y[i] - ahead.y[i];
                DVec3::X
                    * (problem.slope(&ahead, i).dot(by) + 0.5 * curvature * by.length_squared())
            })?;
            let next_value = problem.value(&next, poll)?;
            if next_value <= from + model.x + 1e-9 * from || curvature > 1e6 {
                break (next, next_value);
            }
            curvature *= 2.0;
        };
        let uphill = sum(n, poll, |i| {
            DVec3::X * problem.slope(&ahead, i).dot(next.y[i] - now.y[i])
        })?;
        let after = if uphill.x > 0.0 {
            1.0
        } else {
            0.5 * (1.0 + (1.0 + 4.0 * momentum * momentum).sqrt())
        };
        let along = if uphill.x > 0.0 {
            0.0
        } else {
            (momentum - 1.0) / after
        };
        ahead = next.beyond(&now, along, poll)?;
        (now, value, momentum) = (next, next_value, after);
        gap = problem.gap(&now, poll)?;
    }
    let mut right = right.to_vec();
    update(&mut right, poll, |i, b| *b += now.y[i])?;
    let solution = system.solve(&right, now.d, goal, poll)?;
    let energies = Energies {
        through,
        reached: value,
        least: (value - gap).max(0.0),
        steps,
    };
    Ok(Found {
        solution,
        away: now.y,
        energies,
    })
}

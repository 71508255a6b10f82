//! Linear systems A·x = b for points: by conjugate gradients where a scaling of the rows makes A symmetric and positive
//! definite, else by conjugate gradients on AᵀA·x = Aᵀb.
//!
//! **Symmetric.** Where all weights of a row outside the diagonal are equal, γᵢ > 0, and pairs of
//! unknowns occur mutually, S = diag(1/γ)·A is symmetric: diag(aᵢᵢ/γᵢ) and a pattern of ones. It is
//! solved by the method of Hestenes and Stiefel (1952), preconditioned by its diagonal, each
//! coordinate alone. A direction of negative curvature shows that S is not positive definite.
//!
//! **General.** CGLS (Björck, *Numerical Methods for Least Squares Problems*, 1996, section 7.4) never breaks down; where A is
//! singular it ends at the least squares solution that is nearest to where it started.

use super::sparse::{Sparse, greatest, sum, update};
use crate::parallel::Poll;
use crate::progress::Cancelled;
use crate::vector::DVec3;

/// Steps of conjugate gradients at most on the symmetric system: some tens are usual at any size.
const MOST_STEPS: usize = 1000;

/// Steps at most on the normal equations, whose condition is that of the system squared.
const MOST_NORMAL_STEPS: usize = 20_000;

/// Gradients of the sum of squares shorter than this, relative to the residual, are within
/// rounding: A's weights sum to 1.
const NO_GRADIENT: f64 = 1e-14;

/// How far weights of a row may differ that are called the same: rounding of their formulas.
const SAME: f64 = 1e-12;

/// How a system was solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Solver {
    Symmetric,
    Normal,
}

/// A solution and a report.
pub(super) struct Solution {
    pub(super) x: Vec<DVec3>,
    pub(super) steps: usize,
    pub(super) solver: Solver,
}

/// A square system whose unknowns are numbered from 0.
pub(super) struct System {
    matrix: Sparse,
    transposed: Sparse,
    symmetric: Option<Symmetric>,
}

/// S = diag(scale)·A = diag(diagonal) + pattern.
struct Symmetric {
    scale: Vec<f64>,
    diagonal: Vec<f64>,
    /// The pattern outside the diagonal, by rows; its weights are not used.
    pattern: Sparse,
}

impl System {
    /// The system of a matrix whose rows name their columns in ascending order.
    pub(crate) fn new(matrix: Sparse) -> Self {
        let transposed = matrix.transposed(matrix.rows());
        let symmetric = Symmetric::of(&matrix, &transposed);
        Self {
            matrix,
            transposed,
            symmetric,
        }
    }

    /// Solves A·x = b from `x` on, until no coordinate of the residual is above `goal` or there is nothing to gain.
    pub(super) fn solve(
        &self,
        b: &[DVec3],
        x: Vec<DVec3>,
        goal: f64,
        poll: &mut Poll<'_>,
    ) -> Result<Solution, Cancelled> {
        if let Some(symmetric) = &self.symmetric {
            let mut right = b.to_vec();
            update(&mut right, poll, |i, b| *b *= symmetric.scale[i])?;
            let found =
                symmetric.solve(&right, x.clone(), poll, |i, r| r / symmetric.scale[i], goal)?;
            if let Some(solution) = found {
                return Ok(solution);
            }
        }
        least_squares([&self.matrix, &self.transposed], b, x, goal, poll)
    }

    /// Solves Aᵀ·x = b in the same way.
    pub(super) fn solve_transposed(
        &self,
        b: &[DVec3],
        x: Vec<DVec3>,
        goal: f64,
        poll: &mut Poll<'_>,
    ) -> Result<Solution, Cancelled> {
        if let Some(symmetric) = &self.symmetric {
            // Aᵀ = S·diag(1/scale).
            let mut start = x.clone();
            update(&mut start, poll, |i, x| *x /= symmetric.scale[i])?;
            if let Some(mut solution) = symmetric.solve(b, start, poll, |_, r| r, goal)? {
                update(&mut solution.x, poll, |i, x| *x *= symmetric.scale[i])?;
                return Ok(solution);
            }
        }
        least_squares([&self.transposed, &self.matrix], b, x, goal, poll)
    }
}

impl Symmetric {
    fn of(matrix: &Sparse, transposed: &Sparse) -> Option<Self> {
        let n = matrix.rows();
        if (0..n).any(|i| matrix.columns(i) != transposed.columns(i)) {
            return None;
        }
        let (mut scale, mut diagonal) = (Vec::with_capacity(n), Vec::with_capacity(n));
        let mut pattern = Sparse::empty();
        for i in 0..n {
            let others = matrix.row(i).filter(|&(j, _)| j as usize != i);
            let (_, weight) = others.clone().next()?;
            let is_same = |other: f64| (other - weight).abs() <= SAME * weight;
            if !others.clone().all(|(_, other)| is_same(other)) {
                return None;
            }
            let own = matrix
                .row(i)
                .find(|&(j, _)| j as usize == i)
                .map_or(0.0, |(_, own)| own);
            // A diagonal that is not positive cannot be that of a positive definite matrix.
            if own <= 0.0 {
                return None;
            }
            scale.push(1.0 / weight);
            diagonal.push(own / weight);
            pattern.push(others.map(|(j, _)| (j, 1.0)));
        }
        Some(Self {
            scale,
            diagonal,
            pattern,
        })
    }

    fn row_times(&self, i: usize, x: &[DVec3]) -> DVec3 {
        let around = self.pattern.columns(i).iter();
        around.fold(self.diagonal[i] * x[i], |sum, &j| sum + x[j as usize])
    }

    /// Solves S·x = b from `x` on until `size` of no residual is above `goal` in any coordinate; none where S is not positive
    /// definite or there is no end to it.
    fn solve(
        &self,
        b: &[DVec3],
        mut x: Vec<DVec3>,
        poll: &mut Poll<'_>,
        size: impl Fn(usize, DVec3) -> DVec3 + Sync,
        goal: f64,
    ) -> Result<Option<Solution>, Cancelled> {
        let n = b.len();
        let mut r = b.to_vec();
        update(&mut r, poll, |i, r| *r -= self.row_times(i, &x))?;
        let mut p = r.clone();
        update(&mut p, poll, |i, p| *p /= self.diagonal[i])?;
        let mut rz = sum(n, poll, |i| r[i] * p[i])?;
        for steps in 0..MOST_STEPS {
            if greatest(n, poll, |i| size(i, r[i]).abs().max_element())? <= goal {
                return Ok(Some(Solution {
                    x,
                    steps,
                    solver: Solver::Symmetric,
                }));
            }
            let mut q = p.clone();
            update(&mut q, poll, |i, q| *q = self.row_times(i, &p))?;
            let bend = sum(n, poll, |i| p[i] * q[i])?;
            if !(bend.cmpge(DVec3::ZERO).all() && bend.is_finite()) {
                return Ok(None);
            }
            let along = quotient(rz, bend);
            update(&mut x, poll, |i, x| *x += along * p[i])?;
            update(&mut r, poll, |i, r| *r -= along * q[i])?;
            let next = sum(n, poll, |i| r[i] * r[i] / self.diagonal[i])?;
            let turn = quotient(next, rz);
            update(&mut p, poll, |i, p| {
                *p = r[i] / self.diagonal[i] + turn * *p
            })?;
            rz = next;
        }
        Ok(None)
    }
}

/// Least squares for [A, Aᵀ].
fn least_squares(
    [matrix, transposed]: [&Sparse; 2],
    b: &[DVec3],
    mut x: Vec<DVec3>,
    goal: f64,
    poll: &mut Poll<'_>,
) -> Result<Solution, Cancelled> {
    let n = b.len();
    let mut r = b.to_vec();
    update(&mut r, poll, |i, r| *r -= matrix.row_times(i, &x))?;
    let mut p = transposed.times(&r, poll)?;
    let mut square = sum(n, poll, |i| p[i] * p[i])?;
    let mut steps = 0;
    while steps < MOST_NORMAL_STEPS && greatest(n, poll, |i| r[i].abs().max_element())? > goal {
        let residual = sum(n, poll, |i| r[i] * r[i])?;
        if square.cmple(NO_GRADIENT * NO_GRADIENT * residual).all() {
            break;
        }
        let q = matrix.times(&p, poll)?;
        let along = quotient(square, sum(n, poll, |i| q[i] * q[i])?);
        update(&mut x, poll, |i, x| *x += along * p[i])?;
        update(&mut r, poll, |i, r| *r -= along * q[i])?;
        let gradient = transposed.times(&r, poll)?;
        let next = sum(n, poll, |i| gradient[i] * gradient[i])?;
        let turn = quotient(next, square);
        update(&mut p, poll, |i, p| *p = gradient[i] + turn * *p)?;
        square = next;
        steps += 1;
    }
    Ok(Solution {
        x,
        steps,
        solver: Solver::Normal,
    })
}

/// The quotient of each coordinate; 0 where there is nothing to divide by, because that coordinate is solved.
fn quotient(a: DVec3, b: DVec3) -> DVec3 {
    let of = |a: f64, b: f64| if b > 0.0 { a / b } else { 0.0 };
    DVec3::new(of(a.x, b.x), of(a.y, b.y), of(a.z, b.z))
}

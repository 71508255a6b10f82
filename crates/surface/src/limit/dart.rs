//! Limit stencils of darts: closed rings with one sharp edge, the first.
//!
//! The ring matrix is no longer circulant, but still its own mirror image across the sharp edge. Functionals on the
//! differences that are even and odd under that reflection keep to themselves; a dart's surface is smooth where the
//! dominant even one (along the crease) and the dominant odd one (across it) dominate all others. The position is
//! the left eigenvector of S for 1, found by iteration: each step shrinks the rest by the next eigenvalue.
//!
//! With Loop's scheme the odd patterns do not notice the crease, so that the tangent across it is the smooth one;
//! that along it, and the position, are not those of the smooth vertex (from which they differ by tenths).

use super::LimitError;
use super::complex::Complex;
use super::eigen::{components, eigenvalues, left_vector};
use super::matrix::Matrix;
use super::neighbourhood::Neighbourhood;
use super::stencil::{LimitStencil, TangentPlane, is_real, same_modulus};
use crate::scheme::Support;

/// Greatest number of points whose tangents are computed: two dense eigenproblems of half that size take a second.
/// Beyond it a dart has its limit position but no tangent plane.
const MOST_POINTS: usize = 1024;

/// How far the mirror image of a mask may differ from it.
const MIRROR_TOLERANCE: f64 = 1e-11;

/// Steps of the iteration for the position: the usual schemes need a hundred.
const MOST_STEPS: usize = 10_000;

/// Steps after which nothing shrinks any more but rounding that changes from one to the next.
const STALLED: usize = 16;

/// The limit stencil of a dart.
///
/// # Errors
/// The masks are not those of a scheme as its contract describes it, or do not converge here.
pub(super) fn analyse(neighbourhood: &Neighbourhood<'_>) -> Result<LimitStencil, LimitError> {
    let rows = (0..neighbourhood.len()).map(|i| Ok(sparse(&neighbourhood.row(i)?)));
    let rows = rows.collect::<Result<Vec<_>, LimitError>>()?;
    let position = position(neighbourhood, &rows)?;
    let bare = LimitStencil::without_tangents(neighbourhood.shape, neighbourhood.support, position);
    if neighbourhood.len() > MOST_POINTS {
        return Ok(bare);
    }
    let differences = differences(&rows);
    let mirror = mirror(neighbourhood);
    let n = differences.row_count();
    let is_mirrored = |i: usize, j: usize| {
        (differences[(i, j)] - differences[(mirror[i], mirror[j])]).modulus() <= MIRROR_TOLERANCE
    };
    if !(0..n).all(|i| (0..n).all(|j| is_mirrored(i, j))) {
        return Ok(bare);
    }
    let failed =
        || neighbourhood.unsuitable("the eigenvalues of its ring matrix could not be computed");
    let along = Parity::new(&differences, &mirror, 1.0).ok_or_else(failed)?;
    let across = Parity::new(&differences, &mirror, -1.0).ok_or_else(failed)?;
    let greatest = along.modulus(0).max(across.modulus(0));
    if greatest >= 1.0 - 1e-12 {
        let what = format!(
            "differences must shrink, but the difference matrix has an eigenvalue of modulus {greatest}"
        );
        return Err(neighbourhood.unsuitable(what));
    }
    let next = along.modulus(1).max(across.modulus(1));
    let moduli = [along.modulus(0), across.modulus(0)];
    let least = moduli[0].min(moduli[1]);
    if least <= next || same_modulus(least, next) {
        return Ok(bare);
    }
    let k = neighbourhood.valence();
    let (Some(first), Some(second)) = (along.dominant(k), across.dominant(k)) else {
        return Ok(bare);
    };
    let tangents = first
        .iter()
        .zip(second.iter())
        .map(|(&u, &w)| [u, w])
        .collect();
    let plane = TangentPlane::Surface;
    Ok(LimitStencil {
        tangents,
        plane,
        eigenvalues: moduli,
        next_eigenvalue: next,
        ..bare
    }
    .oriented())
}

/// The weights of a row that are not zero, with their columns.
fn sparse(row: &[f64]) -> Vec<(usize, f64)> {
    row.iter()
        .copied()
        .enumerate()
        .filter(|&(_, weight)| weight != 0.0)
        .collect()
}

/// Weights of the limit position. Sums of many terms may differ by their rounding from step to step
/// endlessly: the iteration has ended once the change is no more than that and has not shrunk for
/// some steps.
fn position(
    neighbourhood: &Neighbourhood<'_>,
    rows: &[Vec<(usize, f64)>],
) -> Result<Vec<f64>, LimitError> {
    let mut weights = vec![0.0; rows.len()];
    weights[0] = 1.0;
    let rounding = rows.len() as f64 * f64::EPSILON;
    let (mut least_change, mut stalled) = (f64::INFINITY, 0);
    for _ in 0..MOST_STEPS {
        let mut next = vec![0.0; rows.len()];
        for (row, &weight) in rows
            .iter()
            .zip(&weights)
            .filter(|&(_, &weight)| weight != 0.0)
        {
            row.iter()
                .for_each(|&(column, entry)| next[column] += weight * entry);
        }
        let sum: f64 = next.iter().sum();
        next.iter_mut().for_each(|weight| *weight /= sum);
        let change = next
            .iter()
            .zip(&weights)
            .fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        weights = next;
        stalled = if change < least_change {
            0
        } else {
            stalled + 1
        };
        least_change = least_change.min(change);
        if change <= f64::EPSILON || stalled >= STALLED && change <= rounding {
            return Ok(weights);
        }
    }
    Err(neighbourhood.unsuitable("the eigenvalue 1 of the ring matrix must be simple"))
}

/// D over all points but the vertex.
fn differences(rows: &[Vec<(usize, f64)>]) -> Matrix {
    let n = rows.len() - 1;
    let mut differences = Matrix::zeros(n, n);
    for (i, row) in rows[1..].iter().enumerate() {
        for (share, entries) in [(1.0, row), (-1.0, &rows[0])] {
            for &(column, weight) in entries.iter().filter(|&&(column, _)| column > 0) {
                differences[(i, column - 1)] += (share * weight).into();
            }
        }
    }
    differences
}

/// The mirror image of each point across the sharp edge, the vertex left out of the numbering.
fn mirror(neighbourhood: &Neighbourhood<'_>) -> Vec<usize> {
    let k = neighbourhood.valence();
    let edges = |start: usize| (0..k).map(move |j| start + (k - j) % k);
    match neighbourhood.support {
        Support::OneRing => edges(0).collect(),
        Support::TwoRing => edges(0)
            .chain(edges(k))
            .chain((0..k).map(|j| 2 * k + k - 1 - j))
            .collect(),
    }
}

/// The functionals of one parity: D acting on them, its components and its eigenvalues by falling modulus.
struct Parity<'d> {
    mirror: &'d [usize],
    sign: f64,
    /// One point of each pair of mirror images.
    points: Vec<usize>,
    matrix: Matrix,
    components: Vec<Vec<usize>>,
    modes: Vec<(Complex, usize)>,
}

impl<'d> Parity<'d> {
    /// Even functionals for `sign` 1, odd ones for −1. `None` where an iteration does not converge.
    fn new(differences: &Matrix, mirror: &'d [usize], sign: f64) -> Option<Self> {
        let is_own = |i: usize| mirror[i] == i;
        let points: Vec<usize> = (0..mirror.len())
            .filter(|&i| i < mirror[i] || (is_own(i) && sign > 0.0))
            .collect();
        // The value at j after a step of a functional with weight 1 at i and ±1 at its image.
        let matrix = Matrix::from_fn(points.len(), points.len(), |a, b| {
            let (i, j) = (points[a], points[b]);
            let image = if is_own(i) {
                Complex::ZERO
            } else {
                differences[(mirror[i], j)] * sign
            };
            differences[(i, j)] + image
        });
        let components = components(&matrix);
        let mut modes = Vec::with_capacity(points.len());
        for (component, rows) in components.iter().enumerate() {
            let values = eigenvalues(&matrix.block(rows, rows))?;
            modes.extend(values.into_iter().map(|value| (value, component)));
        }
        modes.sort_by(|a, b| b.0.modulus().total_cmp(&a.0.modulus()));
        Some(Self {
            mirror,
            sign,
            points,
            matrix,
            components,
            modes,
        })
    }

    fn modulus(&self, place: usize) -> f64 {
        self.modes.get(place).map_or(0.0, |mode| mode.0.modulus())
    }

    /// The dominant functional over all points, its greatest weight on the first `ring` of them 1.
    fn dominant(&self, ring: usize) -> Option<Vec<f64>> {
        let &(value, component) = self.modes.first().filter(|mode| is_real(mode.0))?;
        let own = left_vector(&self.matrix, &self.components, component, value.re)?;
        let mut all = vec![0.0; self.mirror.len()];
        for (&point, &weight) in self.points.iter().zip(&own) {
            all[self.mirror[point]] = self.sign * weight;
            all[point] = weight;
        }
        let greatest = |a: f64, &b: &f64| if b.abs() > a.abs() { b } else { a };
        let most = all[..ring].iter().fold(0.0, greatest);
        (most != 0.0).then(|| all.iter().map(|weight| weight / most).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ring::SharpRing;
    use crate::scheme::{Loop, LoopWarren, Scheme};

    /// Values at the points of a dart's neighbourhood converge to the weighted sum, whatever the
    /// valence.
    #[test]
    fn positions_are_found_at_all_valences() {
        for k in (3..350).chain([512, 600, 1024]) {
            for scheme in [&Loop as &dyn Scheme, &LoopWarren] {
                let mut spokes = vec![0.0; k];
                spokes[0] = f64::INFINITY;
                let sharp = SharpRing {
                    open: false,
                    vertex: 0.0,
                    spokes,
                };
                let neighbourhood = Neighbourhood::of_sharp(scheme, sharp).unwrap();
                let rows: Vec<_> = (0..neighbourhood.len())
                    .map(|i| sparse(&neighbourhood.row(i).unwrap()))
                    .collect();
                let weights = position(&neighbourhood, &rows).unwrap();
                let mut numbers: Vec<f64> = (0..rows.len())
                    .map(|i| (1.7 * (i * i) as f64).sin())
                    .collect();
                let found: f64 = weights
                    .iter()
                    .zip(&numbers)
                    .map(|(weight, number)| weight * number)
                    .sum();
                for _ in 0..200 {
                    let refined = rows
                        .iter()
                        .map(|row| row.iter().map(|&(at, entry)| entry * numbers[at]).sum());
                    numbers = refined.collect();
                }
                assert!(
                    (found - numbers[0]).abs() < 1e-13,
                    "{k}: {found} {}",
                    numbers[0]
                );
            }
        }
    }
}

//! Limit stencils of closed rings.
//!
//! The ring matrix of a closed ring is block-circulant: one kind of point (OneRing) or three (TwoRing) for each
//! of k sectors. The discrete Fourier transform over the sectors takes it apart into k blocks of 1×1 or 3×3,
//! `Ŝ(m)_ab = Σ_j S[(a,0),(b,j)]·e^{2πimj/k}`; a left eigenvector Y of Ŝ(m) gives the left eigenvector
//! `Y_a·e^{−2πimj/k}` of S, real and imaginary part separately. Differences to the vertex change block 0 alone:
//! `D̂(0)_ab = Ŝ(0)_ab − k·S[0,(b,·)]`.

use core::f64::consts::TAU;

use super::LimitError;
use super::complex::Complex;
use super::eigen::{eigenvalues, left_eigenvector, only_solution};
use super::matrix::Matrix;
use super::neighbourhood::Neighbourhood;
use super::stencil::{LimitStencil, TangentPlane, is_real, same_modulus};
use crate::math;
use crate::scheme::Support;

/// Multiply-adds that the transform may take (a second or so). A dense mask reaches it at 16,000 edges, Loop's
/// never; beyond it a ring has its limit position but no tangent plane.
const MOST_WORK: usize = 1 << 29;

/// The greatest difference between two rows that are equal up to a turn.
const TURN_TOLERANCE: f64 = 1e-11;

/// An eigenvalue of the difference matrix and the frequency of its block.
#[derive(Clone, Copy)]
struct Mode {
    value: Complex,
    frequency: usize,
}

/// The rows of one sector, and their images for all the others.
struct Sector<'n, 's> {
    neighbourhood: &'n Neighbourhood<'s>,
    /// Kinds of points a sector has.
    kinds: usize,
    /// Weights of the vertex and of one point of each kind, for the vertex's own new position.
    centre: Vec<f64>,
    /// First row of each kind, without the vertex: the weights that are not zero as kind, sector, weight.
    rows: Vec<Vec<(usize, usize, f64)>>,
    /// e^{2πij/k}.
    roots: Vec<Complex>,
}

/// The limit stencil of a closed ring.
///
/// # Errors
/// The masks are not those of a scheme as its contract describes it, or do not converge here.
pub(super) fn analyse(neighbourhood: &Neighbourhood<'_>) -> Result<LimitStencil, LimitError> {
    let sector = Sector::new(neighbourhood)?;
    let position = sector.position()?;
    let (shape, support) = (neighbourhood.shape, neighbourhood.support);
    let bare = LimitStencil::without_tangents(shape, support, position);
    let weights: usize = sector.rows.iter().map(Vec::len).sum();
    if weights.saturating_mul(neighbourhood.valence()) > MOST_WORK {
        return Ok(bare);
    }
    let modes = sector.modes()?;
    let greatest = modes.first().map_or(0.0, |mode| mode.value.modulus());
    if greatest >= 1.0 - 1e-12 {
        let what = format!(
            "differences must shrink, but the difference matrix has an eigenvalue of modulus {greatest}"
        );
        return Err(neighbourhood.unsuitable(what));
    }
    let Some(dominant) = sector.dominant(&modes) else {
        return Ok(bare);
    };
    let first = sector.eigenvector(dominant.first)?;
    let tangents = match dominant.second {
        None => first.iter().map(|weight| [weight.re, -weight.im]).collect(),
        Some(second) => {
            let second = sector.eigenvector(second)?;
            first
                .iter()
                .zip(&second)
                .map(|(a, b)| [a.re, b.re])
                .collect()
        }
    };
    let plane = TangentPlane::Surface;
    let (eigenvalues, next_eigenvalue) = (dominant.moduli, dominant.next);
    Ok(LimitStencil {
        tangents,
        plane,
        eigenvalues,
        next_eigenvalue,
        ..bare
    }
    .oriented())
}

/// The two dominant left eigenvectors: real and imaginary part of one mode, or two real modes.
struct Dominant {
    first: Mode,
    /// None where both come from the first mode.
    second: Option<Mode>,
    moduli: [f64; 2],
    next: f64,
}

impl<'n, 's> Sector<'n, 's> {
    fn new(neighbourhood: &'n Neighbourhood<'s>) -> Result<Self, LimitError> {
        let k = neighbourhood.valence();
        let kinds = match neighbourhood.support {
            Support::OneRing => 1,
            Support::TwoRing => 3,
        };
        let first_of = |kind: usize| 1 + kind * k;
        let central = neighbourhood.row(0)?;
        let mut centre = vec![central[0]];
        for kind in 0..kinds {
            let weights = &central[first_of(kind)..first_of(kind) + k];
            if weights
                .iter()
                .any(|w| (w - weights[0]).abs() > TURN_TOLERANCE)
            {
                let what =
                    "the vertex mask of a closed ring must give all neighbours the same weight";
                return Err(neighbourhood.unsuitable(what));
            }
            centre.push(weights[0]);
        }
        let mut rows = Vec::new();
        for kind in 0..kinds {
            let row = neighbourhood.row(first_of(kind))?;
            check_turned(neighbourhood, kind, &row)?;
            let weights = row[1..]
                .iter()
                .enumerate()
                .filter(|(_, weight)| **weight != 0.0);
            rows.push(weights.map(|(i, &weight)| (i / k, i % k, weight)).collect());
        }
        let root = |j: usize| {
            let (sine, cosine) = math::sin_cos(TAU * j as f64 / k as f64);
            Complex::new(cosine, sine)
        };
        let roots = (0..k).map(root).collect();
        Ok(Self {
            neighbourhood,
            kinds,
            centre,
            rows,
            roots,
        })
    }

    fn valence(&self) -> usize {
        self.neighbourhood.valence()
    }

    /// Ŝ(m).
    fn ring_block(&self, frequency: usize) -> Matrix {
        let k = self.valence();
        let mut block = Matrix::zeros(self.kinds, self.kinds);
        for (kind, row) in self.rows.iter().enumerate() {
            for &(other, sector, weight) in row {
                block[(kind, other)] += self.roots[(frequency * sector) % k] * weight;
            }
        }
        block
    }

    /// D̂(m).
    fn difference_block(&self, frequency: usize) -> Matrix {
        let mut block = self.ring_block(frequency);
        if frequency == 0 {
            for kind in 0..self.kinds {
                for other in 0..self.kinds {
                    let drawn = self.valence() as f64 * self.centre[1 + other];
                    block[(kind, other)] -= drawn.into();
                }
            }
        }
        block
    }

    /// Weights of the limit position: the left eigenvector of S for 1, which is the same in every sector.
    fn position(&self) -> Result<Vec<f64>, LimitError> {
        let k = self.valence() as f64;
        let mut weights = vec![1.0];
        if self.centre[1..].iter().all(|&weight| weight == 0.0) {
            weights.resize(1 + self.kinds, 0.0);
        } else {
            // Equation b is column b of x·(S − 1) = 0; the vertex's column, which depends on the others, is
            // replaced by "the weights sum to 1".
            let size = 1 + self.kinds;
            let block = self.ring_block(0);
            let system =
                Matrix::from_fn(size, size, |equation, unknown| match (equation, unknown) {
                    (0, 0) => 1.0,
                    (0, _) => k,
                    (_, 0) => self.centre[equation],
                    _ => {
                        block[(unknown - 1, equation - 1)].re
                            - f64::from(u8::from(equation == unknown))
                    }
                });
            weights = only_solution(system).ok_or_else(|| {
                let what = "the eigenvalue 1 of the ring matrix must be simple";
                self.neighbourhood.unsuitable(what)
            })?;
        }
        let (centre, kinds) = (weights[0], &weights[1..]);
        let all = kinds
            .iter()
            .flat_map(|&weight| core::iter::repeat_n(weight, self.valence()));
        Ok(core::iter::once(centre).chain(all).collect())
    }

    /// Eigenvalues of D by falling modulus; an entry of a frequency between 0 and k/2 represents
    /// its conjugate too.
    fn modes(&self) -> Result<Vec<Mode>, LimitError> {
        let mut modes = Vec::with_capacity((self.valence() / 2 + 1) * self.kinds);
        for frequency in 0..=self.valence() / 2 {
            let Some(values) = eigenvalues(&self.difference_block(frequency)) else {
                return Err(self
                    .neighbourhood
                    .unsuitable("the eigenvalues of its ring matrix could not be computed"));
            };
            modes.extend(values.into_iter().map(|value| Mode { value, frequency }));
        }
        modes.sort_by(|a, b| b.value.modulus().total_cmp(&a.value.modulus()));
        Ok(modes)
    }

    /// Whether a mode of this frequency comes with its mirror image, at k − m.
    fn is_double(&self, mode: &Mode) -> bool {
        mode.frequency != 0 && 2 * mode.frequency != self.valence()
    }

    /// The two dominant eigenvectors if they dominate strictly.
    fn dominant(&self, modes: &[Mode]) -> Option<Dominant> {
        let first = *modes.first()?;
        let modulus = |i: usize| modes.get(i).map_or(0.0, |mode| mode.value.modulus());
        let (second, taken) = if self.is_double(&first) {
            (None, 1)
        } else if !is_real(first.value) {
            // A block of real weights: the conjugate is the next one.
            (None, 2)
        } else {
            let second = *modes.get(1)?;
            if self.is_double(&second) || !is_real(second.value) {
                return None;
            }
            (Some(second), 2)
        };
        let moduli = [modulus(0), modulus(taken - 1)];
        let next = modulus(taken);
        if same_modulus(moduli[1], next) || moduli[1] == 0.0 {
            return None;
        }
        Some(Dominant {
            first,
            second,
            moduli,
            next,
        })
    }

    /// The left eigenvector of a mode over all differences, scaled to 1 at the first neighbour (or where it is
    /// greatest, should it vanish there).
    fn eigenvector(&self, mode: Mode) -> Result<Vec<Complex>, LimitError> {
        let failed = || {
            self.neighbourhood
                .unsuitable("a left eigenvector of its ring matrix could not be computed")
        };
        let vector = left_eigenvector(&self.difference_block(mode.frequency), mode.value)
            .ok_or_else(failed)?;
        let scale = if vector[0].modulus() > 1e-9 {
            vector[0]
        } else {
            vector.iter().copied().fold(Complex::ZERO, |a, b| {
                if b.modulus() > a.modulus() { b } else { a }
            })
        };
        let k = self.valence();
        let turned = |weight: Complex| {
            let weight = weight / scale;
            (0..k).map(move |j| weight * self.roots[(mode.frequency * j) % k].conj())
        };
        Ok(vector.iter().flat_map(|&weight| turned(weight)).collect())
    }
}

/// Checks on two other sectors that their rows are the first one's, turned.
fn check_turned(
    neighbourhood: &Neighbourhood<'_>,
    kind: usize,
    row: &[f64],
) -> Result<(), LimitError> {
    let k = neighbourhood.valence();
    for turn in [1, k / 2] {
        let other = neighbourhood.row(1 + kind * k + turn)?;
        let turned = |i: usize| 1 + i / k * k + (i % k + turn) % k;
        let same = (row[0] - other[0]).abs() <= TURN_TOLERANCE
            && row[1..]
                .iter()
                .enumerate()
                .all(|(i, weight)| (weight - other[turned(i)]).abs() <= TURN_TOLERANCE);
        if !same {
            let what = "the masks of a closed ring must not depend on where it is cut";
            return Err(neighbourhood.unsuitable(what));
        }
    }
    Ok(())
}

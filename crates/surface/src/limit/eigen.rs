//! Numerical linear algebra of small matrices: eigenvalues, left eigenvectors, the strongly connected
//! components of a matrix's pattern (its block triangular form), and linear systems from the left.
//!
//! Nothing here knows of schemes. Everything returns `None` where an iteration does not converge or a system has
//! no solution.

use super::complex::Complex;
use super::matrix::{Matrix, Reduced, length};

/// QR steps allowed for one eigenvalue: two or three are usual.
const STEPS: usize = 60;

/// Steps after which a shift is taken from elsewhere, in case the usual ones go round in a circle.
const STEPS_TO_TURN: usize = 10;

/// Greatest residual, relative to the matrix, of a left eigenvector that is accepted.
const RESIDUAL: f64 = 1e-9;

/// Eigenvalues of a square matrix, by QR steps with Wilkinson's shifts on its Hessenberg form (G. H. Golub and C. F. Van Loan, *Matrix
/// Computations*, chapter 7).
pub(super) fn eigenvalues(matrix: &Matrix) -> Option<Vec<Complex>> {
    let size = |entry: Complex| entry.re.abs() + entry.im.abs();
    let n = matrix.row_count();
    let norm = matrix.norm();
    let mut h = hessenberg_form(matrix.clone());
    let (mut left, mut steps) = (n, 0);
    while left > 0 {
        let is_split = |&row: &usize| {
            let diagonal = size(h[(row, row)]) + size(h[(row - 1, row - 1)]);
            let scale = if diagonal > 0.0 { diagonal } else { norm };
            size(h[(row, row - 1)]) <= f64::EPSILON * scale
        };
        let first = (1..left).rev().find(is_split).unwrap_or(0);
        if first + 1 == left {
            (left, steps) = (first, 0);
            continue;
        }
        if first + 2 == left {
            let [upper, lower] = eigenvalues_of_two(&h, left);
            (h[(first, first)], h[(left - 1, left - 1)]) = (upper, lower);
            (left, steps) = (first, 0);
            continue;
        }
        steps += 1;
        if steps > STEPS {
            return None;
        }
        let shift = if steps % STEPS_TO_TURN == 0 {
            h[(left - 1, left - 1)] + size(h[(left - 1, left - 2)]).into()
        } else {
            eigenvalues_of_two(&h, left)[1]
        };
        qr_step(&mut h, first, left, shift);
    }
    Some((0..n).map(|i| h[(i, i)]).collect())
}

/// A matrix with the same eigenvalues and zeros below the first subdiagonal, by elimination.
fn hessenberg_form(mut matrix: Matrix) -> Matrix {
    let n = matrix.row_count();
    for column in 0..n.saturating_sub(2) {
        let next = column + 1;
        let modulus = |row: usize| matrix[(row, column)].modulus_squared();
        let pivot = (next..n).fold(next, |best, row| {
            if modulus(row) > modulus(best) {
                row
            } else {
                best
            }
        });
        matrix.swap_rows(next, pivot);
        matrix.swap_columns(next, pivot);
        let divisor = matrix[(next, column)];
        for row in next + 1..n {
            if matrix[(row, column)] == Complex::ZERO {
                continue;
            }
            let factor = matrix[(row, column)] / divisor;
            matrix.add_row(row, next, -factor, column);
            matrix[(row, column)] = Complex::ZERO;
            for i in 0..n {
                let product = factor * matrix[(i, row)];
                matrix[(i, next)] += product;
            }
        }
    }
    matrix
}

/// Of the last 2×2 block of the first `left` rows, both eigenvalues, that next to its last entry (Wilkinson's shift) last. Simple numbers come
/// out exactly.
fn eigenvalues_of_two(h: &Matrix, left: usize) -> [Complex; 2] {
    let (i, j) = (left - 2, left - 1);
    let last = h[(j, j)];
    let half = (h[(i, i)] - last) / 2.0;
    let product = h[(i, j)] * h[(j, i)];
    let root = (half * half + product).sqrt();
    let [plus, minus] = [half + root, half - root];
    let greater = if plus.modulus_squared() >= minus.modulus_squared() {
        plus
    } else {
        minus
    };
    if greater == Complex::ZERO {
        return [last, last];
    }
    [last + greater, last - product / greater]
}

/// H − σ = QR, then RQ + σ, on the rows and columns from `first` to `end`, by Givens rotations.
fn qr_step(h: &mut Matrix, first: usize, end: usize, shift: Complex) {
    (first..end).for_each(|i| h[(i, i)] -= shift);
    let mut rotations = Vec::with_capacity(end - first);
    for i in first..end - 1 {
        let (a, b) = (h[(i, i)], h[(i + 1, i)]);
        let length = (a.modulus_squared() + b.modulus_squared()).sqrt();
        // Both may be 0 where the shift is an eigenvalue.
        let (c, s) = if length > 0.0 {
            (a / length, b / length)
        } else {
            (1.0.into(), Complex::ZERO)
        };
        for column in i..end {
            let (upper, lower) = (h[(i, column)], h[(i + 1, column)]);
            h[(i, column)] = c.conj() * upper + s.conj() * lower;
            h[(i + 1, column)] = c * lower - s * upper;
        }
        rotations.push((c, s));
    }
    for (i, (c, s)) in (first..).zip(rotations) {
        for row in first..(i + 2).min(end) {
            let (before, after) = (h[(row, i)], h[(row, i + 1)]);
            h[(row, i)] = before * c + after * s;
            h[(row, i + 1)] = after * c.conj() - before * s.conj();
        }
    }
    (first..end).for_each(|i| h[(i, i)] += shift);
}

/// A left eigenvector of an eigenvalue, of unit length: the null vector of a matrix whose rank is one short, also for the eigenvalue of a
/// Jordan block.
pub(super) fn left_eigenvector(matrix: &Matrix, eigenvalue: Complex) -> Option<Vec<Complex>> {
    let n = matrix.row_count();
    let shifted = matrix.transposed().shifted(eigenvalue);
    let vector = Reduced::new(shifted.clone(), vec![Complex::ZERO; n], n - 1, 0.0).null_vector()?;
    let residual = length(&shifted.times(&vector));
    (residual <= RESIDUAL * matrix.norm()).then_some(vector)
}

/// A solution x of `x·matrix = right`, of least length where there are several.
fn solve_left(matrix: &Matrix, right: Vec<Complex>) -> Option<Vec<Complex>> {
    let (transposed, n) = (matrix.transposed(), matrix.row_count());
    let cut = 1e-10 * matrix.norm().max(1e-3);
    let solution = Reduced::new(transposed.clone(), right.clone(), n, cut).least_solution();
    let image = transposed.times(&solution);
    let difference: Vec<Complex> = image.iter().zip(&right).map(|(&a, &b)| a - b).collect();
    (length(&difference) <= RESIDUAL * (length(&right) + matrix.norm())).then_some(solution)
}

/// The solution x of `matrix·x = (1, 0, …, 0)`; `None` where there is not exactly one.
pub(super) fn only_solution(matrix: Matrix) -> Option<Vec<f64>> {
    let n = matrix.row_count();
    let cut = n as f64 * f64::EPSILON * matrix.norm();
    let right = (0..n).map(|i| f64::from(u8::from(i == 0)).into());
    let reduced = Reduced::new(matrix, right.collect(), n, cut);
    let solution = || reduced.least_solution().iter().map(|x| x.re).collect();
    (reduced.rank == n).then(solution)
}

/// Replaces the eigenvalues that belong to one Jordan block by one, and says which those are.
///
/// Rounding splits the eigenvalue of a block of size m into m that differ by some ε^{1/m}, while their mean stays
/// accurate; whether they are one block shows in the rank of the matrix minus that mean.
pub(super) fn join_jordan_blocks(
    matrix: &Matrix,
    mut values: Vec<Complex>,
) -> Vec<(Complex, bool)> {
    /// Eigenvalues of a block of size two differ by less than this fraction of the matrix.
    const CLOSE: f64 = 1e-6;
    let size = matrix.norm();
    let mut joined = Vec::with_capacity(values.len());
    while let Some(value) = values.pop() {
        let (near, far): (Vec<Complex>, Vec<Complex>) = values
            .iter()
            .partition(|&&other| (other - value).modulus() <= CLOSE * size);
        let sum = near.iter().fold(value, |sum, &other| sum + other);
        let mean = sum / (near.len() + 1) as f64;
        let is_real = mean.im.abs() <= 1e-12 * size;
        if !near.is_empty() && is_real && eigenspace_dimension(matrix, mean.re) == 1 {
            joined.push((mean.re.into(), true));
            values = far;
        } else {
            joined.push((value, false));
        }
    }
    joined
}

/// How many independent eigenvectors a matrix has for an eigenvalue.
pub(super) fn eigenspace_dimension(matrix: &Matrix, eigenvalue: f64) -> usize {
    let n = matrix.row_count();
    let shifted = matrix.shifted(eigenvalue.into());
    n - Reduced::new(shifted, vec![Complex::ZERO; n], n, 1e-9 * matrix.norm()).rank
}

/// The strongly connected components of the pattern of a square matrix, where row i depends on the columns that
/// are not zero: a component comes after all those that it depends on. Each lists its rows in ascending order.
///
/// Tarjan's algorithm, without recursion.
pub(super) fn components(matrix: &Matrix) -> Vec<Vec<usize>> {
    const UNSEEN: usize = usize::MAX;
    let n = matrix.row_count();
    let mut order = vec![UNSEEN; n];
    let mut low = vec![0; n];
    let mut on_stack = vec![false; n];
    let (mut stack, mut found, mut count) = (Vec::new(), Vec::new(), 0);
    for root in 0..n {
        if order[root] != UNSEEN {
            continue;
        }
        let mut path = vec![(root, 0)];
        while let Some(&mut (row, ref mut column)) = path.last_mut() {
            if order[row] == UNSEEN {
                (order[row], low[row]) = (count, count);
                count += 1;
                stack.push(row);
                on_stack[row] = true;
            }
            let next = (*column..n).find(|&c| {
                matrix[(row, c)] != Complex::ZERO && (order[c] == UNSEEN || on_stack[c])
            });
            if let Some(c) = next {
                if order[c] == UNSEEN {
                    *column = c;
                    path.push((c, 0));
                } else {
                    *column = c + 1;
                    low[row] = low[row].min(order[c]);
                }
                continue;
            }
            path.pop();
            if let Some(&(parent, _)) = path.last() {
                low[parent] = low[parent].min(low[row]);
            }
            if low[row] == order[row] {
                let mut component = Vec::new();
                while let Some(r) = stack.pop() {
                    on_stack[r] = false;
                    component.push(r);
                    if r == row {
                        break;
                    }
                }
                component.sort_unstable();
                found.push(component);
            }
        }
    }
    found
}

/// The left eigenvector of a matrix for an eigenvalue of one of its components, continued to all components that
/// this one depends on.
pub(super) fn left_vector(
    matrix: &Matrix,
    components: &[Vec<usize>],
    component: usize,
    eigenvalue: f64,
) -> Option<Vec<f64>> {
    let own = &components[component];
    let mut vector = vec![0.0; matrix.row_count()];
    let start = left_eigenvector(&matrix.block(own, own), eigenvalue.into())?;
    own.iter()
        .zip(start)
        .for_each(|(&row, weight)| vector[row] = weight.re);
    // Components come after those that they depend on: this one reaches only earlier ones.
    for rows in components[..component].iter().rev() {
        let drawn = |&column: &usize| {
            let terms = (0..).zip(&vector);
            terms.fold(Complex::ZERO, |sum, (row, &weight)| {
                sum - matrix[(row, column)] * weight
            })
        };
        let right: Vec<Complex> = rows.iter().map(drawn).collect();
        if right.iter().all(|&entry| entry == Complex::ZERO) {
            continue;
        }
        let system = matrix.block(rows, rows).shifted(eigenvalue.into());
        let solution = solve_left(&system, right)?;
        rows.iter()
            .zip(solution)
            .for_each(|(&row, weight)| vector[row] = weight.re);
    }
    Some(vector)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers between −1 and 1 without a pattern.
    fn number(seed: usize) -> f64 {
        let state = (seed as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        (state ^ state >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9) as i64 as f64 / 2f64.powi(63)
    }

    fn sorted(values: &[Complex]) -> Vec<(f64, f64)> {
        let mut parts: Vec<(f64, f64)> = values.iter().map(|v| (v.re, v.im)).collect();
        parts.sort_by(|a, b| (a.0 + 1e-3 * a.1).total_cmp(&(b.0 + 1e-3 * b.1)));
        parts
    }

    /// The crate nalgebra computes the same eigenvalues by its Schur decomposition.
    #[test]
    fn eigenvalues_are_those_of_another_implementation() {
        for n in [1, 2, 3, 5, 8, 21, 60] {
            for is_complex in [false, true] {
                let entry = |i: usize, j: usize| {
                    let seed = 2 * (i * 97 + j) + 20_000 * n;
                    let im = if is_complex { number(seed + 1) } else { 0.0 };
                    Complex::new(number(seed), im)
                };
                let other = nalgebra::DMatrix::from_fn(n, n, |i, j| {
                    nalgebra::Complex::new(entry(i, j).re, entry(i, j).im)
                });
                let (_, triangular) = other.schur().unpack();
                let theirs = triangular.diagonal();
                let theirs: Vec<Complex> =
                    theirs.iter().map(|v| Complex::new(v.re, v.im)).collect();
                let ours = eigenvalues(&Matrix::from_fn(n, n, entry)).unwrap();
                let (ours, theirs) = (sorted(&ours), sorted(&theirs));
                for (a, b) in ours.iter().zip(&theirs) {
                    assert!(
                        (a.0 - b.0).abs() < 1e-11 && (a.1 - b.1).abs() < 1e-11,
                        "{n}: {a:?} {b:?}"
                    );
                }
            }
        }
    }

    /// A turn of n places has the n-th roots of 1: no shift of the last block alone would find them.
    #[test]
    fn eigenvalues_of_turns_are_roots_of_one() {
        for n in [2, 3, 4, 7, 12, 64] {
            let turn = Matrix::from_fn(n, n, |i, j| f64::from(u8::from((i + 1) % n == j)));
            for value in eigenvalues(&turn).unwrap() {
                let angle =
                    crate::math::atan2(value.im, value.re) * n as f64 / core::f64::consts::TAU;
                assert!((value.modulus() - 1.0).abs() < 1e-13, "{n}: {value:?}");
                assert!((angle - angle.round()).abs() < 1e-11, "{n}: {value:?}");
            }
        }
    }

    /// Jordan blocks of 1/4 among other eigenvalues, in other coordinates of whole numbers: one eigenvalue, one left eigenvector.
    #[test]
    fn jordan_blocks_are_joined() {
        for size in [2, 3] {
            let n = size + 2;
            let jordan = |i: usize, j: usize| match j.wrapping_sub(i) {
                0 if i < size => 0.25,
                0 => 0.1 * i as f64,
                1 if j < size => 1.0,
                _ => 0.0,
            };
            // Coordinates: 1 on and below the diagonal; the inverse differs from 0 on two diagonals.
            let left = |i: usize, j: usize| (0..=i).map(|k| jordan(k, j)).sum::<f64>();
            let inverse = |i: usize, j: usize| match i.wrapping_sub(j) {
                0 => 1.0,
                1 => -1.0,
                _ => 0.0,
            };
            let matrix = Matrix::from_fn(n, n, |i, j| {
                (0..n).map(|k| left(i, k) * inverse(k, j)).sum::<f64>()
            });
            let joined = join_jordan_blocks(&matrix, eigenvalues(&matrix).unwrap());
            let blocks: Vec<_> = joined.iter().filter(|(_, defective)| *defective).collect();
            assert_eq!((joined.len(), blocks.len()), (3, 1), "{joined:?}");
            assert!((blocks[0].0.re - 0.25).abs() < 1e-12);
            assert_eq!(eigenspace_dimension(&matrix, 0.25), 1);
            assert!(left_eigenvector(&matrix, 0.25.into()).is_some());
        }
    }

    /// A singular system whose solutions are a line: the one found is orthogonal to it.
    #[test]
    fn solutions_are_of_least_length() {
        let matrix = Matrix::from_fn(3, 3, |i, j| {
            [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]][i][j]
        });
        let right: Vec<Complex> = [12.0, 15.0, 18.0].map(Complex::from).to_vec();
        let solution = solve_left(&matrix, right).unwrap();
        // x·M = right has the solutions (1, 1, 1) + t (1, −2, 1).
        let t = (
            solution[0].re - 1.0,
            solution[1].re - 1.0,
            solution[2].re - 1.0,
        );
        assert!(
            t.0.abs() < 1e-12 && t.1.abs() < 1e-12 && t.2.abs() < 1e-12,
            "{t:?}"
        );
        assert!(solve_left(&matrix, [1.0, 0.0, 0.0].map(Complex::from).to_vec()).is_none());
    }
}

//! Numerical linear algebra of small matrices: eigenvalues, left eigenvectors, the strongly connected
//! components of a matrix's pattern (its block triangular form), and linear systems from the left.
//!
//! Nothing here knows of schemes. Everything returns `None` where an iteration does not converge or a system has
//! no solution.

use nalgebra::{Complex, ComplexField, DMatrix, DVector, Schur};

/// QR steps allowed for a matrix of n rows, as a multiple of n: two or three a row are usual.
const STEPS_PER_ROW: usize = 60;

/// Greatest residual, relative to the matrix, of a left eigenvector that is accepted.
const RESIDUAL: f64 = 1e-9;

/// Up to this size linear systems are solved by singular values, which find the solution of least length even
/// where the matrix is singular.
const SINGULAR_VALUES_UP_TO: usize = 24;

/// Eigenvalues of a real square matrix.
pub(super) fn eigenvalues(matrix: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    let schur = Schur::try_new(matrix.clone(), f64::EPSILON, STEPS_PER_ROW * (matrix.nrows() + 2))?;
    Some(schur.complex_eigenvalues().iter().copied().collect())
}

/// Eigenvalues of a complex square matrix.
pub(super) fn complex_eigenvalues(matrix: &DMatrix<Complex<f64>>) -> Option<Vec<Complex<f64>>> {
    if matrix.nrows() == 1 {
        return Some(vec![matrix[(0, 0)]]);
    }
    let schur = Schur::try_new(matrix.clone(), f64::EPSILON, STEPS_PER_ROW * (matrix.nrows() + 2))?;
    let (_, triangular) = schur.unpack();
    Some(triangular.diagonal().iter().copied().collect())
}

/// The left eigenvector of a simple eigenvalue, of unit length, by inverse iteration.
pub(super) fn left_eigenvector<T>(matrix: &DMatrix<T>, eigenvalue: T) -> Option<DVector<T>>
where
    T: ComplexField<RealField = f64> + Copy,
{
    let n = matrix.nrows();
    if n == 1 {
        return Some(DVector::from_element(1, T::one()));
    }
    let size = matrix.norm().max(f64::MIN_POSITIVE);
    let transposed = matrix.transpose();
    // A shift beside the eigenvalue keeps the system solvable; the error it leaves shrinks by 1e-10 a step.
    let shift = eigenvalue + T::from_real(size * 1e-11);
    let system = (&transposed - DMatrix::identity(n, n) * shift).lu();
    // Starting with unequal entries: a vector with the matrix's symmetry could miss the eigenvector.
    let mut vector = DVector::from_fn(n, |i, _| T::from_real(1.0 + 0.37 * ((i * i + i) as f64 * 0.61).sin()));
    for _ in 0..4 {
        vector = system.solve(&vector)?;
        let length = vector.norm();
        if !length.is_finite() || length == 0.0 {
            return None;
        }
        vector.unscale_mut(length);
    }
    let residual = (&transposed * &vector - &vector * eigenvalue).norm();
    (residual <= RESIDUAL * size).then_some(vector)
}

/// A solution x of `x·matrix = right`, of least length where there are several.
pub(super) fn solve_left(matrix: &DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
    let transposed = matrix.transpose();
    let solution = if matrix.nrows() <= SINGULAR_VALUES_UP_TO {
        let singular = transposed.clone().try_svd(true, true, f64::EPSILON, 1000)?;
        let cut = 1e-10 * singular.singular_values.max().max(1e-3);
        singular.solve(right, cut).ok()?
    } else {
        transposed.clone().lu().solve(right)?
    };
    let residual = (&transposed * &solution - right).norm();
    (residual <= RESIDUAL * (right.norm() + matrix.norm())).then_some(solution)
}

/// The strongly connected components of the pattern of a square matrix, where row i depends on the columns that
/// are not zero: a component comes after all those that it depends on. Each lists its rows in ascending order.
///
/// Tarjan's algorithm, without recursion.
pub(super) fn components(matrix: &DMatrix<f64>) -> Vec<Vec<usize>> {
    const UNSEEN: usize = usize::MAX;
    let n = matrix.nrows();
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
            let next = (*column..n).find(|&c| matrix[(row, c)] != 0.0 && (order[c] == UNSEEN || on_stack[c]));
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
                let start = stack.iter().rposition(|&r| r == row).unwrap_or(0);
                let mut component = stack.split_off(start);
                component.iter().for_each(|&r| on_stack[r] = false);
                component.sort_unstable();
                found.push(component);
            }
        }
    }
    found
}

/// The rows `rows` and columns `columns` of a matrix.
pub(super) fn block(matrix: &DMatrix<f64>, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), columns.len(), |i, j| matrix[(rows[i], columns[j])])
}

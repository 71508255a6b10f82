//! Numerical linear algebra of small matrices: eigenvalues, left eigenvectors, the strongly connected
//! components of a matrix's pattern (its block triangular form), and linear systems from the left.
//!
//! Nothing here knows of schemes. Everything returns `None` where an iteration does not converge or a system has
//! no solution.

use nalgebra::{Complex, ComplexField, DMatrix, DVector, Schur};

use crate::math;

/// QR steps allowed for a matrix of n rows, as a multiple of n: two or three a row are usual.
const STEPS_PER_ROW: usize = 60;

/// Greatest residual, relative to the matrix, of a left eigenvector that is accepted.
const RESIDUAL: f64 = 1e-9;

/// Up to this size linear systems and null vectors are found by singular values, which give the solution of least
/// length even where the matrix is singular.
const SINGULAR_VALUES_UP_TO: usize = 24;

/// Where the iteration for singular values stops; at machine precision itself it may not end.
const SINGULAR_VALUE_ACCURACY: f64 = 5.0 * f64::EPSILON;

/// Eigenvalues of a real square matrix.
pub(super) fn eigenvalues(matrix: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    let schur = Schur::try_new(
        matrix.clone(),
        f64::EPSILON,
        STEPS_PER_ROW * (matrix.nrows() + 2),
    )?;
    Some(schur.complex_eigenvalues().iter().copied().collect())
}

/// Eigenvalues of a complex square matrix.
pub(super) fn complex_eigenvalues(matrix: &DMatrix<Complex<f64>>) -> Option<Vec<Complex<f64>>> {
    if matrix.nrows() == 1 {
        return Some(vec![matrix[(0, 0)]]);
    }
    let schur = Schur::try_new(
        matrix.clone(),
        f64::EPSILON,
        STEPS_PER_ROW * (matrix.nrows() + 2),
    )?;
    let (_, triangular) = schur.unpack();
    Some(triangular.diagonal().iter().copied().collect())
}

/// The one left eigenvector of an eigenvalue, of unit length.
pub(super) fn left_eigenvector<T>(matrix: &DMatrix<T>, eigenvalue: T) -> Option<DVector<T>>
where
    T: ComplexField<RealField = f64> + Copy,
{
    let n = matrix.nrows();
    let transposed = matrix.transpose();
    let vector = if n <= SINGULAR_VALUES_UP_TO {
        null_vector(&transposed - DMatrix::identity(n, n) * eigenvalue)?
    } else {
        inverse_iteration(&transposed, eigenvalue)?
    };
    let residual = (&transposed * &vector - &vector * eigenvalue).norm();
    (residual <= RESIDUAL * matrix.norm()).then_some(vector)
}

/// The unit vector that a matrix shrinks most: its null vector where its rank is one short, as for the eigenvalue
/// of a Jordan block, where inverse iteration would lose half the digits.
fn null_vector<T>(matrix: DMatrix<T>) -> Option<DVector<T>>
where
    T: ComplexField<RealField = f64> + Copy,
{
    if matrix.nrows() == 1 {
        return Some(DVector::from_element(1, T::one()));
    }
    let singular = matrix.try_svd(false, true, SINGULAR_VALUE_ACCURACY, 1000)?;
    Some(singular.v_t?.row(singular.singular_values.imin()).adjoint())
}

/// The right eigenvector of a simple eigenvalue.
fn inverse_iteration<T>(matrix: &DMatrix<T>, eigenvalue: T) -> Option<DVector<T>>
where
    T: ComplexField<RealField = f64> + Copy,
{
    let n = matrix.nrows();
    let size = matrix.norm().max(f64::MIN_POSITIVE);
    // A shift next to the eigenvalue keeps the system solvable; the error it leaves shrinks by
    // 1e-10 a step.
    let shift = eigenvalue + T::from_real(size * 1e-11);
    let system = (matrix - DMatrix::identity(n, n) * shift).lu();
    // Starting with unequal entries: a vector with the matrix's symmetry could miss the eigenvector.
    let mut vector = DVector::from_fn(n, |i, _| {
        T::from_real(1.0 + 0.37 * math::sin((i * i + i) as f64 * 0.61))
    });
    for _ in 0..4 {
        vector = system.solve(&vector)?;
        let length = vector.norm();
        if !length.is_finite() || length == 0.0 {
            return None;
        }
        vector.unscale_mut(length);
    }
    Some(vector)
}

/// A solution x of `x·matrix = right`, of least length where there are several.
fn solve_left(matrix: &DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
    let transposed = matrix.transpose();
    let solution = if matrix.nrows() <= SINGULAR_VALUES_UP_TO {
        let singular = transposed
            .clone()
            .try_svd(true, true, SINGULAR_VALUE_ACCURACY, 1000)?;
        let cut = 1e-10 * singular.singular_values.max().max(1e-3);
        singular.solve(right, cut).ok()?
    } else {
        transposed.clone().lu().solve(right)?
    };
    let residual = (&transposed * &solution - right).norm();
    (residual <= RESIDUAL * (right.norm() + matrix.norm())).then_some(solution)
}

/// Replaces the eigenvalues that belong to one Jordan block by one, and says which those are.
///
/// Rounding splits the eigenvalue of a block of size m into m that differ by some ε^{1/m}, while their mean stays
/// accurate; whether they are one block shows in the rank of the matrix minus that mean. Matrices larger than
/// [`SINGULAR_VALUES_UP_TO`] are left alone.
pub(super) fn join_jordan_blocks(
    matrix: &DMatrix<f64>,
    mut values: Vec<Complex<f64>>,
) -> Vec<(Complex<f64>, bool)> {
    /// Eigenvalues of a block of size two differ by less than this fraction of the matrix.
    const CLOSE: f64 = 1e-6;
    let size = matrix.norm();
    let mut joined = Vec::with_capacity(values.len());
    while let Some(value) = values.pop() {
        let (near, far): (Vec<_>, Vec<_>) = values
            .iter()
            .partition(|other| (*other - value).modulus() <= CLOSE * size);
        let mean = (near.iter().sum::<Complex<f64>>() + value) / (near.len() + 1) as f64;
        let is_real = mean.im.abs() <= 1e-12 * size;
        let defective =
            !near.is_empty() && is_real && eigenspace_dimension(matrix, mean.re) == Some(1);
        if defective {
            joined.push((Complex::new(mean.re, 0.0), true));
            values = far;
        } else {
            joined.push((value, false));
        }
    }
    joined
}

/// How many independent eigenvectors a matrix has for an eigenvalue; `None` for matrices larger than
/// [`SINGULAR_VALUES_UP_TO`].
pub(super) fn eigenspace_dimension(matrix: &DMatrix<f64>, eigenvalue: f64) -> Option<usize> {
    let (n, size) = (matrix.nrows(), matrix.norm());
    if n > SINGULAR_VALUES_UP_TO {
        return None;
    }
    let shifted = matrix - DMatrix::identity(n, n) * eigenvalue;
    let singular = shifted.try_svd(false, false, SINGULAR_VALUE_ACCURACY, 1000)?;
    Some(
        singular
            .singular_values
            .iter()
            .filter(|&&s| s <= 1e-9 * size)
            .count(),
    )
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
            let next = (*column..n)
                .find(|&c| matrix[(row, c)] != 0.0 && (order[c] == UNSEEN || on_stack[c]));
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

/// The rows `rows` and columns `columns` of a matrix.
pub(super) fn block(matrix: &DMatrix<f64>, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
        matrix[(rows[i], columns[j])]
    })
}

/// The left eigenvector of a matrix for an eigenvalue of one of its components, continued to all components that
/// this one depends on.
pub(super) fn left_vector(
    matrix: &DMatrix<f64>,
    components: &[Vec<usize>],
    component: usize,
    eigenvalue: f64,
) -> Option<DVector<f64>> {
    let own = &components[component];
    let mut vector = DVector::zeros(matrix.nrows());
    let start = left_eigenvector(&block(matrix, own, own), eigenvalue)?;
    own.iter()
        .zip(start.iter())
        .for_each(|(&row, &weight)| vector[row] = weight);
    // Components come after those that they depend on: this one reaches only earlier ones.
    for rows in components[..component].iter().rev() {
        let columns = DMatrix::from_fn(matrix.nrows(), rows.len(), |i, j| matrix[(i, rows[j])]);
        let right = -columns.tr_mul(&vector);
        if right.iter().all(|&entry| entry == 0.0) {
            continue;
        }
        let system =
            block(matrix, rows, rows) - DMatrix::identity(rows.len(), rows.len()) * eigenvalue;
        let solution = solve_left(&system, &right)?;
        rows.iter()
            .zip(solution.iter())
            .for_each(|(&row, &weight)| vector[row] = weight);
    }
    Some(vector)
}

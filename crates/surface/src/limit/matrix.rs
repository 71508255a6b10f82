//! Small dense matrices of complex numbers, and linear systems that may be singular.

use core::ops::{Index, IndexMut};

use super::complex::Complex;

/// A vector's Euclidean length.
pub(super) fn length(vector: &[Complex]) -> f64 {
    let squares = vector.iter().map(|entry| entry.modulus_squared());
    squares.sum::<f64>().sqrt()
}

/// Σ aᵢ* bᵢ.
fn inner_product(a: &[Complex], b: &[Complex]) -> Complex {
    a.iter()
        .zip(b)
        .fold(Complex::ZERO, |sum, (a, &b)| sum + a.conj() * b)
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Matrix {
    rows: usize,
    columns: usize,
    /// Row by row.
    entries: Vec<Complex>,
}

impl Matrix {
    pub(super) fn from_fn<T: Into<Complex>>(
        rows: usize,
        columns: usize,
        entry: impl Fn(usize, usize) -> T,
    ) -> Self {
        let entry = &entry;
        let of_row = |row| (0..columns).map(move |column| entry(row, column).into());
        Self {
            rows,
            columns,
            entries: (0..rows).flat_map(of_row).collect(),
        }
    }

    pub(super) fn zeros(rows: usize, columns: usize) -> Self {
        Self::from_fn(rows, columns, |_, _| Complex::ZERO)
    }

    pub(super) fn row_count(&self) -> usize {
        self.rows
    }

    fn row(&self, row: usize) -> &[Complex] {
        &self.entries[row * self.columns..][..self.columns]
    }

    /// The root of the sum of all squared moduli.
    pub(super) fn norm(&self) -> f64 {
        length(&self.entries)
    }

    pub(super) fn transposed(&self) -> Self {
        Self::from_fn(self.columns, self.rows, |row, column| self[(column, row)])
    }

    /// The matrix minus a multiple of the identity.
    pub(super) fn shifted(&self, by: Complex) -> Self {
        let mut shifted = self.clone();
        (0..self.rows).for_each(|i| shifted[(i, i)] -= by);
        shifted
    }

    /// The rows `rows` and columns `columns`.
    pub(super) fn block(&self, rows: &[usize], columns: &[usize]) -> Self {
        Self::from_fn(rows.len(), columns.len(), |i, j| {
            self[(rows[i], columns[j])]
        })
    }

    /// The product with a column.
    pub(super) fn times(&self, vector: &[Complex]) -> Vec<Complex> {
        let of_row = |row| {
            let terms = self.row(row).iter().zip(vector);
            terms.fold(Complex::ZERO, |sum, (&a, &b)| sum + a * b)
        };
        (0..self.rows).map(of_row).collect()
    }

    pub(super) fn swap_rows(&mut self, a: usize, b: usize) {
        for column in 0..self.columns {
            self.entries
                .swap(a * self.columns + column, b * self.columns + column);
        }
    }

    pub(super) fn swap_columns(&mut self, a: usize, b: usize) {
        for row in self.entries.chunks_exact_mut(self.columns) {
            row.swap(a, b);
        }
    }

    /// Adds a multiple of row `of` to row `to`, from a column on.
    pub(super) fn add_row(&mut self, to: usize, of: usize, factor: Complex, from: usize) {
        for column in from..self.columns {
            let product = factor * self[(of, column)];
            self[(to, column)] += product;
        }
    }
}

impl Index<(usize, usize)> for Matrix {
    type Output = Complex;
    fn index(&self, (row, column): (usize, usize)) -> &Complex {
        &self.entries[row * self.columns + column]
    }
}

impl IndexMut<(usize, usize)> for Matrix {
    fn index_mut(&mut self, (row, column): (usize, usize)) -> &mut Complex {
        &mut self.entries[row * self.columns + column]
    }
}

/// A square linear system A·x = b after Gaussian elimination with complete pivoting: `rank` unknowns follow from the others. Complete pivoting
/// shows the rank, however small the entries of the rows that are left.
pub(super) struct Reduced {
    matrix: Matrix,
    right: Vec<Complex>,
    /// Which unknown each column belongs to.
    unknowns: Vec<usize>,
    pub(super) rank: usize,
}

impl Reduced {
    /// Eliminates at most `most` unknowns, and none whose pivot's modulus is at most `cut`.
    pub(super) fn new(matrix: Matrix, right: Vec<Complex>, most: usize, cut: f64) -> Self {
        let mut system = Self {
            unknowns: (0..matrix.rows).collect(),
            matrix,
            right,
            rank: 0,
        };
        while system.rank < most && system.eliminate(cut) {
            system.rank += 1;
        }
        system
    }

    /// Makes what is below the next pivot 0; false where there is none greater than `cut`.
    fn eliminate(&mut self, cut: f64) -> bool {
        let (n, step) = (self.matrix.rows, self.rank);
        let (mut greatest, mut place) = (cut * cut, None);
        for row in step..n {
            for column in step..n {
                let size = self.matrix[(row, column)].modulus_squared();
                if size > greatest {
                    (greatest, place) = (size, Some((row, column)));
                }
            }
        }
        let Some((row, column)) = place else {
            return false;
        };
        self.matrix.swap_rows(step, row);
        self.right.swap(step, row);
        self.matrix.swap_columns(step, column);
        self.unknowns.swap(step, column);
        let pivot = self.matrix[(step, step)];
        for row in step + 1..n {
            let factor = -(self.matrix[(row, step)] / pivot);
            if factor != Complex::ZERO {
                self.matrix.add_row(row, step, factor, step);
                let product = factor * self.right[step];
                self.right[row] += product;
            }
        }
        true
    }

    /// The solution for values of the unknowns that are left, by column, of the system with the right side or with zeros.
    fn solution(&self, free: impl Fn(usize) -> f64, right: bool) -> Vec<Complex> {
        let n = self.matrix.rows;
        let mut solution = vec![Complex::ZERO; n];
        for column in self.rank..n {
            solution[self.unknowns[column]] = free(column).into();
        }
        for row in (0..self.rank).rev() {
            let start = if right {
                self.right[row]
            } else {
                Complex::ZERO
            };
            let sum = (row + 1..n).rev().fold(start, |sum, column| {
                sum - self.matrix[(row, column)] * solution[self.unknowns[column]]
            });
            // Adding 0 takes away the sign of zeros.
            solution[self.unknowns[row]] = sum / self.matrix[(row, row)] + Complex::ZERO;
        }
        solution
    }

    /// A vector of unit length that the matrix takes to 0.
    pub(super) fn null_vector(&self) -> Option<Vec<Complex>> {
        self.null_vectors().into_iter().next()
    }

    /// An orthonormal basis of the vectors that the matrix takes to 0.
    fn null_vectors(&self) -> Vec<Vec<Complex>> {
        let mut basis: Vec<Vec<Complex>> = Vec::new();
        for own in self.rank..self.matrix.rows {
            let mut vector = self.solution(|column| f64::from(u8::from(column == own)), false);
            take_away(&mut vector, &basis);
            let length = length(&vector);
            vector.iter_mut().for_each(|entry| *entry = *entry / length);
            basis.push(vector);
        }
        basis
    }

    /// The solution of least length.
    pub(super) fn least_solution(&self) -> Vec<Complex> {
        let mut solution = self.solution(|_| 0.0, true);
        take_away(&mut solution, &self.null_vectors());
        solution
    }
}

/// Makes a vector orthogonal to those of an orthonormal basis.
fn take_away(vector: &mut [Complex], basis: &[Vec<Complex>]) {
    for direction in basis {
        let share = inner_product(direction, vector);
        for (entry, &along) in vector.iter_mut().zip(direction) {
            *entry -= share * along;
        }
    }
}

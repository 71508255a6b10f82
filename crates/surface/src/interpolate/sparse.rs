//! Sparse matrices by rows, and sums over vectors of points in a fixed order.

use crate::limit::LimitRows;
use crate::parallel::{self, Poll};
use crate::progress::Cancelled;
use crate::vector::DVec3;

/// Elements of a sum that are added together: fixed, so that results do not depend on threads.
const PIECE: usize = 1 << 12;

/// A sparse matrix; it acts on each coordinate of points alike.
pub(super) struct Sparse {
    starts: Vec<usize>,
    columns: Vec<u32>,
    weights: Vec<f64>,
}

impl From<LimitRows> for Sparse {
    fn from(rows: LimitRows) -> Self {
        Self {
            starts: rows.starts,
            columns: rows.vertices,
            weights: rows.weights,
        }
    }
}

impl Sparse {
    /// A matrix without rows.
    pub(super) fn empty() -> Self {
        Self {
            starts: vec![0],
            columns: Vec::new(),
            weights: Vec::new(),
        }
    }

    /// Adds a row.
    pub(super) fn push(&mut self, row: impl IntoIterator<Item = (u32, f64)>) {
        for (column, weight) in row {
            self.columns.push(column);
            self.weights.push(weight);
        }
        self.starts.push(self.columns.len());
    }

    /// Number of rows.
    pub(super) fn rows(&self) -> usize {
        self.starts.len() - 1
    }

    /// The columns of a row and their weights.
    #[inline]
    pub(super) fn row(&self, i: usize) -> impl ExactSizeIterator<Item = (u32, f64)> + Clone + '_ {
        let row = self.starts[i]..self.starts[i + 1];
        self.columns[row.clone()]
            .iter()
            .copied()
            .zip(self.weights[row].iter().copied())
    }

    /// The columns of a row.
    #[inline]
    pub(super) fn columns(&self, i: usize) -> &[u32] {
        &self.columns[self.starts[i]..self.starts[i + 1]]
    }

    /// The weights of a row, in the order of its columns.
    pub(super) fn weights_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.weights[self.starts[i]..self.starts[i + 1]]
    }

    /// The product of a row with a vector.
    #[inline]
    pub(super) fn row_times(&self, i: usize, x: &[DVec3]) -> DVec3 {
        self.row(i).fold(DVec3::ZERO, |sum, (column, weight)| {
            sum + weight * x[column as usize]
        })
    }

    /// The product with a vector.
    pub(crate) fn times(&self, x: &[DVec3], poll: &mut Poll<'_>) -> Result<Vec<DVec3>, Cancelled> {
        parallel::map_polled(self.rows(), poll, |i| self.row_times(i, x))
    }

    /// The transposed matrix of a matrix with `columns` columns.
    pub(super) fn transposed(&self, columns: usize) -> Self {
        let mut starts = vec![0; columns + 1];
        self.columns
            .iter()
            .for_each(|&column| starts[column as usize + 1] += 1);
        for i in 0..columns {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut transposed = Self {
            starts,
            columns: vec![0; self.columns.len()],
            weights: self.weights.clone(),
        };
        for i in 0..self.rows() {
            for (column, weight) in self.row(i) {
                let place = next[column as usize];
                (transposed.columns[place], transposed.weights[place]) = (i as u32, weight);
                next[column as usize] += 1;
            }
        }
        transposed
    }
}

/// The sum of `f` over all places below `n`.
pub(crate) fn sum(
    n: usize,
    poll: &mut Poll<'_>,
    f: impl Fn(usize) -> DVec3 + Sync,
) -> Result<DVec3, Cancelled> {
    let pieces = parallel::pieces_polled(n, PIECE, poll, |piece| piece.map(&f).sum::<DVec3>())?;
    Ok(pieces.into_iter().sum())
}

/// The greatest of `f` over all places below `n`; NaN counts as infinite.
pub(crate) fn greatest(
    n: usize,
    poll: &mut Poll<'_>,
    f: impl Fn(usize) -> f64 + Sync,
) -> Result<f64, Cancelled> {
    let most = |a: f64, b: f64| if b.is_nan() { f64::INFINITY } else { a.max(b) };
    let pieces = parallel::pieces_polled(n, PIECE, poll, |piece| piece.map(&f).fold(0.0, most))?;
    Ok(pieces.into_iter().fold(0.0, f64::max))
}

/// Changes each element of a vector by its place.
pub(crate) fn update(
    x: &mut [DVec3],
    poll: &mut Poll<'_>,
    f: impl Fn(usize, &mut DVec3) + Sync,
) -> Result<(), Cancelled> {
    parallel::for_each_chunk_polled(x, PIECE, poll, |chunk, slots| {
        slots
            .iter_mut()
            .enumerate()
            .for_each(|(i, slot)| f(chunk * PIECE + i, slot));
    })
}

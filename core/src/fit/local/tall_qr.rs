//! The triangular factor of a tall matrix, block by block (Golub and Van Loan, *Matrix Computations*, 2013, sec. 5.2).
//!
//! A block of rows is stacked under the triangle of the rows before it, and Householder reflections make the stack triangular again. A
//! reflection touches one row of the triangle and the block. The residuals are one more column, so that Qᵀr comes out beside R, and Q
//! is not kept. The working set is one block, whatever the number of rows.

use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Rows of a block: with nine columns it fits into the first-level cache.
const BLOCK: usize = 256;
/// Rows that are reduced together before chunks meet. The order of operations depends on it, not on the number of threads.
const CHUNK: usize = 16_384;

/// R of `A = Q R`, and Qᵀr.
#[derive(Debug, Clone, Default)]
pub(crate) struct TallQr {
    columns: usize,
    /// Column after column of the triangle with r as its last column, `columns` rows each.
    r: Vec<f64>,
    block: Vec<f64>,
}

impl TallQr {
    /// Factorises those columns of a matrix with the residuals beside them.
    pub(crate) fn reduce(&mut self, matrix: &DMatrix<f64>, columns: &[usize], residuals: &DVector<f64>) {
        self.reduce_rows(matrix, columns, residuals, 0..matrix.nrows());
    }

    fn reduce_rows(&mut self, matrix: &DMatrix<f64>, columns: &[usize], residuals: &DVector<f64>, rows: Range<usize>) {
        self.clear(columns.len());
        if rows.len() <= CHUNK {
            self.add_rows(matrix, columns, residuals, rows);
            return;
        }
        let chunk = |first: usize| {
            let mut part = Self::default();
            part.clear(columns.len());
            part.add_rows(matrix, columns, residuals, first..rows.end.min(first + CHUNK));
            part
        };
        for part in map_chunks(rows.clone(), &chunk) {
            self.add_triangle(&part);
        }
    }

    /// The same of a matrix whose columns, all but the last ones, are 0 outside some rows: `extents` has the rows of each column of the matrix,
    /// those of equal rows side by side. Each block of rows is made triangular in its own columns first; what is left of it meets the others
    /// in the columns that all have. The cost is the sum of the blocks.
    pub(crate) fn reduce_blocks(&mut self, matrix: &DMatrix<f64>, columns: &[usize], residuals: &DVector<f64>, extents: &[Range<usize>]) {
        let whole = 0..matrix.nrows();
        let border = columns.iter().position(|&j| extents[j] == whole).unwrap_or(columns.len());
        // Blocks of which no own column takes part count as well.
        let mut blocks: Vec<Range<usize>> = extents.iter().filter(|rows| **rows != whole).cloned().collect();
        blocks.dedup();
        if blocks.is_empty() || blocks.iter().map(ExactSizeIterator::len).sum::<usize>() != whole.len() {
            return self.reduce(matrix, columns, residuals);
        }
        let (n, shared) = (columns.len(), columns.len() - border);
        self.clear(n);
        let mut meeting = Self::default();
        meeting.clear(shared);
        let mut first = 0;
        for rows in blocks {
            let own = columns[first..border].iter().take_while(|&&j| extents[j] == rows).count();
            let of_block: Vec<usize> = columns[first..first + own].iter().chain(&columns[border..]).copied().collect();
            let mut part = Self::default();
            part.reduce_rows(matrix, &of_block, residuals, rows);
            // The place of a column of the block in the whole; the residuals stand last in both.
            let place = |k: usize| if k < own { first + k } else { border + k - own };
            for k in 0..=own + shared {
                for i in 0..own.min(k + 1) {
                    self.r[place(k) * n + first + i] = part.r[k * part.columns + i];
                }
            }
            meeting.add_corner(&part, own);
            first += own;
        }
        for k in 0..=shared {
            for i in 0..shared.min(k + 1) {
                self.r[(border + k) * n + border + i] = meeting.r[k * shared + i];
            }
        }
    }

    /// Adds the rows of another triangle without its first rows and columns.
    fn add_corner(&mut self, other: &Self, skipped: usize) {
        if self.columns == 0 {
            return;
        }
        self.block.clear();
        for column in other.r.chunks_exact(other.columns).skip(skipped) {
            self.block.extend_from_slice(&column[skipped..]);
        }
        self.eliminate(self.columns);
    }

    fn clear(&mut self, columns: usize) {
        self.columns = columns;
        self.r.clear();
        self.r.resize(columns * (columns + 1), 0.0);
    }

    fn add_rows(&mut self, matrix: &DMatrix<f64>, columns: &[usize], residuals: &DVector<f64>, rows: Range<usize>) {
        let height = matrix.nrows();
        for first in rows.clone().step_by(BLOCK) {
            let end = rows.end.min(first + BLOCK);
            self.block.clear();
            for &j in columns {
                self.block.extend_from_slice(&matrix.as_slice()[j * height + first..j * height + end]);
            }
            self.block.extend_from_slice(&residuals.as_slice()[first..end]);
            self.eliminate(end - first);
        }
    }

    /// Adds the rows of another triangle.
    fn add_triangle(&mut self, other: &Self) {
        self.block.clear();
        self.block.extend_from_slice(&other.r);
        self.eliminate(self.columns);
    }

    /// Reflects the block of that many rows into the triangle.
    fn eliminate(&mut self, rows: usize) {
        let Self { columns, r, block, .. } = self;
        let n = *columns;
        if rows == 0 {
            return;
        }
        for j in 0..n {
            let (head, tail) = block.split_at_mut((j + 1) * rows);
            let v = &head[j * rows..];
            let pivot = r[j * n + j];
            let norm = (pivot * pivot + dot(v, v)).sqrt();
            if norm == 0.0 {
                continue;
            }
            let diagonal = if pivot > 0.0 { -norm } else { norm };
            // The reflector is 1 − v vᵀ/β with v = (pivot − diagonal, block column) and β = ‖v‖²/2.
            let first = pivot - diagonal;
            let over_beta = 1.0 / (norm * (norm + pivot.abs()));
            for (k, column) in (j + 1..).zip(tail.chunks_exact_mut(rows)) {
                let above = &mut r[k * n + j];
                let along = over_beta * (first * *above + dot(v, column));
                *above -= along * first;
                column.iter_mut().zip(v).for_each(|(c, v)| *c -= along * v);
            }
            r[j * n + j] = diagonal;
        }
    }

    /// An element of R on or above the diagonal.
    pub(crate) fn r(&self, i: usize, j: usize) -> f64 {
        self.r[j * self.columns + i]
    }

    /// Qᵀr, as many numbers as there are columns.
    pub(crate) fn rotated(&self) -> &[f64] {
        &self.r[self.columns * self.columns..]
    }

    /// Solves Rᵀ y = b in place, which turns Aᵀs into Qᵀs; an unknown without a pivot is 0.
    pub(crate) fn solve_transposed(&self, b: &mut [f64]) {
        for j in 0..self.columns {
            let (before, rest) = b.split_at_mut(j);
            let sum: f64 = before.iter().zip(&self.r[j * self.columns..]).map(|(y, r)| y * r).sum();
            let pivot = self.r(j, j);
            rest[0] = if pivot == 0.0 { 0.0 } else { (rest[0] - sum) / pivot };
        }
    }
}

/// The sum of products, in four running sums that the processor forms side by side.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (a, b) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a.zip(b) {
        for lane in 0..4 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// The chunks in their order, on all threads.
fn map_chunks(rows: Range<usize>, chunk: &(dyn Fn(usize) -> TallQr + Sync)) -> Vec<TallQr> {
    let firsts: Vec<usize> = rows.step_by(CHUNK).collect();
    #[cfg(feature = "threads")]
    {
        use rayon::prelude::*;
        firsts.par_iter().map(|&first| chunk(first)).collect()
    }
    #[cfg(not(feature = "threads"))]
    firsts.iter().map(|&first| chunk(first)).collect()
}

#[cfg(test)]
mod tests {
    use super::{BLOCK, CHUNK, TallQr};
    use nalgebra::{DMatrix, DVector};

    const COLUMNS: usize = 4;
    /// Roundings of sums of as many products as there are rows, of numbers below 1.
    const ROUNDING: f64 = 1e-11;

    /// Numbers without structure, in −0.4 … 0.6.
    fn numbers(ratio: f64) -> impl Iterator<Item = f64> {
        (1..).map(move |i: u32| (ratio * f64::from(i)).fract() - 0.4)
    }

    #[test]
    fn r_and_the_rotated_residuals_are_those_of_the_normal_equations() {
        for rows in [2, COLUMNS, BLOCK - 1, BLOCK + 3, CHUNK + BLOCK + 7] {
            let matrix = DMatrix::from_iterator(rows, COLUMNS, numbers(2.0_f64.sqrt()).take(rows * COLUMNS));
            let residuals = DVector::from_iterator(rows, numbers(3.0_f64.sqrt()).take(rows));
            let mut qr = TallQr::default();
            // Columns in another order, one of them left out.
            let columns = [2, 0, 1];
            qr.reduce(&matrix, &columns, &residuals);
            let r = DMatrix::from_fn(3, 3, |i, j| if i <= j { qr.r(i, j) } else { 0.0 });
            let picked = DMatrix::from_fn(rows, 3, |i, j| matrix[(i, columns[j])]);
            assert!((r.transpose() * &r - picked.transpose() * &picked).amax() < ROUNDING, "{rows}");
            let along = picked.transpose() * &residuals;
            assert!((r.transpose() * DVector::from_column_slice(qr.rotated()) - &along).amax() < ROUNDING, "{rows}");
            if rows > COLUMNS {
                let mut solved = along.as_slice().to_vec();
                qr.solve_transposed(&mut solved);
                assert!((DVector::from_vec(solved) - DVector::from_column_slice(qr.rotated())).amax() < ROUNDING, "{rows}");
            }
        }
    }

    #[test]
    fn a_bordered_matrix_has_the_triangle_of_the_dense_one() {
        // Two blocks with columns of their own, a third one of whose columns none takes part, and two columns that all have.
        let extents = [0..7, 0..7, 7..12, 12..20, 0..20, 0..20];
        let mut matrix = DMatrix::from_iterator(20, 6, numbers(2.0_f64.sqrt()).take(120));
        for (j, rows) in extents.iter().enumerate() {
            (0..20).filter(|i| !rows.contains(i)).for_each(|i| matrix[(i, j)] = 0.0);
        }
        let residuals = DVector::from_iterator(20, numbers(3.0_f64.sqrt()).take(20));
        for columns in [vec![0, 1, 2, 4, 5], vec![0, 1, 2, 3, 4, 5], vec![1, 3], vec![4], vec![]] {
            let (mut dense, mut bordered) = (TallQr::default(), TallQr::default());
            dense.reduce(&matrix, &columns, &residuals);
            bordered.reduce_blocks(&matrix, &columns, &residuals, &extents);
            let n = columns.len();
            // The rows of a triangle have a sign each.
            for i in 0..n {
                let sign = (dense.r(i, i) * bordered.r(i, i)).signum();
                let is_same = |one: f64, other: f64| (one - sign * other).abs() < ROUNDING;
                assert!((i..n).all(|j| is_same(dense.r(i, j), bordered.r(i, j))), "{columns:?}: row {i}");
                assert!(is_same(dense.rotated()[i], bordered.rotated()[i]), "{columns:?}: residual {i}");
            }
        }
    }

    #[test]
    fn a_column_of_zeros_leaves_no_pivot() {
        let matrix = DMatrix::from_column_slice(6, 2, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let mut qr = TallQr::default();
        qr.reduce(&matrix, &[0, 1], &DVector::repeat(6, 1.0));
        assert_eq!(qr.r(0, 0), 0.0);
        let mut b = [3.0, 1.0];
        qr.solve_transposed(&mut b);
        assert!(b[0] == 0.0 && b[1].is_finite());
    }
}

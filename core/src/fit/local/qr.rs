//! Householder's QR factorisation of small dense matrices, and damped least squares in a box on top of it (Golub and Van Loan,
//! *Matrix Computations*, 2013, sec. 5.2). The tall matrix of a step comes as its triangular factor.
//!
//! The matrices of a fit have a handful of columns. Plain loops over one buffer, used again from step to step, cost less than the
//! allocations of a general library. Normal equations would cost half the digits.

use crate::fit::local::tall_qr::TallQr;

/// `A = Q R`, in place: R on and above the diagonal, the reflectors below.
#[derive(Debug, Clone, Default)]
pub(crate) struct Qr {
    rows: usize,
    columns: usize,
    /// Column after column.
    a: Vec<f64>,
    /// The diagonal of R.
    diagonal: Vec<f64>,
}

impl Qr {
    /// Factorises the matrix of that many rows and columns that `fill` writes, column after column, over zeros.
    pub(crate) fn factorise(&mut self, rows: usize, columns: usize, fill: impl FnOnce(&mut [f64])) {
        self.rows = rows.max(columns);
        self.columns = columns;
        self.a.clear();
        self.a.resize(self.rows * columns, 0.0);
        self.diagonal.clear();
        self.diagonal.resize(columns, 0.0);
        fill(&mut self.a);
        for j in 0..columns {
            let (head, tail) = self.a.split_at_mut((j + 1) * self.rows);
            let v = &mut head[j * self.rows + j..];
            let norm = v.iter().map(|x| x * x).sum::<f64>().sqrt();
            if norm == 0.0 {
                continue;
            }
            let norm = if v[0] < 0.0 { -norm } else { norm };
            // v is scaled so that the reflector is 1 − v vᵀ/v₀.
            v.iter_mut().for_each(|x| *x /= norm);
            v[0] += 1.0;
            self.diagonal[j] = -norm;
            for column in tail.chunks_exact_mut(self.rows) {
                reflect(v, &mut column[j..]);
            }
        }
    }

    /// Writes Qᵀ b over b.
    pub(crate) fn transposed_times(&self, b: &mut [f64]) {
        for j in 0..self.columns {
            if self.diagonal[j] != 0.0 {
                reflect(&self.a[j * self.rows + j..(j + 1) * self.rows], &mut b[j..]);
            }
        }
    }

    /// Solves R x = b; an unknown without a pivot stays 0.
    pub(crate) fn solve(&self, b: &[f64], x: &mut [f64]) {
        x.copy_from_slice(&b[..self.columns]);
        for j in (0..self.columns).rev() {
            x[j] = if self.diagonal[j] == 0.0 { 0.0 } else { x[j] / self.diagonal[j] };
            let (above, rest) = x.split_at_mut(j);
            for (value, r) in above.iter_mut().zip(&self.a[j * self.rows..]) {
                *value -= rest[0] * r;
            }
        }
    }
}

/// Applies 1 − v vᵀ/v₀.
fn reflect(v: &[f64], column: &mut [f64]) {
    let dot: f64 = v.iter().zip(column.iter()).map(|(a, b)| a * b).sum();
    let factor = dot / v[0];
    column.iter_mut().zip(v).for_each(|(c, v)| *c -= factor * v);
}

/// A damped least squares problem in a box, `min ‖A d + b‖² + λ ‖D d‖²` with low ≤ d ≤ high, given A = Q R and Qᵀ b.
pub(crate) struct Damped<'a> {
    /// A.
    pub qr: &'a TallQr,
    /// D.
    pub scale: &'a [f64],
    /// λ.
    pub damping: f64,
}

/// Buffers of a damped problem, used again from step to step.
#[derive(Debug, Default)]
pub(crate) struct Buffers {
    qr: Qr,
    right: Vec<f64>,
    solution: Vec<f64>,
    /// The unknowns that are not on their bounds.
    inside: Vec<usize>,
}

impl Damped<'_> {
    /// Solves it within the bounds of the step. Of the unknowns that would pass their bounds, the one that does so by most of its
    /// step is put on its bound, and the others are solved again, until none passes.
    pub(crate) fn solve_within(&self, b: &[f64], bounds: &[(f64, f64)], step: &mut [f64], buffers: &mut Buffers) {
        let k = step.len();
        buffers.inside.clear();
        buffers.inside.extend(0..k);
        step.fill(0.0);
        loop {
            self.factorise(buffers);
            self.solve_inside(b, step, buffers);
            let excess = |(&j, &value): (&usize, &f64)| {
                let (low, high) = bounds[j];
                let bound = if value < low { low } else { high };
                (value < low || value > high).then(|| (j, bound, (value - bound).abs() / value.abs()))
            };
            let worst = buffers.inside.iter().zip(&buffers.solution).filter_map(excess).max_by(|a, b| a.2.total_cmp(&b.2));
            match worst {
                Some((j, bound, _)) => {
                    step[j] = bound;
                    buffers.inside.retain(|&other| other != j);
                    if buffers.inside.is_empty() {
                        return;
                    }
                }
                None => {
                    for (&j, &value) in buffers.inside.iter().zip(&buffers.solution) {
                        step[j] = value;
                    }
                    return;
                }
            }
        }
    }

    /// Solves it for another b, the unknowns that the last solution put on their bounds held at 0.
    pub(crate) fn resolve_with_rhs(&self, b: &[f64], step: &mut [f64], buffers: &mut Buffers) {
        step.fill(0.0);
        self.solve_inside(b, step, buffers);
        for (&j, &value) in buffers.inside.iter().zip(&buffers.solution) {
            step[j] = value;
        }
    }

    fn factorise(&self, buffers: &mut Buffers) {
        let k = self.scale.len();
        let Buffers { qr, inside, .. } = buffers;
        qr.factorise(2 * k, inside.len(), |a| {
            for (column, &j) in a.chunks_exact_mut(2 * k).zip(inside.iter()) {
                for (i, slot) in column[..=j].iter_mut().enumerate() {
                    *slot = self.qr.r(i, j);
                }
                column[k + j] = self.damping.sqrt() * self.scale[j];
            }
        });
    }

    /// With the unknowns outside `inside` at the values in `step`.
    fn solve_inside(&self, b: &[f64], step: &[f64], buffers: &mut Buffers) {
        let k = step.len();
        let Buffers { qr, right, solution, inside } = buffers;
        solution.clear();
        if inside.is_empty() {
            return;
        }
        right.clear();
        right.extend(b[..k].iter().map(|b| -b));
        right.resize(2 * k, 0.0);
        for (j, &value) in step.iter().enumerate().filter(|(j, value)| **value != 0.0 && !inside.contains(j)) {
            for (i, slot) in right[..=j].iter_mut().enumerate() {
                *slot -= value * self.qr.r(i, j);
            }
        }
        qr.transposed_times(right);
        solution.resize(inside.len(), 0.0);
        qr.solve(right, solution);
    }

    /// Reduction of the undamped sum of squares by a step, ‖b‖² − ‖A d + b‖², summed without a difference of large numbers.
    pub(crate) fn reduction(&self, b: &[f64], step: &[f64]) -> f64 {
        let k = step.len();
        (0..k)
            .map(|i| {
                let moved: f64 = (i..k).map(|j| self.qr.r(i, j) * step[j]).sum();
                -moved * (2.0 * b[i] + moved)
            })
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::{Buffers, Damped, Qr};
    use crate::fit::local::tall_qr::TallQr;
    use nalgebra::{DMatrix, DVector};

    const ROWS: usize = 7;
    const COLUMNS: usize = 3;
    /// A few dozen roundings of numbers around 1.
    const ROUNDING: f64 = 1e-13;

    /// Numbers without structure, in −0.4 … 0.6.
    fn numbers(ratio: f64) -> impl Iterator<Item = f64> {
        (1..).map(move |i: u32| (ratio * f64::from(i * i)).fract() - 0.4)
    }

    fn matrix() -> DMatrix<f64> {
        DMatrix::from_iterator(ROWS, COLUMNS, numbers(2.0_f64.sqrt()).take(ROWS * COLUMNS))
    }

    fn right() -> DVector<f64> {
        DVector::from_iterator(ROWS, numbers(3.0_f64.sqrt()).take(ROWS))
    }

    fn factorised(a: &DMatrix<f64>) -> Qr {
        let mut qr = Qr::default();
        qr.factorise(a.nrows(), a.ncols(), |buffer| buffer.copy_from_slice(a.as_slice()));
        qr
    }

    fn rotated(qr: &Qr, b: &DVector<f64>) -> Vec<f64> {
        let mut rotated = b.as_slice().to_vec();
        qr.transposed_times(&mut rotated);
        rotated
    }

    fn reduced(a: &DMatrix<f64>, b: &DVector<f64>) -> TallQr {
        let mut qr = TallQr::default();
        qr.reduce(a, &[0, 1, 2], b);
        qr
    }

    #[test]
    fn it_solves_least_squares_as_the_normal_equations_do() {
        let (a, b) = (matrix(), right());
        let qr = factorised(&a);
        let mut x = vec![0.0; COLUMNS];
        qr.solve(&rotated(&qr, &b), &mut x);
        let expected = (a.transpose() * &a).lu().solve(&(a.transpose() * &b)).unwrap();
        assert!((DVector::from_vec(x) - expected).amax() < ROUNDING);
    }

    #[test]
    fn an_unknown_without_a_column_stays_where_it_is() {
        let mut a = matrix();
        a.column_mut(1).fill(0.0);
        let qr = factorised(&a);
        let mut x = vec![1.0; COLUMNS];
        qr.solve(&rotated(&qr, &right()), &mut x);
        assert_eq!(x[1], 0.0);
        assert!(x.iter().all(|x| x.is_finite()));
    }

    #[test]
    fn a_damped_step_solves_the_damped_normal_equations() {
        let (a, b) = (matrix(), right());
        let (qr, scale, damping) = (reduced(&a, &b), [0.5, 1.0, 2.0], 0.3);
        let mut step = vec![0.0; COLUMNS];
        let free = [(f64::NEG_INFINITY, f64::INFINITY); COLUMNS];
        Damped { qr: &qr, scale: &scale, damping }.solve_within(qr.rotated(), &free, &mut step, &mut Buffers::default());
        let squares = DMatrix::from_diagonal(&DVector::from_iterator(COLUMNS, scale.iter().map(|s| damping * s * s)));
        let expected = (a.transpose() * &a + squares).lu().solve(&(a.transpose() * -b)).unwrap();
        assert!((DVector::from_vec(step) - expected).amax() < ROUNDING);
    }

    #[test]
    fn in_a_box_the_bounds_hold_and_the_other_unknowns_have_no_slope() {
        let (a, b) = (matrix(), right());
        let (qr, scale) = (reduced(&a, &b), [1.0; COLUMNS]);
        let damped = Damped { qr: &qr, scale: &scale, damping: 0.0 };
        let rotated = qr.rotated();
        let mut free = vec![0.0; COLUMNS];
        damped.solve_within(rotated, &[(f64::NEG_INFINITY, f64::INFINITY); COLUMNS], &mut free, &mut Buffers::default());
        // The unknown with the longest step is held at half of it.
        let held = (0..COLUMNS).max_by(|&i, &j| free[i].abs().total_cmp(&free[j].abs())).unwrap();
        let mut bounds = [(-10.0, 10.0); COLUMNS];
        bounds[held] = (-0.5 * free[held].abs(), 0.5 * free[held].abs());
        let mut step = vec![0.0; COLUMNS];
        damped.solve_within(rotated, &bounds, &mut step, &mut Buffers::default());
        assert_eq!(step[held], 0.5 * free[held]);
        let residuals = &a * DVector::from_column_slice(&step) + &b;
        let slope = a.transpose() * &residuals;
        for j in (0..COLUMNS).filter(|&j| j != held) {
            assert!(slope[j].abs() < ROUNDING, "{j}: {}", slope[j]);
        }
        let fall = b.norm_squared() - residuals.norm_squared();
        assert!((damped.reduction(rotated, &step) - fall).abs() < ROUNDING && fall > 0.0);
    }
}

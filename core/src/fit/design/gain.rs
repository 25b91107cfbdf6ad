//! What the next reading would gain at each candidate, beside what is measured already.

use crate::fit::design::choice::{AngleChoice, AngleChoiceError, DesignCriterion};
use crate::fit::design::discrimination::Discrimination;
use crate::fit::design::information::{Information, Reading};
use crate::fit::observer::Observer;
use crate::model::Parameter;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Information that is there before any reading, as a share of that of all candidates together: with it the first readings, which alone
/// determine nothing, have a gain too.
const BEFORE: f64 = 1e-9;

/// What one more reading at each candidate would gain, in the order of the grid: for the determinant the rise of ln det of the information,
/// for variances the fall of the logarithm of their sum, for telling models apart the square of the difference in units of the noise. The
/// count of the choice plays no part; of several surfaces it is the mean.
///
/// # Errors
///
/// [`AngleChoiceError`] where nothing is asked for, the surface is none, or it was cancelled.
pub fn next_gains(choice: &AngleChoice, observer: Observer<'_>) -> Result<Vec<f64>, AngleChoiceError> {
    if choice.surfaces.is_empty() || choice.noise.quantities() == 0 || choice.grid.is_empty() {
        return Err(AngleChoiceError::Nothing);
    }
    let surfaces = choice.every(1)?;
    if let Some(discrimination) = Discrimination::of(choice, &surfaces)? {
        return discrimination.next_squares(observer);
    }
    choice.check_asked()?;
    let free: Vec<Parameter> = choice.free.iter().collect();
    let mut sum = vec![0.0; choice.grid.len()];
    for surface in &surfaces {
        let reading = Reading { surface, free: &free, noise: choice.noise };
        let gains = gains_of(choice, &reading, observer)?;
        sum.iter_mut().zip(gains).for_each(|(sum, gain)| *sum += gain);
    }
    #[expect(clippy::cast_precision_loss, reason = "a number of surfaces")]
    let count = surfaces.len() as f64;
    Ok(sum.into_iter().map(|sum| sum / count).collect())
}

/// On one surface.
fn gains_of(choice: &AngleChoice, reading: &Reading<'_>, observer: Observer<'_>) -> Result<Vec<f64>, AngleChoiceError> {
    let information = Information::new(reading, &choice.grid, &choice.given, &|_| !(observer.cancelled)())?;
    let information = information.ok_or(AngleChoiceError::Cancelled)?;
    let rank = information.rank();
    let asked: &[Parameter] = if let DesignCriterion::Variances(asked) = &choice.criterion { asked } else { &[] };
    let contrasts: Vec<DVector<f64>> = asked.iter().filter_map(|&parameter| information.contrast(reading, parameter)).collect();
    let before = &information.given + DMatrix::identity(rank, rank) * BEFORE;
    let cholesky = Cholesky::new(before).ok_or(AngleChoiceError::Nothing)?;
    let candidates: Vec<usize> = (0..choice.grid.len()).collect();
    let rows = information.rows(reading, &choice.grid, &candidates)?;
    let rows_each = reading.rows_each();
    let variance: f64 = contrasts.iter().map(|contrast| contrast.dot(&cholesky.solve(contrast))).sum();
    let gains = rows.chunks((rank * rows_each).max(1)).map(|rows| gain(&cholesky, &contrasts, variance, rows, rows_each));
    Ok(gains.collect())
}

/// Of one candidate with its rows R: `ln det(1 + R M⁻¹ Rᵀ)`, or the fall of the logarithm of the variance Σ cᵀM⁻¹c by Woodbury's formula.
fn gain(cholesky: &Cholesky<f64, Dyn>, contrasts: &[DVector<f64>], variance: f64, rows: &[f64], rows_each: usize) -> f64 {
    let rank = rows.len() / rows_each.max(1);
    let rows = DMatrix::from_row_slice(rows_each, rank, rows);
    let solved = cholesky.solve(&rows.transpose());
    let inner = DMatrix::identity(rows_each, rows_each) + &rows * &solved;
    if contrasts.is_empty() {
        return libm::log(inner.determinant());
    }
    let Some(inverse) = inner.try_inverse() else { return 0.0 };
    let fall_of = |contrast: &DVector<f64>| {
        let through = solved.transpose() * contrast;
        through.dot(&(&inverse * &through))
    };
    let fall: f64 = contrasts.iter().map(fall_of).sum();
    -libm::log1p(-(fall / variance).min(1.0 - f64::EPSILON))
}

//! Stage 5 of a foreign table: the cells of a row to values.

use super::dialect::{Decimal, Dialect};
use super::grid::CellGrid;
use super::number::{ReadCell, has_fortran_exponent};
use super::plan::{Group, Plan};
use super::vocabulary::Measure;
use crate::measurement::field::hundredth;
use crate::measurement::{ColumnPlace, Expected, Field, Polarimeter, Quantity, ReadError, ReadErrorKind, Unit, quote};
use crate::optics::Degrees;

/// A row as the file has it, before its angles are put in this program's convention.
#[derive(Debug, Clone)]
pub(crate) struct RawRow {
    pub(crate) line: u64,
    pub(crate) theta_i: f64,
    /// Degrees; negative on the backscatter side, or from 0 to 360.
    pub(crate) theta_r: f64,
    pub(crate) dphi: f64,
    pub(crate) dolp: Option<Quantity>,
    pub(crate) brdf: Option<Quantity>,
    pub(crate) masked: bool,
    /// Whether a value is missing that the row has a cell for.
    pub(crate) lacks_value: bool,
    pub(crate) is_above_one: bool,
    pub(crate) has_zero_sigma: bool,
    pub(crate) wavelength_nm: Option<f64>,
    /// Index of the name of its measurement.
    pub(crate) set: u32,
}

/// Angles and labels that all values of a row share.
#[derive(Debug, Clone, Copy, Default)]
struct Shared {
    theta_i: Option<f64>,
    theta_r: Option<f64>,
    dphi: f64,
    wavelength_nm: Option<f64>,
    masked: bool,
}

/// Where the fields of a section stand.
struct Places {
    theta_i: Option<usize>,
    theta_r: Option<usize>,
    dphi: Option<usize>,
    phi_i: Option<usize>,
    phi_r: Option<usize>,
    wavelength: Option<usize>,
    masked: Option<usize>,
    set: Option<usize>,
}

/// Reads the rows of a section.
pub(crate) struct ForeignRowReader<'a> {
    grid: &'a CellGrid,
    dialect: Dialect,
    plan: &'a Plan,
    places: Places,
    is_normalised: bool,
    fills_down: bool,
    /// The angles of the row before, for cells that were merged.
    before: Shared,
    /// The first cell with a decimal mark, and its line.
    marked: Option<(u64, String)>,
}

/// Values of a wide table that are all 0 in one row: the detector was in the way of the light.
const SHADED_FROM: usize = 3;

/// The column of the first value of a place.
fn first_column(group: &Group) -> usize {
    let of_polarimeter = group.polarimeter.as_ref().and_then(|(_, channels)| channels.first());
    [group.dolp.as_ref(), group.brdf.as_ref(), of_polarimeter].into_iter().flatten().next().map_or(0, |(column, _)| *column)
}

impl<'a> ForeignRowReader<'a> {
    pub(crate) fn new(grid: &'a CellGrid, plan: &'a Plan, is_normalised: bool, fills_down: bool) -> Self {
        let place = |field| plan.column(field);
        let places = Places {
            theta_i: place(Field::ThetaI),
            theta_r: place(Field::ThetaR),
            dphi: place(Field::Dphi),
            phi_i: place(Field::PhiI),
            phi_r: place(Field::PhiR),
            wavelength: place(Field::Wavelength),
            masked: place(Field::Masked),
            set: place(Field::Set),
        };
        Self { dialect: grid.dialect(), grid, plan, places, is_normalised, fills_down, before: Shared::default(), marked: None }
    }

    /// The text of the column `set`.
    pub(crate) fn set<'b>(&self, cells: &[&'b str]) -> Option<&'b str> {
        self.places.set.and_then(|column| cells.get(column).copied()).filter(|name| !name.is_empty())
    }

    /// The values of a row: one for each place of a wide table.
    ///
    /// # Errors
    /// A cell is no number, or a number outside its range; a heading states an angle of incidence of 90°
    /// or more.
    pub(crate) fn read(&mut self, row: usize, cells: &[&str], set: u32, rows: &mut Vec<RawRow>) -> Result<(), ReadError> {
        let line = self.grid.line(row);
        let shared = self.shared(line, cells)?;
        let first = rows.len();
        for group in &self.plan.groups {
            let theta_i = group.theta_i.or(shared.theta_i).unwrap_or(0.0);
            if let Some(stated) = group.theta_i.filter(|stated| stated.abs() >= 90.0) {
                let kind = ReadErrorKind::OutOfRange { found: stated.to_string(), expected: Expected::ThetaI };
                return Err(self.error(line, first_column(group), kind));
            }
            let theta_r = group.theta_r.or(shared.theta_r).unwrap_or(theta_i);
            let mut raw = RawRow {
                line,
                theta_i,
                theta_r,
                dphi: shared.dphi,
                dolp: None,
                brdf: None,
                masked: shared.masked,
                lacks_value: false,
                is_above_one: false,
                has_zero_sigma: false,
                wavelength_nm: group.wavelength_nm.or(shared.wavelength_nm).or(self.plan.wavelength_nm),
                set,
            };
            self.fill(&mut raw, line, cells, group)?;
            rows.push(raw);
        }
        let new = &mut rows[first..];
        if new.len() >= SHADED_FROM && new.iter().all(|raw| raw.dolp.is_none() && raw.brdf.is_some_and(|brdf| brdf.value == 0.0)) {
            for raw in new {
                (raw.brdf, raw.lacks_value, raw.masked) = (None, true, true);
            }
        }
        Ok(())
    }

    fn shared(&mut self, line: u64, cells: &[&str]) -> Result<Shared, ReadError> {
        let (places, plan) = (&self.places, self.plan);
        let (theta_i_at, theta_r_at) = (places.theta_i, places.theta_r);
        let (dphi_at, phi_i, phi_r, wavelength, masked) = (places.dphi, places.phi_i, places.phi_r, places.wavelength, places.masked);
        let theta_i = match theta_i_at {
            Some(column) => Some(self.angle(line, cells, column, Expected::ThetaI, self.before.theta_i)?),
            None => plan.theta_i,
        };
        let theta_r = match theta_r_at {
            Some(column) => Some(self.angle(line, cells, column, Expected::ThetaR, self.before.theta_r)?),
            None => None,
        };
        let dphi = match (dphi_at, phi_i, phi_r) {
            (Some(column), ..) => self.angle(line, cells, column, Expected::Dphi, None)?,
            (None, Some(phi_i), Some(phi_r)) => {
                self.angle(line, cells, phi_r, Expected::Dphi, None)? - self.angle(line, cells, phi_i, Expected::Dphi, None)?
            }
            _ => plan.dphi.unwrap_or(180.0),
        };
        let wavelength_nm = match wavelength {
            Some(column) => {
                self.number(line, cells, column, Expected::Wavelength)?.or(self.before.wavelength_nm.filter(|_| self.fills_down))
            }
            None => None,
        };
        let masked = match masked {
            Some(column) => self.mask(line, cells, column)?,
            None => false,
        };
        let shared = Shared { theta_i, theta_r, dphi, wavelength_nm, masked };
        self.before = shared;
        Ok(shared)
    }

    fn angle(&mut self, line: u64, cells: &[&str], column: usize, expected: Expected, before: Option<f64>) -> Result<f64, ReadError> {
        let angle = self.number(line, cells, column, expected)?.or(before.filter(|_| self.fills_down));
        let degrees = angle.ok_or_else(|| self.error(line, column, ReadErrorKind::EmptyCell { expected }))?;
        let is_allowed = expected != Expected::ThetaI || degrees.abs() < 90.0;
        if is_allowed { Ok(degrees) } else { Err(self.out_of_range(line, cells, column, expected)) }
    }

    fn mask(&self, line: u64, cells: &[&str], column: usize) -> Result<bool, ReadError> {
        match cells.get(column).map_or(ReadCell::Missing, |cell| ReadCell::new(cell, self.dialect)) {
            ReadCell::Missing => Ok(false),
            ReadCell::Number(number, _) if number == 0.0 || number == 1.0 => Ok(number == 1.0),
            ReadCell::Text(text) if ["true", "yes", "x", "ja", "是"].contains(&text.to_lowercase().as_str()) => Ok(true),
            ReadCell::Text(text) if ["false", "no", "nein", "否"].contains(&text.to_lowercase().as_str()) => Ok(false),
            _ => Err(self.out_of_range(line, cells, column, Expected::Mask)),
        }
    }

    /// The quantities of one place.
    fn fill(&mut self, raw: &mut RawRow, line: u64, cells: &[&str], group: &Group) -> Result<(), ReadError> {
        let is_beyond = raw.theta_r.abs() >= 90.0 && raw.theta_r.abs() <= 270.0;
        let is_free = raw.masked || is_beyond;
        if let Some((column, sigma)) = group.dolp {
            let expected = if self.plan.columns[column].unit == Unit::Percent { Expected::DolpPercent } else { Expected::Dolp };
            let dolp = self.quantity(line, cells, (column, sigma), expected, raw)?;
            let is_allowed = dolp.is_none_or(|dolp| (0.0..=1.0).contains(&dolp.value));
            if !is_allowed && !is_free {
                return Err(self.out_of_range(line, cells, column, expected));
            }
            raw.dolp = dolp.filter(|_| is_allowed);
            raw.lacks_value |= raw.dolp.is_none();
        }
        if let Some((column, sigma)) = group.brdf {
            let brdf = self.quantity(line, cells, (column, sigma), Expected::Brdf, raw)?;
            let is_allowed = brdf.is_none_or(|brdf| brdf.value >= 0.0);
            if !is_allowed && !is_free {
                return Err(self.out_of_range(line, cells, column, Expected::Brdf));
            }
            let divisor = self.plan.brdf_is.divisor(Degrees(raw.theta_r).cos());
            let divided = |brdf: Quantity| Quantity { value: brdf.value / divisor, sigma: brdf.sigma.map(|sigma| sigma / divisor) };
            raw.brdf = brdf.filter(|_| is_allowed && divisor > 0.0).map(divided);
            // Beside a DoLP an empty cell needs no notice.
            raw.lacks_value |= raw.brdf.is_none() && (raw.dolp.is_none() || !cells.get(column).copied().unwrap_or_default().is_empty());
        }
        if let Some((polarimeter, channels)) = &group.polarimeter {
            let dolp = self.polarimeter(line, cells, *polarimeter, channels, raw)?;
            raw.is_above_one = dolp.is_some_and(|dolp| dolp.value > 1.0);
            raw.dolp = dolp.filter(|dolp| dolp.value <= 1.0);
            raw.lacks_value |= dolp.is_none();
        }
        raw.masked |= raw.dolp.is_none() && raw.brdf.is_none();
        Ok(())
    }

    fn polarimeter(
        &mut self,
        line: u64,
        cells: &[&str],
        polarimeter: Polarimeter,
        channels: &[(usize, Option<usize>)],
        raw: &mut RawRow,
    ) -> Result<Option<Quantity>, ReadError> {
        let expected = if polarimeter == Polarimeter::Psi { Expected::Psi } else { Expected::FiniteNumber };
        let mut values: Vec<Quantity> = Vec::with_capacity(channels.len());
        for &channel in channels {
            let Some(mut value) = self.quantity(line, cells, channel, expected, raw)? else { return Ok(None) };
            if polarimeter == Polarimeter::Psi && !(0.0..=90.0).contains(&value.value) {
                return Err(self.out_of_range(line, cells, channel.0, expected));
            }
            if let Some(first) = values.first().filter(|_| self.is_normalised) {
                value = Quantity { value: value.value * first.value, sigma: value.sigma.map(|sigma| sigma * first.value.abs()) };
            }
            values.push(value);
        }
        if self.is_normalised
            && let Some(first) = values.first_mut()
        {
            // The share of the first channel cancels.
            first.sigma = first.sigma.map(|_| 0.0);
        }
        Ok(polarimeter.dolp(&values))
    }

    /// A value and its standard deviation, in the native unit.
    fn quantity(
        &mut self,
        line: u64,
        cells: &[&str],
        (column, sigma): (usize, Option<usize>),
        expected: Expected,
        raw: &mut RawRow,
    ) -> Result<Option<Quantity>, ReadError> {
        let Some(value) = self.number(line, cells, column, expected)? else { return Ok(None) };
        let sigma = match sigma {
            Some(column) => match self.number(line, cells, column, Expected::Sigma)? {
                Some(sigma) if sigma < 0.0 && !raw.masked => return Err(self.out_of_range(line, cells, column, Expected::Sigma)),
                Some(sigma) => {
                    raw.has_zero_sigma |= sigma == 0.0;
                    Some(sigma).filter(|sigma| *sigma > 0.0)
                }
                None => None,
            },
            None => None,
        };
        Ok(Some(Quantity { value, sigma }))
    }

    /// A cell as a number in the native unit of its column; none where nothing was measured.
    fn number(&mut self, line: u64, cells: &[&str], column: usize, expected: Expected) -> Result<Option<f64>, ReadError> {
        let Some(&cell) = cells.get(column) else { return Ok(None) };
        match ReadCell::new(cell, self.dialect) {
            ReadCell::Missing => Ok(None),
            ReadCell::Number(number, unit) => {
                if self.marked.is_none() && cell.contains(if self.dialect.decimal == Decimal::Comma { ',' } else { '.' }) {
                    self.marked = Some((line, cell.to_owned()));
                }
                let by_column = match self.plan.columns[column].unit {
                    Unit::Native => None,
                    Unit::Radians => Some(Measure::Radians),
                    Unit::Percent => Some(Measure::Percent),
                    Unit::Micrometers => Some(Measure::Micrometers),
                    Unit::Angstroms => Some(Measure::Angstroms),
                };
                Ok(Some(match unit.filter(|unit| *unit != Measure::Other).or(by_column) {
                    Some(Measure::Radians) => number.to_degrees(),
                    Some(Measure::Percent) => hundredth(number),
                    Some(Measure::Micrometers) => number * 1000.0,
                    Some(Measure::Angstroms) => number * 0.1,
                    _ => number,
                }))
            }
            ReadCell::Text(_) => Err(self.error(line, column, self.fault(cell, expected))),
        }
    }

    /// Why a cell is no number.
    fn fault(&self, cell: &str, expected: Expected) -> ReadErrorKind {
        let found = quote(cell);
        let other = if self.dialect.decimal == Decimal::Comma { Decimal::Point } else { Decimal::Comma };
        let is_other = ReadCell::new(cell, Dialect { decimal: other, ..self.dialect }).is_number();
        match &self.marked {
            _ if has_fortran_exponent(cell) => ReadErrorKind::FortranExponent { found },
            Some((other_line, other)) if is_other => {
                ReadErrorKind::TwoDecimalMarks { found, other: other.clone(), other_line: *other_line }
            }
            _ => ReadErrorKind::NotANumber { found, expected },
        }
    }

    fn error(&self, line: u64, column: usize, kind: ReadErrorKind) -> ReadError {
        let name = quote(&self.plan.columns[column].name);
        let name = if name == (column + 1).to_string() { String::new() } else { name };
        ReadError { line: Some(line), column: Some(ColumnPlace { number: column + 1, name }), kind }
    }

    fn out_of_range(&self, line: u64, cells: &[&str], column: usize, expected: Expected) -> ReadError {
        let found = quote(cells.get(column).copied().unwrap_or_default());
        self.error(line, column, ReadErrorKind::OutOfRange { found, expected })
    }
}

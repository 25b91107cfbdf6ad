//! Reads a measurement from a table.
//!
//! | column | meaning |
//! |---|---|
//! | `theta_i` | degrees, 0 ≤ θi < 90 |
//! | `theta_r` | degrees, −90 < θr < 90; negative is the backscatter side (θr := abs θr, Δφ := 0), only where `dphi` is absent or 180 |
//! | `dphi` | degrees, any finite value; 180 where there is no such column |
//! | `dolp`, `dolp_sigma` | 0…1 (or `dolp_percent`, 0…100); standard deviation > 0 |
//! | `brdf`, `brdf_sigma` | sr⁻¹, ≥ 0; standard deviation > 0 |
//! | `masked` | 0 or 1 |
//!
//! Nothing is guessed and no row is dropped: what does not fit is an error that names its place.

use crate::measurement::mapping::{Field, Mapping, Unit};
use crate::measurement::table::{Progress, ReadError, ReadErrorKind, Record, Table};
use crate::measurement::{Measurement, Quantity, Row};
use crate::optics::Geometry;
use std::io::Read;

/// Which column holds what.
struct Layout {
    theta_i: Angle,
    theta_r: Angle,
    dphi: Option<Angle>,
    dolp: Option<Source>,
    brdf: Option<Source>,
    masked: Option<usize>,
}

/// Where an angle stands, and in what.
#[derive(Clone, Copy)]
enum Angle {
    Column {
        column: usize,
        is_radians: bool,
    },
    /// The same in every row, in degrees.
    Constant(f64),
}

/// Where a quantity and its standard deviation stand, and what is allowed there.
struct Source {
    value: usize,
    sigma: Option<usize>,
    /// One over the unit of the value column: 100 for percent.
    per_unit: f64,
    /// The same of the standard deviation.
    sigma_per_unit: f64,
    maximum: f64,
    expected: &'static str,
}

const DOLP: &str = "a DoLP from 0 to 1";
const DOLP_PERCENT: &str = "a DoLP from 0 to 100 percent";
const BRDF: &str = "a BRDF of 0 sr⁻¹ or more";
const SIGMA: &str = "a standard deviation above 0";
const THETA_I: &str = "an angle of incidence, 0 ≤ θi < 90 degrees";
const THETA_R: &str = "an angle of view, −90 < θr < 90 degrees";
const DPHI: &str = "a finite angle in degrees";
const MASKED: &str = "0 or 1";
const KNOWN: [&str; 9] = ["theta_i", "theta_r", "dphi", "dolp", "dolp_percent", "dolp_sigma", "brdf", "brdf_sigma", "masked"];

/// Reads a measurement; `progress` is told how far it is and may stop it.
pub fn read(source: impl Read, progress: Progress<'_>) -> Result<Measurement, ReadError> {
    let table = Table::new(source)?;
    let layout = Layout::new(&table)?;
    let ignored_columns = table.header().iter().filter(|name| !KNOWN.contains(&name.as_str())).cloned().collect();
    read_rows(&table, &layout, ignored_columns, progress)
}

/// Reads a foreign table whose columns were said to be so; the others are ignored and named. It may be without a header.
pub fn read_mapped(source: impl Read, mapping: &Mapping, progress: Progress<'_>) -> Result<Measurement, ReadError> {
    let table = Table::foreign(source)?;
    let layout = Layout::mapped(&table, mapping)?;
    let mut used = Vec::new();
    for field in Field::ALL {
        used.extend(mapping.place(field, &table)?.map(|(index, _)| index));
    }
    let others = (0..table.header().len()).filter(|index| !used.contains(index));
    let ignored_columns = others.map(|index| table.title(index)).collect();
    read_rows(&table, &layout, ignored_columns, progress)
}

fn read_rows(table: &Table, layout: &Layout, ignored_columns: Vec<String>, progress: Progress<'_>) -> Result<Measurement, ReadError> {
    let (mut rows, mut lines) = (Vec::new(), Vec::new());
    table.for_each(progress, |record| {
        rows.push(layout.row(record)?);
        lines.push(record.line());
        Ok(())
    })?;
    Ok(Measurement { metadata: table.metadata().to_vec(), rows, lines, ignored_columns })
}

impl Layout {
    fn new(table: &Table) -> Result<Self, ReadError> {
        let no_quantity = || table.header_error(ReadErrorKind::NoQuantity { names: table.titles() });
        let guess = Mapping::guess(table.header(), &[]);
        if guess.find(Field::ThetaR).is_some() && !guess.has_quantity() {
            // Whatever the angles are called, this is what is missing.
            return Err(no_quantity());
        }
        let (theta_i, theta_r) = (table.require("theta_i")?, table.require("theta_r")?);
        let (fraction, percent) = (table.find("dolp")?, table.find("dolp_percent")?);
        if let (Some(a), Some(b)) = (fraction, percent) {
            return Err(table.repeated(a.min(b), a.max(b)));
        }
        let (dolp_sigma, brdf_sigma) = (table.find("dolp_sigma")?, table.find("brdf_sigma")?);
        let dolp = fraction
            .map(|value| Source { value, sigma: dolp_sigma, per_unit: 1.0, sigma_per_unit: 1.0, maximum: 1.0, expected: DOLP })
            .or(percent.map(|value| Source {
                value,
                sigma: dolp_sigma,
                per_unit: 100.0,
                sigma_per_unit: 1.0,
                maximum: 100.0,
                expected: DOLP_PERCENT,
            }));
        let brdf = table.find("brdf")?.map(|value| Source {
            value,
            sigma: brdf_sigma,
            per_unit: 1.0,
            sigma_per_unit: 1.0,
            maximum: f64::MAX,
            expected: BRDF,
        });
        if dolp.is_none() && brdf.is_none() {
            return Err(no_quantity());
        }
        let degrees = |column| Angle::Column { column, is_radians: false };
        let (theta_i, theta_r) = (degrees(theta_i), degrees(theta_r));
        Ok(Self { theta_i, theta_r, dphi: table.find("dphi")?.map(degrees), dolp, brdf, masked: table.find("masked")? })
    }

    fn mapped(table: &Table, mapping: &Mapping) -> Result<Self, ReadError> {
        let angle = |field| -> Result<Option<Angle>, ReadError> {
            let place = mapping.place(field, table)?;
            let column = place.map(|(column, unit)| Angle::Column { column, is_radians: unit == Unit::Radians });
            Ok(column.or(mapping.constant(field).map(Angle::Constant)))
        };
        let require = |field: Field| angle(field)?.ok_or_else(|| table.header_error(ReadErrorKind::NotMapped { field: field.key() }));
        let source = |field, sigma_field| -> Result<Option<Source>, ReadError> {
            let (value, sigma) = (mapping.place(field, table)?, mapping.place(sigma_field, table)?);
            let per_unit = |unit| if unit == Unit::Percent { 100.0 } else { 1.0 };
            Ok(value.map(|(value, unit)| {
                let (maximum, expected) = match (field, unit) {
                    (Field::Brdf, _) => (f64::MAX, BRDF),
                    (_, Unit::Percent) => (100.0, DOLP_PERCENT),
                    _ => (1.0, DOLP),
                };
                let sigma_per_unit = sigma.map_or(1.0, |(_, unit)| per_unit(unit));
                Source { value, sigma: sigma.map(|(column, _)| column), per_unit: per_unit(unit), sigma_per_unit, maximum, expected }
            }))
        };
        let (dolp, brdf) = (source(Field::Dolp, Field::DolpSigma)?, source(Field::Brdf, Field::BrdfSigma)?);
        if dolp.is_none() && brdf.is_none() {
            return Err(table.header_error(ReadErrorKind::NotMapped { field: "dolp or brdf" }));
        }
        let masked = mapping.place(Field::Masked, table)?.map(|(column, _)| column);
        Ok(Self { theta_i: require(Field::ThetaI)?, theta_r: require(Field::ThetaR)?, dphi: angle(Field::Dphi)?, dolp, brdf, masked })
    }

    fn row(&self, record: &Record<'_>) -> Result<Row, ReadError> {
        let geometry = self.geometry(record)?;
        let dolp = self.dolp.as_ref().map(|source| source.quantity(record)).transpose()?.flatten();
        let brdf = self.brdf.as_ref().map(|source| source.quantity(record)).transpose()?.flatten();
        if dolp.is_none() && brdf.is_none() {
            return Err(record.row_error(ReadErrorKind::NoData));
        }
        let masked = match self.masked {
            Some(column) => match record.optional(column, MASKED)? {
                None | Some(0.0) => false,
                Some(1.0) => true,
                Some(_) => return Err(record.out_of_range(column, MASKED)),
            },
            None => false,
        };
        Ok(Row { geometry, dolp, brdf, masked })
    }

    fn geometry(&self, record: &Record<'_>) -> Result<Geometry, ReadError> {
        let theta_i = self.theta_i.degrees(record, THETA_I)?;
        if !(0.0..90.0).contains(&theta_i) {
            return Err(self.theta_i.out_of_range(record, THETA_I));
        }
        let theta_r = self.theta_r.degrees(record, THETA_R)?;
        if theta_r.abs() >= 90.0 {
            return Err(self.theta_r.out_of_range(record, THETA_R));
        }
        let dphi = self.dphi.map_or(Ok(180.0), |angle| angle.degrees(record, DPHI))?;
        if theta_r < 0.0 && dphi != 180.0 {
            return Err(self.theta_r.error(record, |found| ReadErrorKind::NegativeThetaR { found, dphi }));
        }
        let geometry = if theta_r < 0.0 { Geometry::in_plane(theta_i, theta_r) } else { Geometry::new(theta_i, theta_r, dphi) };
        geometry.map_err(|_| self.theta_r.out_of_range(record, THETA_R))
    }
}

impl Angle {
    fn degrees(self, record: &Record<'_>, expected: &'static str) -> Result<f64, ReadError> {
        let degrees = match self {
            Self::Column { column, is_radians: true } => record.number(column, expected)?.to_degrees(),
            Self::Column { column, is_radians: false } => record.number(column, expected)?,
            Self::Constant(degrees) => degrees,
        };
        if degrees.is_finite() { Ok(degrees) } else { Err(self.out_of_range(record, expected)) }
    }

    /// An error at its cell; of a constant, at no place of the file.
    fn error(self, record: &Record<'_>, kind: impl FnOnce(String) -> ReadErrorKind) -> ReadError {
        match self {
            Self::Column { column, .. } => record.error(column, kind(record.text(column))),
            Self::Constant(degrees) => kind(degrees.to_string()).anywhere(),
        }
    }

    fn out_of_range(self, record: &Record<'_>, expected: &str) -> ReadError {
        self.error(record, |found| ReadErrorKind::OutOfRange { found, expected: expected.to_owned() })
    }
}

impl Source {
    fn quantity(&self, record: &Record<'_>) -> Result<Option<Quantity>, ReadError> {
        let value = record.optional(self.value, self.expected)?;
        if value.is_some_and(|value| !(0.0..=self.maximum).contains(&value)) {
            return Err(record.out_of_range(self.value, self.expected));
        }
        let mut sigma = None;
        if let Some(column) = self.sigma {
            sigma = record.optional(column, SIGMA)?;
            if sigma.is_some_and(|sigma| sigma <= 0.0) {
                return Err(record.out_of_range(column, SIGMA));
            }
            if value.is_none() && sigma.is_some() {
                return Err(record.error(column, ReadErrorKind::SigmaWithoutValue));
            }
        }
        Ok(value.map(|value| Quantity {
            value: value / self.per_unit,
            sigma: sigma.map(|sigma| sigma / self.sigma_per_unit).filter(|&sigma| sigma > 0.0),
        }))
    }
}

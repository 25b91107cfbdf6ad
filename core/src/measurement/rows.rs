//! Turns the records of a table into rows of a measurement.

use crate::measurement::field::hundredth;
use crate::measurement::foreign::field_of;
use crate::measurement::note::{ImportNote, LineList};
use crate::measurement::{
    BeyondHorizon, Expected, Field, Measurement, Progress, Quantity, ReadError, ReadErrorKind, Record, Row, Table, Unit,
};
use crate::optics::Geometry;
use std::collections::HashMap;

/// Which column holds what.
pub(crate) struct RowReader {
    theta_i: usize,
    theta_r: usize,
    dphi: Option<usize>,
    dolp: Option<QuantitySource>,
    brdf: Option<QuantitySource>,
    masked: Option<usize>,
    set: Option<usize>,
    wavelength_nm: Option<usize>,
}

/// A row as it is read, at any angle of view.
struct RawRow {
    theta_i: f64,
    /// Negative on the backscatter side.
    theta_r: f64,
    dphi: f64,
    dolp: Option<Quantity>,
    brdf: Option<Quantity>,
    masked: bool,
    /// Whether a word stands for a value, no value is there, or an impossible one is masked.
    lacks_value: bool,
}

/// Where a quantity and its standard deviation stand, and which values are allowed there.
struct QuantitySource {
    value: usize,
    sigma: Option<usize>,
    /// One over the unit of the value column: 100 for percent.
    per_unit: f64,
    /// One over the unit of the column of the standard deviation.
    sigma_per_unit: f64,
    maximum: f64,
    expected: Expected,
}

impl RowReader {
    /// The reader of this project's own columns.
    pub(crate) fn native(table: &Table) -> Result<Self, ReadError> {
        let no_quantity = || table.header_error(ReadErrorKind::NoQuantity { names: table.header().to_vec() });
        let fields: Vec<Field> = table.header().iter().filter_map(|name| field_of(name)).collect();
        if fields.contains(&Field::ThetaR) && !fields.iter().any(|field| field.is_measured()) {
            // Whatever the names of the angles, the quantity is what the table lacks.
            return Err(no_quantity());
        }
        let (theta_i, theta_r) = (table.require("theta_i")?, table.require("theta_r")?);
        let (fraction, percent) = (table.find("dolp")?, table.find("dolp_percent")?);
        if let (Some(a), Some(b)) = (fraction, percent) {
            return Err(table.repeated(a.min(b), a.max(b)));
        }
        let (dolp_sigma, brdf_sigma) = (table.find("dolp_sigma")?, table.find("brdf_sigma")?);
        let with_sigma = |sigma: Option<usize>| sigma.map(|column| (column, Unit::Native));
        let dolp = fraction.map(|column| (column, Unit::Native)).or(percent.map(|column| (column, Unit::Percent)));
        let dolp = dolp.map(|value| QuantitySource::new(Field::Dolp, value, with_sigma(dolp_sigma)));
        let brdf = table.find("brdf")?.map(|column| QuantitySource::new(Field::Brdf, (column, Unit::Native), with_sigma(brdf_sigma)));
        if dolp.is_none() && brdf.is_none() {
            return Err(no_quantity());
        }
        Ok(Self {
            theta_i,
            theta_r,
            dphi: table.find("dphi")?,
            dolp,
            brdf,
            masked: table.find("masked")?,
            set: table.find("set")?,
            wavelength_nm: table.find("wavelength_nm")?,
        })
    }

    /// All rows of the table as one measurement, or with `split` one for each value of the columns
    /// `set` and `wavelength_nm`, in the order of the file.
    pub(crate) fn read(
        &self,
        table: &Table,
        ignored_columns: &[String],
        split: bool,
        progress: Progress<'_>,
    ) -> Result<Vec<Measurement>, ReadError> {
        let empty =
            Measurement { metadata: table.metadata().to_vec(), ignored_columns: ignored_columns.to_vec(), ..Measurement::default() };
        let mut found = vec![empty.clone()];
        let mut places: HashMap<(String, String), usize> = HashMap::new();
        let (mut without_value, mut beyond, mut has_value) = (LineList::default(), LineList::default(), false);
        let blank = table.for_each(progress, |record| {
            let row = self.row(record)?;
            let place = if split { self.place(record, &mut places)? } else { 0 };
            if place == found.len() {
                found.push(empty.clone());
            }
            has_value |= row.dolp.is_some() || row.brdf.is_some();
            if row.lacks_value {
                without_value.push(record.line());
            }
            if row.theta_r.abs() >= 90.0 {
                beyond.push(record.line());
            }
            row.add_to(&mut found[place], record.line());
            Ok(())
        })?;
        if !has_value {
            return Err(table.header_error(ReadErrorKind::NoData));
        }
        for ((set, wavelength), place) in places {
            let measurement = &mut found[place];
            if self.wavelength_nm.is_some() {
                measurement.metadata.retain(|(key, _)| key != "wavelength_nm");
            }
            if !wavelength.is_empty() {
                measurement.metadata.push(("wavelength_nm".to_owned(), wavelength));
            }
            measurement.name = set;
        }
        let notes = [ImportNote::NotMeasured(without_value), ImportNote::BeyondHorizon(beyond), ImportNote::BlankRows(blank)];
        found[0].notes.extend(notes.into_iter().filter(|note| note.lines().is_some_and(|lines| lines.count > 0)));
        Ok(found)
    }

    /// Index of the measurement of a row; the number of measurements for a new one.
    fn place(&self, record: &Record<'_>, places: &mut HashMap<(String, String), usize>) -> Result<usize, ReadError> {
        let set = self.set.map_or_else(String::new, |column| record.text(column));
        let mut wavelength = String::new();
        if let Some(column) = self.wavelength_nm
            && let Some(nm) = record.optional(column, Expected::Wavelength)?
        {
            if nm <= 0.0 {
                return Err(record.out_of_range(column, Expected::Wavelength));
            }
            wavelength = nm.to_string();
        }
        let next = places.len();
        Ok(*places.entry((set, wavelength)).or_insert(next))
    }

    fn row(&self, record: &Record<'_>) -> Result<RawRow, ReadError> {
        let masked = match self.masked {
            Some(column) => match record.optional(column, Expected::Mask)? {
                None | Some(0.0) => false,
                Some(1.0) => true,
                Some(_) => return Err(record.out_of_range(column, Expected::Mask)),
            },
            None => false,
        };
        let (theta_i, theta_r, dphi) = self.angles(record, masked)?;
        let mut lacks_value = false;
        let mut quantity = |source: &Option<QuantitySource>| -> Result<Option<Quantity>, ReadError> {
            let Some(source) = source else { return Ok(None) };
            let quantity = source.quantity(record, masked)?;
            // An empty cell beside a value needs no notice.
            lacks_value |= quantity.is_none() && !record.is_empty(source.value);
            Ok(quantity)
        };
        let (dolp, brdf) = (quantity(&self.dolp)?, quantity(&self.brdf)?);
        let is_empty = dolp.is_none() && brdf.is_none();
        Ok(RawRow { theta_i, theta_r, dphi, dolp, brdf, masked: masked || is_empty, lacks_value: lacks_value || is_empty })
    }

    /// θi, signed θr and Δφ in degrees, with |θr| from 90° on in a masked row.
    fn angles(&self, record: &Record<'_>, masked: bool) -> Result<(f64, f64, f64), ReadError> {
        let theta_i = record.number(self.theta_i, Expected::ThetaI)?;
        if !(0.0..90.0).contains(&theta_i) {
            return Err(record.out_of_range(self.theta_i, Expected::ThetaI));
        }
        let theta_r = record.number(self.theta_r, Expected::ThetaR)?;
        if theta_r.abs() >= 90.0 && !masked {
            return Err(record.out_of_range(self.theta_r, Expected::ThetaR));
        }
        let dphi = self.dphi.map_or(Ok(180.0), |column| record.number(column, Expected::Dphi))?;
        if theta_r < 0.0 && dphi != 180.0 {
            let found = record.text(self.theta_r);
            return Err(record.error(self.theta_r, ReadErrorKind::NegativeThetaR { found, dphi }));
        }
        Ok((theta_i, theta_r, dphi))
    }
}

impl RawRow {
    fn add_to(self, measurement: &mut Measurement, line: u64) {
        let Self { theta_i, theta_r, dphi, dolp, brdf, masked, .. } = self;
        let geometry = if theta_r < 0.0 { Geometry::in_plane(theta_i, theta_r) } else { Geometry::new(theta_i, theta_r, dphi) };
        match geometry {
            Ok(geometry) => {
                measurement.rows.push(Row { geometry, dolp, brdf, masked });
                measurement.lines.push(line);
            }
            // The angles were checked when they were read: θr alone is beyond.
            Err(_) => measurement.beyond_horizon.push(BeyondHorizon { theta_i, theta_r, dphi, dolp, brdf }),
        }
    }
}

impl QuantitySource {
    fn new(field: Field, (value, unit): (usize, Unit), sigma: Option<(usize, Unit)>) -> Self {
        let per_unit = |unit| if unit == Unit::Percent { 100.0 } else { 1.0 };
        let (maximum, expected) = match (field, unit) {
            (Field::Brdf, _) => (f64::MAX, Expected::Brdf),
            (_, Unit::Percent) => (100.0, Expected::DolpPercent),
            _ => (1.0, Expected::Dolp),
        };
        let sigma_per_unit = sigma.map_or(1.0, |(_, unit)| per_unit(unit));
        Self { value, sigma: sigma.map(|(column, _)| column), per_unit: per_unit(unit), sigma_per_unit, maximum, expected }
    }

    /// The quantity, if it was measured; in a masked row a value outside its range is none.
    fn quantity(&self, record: &Record<'_>, masked: bool) -> Result<Option<Quantity>, ReadError> {
        if record.is_not_measured(self.value) {
            return Ok(None);
        }
        let value = record.number(self.value, self.expected)?;
        if !(0.0..=self.maximum).contains(&value) {
            return if masked { Ok(None) } else { Err(record.out_of_range(self.value, self.expected)) };
        }
        let mut sigma = None;
        if let Some(column) = self.sigma.filter(|&column| !record.is_not_measured(column)) {
            sigma = record.optional(column, Expected::Sigma)?;
            if sigma.is_some_and(|sigma| sigma <= 0.0) {
                return Err(record.out_of_range(column, Expected::Sigma));
            }
        }
        let sigma = sigma.map(|sigma| if self.sigma_per_unit == 1.0 { sigma } else { hundredth(sigma) }).filter(|&sigma| sigma > 0.0);
        Ok(Some(Quantity { value: if self.per_unit == 1.0 { value } else { hundredth(value) }, sigma }))
    }
}

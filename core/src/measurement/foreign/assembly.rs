//! Stage 6 of a foreign table: raw rows to measurements in this program's conventions, with notices.

use super::options::TableOptions;
use super::plan::Plan;
use super::row_reader::RawRow;
use crate::measurement::formats::{ImportError, Imported};
use crate::measurement::{
    BeyondHorizon, BrdfMeaning, Channel, Expected, Field, ImportNote, LineList, Measurement, Polarimeter, ReadErrorKind, Row, Unit,
    choose_wavelength,
};
use crate::optics::Geometry;
use std::collections::HashMap;

/// Rows of all sections, and what was found on the way.
pub(crate) struct Assembly {
    pub(crate) rows: Vec<RawRow>,
    options: TableOptions,
    sets: Vec<String>,
    set_numbers: HashMap<String, u32>,
    titled: Vec<Option<String>>,
    notes: Vec<ImportNote>,
    polarimeter: Option<Polarimeter>,
    brdf_is: Option<BrdfMeaning>,
    has_dphi: bool,
}

/// DoLP below so many standard deviations is of the size of its error.
const BIASED_BELOW: f64 = 2.0;

impl Assembly {
    pub(crate) fn new(options: TableOptions, titled: Vec<Option<String>>) -> Self {
        let mut assembly = Self {
            rows: Vec::new(),
            options,
            sets: Vec::new(),
            set_numbers: HashMap::new(),
            titled,
            notes: Vec::new(),
            polarimeter: None,
            brdf_is: None,
            has_dphi: false,
        };
        assembly.set_named("");
        assembly
    }

    /// The number of the set of that name.
    pub(crate) fn set_named(&mut self, name: &str) -> u32 {
        if let Some(&number) = self.set_numbers.get(name) {
            return number;
        }
        let number = u32::try_from(self.sets.len()).unwrap_or(u32::MAX);
        self.sets.push(name.to_owned());
        self.set_numbers.insert(name.to_owned(), number);
        number
    }

    /// The number of the set that the title of a section names.
    pub(crate) fn titled_set(&mut self, section: usize) -> u32 {
        let name = self.titled.get(section).cloned().flatten().unwrap_or_default();
        self.set_named(&name)
    }

    /// Takes in what the columns of a section are.
    pub(crate) fn add_plan(&mut self, plan: &Plan) {
        let mut note = |note: ImportNote| {
            if !self.notes.contains(&note) {
                self.notes.push(note);
            }
        };
        for column in plan.columns.iter().filter(|column| column.unit == Unit::Percent && !column.states_unit) {
            if column.field == Some(Field::Dolp) {
                note(ImportNote::TakenAsPercent { name: column.name.clone() });
            }
        }
        if plan.is_normalised == Some(true) && !self.options.normalised && !plan.mueller.is_empty() {
            note(ImportNote::NormalisedElements);
        }
        self.polarimeter = self.polarimeter.or(plan.groups.iter().find_map(|group| group.polarimeter.as_ref().map(|(of, _)| *of)));
        if plan.groups.iter().any(|group| group.brdf.is_some()) {
            self.brdf_is = Some(plan.brdf_is);
        }
        self.has_dphi |= plan.dphi.is_some() || plan.column(Field::Dphi).is_some() || plan.column(Field::PhiR).is_some();
    }

    /// The measurements, with notices.
    ///
    /// # Errors
    /// An angle is outside its range, no value is there, or no wavelength is near the one asked for.
    pub(crate) fn finish(mut self, metadata: &[(String, String)]) -> Result<Imported, ImportError> {
        self.turn_angles()?;
        self.choose_wavelength()?;
        if !self.rows.iter().any(|row| row.dolp.is_some() || row.brdf.is_some()) {
            return Err(ReadErrorKind::NoData.anywhere().into());
        }
        self.note_rows();
        let measurements = self.measurements(metadata)?;
        Ok(Imported { measurements, notes: self.notes })
    }

    /// Puts angles in the convention of this program: θi from 0, θr negative on the backscatter side.
    fn turn_angles(&mut self) -> Result<(), ImportError> {
        let is_around = |row: &RawRow| row.theta_r > 180.0 && row.theta_r <= 360.0;
        if self.rows.iter().any(is_around) {
            self.rows.iter_mut().filter(|row| is_around(row)).for_each(|row| row.theta_r -= 360.0);
            self.notes.push(ImportNote::WrappedAngles);
        }
        if self.options.flip {
            self.rows.iter_mut().for_each(|row| row.theta_r = -row.theta_r);
        }
        if let Some(negative) = self.rows.iter().find(|row| row.theta_i < 0.0) {
            if let Some(positive) = self.rows.iter().find(|row| row.theta_i > 0.0) {
                let line = negative.line.max(positive.line);
                let found = negative.theta_i.to_string();
                return Err(ReadErrorKind::OutOfRange { found, expected: Expected::ThetaI }.at_line(line).into());
            }
            self.rows.iter_mut().for_each(|row| row.theta_i = row.theta_i.abs());
            self.notes.push(ImportNote::NegativeIncidence);
        }
        let mut angles = self.rows.iter().map(|row| row.theta_r).filter(|theta_r| theta_r.abs() < 90.0);
        let is_all_negative = angles.clone().any(|theta_r| theta_r < 0.0) && angles.all(|theta_r| theta_r <= 0.0);
        if is_all_negative && !self.has_dphi {
            self.notes.push(ImportNote::AllBackscatter);
        }
        if let Some(row) = self.rows.iter().find(|row| row.theta_r < 0.0 && row.dphi != 180.0) {
            let kind = ReadErrorKind::NegativeThetaR { found: row.theta_r.to_string(), dphi: row.dphi };
            return Err(kind.at_line(row.line).into());
        }
        Ok(())
    }

    /// Keeps the wavelength nearest to the one asked for, where there are several.
    fn choose_wavelength(&mut self) -> Result<(), ImportError> {
        let Some(wanted_nm) = self.options.wavelength_nm else { return Ok(()) };
        let mut available: Vec<f64> = self.rows.iter().filter_map(|row| row.wavelength_nm).collect();
        available.sort_by(f64::total_cmp);
        available.dedup();
        if available.is_empty() {
            self.rows.iter_mut().for_each(|row| row.wavelength_nm = Some(wanted_nm));
            return Ok(());
        }
        let nearest = choose_wavelength(&available, Some(wanted_nm))?;
        self.rows.retain(|row| row.wavelength_nm.is_none_or(|nm| nm == nearest));
        self.notes.extend(ImportNote::nearest(Some(wanted_nm), &[nearest]));
        Ok(())
    }

    fn note_rows(&mut self) {
        let list = |is_it: fn(&RawRow) -> bool| {
            let mut lines = LineList::default();
            self.rows.iter().filter(|row| is_it(row)).for_each(|row| lines.push(row.line));
            lines
        };
        let is_beyond = |row: &RawRow| row.theta_r.abs() >= 90.0;
        let without = list(|row| row.lacks_value && row.theta_r.abs() < 90.0);
        let mut notes = vec![
            ImportNote::NotMeasured(without),
            ImportNote::BeyondHorizon(list(is_beyond)),
            ImportNote::ZeroSigma(list(|row| row.has_zero_sigma)),
        ];
        if self.polarimeter.is_some() {
            let is_small = |row: &RawRow| row.dolp.is_some_and(|dolp| dolp.sigma.is_some_and(|sigma| dolp.value < BIASED_BELOW * sigma));
            notes.push(ImportNote::BiasedDolp(list(is_small)));
        }
        notes.retain(|note| note.lines().is_some_and(|lines| lines.count > 0));
        let above = self.rows.iter().filter(|row| row.is_above_one).count();
        if above > 0 {
            notes.push(ImportNote::DolpAboveOne { count: above });
        }
        self.notes.extend(notes);
    }

    fn measurements(&self, metadata: &[(String, String)]) -> Result<Vec<Measurement>, ImportError> {
        let mut places: HashMap<(u32, Option<u64>), usize> = HashMap::new();
        let mut keys: Vec<(u32, Option<f64>)> = Vec::new();
        let mut all: Vec<Measurement> = Vec::new();
        for raw in &self.rows {
            let place = *places.entry((raw.set, raw.wavelength_nm.map(f64::to_bits))).or_insert_with(|| {
                keys.push((raw.set, raw.wavelength_nm));
                all.push(Measurement::default());
                all.len() - 1
            });
            let measurement = &mut all[place];
            let (theta_i, theta_r) = (raw.theta_i, raw.theta_r);
            if theta_r.abs() >= 90.0 {
                let RawRow { dphi, dolp, brdf, .. } = *raw;
                measurement.beyond_horizon.push(BeyondHorizon { theta_i, theta_r, dphi, dolp, brdf });
                continue;
            }
            let geometry = if theta_r < 0.0 { Geometry::in_plane(theta_i, theta_r) } else { Geometry::new(theta_i, theta_r, raw.dphi) };
            measurement.rows.push(Row { geometry: geometry?, dolp: raw.dolp, brdf: raw.brdf, masked: raw.masked });
            measurement.lines.push(raw.line);
        }
        let is_single = all.len() == 1;
        for (measurement, (set, wavelength_nm)) in all.iter_mut().zip(&keys) {
            let set_name = &self.sets[*set as usize];
            let shares_set = keys.iter().filter(|(other, _)| other == set).count() > 1;
            let wavelength = wavelength_nm.filter(|_| shares_set || set_name.is_empty() && !is_single).map(|nm| format!("{nm} nm"));
            measurement.name =
                [Some(set_name.clone()).filter(|name| !name.is_empty()), wavelength].into_iter().flatten().collect::<Vec<_>>().join(" ");
            metadata.clone_into(&mut measurement.metadata);
            measurement.metadata.extend(wavelength_nm.map(|nm| ("wavelength_nm".to_owned(), nm.to_string())));
            measurement.metadata.extend(self.polarimeter.map(|of| ("quantity".to_owned(), quantity(of))));
            measurement.metadata.extend(self.brdf_is.map(|is| ("brdf_is".to_owned(), is.to_string())));
        }
        Ok(all)
    }
}

/// What DoLP was computed from, for the metadata.
fn quantity(polarimeter: Polarimeter) -> String {
    let names: Vec<&str> = polarimeter.channels().iter().map(|&channel: &Channel| Field::Channel(channel).key()).collect();
    format!("DoLP from {}", names.join(", "))
}

//! Stage 4 of a foreign table: columns with meaning and unit, and what is in doubt.

use super::doubt::Doubt;
use super::heading::ColumnHeading;
use super::heading_meaning::Meaning;
use super::layout::Section;
use super::options::TableOptions;
use super::planned_column::PlannedColumn;
use super::vocabulary::{Measure, measure};
use crate::measurement::{BrdfMeaning, Channel, ColumnChoice, ColumnPlace, Field, Polarimeter, ReadError, ReadErrorKind, Unit};

/// A column of values, and that of their standard deviations.
pub(crate) type ValueColumns = (usize, Option<usize>);

/// Values of one row that belong together: those of one place in a wide table.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Group {
    pub(crate) theta_i: Option<f64>,
    pub(crate) theta_r: Option<f64>,
    pub(crate) wavelength_nm: Option<f64>,
    /// Columns of DoLP and its standard deviation, of BRDF and its.
    pub(crate) dolp: Option<ValueColumns>,
    pub(crate) brdf: Option<ValueColumns>,
    pub(crate) polarimeter: Option<(Polarimeter, Vec<ValueColumns>)>,
}

/// What the columns of a section are.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Plan {
    pub(crate) columns: Vec<PlannedColumn>,
    pub(crate) groups: Vec<Group>,
    pub(crate) brdf_is: BrdfMeaning,
    pub(crate) theta_i: Option<f64>,
    pub(crate) dphi: Option<f64>,
    pub(crate) wavelength_nm: Option<f64>,
    /// Whether all but the first channel are divided by the first; none where that is to be seen from
    /// the values.
    pub(crate) is_normalised: Option<bool>,
    /// All columns of Mueller elements, the first element first.
    pub(crate) mueller: Vec<usize>,
    pub(crate) doubts: Vec<Doubt>,
}

impl Plan {
    /// The columns of a section.
    ///
    /// # Errors
    /// The options name a column that is not there.
    pub(crate) fn new(section: &Section, width: usize, options: &TableOptions) -> Result<Self, ReadError> {
        let mut planner = Planner::new(section, width, options);
        if let Some(mapping) = &options.columns {
            planner.apply(mapping, section)?;
            planner.settle_repeats();
        } else {
            planner.resolve_letters();
            planner.resolve_mueller();
            planner.resolve_wide();
            planner.resolve_angles();
            planner.resolve_generic();
            planner.settle_repeats();
        }
        Ok(planner.finish())
    }

    pub(crate) fn column(&self, field: Field) -> Option<usize> {
        self.columns.iter().position(|column| column.field == Some(field))
    }
}

struct Planner<'a> {
    section: &'a Section,
    options: &'a TableOptions,
    headings: Vec<ColumnHeading>,
    columns: Vec<PlannedColumn>,
    mueller: Vec<usize>,
    doubts: Vec<Doubt>,
}

impl<'a> Planner<'a> {
    fn new(section: &'a Section, width: usize, options: &'a TableOptions) -> Self {
        let count = width.max(section.header.len());
        let name = |index: usize| section.header.get(index).map_or("", String::as_str);
        let mut headings: Vec<ColumnHeading> = (0..count).map(|index| ColumnHeading::new(name(index))).collect();
        for (heading, unit) in headings.iter_mut().zip(&section.units) {
            heading.measure = heading.measure.or_else(|| measure(unit));
            heading.is_brdf |= heading.measure == Some(Measure::PerSteradian);
        }
        let columns = headings.iter().enumerate().map(|(index, heading)| PlannedColumn {
            name: if section.header.is_empty() { (index + 1).to_string() } else { name(index).to_owned() },
            field: match heading.meaning {
                Meaning::Field(field) => Some(field),
                _ => None,
            },
            unit: Unit::Native,
            states_unit: heading.measure.is_some(),
            theta_i: heading.at.theta_i,
            theta_r: heading.at.theta_r,
            wavelength_nm: heading.at.wavelength_nm,
            score: heading.score,
            is_brdf: heading.is_brdf,
        });
        Self { section, options, columns: columns.collect(), headings, mueller: Vec::new(), doubts: Vec::new() }
    }

    fn names(&self) -> Vec<String> {
        self.columns.iter().map(|column| column.name.clone()).collect()
    }

    fn has(&self, field: Field) -> bool {
        self.columns.iter().any(|column| column.field == Some(field))
    }

    /// Uses the columns that a mapping names, and of others those of the angles alone.
    fn apply(&mut self, mapping: &crate::measurement::Mapping, section: &Section) -> Result<(), ReadError> {
        let named = |field: Field| mapping.find(field).is_some();
        for column in &mut self.columns {
            column.field = column.field.filter(|field| matches!(field, Field::ThetaI | Field::ThetaR) && !named(*field));
        }
        for mapped in &mapping.columns {
            let by_name = |name: &str| self.columns.iter().position(|column| column.name == name);
            if let ColumnChoice::Name(name) = &mapped.column {
                let same: Vec<usize> = (0..self.columns.len()).filter(|&index| self.columns[index].name == *name).collect();
                if same.len() > 1 {
                    let place = ColumnPlace { number: same[1] + 1, name: name.clone() };
                    let kind = ReadErrorKind::RepeatedColumn { first: same[0] + 1 };
                    return Err(ReadError { line: section.header_line, column: Some(place), kind });
                }
            }
            let index = match &mapped.column {
                ColumnChoice::Name(name) => by_name(name),
                // A title may be a number.
                ColumnChoice::Number(number) => {
                    number.checked_sub(1).filter(|&index| index < self.columns.len()).or_else(|| by_name(&number.to_string()))
                }
            };
            let unknown = || {
                let kind = ReadErrorKind::UnknownColumn { field: mapped.field, found: mapped.column.clone(), names: self.names() };
                ReadError { line: section.header_line, column: None, kind }
            };
            let index = index.ok_or_else(unknown)?;
            let column = &mut self.columns[index];
            (column.field, column.unit, column.states_unit, column.score) = (Some(mapped.field), mapped.unit, true, 10);
            (column.theta_i, column.theta_r, column.wavelength_nm) = (None, None, None);
            self.headings[index].measure = None;
        }
        Ok(())
    }

    /// I, Q and U are Stokes parameters where all three are there.
    fn resolve_letters(&mut self) {
        let find = |letter: char| self.headings.iter().position(|heading| heading.meaning == Meaning::Letter(letter));
        if let (Some(i), Some(q), Some(u)) = (find('i'), find('q'), find('u')) {
            for (index, channel) in [(i, Channel::S0), (q, Channel::S1), (u, Channel::S2)] {
                self.columns[index].field = Some(Field::Channel(channel));
            }
        }
    }

    /// Elements of a Mueller matrix, counted from 0 or from 1.
    fn resolve_mueller(&mut self) {
        let elements: Vec<(usize, u8, u8, bool)> = self
            .headings
            .iter()
            .enumerate()
            .filter_map(|(index, heading)| match heading.meaning {
                Meaning::Mueller { row, column, is_sigma } => Some((index, row, column, is_sigma)),
                _ => None,
            })
            .collect();
        let has_index = |wanted: u8| elements.iter().any(|(_, row, column, _)| *row == wanted || *column == wanted);
        if elements.is_empty() {
            return;
        }
        let base = match (has_index(0), has_index(4)) {
            (true, _) => 0,
            (false, true) => 1,
            (false, false) => {
                self.doubts.push(Doubt::MuellerCount);
                return;
            }
        };
        for (index, row, column, is_sigma) in elements {
            let channel = match (row - base.min(row), column - base.min(column)) {
                (0, 0) => Some(Channel::M00),
                (1, 0) => Some(Channel::M10),
                (2, 0) => Some(Channel::M20),
                _ => None,
            };
            if !is_sigma {
                let at = if channel == Some(Channel::M00) { 0 } else { self.mueller.len() };
                self.mueller.insert(at, index);
            }
            self.columns[index].field =
                channel.map(|channel| if is_sigma { Field::ChannelSigma(channel) } else { Field::Channel(channel) });
        }
    }

    /// Columns whose names are places: what the places are, and what is measured there.
    fn resolve_wide(&mut self) {
        let across = self.headings.iter().find_map(|heading| heading.across);
        let is_open = |heading: &ColumnHeading| heading.at.bare.is_some();
        let bare: Vec<usize> = (0..self.headings.len()).filter(|&index| is_open(&self.headings[index])).collect();
        let values: Vec<f64> = bare.iter().filter_map(|&index| self.headings[index].at.bare).collect();
        let has_theta_i = self.has(Field::ThetaI) || self.section.title.theta_i.is_some() || self.options.theta_i.is_some();
        let kind = match across {
            Some(field) => Some(field),
            None if values.iter().all(|value| *value >= 200.0) => Some(Field::Wavelength),
            None if values.iter().all(|value| value.abs() < 90.0) && !has_theta_i => Some(Field::ThetaI),
            None if values.iter().all(|value| value.abs() <= 180.0) && !self.has(Field::ThetaR) => Some(Field::ThetaR),
            None => None,
        };
        for index in bare {
            let (column, value) = (&mut self.columns[index], self.headings[index].at.bare);
            match kind {
                Some(Field::ThetaI) => column.theta_i = value,
                Some(Field::ThetaR) => column.theta_r = value,
                Some(Field::Wavelength) => column.wavelength_nm = value,
                _ => {}
            }
        }
        if kind == Some(Field::ThetaI) && !self.has(Field::ThetaR) && self.columns[0].field.is_none() && self.columns[0].name.is_empty() {
            self.columns[0].field = Some(Field::ThetaR);
        }
        self.name_wide_columns();
    }

    /// What the columns hold whose names are places alone.
    fn name_wide_columns(&mut self) {
        let is_placed = |column: &PlannedColumn| column.theta_i.is_some() || column.theta_r.is_some() || column.wavelength_nm.is_some();
        let open: Vec<usize> = (0..self.columns.len())
            .filter(|&index| {
                is_placed(&self.columns[index]) && self.columns[index].field.is_none() && self.headings[index].meaning == Meaning::Unknown
            })
            .collect();
        let is_stated = self.columns.iter().any(|column| column.field.is_some_and(Field::is_measured));
        if open.is_empty() || is_stated && self.options.wide.is_none() {
            return;
        }
        let titled = self.section.title.quantity;
        let Some(field) = self.options.wide.or(titled.map(|(field, ..)| field)) else {
            self.doubts.push(Doubt::WideQuantity { names: open.iter().map(|&index| self.columns[index].name.clone()).collect() });
            return;
        };
        for index in open {
            self.columns[index].field = Some(field);
            self.columns[index].score = 7;
            if let Some((titled, brdf_is, percent)) = titled.filter(|(titled, ..)| *titled == field) {
                self.headings[index].brdf_is = brdf_is.filter(|_| titled == Field::Brdf);
                // `°` behind a place is the unit of the place.
                self.headings[index].measure = self.headings[index].measure.filter(|unit| *unit == Measure::Percent).or(percent);
            }
        }
    }

    /// An angle of no particular ray is the one that is missing.
    fn resolve_angles(&mut self) {
        let open: Vec<usize> = (0..self.headings.len()).filter(|&index| self.headings[index].meaning == Meaning::Angle).collect();
        let is_wide = |of: fn(&PlannedColumn) -> Option<f64>| self.columns.iter().any(|column| of(column).is_some());
        let has_theta_i = self.has(Field::ThetaI)
            || self.section.title.theta_i.is_some()
            || self.options.theta_i.is_some()
            || is_wide(|column| column.theta_i);
        let has_theta_r = self.has(Field::ThetaR) || is_wide(|column| column.theta_r);
        let is_specular =
            self.columns.iter().any(|column| matches!(column.field, Some(Field::Channel(Channel::Psi | Channel::Rs | Channel::Rp))));
        let field = match (has_theta_i, has_theta_r) {
            (false, false) if is_specular => Field::ThetaI,
            (true, false) => Field::ThetaR,
            (false, true) => Field::ThetaI,
            _ => return,
        };
        match open[..] {
            [only] => self.columns[only].field = Some(field),
            [] => {}
            _ => self.doubts.push(self.several(field, &open)),
        }
    }

    /// Values and standard deviations of no particular quantity.
    fn resolve_generic(&mut self) {
        let is_quantity = |column: &PlannedColumn| column.field.is_some_and(|field| field.sigma().is_some());
        for index in 0..self.columns.len() {
            if self.headings[index].meaning == Meaning::Value
                && !self.columns.iter().any(is_quantity)
                && let Some((field, brdf_is, percent)) = self.section.title.quantity
            {
                (self.columns[index].field, self.columns[index].score) = (Some(field), 4);
                self.headings[index].brdf_is = brdf_is;
                self.headings[index].measure = self.headings[index].measure.or(percent);
            }
            let is_sigma = self.headings[index].meaning == Meaning::Sigma;
            let before = (0..index).rev().find(|&before| is_quantity(&self.columns[before]));
            let after = || (index..self.columns.len()).find(|&after| is_quantity(&self.columns[after]));
            if let Some(of) = before.or_else(after).filter(|_| is_sigma) {
                let value = self.columns[of].clone();
                let column = &mut self.columns[index];
                column.field = value.field.and_then(Field::sigma);
                (column.theta_i, column.theta_r, column.wavelength_nm) = (value.theta_i, value.theta_r, value.wavelength_nm);
                column.score = 6;
            }
        }
        // A standard deviation beside a value with a place belongs to the same place.
        for index in 1..self.columns.len() {
            let column = &self.columns[index];
            let is_placeless = column.theta_i.is_none() && column.theta_r.is_none() && column.wavelength_nm.is_none();
            let before = self.columns[index - 1].clone();
            if is_placeless && before.field.and_then(Field::sigma).is_some_and(|sigma| column.field == Some(sigma)) {
                let column = &mut self.columns[index];
                (column.theta_i, column.theta_r, column.wavelength_nm) = (before.theta_i, before.theta_r, before.wavelength_nm);
            }
        }
    }

    fn several(&self, field: Field, columns: &[usize]) -> Doubt {
        Doubt::Several { field, columns: columns.iter().map(|&index| (index + 1, self.columns[index].name.clone())).collect() }
    }

    /// Leaves each field of one place to its surest column; a tie is a doubt.
    fn settle_repeats(&mut self) {
        let place = |column: &PlannedColumn| {
            (column.field, column.theta_i.map(f64::to_bits), column.theta_r.map(f64::to_bits), column.wavelength_nm.map(f64::to_bits))
        };
        for index in 0..self.columns.len() {
            let Some(field) = self.columns[index].field else { continue };
            let same: Vec<usize> =
                (index..self.columns.len()).filter(|&other| place(&self.columns[other]) == place(&self.columns[index])).collect();
            if same.len() == 1 {
                continue;
            }
            let best = same.iter().map(|&other| self.columns[other].score).max().unwrap_or(0);
            let surest: Vec<usize> = same.iter().copied().filter(|&other| self.columns[other].score == best).collect();
            let is_choice = surest.len() > 1 && !matches!(field, Field::Set | Field::Masked);
            if is_choice {
                self.doubts.push(self.several(field, &surest));
            }
            for other in same.into_iter().filter(|other| *other != surest[0]) {
                self.columns[other].field = None;
            }
        }
    }

    fn finish(mut self) -> Plan {
        self.settle_units();
        let mut groups = self.groups();
        self.drop_unused(&mut groups);
        let title = &self.section.title;
        let theta_i = self.options.theta_i.or(self.options.columns.as_ref().and_then(|mapping| mapping.theta_i)).or(title.theta_i);
        let dphi = self.options.dphi.or(self.options.columns.as_ref().and_then(|mapping| mapping.dphi)).or(title.dphi);
        let brdf_is = self.brdf_meaning();
        let stated = self.columns.iter().zip(&self.headings).filter(|(column, _)| matches!(column.field, Some(Field::Channel(_))));
        let is_normalised = self.options.normalised || stated.clone().any(|(_, heading)| heading.is_normalised);
        let mut plan = Plan {
            brdf_is: brdf_is.unwrap_or(BrdfMeaning::Brdf),
            theta_i: theta_i.filter(|_| !self.has(Field::ThetaI)),
            dphi: dphi.filter(|_| !self.has(Field::Dphi)),
            wavelength_nm: title.wavelength_nm,
            is_normalised: if is_normalised { Some(true) } else { self.mueller.is_empty().then_some(false) },
            mueller: std::mem::take(&mut self.mueller),
            groups,
            columns: std::mem::take(&mut self.columns),
            doubts: std::mem::take(&mut self.doubts),
        };
        plan.doubt(brdf_is, self.section);
        plan
    }

    /// Converts what headings and the row of units say.
    fn settle_units(&mut self) {
        let percents: Vec<bool> = self.headings.iter().map(ColumnHeading::is_percent).collect();
        for (index, is_percent) in percents.into_iter().enumerate() {
            let Some(field) = self.columns[index].field else { continue };
            if self.options.columns.is_some() {
                continue;
            }
            let has_unit = |unit| field.unit_names().iter().any(|(_, known)| *known == unit);
            let of_measure = match self.headings[index].measure {
                Some(Measure::Radians) => Some(Unit::Radians),
                Some(Measure::Percent) => Some(Unit::Percent),
                Some(Measure::Micrometers) => Some(Unit::Micrometers),
                Some(Measure::Angstroms) => Some(Unit::Angstroms),
                _ => None,
            };
            if let Some(unit) = of_measure.filter(|unit| has_unit(*unit)) {
                self.columns[index].unit = unit;
            }
            // An error without a unit has the unit of its value.
            let value = (0..self.columns.len()).rfind(|&other| self.columns[other].field.and_then(Field::sigma) == Some(field));
            let states = self.headings[index].measure.is_some_and(|unit| unit != Measure::Other) || is_percent;
            if let Some(value) = value.filter(|_| !states) {
                self.columns[index].states_unit = self.columns[value].states_unit;
                self.columns[index].unit = match self.headings[value].measure {
                    Some(Measure::Percent) if has_unit(Unit::Percent) => Unit::Percent,
                    Some(Measure::Radians) if has_unit(Unit::Radians) => Unit::Radians,
                    _ => Unit::Native,
                };
            }
        }
    }

    fn groups(&self) -> Vec<Group> {
        let mut groups: Vec<Group> = Vec::new();
        for column in self.columns.iter().filter(|column| column.field.is_some_and(Field::is_measured)) {
            let at = (column.theta_i, column.theta_r, column.wavelength_nm);
            if !groups.iter().any(|group| (group.theta_i, group.theta_r, group.wavelength_nm) == at) {
                let (theta_i, theta_r, wavelength_nm) = at;
                groups.push(Group { theta_i, theta_r, wavelength_nm, dolp: None, brdf: None, polarimeter: None });
            }
        }
        for group in &mut groups {
            let at = (group.theta_i, group.theta_r, group.wavelength_nm);
            let find = |field| {
                self.columns
                    .iter()
                    .position(|column| column.field == Some(field) && (column.theta_i, column.theta_r, column.wavelength_nm) == at)
            };
            let with_sigma = |field: Field| find(field).map(|value| (value, field.sigma().and_then(find)));
            group.dolp = with_sigma(Field::Dolp);
            group.brdf = with_sigma(Field::Brdf);
            group.polarimeter = Polarimeter::ALL.iter().find_map(|&polarimeter| {
                let channels: Option<Vec<_>> = polarimeter.channels().iter().map(|&channel| with_sigma(Field::Channel(channel))).collect();
                channels.map(|channels| (polarimeter, channels))
            });
            if group.dolp.is_some() {
                group.polarimeter = None;
            }
            // S0 or m00 is a BRDF where the table says so.
            let first = [Field::Channel(Channel::S0), Field::Channel(Channel::M00)].into_iter().find_map(with_sigma);
            group.brdf = group.brdf.or(first.filter(|(index, _)| self.columns[*index].is_brdf || self.titled_brdf()));
        }
        groups.retain(|group| group.dolp.is_some() || group.brdf.is_some() || group.polarimeter.is_some());
        groups
    }

    /// Whether a title says that Stokes values or Mueller elements are those of a BRDF.
    fn titled_brdf(&self) -> bool {
        self.section.title.quantity.is_some_and(|(field, is, _)| field == Field::Brdf && is == Some(BrdfMeaning::Brdf))
            && self.options.columns.is_none()
    }

    /// Columns that no group uses are named as not used.
    fn drop_unused(&mut self, groups: &mut [Group]) {
        let mut used = vec![false; self.columns.len()];
        let mut mark = |(value, sigma): &(usize, Option<usize>)| {
            used[*value] = true;
            if let Some(sigma) = sigma {
                used[*sigma] = true;
            }
        };
        for group in groups.iter() {
            group.dolp.iter().chain(&group.brdf).for_each(&mut mark);
            group.polarimeter.iter().flat_map(|(_, channels)| channels).for_each(&mut mark);
        }
        for (column, used) in self.columns.iter_mut().zip(used) {
            if column.field.is_some_and(Field::is_measured) && !used {
                column.field = None;
            }
        }
    }

    /// What the BRDF of the table is; none where that is open.
    fn brdf_meaning(&self) -> Option<BrdfMeaning> {
        let first = self.columns.iter().position(|column| column.field == Some(Field::Brdf));
        let Some(first) = first else { return Some(self.options.brdf_is.unwrap_or(BrdfMeaning::Brdf)) };
        let is_chosen = self.options.wide == Some(Field::Brdf) || self.options.columns.is_some();
        let stated = self.headings[first].brdf_is.or_else(|| self.section.title.quantity.and_then(|(_, is, _)| is));
        let by_unit = (self.headings[first].measure == Some(Measure::PerSteradian)).then_some(BrdfMeaning::Brdf);
        self.options.brdf_is.or(stated).or(by_unit).or(is_chosen.then_some(BrdfMeaning::Brdf))
    }
}

impl Plan {
    /// Adds the doubts that are left.
    fn doubt(&mut self, brdf_is: Option<BrdfMeaning>, section: &Section) {
        let names: Vec<String> = self.columns.iter().map(|column| column.name.clone()).collect();
        let is_wide = |of: fn(&PlannedColumn) -> Option<f64>| self.columns.iter().any(|column| of(column).is_some());
        let has_theta_i = self.column(Field::ThetaI).is_some() || self.theta_i.is_some() || is_wide(|column| column.theta_i);
        let is_specular = self.groups.iter().any(|group| group.polarimeter.as_ref().is_some_and(|(of, _)| of.is_specular()));
        let has_theta_r = self.column(Field::ThetaR).is_some() || is_wide(|column| column.theta_r) || is_specular;
        let is_known =
            |doubts: &[Doubt], field: Field| doubts.iter().any(|doubt| matches!(doubt, Doubt::Several { field: of, .. } if *of == field));
        if section.header.is_empty() && self.groups.is_empty() {
            self.doubts.push(Doubt::NoHeader { columns: names.len() });
            return;
        }
        if self.groups.is_empty() && self.doubts.is_empty() {
            self.doubts.push(Doubt::NoQuantity { names: names.clone() });
        }
        for (field, is_there) in [(Field::ThetaI, has_theta_i), (Field::ThetaR, has_theta_r)] {
            if !is_there && !is_known(&self.doubts, field) {
                self.doubts.push(Doubt::NoAngle { field, names: names.clone() });
            }
        }
        if brdf_is.is_none()
            && let Some(index) = self.column(Field::Brdf)
        {
            self.doubts.push(Doubt::BrdfMeaning { name: self.columns[index].name.clone() });
        }
    }
}

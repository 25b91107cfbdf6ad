//! What a line of text says about the rows below: an angle, a wavelength, a sample, a quantity.

use super::dialect::Dialect;
use super::heading::{At, ColumnHeading};
use super::heading_meaning::Meaning;
use super::number::ReadCell;
use super::vocabulary::{Measure, Word, meanings, normalised, words};
use crate::measurement::{BrdfMeaning, Field};

/// What titles say.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Title {
    /// Degrees.
    pub(crate) theta_i: Option<f64>,
    /// Degrees.
    pub(crate) dphi: Option<f64>,
    pub(crate) wavelength_nm: Option<f64>,
    pub(crate) set: Option<String>,
    /// DoLP or BRDF, where the text names one of them.
    pub(crate) quantity: Option<(Field, Option<BrdfMeaning>, Option<Measure>)>,
}

/// Marks of remarks at the beginning of a line.
const MARKS: [&str; 7] = ["#", "%", "//", "!", ";", "*", "'"];

/// A line without the mark of a remark and white space around it.
pub(crate) fn strip_mark(line: &str) -> &str {
    let text = line.trim();
    let Some(mark) = MARKS.iter().find(|mark| text.starts_with(**mark)) else { return text };
    text.trim_start_matches(*mark).trim_start()
}

/// Key and value of a line `key: value` or `key = value`, or of a line of two cells.
pub(crate) fn key_and_value(text: &str) -> Option<(&str, &str)> {
    let is_time = |before: &str, after: &str| {
        before.ends_with(|last: char| last.is_ascii_digit()) && after.starts_with(|first: char| first.is_ascii_digit())
    };
    let (key, value) =
        ["：", ":", "=", ";", "\t", ","].iter().find_map(|mark| text.split_once(mark)).filter(|(key, value)| !is_time(key, value))?;
    let (key, value) = (key.trim().trim_matches('"'), value.trim().trim_end_matches([';', ',', '\t']).trim().trim_matches('"'));
    (!key.is_empty() && !value.is_empty() && key.len() <= 60).then_some((key, value))
}

/// A number below is a wavelength in micrometres where no unit stands beside it.
const SHORTEST_NM: f64 = 20.0;

impl Title {
    /// What a line says.
    pub(crate) fn new(text: &str, dialect: Dialect) -> Self {
        let mut title = Self::default();
        if text.len() > 400 {
            return title;
        }
        title.quantity = quantity_in(text);
        let text = text.replace('：', ":").replace('＝', "=");
        // A comma parts what is said, but not the digits of a number.
        for part in text.split([';', '\t', '|', '，']).flat_map(|part| part.split(", ")).flat_map(|part| part.split(" and ")) {
            if let Some((key, value)) = key_and_value(part) {
                title.add_pair(key, value, dialect);
            } else {
                title.add_words(part);
            }
        }
        // A key and its value in two cells.
        if !title.says_where()
            && let Some((key, value)) = key_and_value(&text)
        {
            title.add_pair(key, value, dialect);
        }
        title
    }

    fn add_pair(&mut self, key: &str, value: &str, dialect: Dialect) {
        let heading = ColumnHeading::new(key);
        if heading.meaning == Meaning::Field(Field::Set) && heading.score >= 7 {
            self.set = Some(value.to_owned());
            return;
        }
        let any = Dialect { decimal: super::dialect::Decimal::Point, ..dialect };
        let number = match ReadCell::new(value, dialect) {
            ReadCell::Text(_) => ReadCell::new(value, any),
            cell => cell,
        };
        if let ReadCell::Number(number, unit) = number {
            self.add(of_number(heading.meaning, number, unit.or(heading.measure)));
        } else {
            self.add_words(&format!("{key} {value}"));
        }
    }

    /// Takes in words before a number: `Scan at AOI 30 deg`.
    fn add_words(&mut self, text: &str) {
        let starts = std::iter::once(0).chain(text.char_indices().filter(|(_, letter)| letter.is_whitespace()).map(|(at, _)| at + 1));
        for start in starts.take(12) {
            let Some(rest) = text.get(start..) else { continue };
            let heading = ColumnHeading::new(rest);
            let At { theta_i, wavelength_nm, .. } = heading.at;
            // The sample's temperature at an angle is none of this.
            if heading.meaning == Meaning::Unknown && (theta_i.is_some() || wavelength_nm.is_some()) {
                let nm = wavelength_nm.filter(|nm| *nm > 0.0).map(|nm| if nm < SHORTEST_NM { 1000.0 * nm } else { nm });
                self.add(Self { theta_i: theta_i.filter(is_incidence), wavelength_nm: nm, ..Self::default() });
                return;
            }
        }
    }

    /// Whether the text says where the rows below were measured.
    pub(crate) fn says_where(&self) -> bool {
        self.theta_i.is_some() || self.dphi.is_some() || self.wavelength_nm.is_some() || self.set.is_some()
    }

    /// Takes in another title of the same rows; the later one counts.
    pub(crate) fn add(&mut self, other: Self) {
        let before = std::mem::replace(self, other);
        self.inherit(&before);
    }

    /// Takes from an earlier title what this one does not say.
    pub(crate) fn inherit(&mut self, before: &Self) {
        self.theta_i = self.theta_i.or(before.theta_i);
        self.dphi = self.dphi.or(before.dphi);
        self.wavelength_nm = self.wavelength_nm.or(before.wavelength_nm);
        self.quantity = self.quantity.or(before.quantity);
        if self.set.is_none() {
            self.set.clone_from(&before.set);
        }
    }
}

fn is_incidence(degrees: &f64) -> bool {
    (0.0..90.0).contains(degrees)
}

/// What a number says that stands behind a name with that meaning.
fn of_number(meaning: Meaning, number: f64, unit: Option<Measure>) -> Title {
    let degrees = if unit == Some(Measure::Radians) { number.to_degrees() } else { number };
    let is_angle = matches!(unit, None | Some(Measure::Degrees | Measure::Radians));
    match meaning {
        Meaning::Field(Field::ThetaI) if is_angle => Title { theta_i: Some(degrees).filter(is_incidence), ..Title::default() },
        Meaning::Field(Field::Dphi) if is_angle => Title { dphi: Some(degrees), ..Title::default() },
        Meaning::Field(Field::Wavelength) if number > 0.0 => {
            let factor = match unit {
                Some(Measure::Micrometers) => 1000.0,
                Some(Measure::Angstroms) => 0.1,
                _ if number < SHORTEST_NM => 1000.0,
                _ => 1.0,
            };
            Title { wavelength_nm: Some(number * factor), ..Title::default() }
        }
        _ => Title::default(),
    }
}

/// The quantity that a text names: DoLP or BRDF, not both.
fn quantity_in(text: &str) -> Option<(Field, Option<BrdfMeaning>, Option<Measure>)> {
    let all: Vec<Vec<Word>> = words(&normalised(text)).iter().filter(|word| word.len() > 1).map(|word| meanings(word)).collect();
    let has = |of: Word| all.iter().any(|meanings| meanings.contains(&of));
    let dolp = has(Word::Polarisation) && !has(Word::Angle) && !has(Word::Foreign);
    let factor = has(Word::Factor) && has(Word::Reflectance) || words(&normalised(text)).iter().any(|word| word.ends_with("faktor"));
    let brdf = has(Word::Brdf) || factor || has(Word::Reflectance);
    let percent = text.contains('%').then_some(Measure::Percent);
    match (dolp, brdf) {
        (true, false) => Some((Field::Dolp, None, percent)),
        (false, true) => {
            let is = if factor { Some(BrdfMeaning::Factor) } else { has(Word::Brdf).then_some(BrdfMeaning::Brdf) };
            let is = if has(Word::Cosine) { Some(BrdfMeaning::BrdfCos) } else { is };
            Some((Field::Brdf, is, percent))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::super::dialect::{Decimal, Dialect, Separator};
    use super::{Title, strip_mark};
    use crate::measurement::Field;

    #[test]
    fn titles_say_where_and_what() {
        let dialect = Dialect { separator: Separator::Character(';'), decimal: Decimal::Comma, thousands: None };
        for (text, theta_i, wavelength_nm) in [
            ("AOI = 30 deg", Some(30.0), None),
            ("AOI: 30,5°", Some(30.5), None),
            ("Einfallswinkel 40 °", Some(40.0), None),
            ("# theta_i = 45", Some(45.0), None),
            ("入射角：30°", Some(30.0), None),
            ("--- Scan at AOI 30 deg ---", Some(30.0), None),
            ("Angle of incidence: 60 degrees, wavelength: 633 nm", Some(60.0), Some(633.0)),
            ("AOI;45;;", Some(45.0), None),
            ("Wavelength 0.65 µm", None, Some(650.0)),
            ("WAVELENGTH 0.65", None, Some(650.0)),
            ("HeNe laser 633 nm", None, Some(633.0)),
            ("incident angle (rad): 0.5235987755982988", Some(30.0), None),
            ("date 2024-05-01 12:30 operator JL", None, None),
            ("Goniometer scan 7", None, None),
            ("Messung Probe 7", None, None),
            ("Incident power: 30 mW", None, None),
        ] {
            let title = Title::new(strip_mark(text), dialect);
            let close = |a: Option<f64>, b: Option<f64>| a.zip(b).map_or(a == b, |(a, b)| (a - b).abs() < 1e-9);
            assert!(close(title.theta_i, theta_i) && close(title.wavelength_nm, wavelength_nm), "{text}: {title:?}");
        }
        for (text, quantity) in [
            ("Degree of linear polarisation", Some(Field::Dolp)),
            ("Polarisationsgrad von Probe 7", Some(Field::Dolp)),
            ("线偏振度测量", Some(Field::Dolp)),
            ("In-plane BRDF, plate C", Some(Field::Brdf)),
            ("Measurement of a plate", None),
        ] {
            assert_eq!(Title::new(text, dialect).quantity.map(|(field, ..)| field), quantity, "{text}");
        }
        assert_eq!(Title::new("Sample: copper, rough", dialect).set.as_deref(), Some("copper"));
    }
}

//! What the cell of a header says: a meaning, a unit, and where its values were measured.

use super::heading_meaning::{Meaning, meaning_of};
use super::vocabulary::{Measure, Word, before_error, meanings, measure, normalised, words};
use crate::measurement::{BrdfMeaning, Channel, Field};

/// Where the values of a column were measured, as far as its heading says so.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct At {
    /// Degrees.
    pub(crate) theta_i: Option<f64>,
    /// Degrees.
    pub(crate) theta_r: Option<f64>,
    pub(crate) wavelength_nm: Option<f64>,
    /// A number without a unit.
    pub(crate) bare: Option<f64>,
}

impl At {
    pub(crate) fn is_anywhere(&self) -> bool {
        *self == Self::default()
    }
}

/// What the cell of a header says.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ColumnHeading {
    pub(crate) meaning: Meaning,
    /// How sure the meaning is: 0 for none, 10 for a name of this project's own.
    pub(crate) score: u8,
    pub(crate) measure: Option<Measure>,
    /// What a BRDF is, where the heading says so.
    pub(crate) brdf_is: Option<BrdfMeaning>,
    /// Whether a channel is a BRDF too.
    pub(crate) is_brdf: bool,
    /// Whether the channel is divided by the first one.
    pub(crate) is_normalised: bool,
    pub(crate) at: At,
    /// What the other columns of a wide table are, of a corner such as `view\AOI`.
    pub(crate) across: Option<Field>,
}

impl ColumnHeading {
    const NONE: Self = Self {
        meaning: Meaning::Unknown,
        score: 0,
        measure: None,
        brdf_is: None,
        is_brdf: false,
        is_normalised: false,
        at: At { theta_i: None, theta_r: None, wavelength_nm: None, bare: None },
        across: None,
    };

    /// What a cell of a header says.
    pub(crate) fn new(cell: &str) -> Self {
        if cell.trim().is_empty() || cell.len() > 120 {
            return Self::NONE;
        }
        if let Some(corner) = corner(cell) {
            return corner;
        }
        let whole = normalised(cell);
        let (rest, measure) = without_measure(&whole);
        let mut heading = Self { measure, ..Self::NONE };
        if let Some((row, column, is_sigma)) = mueller(&words(&whole)) {
            return Self { meaning: Meaning::Mueller { row, column, is_sigma }, score: 9, ..Self::NONE };
        }
        let with_digits = split_glued(words(&rest));
        let says_brdf =
            |words: &[String]| measure == Some(Measure::PerSteradian) || words.iter().any(|word| meanings(word).contains(&Word::Brdf));
        if let Some((row, column, is_sigma)) = mueller(&with_digits) {
            heading.is_brdf = says_brdf(&with_digits);
            return Self { meaning: Meaning::Mueller { row, column, is_sigma }, score: 9, ..heading };
        }
        let (rest, at_number) = without_number(&rest);
        let all = split_glued(words(&rest));
        if let Some((special, is_sigma, is_normalised)) = special(&rest, &all, at_number) {
            let field = if is_sigma { Field::ChannelSigma(special) } else { Field::Channel(special) };
            heading.is_brdf = measure == Some(Measure::PerSteradian) || all.iter().any(|word| meanings(word).contains(&Word::Brdf));
            return Self { meaning: Meaning::Field(field), score: 9, is_normalised, ..heading };
        }
        let (meaning, score, brdf_is) = meaning_of(&all);
        heading = Self { meaning, score, brdf_is, ..heading };
        if let Some((number, unit)) = at_number {
            heading.add_place(number, unit);
            // `AOI 30 DoLP`: the words of the place tell where, the others what.
            let is_place = |word: &&String| {
                meanings(word)
                    .iter()
                    .any(|of| matches!(of, Word::Incidence | Word::View | Word::ViewAngle | Word::Angle | Word::Wavelength))
                    && *word != "s"
            };
            let (places, others): (Vec<String>, Vec<String>) = all.into_iter().partition(|word| is_place(&word));
            if !places.is_empty() && !others.is_empty() {
                let mut place = Self { meaning: meaning_of(&places).0, ..Self::NONE };
                place.add_place(number, unit);
                let (meaning, score, brdf_is) = meaning_of(&others);
                if meaning != Meaning::Unknown {
                    heading = Self { meaning, score, brdf_is, at: place.at, ..heading };
                }
            }
        }
        heading
    }

    /// Takes in the number of a heading such as `DoLP 450 nm` or `AOI 30`.
    fn add_place(&mut self, number: f64, unit: Option<Measure>) {
        let degrees = if unit == Some(Measure::Radians) { number.to_degrees() } else { number };
        match (self.meaning, unit) {
            (Meaning::Field(Field::ThetaI), _) => self.at.theta_i = Some(degrees),
            (Meaning::Field(Field::ThetaR), _) => self.at.theta_r = Some(degrees),
            (_, Some(Measure::Nanometers)) | (Meaning::Field(Field::Wavelength), None) => self.at.wavelength_nm = Some(number),
            (_, Some(Measure::Micrometers)) => self.at.wavelength_nm = Some(1000.0 * number),
            (_, Some(Measure::Angstroms)) => self.at.wavelength_nm = Some(0.1 * number),
            _ => self.at.bare = Some(degrees),
        }
        // An angle or a wavelength with a number says where, not what.
        if matches!(self.meaning, Meaning::Field(Field::ThetaI | Field::ThetaR | Field::Wavelength) | Meaning::Angle) {
            (self.meaning, self.score) = (Meaning::Unknown, 0);
        }
    }

    /// The unit of a quantity that the heading states, as this program names it.
    pub(crate) fn is_percent(&self) -> bool {
        self.measure == Some(Measure::Percent)
    }
}

/// `view angle\AOI`: what the rows are, and what the columns are.
fn corner(cell: &str) -> Option<ColumnHeading> {
    let parts = ["\\", "→", "|", " vs. ", " vs ", "/"].iter().find_map(|mark| cell.split_once(mark))?;
    let of = |part: &str| match ColumnHeading::new(part.trim_matches(['↓', '→', ' '])) {
        heading @ ColumnHeading { meaning: Meaning::Field(Field::ThetaI | Field::ThetaR | Field::Wavelength), .. }
            if heading.at.is_anywhere() =>
        {
            Some(heading)
        }
        _ => None,
    };
    let (rows, columns) = (of(parts.0)?, of(parts.1)?);
    let Meaning::Field(across) = columns.meaning else { return None };
    (rows.meaning != columns.meaning).then_some(ColumnHeading { across: Some(across), ..rows })
}

/// The text without its unit: in brackets, behind a slash or `in`, or as the last word.
fn without_measure(text: &str) -> (String, Option<Measure>) {
    let mut text = text.to_owned();
    let mut found = None;
    for (open, close) in [('[', ']'), ('(', ')'), ('{', '}'), ('<', '>')] {
        if let Some(start) = text.find(open)
            && let Some(length) = text[start..].find(close)
            && let Some(unit) = measure(&text[start..=start + length]).or_else(|| measure(&text[start + 1..start + length]))
        {
            found = Some(unit);
            text.replace_range(start..=start + length, " ");
        }
    }
    if found.is_some() {
        return (text, found);
    }
    let trimmed = text.trim();
    if let Some((before, after)) = trimmed.rsplit_once('/')
        && let Some(unit) = measure(after)
        && !before.trim().is_empty()
    {
        return (before.trim_end().strip_suffix('1').unwrap_or(before).to_owned(), Some(unit));
    }
    let is_number = |before: &str| before.trim_end().ends_with(|last: char| last.is_ascii_digit());
    let before_last = trimmed.rfind([' ', '_', ',', ':']).map(|at| (&trimmed[..at], &trimmed[at + 1..]));
    for (before, after) in before_last.into_iter().chain(trimmed.char_indices().last().map(|(at, _)| trimmed.split_at(at))) {
        let is_sign = matches!(after, "%" | "°" | "º");
        if (is_sign || after.chars().count() > 1)
            && let Some(unit) = measure(after).filter(|unit| *unit != Measure::Other)
            && !is_number(before)
            && before.contains(char::is_alphanumeric)
            && after != "ang"
        {
            let before = before.trim_end().trim_end_matches("_in").trim_end_matches(" in");
            return (before.to_owned(), Some(unit));
        }
    }
    (trimmed.to_owned(), None)
}

/// The text without its number, where that is one that says where or at which wavelength.
fn without_number(text: &str) -> (String, Option<(f64, Option<Measure>)>) {
    let bytes = text.as_bytes();
    let mut start = 0;
    while let Some(offset) = text[start..].find(|letter: char| letter.is_ascii_digit()) {
        let begin = start + offset;
        let length = text[begin..].find(|letter: char| !letter.is_ascii_digit() && !".,".contains(letter)).unwrap_or(text.len() - begin);
        let digits = text[begin..begin + length].trim_end_matches(['.', ',']);
        let end = begin + digits.len();
        start = begin + length;
        // `s0`, `i45` and `m11` are names; `dolp550` and `aoi30` are not.
        let before = &text[..begin];
        let glued = &before[before.trim_end_matches(|letter: char| letter.is_ascii_alphabetic()).len()..];
        if !glued.is_empty() && (meanings(glued).is_empty() || glued.len() < 2 || digits.len() < 2) {
            continue;
        }
        let sign = if begin > 0 && bytes[begin - 1] == b'-' && (begin == 1 || matches!(bytes[begin - 2], b' ' | b'=' | b'(')) {
            -1.0
        } else {
            1.0
        };
        let Ok(number) = digits.replace(',', ".").parse::<f64>() else { continue };
        let after = text[end..].trim_start();
        let unit_length = after.find(|letter: char| letter.is_whitespace() || ")]_,;:=".contains(letter)).unwrap_or(after.len());
        let unit = measure(&after[..unit_length]).filter(|unit| *unit != Measure::Other);
        // `S_0` and `S 1` are names too.
        let word = text[..begin].trim_end_matches(|letter: char| !letter.is_alphanumeric());
        let last = word.len() - word.chars().rev().take_while(|letter| letter.is_alphanumeric()).map(char::len_utf8).sum::<usize>();
        let is_index = digits.len() == 1 && (word.chars().count() > 0 && word[last..].chars().count() == 1 || &word[last..] == "theta");
        if is_index && unit.is_none() {
            continue;
        }
        if unit.is_none()
            && after.starts_with(|next: char| next.is_ascii_alphabetic())
            && text[end..].starts_with(|next: char| next.is_ascii_alphabetic())
        {
            continue;
        }
        let rest = if unit.is_some() { &after[unit_length..] } else { after };
        return (format!("{} {rest}", &text[..begin]), Some((sign * number, unit)));
    }
    (text.to_owned(), None)
}

/// Parts words such as `thetai`, `dolperr`, `errdolp` and `dphi`.
fn split_glued(words: Vec<String>) -> Vec<String> {
    let mut out = Vec::new();
    for word in words {
        let front = ["theta", "dolp", "brdf", "psi"].iter().find(|front| word.len() > front.len() && word.starts_with(**front));
        let back = ["dolp", "brdf", "phi", "angle"].iter().find(|back| word.len() > back.len() && word.ends_with(**back));
        if let Some((before, error)) = before_error(&word) {
            out.extend([before.to_owned(), error.to_owned()]);
        } else if let Some(front) = front {
            out.extend([(*front).to_owned(), word[front.len()..].to_owned()]);
        } else if let Some(back) = back {
            out.extend([word[..word.len() - back.len()].to_owned(), (*back).to_owned()]);
        } else if let Some(of) = word.strip_prefix("phi").filter(|of| matches!(*of, "i" | "r" | "in" | "out" | "v" | "s" | "o")) {
            out.extend(["phi".to_owned(), of.to_owned()]);
        } else {
            out.push(word);
        }
    }
    out
}

/// Marks of a standard deviation that may stick to the name of a channel.
const GLUED_ERRORS: [&str; 9] = ["stddev", "sigma", "error", "err", "std", "unc", "sd", "u", "d"];

/// A channel with a name of its own, whether it is its standard deviation, and whether it is divided
/// by the first.
fn special(text: &str, words: &[String], number: Option<(f64, Option<Measure>)>) -> Option<(Channel, bool, bool)> {
    let is_error = |word: &str| meanings(word).contains(&Word::Error);
    let strong = |word: &&String| word.len() > 1 && is_error(word);
    let mut is_sigma = words.iter().any(|word| strong(&word));
    let mut rest: Vec<&str> = words.iter().filter(|word| !strong(word)).map(String::as_str).collect();
    // u(S0), dS0, s_S0.
    if rest.len() == 2 && matches!(rest[0], "u" | "d" | "e" | "delta") && channel(rest[1], &[], None).is_some() {
        is_sigma = true;
        rest.remove(0);
    }
    let fillers: &[&str] = &["stokes", "norm", "normalized", "normalised", "normiert", "brdf", "parameter", "component", "counts"];
    let names: Vec<&str> = rest.iter().copied().filter(|word| !fillers.contains(word)).collect();
    if let [first, "s0"] = names[..]
        && text.contains('/')
    {
        return channel(first, &[], None).filter(|found| matches!(found, Channel::S1 | Channel::S2)).map(|found| (found, is_sigma, true));
    }
    let is_normalised = rest.iter().any(|word| word.starts_with("norm"));
    let stem = names.concat();
    if let Some(found) = channel(&stem, &names, number) {
        return Some((found, is_sigma, is_normalised));
    }
    let glued = GLUED_ERRORS.iter().find_map(|mark| stem.strip_suffix(mark).or_else(|| stem.strip_prefix(mark)));
    glued.and_then(|stem| channel(stem, &[], None)).filter(|found| *found != Channel::Psi).map(|found| (found, true, is_normalised))
}

/// The channel of a name in small letters.
fn channel(stem: &str, words: &[&str], number: Option<(f64, Option<Measure>)>) -> Option<Channel> {
    if let Some(found) = match stem {
        "s0" => Some(Channel::S0),
        "s1" => Some(Channel::S1),
        "s2" => Some(Channel::S2),
        "psi" => Some(Channel::Psi),
        "rs" | "is" | "rperp" | "iperp" | "rte" | "ite" | "rsenkrecht" | "isenkrecht" | "rspol" | "ispol" => Some(Channel::Rs),
        "rp" | "ip" | "rpar" | "ipar" | "rtm" | "itm" | "rparallel" | "iparallel" | "rppol" | "ippol" => Some(Channel::Rp),
        _ => None,
    } {
        return Some(found);
    }
    if let [first, rest @ ..] = words
        && !rest.is_empty()
        && (["r", "i"].contains(first) || ["refl", "intens", "signal"].iter().any(|front| first.starts_with(front)))
    {
        let is_any = |names: &[&str]| rest.iter().all(|word| names.contains(word) || *word == "pol" || word.starts_with("polari"));
        if is_any(&["s", "te", "perp", "perpendicular", "senkrecht", "spol"]) && rest[0] != "pol" {
            return Some(Channel::Rs);
        } else if is_any(&["p", "tm", "par", "parallel", "ppol"]) && rest[0] != "pol" {
            return Some(Channel::Rp);
        }
    }
    // I45, I_45, I(45°), Intensity 45 deg, 光强45.
    let is_name = |name: &str| matches!(name, "i" | "int" | "p" | "pol" | "l" | "ch" | "光强" | "强度") || name.starts_with("intens");
    let of = |degrees: f64| {
        let all = [(0.0, Channel::I0), (45.0, Channel::I45), (90.0, Channel::I90), (135.0, Channel::I135)];
        all.iter().find(|(angle, _)| *angle == degrees).map(|(_, channel)| *channel)
    };
    if let Some((degrees, None | Some(Measure::Degrees))) = number
        && words.len() == 1
        && is_name(words[0])
    {
        return of(degrees);
    }
    let digits = stem.trim_start_matches(|letter: char| !letter.is_ascii_digit());
    let name = &stem[..stem.len() - digits.len()];
    (is_name(name) && !digits.is_empty()).then(|| digits.parse().ok().and_then(of)).flatten()
}

/// Row and column of a Mueller element, as the heading counts them, and whether it is its standard
/// deviation.
fn mueller(words: &[String]) -> Option<(u8, u8, bool)> {
    let is_error = |word: &&String| word.len() > 1 && meanings(word).contains(&Word::Error);
    let is_sigma = words.iter().any(|word| is_error(&word));
    let stem: String = words
        .iter()
        .filter(|word| !is_error(word) && !["brdf", "matrix", "element", "norm"].contains(&word.as_str()))
        .map(String::as_str)
        .collect();
    let stem = GLUED_ERRORS.iter().find_map(|mark| stem.strip_suffix(mark)).map_or((stem.as_str(), is_sigma), |stem| (stem, true));
    let digits = ["mueller", "muller", "mm", "m"].iter().find_map(|name| stem.0.strip_prefix(name))?;
    let [row, column] = digits.as_bytes() else { return None };
    let index = |digit: &u8| (b'0'..=b'4').contains(digit).then(|| digit - b'0');
    Some((index(row)?, index(column)?, stem.1))
}

#[cfg(test)]
#[path = "heading_tests.rs"]
mod tests;

//! What the words of a heading mean.

use super::vocabulary::{Word, meanings};
use crate::measurement::{BrdfMeaning, Field};

/// What a column may hold by its heading.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Meaning {
    /// A field.
    Field(Field),
    /// An angle of no particular ray.
    Angle,
    /// A Mueller element by the indices of the heading, and whether it is its standard deviation.
    Mueller { row: u8, column: u8, is_sigma: bool },
    /// Stokes I, Q, U or V, if the others are there.
    Letter(char),
    /// A standard deviation of no particular quantity.
    Sigma,
    /// A value of no particular quantity.
    Value,
    /// Nothing that is known, or known to be nothing that is used.
    Unknown,
}

/// The meaning of the words of a heading, how sure it is, and what a BRDF is.
pub(crate) fn meaning_of(words: &[String]) -> (Meaning, u8, Option<BrdfMeaning>) {
    if let [only] = words
        && let [letter] = only.as_bytes()
        && b"iquv".contains(letter)
    {
        return (Meaning::Letter(char::from(*letter)), 3, None);
    }
    let (strong, rest): (Vec<&String>, Vec<&String>) =
        words.iter().partition(|word| word.len() > 1 && *word != "delta" && meanings(word).contains(&Word::Error));
    if !strong.is_empty() {
        return sigma_of(&rest);
    }
    let found = value_of(&rest);
    // u(DoLP), ΔDoLP, sDoLP.
    if let [first, others @ ..] = &rest[..]
        && matches!(first.as_str(), "u" | "d" | "e" | "s" | "delta")
        && matches!(value_of(others).0, Meaning::Field(Field::Dolp | Field::Brdf))
    {
        return sigma_of(others);
    }
    found
}

/// The standard deviation of what the words mean.
fn sigma_of(words: &[&String]) -> (Meaning, u8, Option<BrdfMeaning>) {
    let (meaning, score, brdf_is) = value_of(words);
    match meaning {
        Meaning::Field(field) => field.sigma().map_or((Meaning::Unknown, 0, None), |sigma| (Meaning::Field(sigma), score, brdf_is)),
        Meaning::Unknown
            if words.iter().all(|word| meanings(word).iter().any(|of| matches!(of, Word::Filler | Word::Value | Word::Degree))) =>
        {
            (Meaning::Sigma, 6, None)
        }
        Meaning::Value => (Meaning::Sigma, 6, None),
        _ => (Meaning::Unknown, 0, None),
    }
}

fn value_of(words: &[&String]) -> (Meaning, u8, Option<BrdfMeaning>) {
    let all: Vec<Vec<Word>> = words.iter().map(|word| meanings(word)).collect();
    let has = |of: Word| all.iter().any(|meanings| meanings.contains(&of));
    let unknown = all.iter().filter(|meanings| meanings.is_empty()).count();
    let (field, plain) = (|field, score| (Meaning::Field(field), score, None), words.iter().map(|word| word.as_str()).collect::<Vec<_>>());
    let certain = |score: u8| if unknown == 0 { score } else { score.saturating_sub(3) };
    // `DoLP R` may be one of three colours.
    let belongs = |meanings: &Vec<Word>| {
        let of_quantity = [
            Word::Polarisation,
            Word::Degree,
            Word::Linear,
            Word::Brdf,
            Word::Reflectance,
            Word::Factor,
            Word::Cosine,
            Word::Filler,
            Word::Value,
            Word::Angle,
        ];
        meanings.iter().any(|of| of_quantity.contains(of))
    };
    let of_quantity = |score: u8| if all.iter().all(belongs) { score } else { score.saturating_sub(3) };
    let (inc, view) = (has(Word::Incidence), has(Word::View) || has(Word::ViewAngle));
    let is_long_polarisation = all.iter().zip(&plain).any(|(meanings, word)| meanings.contains(&Word::Polarisation) && *word != "p");
    if has(Word::Foreign)
        || plain == ["delta"]
        || plain == ["del"]
        || is_long_polarisation && (has(Word::Angle) || has(Word::Azimuth)) && !has(Word::Degree)
    {
        return (Meaning::Unknown, 0, None);
    }
    if has(Word::Azimuth) {
        return match (inc, view) {
            (true, false) => field(Field::PhiI, certain(8)),
            (false, true) => field(Field::PhiR, certain(8)),
            _ => field(Field::Dphi, certain(if has(Word::Difference) { 9 } else { 6 })),
        };
    }
    if is_long_polarisation || plain == ["p"] {
        return field(
            Field::Dolp,
            of_quantity(if plain == ["p"] {
                5
            } else if has(Word::Linear) || plain.contains(&"dolp") {
                9
            } else {
                7
            }),
        );
    }
    if has(Word::Wavelength) {
        return field(Field::Wavelength, certain(8));
    }
    if let Some((score, is)) = brdf_of(&plain, &all) {
        return (Meaning::Field(Field::Brdf), of_quantity(score), is);
    }
    angle_of(&plain, &all, unknown).unwrap_or_else(|| {
        if has(Word::Sample) && !has(Word::Value) {
            field(Field::Set, certain(7))
        } else if has(Word::Mask) {
            field(Field::Masked, certain(8))
        } else if has(Word::Value) && unknown == 0 {
            (Meaning::Value, 4, None)
        } else {
            (Meaning::Unknown, 0, None)
        }
    })
}

/// How sure it is that words mean a BRDF, and which kind; none if they mean none.
fn brdf_of(words: &[&str], all: &[Vec<Word>]) -> Option<(u8, Option<BrdfMeaning>)> {
    let has = |of: Word| all.iter().any(|meanings| meanings.contains(&of));
    if has(Word::Brdf) || words == ["f", "r"] {
        let is = if has(Word::Cosine) {
            BrdfMeaning::BrdfCos
        } else if has(Word::Factor) {
            BrdfMeaning::Factor
        } else {
            BrdfMeaning::Brdf
        };
        return Some((9, Some(is)));
    }
    if has(Word::Factor) && (has(Word::Reflectance) || has(Word::ViewAngle) || words.len() == 1) {
        return Some((8, Some(BrdfMeaning::Factor)));
    }
    let is_incident_alone = has(Word::Incidence) && words.len() == 1;
    (has(Word::Reflectance) && !has(Word::Angle) && !is_incident_alone).then_some((5, None))
}

/// The angle that words mean, if they mean one.
fn angle_of(words: &[&str], all: &[Vec<Word>], unknown: usize) -> Option<(Meaning, u8, Option<BrdfMeaning>)> {
    let has = |of: Word| all.iter().any(|meanings| meanings.contains(&of));
    let is_angle = has(Word::Angle);
    // A letter counts beside an angle alone, and only as the index that it then is.
    let inc = all.iter().zip(words).any(|(meanings, word)| meanings.contains(&Word::Incidence) && (is_angle || word.len() > 2));
    let view = has(Word::View) || is_angle && has(Word::ViewAngle);
    let score = if unknown > 0 { 5 } else { 8 };
    let known = unknown == 0 || is_angle;
    match (inc, view) {
        // Names that mean an angle beside the other one alone.
        _ if matches!(words, ["in" | "alpha"] | ["theta", "1"]) => Some((Meaning::Field(Field::ThetaI), 3, None)),
        _ if matches!(words, ["out" | "beta"] | ["theta", "2"]) => Some((Meaning::Field(Field::ThetaR), 3, None)),
        _ if matches!(words, ["ti"]) => Some((Meaning::Field(Field::ThetaI), 6, None)),
        _ if matches!(words, ["tr" | "tv" | "to"]) => Some((Meaning::Field(Field::ThetaR), 6, None)),
        (true, false) if known => Some((Meaning::Field(Field::ThetaI), score, None)),
        (false, true) if known => Some((Meaning::Field(Field::ThetaR), score, None)),
        (false, false) if is_angle && unknown == 0 && !has(Word::Sample) => Some((Meaning::Angle, 4, None)),
        _ => None,
    }
}

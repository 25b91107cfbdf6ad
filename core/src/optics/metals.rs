//! Tabulated complex refractive indices of metals, several sources side by side: "the" index of copper is not one number.
//!
//! The figures are those of the refractiveindex.info database (public domain, CC0 1.0), 200 to about 2500 nm, in
//! `assets/optical_constants.csv`; its head says how it was made. Every source is cited.
//!
//! Between two samples n and k are interpolated **linearly in wavelength**. Nothing leaves the interval of its neighbours, so that
//! n, k ≥ 0 holds everywhere and neither noise nor an interband edge makes a ripple; k of a free-electron metal is itself linear in
//! wavelength. With every other sample left out, the line misses the ones left out by 0.8 % (mean over the tables of the median; linear in photon energy 1.1 %,
//! monotone cubic 0.6 %), against sources that differ by tens of percent.

use crate::optics::{RefractiveIndex, RefractiveIndexError};
use std::sync::OnceLock;

/// A metal or an alloy with its sources.
#[derive(Debug, Clone, PartialEq)]
pub struct Metal {
    /// Short name: the chemical symbol, or that of the alloy.
    pub key: String,
    /// Name in words.
    pub name: String,
    /// Who measured it, at least one.
    pub sources: Vec<MetalSource>,
}

/// One table of a metal's index.
#[derive(Debug, Clone, PartialEq)]
pub struct MetalSource {
    /// Short name, unique within the metal.
    pub key: String,
    /// Authors and year.
    pub name: String,
    /// Where it was published.
    pub citation: String,
    /// What is said of sample and method; may be empty.
    pub comment: String,
    /// Samples by ascending wavelength, at least one.
    samples: Vec<Sample>,
}

/// The index at one wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Vacuum wavelength in nm.
    pub wavelength_nm: f64,
    /// n + i k_m.
    pub index: RefractiveIndex,
}

/// A wavelength that a source says nothing about.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{wavelength_nm} nm is outside the tabulated range, {} to {} nm", .range_nm.0, .range_nm.1)]
pub struct OutsideRange {
    /// What was asked for, in nm.
    pub wavelength_nm: f64,
    /// First and last tabulated wavelength in nm.
    pub range_nm: (f64, f64),
}

/// Why a table of metals cannot be read.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("line {line}: {kind}")]
pub struct MetalsError {
    /// Line from 1.
    pub line: usize,
    /// What is wrong there.
    pub kind: MetalsErrorKind,
}

/// What is wrong with a table of metals.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MetalsErrorKind {
    /// Not the header that stands before the samples.
    #[error("found {found:?}, expected the header {HEADER}")]
    Header {
        /// What stands there.
        found: String,
    },
    /// A `# metal:` or `# source:` line with too few or too many parts.
    #[error("found {found} parts between bars, expected {expected}")]
    Parts {
        /// How many.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// A source that belongs to no metal above it, or whose name has no metal in it.
    #[error("the source {found:?} belongs to no metal named above it")]
    StrayHead {
        /// Its name.
        found: String,
    },
    /// A metal or source named twice.
    #[error("{found:?} is named twice")]
    Repeated {
        /// Its name.
        found: String,
    },
    /// A row of another length.
    #[error("found {found} cells, expected 4")]
    Cells {
        /// How many.
        found: usize,
    },
    /// A row of a source that was never named.
    #[error("the source {found:?} is not named in the head of the table")]
    UnknownSource {
        /// Its name.
        found: String,
    },
    /// Text in place of a number, or a number that is not finite.
    #[error("column {column}: found {found:?}, expected a finite number")]
    Number {
        /// Name of the column.
        column: &'static str,
        /// The cell.
        found: String,
    },
    /// Wavelengths that do not ascend from above 0.
    #[error("wavelengths must ascend from above 0 within a source: found {found} nm after {before} nm")]
    Wavelength {
        /// The wavelength in nm.
        found: f64,
        /// The one before in nm.
        before: f64,
    },
    /// Numbers that are no index.
    #[error(transparent)]
    Index(#[from] RefractiveIndexError),
    /// A source without a sample.
    #[error("the source {0:?} has no samples")]
    NoSamples(String),
    /// Not a single metal.
    #[error("there is no metal in the table")]
    Empty,
}

/// The line before the samples.
const HEADER: &str = "source,wavelength_nm,n,k";

/// The bundled metals; read at the first call.
///
/// # Errors
///
/// [`MetalsError`] where the table of the build is damaged, which a test rules out.
pub fn metals() -> Result<&'static [Metal], MetalsError> {
    static METALS: OnceLock<Result<Vec<Metal>, MetalsError>> = OnceLock::new();
    METALS.get_or_init(|| read_metals(include_str!("../../assets/optical_constants.csv"))).as_deref().map_err(Clone::clone)
}

/// The bundled metal of that key or name, capitals or not.
///
/// # Errors
///
/// As [`metals`].
pub fn metal(name: &str) -> Result<Option<&'static Metal>, MetalsError> {
    let is_it = |metal: &&Metal| metal.key.eq_ignore_ascii_case(name) || metal.name.eq_ignore_ascii_case(name);
    Ok(metals()?.iter().find(is_it))
}

/// The bundled metal that a text names as a word: its symbol as it is written, or its name, capitals or not. Of several the one named first.
///
/// # Errors
///
/// As [`metals`].
pub fn metal_named_in(text: &str) -> Result<Option<&'static Metal>, MetalsError> {
    let words = |text: &str| -> Vec<String> {
        text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).map(str::to_owned).collect()
    };
    let lower = |words: &[String]| -> Vec<String> {
        let spelt = |word: &String| if word == "aluminum" { "aluminium".to_owned() } else { word.clone() };
        words.iter().map(|word| spelt(&word.to_lowercase())).collect()
    };
    let said = words(text);
    let said_lower = lower(&said);
    let place = |metal: &Metal| {
        let symbol = said.iter().position(|word| *word == metal.key);
        let name = lower(&words(&metal.name));
        let name = said_lower.windows(name.len().max(1)).position(|window| window == name);
        symbol.into_iter().chain(name).min()
    };
    Ok(metals()?.iter().filter_map(|metal| Some((place(metal)?, metal))).min_by_key(|(place, _)| *place).map(|(_, metal)| metal))
}

/// Reads a table of metals: `# metal: key | name` and `# source: metal/key | name | citation | comment` lines, the header
/// `source,wavelength_nm,n,k`, and a row per sample, by source and ascending wavelength in nm. Other `#` lines are comments.
///
/// # Errors
///
/// [`MetalsError`] with the line that has another form.
pub fn read_metals(text: &str) -> Result<Vec<Metal>, MetalsError> {
    let mut metals: Vec<Metal> = Vec::new();
    let mut header_seen = false;
    let mut place = (0, 0);
    let mut last = 1;
    for (line, text) in (1..).zip(text.lines()) {
        last = line;
        let result = if let Some(rest) = text.strip_prefix("# metal:") {
            metal_head(rest, &mut metals)
        } else if let Some(rest) = text.strip_prefix("# source:") {
            source_head(rest, &mut metals)
        } else if text.starts_with('#') || text.is_empty() {
            Ok(())
        } else if !header_seen {
            header_seen = true;
            if text == HEADER { Ok(()) } else { Err(MetalsErrorKind::Header { found: text.to_owned() }) }
        } else {
            sample(text, &mut metals, &mut place)
        };
        result.map_err(|kind| MetalsError { line, kind })?;
    }
    let at_end = |kind| Err(MetalsError { line: last, kind });
    for metal in &metals {
        if let Some(source) = metal.sources.iter().find(|source| source.samples.is_empty()) {
            return at_end(MetalsErrorKind::NoSamples(full_name(metal, source)));
        }
        if metal.sources.is_empty() {
            return at_end(MetalsErrorKind::NoSamples(metal.key.clone()));
        }
    }
    if metals.is_empty() { at_end(MetalsErrorKind::Empty) } else { Ok(metals) }
}

fn full_name(metal: &Metal, source: &MetalSource) -> String {
    format!("{}/{}", metal.key, source.key)
}

/// The parts between bars, exactly so many.
fn parts<const N: usize>(text: &str) -> Result<[String; N], MetalsErrorKind> {
    let parts: Vec<String> = text.split('|').map(|part| part.trim().to_owned()).collect();
    parts.try_into().map_err(|parts: Vec<String>| MetalsErrorKind::Parts { found: parts.len(), expected: N })
}

fn metal_head(text: &str, metals: &mut Vec<Metal>) -> Result<(), MetalsErrorKind> {
    let [key, name] = parts(text)?;
    if metals.iter().any(|metal| metal.key == key) {
        return Err(MetalsErrorKind::Repeated { found: key });
    }
    metals.push(Metal { key, name, sources: Vec::new() });
    Ok(())
}

fn source_head(text: &str, metals: &mut [Metal]) -> Result<(), MetalsErrorKind> {
    let [full, name, citation, comment] = parts(text)?;
    let named = full.split_once('/').and_then(|(metal, key)| Some((metals.iter_mut().find(|known| known.key == metal)?, key)));
    let Some((metal, key)) = named else {
        return Err(MetalsErrorKind::StrayHead { found: full });
    };
    if metal.sources.iter().any(|source| source.key == key) {
        return Err(MetalsErrorKind::Repeated { found: full });
    }
    metal.sources.push(MetalSource { key: key.to_owned(), name, citation, comment, samples: Vec::new() });
    Ok(())
}

/// Adds a row to its source; `place` is where the row before went, since rows of a source stand together.
fn sample(text: &str, metals: &mut [Metal], place: &mut (usize, usize)) -> Result<(), MetalsErrorKind> {
    let cells: Vec<&str> = text.split(',').collect();
    let [full, wavelength, n, k] = cells[..] else {
        return Err(MetalsErrorKind::Cells { found: cells.len() });
    };
    if !is_source(metals, *place, full) {
        let all = metals.iter().enumerate().flat_map(|(m, metal)| (0..metal.sources.len()).map(move |s| (m, s)));
        let found = all.into_iter().find(|&at| is_source(metals, at, full));
        *place = found.ok_or_else(|| MetalsErrorKind::UnknownSource { found: full.to_owned() })?;
    }
    let wavelength_nm = number("wavelength_nm", wavelength)?;
    let index = RefractiveIndex::new(number("n", n)?, number("k", k)?)?;
    let samples = &mut metals[place.0].sources[place.1].samples;
    let before = samples.last().map_or(0.0, |sample| sample.wavelength_nm);
    if wavelength_nm <= before {
        return Err(MetalsErrorKind::Wavelength { found: wavelength_nm, before });
    }
    samples.push(Sample { wavelength_nm, index });
    Ok(())
}

/// Whether the source at that place has that full name.
fn is_source(metals: &[Metal], (m, s): (usize, usize), full: &str) -> bool {
    let at = metals.get(m).and_then(|metal| Some((metal.key.as_str(), metal.sources.get(s)?.key.as_str())));
    at.is_some() && at == full.split_once('/')
}

fn number(column: &'static str, cell: &str) -> Result<f64, MetalsErrorKind> {
    let number = cell.trim().parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| MetalsErrorKind::Number { column, found: cell.to_owned() })
}

impl Metal {
    /// The source of that key, capitals or not.
    #[must_use]
    pub fn source(&self, key: &str) -> Option<&MetalSource> {
        self.sources.iter().find(|source| source.key.eq_ignore_ascii_case(key))
    }

    /// From the shortest to the longest wavelength in nm that any source speaks of.
    #[must_use]
    pub fn range_nm(&self) -> (f64, f64) {
        let ranges = self.sources.iter().map(MetalSource::range_nm);
        ranges.fold((f64::INFINITY, 0.0), |(low, high), range| (low.min(range.0), high.max(range.1)))
    }
}

impl MetalSource {
    /// Samples by ascending wavelength, at least one.
    #[must_use]
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// First and last tabulated wavelength in nm.
    #[must_use]
    pub fn range_nm(&self) -> (f64, f64) {
        let at = |sample: Option<&Sample>| sample.map_or(f64::NAN, |sample| sample.wavelength_nm);
        (at(self.samples.first()), at(self.samples.last()))
    }

    /// The index at a vacuum wavelength in nm, linear between its neighbours; the tabulated one at a sample.
    ///
    /// # Errors
    ///
    /// [`OutsideRange`] where the wavelength lies outside the tabulated range.
    pub fn index_at(&self, wavelength_nm: f64) -> Result<RefractiveIndex, OutsideRange> {
        let outside = || OutsideRange { wavelength_nm, range_nm: self.range_nm() };
        let above = self.samples.partition_point(|sample| sample.wavelength_nm < wavelength_nm);
        let high = self.samples.get(above).ok_or_else(outside)?;
        if high.wavelength_nm == wavelength_nm {
            return Ok(high.index);
        }
        let low = above.checked_sub(1).and_then(|below| self.samples.get(below)).ok_or_else(outside)?;
        let share = (wavelength_nm - low.wavelength_nm) / (high.wavelength_nm - low.wavelength_nm);
        let between = |a: f64, b: f64| (1.0 - share) * a + share * b;
        let (n, k) = (between(low.index.n(), high.index.n()), between(low.index.k_m(), high.index.k_m()));
        // Fails for no wavelength between two samples; for NaN, which lies nowhere.
        RefractiveIndex::new(n, k).map_err(|_| outside())
    }
}

#[cfg(test)]
mod tests {
    use super::{MetalsErrorKind, RefractiveIndex, metal, metal_named_in, metals, read_metals};

    const HEAD: &str = "# metal: X | ex\n# source: X/A | A 1999 | J. 1, 2 | film\nsource,wavelength_nm,n,k\n";

    #[test]
    fn every_bundled_source_is_cited_and_spans_a_range() {
        let metals = metals().expect("the bundled table is whole");
        let keys: Vec<&str> = metals.iter().map(|metal| metal.key.as_str()).collect();
        assert_eq!(keys, ["Ag", "Al", "Au", "Co", "Cr", "Cu", "Fe", "Mo", "Ni", "Pt", "Ti", "W", "stainless-steel", "brass"]);
        for metal in metals {
            assert!(metal.sources.len() >= 2, "{}", metal.key);
            for source in &metal.sources {
                let (low, high) = source.range_nm();
                assert!(!source.citation.is_empty() && !source.name.is_empty() && low < high, "{}/{}", metal.key, source.key);
                assert!(source.index_at(low).is_ok() && source.index_at(high).is_ok() && source.index_at(0.5 * (low + high)).is_ok());
                for outside in [low.next_down(), high.next_up(), 0.0, -1.0, f64::NAN, f64::INFINITY] {
                    let error = source.index_at(outside).expect_err("outside").to_string();
                    assert!(error.contains("outside the tabulated range") && error.contains(&low.to_string()), "{error}");
                }
            }
        }
    }

    #[test]
    fn the_index_is_linear_between_samples_and_exact_at_them() {
        let metals = read_metals(&format!("{HEAD}X/A,400,1,2\nX/A,500,2,6\n")).expect("a table");
        let at = |wavelength| metals[0].sources[0].index_at(wavelength).map(|index| (index.n(), index.k_m()));
        assert_eq!((at(400.0), at(425.0), at(500.0)), (Ok((1.0, 2.0)), Ok((1.25, 3.0)), Ok((2.0, 6.0))));
    }

    #[test]
    fn copper_is_not_one_number() {
        let copper = metal("copper").expect("the bundled table is whole").expect("copper");
        assert_eq!(copper.key, "Cu");
        let n: Vec<f64> = copper.sources.iter().filter_map(|source| source.index_at(650.0).ok()).map(RefractiveIndex::n).collect();
        let (low, high) = (n.iter().copied().fold(f64::INFINITY, f64::min), n.iter().copied().fold(0.0, f64::max));
        // The sources of the database at 650 nm, as published: n from 0.09 to 0.50.
        assert!(n.len() >= 6 && low < 0.12 && high > 0.4, "{n:?}");
    }

    #[test]
    fn a_metal_is_known_by_a_word_that_names_it() {
        for (text, expected) in [
            ("Cu", Some("Cu")),
            ("Al 6061", Some("Al")),
            ("rolled aluminum, 150 nm coat", Some("Al")),
            ("Copper plate", Some("Cu")),
            ("Al-1%Si", Some("Al")),
            ("Stainless steel 316L", Some("stainless-steel")),
            ("gold on chromium", Some("Au")),
            ("Ta", None),
            ("45# steel", None),
            ("TiN", None),
            ("goldenrod", None),
            ("the w in a word", None),
            ("", None),
        ] {
            let found = metal_named_in(text).expect("the bundled table is whole");
            assert_eq!(found.map(|metal| metal.key.as_str()), expected, "{text:?}");
        }
    }

    #[test]
    fn a_damaged_table_is_refused_with_line_and_cause() {
        for (text, line, part) in [
            ("", 1, "no metal"),
            ("# metal: X\n", 1, "1 parts"),
            ("# source: X/A | a | b | c\n", 1, "belongs to no metal"),
            ("# metal: X | x\n# metal: X | y\n", 2, "twice"),
            ("# metal: X | x\nsource,n,k\n", 2, "expected the header"),
            ("# metal: X | x\n", 1, "no samples"),
            (HEAD, 3, "no samples"),
            (&format!("{HEAD}X/A,400,1\n"), 4, "3 cells"),
            (&format!("{HEAD}X/B,400,1,2\n"), 4, "not named"),
            (&format!("{HEAD}X/A,400,1,two\n"), 4, "column k: found \"two\""),
            (&format!("{HEAD}X/A,400,NaN,2\n"), 4, "column n: found \"NaN\""),
            (&format!("{HEAD}X/A,400,-1,2\n"), 4, "n = -1"),
            (&format!("{HEAD}X/A,0,1,2\n"), 4, "ascend"),
            (&format!("{HEAD}X/A,400,1,2\nX/A,400,1,2\n"), 5, "ascend"),
        ] {
            let error = read_metals(text).expect_err(text);
            assert!(error.line == line && error.to_string().contains(part), "{text:?}: {error}");
        }
        let twice = format!("{HEAD}X/A,400,1,2\n").replace("| film\n", "| film\n# source: X/A | A | B | C\n");
        assert_eq!(read_metals(&twice).map_err(|error| error.kind), Err(MetalsErrorKind::Repeated { found: "X/A".to_owned() }));
    }
}

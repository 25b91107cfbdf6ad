//! Words of headers, titles and units in English, German and Chinese, and their meaning.

/// A unit of measure as headers and cells write it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Measure {
    Degrees,
    Radians,
    Percent,
    PerSteradian,
    Nanometers,
    Micrometers,
    Angstroms,
    /// A pure number, counts, seconds: nothing that is converted.
    Other,
}

const MEASURES: &[(Measure, &[&str])] = &[
    (Measure::Degrees, &["°", "º", "deg", "degs", "degree", "degrees", "grad", "度", "deg.", "altgrad"]),
    (Measure::Radians, &["rad", "rads", "radian", "radians", "bogenmass", "radiant", "弧度"]),
    (Measure::Percent, &["%", "percent", "prozent", "pct", "百分比", "％", "proz", "in %"]),
    (
        Measure::PerSteradian,
        &["1/sr", "sr-1", "sr^-1", "/sr", "sr^{-1}", "sr**-1", "1/ sr", "1 / sr", "每球面度", "per sr", "inverse steradian", "sr"],
    ),
    (Measure::Nanometers, &["nm", "nanometer", "nanometers", "纳米"]),
    (Measure::Micrometers, &["um", "µm", "μm", "micron", "microns", "micrometer", "微米"]),
    (Measure::Angstroms, &["å", "angstrom", "angstroms", "ang"]),
    (
        Measure::Other,
        &[
            "1",
            "-",
            "--",
            "–",
            "a.u.",
            "au",
            "arb.",
            "arb. u.",
            "arb.u.",
            "a. u.",
            "w.e.",
            "counts",
            "cts",
            "s",
            "ms",
            "mm",
            "fraction",
            "frac",
            "dimensionless",
            "none",
            "ratio",
            "v",
            "mv",
            "k",
            "°c",
            "nw",
            "mw",
            "w",
            "dn",
            "adu",
            "text",
            "0-1",
            "0..1",
            "0…1",
            "h",
            "无",
            "hz",
            "min",
            "sec",
            "任意单位",
            "n/a",
            "unitless",
            "w/m2",
            "w/m²",
            "m",
            "bool",
            "no.",
            "#",
            "℃",
            "date",
            "time",
        ],
    ),
];

/// The unit that a text is; none for other texts.
pub(crate) fn measure(text: &str) -> Option<Measure> {
    let text = text.trim().trim_matches(['[', ']', '(', ')', '{', '}', '（', '）', '【', '】']).trim();
    if text.is_empty() || text.len() > 24 {
        return None;
    }
    let text = text.to_lowercase().replace("⁻¹", "-1").replace('ß', "ss");
    MEASURES.iter().find(|(_, names)| names.contains(&text.as_str())).map(|(measure, _)| *measure)
}

/// Small letters, Greek letters and special signs by name, full-width signs as ASCII, one blank
/// before a capital that begins a word.
pub(crate) fn normalised(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 8);
    let mut before = ' ';
    let text = text.replace("+/-", "±").replace("+-", "±");
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        let begins_word = letter.is_ascii_uppercase()
            && before.is_ascii_lowercase()
            && letters.peek().is_some_and(char::is_ascii_lowercase)
            && !out.ends_with("do");
        if begins_word {
            out.push(' ');
        }
        match letter {
            'θ' | 'ϑ' | 'Θ' => out.push_str(" theta "),
            'φ' | 'ϕ' | 'Φ' => out.push_str(" phi "),
            'ψ' | 'Ψ' => out.push_str(" psi "),
            'Δ' | '∆' | 'δ' => out.push_str(" delta "),
            'σ' | 'Σ' => out.push_str(" sigma "),
            'λ' | 'Λ' => out.push_str(" lambda "),
            'α' => out.push_str(" alpha "),
            'β' => out.push_str(" beta "),
            '±' => out.push_str(" pm "),
            'ä' | 'Ä' => out.push('a'),
            'ö' | 'Ö' => out.push('o'),
            'ü' | 'Ü' => out.push('u'),
            'ß' => out.push_str("ss"),
            'ᵢ' => out.push_str(" i"),
            'ᵣ' => out.push_str(" r"),
            'ᵥ' => out.push_str(" v"),
            'ₛ' => out.push_str(" s"),
            'ₚ' => out.push_str(" p"),
            '₀'..='₉' => out.push(char::from_digit(letter as u32 - '₀' as u32, 10).unwrap_or('0')),
            '⊥' => out.push_str(" perp"),
            '∥' | '‖' => out.push_str(" par"),
            '·' | '×' | '⋅' | '*' => out.push(' '),
            // Full-width forms of ASCII.
            '\u{ff01}'..='\u{ff5e}' => out.extend(char::from_u32(letter as u32 - 0xfee0).map(|letter| letter.to_ascii_lowercase())),
            _ => out.extend(letter.to_lowercase()),
        }
        before = letter;
    }
    out
}

/// Words of letters and digits; Chinese and Latin letters are parted.
pub(crate) fn words(normalised: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut kind = 0;
    for letter in normalised.chars() {
        let now = match letter {
            _ if letter.is_ascii_alphanumeric() => 1,
            _ if letter.is_alphanumeric() => 2,
            _ => 0,
        };
        match words.last_mut() {
            Some(word) if now == kind && now != 0 => word.push(letter),
            _ if now != 0 => words.push(letter.to_string()),
            _ => {}
        }
        kind = now;
    }
    words
}

/// What a word says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Word {
    Incidence,
    View,
    /// Means view beside a word for an angle alone.
    ViewAngle,
    Angle,
    Azimuth,
    Difference,
    Polarisation,
    Degree,
    Linear,
    Brdf,
    Reflectance,
    Factor,
    Cosine,
    Error,
    Wavelength,
    Sample,
    Mask,
    Value,
    /// Says that the column is none of the quantities: an analyser, a time, an angle of polarisation.
    Foreign,
    Filler,
}

/// Words by how they begin, the first that fits.
const BEGINNINGS: &[(Word, &[&str])] = &[
    (
        Word::Foreign,
        &["polarizer", "polariser", "polarisator", "analy", "ellipticity", "circular", "aolp", "dolcp", "docp", "retard", "depol"],
    ),
    (Word::Incidence, &["incid", "incom", "einfall", "einstrahl", "illum", "beleucht", "lichtquelle", "solar", "irradiation"]),
    (
        Word::View,
        &[
            "view",
            "observ",
            "betracht",
            "beobacht",
            "ausfall",
            "emerg",
            "outgo",
            "blickwinkel",
            "sichtwinkel",
            "detektorwinkel",
            "messwinkel",
            "kamerawinkel",
            "streuwinkel",
            "austrittswinkel",
            "reflexionswinkel",
            "remissionswinkel",
            "ausstrahl",
            "abstrahl",
            "empfanger",
        ],
    ),
    (
        Word::Error,
        &[
            "error",
            "err",
            "std",
            "stdev",
            "stddev",
            "standardabw",
            "stabw",
            "uncert",
            "unsicher",
            "fehler",
            "messunsich",
            "messfehler",
            "deviat",
        ],
    ),
    (
        Word::ViewAngle,
        &[
            "detect",
            "detekt",
            "receiv",
            "emission",
            "emit",
            "exit",
            "scatter",
            "streu",
            "austritt",
            "camera",
            "kamera",
            "sensor",
            "measur",
            "mess",
            "reflect",
            "reflex",
            "reflekt",
            "departure",
            "goniometer",
            "arm",
        ],
    ),
    (Word::Azimuth, &["azim", "phi", "raa", "relaz"]),
    (Word::Polarisation, &["polari", "dolp", "linpol"]),
    (Word::Angle, &["angle", "winkel", "theta", "zenit", "polar", "zenith"]),
    (Word::Brdf, &["brdf", "bsdf", "bidirectional", "bidirektional"]),
    (Word::Factor, &["factor", "faktor", "coefficient"]),
    (Word::Cosine, &["cos"]),
    (Word::Wavelength, &["wavel", "wellenl", "lambda"]),
    (Word::Sample, &["sampl", "probe", "proben", "specim", "materia", "muster", "werkstoff"]),
    (Word::Mask, &["mask", "exclu", "reject", "outlier", "ausgeschl"]),
];

/// Whole words.
const WORDS: &[(Word, &[&str])] = &[
    (Word::Incidence, &["aoi", "inc", "in", "i", "ein", "source", "lamp", "quelle", "licht", "sun", "sza", "vonlicht", "e", "aoin"]),
    (Word::View, &["view", "viewing", "vza", "vz", "va", "aov", "aor", "obs", "det", "detector", "detektor", "reception"]),
    (Word::ViewAngle, &["r", "v", "s", "o", "out", "refl", "rec", "aus", "re", "detector", "reflected", "reflection", "exitance"]),
    (Word::Angle, &["th", "ang", "tilt"]),
    (Word::Azimuth, &["az", "raa"]),
    (Word::Difference, &["delta", "d", "rel", "relative", "relativer", "relativ", "diff", "difference", "differenz"]),
    (Word::Polarisation, &["dolp", "dlp", "dop", "pol", "polarisationsgrad", "polarisierungsgrad", "p", "plin", "lpd", "pg"]),
    (Word::Degree, &["degree", "deg", "grad", "fraction", "anteil", "amount"]),
    (Word::Linear, &["linear", "lin", "linearer", "lineare", "linearen"]),
    (Word::Brdf, &["fr", "rbrdf"]),
    (
        Word::Reflectance,
        &["reflectance", "reflectivity", "reflexionsgrad", "reflektanz", "reflexion", "remission", "radiance", "remissionsgrad", "refl"],
    ),
    (Word::Factor, &["brf", "hdrf", "reflexionsfaktor", "reflektanzfaktor", "remissionsfaktor", "strahldichtefaktor"]),
    (
        Word::Error,
        &["sigma", "sd", "unc", "se", "sem", "rms", "pm", "u", "stdabw", "abw", "delta", "e", "s", "dev", "sigm", "streuung", "abweichung"],
    ),
    (Word::Wavelength, &["wl", "wave", "nm", "wvl", "wln"]),
    (Word::Sample, &["sample", "set", "name", "target", "surface", "piece", "oberflache", "specimen"]),
    (Word::Mask, &["masked", "mask", "excluded"]),
    (Word::Value, &["value", "wert", "messwert", "data", "result", "ergebnis", "reading", "y", "val"]),
    (Word::Foreign, &["aop", "aolp", "dolpangle", "evpa", "aodop"]),
    (
        Word::Filler,
        &[
            "of",
            "the",
            "der",
            "des",
            "von",
            "zum",
            "zur",
            "and",
            "normal",
            "to",
            "from",
            "surface",
            "gegen",
            "lot",
            "ray",
            "beam",
            "direction",
            "light",
            "richtung",
            "strahl",
            "measured",
            "gemessen",
            "mean",
            "mittel",
            "mittlerer",
            "average",
            "avg",
            "total",
            "abs",
            "dir",
            "x",
            "rel",
            "at",
            "bei",
            "for",
            "with",
            "no",
            "nr",
            "number",
            "id",
            "col",
            "exp",
            "vs",
            "per",
        ],
    ),
];

/// Parts of Chinese words.
const CHINESE: &[(Word, &[&str])] = &[
    (Word::Foreign, &["偏振角", "圆偏振", "检偏", "起偏", "偏振片", "时间", "温度"]),
    (Word::Error, &["误差", "标准差", "标准偏差", "不确定度", "均方差", "偏差"]),
    (Word::Azimuth, &["方位"]),
    (Word::Difference, &["相对", "差"]),
    (Word::Incidence, &["入射", "光源", "照明", "照射", "太阳"]),
    (Word::View, &["观", "探测", "反射角", "出射", "接收", "相机", "散射角", "视角", "检测", "反射天顶"]),
    (Word::Polarisation, &["偏振"]),
    (Word::Linear, &["线"]),
    (Word::Factor, &["因子", "系数"]),
    (Word::Brdf, &["双向反射", "双向散射"]),
    (Word::Reflectance, &["反射率", "反射比", "辐亮度", "反射因"]),
    (Word::Cosine, &["余弦"]),
    (Word::Wavelength, &["波长"]),
    (Word::Sample, &["样品", "样本", "试样", "材料"]),
    (Word::Mask, &["屏蔽", "掩"]),
    (Word::Angle, &["角", "天顶"]),
    (Word::Degree, &["度"]),
    (Word::Value, &["值", "数据"]),
];

/// A Chinese word parted before the word for an error that ends it.
pub(crate) fn before_error(word: &str) -> Option<(&str, &str)> {
    let (_, errors) = CHINESE.iter().find(|(meaning, _)| *meaning == Word::Error)?;
    let error = errors.iter().filter(|error| word.ends_with(**error)).max_by_key(|error| error.len())?;
    let before = &word[..word.len() - error.len()];
    (!before.is_empty()).then(|| (before, &word[before.len()..]))
}

/// All that a word may say; nothing for an unknown one.
pub(crate) fn meanings(word: &str) -> Vec<Word> {
    if !word.is_ascii() {
        return CHINESE.iter().filter(|(_, parts)| parts.iter().any(|part| word.contains(part))).map(|(meaning, _)| *meaning).collect();
    }
    let mut found: Vec<Word> = WORDS.iter().filter(|(_, whole)| whole.contains(&word)).map(|(meaning, _)| *meaning).collect();
    let begins = |beginning: &&str| word.starts_with(*beginning);
    if let Some((meaning, _)) = BEGINNINGS.iter().find(|(_, beginnings)| beginnings.iter().any(begins)) {
        found.push(*meaning);
    }
    // A German compound ends with what it is.
    if word.len() > 6 && word.ends_with("winkel") {
        found.push(Word::Angle);
        let inside = BEGINNINGS.iter().find(|(_, beginnings)| beginnings.iter().any(|beginning| word.contains(beginning)));
        found.extend(inside.map(|(meaning, _)| *meaning));
    }
    if word.ends_with("azimut") || word.ends_with("azimutwinkel") {
        found = vec![Word::Azimuth];
    }
    if word.contains("polarisationswinkel") {
        found = vec![Word::Foreign];
    }
    if word.ends_with("faktor") {
        found.push(Word::Factor);
    }
    if word.starts_with("reflexions") && word.ends_with("grad") {
        found = vec![Word::Reflectance];
    }
    found
}

#[cfg(test)]
mod tests {
    use super::{Measure, Word, meanings, measure, normalised, words};

    #[test]
    fn words_are_cut_at_signs_capitals_and_scripts() {
        for (text, expected) in [
            ("ThetaIn", vec!["theta", "in"]),
            ("DoLP_err", vec!["dolp", "err"]),
            ("θᵢ", vec!["theta", "i"]),
            ("Δφ", vec!["delta", "phi"]),
            ("入射角theta", vec!["入射角", "theta"]),
            ("Größe Ａ１", vec!["grosse", "a1"]),
            ("AngleOfIncidence", vec!["angle", "of", "incidence"]),
        ] {
            assert_eq!(words(&normalised(text)), expected, "{text}");
        }
        assert!(meanings("einfallswinkel").contains(&Word::Incidence) && meanings("einfallswinkel").contains(&Word::Angle));
        assert_eq!((measure("[°]"), measure(" sr⁻¹ "), measure("apples")), (Some(Measure::Degrees), Some(Measure::PerSteradian), None));
    }
}

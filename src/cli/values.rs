//! The values of options: parameters, assignments, intervals, lists and ranges of angles.

use crate::files::{export, picture};
use crate::report::{PictureQuantity, TableFormat};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use pbrdf::fit::posterior::Prior;
use pbrdf::fit::{BrdfResiduals, Intervals, Loss, Weights};
use pbrdf::measurement::{BrdfMeaning, Columns, Field, Mapping, TensorResolution};
use pbrdf::model::{DolpFormula, Lamp, PRESETS, Parameter, ParameterSet, Preset, Shape, assignment_from_text};
use std::path::PathBuf;

/// `n=2`.
pub type Assignment = (Parameter, f64);
/// `n=0.1..5`.
pub type Interval = (Parameter, f64, f64);

/// What is said of a parameter: of all measurements, or of the one that is named, as in `n@B.csv=1.2`.
#[derive(Debug, Clone, PartialEq)]
pub struct Targeted<T> {
    pub parameter: Parameter,
    /// The measurement; all without.
    pub set: Option<String>,
    pub value: T,
}

impl<T> Targeted<T> {
    fn new(set: Option<&str>, parameter: Parameter, value: T) -> Self {
        Self { parameter, set: set.map(|set| set.trim().to_owned()), value }
    }
}

/// What chosen angles are to be good for.
#[derive(Debug, Clone)]
pub enum Criterion {
    /// All free parameters.
    Determinant,
    /// These.
    Variances(Vec<Parameter>),
    /// Telling the first model from the second.
    Tell(&'static Preset, &'static Preset),
}

/// The parameters that each measurement has for itself.
#[derive(Debug, Clone)]
pub enum OwnParameters {
    /// All of the model: separate surfaces.
    All,
    /// These.
    These(ParameterSet),
}

/// Priors of parameters.
#[derive(Debug, Clone)]
pub struct Priors(pub Vec<Targeted<Prior>>);

/// Angles in degrees, in their order.
#[derive(Debug, Clone)]
pub struct Grid(pub Vec<f64>);

/// More points than anybody measures, and still no strain on memory.
const LARGEST_GRID: f64 = 1e6;
/// Rows that a grid of all lists makes at most: some gigabytes of memory and of text.
const MOST_ROWS: usize = 10_000_000;

/// Most nodes of an angle, and of all together, that a tensor is written with.
const MOST_NODES: usize = 2000;
const MOST_MATRICES: usize = 32_000_000;

/// An option of the core by its name on the command line: name, help, value.
type Choice<T> = (&'static str, &'static str, T);

fn choice<T: Copy + Send + Sync + 'static>(choices: &'static [Choice<T>]) -> impl TypedValueParser<Value = T> {
    let names = choices.iter().map(|(name, help, _)| PossibleValue::new(*name).help(*help));
    let value = |name: String| choices.iter().find(|(known, ..)| *known == name).map(|(.., value)| *value).ok_or("no such choice");
    PossibleValuesParser::new(names).try_map(value)
}

/// What divides the residuals.
pub fn weights() -> impl TypedValueParser<Value = Weights> {
    const CHOICES: [Choice<Weights>; 2] =
        [("none", "Nothing: Eq. (18)", Weights::None), ("sigma", "The stated standard deviations: χ²", Weights::Sigma)];
    choice(&CHOICES)
}

/// The form of a table of results.
pub fn table_format() -> impl TypedValueParser<Value = TableFormat> {
    const CHOICES: [Choice<TableFormat>; 3] = [
        ("csv", "For a spreadsheet", TableFormat::Csv),
        ("markdown", "For a text", TableFormat::Markdown),
        ("latex", "For a paper, with the rules of booktabs", TableFormat::Latex),
    ];
    choice(&CHOICES)
}

/// How the uncertainty of the parameters is found.
pub fn intervals() -> impl TypedValueParser<Value = Intervals> {
    const CHOICES: [Choice<Intervals>; 3] = [
        ("profile", "Profile-likelihood intervals; standard errors where they agree", Intervals::Profile),
        ("linear", "Standard errors from the slopes at the solution alone", Intervals::Linear),
        ("none", "Not at all", Intervals::None),
    ];
    choice(&CHOICES)
}

/// How BRDF residuals are formed.
pub fn brdf_residuals() -> impl TypedValueParser<Value = BrdfResiduals> {
    const CHOICES: [Choice<BrdfResiduals>; 3] = [
        ("absolute", "X − Xm", BrdfResiduals::Absolute),
        ("relative", "(X − Xm)/Xm", BrdfResiduals::Relative),
        ("log", "ln X − ln Xm", BrdfResiduals::Log),
    ];
    choice(&CHOICES)
}

/// How a residual counts.
pub fn loss() -> impl TypedValueParser<Value = Loss> {
    const CHOICES: [Choice<Loss>; 3] = [
        ("linear", "By its square", Loss::Squared),
        ("huber", "By its square up to the scale, by its size beyond", Loss::Huber),
        ("soft-l1", "The same with a smooth passage", Loss::SoftL1),
    ];
    choice(&CHOICES)
}

/// Which reading of Eq. (17) predicts DoLP.
pub fn dolp_formula() -> impl TypedValueParser<Value = DolpFormula> {
    const CHOICES: [Choice<DolpFormula>; 2] = [
        ("consistent", "k_s inside the numerator", DolpFormula::Consistent),
        ("printed", "k_s missing, as printed", DolpFormula::AsPrinted),
    ];
    choice(&CHOICES)
}

/// The quantities that are measured.
pub fn columns() -> impl TypedValueParser<Value = Columns> {
    const CHOICES: [Choice<Columns>; 3] =
        [("dolp", "DoLP", Columns::Dolp), ("brdf", "BRDF", Columns::Brdf), ("both", "Both", Columns::Both)];
    choice(&CHOICES)
}

/// What a camera sees.
pub fn shape() -> impl TypedValueParser<Value = Shape> {
    const CHOICES: [Choice<Shape>; 4] = [
        ("sphere", "Of radius 1", Shape::Sphere),
        ("cylinder", "Of radius 1, upright", Shape::Cylinder),
        ("plate", "A square, tilted by 45° to the right", Shape::Plate),
        ("relief", "A rough height field", Shape::Relief),
    ];
    choice(&CHOICES)
}

/// What a picture shows.
pub fn picture_quantity() -> impl TypedValueParser<Value = PictureQuantity> {
    const CHOICES: [Choice<PictureQuantity>; 4] = [
        ("s0", "Radiance", PictureQuantity::S0),
        ("dolp", "Degree of linear polarisation", PictureQuantity::Dolp),
        ("aop", "Angle of polarisation", PictureQuantity::Aop),
        ("analyser", "Radiance through an analyser", PictureQuantity::Analyser),
    ];
    choice(&CHOICES)
}

/// `30,135`: the direction of a lamp.
pub fn lamp(text: &str) -> Result<Lamp, String> {
    let expected = || format!("expected two angles in degrees, such as 30,135, found {text:?}");
    let (polar, azimuth) = text.split_once(',').ok_or_else(expected)?;
    Lamp::new(number(polar)?, number(azimuth)?).map_err(|error| error.to_string())
}

/// Pixels along an edge of a picture.
pub fn picture_size(text: &str) -> Result<usize, String> {
    let size = text.trim().parse::<usize>().ok().filter(|size| (2..=4096).contains(size));
    size.ok_or_else(|| format!("{text:?} is no whole number from 2 to 4096"))
}

/// The name of a file that Stokes vectors are written to.
pub fn stokes_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    picture::stokes_file_kind(&path).map_err(|error| error.to_string()).map(|_| path)
}

/// A preset by its name.
pub fn preset(text: &str) -> Result<&'static Preset, String> {
    Preset::from_key(text).ok_or_else(|| format!("expected one of {}", PRESETS.map(|preset| preset.key).join(", ")))
}

/// `d`, `c:n,k` or `tell:cauchy,gauss`.
pub fn criterion(text: &str) -> Result<Criterion, String> {
    let expected = || format!("expected d, c:n,k or tell:cauchy,gauss, found {text:?}");
    match text.trim().split_once(':') {
        None if text.trim() == "d" => Ok(Criterion::Determinant),
        Some(("c", names)) => names.split(',').map(parameter).collect::<Result<_, _>>().map(Criterion::Variances),
        Some(("tell", models)) => {
            let (one, other) = models.split_once(',').ok_or_else(expected)?;
            Ok(Criterion::Tell(preset(one.trim())?, preset(other.trim())?))
        }
        _ => Err(expected()),
    }
}

/// A parameter by its name.
pub fn parameter(text: &str) -> Result<Parameter, String> {
    Parameter::from_key(text.trim()).ok_or_else(|| format!("{text:?} is no parameter; expected one of {}", Parameter::keys()))
}

/// The first parameter that is named twice.
pub fn twice(names: impl IntoIterator<Item = Parameter>) -> Option<Parameter> {
    let mut seen = ParameterSet::EMPTY;
    names.into_iter().find(|&parameter| {
        let is_known = seen.contains(parameter);
        seen = seen.with(parameter);
        is_known
    })
}

/// A finite number.
pub fn number(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(format!("{text:?} is not a finite number")),
    }
}

/// A finite number of 0 or more.
pub fn not_negative(text: &str) -> Result<f64, String> {
    number(text).and_then(|number| if number >= 0.0 { Ok(number) } else { Err(format!("{text} is negative; expected 0 or more")) })
}

/// A finite number above 0.
pub fn positive(text: &str) -> Result<f64, String> {
    number(text).and_then(|number| if number > 0.0 { Ok(number) } else { Err(format!("{text} is not above 0")) })
}

/// A whole number from 1 to a million.
pub fn count(text: &str) -> Result<usize, String> {
    text.trim()
        .parse::<usize>()
        .ok()
        .filter(|count| (1..=1_000_000).contains(count))
        .ok_or_else(|| format!("{text:?} is no whole number from 1 to 1000000"))
}

/// `name=value`, the value in the parameter's mathematical domain.
pub fn assignment(text: &str) -> Result<Assignment, String> {
    assignment_from_text(text).map_err(|error| error.to_string())
}

/// A whole number from 1 to a hundred.
pub fn chain_count(text: &str) -> Result<usize, String> {
    count(text).ok().filter(|&chains| chains <= 100).ok_or_else(|| format!("{text:?} is no whole number from 1 to 100"))
}

/// `n=normal(2.07,0.1),k=uniform(1,5)`, each name also with `@measurement`.
pub fn priors(text: &str) -> Result<Priors, String> {
    let mut rest = text.trim();
    let mut priors = Vec::new();
    while !rest.is_empty() {
        let end = rest.find(')').map_or(rest.len(), |end| end + 1);
        priors.push(prior(&rest[..end])?);
        rest = rest[end..].trim_start();
        rest = rest.strip_prefix(',').unwrap_or(rest).trim_start();
    }
    let key = |prior: &Targeted<Prior>| (prior.parameter, prior.set.clone());
    if let Some(twice) = priors.iter().enumerate().find_map(|(i, of)| priors[..i].iter().find(|other| key(other) == key(of))) {
        return Err(format!("{} has two priors", twice.parameter.key()));
    }
    // What is said of one measurement overrules what is said of all.
    priors.sort_by_key(|prior: &Targeted<Prior>| prior.set.is_some());
    Ok(Priors(priors))
}

fn prior(text: &str) -> Result<Targeted<Prior>, String> {
    let expected = || format!("expected name=normal(mean,sd), name=uniform(low,high) or name=loguniform(low,high), found {text:?}");
    let (option, set) = without_set(text);
    let (name, prior) = option.split_once('=').ok_or_else(expected)?;
    let (kind, numbers) = prior.split_once('(').ok_or_else(expected)?;
    let (one, other) = numbers.strip_suffix(')').and_then(|numbers| numbers.split_once(',')).ok_or_else(expected)?;
    let (one, other) = (number(one)?, number(other)?);
    let prior = match kind.trim() {
        "normal" => Prior::Normal { mean: one, sd: other },
        "uniform" => Prior::Uniform { low: one, high: other },
        "loguniform" => Prior::LogUniform { low: one, high: other },
        _ => return Err(expected()),
    };
    Ok(Targeted::new(set, parameter(name)?, prior))
}

/// `name` or `name=value`.
pub fn parameter_or_assignment(text: &str) -> Result<(Parameter, Option<f64>), String> {
    if text.contains('=') {
        assignment(text).map(|(parameter, value)| (parameter, Some(value)))
    } else {
        parameter(text).map(|parameter| (parameter, None))
    }
}

/// `n@B.csv=1.2` as `n=1.2` and `B.csv`: an option without its measurement, and the measurement.
fn without_set(text: &str) -> (String, Option<&str>) {
    let (names, value) = text.rsplit_once('=').map_or((text, None), |(names, value)| (names, Some(value)));
    let (name, set) = names.split_once('@').map_or((names, None), |(name, set)| (name, Some(set)));
    (value.map_or_else(|| name.to_owned(), |value| format!("{name}={value}")), set)
}

/// `name=value` or `name@measurement=value`.
pub fn targeted_assignment(text: &str) -> Result<Targeted<f64>, String> {
    let (option, set) = without_set(text);
    assignment(&option).map(|(parameter, value)| Targeted::new(set, parameter, value))
}

/// `name`, `name=value`, and either with `@measurement` after the name.
pub fn targeted_fix(text: &str) -> Result<Targeted<Option<f64>>, String> {
    let (option, set) = without_set(text);
    parameter_or_assignment(&option).map(|(parameter, value)| Targeted::new(set, parameter, value))
}

/// `name` or `name@measurement`.
pub fn targeted_parameter(text: &str) -> Result<Targeted<()>, String> {
    let (name, set) = text.split_once('@').map_or((text, None), |(name, set)| (name, Some(set)));
    parameter(name).map(|parameter| Targeted::new(set, parameter, ()))
}

/// `name=low..high` or `name@measurement=low..high`.
pub fn targeted_interval(text: &str) -> Result<Targeted<(f64, f64)>, String> {
    let (option, set) = without_set(text);
    interval(&option).map(|(parameter, low, high)| Targeted::new(set, parameter, (low, high)))
}

/// The own parameters of measurements: names, or `all`.
pub fn own(text: &str) -> Result<OwnParameters, String> {
    if text.trim() == "all" {
        return Ok(OwnParameters::All);
    }
    text.split(',').map(parameter).collect::<Result<_, _>>().map(OwnParameters::These)
}

/// `name=low..high`.
pub fn interval(text: &str) -> Result<Interval, String> {
    let expected = || format!("expected name=low..high, such as n=0.1..5, found {text:?}");
    let (name, range) = text.split_once('=').ok_or_else(expected)?;
    let (low, high) = range.split_once("..").ok_or_else(expected)?;
    Ok((parameter(name)?, number(low)?, number(high)?))
}

/// `theta_i=AOI,dolp=3:percent`.
pub fn mapping(text: &str) -> Result<Mapping, String> {
    Mapping::from_text(text).map_err(|error| error.to_string())
}

/// One character that separates thousands.
pub fn thousands(text: &str) -> Result<char, String> {
    let mut letters = text.chars();
    match (letters.next(), letters.next()) {
        (Some(letter), None) if !letter.is_alphanumeric() && !"+-".contains(letter) => Ok(letter),
        _ => Err(format!("{text:?} is no thousands separator; expected one character, such as ','")),
    }
}

/// `dolp` or `brdf`.
pub fn wide(text: &str) -> Result<Field, String> {
    match text {
        "dolp" => Ok(Field::Dolp),
        "brdf" => Ok(Field::Brdf),
        _ => Err(format!("{text:?} is neither dolp nor brdf")),
    }
}

/// `brdf`, `brdf-cos` or `factor`.
pub fn brdf_meaning(text: &str) -> Result<BrdfMeaning, String> {
    let found = BrdfMeaning::ALL.iter().find(|(name, _)| *name == text);
    found.map(|(_, meaning)| *meaning).ok_or_else(|| format!("{text:?} is none of brdf, brdf-cos, factor"))
}

/// `73,61,64`: three numbers of nodes.
pub fn resolution(text: &str) -> Result<TensorResolution, String> {
    let expected = || format!("expected three whole numbers from 2 to {MOST_NODES}, such as 73,61,64, found {text:?}");
    let counts: Option<Vec<usize>> =
        text.split(',').map(|part| part.trim().parse().ok().filter(|count| (2..=MOST_NODES).contains(count))).collect();
    let counts = counts.ok_or_else(expected)?;
    let [phi_d, theta_d, theta_h] = counts[..] else { return Err(expected()) };
    if phi_d * theta_d * theta_h > MOST_MATRICES {
        return Err(format!("{text} makes more than {MOST_MATRICES} matrices, a file beyond 2 GB"));
    }
    Ok(TensorResolution { phi_d, theta_d, theta_h })
}

/// `30,40,50` or `20:60:5` (inclusive), or a mixture of both.
pub fn grid(text: &str) -> Result<Grid, String> {
    let mut angles = Vec::new();
    for part in text.split(',') {
        match part.split(':').collect::<Vec<_>>()[..] {
            [angle] => angles.push(number(angle)?),
            [from, to, step] => range(number(from)?, number(to)?, number(step)?, &mut angles)?,
            _ => return Err(format!("{part:?} is neither an angle nor a range from:to:step")),
        }
    }
    Ok(Grid(angles))
}

/// The rows of a grid of those lists.
pub fn row_count(lists: &[&Grid]) -> Result<usize, String> {
    let rows = lists.iter().map(|grid| grid.0.len() as u128).product::<u128>();
    usize::try_from(rows)
        .ok()
        .filter(|&rows| rows <= MOST_ROWS)
        .ok_or_else(|| format!("The lists of angles make {rows} rows, and at most {MOST_ROWS} are allowed; use coarser steps."))
}

fn range(from: f64, to: f64, step: f64, angles: &mut Vec<f64>) -> Result<(), String> {
    let steps = (to - from) / step;
    if !(0.0..LARGEST_GRID).contains(&steps) {
        return Err(if steps >= LARGEST_GRID {
            format!("the range {from}:{to}:{step:e} has more than a million points")
        } else {
            format!("the range {from}:{to}:{step:e} does not lead from its beginning to its end")
        });
    }
    // Inclusive: an end that rounding misses by less than a millionth of a step counts.
    let last = (steps + 1e-6).floor();
    let mut i = 0.0;
    while i <= last {
        angles.push(from + i * step);
        i += 1.0;
    }
    Ok(())
}

/// The name of a file that a report is written to.
pub fn report_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    export::report_kind(&path).map_err(|error| error.to_string()).map(|_| path)
}

/// The name of a file that a figure is written to.
pub fn picture_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    export::picture_kind(&path).map_err(|error| error.to_string()).map(|_| path)
}
#[cfg(test)]
mod tests {
    use super::{Targeted, grid, interval, priors};
    use pbrdf::fit::posterior::Prior;
    use pbrdf::model::Parameter;

    #[test]
    fn grids_are_lists_and_inclusive_ranges() {
        assert_eq!(grid("30,40,50").map(|grid| grid.0), Ok(vec![30.0, 40.0, 50.0]));
        assert_eq!(grid("20:60:20").map(|grid| grid.0), Ok(vec![20.0, 40.0, 60.0]));
        assert_eq!(grid("-10:10:5,30").map(|grid| grid.0), Ok(vec![-10.0, -5.0, 0.0, 5.0, 10.0, 30.0]));
        assert_eq!(grid("0:1:0.1").map(|grid| grid.0.len()), Ok(11));
        for wrong in ["", "a", "1:2", "1:2:0", "2:1:1", "1:2:-1", "0:1:1e-9", "inf", "1:2:3:4"] {
            assert!(grid(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn priors_are_separated_by_the_commas_outside_brackets() {
        let read = priors("n=normal(2.07, 0.1), k=uniform(1,5)").map(|priors| priors.0);
        let (normal, uniform) = (Prior::Normal { mean: 2.07, sd: 0.1 }, Prior::Uniform { low: 1.0, high: 5.0 });
        assert_eq!(read, Ok(vec![Targeted::new(None, Parameter::N, normal), Targeted::new(None, Parameter::K, uniform)]));
        let read = priors("n@B.csv=normal(2.07,0.1),n=uniform(1,5)").map(|priors| priors.0);
        assert_eq!(read, Ok(vec![Targeted::new(None, Parameter::N, uniform), Targeted::new(Some("B.csv"), Parameter::N, normal)]));
        for wrong in [
            "n",
            "n=normal",
            "n=normal(1)",
            "n=normal(1,2",
            "n=cauchy(1,2)",
            "m=normal(1,2)",
            "n=normal(1,x)",
            "n=normal(1,2),n=uniform(1,2)",
        ] {
            assert!(priors(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn intervals_have_two_ends() {
        assert_eq!(interval("c=-1..0"), Ok((Parameter::C, -1.0, 0.0)));
        for wrong in ["c", "c=1", "c=..1", "x=0..1"] {
            assert!(interval(wrong).is_err(), "{wrong}");
        }
    }
}

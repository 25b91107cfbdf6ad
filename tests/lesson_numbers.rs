//! Every number that a bundled lesson states, against the core.
//!
//! A number is right if it is the computed one rounded to the digits that the lesson gives. A lesson
//! states no number with decimals that is neither here nor among its own settings.

#![allow(clippy::expect_used, reason = "a test stops where anything is missing")]
#![allow(clippy::disallowed_methods, reason = "numbers are compared to the few digits of a sentence")]

use pbrdf::fit::{Design, Fit, FitResult, Intervals, NoiseModel};
use pbrdf::measurement::{Columns, Measurement, Simulation, grid_geometries};
use pbrdf::model::{Model, Parameter, Parameters, Pbrdf, Preset};
use pbrdf::optics::{Facet, Geometry, metal};
use std::collections::BTreeMap;
use std::path::Path;

/// Numbers as a lesson says them, with what the core says.
type Claims = Vec<(&'static str, f64)>;

fn model(key: &str) -> Model {
    Preset::from_key(key).expect("a preset").model
}

/// The surface that most lessons begin with.
fn usual() -> Parameters {
    Parameters { n: 2.0, k: 3.0, sigma: 0.3, ks: 1.0, kd: 0.1, kv: 0.1, q: 2.0, c: -0.5, sigma_v: 0.5 }
}

fn surface(key: &str, parameters: Parameters) -> Pbrdf {
    Pbrdf::new(model(key), parameters).expect("a surface")
}

fn facet(theta_i: f64, theta_r: f64, dphi: f64) -> Facet {
    Facet::new(Geometry::new(theta_i, theta_r, dphi).expect("a geometry"))
}

/// In the plane of incidence; a negative θr is the side of the source.
fn in_plane(theta_i: f64, theta_r: f64) -> Facet {
    facet(theta_i, theta_r.abs(), if theta_r < 0.0 { 0.0 } else { 180.0 })
}

fn dolp(key: &str, parameters: Parameters, theta_i: f64, theta_r: f64) -> f64 {
    surface(key, parameters).dolp(&in_plane(theta_i, theta_r))
}

fn brdf(key: &str, parameters: Parameters, theta_i: f64, theta_r: f64) -> f64 {
    surface(key, parameters).reflection(&in_plane(theta_i, theta_r)).brdf
}

/// DoLP of bare facets that are met under β.
fn limit(n: f64, k: f64, beta: f64) -> f64 {
    surface("specular", Parameters { n, k, ..usual() }).fresnel_limit(&in_plane(beta, beta))
}

/// Rs and Rp at an angle, by the textbook.
fn reflectances(n: f64, k: f64, beta: f64) -> (f64, f64) {
    let (cos, sin2) = (beta.to_radians().cos(), beta.to_radians().sin().powi(2));
    let index2 = (n * n - k * k, 2.0 * n * k);
    let root = complex_sqrt((index2.0 - sin2, index2.1));
    let ratio2 = |a: (f64, f64), b: (f64, f64)| (a.0 * a.0 + a.1 * a.1) / (b.0 * b.0 + b.1 * b.1);
    let scaled = (index2.0 * cos, index2.1 * cos);
    let rs = ratio2((cos - root.0, -root.1), (cos + root.0, root.1));
    (rs, ratio2((scaled.0 - root.0, scaled.1 - root.1), (scaled.0 + root.0, scaled.1 + root.1)))
}

fn complex_sqrt((re, im): (f64, f64)) -> (f64, f64) {
    let size = re.hypot(im);
    (f64::midpoint(size, re).max(0.0).sqrt(), f64::midpoint(size, -re).max(0.0).sqrt())
}

/// The angle, to 0.01°, where that is largest.
fn where_largest(of: impl Fn(f64) -> f64) -> f64 {
    let angles = (100..8999).map(|hundredths| f64::from(hundredths) / 100.0);
    angles.max_by(|a, b| of(*a).total_cmp(&of(*b))).expect("angles")
}

/// Where DoLP of bare facets peaks: the second Brewster angle.
fn second_brewster(n: f64, k: f64) -> f64 {
    where_largest(|beta| limit(n, k, beta))
}

/// ψ and Δ in degrees, with Δ = 180° at normal incidence.
fn psi_delta(n: f64, k: f64, beta: f64) -> (f64, f64) {
    let matrix = surface("specular", Parameters { n, k, ..usual() }).mueller_in_facet_plane(&in_plane(beta, beta));
    let m = |row: usize, column: usize| matrix.0[(row, column)] / matrix.0[(0, 0)];
    let psi = 0.5 * m(1, 0).abs().acos().to_degrees();
    (psi, m(2, 3).abs().atan2(m(2, 2)).to_degrees())
}

fn m23(n: f64, k: f64) -> f64 {
    let matrix = surface("specular", Parameters { n, k, ..usual() }).mueller_in_facet_plane(&in_plane(50.0, 50.0));
    matrix.0[(2, 3)] / matrix.0[(0, 0)]
}

fn steel() -> Parameters {
    Parameters { n: 2.07, k: 2.9, sigma: 0.35, ks: 1.0, kd: 0.12, kv: 0.2, q: 2.2, c: -0.4, sigma_v: 0.6 }
}

fn steps(first: i32, last: i32, by: usize) -> Vec<f64> {
    (first..=last).step_by(by).map(f64::from).collect()
}

/// The 27 angles of the paper, and dense ones.
fn angles(dense: bool) -> (Vec<f64>, Vec<f64>) {
    if dense { (steps(10, 80, 10), steps(0, 85, 5)) } else { (steps(30, 50, 10), steps(20, 60, 5)) }
}

fn simulated(parameters: Parameters, dense: bool, seed: u64) -> Measurement {
    let (theta_i, theta_r) = angles(dense);
    let surface = surface("cauchy", parameters);
    let model_name = "cauchy".to_owned();
    let simulation =
        Simulation { model_name, surface, theta_i, theta_r, dphi: 180.0, columns: Columns::Dolp, noise: 0.005, brdf_noise: 0.0, seed };
    simulation.run().expect("angles")
}

fn example() -> Measurement {
    Measurement::read(&include_bytes!("../assets/examples/steel45_simulated.csv")[..]).expect("an example")
}

fn fitted(measurement: &Measurement, key: &str, intervals: Intervals, fixed: &[(Parameter, f64)]) -> FitResult {
    let fit = fixed.iter().fold(Fit::new(measurement, model(key)), |fit, (parameter, value)| fit.fix(*parameter, *value));
    fit.intervals(intervals).run().expect("a fit")
}

fn value(result: &FitResult, parameter: Parameter) -> f64 {
    estimate(result, parameter).value
}

fn estimate(result: &FitResult, parameter: Parameter) -> &pbrdf::fit::Estimate {
    result.estimates.iter().find(|estimate| estimate.parameter == parameter).expect("an estimate")
}

/// The ends of an interval; what is open is NaN, which no claim equals.
fn interval(result: &FitResult, parameter: Parameter) -> [f64; 2] {
    let interval = estimate(result, parameter).interval68.expect("an interval");
    [interval.low.unwrap_or(f64::NAN), interval.high.unwrap_or(f64::NAN)]
}

/// Predicted standard error of a parameter of the steel.
fn predicted(dense: bool, both: bool, parameter: Parameter) -> f64 {
    let (theta_i, theta_r) = angles(dense);
    let geometries = grid_geometries(&theta_i, &theta_r, 180.0).expect("angles");
    let noise = NoiseModel { dolp: Some(0.005), brdf: both.then_some(0.02) };
    let prediction = Design::new(Model::CAUCHY, steel(), geometries, noise).predict().expect("a prediction");
    prediction.errors.iter().find(|(other, _)| *other == parameter).and_then(|(_, error)| *error).expect("an error")
}

fn brewster() -> Claims {
    let peak = |k: f64| (second_brewster(1.5, k), limit(1.5, k, second_brewster(1.5, k)));
    let seen_at = |k: f64| 2.0 * peak(k).0 - 70.0;
    let pseudo = where_largest(|beta| -reflectances(1.5, 1.0, beta).1);
    vec![
        ("56.3", 1.5_f64.atan().to_degrees()),
        ("43", seen_at(0.0)),
        ("46", seen_at(0.5)),
        ("54", seen_at(1.0)),
        ("78", seen_at(3.0)),
        ("0.91", peak(0.5).1),
        ("0.76", peak(1.0).1),
        ("0.42", peak(3.0).1),
        ("62.2", peak(1.0).0),
        ("59.1", pseudo),
        ("0.03", limit(1.24, 6.6, 40.0)),
        ("0.18", limit(1.24, 6.6, 80.0)),
    ]
}

fn forgets() -> Claims {
    let [one, other] = [(1.24, 6.6), (3.0, 10.0054)];
    let both = |beta: f64| [limit(one.0, one.1, beta), limit(other.0, other.1, beta)];
    let apart = |beta: f64| 100.0 * (both(beta)[1] / both(beta)[0] - 1.0);
    vec![
        ("0.048", both(50.0)[0]),
        ("0.049", both(50.0)[1]),
        ("0.086", both(62.5)[0]),
        ("0.090", both(62.5)[1]),
        ("0.178", both(80.0)[0]),
        ("0.236", both(80.0)[1]),
        ("2", apart(50.0)),
        ("5", apart(62.5)),
        ("62.5", f64::midpoint(40.0, 85.0)),
        ("82", second_brewster(one.0, one.1)),
    ]
}

fn tails() -> Claims {
    let lobe = |sigma: f64, q: f64, theta_r: f64| brdf("specular", Parameters { sigma, q, ..usual() }, 40.0, theta_r);
    vec![
        ("0.00049", lobe(0.02, 2.0, -30.0)),
        ("0.0114", lobe(0.1, 2.0, -30.0)),
        ("2.8", lobe(0.02, 2.0, -30.0) / lobe(0.02, 2.0, -60.0)),
        ("2.7", lobe(0.1, 2.0, -30.0) / lobe(0.1, 2.0, -60.0)),
        // The facet between θi = 40° and θr = 90°.
        ("25", f64::midpoint(90.0, -40.0)),
        ("0.324", lobe(0.1, 1.5, 80.0)),
        ("0.235", lobe(0.1, 2.0, 80.0)),
        ("0.062", lobe(0.1, 3.0, 80.0)),
        ("0.0021", lobe(0.1, 5.0, 80.0)),
        ("1.87", lobe(0.1, 1.5, 40.0)),
        ("15.0", lobe(0.1, 5.0, 40.0)),
    ]
}

/// σ of Gauss with the median slope of Cauchy.
fn gauss_of_equal_median(sigma: f64, q: f64) -> f64 {
    let median = std::f64::consts::SQRT_2 * sigma * (2.0_f64.powf(1.0 / (q - 1.0)) - 1.0).sqrt();
    median / (2.0 * std::f64::consts::LN_2).sqrt()
}

fn members() -> Claims {
    let gauss = Parameters { sigma: gauss_of_equal_median(0.3, 2.0), ..usual() };
    let apart = 100.0 * (dolp("cauchy", usual(), 40.0, 40.0) / dolp("gauss", gauss, 40.0, 40.0) - 1.0);
    vec![
        ("0.424", std::f64::consts::SQRT_2 * 0.3),
        ("0.31", gauss_of_equal_median(1.3416, 20.0)),
        ("0.3", 1.3416 / 20.0_f64.sqrt()),
        ("6", apart.floor()),
    ]
}

fn three_angles() -> Claims {
    let free = fitted(&example(), "cauchy", Intervals::Profile, &[]);
    let known = fitted(&example(), "cauchy", Intervals::Profile, &[(Parameter::N, 2.07), (Parameter::K, 2.9)]);
    let (n, sigma) = (interval(&free, Parameter::N), interval(&known, Parameter::Sigma));
    vec![
        ("1.89", value(&free, Parameter::N)),
        ("0.94", n[0]),
        ("5.7", n[1]),
        ("0.64", interval(&free, Parameter::Kd)[1]),
        ("0.29", interval(&known, Parameter::Kd)[1]),
        ("0.17", sigma[0]),
        ("1.04", sigma[1]),
        ("2.8", predicted(false, false, Parameter::N)),
        ("0.018", predicted(true, false, Parameter::N)),
        ("10.7", predicted(false, false, Parameter::Q)),
        ("0.20", predicted(true, false, Parameter::Q)),
        ("0.46", predicted(false, false, Parameter::SigmaV)),
        ("0.053", predicted(true, false, Parameter::SigmaV)),
    ]
}

fn masking() -> Claims {
    let kink = |theta_i: f64| (180.0 + theta_i) / 3.0;
    let unmasked = Pbrdf::new(Model { masking: pbrdf::optics::Masking::None, ..model("specular-gauss") }, usual()).expect("a surface");
    vec![
        ("73", kink(40.0)),
        ("73.3", kink(40.0)),
        ("0.79", brdf("specular-gauss", usual(), 40.0, kink(40.0))),
        ("83", kink(70.0)),
        ("5.8", brdf("specular-gauss", usual(), 70.0, 83.0)),
        ("8.0", brdf("specular-gauss", usual(), 70.0, 89.99)),
        ("40", unmasked.reflection(&in_plane(70.0, 89.0)).brdf),
    ]
}

fn not_reciprocal() -> Claims {
    let at = |theta_i: f64, theta_r: f64| surface("cauchy", usual()).reflection(&in_plane(theta_i, theta_r));
    vec![
        ("0.262", at(20.0, 70.0).brdf),
        ("0.004", at(20.0, 70.0).volume),
        ("0.321", at(70.0, 20.0).brdf),
        ("0.063", at(70.0, 20.0).volume),
        ("0.258", brdf("cauchy", Parameters { kv: 0.0, ..usual() }, 70.0, 20.0)),
    ]
}

fn minnaert() -> Claims {
    let reflectance = |c: f64, theta_i: f64| 2.0 * theta_i.to_radians().cos().powf(c) / (c + 2.0);
    let breach = where_largest(|theta_i| -(0.1 * reflectance(-0.5, theta_i) - 1.0).abs());
    vec![("4.5", reflectance(-0.5, 85.0)), ("89.0", breach)]
}

fn out_of_plane() -> Claims {
    let metal = surface("cauchy", Parameters { n: 1.24, k: 6.6, kd: 0.02, kv: 0.02, ..usual() });
    vec![("0.060", metal.dolp(&facet(50.0, 60.0, 180.0))), ("0.020", metal.dolp(&facet(50.0, 60.0, 90.0)))]
}

fn copper() -> Claims {
    let copper = metal("Cu").expect("the tables").expect("copper");
    let hagemann = copper.sources.iter().find(|source| source.name.contains("Hagemann")).expect("Hagemann");
    let at = |nm: f64| hagemann.index_at(nm).expect("in the table");
    let of = |nm: f64| limit(at(nm).n(), at(nm).k_m(), 60.0);
    let mirror = |nm: f64| ((at(nm).n() - 1.0).powi(2) + at(nm).k_m().powi(2)) / ((at(nm).n() + 1.0).powi(2) + at(nm).k_m().powi(2));
    let indices: Vec<_> = copper.sources.iter().filter_map(|source| source.index_at(650.0).ok()).collect();
    let ends = |of: &dyn Fn(f64, f64) -> f64| {
        let all = indices.iter().map(|index| of(index.n(), index.k_m()));
        all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
    };
    let (n, k, dolp) = (ends(&|n, _| n), ends(&|_, k| k), ends(&|n, k| limit(n, k, 60.0)));
    vec![
        ("0.04", of(650.0)),
        ("0.24", of(560.0)),
        ("0.34", of(450.0)),
        ("0.22", at(650.0).n()),
        ("0.86", at(560.0).n()),
        ("3.64", at(650.0).k_m()),
        ("2.60", at(560.0).k_m()),
        ("0.94", mirror(650.0)),
        ("0.66", mirror(560.0)),
        ("0.09", n.0),
        ("0.50", n.1),
        ("3.4", k.0),
        ("3.8", k.1),
        ("0.02", dolp.0),
        ("0.08", dolp.1),
    ]
}

fn sphere() -> Claims {
    let of = |sigma: f64, theta_i: f64, theta_r: f64| dolp("cauchy", Parameters { sigma, ..usual() }, theta_i, theta_r);
    vec![
        ("0.087", limit(2.0, 3.0, 30.0)),
        ("0.069", of(0.3, 30.0, 30.0)),
        ("0.040", of(0.3, 60.0, 0.0)),
        ("0.058", of(0.3, 0.0, 60.0)),
        ("0.084", of(0.1, 30.0, 30.0)),
        ("0.015", of(0.1, 60.0, 0.0)),
    ]
}

fn analyser() -> Claims {
    let brewster = 1.5_f64.atan().to_degrees();
    let metal = dolp("cauchy", usual(), brewster, brewster);
    let through = |angle: f64| angle.to_radians().cos().powi(2);
    vec![
        ("56.31", brewster),
        ("112.62", 2.0 * brewster),
        ("1", limit(1.5, 0.0, brewster)),
        ("0.75", through(30.0)),
        ("0.25", through(60.0)),
        ("0.301", metal),
        ("0.537", (1.0 - metal) / (1.0 + metal)),
    ]
}

fn ring() -> Claims {
    let radius = |n: f64, k: f64| second_brewster(n, k).to_radians().sin();
    let peak = |k: f64| limit(1.5, k, second_brewster(1.5, k));
    vec![
        ("0.83", radius(1.5, 0.0)),
        ("56.31", second_brewster(1.5, 0.0)),
        ("0.88", radius(1.5, 1.0)),
        ("0.94", radius(1.5, 2.0)),
        ("0.96", radius(1.5, 3.0)),
        ("0.76", peak(1.0)),
        ("0.55", peak(2.0)),
        ("0.42", peak(3.0)),
        ("62.18", second_brewster(1.5, 1.0)),
        ("69.51", second_brewster(1.5, 2.0)),
        ("74.23", second_brewster(1.5, 3.0)),
        ("81.7", second_brewster(1.24, 6.6)),
        ("0.99", radius(1.24, 6.6)),
    ]
}

fn errors_that_lie() -> Claims {
    let linear = fitted(&example(), "cauchy", Intervals::Linear, &[]);
    let profile = fitted(&example(), "cauchy", Intervals::Profile, &[]);
    let other = fitted(&simulated(steel(), false, 2), "cauchy", Intervals::Profile, &[]);
    let (n, again) = (interval(&profile, Parameter::N), interval(&other, Parameter::N));
    assert!(interval(&other, Parameter::Sigma)[1].is_nan(), "σ has no upper end");
    vec![
        ("2.1", estimate(&linear, Parameter::N).std_error.unwrap_or(f64::NAN)),
        ("1.9", value(&linear, Parameter::N)),
        ("0.94", n[0]),
        ("5.7", n[1]),
        ("1.49", value(&other, Parameter::N)),
        ("4e-5", value(&other, Parameter::Kd)),
        ("0.9", again[0]),
        ("8.0", again[1]),
    ]
}

fn six_draws() -> Claims {
    let truth = Parameters { sigma: 0.67, kv: 0.25, ..steel() };
    let fits = |seed: u64| {
        let data = simulated(truth, true, seed);
        ["gauss", "cauchy"].map(|key| fitted(&data, key, Intervals::None, &[]))
    };
    let lead = |[gauss, cauchy]: &[FitResult; 2]| {
        let aicc = |result: &FitResult| result.statistics.aicc.expect("enough data");
        aicc(gauss) - aicc(cauchy)
    };
    let all: Vec<[FitResult; 2]> = (1..=6).map(fits).collect();
    let (first, third, fifth) = (&all[0], &all[2], &all[4]);
    assert!((value(&third[1], Parameter::Q) - 20.0).abs() < 1e-6, "on its bound");
    vec![
        ("3.2", lead(first)),
        ("0.49", value(&first[0], Parameter::Sigma)),
        ("2.4", -lead(third)),
        ("8.6", lead(&all[1])),
        ("6.8", lead(&all[3])),
        ("15.6", lead(fifth)),
        ("6.8", lead(&all[5])),
        ("1.14", value(&fifth[1], Parameter::Q)),
        ("0.03", value(&fifth[1], Parameter::Kd)),
        ("2.06", value(&fifth[1], Parameter::N)),
        ("2.93", value(&fifth[1], Parameter::K)),
    ]
}

fn as_printed() -> Claims {
    let consistent = |ks: f64| dolp("cauchy", Parameters { ks, ..usual() }, 50.0, 50.0);
    let formula = pbrdf::model::DolpFormula::AsPrinted;
    let printed = |ks: f64| {
        let surface = surface("cauchy", Parameters { ks, ..usual() }).with_dolp_formula(formula);
        surface.dolp(&in_plane(50.0, 50.0))
    };
    vec![
        ("0.119", consistent(0.1)),
        ("0.240", consistent(2.0)),
        ("1.187", printed(0.1)),
        ("0.228", printed(1.0)),
        ("0.228", consistent(1.0)),
        ("0.120", printed(2.0)),
    ]
}

fn brdf_column() -> Claims {
    use Parameter::{Ks, N, Q, Sigma};
    vec![
        ("2.8", predicted(false, false, N)),
        ("0.97", predicted(false, false, Sigma)),
        ("10.7", predicted(false, false, Q)),
        ("0.50", predicted(false, true, N)),
        ("0.17", predicted(false, true, Sigma)),
        ("1.9", predicted(false, true, Q)),
        ("0.015", predicted(true, true, N)),
        ("0.0072", predicted(true, true, Sigma)),
        ("0.016", predicted(true, true, Ks)),
        // What the bundled aluminium was simulated with: its head says so.
        ("0.15", 0.15),
    ]
}

fn ellipsometry() -> Claims {
    let [one, other] = [(1.24, 6.6), (3.0, 10.0054)];
    let ((psi, delta), (psi_other, delta_other)) = (psi_delta(one.0, one.1, 50.0), psi_delta(other.0, other.1, 50.0));
    vec![
        ("0.048", limit(one.0, one.1, 50.0)),
        ("0.049", limit(other.0, other.1, 50.0)),
        ("0.261", m23(one.0, one.1)),
        ("0.166", m23(other.0, other.1)),
        ("43.61", psi),
        ("43.58", psi_other),
        ("164.9", delta),
        ("170.4", delta_other),
    ]
}

fn claims() -> Vec<(&'static str, Claims)> {
    vec![
        ("01", brewster()),
        ("02", Vec::new()),
        ("03", forgets()),
        ("04", vec![("0.1347", dolp("cauchy", usual(), 40.0, 40.0))]),
        ("05", tails()),
        ("06", members()),
        ("07", three_angles()),
        ("08", masking()),
        ("09", not_reciprocal()),
        ("10", minnaert()),
        ("11", out_of_plane()),
        ("12", copper()),
        ("13", sphere()),
        ("14", analyser()),
        ("15", ring()),
        ("16", errors_that_lie()),
        ("17", six_draws()),
        ("18", as_printed()),
        ("19", brdf_column()),
        ("20", ellipsometry()),
    ]
}

/// Values that a lesson speaks of as the reader's choice, at which other numbers are computed.
const CHOSEN: [(&str, &str); 2] = [("01", "0.5"), ("10", "0.1")];

/// The lessons by the number at the beginning of their names.
fn lessons() -> BTreeMap<String, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/lessons");
    let entries = std::fs::read_dir(folder).expect("the lessons").map(|entry| entry.expect("an entry").path());
    let lesson = |path: std::path::PathBuf| {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        (name[..2].to_owned(), std::fs::read_to_string(path).expect("a text"))
    };
    entries.map(lesson).collect()
}

/// What a lesson says in a language, and what it sets.
fn parts(text: &str) -> [String; 3] {
    let [mut english, mut chinese, mut set] = [String::new(), String::new(), String::new()];
    for line in text.lines() {
        let part = match line {
            _ if line.starts_with("- ") => &mut set,
            _ if line.starts_with("**") && line.split("**").nth(1).is_some_and(|label| label.ends_with(".zh")) => &mut chinese,
            _ if line.starts_with("**") => &mut english,
            _ => continue,
        };
        part.push_str(line);
        part.push('\n');
    }
    [english, chinese, set]
}

/// The numbers of a text, without signs.
fn numbers(text: &str) -> Vec<String> {
    let mut all = vec![String::new()];
    // Ends of a range are two numbers.
    for c in text.replace("..", " ").chars() {
        let last = all.last_mut().expect("one is there");
        let is_mantissa = c.is_ascii_digit() || (c == '.' && !last.is_empty());
        let is_exponent = c == 'e' && last.chars().any(|c| c.is_ascii_digit());
        if is_mantissa || is_exponent || (c == '-' && last.ends_with('e')) {
            last.push(c);
        } else if !last.is_empty() {
            all.push(String::new());
        }
    }
    all.into_iter().map(|number| number.trim_end_matches(['.', 'e']).to_owned()).filter(|number| !number.is_empty()).collect()
}

/// Half of a unit of the last digit.
fn half_digit(said: &str) -> f64 {
    let (digits, exponent) = said.split_once('e').map_or((said, 0), |(digits, exponent)| (digits, exponent.parse().expect("an exponent")));
    let decimals = digits.split_once('.').map_or(0, |(_, decimals)| i32::try_from(decimals.len()).expect("few digits"));
    0.5 * 10.0_f64.powi(exponent - decimals)
}

#[test]
fn every_number_of_every_lesson_is_what_the_core_says() {
    let lessons = lessons();
    let claims = claims();
    assert_eq!(claims.iter().map(|(lesson, _)| (*lesson).to_owned()).collect::<Vec<_>>(), lessons.keys().cloned().collect::<Vec<_>>());
    let mut faults = Vec::new();
    for (lesson, claims) in claims {
        let [english, chinese, set] = parts(&lessons[lesson]);
        let (said_in_english, said_in_chinese, set) = (numbers(&english), numbers(&chinese), numbers(&set));
        for (said, value) in &claims {
            let stated: f64 = said.parse().expect("a number");
            // Rounding may go either way where a value lies in the middle.
            if (stated - value).abs() > 1.000_001 * half_digit(said) || value.is_nan() {
                faults.push(format!("{lesson}: said {said}, is {value}"));
            }
            for (language, numbers) in [("English", &said_in_english), ("Chinese", &said_in_chinese)] {
                if !numbers.iter().any(|number| number == said) {
                    faults.push(format!("{lesson}: {said} does not stand in the {language} text"));
                }
            }
        }
        let is_known = |number: &String| {
            let same = |other: &String| other.parse::<f64>().ok() == number.parse::<f64>().ok();
            let is_chosen = CHOSEN.contains(&(lesson, number.as_str()));
            is_chosen || claims.iter().any(|(said, _)| said == number) || set.iter().any(same)
        };
        let unknown = said_in_english.iter().chain(&said_in_chinese).filter(|number| number.contains('.') && !is_known(number));
        faults.extend(unknown.map(|number| format!("{lesson}: nothing says that {number} is right")));
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn numbers_are_found_in_texts_and_a_wrong_one_is_seen() {
    assert_eq!(numbers("DoLP is 0.24 at 560 nm; 4e-5, m23/m00 = 0.1."), ["0.24", "560", "4e-5", "23", "00", "0.1"]);
    assert!(
        (half_digit("0.24") - 0.005).abs() < 1e-15 && (half_digit("4e-5") - 0.5e-5).abs() < 1e-18 && (half_digit("73") - 0.5).abs() < 1e-15
    );
}

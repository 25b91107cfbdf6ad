//! The solver on the 27 nonlinear problems of NIST's Statistical Reference Datasets: certified digits from both starts.
#![allow(clippy::expect_used, clippy::print_stdout, reason = "a test fails by panicking, and tells its figures")]

#[path = "common/dual.rs"]
mod dual;

use dual::Dual;
use nalgebra::{DMatrix, DVector};
use pbrdf::fit::{Effort, LeastSquares, Observer, Solution, minimise};
use std::f64::consts::PI;
use std::path::Path;

/// The bar: digits of the worst parameter of a problem.
const DIGITS: f64 = 8.0;
/// NIST prints 11 digits: a difference below them is none.
const CERTIFIED_DIGITS: f64 = 11.0;
/// The bar: problems that reach it from both starts, of 27.
const PROBLEMS: usize = 27;

type Model = fn(&[Dual], &[f64]) -> Dual;

/// A problem of the collection.
struct Strd {
    name: &'static str,
    model: Model,
    starts: [Vec<f64>; 2],
    certified: Vec<f64>,
    /// Responses.
    y: Vec<f64>,
    /// Predictors of each.
    x: Vec<Vec<f64>>,
}

/// It and where to begin.
struct From<'a>(&'a Strd, &'a [f64]);

impl LeastSquares for From<'_> {
    fn residual_count(&self) -> usize {
        self.0.y.len()
    }

    fn start(&self) -> DVector<f64> {
        DVector::from_column_slice(self.1)
    }

    fn bounds_of(&self, _: usize) -> (f64, f64) {
        (f64::NEG_INFINITY, f64::INFINITY)
    }

    fn residuals_at(&self, b: &DVector<f64>, out: &mut DVector<f64>) -> bool {
        let b: Vec<Dual> = b.iter().map(|&b| Dual::from(b)).collect();
        for ((slot, y), x) in out.iter_mut().zip(&self.0.y).zip(&self.0.x) {
            *slot = (self.0.model)(&b, x).value - y;
        }
        out.iter().all(|r| r.is_finite())
    }

    fn jacobian_at(&self, b: &DVector<f64>, out: &mut DMatrix<f64>) -> bool {
        let b: Vec<Dual> = b.iter().enumerate().map(|(j, &b)| Dual::unknown(b, j)).collect();
        for (i, x) in self.0.x.iter().enumerate() {
            let y = (self.0.model)(&b, x);
            (0..b.len()).for_each(|j| out[(i, j)] = y.by[j]);
        }
        out.iter().all(|d| d.is_finite())
    }
}

/// `Σ aⱼ xʲ`.
fn polynomial(coefficients: &[Dual], x: f64) -> Dual {
    coefficients.iter().rev().fold(Dual::from(0.0), |sum, &a| sum * x + a)
}

fn with_one(coefficients: &[Dual]) -> Vec<Dual> {
    std::iter::once(Dual::from(1.0)).chain(coefficients.iter().copied()).collect()
}

/// A Gaussian bell.
fn bell(x: f64, center: Dual, width: Dual) -> Dual {
    let t = (-center + x) / width;
    (-(t * t)).exp()
}

fn gauss(b: &[Dual], x: &[f64]) -> Dual {
    b[0] * (-b[1] * x[0]).exp() + b[2] * bell(x[0], b[3], b[4]) + b[5] * bell(x[0], b[6], b[7])
}

fn lanczos(b: &[Dual], x: &[f64]) -> Dual {
    b[0] * (-b[1] * x[0]).exp() + b[2] * (-b[3] * x[0]).exp() + b[4] * (-b[5] * x[0]).exp()
}

fn chwirut(b: &[Dual], x: &[f64]) -> Dual {
    (-b[0] * x[0]).exp() / (b[1] + b[2] * x[0])
}

fn saturation(b: &[Dual], x: &[f64]) -> Dual {
    b[0] * (-(-b[1] * x[0]).exp() + 1.0)
}

fn cubics(b: &[Dual], x: &[f64]) -> Dual {
    polynomial(&b[..4], x[0]) / polynomial(&with_one(&b[4..]), x[0])
}

fn wave(cosine: Dual, sine: Dual, period: Dual, x: f64) -> Dual {
    let phase = Dual::from(2.0 * PI * x) / period;
    cosine * phase.cos() + sine * phase.sin()
}

const MODELS: [(&str, Model); 27] = [
    ("Bennett5", |b, x| b[0] * (b[1] + x[0]).pow(Dual::from(-1.0) / b[2])),
    ("BoxBOD", saturation),
    ("Chwirut1", chwirut),
    ("Chwirut2", chwirut),
    ("DanWood", |b, x| b[0] * Dual::from(x[0]).pow(b[1])),
    ("ENSO", |b, x| b[0] + wave(b[1], b[2], Dual::from(12.0), x[0]) + wave(b[4], b[5], b[3], x[0]) + wave(b[7], b[8], b[6], x[0])),
    ("Eckerle4", |b, x| {
        let t = (-b[2] + x[0]) / b[1];
        b[0] / b[1] * (t * t * -0.5).exp()
    }),
    ("Gauss1", gauss),
    ("Gauss2", gauss),
    ("Gauss3", gauss),
    ("Hahn1", cubics),
    ("Kirby2", |b, x| polynomial(&b[..3], x[0]) / polynomial(&with_one(&b[3..]), x[0])),
    ("Lanczos1", lanczos),
    ("Lanczos2", lanczos),
    ("Lanczos3", lanczos),
    ("MGH09", |b, x| b[0] * (b[1] * x[0] + x[0] * x[0]) / (b[2] * x[0] + x[0] * x[0] + b[3])),
    ("MGH10", |b, x| b[0] * (b[1] / (b[2] + x[0])).exp()),
    ("MGH17", |b, x| b[0] + b[1] * (-b[3] * x[0]).exp() + b[2] * (-b[4] * x[0]).exp()),
    ("Misra1a", saturation),
    ("Misra1b", |b, x| {
        let t = b[1] * x[0] / 2.0 + 1.0;
        b[0] * (-(Dual::from(1.0) / (t * t)) + 1.0)
    }),
    ("Misra1c", |b, x| b[0] * (-(b[1] * x[0] * 2.0 + 1.0).pow(Dual::from(-0.5)) + 1.0)),
    ("Misra1d", |b, x| b[0] * b[1] * x[0] / (b[1] * x[0] + 1.0)),
    ("Nelson", |b, x| b[0] - b[1] * x[0] * (-b[2] * x[1]).exp()),
    ("Rat42", |b, x| b[0] / ((b[1] - b[2] * x[0]).exp() + 1.0)),
    ("Rat43", |b, x| b[0] / ((b[1] - b[2] * x[0]).exp() + 1.0).pow(Dual::from(1.0) / b[3])),
    ("Roszman1", |b, x| b[0] - b[1] * x[0] - (b[2] / (-b[3] + x[0])).atan() / PI),
    ("Thurber", cubics),
];

/// Reads a file of the collection.
fn read(name: &'static str, model: Model) -> Strd {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/data/nist_strd/{name}.dat"));
    let text = std::fs::read_to_string(path).expect("a file of the repository");
    let numbers = |text: &str| text.split_whitespace().map(|word| word.parse().expect("a number")).collect::<Vec<f64>>();
    let parameters: Vec<Vec<f64>> =
        text.lines().filter_map(|line| Some(numbers(line.trim().strip_prefix('b')?.split_once('=')?.1))).collect();
    let column = |j: usize| parameters.iter().map(|row| row[j]).collect::<Vec<f64>>();
    // The last line that begins so heads the numbers.
    let heading = text.lines().enumerate().filter(|(_, line)| line.starts_with("Data:")).last().expect("data").0;
    let rows = text.lines().skip(heading + 1);
    let rows: Vec<Vec<f64>> = rows.filter(|line| !line.trim().is_empty()).map(numbers).collect();
    let response = |y: f64| if name == "Nelson" { libm::log(y) } else { y };
    Strd {
        name,
        model,
        starts: [column(0), column(1)],
        certified: column(2),
        y: rows.iter().map(|row| response(row[0])).collect(),
        x: rows.iter().map(|row| row[1..].to_vec()).collect(),
    }
}

/// Digits of the worst parameter: the logarithm of its relative error.
fn digits(found: &DVector<f64>, certified: &[f64]) -> f64 {
    let error = |(b, reference): (&f64, &f64)| (b - reference).abs() / reference.abs();
    let worst = found.iter().zip(certified).map(error).fold(0.0, f64::max);
    (-libm::log10(worst)).clamp(0.0, CERTIFIED_DIGITS)
}

#[test]
fn certified_digits_from_both_starts() {
    println!("{:10} {:>15} {:>23}", "problem", "digits", "evaluations");
    let mut reached = 0;
    for (name, model) in MODELS {
        let problem = read(name, model);
        let solve = |start: &Vec<f64>| minimise(&From(&problem, start), Effort::Thorough, Observer::NONE);
        let [first, second]: [Solution; 2] = [solve(&problem.starts[0]), solve(&problem.starts[1])];
        let [digits_1, digits_2] = [&first, &second].map(|solution| digits(&solution.x, &problem.certified));
        println!("{:10} {digits_1:7.1} {digits_2:7.1} {:11} {:11}", problem.name, first.evaluations, second.evaluations);
        reached += usize::from(digits_1.min(digits_2) >= DIGITS);
    }
    println!("{reached} of {} problems reach {DIGITS} digits from both starts", MODELS.len());
    assert!(reached >= PROBLEMS, "{reached} of {}", MODELS.len());
}

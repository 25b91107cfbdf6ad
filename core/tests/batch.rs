//! The batch kernel against 60-digit arithmetic and against the scalar form.
#![allow(clippy::expect_used, clippy::print_stdout, reason = "a test fails by panicking, and may tell its figures")]

mod common;

use common::{DARK_VALUE, gradient_error, relative_error, table};
use pbrdf::model::{
    AngleColumns, AngleColumnsError, Batch, Diffuse, DolpFormula, DolpGradients, GradientRequest, Instructions, Model, Parameter,
    Parameters, Pbrdf, PerParameter, Radiances,
};
use pbrdf::optics::{Geometry, Masking, SlopeDistribution};

/// Bar on the relative error of BRDF and DoLP against 60 digits.
const VALUE: f64 = 1e-13;
/// Bar on the gradient, in the measure of [`gradient_error`].
const GRADIENT: f64 = 1e-12;

const WIDTHS: [Instructions; 3] = [Instructions::Widest, Instructions::Avx2, Instructions::Portable];

fn values_agree(name: &str, instructions: Instructions) {
    let mut worst = (0.0, 0.0);
    let (mut dolp, mut brdf, mut radiances) = (Vec::new(), Vec::new(), Radiances::default());
    for row in table(name) {
        let batch = Batch::new([row.geometry()]).with_instructions(instructions);
        let surface = row.surface();
        batch.dolp(&surface, &mut dolp);
        batch.brdf(&surface, &mut brdf);
        batch.radiances(&surface, &mut radiances);
        assert_eq!(radiances.brdf, brdf);
        let bar = VALUE * row.critical_angle_factor();
        for (column, value) in [("brdf", brdf[0]), ("dolp", dolp[0]), ("dolp", radiances.dolp[0]), ("specular", radiances.specular[0])] {
            let error = relative_error(value, row.number(column));
            let is_dark = column == "dolp" && row.is_dark();
            let bar = if is_dark { DARK_VALUE } else { bar };
            assert!(error <= bar, "{name} line {} ({}): {column} = {value:e}, relative error {error:.1e}", row.line, row.text("case"));
            match column {
                _ if is_dark => {}
                "brdf" => worst.0 = f64::max(worst.0, error),
                "dolp" => worst.1 = f64::max(worst.1, error),
                _ => {}
            }
        }
    }
    println!("{name}, {}: worst relative error {:.1e} in BRDF, {:.1e} in DoLP", instructions.name(), worst.0, worst.1);
}

fn gradients_agree(name: &str, instructions: Instructions) {
    let mut worst: f64 = 0.0;
    let mut gradients = DolpGradients::default();
    for row in table(name) {
        let batch = Batch::new([row.geometry()]).with_instructions(instructions);
        batch.dolp_gradients(&row.surface(), &mut gradients);
        let values = PerParameter::from_fn(|parameter| gradients.by[parameter][0]);
        let references = PerParameter::from_fn(|parameter| row.number(&format!("ddolp_d{}", parameter.key())));
        let error = gradient_error(&values, &references, &row.parameters());
        let bar = if row.is_dark() { DARK_VALUE } else { GRADIENT * row.critical_angle_factor() };
        assert!(error <= bar, "{name} line {} ({}): error {error:.1e}\n{values:?}\n{references:?}", row.line, row.text("case"));
        worst = worst.max(error);
    }
    println!("{name}, {}: worst gradient error {worst:.1e}", instructions.name());
}

/// Values at columns of angles, whose geometry is prepared in vectors too.
fn values_of_columns_agree(name: &str, instructions: Instructions) {
    for row in table(name) {
        let geometry = row.geometry();
        let angles = [geometry.theta_i().0, geometry.theta_r().0, geometry.dphi().0];
        let columns = angles.each_ref().map(std::slice::from_ref);
        let columns = AngleColumns::new(columns[0], columns[1], columns[2]).expect("one point").with_instructions(instructions);
        let mut values = [0.0; 3];
        columns.radiances(&row.surface(), values.each_mut().map(std::slice::from_mut)).expect("a geometry");
        let bar = VALUE * row.critical_angle_factor();
        for (column, value) in ["brdf", "dolp", "specular"].into_iter().zip(values) {
            let error = relative_error(value, row.number(column));
            let bar = if column == "dolp" && row.is_dark() { DARK_VALUE } else { bar };
            assert!(error <= bar, "{name} line {} ({}): {column} = {value:e}, relative error {error:.1e}", row.line, row.text("case"));
        }
    }
}

#[test]
fn values_agree_with_sixty_digits() {
    for instructions in WIDTHS {
        values_of_columns_agree("golden.csv", instructions);
        values_of_columns_agree("golden_corners.csv", instructions);
        values_agree("golden.csv", instructions);
        values_agree("golden_corners.csv", instructions);
    }
}

#[test]
fn gradients_agree_with_sixty_digits() {
    for instructions in WIDTHS {
        gradients_agree("golden_jacobian.csv", instructions);
        gradients_agree("golden_corners.csv", instructions);
    }
}

/// A number below 1 for each i, spread evenly (golden ratio and its like).
fn spread(i: usize, step: f64) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "a small number")]
    let i = i as f64;
    (i * step).fract()
}

/// Geometries over the hemisphere, with the awkward ones among them: normal, retro, grazing, in plane.
fn geometries(count: usize) -> Vec<Geometry> {
    (0..count)
        .map(|i| {
            let (theta_i, theta_r, dphi) = match i % 11 {
                0 => (0.0, 0.0, 0.0),
                1 => (45.0, 45.0, 180.0),
                2 => (45.0, 45.0, 0.0),
                3 => (90.0 - 1e-6, 90.0 - 1e-6, 180.0),
                4 => (90.0 - 1e-6, 90.0 - 1e-6, 0.0),
                5 => (60.0, 1e-9, 90.0),
                _ => (90.0 * spread(i, 0.618_034), 90.0 * spread(i, 0.754_878), 360.0 * spread(i, 0.569_84)),
            };
            Geometry::new(theta_i, theta_r, dphi).expect("angles in range")
        })
        .collect()
}

/// Surfaces over the box, its edges among them, and some far outside it.
fn surfaces() -> Vec<Pbrdf> {
    let mut surfaces = Vec::new();
    for i in 0..240 {
        let mut parameters = Parameters::default();
        for (j, parameter) in Parameter::ALL.into_iter().enumerate() {
            let (low, high) = (*parameter.range().start(), *parameter.range().end());
            parameters[parameter] = match (i + 3 * j) % 10 {
                0 => low,
                1 => high,
                _ => low + (high - low) * spread(i * 9 + j, 0.618_034),
            };
        }
        match i % 24 {
            5 => parameters.n = 1e10,
            6 => (parameters.n, parameters.k) = (0.0, 1e-40),
            7 => (parameters.n, parameters.k) = (1.0, 0.0),
            8 => parameters.ks = 0.0,
            9 => parameters.sigma = 1e-30,
            10 => parameters.kd = 1e100,
            11 => (parameters.n, parameters.k) = (1.0 + 1e-9, 0.0),
            12 => parameters.q = 1e12,
            13 => parameters.sigma_v = 1e-6,
            14 => parameters.c = 40.0,
            15 => parameters.c = -40.0,
            16 => (parameters.ks, parameters.kv, parameters.sigma_v) = (1e-100, 1e100, 1e-30),
            17 => (parameters.ks, parameters.sigma) = (1e100, 1e30),
            18 => parameters.q = 1.0 + 1e-12,
            _ => {}
        }
        let distribution = SlopeDistribution::ALL[i % 2];
        let diffuse = [Diffuse::Minnaert, Diffuse::Lambert, Diffuse::Absent, Diffuse::Hyde][i / 2 % 4];
        let dolp_formula = [DolpFormula::Consistent, DolpFormula::AsPrinted][i / 5 % 2];
        let model = Model {
            masking: [Masking::VGroove, Masking::None][i / 12 % 2],
            diffuse,
            volume: i / 6 % 2 == 0,
            dolp_formula,
            ..Model::full(distribution)
        };
        surfaces.push(Pbrdf::new(model, parameters).expect("inside the domain"));
    }
    let lobes_only = Model { specular: false, ..Model::full(SlopeDistribution::Gauss) };
    surfaces.push(Pbrdf::new(lobes_only, Parameters::default()).expect("inside the domain"));
    surfaces
}

/// Both forms are within 1e-13 of the truth, wherever they are above [`common::NEGLIGIBLE`].
const APART: f64 = 2.0 * VALUE;

#[test]
fn agrees_with_the_scalar_form_everywhere() {
    let batch = Batch::new(geometries(203));
    let (mut dolp, mut radiances) = (Vec::new(), Radiances::default());
    for surface in surfaces() {
        batch.dolp(&surface, &mut dolp);
        batch.radiances(&surface, &mut radiances);
        for (i, facet) in batch.facets().iter().enumerate() {
            let expected = surface.reflection(facet);
            for (value, reference) in [
                (dolp[i], expected.dolp),
                (radiances.dolp[i], expected.dolp),
                (radiances.brdf[i], expected.brdf),
                (radiances.specular[i], expected.specular),
            ] {
                let same = value == reference || relative_error(value, reference) <= APART;
                assert!(same, "{value:e} is not {reference:e} at {facet:?} of {surface:?}");
            }
        }
    }
}

/// Angles of geometries, column by column.
fn columns(geometries: &[Geometry]) -> [Vec<f64>; 3] {
    let column = |of: fn(&Geometry) -> f64| geometries.iter().map(of).collect();
    [column(|at| at.theta_i().0), column(|at| at.theta_r().0), column(|at| at.dphi().0)]
}

#[test]
fn columns_of_angles_agree_with_the_scalar_form_everywhere() {
    for count in [0, 1, 7, 8, 203, 1200] {
        let geometries = geometries(count);
        let [theta_i, theta_r, dphi] = columns(&geometries);
        let angles = AngleColumns::new(&theta_i, &theta_r, &dphi).expect("one length");
        let prepared = angles.prepare().expect("geometries");
        let mut values = [(); 3].map(|()| vec![0.0; count]);
        let mut again = values.clone();
        for surface in surfaces().into_iter().step_by(if count > 300 { 40 } else { 1 }) {
            angles.radiances(&surface, values.each_mut().map(Vec::as_mut_slice)).expect("geometries");
            prepared.radiances(&surface, again.each_mut().map(Vec::as_mut_slice)).expect("as many numbers");
            assert_eq!(values.each_ref().map(|column| bits(column)), again.each_ref().map(|column| bits(column)));
            let mut brdf = vec![0.0; count];
            angles.radiances(&surface, [&mut brdf, &mut [], &mut []]).expect("geometries");
            assert_eq!(bits(&brdf), bits(&values[0]));
            for (i, geometry) in geometries.iter().enumerate() {
                let expected = surface.reflection(&pbrdf::optics::Facet::new(*geometry));
                let [brdf, dolp, specular] = values.each_ref().map(|column| column[i]);
                for (value, reference) in [(dolp, expected.dolp), (brdf, expected.brdf), (specular, expected.specular)] {
                    let same = value == reference || relative_error(value, reference) <= APART;
                    assert!(same, "{value:e} is not {reference:e} at {geometry:?} of {surface:?}");
                }
            }
        }
    }
}

fn bits(column: &[f64]) -> Vec<u64> {
    column.iter().map(|value| value.to_bits()).collect()
}

#[test]
fn a_negative_angle_of_view_is_the_backscatter_side_and_a_far_azimuth_is_reduced() {
    let surface = Pbrdf::new(Model::CAUCHY, Parameters::default()).expect("the defaults");
    let brdf = |theta_r: f64, dphi: f64| {
        let mut values = [[0.0]; 3];
        let [brdf, dolp, specular] = &mut values;
        let (theta_i, theta_r, dphi) = ([30.0], [theta_r], [dphi]);
        AngleColumns::new(&theta_i, &theta_r, &dphi).expect("one point").radiances(&surface, [brdf, dolp, specular]).map(|()| values[0][0])
    };
    assert_eq!(brdf(-40.0, 180.0), brdf(40.0, 0.0));
    // 1e12 is 280° more than a whole number of turns.
    let (far, near) = (brdf(40.0, 1e12).expect("a geometry"), brdf(40.0, 280.0).expect("a geometry"));
    assert!((far / near - 1.0).abs() < APART, "{far} {near}");
    assert_eq!(brdf(-40.0, 90.0), Err(AngleColumnsError::Side { point: 0, theta_r: -40.0, dphi: 90.0 }));
}

#[test]
fn the_first_point_that_is_none_is_named() {
    let surface = Pbrdf::new(Model::CAUCHY, Parameters::default()).expect("the defaults");
    let good = vec![30.0; 2000];
    for (point, angle) in [(0, f64::NAN), (511, 90.0), (512, f64::INFINITY), (1999, -90.0)] {
        for column in 0..3 {
            let mut columns = [good.clone(), good.clone(), vec![180.0; 2000]];
            columns[column][point] = angle;
            if column == 2 && angle.is_finite() {
                continue;
            }
            let [theta_i, theta_r, dphi] = &columns;
            let mut values = [(); 3].map(|()| vec![0.0; 2000]);
            let angles = AngleColumns::new(theta_i, theta_r, dphi).expect("one length");
            for outcome in [angles.radiances(&surface, values.each_mut().map(Vec::as_mut_slice)), angles.prepare().map(|_| ())] {
                assert!(
                    matches!(outcome, Err(AngleColumnsError::Point { point: found, .. }) if found == point),
                    "{column} {angle}: {outcome:?}"
                );
            }
        }
    }
    assert_eq!(AngleColumns::new(&good, &good[1..], &good), Err(AngleColumnsError::Lengths(2000, 1999, 2000)));
}

#[test]
fn gradients_agree_with_the_scalar_form_everywhere() {
    let batch = Batch::new(geometries(101));
    let mut gradients = DolpGradients::default();
    for surface in surfaces() {
        batch.dolp_gradients(&surface, &mut gradients);
        for (i, facet) in batch.facets().iter().enumerate() {
            let (_, expected) = surface.reflection_and_gradient(facet, GradientRequest::ALL);
            let values = PerParameter::from_fn(|parameter| gradients.by[parameter][i]);
            let error = gradient_error(&values, &expected.dolp, surface.parameters());
            assert!(error <= 2.0 * GRADIENT, "{error:e}: {values:?} is not {:?} at {facet:?} of {surface:?}", expected.dolp);
            let infinite = |derivative: &f64| derivative.is_infinite();
            assert_eq!(values.map(|d| infinite(&d)), expected.dolp.map(|d| infinite(&d)));
        }
    }
}

#[test]
fn every_length_has_every_point_in_its_place() {
    let all = geometries(67);
    let surface = Pbrdf::new(Model::full(SlopeDistribution::Cauchy), Parameters::default()).expect("the defaults");
    let mut whole = Vec::new();
    Batch::new(all.iter().copied()).dolp(&surface, &mut whole);
    for count in 0..all.len() {
        for instructions in WIDTHS {
            let batch = Batch::new(all[..count].iter().copied()).with_instructions(instructions);
            // A column that was longer before.
            let mut dolp = vec![f64::NAN; 99];
            batch.dolp(&surface, &mut dolp);
            assert_eq!(dolp.len(), count);
            let mut shifted = Vec::new();
            Batch::new(all[count / 2..count].iter().copied()).with_instructions(instructions).dolp(&surface, &mut shifted);
            assert_eq!(dolp[count / 2..], shifted, "a point's value depends on its place");
            assert!(dolp.iter().zip(&whole).all(|(a, b)| a == b || relative_error(*a, *b) < VALUE));
        }
    }
}

#[test]
fn threads_and_widths_do_not_change_a_bit() {
    let batch = Batch::new(geometries(50_001));
    let alone = batch.clone().single_threaded();
    let narrow = batch.clone().with_instructions(Instructions::Avx2);
    let has_fma = Instructions::Avx2.name() == "AVX2";
    // Hyde's integral, the scalar form's alone, takes its time at so many angles of incidence.
    for surface in surfaces().iter().filter(|surface| surface.model().diffuse != Diffuse::Hyde).step_by(17) {
        let mut results = [(); 3].map(|()| (Radiances::default(), DolpGradients::default()));
        for (batch, (radiances, gradients)) in [&batch, &alone, &narrow].into_iter().zip(&mut results) {
            batch.radiances(surface, radiances);
            batch.dolp_gradients(surface, gradients);
        }
        let bits = |x: &[f64]| x.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        for (radiances, gradients) in &results[1..if has_fma { 3 } else { 2 }] {
            assert_eq!(bits(&radiances.dolp), bits(&results[0].0.dolp));
            assert_eq!(bits(&radiances.brdf), bits(&results[0].0.brdf));
            for (column, expected) in gradients.by.iter().zip(&results[0].1.by) {
                assert_eq!(bits(column), bits(expected));
            }
        }
    }
}

/// Some seconds in release: `cargo test --release --no-default-features --features threads --test batch -- --ignored`.
#[test]
#[ignore = "10⁸ evaluations, for a release build"]
fn a_hundred_million_evaluations_without_one_that_is_not_a_number() {
    let batch = Batch::new(geometries(100_000));
    let (mut radiances, mut gradients, mut infinite) = (Radiances::default(), DolpGradients::default(), 0_usize);
    for i in 0..1000_usize {
        let mut parameters = Parameters::default();
        for (j, parameter) in Parameter::ALL.into_iter().enumerate() {
            let (low, high) = (*parameter.range().start(), *parameter.range().end());
            parameters[parameter] = match (i + 3 * j) % 23 {
                0 => low,
                1 => high,
                2 => low.next_up(),
                3 => high.next_down(),
                _ => low + (high - low) * spread(i * 9 + j, 0.618_034),
            };
        }
        let surface =
            Pbrdf::new(Model::full(SlopeDistribution::ALL[i % 2]), parameters.flushed_to_zero()).expect("the box lies in the domain");
        batch.radiances(&surface, &mut radiances);
        batch.dolp_gradients(&surface, &mut gradients);
        assert!(radiances.dolp.iter().all(|dolp| (0.0..=1.0).contains(dolp)), "{surface:?}");
        assert!(radiances.brdf.iter().all(|brdf| *brdf >= 0.0 && brdf.is_finite()), "{surface:?}");
        for column in &gradients.by {
            assert!(column.iter().all(|derivative| !derivative.is_nan()), "{surface:?}");
            infinite += column.iter().filter(|derivative| derivative.is_infinite()).count();
        }
    }
    println!("{infinite} of 9·10⁸ derivatives beyond f64");
}

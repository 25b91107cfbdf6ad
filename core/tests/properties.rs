//! What must hold everywhere: never NaN, 0 ≤ DoLP ≤ DoLP_s ≤ 1, BRDF ≥ 0, admissible Mueller matrices, reciprocity, derivatives
//! that are those of the values.
#![allow(clippy::expect_used, clippy::print_stdout, reason = "a test fails by panicking, and may tell its figures")]

use nalgebra::Complex;
use nalgebra::Matrix4;
use pbrdf::model::{Diffuse, DolpFormula, Domain, GradientRequest, Model, Parameter, Parameters, Pbrdf};
use pbrdf::optics::{Facet, Geometry, Mueller, SlopeDistribution};
use proptest::prelude::{BoxedStrategy, Just, ProptestConfig, Strategy, prop, prop_assert, prop_oneof, proptest};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// A value in a range, its edges and their nearest neighbours included.
fn in_range(low: f64, high: f64) -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => low..=high,
        1 => Just(low),
        1 => Just(high),
        1 => Just(low.next_up()),
        1 => Just(high.next_down()),
    ]
}

/// The box, its edges, and now and then a surface that light hardly sees, some units in the last place from N = 1.
fn in_box() -> impl Strategy<Value = Parameters> {
    let near_one = (0..4_u64, prop::bool::ANY).prop_map(|(ulps, up)| {
        let bits = 1.0_f64.to_bits();
        f64::from_bits(if up { bits + ulps } else { bits - ulps })
    });
    let faint = (anywhere_in_box(), near_one).prop_map(|(parameters, n)| Parameters { n, k: 0.0, ..parameters });
    prop_oneof![9 => anywhere_in_box(), 1 => faint]
}

fn anywhere_in_box() -> impl Strategy<Value = Parameters> {
    let of = |parameter: Parameter| in_range(*parameter.range().start(), *parameter.range().end());
    Parameter::ALL.map(of).prop_map(|values| {
        let mut parameters = Parameters::default();
        for (parameter, value) in Parameter::ALL.into_iter().zip(values) {
            parameters[parameter] = value;
        }
        // The neighbour of a weight of 0 lies below the domain.
        parameters.flushed_to_zero()
    })
}

/// Values of the whole domain, its ends included.
fn in_domain() -> impl Strategy<Value = Parameters> {
    let powers = |low: f64, high: f64| (low..high).prop_map(libm::exp10);
    let size = |low: f64, high: f64| prop_oneof![4 => powers(-3.0, 3.0), 1 => powers(low, high), 1 => Just(libm::exp10(low)), 1 => Just(libm::exp10(high))];
    let or_zero = |size: BoxedStrategy<f64>| prop_oneof![6 => size, 1 => Just(0.0)];
    let weight = || or_zero(size(-100.0, 100.0).boxed());
    let index = || size(-320.0, 10.0);
    (
        index(),
        or_zero(index().boxed()),
        size(-30.0, 30.0),
        [weight(), weight(), weight()],
        size(-12.0, 12.0),
        -1e3..=1e3_f64,
        size(-30.0, 30.0),
    )
        .prop_map(|(n, k, sigma, [ks, kd, kv], tail, c, sigma_v)| {
            let parameters = Parameters { n, k, sigma, ks, kd, kv, q: 1.0 + tail, c, sigma_v };
            // A power of ten may be rounded to the other side of an end.
            Parameter::ALL.into_iter().fold(parameters, |mut parameters, parameter| {
                let (Domain::Between(low, high) | Domain::ZeroOrBetween(low, high)) = parameter.domain();
                let value = parameters[parameter];
                parameters[parameter] = if value == 0.0 { 0.0 } else { value.clamp(low, high) };
                parameters
            })
        })
        .prop_filter("a medium", |parameters| parameters.n > 0.0 || parameters.k > 0.0)
}

/// Two directions; now and then the same twice, the mirror direction, or a neighbour of either.
fn geometry() -> impl Strategy<Value = Geometry> {
    let zenith = || in_range(0.0, 90.0_f64.next_down());
    let azimuth = || prop_oneof![Just(0.0), Just(180.0), Just(-180.0), Just(180.0_f64.next_up()), Just(5e-324), -720.0..720.0_f64];
    let anywhere = (zenith(), zenith(), azimuth());
    let neighbours = (zenith(), 0..3_u8, azimuth()).prop_map(|(theta, step, dphi)| {
        let other = match step {
            0 => theta,
            1 => theta.next_up().min(90.0_f64.next_down()),
            _ => theta.next_down().max(0.0),
        };
        (theta, other, dphi)
    });
    prop_oneof![4 => anywhere, 1 => neighbours]
        .prop_map(|(theta_i, theta_r, dphi)| Geometry::new(theta_i, theta_r, dphi).expect("angles in range"))
}

/// The nine-parameter model, or with Hyde's balance for its diffuse term.
fn model() -> impl Strategy<Value = Model> {
    (distribution(), prop_oneof![3 => Just(Diffuse::Minnaert), 1 => Just(Diffuse::Hyde)], prop::bool::ANY)
        .prop_map(|(distribution, diffuse, volume)| Model { diffuse, volume, ..Model::full(distribution) })
}

fn distribution() -> impl Strategy<Value = SlopeDistribution> {
    prop_oneof![Just(SlopeDistribution::Gauss), Just(SlopeDistribution::Cauchy)]
}

/// Smallest eigenvalue of the coherency matrix, over m00: not negative for a matrix that some optical system has.
fn admissibility(mueller: &Mueller) -> f64 {
    let i = Complex::new(0.0, 1.0);
    let one = Complex::new(1.0, 0.0);
    // H = ¼ Σ m_jk (σ_j ⊗ σ_k*), with S3 = −2 Im(E_s E_p*): σ_3 the other way round than usual.
    let pauli = [
        [[one, one * 0.0], [one * 0.0, one]],
        [[one, one * 0.0], [one * 0.0, -one]],
        [[one * 0.0, one], [one, one * 0.0]],
        [[one * 0.0, i], [-i, one * 0.0]],
    ];
    let coherency = Matrix4::from_fn(|a, b| {
        let mut sum = Complex::new(0.0, 0.0);
        for j in 0..4 {
            for k in 0..4 {
                sum += pauli[j][a / 2][b / 2] * pauli[k][a % 2][b % 2].conj() * mueller.element(j, k);
            }
        }
        sum * 0.25
    });
    coherency.symmetric_eigenvalues().min() / mueller.element(0, 0)
}

/// Rounding of an eigenvalue, in units of m00.
const EIGENVALUE: f64 = 1e-12;
/// DoLP and its limit are rounded apart.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Derivatives below this count as 0, as in the measure of the reference tables.
const NEGLIGIBLE: f64 = 1e-30;
/// Relative step of the numerical derivatives: ε^(1/4), between rounding and curvature.
const DIFFERENCE: f64 = 1e-4;

/// Half a second of them; `PROPTEST_CASES` does not reach here, so that CI and users try the same number.
const CASES: u32 = 20_000;

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(CASES) })]

    #[test]
    fn dolp_and_brdf_stay_in_their_ranges_over_the_whole_box(parameters in in_box(), geometry in geometry(), model in model()) {
        let surface = Pbrdf::new(model, parameters).expect("the box lies in the domain");
        let facet = Facet::new(geometry);
        let (reflection, gradient) = surface.reflection_and_gradient(&facet, GradientRequest::ALL);
        let limit = surface.fresnel_limit(&facet);
        prop_assert!(reflection.brdf >= 0.0 && reflection.brdf.is_finite());
        prop_assert!(reflection.dolp >= 0.0 && reflection.dolp <= limit * (1.0 + ROUNDING) && limit <= 1.0, "{} {}", reflection.dolp, limit);
        prop_assert!(gradient.brdf.iter().chain(&gradient.dolp).all(|derivative| !derivative.is_nan()), "{gradient:?}");
    }

    #[test]
    fn nothing_is_not_a_number_in_the_whole_domain(
        parameters in in_domain(), geometry in geometry(), model in model(), as_printed in prop::bool::ANY,
    ) {
        let formula = if as_printed { DolpFormula::AsPrinted } else { DolpFormula::Consistent };
        let surface = Pbrdf::new(model.with_dolp_formula(formula), parameters).expect("parameters in the domain");
        let (reflection, gradient) = surface.reflection_and_gradient(&Facet::new(geometry), GradientRequest::ALL);
        // As printed it is at most 1/k_s, and with k_s = 0 as large as the depolarised terms are dark.
        let most = match formula {
            DolpFormula::Consistent => 1.0,
            _ if parameters.ks > 0.0 => (1.0 + ROUNDING) / parameters.ks,
            _ => f64::INFINITY,
        };
        prop_assert!((0.0..=most).contains(&reflection.dolp), "{reflection:?}");
        prop_assert!(reflection.brdf >= 0.0, "{reflection:?}");
        prop_assert!(gradient.brdf.iter().chain(&gradient.dolp).all(|derivative| !derivative.is_nan()), "{gradient:?}");
    }

    #[test]
    fn mueller_matrices_are_admissible(parameters in in_box(), geometry in geometry(), distribution in distribution()) {
        let surface = Pbrdf::new(Model::full(distribution), Parameters { ks: parameters.ks.max(1e-3), ..parameters }).expect("the box lies in the domain");
        let mueller = surface.mueller(geometry);
        // Below this the elements have no digits left to judge by.
        let is_lit = mueller.element(0, 0) > 1e-200;
        prop_assert!(!is_lit || admissibility(&mueller) >= -EIGENVALUE, "{}", admissibility(&mueller));
    }

    #[test]
    fn specular_and_diffuse_lobes_are_reciprocal(parameters in in_box(), geometry in geometry(), distribution in distribution()) {
        let model = Model { volume: false, diffuse: Diffuse::Minnaert, ..Model::full(distribution) };
        let surface = Pbrdf::new(model, parameters).expect("the box lies in the domain");
        let back = Geometry::new(geometry.theta_r().0, geometry.theta_i().0, -geometry.dphi().0).expect("the same angles");
        let (there, again) = (surface.reflection(&Facet::new(geometry)), surface.reflection(&Facet::new(back)));
        // The same products in another order.
        prop_assert!((there.brdf - again.brdf).abs() <= 1e-12 * there.brdf, "{} {}", there.brdf, again.brdf);
        prop_assert!((there.dolp - again.dolp).abs() <= 1e-12, "{} {}", there.dolp, again.dolp);
    }

    #[test]
    fn derivatives_are_those_of_the_values(parameters in in_box(), geometry in geometry(), distribution in distribution()) {
        let model = Model::full(distribution);
        let facet = Facet::new(geometry);
        let at = |parameters: Parameters| {
            let reflection = Pbrdf::new(model, parameters).expect("the box lies well inside the domain").reflection(&facet);
            [reflection.brdf, reflection.dolp]
        };
        let (_, gradient) = Pbrdf::new(model, parameters).expect("the box lies in the domain").reflection_and_gradient(&facet, GradientRequest::ALL);
        let (n, k) = (parameters.n, parameters.k);
        for parameter in model.parameters() {
            let value = parameters[parameter];
            let step = DIFFERENCE * if parameter == Parameter::Q { value - 1.0 } else { value.abs().max(DIFFERENCE) };
            // Where a parameter ends there are one-sided derivatives; at the critical angle infinite ones; around N = 1 a dip that
            // may be far narrower than the step.
            let ends = value - 2.0 * step < 0.0 && parameter != Parameter::C;
            let critical = libm::hypot((n - k) * (n + k) - facet.sin_beta_sq, 2.0 * n * k) < 20.0 * DIFFERENCE * (n * n + k * k);
            let dark = libm::hypot(n - 1.0, k) < 20.0 * DIFFERENCE;
            let of_index = parameter == Parameter::N || parameter == Parameter::K;
            if ends || (of_index && (critical || dark)) {
                continue;
            }
            let moved = |by: f64| {
                let mut moved = parameters;
                moved[parameter] += by * step;
                (moved[parameter], at(moved))
            };
            let [down_2, down, here, up, up_2] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(moved);
            for (i, analytic) in [gradient.brdf[parameter], gradient.dolp[parameter]].into_iter().enumerate() {
                let between = |low: &(f64, [f64; 2]), high: &(f64, [f64; 2])| (high.1[i] - low.1[i]) / (high.0 - low.0);
                let (near, far) = (between(&down, &up), between(&down_2, &up_2));
                let (before, after) = (between(&down, &here), between(&here, &up));
                // Something smaller than the step lies between them: an extremum, the edge of total reflection.
                if (after - before).abs() > 0.1 * before.abs().max(after.abs()) {
                    continue;
                }
                // What the two steps disagree by is the error of the farther one; values are rounded.
                let rounding = 1e3 * f64::EPSILON * up_2.1[i].abs().max(down_2.1[i].abs()) / step;
                let bar = 4.0 * (near - far).abs() + rounding + NEGLIGIBLE;
                prop_assert!((analytic - near).abs() <= bar, "{parameter:?} of {i}: {analytic:e}, by differences {near:e} or {far:e}");
            }
        }
    }
}

/// With q near 1 the tail is bright where tan²α/2σ² is as large as it gets.
#[test]
fn derivatives_by_q_hold_for_the_narrowest_lobes() {
    // Central differences of steps of 1e-3 (q − 1): curvature 1e-6, rounding far below.
    const BAR: f64 = 1e-5;
    let facet = Facet::new(Geometry::new(40.0, 55.0, 150.0).expect("angles in range"));
    for sigma in [1e-10, 1e-20, 1e-30] {
        let parameters = Parameters { sigma, q: 1.001, ..Parameters::default() };
        let at = |q: f64| {
            let surface = Pbrdf::new(Model::full(SlopeDistribution::Cauchy), Parameters { q, ..parameters }).expect("in the domain");
            let (reflection, gradient) = surface.reflection_and_gradient(&facet, GradientRequest::ALL);
            ([reflection.brdf, reflection.dolp], [gradient.brdf, gradient.dolp].map(|by| by[Parameter::Q]))
        };
        let step = 1e-3 * (parameters.q - 1.0);
        let ((low, _), (_, analytic), (high, _)) = (at(parameters.q - step), at(parameters.q), at(parameters.q + step));
        for i in 0..2 {
            let numeric = (high[i] - low[i]) / (2.0 * step);
            assert!((analytic[i] - numeric).abs() <= BAR * numeric.abs(), "σ = {sigma:e}: {} {numeric}", analytic[i]);
        }
    }
}

/// Evaluations of the long run.
const HUNDRED_MILLION: u64 = 100_000_000;

/// `cargo test --release --test properties -- --ignored --nocapture`: two to three minutes.
#[test]
#[ignore = "two to three minutes in a release build"]
fn a_hundred_million_random_evaluations_are_all_numbers() {
    let mut random = Pcg64::seed_from_u64(20_211_129);
    let mut infinite = 0_u64;
    for _ in 0..HUNDRED_MILLION {
        let mut parameters = Parameters::default();
        for parameter in Parameter::ALL {
            let (low, high) = parameter.range().into_inner();
            parameters[parameter] = place(&mut random, low, high);
        }
        let last = 90.0_f64.next_down();
        let [theta_i, theta_r] = [(); 2].map(|()| place(&mut random, 0.0, last));
        let dphi = place(&mut random, -180.0, 180.0);
        let distribution = if random.next_u64() & 1 == 0 { SlopeDistribution::Gauss } else { SlopeDistribution::Cauchy };
        let surface = Pbrdf::new(Model::full(distribution), parameters.flushed_to_zero()).expect("the box lies in the domain");
        let facet = Facet::new(Geometry::new(theta_i, theta_r, dphi).expect("angles in range"));
        let (reflection, gradient) = surface.reflection_and_gradient(&facet, GradientRequest::ALL);
        assert!(reflection.brdf.is_finite() && (0.0..=1.0).contains(&reflection.dolp), "{parameters:?} {facet:?}");
        for derivative in gradient.brdf.iter().chain(&gradient.dolp) {
            assert!(!derivative.is_nan(), "{parameters:?} {facet:?}");
            infinite += u64::from(derivative.is_infinite());
        }
    }
    println!("{HUNDRED_MILLION} evaluations with 18 derivatives each: no NaN, {infinite} derivatives beyond f64");
}

/// A value in a range: mostly inside, one time in sixteen an edge or its neighbour.
fn place(random: &mut Pcg64, low: f64, high: f64) -> f64 {
    let drawn = random.next_u64();
    match drawn & 63 {
        0 => low,
        1 => high,
        2 => low.next_up(),
        3 => high.next_down(),
        _ => {
            #[expect(clippy::cast_precision_loss, reason = "53 bits fit an f64 exactly")]
            let fraction = (drawn >> 11) as f64 / 9_007_199_254_740_992.0;
            low + (high - low) * fraction
        }
    }
}

//! What must hold everywhere: never NaN, 0 ≤ DoLP ≤ DoLP_s ≤ 1, BRDF ≥ 0, admissible Mueller matrices, reciprocity.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use nalgebra::Complex;
use nalgebra::Matrix4;
use pbrdf::model::{Diffuse, Model, Parameter, Parameters, Pbrdf, Wanted};
use pbrdf::optics::{Facet, Geometry, Mueller, SlopeDistribution};
use proptest::prelude::*;

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

fn in_box() -> impl Strategy<Value = Parameters> {
    let of = |parameter: Parameter| in_range(*parameter.range().start(), *parameter.range().end());
    Parameter::ALL.map(of).prop_map(|values| {
        let mut parameters = Parameters::default();
        for (parameter, value) in Parameter::ALL.into_iter().zip(values) {
            parameters[parameter] = value;
        }
        parameters
    })
}

/// Values of the whole mathematical domain, to the ends of f64.
fn in_domain() -> impl Strategy<Value = Parameters> {
    let size = || prop_oneof![4 => -3.0..3.0_f64, 1 => -320.0..308.0_f64].prop_map(|exponent| libm::exp10(exponent).max(5e-324));
    let weight = || prop_oneof![4 => size().boxed(), 1 => Just(0.0).boxed()];
    let signed =
        prop_oneof![4 => (-1e3..1e3_f64).boxed(), 1 => (size(), prop::bool::ANY).prop_map(|(c, up)| if up { c } else { -c }).boxed()];
    (size(), weight(), size(), [weight(), weight(), weight()], size(), signed, size()).prop_map(
        |(n, k, sigma, [ks, kd, kv], q, c, sigma_v)| Parameters {
            n,
            k,
            sigma,
            ks,
            kd,
            kv,
            q: (1.0 + q).max(1.0_f64.next_up()),
            c,
            sigma_v,
        },
    )
}

fn geometry() -> impl Strategy<Value = Geometry> {
    let zenith = || in_range(0.0, 90.0_f64.next_down());
    let azimuth = prop_oneof![Just(0.0), Just(180.0), Just(-180.0), -720.0..720.0_f64];
    (zenith(), zenith(), azimuth).prop_map(|(theta_i, theta_r, dphi)| Geometry::new(theta_i, theta_r, dphi).expect("angles in range"))
}

/// The nine-parameter model, or with Hyde's balance for its diffuse term.
fn model() -> impl Strategy<Value = Model> {
    (distribution(), prop_oneof![3 => Just(Diffuse::Minnaert), 1 => Just(Diffuse::Hyde)], any::<bool>())
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

/// Half a second of them; `PROPTEST_CASES` does not reach here, so that CI and users try the same number.
const CASES: u32 = 20_000;

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(CASES) })]

    #[test]
    fn dolp_and_brdf_stay_in_their_ranges_over_the_whole_box(parameters in in_box(), geometry in geometry(), model in model()) {
        let surface = Pbrdf::new(model, parameters).expect("the box lies in the domain");
        let facet = Facet::new(geometry);
        let (reflection, gradient) = surface.reflection_and_gradient(&facet, Wanted::ALL);
        let limit = surface.fresnel_limit(&facet);
        prop_assert!(reflection.brdf >= 0.0 && reflection.brdf.is_finite());
        prop_assert!(reflection.dolp >= 0.0 && reflection.dolp <= limit * (1.0 + ROUNDING) && limit <= 1.0, "{} {}", reflection.dolp, limit);
        prop_assert!(gradient.brdf.iter().chain(&gradient.dolp).all(|derivative| !derivative.is_nan()), "{gradient:?}");
    }

    #[test]
    fn nothing_is_not_a_number_in_the_whole_domain(parameters in in_domain(), geometry in geometry(), model in model()) {
        let surface = Pbrdf::new(model, parameters).expect("parameters in the domain");
        let (reflection, gradient) = surface.reflection_and_gradient(&Facet::new(geometry), Wanted::ALL);
        prop_assert!((0.0..=1.0).contains(&reflection.dolp), "{reflection:?}");
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
}

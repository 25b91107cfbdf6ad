//! The audit: what it finds is there, and what cannot be wrong is never found.
#![allow(clippy::expect_used, clippy::print_stdout, reason = "a test fails by panicking, and may tell its figures")]

use nalgebra::Matrix4;
use pbrdf::model::{Audit, Check, Diffuse, Model, Parameter, Parameters, Pbrdf, Preset, Reflectance};
use pbrdf::optics::{Degrees, Facet, Fresnel, Geometry, Masking, Mueller, RefractiveIndex, SlopeDistribution};
use std::f64::consts::PI;

const STEEL: Parameters = Parameters { n: 2.07, k: 2.9, sigma: 0.35, ks: 1.0, kd: 0.12, kv: 0.25, q: 2.2, c: -0.4, sigma_v: 0.6 };

fn surface(model: Model, parameters: Parameters) -> Pbrdf {
    Pbrdf::new(model, parameters).expect("a valid surface")
}

fn full(distribution: SlopeDistribution) -> Model {
    Model::full(distribution)
}

/// ∫ F00 cos θr dω by midpoints: no slopes, no edges.
fn by_directions(surface: &Pbrdf, theta_i: f64) -> [f64; 3] {
    let (zeniths, azimuths) = (900, 450);
    let mut sums = [0.0; 3];
    for i in 0..zeniths {
        let theta_r = 90.0 * (f64::from(i) + 0.5) / f64::from(zeniths);
        let (sin, cos) = Degrees(theta_r).sin_cos();
        for j in 0..azimuths {
            let dphi = 180.0 * (f64::from(j) + 0.5) / f64::from(azimuths);
            let reflection = surface.reflection(&Facet::new(Geometry::new(theta_i, theta_r, dphi).expect("a valid geometry")));
            for (sum, term) in sums.iter_mut().zip([reflection.specular, reflection.diffuse, reflection.volume]) {
                *sum += term * sin * cos;
            }
        }
    }
    sums.map(|sum| sum * (PI / 2.0 / f64::from(zeniths)) * (2.0 * PI / f64::from(azimuths)))
}

#[test]
fn reflectance_is_the_integral_over_all_directions_of_view() {
    // The kinks of G, and cos^c at the horizon, cost the midpoint rule of this mesh some 1e-4.
    let tolerance = 3e-4;
    for (distribution, masking) in [
        (SlopeDistribution::Gauss, Masking::VGroove),
        (SlopeDistribution::Cauchy, Masking::VGroove),
        (SlopeDistribution::Gauss, Masking::None),
    ] {
        let surface = surface(Model { masking, ..full(distribution) }, STEEL);
        for theta_i in [0.0, 35.0, 60.0, 80.0] {
            let found = Reflectance::new(&surface, Degrees(theta_i));
            let expected = by_directions(&surface, theta_i);
            for (found, expected) in [found.specular, found.diffuse, found.volume].into_iter().zip(expected) {
                assert!((found - expected).abs() < tolerance * expected, "{distribution:?} {masking:?} {theta_i}°: {found} {expected}");
            }
        }
    }
}

#[test]
fn a_perfect_reflector_with_hydes_balance_gives_back_all_light() {
    let model = Preset::from_key("hyde").expect("a preset").model;
    for distribution in [SlopeDistribution::Gauss, SlopeDistribution::Cauchy] {
        for sigma in [0.001, 0.05, 0.4, 2.0] {
            // 1 − R ≈ 4n/k² or less at any angle that the audit looks at.
            let mirror = Parameters { n: 1e-12, k: 1e6, sigma, ..STEEL };
            for reflectance in Audit::new(&surface(Model { distribution, ..model }, mirror)).reflectance {
                let off = (reflectance.total() - 1.0).abs();
                // 16 nodes in azimuth hold some nine digits, fewer at 89°.
                assert!(off < 1e-7 && reflectance.error < 1e-4, "{distribution:?} σ = {sigma}: {reflectance:?}");
            }
        }
    }
}

#[test]
fn a_mirror_reflects_as_fresnel_says() {
    let model = Model { diffuse: Diffuse::Absent, volume: false, ..full(SlopeDistribution::Gauss) };
    let surface = surface(model, Parameters { sigma: 0.001, ..STEEL });
    for theta_i in [0.0, 30.0, 60.0, 75.0] {
        let facet = Facet::new(Geometry::new(theta_i, theta_i, 180.0).expect("a valid geometry"));
        let expected = Fresnel::new(RefractiveIndex::new(STEEL.n, STEEL.k).expect("a metal"), &facet).mean();
        // Facets that are tilted by 0.001 see other angles: σ² times the curvature of R.
        assert!((Reflectance::new(&surface, Degrees(theta_i)).specular / expected - 1.0).abs() < 1e-4, "{theta_i}");
    }
}

#[test]
fn the_minnaert_term_exceeds_the_light_at_grazing_incidence_and_the_audit_says_so() {
    let model = Model { specular: false, volume: false, ..full(SlopeDistribution::Gauss) };
    let audit = Audit::new(&surface(model, Parameters { kd: 1.0, c: -0.5, ..STEEL }));
    let at_85 = audit.reflectance.iter().find(|reflectance| reflectance.theta_i == 85.0).expect("85° is looked at");
    assert!((at_85.diffuse - 4.516_3).abs() < 1e-3, "{at_85:?}");
    let finding = audit.finding(Check::Reflectance).expect("always there");
    assert!(!finding.pass && finding.why().contains("More light leaves"));
    assert!(
        audit.finding(Check::SpecularReciprocity).is_none() && audit.finding(Check::DiffuseReciprocity).is_some_and(|finding| finding.pass)
    );
    // Lambert of weight 1 reflects all light and no more.
    let lambert = Audit::new(&surface(Model { diffuse: Diffuse::Lambert, ..model }, Parameters { kd: 1.0, ..STEEL }));
    assert!(lambert.finding(Check::Reflectance).is_some_and(|finding| finding.pass && finding.value == 1.0));
}

#[test]
fn the_volume_term_and_hydes_balance_are_not_reciprocal_and_the_rest_is() {
    let audit = Audit::new(&surface(full(SlopeDistribution::Cauchy), STEEL));
    let pass = |check| audit.finding(check).expect("of the model").pass;
    assert_eq!([Check::SpecularReciprocity, Check::DiffuseReciprocity, Check::VolumeReciprocity].map(pass), [true, true, false]);
    let volume = audit.finding(Check::VolumeReciprocity).expect("of the model");
    // From the normal to the horizon: 1 − e^(−θ²/2σ_v²) at 89°.
    let expected = 1.0 - libm::exp(-0.5 * (89.0_f64.to_radians() / STEEL.sigma_v).powi(2));
    assert!((volume.value - expected).abs() < 1e-12 && volume.at.is_some_and(|at| at.theta_i().0 == 0.0 && at.theta_r().0 == 89.0));
    let hyde = Audit::new(&surface(Preset::from_key("hyde").expect("a preset").model, STEEL));
    assert!(hyde.finding(Check::DiffuseReciprocity).is_some_and(|finding| !finding.pass));
}

#[test]
fn what_cannot_be_wrong_is_found_right_all_over_the_box() {
    let always = [Check::SpecularReciprocity, Check::DiffuseReciprocity, Check::FresnelLimit, Check::Admissibility, Check::Normalisation];
    for i in 0..60 {
        let mut parameters = STEEL;
        for (j, parameter) in (1..).zip(Parameter::ALL) {
            let fraction = (f64::from(i) * f64::from(2 * j + 1).sqrt()).fract();
            let (low, high) = (*parameter.range().start(), *parameter.range().end());
            // The edges too: σ = 0.001, q = 1.0001, c = −1.
            parameters[parameter] = if i == 0 { low } else { low + fraction * (high - low) };
        }
        parameters.ks = parameters.ks.max(1e-3);
        for distribution in SlopeDistribution::ALL {
            let audit = Audit::new(&surface(full(distribution), parameters));
            for check in always {
                let finding = audit.finding(check).expect("of the model");
                assert!(finding.pass, "{distribution:?} {parameters:?}: {finding:?}");
            }
            for reflectance in audit.reflectance {
                assert!(reflectance.total().is_finite() && reflectance.error <= 1e-4 * parameters.ks, "{parameters:?}: {reflectance:?}");
            }
        }
    }
}

#[test]
fn a_matrix_that_polarises_more_than_there_is_light_is_not_admissible() {
    let mut matrix = Matrix4::zeros();
    (matrix[(0, 0)], matrix[(1, 0)]) = (1.0, 1.1);
    assert!(Mueller(matrix).smallest_coherency_eigenvalue() < -0.01);
    matrix[(1, 0)] = 0.9;
    assert!(Mueller(matrix).smallest_coherency_eigenvalue() > 0.0);
}

/// What an audit costs: `cargo test --release --test audit -- --ignored --nocapture`.
#[test]
#[ignore = "prints a time"]
fn an_audit_takes_milliseconds() {
    for (name, parameters) in
        [("steel", STEEL), ("mirror", Parameters { sigma: 0.001, ..STEEL }), ("rough", Parameters { sigma: 2.0, ..STEEL })]
    {
        let surface = surface(full(SlopeDistribution::Cauchy), parameters);
        let begun = std::time::Instant::now();
        let times = 20;
        let sum: f64 = (0..times).map(|_| Audit::new(std::hint::black_box(&surface)).reflectance[3].total()).sum();
        println!("{name}: {:.2} ms each (ρ at 15° {:.4})", begun.elapsed().as_secs_f64() * 1e3 / f64::from(times), sum / f64::from(times));
        assert!(sum.is_finite());
    }
}

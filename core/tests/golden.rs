//! The model against 60-digit arithmetic.
#![allow(clippy::expect_used, clippy::print_stdout, reason = "a test fails by panicking, and may tell its figures")]

mod common;

use common::{Row, gradient_error, relative_error, table};
use pbrdf::model::{GradientRequest, Parameter};
use pbrdf::optics::Facet;

/// Bar on the relative error of BRDF and DoLP: some 500 units in the last place, met by forms in which nothing cancels.
const VALUE: f64 = 1e-13;
/// Bar on the gradient, in the measure of [`gradient_error`].
const GRADIENT: f64 = 1e-12;

/// sin²β/|N² − sin²β|, at least 1: how much an index at its critical angle magnifies a rounding of sin²β.
fn critical_angle_factor(row: &Row) -> f64 {
    let s = Facet::new(row.geometry()).sin_beta_sq;
    let (n, k) = (row.number("n"), row.number("k"));
    (s / libm::hypot((n - k) * (n + k) - s, 2.0 * n * k)).max(1.0)
}

fn values_agree(name: &str) {
    let mut worst = (0.0, 0.0);
    for row in table(name) {
        let reflection = row.surface().reflection(&Facet::new(row.geometry()));
        let bar = VALUE * critical_angle_factor(&row);
        for (column, value) in [
            ("brdf", reflection.brdf),
            ("dolp", reflection.dolp),
            ("specular", reflection.specular),
            ("diffuse", reflection.diffuse),
            ("volume", reflection.volume),
        ] {
            let error = relative_error(value, row.number(column));
            assert!(error <= bar, "{name} line {} ({}): {column} = {value:e}, relative error {error:.1e}", row.line, row.text("case"));
            match column {
                "brdf" => worst.0 = f64::max(worst.0, error),
                "dolp" => worst.1 = f64::max(worst.1, error),
                _ => {}
            }
        }
        let dolp = row.surface().dolp(&Facet::new(row.geometry()));
        assert_eq!(dolp, reflection.dolp, "{name} line {}: the short way to DoLP is another way", row.line);
    }
    println!("{name}: worst relative error {:.1e} in BRDF, {:.1e} in DoLP", worst.0, worst.1);
}

fn gradients_agree(name: &str) {
    let mut worst: f64 = 0.0;
    for row in table(name) {
        let (_, gradient) = row.surface().reflection_and_gradient(&Facet::new(row.geometry()), GradientRequest::ALL);
        for (prefix, values) in [("dbrdf_d", gradient.brdf), ("ddolp_d", gradient.dolp)] {
            let references = Parameter::ALL.map(|parameter| row.number(&format!("{prefix}{}", parameter.key())));
            let error = gradient_error(&values, &references, &row.parameters());
            let bar = GRADIENT * critical_angle_factor(&row);
            assert!(
                error <= bar,
                "{name} line {} ({}): {prefix}… error {error:.1e}\n{values:?}\n{references:?}",
                row.line,
                row.text("case")
            );
            worst = worst.max(error);
        }
    }
    println!("{name}: worst gradient error {worst:.1e}");
}

#[test]
fn values_agree_with_sixty_digits() {
    values_agree("golden.csv");
}

#[test]
fn values_agree_with_sixty_digits_in_the_corners() {
    values_agree("golden_corners.csv");
}

#[test]
fn gradients_agree_with_sixty_digits() {
    gradients_agree("golden_jacobian.csv");
}

#[test]
fn gradients_agree_with_sixty_digits_in_the_corners() {
    gradients_agree("golden_corners.csv");
}

#[test]
fn the_stability_gallery_agrees_with_sixty_digits() {
    values_agree("stability_gallery.csv");
    gradients_agree("stability_gallery.csv");
}

#[test]
fn what_is_not_wanted_is_left_out_and_changes_nothing_else() {
    for row in table("golden_jacobian.csv").iter().step_by(5) {
        let (surface, facet) = (row.surface(), Facet::new(row.geometry()));
        let (whole, all) = surface.reflection_and_gradient(&facet, GradientRequest::ALL);
        for bits in 0_u16..512 {
            let by = Parameter::ALL.into_iter().filter(|&parameter| bits & (1 << parameter as u16) != 0).collect();
            for (brdf, dolp) in [(true, true), (true, false), (false, true)] {
                let (reflection, gradient) = surface.reflection_and_gradient(&facet, GradientRequest { by, brdf, dolp });
                assert_eq!(reflection.brdf, if brdf { whole.brdf } else { 0.0 });
                assert_eq!(reflection.dolp, if dolp { whole.dolp } else { 0.0 });
                for parameter in Parameter::ALL {
                    let (j, wanted) = (parameter as usize, by.contains(parameter));
                    assert_eq!(gradient.brdf[j], if brdf && wanted { all.brdf[j] } else { 0.0 }, "{parameter:?}");
                    assert_eq!(gradient.dolp[j], if dolp && wanted { all.dolp[j] } else { 0.0 }, "{parameter:?}");
                }
            }
        }
    }
}

//! The model against 60-digit arithmetic.
#![allow(clippy::expect_used, clippy::print_stdout, reason = "a test fails by panicking, and may tell its figures")]

mod common;

use common::{DARK_VALUE, gradient_error, relative_error, table};
use pbrdf::model::{GradientRequest, Parameter, PerParameter};
use pbrdf::optics::Facet;

/// Bar on the relative error of BRDF and DoLP: some 500 units in the last place, met by forms in which nothing cancels.
const VALUE: f64 = 1e-13;
/// Bar on the gradient, in the measure of [`gradient_error`].
const GRADIENT: f64 = 1e-12;

fn values_agree(name: &str) {
    let mut worst = (0.0, 0.0, 0.0);
    for row in table(name) {
        let reflection = row.surface().reflection(&Facet::new(row.geometry()));
        let bar = VALUE * row.critical_angle_factor();
        for (column, value) in [
            ("brdf", reflection.brdf),
            ("dolp", reflection.dolp),
            ("specular", reflection.specular),
            ("diffuse", reflection.diffuse),
            ("volume", reflection.volume),
        ] {
            let error = relative_error(value, row.number(column));
            let bar = if column == "dolp" && row.is_dark() { DARK_VALUE } else { bar };
            assert!(error <= bar, "{name} line {} ({}): {column} = {value:e}, relative error {error:.1e}", row.line, row.text("case"));
            match column {
                "dolp" if row.is_dark() => worst.2 = f64::max(worst.2, error),
                "brdf" => worst.0 = f64::max(worst.0, error),
                "dolp" => worst.1 = f64::max(worst.1, error),
                _ => {}
            }
        }
        let dolp = row.surface().dolp(&Facet::new(row.geometry()));
        assert_eq!(dolp, reflection.dolp, "{name} line {}: the short way to DoLP is another way", row.line);
    }
    println!("{name}: worst relative error {:.1e} in BRDF, {:.1e} in DoLP, {:.1e} in DoLP of dark lobes", worst.0, worst.1, worst.2);
}

fn gradients_agree(name: &str) {
    let mut worst: f64 = 0.0;
    for row in table(name) {
        let (_, gradient) = row.surface().reflection_and_gradient(&Facet::new(row.geometry()), GradientRequest::ALL);
        for (prefix, values) in [("dbrdf_d", gradient.brdf), ("ddolp_d", gradient.dolp)] {
            let references = PerParameter::from_fn(|parameter| row.number(&format!("{prefix}{}", parameter.key())));
            let error = gradient_error(&values, &references, &row.parameters());
            let of_dark = prefix == "ddolp_d" && row.is_dark();
            let bar = if of_dark { DARK_VALUE } else { GRADIENT * row.critical_angle_factor() };
            assert!(
                error <= bar,
                "{name} line {} ({}): {prefix}… error {error:.1e}\n{values:?}\n{references:?}",
                row.line,
                row.text("case")
            );
            worst = if of_dark { worst } else { worst.max(error) };
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
        for bits in 0_u16..1 << Parameter::COUNT {
            let by = Parameter::ALL.into_iter().filter(|&parameter| bits & (1 << parameter as u16) != 0).collect();
            for (brdf, dolp) in [(true, true), (true, false), (false, true)] {
                let (reflection, gradient) = surface.reflection_and_gradient(&facet, GradientRequest { by, brdf, dolp });
                assert_eq!(reflection.brdf, if brdf { whole.brdf } else { 0.0 });
                assert_eq!(reflection.dolp, if dolp { whole.dolp } else { 0.0 });
                for parameter in Parameter::ALL {
                    let wanted = by.contains(parameter);
                    assert_eq!(gradient.brdf[parameter], if brdf && wanted { all.brdf[parameter] } else { 0.0 }, "{parameter:?}");
                    assert_eq!(gradient.dolp[parameter], if dolp && wanted { all.dolp[parameter] } else { 0.0 }, "{parameter:?}");
                }
            }
        }
    }
}

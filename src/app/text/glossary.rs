//! What more than one panel says: errors of parameters, and what words mean.

use pbrdf::fit::{EstimateStatus, relative_error_base};
use pbrdf::model::Parameter;
use tr::tr;

/// An error in percent of the size of what it belongs to.
pub fn percent(parameter: Parameter, value: f64, error: f64) -> String {
    let percent = 100.0 * error / relative_error_base(parameter, value);
    if percent.is_finite() && percent < 1e4 { format!("{percent:.*} %", usize::from(percent < 10.0)) } else { "—".to_owned() }
}

/// What ΔE is.
pub fn delta_e_help() -> String {
    tr!("ΔE = Σ (X − Xm)² / Σ Xm², Eq. (18): the squared distance between model X and measurement Xm over that of the measurement from 0; \
         with DoLP and BRDF measured, the sum of both. 0 is a perfect fit.")
}

/// What the standing of an estimate means.
pub fn standing_help(standing: EstimateStatus) -> String {
    match standing {
        EstimateStatus::Fixed => tr!("The fit left it as it was."),
        EstimateStatus::AtBound(_) => {
            tr!("It rests on the end of its range: a better value may lie outside. There it has no standard error.")
        }
        EstimateStatus::Determined(_) => tr!("One standard error, linearised at the solution"),
        EstimateStatus::NoDegreesOfFreedom => {
            tr!("As many values as free parameters (no degree of freedom): nothing is left over to tell an error from.")
        }
        EstimateStatus::Undetermined => open_help(),
    }
}

/// What it means that data leave a parameter open.
pub fn open_help() -> String {
    tr!("The data leave it open: quite other values, together with other parameters, fit as well, so that it has no standard error.")
}

/// Headings of a list of minima.
pub fn minima_headings_ui(ui: &mut egui::Ui) {
    ui.strong("ΔE").on_hover_text(delta_e_help());
    ui.strong(tr!("reached")).on_hover_text(tr!("How many of the starts ended there"));
    ui.strong(tr!("stop")).on_hover_text(tr!("Why the best of them went no further"));
}

/// What AICc is.
pub fn aicc_help() -> String {
    tr!(
        "Akaike's criterion, corrected for few data: the smaller, the better a model is worth its parameters on the same data. A difference \
         below 2 means little, one above 10 decides."
    )
}

/// What a mask is.
pub fn mask_help() -> String {
    tr!("Masked rows stay in the file and are shown, but count in no fit and no statistic.")
}

/// That there are fewer measured values than free parameters, if so.
pub fn too_few(values: usize, free: usize) -> Option<String> {
    (values < free).then(|| {
        tr!(
            "{0} measured values cannot determine {1} free parameters: tick fixed for what you know, or measure at more angles.",
            values,
            free
        )
    })
}

/// Three significant digits, enough for an error.
pub fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(1e-4..1e4).contains(&value.abs()) {
        return format!("{value:.2e}");
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number of decimals from 0 to 6")]
    let decimals = (2.0 - libm::log10(value.abs()).floor()).clamp(0.0, 6.0) as usize;
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::{percent, short};
    use pbrdf::fit::is_poorly_determined;
    use pbrdf::model::Parameter;

    #[test]
    fn errors_are_judged_by_the_size_of_what_they_belong_to() {
        assert!(is_poorly_determined(Parameter::N, 2.0, 1.5) && !is_poorly_determined(Parameter::N, 2.0, 0.5));
        // q counts from 1.
        assert!(is_poorly_determined(Parameter::Q, 1.2, 0.15));
        assert_eq!(percent(Parameter::N, 2.0, 0.05), "2.5 %");
        assert_eq!(percent(Parameter::Kd, 0.0, 0.05), "—");
    }

    #[test]
    fn errors_are_shown_with_three_digits() {
        for (value, expected) in [(0.0, "0"), (2.3561, "2.36"), (-0.001_234, "-0.00123"), (1234.5, "1234"), (1e-7, "1.00e-7")] {
            assert_eq!(short(value), expected);
        }
    }
}

//! Files that release 0.1 wrote open with everything that they hold.
//!
//! `tests/fixtures/v0.1/README.md` says how each file was made. Beside each stands what that release showed after it had
//! opened the file.

use crate::app::shell::app::App;
use crate::app::storage::settings_file;
use crate::app::tests::{explorer, harness, wait};
use crate::app::views::action::Action;
use crate::app::work::layout::Layout;
use crate::app::work::settings::Settings;
use crate::app::work::surface::Surface;
use pbrdf::fit::{Loss, Starts};
use pbrdf::model::{DolpFormula, Parameter, Parameters, Preset};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Relative difference that arithmetic in another order may make. Fits without a record of how they
/// came about are made again; where the data determine little they end elsewhere in a flat valley.
const TOLERANCE: f64 = 1e-7;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/v0.1")
}

/// Names of the files that end so, without that ending.
fn names(ending: &str) -> Vec<String> {
    let entries = std::fs::read_dir(folder()).expect("the fixtures").map(|entry| entry.expect("an entry").file_name());
    let mut names: Vec<String> = entries.filter_map(|name| name.to_str()?.strip_suffix(ending).map(str::to_owned)).collect();
    names.sort();
    names
}

fn json_of(name: &str) -> Value {
    let text = std::fs::read_to_string(folder().join(name)).expect("a fixture");
    serde_json::from_str(&text).expect("JSON")
}

/// Asserts that two values are the same but for rounding of numbers.
fn assert_same(actual: &Value, expected: &Value, place: &str) {
    match (actual, expected) {
        (Value::Object(one), Value::Object(other)) => {
            assert_eq!(one.keys().collect::<Vec<_>>(), other.keys().collect::<Vec<_>>(), "{place}");
            // Uncertainties are those of the present analysis.
            let kept = one.iter().filter(|(key, _)| *key != "std_errors");
            kept.for_each(|(key, value)| assert_same(value, &other[key], &format!("{place}.{key}")));
        }
        (Value::Array(one), Value::Array(other)) if one.len() == other.len() => {
            one.iter().zip(other).enumerate().for_each(|(i, (one, other))| assert_same(one, other, &format!("{place}[{i}]")));
        }
        (Value::Number(one), Value::Number(other)) => {
            let (one, other) = (one.as_f64().expect("a number"), other.as_f64().expect("a number"));
            assert!((one - other).abs() <= TOLERANCE * other.abs(), "{place}: {one} instead of {other}");
        }
        _ => assert_eq!(actual, expected, "{place}"),
    }
}

#[test]
fn sessions_open() {
    let names = names(".pbrdf.json");
    assert!(names.len() >= 17, "{names:?}");
    for name in names {
        let mut window = harness();
        explorer(&mut window).actions.push(Action::OpenSession(folder().join(format!("{name}.pbrdf.json"))));
        wait(&mut window);
        let mut actual = view(explorer(&mut window));
        let mut expected = json_of(&format!("{name}.expected.json"));
        // The sentence about what a file lacks may be worded anew.
        let notice = actual["notice"].take();
        assert_eq!(notice.is_string(), expected["notice"].take().is_string(), "{name}: {notice}");
        assert_same(&actual, &expected, &name);
    }
}

#[test]
fn settings_are_read() {
    let names = names(".settings.json");
    assert!(names.len() >= 2, "{names:?}");
    for name in names {
        let (read, notice) = settings_file::load_from(&folder().join(format!("{name}.settings.json")));
        assert_eq!(notice, None, "{name}");
        let mut panes = Vec::new();
        panes_of(&read.layout, &mut panes);
        let actual = json!({
            "settings": settings_view(&read.settings.settings, &read.settings.surface),
            "theme": read.window.theme,
            "language": read.window.language,
            "size": read.window.size,
            "maximized": read.window.maximized,
            "show_frame_times": read.window.show_frame_times,
            "recent": read.window.recent,
            "panes": panes,
        });
        assert_same(&actual, &json_of(&format!("{name}.settings.expected.json")), &name);
    }
}

/// Panes of a layout, in its order.
fn panes_of(layout: &Layout, out: &mut Vec<&'static str>) {
    match layout {
        Layout::Pane(pane) => out.push(pane.key()),
        Layout::Tabs { parts, .. } => parts.iter().for_each(|part| panes_of(part, out)),
        Layout::Columns(parts) | Layout::Rows(parts) => parts.iter().for_each(|(_, part)| panes_of(part, out)),
    }
}

fn keys<'a>(parameters: impl IntoIterator<Item = &'a Parameter>) -> Vec<&'static str> {
    parameters.into_iter().map(|parameter| parameter.key()).collect()
}

/// Values in the order of the parameters' keys.
fn values(parameters: &Parameters) -> Value {
    json!(parameters.to_array())
}

/// Names of that release.
fn loss(loss: Loss) -> &'static str {
    match loss {
        Loss::Squared => "linear",
        Loss::Huber => "huber",
        Loss::SoftL1 => "soft-l1",
    }
}

fn formula(formula: DolpFormula) -> &'static str {
    match formula {
        DolpFormula::Consistent => "consistent",
        DolpFormula::AsPrinted => "printed",
    }
}

/// What the settings hold, under names of this test.
fn settings_view(settings: &Settings, surface: &Surface) -> Value {
    let locked: Vec<Parameter> = surface.locked.iter().collect();
    json!({
        "parameters": values(&surface.parameters),
        "preset": Preset::of(surface.model).map(|preset| preset.key),
        "model_parameters": keys(&surface.model.parameters().iter().collect::<Vec<_>>()),
        "locked": keys(&locked),
        "bounds": surface.bounds.iter().map(|(p, low, high)| json!([p.key(), low, high])).collect::<Vec<_>>(),
        "show_bounds": settings.show_bounds,
        "weights": settings.fit_options.weights,
        "brdf_residuals": settings.fit_options.brdf_residuals,
        "loss": loss(settings.fit_options.loss),
        "loss_scale": settings.fit_options.loss_scale,
        "dolp_formula": formula(surface.model.dolp_formula),
        "dolp_only": settings.fit_options.dolp_only,
        "starts": match settings.starts { Starts::One => json!("one"), Starts::Automatic => json!("automatic"), Starts::Exactly(n) => json!(n), Starts::Until(rule) => json!(rule) },
        "seed": settings.seed,
        "planned_theta_i": settings.design.theta_i.iter().flat_map(|span| span.angles()).collect::<Vec<f64>>(),
        "planned_theta_r": settings.design.theta_r.iter().flat_map(|span| span.angles()).collect::<Vec<f64>>(),
        "planned_dphi": settings.design.dphi,
        "planned_columns": settings.design.columns,
        "planned_noise": [settings.design.noise, settings.design.brdf_noise],
        "theta_i": settings.theta_i,
        "dphi": settings.dphi,
        "log_brdf": settings.log_brdf,
        "show_limit": settings.show_limit,
        "show_band": settings.show_band,
        "show_backscatter": settings.show_backscatter,
        "refit_live": settings.refit_live,
        "share": settings.view_options.share,
        "overlay": settings.view_options.overlay,
        "polar_log": settings.view_options.polar_log,
        "hemisphere": settings.view_options.hemisphere,
        "metal": settings.metal_selection.metal,
        "wavelength_nm": settings.metal_selection.wavelength_nm,
        "metal_source": settings.metal_selection.source,
        "follow": settings.metal_selection.follow,
        "landscape": [settings.panes.landscape.across.key(), settings.panes.landscape.up.key()],
        "landscape_contours": settings.panes.landscape.contours,
    })
}

/// What the window shows of the work that is open.
fn view(window: &App) -> Value {
    let work = &window.work;
    let mut panes = Vec::new();
    if let Some(layout) = window.dock.layout() {
        panes_of(&layout, &mut panes);
    }
    let on_screen: Vec<&str> = window.dock.on_screen().iter().map(|pane| pane.key()).collect();
    let rows = &work.active().measurement.rows;
    let fits: Vec<Value> = work.fit_history().iter().map(|fit| {
        let report = &fit.report;
        json!({
            "delta_e": report.objective,
            "sum_of_squares": report.statistics.rss,
            "start_delta_e": report.start_objective,
            "parameters": values(&report.parameters),
            "start": values(fit.problem.start()),
            "before": values(&fit.before),
            "free": keys(fit.problem.free()),
            "bounds": fit.problem.free().iter().map(|&p| { let (low, high) = fit.problem.bounds().of(p); json!([low, high]) }).collect::<Vec<_>>(),
            "std_errors": report.estimates.iter().map(|e| e.std_error).collect::<Vec<_>>(),
            "loss": loss(fit.problem.options().loss),
            "loss_scales": report.statistics.loss_scales,
            "dolp_formula": formula(fit.problem.model().dolp_formula),
            "brdf_residuals": fit.problem.options().brdf_residuals,
            "stop_reason": report.stop_reason,
            "residuals": fit.problem.len(),
            "evaluations": report.course.evaluations,
            "minima": report.course.minima.len(),
            "steps": report.course.trace.len(),
            "undetermined": report.undetermined.len(),
            "masked": fit.mask.to_vec(),
        })
    }).collect();
    json!({
        "name": work.active().name,
        "sha256": work.active().sha256,
        "rows": rows.len(),
        "dolp_values": rows.iter().filter(|row| row.dolp.is_some()).count(),
        "brdf_values": rows.iter().filter(|row| row.brdf.is_some()).count(),
        "masked": work.active().mask().to_vec(),
        "metadata_keys": work.active().measurement.metadata.iter().map(|(key, _)| key.clone()).collect::<Vec<_>>(),
        "panes": panes,
        "on_screen": on_screen,
        "settings": settings_view(work.settings(), work.surface()),
        "fits": fits,
        "shown_fit": work.shown_fit().and_then(|shown| work.fit_history().iter().position(|fit| Arc::ptr_eq(fit, shown))),
        "lesson_open": window.lessons.open().is_some(),
        "notice": window.toasts.text(),
    })
}

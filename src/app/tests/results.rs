//! The table of results, the history of fits, and what is exported of them.

use crate::app::shell::app::App;
use crate::app::storage::export::{ExportKind, SheetForm};
use crate::app::tests::{explorer, harness, wait};
use crate::app::views::action::{Action, ListAction};
use crate::app::work::edit::Edit;
use crate::app::work::pane_id::PaneId;
use crate::report::TableFormat;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use pbrdf::fit::Starts;
use pbrdf::model::{PRESETS, Parameter, Preset};

type Window = Harness<'static, Option<App>>;

fn order(harness: &mut Window, action: Action) {
    explorer(harness).actions.push(action);
    wait(harness);
}

/// The window with copper and aluminium open and fitted by one start each, and the pane Results in front.
fn with_two_fits() -> Window {
    let mut harness = harness();
    explorer(&mut harness).work.settings_mut().starts = Starts::One;
    for example in [1, 2] {
        order(&mut harness, Action::OpenExample(example));
        order(&mut harness, Action::StartFit);
    }
    explorer(&mut harness).dock.show(PaneId::Results);
    wait(&mut harness);
    harness
}

fn table(harness: &mut Window) -> String {
    explorer(harness).results().expect("a table").text(TableFormat::Csv, &crate::report::English)
}

#[test]
fn results_are_a_column_for_each_measurement_and_model_that_sorts_and_hides() {
    let mut harness = with_two_fits();
    let [copper, aluminium] = ["Copper 650 nm (simulated), cauchy", "Aluminium 650 nm (simulated), cauchy"];
    assert!(table(&mut harness).starts_with(&format!("parameter,\"{copper}\",\"{aluminium}\"\n")), "{}", table(&mut harness));
    let delta_e = |harness: &mut Window| -> Vec<f64> {
        explorer(harness).results().expect("a table").columns.iter().map(|column| column.delta_e.expect("a number")).collect()
    };
    harness.get_by_label("Sort by ΔE").click();
    harness.run();
    let upwards = delta_e(&mut harness);
    assert!(upwards[0] < upwards[1], "{upwards:?}");
    harness.get_by_label("Sort by ΔE").click();
    harness.run();
    assert_eq!(delta_e(&mut harness), [upwards[1], upwards[0]]);
    harness.get_by_label("Original order").click();
    harness.run();
    harness.get_by_label(copper).click();
    harness.run();
    harness.get_by_label("Hide this column").click();
    harness.run();
    // One measurement alone needs no name.
    assert!(table(&mut harness).starts_with("parameter,cauchy\n"), "{}", table(&mut harness));
    // The arrangement is part of the work, and follows a measurement to its new name.
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("work.pbrdf.json");
    order(&mut harness, Action::Export(ExportKind::Session, path.clone()));
    let mut again = self::harness();
    order(&mut again, Action::OpenSession(path));
    explorer(&mut again).dock.show(PaneId::Results);
    wait(&mut again);
    assert_eq!(table(&mut again), table(&mut harness));
    let number = explorer(&mut again).work.measurements().iter().next().expect("copper").number;
    explorer(&mut again).work.apply(Edit::RenameMeasurement { number, name: "Cu".to_owned() });
    wait(&mut again);
    assert_eq!(explorer(&mut again).results().expect("a table").columns.len(), 1);
    harness.get_by_label("Show hidden columns (1)").click();
    harness.run();
    assert!(table(&mut harness).contains(copper));
    // A second fit of a measurement by the same model takes the place of the first.
    order(&mut harness, Action::StartFit);
    assert_eq!(delta_e(&mut harness).len(), 2);
}

#[test]
fn results_are_copied_and_exported_in_three_forms() {
    let mut harness = with_two_fits();
    harness.get_by_label("LaTeX").click();
    harness.step();
    let copied = harness.output().platform_output.commands.iter().find_map(|command| match command {
        egui::OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    wait(&mut harness);
    let folder = tempfile::tempdir().expect("a folder");
    for (name, beginning) in [("r.csv", "parameter,"), ("r.md", "|  | "), ("r.tex", "% \\usepackage{booktabs}")] {
        let path = folder.path().join(name);
        order(&mut harness, Action::Export(ExportKind::Results, path.clone()));
        let text = std::fs::read_to_string(&path).expect("the export wrote it");
        assert!(text.starts_with(beginning), "{text}");
        if let Some(copied) = copied.as_ref().filter(|_| name == "r.tex") {
            assert_eq!(*copied, text);
        }
    }
    order(&mut harness, Action::Export(ExportKind::Results, folder.path().join("r.xlsx")));
    let sentence = explorer(&mut harness).toasts.take().expect("a sentence");
    assert!(sentence.contains(".csv, .md or .tex"), "{sentence}");
}

#[test]
fn fits_of_a_comparison_are_fits() {
    let mut harness = harness();
    explorer(&mut harness).work.settings_mut().starts = Starts::One;
    order(&mut harness, Action::CompareModels);
    assert_eq!(explorer(&mut harness).work.fit_history().len(), PRESETS.len());
    assert!(explorer(&mut harness).work.shown_fit().is_none(), "the sliders stay until a row is clicked");
    // Two models have the same terms; the row that was clicked is the one that is named.
    let thilak = Preset::from_key("fresnel").expect("a preset");
    let row = PRESETS.iter().position(|preset| preset.key == thilak.key).expect("a row");
    explorer(&mut harness).work.apply(Edit::UseModelFit(row));
    wait(&mut harness);
    assert_eq!(explorer(&mut harness).work.preset().map(|preset| preset.key), Some("fresnel"));
    let shown = explorer(&mut harness).work.shown_fit().expect("the fit of the row").clone();
    assert!(shown.problem.options().dolp_only);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("report.md");
    order(&mut harness, Action::Export(ExportKind::Report, path.clone()));
    assert!(std::fs::read_to_string(&path).expect("a report").contains("Thilak"));
    let columns = explorer(&mut harness).results().expect("a table").columns;
    let titles: Vec<&str> = columns.iter().map(|column| column.title.as_str()).collect();
    assert_eq!(titles, PRESETS.map(|preset| preset.key));
}

#[test]
fn the_history_names_file_model_and_values_and_a_click_brings_them_back() {
    let mut harness = with_two_fits();
    harness.get_by_label("History of fits (2)").click_accesskit();
    wait(&mut harness);
    let entry = explorer(&mut harness).work.fit_history().get(1, 0).expect("the first fit");
    let n = crate::report::bracketed(entry.report.estimate(Parameter::N).expect("an estimate"));
    assert!(harness.query_all_by_label(&format!("n = {n}")).count() >= 1);
    assert!(harness.query_all_by_label("all free but k_s").count() >= 1);
    harness.get_by_label("1. Copper 650 nm (simulated) · cauchy").click_accesskit();
    wait(&mut harness);
    let work = &explorer(&mut harness).work;
    assert_eq!((work.active().name.as_str(), work.surface().parameters), ("Copper 650 nm (simulated)", entry.report.parameters));
    assert_eq!(work.shown_fit().map(|fit| fit.id), Some(1));
}

#[test]
fn a_file_that_is_opened_again_has_its_fits_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("mine.csv");
    std::fs::write(&path, "theta_i,theta_r,dolp\n30,20,0.05\n30,40,0.1\n50,50,0.25\n50,60,0.3\n").expect("a file");
    let mut harness = harness();
    explorer(&mut harness).work.settings_mut().starts = Starts::One;
    order(&mut harness, Action::OpenMeasurements(vec![path.clone()]));
    order(&mut harness, Action::StartFit);
    let fitted = explorer(&mut harness).work.shown_fit().expect("a fit").report.parameters;
    order(&mut harness, Action::List(ListAction::Close(None)));
    assert!(explorer(&mut harness).work.shown_fit().is_none());
    order(&mut harness, Action::OpenMeasurements(vec![path]));
    let work = &explorer(&mut harness).work;
    assert_eq!(work.shown_fit().map(|fit| fit.report.parameters), Some(fitted));
    assert_eq!(work.fit_history().get(0, 0).map(|fit| fit.number), Some(work.active().number));
}

#[test]
fn a_table_of_a_fit_says_what_was_fitted_and_what_was_simulated() {
    let mut harness = with_two_fits();
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("fit.csv");
    order(&mut harness, Action::Export(ExportKind::Fitted, path.clone()));
    let text = std::fs::read_to_string(&path).expect("the export wrote it");
    let n = explorer(&mut harness).work.shown_fit().expect("a fit").report.parameters.n;
    for line in ["# simulated_n: 1.24".to_owned(), format!("# fitted_n: {n}; "), "# fitted_model: cauchy".to_owned()] {
        assert!(text.contains(&line), "{line} is missing in {text}");
    }
    assert!(!text.contains("\n# n: "), "the truth has a name of its own");
}

#[test]
fn plots_on_screen_are_exported_as_one_figure() {
    let mut harness = harness();
    let folder = tempfile::tempdir().expect("a folder");
    for (form, name) in SheetForm::ALL.into_iter().zip(["column.svg", "row.svg", "square.png"]) {
        let path = folder.path().join(name);
        order(&mut harness, Action::Export(ExportKind::Sheet(form), path.clone()));
        let bytes = std::fs::read(&path).expect("the export wrote it");
        if name.ends_with(".svg") {
            assert_eq!(String::from_utf8(bytes).expect("UTF-8").matches("<g transform=").count(), 2, "DoLP and lobes");
        } else {
            assert!(bytes.starts_with(b"\x89PNG"));
        }
    }
    explorer(&mut harness).dock.close(PaneId::Dolp);
    let open: Vec<PaneId> = explorer(&mut harness).dock.on_screen();
    open.into_iter().for_each(|pane| explorer(&mut harness).dock.close(pane));
    wait(&mut harness);
    if explorer(&mut harness).sheet(SheetForm::Row).is_none() {
        order(&mut harness, Action::Export(ExportKind::Sheet(SheetForm::Row), folder.path().join("none.svg")));
        assert!(explorer(&mut harness).toasts.take().is_some_and(|sentence| sentence.contains("no plot")));
    }
}

#[test]
fn a_figure_of_sliders_beside_the_fit_gives_the_band_a_name_of_its_own() {
    let mut harness = harness();
    explorer(&mut harness).work.settings_mut().starts = Starts::One;
    order(&mut harness, Action::StartFit);
    let names = |harness: &mut Window| -> Vec<String> {
        let figure = explorer(harness).figure(PaneId::Dolp).expect("a plot");
        let bands = figure.panels[0].series.iter().filter(|series| matches!(series.mark, crate::figure::Mark::Band { .. }));
        bands.map(|series| series.name.clone()).collect()
    };
    assert!(names(&mut harness).iter().all(|name| name.starts_with("θi = ")), "{:?}", names(&mut harness));
    let gauss = Preset::from_key("gauss").expect("a preset");
    order(&mut harness, Action::UseModel(gauss.key));
    let last_fit = "± 1 standard error of the last fit";
    assert!(names(&mut harness).iter().all(|name| name == last_fit), "{:?}", names(&mut harness));
    // The curve that the band belongs to is there, too.
    let figure = explorer(&mut harness).figure(PaneId::Dolp).expect("a plot");
    assert!(figure.panels[0].series.iter().any(|series| series.name == "last fit"), "the ghost has an entry");
}

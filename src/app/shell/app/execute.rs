//! Carries out what menus, keys, panes and panels ask for.

use crate::app::shell::app::App;
use crate::app::shell::app::fits::{compare_models, find_intervals, fit_each, start_bootstrap, start_fit, start_profile};
use crate::app::shell::app::inquiries;
use crate::app::shell::app::lesson::{end_lesson, keep_lesson, show_step};
use crate::app::shell::app::link;
use crate::app::shell::app::lists;
use crate::app::shell::app::open::{cancel_import, open, open_files, start_import};
use crate::app::shell::dialogs::OverwritePrompt;
use crate::app::shell::docking::Dock;
use crate::app::shell::file_dialogs::request_for;
use crate::app::shell::presentation;
use crate::app::shell::theme;
use crate::app::storage::export;
use crate::app::storage::export::ExportKind;
use crate::app::text::messages::WindowWording;
use crate::app::views::action::{Action, WindowAction};
use crate::app::views::table_text;
use crate::app::work::edit::Edit;
use crate::app::work::layout::Layout;
use crate::app::work::open_measurement::{EXAMPLES, OpenMeasurement};
use crate::app::work::pane_id::PaneId;
use crate::app::work::parameter_text;
use crate::app::work::settings::{SidePanel, SidePanels};
use crate::report::TableFormat;
use egui::ViewportCommand;
use pbrdf::model::{FINISHES, PRESETS, Parameters};
use pbrdf::selftest::Setting;
use std::path::PathBuf;
use tr::tr;

/// Carries out an action; the error is a sentence.
pub fn execute(app: &mut App, ctx: &egui::Context, action: Action) -> Result<(), String> {
    match action {
        Action::ChooseMeasurement | Action::ChooseFolder | Action::ChooseSession | Action::ChooseSave | Action::ChooseExport(_) => {
            request_for(app.work.active(), &action).map_or(Ok(()), |request| app.jobs.files.ask(request))?;
        }
        Action::OpenMeasurements(paths) => open_files(app, paths)?,
        Action::OpenSession(path) => app.jobs.files.open_session(path)?,
        Action::SaveSession => return execute(app, ctx, saving_session(app)),
        Action::Export(kind, path) => export(app, kind, path)?,
        Action::CopyPlot(pane) => ctx.copy_image(export::image(app.figure(pane))?),
        Action::CopyTable => copy_table(app, ctx),
        Action::CopyResults(format) => copy_results(app, ctx, format)?,
        Action::SaveNew(path) => write_new(app, ctx, path.clone(), Action::SaveMeasurement(path))?,
        Action::ExportNew(kind, path) => {
            kind.check(&path)?;
            write_new(app, ctx, path.clone(), Action::Export(kind, path))?;
        }
        Action::Replace => return app.dialogs.overwrite.take().map_or(Ok(()), |asked| execute(app, ctx, asked.command)),
        Action::KeepFile => app.dialogs.overwrite = None,
        Action::SaveMeasurement(path) => app.jobs.files.save(path, app.work.active().measurement.clone())?,
        Action::List(action) => lists::execute(app, action)?,
        Action::OpenExample(index) => open_example(app, index)?,
        Action::ShowStep(lesson, step) => show_step(app, lesson, step)?,
        Action::CloseLesson => end_lesson(app)?,
        Action::KeepLesson => keep_lesson(app)?,
        Action::Import => start_import(app)?,
        Action::CancelImport => cancel_import(app),
        Action::CancelLoading => app.jobs.files.cancel_load(),
        Action::StartFit => {
            app.window.panels.front = SidePanel::Fit;
            start_fit(app)?;
        }
        Action::FitEach => fit_each(app)?,
        Action::CancelFit => app.jobs.fits.fit.cancel(),
        Action::FindIntervals => find_intervals(app)?,
        Action::CancelIntervals => app.jobs.fits.intervals.cancel(),
        Action::Profile(parameter) => start_profile(app, parameter)?,
        Action::Bootstrap => start_bootstrap(app)?,
        Action::CancelScan => app.jobs.fits.cancel_scan(),
        Action::CompareModels => compare_shown(app)?,
        Action::CancelComparison => app.jobs.fits.compare.cancel(),
        Action::Inquire(action) => inquiries::execute(app, action)?,
        Action::RunBenchmark(id) => app.jobs.benchmarks.start(id)?,
        Action::ForgetBenchmark(id) => app.jobs.benchmarks.forget(id),
        Action::CancelBenchmark => app.jobs.benchmarks.cancel(),
        Action::UseCase(index) => use_case(app, index),
        Action::UseFit => app.work.apply(Edit::UseFit),
        Action::UseValuesBeforeFit => app.work.apply(Edit::UseValuesBeforeFit),
        Action::ReturnToFit(index) => {
            app.work.apply(Edit::ReturnToFit(index));
            app.jobs.fits.abandon_scan();
            find_intervals(app)?;
        }
        Action::Undo => app.work.apply(Edit::Undo),
        Action::Redo => app.work.apply(Edit::Redo),
        Action::Toggle(switch) => app.work.apply(Edit::SetSwitch(switch, !switch.is_on(app.work.settings()))),
        Action::CopyLink | Action::OpenLink(_) | Action::PasteParameters(_) => link::execute(app, ctx, action)?,
        Action::ResetParameters => app.work.apply(Edit::SetParameters(Parameters::default())),
        Action::UseFinish(index) => use_finish(app, index),
        Action::UseModel(key) => use_model(app, key),
        Action::CopyParameters => ctx.copy_text(parameter_text::text(&app.work.surface().parameters)),
        Action::RequestPaste => ctx.send_viewport_cmd(ViewportCommand::RequestPaste),
        Action::MarkDirection(picked) => app.derived.picked = Some(picked),
        Action::ShowOutlook(is_shown) => app.derived.is_outlook_shown = is_shown,
        Action::Window(action) => execute_window(app, ctx, action),
    }
    Ok(())
}

/// Carries out what changes how the window stands.
fn execute_window(app: &mut App, ctx: &egui::Context, action: WindowAction) {
    match action {
        WindowAction::ToggleFrameTimes => app.window.show_frame_times = !app.window.show_frame_times,
        WindowAction::ShowPane(pane) => app.dock.show(pane),
        WindowAction::ClosePane(pane) => app.dock.close(pane),
        WindowAction::FillWindow(pane) => app.dock.fill(pane),
        WindowAction::Present => presentation::toggle(app, ctx),
        WindowAction::ChooseTalkSlider(slider) => app.window.talk.toggle(slider),
        WindowAction::ToggleSpotlight => app.window.talk.spotlight = !app.window.talk.spotlight,
        WindowAction::TogglePanel(panel) => app.window.panels.toggle(panel),
        WindowAction::Zoom(step) => zoom(ctx, step),
        WindowAction::ResetLayout => reset_layout(app),
        WindowAction::ForgetRecent => app.window.recent.clear(),
        WindowAction::OpenPalette => app.dialogs.palette.open(),
        WindowAction::ShowHelp(page) => app.dialogs.help = Some(page),
        WindowAction::CloseHelp => app.dialogs.help = None,
        WindowAction::ShowTour(step) => app.dialogs.tour = Some(step),
        WindowAction::EndTour => {
            app.dialogs.tour = None;
            app.window.knows_tour = true;
        }
        WindowAction::DismissToast(place) => app.toasts.dismiss(place),
        WindowAction::DismissToasts => app.toasts.clear(),
        WindowAction::SetLanguage(language) => app.window.language = language,
        WindowAction::SetTheme(theme) => {
            app.window.theme = theme;
            theme::set(ctx, theme);
        }
        WindowAction::Quit => ctx.send_viewport_cmd(ViewportCommand::Close),
    }
}

/// Compares the models, with the pane that shows the comparison on screen.
fn compare_shown(app: &mut App) -> Result<(), String> {
    app.dock.show(PaneId::Models);
    compare_models(app)
}

/// Into the file that the session came from or went to last; asks where there is none.
fn saving_session(app: &App) -> Action {
    let kind = ExportKind::Session;
    app.work.session_file().map_or(Action::ChooseExport(kind), |path| Action::Export(kind, path.to_owned()))
}

fn use_finish(app: &mut App, index: usize) {
    if let Some(finish) = FINISHES.get(index) {
        app.work.apply(Edit::SetParameters(finish.on(app.work.surface().parameters)));
    }
}

fn use_model(app: &mut App, key: &str) {
    if let Some(preset) = PRESETS.iter().find(|preset| preset.key == key) {
        let formula = app.work.surface().model.dolp_formula;
        app.work.apply(Edit::SetModel(preset.model.with_dolp_formula(formula)));
    }
}

/// Writes into a file whose path was typed; asks first, if there is one already.
fn write_new(app: &mut App, ctx: &egui::Context, path: PathBuf, command: Action) -> Result<(), String> {
    if path.is_file() {
        app.dialogs.overwrite = Some(OverwritePrompt { path, command });
        return Ok(());
    }
    execute(app, ctx, command)
}

fn export(app: &mut App, kind: ExportKind, path: PathBuf) -> Result<(), String> {
    kind.check(&path)?;
    let figure = match kind {
        ExportKind::Plot(pane) => app.figure(pane),
        ExportKind::Sheet(form) => app.sheet(form),
        _ => None,
    };
    let write = if kind == ExportKind::Results { export::results(app.results())? } else { kind.snapshot(&app.work, figure)? };
    app.jobs.files.export(kind, app.work.revision(), path, write)
}

fn open_example(app: &mut App, index: usize) -> Result<(), String> {
    EXAMPLES.get(index).map_or(Ok(()), |example| app.jobs.files.open_text(example.name.to_owned(), example.text))
}

/// The table of results to the clipboard.
fn copy_results(app: &mut App, ctx: &egui::Context, format: TableFormat) -> Result<(), String> {
    let table = app.results().ok_or_else(|| tr!("There is no fit yet."))?;
    ctx.copy_text(table.text(format, &WindowWording));
    app.toasts.info(tr!("The table of results is copied."));
    Ok(())
}

/// The table of the pane Data to the clipboard.
fn copy_table(app: &mut App, ctx: &egui::Context) {
    ctx.copy_text(table_text(&app.work));
    let rows = app.work.active().measurement.rows.len();
    app.toasts.info(tr!("One row is copied; paste it into a spreadsheet." | "{n} rows are copied; paste them into a spreadsheet." % rows));
}

fn reset_layout(app: &mut App) {
    let layout = Layout::default();
    app.dock.rearrange(Dock::new(&layout));
    app.work.apply(Edit::SetLayout(layout));
    app.window.panels = SidePanels::default();
}

/// As the keys of the toolkit do it.
fn zoom(ctx: &egui::Context, step: i8) {
    match step {
        0 => ctx.set_zoom_factor(1.0),
        1.. => egui::gui_zoom::zoom_in(ctx),
        _ => egui::gui_zoom::zoom_out(ctx),
    }
}

/// Sliders, terms and angles of a case of the stability gallery; of a fit, its data as well.
fn use_case(app: &mut App, index: usize) {
    let Some(row) = app.benchmarks.stability.as_ref().and_then(|shown| shown.report.rows.get(index)) else { return };
    let (case, setting) = (row.case.clone(), row.setting.clone());
    match setting {
        Setting::Evaluation { model, parameters, geometry } => {
            app.work.apply(Edit::TakeValues { parameters, model });
            app.work.apply(Edit::SetDirection { theta_i: geometry.theta_i().0, dphi: geometry.dphi().0 });
        }
        Setting::Fit { model, start, measurement } => {
            open(app, OpenMeasurement::new(case.to_string(), measurement));
            app.work.apply(Edit::TakeValues { parameters: start, model });
        }
    }
}

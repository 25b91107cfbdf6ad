//! The window as a whole: what it holds, what happens before each frame, and how a frame is put together.

use crate::app::jobs::spawner::Spawner;
use crate::app::panels;
use crate::app::platform::Instant;
use crate::app::shell::autosave::AutosaveKey;
use crate::app::shell::command_palette::{Palette, palette_ui};
use crate::app::shell::commands;
use crate::app::shell::docking::{Dock, panes_ui};
use crate::app::shell::file_dialogs::request_for;
use crate::app::shell::frame_times::FrameTimes;
use crate::app::shell::help_ui::help_ui;
use crate::app::shell::import_dialog::ImportDialog;
use crate::app::shell::import_ui::import_ui;
use crate::app::shell::job_results::poll_jobs;
use crate::app::shell::lesson_session::LessonSession;
use crate::app::shell::lesson_ui::lesson_panel;
use crate::app::shell::lessons;
use crate::app::shell::lessons::Lessons;
use crate::app::shell::menu_bar::menu_ui;
use crate::app::shell::overwrite_ui::overwrite_ui;
use crate::app::shell::path_entry::{OverwritePrompt, PathEntry};
use crate::app::shell::status_bar::{notices_ui, status_ui};
use crate::app::shell::theme;
use crate::app::shell::toasts::Toasts;
use crate::app::storage::export::ExportKind;
use crate::app::storage::{export, settings_file};
use crate::app::tasks::jobs::Jobs;
use crate::app::text::help::Help;
use crate::app::text::i18n;
use crate::app::text::localized::Localized as _;
use crate::app::views::action::Action;
use crate::app::views::benchmarks::Benchmarks;
use crate::app::views::derived::Derived;
use crate::app::views::{Cx, Views};
use crate::app::work::document::{Document, EXAMPLES};
use crate::app::work::edit::Edit;
use crate::app::work::fit_setup::{free, problem, reason};
use crate::app::work::layout::Layout;
use crate::app::work::pane_id::PaneId;
use crate::app::work::parameter_text;
use crate::app::work::settings::{Settings, SettingsFile, Theme, WindowSettings};
use crate::app::work::workspace::Workspace;
use crate::figure::Figure;
use pbrdf::fit::{FitOptions, FitResult, Problem};
use pbrdf::measurement::Measurement;
use pbrdf::measurement::formats::ImportNote;
use pbrdf::model::{FINISHES, PRESETS, Parameter, ParameterSet, Parameters};
use pbrdf::selftest::Setting;
use std::io::Write as _;
use std::path::PathBuf;
use std::time::Duration;
use tr::tr;

/// The window.
pub struct App {
    pub work: Workspace,
    pub window: WindowSettings,
    /// Where the settings go; nowhere in tests.
    pub settings_file: Option<PathBuf>,
    pub derived: Derived,
    pub jobs: Jobs,
    /// What the program found out about itself.
    pub reports: Benchmarks,
    /// Whether the panel shows what the data would determine.
    pub show_predicted_errors: bool,
    pub notices: Toasts,
    pub views: Views,
    pub panes: Dock,
    pub palette: Palette,
    /// The page of help that is open.
    pub help: Option<Help>,
    /// A foreign file that waits for a choice.
    pub import: Option<ImportDialog>,
    pub lessons: Lessons,
    /// The user's own work, while a lesson is on.
    pub(crate) lesson_session: Option<Box<LessonSession>>,
    /// Whether a button of the mouse is down: axes then grow and do not shrink.
    pub dragging: bool,
    /// Paths typed by hand, where there is no file dialog.
    pub typed: PathEntry,
    /// A file that is asked about before it is replaced.
    pub replacing: Option<OverwritePrompt>,
    /// Where the working state goes; nowhere in tests.
    pub working_file: Option<PathBuf>,
    /// The working state as it was written last.
    pub(crate) autosaved: Option<AutosaveKey>,
    /// Since when it is another one.
    pub(crate) unsaved_since: Option<Instant>,
    pub actions: Vec<Action>,
    pub frame_times: FrameTimes,
    saved: SettingsFile,
    changed_at: Option<Instant>,
}

/// How long settings rest before they are written.
pub(crate) const SAVE_AFTER: Duration = Duration::from_millis(1500);

impl App {
    pub fn new(ctx: &egui::Context, stored: SettingsFile) -> Self {
        theme::install(ctx);
        i18n::install();
        i18n::set(stored.window.language);
        set_theme(ctx, stored.window.theme);
        let saved = stored.clone();
        let SettingsFile { settings, window } = stored;
        let spawner = {
            let ctx = ctx.clone();
            Spawner::new(move || ctx.request_repaint())
        };
        Self {
            saved,
            panes: Dock::new(&window.layout),
            work: Workspace::new(settings),
            window,
            settings_file: None,
            derived: Derived::default(),
            jobs: Jobs::new(spawner),
            reports: Benchmarks::default(),
            show_predicted_errors: false,
            notices: Toasts::default(),
            views: Views::default(),
            palette: Palette::default(),
            help: None,
            import: None,
            lessons: Lessons::default(),
            lesson_session: None,
            dragging: false,
            typed: PathEntry::default(),
            replacing: None,
            working_file: None,
            autosaved: None,
            unsaved_since: None,
            actions: Vec::new(),
            frame_times: FrameTimes::default(),
            changed_at: None,
        }
    }

    /// Opens the first example, and then the file if there is one: if that cannot be read, the example stays.
    pub fn begin(&mut self, file: Option<PathBuf>) {
        // Tests read no folders of the user.
        let own = self.settings_file.as_ref().and_then(|_| lessons::own_folder());
        self.read_lessons(own.as_deref());
        let example = &EXAMPLES[0];
        match pbrdf::measurement::Measurement::read(example.text.as_bytes()) {
            Ok(measurement) => self.take(example.name.to_owned(), measurement),
            Err(error) => self.say(tr!("The bundled example cannot be read: {}.", error.localized())),
        }
        self.actions.extend(file.map(Action::OpenMeasurement));
    }

    /// The bundled lessons and those of a folder, and a sentence for each that is none.
    pub(crate) fn read_lessons(&mut self, own: Option<&std::path::Path>) {
        let (lessons, faults) = Lessons::load(own);
        self.lessons = lessons;
        faults.into_iter().for_each(|sentence| self.say(sentence));
    }

    /// Shows a sentence over the plots until it is dismissed.
    pub fn say(&mut self, sentence: String) {
        self.notices.error(sentence);
    }

    /// Puts a measurement in the place of the active one.
    pub fn take(&mut self, name: String, measurement: Measurement) {
        self.open(Document::new(name, measurement));
    }

    /// Puts a measurement in the place of the active one.
    pub(crate) fn open(&mut self, document: Document) {
        self.import = None;
        for note in &document.measurement.notes {
            self.say(format!("{}: {}", document.name, note.localized()));
        }
        if !document.measurement.ignored_columns.is_empty() {
            let note = ImportNote::IgnoredColumns { names: document.measurement.ignored_columns.clone() };
            self.say(format!("{}: {note}.", document.name));
        }
        self.work.apply(Edit::Open(Box::new(document)));
        self.views = Views::default();
        self.jobs.fits.abandon();
    }

    /// Before each frame: results of jobs, dropped files, commands, what is derived, settings.
    pub fn logic(&mut self, ctx: &egui::Context) {
        for file in ctx.input(|input| input.raw.dropped_files.clone()) {
            self.actions.push(Action::OpenMeasurement(file.path().to_owned()));
        }
        i18n::set(self.window.language);
        self.listen_to_keys(ctx);
        self.jobs.spawner.begin_frame();
        poll_jobs(self);
        for command in std::mem::take(&mut self.actions) {
            if let Err(sentence) = self.execute(ctx, command) {
                self.say(sentence);
            }
        }
        self.dragging = ctx.input(|input| input.pointer.any_down());
        self.refit_if_moved();
        if !self.dragging && !self.jobs.fits.refit.is_running() {
            self.work.record_step();
        }
        self.refresh();
        self.remember_window(ctx);
        self.save_when_rested(ctx);
        self.autosave_when_rested(ctx);
    }

    /// Makes anew what is on screen and has other inputs than before.
    fn refresh(&mut self) {
        self.derived.refresh_status(&self.work.settings, &self.work.document);
        let free = self.free();
        self.derived.refresh_outlook(&self.work.settings, &self.work.document, free, self.show_predicted_errors);
        self.refresh_import();
        self.panes.activate_tabs();
        let on_screen = self.panes.on_screen();
        let mut draft = self.work.settings.clone();
        let (mut cx, views, _) = self.split(&mut draft);
        views.refresh(&on_screen, &mut cx);
    }

    /// What panes get to see, the panes, and where they lie.
    ///
    /// They write to the draft of the settings; [`App::apply_draft`] turns its differences into edits.
    fn split<'a>(&'a mut self, settings: &'a mut Settings) -> (Cx<'a>, &'a mut Views, &'a mut Dock) {
        let Workspace { document, shown_fit, fit_history, model_comparison, diagnostics, .. } = &mut self.work;
        let cx = Cx {
            settings,
            document,
            fit: shown_fit.as_ref(),
            fits: fit_history,
            comparison: model_comparison,
            diagnostics,
            derived: &mut self.derived,
            jobs: &self.jobs,
            benchmarks: &mut self.reports,
            actions: &mut self.actions,
            interacting: self.dragging,
        };
        (cx, &mut self.views, &mut self.panes)
    }

    /// Makes the work what the draft says.
    fn apply_draft(&mut self, draft: &Settings) {
        Edit::between(&self.work.settings, draft).into_iter().for_each(|edit| self.work.apply(edit));
    }

    /// The figure of a pane, for files and the clipboard.
    pub fn figure(&mut self, pane: PaneId) -> Option<Figure> {
        let mut draft = self.work.settings.clone();
        let (cx, views, _) = self.split(&mut draft);
        views.figure(pane, &cx)
    }

    fn listen_to_keys(&mut self, ctx: &egui::Context) {
        // Keys belong to the field that is being typed into, or to the question that is asked.
        if ctx.text_edit_focused() || self.import.is_some() || self.replacing.is_some() {
            return;
        }
        self.actions.extend(commands::pressed(self, ctx));
        let text = |event: &egui::Event| if let egui::Event::Paste(text) = event { Some(text.clone()) } else { None };
        let pasted = ctx.input(|input| input.events.iter().find_map(text));
        self.actions.extend(pasted.map(Action::PasteParameters));
    }

    /// Fits what is free again after a slider was moved, one fit at a time.
    fn refit_if_moved(&mut self) {
        let parameters = self.work.settings.parameters;
        if !self.work.settings.refit_live
            || self.jobs.fits.refit.is_running()
            || self.jobs.fits.fit.is_running()
            || self.work.last_refit_at == Some(parameters)
        {
            return;
        }
        self.work.last_refit_at = Some(parameters);
        if parameters.validate(self.work.settings.model.parameters()).is_err() || self.free().is_empty() {
            return;
        }
        let Settings { model, choices, .. } = self.work.settings;
        // Why a fit is not possible is said when one is asked for.
        if let Ok(problem) = problem(&self.work.settings, &self.work.document.measurement, model, self.free(), choices)
            && let Err(sentence) = self.jobs.fits.refit(problem)
        {
            self.say(sentence);
        }
    }

    fn compare_models(&mut self) -> Result<(), String> {
        let Self { work: Workspace { settings, document, .. }, .. } = self;
        let problems = PRESETS.iter().map(|preset| {
            let choices = FitOptions { dolp_only: preset.dolp_only, ..settings.choices };
            let model = preset.model.with_dolp_formula(settings.model.dolp_formula);
            let free = pbrdf::fit::free_by_default(model, &document.measurement, &choices);
            let problem = problem(settings, &document.measurement, model, free, choices);
            (preset, problem)
        });
        let problems = problems.collect();
        self.work.apply(Edit::SetModelComparison(Vec::new()));
        self.jobs.fits.compare(problems, self.work.settings.starts, self.work.settings.seed)
    }

    pub(crate) fn execute(&mut self, ctx: &egui::Context, command: Action) -> Result<(), String> {
        match command {
            Action::ChooseMeasurement | Action::ChooseSession | Action::ChooseSave | Action::ChooseExport(_) => {
                request_for(&self.work.document, &command).map_or(Ok(()), |request| self.jobs.files.ask(request))?;
            }
            Action::OpenMeasurement(path) if export::ExportKind::Session.check(&path).is_ok() => {
                self.jobs.files.open_session(path)?;
            }
            Action::OpenMeasurement(path) => self.jobs.files.open(path)?,
            Action::OpenSession(path) => self.jobs.files.open_session(path)?,
            Action::SaveSession => self.save_session(ctx)?,
            Action::Export(what, path) => self.export(what, path)?,
            Action::CopyPlot(pane) => ctx.copy_image(export::image(self.figure(pane))?),
            Action::CopyTable => self.copy_table(ctx),
            Action::SaveNew(_) | Action::ExportNew(..) | Action::Replace | Action::KeepFile => self.write_typed(ctx, command)?,
            Action::SaveMeasurement(path) => self.jobs.files.save(path, self.work.document.measurement.clone())?,
            Action::Mask { rows, masked } => self.work.apply(Edit::Mask { rows, masked }),
            Action::OpenExample(index) => self.open_example(index)?,
            Action::ShowStep(lesson, step) => self.show_step(lesson, step)?,
            Action::CloseLesson => self.end_lesson()?,
            Action::KeepLesson => self.keep_lesson(),
            Action::ImportDialog => self.start_import()?,
            Action::CancelImport => self.cancel_import(),
            Action::CancelLoading => self.jobs.files.cancel_load(),
            Action::StartFit => self.start_fit()?,
            Action::CancelFit => self.jobs.fits.fit.cancel(),
            Action::UseFit => self.work.apply(Edit::UseFit),
            Action::Back => self.work.apply(Edit::UseValuesBeforeFit),
            Action::DismissNotices => self.notices.clear(),
            Action::Undo => self.work.apply(Edit::Undo),
            Action::Redo => self.work.apply(Edit::Redo),
            Action::CopyParameters => ctx.copy_text(parameter_text::text(&self.work.settings.parameters)),
            Action::RequestPaste => ctx.send_viewport_cmd(egui::ViewportCommand::RequestPaste),
            Action::PasteParameters(text) => {
                let parameters = parameter_text::read(&text, self.work.settings.parameters)?;
                self.work.apply(Edit::SetParameters(parameters));
            }
            Action::SetParameters(values) => self.set_parameters(values),
            Action::UseFinish(index) => self.use_finish(index),
            Action::ResetParameters => self.work.apply(Edit::SetParameters(Parameters::default())),
            Action::UseModel(key) => self.use_model(key),
            Action::ReturnTo(index) => self.return_to(index),
            Action::Profile(parameter) => self.start_profile(parameter)?,
            Action::Bootstrap => self.start_bootstrap()?,
            Action::CancelScan => self.jobs.fits.cancel_scan(),
            Action::UseRung(index) => self.work.apply(Edit::UseModelFit(index)),
            Action::CompareModels => {
                self.panes.show(PaneId::Models);
                self.compare_models()?;
            }
            Action::MakeReport(subject) => self.jobs.benchmarks.start(subject)?,
            Action::ForgetReport(subject) => self.jobs.benchmarks.forget(subject),
            Action::CancelReport => self.jobs.benchmarks.cancel(),
            Action::UseCase(index) => self.use_case(index),
            Action::CancelComparison => self.jobs.fits.compare.cancel(),
            Action::Toggle(switch) => {
                let on = switch.is_on(&self.work.settings);
                self.work.apply(Edit::SetSwitch(switch, !on));
            }
            Action::ToggleFrameTimes => self.window.show_frame_times = !self.window.show_frame_times,
            Action::TogglePane(pane) if self.panes.is_on_screen(pane) => self.panes.close(pane),
            Action::TogglePane(pane) => self.panes.show(pane),
            Action::ClosePane(pane) => self.panes.close(pane),
            Action::ResetLayout => self.panes = Dock::new(&Layout::default()),
            Action::ForgetRecent => self.window.recent.clear(),
            Action::OpenPalette => self.palette.open(),
            Action::ShowHelp(page) => self.help = Some(page),
            Action::CloseHelp => self.help = None,
            Action::SetLanguage(language) => self.window.language = language,
            Action::SetTheme(theme) => {
                self.window.theme = theme;
                set_theme(ctx, theme);
            }
            Action::Quit => ctx.send_viewport_cmd(egui::ViewportCommand::Close),
        }
        Ok(())
    }

    fn export(&mut self, what: ExportKind, path: PathBuf) -> Result<(), String> {
        what.check(&path)?;
        let figure = if let ExportKind::Plot(pane) = what { self.figure(pane) } else { None };
        let write = what.snapshot(&self.work, self.shown_layout(), figure)?;
        self.jobs.files.export(what, path, write)
    }

    fn open_example(&mut self, index: usize) -> Result<(), String> {
        EXAMPLES.get(index).map_or(Ok(()), |example| self.jobs.files.open_text(example.name.to_owned(), example.text))
    }

    fn set_parameters(&mut self, values: Vec<(Parameter, f64)>) {
        values.into_iter().for_each(|(parameter, value)| self.work.apply(Edit::SetParameter(parameter, value)));
    }

    fn use_finish(&mut self, index: usize) {
        if let Some(finish) = FINISHES.get(index) {
            self.work.apply(Edit::SetParameters(finish.on(self.work.settings.parameters)));
        }
    }

    fn use_model(&mut self, key: &str) {
        if let Some(preset) = PRESETS.iter().find(|preset| preset.key == key) {
            let formula = self.work.settings.model.dolp_formula;
            self.work.apply(Edit::SetModel(preset.model.with_dolp_formula(formula)));
        }
    }

    /// The table of the pane Data to the clipboard.
    fn copy_table(&mut self, ctx: &egui::Context) {
        ctx.copy_text(crate::app::views::table_text(&self.work.settings, &self.work.document));
        self.notices.info(tr!("{} rows are copied; paste them into a spreadsheet.", self.work.document.measurement.rows.len()));
    }

    fn start_bootstrap(&mut self) -> Result<(), String> {
        self.work.apply(Edit::SetBootstrap(None));
        match self.shown_fit() {
            Some((problem, report)) => self.jobs.fits.bootstrap(problem, report, self.work.diagnostics.replicates, self.work.settings.seed),
            None => Ok(()),
        }
    }

    fn start_profile(&mut self, parameter: Parameter) -> Result<(), String> {
        self.work.apply(Edit::SetProfile(None));
        match self.shown_fit() {
            Some((problem, report)) => self.jobs.fits.profile(problem, report, parameter),
            None => Ok(()),
        }
    }

    /// The parameters that a fit would change: those that the data can speak of, less the locked ones.
    pub fn free(&self) -> ParameterSet {
        free(&self.work.settings, self.work.document.measurement.has_brdf())
    }

    /// Sliders, model and results as an earlier fit left them.
    fn return_to(&mut self, index: usize) {
        self.work.apply(Edit::ReturnToFit(index));
        self.jobs.fits.abandon_scan();
    }

    /// Sliders, terms and angles of a case of the stability gallery; of a fit, its data as well.
    fn use_case(&mut self, index: usize) {
        let Some(row) = self.reports.stability.as_ref().and_then(|shown| shown.report.rows.get(index)) else { return };
        let (case, setting) = (row.case.clone(), row.setting.clone());
        match setting {
            Setting::Evaluation { model, parameters, geometry } => {
                self.work.apply(Edit::TakeValues { parameters, model });
                self.work.apply(Edit::SetDirection { theta_i: geometry.theta_i().0, dphi: geometry.dphi().0 });
            }
            Setting::Fit { model, start, measurement } => {
                self.take(case.to_string(), measurement);
                self.work.apply(Edit::TakeValues { parameters: start, model });
                self.work.session_file = None;
            }
        }
    }

    /// The fit that is shown, with the problem that it solved.
    fn shown_fit(&self) -> Option<(Problem, FitResult)> {
        let fit = self.work.shown_fit.as_ref()?;
        // An automatic scale of the loss belongs to the fit, not to its problem.
        Some((fit.problem.with_loss_scales(fit.report.statistics.loss_scales), fit.report.clone()))
    }

    fn start_fit(&mut self) -> Result<(), String> {
        let Settings { model, parameters, choices, starts, seed, .. } = self.work.settings;
        parameters.validate(model.parameters()).map_err(|error| tr!("The fit cannot begin: {}.", error.localized()))?;
        let measurement = &self.work.document.measurement;
        match problem(&self.work.settings, measurement, model, self.free(), choices) {
            Ok(problem) => self.jobs.fits.fit(problem, &self.work.document, starts, seed),
            Err(error) => Err(tr!("The fit cannot begin: {}.", reason(&error, measurement))),
        }
    }

    fn remember_window(&mut self, ctx: &egui::Context) {
        let (size, maximized) = ctx.input(|input| (input.viewport().inner_rect.map(|rect| rect.size()), input.viewport().maximized));
        self.window.maximized = maximized.unwrap_or(false);
        if let Some(size) = size.filter(|_| !self.window.maximized) {
            self.window.size = [size.x.round(), size.y.round()];
        }
        // While all panes are closed, the arrangement before that is kept; that of a lesson goes with it.
        if let Some(layout) = self.panes.layout().filter(|_| self.lesson_session.is_none()) {
            self.window.layout = layout;
        }
    }

    fn save_when_rested(&mut self, ctx: &egui::Context) {
        if !self.is_changed() {
            self.changed_at = None;
            return;
        }
        let begun = *self.changed_at.get_or_insert_with(Instant::now);
        if begun.elapsed() >= SAVE_AFTER {
            self.save();
        } else {
            ctx.request_repaint_after(SAVE_AFTER);
        }
    }

    fn is_changed(&self) -> bool {
        self.own_work().settings != self.saved.settings || self.window != self.saved.window
    }

    /// Writes the settings now.
    pub fn save(&mut self) {
        self.changed_at = None;
        self.saved = SettingsFile { settings: self.own_work().settings.clone(), window: self.window.clone() };
        if let Some(path) = &self.settings_file
            && let Err(error) = settings_file::save(path, &self.saved)
        {
            let sentence = tr!("The settings cannot be saved to {0}: {1}.", path.display(), error.localized());
            self.settings_file = None;
            self.say(sentence);
        }
    }

    fn parameters_ui(&mut self, ui: &mut egui::Ui) {
        let (mut draft, mut refusals) = (self.work.settings.clone(), Vec::new());
        panels::parameters_ui(&mut draft, &mut refusals, &|parameter| self.lessons.range(parameter), ui);
        self.apply_draft(&draft);
        refusals.into_iter().for_each(|sentence| self.say(sentence));
    }

    fn fit_ui(&mut self, ui: &mut egui::Ui) {
        let mut shown = self.show_predicted_errors;
        let mut draft = self.work.settings.clone();
        let (mut cx, ..) = self.split(&mut draft);
        panels::fit_ui(&mut cx, &mut shown, ui);
        self.apply_draft(&draft);
        self.show_predicted_errors = shown;
    }

    fn panes_ui(&mut self, ui: &mut egui::Ui) {
        let mut draft = self.work.settings.clone();
        let (mut cx, views, dock) = self.split(&mut draft);
        panes_ui(dock, views, &mut cx, ui);
        self.apply_draft(&draft);
    }

    /// One frame.
    pub fn ui(&mut self, ui: &mut egui::Ui) {
        egui::Panel::top("menu").show(ui, |ui| menu_ui(self, ui));
        egui::Panel::bottom("status").show(ui, |ui| status_ui(self, ui));
        egui::Panel::left("parameters").exact_size(366.0).resizable(false).show(ui, |ui| self.parameters_ui(ui));
        egui::Panel::right("fit")
            .default_size(if ui.ctx().content_rect().width() < 1200.0 { 270.0 } else { 320.0 })
            .min_size(250.0)
            .show(ui, |ui| self.fit_ui(ui));
        egui::CentralPanel::default().frame(egui::Frame::central_panel(ui.style()).inner_margin(2)).show(ui, |ui| {
            lesson_panel(self, ui);
            let room = ui.available_rect_before_wrap();
            self.panes_ui(ui);
            notices_ui(self, ui, room);
        });
        palette_ui(self, ui);
        import_ui(self, ui);
        overwrite_ui(self, ui);
        help_ui(self, ui);
    }
}

fn set_theme(ctx: &egui::Context, theme: Theme) {
    ctx.set_theme(match theme {
        Theme::System => egui::ThemePreference::System,
        Theme::Light => egui::ThemePreference::Light,
        Theme::Dark => egui::ThemePreference::Dark,
    });
}

impl eframe::App for App {
    fn logic(&mut self, ctx: &egui::Context, _frame: &mut eframe::Frame) {
        Self::logic(self, ctx);
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        if let Some(seconds) = frame.info().cpu_usage {
            self.frame_times.push(seconds, self.views.lag(&self.panes.on_screen()));
        }
        Self::ui(self, ui);
    }

    fn on_exit(&mut self, _gl: Option<&eframe::glow::Context>) {
        if self.window.show_frame_times {
            // Where drawing is too slow, or switched off, to read the status line.
            let _ = writeln!(std::io::stderr(), "{}", self.frame_times.text());
        }
        if self.is_changed() {
            self.save();
        }
        self.autosave_now();
    }
}

//! Everything that can be ordered, in one table: menus, keyboard and palette read it, and so does a
//! test for clashes.

use crate::app::platform;
use crate::app::shell::app::App;
use crate::app::shell::app::autosave::work_title;
use crate::app::storage::export::{ExportKind, SheetForm};
use crate::app::tasks::benchmarks::BenchmarkId;
use crate::app::text::help::Help;
use crate::app::text::i18n;
use crate::app::text::i18n::Language;
use crate::app::text::i18n::translated;
use crate::app::views;
use crate::app::views::action::{Action, InquiryAction, ListAction, WindowAction};
use crate::app::views::spec;
use crate::app::work::edit::Switch;
use crate::app::work::open_measurement::EXAMPLES;
use crate::app::work::pane_id::PaneId;
use crate::app::work::settings::{SidePanel, Theme};
use crate::app::work::sharing::Sharing;
use crate::report::TableFormat;
use egui::{Key, KeyboardShortcut, Modifiers};
use pbrdf::fit::GeodesicWay;
use pbrdf::model::{FINISHES, PRESETS};
use std::borrow::Cow;
use tr::tr;

/// The menu that a command stands in, in the order of the bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Menu {
    File,
    Example,
    Recent,
    Export,
    Edit,
    Measurement,
    Fit,
    Pane,
    /// Panes that judge the program itself.
    Program,
    View,
    Theme,
    Language,
    Lesson,
    Help,
    /// The palette alone.
    None,
}

impl Menu {
    /// What it is called; the palette alone has no name.
    pub fn name(self) -> String {
        match self {
            Self::File => tr!("File"),
            Self::Example => tr!("Examples"),
            Self::Recent => tr!("Recent"),
            Self::Export => tr!("Export"),
            Self::Edit => tr!("Edit"),
            Self::Measurement => tr!("Measurements"),
            Self::Fit => tr!("Fitting"),
            Self::Pane => tr!("Panes"),
            Self::Program => tr!("The program itself"),
            Self::View => tr!("View"),
            Self::Theme => tr!("Theme"),
            Self::Language => tr!("Language"),
            Self::Lesson => tr!("Lessons"),
            Self::Help => tr!("Help"),
            Self::None => String::new(),
        }
    }
}

/// Whether a command can be carried out now, and for a switch where it stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Availability {
    Impossible,
    Possible,
    Off,
    On,
}

/// A command as menus and the palette show it.
#[derive(Debug, Clone)]
pub struct Command {
    pub action: Action,
    pub menu: Menu,
    pub text: Cow<'static, str>,
    pub tooltip: Cow<'static, str>,
    pub shortcut: Option<KeyboardShortcut>,
    pub status: Availability,
}

impl Command {
    /// What it does; where that does not say why it cannot be carried out, the reason.
    pub fn why_disabled(&self) -> String {
        match self.action {
            Action::ChooseExport(ExportKind::Plot(pane)) | Action::CopyPlot(pane) => {
                tr!("Open the pane {} first (menu View).", translated(spec(pane).title))
            }
            Action::ChooseExport(ExportKind::Sheet(_)) => tr!("Bring two panes with plots to the screen first (menu View)."),
            Action::ChooseExport(ExportKind::Fitted | ExportKind::Report | ExportKind::Results)
            | Action::CopyResults(_)
            | Action::UseFit
            | Action::List(ListAction::PinFit)
            | Action::UseValuesBeforeFit
            | Action::Bootstrap
            | Action::Inquire(InquiryAction::Walk(_)) => {
                tr!("Fit first (F5).")
            }
            _ => self.tooltip.to_string(),
        }
    }
}

struct Entry {
    action: Action,
    menu: Menu,
    text: &'static str,
    tooltip: &'static str,
    shortcut: Option<KeyboardShortcut>,
    status: fn(&App) -> Availability,
}

const fn ctrl(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::COMMAND, key))
}

const fn ctrl_shift(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), key))
}

const fn plain(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::NONE, key))
}

const fn alt(key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(Modifiers::ALT, key))
}

fn has_rows(app: &App) -> Availability {
    only_if(app.work.measurements().has_rows())
}

fn has_several(app: &App) -> Availability {
    only_if(app.work.measurements().iter().count() > 1)
}

fn always(_: &App) -> Availability {
    Availability::Possible
}

fn only_if(possible: bool) -> Availability {
    if possible { Availability::Possible } else { Availability::Impossible }
}

fn switch(on: bool) -> Availability {
    if on { Availability::On } else { Availability::Off }
}

/// One row: what it orders, where it stands, what it is called, what it does, its keys, and whether
/// it is possible.
const fn row(
    action: Action,
    menu: Menu,
    text: &'static str,
    tooltip: &'static str,
    shortcut: Option<KeyboardShortcut>,
    status: fn(&App) -> Availability,
) -> Entry {
    Entry { action, menu, text, tooltip, shortcut, status }
}

/// Commands that are always the same; those of examples, recent files, panes, models and themes
/// follow from their own tables.
#[rustfmt::skip]
static ENTRIES: &[Entry] = &[
    row(Action::ChooseMeasurement, Menu::File, "Open measurements…", "Tables of DoLP or BRDF against angles, beside those that are open", ctrl(Key::O), always),
    row(Action::ChooseFolder, Menu::File, "Open a folder…", "Every measurement of a folder as a series, beside those that are open", None, always),
    row(Action::ChooseSave, Menu::File, "Save measurement as…", "The table of the active measurement with its masks, as CSV", None, always),
    row(Action::ChooseSession, Menu::File, "Open session…", "Sliders, data, masks, fits and layout as they were saved", ctrl_shift(Key::O),
        always),
    row(Action::SaveSession, Menu::File, "Save session", "Sliders, data, masks, fits and layout in one file that opens on any machine",
        ctrl(Key::S), always),
    row(Action::ChooseExport(ExportKind::Session), Menu::File, "Save session as…", "The session into another file", ctrl_shift(Key::S), always),
    row(Action::ChooseExport(ExportKind::Curves), Menu::Export, "Curves as CSV…", "DoLP, limit, BRDF and terms along every measured θi", None,
        always),
    row(Action::ChooseExport(ExportKind::Fitted), Menu::Export, "Fit as CSV…", "The measurement with model and residuals beside it", None,
        |app| only_if(app.work.shown_fit().is_some())),
    row(Action::ChooseExport(ExportKind::Results), Menu::Export, "Table of results…",
        "Fits side by side as the pane Results shows them: CSV, Markdown, or LaTeX with booktabs", None, |app| only_if(!app.work.fit_history().is_empty())),
    row(Action::CopyResults(TableFormat::Csv), Menu::Edit, "Copy results as CSV", "The table of the pane Results, for a spreadsheet", None,
        |app| only_if(!app.work.fit_history().is_empty())),
    row(Action::CopyResults(TableFormat::Markdown), Menu::Edit, "Copy results as Markdown", "The table of the pane Results, for a text", None,
        |app| only_if(!app.work.fit_history().is_empty())),
    row(Action::CopyResults(TableFormat::Latex), Menu::Edit, "Copy results as LaTeX", "The table of the pane Results, for a paper, with booktabs", None,
        |app| only_if(!app.work.fit_history().is_empty())),
    row(Action::ChooseExport(ExportKind::Report), Menu::Export, "Fit as a report…",
        "HTML in one file, or Markdown: data, model, parameters with errors, what is open, figures", ctrl(Key::R),
        |app| only_if(app.work.shown_fit().is_some())),
    row(Action::ChooseExport(ExportKind::Draws), Menu::Export, "Draws as CSV…", "A row for each draw from the posterior, a column for each free parameter",
        None, |app| only_if(app.work.posterior().is_some())),
    row(Action::ChooseExport(ExportKind::Plan), Menu::Export, "Plan of angles as CSV…",
        "The planned readings as an empty table to fill in, in an order of little movement", None,
        |app| only_if(!app.work.settings().design.readings.is_empty())),
    row(Action::ChooseExport(ExportKind::Picture), Menu::Export, "Picture as numbers…",
        "What the pane Picture shows: Stokes vectors as EXR or CSV, colours as PNG", None, always),
    row(Action::CancelLoading, Menu::File, "Cancel reading", "Stop reading the file", None, |app| only_if(app.jobs.files.reading_fraction().is_some())),
    row(Action::Window(WindowAction::Quit), Menu::File, "Quit", "Sliders, views and layout are kept", ctrl(Key::Q), always),
    row(Action::Undo, Menu::Edit, "Undo", "Sliders, model, switches, views and masks as they were", ctrl(Key::Z),
        |app| only_if(app.work.can_undo())),
    row(Action::Redo, Menu::Edit, "Redo", "Forth again; also with Ctrl+Y", ctrl_shift(Key::Z), |app| only_if(app.work.can_redo())),
    row(Action::CopyLink, Menu::Edit, "Copy link", "Sliders, data, fits, panes and the open lesson as a link, which opens in a browser and in this window", None, always),
    row(Action::CopyParameters, Menu::Edit, "Copy parameters", "All nine as text: n=2, k=3, …", ctrl_shift(Key::C), always),
    row(Action::RequestPaste, Menu::Edit, "Paste parameters", "From text such as n=2.07, k=2.9; those that it does not name stay",
        ctrl_shift(Key::V), always),
    row(Action::ResetParameters, Menu::Edit, "Reset all parameters", "All nine parameters to their defaults", None, always),
    row(Action::CopyTable, Menu::Edit, "Copy data table", "Every row as the pane Data shows it, with tabs between cells as spreadsheets want them", None, always),
    row(Action::List(ListAction::Step(1)), Menu::Measurement, "Next measurement", "The measurement below the active one to the sliders", ctrl(Key::PageDown),
        has_several),
    row(Action::List(ListAction::Step(-1)), Menu::Measurement, "Previous measurement", "The measurement above the active one to the sliders",
        ctrl(Key::PageUp), has_several),
    row(Action::List(ListAction::Rename), Menu::Measurement, "Rename measurement", "Another name for the active measurement", plain(Key::F2), has_rows),
    row(Action::List(ListAction::Move(-1)), Menu::Measurement, "Move measurement up", "One place up the list", alt(Key::ArrowUp),
        |app| only_if(app.work.measurements().active_index() > 0)),
    row(Action::List(ListAction::Move(1)), Menu::Measurement, "Move measurement down", "One place down the list", alt(Key::ArrowDown),
        |app| only_if(app.work.measurements().active_index() + 1 < app.work.measurements().iter().count())),
    row(Action::List(ListAction::ShowAll(true)), Menu::Measurement, "Show all measurements", "Draw every open measurement", None, has_several),
    row(Action::List(ListAction::ShowAll(false)), Menu::Measurement, "Show the active measurement alone", "Draw no other measurement", None, has_several),
    row(Action::List(ListAction::Close(None)), Menu::Measurement, "Close measurement", "Take the active measurement off the list; undo brings it back",
        ctrl(Key::W), has_rows),
    row(Action::List(ListAction::PinSliders), Menu::Measurement, "Pin the sliders", "The surface of the sliders as it is, drawn in every plot until it is removed",
        ctrl(Key::P), always),
    row(Action::List(ListAction::PinOtherDistribution), Menu::Measurement, "Pin the other distribution", "Gauss for Cauchy or Cauchy for Gauss, at equal median slope",
        None, |app| only_if(app.work.surface().model.specular)),
    row(Action::List(ListAction::PinFit), Menu::Measurement, "Pin the fit", "The surface of the shown fit, drawn in every plot until it is removed", None,
        |app| only_if(app.work.shown_fit().is_some())),
    row(Action::List(ListAction::UnpinAll), Menu::Measurement, "Remove all pinned surfaces", "No surface but that of the sliders and of the last fit is drawn", None,
        |app| only_if(!app.work.pinned().is_empty())),
    row(Action::StartFit, Menu::Fit, "Start fit", "Levenberg–Marquardt from the sliders, all parameters that are not fixed",
        plain(Key::F5), |app| only_if(!app.jobs.fits.fit.is_running())),
    row(Action::FitEach, Menu::Fit, "Fit each measurement", "Every open measurement by itself, one after the other", None,
        |app| only_if(app.work.measurements().measured().count() > 1 && !app.jobs.fits.fit.is_running())),
    row(Action::CancelFit, Menu::Fit, "Cancel fit", "Stop and keep the best so far", None, |app| only_if(app.jobs.fits.fit.is_running())),
    row(Action::UseFit, Menu::Fit, "Use fit as sliders", "The fitted values to the sliders", None, |app| only_if(app.work.shown_fit().is_some())),
    row(Action::UseValuesBeforeFit, Menu::Fit, "Back to before the fit", "The sliders as they were before the fit", None,
        |app| only_if(app.work.shown_fit().is_some())),
    row(Action::ReturnToFit(1), Menu::Fit, "Return to the fit before", "Sliders and results as the fit before the last one left them", None,
        |app| only_if(app.work.fit_history().len() > 1)),
    row(Action::CompareModels, Menu::Fit, "Compare all models", "Fit the whole ladder of models to this measurement", None,
        |app| only_if(!app.jobs.fits.compare.is_running())),
    row(Action::CancelComparison, Menu::Fit, "Stop comparing", "Stop comparing models", None,
        |app| only_if(app.jobs.fits.compare.is_running())),
    row(Action::Inquire(InquiryAction::Walk(GeodesicWay::Nearer)), Menu::Fit, "Follow the weakest direction", "Sliders move from the fit along the direction that the data determine least",
        None, |app| only_if(app.work.shown_fit().is_some())),
    row(Action::Inquire(InquiryAction::DrawPosterior), Menu::Fit, "Draw from the posterior", "All surfaces that the data allow, in the pane Posterior", plain(Key::F7),
        |app| only_if(!app.jobs.posteriors.draw.is_running())),
    row(Action::Inquire(InquiryAction::CancelPosterior), Menu::Fit, "Stop drawing", "What is drawn so far is shown", None,
        |app| only_if(app.jobs.posteriors.draw.is_running())),
    row(Action::RunBenchmark(BenchmarkId::ErrorVsTime), Menu::None, "Measure error against run time",
        "Evaluations against 60 digits, fits against their truth; up to a minute", None, |app| only_if(app.jobs.benchmarks.can_start(BenchmarkId::ErrorVsTime))),
    row(Action::RunBenchmark(BenchmarkId::Stability), Menu::None, "Run the stability cases", "Stiff and extreme cases against 60 digits, and fits",
        None, |app| only_if(app.jobs.benchmarks.can_start(BenchmarkId::Stability))),
    row(Action::RunBenchmark(BenchmarkId::Cost), Menu::None, "Measure costs of scenes", "Nanoseconds per point, and what is left out", None,
        |app| only_if(app.jobs.benchmarks.can_start(BenchmarkId::Cost))),
    row(Action::CancelBenchmark, Menu::None, "Stop measuring", "What is done so far is shown", None,
        |app| only_if(app.jobs.benchmarks.is_running())),
    row(Action::Bootstrap, Menu::Fit, "Bootstrap the fit", "Deal the residuals of the fit out anew and fit again", None,
        |app| only_if(app.work.shown_fit().is_some() && !app.jobs.fits.is_scanning())),
    row(Action::CancelScan, Menu::Fit, "Stop profile or bootstrap", "What is done so far is shown", None,
        |app| only_if(app.jobs.fits.is_scanning())),
    row(Action::Toggle(Switch::RefitLive), Menu::Fit, "Keep refitting while dragging",
        "Fixed parameters follow their sliders, the others are fitted again at once", None, |app| switch(app.work.settings().refit_live)),
    row(Action::Window(WindowAction::Present), Menu::View, "Presentation", "Full screen and large: the panes on screen, at most four, with a few sliders; Escape leads back",
        plain(Key::F11), |app| switch(app.dock.is_presented())),
    row(Action::Window(WindowAction::ToggleSpotlight), Menu::View, "Spotlight of the pointer", "In a presentation all but the surroundings of the pointer is dimmed", None,
        |app| switch(app.window.talk.spotlight)),
    row(Action::Window(WindowAction::TogglePanel(SidePanel::Parameters)), Menu::View, "Panel of parameters", "Sliders and measurements beside the plots", ctrl(Key::B),
        |app| switch(app.window.panels.parameters)),
    row(Action::Window(WindowAction::TogglePanel(SidePanel::Fit)), Menu::View, "Panel of fits", "Fits and what they say beside the plots", ctrl(Key::J),
        |app| switch(app.window.panels.fit)),
    row(Action::Window(WindowAction::Zoom(1)), Menu::View, "Zoom in", "Letters and lines larger", ctrl(Key::Plus), always),
    row(Action::Window(WindowAction::Zoom(-1)), Menu::View, "Zoom out", "Letters and lines smaller", ctrl(Key::Minus), always),
    row(Action::Window(WindowAction::Zoom(0)), Menu::View, "Zoom 100 %", "Letters and lines of their own size", ctrl(Key::Num0), always),
    row(Action::Window(WindowAction::ResetLayout), Menu::View, "Reset layout", "All panes and panels where they were at first", None, always),
    row(Action::Toggle(Switch::LogBrdf), Menu::View, "Logarithmic lobes", "BRDF against a logarithmic axis", ctrl(Key::L),
        |app| switch(app.work.settings().log_brdf)),
    row(Action::Toggle(Switch::Limit), Menu::View, "Show Fresnel limit", "DoLP without any depolarising term", None,
        |app| switch(app.work.settings().show_limit)),
    row(Action::Toggle(Switch::Backscatter), Menu::View, "Show backscatter side", "Negative θr, also where nothing was measured",
        ctrl_shift(Key::B), |app| switch(app.work.settings().show_backscatter)),
    row(Action::Window(WindowAction::ToggleFrameTimes), Menu::View, "Frame times", "How long drawing takes, in the status line", None,
        |app| switch(app.window.show_frame_times)),
    row(Action::CloseLesson, Menu::Lesson, "Close lesson", "Your own sliders, data, fits and panes come back", None,
        |app| only_if(app.lessons.session.is_some())),
    row(Action::KeepLesson, Menu::Lesson, "Keep what the lesson shows", "Close the lesson and go on from here; your work of before is given up",
        None, |app| only_if(app.lessons.session.is_some())),
    row(Action::Window(WindowAction::OpenPalette), Menu::Help, "All commands…", "Find a command by a few letters of its name", ctrl_shift(Key::P), always),
    row(Action::Window(WindowAction::ShowTour(0)), Menu::Help, "Tour…", "Sliders, plots, fits and lessons in four steps", None, always),
    row(Action::Window(WindowAction::ShowHelp(Help::FirstSteps)), Menu::Help, "First steps…", "From a file to a fit, step by step", plain(Key::F1), always),
    row(Action::Window(WindowAction::ShowHelp(Help::Words)), Menu::Help, "Words…", "What the words and signs of this window mean", None, always),
    row(Action::Window(WindowAction::ShowHelp(Help::About)), Menu::Help, "About pbrdf-explorer…", "Version, licence, the paper of the model, and where settings are kept",
        None, always),
    row(Action::Window(WindowAction::DismissToasts), Menu::None, "Dismiss notices", "Away with the sentences over the plots", plain(Key::Escape),
        |app| only_if(!app.toasts.is_empty())),
];

/// A command without keys.
fn item(action: Action, menu: Menu, text: Cow<'static, str>, tooltip: Cow<'static, str>, status: Availability) -> Command {
    Command { action, menu, text, tooltip, shortcut: None, status }
}

/// Forth and back in the open lesson, with the keys that a presenter's remote sends.
fn lesson_steps(app: &App) -> Vec<Command> {
    let (Some((lesson, step)), Some((of, _))) = (app.lessons.open(), app.lessons.current()) else { return Vec::new() };
    let next = (step + 1 < of.steps.len()).then(|| (step + 1, tr!("Next step"), Key::PageDown));
    let before = step.checked_sub(1).map(|step| (step, tr!("Previous step"), Key::PageUp));
    let title = of.title.in_language(i18n::current().code());
    let command = |(step, text, key): (usize, String, Key)| Command {
        shortcut: plain(key),
        ..item(Action::ShowStep(lesson, step), Menu::Lesson, text.into(), title.to_owned().into(), Availability::Possible)
    };
    next.into_iter().chain(before).map(command).collect()
}

fn finishes() -> impl Iterator<Item = Command> {
    FINISHES.iter().enumerate().map(|(i, finish)| {
        let text = tr!("Surface finish: {}", translated(finish.name));
        item(Action::UseFinish(i), Menu::None, text.into(), views::values(finish).into(), Availability::Possible)
    })
}

/// Of the panes with a plot; possible for those on screen.
fn plots(on_screen: &[PaneId]) -> impl Iterator<Item = Command> {
    PaneId::ALL.iter().filter(|pane| spec(**pane).has_figure).flat_map(move |&pane| {
        let title = translated(spec(pane).title);
        let status = only_if(on_screen.contains(&pane));
        let export = tr!("Plot {} as SVG or PNG…", title);
        let copy = tr!("Copy plot {}", title);
        [
            item(
                Action::ChooseExport(ExportKind::Plot(pane)),
                Menu::Export,
                export.into(),
                tr!("With axes and legend, for print").into(),
                status,
            ),
            item(Action::CopyPlot(pane), Menu::Edit, copy.into(), tr!("As an image, to the clipboard").into(), status),
        ]
    })
}

/// Of several plots on screen as one figure.
fn sheets(on_screen: &[PaneId]) -> impl Iterator<Item = Command> {
    let plots = on_screen.iter().filter(|pane| spec(**pane).has_figure).count();
    SheetForm::ALL.into_iter().map(move |form| {
        let (rows, columns) = form.shape();
        let text = tr!("Plots on screen as one figure, {0} × {1}…", rows, columns);
        let tooltip = tr!("One SVG or PNG, for a handout or a paper").into();
        item(Action::ChooseExport(ExportKind::Sheet(form)), Menu::Export, text.into(), tooltip, only_if(plots > 1))
    })
}

/// Of the open measurements.
fn measurements(app: &App) -> impl Iterator<Item = Command> {
    let active = app.work.active().number;
    app.work.measurements().iter().filter(|open| !open.measurement.rows.is_empty()).map(move |open| {
        let (text, status) = (tr!("Measurement: {}", open.title()), switch(open.number == active));
        item(Action::List(ListAction::Activate(open.number)), Menu::None, text.into(), open.description().into(), status)
    })
}

/// What several measurements have in common.
fn sharings(app: &App) -> impl Iterator<Item = Command> {
    let list = app.work.measurements();
    let (current, are_several) = (Sharing::of(list.shared()), list.measured().count() > 1);
    Sharing::ALL.into_iter().map(move |sharing| {
        let text = tr!("Measurements of {}", translated(sharing.name()));
        let status = if are_several { switch(current == Some(sharing)) } else { Availability::Impossible };
        item(Action::List(ListAction::Share(sharing)), Menu::Measurement, text.into(), translated(sharing.help()).into(), status)
    })
}

/// The files that were opened last, the work of before, and the way to forget the files.
fn recent_files(app: &App) -> impl Iterator<Item = Command> {
    let recent = app.window.recent.iter().map(|path| {
        let name = path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned());
        item(
            Action::OpenMeasurements(vec![path.clone()]),
            Menu::Recent,
            name.into(),
            path.display().to_string().into(),
            Availability::Possible,
        )
    });
    let kept = app.persistence.kept.iter().map(|work| {
        let measurements = tr!("one measurement" | "{n} measurements" % work.names.len());
        let about = tr!("{0}, {1}; what is open now is kept", measurements, tr!("one fit" | "{n} fits" % work.fits));
        let names: Vec<&str> = work.names.iter().map(String::as_str).chain([about.as_str()]).collect();
        item(Action::OpenSession(work.path.clone()), Menu::Recent, work_title(work).into(), names.join("\n").into(), Availability::Possible)
    });
    let forget = item(
        Action::Window(WindowAction::ForgetRecent),
        Menu::Recent,
        tr!("Forget recent files").into(),
        tr!("Empty this list; the files stay").into(),
        only_if(!app.window.recent.is_empty()),
    );
    recent.chain(kept).chain([forget])
}

/// Every command that there is at the moment.
pub fn items(app: &App) -> Vec<Command> {
    let fixed = ENTRIES.iter().map(|entry| Command {
        action: entry.action.clone(),
        menu: entry.menu,
        text: translated(entry.text).into(),
        tooltip: translated(entry.tooltip).into(),
        shortcut: entry.shortcut,
        status: (entry.status)(app),
    });
    let examples = EXAMPLES.iter().enumerate().map(|(i, example)| {
        item(
            Action::OpenExample(i),
            Menu::Example,
            translated(example.name).into(),
            tr!("A bundled measurement, simulated").into(),
            Availability::Possible,
        )
    });
    let code = i18n::current().code();
    let lessons = app.lessons.all.iter().enumerate().map(|(i, lesson)| {
        let [text, about] = [&lesson.title, &lesson.about].map(|wording| wording.in_language(code).to_owned());
        item(Action::ShowStep(i, 0), Menu::Lesson, text.into(), about.into(), Availability::Possible)
    });
    let on_screen = app.dock.on_screen();
    let panes = PaneId::ALL.iter().map(|&pane| Command {
        shortcut: spec(pane).shortcut.and_then(ctrl),
        ..item(
            Action::Window(WindowAction::ShowPane(pane)),
            if pane.judges_program() { Menu::Program } else { Menu::Pane },
            translated(spec(pane).title).into(),
            translated(spec(pane).tooltip).into(),
            switch(on_screen.contains(&pane)),
        )
    });
    let fill = on_screen.first().map(|&pane| Command {
        shortcut: ctrl(Key::M),
        ..item(
            Action::Window(WindowAction::FillWindow(pane)),
            Menu::View,
            tr!("Fill the window with one pane").into(),
            tr!("Also with a double click on its name; once more, and all is where it was").into(),
            switch(app.dock.is_filled()),
        )
    });
    let current = app.work.preset().map(|preset| preset.key);
    let models = PRESETS.iter().map(|preset| {
        let text = tr!("Model: {}", translated(preset.name));
        item(Action::UseModel(preset.key), Menu::None, text.into(), translated(preset.citation).into(), switch(current == Some(preset.key)))
    });
    let themes = Theme::ALL.into_iter().map(|theme| {
        let (action, is_set) = (Action::Window(WindowAction::SetTheme(theme)), switch(app.window.theme == theme));
        item(action, Menu::Theme, translated(theme.name()).into(), tr!("Colours of the window").into(), is_set)
    });
    let languages = Language::ALL.into_iter().map(|language| {
        let (action, is_set) = (Action::Window(WindowAction::SetLanguage(language)), switch(app.window.language == language));
        item(action, Menu::Language, language.name().into(), tr!("Language of the window").into(), is_set)
    });
    fixed
        .chain(sheets(&on_screen))
        .chain(plots(&on_screen))
        .chain(measurements(app))
        .chain(sharings(app))
        .chain(examples)
        .chain(lesson_steps(app))
        .chain(lessons)
        .chain(recent_files(app))
        .chain(panes)
        .chain(fill)
        .chain(models)
        .chain(finishes())
        .chain(themes)
        .chain(languages)
        .filter(|command| !platform::IS_PAGE || is_of_page(&command.action))
        .collect()
}

/// Whether a page can carry out the command: it has no folders, closes with its tab, reads the clipboard only when the user pastes, and
/// does not measure.
fn is_of_page(action: &Action) -> bool {
    match action {
        Action::Window(WindowAction::Quit)
        | Action::ChooseFolder
        | Action::RequestPaste
        | Action::RunBenchmark(_)
        | Action::CancelBenchmark => false,
        Action::Window(WindowAction::ShowPane(pane)) => !matches!(pane, PaneId::ErrorVsTime | PaneId::Stability | PaneId::Cost),
        _ => true,
    }
}

//! Everything that can be ordered, in one table: menus, keyboard and palette read it, and so does a test for clashes.

use crate::app::shell::app::App;
use crate::app::storage::export::ExportKind;
use crate::app::tasks::benchmarks::BenchmarkId;
use crate::app::text::help::Help;
use crate::app::text::i18n;
use crate::app::text::i18n::Language;
use crate::app::text::i18n::translated;
use crate::app::views;
use crate::app::views::spec;
use crate::app::work::document::EXAMPLES;
use crate::app::work::edit::Switch;
use crate::app::work::pane_id::PaneId;
use crate::app::work::settings::Theme;
use egui::{Key, KeyboardShortcut, Modifiers};
use pbrdf::model::{FINISHES, PRESETS, Parameter, Preset};
use std::borrow::Cow;
use std::path::PathBuf;
use tr::tr;

/// An order from the window.
#[derive(Debug, Clone, PartialEq)]
pub enum Command {
    /// Ask the desktop for a file.
    ChooseMeasurement,
    /// Read that file.
    OpenMeasurement(PathBuf),
    /// Ask the desktop where to save.
    ChooseSave,
    /// Write the measurement, masks and all, into that file.
    SaveMeasurement(PathBuf),
    /// The same into a new file; asks if there is one already.
    SaveNew(PathBuf),
    /// Write in the place of the file that is asked about.
    Replace,
    /// Leave it as it is.
    KeepFile,
    /// Ask the desktop for a session.
    ChooseSession,
    OpenSession(PathBuf),
    /// Into the file that it came from or went to last; asks where there is none.
    SaveSession,
    /// Ask the desktop where to write that.
    ChooseExport(ExportKind),
    Export(ExportKind, PathBuf),
    /// The same into a new file; asks if there is one already.
    ExportNew(ExportKind, PathBuf),
    /// The plot of a pane to the clipboard, as an image.
    CopyPlot(PaneId),
    /// The measurement to the clipboard, as text.
    CopyTable,
    /// Load the bundled example of that number.
    OpenExample(usize),
    /// The lesson of that number at the step of that number: sliders and views as it wants them.
    ShowStep(usize, usize),
    /// Out of the lesson; what was there before it comes back.
    CloseLesson,
    /// Out of the lesson, and on with what it set.
    KeepLesson,
    /// Read the foreign file as it was chosen.
    ImportDialog,
    /// Leave it; what is open stays.
    CancelImport,
    /// Stop reading.
    CancelLoading,
    ForgetRecent,
    StartFit,
    CancelFit,
    /// Fitted values to the sliders.
    UseFit,
    /// The values from before the fit to the sliders.
    Back,
    DismissNotices,
    /// Take rows out of every statistic, or back in.
    Mask {
        rows: Vec<usize>,
        masked: bool,
    },
    Undo,
    Redo,
    /// Sliders and results as the earlier fit of that number left them, the newest first.
    ReturnTo(usize),
    /// Hold a parameter around its fitted value, and fit the rest.
    Profile(Parameter),
    /// Deal the residuals of the fit out anew.
    Bootstrap,
    CancelScan,
    /// Sliders and terms as the comparison's fit of that number has them.
    UseRung(usize),
    /// Sliders to the clipboard, as text.
    CopyParameters,
    /// Ask for what is on the clipboard.
    RequestPaste,
    /// Text to the sliders.
    PasteParameters(String),
    ResetParameters,
    /// Those sliders to those values.
    SetParameters(Vec<(Parameter, f64)>),
    /// σ, q and the weights of the surface finish of that number.
    UseFinish(usize),
    /// The terms of that preset, by its key.
    UseModel(&'static str),
    /// Fit all models of the ladder.
    CompareModels,
    CancelComparison,
    /// Measure, in the background.
    MakeReport(BenchmarkId),
    CancelReport,
    /// Not to be made after the one that is being made.
    ForgetReport(BenchmarkId),
    /// Sliders, terms and angles as that case of the stability gallery has them.
    UseCase(usize),
    Toggle(Switch),
    ToggleFrameTimes,
    /// A pane to the screen, or off it.
    TogglePane(PaneId),
    ClosePane(PaneId),
    ResetLayout,
    SetTheme(Theme),
    SetLanguage(Language),
    OpenPalette,
    ShowHelp(Help),
    CloseHelp,
    Quit,
}

impl Command {
    /// Why it cannot be carried out, where that is not said by what it does.
    pub fn why_disabled(&self) -> Option<String> {
        match self {
            Self::ChooseExport(ExportKind::Plot(pane)) | Self::CopyPlot(pane) => {
                Some(tr!("Open the pane {} first (menu View).", translated(spec(*pane).title)))
            }
            Self::ChooseExport(ExportKind::Fitted | ExportKind::Report) | Self::UseFit | Self::Back | Self::Bootstrap => {
                Some(tr!("Fit first (F5)."))
            }
            _ => None,
        }
    }
}

/// The menu that a command stands in, in the order of the bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Menu {
    File,
    Example,
    Recent,
    Export,
    Edit,
    Fit,
    PaneId,
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
            Self::Fit => tr!("Fitting"),
            Self::PaneId => tr!("Panes"),
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
pub enum Status {
    Impossible,
    Possible,
    Off,
    On,
}

/// A command as menus and the palette show it.
#[derive(Debug, Clone)]
pub struct Item {
    pub command: Command,
    pub menu: Menu,
    pub text: Cow<'static, str>,
    pub tooltip: Cow<'static, str>,
    pub shortcut: Option<KeyboardShortcut>,
    pub status: Status,
}

struct Entry {
    command: Command,
    menu: Menu,
    text: &'static str,
    tooltip: &'static str,
    shortcut: Option<KeyboardShortcut>,
    status: fn(&App) -> Status,
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

fn always(_: &App) -> Status {
    Status::Possible
}

fn only_if(possible: bool) -> Status {
    if possible { Status::Possible } else { Status::Impossible }
}

fn switch(on: bool) -> Status {
    if on { Status::On } else { Status::Off }
}

/// One row: what it orders, where it stands, what it is called, what it does, its keys, and whether it is possible.
const fn row(
    command: Command,
    menu: Menu,
    text: &'static str,
    tooltip: &'static str,
    shortcut: Option<KeyboardShortcut>,
    status: fn(&App) -> Status,
) -> Entry {
    Entry { command, menu, text, tooltip, shortcut, status }
}

/// Commands that are always the same; those of examples, recent files, panes, models and themes follow from their own tables.
#[rustfmt::skip]
static ENTRIES: &[Entry] = &[
    row(Command::ChooseMeasurement, Menu::File, "Open measurement…", "A table of DoLP or BRDF against angles", ctrl(Key::O), always),
    row(Command::ChooseSave, Menu::File, "Save measurement as…", "The table with its masks, as CSV", ctrl(Key::S), always),
    row(Command::ChooseSession, Menu::File, "Open session…", "Sliders, data, masks, fits and layout as they were saved", ctrl_shift(Key::O),
        always),
    row(Command::SaveSession, Menu::File, "Save session", "Sliders, data, masks, fits and layout in one file that opens on any machine",
        ctrl_shift(Key::S), always),
    row(Command::ChooseExport(ExportKind::Session), Menu::File, "Save session as…", "The session into another file", None, always),
    row(Command::ChooseExport(ExportKind::Curves), Menu::Export, "Curves as CSV…", "DoLP, limit, BRDF and terms along every measured θi", None,
        always),
    row(Command::ChooseExport(ExportKind::Fitted), Menu::Export, "Fit as CSV…", "The measurement with model and residuals beside it", None,
        |e| only_if(e.work.shown_fit.is_some())),
    row(Command::ChooseExport(ExportKind::Report), Menu::Export, "Fit as a report…",
        "HTML in one file, or Markdown: data, model, parameters with errors, what is open, figures", ctrl(Key::R),
        |e| only_if(e.work.shown_fit.is_some())),
    row(Command::CancelLoading, Menu::File, "Cancel reading", "Stop reading the file", None, |e| only_if(e.jobs.files.reading_fraction().is_some())),
    row(Command::Quit, Menu::File, "Quit", "Sliders, views and layout are kept", ctrl(Key::Q), always),
    row(Command::Undo, Menu::Edit, "Undo", "Sliders, model, switches, views and masks as they were", ctrl(Key::Z),
        |e| only_if(e.work.undo.can_undo())),
    row(Command::Redo, Menu::Edit, "Redo", "Forth again; also with Ctrl+Y", ctrl_shift(Key::Z), |e| only_if(e.work.undo.can_redo())),
    row(Command::CopyParameters, Menu::Edit, "Copy parameters", "All nine as text: n=2, k=3, …", ctrl_shift(Key::C), always),
    row(Command::RequestPaste, Menu::Edit, "Paste parameters", "From text such as n=2.07, k=2.9; those that it does not name stay",
        ctrl_shift(Key::V), always),
    row(Command::ResetParameters, Menu::Edit, "Reset all parameters", "All nine parameters to their defaults", None, always),
    row(Command::CopyTable, Menu::Edit, "Copy data table", "Every row as the pane Data shows it, with tabs between cells as spreadsheets want them", None, always),
    row(Command::StartFit, Menu::Fit, "Start fit", "Levenberg–Marquardt from the sliders, all parameters that are not fixed",
        plain(Key::F5), |e| only_if(!e.jobs.fits.fit.is_running())),
    row(Command::CancelFit, Menu::Fit, "Cancel fit", "Stop and keep the best so far", None, |e| only_if(e.jobs.fits.fit.is_running())),
    row(Command::UseFit, Menu::Fit, "Use fit as sliders", "The fitted values to the sliders", None, |e| only_if(e.work.shown_fit.is_some())),
    row(Command::Back, Menu::Fit, "Back to before the fit", "The sliders as they were before the fit", None,
        |e| only_if(e.work.shown_fit.is_some())),
    row(Command::ReturnTo(1), Menu::Fit, "Return to the fit before", "Sliders and results as the fit before the last one left them", None,
        |e| only_if(e.work.fit_history.len() > 1)),
    row(Command::CompareModels, Menu::Fit, "Compare all models", "Fit the whole ladder of models to this measurement", None,
        |e| only_if(!e.jobs.fits.compare.is_running())),
    row(Command::CancelComparison, Menu::Fit, "Stop comparing", "Stop comparing models", None,
        |e| only_if(e.jobs.fits.compare.is_running())),
    row(Command::MakeReport(BenchmarkId::ErrorVsTime), Menu::None, "Measure error against run time",
        "Evaluations against 60 digits, fits against their truth; up to a minute", None, |e| only_if(e.jobs.benchmarks.can_start(BenchmarkId::ErrorVsTime))),
    row(Command::MakeReport(BenchmarkId::Stability), Menu::None, "Run the stability cases", "Stiff and extreme cases against 60 digits, and fits",
        None, |e| only_if(e.jobs.benchmarks.can_start(BenchmarkId::Stability))),
    row(Command::MakeReport(BenchmarkId::Cost), Menu::None, "Measure costs of scenes", "Nanoseconds per point, and what is left out", None,
        |e| only_if(e.jobs.benchmarks.can_start(BenchmarkId::Cost))),
    row(Command::CancelReport, Menu::None, "Stop measuring", "What is done so far is shown", None,
        |e| only_if(e.jobs.benchmarks.is_running())),
    row(Command::Bootstrap, Menu::Fit, "Bootstrap the fit", "Deal the residuals of the fit out anew and fit again", None,
        |e| only_if(e.work.shown_fit.is_some() && !e.jobs.fits.is_scanning())),
    row(Command::CancelScan, Menu::Fit, "Stop profile or bootstrap", "What is done so far is shown", None,
        |e| only_if(e.jobs.fits.is_scanning())),
    row(Command::Toggle(Switch::RefitLive), Menu::Fit, "Keep refitting while dragging",
        "Fixed parameters follow their sliders, the others are fitted again at once", None, |e| switch(e.work.settings.refit_live)),
    row(Command::ResetLayout, Menu::View, "Reset layout", "All panes where they were at first", None, always),
    row(Command::Toggle(Switch::LogBrdf), Menu::View, "Logarithmic lobes", "BRDF against a logarithmic axis", ctrl(Key::L),
        |e| switch(e.work.settings.log_brdf)),
    row(Command::Toggle(Switch::Limit), Menu::View, "Show Fresnel limit", "DoLP without any depolarising term", None,
        |e| switch(e.work.settings.show_limit)),
    row(Command::Toggle(Switch::Backscatter), Menu::View, "Show backscatter side", "Negative θr, also where nothing was measured",
        ctrl(Key::B), |e| switch(e.work.settings.show_backscatter)),
    row(Command::ToggleFrameTimes, Menu::View, "Frame times", "How long drawing takes, in the status line", None,
        |e| switch(e.window.show_frame_times)),
    row(Command::CloseLesson, Menu::Lesson, "Close lesson", "Your own sliders, data, fits and panes come back", None,
        |e| only_if(e.lessons.open.is_some())),
    row(Command::KeepLesson, Menu::Lesson, "Keep what the lesson shows", "Close the lesson and go on from here; your work of before is given up",
        None, |e| only_if(e.lessons.open.is_some())),
    row(Command::OpenPalette, Menu::Help, "All commands…", "Find a command by a few letters of its name", ctrl_shift(Key::P), always),
    row(Command::ShowHelp(Help::FirstSteps), Menu::Help, "First steps…", "From a file to a fit, step by step", plain(Key::F1), always),
    row(Command::ShowHelp(Help::Words), Menu::Help, "Words…", "What the words and signs of this window mean", None, always),
    row(Command::ShowHelp(Help::About), Menu::Help, "About pbrdf-explorer…", "Version, licence, the paper of the model, and where settings are kept",
        None, always),
    row(Command::DismissNotices, Menu::None, "Dismiss notices", "Away with the sentences over the plots", plain(Key::Escape),
        |e| only_if(!e.notices.is_empty())),
];

/// A command without keys.
fn item(command: Command, menu: Menu, text: Cow<'static, str>, tooltip: Cow<'static, str>, status: Status) -> Item {
    Item { command, menu, text, tooltip, shortcut: None, status }
}

fn finishes() -> impl Iterator<Item = Item> {
    FINISHES.iter().enumerate().map(|(i, finish)| {
        let text = tr!("Surface finish: {}", translated(finish.name));
        item(Command::UseFinish(i), Menu::None, text.into(), views::values(finish).into(), Status::Possible)
    })
}

/// Of the panes with a plot; possible for those on screen.
fn plots(on_screen: &[PaneId]) -> impl Iterator<Item = Item> {
    PaneId::ALL.iter().filter(|pane| spec(**pane).has_figure).flat_map(move |&pane| {
        let title = translated(spec(pane).title);
        let status = only_if(on_screen.contains(&pane));
        let export = tr!("Plot {} as SVG or PNG…", title);
        let copy = tr!("Copy plot {}", title);
        [
            item(
                Command::ChooseExport(ExportKind::Plot(pane)),
                Menu::Export,
                export.into(),
                tr!("With axes and legend, for print").into(),
                status,
            ),
            item(Command::CopyPlot(pane), Menu::Edit, copy.into(), tr!("As an image, to the clipboard").into(), status),
        ]
    })
}

/// Every command that there is at the moment.
pub fn items(explorer: &App) -> Vec<Item> {
    let fixed = ENTRIES.iter().map(|entry| Item {
        command: entry.command.clone(),
        menu: entry.menu,
        text: translated(entry.text).into(),
        tooltip: translated(entry.tooltip).into(),
        shortcut: entry.shortcut,
        status: (entry.status)(explorer),
    });
    let examples = EXAMPLES.iter().enumerate().map(|(i, example)| {
        item(
            Command::OpenExample(i),
            Menu::Example,
            translated(example.name).into(),
            tr!("A bundled measurement, simulated").into(),
            Status::Possible,
        )
    });
    let recent = explorer.window.recent.iter().map(|path| {
        let name = path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned());
        item(Command::OpenMeasurement(path.clone()), Menu::Recent, name.into(), path.display().to_string().into(), Status::Possible)
    });
    let forget = item(
        Command::ForgetRecent,
        Menu::Recent,
        tr!("Forget recent files").into(),
        tr!("Empty this list; the files stay").into(),
        only_if(!explorer.window.recent.is_empty()),
    );
    let code = i18n::current().code();
    let lessons = explorer.lessons.all.iter().enumerate().map(|(i, lesson)| {
        let [text, about] = [&lesson.title, &lesson.about].map(|wording| wording.in_language(code).to_owned());
        item(Command::ShowStep(i, 0), Menu::Lesson, text.into(), about.into(), Status::Possible)
    });
    let on_screen = explorer.panes.on_screen();
    let panes = PaneId::ALL.iter().map(|&pane| Item {
        shortcut: spec(pane).shortcut.and_then(ctrl),
        ..item(
            Command::TogglePane(pane),
            Menu::PaneId,
            translated(spec(pane).title).into(),
            translated(spec(pane).tooltip).into(),
            switch(on_screen.contains(&pane)),
        )
    });
    let current = Preset::of(explorer.work.settings.model).map(|preset| preset.key);
    let models = PRESETS.iter().map(|preset| {
        let text = tr!("Model: {}", translated(preset.name));
        item(
            Command::UseModel(preset.key),
            Menu::None,
            text.into(),
            translated(preset.citation).into(),
            switch(current == Some(preset.key)),
        )
    });
    let themes = Theme::ALL.into_iter().map(|theme| {
        let tooltip = tr!("Colours of the window").into();
        item(Command::SetTheme(theme), Menu::Theme, translated(theme.name()).into(), tooltip, switch(explorer.window.theme == theme))
    });
    let languages = Language::ALL.into_iter().map(|language| {
        let tooltip = tr!("Language of the window").into();
        item(Command::SetLanguage(language), Menu::Language, language.name().into(), tooltip, switch(explorer.window.language == language))
    });
    fixed
        .chain(plots(&on_screen))
        .chain(examples)
        .chain(lessons)
        .chain(recent)
        .chain([forget])
        .chain(panes)
        .chain(models)
        .chain(finishes())
        .chain(themes)
        .chain(languages)
        .collect()
}

/// The command whose keys are pressed, if it is possible now.
pub fn pressed(explorer: &App, ctx: &egui::Context) -> Option<Command> {
    let any_key = ctx.input(|input| input.events.iter().any(|event| matches!(event, egui::Event::Key { pressed: true, .. })));
    if !any_key {
        return None;
    }
    if explorer.work.undo.can_redo() && ctx.input_mut(|input| input.consume_key(Modifiers::COMMAND, Key::Y)) {
        // As other programs have it.
        return Some(Command::Redo);
    }
    let mut items = items(explorer);
    // Escape leaves what lies above first, and is nobody's while there is nothing to dismiss.
    let is_covered = ctx.memory(|memory| memory.top_modal_layer().is_some()) || egui::Popup::is_any_open(ctx);
    items.retain(|item| item.command != Command::DismissNotices || (item.status == Status::Possible && !is_covered));
    // The longer shortcut first: egui takes the shorter one for a part of it.
    items.sort_by_key(|item| item.shortcut.is_none_or(|shortcut| !shortcut.modifiers.shift));
    let hit = |item: &Item| item.shortcut.is_some_and(|shortcut| ctx.input_mut(|input| input.consume_shortcut(&shortcut)));
    let item = items.iter().find(|item| hit(item))?;
    (item.status != Status::Impossible).then(|| item.command.clone())
}

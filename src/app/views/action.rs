//! What the window can be asked to do.

use crate::app::storage::export::ExportKind;
use crate::app::tasks::benchmarks::BenchmarkId;
use crate::app::text::help::Help;
use crate::app::text::i18n::Language;
use crate::app::views::pointing::PickedDirection;
use crate::app::work::edit::Switch;
use crate::app::work::pane_id::PaneId;
use crate::app::work::settings::{SidePanel, Theme};
use crate::app::work::sharing::Sharing;
use crate::app::work::talk::TalkSlider;
use crate::report::TableFormat;
use pbrdf::fit::GeodesicWay;
use pbrdf::model::Parameter;
use std::path::PathBuf;

/// Something that menus, keys, panes and panels ask of the window, which carries it out before the
/// next frame.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// Ask the desktop for files.
    ChooseMeasurement,
    /// Ask the desktop for a folder of measurements.
    ChooseFolder,
    /// Read these files, measurements and sessions, and the measurements of these folders.
    OpenMeasurements(Vec<PathBuf>),
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
    /// The table of results to the clipboard, as text of that form.
    CopyResults(TableFormat),
    List(ListAction),
    /// Load the bundled example of that number.
    OpenExample(usize),
    /// The lesson of that number at the step of that number: sliders and views as it wants them.
    ShowStep(usize, usize),
    /// Out of the lesson; what was there before it comes back.
    CloseLesson,
    /// Out of the lesson, and on with what it set.
    KeepLesson,
    /// Read the foreign file as it was chosen.
    Import,
    /// Leave it; what is open stays.
    CancelImport,
    /// Stop reading.
    CancelLoading,
    /// Fit the active measurement, or all together where they share anything.
    StartFit,
    /// Fit every measurement by itself.
    FitEach,
    CancelFit,
    /// Find the intervals of the shown fit, which were stopped.
    FindIntervals,
    CancelIntervals,
    /// Fitted values to the sliders.
    UseFit,
    /// The values from before the fit to the sliders.
    UseValuesBeforeFit,
    Undo,
    Redo,
    /// Sliders and results as the earlier fit of that number left them, the newest first.
    ReturnToFit(usize),
    /// Hold a parameter around its fitted value, and fit the rest.
    Profile(Parameter),
    /// Deal the residuals of the fit out anew.
    Bootstrap,
    CancelScan,
    /// The work to the clipboard, as a link.
    CopyLink,
    /// Show the work of the link in that text; the user's own is kept.
    OpenLink(String),
    /// Sliders to the clipboard, as text.
    CopyParameters,
    /// Ask for what is on the clipboard.
    RequestPaste,
    /// Text to the sliders.
    PasteParameters(String),
    ResetParameters,
    /// σ, q and the weights of the surface finish of that number.
    UseFinish(usize),
    /// The terms of that preset, by its key.
    UseModel(&'static str),
    /// Fit all models of the ladder.
    CompareModels,
    CancelComparison,
    /// Ask more of data than a fit.
    Inquire(InquiryAction),
    /// Measure, in the background.
    RunBenchmark(BenchmarkId),
    CancelBenchmark,
    /// Not to be made after the one that is being made.
    ForgetBenchmark(BenchmarkId),
    /// Sliders, terms and angles as that case of the stability gallery has them.
    UseCase(usize),
    Toggle(Switch),
    /// Whether what the data determine is on screen.
    ShowOutlook(bool),
    /// A direction that was picked in the picture, degrees: marked in plots against θr.
    MarkDirection(PickedDirection),
    /// Something about how the window stands, and nothing of the work.
    Window(WindowAction),
}

/// What is done with open measurements and pinned surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ListAction {
    /// The measurement of that number to the sliders.
    Activate(u64),
    /// The measurement so many places down the list, around its ends.
    Step(isize),
    /// Another name for the active measurement.
    Rename,
    /// The active measurement so many places down the list.
    Move(isize),
    /// Draw all measurements or the active one alone.
    ShowAll(bool),
    /// Close the measurement of that number, or the active one.
    Close(Option<u64>),
    /// What the measurements have in common.
    Share(Sharing),
    /// The sliders as a pinned surface.
    PinSliders,
    /// The sliders with the other distribution of slopes, at equal median.
    PinOtherDistribution,
    /// The shown fit.
    PinFit,
    /// The fit of that row of the comparison of models.
    PinModelFit(usize),
    UnpinAll,
}

/// What is asked of data beyond a fit: posteriors, open directions, further angles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InquiryAction {
    /// Move the sliders from the shown fit along the direction that its data determine least.
    Walk(GeodesicWay),
    /// Leave them where they are on the way.
    StopWalk,
    /// Move them back to the fit.
    CancelWalk,
    /// Choose as many angles as the plan says.
    ChooseAngles,
    CancelChoice,
    /// Draw from the posterior of the active measurement, or of all where they share anything.
    DrawPosterior,
    CancelPosterior,
    /// Find the evidence of the compared models.
    FindEvidence,
    CancelEvidence,
}

/// What changes how the window stands, and nothing of the work.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WindowAction {
    ForgetRecent,
    DismissToasts,
    ToggleFrameTimes,
    /// A pane to the screen.
    ShowPane(PaneId),
    /// A pane alone in the window, and back.
    FillWindow(PaneId),
    /// The presentation begins or ends.
    Present,
    /// A slider into the strip of the presentation, or out of it.
    ChooseTalkSlider(TalkSlider),
    ToggleSpotlight,
    /// A panel beside the plots, and away.
    TogglePanel(SidePanel),
    /// All larger (1), smaller (−1), or as it is by itself (0).
    Zoom(i8),
    ClosePane(PaneId),
    ResetLayout,
    SetTheme(Theme),
    SetLanguage(Language),
    OpenPalette,
    /// The tour at the step of that number.
    ShowTour(usize),
    EndTour,
    /// Away with the notice of that place.
    DismissToast(usize),
    ShowHelp(Help),
    CloseHelp,
    Quit,
}

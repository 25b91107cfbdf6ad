//! What the user asked for while the window was drawn; carried out afterwards.

use super::state::Theme;
use pbrdf::model::Parameter;
use std::path::PathBuf;

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
    /// Load the bundled example of that number.
    OpenExample(usize),
    /// Stop reading.
    CancelLoading,
    StartFit,
    CancelFit,
    /// Fitted values to the sliders.
    UseFit,
    /// The values from before the fit to the sliders.
    Back,
    DismissNotice,
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
    /// Fit all models of the ladder.
    CompareModels,
    CancelComparison,
    SetTheme(Theme),
    Quit,
}

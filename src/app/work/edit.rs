//! The changes that can be made to the work.

use crate::app::work::design::DesignSettings;
use crate::app::work::diagnostics::ProfileCurve;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::layout::Layout;
use crate::app::work::model_fit::ComparedModel;
use crate::app::work::open_measurement::{DrawnSeries, MeasurementStyle, OpenMeasurement};
use crate::app::work::picture_options::PictureOptions;
use crate::app::work::posterior::{DrawnPosterior, PosteriorOptions};
use crate::app::work::predicted_errors::PlannedAngles;
use crate::app::work::results_options::ResultsOptions;
use crate::app::work::settings::{LandscapeAxes, MetalSelection, Settings, ViewOptions};
use crate::app::work::surface::{PinnedSurface, Surface};
use crate::app::work::weakest_walk::WeakestWalk;
use pbrdf::fit::posterior::LogEvidence;
use pbrdf::fit::{Bootstrap, Estimate, FitOptions, FitResult, JointResult, Starts};
use pbrdf::model::{Model, Parameter, ParameterSet, Parameters};
use std::path::PathBuf;
use std::sync::Arc;

/// One change of the work, in terms of what a user does; [`Workspace::apply`] carries it out.
///
/// A panel never writes to the work. Where a widget needs a `&mut`, the panel hands it a copy of
/// the small value behind it, and pushes an edit if the copy differs afterwards:
///
/// ```ignore
/// let mut options = cx.work.settings().shown;
/// ui.checkbox(&mut options.filled, tr!("Filled lobes"));
/// cx.set_view_options(options);
/// ```
///
/// The edits of a frame are carried out after it, in their order. Each bumps
/// [`Workspace::revision`]; what depends on the work compares that number.
///
/// [`Workspace::apply`]: crate::app::work::workspace::Workspace::apply
/// [`Workspace::revision`]: crate::app::work::workspace::Workspace::revision
pub enum Edit {
    /// All sliders.
    SetParameters(Parameters),
    SetModel(Model),
    /// Sliders, model, locks and bounds of the active measurement.
    SetSurface(Box<Surface>),
    /// The parameters that all surfaces share; they are those of the active one.
    Share(ParameterSet),
    /// Angles of the lobes, degrees.
    SetDirection {
        theta_i: f64,
        dphi: f64,
    },
    /// Something that is on or off.
    SetSwitch(Switch, bool),
    SetFitOptions(FitOptions),
    SetStarts(Starts),
    /// Seed of the starts and of the bootstrap.
    SetSeed(u64),
    SetViewOptions(ViewOptions),
    SetLandscapeAxes(LandscapeAxes),
    SetPictureOptions(PictureOptions),
    /// Hidden columns and the order of the table of results.
    SetResultsOptions(ResultsOptions),
    SetMetalSelection(MetalSelection),
    /// How a posterior is drawn.
    SetPosteriorOptions(PosteriorOptions),
    /// Draws from the posterior of their measurements.
    SetPosterior(Arc<DrawnPosterior>),
    /// The way from a fit along the direction that the data determine least.
    SetWalk(Arc<WeakestWalk>),
    /// Takes the values at a share, 0 to 1, of the way from the shown fit.
    WalkTo(f64),
    /// Takes the values of one draw, by the numbers of its measurements.
    UseDraw(Vec<(u64, Parameters)>),
    /// The angles that might be measured.
    SetDesign(DesignSettings),
    /// Plans the angles that were chosen.
    SetPlan(PlannedAngles),
    /// Masks these rows of the active measurement, or unmasks them.
    Mask {
        rows: Vec<usize>,
        masked: bool,
    },
    /// Adds a measurement to those that are open; it becomes the active one.
    Open(Box<OpenMeasurement>),
    /// Closes the measurement of that number.
    Close(u64),
    /// Shows the measurement of that number; no step of undo.
    Activate(u64),
    /// Moves a measurement so many places down the list, or up.
    MoveMeasurement {
        number: u64,
        by: isize,
    },
    RenameMeasurement {
        number: u64,
        name: String,
    },
    /// Colour and marker of a measurement, and whether it is shown.
    SetMeasurementStyle {
        number: u64,
        style: MeasurementStyle,
    },
    /// How often the squared residuals of a measurement count in joint fits.
    SetWeight {
        number: u64,
        weight: f64,
    },
    /// The angles of incidence that plots show of a measurement.
    SetDrawnSeries {
        number: u64,
        drawn: DrawnSeries,
    },
    /// Pins a surface: its name, model and values.
    Pin {
        name: String,
        model: Model,
        parameters: Parameters,
    },
    /// Another name or colour of the pinned surface of that place, or whether it is drawn.
    SetPin(usize, Box<PinnedSurface>),
    /// Removes the pinned surface of that place.
    Unpin(usize),
    /// Takes the values and the model of the pinned surface of that place.
    UsePin(usize),
    /// Adds finished fits to the history, shows them and takes their values.
    AddFits(Vec<FitEntry>),
    /// Puts a report with intervals in the place of that of the fit with this id. If its minimum is a
    /// better one, sliders that stand at the minimum before follow.
    SetFitReport {
        id: usize,
        report: Box<FitResult>,
    },
    /// The same of a joint fit.
    SetJointResult {
        id: usize,
        result: Box<JointResult>,
    },
    /// Takes the free parameters of a fit that ran while sliders moved.
    Refit(Refit),
    /// Values and model of something that was looked at. A live refit does not begin there.
    TakeValues {
        parameters: Parameters,
        model: Model,
    },
    /// Takes the values and the model of the shown fit.
    UseFit,
    /// Takes the values from before the shown fit.
    UseValuesBeforeFit,
    /// Takes the values and the model of an earlier fit, 0 the newest, and shows it with its
    /// measurement.
    ReturnToFit(usize),
    /// The fits of all presets to the measurements of those numbers: to one, or to several together.
    SetModelComparison {
        numbers: Vec<u64>,
        models: Vec<ComparedModel>,
    },
    /// Evidence of those rows of the comparison of the measurement of that number.
    SetEvidence {
        number: u64,
        found: Vec<(usize, Option<LogEvidence>)>,
    },
    /// Takes the values and the model of that row of the comparison.
    UseModelFit(usize),
    /// The parameter that the next profile is of.
    SetProfiled(Parameter),
    SetProfile(Option<ProfileCurve>),
    /// How many data sets the next bootstrap deals out.
    SetReplicates(usize),
    SetBootstrap(Option<Bootstrap>),
    /// Where the panes lie; no step of undo.
    SetLayout(Layout),
    /// The file of the session that is open.
    SetSessionFile(Option<PathBuf>),
    Undo,
    Redo,
}

/// What a fit that ran while sliders moved has found: estimates by the number of the measurement.
pub struct Refit(pub Vec<(u64, Vec<Estimate>)>);

/// What is either on or off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Switch {
    LogBrdf,
    Limit,
    Band,
    Backscatter,
    RefitLive,
    /// The bounds under the sliders.
    Bounds,
}

impl Switch {
    pub fn is_on(self, settings: &Settings) -> bool {
        match self {
            Self::LogBrdf => settings.log_brdf,
            Self::Limit => settings.show_limit,
            Self::Band => settings.show_band,
            Self::Backscatter => settings.show_backscatter,
            Self::RefitLive => settings.refit_live,
            Self::Bounds => settings.show_bounds,
        }
    }

    pub(super) fn set(self, settings: &mut Settings, on: bool) {
        *match self {
            Self::LogBrdf => &mut settings.log_brdf,
            Self::Limit => &mut settings.show_limit,
            Self::Band => &mut settings.show_band,
            Self::Backscatter => &mut settings.show_backscatter,
            Self::RefitLive => &mut settings.refit_live,
            Self::Bounds => &mut settings.show_bounds,
        } = on;
    }
}

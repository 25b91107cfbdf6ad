//! The changes that can be made to the work.

use crate::app::work::design::Plan;
use crate::app::work::diagnostics::{Bootstrap, ProfileCurve};
use crate::app::work::document::Document;
use crate::app::work::fit_history::FitEntry;
use crate::app::work::model_fit::ModelFit;
use crate::app::work::settings::{LandscapeAxes, MetalSelection, Settings, ViewOptions};
use pbrdf::fit::{FitOptions, FitResult, Starts};
use pbrdf::model::{Model, Parameter, ParameterSet, Parameters};

/// One change of the work, in terms of what a user does; [`Workspace::apply`] carries it out.
///
/// A panel never writes to the work. It gets a draft of the settings, whose differences [`Edit::between`] turns into edits; or, where a
/// widget needs a `&mut`, it hands the widget a copy of the small value behind it, and pushes an edit if the copy differs afterwards:
///
/// ```ignore
/// let mut options = cx.work.settings.shown;
/// ui.checkbox(&mut options.filled, tr!("Filled lobes"));
/// if options != cx.work.settings.shown {
///     cx.edits.push(Edit::SetViewOptions(options));
/// }
/// ```
///
/// The edits of a frame are carried out after it, in their order. Each bumps [`Workspace::revision`]; what depends on the work compares that
/// number.
///
/// [`Workspace::apply`]: crate::app::work::workspace::Workspace::apply
/// [`Workspace::revision`]: crate::app::work::workspace::Workspace::revision
pub enum Edit {
    /// One slider.
    SetParameter(Parameter, f64),
    /// All sliders.
    SetParameters(Parameters),
    SetModel(Model),
    /// The parameters that a fit leaves alone.
    SetLocked(ParameterSet),
    /// Lower and upper bound in fits; without, the range of the slider. Bounds that [`pbrdf::fit::Bounds::set`] refuses change nothing.
    SetBounds(Parameter, Option<(f64, f64)>),
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
    SetMetalSelection(MetalSelection),
    /// The angles that might be measured.
    SetPlan(Plan),
    /// Masks these rows of the active measurement, or unmasks them.
    Mask {
        rows: Vec<usize>,
        masked: bool,
    },
    /// Puts a measurement in the place of the active one.
    Open(Box<Document>),
    /// Adds a finished fit to the history, shows it and takes its values.
    AddFit(Box<FitEntry>),
    /// Takes the free parameters of a fit that ran while sliders moved.
    Refit(Box<FitResult>),
    /// Values and model of something that was looked at. A live refit does not begin there.
    TakeValues {
        parameters: Parameters,
        model: Model,
    },
    /// Takes the values and the model of the shown fit.
    UseFit,
    /// Takes the values from before the shown fit.
    UseValuesBeforeFit,
    /// Takes the values and the model of an earlier fit, 0 the newest, and shows it.
    ReturnToFit(usize),
    /// The fits of all presets to the active measurement.
    SetModelComparison(Vec<ModelFit>),
    /// Takes the values and the model of that row of the comparison.
    UseModelFit(usize),
    SetProfile(Option<ProfileCurve>),
    SetBootstrap(Option<Bootstrap>),
    Undo,
    Redo,
}

impl Edit {
    /// The edits that lead from some settings to others.
    pub fn between(before: &Settings, after: &Settings) -> Vec<Self> {
        let mut edits = Vec::new();
        let is_other = |a: f64, b: f64| a.to_bits() != b.to_bits();
        for parameter in Parameter::ALL {
            let value = after.parameters[parameter];
            if is_other(before.parameters[parameter], value) {
                edits.push(Self::SetParameter(parameter, value));
            }
            let bounds = |settings: &Settings| {
                let own = settings.bounds.iter().find(|(other, ..)| *other == parameter);
                own.map(|(_, low, high)| (*low, *high))
            };
            if bounds(before) != bounds(after) {
                edits.push(Self::SetBounds(parameter, bounds(after)));
            }
        }
        for switch in Switch::ALL {
            let on = switch.is_on(after);
            if switch.is_on(before) != on {
                edits.push(Self::SetSwitch(switch, on));
            }
        }
        let others = [
            (before.model != after.model, Self::SetModel(after.model)),
            (before.locked != after.locked, Self::SetLocked(after.locked)),
            (before.choices != after.choices, Self::SetFitOptions(after.choices)),
            (before.starts != after.starts, Self::SetStarts(after.starts)),
            (before.seed != after.seed, Self::SetSeed(after.seed)),
            (before.shown != after.shown, Self::SetViewOptions(after.shown)),
            (before.landscape != after.landscape, Self::SetLandscapeAxes(after.landscape)),
            (
                is_other(before.theta_i, after.theta_i) || is_other(before.dphi, after.dphi),
                Self::SetDirection { theta_i: after.theta_i, dphi: after.dphi },
            ),
        ];
        edits.extend(others.into_iter().filter(|(is_changed, _)| *is_changed).map(|(_, edit)| edit));
        if before.tabulated != after.tabulated {
            edits.push(Self::SetMetalSelection(after.tabulated.clone()));
        }
        if before.plan != after.plan {
            edits.push(Self::SetPlan(after.plan.clone()));
        }
        edits
    }
}

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
    pub const ALL: [Self; 6] = [Self::LogBrdf, Self::Limit, Self::Band, Self::Backscatter, Self::RefitLive, Self::Bounds];

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

#[cfg(test)]
mod tests {
    use super::{Edit, Switch};
    use crate::app::work::settings::Settings;
    use crate::app::work::workspace::Workspace;
    use pbrdf::model::{Parameter, ParameterSet};

    #[test]
    fn edits_between_settings_lead_from_one_to_the_other() {
        let before = Settings::default();
        let mut after = before.clone();
        assert!(Edit::between(&before, &after).is_empty());
        (after.parameters.n, after.parameters.k, after.theta_i, after.seed) = (1.5, f64::NAN, 12.0, 7);
        after.locked = ParameterSet::ALL;
        after.set_bounds(Parameter::N, 0.5, 3.0).expect("sound bounds");
        after.shown.filled = true;
        after.landscape.contours = false;
        after.tabulated.follow = false;
        after.model.volume = false;
        after.plan.noise = 0.5;
        for switch in Switch::ALL {
            switch.set(&mut after, !switch.is_on(&before));
        }
        let mut work = Workspace::new(before);
        let revision = work.revision();
        Edit::between(&work.settings, &after).into_iter().for_each(|edit| work.apply(edit));
        assert!(work.revision() > revision);
        assert!(work.settings.parameters.k.is_nan());
        // A value that is not a number differs from itself.
        (work.settings.parameters.k, after.parameters.k) = (0.0, 0.0);
        assert_eq!(work.settings, after);
        after.parameters.k = f64::NAN;
        let same = after.clone();
        assert!(Edit::between(&same, &after).is_empty());
    }
}

//! Messages of `pbrdf::fit::posterior`.

use crate::app::text::i18n::translated;
use crate::app::text::localized::Localized;
use pbrdf::fit::UnknownName;
use pbrdf::fit::posterior::{OddsGrade, PosteriorError, PosteriorVerdict, PriorError};
use pbrdf::optics::shortest;
use tr::tr;

impl Localized for PriorError {
    fn localized(&self) -> String {
        match self {
            Self::OutsideBounds { parameter, low, high } => {
                tr!("the prior of {0} lies outside its bounds {1} … {2}", parameter.symbol(), shortest(*low), shortest(*high))
            }
            Self::NoDistribution { parameter, expected } => {
                tr!("the prior of {0} is no distribution: {1}", parameter.symbol(), translated(expected))
            }
            Self::NotFree { parameter } => tr!("{} is not free and has no prior", parameter.symbol()),
        }
    }
}

impl Localized for OddsGrade {
    fn localized(&self) -> String {
        match self {
            Self::NotWorthMention => tr!("not worth more than a bare mention"),
            Self::Positive => tr!("positive evidence"),
            Self::Strong => tr!("strong evidence"),
            Self::VeryStrong => tr!("very strong evidence"),
        }
    }
}

impl Localized for PosteriorError {
    fn localized(&self) -> String {
        match self {
            Self::Prior(error) => error.localized(),
            Self::Bounds(error) => error.localized(),
            Self::NothingFree => tr!("no parameter is free: there is nothing to draw"),
            Self::NoData => tr!("there are no data: the posterior is the prior"),
            Self::TooFewDraws { draws, chains } => tr!("{0} draws of {1} chains are too few", draws, chains),
            Self::NotFinite => tr!("the likelihood is not finite at the fit, so no chain can begin there"),
        }
    }
}

impl<N: UnknownName> Localized for PosteriorVerdict<N> {
    fn localized(&self) -> String {
        match self {
            Self::Converged { size } => tr!("converged: at least {} effective draws of each parameter", format!("{size:.0}")),
            Self::TooFewDraws => tr!("too few draws to tell whether the chains have converged"),
            Self::NotMixed { parameter, rhat } => {
                tr!("not converged: the chains disagree on {0} (R-hat {1}); draw more", parameter.symbol(), format!("{rhat:.3}"))
            }
            Self::SmallSize { parameter, size } => {
                tr!("rough: {0} has {1} effective draws only; draw more", parameter.symbol(), format!("{size:.0}"))
            }
            Self::Diverged { count, share } => tr!(
                "nearly converged: {0} transitions ({1} %) diverged in a narrow place, whose weight may be off by as much",
                count,
                format!("{:.1}", 100.0 * share)
            ),
        }
    }
}

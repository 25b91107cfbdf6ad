//! The section of a report about draws from the posterior.

use crate::report::corner_figure::{CornerFigure, FittedMark};
use crate::report::document::DocumentPart;
use crate::report::language::ReportLanguage;
use pbrdf::fit::UnknownName;
use pbrdf::fit::posterior::{BoundedPrior, MarginalSummary, PosteriorSample, PosteriorSettings};
use pbrdf::rounding::significant;

/// Draws with everything that a report states of them.
#[derive(Clone, Copy)]
pub struct PosteriorSection<'a, N, P> {
    /// The draws.
    pub draws: &'a PosteriorSample<N, P>,
    /// What they say of each free parameter.
    pub summaries: &'a [MarginalSummary],
    /// The prior of each.
    pub priors: &'a [BoundedPrior],
    /// How they were drawn.
    pub settings: PosteriorSettings,
    /// Whether they are to be trusted, in the language of the document.
    pub verdict: &'a str,
    /// What the fit says of each free parameter.
    pub fitted: &'a [Option<FittedMark>],
    /// The language of the document.
    pub words: &'a dyn ReportLanguage,
}

impl<N: UnknownName, P> PosteriorSection<'_, N, P> {
    /// Its heading, the corner plot, what the draws say of each parameter, and how they came about.
    #[must_use]
    pub fn parts(&self) -> Vec<DocumentPart> {
        let words = self.words;
        let PosteriorSettings { draws, chains, seed } = self.settings;
        let text = "{0} draws by a no-U-turn sampler ({1} of each of {2} chains were asked for, seed {3}); {4}.";
        let made = words.fill(text, &[&self.draws.len(), &draws, &chains, &seed, &self.verdict]);
        let shown = (0..self.draws.parameters.len()).collect();
        let corner = CornerFigure::new(self.draws, self.priors, shown, self.fitted, String::new()).figure;
        let caption = words.text(
            "Draws from the posterior: every free parameter with its prior (dashed), every pair with lines around 68 and 95 % of the draws; \
             red, the fit and its interval at 68.3 %.",
        );
        vec![
            DocumentPart::Heading(words.text("Posterior")),
            DocumentPart::Paragraph(made),
            DocumentPart::Picture { name: "posterior".to_owned(), caption, figure: Box::new(corner) },
            self.table(),
        ]
    }

    fn table(&self) -> DocumentPart {
        let head = ["parameter", "prior", "median", "68 %", "90 %", "R-hat", "effective draws"].map(|name| self.words.text(name));
        let row = |((name, summary), prior): ((&N, &MarginalSummary), &BoundedPrior)| {
            let [q05, q16, q50, q84, q95] = summary.quantiles.map(|value| significant(value, 4));
            let (rhat, size) = summary
                .convergence
                .map_or((String::new(), String::new()), |of| (format!("{:.3}", of.rhat), format!("{:.0}", of.ess_bulk.min(of.ess_tail))));
            let (low, high) = prior.ends();
            let prior = format!("{} {low} … {high}", self.words.text(prior.kind()));
            vec![name.symbol().into_owned(), prior, q50, format!("{q16} … {q84}"), format!("{q05} … {q95}"), rhat, size]
        };
        let rows = self.draws.parameters.iter().zip(self.summaries).zip(self.priors).map(row).collect();
        DocumentPart::Table { head: head.to_vec(), rows }
    }
}

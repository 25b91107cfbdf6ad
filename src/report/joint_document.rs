//! A joint fit as a document: what all measurements share, what each has for itself, and the figures and
//! data of each.

use crate::figure::Figure;
use crate::report::document::{DocumentPart, ReportDocument};
use crate::report::fit_document::{DataSource, FitDocument, correlation_parts};
use crate::report::language::ReportLanguage;
use crate::report::result_table::{ResultCells, ResultColumn, ResultTable};
use pbrdf::fit::{FitResult, JointProblem, JointResult};
use pbrdf::measurement::Measurement;
use pbrdf::model::{Parameter, ParameterSet};
use pbrdf::rounding::significant;

/// One measurement of a joint fit, and where it comes from.
#[derive(Debug, Clone, Copy)]
pub struct JointSource<'a> {
    /// What it is called.
    pub name: &'a str,
    /// The data.
    pub measurement: &'a Measurement,
    /// Where they come from.
    pub source: &'a DataSource,
}

/// A joint fit with everything that its report states.
#[derive(Clone, Copy)]
pub struct JointDocument<'a> {
    /// The measurements, in the order of the fit.
    pub sources: &'a [JointSource<'a>],
    /// What was minimised.
    pub problem: &'a JointProblem,
    /// What came out.
    pub report: &'a JointResult,
    /// The program and its version.
    pub program: &'a str,
    /// Date and time of the report, as ISO 8601; empty if unknown.
    pub date: &'a str,
    /// Its language.
    pub words: &'a dyn ReportLanguage,
}

/// Figures side by side, at most.
const MOST_COLUMNS: usize = 3;

impl JointDocument<'_> {
    fn heading(&self, english: &str) -> DocumentPart {
        DocumentPart::Heading(self.words.text(english))
    }

    /// What `content` takes from the document of each measurement by itself.
    fn each<T>(&self, content: impl Fn(usize, &FitDocument<'_>) -> T) -> Vec<T> {
        let of = |(place, ((source, problem), report)): (usize, ((&JointSource<'_>, _), FitResult))| {
            let Self { program, date, words, .. } = *self;
            let JointSource { measurement, source, .. } = *source;
            content(place, &FitDocument { measurement, source, problem, report: &report, program, date, words })
        };
        let reports = (0..self.sources.len()).map(|set| self.report.of_set(set));
        self.sources.iter().zip(self.problem.parts()).zip(reports).enumerate().map(of).collect()
    }

    /// The whole document.
    #[must_use]
    pub fn document(&self) -> ReportDocument {
        let mut parts = vec![DocumentPart::Paragraph(self.summary())];
        parts.extend(self.figures());
        parts.extend(self.parameters());
        parts.extend(self.open());
        parts.extend(correlation_parts(&self.report.correlations, self.words));
        parts.extend(self.goodness());
        parts.extend(self.data());
        parts.extend(self.each(|place, document| if place == 0 { document.model() } else { Vec::new() }).concat());
        parts.extend(self.each(|place, document| if place == 0 { document.made_by() } else { Vec::new() }).concat());
        let title = self.words.fill("Joint fit of {0} measurements", &[&self.sources.len()]);
        ReportDocument { title, language: self.words.language(), parts }
    }

    /// One figure: data, fit and residuals of each measurement, side by side.
    #[must_use]
    pub fn figure(&self) -> Option<Figure> {
        let title = |figure: Figure, place: usize| Figure { title: self.sources[place].name.to_owned(), ..figure };
        let figures = self.each(|place, document| document.figure().map(|figure| title(figure, place)));
        let figures: Vec<Figure> = figures.into_iter().flatten().collect();
        let columns = if figures.len() == 4 { 2 } else { MOST_COLUMNS };
        (!figures.is_empty()).then(|| Figure::sheet("", figures, columns))
    }

    fn summary(&self) -> String {
        let words = self.words;
        let keys = |set: ParameterSet| set.iter().map(|parameter| Parameter::symbol(parameter).to_owned()).collect::<Vec<_>>();
        let own = self.report.model.parameters().intersection(self.problem.own());
        let own = if own.is_empty() {
            words.text("All parameters are shared.")
        } else {
            words.fill("Each measurement has its own {0}; all other parameters are shared.", &[&words.list(&keys(own))])
        };
        let (used, all) = (self.each(|_, document| document.used()), self.sources.iter().map(|source| source.measurement.rows.len()));
        let (used, all) = (used.iter().sum::<usize>(), all.sum::<usize>());
        let JointResult { stop_reason, objective, start_objective, course, .. } = self.report;
        let number = |value: Option<f64>| value.map_or_else(|| words.text("not defined"), |value| significant(value, 6));
        let (before, after, reason) = (number(*start_objective), number(*objective), words.stop_reason(*stop_reason));
        let text = "{0} of {1} rows. How it ended: {2}. ΔE of Eq. (18) went from {3} to {4} in {5} evaluations and {6} ms.";
        let course = words.fill(text, &[&used, &all, &reason, &before, &after, &course.evaluations, &format!("{:.0}", course.elapsed_ms)]);
        format!("{own} {course}")
    }

    /// The figures of each measurement, its name before their captions.
    fn figures(&self) -> Vec<DocumentPart> {
        let named = |place: usize, part: DocumentPart| match part {
            DocumentPart::Picture { name, caption, figure } => {
                let caption = format!("{}: {caption}", self.sources[place].name);
                Some(DocumentPart::Picture { name: format!("{name}-{}", place + 1), caption, figure })
            }
            _ => None,
        };
        let of = |place: usize, document: &FitDocument<'_>| -> Vec<DocumentPart> {
            document.figures().into_iter().filter_map(|part| named(place, part)).collect()
        };
        std::iter::once(self.heading("Figures")).chain(self.each(of).concat()).collect()
    }

    fn parameters(&self) -> Vec<DocumentPart> {
        let column = |place: usize, document: &FitDocument<'_>| {
            ResultColumn::of_set(self.sources[place].name.to_owned(), self.report, place, document.used())
        };
        let ResultCells { head, rows, notes, .. } = ResultTable { columns: self.each(column) }.cells(self.words);
        let help = self.words.text("The digits in brackets are the uncertainty in the last digits of the value, at 68.3 %.");
        let mut parts = vec![self.heading("Parameters"), DocumentPart::Table { head, rows }, DocumentPart::Paragraph(help)];
        if !notes.is_empty() {
            parts.push(DocumentPart::List(notes));
        }
        parts
    }

    fn open(&self) -> Vec<DocumentPart> {
        let open: Vec<String> = self.report.describe_undetermined().iter().map(|what| self.words.undetermined_jointly(what)).collect();
        let what = match () {
            () if !open.is_empty() => DocumentPart::List(open),
            () if self.problem.unknowns().is_empty() => DocumentPart::Paragraph(self.words.text("No parameter was free.")),
            () => DocumentPart::Paragraph(self.words.text("Nothing: every free parameter is determined.")),
        };
        vec![self.heading("What the data leave open"), what]
    }

    fn goodness(&self) -> Vec<DocumentPart> {
        let (words, statistics) = (self.words, &self.report.statistics);
        let number = |value: Option<f64>| value.map_or_else(|| words.text("not defined"), |value| significant(value, 6));
        let mut rows = vec![
            (words.text("ΔE, Eq. (18)"), number(self.report.objective)),
            (words.text("sum of squares"), significant(statistics.rss, 6)),
            (words.text("degrees of freedom"), statistics.dof.to_string()),
        ];
        if statistics.chi2.is_some() {
            rows.push((words.text("χ²"), number(statistics.chi2)));
        }
        rows.push((words.text("AICc"), number(statistics.aicc)));
        let rows = rows.into_iter().map(|(name, value)| vec![name, value]).collect();
        vec![self.heading("Goodness of fit"), DocumentPart::Table { head: Vec::new(), rows }]
    }

    /// The data of each measurement under its name.
    fn data(&self) -> Vec<DocumentPart> {
        let of = |place: usize, document: &FitDocument<'_>| {
            let heading = DocumentPart::Heading(self.words.fill("Data: {0}", &[&self.sources[place].name]));
            std::iter::once(heading).chain(document.data().into_iter().skip(1)).collect::<Vec<_>>()
        };
        self.each(of).concat()
    }
}

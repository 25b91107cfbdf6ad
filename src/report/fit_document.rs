//! A fit as a document: data and their source, model, options, parameters, undetermined directions,
//! figures.

use crate::figure::{Figure, Panel};
use crate::report::document::{DocumentPart, ReportDocument};
use crate::report::fit_figures::FitFigures;
use crate::report::language::ReportLanguage;
use pbrdf::fit::{
    BrdfResiduals, Correlations, Edge, Estimate, EstimateStatus, FitOptions, FitRange, FitResult, Interval, Loss, Problem, Tie,
    UnknownName, Weights,
};
use pbrdf::measurement::{IncidenceSeries, Measurement, Row};
use pbrdf::model::{Audit, Check, Diffuse, DolpFormula, Finding, Model, Parameter, Pbrdf, Preset};
use pbrdf::optics::{Masking, SlopeDistribution};
use pbrdf::rounding::{significant, trimmed};

/// Where measured data come from.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct DataSource {
    /// Name of the file.
    pub name: String,
    /// SHA-256 of its bytes in hexadecimal digits.
    pub sha256: Option<String>,
}

/// A fit with everything that its report states.
#[derive(Clone, Copy)]
pub struct FitDocument<'a> {
    /// The data.
    pub measurement: &'a Measurement,
    /// Where they come from.
    pub source: &'a DataSource,
    /// What was minimised.
    pub problem: &'a Problem,
    /// What came out.
    pub report: &'a FitResult,
    /// The program and its version.
    pub program: &'a str,
    /// Date and time of the report, as ISO 8601; empty if unknown.
    pub date: &'a str,
    /// Its language.
    pub words: &'a dyn ReportLanguage,
}

impl FitDocument<'_> {
    /// A text in the language of the document.
    fn text(&self, english: &str) -> String {
        self.words.text(english)
    }

    fn heading(&self, english: &str) -> DocumentPart {
        DocumentPart::Heading(self.text(english))
    }

    fn paragraph(&self, english: &str) -> DocumentPart {
        DocumentPart::Paragraph(self.text(english))
    }

    /// Rows of a table with two columns, each with a name.
    fn pairs(&self, rows: Vec<(&str, String)>) -> DocumentPart {
        DocumentPart::Table { head: Vec::new(), rows: rows.into_iter().map(|(key, value)| vec![self.text(key), value]).collect() }
    }

    /// The head of a table.
    fn head<const N: usize>(&self, names: [&str; N]) -> Vec<String> {
        names.into_iter().map(|name| if name.is_empty() { String::new() } else { self.text(name) }).collect()
    }

    fn number(&self, value: Option<f64>) -> String {
        value.map_or_else(|| self.text("not defined"), |value| significant(value, 6))
    }

    /// A figure with a caption.
    fn picture(&self, name: &str, caption: String, figure: &Figure) -> DocumentPart {
        DocumentPart::Picture { name: name.to_owned(), caption, figure: Box::new(figure.translate(&|text| self.words.label(text))) }
    }

    /// The whole document.
    #[must_use]
    pub fn document(&self) -> ReportDocument {
        let mut parts = vec![DocumentPart::Paragraph(self.summary())];
        parts.extend(self.figures());
        parts.extend(self.parameters());
        parts.extend(self.open());
        parts.extend(self.correlations());
        parts.extend(self.goodness());
        parts.extend(self.data());
        parts.extend(self.model());
        parts.extend(self.audit());
        parts.extend(self.made_by());
        ReportDocument { title: self.words.fill("Fit of {0}", &[&self.source.name]), language: self.words.language(), parts }
    }

    /// The program, and when.
    pub(super) fn made_by(&self) -> Vec<DocumentPart> {
        let date = if self.date.is_empty() { String::new() } else { format!(", {}", self.date) };
        vec![self.heading("Program"), DocumentPart::Paragraph(format!("{}{date}.", self.program))]
    }

    /// One figure of data, fit and residuals: DoLP and, where it is measured and predicted, the BRDF
    /// below it.
    #[must_use]
    pub fn figure(&self) -> Option<Figure> {
        let surface = Pbrdf::new(self.report.model, self.report.parameters).ok()?;
        let series = IncidenceSeries::of(&self.measurement.rows);
        let figures = FitFigures::new(&surface, &series);
        let brdf = if self.measurement.has_brdf() && !self.choices().dolp_only { figures.brdf(&self.source.name) } else { None };
        match (figures.dolp(&self.source.name), brdf) {
            (Some(dolp), Some(brdf)) => {
                let panels = dolp.panels.into_iter().chain(brdf.panels.into_iter().map(|panel| Panel { height_share: 2.6, ..panel }));
                Some(Figure { panels: panels.collect(), height_mm: dolp.height_mm + brdf.height_mm, ..dolp })
            }
            (dolp, brdf) => dolp.or(brdf),
        }
    }

    pub(super) fn used(&self) -> usize {
        let is_used = |row: &&Row| !row.masked && self.choices().range.is_none_or(|range| range.contains(row.geometry));
        self.measurement.rows.iter().filter(is_used).count()
    }

    fn choices(&self) -> &FitOptions {
        self.problem.options()
    }

    fn summary(&self) -> String {
        let FitResult { stop_reason, objective, start_objective, course, .. } = self.report;
        // Sessions of old versions do not hold the number of evaluations.
        let (rows, reason) = (self.measurement.rows.len(), self.words.stop_reason(*stop_reason));
        let (before, after) = (self.number(*start_objective), self.number(*objective));
        if course.minima.is_empty() {
            let text = "{0} of {1} rows. How it ended: {2}. ΔE of Eq. (18) went from {3} to {4}.";
            return self.words.fill(text, &[&self.used(), &rows, &reason, &before, &after]);
        }
        let text = "{0} of {1} rows. How it ended: {2}. ΔE of Eq. (18) went from {3} to {4} in {5} evaluations and {6} ms.";
        self.words.fill(text, &[&self.used(), &rows, &reason, &before, &after, &course.evaluations, &format!("{:.0}", course.elapsed_ms)])
    }

    pub(super) fn figures(&self) -> Vec<DocumentPart> {
        let Ok(surface) = Pbrdf::new(self.report.model, self.report.parameters) else { return Vec::new() };
        let series = IncidenceSeries::of(&self.measurement.rows);
        let figures = FitFigures::new(&surface, &series);
        let mut parts = vec![self.heading("Figures")];
        if let Some(figure) = figures.dolp("") {
            let caption = self.text(
                "DoLP against the angle of view: points measured, curves fitted, dashed the Fresnel limit that no diffuse or volume term \
                 can exceed; below, model less measured.",
            );
            parts.push(self.picture("dolp", caption, &figure));
        }
        let predicts_brdf = !self.choices().dolp_only;
        if let Some(figure) = figures.brdf("").filter(|_| predicts_brdf) {
            let caption = match series.first() {
                Some(first) if !self.measurement.has_brdf() => {
                    let text = "Lobes of the BRDF at {0} with the weights of the fit; no BRDF was measured.";
                    self.words.fill(text, &[&first.name()])
                }
                _ => self.text("BRDF against the angle of view: points measured, curves fitted."),
            };
            parts.push(self.picture("brdf", caption, &figure));
        }
        parts
    }

    fn parameters(&self) -> Vec<DocumentPart> {
        let has_intervals = self.report.course.intervals_complete.is_some();
        let mut head = self.head(["", "parameter", "value", "standard error", "start", "bounds", "unit"]);
        if has_intervals {
            head.splice(3..4, self.head(["interval, 68.3 %", "interval, 95 %"]));
        }
        let row = |estimate: &Estimate| {
            let Estimate { parameter, start, free, interval95, .. } = *estimate;
            let mut cells =
                vec![parameter.symbol().to_owned(), self.text(parameter.name()), estimate.value_text(), self.uncertainty(estimate)];
            if has_intervals {
                cells.push(interval95.map_or_else(String::new, |interval| self.interval(interval)));
            }
            let (low, high) = self.problem.bounds().of(parameter);
            cells.extend([trimmed(start, 6), if free { format!("{low} … {high}") } else { String::new() }, parameter.unit().to_owned()]);
            cells
        };
        let table = DocumentPart::Table { head, rows: self.report.estimates.iter().map(row).collect() };
        let errors = match self.choices().weights {
            _ if has_intervals => {
                "Intervals are by profile likelihood: the parameter held, all others fitted again, until the misfit is as large as the level \
                 allows. A side that the parameter's bound ends is open; open on both sides, the data do not determine it. The intervals say \
                 nothing about a wrong model."
            }
            Weights::Sigma => "Standard errors are those of the stated standard deviations, one each, linearised at the solution.",
            Weights::None => {
                "Standard errors come from the scatter of the residuals, one standard deviation each, linearised at the solution; \
                 they say nothing about a wrong model."
            }
        };
        let mut parts = vec![self.heading("Parameters"), table, self.paragraph(errors)];
        if self.report.course.intervals_complete == Some(false) {
            parts.push(self.paragraph("Not every interval was followed to its end: some may be wider."));
        }
        if !has_intervals && self.report.estimates.iter().any(|estimate| estimate.at_bound.is_some()) {
            parts.push(self.paragraph("A parameter at a bound has no standard error, and those of the others hold with it kept there."));
        }
        parts
    }

    /// How uncertain an estimate is, or why that is not known, and which bound it rests on.
    fn uncertainty(&self, estimate: &Estimate) -> String {
        let bound = |edge| self.text(if edge == Edge::Lower { "at lower bound" } else { "at upper bound" });
        let text = match estimate.status() {
            EstimateStatus::Fixed => self.text("fixed"),
            EstimateStatus::AtBound(edge) => return bound(edge),
            EstimateStatus::Determined(_) | EstimateStatus::Within(_) => estimate.uncertainty_text().unwrap_or_default(),
            EstimateStatus::UncertaintyUnknown => self.text("uncertainty unknown"),
            EstimateStatus::Undetermined => self.text("not determined"),
        };
        let parts: Vec<String> = [Some(text), estimate.at_bound.map(bound)].into_iter().flatten().collect();
        self.words.list(&parts)
    }

    /// An interval by its ends.
    fn interval(&self, interval: Interval) -> String {
        let end = |value: f64| significant(value, 4);
        match (interval.low, interval.high) {
            (Some(low), Some(high)) => format!("{} … {}", end(low), end(high)),
            (Some(low), None) => format!("> {}", end(low)),
            (None, Some(high)) => format!("< {}", end(high)),
            (None, None) => self.text("not determined"),
        }
    }

    fn open(&self) -> Vec<DocumentPart> {
        let open = self.report.describe_undetermined();
        let mut parts = vec![self.heading("What the data leave open")];
        if open.is_empty() {
            let text = if self.report.correlations.parameters.is_empty() {
                "No parameter was free."
            } else {
                "Nothing: every free parameter is determined."
            };
            parts.push(self.paragraph(text));
        } else {
            parts.push(DocumentPart::List(open.iter().map(|what| self.words.undetermined(what)).collect()));
        }
        if !self.report.undetermined.is_empty() {
            parts.push(self.paragraph(
                "Along an open direction the parameters may change together without changing what was measured: their values above are \
                 one choice among many and have no standard error.",
            ));
        }
        parts
    }

    fn correlations(&self) -> Vec<DocumentPart> {
        correlation_parts(&self.report.correlations, self.words)
    }

    fn goodness(&self) -> Vec<DocumentPart> {
        let report = self.report;
        let mut rows = vec![
            ("ΔE, Eq. (18)", self.number(report.objective)),
            ("sum of squares", significant(report.statistics.rss, 6)),
            ("degrees of freedom", report.statistics.dof.to_string()),
        ];
        if let Some(chi2) = report.statistics.chi2 {
            rows.push(("χ²", significant(chi2, 6)));
            #[expect(clippy::cast_precision_loss, reason = "a number of residuals")]
            rows.push(("χ² per degree of freedom", self.number((report.statistics.dof > 0).then(|| chi2 / report.statistics.dof as f64))));
        }
        rows.push(("AICc", self.number(report.statistics.aicc)));
        let mut parts = vec![self.heading("Goodness of fit"), self.pairs(rows)];
        if let Some(share) = report.course.unseen_share() {
            let share = significant(100.0 * share, 2);
            let text = "{0} starts, {1} in the best basin; about {2} % of further starts would end in a minimum not seen (Boender and Kan, \
                        Math. Program. 37, 59 (1987)).";
            parts.push(DocumentPart::Paragraph(self.words.fill(text, &[&report.course.starts(), &report.course.hits_of_best(), &share])));
        }
        if report.course.minima.len() > 1 {
            let row = |minimum: &pbrdf::fit::Minimum| {
                vec![significant(minimum.objective, 6), minimum.hits.to_string(), self.words.stop_reason(minimum.stop_reason)]
            };
            parts.push(self.paragraph("Where the starts ended, the best first:"));
            parts.push(DocumentPart::Table {
                head: self.head(["ΔE", "starts", "why there"]),
                rows: report.course.minima.iter().map(row).collect(),
            });
        }
        parts
    }

    pub(super) fn data(&self) -> Vec<DocumentPart> {
        let measurement = self.measurement;
        let masked = measurement.rows.len() - self.used();
        let mut rows = vec![("file", self.source.name.clone())];
        if let Some(sha256) = &self.source.sha256 {
            rows.push(("SHA-256 of the file", sha256.clone()));
        }
        rows.push(("rows", self.words.fill("{0}, {1} of them masked and not used", &[&measurement.rows.len(), &masked])));
        let quantity = |there: bool, count: usize, name: &str| there.then(|| self.words.fill(name, &[&count]));
        let count = |of: fn(&pbrdf::measurement::Row) -> bool| measurement.rows.iter().filter(|row| of(row)).count();
        let measured = [
            quantity(measurement.has_dolp(), count(|row| row.dolp.is_some()), "DoLP ({0} values)"),
            quantity(measurement.has_brdf(), count(|row| row.brdf.is_some()), "BRDF in 1/sr ({0} values)"),
        ];
        rows.push(("measured", self.words.list(&measured.into_iter().flatten().collect::<Vec<_>>())));
        let angles: Vec<String> = measurement.incidence_angles().iter().take(20).map(|angle| format!("{angle}°")).collect();
        rows.push(("angles of incidence", angles.join(", ")));
        let mut parts = vec![self.heading("Data"), self.pairs(rows)];
        if !measurement.metadata.is_empty() {
            parts.push(DocumentPart::Quoted(measurement.metadata.clone()));
        }
        parts
    }

    pub(super) fn model(&self) -> Vec<DocumentPart> {
        let model = self.report.model;
        let preset = Preset::of_fit(model, self.choices().dolp_only);
        let mut rows = vec![
            ("model", self.text(preset.map_or("own choice of terms", |preset| preset.name))),
            ("source", preset.map_or_else(String::new, |preset| self.text(preset.citation))),
            ("terms", self.terms(model)),
        ];
        rows.extend(self.choice_rows());
        vec![self.heading("Model and choices"), self.pairs(rows)]
    }

    /// Physical checks of the fitted surface.
    fn audit(&self) -> Vec<DocumentPart> {
        let Ok(surface) = Pbrdf::new(self.report.model, self.report.parameters) else { return Vec::new() };
        let row = |finding: &Finding| {
            let Finding { check, value, bar, pass, at } = *finding;
            let place =
                at.map_or_else(String::new, |at| format!("θi = {}°, θr = {}°, Δφ = {}°", at.theta_i().0, at.theta_r().0, at.dphi().0));
            let verdict = if pass { "pass" } else { "fail" };
            let (name, verdict, why) = (self.text(name_of(check)), self.text(verdict), self.words.finding(finding));
            vec![name, significant(value, 4), significant(bar, 2), verdict, place, why]
        };
        let head = self.head(["check", "number", "limit", "verdict", "direction", "why"]);
        vec![self.heading("Audit"), DocumentPart::Table { head, rows: Audit::new(&surface).findings.iter().map(row).collect() }]
    }

    fn choice_rows(&self) -> Vec<(&'static str, String)> {
        let FitOptions { weights, brdf_residuals, loss, loss_scale, dolp_only, range } = self.choices();
        let weights = match weights {
            Weights::None => "none: all values of a quantity count alike",
            Weights::Sigma => "each residual divided by the stated standard deviation",
        };
        let brdf = match brdf_residuals {
            BrdfResiduals::Absolute => "X − Xm".to_owned(),
            BrdfResiduals::Relative => "(X − Xm)/Xm".to_owned(),
            BrdfResiduals::Log => "ln X − ln Xm".to_owned(),
        };
        let scale = || match loss_scale {
            None => self.text("scale from the residuals of a linear fit"),
            Some(scale) => self.words.fill("scale {0}", &[scale]),
        };
        let loss = match loss {
            Loss::Squared => self.text("squares"),
            Loss::Huber => self.words.fill("Huber, {0}", &[&scale()]),
            Loss::SoftL1 => self.words.fill("soft L1, {0}", &[&scale()]),
        };
        let reading = match self.problem.model().dolp_formula {
            DolpFormula::Consistent => "consistent: k_s in the numerator",
            DolpFormula::AsPrinted => "as printed: k_s missing from the numerator",
        };
        let free: Vec<&str> = self.problem.free().iter().map(|&parameter| Parameter::symbol(parameter)).collect();
        let mut rows = vec![("free parameters", free.join(", ")), ("weights", self.text(weights))];
        if self.measurement.has_brdf() {
            let brdf = if *dolp_only { self.text("not used: the model predicts DoLP only") } else { brdf };
            rows.push(("residuals of BRDF", brdf));
        }
        rows.extend([("loss", loss), ("reading of Eq. (17)", self.text(reading))]);
        rows.extend(range.map(|FitRange { theta_i: [from, to], theta_r: [low, high] }| {
            ("angles", format!("{from}° ≤ θi ≤ {to}°, {low}° ≤ θr ≤ {high}°"))
        }));
        let tie = |tie: &Tie| format!("{} = {} × {}", tie.parameter.symbol(), tie.factor, tie.to.symbol());
        let ties: Vec<String> = self.problem.ties().iter().map(tie).collect();
        if !ties.is_empty() {
            rows.push(("ties", ties.join(", ")));
        }
        if self.problem.emphasis() != 1.0 {
            rows.push(("weight among the measurements", significant(self.problem.emphasis(), 4)));
        }
        rows
    }

    /// The terms of a model.
    fn terms(&self, model: Model) -> String {
        let distribution = match model.distribution {
            SlopeDistribution::Gauss => "Gauss facets",
            SlopeDistribution::Cauchy => "Cauchy facets",
        };
        let masking = match model.masking {
            Masking::VGroove => "masking and shadowing of V grooves",
            _ => "no masking",
        };
        let diffuse = match model.diffuse {
            Diffuse::Absent => None,
            Diffuse::Lambert => Some("a Lambertian term"),
            Diffuse::Minnaert => Some("a Minnaert term"),
            Diffuse::Hyde => Some("a Lambertian term from the energy balance"),
        };
        let specular =
            model.specular.then(|| self.words.fill("a specular lobe of {0} with {1}", &[&self.text(distribution), &self.text(masking)]));
        let others = diffuse.into_iter().chain(model.volume.then_some("a volume term")).map(|term| self.text(term));
        self.words.list(&specular.into_iter().chain(others).collect::<Vec<_>>())
    }
}

/// Correlations as a table; nothing for fewer than two.
pub(super) fn correlation_parts<N: UnknownName>(correlations: &Correlations<N>, words: &dyn ReportLanguage) -> Vec<DocumentPart> {
    let names: Vec<String> = correlations.parameters.iter().map(|parameter| parameter.symbol().into_owned()).collect();
    if names.len() < 2 {
        return Vec::new();
    }
    let head = [String::new()].into_iter().chain(names.iter().cloned()).collect();
    let cell = |value: &f64| if value.is_finite() { format!("{value:.3}") } else { "–".to_owned() };
    let row = |(i, name): (usize, &String)| {
        let cells = correlations.matrix.row(i).iter().map(cell).collect::<Vec<_>>();
        [name.clone()].into_iter().chain(cells).collect()
    };
    let rows = names.iter().enumerate().map(row).collect();
    let heading = DocumentPart::Heading(words.text("Correlations of the determined parameters"));
    vec![heading, DocumentPart::Table { head, rows }]
}

/// A check in words.
fn name_of(check: Check) -> &'static str {
    match check {
        Check::SpecularReciprocity => "reciprocity of the specular term, relative defect",
        Check::DiffuseReciprocity => "reciprocity of the diffuse term, relative defect",
        Check::VolumeReciprocity => "reciprocity of the volume term, relative defect",
        Check::Reflectance => "directional-hemispherical reflectance, largest",
        Check::FresnelLimit => "DoLP above the Fresnel limit, largest",
        Check::Admissibility => "eigenvalue of the coherency matrix over m00, smallest",
        Check::Normalisation => "projected area of the facets, distance from 1",
    }
}

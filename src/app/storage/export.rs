//! What leaves the window as a file or to the clipboard: plots, curves, fits, sessions.

use crate::app::storage::session::Session;
use crate::app::text::i18n::translated;
use crate::app::text::localized::Localized as _;
use crate::app::text::messages::WindowWording;
use crate::app::work::fit_history::{FitEntry, JointEntry};
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::pane_id::PaneId;
use crate::app::work::picture_scene::{Scene, SceneKey};
use crate::app::work::posterior::{DrawnPosterior, marks_of_fit};
use crate::app::work::workspace::Workspace;
use crate::figure::Figure;
use crate::files::export;
use crate::files::picture::{StokesFileKind, stokes_file_kind, write_colors, write_exr, write_table};
use crate::files::write_file::write_file;
use crate::report::{
    DataSource, DocumentPart, FitDocument, JointDocument, JointSource, PosteriorSection, ReportDocument, ResultTable, fit_comments,
    least_movement, picture_map, write_curves, write_draws, write_fitted, write_fitted_sets, write_plan,
};
use pbrdf::fit::UnknownName as _;
use pbrdf::measurement::Measurement;
use pbrdf::model::{Pbrdf, Quality};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tr::tr;

/// Something that can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExportKind {
    Plot(PaneId),
    /// The plots on screen in one figure.
    Sheet(SheetForm),
    /// Fits side by side.
    Results,
    /// The model along every measured θi.
    Curves,
    /// The measurement with the fit beside it.
    Fitted,
    Report,
    /// Draws from the posterior.
    Draws,
    /// Planned angles as an empty table.
    Plan,
    /// The picture as numbers or colours.
    Picture,
    Session,
}

/// How plots stand in one figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SheetForm {
    /// Two, one above the other.
    Column,
    /// Two side by side.
    Row,
    /// Four.
    Square,
}

impl SheetForm {
    pub const ALL: [Self; 3] = [Self::Column, Self::Row, Self::Square];

    /// Rows and columns.
    pub fn shape(self) -> (usize, usize) {
        match self {
            Self::Column => (2, 1),
            Self::Row => (1, 2),
            Self::Square => (2, 2),
        }
    }
}

/// Writes it into that file; the error is a sentence.
pub type Write = Box<dyn FnOnce(&Path) -> Result<(), String> + Send>;

/// Resolution of a plot on the clipboard.
const SCREEN_DPI: f64 = 150.0;

impl ExportKind {
    /// What it is called in a sentence.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plot(_) => "The plot",
            Self::Sheet(_) => "The figure",
            Self::Results => "The table of results",
            Self::Curves => "The table of curves",
            Self::Fitted => "The table of the fit",
            Self::Report => "The report",
            Self::Draws => "The table of draws",
            Self::Plan => "The plan",
            Self::Picture => "The picture",
            Self::Session => "The session",
        }
    }

    /// Endings of its files, the usual one first.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Plot(_) | Self::Sheet(_) => &["svg", "png"],
            Self::Results => &["csv", "md", "tex"],
            Self::Curves | Self::Fitted | Self::Draws | Self::Plan => &["csv"],
            Self::Report => &["html", "md"],
            Self::Picture => &["exr", "png", "csv"],
            Self::Session => &["pbrdf.json"],
        }
    }

    /// A name to begin with.
    pub fn file_name(self, document: &OpenMeasurement) -> String {
        let name = document.file_name();
        let stem = name.trim_end_matches(".csv");
        let what = match self {
            Self::Plot(pane) => format!("-{}", pane.key()),
            Self::Sheet(_) => "-figure".to_owned(),
            Self::Results => "-results".to_owned(),
            Self::Curves => "-curves".to_owned(),
            Self::Fitted => "-fitted".to_owned(),
            Self::Report => "-report".to_owned(),
            Self::Draws => "-draws".to_owned(),
            Self::Plan => "-plan".to_owned(),
            Self::Picture => "-picture".to_owned(),
            Self::Session => String::new(),
        };
        format!("{stem}{what}.{}", self.extensions()[0])
    }

    /// The path with the usual ending, if it has none.
    pub fn with_ending(self, path: PathBuf) -> PathBuf {
        match path.extension() {
            Some(_) => path,
            None => path.with_extension(self.extensions()[0]),
        }
    }

    /// Refuses a path that ends like another kind of file; the error is a sentence.
    pub fn check(self, path: &Path) -> Result<(), String> {
        let fits = match self {
            Self::Plot(_) | Self::Sheet(_) => export::picture_kind(path).map(drop),
            Self::Results => export::table_format(path).map(drop),
            Self::Curves | Self::Fitted | Self::Draws | Self::Plan => export::expect_ending(path, "csv"),
            Self::Report => export::report_kind(path).map(drop),
            Self::Picture => stokes_file_kind(path).map(drop),
            Self::Session => export::expect_ending(path, "json"),
        };
        fits.map_err(|reason| tr!("{}.", reason.localized()))
    }

    /// A snapshot of the work that writes itself: the work may change while it is written. A plot
    /// is its figure.
    ///
    /// # Errors
    /// There is nothing to write; the error is a sentence.
    pub fn snapshot(self, work: &Workspace, figure: Option<Figure>) -> Result<Write, String> {
        match self {
            // The table is that of a pane.
            Self::Results => results(None),
            Self::Plot(_) | Self::Sheet(_) => {
                let figure = figure.ok_or_else(|| tr!("There is no plot to export."))?;
                Ok(Box::new(move |path| {
                    let kind = export::picture_kind(path).map_err(|reason| tr!("{}.", reason.localized()))?;
                    export::write_picture(path, kind, &figure).map_err(|error| failure(path, &error))
                }))
            }
            Self::Curves => {
                let surface = surface(work)?;
                let series = work.active().series.clone();
                let backscatter = work.settings().show_backscatter || work.active().has_backscatter();
                Ok(written(move |out| write_curves(&surface, &series, backscatter, out)))
            }
            Self::Fitted => {
                let fit = work.shown_fit().ok_or_else(|| translated(NO_FIT))?;
                fitted(fit, &parts_of(fit, work))
            }
            Self::Report => report(work),
            Self::Plan => plan(work),
            Self::Draws => {
                let drawn = work.posterior().ok_or_else(|| tr!("Nothing is drawn yet."))?.clone();
                Ok(written(move |out| write_draws(out, &drawn.draws)))
            }
            Self::Picture => picture(work),
            Self::Session => {
                let session = Session::of(work);
                Ok(written(move |out| session.write(out)))
            }
        }
    }
}

const NO_FIT: &str = "There is no fit yet.";

fn failure(path: &Path, error: &std::io::Error) -> String {
    tr!("{0} cannot be written: {1}.", path.display(), error.localized())
}

fn written(body: impl FnOnce(&mut dyn std::io::Write) -> std::io::Result<()> + Send + 'static) -> Write {
    Box::new(move |path| write_file(path, body).map_err(|error| failure(path, &error)))
}

fn surface(work: &Workspace) -> Result<Pbrdf, String> {
    Pbrdf::new(work.surface().model, work.surface().parameters).map_err(|error| tr!("There are no curves: {}.", error.localized()))
}

/// A table of results that writes itself; its form is that of the file's ending.
///
/// # Errors
/// There is none; a sentence.
pub fn results(table: Option<ResultTable>) -> Result<Write, String> {
    let table = table.ok_or_else(|| translated(NO_FIT))?;
    Ok(Box::new(move |path| {
        let format = export::table_format(path).map_err(|reason| tr!("{}.", reason.localized()))?;
        let text = table.text(format, &WindowWording);
        write_file(path, |out| out.write_all(text.as_bytes())).map_err(|error| failure(path, &error))
    }))
}

/// The fits of all measurements of a joint fit in their order; the fit alone where it was none, or where parts are gone.
fn parts_of(fit: &Arc<FitEntry>, work: &Workspace) -> Vec<Arc<FitEntry>> {
    let Some(joint) = &fit.joint else { return vec![fit.clone()] };
    let mut parts: Vec<Arc<FitEntry>> = work.fit_history().parts(fit.id).cloned().collect();
    parts.sort_by_key(|part| part.joint.as_ref().map(|joint| joint.set));
    if parts.len() == joint.of.result.sets.len() { parts } else { vec![fit.clone()] }
}

/// The measurements of a fit with the fitted values beside them.
fn fitted(fit: &FitEntry, parts: &[Arc<FitEntry>]) -> Result<Write, String> {
    let model = fit.preset().map_or("own terms", |preset| preset.key);
    let dolp_only = fit.problem.options().dolp_only;
    let surface = |fit: &FitEntry| Pbrdf::new(fit.report.model, fit.report.parameters).map_err(|error| tr!("{}.", error.localized()));
    let joint = fit.joint.as_ref().filter(|_| parts.len() > 1);
    let Some(joint) = joint else {
        let (surface, measurement) = (surface(fit)?, fit.measurement().measurement);
        let estimates = fit.report.estimates.iter().map(|estimate| (estimate.parameter.key(), estimate));
        let comments = fit_comments(model, fit.report.objective, estimates);
        return Ok(written(move |out| write_fitted(&measurement, &surface, dolp_only, &comments, out)));
    };
    let surfaces = parts.iter().map(|part| surface(part)).collect::<Result<Vec<_>, _>>()?;
    let estimates: Vec<_> = joint.of.result.estimates().map(|(name, estimate)| (name.key().into_owned(), estimate)).collect();
    let comments = fit_comments(model, joint.of.result.objective, estimates);
    let named = |(part, name): (&Arc<FitEntry>, &Arc<str>)| Measurement {
        name: name.to_string(),
        ..part.measurement().measurement.as_ref().clone()
    };
    let measurements: Vec<Measurement> = parts.iter().zip(joint.of.problem.set_names()).map(named).collect();
    Ok(written(move |out| {
        let sets: Vec<(&Measurement, Pbrdf)> = measurements.iter().zip(surfaces).collect();
        write_fitted_sets(&sets, dolp_only, &comments, out)
    }))
}

/// The report of the shown fit; of a joint one, that of all its measurements.
fn report(work: &Workspace) -> Result<Write, String> {
    let fit = work.shown_fit().cloned().ok_or_else(|| translated(NO_FIT))?;
    let parts = parts_of(&fit, work);
    let drawn = work.posterior().filter(|drawn| drawn.draws.model == fit.report.model).cloned();
    Ok(Box::new(move |path| {
        let kind = export::report_kind(path).map_err(|reason| tr!("{}.", reason.localized()))?;
        let whole = fit.joint.as_ref().filter(|joint| joint.of.result.sets.len() == parts.len());
        let mut document = whole.map_or_else(|| single_report(&fit), |joint| joint_report(&joint.of, &parts));
        // Before the heading and the line about the program.
        let last = document.parts.len().saturating_sub(2);
        document.parts.splice(last..last, drawn.iter().flat_map(|drawn| posterior_parts(drawn, &fit)));
        export::write_report(path, kind, &document).map_err(|error| failure(path, &error))
    }))
}

fn posterior_parts(drawn: &DrawnPosterior, fit: &Arc<FitEntry>) -> Vec<DocumentPart> {
    let DrawnPosterior { from, draws, summaries, .. } = drawn;
    let (fitted, verdict) = (marks_of_fit(Some(fit), drawn), drawn.verdict.localized());
    let (priors, settings) = (&from.priors[..], from.settings);
    PosteriorSection { draws, summaries, priors, settings, verdict: &verdict, fitted: &fitted, words: &WindowWording }.parts()
}

/// The planned readings in an order of little movement.
fn plan(work: &Workspace) -> Result<Write, String> {
    let design = &work.settings().design;
    if design.readings.is_empty() {
        return Err(tr!("No reading is planned yet."));
    }
    let (columns, dphi, ordered) = (design.columns, design.dphi, least_movement(&design.readings));
    Ok(written(move |out| write_plan(out, columns, ordered.iter().map(|[theta_i, theta_r]| [*theta_i, *theta_r, dphi]))))
}

/// Pixels along an edge of an exported picture.
const PICTURE_SIZE: usize = 512;

/// The picture of the sliders, one half of it of the companion where there is one.
fn picture(work: &Workspace) -> Result<Write, String> {
    surface(work)?;
    let (key, options) = (SceneKey::of(work), work.settings().panes.picture);
    Ok(Box::new(move |path| {
        let kind = stokes_file_kind(path).map_err(|reason| tr!("{}.", reason.localized()))?;
        let (lamp, has_sky) = (key.lamp, key.sky.is_some());
        let scene = Scene::new(key, PICTURE_SIZE, Quality::Fine, None, &|| false).ok_or_else(|| tr!("There is no picture to export."))?;
        let body = |out: &mut dyn std::io::Write| match kind {
            StokesFileKind::Png => {
                let (shown, axis) = (scene.shown(&options), options.quantity.axis());
                write_colors(&picture_map(&shown.values, PICTURE_SIZE, axis.between(shown.range.0, shown.range.1), shown.colors), out)
            }
            StokesFileKind::Exr => write_exr(&scene.exported(&options), out),
            StokesFileKind::Csv => write_table(&scene.picture, &scene.exported(&options), lamp.as_ref(), has_sky, out),
        };
        write_file(path, body).map_err(|error| failure(path, &error))
    }))
}

fn data_source(fit: &FitEntry) -> DataSource {
    DataSource { name: fit.document.clone(), sha256: fit.sha256.clone() }
}

fn single_report(fit: &FitEntry) -> ReportDocument {
    let (program, date) = (export::program(), export::now());
    let document = FitDocument {
        measurement: &fit.measurement().measurement,
        source: &data_source(fit),
        problem: &fit.problem,
        report: &fit.report,
        program: &program,
        date: &date,
        words: &WindowWording,
    };
    document.document()
}

fn joint_report(of: &JointEntry, parts: &[Arc<FitEntry>]) -> ReportDocument {
    let (program, date) = (export::program(), export::now());
    let origins: Vec<_> = parts.iter().map(|part| (part.measurement().measurement, data_source(part))).collect();
    let sources = parts.iter().zip(&origins);
    let sources = sources.map(|(part, origin)| JointSource { name: &part.document, measurement: &origin.0, source: &origin.1 });
    let sources: Vec<JointSource<'_>> = sources.collect();
    let (problem, report) = (&of.problem, &of.result);
    JointDocument { sources: &sources, problem, report, program: &program, date: &date, words: &WindowWording }.document()
}

/// A plot as an image for the clipboard.
///
/// # Errors
/// There is no plot, or it cannot be drawn; the error is a sentence.
pub fn image(figure: Option<Figure>) -> Result<egui::ColorImage, String> {
    let figure = figure.ok_or_else(|| tr!("There is no plot to copy."))?;
    let image = figure.image(SCREEN_DPI).map_err(|error| tr!("The plot cannot be drawn: {}.", error.localized()))?;
    Ok(egui::ColorImage::from_rgba_unmultiplied([image.width as usize, image.height as usize], &image.rgba))
}

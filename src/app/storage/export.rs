//! What leaves the window as a file or to the clipboard: plots, curves, fits, sessions.

use crate::app::plots::Ribbon;
use crate::app::plots::print::{FOREGROUND, MUTED, points};
use crate::app::shell::app::App;
use crate::app::shell::benchmarks::BenchmarkId;
use crate::app::shell::docking::PaneId;
use crate::app::storage::session::{SavedFit, Session};
use crate::app::text::i18n::{label, translated};
use crate::app::text::messages::{Localized as _, WindowWording};
use crate::app::views;
use crate::app::views::curves::{Curves, Marks};
use crate::app::work::document::Document;
use crate::app::work::fit_history::{FitEntry, FitHistory};
use crate::app::work::layout::Layout;
use crate::app::work::settings::Settings;
use crate::app::work::workspace::Workspace;
use crate::export;
use crate::figure::{Axis, Dash, Drawn, Figure, Panel, Point, Rgb, SERIES, Series, Symbol};
use crate::report::{FitDocument, Source, write_curves, write_fitted};
use crate::write_file::write_file;
use egui_plot::PlotPoint;
use pbrdf::model::Pbrdf;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tr::tr;

/// Something that can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExportKind {
    Plot(PaneId),
    /// The model along every measured θi.
    Curves,
    /// The measurement with the fit beside it.
    Fitted,
    Report,
    Session,
}

/// Writes it into that file; the error is a sentence.
pub type Write = Box<dyn FnOnce(&Path) -> Result<(), String> + Send>;

/// The panes with a plot that can be exported.
pub const PLOTS: [PaneId; 13] = [
    PaneId::Dolp,
    PaneId::Lobes,
    PaneId::PolarLobes,
    PaneId::Facets,
    PaneId::Convergence,
    PaneId::Metals,
    PaneId::Hemisphere,
    PaneId::Mueller,
    PaneId::Landscape,
    PaneId::Audit,
    PaneId::ErrorVsTime,
    PaneId::Stability,
    PaneId::Cost,
];

/// Resolution of a plot on the clipboard.
const SCREEN_DPI: f64 = 150.0;

impl ExportKind {
    /// What it is called in a sentence.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plot(_) => "The plot",
            Self::Curves => "The table of curves",
            Self::Fitted => "The table of the fit",
            Self::Report => "The report",
            Self::Session => "The session",
        }
    }

    /// Endings of its files, the usual one first.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Plot(_) => &["svg", "png"],
            Self::Curves | Self::Fitted => &["csv"],
            Self::Report => &["html", "md"],
            Self::Session => &["pbrdf.json"],
        }
    }

    /// A name to begin with.
    pub fn file_name(self, explorer: &App) -> String {
        let name = explorer.work.document.file_name();
        let stem = name.trim_end_matches(".csv");
        let what = match self {
            Self::Plot(pane) => format!("-{}", pane.entry().key),
            Self::Curves => "-curves".to_owned(),
            Self::Fitted => "-fitted".to_owned(),
            Self::Report => "-report".to_owned(),
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
            Self::Plot(_) => export::picture_kind(path).map(drop),
            Self::Curves | Self::Fitted => export::expect_ending(path, "csv"),
            Self::Report => export::report_kind(path).map(drop),
            Self::Session => export::expect_ending(path, "json"),
        };
        fits.map_err(|reason| tr!("{}.", reason.localized()))
    }

    /// What is needed to write it, taken from the window as it is now; the error is a sentence.
    pub fn taken_from(self, explorer: &App) -> Result<Write, String> {
        match self {
            Self::Plot(pane) => {
                let figure = figure(explorer, pane).ok_or_else(|| tr!("There is no plot to export."))?;
                Ok(Box::new(move |path| {
                    let kind = export::picture_kind(path).map_err(|reason| tr!("{}.", reason.localized()))?;
                    export::write_picture(path, kind, &figure).map_err(|error| failure(path, &error))
                }))
            }
            Self::Curves => {
                let surface = surface(explorer)?;
                let series = explorer.work.document.series.clone();
                let backscatter = explorer.work.settings.show_backscatter || explorer.work.document.has_backscatter();
                Ok(written(move |out| write_curves(&surface, &series, backscatter, out)))
            }
            Self::Fitted => {
                let fit = explorer.work.shown_fit.as_ref().ok_or_else(|| translated(NO_FIT))?;
                let surface = Pbrdf::new(fit.report.model, fit.report.parameters).map_err(|error| tr!("{}.", error.localized()))?;
                let (choices, measurement) = (*fit.problem.choices(), explorer.work.document.measurement.clone());
                Ok(written(move |out| write_fitted(&measurement, &surface, choices.dolp_only, out)))
            }
            Self::Report => report(explorer),
            Self::Session => {
                let session = session(explorer);
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

fn surface(explorer: &App) -> Result<Pbrdf, String> {
    Pbrdf::new(explorer.work.settings.model, explorer.work.settings.parameters)
        .map_err(|error| tr!("There are no curves: {}.", error.localized()))
}

fn report(explorer: &App) -> Result<Write, String> {
    let fit = explorer.work.shown_fit.clone().ok_or_else(|| translated(NO_FIT))?;
    let (report, problem) = (fit.report.clone(), fit.problem.clone());
    let (measurement, document) = (explorer.work.document.measurement.clone(), &explorer.work.document);
    let source = Source { name: document.name.clone(), sha256: document.sha256.clone() };
    Ok(Box::new(move |path| {
        let kind = export::report_kind(path).map_err(|reason| tr!("{}.", reason.localized()))?;
        let (program, date) = (export::program(), export::now());
        let fit = FitDocument {
            measurement: &measurement,
            source: &source,
            problem: &problem,
            report: &report,
            program: &program,
            date: &date,
            words: &WindowWording,
        };
        export::write_report(path, kind, &fit.document()).map_err(|error| failure(path, &error))
    }))
}

/// The session as it is shown, that of a lesson included.
pub fn session(explorer: &App) -> Session {
    let App { work: Workspace { settings, document, fit_history, shown_fit: last_fit, .. }, .. } = explorer;
    let layout = explorer.panes.layout().unwrap_or_else(|| explorer.window.layout.clone());
    session_of(settings, layout, document, fit_history, last_fit.as_ref())
}

/// The session of the user's own work, which a lesson sets aside.
pub fn own_session(explorer: &App) -> Session {
    let Workspace { settings, document, fit_history, shown_fit, .. } = explorer.own_work();
    session_of(settings, explorer.window.layout.clone(), document, fit_history, shown_fit.as_ref())
}

fn session_of(settings: &Settings, layout: Layout, document: &Document, fits: &FitHistory, shown: Option<&Arc<FitEntry>>) -> Session {
    let fits: Vec<&Arc<FitEntry>> = fits.iter().filter(|fit| fit.number == document.number).collect();
    Session {
        settings: settings.clone(),
        layout,
        name: document.name.clone(),
        sha256: document.sha256.clone(),
        measurement: (!document.measurement.rows.is_empty()).then(|| document.measurement.clone()),
        shown: fits.iter().position(|fit| shown.is_some_and(|shown| Arc::ptr_eq(fit, shown))),
        fits: fits.into_iter().map(|fit| SavedFit::new(fit)).collect(),
        left_out: Vec::new(),
    }
}

/// The plot of a pane as an image for the clipboard.
pub fn image(explorer: &App, pane: PaneId) -> Result<egui::ColorImage, String> {
    let figure = figure(explorer, pane).ok_or_else(|| tr!("There is no plot to copy."))?;
    let image = figure.image(SCREEN_DPI).map_err(|error| tr!("The plot cannot be drawn: {}.", error.localized()))?;
    Ok(egui::ColorImage::from_rgba_unmultiplied([image.width as usize, image.height as usize], &image.rgba))
}

/// The figure of a pane, of the same curves and points that are drawn, in the language of the window.
pub fn figure(explorer: &App, pane: PaneId) -> Option<Figure> {
    Some(plain_figure(explorer, pane)?.translate(&label))
}

fn plain_figure(explorer: &App, pane: PaneId) -> Option<Figure> {
    match pane {
        PaneId::Dolp => dolp(explorer),
        PaneId::Lobes => lobes(explorer),
        PaneId::PolarLobes => views::polar_figure(explorer),
        PaneId::Facets => views::facets_figure(explorer),
        PaneId::Convergence => views::convergence_figure(explorer),
        PaneId::Metals => views::metals_figure(explorer),
        PaneId::Hemisphere => views::hemisphere_figure(explorer),
        PaneId::Mueller => views::mueller_figure(explorer),
        PaneId::Landscape => views::landscape_figure(explorer),
        PaneId::Audit => views::audit_figure(explorer),
        _ => explorer.reports.figure(BenchmarkId::of(pane)?).cloned(),
    }
}

fn measured(marks: &Marks, name: &str, color: Rgb, y: impl Fn(f64) -> f64) -> Vec<Series> {
    let bar = |point: &PlotPoint| marks.bars.iter().find(|bar| bar.x == point.x && (bar.low..=bar.high).contains(&point.y));
    let point = |point: &PlotPoint| Point { x: point.x, y: y(point.y), bar: bar(point).map(|bar| (y(bar.low), y(bar.high))) };
    let used = Series::measured(name, marks.used.iter().map(point).collect(), Symbol::Disc).colored(color);
    let masked = Series::measured("masked", marks.masked.iter().map(point).collect(), Symbol::Circle).colored(MUTED);
    let is_there = |series: &Series| matches!(&series.drawn, Drawn::Points { points, .. } if !points.is_empty());
    [used, masked].into_iter().filter(is_there).collect()
}

/// The band around a fitted curve; its pieces do not join.
fn band(ribbons: &[Ribbon], name: &str, color: Rgb, y: impl Fn(f64) -> f64) -> Series {
    let piece = |ribbon: &Ribbon| -> Vec<[f64; 3]> {
        let ends = ribbon.low.iter().zip(&ribbon.high);
        ribbon.x.iter().zip(ends).map(|(x, (low, high))| [*x, y(*low), y(*high)]).chain([[f64::NAN; 3]]).collect()
    };
    Series::band(name, ribbons.iter().flat_map(piece).collect()).colored(color)
}

fn dolp(explorer: &App) -> Option<Figure> {
    let App { work: Workspace { settings, document, .. }, derived, views, .. } = explorer;
    let (curves, key, marks) = (derived.curves.get()?, derived.curves.key()?, derived.marks.get()?);
    let plain = |y: f64| y;
    let limit = |curves: &Curves, color| Series::dashed("Fresnel limit", points(&curves.limit, plain), Dash::Dashed).colored(color);
    let share = |curves: &Curves, color| Series::dashed("specular share", points(&curves.share, plain), Dash::Dotted).colored(color);
    let mut series = Vec::new();
    for (i, ((curves, marks), color)) in curves.series.iter().zip(&marks.series).zip(SERIES).enumerate() {
        if settings.show_limit {
            series.push(limit(curves, color));
        }
        if let Some(ribbons) = views.dolp.band.get().and_then(|bands| bands.get(i)) {
            series.push(band(ribbons, &marks.name, color, plain));
        }
        series.push(Series::line(&marks.name, points(&curves.dolp, plain)).colored(color));
        series.extend(measured(&marks.dolp, &marks.name, color, plain));
        if settings.shown.share {
            series.push(share(curves, color));
        }
    }
    if curves.own_is_series.is_none() {
        if settings.show_limit {
            series.push(limit(&curves.own, FOREGROUND));
        }
        if settings.shown.share {
            series.push(share(&curves.own, FOREGROUND));
        }
        let name = tr!("θi = {}° (slider)", settings.theta_i);
        series.push(Series::line(name, points(&curves.own.dolp, plain)).colored(FOREGROUND));
    }
    let range = views.dolp.range()?;
    let y = Axis::linear("DoLP", "").between(range.low, range.high);
    let x = key.x();
    let panel = Panel { x: Axis::linear("θr", "°").between(x.low, x.high), y, series, ..Panel::default() };
    Some(Figure { title: document.name.clone(), panels: vec![panel], ..Figure::default() })
}

fn lobes(explorer: &App) -> Option<Figure> {
    let App { work: Workspace { settings, document, .. }, derived, views, .. } = explorer;
    let (curves, key, marks) = (derived.curves.get()?, derived.curves.key()?, derived.marks.get()?);
    let log = key.brdf.log;
    let quantity = if key.brdf.times_cosine { "BRDF × cos θr" } else { "BRDF" };
    let value = |y: f64| if log { libm::exp10(y) } else { y };
    let mut series = Vec::new();
    let all = curves.series.iter().zip(&marks.series).zip(SERIES).enumerate();
    for (i, ((curves, marks), color)) in all.filter(|(_, ((_, marks), _))| marks.brdf.is_there()) {
        if let Some(ribbons) = views.lobes.band.get().and_then(|bands| bands.get(i)) {
            series.push(band(ribbons, &marks.name, color, value));
        }
        series.push(Series::line(&marks.name, points(&curves.total, value)).colored(color));
        series.extend(measured(&marks.brdf, &marks.name, color, value));
    }
    let own = &curves.own;
    let terms = [("specular", &own.specular, 3), ("diffuse", &own.diffuse, 4), ("volume", &own.volume, 5)];
    for (name, pieces, color) in terms.into_iter().filter(|(_, pieces, _)| !pieces.is_empty()) {
        series.push(Series::dashed(name, points(pieces, value), Dash::Solid).colored(SERIES[color]));
    }
    series.push(Series::line("total", points(&own.total, value)).colored(FOREGROUND));
    let range = views.lobes.range()?;
    let axis = if log { Axis::log(quantity, "sr⁻¹") } else { Axis::linear(quantity, "sr⁻¹") };
    let x = key.x();
    let panel = Panel {
        title: format!("θi = {}°, Δφ = {}°", settings.theta_i, settings.dphi),
        x: Axis::linear("θr", "°").between(x.low, x.high),
        y: axis.between(value(range.low), value(range.high)),
        series,
        ..Panel::default()
    };
    Some(Figure { title: document.name.clone(), panels: vec![panel], ..Figure::default() })
}

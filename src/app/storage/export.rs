//! What leaves the window as a file or to the clipboard: plots, curves, fits, sessions.

use crate::app::storage::session::Session;
use crate::app::text::i18n::translated;
use crate::app::text::localized::Localized as _;
use crate::app::text::messages::WindowWording;
use crate::app::work::open_measurement::OpenMeasurement;
use crate::app::work::pane_id::PaneId;
use crate::app::work::picture_scene::{Scene, SceneKey};
use crate::app::work::workspace::Workspace;
use crate::figure::Figure;
use crate::files::export;
use crate::files::picture::{StokesFileKind, stokes_file_kind, write_colors, write_exr, write_table};
use crate::files::write_file::write_file;
use crate::report::{DataSource, FitDocument, picture_map, write_curves, write_fitted};
use pbrdf::model::{Pbrdf, Quality};
use std::path::{Path, PathBuf};
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
    /// The picture as numbers or colours.
    Picture,
    Session,
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
            Self::Curves => "The table of curves",
            Self::Fitted => "The table of the fit",
            Self::Report => "The report",
            Self::Picture => "The picture",
            Self::Session => "The session",
        }
    }

    /// Endings of its files, the usual one first.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Plot(_) => &["svg", "png"],
            Self::Curves | Self::Fitted => &["csv"],
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
            Self::Curves => "-curves".to_owned(),
            Self::Fitted => "-fitted".to_owned(),
            Self::Report => "-report".to_owned(),
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
            Self::Plot(_) => export::picture_kind(path).map(drop),
            Self::Curves | Self::Fitted => export::expect_ending(path, "csv"),
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
            Self::Plot(_) => {
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
                let surface = Pbrdf::new(fit.report.model, fit.report.parameters).map_err(|error| tr!("{}.", error.localized()))?;
                let (fit_options, measurement) = (*fit.problem.options(), work.active().measurement.clone());
                Ok(written(move |out| write_fitted(&measurement, &surface, fit_options.dolp_only, out)))
            }
            Self::Report => report(work),
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

fn report(work: &Workspace) -> Result<Write, String> {
    let fit = work.shown_fit().cloned().ok_or_else(|| translated(NO_FIT))?;
    let (report, problem) = (fit.report.clone(), fit.problem.clone());
    let (measurement, document) = (work.active().measurement.clone(), work.active());
    let source = DataSource { name: document.name.clone(), sha256: document.sha256.clone() };
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

/// Pixels along an edge of an exported picture.
const PICTURE_SIZE: usize = 512;

/// The picture of the sliders, one half of it of the companion where there is one.
fn picture(work: &Workspace) -> Result<Write, String> {
    surface(work)?;
    let (key, options) = (SceneKey::of(work), work.settings().picture);
    Ok(Box::new(move |path| {
        let kind = stokes_file_kind(path).map_err(|reason| tr!("{}.", reason.localized()))?;
        let (lamp, has_sky) = (key.lamp, key.sky.is_some());
        let scene = Scene::new(key, PICTURE_SIZE, Quality::Fine, None, &|| false).ok_or_else(|| tr!("There is no picture to export."))?;
        let body = |out: &mut dyn std::io::Write| match kind {
            StokesFileKind::Png => {
                let (shown, axis) = (scene.shown(&options), options.quantity.axis());
                write_colors(&picture_map(&shown.values, PICTURE_SIZE, axis.between(shown.range.0, shown.range.1), shown.colors), out)
            }
            StokesFileKind::Exr => write_exr(&scene.joined(), out),
            StokesFileKind::Csv => write_table(&scene.picture, &scene.joined(), lamp.as_ref(), has_sky, out),
        };
        write_file(path, body).map_err(|error| failure(path, &error))
    }))
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

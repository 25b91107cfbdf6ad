//! What can be asked on the command line.

use crate::cli::values;
use crate::cli::values::{Assignment, Grid, Interval};
use clap::{Args, Parser, Subcommand, ValueEnum};
use pbrdf::fit;
use pbrdf::measurement;
use pbrdf::measurement::formats::FORMATS;
use pbrdf::measurement::{Mapping, TensorResolution};
use pbrdf::model::{Parameter, Preset};
use std::path::PathBuf;

/// Explores, fits and simulates polarised reflection from metal surfaces.
///
/// Without a command it opens the window.
#[derive(Debug, Parser)]
#[command(version, about, args_conflicts_with_subcommands = true)]
pub struct Arguments {
    /// What to do without a window.
    #[command(subcommand)]
    pub task: Option<Task>,
    /// Measurement to open in the window.
    pub file: Option<PathBuf>,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Task {
    /// Evaluate the model, one row of parameters and angles after the other.
    Evaluate(Evaluate),
    /// Fit the model to a measurement.
    Fit(Box<Fit>),
    /// Simulate a measurement.
    Simulate(Simulate),
    /// Fit several models to one measurement.
    Compare(Box<Compare>),
    /// Predict standard errors from a choice of angles.
    PlanArguments(PlanArguments),
    /// ReportArguments on error against run time, on numerical stability, or on the cost of each term.
    ReportArguments(ReportArguments),
    /// Turn a foreign file into a measurement.
    ImportArguments(ImportArguments),
    /// Write a surface for another program.
    #[command(subcommand)]
    Export(Export),
    /// List tabulated refractive indices of metals, source by source.
    Metals(Metals),
}

/// Arguments of a command that is announced but not built.
#[derive(Debug, Args)]
#[command(disable_help_flag = true)]
pub struct Later {
    /// Whatever follows.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    pub rest: Vec<String>,
}

/// `evaluate`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct Evaluate {
    /// Table with the columns distribution, the nine parameters, theta_i, theta_r and dphi (180 if absent).
    pub input: PathBuf,
    /// File to write; standard output without.
    #[arg(short, long)]
    pub output: Option<PathBuf>,
    /// Add the 16 elements of the Mueller matrix, m00 to m33.
    #[arg(long)]
    pub mueller: bool,
    /// Add the derivatives of BRDF and DoLP by each parameter.
    #[arg(long)]
    pub gradient: bool,
}

/// `fit`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct Fit {
    /// Measurement: theta_i, theta_r and dolp or brdf, in degrees and 1/sr.
    pub input: PathBuf,
    /// Model: a preset such as cauchy, gauss, specular or fresnel.
    #[arg(long, default_value = "cauchy", value_parser = values::preset)]
    pub model: &'static Preset,
    #[command(flatten)]
    pub options: FitArguments,
    /// Scan these parameters: hold each on a grid and fit the rest again, for an honest interval.
    #[arg(long, value_delimiter = ',', value_parser = values::parameter)]
    pub profile: Vec<Parameter>,
    /// Refit so many data sets with residuals dealt out anew.
    #[arg(long, value_parser = values::count)]
    pub bootstrap: Option<usize>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
    /// File for the input columns with dolp_model, dolp_residual, brdf_model, brdf_residual beside them.
    #[arg(short, long)]
    pub output: Option<PathBuf>,
    /// File for a report with figures: .html in one file, .md with its figures as .svg files beside it.
    #[arg(long, value_name = "FILE.html|.md", value_parser = values::report_file)]
    pub report: Option<PathBuf>,
    /// File for a figure of data, fit and residuals: .svg, or .png at 300 dots an inch.
    #[arg(long, value_name = "FILE.svg|.png", value_parser = values::picture_file)]
    pub figure: Option<PathBuf>,
}

/// `compare`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct Compare {
    /// Measurement: theta_i, theta_r and dolp or brdf, in degrees and 1/sr.
    pub input: PathBuf,
    /// Models to compare; all without.
    #[arg(long, value_delimiter = ',', value_parser = values::preset)]
    pub models: Vec<&'static Preset>,
    #[command(flatten)]
    pub options: FitArguments,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// What `fit` and `compare` have in common.
#[derive(Debug, Args)]
pub struct FitArguments {
    /// Values to start from, such as n=2,k=3; defaults for the rest.
    #[arg(long, value_delimiter = ',', value_parser = values::assignment)]
    pub start: Vec<Assignment>,
    /// Parameters that stay as they are, such as ks=1,c.
    #[arg(long, value_delimiter = ',', value_parser = values::parameter_or_assignment)]
    pub fix: Vec<(Parameter, Option<f64>)>,
    /// Parameters to free that would be fixed, such as ks.
    #[arg(long, value_delimiter = ',', value_parser = values::parameter)]
    pub free: Vec<Parameter>,
    /// Bounds, such as n=0.1..5.
    #[arg(long, value_delimiter = ',', value_parser = values::interval)]
    pub bounds: Vec<Interval>,
    /// How many starts; without, a first guess and as many as find something new. 1 is the start alone.
    #[arg(long, value_parser = values::count)]
    pub starts: Option<usize>,
    /// Seed of whatever is random.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// What divides the residuals.
    #[arg(long, value_enum, default_value_t = Weights::None)]
    pub weights: Weights,
    /// How BRDF residuals are formed.
    #[arg(long, value_enum, default_value_t = BrdfResiduals::Relative)]
    pub brdf_residuals: BrdfResiduals,
    /// How a residual counts: robust losses spare outliers.
    #[arg(long, value_enum, default_value_t = Loss::Squared)]
    pub loss: Loss,
    /// Where a robust loss begins to spare, in units of X − Xm; without, 1.345 × normalised MAD of the residuals.
    #[arg(long, value_parser = values::positive)]
    pub loss_scale: Option<f64>,
    /// Which reading of Eq. (17) predicts DoLP; printed leaves k_s out of the numerator.
    #[arg(long, value_enum, default_value_t = DolpFormula::Consistent)]
    pub eq17: DolpFormula,
}

/// `plan`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct PlanArguments {
    #[command(flatten)]
    pub surface: Surface,
    #[command(flatten)]
    pub angles: Angles,
    /// Standard deviation of the noise in DoLP, absolute.
    #[arg(long, default_value_t = 0.005, value_parser = values::positive)]
    pub noise: f64,
    /// Standard deviation of the noise in BRDF, relative.
    #[arg(long, default_value_t = 0.02, value_parser = values::positive)]
    pub brdf_noise: f64,
    /// What is measured.
    #[arg(long, value_enum, default_value_t = Columns::Dolp)]
    pub columns: Columns,
    /// Parameters that are known.
    #[arg(long, value_delimiter = ',', value_parser = values::parameter)]
    pub fix: Vec<Parameter>,
    /// Parameters to free that would be fixed, such as ks.
    #[arg(long, value_delimiter = ',', value_parser = values::parameter)]
    pub free: Vec<Parameter>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// A model with values.
#[derive(Debug, Args)]
pub struct Surface {
    /// Model: a preset such as cauchy, gauss, specular or fresnel.
    #[arg(long, default_value = "cauchy", value_parser = values::preset)]
    pub model: &'static Preset,
    /// Parameters, such as n=2.07,k=2.9; defaults for the rest.
    #[arg(long, value_delimiter = ',', value_parser = values::assignment)]
    pub set: Vec<Assignment>,
}

/// Where is measured.
#[derive(Debug, Args)]
pub struct Angles {
    /// Angles of incidence in degrees: a list 30,40,50 or a range 10:80:10.
    #[arg(long, value_parser = values::grid)]
    pub theta_i: Grid,
    /// Angles of view in degrees, the same way; negative is the backscatter side.
    #[arg(long, allow_hyphen_values = true, value_parser = values::grid)]
    pub theta_r: Grid,
    /// Relative azimuth in degrees; 180 is the forward side.
    #[arg(long, default_value_t = 180.0, allow_hyphen_values = true, value_parser = values::number)]
    pub dphi: f64,
}

/// `import`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true, after_help = import_help())]
pub struct ImportArguments {
    /// Woollam ellipsometry text, a tensor of Mueller matrices (.pbsdf), or with --columns any table.
    pub input: PathBuf,
    /// Vacuum wavelength in nm; the nearest one of the file is taken, with a notice.
    #[arg(long, value_name = "NM", value_parser = values::positive)]
    pub wavelength: Option<f64>,
    /// Which columns of a table are what, such as theta_i=AOI,theta_r=3:radians,dolp=DoLP:percent.
    #[arg(long, value_name = "FIELD=COLUMN[:UNIT],...", value_parser = values::mapping)]
    pub columns: Option<Mapping>,
    /// Angles of incidence of the slices through a tensor, in degrees (15:75:15 without); or the one of a table without such a column.
    #[arg(long, value_parser = values::grid)]
    pub theta_i: Option<Grid>,
    /// Angles of view of the slices through a tensor, in degrees; negative is the backscatter side.
    #[arg(long, default_value = "-80:80:5", allow_hyphen_values = true, value_parser = values::grid)]
    pub theta_r: Grid,
    /// Relative azimuth in degrees of the slices through a tensor, or of a table without such a column (180 without); 180 is the
    /// plane of incidence, others are out of plane.
    #[arg(long, allow_hyphen_values = true, value_parser = values::number)]
    pub dphi: Option<f64>,
    /// File to write; standard output without.
    #[arg(short, long)]
    pub output: Option<PathBuf>,
}

/// What `import` understands: a paragraph for each form of files.
fn import_help() -> String {
    let formats: Vec<&str> = FORMATS.iter().map(|format| format.help()).chain([TABLE_HELP]).collect();
    formats.join("\n\n")
}

const TABLE_HELP: &str = "\
Table with --columns: fields theta_i, theta_r, dphi (degrees, or :radians), dolp, dolp_sigma (fraction, or :percent), brdf, brdf_sigma,
masked; a column by its name in the header or its number from 1. A table without a column for theta_i takes it from --theta-i, one
without dphi from --dphi. Without --columns a guess is offered, not applied.";

/// `export`.
#[derive(Debug, Subcommand)]
pub enum Export {
    /// A tensor of Mueller matrices, .pbsdf, for the plugin measured_polarized of Mitsuba 3.
    Mitsuba(Mitsuba),
}

/// `export mitsuba`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct Mitsuba {
    #[command(flatten)]
    pub surface: Surface,
    /// What the file says of its one band, in nm; Mitsuba takes it for every wavelength.
    #[arg(long, value_name = "NM", default_value_t = 550, value_parser = clap::value_parser!(u16).range(1..))]
    pub wavelength: u16,
    /// Nodes in the azimuth of difference (-180 to 180 degrees), the angle of difference and the half angle (0 to 90 degrees).
    #[arg(long, value_name = "PHI_D,THETA_D,THETA_H", default_value = "73,61,64", value_parser = values::resolution)]
    pub resolution: TensorResolution,
    /// File to write.
    #[arg(short, long)]
    pub output: PathBuf,
}

/// `metals`.
#[derive(Debug, Args)]
#[command(after_help = METALS_HELP)]
pub struct Metals {
    /// Symbol or name, such as Cu or copper; all metals without.
    pub name: Option<String>,
    /// Vacuum wavelength in nm at which to give n and k, linear between tabulated ones.
    #[arg(long, value_name = "NM", value_parser = values::positive)]
    pub wavelength: Option<f64>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// What the answer of `metals` holds.
const METALS_HELP: &str = "\
Figures of the refractiveindex.info database (CC0); sources differ, and each is cited.

JSON: {\"wavelength_nm\": number or null, \"rows\": [...]}, one flat row per source:
  metal, name, source, authors, citation, comment, from_nm, to_nm, n, k
  n and k are null without --wavelength and where it is outside from_nm to to_nm.";

/// `simulate`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct Simulate {
    #[command(flatten)]
    pub surface: Surface,
    #[command(flatten)]
    pub angles: Angles,
    /// What is measured.
    #[arg(long, value_enum, default_value_t = Columns::Dolp)]
    pub columns: Columns,
    /// Standard deviation of the noise in DoLP, absolute.
    #[arg(long, default_value_t = 0.0, value_parser = values::not_negative)]
    pub noise: f64,
    /// Standard deviation of the noise in BRDF, relative.
    #[arg(long, default_value_t = 0.0, value_parser = values::not_negative)]
    pub brdf_noise: f64,
    /// Seed of the noise.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// File to write.
    #[arg(short, long)]
    pub output: PathBuf,
}

/// `report`.
#[derive(Debug, Args)]
pub struct ReportArguments {
    /// What about.
    #[arg(value_enum)]
    pub subject: ReportSubject,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
    /// Folder for the report as JSON and Markdown, and for its figures as SVG and PNG; made if it is not there.
    #[arg(short, long, value_name = "FOLDER")]
    pub output: Option<PathBuf>,
}

/// What a report is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ReportSubject {
    /// Error against run time, of evaluations and of fits; a few minutes.
    ErrorVsTime,
    /// A gallery of stiff and extreme cases: digits held, and what becomes of fits.
    Stability,
    /// Nanoseconds per point, and what each scene leaves out.
    Cost,
}

impl ReportSubject {
    /// Its name on the command line and in names of files.
    pub fn key(self) -> &'static str {
        match self {
            Self::ErrorVsTime => "error-vs-time",
            Self::Stability => "stability",
            Self::Cost => "cost",
        }
    }
}

/// Options of the core under their names on the command line.
macro_rules! choice {
    ($(#[$doc:meta])* $name:ident => $core:path { $($(#[$variant_doc:meta])* $variant:ident),* }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, ValueEnum)]
        pub enum $name { $($(#[$variant_doc])* $variant,)* }

        impl From<$name> for $core {
            fn from(choice: $name) -> Self {
                match choice { $($name::$variant => Self::$variant,)* }
            }
        }
    };
}

choice! {
    /// What divides the residuals.
    Weights => fit::Weights {
        /// Nothing: Eq. (18).
        None,
        /// The stated standard deviations: χ².
        Sigma
    }
}
choice! {
    /// How BRDF residuals are formed.
    BrdfResiduals => fit::BrdfResiduals {
        /// X − Xm.
        Absolute,
        /// (X − Xm)/Xm.
        Relative,
        /// ln X − ln Xm.
        Log
    }
}
choice! {
    /// How a residual counts.
    Loss => fit::Loss {
        /// By its square.
        #[value(name = "linear")]
        Squared,
        /// By its square up to the scale, by its size beyond.
        Huber,
        /// The same with a smooth passage.
        SoftL1
    }
}
choice! {
    /// Which reading of Eq. (17) predicts DoLP.
    DolpFormula => fit::DolpFormula {
        /// k_s inside the numerator.
        Consistent,
        /// k_s missing, as printed.
        #[value(name = "printed")]
        AsPrinted
    }
}
choice! {
    /// What is measured.
    Columns => measurement::Columns {
        /// DoLP.
        Dolp,
        /// BRDF.
        Brdf,
        /// Both.
        Both
    }
}

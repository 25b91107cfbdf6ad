//! The arguments of the command line.

use crate::cli::values;
use crate::cli::values::{Assignment, Criterion, Grid, OwnParameters, Priors, Targeted};
use crate::report::{PictureQuantity, TableFormat};
use clap::{Args, Parser, Subcommand, ValueEnum};
use pbrdf::fit::{BrdfResiduals, Intervals, Loss, Weights};
use pbrdf::measurement::formats::FORMATS;
use pbrdf::measurement::{BrdfMeaning, Columns, Field, Mapping, TensorResolution};
use pbrdf::model::{DolpFormula, Lamp, Parameter, Preset, Shape};
use std::path::PathBuf;

/// Explores, fits and simulates polarised reflection from metal surfaces.
///
/// Without a command it opens the window.
#[derive(Debug, Parser)]
#[command(version, about, args_conflicts_with_subcommands = true)]
pub struct Arguments {
    /// What to do without a window.
    #[command(subcommand)]
    pub command: Option<Commands>,
    /// Measurements to open in the window, beside the work of the last time.
    #[arg(value_name = "FILE")]
    pub files: Vec<PathBuf>,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Commands {
    /// Evaluate the model, one row of parameters and angles after the other.
    Evaluate(EvaluateArguments),
    /// Fit the model to a measurement.
    Fit(Box<FitArguments>),
    /// Simulate a measurement.
    Simulate(SimulateArguments),
    /// Fit several models to one measurement.
    Compare(Box<CompareArguments>),
    /// Draw from the posterior: all surfaces that a measurement allows.
    Posterior(Box<PosteriorArguments>),
    /// Predict standard errors from a choice of angles.
    Plan(PlanArguments),
    /// Report on error against run time, on numerical stability, or on the cost of each term.
    Report(ReportArguments),
    /// Paint what a polarisation camera sees of a surface.
    Picture(PictureArguments),
    /// Turn a foreign file into a measurement.
    Import(ImportArguments),
    /// Write a surface for another program.
    #[command(subcommand)]
    Export(ExportTarget),
    /// List tabulated refractive indices of metals, source by source.
    Metals(MetalsArguments),
}

/// `evaluate`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct EvaluateArguments {
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
pub struct FitArguments {
    /// Measurements: theta_i, theta_r and dolp or brdf, in degrees and 1/sr; a column set makes several of one file.
    #[arg(required = true)]
    pub inputs: Vec<PathBuf>,
    /// Fit each measurement by itself and write a row of --output for it, several at a time; patterns such as 'runs/*.csv' are expanded.
    /// Rows are written as they come; the same command again goes on where it was.
    #[arg(long, requires = "output", conflicts_with_all = ["own", "profile", "bootstrap", "json", "table", "report", "figure"])]
    pub batch: bool,
    /// Model: a preset such as cauchy, gauss, specular or fresnel.
    #[arg(long, default_value = "cauchy", value_parser = values::preset)]
    pub model: &'static Preset,
    /// Parameters that each measurement has for itself, such as n,k, or all; the others are shared.
    #[arg(long, value_name = "NAMES|all", value_parser = values::own)]
    pub own: Option<OwnParameters>,
    #[command(flatten)]
    pub problem: ProblemArguments,
    /// Scan these parameters: hold each on a grid and fit the rest again, for an honest interval.
    #[arg(long, value_delimiter = ',', value_parser = values::parameter)]
    pub profile: Vec<Parameter>,
    /// Refit so many data sets with residuals dealt out anew.
    #[arg(long, value_parser = values::count)]
    pub bootstrap: Option<usize>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
    /// Print the results as a table for a paper: a row for each parameter, a column for each measurement.
    #[arg(long, value_name = "FORM", value_parser = values::table_format(), conflicts_with = "json")]
    pub table: Option<TableFormat>,
    /// File for the input columns with dolp_model, dolp_residual, brdf_model, brdf_residual beside them; what was fitted stands in its comments.
    /// With --batch the table of results.
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
pub struct CompareArguments {
    /// Measurements: theta_i, theta_r and dolp or brdf, in degrees and 1/sr; a column set makes several of one file.
    #[arg(required = true)]
    pub inputs: Vec<PathBuf>,
    /// Models to compare; all without.
    #[arg(long, value_delimiter = ',', value_parser = values::preset)]
    pub models: Vec<&'static Preset>,
    /// Fit several measurements together: parameters that each has for itself, such as n,k, or all; the others are shared.
    #[arg(long, value_name = "NAMES|all", value_parser = values::own)]
    pub own: Option<OwnParameters>,
    #[command(flatten)]
    pub problem: ProblemArguments,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
    /// Print the results as a table for a paper: a row for each parameter, a column for each measurement and model.
    #[arg(long, value_name = "FORM", value_parser = values::table_format(), conflicts_with = "json")]
    pub table: Option<TableFormat>,
    /// File for a figure: a panel for each measurement, its points and the curves of all models; .svg, or .png at 300 dots an inch.
    #[arg(long, value_name = "FILE.svg|.png", value_parser = values::picture_file)]
    pub figure: Option<PathBuf>,
}

/// What `fit` and `compare` have in common.
#[derive(Debug, Args)]
pub struct ProblemArguments {
    /// Values to start from, such as n=2,k=3; defaults for the rest. For one of several measurements: n@B.csv=2.
    #[arg(long, value_delimiter = ',', value_parser = values::targeted_assignment)]
    pub start: Vec<Targeted<f64>>,
    /// Parameters that stay as they are, such as ks=1,c.
    #[arg(long, value_delimiter = ',', value_parser = values::targeted_fix)]
    pub fix: Vec<Targeted<Option<f64>>>,
    /// Parameters to free that would be fixed, such as ks.
    #[arg(long, value_delimiter = ',', value_parser = values::targeted_parameter)]
    pub free: Vec<Targeted<()>>,
    /// Bounds, such as n=0.1..5.
    #[arg(long, value_delimiter = ',', value_parser = values::targeted_interval)]
    pub bounds: Vec<Targeted<(f64, f64)>>,
    /// How many starts; without, a first guess and as many as find something new. 1 is the start alone.
    #[arg(long, value_parser = values::count)]
    pub starts: Option<usize>,
    /// Seed of whatever is random.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// What divides the residuals.
    #[arg(long, default_value = "none", value_parser = values::weights())]
    pub weights: Weights,
    /// How the uncertainty of the parameters is found.
    #[arg(long, default_value = "profile", value_parser = values::intervals())]
    pub intervals: Intervals,
    /// How BRDF residuals are formed.
    #[arg(long, default_value = "relative", value_parser = values::brdf_residuals())]
    pub brdf_residuals: BrdfResiduals,
    /// How a residual counts: robust losses spare outliers.
    #[arg(long, default_value = "linear", value_parser = values::loss())]
    pub loss: Loss,
    /// Where a robust loss begins to spare, in units of X − Xm; without, 1.345 × normalised MAD of the residuals.
    #[arg(long, value_parser = values::positive)]
    pub loss_scale: Option<f64>,
    /// Which reading of Eq. (17) predicts DoLP; printed leaves k_s out of the numerator.
    #[arg(long, default_value = "consistent", value_parser = values::dolp_formula())]
    pub eq17: DolpFormula,
}

/// `posterior`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct PosteriorArguments {
    /// Measurements: theta_i, theta_r and dolp or brdf, in degrees and 1/sr; a column set makes several of one file.
    #[arg(required = true)]
    pub inputs: Vec<PathBuf>,
    /// Model: a preset such as cauchy, gauss, specular or fresnel.
    #[arg(long, default_value = "cauchy", value_parser = values::preset)]
    pub model: &'static Preset,
    /// Parameters that each measurement has for itself, such as n,k, or all; the others are shared.
    #[arg(long, value_name = "NAMES|all", value_parser = values::own)]
    pub own: Option<OwnParameters>,
    #[command(flatten)]
    pub problem: ProblemArguments,
    /// Draws of each chain, after the warm-up.
    #[arg(long, default_value_t = 4000, value_parser = values::count)]
    pub draws: usize,
    /// Chains.
    #[arg(long, default_value_t = 4, value_parser = values::chain_count)]
    pub chains: usize,
    /// Priors, such as n=normal(2.07,0.1),k=uniform(1,5),sigma=loguniform(0.01,1); the others are uniform within the bounds.
    #[arg(long, value_parser = values::priors)]
    pub prior: Option<Priors>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
    /// File for the draws: a column for each free parameter, log_posterior and chain.
    #[arg(short, long)]
    pub output: Option<PathBuf>,
}

/// `plan`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct PlanArguments {
    #[command(flatten)]
    pub surface: SurfaceArguments,
    /// Angles of incidence in degrees: a list 30,40,50 or a range 10:80:10.
    #[arg(long, value_parser = values::grid)]
    pub theta_i: Grid,
    /// Angles of view in degrees, the same way; negative is the backscatter side.
    #[arg(long, allow_hyphen_values = true, value_parser = values::grid)]
    pub theta_r: Grid,
    /// Relative azimuths in degrees, the same way; 180 is the forward side.
    #[arg(long, default_value = "180", allow_hyphen_values = true, value_parser = values::grid)]
    pub dphi: Grid,
    /// Standard deviation of the noise in DoLP, absolute.
    #[arg(long, default_value_t = 0.005, value_parser = values::positive)]
    pub noise: f64,
    /// Standard deviation of the noise in BRDF, relative.
    #[arg(long, default_value_t = 0.02, value_parser = values::positive)]
    pub brdf_noise: f64,
    /// What is measured.
    #[arg(long, default_value = "dolp", value_parser = values::columns())]
    pub columns: Columns,
    /// Parameters that are known.
    #[arg(long, value_delimiter = ',', value_parser = values::parameter)]
    pub fix: Vec<Parameter>,
    /// Parameters to free that would be fixed, such as ks.
    #[arg(long, value_delimiter = ',', value_parser = values::parameter)]
    pub free: Vec<Parameter>,
    /// Choose so many of the angles.
    #[arg(long, value_name = "N", value_parser = values::count)]
    pub choose: Option<usize>,
    /// What they are to be good for: d (all free parameters), c:n,k (these), tell:cauchy,gauss (telling the first model from the second).
    #[arg(long, default_value = "d", value_parser = values::criterion, requires = "choose")]
    pub criterion: Criterion,
    /// Allow the same angles more than once.
    #[arg(long, requires = "choose")]
    pub repeats: bool,
    /// What is measured already: it counts, and the chosen angles come on top.
    #[arg(long, value_name = "DATA.csv")]
    pub given: Option<PathBuf>,
    /// Parameter sets to average over, as `posterior -o` writes them; without, those of --set.
    #[arg(long, value_name = "DRAWS.csv", requires = "choose")]
    pub over: Option<PathBuf>,
    /// File for the chosen angles as an empty measurement table.
    #[arg(short, long, requires = "choose")]
    pub output: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// A model with values.
#[derive(Debug, Args)]
pub struct SurfaceArguments {
    /// Model: a preset such as cauchy, gauss, specular or fresnel.
    #[arg(long, default_value = "cauchy", value_parser = values::preset)]
    pub model: &'static Preset,
    /// Parameters, such as n=2.07,k=2.9; defaults for the rest.
    #[arg(long, value_delimiter = ',', value_parser = values::assignment)]
    pub set: Vec<Assignment>,
}

/// Where is measured.
#[derive(Debug, Args)]
pub struct AngleArguments {
    /// Angles of incidence in degrees: a list 30,40,50 or a range 10:80:10.
    #[arg(long, value_parser = values::grid)]
    pub theta_i: Grid,
    /// Angles of view in degrees, the same way; negative is the backscatter side.
    #[arg(long, allow_hyphen_values = true, value_parser = values::grid)]
    pub theta_r: Grid,
    /// Relative azimuths in degrees, the same way; 180 is the forward side.
    #[arg(long, default_value = "180", allow_hyphen_values = true, value_parser = values::grid)]
    pub dphi: Grid,
}

/// `import`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true, after_help = import_help())]
pub struct ImportArguments {
    /// A table of any laboratory, as text or workbook, or a file of an instrument.
    pub input: PathBuf,
    /// Take the guess of a table without asking, and print it.
    #[arg(long)]
    pub auto: bool,
    /// Vacuum wavelength in nm; of several the nearest one is taken, with a notice.
    #[arg(long, value_name = "NM", value_parser = values::positive)]
    pub wavelength: Option<f64>,
    /// Which columns of a table are what, such as theta_i=AOI,theta_r=3:radians,dolp=DoLP:percent.
    #[arg(long, value_name = "FIELD=COLUMN[:UNIT],...", value_parser = values::mapping)]
    pub columns: Option<Mapping>,
    /// The sheet of a workbook; the first without.
    #[arg(long, value_name = "NAME")]
    pub sheet: Option<String>,
    /// What separates thousands in the numbers of a table, such as ','.
    #[arg(long, value_name = "C", value_parser = values::thousands)]
    pub thousands: Option<char>,
    /// A negative angle of view is the forward side.
    #[arg(long)]
    pub flip: bool,
    /// What the columns of a wide table hold that nothing names: dolp or brdf.
    #[arg(long, value_name = "QUANTITY", value_parser = values::wide)]
    pub wide: Option<Field>,
    /// Stokes parameters or Mueller elements are divided by the first one.
    #[arg(long)]
    pub normalised: bool,
    /// What a column of BRDF or reflectance holds: brdf, brdf-cos (times cos theta_r) or factor (reflectance factor, pi times it).
    #[arg(long, value_name = "MEANING", value_parser = values::brdf_meaning)]
    pub brdf_is: Option<BrdfMeaning>,
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
    /// File to write, or with / at its end a folder for one file a measurement; standard output without.
    #[arg(short, long)]
    pub output: Option<PathBuf>,
}

/// What `import` understands: a paragraph for each form of files.
fn import_help() -> String {
    let formats: Vec<&str> = FORMATS.iter().map(|format| format.help()).chain([TABLE_HELP]).collect();
    formats.join("\n\n")
}

const TABLE_HELP: &str = "\
Any other table: its guess is printed, and taken with --auto. With --columns the columns are named: theta_i, theta_r, dphi (degrees, or
:radians), dolp, dolp_sigma (fraction, or :percent), brdf, brdf_sigma, masked, set, wavelength_nm, and what DoLP is computed from: s0, s1,
s2; i0, i45, i90, i135; rs, rp; psi; m00, m10, m20, each with its _sigma; a column by its name in the header or its number from 1. A table
without a column for theta_i takes it from --theta-i, one without dphi from --dphi. Several wavelengths or samples become several
measurements, told apart by a column set.";

/// `export`.
#[derive(Debug, Subcommand)]
pub enum ExportTarget {
    /// A tensor of Mueller matrices, .pbsdf, for the plugin measured_polarized of Mitsuba 3.
    Mitsuba(MitsubaArguments),
}

/// `export mitsuba`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct MitsubaArguments {
    #[command(flatten)]
    pub surface: SurfaceArguments,
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
pub struct MetalsArguments {
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
pub struct SimulateArguments {
    #[command(flatten)]
    pub surface: SurfaceArguments,
    #[command(flatten)]
    pub angles: AngleArguments,
    /// What is measured.
    #[arg(long, default_value = "dolp", value_parser = values::columns())]
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

/// `picture`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true, after_help = PICTURE_HELP)]
pub struct PictureArguments {
    #[command(flatten)]
    pub surface: SurfaceArguments,
    /// What the camera sees.
    #[arg(long, default_value = "sphere", value_parser = values::shape())]
    pub shape: Shape,
    /// Direction of a distant, unpolarised lamp of irradiance 1: its angle from the camera, 0 to 180 degrees, and the angle from right to up;
    /// 30,135 where there is no sky either.
    #[arg(long, value_name = "POLAR,AZIMUTH", allow_hyphen_values = true, value_parser = values::lamp)]
    pub lamp: Option<Lamp>,
    /// Radiance of a uniform, unpolarised sky.
    #[arg(long, value_name = "RADIANCE", value_parser = values::positive)]
    pub sky: Option<f64>,
    /// Pixels along an edge, 2 to 4096.
    #[arg(long, value_name = "PIXELS", default_value = "512", value_parser = values::picture_size)]
    pub size: usize,
    /// What a .png shows; the other files hold Stokes vectors.
    #[arg(long, default_value = "s0", value_parser = values::picture_quantity())]
    pub show: PictureQuantity,
    /// Angle of the analyser from right to up, in degrees.
    #[arg(long, value_name = "DEGREES", default_value = "30", allow_hyphen_values = true, value_parser = values::number)]
    pub analyser: f64,
    /// File to write: a picture, an image of numbers, or a table.
    #[arg(short, long, value_name = "FILE.png|.exr|.csv", value_parser = values::stokes_file)]
    pub output: PathBuf,
}

/// What the files of `picture` hold.
const PICTURE_HELP: &str = "\
The camera looks along -z: x runs to the right, y up, z towards it. The sphere and the cylinder, whose axis is y, have the
radius 1; the plate is tilted by 45 degrees towards +x; nothing casts a shadow.
.png    the picture, one pixel a pixel, and the key of its colours to the right
.exr    channels S0, S1, S2, S3 as 32-bit numbers; 0 where there is no surface
.csv    a row for each lit pixel: x, y, theta_i, theta_r, dphi, s0, s1, s2, s3; angles are those of the lamp
S1 > 0 is polarised along x, S2 > 0 along the diagonal of x and y; the angle of polarisation runs from x towards y.";

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

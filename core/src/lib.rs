//! Polarimetric microfacet BRDF of metal surfaces: values, Mueller matrices, derivatives, and fits that say what the data determine.
//!
//! ```
//! # std::env::set_current_dir("..")?;
//! use pbrdf::{Fit, Measurement, Model, Parameter::{Ks, N}};
//!
//! let data = Measurement::read(std::fs::File::open("assets/examples/steel45_simulated.csv")?)?;
//! let result = Fit::new(&data, Model::CAUCHY).fix(Ks, 1.0).bound(N, 0.1..=5.0).run()?;
//! println!("n = {}", result[N]); // value ± standard error, or why there is none
//! result.undetermined().for_each(|direction| println!("{direction}"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The book says what all of this is for: [The model](../../book/model.html) has every formula,
//! [Fits](../../book/fits.html) and [Intervals](../../book/intervals.html) what the numbers of a fit mean, and
//! [Numerics](../../book/numerics.html) how exact they are. Its chapter [Rust](../../book/rust.html) leads back here. `mdbook build docs`
//! puts it beside this documentation; its sources are in the folder `docs` of the repository.
//!
//! # Tour
//!
//! ## Evaluate
//!
//! A [`Pbrdf`] is a [`Model`] with values of its [`Parameters`]. A [`Geometry`] is prepared once ([`optics::Facet`]) and evaluated for
//! any number of surfaces. In the book: [The facet](../../book/model.html#the-facet-2), [Parameters](../../book/model.html#parameters).
//!
//! ```
//! use pbrdf::optics::Facet;
//! use pbrdf::{Geometry, Model, Parameters, Pbrdf};
//!
//! let surface = Pbrdf::new(Model::CAUCHY, Parameters { n: 2.07, k: 2.9, ..Parameters::default() })?;
//! let facet = Facet::new(Geometry::new(60.0, 50.0, 180.0)?);
//! let reflection = surface.reflection(&facet);
//! assert!(reflection.dolp < surface.fresnel_limit(&facet));
//! assert_eq!(reflection.brdf, reflection.specular + reflection.diffuse + reflection.volume);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## Derivatives and Mueller matrices
//!
//! Derivatives are analytic. Only those asked for are evaluated.
//!
//! ```
//! use pbrdf::model::GradientRequest;
//! use pbrdf::optics::Facet;
//! use pbrdf::{Geometry, Model, Parameter, Parameters, Pbrdf};
//!
//! # let surface = Pbrdf::new(Model::CAUCHY, Parameters::default())?;
//! let geometry = Geometry::new(60.0, 50.0, 170.0)?;
//! let request = GradientRequest { by: [Parameter::N, Parameter::Kd].into_iter().collect(), brdf: true, dolp: true };
//! let (reflection, gradient) = surface.reflection_and_gradient(&Facet::new(geometry), request);
//! // More diffuse light, less polarisation.
//! assert!(gradient.dolp[Parameter::Kd] < 0.0);
//! let mueller = surface.mueller(geometry);
//! assert!((mueller.element(0, 0) - reflection.brdf).abs() <= 1e-12 * reflection.brdf);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## Many geometries at once
//!
//! [`model::Batch`] evaluates a fixed list of geometries with the vector units of the processor. In the book:
//! [Error against time](../../book/numerics.html#error-against-time), [Time and memory](../../book/numerics.html#time-and-memory).
//!
//! ```
//! use pbrdf::model::Batch;
//! use pbrdf::{Geometry, Model, Parameters, Pbrdf};
//!
//! # let surface = Pbrdf::new(Model::CAUCHY, Parameters::default())?;
//! let geometries = (0..80).map(|theta_r| Geometry::new(60.0, f64::from(theta_r), 180.0)).collect::<Result<Vec<_>, _>>()?;
//! let batch = Batch::new(geometries);
//! let mut dolp = Vec::new();
//! batch.dolp(&surface, &mut dolp);
//! assert_eq!(dolp.len(), 80);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## Measurements, read and simulated
//!
//! [`Measurement::read`] reads a table from anything that is [`std::io::Read`]. [`measurement::Simulation`] makes one with seeded
//! noise. In the book: [A measurement](../../book/command_line.html#a-measurement), [Import](../../book/import.html).
//!
//! ```
//! use pbrdf::measurement::{Columns, Simulation};
//! use pbrdf::{Model, Parameters, Pbrdf};
//!
//! let simulation = Simulation {
//!     model_name: "cauchy".to_owned(),
//!     surface: Pbrdf::new(Model::CAUCHY, Parameters::default())?,
//!     theta_i: vec![30.0, 50.0, 70.0],
//!     theta_r: (0..8).map(|i| f64::from(10 * i)).collect(),
//!     dphi: 180.0,
//!     columns: Columns::Dolp,
//!     noise: 0.005,
//!     brdf_noise: 0.0,
//!     seed: 1,
//! };
//! let data = simulation.run()?;
//! assert_eq!(data.rows.len(), 24);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## Fit, and what the data leave undetermined
//!
//! [`Fit`] describes a fit and runs it. Each [`fit::Estimate`] of the [`FitResult`] has a status and displays accordingly: rounded by
//! its standard error, undetermined, at a bound, or fixed. Directions in parameter space that the data do not determine are listed.
//! In the book: [How the minimum is found](../../book/fits.html#how-the-minimum-is-found); [`fit::JointFit`] fits
//! [several measurements at once](../../book/joint.html).
//!
//! ```
//! use pbrdf::fit::Starts;
//! use pbrdf::{Fit, Measurement, Model};
//!
//! // Three values of DoLP do not determine eight parameters.
//! let data = Measurement::read("theta_i,theta_r,dolp\n30,40,0.13\n50,50,0.29\n70,70,0.67\n".as_bytes())?;
//! let result = Fit::new(&data, Model::CAUCHY).starts(Starts::One).run()?;
//! assert!(result.undetermined().count() > 0);
//! println!("{result}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## Profiles and bootstrap
//!
//! Linear standard errors are a first answer. [`fit::profile`] follows the valley of one parameter; [`fit::bootstrap`] refits resampled
//! residuals. Both take the problem and its result. In the book: [How the ends are found](../../book/intervals.html#how-the-ends-are-found).
//!
//! ```
//! use pbrdf::fit::{Observer, Starts, profile};
//! use pbrdf::{Fit, Measurement, Model, Parameter::N};
//!
//! # let table = "theta_i,theta_r,dolp\n30,40,0.127\n40,40,0.166\n50,50,0.268\n60,60,0.398\n70,60,0.466\n70,70,0.525\n";
//! # let data = Measurement::read(table.as_bytes())?;
//! let fit = Fit::new(&data, Model::SPECULAR).starts(Starts::One);
//! let (problem, result) = (fit.problem()?, fit.run()?);
//! let profile = profile(&problem, &result, N, Observer::NONE);
//! assert!(profile.points.len() > 2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## Choose angles
//!
//! [`fit::Design`] predicts the standard errors of a measurement before it is made.
//!
//! ```
//! use pbrdf::fit::{Design, NoiseModel};
//! use pbrdf::measurement::grid_geometries;
//! use pbrdf::{Model, Parameters};
//!
//! let geometries = grid_geometries(&[30.0, 60.0], &[0.0, 20.0, 40.0, 60.0, 70.0], 180.0)?;
//! let noise = NoiseModel { dolp: Some(0.005), brdf: None };
//! let prediction = Design::new(Model::CAUCHY, Parameters::default(), geometries, noise).predict()?;
//! for (parameter, error) in &prediction.errors {
//!     println!("{}: standard error {error:?}", parameter.symbol());
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`fit::choose`] picks the angles, and [`fit::posterior::Posterior`] draws all surfaces that a measurement allows. In the book:
//! [Which angles to measure](../../book/angles.html), [The posterior](../../book/posterior.html).
//!
//! Programs: `examples/evaluate.rs`, `fit.rs`, `compare_distributions.rs`, `profile.rs`, `choose_angles.rs`.
//!
//! # Scope
//!
//! The model of F. Wang et al., *Polarization bidirectional reflection distribution function of metal surfaces based on diffuse
//! reflection optimization*, Acta Optica Sinica 41(11), 1129002 (2021), doi 10.3788/AOS202141.1129002, and its special cases: values,
//! Mueller matrices, analytic derivatives; tables of measured DoLP and BRDF; least squares in a box, and what the data determine.
//!
//! # Out of scope
//!
//! Rendering, sampling, multiple scattering beyond the model's own terms, anisotropic surfaces, light that is partly coherent, and
//! repair of what the model does not promise (reciprocity of the volume term, an albedo below 1). Nothing here opens a file, starts a
//! thread without the feature `threads`, or reads a clock that it was not given.
//!
//! # Symbols
//!
//! | here | in the paper | meaning |
//! |---|---|---|
//! | `theta_i`, `theta_r` | θi, θr | zenith angles of incidence and view, degrees, 0 ≤ θ < 90 |
//! | `dphi` | Δφ | φr − φi, degrees; 180 is the forward side |
//! | `beta`, `alpha` | β, α | angle of incidence on the facet, tilt of the facet |
//! | `n`, `k` | n, k_m | complex refractive index n + i k |
//! | `sigma` | σ | slope scale of the facets, without unit |
//! | `ks`, `kd`, `kv` | k_s, k_d, k_v | weights of the specular, diffuse and volume lobes |
//! | `q` | q | tail exponent of the Cauchy distribution, > 1 |
//! | `c` | c = o − 1 | Minnaert exponent |
//! | `sigma_v` | σ_v | width of the volume lobe, radians |
//!
//! # Modules
//!
//! Imports run downwards only.
//!
//! 1. [`optics`]: angles, geometry, Fresnel, facets, Stokes and Mueller, tabulated metals
//! 2. [`model`]: parameters, lobes, the pBRDF, its gradient, prepared geometries, batches, presets, audit
//! 3. [`measurement`]: tables read, written, simulated; foreign files imported, tensors exported
//! 4. [`fit`]: options, bounds, objective, solvers, multistart, results, uncertainty, profiles, bootstrap, posterior, design
//! 5. `selftest` (feature): error against run time, stability, cost
//!
//! Feature `threads`: starts, grids and batches run in parallel. The results are the same to the bit without it.

pub use fit::{Fit, FitResult};
pub use measurement::Measurement;
pub use model::{Model, Parameter, Parameters, Pbrdf};
pub use optics::Geometry;

pub mod fit;
pub mod measurement;
pub mod model;
pub mod optics;
pub use fit::rounding;
#[cfg(feature = "selftest")]
pub mod selftest;

/// The code of the book's chapter on Rust runs as documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../../docs/rust.md")]
mod book {}

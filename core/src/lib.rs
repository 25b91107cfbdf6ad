//! The headless core of pbrdf-explorer: a nine-parameter polarimetric microfacet BRDF of metal surfaces, its
//! measurements, its fits and its reports.
//!
//! # Scope
//!
//! The model of F. Wang et al., *Polarization bidirectional reflection distribution function of metal surfaces based on diffuse
//! reflection optimization*, Acta Optica Sinica 41(11), 1129002 (2021), doi 10.3788/AOS202141.1129002, and its special cases:
//! values, Mueller matrices, analytic derivatives; tables of measured DoLP and BRDF; least squares in a box, and what the data determine.
//!
//! # Out of scope
//!
//! Rendering, sampling, multiple scattering beyond the model's own terms, anisotropic surfaces, light that is
//! partly coherent, and repair of what the model does not promise (reciprocity of the volume term, an albedo below 1). Nothing here opens a
//! file, starts a thread or looks at a clock that it was not given.
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
//! Floors of a house; imports run downwards only.
//!
//! 1. [`optics`]: angles, geometry, Fresnel, facets, Stokes and Mueller, tabulated metals
//! 2. [`model`]: the parameters, the lobes, the pBRDF, its gradient, prepared geometries, batches, presets, audit
//! 3. [`measurement`]: tables read, written, simulated; foreign files imported, tensors exported
//! 4. [`fit`]: choices, bounds, residuals, solver and its coordinates, starts, uncertainty, profiles, bootstrap
//! 5. `selftest` (a feature): error against run time, stability, cost

pub use fit::{Fit, FitResult};
pub use measurement::Measurement;
pub use model::{Model, Parameter, Parameters, Pbrdf};
pub use optics::Geometry;

pub mod fit;
pub mod measurement;
pub mod model;
pub mod optics;
pub mod rounding;
#[cfg(feature = "selftest")]
pub mod selftest;

//! Floor 2: the polarimetric BRDF and its parameters.
//!
//! `F = k_s F^s + k_d F^d + k_v F^v`, Eqs. (3, 14) of Wang et al., Acta Opt. Sin. 41, 1129002 (2021): a
//! Torrance–Sparrow lobe of Fresnel-reflecting microfacets, a Minnaert lobe and a volume lobe. Which terms are there is part of
//! the [`Model`]; how strong they are is in the [`Parameters`].

mod assignment;
mod audit;
pub(crate) mod batch;
mod domain;
mod facet_mean;
mod finishes;
mod geometry_set;
mod gradient;
mod hemisphere;
mod hyde_diffuse;
mod lobes;
mod map_parallel;
mod parameter_set;
mod parameters;
mod pbrdf;
mod per_parameter;
mod picture;
mod prepared;
mod presets;
mod reflectance;
mod terms;
mod validation;

pub use assignment::{AssignmentError, assignment_from_text, assignments_from_text, text_from_parameters};
pub use audit::{Audit, Check, Finding};
pub use batch::{AngleColumns, AngleColumnsError, Batch, DolpGradients, Instructions, PreparedAngles, Radiances};
pub use domain::Domain;
pub use finishes::{FINISHES, Finish};
pub use geometry_set::GeometrySet;
pub use gradient::{Gradient, GradientRequest};
pub use hemisphere::{Hemisphere, HemisphereMap};
pub(crate) use hyde_diffuse::lost_by_single_reflection;
pub use lobes::Lobe;
pub use parameter_set::ParameterSet;
pub use parameters::{Parameter, Parameters};
pub use pbrdf::{Pbrdf, Reflection};
pub use per_parameter::PerParameter;
pub use picture::{HeightField, HeightFieldError, Lamp, LampError, Lighting, Picture, Quality, Shape, SkyTable, StokesImage};
pub use presets::{PRESETS, Preset};
pub use reflectance::Reflectance;
pub use terms::{Diffuse, DolpFormula, Model};
pub use validation::ParameterError;

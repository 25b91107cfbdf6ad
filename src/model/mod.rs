//! Floor 2: the nine-parameter polarimetric BRDF.
//!
//! `F = k_s F^s + k_d F^d + k_v F^v`, Eqs. (3, 14) of Wang et al., Acta Opt. Sin. 41, 1129002 (2021): a
//! Torrance–Sparrow lobe of Fresnel-reflecting microfacets, a Minnaert lobe and a volume lobe. Which terms are there is part of
//! the [`Model`]; how strong they are is in the [`Parameters`].

mod assignment;
mod at_hand;
mod audit;
mod batch;
mod far_tail;
mod finishes;
mod gradient;
mod hemisphere;
mod ladder;
mod lesson;
mod lobes;
mod parameters;
mod pbrdf;
mod scene;
mod single_reflection;

pub use assignment::{AssignmentError, assignment_from_text, assignments_from_text, text_from_parameters};
pub use audit::{Audit, Check, Finding, Reflectance};
pub use batch::{Batch, DolpGradients, Instructions, Radiances};
pub use finishes::{FINISHES, Finish};
pub use gradient::{Gradient, Wanted};
pub use hemisphere::{Hemisphere, HemisphereMap};
pub use ladder::{PRESETS, Preset};
pub use lesson::{Data, Lesson, LessonError, LessonErrorKind, Step, Wording};
pub use lobes::Lobe;
pub use parameters::{Domain, Parameter, ParameterError, ParameterSet, Parameters};
pub use pbrdf::{Diffuse, Model, Pbrdf, Reflection};
pub use scene::Scene;
pub(crate) use single_reflection::lost_by_single_reflection;

//! What the physics says of a surface as it is set: energy, reciprocity, polarisation.
//!
//! Nothing here repairs anything. Each finding is a number with a verdict and a sentence on why:
//!
//! - reciprocity, `F(ωi, ωr) = F(ωr, ωi)` (Helmholtz), of each term: relative defect `|F − F'|/max(F, F')`, the largest over a mesh of directions and where
//! - directional-hemispherical reflectance `ρ(θi) = ∫ F00 cos θr dω`: at most 1 for a surface that does not shine by itself
//! - DoLP ≤ DoLP_s: depolarising terms can only lower it
//! - admissible Mueller matrices: the coherency matrix `H = ¼ Σ m_jk (σ_j ⊗ σ_k*)` has no negative eigenvalue (Cloude, Optik 75, 26 (1986))
//! - facets that cover their surface once: `∫ D cos α dω = 1`

use crate::model::{Diffuse, DolpFormula, Model, Parameters, Pbrdf, Reflectance};
use crate::optics::{Degrees, Facet, Geometry, Order, SlopeDistribution, pieces};
use std::f64::consts::PI;

/// Angles of incidence of the reflectance, degrees.
const INCIDENCES: [f64; 19] =
    [0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0, 65.0, 70.0, 75.0, 80.0, 85.0, 89.0];
/// Zenith angles of the mesh of directions, degrees.
const ZENITHS: [f64; 11] = [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 85.0, 89.0];
/// Azimuths of the mesh, degrees.
const AZIMUTHS: [f64; 5] = [0.0, 45.0, 90.0, 135.0, 180.0];

/// What rounding alone makes of a reciprocal term: the same products in another order.
const RECIPROCAL: f64 = 1e-12;
/// DoLP and its limit are rounded apart.
const ABOVE_LIMIT: f64 = 4.0 * f64::EPSILON;
/// Rounding of an eigenvalue, in units of m00.
const EIGENVALUE: f64 = 1e-12;
/// The quadrature of a smooth density to 32 nodes a piece.
const NORMALISED: f64 = 1e-9;
/// Below this radiance factor the elements of a Mueller matrix have no digits left to judge by.
const LIT: f64 = 1e-200;

/// What was looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Check {
    /// Reciprocity of the specular term.
    SpecularReciprocity,
    /// Reciprocity of the diffuse term.
    DiffuseReciprocity,
    /// Reciprocity of the volume term.
    VolumeReciprocity,
    /// Directional-hemispherical reflectance.
    Reflectance,
    /// DoLP against the Fresnel limit.
    FresnelLimit,
    /// Eigenvalues of the coherency matrices.
    Admissibility,
    /// Area of the facets.
    Normalisation,
}

/// One number with its verdict.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Finding {
    /// What was looked at.
    pub check: Check,
    /// The number: a relative defect, the largest reflectance, the largest DoLP − DoLP_s, the smallest eigenvalue over m00, how far the
    /// integral of the distribution is from 1.
    pub value: f64,
    /// What it may be at most (of an eigenvalue: at least).
    pub bar: f64,
    /// Whether it is.
    pub pass: bool,
    /// Where the number was found; none where the check has no place.
    pub at: Option<Geometry>,
}

/// All findings about a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Audit {
    /// One for each check that concerns the model's terms.
    pub findings: Vec<Finding>,
    /// ρ against θi, ascending.
    pub reflectance: Vec<Reflectance>,
}

impl Audit {
    /// Looks at a surface, its DoLP by the consistent formula: the Fresnel limit is one of that.
    #[must_use]
    pub fn new(surface: &Pbrdf) -> Self {
        let surface = &surface.with_dolp_formula(DolpFormula::Consistent);
        let model = surface.model();
        let reflectance: Vec<Reflectance> = INCIDENCES.iter().map(|&theta_i| Reflectance::new(surface, Degrees(theta_i))).collect();
        let mut findings = Vec::new();
        if model.specular {
            findings.push(reciprocity(surface, Check::SpecularReciprocity));
        }
        if model.diffuse != Diffuse::Absent {
            findings.push(reciprocity(surface, Check::DiffuseReciprocity));
        }
        if model.volume {
            findings.push(reciprocity(surface, Check::VolumeReciprocity));
        }
        findings.push(largest_reflectance(&reflectance));
        if model.specular {
            findings.push(fresnel_limit(surface));
        }
        findings.push(admissibility(surface));
        if model.specular {
            findings.push(normalisation(model, surface.parameters()));
        }
        Self { findings, reflectance }
    }

    /// The finding of that check, where it concerns the model.
    #[must_use]
    pub fn finding(&self, check: Check) -> Option<&Finding> {
        self.findings.iter().find(|finding| finding.check == check)
    }
}

impl Finding {
    /// Why it is as it is, in one sentence.
    #[must_use]
    pub fn why(&self) -> &'static str {
        match (self.check, self.pass) {
            (Check::SpecularReciprocity, true) => {
                "P, G and the Fresnel reflection stay when the directions change places; tested on the radiance, F00."
            }
            (Check::SpecularReciprocity, false) => "The specular term should be the same both ways: this is a fault of the program.",
            (Check::DiffuseReciprocity, true) => "cos θi and cos θr enter as a product: they may change places.",
            (Check::DiffuseReciprocity, false) => {
                "Hyde's balance depends on the angle of incidence alone: seen the other way round it is another."
            }
            (Check::VolumeReciprocity, true) => "The volume lobe is absent, or so wide that it hardly depends on any angle.",
            (Check::VolumeReciprocity, false) => "The volume term depends on the angle of view alone: it cannot be reciprocal.",
            (Check::Reflectance, true) => "No more light leaves the surface than falls on it.",
            (Check::Reflectance, false) => {
                "More light leaves the surface than falls on it: nothing in the model keeps k_s, k_d and k_v together below that, and for c < 0 the Minnaert term grows without end at grazing incidence."
            }
            (Check::FresnelLimit, true) => "The depolarising terms add radiance without polarisation: they can only lower DoLP.",
            (Check::FresnelLimit, false) => "DoLP above that of the bare facets: this is a fault of the program.",
            (Check::Admissibility, true) => {
                "A Fresnel reflection and depolarisers with positive weights add up to a matrix that some optical system has."
            }
            (Check::Admissibility, false) => "No optical system has this matrix: this is a fault of the program.",
            (Check::Normalisation, true) => "The facets, projected, cover their surface exactly once.",
            (Check::Normalisation, false) => "The projected facets should cover the surface once: this is a fault of the program.",
        }
    }
}

/// The directions of the mesh.
fn mesh() -> impl Iterator<Item = Geometry> {
    let zeniths = || ZENITHS.into_iter();
    let all = zeniths().flat_map(move |i| zeniths().flat_map(move |r| AZIMUTHS.into_iter().map(move |dphi| (i, r, dphi))));
    all.filter_map(|(i, r, dphi)| Geometry::new(i, r, dphi).ok())
}

/// The largest number over the mesh and where it is; 0 nowhere without a number.
fn largest(of: impl Fn(Geometry) -> Option<f64>) -> (f64, Option<Geometry>) {
    let numbers = mesh().filter_map(|geometry| Some((of(geometry)?, geometry)));
    numbers.fold(
        (0.0, None),
        |(most, at), (number, geometry)| if number > most || at.is_none() { (number, Some(geometry)) } else { (most, at) },
    )
}

/// |F − F'|/max(F, F') of one term, where there is light.
fn reciprocity(surface: &Pbrdf, check: Check) -> Finding {
    let term = |geometry: Geometry| {
        let reflection = surface.reflection(&Facet::new(geometry));
        match check {
            Check::DiffuseReciprocity => reflection.diffuse,
            Check::VolumeReciprocity => reflection.volume,
            _ => reflection.specular,
        }
    };
    let (value, at) = largest(|there| {
        let back =
            Geometry::new(there.theta_r().0, there.theta_i().0, -there.dphi().0).ok().filter(|_| there.theta_i() < there.theta_r())?;
        let (one, other) = (term(there), term(back));
        let larger = one.max(other);
        (larger > LIT).then(|| (one - other).abs() / larger)
    });
    Finding { check, value, bar: RECIPROCAL, pass: value <= RECIPROCAL, at }
}

fn largest_reflectance(reflectance: &[Reflectance]) -> Finding {
    let most = reflectance.iter().max_by(|a, b| a.total().total_cmp(&b.total()));
    let (value, theta_i, error) = most.map_or((0.0, 0.0, 0.0), |most| (most.total(), most.theta_i, most.error));
    // What the quadrature cannot tell from 1 is not above it.
    let bar = 1.0 + error.max(NORMALISED);
    Finding { check: Check::Reflectance, value, bar: 1.0, pass: value <= bar, at: Geometry::new(theta_i, 0.0, 180.0).ok() }
}

fn fresnel_limit(surface: &Pbrdf) -> Finding {
    let (value, at) = largest(|geometry| {
        let facet = Facet::new(geometry);
        let limit = surface.fresnel_limit(&facet);
        Some(surface.dolp(&facet) - limit * (1.0 + ABOVE_LIMIT))
    });
    Finding { check: Check::FresnelLimit, value, bar: 0.0, pass: value <= 0.0, at }
}

fn admissibility(surface: &Pbrdf) -> Finding {
    let (negative, at) = largest(|geometry| {
        let mueller = surface.mueller(geometry);
        let m00 = mueller.element(0, 0);
        (m00 > LIT && m00.is_finite()).then(|| -mueller.smallest_coherency_eigenvalue() / m00)
    });
    // Without light there is nothing to judge.
    Finding { check: Check::Admissibility, value: -negative, bar: -EIGENVALUE, pass: -negative >= -EIGENVALUE, at }
}

/// ∫ D cos α dω = ∫ P dω over slopes: dω = 2π s cos³α ds and s ds = σ² dw. Of a heavy tail that reaches beyond w = e^60 the rest is known: e^(−y).
fn normalisation(model: Model, p: &Parameters) -> Finding {
    let distribution: SlopeDistribution = model.distribution;
    let end = distribution.faintest(0.0, p.q).min(60.0);
    let mut value = libm::exp(-distribution.survival_exponent(libm::expm1(end), p.q));
    for piece in pieces(0.0, end) {
        for (x, weight) in Order::Fine.between(piece[0], piece[1]) {
            let w = libm::expm1(x);
            let tan_alpha_sq = 2.0 * w * p.sigma * p.sigma;
            let cos_alpha_cubed = libm::pow(1.0 + tan_alpha_sq, -1.5);
            value += weight
                * (1.0 + w)
                * distribution.facet_density(tan_alpha_sq, p.sigma, p.q)
                * 2.0
                * PI
                * p.sigma
                * p.sigma
                * cos_alpha_cubed;
        }
    }
    let defect = (value - 1.0).abs();
    Finding { check: Check::Normalisation, value: defect, bar: NORMALISED, pass: defect <= NORMALISED, at: None }
}

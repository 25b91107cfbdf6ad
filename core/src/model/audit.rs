//! What the physics says of a surface as it is set: energy, reciprocity, polarisation.
//!
//! Nothing here repairs anything. Each finding is a number with a verdict and a sentence on why:
//!
//! - reciprocity, `F(ωi, ωr) = F(ωr, ωi)` (Helmholtz), of each term: relative defect `|F − F'|/max(F, F')`, the largest over a mesh of directions and where
//! - directional-hemispherical reflectance `ρ(θi) = ∫ F00 cos θr dω`: at most 1 for a surface that does not shine by itself
//! - DoLP ≤ DoLP_s: depolarising terms can only lower it
//! - admissible Mueller matrices: the coherency matrix `H = ¼ Σ m_jk (σ_j ⊗ σ_k*)` has no negative eigenvalue (Cloude, Optik 75, 26 (1986))
//! - facets that cover their surface once: `∫ D cos α dω = 1`
//!
//! ρ of the specular lobe is integrated over facets instead of directions (dω_r = 4 cos β dω_h), which makes mirror-like lobes as easy as rough ones:
//!
//! `ρ^s = ∫ p(s) ⟨R(β) G u⟩ ds`, `cos β = u cos α cos θi` with the u of [`Grooves`],
//!
//! by Gauss–Legendre quadrature between all kinks of G u; the estimated error is the difference to half the nodes. The Minnaert term has
//! `2 cos^c θi/(c + 2)` for unit k_d, infinite for c ≤ −2, Hyde's `k_s (1 − ρ_perfect)`, the volume term `2π ∫ F^v sin θr cos θr dθr`.

use crate::model::{Diffuse, DolpFormula, Model, Parameters, Pbrdf, lost_by_single_reflection};
use crate::optics::{Degrees, Facet, Fresnel, Geometry, Grooves, Order, SlopeDistribution, reduced_slope_sq};
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

/// Reflectance at one angle of incidence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reflectance {
    /// θi in degrees.
    pub theta_i: f64,
    /// ρ of the specular term.
    pub specular: f64,
    /// ρ of the diffuse term.
    pub diffuse: f64,
    /// ρ of the volume term.
    pub volume: f64,
    /// Estimated error of the specular ρ.
    pub error: f64,
}

impl Reflectance {
    /// ρ of all terms.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.specular + self.diffuse + self.volume
    }
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
        let reflectance: Vec<Reflectance> = INCIDENCES.iter().map(|&theta_i| surface.reflectance(Degrees(theta_i))).collect();
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
            (Check::SpecularReciprocity, true) => "A facet mirrors either way alike, and so do shadowing and masking.",
            (Check::SpecularReciprocity, false) => "The specular term should be the same both ways: this is a fault of the program.",
            (Check::DiffuseReciprocity, true) => "cos θi and cos θr enter as a product: they may change places.",
            (Check::DiffuseReciprocity, false) => {
                "Hyde's balance depends on the angle of incidence alone: seen the other way round it is another."
            }
            (Check::VolumeReciprocity, true) => "So wide a volume lobe hardly depends on any angle.",
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

impl Pbrdf {
    /// Directional-hemispherical reflectance of each term, ∫ F00 cos θr dω, weights included; θi below 90°.
    #[must_use]
    pub fn reflectance(&self, theta_i: Degrees) -> Reflectance {
        let (model, p) = (self.model(), self.parameters());
        let (specular, error) = if model.specular { self.specular_reflectance(theta_i) } else { (0.0, 0.0) };
        let diffuse = match model.diffuse {
            Diffuse::Absent => 0.0,
            Diffuse::Lambert => p.kd,
            Diffuse::Minnaert => p.kd * minnaert(theta_i, p.c),
            Diffuse::Hyde if model.specular => p.ks * lost_by_single_reflection(model, p, theta_i),
            Diffuse::Hyde => 0.0,
        };
        let volume = if model.volume { p.kv * volume(p.sigma_v) } else { 0.0 };
        Reflectance { theta_i: theta_i.0, specular, diffuse, volume, error }
    }

    /// ρ of the specular term and its estimated error.
    fn specular_reflectance(&self, theta_i: Degrees) -> (f64, f64) {
        let grooves = Grooves::at(theta_i);
        let [fine, coarse] =
            [Order::Fine, Order::Coarse].map(|order| self.parameters().ks * self.mean_over_facets(&grooves, theta_i, order));
        (fine, (fine - coarse).abs())
    }

    /// ∫ p(s) ⟨R G u⟩ ds for unit k_s.
    fn mean_over_facets(&self, grooves: &Grooves, theta_i: Degrees, order: Order) -> f64 {
        let (p, distribution) = (self.parameters(), self.model().distribution);
        let end = distribution.faintest(0.0, p.q);
        let mut sum = 0.0;
        let mut low = 0.0;
        for &edge in grooves.edges() {
            let high = libm::log1p(reduced_slope_sq(edge * edge, p.sigma)).min(end);
            for piece in pieces(low, high) {
                for (x, weight) in order.between_roots(piece[0], piece[1]) {
                    let w = libm::expm1(x);
                    let share = weight * distribution.survival_slope(w, p.q) * libm::exp(-distribution.survival_exponent(w, p.q));
                    sum += share * self.mean_over_azimuths(grooves, p.sigma * (2.0 * w).sqrt(), theta_i.cos(), order.halved());
                }
            }
            low = high;
        }
        sum
    }

    /// ⟨R G u⟩ over the azimuths of facets of slope s.
    fn mean_over_azimuths(&self, grooves: &Grooves, s: f64, cos_i: f64, order: Order) -> f64 {
        let cos_alpha = 1.0 / (1.0 + s * s).sqrt();
        let mut sum = 0.0;
        for [low, high] in grooves.azimuths(s) {
            let middle = Grooves::kept(s, grooves.u(s, f64::midpoint(low, high)));
            if middle == 0.0 {
                // Below the horizon.
                continue;
            }
            for (phi, weight) in order.between(low, high) {
                let u = grooves.u(s, phi);
                let kept = if self.model().masking { Grooves::kept(s, u) } else { u };
                let cos_beta = (u * cos_alpha * cos_i).clamp(0.0, 1.0);
                let sin_beta_sq = (1.0 - cos_beta) * (1.0 + cos_beta);
                sum += weight * kept * Fresnel::under(self.index(), cos_beta, cos_beta * cos_beta, sin_beta_sq).mean();
            }
        }
        sum / PI
    }
}

/// Longest piece in ln(1 + w) that one rule is used for.
const LONGEST: f64 = 4.0;

/// An interval in equal pieces short enough for one rule.
fn pieces(low: f64, high: f64) -> impl Iterator<Item = [f64; 2]> {
    let count = ((high - low) / LONGEST).ceil().clamp(0.0, 200.0);
    let width = (high - low) / count;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of 200 at most")]
    let count = count as u32;
    (0..count).map(move |i| [low + f64::from(i) * width, low + f64::from(i + 1) * width])
}

/// `2 cos^c θi/(c + 2)`.
fn minnaert(theta_i: Degrees, c: f64) -> f64 {
    if c > -2.0 { 2.0 * libm::pow(theta_i.cos(), c) / (c + 2.0) } else { f64::INFINITY }
}

/// `2π ∫ F^v sin θr cos θr dθr` for unit k_v, between 0 and the lesser of 90° and ten widths.
fn volume(sigma_v: f64) -> f64 {
    let end = (10.0 * sigma_v).min(0.5 * PI);
    let lobe = |theta: f64| libm::exp(-0.5 * (theta / sigma_v) * (theta / sigma_v)) * libm::sin(2.0 * theta);
    let integral: f64 = Order::Fine.between(0.0, end).map(|(theta, weight)| weight * lobe(theta)).sum();
    // 2π sin cos = π sin 2θ.
    PI * integral / ((2.0 * PI).sqrt() * sigma_v)
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

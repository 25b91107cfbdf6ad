//! The Mueller matrix against NIST's SCATMECH (Gauss facets, V-groove), in and out of plane, every sign.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

mod common;

use common::table;
use pbrdf::model::{Diffuse, Model, Parameters, Pbrdf};
use pbrdf::optics::{Geometry, SlopeDistribution, Stokes};

/// Bar in units of m00: the table has 13 digits.
const AGREEMENT: f64 = 1e-10;

#[test]
fn specular_mueller_matrix_agrees_in_all_elements() {
    let model = Model { diffuse: Diffuse::Absent, volume: false, ..Model::full(SlopeDistribution::Gauss) };
    for row in table("scatmech_mueller.csv") {
        let parameters =
            Parameters { n: row.number("n"), k: row.number("k"), sigma: row.number("sigma"), ks: 1.0, ..Parameters::default() };
        let surface = Pbrdf::new(model, parameters).expect("a valid surface");
        let geometry = Geometry::new(row.number("theta_i"), row.number("theta_r"), row.number("phi_s") + 180.0).expect("a geometry");
        let mueller = surface.mueller(geometry);
        let m00 = row.number("m00");
        for i in 0..4 {
            for j in 0..4 {
                let error = (mueller.element(i, j) - row.number(&format!("m{i}{j}"))).abs() / m00;
                assert!(error <= AGREEMENT, "line {}: m{i}{j} is off by {error:.1e} of m00", row.line);
            }
        }
    }
}

/// Some fifty roundings of a matrix product.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

#[test]
fn dolp_of_the_mueller_matrix_is_the_short_form_of_dolp() {
    for row in table("golden.csv") {
        let (surface, geometry) = (row.surface(), row.geometry());
        let stokes = surface.mueller(geometry).apply(Stokes::UNPOLARISED);
        let reflection = surface.reflection(&pbrdf::optics::Facet::new(geometry));
        if reflection.brdf > 1e-290 {
            assert!((stokes.dolp() - reflection.dolp).abs() <= ROUNDING, "line {}", row.line);
            assert!((stokes.0[0] - reflection.brdf).abs() <= ROUNDING * reflection.brdf, "line {}", row.line);
        }
    }
}

#[test]
fn the_frames_turn_by_dphi_up_to_normal_incidence() {
    for dphi in [0.0, 30.0, 117.0, 180.0, 250.0] {
        let surface = Pbrdf::new(Model::full(SlopeDistribution::Gauss), Parameters::default()).expect("a valid surface");
        let at = |theta: f64| surface.mueller(Geometry::new(theta, theta, dphi).expect("a geometry"));
        let (normal, near) = (at(0.0), at(1e-7));
        // sin² of 1e-7 degrees is 3e-18.
        assert!((normal.0 - near.0).amax() <= ROUNDING * normal.element(0, 0), "dphi {dphi}: {} {}", normal.0, near.0);
    }
}

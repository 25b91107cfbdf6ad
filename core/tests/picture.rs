//! The picture of a shape under a lamp and a sky: pixels against the Mueller matrix of their geometry, the sky against an integral over
//! directions of incidence, and what a textbook says of both.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use pbrdf::model::{Diffuse, DolpFormula, Lamp, Lighting, Model, PRESETS, Parameters, Picture, Quality, Shape, SkyTable, StokesImage};
use pbrdf::optics::{Degrees, Facet};
use pbrdf::{Geometry, Pbrdf};
use std::f64::consts::PI;

const SIZE: usize = 48;

fn picture(shape: Shape) -> Picture {
    Picture::new(shape, SIZE, &|| false).expect("not cancelled")
}

fn stokes(picture: &Picture, surface: &Pbrdf, lamp: Option<Lamp>, sky: Option<(f64, &SkyTable)>) -> StokesImage {
    picture.stokes(surface, &Lighting { lamp, sky }, &|| false).expect("not cancelled")
}

fn lamp(polar: f64, azimuth: f64) -> Lamp {
    Lamp::new(polar, azimuth).expect("a direction")
}

fn surface(model: Model, values: &Parameters) -> Pbrdf {
    Pbrdf::new(model, *values).expect("in range")
}

/// Surfaces that differ in all parameters: a rough metal, a smooth one, a dielectric, a broad tail, a strong diffuse term.
fn parameters() -> [Parameters; 5] {
    let default = Parameters::default();
    [
        Parameters { n: 2.07, k: 2.9, sigma: 0.67, kd: 0.12, kv: 0.2, q: 2.2, c: -0.4, sigma_v: 0.6, ..default },
        Parameters { n: 1.24, k: 6.6, sigma: 0.05, kd: 0.01, kv: 0.01, q: 1.8, ..default },
        Parameters { n: 1.5, k: 0.0, sigma: 0.2, ks: 0.7, kd: 0.4, kv: 0.0, c: 0.0, ..default },
        Parameters { n: 0.4, k: 2.95, sigma: 0.1, q: 1.1, kd: 0.0, kv: 0.3, sigma_v: 0.1, ..default },
        Parameters { n: 3.0, k: 0.5, sigma: 0.3, kd: 2.0, c: -0.9, ..default },
    ]
}

/// The Stokes vector of a surface of that normal under a lamp, from the whole Mueller matrix: another way than the kernels'.
fn expected(surface: &Pbrdf, lamp: &Lamp, normal: [f64; 3]) -> [f64; 3] {
    let Some(geometry) = lamp.geometry(normal) else { return [0.0; 3] };
    let mueller = surface.mueller(geometry);
    let cos_i = geometry.theta_i().cos();
    let azimuth = libm::atan2(normal[1], normal[0]);
    let (sin, cos) = libm::sincos(2.0 * azimuth);
    let (m10, m20) = (mueller.element(1, 0), mueller.element(2, 0));
    assert_eq!(mueller.element(3, 0), 0.0, "unpolarised light gets no circular part");
    [mueller.element(0, 0) * cos_i, -(m10 * cos - m20 * sin) * cos_i, -(m10 * sin + m20 * cos) * cos_i]
}

#[test]
fn every_pixel_is_the_mueller_matrix_of_its_geometry_turned_into_the_cameras_frame() {
    // Kernel and scalar form, and angles and vectors, differ by roundings; close to grazing they are prepared alike.
    const TOLERANCE: f64 = 1e-12;
    for (number, (values, shape)) in
        parameters().iter().zip([Shape::Sphere, Shape::Cylinder, Shape::Plate, Shape::Relief].iter().cycle()).enumerate()
    {
        let picture = picture(*shape);
        for (preset, (polar, azimuth)) in PRESETS.iter().zip([(30.0, 135.0), (75.0, -20.0), (140.0, 60.0), (10.0, 0.0)].into_iter().cycle())
        {
            let (surface, lamp) = (surface(preset.model, values), lamp(polar, azimuth));
            let image = stokes(&picture, &surface, Some(lamp), None);
            let mut lit = 0;
            for (row, column) in (0..SIZE).flat_map(|row| (0..SIZE).map(move |column| (row, column))) {
                let Some(normal) = picture.normal(row, column) else {
                    assert_eq!(image.at(row, column), None);
                    continue;
                };
                let (found, expected) = (image.at(row, column).expect("a surface").0, expected(&surface, &lamp, normal));
                lit += usize::from(expected[0] > 0.0);
                for (found, wanted) in found.iter().zip(expected) {
                    let off = (found - wanted).abs();
                    assert!(
                        off <= TOLERANCE * expected[0],
                        "surface {number}, {}, {shape:?}, {row} {column}: {found} {wanted}",
                        preset.key
                    );
                }
            }
            let is_lit = polar < 120.0 || *shape == Shape::Sphere;
            assert!(lit > SIZE || !is_lit, "{shape:?} {polar}: {lit} pixels");
        }
    }
}

#[test]
fn angles_of_a_pixel_are_those_between_its_vectors() {
    let lamp = lamp(50.0, 200.0);
    let direction = [Degrees(50.0).sin() * Degrees(200.0).cos(), Degrees(50.0).sin() * Degrees(200.0).sin(), Degrees(50.0).cos()];
    for normal in [[0.6, 0.0, 0.8], [-0.48, -0.36, 0.8], [0.0, -0.6, 0.8], [0.0, 0.0, 1.0]] {
        let geometry = lamp.geometry(normal).expect("lit");
        let dot: f64 = normal.iter().zip(direction).map(|(a, b)| a * b).sum();
        assert!((geometry.theta_i().cos() - dot).abs() < 1e-14 && (geometry.theta_r().cos() - normal[2]).abs() < 1e-14);
        // cos 2β of lamp and camera.
        let (theta_i, theta_r) = (geometry.theta_i(), geometry.theta_r());
        let cos_2beta = theta_i.cos() * theta_r.cos() + theta_i.sin() * theta_r.sin() * geometry.dphi().cos();
        assert!((cos_2beta - direction[2]).abs() < 1e-14);
        let Some((back, found)) = Lamp::facing(geometry, 200.0) else { panic!("lamp and camera apart") };
        assert!((back.polar().0 - 50.0).abs() < 1e-9, "{back:?}");
        assert!(found.iter().zip(normal).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?} {normal:?}");
    }
    assert_eq!(lamp.geometry([0.6, 0.8, 0.0]), None, "in its own shadow");
}

#[test]
fn under_a_lamp_alone_the_angle_of_polarisation_and_the_fresnel_limit_are_the_same_everywhere() {
    let lamp = lamp(70.0, 30.0);
    let values = Parameters { n: 1.5, k: 0.0, sigma: 0.3, kd: 0.02, kv: 0.0, ..Parameters::default() };
    let lone = surface(Model::SPECULAR, &values);
    let mixed = surface(Model::CAUCHY, &values);
    // β is half the angle between lamp and camera: 35° in every pixel.
    let limit = lone.fresnel_limit(&Facet::new(Geometry::new(35.0, 35.0, 180.0).expect("a geometry")));
    let picture = picture(Shape::Sphere);
    let image = stokes(&picture, &mixed, Some(lamp), None);
    let lit = |values: &[f64]| values.iter().copied().filter(|value| !value.is_nan()).collect::<Vec<_>>();
    // Across the plane of lamp and camera, 30° + 90°. Roundings of an angle in degrees.
    assert!(lit(&image.angle()).iter().all(|angle| (angle - 120.0).abs() < 1e-9));
    let dolp = lit(&stokes(&picture, &lone, Some(lamp), None).dolp());
    assert!(dolp.len() > SIZE && dolp.iter().all(|dolp| (dolp / limit - 1.0).abs() < 1e-12));
    // What varies is the depolarised share.
    let dolp = lit(&image.dolp());
    let (low, high) = dolp.iter().fold((1.0_f64, 0.0_f64), |(low, high), dolp| (low.min(*dolp), high.max(*dolp)));
    assert!(low < 0.1 * limit && high > 0.5 * limit && high < limit, "{low} {high} {limit}");
}

#[test]
fn behind_the_shape_a_lamp_lights_nothing_and_its_own_shadow_is_dark() {
    let values = Parameters::default();
    let image = stokes(&picture(Shape::Sphere), &surface(Model::CAUCHY, &values), Some(lamp(180.0, 0.0)), None);
    assert!(image.s0.iter().all(|s0| s0.is_nan() || *s0 == 0.0));
    let image = stokes(&picture(Shape::Sphere), &surface(Model::CAUCHY, &values), Some(lamp(90.0, 0.0)), None);
    // From the right: the left half is dark.
    assert!((0..SIZE).all(|row| image.at(row, 5).is_none_or(|stokes| stokes.0[0] == 0.0)));
    assert!(image.at(SIZE / 2, SIZE - 5).expect("a surface").0[0] > 0.0);
    assert!(Lamp::new(-1.0, 0.0).is_err() && Lamp::new(181.0, 0.0).is_err() && Lamp::new(30.0, f64::NAN).is_err());
}

/// S0 and S1 in the meridian basis under a uniform sky of radiance 1, summed over directions of incidence.
fn summed_over_directions(surface: &Pbrdf, theta_r: f64, steps: u32) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for i in 0..steps {
        // Even steps in θi; the lobe's other half in Δφ is the mirror image.
        let theta_i = 90.0 * (f64::from(i) + 0.5) / f64::from(steps);
        let solid = 0.5 * Degrees(2.0 * theta_i).sin() * (0.5 * PI / f64::from(steps)) * (2.0 * PI / f64::from(steps));
        for j in 0..steps {
            let dphi = 180.0 * (f64::from(j) + 0.5) / f64::from(steps);
            let geometry = Geometry::new(theta_i, theta_r, dphi).expect("in range");
            let reflection = surface.reflection(&Facet::new(geometry));
            let (cos, _) = geometry.rotation_out().inverse().double_angle();
            sums[0] += solid * reflection.brdf;
            sums[1] += solid * reflection.brdf * reflection.dolp * cos;
        }
    }
    sums
}

#[test]
fn the_sky_is_the_integral_over_directions_of_incidence() {
    let default = Parameters::default();
    let rough = Parameters { n: 2.07, k: 2.9, sigma: 0.67, kd: 0.12, kv: 0.2, q: 2.2, c: -0.4, sigma_v: 0.6, ..default };
    let sharp = Parameters { n: 1.5, k: 0.0, sigma: 0.1, ks: 0.8, kd: 0.2, kv: 0.1, q: 2.0, ..default };
    for (key, values) in
        [("gauss", rough), ("gauss", sharp), ("cauchy", rough), ("cauchy", sharp), ("priest-germer", rough), ("hyde", sharp)]
    {
        let preset = PRESETS.iter().find(|preset| preset.key == key).expect("a preset");
        let surface = surface(preset.model, &values);
        let (fine, fast) = (SkyTable::new(&surface, Quality::Fine), SkyTable::new(&surface, Quality::Fast));
        for theta_r in [0.0, 12.3, 41.0, 56.3, 70.0, 78.0] {
            let [s0, s1] = summed_over_directions(&surface, theta_r, if preset.key == "hyde" { 300 } else { 800 });
            for (table, bar) in [(&fine, 1e-4), (&fast, 1e-3)] {
                let found = table.at(theta_r);
                assert!((found[0] - s0).abs() <= bar * s0, "{} σ = {}, θr = {theta_r}: {found:?} {s0}", preset.key, values.sigma);
                assert!((found[1] - s1).abs() <= bar * s0, "{} σ = {}, θr = {theta_r}: {found:?} {s1}", preset.key, values.sigma);
            }
        }
    }
}

#[test]
fn under_the_sky_a_sphere_has_the_classical_ring() {
    // A smooth dielectric: DoLP of a mirror, greatest at Brewster's angle, and the light swings along circles around the middle.
    let values = Parameters { n: 1.5, k: 0.0, sigma: 0.01, ..Parameters::default() };
    let gauss = Model { diffuse: Diffuse::Absent, volume: false, ..Model::GAUSS };
    let surface = surface(gauss, &values);
    let table = SkyTable::new(&surface, Quality::Fine);
    let limit = |theta: f64| surface.fresnel_limit(&Facet::new(Geometry::new(theta, theta, 180.0).expect("in range")));
    for theta_r in [10.0, 30.0, 50.0, 70.0] {
        let [s0, s1] = table.at(theta_r);
        // Facets tilt by about σ: second order in it.
        assert!((s1 / s0 - limit(theta_r)).abs() < 2e-3, "{theta_r}: {} {}", s1 / s0, limit(theta_r));
    }
    let brewster = libm::atan(1.5) * 180.0 / PI;
    let steepest =
        (1..89).map(f64::from).max_by(|a, b| (table.at(*a)[1] / table.at(*a)[0]).total_cmp(&(table.at(*b)[1] / table.at(*b)[0])));
    assert!((steepest.expect("angles") - brewster).abs() < 1.0);
    let picture = picture(Shape::Sphere);
    let image = stokes(&picture, &surface, None, Some((2.0, &table)));
    for (row, column) in [(10, 30), (24, 40), (40, 12), (5, 24)] {
        let (x, y) = picture.center(row, column);
        let stokes = image.at(row, column).expect("a surface");
        let tangent = (libm::atan2(y, x) * 180.0 / PI + 90.0).rem_euclid(180.0);
        assert!((stokes.angle().expect("polarised") - tangent).abs() < 1e-9, "{row} {column}");
        let theta_r = libm::asin(libm::hypot(x, y)) * 180.0 / PI;
        assert!((stokes.0[0] - 2.0 * table.at(theta_r)[0]).abs() < 1e-12);
    }
}

#[test]
fn lamp_and_sky_add_up_and_the_printed_formula_changes_no_picture() {
    let surface = surface(Model::CAUCHY, &Parameters { ks: 0.5, ..Parameters::default() });
    let table = SkyTable::new(&surface, Quality::Fast);
    let picture = picture(Shape::Relief);
    let lamp = Some(lamp(40.0, 90.0));
    let both = stokes(&picture, &surface, lamp, Some((0.3, &table)));
    let parts = [stokes(&picture, &surface, lamp, None), stokes(&picture, &surface, None, Some((0.3, &table)))];
    for pixel in 0..SIZE * SIZE {
        // One rounding each.
        assert!((both.s0[pixel] - parts[0].s0[pixel] - parts[1].s0[pixel]).abs() <= 1e-15 * both.s0[pixel]);
        assert!((both.s2[pixel] - parts[0].s2[pixel] - parts[1].s2[pixel]).abs() <= 1e-15 * both.s0[pixel]);
    }
    let printed = surface.with_dolp_formula(DolpFormula::AsPrinted);
    assert_eq!(stokes(&picture, &printed, lamp, None), parts[0]);
    // Malus: the mean through two crossed analysers is half the radiance.
    let (along, across) = (both.through_analyser(Degrees(20.0)), both.through_analyser(Degrees(110.0)));
    assert!((0..SIZE * SIZE).all(|pixel| (along[pixel] + across[pixel] - both.s0[pixel]).abs() <= 1e-14 * both.s0[pixel]));
}

#[test]
fn a_cancelled_picture_is_none() {
    assert_eq!(Picture::new(Shape::Sphere, 8, &|| true), None);
    let surface = surface(Model::CAUCHY, &Parameters::default());
    let lighting = Lighting { lamp: Some(lamp(30.0, 135.0)), sky: None };
    assert_eq!(picture(Shape::Sphere).stokes(&surface, &lighting, &|| true), None);
}

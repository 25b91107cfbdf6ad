//! What does a scene cost in the scalar form, from the least to everything?
//!
//! Budgets: the specular lobe in plane, DoLP alone, a quarter of everything; every omission less than what it leaves out. As a table with
//! differences: `pbrdf-explorer report cost`. Instructions per point, here of DoLP of the full model, as a difference of two counts:
//!
//! ```sh
//! cargo bench --no-default-features --features threads --bench cost --no-run     # prints the name of the executable
//! for n in 1 11; do valgrind --tool=callgrind --callgrind-out-file=/dev/null target/release/deps/cost-… \
//!     --bench --sample-count 1 --sample-size $n dolp_of_all_terms; done          # (second − first)/(10 · 2048)
//! ```
#![allow(clippy::expect_used, reason = "a bench fails by panicking")]

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use pbrdf::model::{Diffuse, GeometrySet, GradientRequest, Model, Parameter, ParameterSet, Parameters, Pbrdf};
use pbrdf::optics::{Geometry, RefractiveIndex, SlopeDistribution};

const POINTS: u32 = 2048;

fn main() {
    divan::main();
}

fn geometries(in_plane: bool) -> Vec<Geometry> {
    let geometry = |i| {
        let spread = |step: f64| (f64::from(i) * step).fract();
        let dphi = if in_plane { 180.0 } else { 360.0 * spread(0.569_84) };
        Geometry::new(85.0 * spread(0.618_034), 85.0 * spread(0.754_878), dphi).expect("angles in range")
    };
    (0..POINTS).map(geometry).collect()
}

fn surface(diffuse: Diffuse, volume: bool, distribution: SlopeDistribution) -> Pbrdf {
    Pbrdf::new(Model { diffuse, volume, ..Model::full(distribution) }, Parameters::default()).expect("the defaults")
}

fn full() -> Pbrdf {
    surface(Diffuse::Minnaert, true, SlopeDistribution::Cauchy)
}

fn dolp(bencher: Bencher, surface: Pbrdf, in_plane: bool) {
    let scene = GeometrySet::new(geometries(in_plane));
    bencher
        .counter(ItemsCount::new(POINTS))
        .bench_local(|| (0..scene.len()).map(|point| scene.dolp(black_box(&surface), point)).sum::<f64>());
}

fn gradient(bencher: Bencher, scene: &GeometrySet, wanted: GradientRequest) {
    let surface = full();
    bencher.counter(ItemsCount::new(POINTS)).bench_local(|| {
        scene
            .reflections_and_gradients(black_box(&surface), wanted)
            .map(|at| at.1.dolp[Parameter::Sigma] + at.1.brdf[Parameter::Sigma])
            .sum::<f64>()
    });
}

/// Budget: a quarter of `everything`.
#[divan::bench]
fn dolp_of_the_specular_lobe_in_plane(bencher: Bencher) {
    dolp(bencher, surface(Diffuse::Absent, false, SlopeDistribution::Cauchy), true);
}

/// Budget: twice Cauchy: there is no q, but a Gaussian tail is soon so dark that its exponent has to be carried to twice the digits.
#[divan::bench]
fn dolp_of_all_terms_gauss(bencher: Bencher) {
    dolp(bencher, surface(Diffuse::Minnaert, true, SlopeDistribution::Gauss), false);
}

/// Budget: less than with derivatives.
#[divan::bench]
fn dolp_of_all_terms(bencher: Bencher) {
    dolp(bencher, full(), false);
}

/// Budget: less than with n and k free.
#[divan::bench]
fn derivatives_with_n_and_k_held(bencher: Bencher) {
    let p = Parameters::default();
    let scene = GeometrySet::new(geometries(false)).with_index(RefractiveIndex::new(p.n, p.k).expect("an index"));
    let by = ParameterSet::ALL.without(Parameter::N).without(Parameter::K);
    gradient(bencher, &scene, GradientRequest { by, brdf: false, dolp: true });
}

/// Budget: less than with those of the BRDF.
#[divan::bench]
fn derivatives_of_dolp(bencher: Bencher) {
    gradient(bencher, &GeometrySet::new(geometries(false)), GradientRequest { by: ParameterSet::ALL, brdf: false, dolp: true });
}

/// The whole: all derivatives and the Mueller matrix. Budget: four times the specular lobe in plane, or more, since that leaves nearly all of it out.
#[divan::bench]
fn everything(bencher: Bencher) {
    let scene = GeometrySet::new(geometries(false));
    let surface = full();
    bencher.counter(ItemsCount::new(POINTS)).bench_local(|| {
        let gradients = scene.reflections_and_gradients(black_box(&surface), GradientRequest::ALL).map(|at| at.1.dolp[Parameter::Sigma]);
        let matrices = scene.facets().iter().map(|facet| surface.mueller(facet.geometry).element(1, 2));
        gradients.zip(matrices).map(|(a, b)| a + b).sum::<f64>()
    });
}

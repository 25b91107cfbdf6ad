//! How many points per second does the batch kernel evaluate?
//!
//! Budgets, on one core of an AVX2 machine: 100 million points a second for DoLP of the full nine-parameter model, 12 million with all
//! nine derivatives. `cargo bench --no-default-features --features threads --bench batch`
#![allow(clippy::expect_used, reason = "a bench fails by panicking")]

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use pbrdf::fit::{Bounds, FitOptions, Landscape, LandscapeAxis, Problem};
use pbrdf::measurement::{Columns, Simulation};
use pbrdf::model::{Batch, Diffuse, DolpGradients, Hemisphere, Instructions, Model, Parameter, ParameterSet, Parameters, Pbrdf, Radiances};
use pbrdf::optics::{Geometry, SlopeDistribution};

/// A hemisphere map of 256² directions.
const POINTS: u32 = 1 << 16;

fn main() {
    divan::main();
}

fn batch(count: u32) -> Batch {
    Batch::new((0..count).map(|i| {
        let spread = |step: f64| (f64::from(i) * step).fract();
        Geometry::new(85.0 * spread(0.618_034), 85.0 * spread(0.754_878), 360.0 * spread(0.569_84)).expect("angles in range")
    }))
}

fn surface(distribution: SlopeDistribution) -> Pbrdf {
    Pbrdf::new(Model::full(distribution), Parameters::default()).expect("the defaults")
}

/// Budget: 100 million a second with AVX2.
#[divan::bench(args = [Instructions::Widest, Instructions::Avx2, Instructions::Portable])]
fn dolp_of_the_full_cauchy_model(bencher: Bencher, instructions: Instructions) {
    let batch = batch(POINTS).single_threaded().with_instructions(instructions);
    let (surface, mut out) = (surface(SlopeDistribution::Cauchy), Vec::new());
    bencher.counter(ItemsCount::new(POINTS)).bench_local(|| batch.dolp(black_box(&surface), &mut out));
}

/// Budget: less than Cauchy.
#[divan::bench]
fn dolp_of_the_full_gauss_model(bencher: Bencher) {
    let batch = batch(POINTS).single_threaded();
    let (surface, mut out) = (surface(SlopeDistribution::Gauss), Vec::new());
    bencher.counter(ItemsCount::new(POINTS)).bench_local(|| batch.dolp(black_box(&surface), &mut out));
}

/// Budget: a quarter of the full model.
#[divan::bench]
fn dolp_of_the_specular_lobe_alone(bencher: Bencher) {
    let batch = batch(POINTS).single_threaded();
    let model = Model { diffuse: Diffuse::Absent, volume: false, ..Model::full(SlopeDistribution::Cauchy) };
    let (surface, mut out) = (Pbrdf::new(model, Parameters::default()).expect("the defaults"), Vec::new());
    bencher.counter(ItemsCount::new(POINTS)).bench_local(|| batch.dolp(black_box(&surface), &mut out));
}

/// Budget: 60 million a second.
#[divan::bench]
fn dolp_and_brdf_of_the_full_cauchy_model(bencher: Bencher) {
    let batch = batch(POINTS).single_threaded();
    let (surface, mut out) = (surface(SlopeDistribution::Cauchy), Radiances::default());
    bencher.counter(ItemsCount::new(POINTS)).bench_local(|| batch.radiances(black_box(&surface), &mut out));
}

/// Budget: 12 million a second.
#[divan::bench(args = [Instructions::Widest, Instructions::Avx2, Instructions::Portable])]
fn dolp_and_its_nine_derivatives(bencher: Bencher, instructions: Instructions) {
    let batch = batch(POINTS).single_threaded().with_instructions(instructions);
    let (surface, mut out) = (surface(SlopeDistribution::Cauchy), DolpGradients::default());
    bencher.counter(ItemsCount::new(POINTS)).bench_local(|| batch.dolp_gradients(black_box(&surface), &mut out));
}

/// Budget: twice one core on two.
#[divan::bench]
fn dolp_on_all_cores(bencher: Bencher) {
    let batch = batch(16 * POINTS);
    let (surface, mut out) = (surface(SlopeDistribution::Cauchy), Vec::new());
    bencher.counter(ItemsCount::new(16 * POINTS)).bench_local(|| batch.dolp(black_box(&surface), &mut out));
}

/// Budget: 5 ms on two cores for 256 × 256 nodes and 27 points.
#[divan::bench]
fn landscape_over_two_parameters(bencher: Bencher) {
    let surface = surface(SlopeDistribution::Cauchy);
    let simulation = Simulation {
        model_name: "cauchy".to_owned(),
        surface,
        theta_i: vec![30.0, 40.0, 50.0],
        theta_r: (4..13).map(|i| 5.0 * f64::from(i)).collect(),
        dphi: 180.0,
        columns: Columns::Dolp,
        noise: 0.0,
        brdf_noise: 0.0,
        seed: 1,
    };
    let measurement = simulation.run().expect("valid angles");
    let (start, choices) = (Parameters::default(), FitOptions::default());
    let problem = Problem::new(&measurement, surface.model(), start, ParameterSet::ALL, Bounds::default(), choices).expect("a problem");
    let axis = |parameter, low, high| LandscapeAxis { parameter, low, high, count: 256, logarithmic: false };
    let (across, up) = (axis(Parameter::N, 0.5, 6.0), axis(Parameter::K, 0.5, 8.0));
    bencher.bench_local(|| Landscape::new(black_box(&problem), across, up, &|| false));
}

/// Budget: a frame of 60 Hz, 16 ms, for a map of 256² directions after a slider has moved.
#[divan::bench]
fn hemisphere_map_of_another_surface(bencher: Bencher) {
    let hemisphere = Hemisphere::new(45.0, 256, &|| false).expect("an angle").expect("not cancelled");
    let surface = surface(SlopeDistribution::Cauchy);
    bencher.bench_local(|| hemisphere.map(black_box(&surface), &|| false));
}

/// Budget: 40 ms for another angle of incidence.
#[divan::bench]
fn hemisphere_prepared(bencher: Bencher) {
    bencher.bench_local(|| Hemisphere::new(black_box(45.0), 256, &|| false));
}

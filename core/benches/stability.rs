//! How long does the stability gallery take, and what do its stiff places cost?
//!
//! Budgets: the whole gallery, evaluations and fits, below 5 s on two cores; a gradient where the specular and the volume term underflow
//! below 10 µs. `cargo bench --no-default-features --features threads --bench stability`.
//! Whether every case passes is a test: `pbrdf-explorer report stability` shows the digits.
#![allow(clippy::expect_used, reason = "a bench fails by panicking")]

use divan::{Bencher, black_box};
use pbrdf::model::{GradientRequest, Model, Parameters, Pbrdf};
use pbrdf::optics::{Facet, Geometry, SlopeDistribution};
use pbrdf::selftest::{Host, Machine, Stability};

fn main() {
    divan::main();
}

/// Budget: 5 s on two cores.
#[divan::bench(sample_count = 5, sample_size = 1)]
fn the_whole_gallery(bencher: Bencher) {
    let surroundings = Host { clock: &|| 0.0, cancelled: &|| false, progress: &|_| {} };
    bencher.bench_local(|| Stability::run(Machine::new("", 1), String::new(), black_box(surroundings)));
}

fn gradient(bencher: Bencher, parameters: Parameters, geometry: (f64, f64, f64)) {
    let surface = Pbrdf::new(Model::full(SlopeDistribution::Gauss), parameters).expect("parameters in the domain");
    let facet = Facet::new(Geometry::new(geometry.0, geometry.1, geometry.2).expect("angles in range"));
    bencher.bench_local(|| black_box(&surface).reflection_and_gradient(black_box(&facet), GradientRequest::ALL));
}

/// The yardstick of the two below: less than 1 µs.
#[divan::bench]
fn gradient_on_ordinary_ground(bencher: Bencher) {
    gradient(bencher, Parameters::default(), (40.0, 55.0, 120.0));
}

/// Budget: as on ordinary ground.
#[divan::bench]
fn gradient_at_grazing_angles(bencher: Bencher) {
    gradient(bencher, Parameters::default(), (90.0 - 1e-6, 90.0 - 1e-6, 120.0));
}

/// Budget: 10 µs, since exponents are carried to twice the digits.
#[divan::bench]
fn gradient_where_terms_underflow(bencher: Bencher) {
    gradient(bencher, Parameters { sigma: 0.01, sigma_v: 0.02, kd: 0.0, ..Parameters::default() }, (40.0, 75.0, 180.0));
}

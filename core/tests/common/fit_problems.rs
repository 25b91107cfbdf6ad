//! Simulated problems of fitting: four layouts of angles, three levels of noise, two distributions, many surfaces.
#![allow(clippy::expect_used, reason = "a test fails by panicking")]
#![allow(dead_code, reason = "each test file uses its own part of this module")]

use pbrdf::fit::{Bounds, FitOptions, Problem, free_by_default};
use pbrdf::measurement::{Columns, Measurement, Simulation};
use pbrdf::model::{Model, Parameter, Parameters, Pbrdf};
use pbrdf::optics::SlopeDistribution;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// Which angles are measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layout {
    /// The paper's: θi 30, 40, 50°, θr 20…60° by 5°.
    Steel,
    /// θi 10…80° by 10°, θr 0…85° by 5°.
    Dense,
    /// One θi, θr 0…80° by 5°.
    Single,
    /// θi 30, 40, 50°, θr −60…60° by 10°.
    BothSides,
}

impl Layout {
    pub const ALL: [Self; 4] = [Self::Steel, Self::Dense, Self::Single, Self::BothSides];

    pub fn key(self) -> &'static str {
        match self {
            Self::Steel => "steel",
            Self::Dense => "dense",
            Self::Single => "single",
            Self::BothSides => "both",
        }
    }

    fn angles(self, single: f64) -> (Vec<f64>, Vec<f64>) {
        let grid = |from: i32, to: i32, step: usize| (from..=to).step_by(step).map(f64::from).collect::<Vec<f64>>();
        match self {
            Self::Steel => (grid(30, 50, 10), grid(20, 60, 5)),
            Self::Dense => (grid(10, 80, 10), grid(0, 85, 5)),
            Self::Single => (vec![single], grid(0, 80, 5)),
            Self::BothSides => (grid(30, 50, 10), grid(-60, 60, 10)),
        }
    }
}

pub const NOISES: [f64; 3] = [0.0, 0.002, 0.01];

/// A simulated problem and the surface behind it.
pub struct Case {
    pub name: String,
    pub layout: Layout,
    pub noise: f64,
    pub distribution: SlopeDistribution,
    pub truth: Parameters,
    pub measurement: Measurement,
}

impl Case {
    pub fn problem(&self) -> Problem {
        let model = Model::full(self.distribution);
        let free = free_by_default(model, &self.measurement, &FitOptions::default());
        Problem::new(&self.measurement, model, Parameters::default(), free, Bounds::default(), FitOptions::default())
            .expect("a valid problem")
    }
}

/// The set of that seed: `repeats` surfaces for each of the 24 combinations.
pub fn cases(seed: u64, repeats: u64) -> Vec<Case> {
    let mut random = Pcg64::seed_from_u64(seed);
    let mut cases = Vec::new();
    for repeat in 0..repeats {
        for layout in Layout::ALL {
            for noise in NOISES {
                for distribution in SlopeDistribution::ALL {
                    let truth = surface(&mut random, repeat % 2 == 1);
                    let single = 10.0 * (3.0 + (5.0 * uniform(&mut random)).floor());
                    let (theta_i, theta_r) = layout.angles(single);
                    let noise_seed = u64::from(random.next_u32());
                    let measurement = Simulation {
                        model_name: distribution.key().to_owned(),
                        surface: Pbrdf::new(Model::full(distribution), truth).expect("a valid surface"),
                        theta_i,
                        theta_r,
                        dphi: 180.0,
                        columns: Columns::Dolp,
                        noise,
                        brdf_noise: 0.0,
                        seed: noise_seed,
                    }
                    .run()
                    .expect("valid angles");
                    let name = format!("{seed}-{:03}-{}-{}-{noise}", cases.len(), layout.key(), distribution.key());
                    cases.push(Case { name, layout, noise, distribution, truth, measurement });
                }
            }
        }
    }
    cases
}

/// Which angles a BRDF is measured at, the noise of it being relative.
pub const BRDF_NOISES: [f64; 3] = [0.01, 0.02, 0.03];

/// Simulated problems of BRDF alone: one θi, near normal, both sides, random directions in the plane, out of the plane; `repeats` surfaces
/// for each layout, noise and distribution.
pub fn brdf_cases(seed: u64, repeats: u64) -> Vec<Case> {
    let mut random = Pcg64::seed_from_u64(seed);
    let mut cases = Vec::new();
    for repeat in 0..repeats {
        for layout in ["single", "normal", "both", "random", "out"] {
            for noise in BRDF_NOISES {
                for distribution in SlopeDistribution::ALL {
                    let truth = surface(&mut random, repeat % 2 == 1);
                    let (theta_i, theta_r, dphi) = brdf_angles(layout, &mut random);
                    let noise_seed = u64::from(random.next_u32());
                    let measurement = Simulation {
                        model_name: distribution.key().to_owned(),
                        surface: Pbrdf::new(Model::full(distribution), truth).expect("a valid surface"),
                        theta_i,
                        theta_r,
                        dphi,
                        columns: Columns::Brdf,
                        noise: 0.0,
                        brdf_noise: noise,
                        seed: noise_seed,
                    }
                    .run()
                    .expect("valid angles");
                    let name = format!("{seed}-{:03}-{layout}-{}-{noise}", cases.len(), distribution.key());
                    cases.push(Case { name, layout: Layout::Single, noise, distribution, truth, measurement });
                }
            }
        }
    }
    cases
}

fn brdf_angles(layout: &str, random: &mut Pcg64) -> (Vec<f64>, Vec<f64>, f64) {
    let grid = |from: i32, to: i32, step: usize| (from..=to).step_by(step).map(f64::from).collect::<Vec<f64>>();
    match layout {
        "single" => (vec![20.0 + 50.0 * uniform(random)], grid(0, 80, 5), 180.0),
        "normal" => (vec![0.0, 5.0, 10.0], grid(0, 60, 5), 180.0),
        "both" => (grid(20, 60, 20), grid(-70, 70, 10), 180.0),
        "random" => {
            let mut some = |count: usize| (0..count).map(|_| 80.0 * uniform(random)).collect::<Vec<f64>>();
            (some(4), some(10), 180.0)
        }
        _ => (grid(20, 60, 20), grid(0, 75, 5), 180.0 - 60.0 * uniform(random)),
    }
}

fn uniform(random: &mut Pcg64) -> f64 {
    f64::from(random.next_u32()) / 4_294_967_296.0
}

/// A metal of ordinary roughness, or (wild) anything in a large part of the box, edges included.
fn surface(random: &mut Pcg64, wild: bool) -> Parameters {
    let mut between = |low: f64, high: f64| low + (high - low) * uniform(random);
    let factor = |low: f64, high: f64, x: f64| low * libm::pow(high / low, x);
    let mut truth = if wild {
        Parameters {
            n: factor(0.05, 8.0, between(0.0, 1.0)),
            k: between(0.0, 10.0),
            sigma: factor(0.03, 1.5, between(0.0, 1.0)),
            ks: 1.0,
            kd: factor(0.003, 2.0, between(0.0, 1.0)),
            kv: factor(0.003, 2.0, between(0.0, 1.0)),
            q: 1.0 + factor(0.1, 12.0, between(0.0, 1.0)),
            c: between(-1.0, 0.0),
            sigma_v: factor(0.1, 2.0, between(0.0, 1.0)),
        }
    } else {
        Parameters {
            n: between(0.3, 4.0),
            k: between(1.0, 7.0),
            sigma: between(0.1, 0.8),
            ks: 1.0,
            kd: between(0.0, 0.5),
            kv: between(0.0, 0.5),
            q: between(1.3, 5.0),
            c: between(-0.9, -0.1),
            sigma_v: between(0.2, 1.2),
        }
    };
    if wild {
        // One in five lies on an edge of the box.
        match (10.0 * between(0.0, 1.0)).floor() {
            0.0 => truth[Parameter::Kd] = 0.0,
            1.0 => truth[Parameter::Kv] = 0.0,
            _ => {}
        }
    }
    truth
}

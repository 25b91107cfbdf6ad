//! A fit of simulated DoLP and BRDF: estimates beside the truth, and what the data leave undetermined.

#![expect(clippy::print_stdout, reason = "an example prints its results")]

use pbrdf::fit::Weights;
use pbrdf::measurement::{Columns, Simulation};
use pbrdf::{Fit, Model, Parameter, Parameters, Pbrdf};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let truth = Parameters { n: 2.07, k: 2.9, sigma: 0.2, ..Parameters::default() };
    let simulation = Simulation {
        model_name: "cauchy".to_owned(),
        surface: Pbrdf::new(Model::CAUCHY, truth)?,
        theta_i: vec![20.0, 40.0, 60.0],
        theta_r: (0..16).map(|i| f64::from(5 * i)).collect(),
        dphi: 180.0,
        columns: Columns::Both,
        noise: 0.005,
        brdf_noise: 0.02,
        seed: 1,
    };
    let data = simulation.run()?;
    let result = Fit::new(&data, Model::CAUCHY).bound(Parameter::N, 0.1..=5.0).weights(Weights::Sigma).run()?;
    println!("{} (ΔE = {:.3e})", result.stop_reason, result.objective.unwrap_or(f64::NAN));
    for estimate in &result.estimates {
        println!("{:>4} = {estimate} (truth {})", estimate.parameter.symbol(), truth[estimate.parameter]);
    }
    result.undetermined().for_each(|direction| println!("{direction}"));
    Ok(())
}

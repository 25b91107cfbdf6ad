//! The profile likelihood of n beside its linear standard error and the bootstrap's.

#![expect(clippy::print_stdout, reason = "an example prints its results")]

use pbrdf::fit::{Observer, Starts, bootstrap, profile};
use pbrdf::measurement::{Columns, Simulation};
use pbrdf::{Fit, Model, Parameter, Parameters, Pbrdf};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let simulation = Simulation {
        model_name: "specular".to_owned(),
        surface: Pbrdf::new(Model::SPECULAR, Parameters::default())?,
        theta_i: vec![30.0, 60.0, 75.0],
        theta_r: (2..16).map(|i| f64::from(5 * i)).collect(),
        dphi: 180.0,
        columns: Columns::Dolp,
        noise: 0.005,
        brdf_noise: 0.0,
        seed: 1,
    };
    let data = simulation.run()?;
    let fit = Fit::new(&data, Model::SPECULAR).starts(Starts::One);
    let (problem, result) = (fit.problem()?, fit.run()?);
    println!("n = {}", result[Parameter::N]);
    let scan = profile(&problem, &result, Parameter::N, Observer::NONE);
    println!("profile: {:?} to {:?}", scan.interval68.low, scan.interval68.high);
    for point in &scan.points {
        println!("{:>10.5} {:.6e}", point.value, point.rss);
    }
    for estimate in bootstrap(&problem, &result, 100, 1, Observer::NONE).estimates {
        println!("bootstrap of {}: standard error {:.5}", estimate.parameter.symbol(), estimate.std_error);
    }
    Ok(())
}

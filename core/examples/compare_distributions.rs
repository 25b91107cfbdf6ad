//! Gauss against Cauchy on data of a Cauchy surface: which distribution of slopes describes them better, and by how much.

#![expect(clippy::print_stdout, reason = "an example prints its results")]

use pbrdf::fit::DistributionComparison;
use pbrdf::measurement::{Columns, Simulation};
use pbrdf::{Fit, Model, Parameters, Pbrdf};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let simulation = Simulation {
        model_name: "cauchy".to_owned(),
        surface: Pbrdf::new(Model::CAUCHY, Parameters { q: 1.5, ..Parameters::default() })?,
        theta_i: vec![30.0, 60.0],
        theta_r: (0..16).map(|i| f64::from(5 * i)).collect(),
        dphi: 180.0,
        columns: Columns::Dolp,
        noise: 0.003,
        brdf_noise: 0.0,
        seed: 1,
    };
    let data = simulation.run()?;
    let gauss = Fit::new(&data, Model::GAUSS).run()?;
    let cauchy = Fit::new(&data, Model::CAUCHY).run()?;
    if let Some(comparison) = DistributionComparison::new(&gauss, &cauchy) {
        println!("{comparison}");
    }
    // The results as JSON, to every digit.
    println!("{}", serde_json::to_string_pretty(&[gauss, cauchy])?);
    Ok(())
}

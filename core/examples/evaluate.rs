//! DoLP and BRDF of a surface in the plane of incidence, with the Fresnel limit that DoLP cannot exceed.

#![expect(clippy::print_stdout, reason = "an example prints its results")]

use pbrdf::optics::Facet;
use pbrdf::{Geometry, Model, Parameters, Pbrdf};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let surface = Pbrdf::new(Model::CAUCHY, Parameters { n: 2.07, k: 2.9, sigma: 0.2, ..Parameters::default() })?;
    println!("{:>7} {:>10} {:>8} {:>8}", "theta_r", "BRDF /sr", "DoLP", "limit");
    for theta_r in (-80..=80).step_by(20) {
        let facet = Facet::new(Geometry::in_plane(60.0, f64::from(theta_r))?);
        let reflection = surface.reflection(&facet);
        println!("{theta_r:>7} {:>10.4} {:>8.4} {:>8.4}", reflection.brdf, reflection.dolp, surface.fresnel_limit(&facet));
    }
    Ok(())
}

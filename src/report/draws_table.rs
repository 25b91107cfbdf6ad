//! Draws from a posterior as a table.

use pbrdf::fit::UnknownName;
use pbrdf::fit::posterior::PosteriorSample;
use std::io::{self, Write};

/// One row per draw: the free parameters, the logarithm of likelihood and priors, the number of the chain.
///
/// # Errors
///
/// The table cannot be written.
pub fn write_draws<N: UnknownName, P>(out: &mut dyn Write, sample: &PosteriorSample<N, P>) -> io::Result<()> {
    for parameter in &sample.parameters {
        write!(out, "{},", parameter.key())?;
    }
    writeln!(out, "log_posterior,chain")?;
    for (chain, draws) in sample.chains.iter().enumerate() {
        for draw in draws {
            draw.unknowns.iter().try_for_each(|value| write!(out, "{value},"))?;
            writeln!(out, "{},{chain}", draw.log_posterior)?;
        }
    }
    Ok(())
}

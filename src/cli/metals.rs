//! `metals`: tabulated refractive indices, source by source.

use crate::cli::arguments::MetalsArguments;
use crate::cli::failure::Failure;
use crate::cli::output;
use pbrdf::optics;
use pbrdf::optics::{Metal, MetalSource, RefractiveIndex};
use serde_json::{Value, json};
use std::io::{self, Write};
use std::process::ExitCode;

pub fn run(arguments: &MetalsArguments) -> Result<ExitCode, Failure> {
    let damaged = |error| Failure::usage(format!("The bundled table of metals is damaged: {error}."));
    let all = optics::metals().map_err(damaged)?;
    let chosen: Vec<&Metal> = match &arguments.name {
        None => all.iter().collect(),
        Some(name) => vec![optics::metal(name).map_err(damaged)?.ok_or_else(|| unknown(name, all))?],
    };
    if let ([metal], Some(wavelength)) = (&chosen[..], arguments.wavelength) {
        refuse_outside(metal, wavelength)?;
    }
    if arguments.json {
        let rows: Vec<Value> =
            chosen.iter().flat_map(|metal| metal.sources.iter().map(|source| row(metal, source, arguments.wavelength))).collect();
        output::write_json(&json!({ "wavelength_nm": arguments.wavelength, "rows": rows }))?;
    } else if let ([metal], Some(_)) = (&chosen[..], &arguments.name) {
        output::write(None, |out| print_sources(out, metal, arguments.wavelength))?;
    } else {
        output::write(None, |out| print_metals(out, &chosen, arguments.wavelength))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn unknown(name: &str, all: &[Metal]) -> Failure {
    let keys: Vec<&str> = all.iter().map(|metal| metal.key.as_str()).collect();
    Failure::usage(format!("{name:?} is not among the tabulated metals; expected one of {}.", keys.join(", ")))
}

/// Refuses a wavelength outside the tables of all sources of a metal.
fn refuse_outside(metal: &Metal, wavelength: f64) -> Result<(), Failure> {
    if metal.sources.iter().any(|source| source.index_at(wavelength).is_ok()) {
        return Ok(());
    }
    let (low, high) = metal.range_nm();
    Err(Failure::usage(format!("No source of {} has {wavelength} nm: they span {low} to {high} nm.", metal.name)))
}

fn index_at(source: &MetalSource, wavelength: Option<f64>) -> Option<RefractiveIndex> {
    source.index_at(wavelength?).ok()
}

fn row(metal: &Metal, source: &MetalSource, wavelength: Option<f64>) -> Value {
    let (from, to) = source.range_nm();
    let index = index_at(source, wavelength);
    json!({
        "metal": metal.key,
        "name": metal.name,
        "source": source.key,
        "authors": source.name,
        "citation": source.citation,
        "comment": source.comment,
        "from_nm": from,
        "to_nm": to,
        "n": index.map(RefractiveIndex::n),
        "k": index.map(RefractiveIndex::k_m),
    })
}

/// A line per metal: how many sources, and between which values they lie.
fn print_metals(out: &mut dyn Write, metals: &[&Metal], wavelength: Option<f64>) -> io::Result<()> {
    write!(out, "{:<16} {:<16} {:>7} {:>15}", "metal", "name", "sources", "nm")?;
    if let Some(wavelength) = wavelength {
        write!(out, "  n and k at {wavelength} nm, from lowest to highest source")?;
    }
    writeln!(out)?;
    for metal in metals {
        let (low, high) = metal.range_nm();
        write!(out, "{:<16} {:<16} {:>7} {:>15}", metal.key, metal.name, metal.sources.len(), format!("{low:.0}-{high:.0}"))?;
        if wavelength.is_some() {
            let found: Vec<RefractiveIndex> = metal.sources.iter().filter_map(|source| index_at(source, wavelength)).collect();
            let span = |of: fn(RefractiveIndex) -> f64| {
                let values = found.iter().map(|&index| of(index));
                let (low, high) = values.fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), value| (low.min(value), high.max(value)));
                format!("{low:.3} to {high:.3}")
            };
            if found.is_empty() {
                write!(out, "  outside the tabulated range")?;
            } else {
                write!(out, "  n {}, k {}", span(RefractiveIndex::n), span(RefractiveIndex::k_m))?;
            }
        }
        writeln!(out)?;
    }
    writeln!(out, "From refractiveindex.info (CC0). The sources of one metal and their citations: pbrdf-explorer metals Cu")
}

/// The sources of one metal, side by side, with their citations underneath.
fn print_sources(out: &mut dyn Write, metal: &Metal, wavelength: Option<f64>) -> io::Result<()> {
    match wavelength {
        Some(wavelength) => writeln!(out, "{} at {wavelength} nm", metal.name)?,
        None => writeln!(out, "{}", metal.name)?,
    }
    let width = metal.sources.iter().map(|source| source.key.len()).max().unwrap_or(0);
    for source in &metal.sources {
        let (low, high) = source.range_nm();
        let range = format!("{low:.0}-{high:.0} nm");
        let value = match (wavelength, index_at(source, wavelength)) {
            (_, Some(index)) => format!("  n = {:.4}  k = {:.4}", index.n(), index.k_m()),
            (Some(_), None) => "  outside the tabulated range".to_owned(),
            (None, None) => String::new(),
        };
        writeln!(out, "  {:<width$}  {range:>13}{value}", source.key)?;
    }
    writeln!(out, "Sources, from refractiveindex.info (CC0):")?;
    for source in &metal.sources {
        let comment = if source.comment.is_empty() { String::new() } else { format!(" [{}]", source.comment) };
        writeln!(out, "  {:<width$}  {}{comment}", source.key, source.citation)?;
    }
    Ok(())
}

//! `evaluate`: the model, one row of parameters and angles after the other.

use crate::cli::arguments::EvaluateArguments;
use crate::cli::failure::Failure;
use crate::cli::{input, interrupt, output};
use pbrdf::measurement::{Expected, ReadError, ReadErrorKind, Record, Table, quote};
use pbrdf::model::{GradientRequest, Model, Parameter, ParameterError, Parameters, Pbrdf, PerParameter};
use pbrdf::optics::{Facet, Geometry, GeometryError, SlopeDistribution, shortest};
use std::io::{self, Write};
use std::process::ExitCode;

/// Which column holds what.
struct Layout {
    distribution: usize,
    parameters: PerParameter<Option<usize>>,
    theta_i: usize,
    theta_r: usize,
    dphi: Option<usize>,
}

pub fn run(arguments: &EvaluateArguments) -> Result<ExitCode, Failure> {
    interrupt::watch();
    let bytes = input::bytes(&arguments.input)?;
    let rows = read(&bytes).map_err(|error| input::read_failure(&arguments.input, &error))?;
    let mut progress = output::Progress::new("evaluating");
    output::write(arguments.output.as_deref(), |out| {
        writeln!(out, "{}", header(arguments).join(","))?;
        let mut line = Vec::new();
        for (i, (surface, geometry)) in rows.iter().enumerate() {
            line.clear();
            evaluate(arguments, surface, *geometry, &mut line)?;
            out.write_all(&line)?;
            if i % 4096 == 0 {
                #[expect(clippy::cast_precision_loss, reason = "a fraction for a progress line")]
                progress.tell_fraction(i as f64 / rows.len() as f64);
                if interrupt::asked() {
                    return Err(io::ErrorKind::Interrupted.into());
                }
            }
        }
        Ok(())
    })
    .map_err(|failure| if interrupt::asked() { Failure::interrupted() } else { failure })?;
    Ok(ExitCode::SUCCESS)
}

fn header(arguments: &EvaluateArguments) -> Vec<String> {
    let mut names: Vec<String> = ["brdf", "dolp", "specular", "diffuse", "volume"].map(str::to_owned).into();
    if arguments.mueller {
        names.extend((0..16).map(|i| format!("m{}{}", i / 4, i % 4)));
    }
    if arguments.gradient {
        for quantity in ["brdf", "dolp"] {
            names.extend(Parameter::ALL.map(|parameter| format!("d{quantity}_d{}", parameter.key())));
        }
    }
    names
}

fn evaluate(arguments: &EvaluateArguments, surface: &Pbrdf, geometry: Geometry, line: &mut Vec<u8>) -> io::Result<()> {
    let facet = Facet::new(geometry);
    let (reflection, gradient) = if arguments.gradient {
        let (reflection, gradient) = surface.reflection_and_gradient(&facet, GradientRequest::ALL);
        (reflection, Some(gradient))
    } else {
        (surface.reflection(&facet), None)
    };
    let mut numbers = vec![reflection.brdf, reflection.dolp, reflection.specular, reflection.diffuse, reflection.volume];
    if arguments.mueller {
        let mueller = surface.mueller(geometry);
        numbers.extend((0..16).map(|i| mueller.element(i / 4, i % 4)));
    }
    if let Some(gradient) = gradient {
        numbers.extend(gradient.brdf);
        numbers.extend(gradient.dolp);
    }
    for (i, number) in numbers.into_iter().enumerate() {
        write!(line, "{}{}", if i == 0 { "" } else { "," }, shortest(number))?;
    }
    writeln!(line)
}

/// Reads and checks all rows; output begins after the last one.
fn read(bytes: &[u8]) -> Result<Vec<(Pbrdf, Geometry)>, ReadError> {
    let table = Table::new(bytes)?;
    let layout = Layout::new(&table)?;
    let mut rows = Vec::new();
    table.for_each(&mut input::while_reading(), |record| {
        rows.push((layout.surface(record)?, layout.geometry(record)?));
        Ok(())
    })?;
    Ok(rows)
}

impl Layout {
    fn new(table: &Table) -> Result<Self, ReadError> {
        let mut parameters = PerParameter::default();
        for parameter in Parameter::ALL {
            // A table of Gauss rows needs no q.
            parameters[parameter] =
                if parameter == Parameter::Q { table.find(parameter.key())? } else { Some(table.require(parameter.key())?) };
        }
        Ok(Self {
            distribution: table.require("distribution")?,
            parameters,
            theta_i: table.require("theta_i")?,
            theta_r: table.require("theta_r")?,
            dphi: table.find("dphi")?,
        })
    }

    fn surface(&self, record: &Record<'_>) -> Result<Pbrdf, ReadError> {
        let name = record.text(self.distribution);
        let distribution = SlopeDistribution::from_key(&name).ok_or_else(|| {
            record.error(self.distribution, ReadErrorKind::NotANumber { found: quote(&name), expected: Expected::Distribution })
        })?;
        let model = Model::full(distribution);
        let mut parameters = Parameters::default();
        for parameter in model.parameters() {
            let column =
                self.parameters[parameter].ok_or_else(|| record.row_error(ReadErrorKind::MissingColumn { name: "q", similar: None }))?;
            parameters[parameter] = record.number(column, Expected::FiniteNumber)?;
        }
        Pbrdf::new(model, parameters).map_err(|error| {
            let column = self.parameters[error.parameter()].unwrap_or(self.distribution);
            match error {
                ParameterError::Outside { parameter, .. } => record.out_of_range(column, Expected::Parameter(parameter.domain())),
                ParameterError::NoIndex => record.out_of_range(column, Expected::Index),
            }
        })
    }

    fn geometry(&self, record: &Record<'_>) -> Result<Geometry, ReadError> {
        let theta_i = record.number(self.theta_i, Expected::Angle)?;
        let theta_r = record.number(self.theta_r, Expected::Angle)?;
        let dphi = self.dphi.map_or(Ok(180.0), |column| record.number(column, Expected::Angle))?;
        Geometry::new(theta_i, theta_r, dphi).map_err(|error| match error {
            GeometryError::ThetaI(_) => record.out_of_range(self.theta_i, Expected::ModelThetaI),
            _ => record.out_of_range(self.theta_r, Expected::ModelThetaR),
        })
    }
}

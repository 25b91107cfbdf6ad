//! Fits of several models on the same points: a panel for each measurement, as Fig. 5 of the paper has it.

use crate::figure::{Axis, Dash, Figure, Panel, SERIES, Series};
use crate::report::curves::{CurvePoint, curve};
use crate::report::fit_figures::{MOST_SERIES, highest_of, measured_series, points, top};
use pbrdf::measurement::{DataPoint, IncidenceSeries, Measurement};
use pbrdf::model::{Model, Parameters, Pbrdf, Preset};

/// A measurement with the surfaces that models were fitted to it.
#[derive(Debug, Clone)]
pub struct ComparedMeasurement<'a> {
    /// What it is called.
    pub name: String,
    /// The data.
    pub measurement: &'a Measurement,
    /// Models as they were fitted, the simplest first.
    pub models: Vec<(&'static Preset, Model, Parameters)>,
}

/// Lines of models, from the last one backwards: the last is solid.
const DASHES: [Dash; 4] = [Dash::Solid, Dash::Dashed, Dash::Sparse, Dash::Dotted];
/// Panels side by side, at most.
const MOST_COLUMNS: usize = 3;

/// The figure; none where no row has a value that a model predicts. Models beyond the last four are left out: more lines cannot be told
/// apart.
#[must_use]
pub fn comparison_figure(measurements: &[ComparedMeasurement<'_>]) -> Option<Figure> {
    let figures: Vec<Figure> = measurements.iter().filter_map(of_measurement).collect();
    let columns = if figures.len() == 4 { 2 } else { MOST_COLUMNS };
    (!figures.is_empty()).then(|| Figure::sheet("", figures, columns))
}

/// Name of a measured quantity, its unit, its points, its value on a curve.
type Quantity = (&'static str, &'static str, fn(&IncidenceSeries) -> &[DataPoint], fn(&CurvePoint) -> f64);

fn of_measurement(of: &ComparedMeasurement<'_>) -> Option<Figure> {
    let series = IncidenceSeries::of(&of.measurement.rows);
    let series = &series[..series.len().min(MOST_SERIES)];
    let quantities: [Quantity; 2] = [
        ("DoLP", "", |group| &group.dolp, |point| point.reflection.dolp),
        ("BRDF", "sr⁻¹", |group| &group.brdf, |point| point.reflection.brdf),
    ];
    let is_measured = |(_, _, marks, _): &&Quantity| series.iter().any(|group| !marks(group).is_empty());
    let &(name, unit, marks, value) = quantities.iter().find(is_measured)?;
    let simulated = of.measurement.metadata("simulated") == Some("true") && !of.name.contains("simulated");
    let title = if simulated { format!("{} (simulated)", of.name) } else { of.name.clone() };
    let backscatter = series.iter().any(IncidenceSeries::has_backscatter);
    let mut highest = series.iter().flat_map(marks).map(top).fold(0.0, f64::max);
    let mut drawn: Vec<Series> = Vec::new();
    let lines: Vec<_> = of.models.iter().rev().zip(DASHES).collect();
    for &((preset, model, parameters), dash) in lines.iter().rev() {
        let Ok(surface) = Pbrdf::new(*model, *parameters) else { continue };
        for (group, color) in series.iter().zip(SERIES).filter(|(group, _)| !marks(group).is_empty()) {
            let curve = curve(&surface, group, backscatter);
            highest = highest.max(highest_of(&curve, value));
            let width = if dash == Dash::Solid { 1.2 } else { 0.9 };
            drawn.push(Series::stroke(preset.name, points(&curve, value), width, dash).colored(color));
        }
    }
    for (group, color) in series.iter().zip(SERIES).filter(|(group, _)| !marks(group).is_empty()) {
        drawn.extend(measured_series(group, marks(group), color));
    }
    let x = Axis::linear("θr", "°").between(if backscatter { -90.0 } else { 0.0 }, 90.0);
    let panel = Panel { x, y: Axis::linear(name, unit).between(0.0, 1.05 * highest), series: drawn, ..Panel::default() };
    Some(Figure { title, panels: vec![panel], ..Figure::default() })
}

#[cfg(test)]
mod tests {
    use super::{ComparedMeasurement, comparison_figure};
    use crate::figure::{Dash, Mark};
    use pbrdf::measurement::Measurement;
    use pbrdf::model::{Parameters, Preset};

    #[test]
    fn the_last_model_is_solid_and_the_one_before_it_dashed() {
        let text = "# simulated: true\ntheta_i,theta_r,dolp\n30,20,0.1\n30,40,0.2\n50,40,0.3\n";
        let measurement = Measurement::read(text.as_bytes()).expect("a measurement");
        let models = ["fresnel", "cauchy"].map(|key| Preset::from_key(key).expect("a preset"));
        let models = models.map(|preset| (preset, preset.model, Parameters::default())).to_vec();
        let of = |name: &str| ComparedMeasurement { name: name.to_owned(), measurement: &measurement, models: models.clone() };
        let sheet = comparison_figure(&[of("copper"), of("aluminium")]).expect("a figure");
        let titles: Vec<&str> = sheet.figures.iter().map(|figure| figure.title.as_str()).collect();
        assert_eq!(titles, ["copper (simulated)", "aluminium (simulated)"]);
        let lines = sheet.figures[0].panels[0].series.iter().filter_map(|series| match &series.mark {
            Mark::Line { dash, .. } => Some((series.name.as_str(), *dash)),
            _ => None,
        });
        let [solid, dashed] = [models[1].0.name, models[0].0.name];
        let expected = [(dashed, Dash::Dashed), (dashed, Dash::Dashed), (solid, Dash::Solid), (solid, Dash::Solid)];
        assert_eq!(lines.collect::<Vec<_>>(), expected);
        let empty = Measurement::default();
        let nothing = ComparedMeasurement { name: String::new(), measurement: &empty, models };
        assert_eq!(comparison_figure(&[nothing]), None);
    }
}

//! An axis of a panel.

/// An axis.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Axis {
    /// What is along it.
    pub label: String,
    /// Its unit; empty for a pure number.
    pub unit: String,
    /// How it is divided.
    pub scale: Scale,
    /// Its ends; what is drawn decides without, and where they are of no use.
    pub range: Option<(f64, f64)>,
    /// Its own marks, such as names of categories, instead of round numbers.
    pub ticks: Option<Vec<(f64, String)>>,
}

impl Axis {
    /// A linear axis.
    pub fn linear(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { label: label.into(), unit: unit.into(), ..Self::default() }
    }

    /// A logarithmic axis.
    pub fn log(label: impl Into<String>, unit: impl Into<String>) -> Self {
        Self { scale: Scale::Log, ..Self::linear(label, unit) }
    }

    /// With those ends.
    #[must_use]
    pub fn between(self, low: f64, high: f64) -> Self {
        Self { range: Some((low, high)), ..self }
    }

    /// With names at 0, 1, 2 …, half a step free at either end.
    pub fn categories(label: impl Into<String>, names: impl IntoIterator<Item = String>) -> Self {
        let ticks: Vec<(f64, String)> = (0_u32..).map(f64::from).zip(names).collect();
        let last = ticks.last().map_or(0.0, |(at, _)| *at);
        Self { range: Some((-0.5, last + 0.5)), ticks: Some(ticks), ..Self::linear(label, "") }
    }

    /// With label and ticks replaced by what `translate` makes of them.
    pub(crate) fn translated(&self, translate: &dyn Fn(&str) -> String) -> Self {
        let ticks = self.ticks.as_ref().map(|ticks| ticks.iter().map(|(at, name)| (*at, translate(name))).collect());
        Self { label: translate(&self.label), ticks, ..self.clone() }
    }

    /// Label and unit as they stand beside the axis.
    #[must_use]
    pub fn title(&self) -> String {
        with_unit(&self.label, &self.unit)
    }
}

/// A name and its unit as they stand beside numbers, `θr / °`; the name alone where there is no unit.
#[must_use]
pub fn with_unit(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name} / {unit}") }
}

/// How an axis is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// Evenly in the logarithm; marks at powers of ten.
    Log,
}

//! A figure in other words: the same curves under names of another language.

use crate::figure::{Axis, Drawn, Figure, Panel, Series};

impl Figure {
    /// With every text put through that function, equal ones alike.
    #[must_use]
    pub fn worded(&self, word: &dyn Fn(&str) -> String) -> Self {
        let panels = self.panels.iter().map(|panel| worded_panel(panel, word)).collect();
        Self { title: word(&self.title), panels, ..self.clone() }
    }
}

fn worded_panel(panel: &Panel, word: &dyn Fn(&str) -> String) -> Panel {
    let series = panel.series.iter().map(|series| worded_series(series, word)).collect();
    Panel { title: word(&panel.title), x: worded_axis(&panel.x, word), y: worded_axis(&panel.y, word), series, ..panel.clone() }
}

fn worded_axis(axis: &Axis, word: &dyn Fn(&str) -> String) -> Axis {
    let ticks = axis.ticks.as_ref().map(|ticks| ticks.iter().map(|(at, name)| (*at, word(name))).collect());
    Axis { label: word(&axis.label), ticks, ..axis.clone() }
}

fn worded_series(series: &Series, word: &dyn Fn(&str) -> String) -> Series {
    let mut series = Series { name: word(&series.name), ..series.clone() };
    match &mut series.drawn {
        Drawn::Labels(labels) => labels.iter_mut().for_each(|(_, text)| *text = word(text)),
        Drawn::HeatMap(map) => map.color_axis = worded_axis(&map.color_axis, word),
        _ => {}
    }
    series
}

//! A figure in another language: the same curves under other names.

use crate::figure::{Axis, Drawn, Figure, Panel, Series};

impl Figure {
    /// With every text replaced by what `translate` makes of it; series of one name keep one name.
    #[must_use]
    pub fn translate(&self, translate: &dyn Fn(&str) -> String) -> Self {
        let panels = self.panels.iter().map(|panel| translated_panel(panel, translate)).collect();
        Self { title: translate(&self.title), panels, ..self.clone() }
    }
}

fn translated_panel(panel: &Panel, translate: &dyn Fn(&str) -> String) -> Panel {
    let series = panel.series.iter().map(|series| translated_series(series, translate)).collect();
    Panel {
        title: translate(&panel.title),
        x: translated_axis(&panel.x, translate),
        y: translated_axis(&panel.y, translate),
        series,
        ..panel.clone()
    }
}

fn translated_axis(axis: &Axis, translate: &dyn Fn(&str) -> String) -> Axis {
    let ticks = axis.ticks.as_ref().map(|ticks| ticks.iter().map(|(at, name)| (*at, translate(name))).collect());
    Axis { label: translate(&axis.label), ticks, ..axis.clone() }
}

fn translated_series(series: &Series, translate: &dyn Fn(&str) -> String) -> Series {
    let mut series = Series { name: translate(&series.name), ..series.clone() };
    match &mut series.drawn {
        Drawn::Labels(labels) => labels.iter_mut().for_each(|(_, text)| *text = translate(text)),
        Drawn::HeatMap(map) => map.color_axis = translated_axis(&map.color_axis, translate),
        _ => {}
    }
    series
}

//! Facet densities and masking–shadowing for print.

use crate::app::panels::significant;
use crate::app::plots::Range;
use crate::app::plots::print::{FOREGROUND, over, points};
use crate::app::shell::app::App;
use crate::app::views::facets::name;
use crate::app::work::workspace::Workspace;
use crate::figure::{Axis, Dash, Drawn, Figure, Panel, SERIES, Series};
use pbrdf::optics::SlopeDistribution;
use tr::tr;

pub fn facets_figure(explorer: &App) -> Option<Figure> {
    let App { work: Workspace { settings, .. }, views, .. } = explorer;
    let view = &views.facets;
    let (densities, masking) = (view.densities.get()?, view.masking.get()?);
    let &(sigma, q, log, ..) = view.densities.key()?;
    let value = |y: f64| if log { libm::exp10(y) } else { y };
    let mut series = Vec::new();
    for ((distribution, density), color) in SlopeDistribution::ALL.into_iter().zip(densities).zip(SERIES) {
        let name = name(distribution);
        series.push(Series::line(tr!("{}: P", name), points(&density.p, value)).colored(color));
        series.push(Series::dashed(tr!("{}: D = P / cos α", name), points(&density.d, value), Dash::Dashed).colored(color));
        if let Some(half) = density.half_width {
            series
                .push(upright(tr!("half of P(0): {}°", format!("{half:.2}")), half, value, view.range.get(), Dash::Dotted).colored(color));
        }
        series.push(Series::upright(tr!("median: {}°", format!("{:.2}", density.median)), density.median).colored(color));
    }
    let y = if log { Axis::log("density", "sr⁻¹") } else { Axis::linear("density", "sr⁻¹") };
    let range = view.range.get().map(|range| Range { low: value(range.low), high: value(range.high) });
    let tilts = Panel {
        title: format!("σ = {}, q = {}", significant(sigma), significant(q)),
        x: over(Axis::linear("α", "°"), view.tilts.get()),
        y: over(y, range),
        series,
        height_share: 1.6,
        ..Panel::default()
    };
    let shadows = Panel {
        title: format!("θi = {}°, Δφ = {}°", settings.theta_i, settings.dphi),
        x: Axis::linear("θr", "°").between(-90.0, 90.0),
        y: Axis::linear("masking–shadowing G", "").between(0.0, 1.05),
        series: vec![Series::line("", points(masking, |y| y)).colored(FOREGROUND)],
        ..Panel::default()
    };
    let title = "Facets".to_owned();
    Some(Figure { title, panels: vec![tilts, shadows], width_mm: 160.0, height_mm: 170.0, ..Figure::default() })
}

/// An upright line of another dash than a rule has.
fn upright(name: String, x: f64, value: impl Fn(f64) -> f64, range: Option<Range>, dash: Dash) -> Series {
    let ends = range.map_or_else(Vec::new, |range| vec![[x, value(range.low)], [x, value(range.high)]]);
    Series { name, color: None, drawn: Drawn::Line { points: ends, width: 0.9, dash } }
}

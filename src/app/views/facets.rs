//! The facets behind the specular lobe: densities of their tilt α for both distributions, Eqs. (5,
//! 7), and masking–shadowing, Eq. (6).

use crate::app::jobs::memo::Memo;
use crate::app::plots::theme::{FOREGROUND, MUTED};
use crate::app::plots::{AutoRange, FigurePlot, KeyEntry, PanelStyle, Polyline, Range, finite, key_line_ui, nice_ceiling, theme};
use crate::app::text::explained::Explained as _;
use crate::app::text::i18n;
use crate::app::text::i18n::Language;
use crate::app::text::numbers::significant;
use crate::app::views::companions::{Pinned, pinned};
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::views::curves::directions;
use crate::app::views::pointing::mark;
use crate::app::work::open_measurement::IncidenceSeries;
use crate::app::work::surface::sigma_of_equal_median;
use crate::app::work::workspace::Workspace;
use crate::figure::{Axis, Dash, Figure, Panel, SERIES, Series};
use egui::{Key, Ui};
use egui_plot::LineStyle;
use pbrdf::optics::{Degrees, Facet, Masking, SlopeDistribution};
use tr::tr;

pub static SPEC: PaneSpec = PaneSpec {
    title: "Facets",
    tooltip: "Densities of facet tilts for both distributions, Eqs. (5, 7), and masking–shadowing, Eq. (6)",
    shortcut: Some(Key::Num4),
    has_options: true,
    has_figure: true,
    new: || Box::new(FacetsView::default()),
};

/// What the pane keeps.
#[derive(Default)]
pub struct FacetsView {
    densities: Memo<DensityKey, [Density; 2]>,
    /// Those of the pinned surfaces.
    pinned: Memo<Vec<Pinned>, Vec<Density>>,
    masking: Memo<(f64, f64), Polyline>,
    tilts: AutoRange,
    /// Of the densities, in logarithms where those are drawn.
    range: AutoRange,
    plot: FigurePlot<PlotKey>,
}

/// Stamps of densities, masking and pinned surfaces, whether densities are logarithmic, how the model masks, the
/// axes, the picked angle of view, the language.
type PlotKey = ([u64; 3], bool, Masking, [Option<Range>; 2], Option<f64>, Language);

/// σ, q, the model's own distribution and whether the other one has the same median slope.
type DensityKey = (f64, f64, SlopeDistribution, bool);

/// One distribution.
#[derive(Debug)]
pub struct Density {
    /// P(α), in sr⁻¹.
    p: Polyline,
    /// D(α) = P/cos α, in sr⁻¹.
    d: Polyline,
    /// α in degrees at which P has fallen to half of P(0), if it does.
    half_width: Option<f64>,
    /// α in degrees that half of the projected facets stay below.
    median: f64,
}

impl Density {
    fn new(distribution: SlopeDistribution, sigma: f64, q: f64) -> Self {
        let p = |alpha: f64| {
            let (sin, cos) = Degrees(alpha).sin_cos();
            let tan = sin / cos;
            distribution.facet_density(tan * tan, sigma, q)
        };
        let median = degrees(distribution.median_slope(sigma, q));
        let tilts = tilts(median);
        let below_half = tilts.windows(2).find(|pair| p(pair[1]) < 0.5 * p(0.0));
        Self {
            p: tilts.iter().map(|&alpha| [alpha, p(alpha)]).collect(),
            d: tilts.iter().map(|&alpha| [alpha, p(alpha) / Degrees(alpha).sin_cos().1]).collect(),
            half_width: below_half.map(|pair| crossing(|alpha| p(alpha) - 0.5 * p(0.0), pair[0], pair[1])),
            median,
        }
    }
}

fn degrees(slope: f64) -> f64 {
    libm::atan(slope).to_degrees()
}

/// Tilts in degrees, close together where facets of that median tilt are.
fn tilts(median: f64) -> Vec<f64> {
    let mut tilts: Vec<f64> = (0..180).map(|i| 0.5 * f64::from(i)).collect();
    tilts.extend((0..200).map(|i| 0.03 * median * f64::from(i)));
    tilts.retain(|tilt| *tilt < 90.0);
    tilts.sort_by(f64::total_cmp);
    tilts.dedup();
    tilts
}

/// Where a function that changes its sign between two places does so, by halving.
fn crossing(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if (f(middle) > 0.0) == (f(low) > 0.0) {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Lower end of the axis of G: its 0 keeps off the first number of θr, and the curve off the rim.
const LOWEST: f64 = -0.03;

/// Decades that a logarithmic axis of densities shows.
const DECADES: f64 = 6.0;

/// G against signed θr.
fn masking(theta_i: f64, dphi: f64) -> Polyline {
    let series = IncidenceSeries { theta_i, plane: dphi.rem_euclid(360.0), dolp: Vec::new(), brdf: Vec::new(), rows: Vec::new() };
    let g = |theta_r| {
        let facet = series.geometry(theta_r).map(Facet::new);
        [theta_r, facet.map_or(f64::NAN, |facet| facet.g_over_cosines / facet.one_over_cosines)]
    };
    directions(theta_i, true).into_iter().map(g).collect()
}

/// Widths of the curve of the model's own distribution and of the other one, in points of paper.
const OWN: f64 = 1.5;
const OTHER: f64 = 0.9;

impl FacetsView {
    fn follow(&mut self, log: bool, interacting: bool) {
        let Some(densities) = self.densities.get() else { return };
        let densities = || densities.iter().chain(self.pinned.get().into_iter().flatten());
        let widest = densities().map(|density| density.median).fold(0.0, f64::max);
        self.tilts.follow(Range { low: 0.0, high: (5.0 * (widest + 0.5).ceil()).min(90.0) }, interacting);
        let top = densities().flat_map(|density| finite(&density.p)).map(|[_, y]| y).fold(f64::NEG_INFINITY, f64::max);
        let range = if log {
            let high = if top > 0.0 { (libm::log10(top) + 0.1).ceil() } else { 1.0 };
            Range { low: high - DECADES, high }
        } else {
            Range { low: 0.0, high: nice_ceiling(top) }
        };
        self.range.follow(range, interacting);
    }

    fn describe(&self, densities: &[Density; 2], masking: &Polyline, picked: Option<f64>, work: &Workspace) -> Option<Figure> {
        let (settings, surface) = (work.settings(), work.surface());
        let range = self.range.get()?;
        let y = if settings.view_options.facets_log {
            Axis::log(tr!("density"), "sr⁻¹").between(libm::exp10(range.low), libm::exp10(range.high))
        } else {
            range.on(Axis::linear(tr!("density"), "sr⁻¹"))
        };
        let mut series = Vec::new();
        for ((distribution, density), color) in SlopeDistribution::ALL.into_iter().zip(densities).zip(SERIES) {
            let name = name(distribution);
            let width = if distribution == surface.model.distribution { OWN } else { OTHER };
            series.push(Series::stroke(tr!("{}: P", name), density.p.clone(), width, Dash::Solid).colored(color));
            series.push(Series::dashed(tr!("{}: D = P / cos α", name), density.d.clone(), Dash::Dashed).colored(color));
            if let (Some(half), Some((low, high))) = (density.half_width, y.range) {
                let name = tr!("half of P(0): {}°", format!("{half:.2}"));
                series.push(Series::dashed(name, vec![[half, low], [half, high]], Dash::Dotted).colored(color));
            }
            let name = tr!("median: {}°", format!("{:.2}", density.median));
            series.push(Series::upright(name, density.median).colored(color));
        }
        let pinned = self.pinned.key().into_iter().flatten().zip(self.pinned.get().into_iter().flatten());
        for (pin, density) in pinned {
            series.push(pin.look.stroke(density.p.clone()));
        }
        let tilts = Panel {
            title: format!("σ = {}, q = {}", significant(surface.parameters.sigma), significant(surface.parameters.q)),
            x: self.tilts.on(Axis::linear("α", "°")),
            y,
            series,
            height_share: 1.6,
            ..Panel::default()
        };
        // Without masking, the model has G = 1 everywhere.
        let ink = if surface.model.masking == Masking::None { MUTED } else { FOREGROUND };
        let shadows = Panel {
            title: tr!("θi = {0}°, Δφ = {1}°", settings.theta_i, settings.dphi),
            x: Axis::linear("θr", "°").between(-90.0, 90.0),
            y: Axis::linear(tr!("masking–shadowing G"), "").between(LOWEST, 1.05),
            series: [Series::line("", masking.clone()).colored(ink)].into_iter().chain(picked.map(|at| mark(at, LOWEST, 1.05))).collect(),
            ..Panel::default()
        };
        Some(Figure { title: tr!("Facets"), panels: vec![tilts, shadows], width_mm: 160.0, height_mm: 170.0, ..Figure::default() })
    }
}

impl View for FacetsView {
    fn refresh(&mut self, cx: &mut Cx<'_>) {
        let (settings, work) = (cx.work.settings(), cx.work);
        let (parameters, model, shown) = (work.surface().parameters, work.surface().model, settings.view_options);
        let key = (parameters.sigma, parameters.q, model.distribution, shown.facets_equal_median);
        self.densities.refresh(key, |&(sigma, q, own, equal_median)| {
            SlopeDistribution::ALL.map(|distribution| {
                let equal = equal_median && distribution != own;
                Density::new(distribution, if equal { sigma_of_equal_median(own, sigma, q) } else { sigma }, q)
            })
        });
        let pinned: Vec<Pinned> = pinned(work).into_iter().filter(|pin| pin.model.specular).collect();
        self.pinned.refresh(pinned, |pins| {
            let density = |pin: &Pinned| Density::new(pin.model.distribution, pin.parameters.sigma, pin.parameters.q);
            pins.iter().map(density).collect()
        });
        self.masking.refresh((settings.theta_i, settings.dphi), |&(theta_i, dphi)| masking(theta_i, dphi));
        self.follow(shown.facets_log, cx.interacting);
        let stamps = [self.densities.stamp(), self.masking.stamp(), self.pinned.stamp()];
        let picked = cx.derived.picked_theta_r(work);
        let key = (stamps, shown.facets_log, model.masking, [self.tilts.get(), self.range.get()], picked, i18n::current());
        let mut plot = std::mem::take(&mut self.plot);
        plot.refresh(key, |_| self.describe(self.densities.get()?, self.masking.get()?, picked, work));
        self.plot = plot;
    }

    fn ui(&mut self, _cx: &mut Cx<'_>, ui: &mut Ui) {
        let pins = self.pinned.key().map_or(&[][..], Vec::as_slice);
        let room = ui.available_height();
        let height = if room > 240.0 { DENSITIES * room } else { room };
        let top = ui.cursor().top();
        if let Some(densities) = self.densities.get() {
            legend_ui(densities, pins, ui);
        }
        let height = (height - (ui.cursor().top() - top)).max(60.0);
        let hover = |name: &str, x: f64, y: f64| format!("{name}\nα = {x:.2}°\n{y:.4e} sr⁻¹");
        let style = PanelStyle::new("facet densities", height, &hover).named(tr!("Plot: densities of facet tilts"));
        if let Some(panel) = self.plot.panel(0) {
            panel.ui(&style, ui);
        }
        if room > 240.0 {
            let hover = |_: &str, x: f64, y: f64| format!("θr = {x:.2}°\nG = {y:.5}");
            let style = PanelStyle { spread: 4.0, ..PanelStyle::new("masking", ui.available_height(), &hover) };
            let style = style.named(tr!("Plot: masking–shadowing against θr"));
            if let Some(panel) = self.plot.panel(1) {
                panel.ui(&style, ui);
            }
        }
    }

    fn options_ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        cx.view_options_ui(|shown| {
            ui.checkbox(&mut shown.facets_log, tr!("Logarithmic densities")).on_hover_text(tr!("Shows the tails, which q sets"));
            ui.checkbox(&mut shown.facets_equal_median, tr!("Equal median slope")).on_hover_text(tr!(
                "The distribution that the model does not have is drawn with the median slope of the other, not with the same σ"
            ));
        });
    }

    fn figure(&self, _cx: &Cx<'_>) -> Option<Figure> {
        self.plot.figure().cloned()
    }
}

fn name(distribution: SlopeDistribution) -> String {
    match distribution {
        SlopeDistribution::Gauss => tr!("Gauss"),
        SlopeDistribution::Cauchy => tr!("Cauchy"),
    }
}

/// What the lines of the plot mean, and where the upright ones stand: in lines above it, where they
/// hide nothing.
fn legend_ui(densities: &[Density; 2], pins: &[Pinned], ui: &mut Ui) {
    let dark = ui.visuals().dark_mode;
    let help = tr!("Dotted: P has fallen to half of P(0). Dashed: half of the projected facets are tilted less.");
    ui.horizontal_wrapped(|ui| {
        for (i, (distribution, density)) in SlopeDistribution::ALL.into_iter().zip(densities).enumerate() {
            if i > 0 {
                ui.add_space(8.0);
            }
            let median = format!("{:.2}", density.median);
            let text = match density.half_width {
                Some(half) => tr!("{0}: half at {1}°, median {2}°", name(distribution), format!("{half:.2}"), median),
                None => tr!("{0}: median {1}°", name(distribution), median),
            };
            ui.colored_label(theme::series(i, dark), text).explained(&help);
        }
    });
    let ink = ui.visuals().text_color();
    let entry = |name, style, width| KeyEntry { name, color: ink, style, width, symbol: None, on_map: false };
    let entries = [
        entry("P".to_owned(), LineStyle::Solid, 2.0),
        entry("D = P / cos α".to_owned(), LineStyle::dashed_dense(), 1.5),
        entry(tr!("half of P(0)"), LineStyle::dotted_dense(), 1.5),
        entry(tr!("median"), LineStyle::dashed_dense(), 1.0),
    ];
    let entries: Vec<KeyEntry> = entries.into_iter().chain(pins.iter().map(|pin| pin.look.key_entry(dark))).collect();
    key_line_ui(&entries, ui);
}

/// Share of the height that the densities have.
const DENSITIES: f32 = 0.62;

#[cfg(test)]
mod tests {
    use super::{Density, SlopeDistribution, degrees, sigma_of_equal_median};
    use crate::app::work::surface::another;

    #[test]
    fn equal_median_means_equal_median() {
        for own in SlopeDistribution::ALL {
            let sigma = sigma_of_equal_median(own, 0.3, 1.7);
            let (a, b) = (own.median_slope(0.3, 1.7), another(own).median_slope(sigma, 1.7));
            // Two products and a quotient.
            assert!((a / b - 1.0).abs() < 8.0 * f64::EPSILON);
        }
    }

    #[test]
    fn half_width_of_narrow_gauss_facets_is_that_of_a_gauss_curve() {
        let sigma = 0.01;
        let half = Density::new(SlopeDistribution::Gauss, sigma, 2.0).half_width.expect("narrow densities fall");
        // exp(−tan²α/2σ²) = 1/2; 1/cos³α is 1 + 1.5 α² there, which moves α by a relative 1.5 σ².
        let expected = degrees(sigma * (2.0 * std::f64::consts::LN_2).sqrt());
        assert!((half / expected - 1.0).abs() < 2.0 * sigma * sigma, "{half} {expected}");
    }

    #[test]
    fn a_density_that_does_not_fall_to_half_has_no_half_width() {
        // Very rough facets: 1/cos³α outweighs the slopes' own fall up to grazing tilts.
        let density = Density::new(SlopeDistribution::Cauchy, 3.0, 1.001);
        assert_eq!(density.half_width, None);
        assert!(density.median > 45.0);
    }
}

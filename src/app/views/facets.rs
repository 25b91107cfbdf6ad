//! The facets behind the specular lobe: densities of their tilt α for both distributions, Eqs. (5, 7), and masking–shadowing, Eq. (6).

mod figure;

pub use figure::facets_figure;

use crate::app::jobs::memo::Memo;
use crate::app::plots::axis;
use crate::app::plots::axis::{axis, decimal, power_of_ten};
use crate::app::plots::{Axes, Following, KeyEntry, Range, curve, key_line_ui, plot, round_up};
use crate::app::shell::app::App;
use crate::app::shell::theme;
use crate::app::views::curves::{Polyline, directions, pieces};
use crate::app::work::document::IncidenceSeries;
use crate::app::work::workspace::Workspace;
use egui::Ui;
use egui_plot::{AxisHints, HoverPosition, LineStyle, VLine};
use pbrdf::optics::{Degrees, Facet, SlopeDistribution};
use tr::tr;

/// What the pane keeps.
#[derive(Default)]
pub struct FacetsView {
    densities: Memo<DensityKey, [Density; 2]>,
    masking: Memo<(f64, f64), Polyline>,
    density_axes: Axes,
    masking_axes: Axes,
    tilts: Following,
    range: Following,
}

/// σ, q, whether drawn as logarithms, the model's own distribution and whether the other one has the same median slope.
type DensityKey = (f64, f64, bool, SlopeDistribution, bool);

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

/// The distribution that a model does not have.
pub fn another(distribution: SlopeDistribution) -> SlopeDistribution {
    match distribution {
        SlopeDistribution::Gauss => SlopeDistribution::Cauchy,
        SlopeDistribution::Cauchy => SlopeDistribution::Gauss,
    }
}

/// σ of the other distribution with the same median slope.
pub fn sigma_of_equal_median(own: SlopeDistribution, sigma: f64, q: f64) -> f64 {
    match own {
        SlopeDistribution::Gauss => SlopeDistribution::cauchy_of_equal_median(sigma, q),
        SlopeDistribution::Cauchy => SlopeDistribution::gauss_of_equal_median(sigma, q),
    }
}

impl Density {
    fn new(distribution: SlopeDistribution, sigma: f64, q: f64, log: bool) -> Self {
        let p = |alpha: f64| {
            let (sin, cos) = Degrees(alpha).sin_cos();
            let tan = sin / cos;
            distribution.facet_density(tan * tan, sigma, q)
        };
        let median = degrees(distribution.median_slope(sigma, q));
        let tilts = tilts(median);
        let coordinate = |y: f64| Some(if log { libm::log10(y) } else { y });
        let below_half = tilts.windows(2).find(|pair| p(pair[1]) < 0.5 * p(0.0));
        Self {
            p: pieces(tilts.iter().map(|&alpha| (alpha, coordinate(p(alpha))))),
            d: pieces(tilts.iter().map(|&alpha| (alpha, coordinate(p(alpha) / Degrees(alpha).sin_cos().1)))),
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

/// Decades that a logarithmic axis of densities shows.
const DECADES: f64 = 6.0;

pub fn facets_refresh(explorer: &mut App) {
    let App { work: Workspace { settings, .. }, views, dragging, .. } = explorer;
    let view = &mut views.facets;
    let (parameters, model, shown) = (settings.parameters, settings.model, settings.shown);
    let key = (parameters.sigma, parameters.q, shown.facets_log, model.distribution, shown.facets_equal_median);
    view.densities.refresh(key, |&(sigma, q, log, own, equal_median)| {
        SlopeDistribution::ALL.map(|distribution| {
            let equal = equal_median && distribution != own;
            Density::new(distribution, if equal { sigma_of_equal_median(own, sigma, q) } else { sigma }, q, log)
        })
    });
    view.masking.refresh((settings.theta_i, settings.dphi), |&(theta_i, dphi)| masking(theta_i, dphi));
    let Some(densities) = view.densities.get() else { return };
    let widest = densities.iter().map(|density| density.median).fold(0.0, f64::max);
    view.tilts.follow(Range { low: 0.0, high: (5.0 * (widest + 0.5).ceil()).min(90.0) }, *dragging);
    let tallest = |density: &Density| density.p.iter().flatten().map(|point| point.y).fold(f64::NEG_INFINITY, f64::max);
    let top = densities.iter().map(tallest).fold(f64::NEG_INFINITY, f64::max);
    let range = if shown.facets_log {
        let high = if top.is_finite() { (top + 0.1).ceil() } else { 1.0 };
        Range { low: high - DECADES, high }
    } else {
        Range { low: 0.0, high: round_up(top) }
    };
    view.range.follow(range, *dragging);
}

/// G against signed θr.
fn masking(theta_i: f64, dphi: f64) -> Polyline {
    let series = IncidenceSeries { theta_i, plane: dphi.rem_euclid(360.0), dolp: Vec::new(), brdf: Vec::new(), rows: Vec::new() };
    pieces(directions(theta_i, true).into_iter().map(|theta_r| {
        let facet = series.geometry(theta_r).map(Facet::new);
        (theta_r, facet.map(|facet| facet.g_over_cosines / facet.one_over_cosines))
    }))
}

/// What is drawn in the pane.
pub fn facets_options_ui(explorer: &mut App, ui: &mut Ui) {
    let shown = &mut explorer.work.settings.shown;
    ui.checkbox(&mut shown.facets_log, tr!("Logarithmic densities")).on_hover_text(tr!("Shows the tails, which q sets"));
    ui.checkbox(&mut shown.facets_equal_median, tr!("Equal median slope")).on_hover_text(tr!(
        "The distribution that the model does not have is drawn with the median slope of the other, not with the same σ"
    ));
}

fn name(distribution: SlopeDistribution) -> String {
    match distribution {
        SlopeDistribution::Gauss => tr!("Gauss"),
        SlopeDistribution::Cauchy => tr!("Cauchy"),
    }
}

/// What the lines of the plot mean, and where the upright ones stand: in lines above it, where they hide nothing.
fn legend_ui(densities: &[Density; 2], ui: &mut Ui) {
    let dark = ui.visuals().dark_mode;
    let help = tr!("Dotted: P has fallen to half of P(0). Dashed: half of the projected facets are tilted less.");
    ui.horizontal_wrapped(|ui| {
        for (i, (distribution, density)) in SlopeDistribution::ALL.into_iter().zip(densities).enumerate() {
            let median = format!("{:.2}", density.median);
            let text = match density.half_width {
                Some(half) => tr!("{0}: half at {1}°, median {2}°", name(distribution), format!("{half:.2}"), median),
                None => tr!("{0}: median {1}°", name(distribution), median),
            };
            ui.colored_label(theme::series(i, dark), text).on_hover_text(&help);
            ui.add_space(8.0);
        }
    });
    let ink = ui.visuals().text_color();
    let entry = |name, style, width| KeyEntry { name, color: ink, style, width };
    let entries = [
        entry("P".to_owned(), LineStyle::Solid, 2.0),
        entry("D = P / cos α".to_owned(), LineStyle::dashed_dense(), 1.0),
        entry(tr!("half of P(0)"), LineStyle::dotted_dense(), 1.0),
        entry(tr!("median"), LineStyle::dashed_loose(), 1.0),
    ];
    key_line_ui(&entries, ui);
}

/// Share of the height that the densities have.
const DENSITIES: f32 = 0.62;

pub fn facets_ui(explorer: &mut App, ui: &mut Ui) {
    let room = ui.available_height();
    let height = if room > 240.0 { DENSITIES * room } else { room };
    densities_ui(explorer, ui, height);
    if room > 240.0 {
        masking_ui(explorer, ui, ui.available_height());
    }
}

fn densities_ui(explorer: &mut App, ui: &mut Ui, height: f32) {
    let App { work: Workspace { settings, .. }, views, .. } = explorer;
    let view = &mut views.facets;
    let Some(densities) = view.densities.get() else { return };
    let dark = ui.visuals().dark_mode;
    let log = settings.shown.facets_log;
    let top = ui.cursor().top();
    legend_ui(densities, ui);
    let height = (height - (ui.cursor().top() - top)).max(60.0);
    let x = axis(AxisHints::new_x(), ui, "α / °", decimal).min_thickness(40.0);
    let y = axis(AxisHints::new_y(), ui, &tr!("density / (1/sr)"), if log { power_of_ten } else { decimal });
    let response = plot("facet densities", ui, height, x, y)
        .y_grid_spacer(move |input| axis::marks(&input, 5.0, if log { 1.0 } else { 0.0 }))
        .label_formatter(move |hover: &HoverPosition<'_>| match hover {
            HoverPosition::NearDataPoint { plot_name, position, .. } => {
                let density = if log { libm::exp10(position.y) } else { position.y };
                Some(format!("{plot_name}\nα = {:.2}°\n{density:.4e} 1/sr", position.x))
            }
            HoverPosition::Elsewhere { .. } => None,
        })
        .show(ui, |plot| {
            view.density_axes.apply(plot, view.tilts.get(), view.range.get());
            for (i, (distribution, density)) in SlopeDistribution::ALL.into_iter().zip(densities).enumerate() {
                let color = theme::series(i, dark);
                let width = if distribution == settings.model.distribution { 2.5 } else { 1.5 };
                let name = name(distribution);
                curve(plot, &density.p, &format!("{name}: P"), color, None, width);
                curve(plot, &density.d, &format!("{name}: D"), color, Some(LineStyle::dashed_dense()), 1.0);
                if let Some(half) = density.half_width {
                    plot.vline(VLine::new("", half).color(color).style(LineStyle::dotted_dense()).allow_hover(false));
                }
                plot.vline(VLine::new("", density.median).color(color).style(LineStyle::dashed_loose()).allow_hover(false));
            }
        });
    view.density_axes.listen(&response, &tr!("Plot: densities of facet tilts"), ui);
}

fn masking_ui(explorer: &mut App, ui: &mut Ui, height: f32) {
    let App { work: Workspace { settings, .. }, views, .. } = explorer;
    let view = &mut views.facets;
    let Some(masking) = view.masking.get() else { return };
    let dark = ui.visuals().dark_mode;
    let title = tr!("θr / °  at θi = {0}°, Δφ = {1}°", settings.theta_i, settings.dphi);
    let x = axis(AxisHints::new_x(), ui, &title, decimal).min_thickness(40.0);
    let y = axis(AxisHints::new_y(), ui, "G", decimal);
    let response = plot("masking", ui, height, x, y)
        .y_grid_spacer(|input| axis::marks(&input, 4.0, 0.0))
        .label_formatter(|hover: &HoverPosition<'_>| match hover {
            HoverPosition::NearDataPoint { position, .. } => Some(format!("θr = {:.2}°\nG = {:.5}", position.x, position.y)),
            HoverPosition::Elsewhere { .. } => None,
        })
        .show(ui, |plot| {
            // The mark at 0 keeps off that at −90°.
            view.masking_axes.apply(plot, Some(Range { low: -90.0, high: 90.0 }), Some(Range { low: -0.1, high: 1.1 }));
            // Without masking, the model has G = 1 everywhere.
            let color = if settings.model.masking { theme::foreground(dark) } else { theme::muted(dark) };
            curve(plot, masking, &tr!("masking–shadowing G"), color, None, 2.0);
        });
    view.masking_axes.listen(&response, &tr!("Plot: masking–shadowing against θr"), ui);
}

#[cfg(test)]
mod tests {
    use super::{Density, SlopeDistribution, another, degrees, sigma_of_equal_median};

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
        let half = Density::new(SlopeDistribution::Gauss, sigma, 2.0, false).half_width.expect("narrow densities fall");
        // exp(−tan²α/2σ²) = 1/2; 1/cos³α is 1 + 1.5 α² there, which moves α by a relative 1.5 σ².
        let expected = degrees(sigma * (2.0 * std::f64::consts::LN_2).sqrt());
        assert!((half / expected - 1.0).abs() < 2.0 * sigma * sigma, "{half} {expected}");
    }

    #[test]
    fn a_density_that_does_not_fall_to_half_has_no_half_width() {
        // Very rough facets: 1/cos³α outweighs the slopes' own fall up to grazing tilts.
        let density = Density::new(SlopeDistribution::Cauchy, 3.0, 1.001, false);
        assert_eq!(density.half_width, None);
        assert!(density.median > 45.0);
    }
}

//! What the physics says of the sliders' surface: each check with its number and verdict, and the
//! reflectance against θi.

use crate::app::jobs::async_memo::AsyncMemo;
use crate::app::jobs::memo::Memo;
use crate::app::plots::theme::{ALARM, FOREGROUND, MUTED};
use crate::app::plots::{AutoRange, FigurePlot, PanelPlot, PanelStyle, Polyline, Range, finite, nice_ceiling, theme};
use crate::app::text::explained::Explained as _;
use crate::app::text::i18n;
use crate::app::text::i18n::Language;
use crate::app::text::localized::Localized as _;
use crate::app::text::numbers::short;
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::views::curves::Term;
use crate::figure::{Axis, Figure, Panel, Series};
use egui::{Key as Keyboard, Label, ScrollArea, Ui};
use pbrdf::model::{Audit, Check, Diffuse, Finding, Model, Parameters, Pbrdf, Reflectance};
use pbrdf::optics::Geometry;
use tr::tr;

pub static SPEC: PaneSpec = PaneSpec {
    title: "Audit",
    tooltip: "What the physics says of the sliders: reciprocity, reflectance, DoLP against its limit, admissible Mueller matrices",
    shortcut: Some(Keyboard::Num7),
    has_options: false,
    has_figure: true,
    new: || Box::new(AuditView::default()),
};

/// What the pane keeps.
#[derive(Default)]
pub struct AuditView {
    job: AsyncMemo<Key, Audit>,
    curves: Memo<Key, ReflectanceCurves>,
    range: AutoRange,
    /// The stamp of the curves, the axis, the language.
    plot: FigurePlot<(u64, Option<Range>, Language)>,
}

type Key = (Parameters, Model);

/// Reflectance against θi.
struct ReflectanceCurves {
    total: Polyline,
    /// The part of it above 1.
    above: Polyline,
    specular: Polyline,
    diffuse: Polyline,
    volume: Polyline,
    /// The largest finite value.
    top: f64,
    /// The smallest θi at which more light leaves than falls on the surface.
    above_from: Option<f64>,
}

impl ReflectanceCurves {
    fn new(audit: &Audit, model: Model) -> Self {
        let along = |value: fn(&Reflectance) -> f64, is_there: bool| -> Polyline {
            audit.reflectance.iter().filter(|_| is_there).map(|at| [at.theta_i, value(at)]).collect()
        };
        let totals: Vec<(f64, f64)> = audit.reflectance.iter().map(|at| (at.theta_i, at.total())).collect();
        let finite = audit.reflectance.iter().map(Reflectance::total).filter(|total| total.is_finite());
        Self {
            total: along(Reflectance::total, true),
            above: above_one(&totals),
            specular: along(|at| at.specular, model.specular),
            diffuse: along(|at| at.diffuse, model.diffuse != Diffuse::Absent),
            volume: along(|at| at.volume, model.volume),
            top: finite.fold(0.0, f64::max),
            above_from: audit.reflectance.iter().find(|at| at.total() > 1.0).map(|at| at.theta_i),
        }
    }
}

impl ReflectanceCurves {
    fn describe(&self, title: String, range: &AutoRange) -> Figure {
        let mut series = vec![Series::level("", 1.0).colored(MUTED)];
        let terms = [(Term::Specular, &self.specular), (Term::Diffuse, &self.diffuse), (Term::Volume, &self.volume)];
        for (term, curve) in terms.into_iter().filter(|(_, curve)| !curve.is_empty()) {
            series.push(Series::line(term.name(), curve.clone()).colored(term.ink()));
        }
        series.push(Series::line(tr!("total"), self.total.clone()).colored(FOREGROUND));
        if !self.above.is_empty() {
            series.push(Series::line(tr!("above 1"), self.above.clone()).colored(ALARM));
        }
        let x = Axis::linear("θi", "°").between(0.0, 90.0);
        let y = range.on(Axis::linear(tr!("directional-hemispherical reflectance"), ""));
        Figure { title, panels: vec![Panel { x, y, series, ..Panel::default() }], ..Figure::default() }
    }
}

/// The parts of a curve above 1, from where it crosses that height.
fn above_one(points: &[(f64, f64)]) -> Polyline {
    let mut above = Vec::new();
    for (i, &(x, y)) in points.iter().enumerate() {
        if let Some(&(before, lower)) = i.checked_sub(1).and_then(|i| points.get(i))
            && (lower > 1.0) != (y > 1.0)
            && (y - lower).is_finite()
        {
            above.push([before + (x - before) * (1.0 - lower) / (y - lower), 1.0]);
        }
        above.push([x, if y > 1.0 { y } else { f64::NAN }]);
    }
    if finite(&above).next().is_none() { Polyline::new() } else { above }
}

impl AuditView {
    /// The newest findings.
    #[cfg(test)]
    pub fn audit(&self) -> Option<&Audit> {
        self.job.get()
    }
}

impl View for AuditView {
    fn refresh(&mut self, cx: &mut Cx<'_>) {
        let key = (cx.work.surface().parameters, cx.work.surface().model);
        let Ok(surface) = Pbrdf::new(key.1, key.0) else {
            // Values that are not numbers differ from themselves: a job would follow a job for
            // ever.
            self.job = AsyncMemo::default();
            self.curves.clear();
            return;
        };
        #[cfg(target_arch = "wasm32")]
        let is_beside = self.job.refresh_beside(&cx.jobs.spawner, &key, || {
            use crate::app::tasks::view_message::{ask_audit, told_audit};
            Some((ask_audit(&surface)?, told_audit))
        });
        #[cfg(not(target_arch = "wasm32"))]
        let is_beside = false;
        if !is_beside {
            self.job.refresh(&cx.jobs.spawner, &key, move |_| Audit::new(&surface));
        }
        let (Some(key), Some(audit)) = (self.job.key(), self.job.get()) else { return };
        self.curves.refresh(*key, |(_, model)| ReflectanceCurves::new(audit, *model));
        let Some(curves) = self.curves.get() else { return };
        // The line at 1 is always in sight; what grows without end at grazing incidence is cut.
        self.range.follow(Range { low: 0.0, high: nice_ceiling(curves.top.clamp(1.0, HIGHEST)) }, cx.interacting);
        let range = &self.range;
        let title = cx.work.active().title();
        self.plot.refresh((self.curves.stamp(), range.get(), i18n::current()), |_| Some(curves.describe(title, range)));
    }

    fn ui(&mut self, _cx: &mut Cx<'_>, ui: &mut Ui) {
        let Some(audit) = self.job.get() else {
            ui.label("…");
            return;
        };
        let (plot, above_from) = (&mut self.plot, self.curves.get().and_then(|curves| curves.above_from));
        if ui.available_width() > SIDE_BY_SIDE {
            let (width, height) = (ui.available_width(), ui.available_height());
            ui.horizontal_top(|ui| {
                let size = egui::vec2(0.56 * width, height);
                ui.allocate_ui_with_layout(size, egui::Layout::top_down(egui::Align::Min), |ui| {
                    ScrollArea::vertical().id_salt("findings").auto_shrink([false; 2]).show(ui, |ui| findings_ui(audit, ui));
                });
                ui.vertical(|ui| reflectance_ui(plot.panel(0), above_from, height, ui));
            });
        } else {
            ScrollArea::both().auto_shrink([false; 2]).show(ui, |ui| {
                // Narrower, the names of the checks would be cut.
                ui.set_width(ui.available_width().max(NARROWEST));
                let top = ui.cursor().top();
                findings_ui(audit, ui);
                ui.add_space(6.0);
                let left = ui.clip_rect().bottom() - top - (ui.cursor().top() - top);
                // The title of an axis and its last number stand a little beyond the plot.
                let margin = egui::Margin { left: 4, right: 10, top: 0, bottom: 0 };
                egui::Frame::new().inner_margin(margin).show(ui, |ui| {
                    reflectance_ui(plot.panel(0), above_from, left.max(PLOT_HEIGHT), ui);
                });
            });
        }
    }

    fn figure(&self, _cx: &Cx<'_>) -> Option<Figure> {
        self.plot.figure().cloned()
    }
}

/// Reflectance that the plot shows at most.
const HIGHEST: f64 = 3.0;
/// From this width on table and plot lie side by side.
const SIDE_BY_SIDE: f32 = 760.0;
/// What the table needs.
const NARROWEST: f32 = 540.0;
/// Least height of the plot, in points.
const PLOT_HEIGHT: f32 = 190.0;

/// Widths of numbers and of directions: no column moves with its digits.
const NUMBER: f32 = 74.0;
const PLACE: f32 = 96.0;

fn findings_ui(audit: &Audit, ui: &mut Ui) {
    let dark = ui.visuals().dark_mode;
    let stripe = ui.visuals().faint_bg_color;
    ui.spacing_mut().item_spacing.y = 2.0;
    let headings = [
        (tr!("check"), tr!("What was looked at, and why it is as it is")),
        (tr!("number"), tr!("The worst over a mesh of directions or angles of incidence; of admissibility the smallest eigenvalue")),
        (tr!("limit"), tr!("What the number must keep for the check to pass")),
        (tr!("direction"), tr!("The direction that the number belongs to: θi, θr, Δφ")),
    ];
    row_ui(ui, |ui, column| {
        let (heading, help) = &headings[column];
        ui.strong(heading).explained(help);
    });
    for (i, finding) in audit.findings.iter().enumerate() {
        let fill = if i % 2 == 0 { stripe } else { egui::Color32::TRANSPARENT };
        egui::Frame::new().fill(fill).inner_margin(egui::Margin::symmetric(0, 3)).show(ui, |ui| {
            row_ui(ui, |ui, column| match column {
                0 => {
                    if finding.pass {
                        ui.colored_label(theme::series(2, dark), tr!("✓ pass"));
                    } else {
                        ui.colored_label(theme::warning(dark), tr!("✗ fail"));
                    }
                    ui.add(Label::new(egui::RichText::new(check_name(finding.check)).strong()));
                }
                1 => _ = ui.monospace(number(finding)),
                2 => _ = ui.monospace(bar(finding)),
                _ => _ = ui.label(place(finding)),
            });
            ui.add(Label::new(finding.localized()).wrap());
        });
    }
}

/// One row: the check as wide as there is room, and three columns of fixed width.
fn row_ui(ui: &mut Ui, mut cell: impl FnMut(&mut Ui, usize)) {
    let gaps = 3.0 * ui.spacing().item_spacing.x;
    let check = (ui.available_width() - 2.0 * NUMBER - PLACE - gaps).max(120.0);
    ui.horizontal(|ui| {
        for (column, width) in [check, NUMBER, NUMBER, PLACE].into_iter().enumerate() {
            let size = egui::vec2(width, ui.spacing().interact_size.y);
            ui.allocate_ui_with_layout(size, egui::Layout::left_to_right(egui::Align::Center), |ui| {
                ui.set_min_width(width);
                cell(ui, column);
            });
        }
    });
}

fn check_name(check: Check) -> String {
    match check {
        Check::SpecularReciprocity => tr!("Reciprocity: specular lobe"),
        Check::DiffuseReciprocity => tr!("Reciprocity: diffuse lobe"),
        Check::VolumeReciprocity => tr!("Reciprocity: volume lobe"),
        Check::Reflectance => tr!("Directional-hemispherical reflectance ρ"),
        Check::FresnelLimit => tr!("DoLP above the Fresnel limit"),
        Check::Admissibility => tr!("Mueller matrices admissible"),
        Check::Normalisation => tr!("Facets cover the surface once"),
    }
}

/// The number of a finding.
fn number(finding: &Finding) -> String {
    match finding.check {
        Check::Reflectance if finding.value.is_finite() => format!("{:.4}", finding.value),
        // An eigenvalue of nothing but rounding and DoLP below its limit have signs.
        _ if finding.value.is_infinite() => "∞".to_owned(),
        _ => short(finding.value),
    }
}

/// What the number must keep.
fn bar(finding: &Finding) -> String {
    match finding.check {
        Check::Admissibility => format!("≥ {:e}", finding.bar),
        Check::Reflectance | Check::FresnelLimit => format!("≤ {}", finding.bar),
        _ => format!("≤ {:e}", finding.bar),
    }
}

fn place(finding: &Finding) -> String {
    // Nothing has its largest value everywhere.
    let Some(geometry) = finding.at.filter(|_| finding.value != 0.0) else { return String::new() };
    let (theta_i, theta_r, dphi) = angles(geometry);
    match finding.check {
        Check::Reflectance => format!("{theta_i}°"),
        _ => format!("{theta_i}°, {theta_r}°, {dphi}°"),
    }
}

fn angles(geometry: Geometry) -> (f64, f64, f64) {
    (geometry.theta_i().0, geometry.theta_r().0, geometry.dphi().0)
}

fn reflectance_ui(panel: Option<&mut PanelPlot>, above_from: Option<f64>, height: f32, ui: &mut Ui) {
    let Some(panel) = panel else { return };
    let top = ui.cursor().top();
    match above_from {
        Some(theta_i) => {
            let sentence = tr!("More light leaves than falls on the surface from θi = {}° on.", theta_i);
            ui.colored_label(theme::warning(ui.visuals().dark_mode), sentence)
        }
        None => ui.label(tr!("Reflectance into all directions, by terms")),
    };
    panel.key_line_ui(ui);
    let height = height - (ui.cursor().top() - top) - ui.spacing().item_spacing.y;
    let hover = |name: &str, x: f64, y: f64| format!("{name}\nθi = {x:.1}°\nρ = {y:.4}");
    panel.ui(&PanelStyle::new("reflectance", height, &hover).named(tr!("Plot: reflectance against θi")), ui);
}

#[cfg(test)]
mod tests {
    use super::{Audit, Parameters, Pbrdf, ReflectanceCurves, above_one, finite};
    use pbrdf::model::Model;
    use pbrdf::optics::SlopeDistribution;

    fn curves(parameters: Parameters) -> ReflectanceCurves {
        let model = Model::full(SlopeDistribution::Cauchy);
        ReflectanceCurves::new(&Audit::new(&Pbrdf::new(model, parameters).expect("in range")), model)
    }

    #[test]
    fn what_is_above_one_is_drawn_as_such() {
        let modest = curves(Parameters { c: 0.0, ..Parameters::default() });
        assert_eq!((modest.above_from, modest.above.len()), (None, 0));
        // The Minnaert lobe of the defaults grows at grazing incidence.
        let bright = curves(Parameters::default());
        let from = bright.above_from.expect("above 1 somewhere");
        let above: Vec<[f64; 2]> = finite(&bright.above).collect();
        let [first, rest @ ..] = &above[..] else { panic!("no points") };
        assert!(first[0] < from && first[1] == 1.0 && rest.iter().all(|[x, y]| *x >= from && *y > 1.0));
        assert!(bright.top > 1.0);
    }

    #[test]
    fn a_curve_is_cut_where_it_crosses_one() {
        let above = above_one(&[(0.0, 0.5), (1.0, 1.5), (2.0, 1.25), (3.0, 0.75), (4.0, 2.0)]);
        let points: Vec<[f64; 2]> = finite(&above).collect();
        assert_eq!(points, [[0.5, 1.0], [1.0, 1.5], [2.0, 1.25], [2.5, 1.0], [3.2, 1.0], [4.0, 2.0]]);
        assert!(above[5][1].is_nan(), "a gap between both");
        assert!(above_one(&[(0.0, f64::INFINITY), (1.0, f64::INFINITY)]).is_empty());
    }

    #[test]
    fn a_reflectance_without_bound_is_no_point_of_a_curve() {
        let endless = curves(Parameters { c: -2.5, ..Parameters::default() });
        let has_none = |curve| finite(curve).next().is_none();
        assert!(has_none(&endless.total) && has_none(&endless.diffuse) && endless.above_from == Some(0.0));
        assert!(!has_none(&endless.specular));
    }
}

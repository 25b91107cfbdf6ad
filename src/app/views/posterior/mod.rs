//! The posterior: all surfaces that the data allow, as a corner plot that grows while draws come, and as a table.

mod priors;
mod table;

use crate::app::jobs::async_memo::AsyncMemo;
use crate::app::jobs::job::Job;
use crate::app::plots::{FigurePlot, theme};
use crate::app::text::i18n::{self, Language};
use crate::app::text::localized::Localized as _;
use crate::app::views::action::{Action, InquiryAction};
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::work::edit::Edit;
use crate::app::work::posterior::{DRAWS, DrawnPosterior, marks_of_fit};
use crate::figure::Figure;
use crate::report::{CornerFigure, FittedMark};
use egui::{DragValue, Label, ProgressBar, Rect, RichText, ScrollArea, Sense, Ui, UiBuilder, Vec2, WidgetInfo, vec2};
use pbrdf::fit::UnknownName as _;
use pbrdf::model::Parameters;
use std::sync::Arc;
use tr::tr;

pub static SPEC: PaneSpec = PaneSpec {
    title: "Posterior",
    tooltip: "All surfaces that the data allow: draws of the free parameters, one by one and in pairs",
    shortcut: None,
    has_options: true,
    has_figure: true,
    new: || Box::new(PosteriorView::default()),
};

/// What the corner plot depends on: which draws, which parameters are left out, what the fit says, the language.
type Key = (u64, Vec<usize>, Vec<Option<FittedMark>>, Language);

/// The pane.
#[derive(Default)]
pub struct PosteriorView {
    /// Those that are shown.
    drawn: Option<Arc<DrawnPosterior>>,
    corner: AsyncMemo<Key, CornerFigure>,
    plot: FigurePlot<Key>,
    /// Keys of parameters that the corner plot leaves out.
    hidden: Vec<String>,
}

/// Least size of a panel of the corner plot, in points.
const LEAST: Vec2 = vec2(56.0, 31.0);
/// How large a panel is made for the sake of a long name, in points.
const LONGEST: f32 = 140.0;
/// Room for numbers and names at the outer axes.
const RIM: Vec2 = vec2(52.0, 36.0);
/// Between panels.
const SEAM: f32 = 3.0;
/// How much wider than high a panel may be.
const WIDEST: f32 = 1.7;

impl View for PosteriorView {
    fn refresh(&mut self, cx: &mut Cx<'_>) {
        self.drawn = newest(cx);
        let Some(drawn) = &self.drawn else { return };
        let fitted = marks_of_fit(cx.work.shown_fit(), drawn);
        let names = &drawn.draws.parameters;
        let shown: Vec<usize> = (0..names.len()).filter(|&i| !self.hidden.iter().any(|key| *key == names[i].key())).collect();
        let key = (drawn.stamp, shown.clone(), fitted.clone(), i18n::current());
        let title = tr!("Posterior of {}", drawn.from.names.join(", "));
        let about = drawn.clone();
        self.corner.refresh(&cx.jobs.spawner, &key, move |_| CornerFigure::new(&about.draws, &about.from.priors, shown, &fitted, title));
        if let (Some(made), Some(corner)) = (self.corner.key(), self.corner.get()) {
            self.plot.refresh(made.clone(), |_| Some(corner.figure.clone()));
        }
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        run_ui(cx, ui);
        let height = ui.available_height();
        ScrollArea::vertical().auto_shrink([false; 2]).show(ui, |ui| {
            let top = ui.cursor().top();
            match self.drawn.clone() {
                Some(drawn) => {
                    self.notices_ui(&drawn, cx, ui);
                    let room = height - (ui.cursor().top() - top);
                    if let Some(values) = self.corner_ui(&drawn, room, ui) {
                        cx.edits.push(Edit::UseDraw(values));
                    }
                    let place = drawn.place_of(cx.work.active().number).unwrap_or(0);
                    table::summary_ui(&drawn, &marks_of_fit(cx.work.shown_fit(), &drawn), place, ui);
                }
                None if cx.jobs.posteriors.draw.is_running() => _ = ui.weak(tr!("The chains warm up: they learn the shape of the posterior.")),
                None => {
                    let text = tr!("A fit says where the best is; the posterior, which surfaces the data allow. Chains begin at the minima of a fit and \
                         draw parameters, each as likely as the data and the priors make it.");
                    ui.add(Label::new(text).wrap());
                }
            }
            ui.collapsing(tr!("Priors"), |ui| priors::priors_ui(cx, ui));
        });
    }

    fn options_ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let mut options = cx.work.settings().panes.posterior.clone();
        ui.checkbox(&mut options.bands, tr!("Bands of draws in the plots"))
            .on_hover_text(tr!("DoLP and lobes of the central 68 and 95 % of the draws"));
        if options != cx.work.settings().panes.posterior {
            cx.edits.push(Edit::SetPosteriorOptions(options));
        }
        ui.separator();
        let names = self.drawn.as_ref().map_or(&[][..], |drawn| &drawn.draws.parameters);
        for name in names {
            let key = name.key().into_owned();
            let mut is_shown = !self.hidden.contains(&key);
            if ui.checkbox(&mut is_shown, name.symbol()).changed() {
                self.hidden.retain(|other| *other != key);
                if !is_shown {
                    self.hidden.push(key);
                }
            }
        }
    }

    fn figure(&self, _cx: &Cx<'_>) -> Option<Figure> {
        self.plot.figure().cloned()
    }

    fn suspend(&mut self) {
        self.corner.stop_if(|_| true);
    }
}

/// The draws of the active measurement: those that are coming, or those of the last run.
fn newest(cx: &Cx<'_>) -> Option<Arc<DrawnPosterior>> {
    let active = cx.work.active().number;
    let coming = cx.jobs.posteriors.draw.job().and_then(Job::progress).and_then(|drawing| drawing.drawn);
    coming.filter(|drawn| drawn.place_of(active).is_some()).or_else(|| cx.work.posterior().cloned())
}

/// The line that starts and stops it.
fn run_ui(cx: &mut Cx<'_>, ui: &mut Ui) {
    let running = cx.jobs.posteriors.draw.job().map(Job::progress);
    ui.horizontal(|ui| match running {
        Some(drawing) => {
            if ui.button(tr!("Stop drawing")).on_hover_text(tr!("What is drawn so far is shown")).clicked() {
                cx.actions.push(Action::Inquire(InquiryAction::CancelPosterior));
            }
            #[expect(clippy::cast_possible_truncation, reason = "a fraction")]
            let share = drawing.map_or(0.0, |drawing| drawing.share) as f32;
            ui.add(ProgressBar::new(share).desired_width(160.0).show_percentage());
        }
        None => {
            let help = tr!("Chains begin at the minima of a fit from the sliders; what is fixed stays fixed");
            if ui.button(tr!("Draw")).on_hover_text(help).clicked() {
                cx.actions.push(Action::Inquire(InquiryAction::DrawPosterior));
            }
            let mut options = cx.work.settings().panes.posterior.clone();
            let mut draws = options.draws;
            let label = ui.label(tr!("draws of each chain"));
            ui.add(DragValue::new(&mut draws).range(DRAWS).speed(20)).labelled_by(label.id);
            ui.weak(tr!("× {0} chains, seed {1}", options.chains, cx.work.settings().seed))
                .on_hover_text(tr!("The seed, under the options of a fit, decides the draws"));
            if draws != options.draws {
                options.draws = draws;
                cx.edits.push(Edit::SetPosteriorOptions(options));
            }
        }
    });
}

impl PosteriorView {
    /// Whether the draws are to be trusted, and what has changed since.
    fn notices_ui(&self, drawn: &DrawnPosterior, cx: &Cx<'_>, ui: &mut Ui) {
        let (draws, warning) = (&drawn.draws, theme::warning(ui.visuals().dark_mode));
        let text = tr!("{0} draws of {1} values; {2}.", draws.len(), drawn.from.values, drawn.verdict.localized());
        ui.add(Label::new(text).wrap()).on_hover_text(tr!(
            "{0} chains, {1} evaluations, {2} s; {3} transitions diverged, {4} were cut at their greatest length",
            draws.chains.len(),
            draws.evaluations,
            format!("{:.1}", draws.elapsed_ms / 1e3),
            draws.divergences,
            draws.cut
        ));
        let list = cx.work.measurements();
        let has_changed = drawn
            .from
            .numbers
            .iter()
            .zip(&drawn.from.generations)
            .any(|(number, generation)| list.get(*number).is_some_and(|open| open.generation != *generation));
        let mut notices = Vec::new();
        if !cx.jobs.posteriors.draw.is_running() && !drawn.is_complete {
            notices.push(tr!("It was stopped before its end."));
        }
        if has_changed {
            notices.push(tr!("The mask has changed since these draws."));
        }
        if draws.model != cx.work.surface().model {
            notices.push(tr!("These draws are of another model than the sliders show."));
        }
        for notice in notices {
            ui.add(Label::new(RichText::new(notice).color(warning)).wrap());
        }
    }

    /// The corner plot; the values of the draw next to a click, by the numbers of the measurements.
    fn corner_ui(&mut self, drawn: &DrawnPosterior, height: f32, ui: &mut Ui) -> Option<Vec<(u64, Parameters)>> {
        let corner = self.corner.get()?;
        let count = corner.shown.len();
        if count == 0 {
            return None;
        }
        #[expect(clippy::cast_precision_loss, reason = "a handful of panels")]
        let panels = count as f32;
        let room = (vec2(ui.available_width(), height) - RIM) / panels - vec2(SEAM, SEAM);
        // Names of parameters with those of their measurements are longer than a small panel is high.
        let longest = self.plot.panels().iter().step_by(count).map(|panel| panel.y_title_length(ui)).fold(0.0, f32::max);
        let size = room.max(LEAST).max(Vec2::splat(longest.min(LONGEST)));
        let size = vec2(size.x.min(WIDEST * size.y), size.y);
        let whole = RIM + panels * (size + vec2(SEAM, SEAM));
        let mut clicked = None;
        ScrollArea::horizontal().id_salt("corner").show(ui, |ui| {
            let (rect, response) = ui.allocate_exact_size(whole, Sense::hover());
            response
                .widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, tr!("Plot: every free parameter, and every pair of them")));
            for (index, panel) in self.plot.panels().iter_mut().enumerate() {
                let (row, column) = (index / count, index % count);
                if column > row {
                    continue;
                }
                #[expect(clippy::cast_precision_loss, reason = "a handful of panels")]
                let offset = vec2(column as f32, row as f32) * (size + vec2(SEAM, SEAM));
                let rim = [row + 1 == count, column == 0];
                let corner_at = rect.min + vec2(RIM.x, 0.0) + offset;
                let (left, below) = (if rim[1] { RIM.x } else { 0.0 }, if rim[0] { RIM.y } else { 0.0 });
                let place = Rect::from_min_size(corner_at - vec2(left, 0.0), size + vec2(left, below));
                // What is scrolled away need not be drawn.
                if !ui.is_rect_visible(place) {
                    continue;
                }
                let mut child = ui.new_child(UiBuilder::new().id_salt(index).max_rect(place));
                let symbol = |place: usize| drawn.draws.parameters[corner.shown[place]].symbol();
                let name = if row == column {
                    tr!("Plot: draws of {}", symbol(row))
                } else {
                    tr!("Plot: draws of {0} against {1}", symbol(row), symbol(column))
                };
                let Some(response) = panel.tile_ui(&name, place.size(), rim, RIM, &mut child) else { continue };
                if response.response.clicked()
                    && let Some(at) = response.response.interact_pointer_pos()
                {
                    let value = response.transform.value_from_position(at);
                    clicked = Some((column, row, [value.x, value.y]));
                }
            }
        });
        let (column, row, at) = clicked?;
        let axes: Vec<(usize, f64, f64)> = if column == row {
            vec![(corner.shown[column], at[0], corner.ranges[column][1] - corner.ranges[column][0])]
        } else {
            let along = |place: usize, value: f64| (corner.shown[place], value, corner.ranges[place][1] - corner.ranges[place][0]);
            vec![along(column, at[0]), along(row, at[1])]
        };
        nearest(drawn, &axes)
    }
}

/// The draw that comes nearest in those parameters: place among the free ones, value, length of the axis.
fn nearest(drawn: &DrawnPosterior, axes: &[(usize, f64, f64)]) -> Option<Vec<(u64, Parameters)>> {
    let away = |unknowns: &[f64]| axes.iter().map(|&(place, value, length)| ((unknowns[place] - value) / length).powi(2)).sum::<f64>();
    let draw = drawn.draws.draws().min_by(|a, b| away(&a.unknowns).total_cmp(&away(&b.unknowns)))?;
    Some(drawn.from.numbers.iter().copied().zip(draw.parameters.iter().copied()).collect())
}

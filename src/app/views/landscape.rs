//! The objective over two parameters, the others at their sliders: its valleys, the way of the last
//! fits, where they ended, and tabulated metals where the axes are n and k. It follows the sliders;
//! a click puts them there.

mod axes;
mod describe;
mod drawn;
mod key;
mod marks;
mod state;

pub use state::LandscapeView;

use crate::app::jobs::async_memo::AsyncMemo;
use crate::app::plots::{PanelPlot, PanelStyle, Range};
use crate::app::text::i18n;
use crate::app::views::context::{Cx, PaneSpec, View};
use crate::app::work::edit::Edit;
use crate::app::work::settings::LandscapeAxes;
use crate::app::work::workspace::Workspace;
use crate::figure::Figure;
use axes::{axis_over, coordinate, first, tidy, value, whole};
use describe::describe;
use drawn::LandscapeImage;
use egui::{ComboBox, Ui};
use key::LandscapeKey;
use marks::{Marks, MarksKey};
use pbrdf::fit::Loss;
use pbrdf::model::{Parameter, ParameterSet};
use tr::tr;

pub static SPEC: PaneSpec = PaneSpec {
    title: "Landscape",
    tooltip: "The objective over any two parameters: valleys, ways of the last fits, minima; a click sets the sliders",
    shortcut: None,
    has_options: true,
    has_figure: true,
    new: || Box::new(LandscapeView::default()),
};

/// Nodes along a side, at rest and while a slider moves.
const FINE: usize = 256;
const COARSE: usize = 128;
/// The least of both where there are many rows, and the evaluations that decide it.
const LEAST: usize = 16;
const EVALUATIONS: [usize; 2] = [20_000_000, 4_000_000];

/// Nodes along a side for so many rows.
fn nodes(rows: usize, most: usize, evaluations: usize) -> usize {
    (evaluations / rows.max(1)).isqrt().clamp(LEAST, most)
}

impl View for LandscapeView {
    fn refresh(&mut self, cx: &mut Cx<'_>) {
        let (work, settings, surface, document) = (cx.work, cx.work.settings(), cx.work.surface(), cx.work.active());
        let LandscapeAxes { across, up, .. } = settings.panes.landscape;
        let fit = cx.work.shown_fit().map(|fit| &**fit);
        self.marks.refresh(MarksKey::new(work), |key| Marks::new(key, work));
        let [x, y] = self.look_at(across, up);
        let mut others = surface.parameters;
        (others[across], others[up]) = (0.0, 0.0);
        // A value that is not a number would differ from itself, and a job follow a job for ever.
        if across == up || others.to_array().iter().any(|value| !value.is_finite()) {
            self.job = AsyncMemo::default();
            return;
        }
        let (model, fit_options) = (surface.model, settings.fit_options);
        let fitted = fit.filter(|fit| fit.report.model == model && *fit.problem.options() == fit_options);
        let is_scaled = fit_options.loss != Loss::Squared && fit_options.loss_scale.is_none();
        let scale_at = is_scaled.then(|| fitted.map_or(surface.parameters, |fit| fit.report.parameters));
        let rows = document.measurement.rows.len() - document.mask().len();
        let key = |fine: bool| {
            let count = if fine { nodes(rows, FINE, EVALUATIONS[0]) } else { nodes(rows, COARSE, EVALUATIONS[1]) };
            let (across, up) = (axis_over(across, x, count)?, axis_over(up, y, count)?);
            Some(LandscapeKey { generation: document.generation, others, model, fit_options, scale_at, across, up })
        };
        let (Some(fine), Some(coarse)) = (key(true), key(false)) else { return };
        let key = if cx.interacting && self.job.key() != Some(&fine) { coarse.clone() } else { fine };
        self.job.stop_if(|running| !running.is_of_use(&key, &coarse));
        #[cfg(target_arch = "wasm32")]
        if self.refresh_beside(cx, &key) {
            self.refresh_plot(work);
            return;
        }
        let (surface, measurement, made_from) = (surface.clone(), document.measurement.clone(), key.clone());
        self.job.refresh(&cx.jobs.spawner, &key, move |stopped| LandscapeImage::new(surface, &measurement, &made_from, stopped));
        self.refresh_plot(work);
    }

    fn ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let mut axes = cx.work.settings().panes.landscape;
        self.axes_ui(&mut axes, cx.work.surface().model.parameters(), ui);
        if let Some(edit) = changed(cx, axes) {
            self.look_anew(None);
            cx.edits.push(edit);
        }
        let line = ui.text_style_height(&egui::TextStyle::Body) + ui.spacing().item_spacing.y;
        let height = (ui.available_height() - line).max(80.0);
        let reading = self.map_ui(cx, height, ui);
        let is_there = self.job.get().map(Option::is_some);
        let text = reading.unwrap_or_else(|| status(is_there, axes.across == axes.up));
        ui.add(egui::Label::new(text).truncate());
    }

    fn options_ui(&mut self, cx: &mut Cx<'_>, ui: &mut Ui) {
        let mut shown = cx.work.settings().panes.landscape;
        ui.checkbox(&mut shown.contours, tr!("Contours"));
        ui.checkbox(&mut shown.paths, tr!("Ways of the last fits"))
            .on_hover_text(tr!("Seen from above: the other parameters moved too, so that a way need not follow this valley"));
        ui.checkbox(&mut shown.minima, tr!("Minima of the last fit")).on_hover_text(tr!("Where its starts ended, each place once"));
        ui.checkbox(&mut shown.cloud, tr!("Draws from the posterior"))
            .on_hover_text(tr!("Seen from above, whatever their other parameters are"));
        ui.checkbox(&mut shown.metals, tr!("Tabulated metals"))
            .on_hover_text(tr!("All sources at the wavelength of the metals pane, where the axes are n and k"));
        cx.edits.extend(changed(cx, shown));
    }

    fn figure(&self, _cx: &Cx<'_>) -> Option<Figure> {
        self.plot.figure().cloned()
    }

    fn suspend(&mut self) {
        self.job.stop_if(|_| true);
    }

    fn lag(&self) -> u64 {
        self.job.frames_behind()
    }
}

#[cfg(target_arch = "wasm32")]
impl LandscapeView {
    /// Has a worker of the page find the heights; whether there is one.
    fn refresh_beside(&mut self, cx: &Cx<'_>, key: &LandscapeKey) -> bool {
        use crate::app::tasks::landscape_message::{ask, told};
        let (surface, document) = (cx.work.surface(), cx.work.active());
        self.job.refresh_beside(&cx.jobs.spawner, key, || {
            let problem = drawn::problem(surface.clone(), &document.measurement, key)?;
            let (axes, key) = ([key.across, key.up], key.clone());
            let request = ask(&problem, key.scale_at, axes, document)?;
            Some((request, move |answer: &str| {
                Some(told(answer, axes)?.and_then(|landscape| LandscapeImage::of(landscape, &problem, &key)))
            }))
        })
    }
}

/// The edit that sets these axes, if they are others.
fn changed(cx: &Cx<'_>, axes: LandscapeAxes) -> Option<Edit> {
    (axes != cx.work.settings().panes.landscape).then_some(Edit::SetLandscapeAxes(axes))
}

/// What stands under the map while nothing is pointed at; whether there is one is not known before the first was made.
fn status(is_there: Option<bool>, is_one: bool) -> String {
    match is_there {
        _ if is_one => tr!("Both axes are the same parameter: choose another one for one of them."),
        Some(true) => tr!("A click puts both sliders there; drag to move, Ctrl+wheel to zoom."),
        Some(false) => tr!("No landscape: this model predicts nothing of the open measurement, or all of it is masked."),
        None => "…".to_owned(),
    }
}

impl LandscapeView {
    /// What is looked at of these axes: all that is seen first, until the user moves it.
    fn look_at(&mut self, across: Parameter, up: Parameter) -> [Range; 2] {
        match self.look.filter(|look| (look.0, look.1) == (across, up)) {
            Some((.., look)) => look,
            None => {
                let look = [across, up].map(first);
                self.look_anew(Some((across, up, look)));
                look
            }
        }
    }

    /// Looks at other ranges than the user has moved to.
    fn look_anew(&mut self, look: Option<(Parameter, Parameter, [Range; 2])>) {
        self.look = look;
        self.plot.panels().iter_mut().for_each(PanelPlot::look_at_all);
    }

    fn refresh_plot(&mut self, work: &Workspace) {
        let (Some(key), Some(drawn)) = (self.job.key(), self.job.get()) else { return };
        let shown = work.settings().panes.landscape;
        // The marks have other axes than a landscape of before.
        if (key.across.parameter, key.up.parameter) != (shown.across, shown.up) {
            return;
        }
        let sliders = [key.across, key.up].map(|nodes| work.surface().parameters[nodes.parameter]);
        let figure_key = (key.clone(), shown, self.marks.stamp(), sliders.map(f64::to_bits), i18n::current());
        self.plot.refresh(figure_key, |(key, ..)| {
            Some(describe(drawn.as_ref()?, key, self.marks.get(), (shown, sliders), work.active().title()))
        });
    }

    /// The map; what the pointer reads there.
    fn map_ui(&mut self, cx: &mut Cx<'_>, height: f32, ui: &mut Ui) -> Option<String> {
        let (marks, key, drawn) = (self.marks.get(), self.job.key()?, self.job.get()?.as_ref());
        let (across, up) = (key.across.parameter, key.up.parameter);
        let at = |x: f64, y: f64| [coordinate(across, x), coordinate(up, y)];
        let hover = |name: &str, x: f64, y: f64| marks.and_then(|marks| marks.text(name, at(x, y))).unwrap_or(name).to_owned();
        let panel = self.plot.panel(0)?;
        let top = ui.cursor().top();
        panel.key_line_ui(ui);
        let style = PanelStyle::new("landscape", height - (ui.cursor().top() - top), &hover);
        let style = style.named(tr!("Map: the objective over {0} and {1}", across.symbol(), up.symbol()));
        let response = panel.ui(&style, ui)?;
        if response.response.double_clicked() {
            self.look = None;
        } else if panel.is_moved() {
            let bounds = response.transform.bounds();
            let look = [0, 1].map(|side| Range { low: bounds.min()[side], high: bounds.max()[side] });
            if self.look != Some((across, up, look)) {
                self.look = Some((across, up, look));
                ui.ctx().request_repaint();
            }
        }
        let point = response.transform.value_from_position(response.response.hover_pos()?);
        let values = [(across, point.x), (up, point.y)].map(|(parameter, place)| (parameter, tidy(value(parameter, place))));
        if response.response.clicked() && values.iter().all(|(parameter, value)| parameter.domain().contains(*value)) {
            let mut parameters = cx.work.surface().parameters;
            values.iter().for_each(|(parameter, value)| parameters[*parameter] = *value);
            cx.edits.push(Edit::SetParameters(parameters));
        }
        let [x, y] = values.map(|(parameter, value)| format!("{} = {value}", parameter.symbol()));
        Some(match drawn.and_then(|drawn| Some((drawn.title, drawn.at([point.x, point.y])?))) {
            Some((title, objective)) => format!("{x}, {y}: {title} = {objective:.4e}"),
            None => format!("{x}, {y}"),
        })
    }

    fn axes_ui(&mut self, axes: &mut LandscapeAxes, used: ParameterSet, ui: &mut Ui) {
        let LandscapeAxes { across, up, .. } = axes;
        let mut is_reset = false;
        ui.horizontal(|ui| {
            for (id, name, parameter) in [("across", tr!("Across"), across), ("up", tr!("Up"), up)] {
                let label = ui.label(name);
                let combo = ComboBox::from_id_salt(id).width(60.0).selected_text(parameter.symbol());
                let current = *parameter;
                let combo = combo.show_ui(ui, |ui| {
                    for other in Parameter::ALL.into_iter().filter(|other| used.contains(*other) || *other == current) {
                        ui.selectable_value(parameter, other, other.symbol()).on_hover_text(other.name());
                    }
                });
                combo.response.labelled_by(label.id);
            }
            is_reset = ui.button(tr!("Whole ranges")).on_hover_text(tr!("Both axes over the whole ranges of the sliders")).clicked();
        });
        if is_reset {
            self.look_anew(Some((axes.across, axes.up, [axes.across, axes.up].map(whole))));
            // The landscape over them is made before the next frame.
            ui.ctx().request_repaint();
        }
    }
}

#[cfg(test)]
impl LandscapeView {
    /// Whether a landscape is being made.
    pub fn is_running(&self) -> bool {
        self.job.is_running()
    }

    /// The inputs of the newest landscape.
    pub fn key(&self) -> Option<&LandscapeKey> {
        self.job.key()
    }

    /// Whether there is a landscape.
    pub fn is_there(&self) -> bool {
        matches!(self.job.get(), Some(Some(_)))
    }

    pub fn marks(&self) -> Option<&Marks> {
        self.marks.get()
    }

    /// What is looked at of each axis.
    pub fn seen(&self) -> Option<[Range; 2]> {
        self.look.map(|(.., look)| look)
    }
}

#[cfg(test)]
mod tests {
    use super::{LandscapeKey, nodes};
    use pbrdf::fit::{FitOptions, LandscapeAxis};
    use pbrdf::model::{Model, Parameter, Parameters};
    use pbrdf::optics::SlopeDistribution;

    #[test]
    fn a_coarse_landscape_on_the_way_is_worth_waiting_for_and_a_fine_one_is_not() {
        let key = |generation, sigma, count| {
            let axis = |parameter| LandscapeAxis { parameter, low: 1.0, high: 2.0, count, logarithmic: false };
            let others = Parameters { sigma, ..Parameters::default() };
            let model = Model::full(SlopeDistribution::Cauchy);
            let (across, up) = (axis(Parameter::N), axis(Parameter::K));
            LandscapeKey { generation, others, model, fit_options: FitOptions::default(), scale_at: None, across, up }
        };
        let (fine, coarse) = (key(1, 0.3, 256), key(1, 0.3, 128));
        assert!(fine.is_of_use(&fine, &coarse) && key(1, 0.2, 128).is_of_use(&coarse, &coarse));
        assert!(!key(1, 0.2, 256).is_of_use(&coarse, &coarse) && !key(1, 0.2, 256).is_of_use(&fine, &coarse));
        assert!(!key(2, 0.3, 128).is_of_use(&coarse, &coarse));
    }

    #[test]
    fn many_rows_make_a_coarse_landscape() {
        assert_eq!((nodes(27, 256, 20_000_000), nodes(27, 128, 4_000_000), nodes(0, 256, 20_000_000)), (256, 128, 256));
        assert_eq!((nodes(2000, 256, 20_000_000), nodes(1_000_000, 256, 20_000_000)), (100, 16));
    }
}

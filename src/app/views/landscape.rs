//! The objective over two parameters, the others at their sliders: its valleys, the way of the last fits, where they ended, and
//! tabulated metals where the axes are n and k. It follows the sliders; a click puts them there.

mod figure;

pub use figure::landscape_figure;

use super::landscape_marks::{Marks, MarksKey, marks_in};
use crate::app::command::Command;
use crate::app::contours::Heights;
use crate::app::curves::Pieces;
use crate::app::latest_job::{LatestJob, Stopped};
use crate::app::memo::Memo;
use crate::app::plots::axis::{self, axis, decimal, power_of_ten};
use crate::app::plots::{BAR_ROOM, BarLabels, BarMarks, ColorScale, Range, color_bar, ink_on, plot};
use crate::app::problem::problem;
use crate::app::state::{OverTwo, Settings};
use crate::app::window::Explorer;
use egui::{Color32, ColorImage, ComboBox, Role, TextureHandle, TextureOptions, Ui, WidgetInfo, vec2};
use egui_plot::{AxisHints, GridInput, GridMark, HoverPosition, Line, PlotBounds, PlotImage, PlotPoint, PlotPoints, PlotResponse, PlotUi};
use pbrdf::fit::{Axis, Choices, Landscape, Loss, Problem, Weights};
use pbrdf::measurement::Measurement;
use pbrdf::model::{Model, Parameter, ParameterSet, Parameters};
use pbrdf::report::figure::ColorMap;
use std::sync::Arc;
use tr::tr;

/// What the pane keeps.
#[derive(Default)]
pub struct LandscapeView {
    job: LatestJob<Key, Option<Drawn>>,
    textured: Memo<Key, ()>,
    texture: Option<TextureHandle>,
    marks: Memo<MarksKey, Marks>,
    /// The parameters of the axes and what is seen of them, once the plot was drawn.
    seen: Option<(Parameter, Parameter, [Range; 2])>,
    /// What the next frame shows, where that is somewhere else.
    wanted: Option<[Range; 2]>,
}

/// What a landscape depends on: everything but where the sliders of its own two parameters stand.
#[derive(Debug, Clone, PartialEq)]
pub struct Key {
    generation: u64,
    others: Parameters,
    model: Model,
    choices: Choices,
    /// Where the residuals are looked at that set the scale of a robust loss.
    scale_at: Option<Parameters>,
    pub across: Axis,
    pub up: Axis,
}

impl Key {
    /// Whether the landscape of these inputs is worth waiting for while other ones are wanted: under a moving slider each coarse one
    /// is a picture on the way. A fine one, or one of other data, is not.
    fn is_of_use(&self, wanted: &Self, coarse: &Self) -> bool {
        let subject = |key: &Self| (key.generation, key.model, key.choices, key.across.parameter, key.up.parameter, key.across.count);
        self == wanted || subject(self) == subject(coarse)
    }
}

/// A landscape as it is drawn.
pub struct Drawn {
    landscape: Landscape,
    image: Arc<ColorImage>,
    scale: ColorScale,
    contours: Vec<(Color32, Pieces)>,
    title: &'static str,
}

/// Nodes along a side, at rest and while a slider moves.
const FINE: usize = 256;
const COARSE: usize = 128;
/// The least of both where there are many rows, and the evaluations that decide it.
const LEAST: usize = 16;
const EVALUATIONS: [usize; 2] = [20_000_000, 4_000_000];
/// Decades that colours tell apart, from the lowest node upwards.
const DECADES: f64 = 6.0;
/// Lines of equal height at most; from 5 to 1 there are so many more.
const LINES: usize = 12;

/// The coordinate of a value on an axis: its logarithm where the parameter is best walked by factors.
pub fn coordinate(parameter: Parameter, value: f64) -> f64 {
    if parameter.is_logarithmic() { libm::log10(value) } else { value }
}

/// The value at a coordinate.
fn value(parameter: Parameter, coordinate: f64) -> f64 {
    if parameter.is_logarithmic() { libm::exp10(coordinate) } else { coordinate }
}

/// All that the slider reaches; four decades of a weight, whose range begins at 0.
fn whole(parameter: Parameter) -> Range {
    let (low, high) = parameter.range().into_inner();
    let low = if parameter.is_logarithmic() { low.max(1e-4 * high) } else { low };
    Range { low: coordinate(parameter, low), high: coordinate(parameter, high) }
}

/// What is seen first: of n and k where metals are in the visible, of the others all.
fn first(parameter: Parameter) -> Range {
    match parameter {
        Parameter::N => Range { low: coordinate(parameter, 0.03), high: coordinate(parameter, 10.0) },
        Parameter::K => Range { low: 0.0, high: 9.0 },
        _ => whole(parameter),
    }
}

/// The axis over what is seen, as far as there are surfaces.
fn axis_over(parameter: Parameter, seen: Range, count: usize) -> Option<Axis> {
    let [low, high] = [seen.low, seen.high].map(|coordinate| value(parameter, coordinate));
    let low = if parameter.domain().contains(low) { low } else { whole_low(parameter) };
    let is_sound = low.is_finite() && high.is_finite() && low < high && parameter.domain().contains(low);
    is_sound.then_some(Axis { parameter, low, high, count, logarithmic: parameter.is_logarithmic() })
}

fn whole_low(parameter: Parameter) -> f64 {
    *parameter.range().start()
}

/// Nodes along a side for so many rows.
fn nodes(rows: usize, most: usize, evaluations: usize) -> usize {
    (evaluations / rows.max(1)).isqrt().clamp(LEAST, most)
}

impl Drawn {
    /// Of the measurement with the choices of the settings; none where there is no problem or no node has a value.
    fn new(mut settings: Settings, measurement: &Measurement, key: &Key, stopped: Stopped<'_>) -> Option<Self> {
        let free = ParameterSet::EMPTY.with(key.across.parameter).with(key.up.parameter);
        // Where its own two sliders stand is no matter, not even if that is nowhere.
        for axis in [key.across, key.up] {
            settings.parameters[axis.parameter] = axis.low;
        }
        let problem = problem(&settings, measurement, settings.model, free, settings.choices).ok()?;
        let problem = key.scale_at.map_or_else(|| problem.clone(), |at| problem.with_loss_scale_of(&at));
        let landscape = Landscape::minimised(&problem, key.across, key.up, stopped)?;
        let heights: Vec<f64> = landscape.objective.iter().map(|objective| libm::log10(*objective)).collect();
        let finite = || heights.iter().copied().filter(|height| height.is_finite());
        let highest = finite().fold(f64::NEG_INFINITY, f64::max);
        let lowest = finite().fold(f64::INFINITY, f64::min);
        if lowest > highest {
            return None;
        }
        // By quarters of a decade, so that colours do not flicker while a slider moves.
        let high = 0.25 * (4.0 * highest).ceil();
        let low = (0.25 * (4.0 * lowest).floor()).clamp(high - DECADES, high - 0.25);
        let scale = ColorScale { map: ColorMap::Sequential, range: Range { low, high } };
        let table = scale.table();
        // The first row of an image is the uppermost.
        let rows = heights.chunks(key.across.count).rev().flatten();
        let image = ColorImage::new([key.across.count, key.up.count], rows.map(|height| table.color(*height)).collect());
        let contours = contours(&heights, key, scale);
        Some(Self { landscape, image: Arc::new(image), scale, contours, title: title(&problem) })
    }

    /// The number at the node nearest to a point of the plot.
    fn at(&self, point: PlotPoint) -> Option<f64> {
        let index = |axis: Axis, place: f64| {
            let [low, high] = [axis.low, axis.high].map(|value| coordinate(axis.parameter, value));
            #[expect(clippy::cast_precision_loss, reason = "a number of nodes")]
            let place = ((place - low) / (high - low) * (axis.count - 1) as f64).round();
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked to be 0 or more")]
            (place >= 0.0).then_some(place as usize).filter(|index| *index < axis.count)
        };
        let (column, row) = (index(self.landscape.across, point.x)?, index(self.landscape.up, point.y)?);
        self.landscape.objective.get(row * self.landscape.across.count + column).copied().filter(|objective| objective.is_finite())
    }
}

/// What is minimised.
fn title(problem: &Problem) -> &'static str {
    match problem.choices().weights {
        _ if problem.minimises_delta_e() => "ΔE",
        Weights::Sigma if problem.choices().loss == Loss::Linear => "χ²",
        _ => "Σ r²",
    }
}

/// Lines at 1, 2 and 5 times powers of ten, or at powers of ten alone, in the coordinates of the plot.
fn contours(heights: &[f64], key: &Key, scale: ColorScale) -> Vec<(Color32, Pieces)> {
    let Range { low, high } = scale.range;
    let levels = |factors: &[f64]| -> Vec<f64> {
        #[expect(clippy::cast_possible_truncation, reason = "a few decades")]
        let decades = low.floor() as i32..=high.ceil() as i32;
        let all = decades.flat_map(|decade| factors.iter().map(move |factor| f64::from(decade) + libm::log10(*factor)));
        all.filter(|level| *level > low && *level < high).collect()
    };
    let levels = [levels(&[1.0, 2.0, 5.0]), levels(&[1.0, 3.0])].into_iter().find(|levels| levels.len() <= LINES);
    let levels = levels.unwrap_or_else(|| (1..LINES).map(|i| low + (high - low) * f64_of(i) / f64_of(LINES)).collect());
    let place = |axis: Axis, index: f64| {
        let [low, high] = [axis.low, axis.high].map(|value| coordinate(axis.parameter, value));
        low + (high - low) * index / f64_of(axis.count - 1)
    };
    let grid = Heights { values: heights, columns: key.across.count };
    let pieces = |level: f64| -> Pieces {
        let points =
            |line: Vec<(f64, f64)>| line.into_iter().map(|(x, y)| PlotPoint::new(place(key.across, x), place(key.up, y))).collect();
        grid.lines(level).into_iter().map(points).collect()
    };
    levels.into_iter().map(|level| (ink_on(scale.color(level)).gamma_multiply(0.55), pieces(level))).collect()
}

#[expect(clippy::cast_precision_loss, reason = "a small number")]
fn f64_of(count: usize) -> f64 {
    count as f64
}

pub fn landscape_refresh(explorer: &mut Explorer) {
    let Explorer { settings, document, views, background, dragging, last_fit, past_fits, .. } = explorer;
    let view = &mut views.landscape;
    let OverTwo { across, up, .. } = settings.landscape;
    let seen = view.seen.filter(|seen| (seen.0, seen.1) == (across, up)).map(|(_, _, seen)| seen);
    if seen.is_none() {
        view.wanted = Some([first(across), first(up)]);
    }
    let Some([x, y]) = view.wanted.or(seen) else { return };
    view.marks.refresh(MarksKey::new(settings, document, past_fits, last_fit.as_deref()), |key| {
        Marks::new(key, past_fits, last_fit.as_deref(), document)
    });
    let mut others = settings.parameters;
    (others[across], others[up]) = (0.0, 0.0);
    // A value that is not a number would differ from itself, and a job follow a job for ever.
    if across == up || others.to_array().iter().any(|value| !value.is_finite()) {
        view.job = LatestJob::default();
        return;
    }
    let Settings { model, choices, .. } = *settings;
    let fitted = last_fit.as_ref().filter(|fit| fit.report.model == model && *fit.problem.choices() == choices);
    let is_scaled = choices.loss != Loss::Linear && choices.loss_scale.is_none();
    let scale_at = is_scaled.then(|| fitted.map_or(settings.parameters, |fit| fit.report.parameters));
    let rows = document.measurement.rows.len() - document.mask().len();
    let key = |fine: bool| {
        let count = if fine { nodes(rows, FINE, EVALUATIONS[0]) } else { nodes(rows, COARSE, EVALUATIONS[1]) };
        let (across, up) = (axis_over(across, x, count)?, axis_over(up, y, count)?);
        Some(Key { generation: document.generation, others, model, choices, scale_at, across, up })
    };
    let (Some(fine), Some(coarse)) = (key(true), key(false)) else { return };
    let key = if *dragging && view.job.key() != Some(&fine) { coarse.clone() } else { fine };
    view.job.stop_if(|running| !running.is_of_use(&key, &coarse));
    let (settings, measurement, made_from) = (settings.clone(), document.measurement.clone(), key.clone());
    view.job.refresh(background, &key, move |stopped| Drawn::new(settings, &measurement, &made_from, stopped));
}

/// What is drawn in the pane.
pub fn landscape_options_ui(explorer: &mut Explorer, ui: &mut Ui) {
    let shown = &mut explorer.settings.landscape;
    ui.checkbox(&mut shown.contours, tr!("Contours"));
    ui.checkbox(&mut shown.paths, tr!("Ways of the last fits"))
        .on_hover_text(tr!("Seen from above: the other parameters moved too, so that a way need not follow this valley"));
    ui.checkbox(&mut shown.minima, tr!("Minima of the last fit")).on_hover_text(tr!("Where its starts ended, each place once"));
    ui.checkbox(&mut shown.metals, tr!("Tabulated metals"))
        .on_hover_text(tr!("All sources at the wavelength of the metals pane, where the axes are n and k"));
}

pub fn landscape_ui(explorer: &mut Explorer, ui: &mut Ui) {
    axes_ui(explorer, ui);
    let OverTwo { across, up, .. } = explorer.settings.landscape;
    let line = ui.text_style_height(&egui::TextStyle::Body) + ui.spacing().item_spacing.y;
    let height = (ui.available_height() - line).max(80.0);
    let response = map_ui(explorer, height, ui);
    let name = || WidgetInfo::labeled(Role::Image, true, tr!("Map: the objective over {0} and {1}", across.symbol(), up.symbol()));
    response.response.widget_info(name);
    let Explorer { commands, views, .. } = explorer;
    let view = &mut views.landscape;
    let bounds = response.transform.bounds();
    let [x, y] = [0, 1].map(|side| Range { low: bounds.min()[side], high: bounds.max()[side] });
    if view.seen != Some((across, up, [x, y])) {
        view.seen = Some((across, up, [x, y]));
        ui.ctx().request_repaint();
    }
    let rect = response.response.rect;
    let drawn = view.job.get().and_then(Option::as_ref);
    if let Some(drawn) = drawn {
        let at = rect.right_top() + vec2(14.0, 20.0);
        let labels = BarLabels { title: drawn.title, marks: BarMarks::Log };
        color_bar(ui, at, (rect.height() - 24.0).max(20.0), drawn.scale, &labels, ui.visuals().text_color(), ui.visuals().dark_mode);
    }
    let pointed = response.response.hover_pos().map(|at| response.transform.value_from_position(at));
    let values = |point: PlotPoint| [(across, point.x), (up, point.y)].map(|(parameter, place)| (parameter, tidy(value(parameter, place))));
    if let Some(point) = pointed.filter(|_| response.response.clicked())
        && values(point).iter().all(|(parameter, value)| parameter.domain().contains(*value))
    {
        commands.push(Command::SetParameters(values(point).to_vec()));
    }
    let reading = pointed.map(|point| {
        let [x, y] = values(point).map(|(parameter, value)| format!("{} = {value}", parameter.symbol()));
        match drawn.and_then(|drawn| Some((drawn.title, drawn.at(point)?))) {
            Some((title, objective)) => format!("{x}, {y}: {title} = {objective:.4e}"),
            None => format!("{x}, {y}"),
        }
    });
    ui.add(egui::Label::new(reading.unwrap_or_else(|| status(drawn.is_some(), across == up))).truncate());
}

/// What stands under the map while nothing is pointed at.
fn status(is_there: bool, is_one: bool) -> String {
    if is_one {
        tr!("Both axes are the same parameter: choose another one for one of them.")
    } else if is_there {
        tr!("A click puts both sliders there; drag to move, Ctrl+wheel to zoom.")
    } else {
        tr!("No landscape: the open measurement has nothing that this model predicts, or all of it is masked.")
    }
}

/// Four digits: what a click can mean.
fn tidy(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

fn axes_ui(explorer: &mut Explorer, ui: &mut Ui) {
    let Explorer { settings, views, .. } = explorer;
    let used = settings.model.parameters();
    let OverTwo { across, up, .. } = &mut settings.landscape;
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
        let OverTwo { across, up, .. } = settings.landscape;
        views.landscape.wanted = Some([across, up].map(whole));
        // The landscape over them is made before the next frame.
        ui.ctx().request_repaint();
    }
}

/// The map with what lies on it.
fn map_ui(explorer: &mut Explorer, height: f32, ui: &mut Ui) -> PlotResponse<()> {
    let Explorer { settings, views, .. } = explorer;
    let view = &mut views.landscape;
    let shown = settings.landscape;
    let drawn = view.job.get().and_then(Option::as_ref);
    if let (Some(key), Some(drawn)) = (view.job.key(), drawn) {
        let (texture, ctx) = (&mut view.texture, ui.ctx());
        view.textured.refresh(key.clone(), |_| match texture {
            Some(texture) => texture.set(drawn.image.clone(), TextureOptions::LINEAR),
            None => *texture = Some(ctx.load_texture("landscape", drawn.image.clone(), TextureOptions::LINEAR)),
        });
    }
    let (wanted, seen) = (view.wanted.take(), view.seen.map(|(_, _, seen)| seen));
    let format = |parameter: Parameter| if parameter.is_logarithmic() { logarithmic } else { decimal };
    let marks = view.marks.get();
    let x = axis(AxisHints::new_x(), ui, shown.across.symbol(), format(shown.across)).min_thickness(36.0);
    let y = axis(AxisHints::new_y(), ui, shown.up.symbol(), format(shown.up));
    plot("landscape", ui, height, x, y)
        .width((ui.available_width() - BAR_ROOM).max(80.0))
        .x_grid_spacer(move |input| grid(shown.across, &input, 7.0))
        .y_grid_spacer(move |input| grid(shown.up, &input, 5.0))
        .show_grid(false)
        .legend(crate::app::plots::legend().position(egui_plot::Corner::LeftTop))
        .label_formatter(|hover: &HoverPosition<'_>| match hover {
            HoverPosition::NearDataPoint { plot_name, index, .. } => marks.and_then(|marks| marks.text(plot_name, *index)),
            HoverPosition::Elsewhere { .. } => None,
        })
        .show(ui, |plot| {
            // A plot that was closed and opened again has forgotten where it was.
            let forgotten = seen.filter(|[x, y]| plot.plot_bounds() != PlotBounds::from_min_max([x.low, y.low], [x.high, y.high]));
            if let Some([x, y]) = wanted.or(forgotten) {
                plot.set_plot_bounds_x(x.low..=x.high);
                plot.set_plot_bounds_y(y.low..=y.high);
            }
            if let (Some(drawn), Some(texture)) = (drawn, &view.texture) {
                drawn_in(plot, drawn, texture, shown.contours);
            }
            if let Some(marks) = marks {
                marks_in(plot, marks, shown);
            }
            let sliders = [shown.across, shown.up].map(|parameter| coordinate(parameter, settings.parameters[parameter]));
            if sliders.iter().all(|place| place.is_finite()) {
                super::landscape_marks::sliders_in(plot, sliders);
            }
        })
}

fn drawn_in<'a>(plot: &mut PlotUi<'a>, drawn: &'a Drawn, texture: &TextureHandle, with_contours: bool) {
    let ends = |axis: Axis| [axis.low, axis.high].map(|value| coordinate(axis.parameter, value));
    let ([left, right], [bottom, top]) = (ends(drawn.landscape.across), ends(drawn.landscape.up));
    let center = PlotPoint::new(f64::midpoint(left, right), f64::midpoint(bottom, top));
    #[expect(clippy::cast_possible_truncation, reason = "a size on the screen")]
    let size = vec2((right - left) as f32, (top - bottom) as f32);
    plot.image(PlotImage::new("", texture.id(), center, size).allow_hover(false));
    for (color, pieces) in drawn.contours.iter().filter(|_| with_contours) {
        for piece in pieces {
            plot.line(Line::new("", PlotPoints::Borrowed(piece)).color(*color).width(1.0).allow_hover(false));
        }
    }
}

/// Marks of an axis, so many smallest spacings apart; of logarithms at 1, 2 and 5 times powers of ten where there is room.
fn grid(parameter: Parameter, input: &GridInput, spread: f64) -> Vec<GridMark> {
    let (low, high) = input.bounds;
    if !parameter.is_logarithmic() {
        return axis::marks(input, spread, 0.0);
    }
    if high - low < 1.0 {
        // At round values, nowhere closer than at the upper end.
        let (first, last) = (libm::exp10(low), libm::exp10(high));
        let base_step_size = std::f64::consts::LN_10 * last * input.base_step_size;
        let marks = axis::marks(&GridInput { bounds: (first, last), base_step_size }, spread, 0.0);
        return marks.into_iter().map(|mark| GridMark { value: libm::log10(mark.value), ..mark }).collect();
    }
    // From 1 to 2 is 0.3 of a decade.
    if 0.3 < 0.7 * spread * input.base_step_size {
        return axis::marks(input, spread, 1.0);
    }
    let mut marks = Vec::new();
    let mut decade = low.floor();
    while decade <= high {
        marks.extend([1.0, 2.0, 5.0].map(|factor| GridMark { value: decade + libm::log10(factor), step_size: 1.0 }));
        decade += 1.0;
    }
    marks.retain(|mark| mark.value >= low && mark.value <= high);
    marks
}

/// A mark of an axis of logarithms: the value itself.
fn logarithmic(exponent: f64, step_size: f64) -> String {
    if (-4.0..=4.0).contains(&exponent) { tidy(libm::exp10(exponent)).to_string() } else { power_of_ten(exponent, step_size) }
}

impl LandscapeView {
    /// Stops the job on its way, where nobody looks.
    pub fn rest(&mut self) {
        self.job.stop_if(|_| true);
    }

    /// How many frames the landscape is behind the sliders.
    pub fn frames_behind(&self) -> u64 {
        self.job.frames_behind()
    }
}

#[cfg(test)]
impl LandscapeView {
    /// Whether a landscape is being made.
    pub fn is_running(&self) -> bool {
        self.job.is_running()
    }

    /// The inputs of the newest landscape.
    pub fn key(&self) -> Option<&Key> {
        self.job.key()
    }

    /// Whether there is a landscape.
    pub fn is_there(&self) -> bool {
        matches!(self.job.get(), Some(Some(_)))
    }

    pub fn marks(&self) -> Option<&Marks> {
        self.marks.get()
    }

    /// Where a value of each axis lies on the screen.
    pub fn seen(&self) -> Option<[Range; 2]> {
        self.seen.map(|(_, _, seen)| seen)
    }
}

#[cfg(test)]
mod tests {
    use super::{Key, Range, axis_over, coordinate, nodes, tidy, value, whole};
    use pbrdf::fit::{Axis, Choices};
    use pbrdf::model::{Model, Parameter, Parameters};
    use pbrdf::optics::SlopeDistribution;

    #[test]
    fn a_coarse_landscape_on_the_way_is_worth_waiting_for_and_a_fine_one_is_not() {
        let key = |generation, sigma, count| {
            let axis = |parameter| Axis { parameter, low: 1.0, high: 2.0, count, logarithmic: false };
            let others = Parameters { sigma, ..Parameters::default() };
            let model = Model::full(SlopeDistribution::Cauchy);
            let (across, up) = (axis(Parameter::N), axis(Parameter::K));
            Key { generation, others, model, choices: Choices::default(), scale_at: None, across, up }
        };
        let (fine, coarse) = (key(1, 0.3, 256), key(1, 0.3, 128));
        assert!(fine.is_of_use(&fine, &coarse) && key(1, 0.2, 128).is_of_use(&coarse, &coarse));
        assert!(!key(1, 0.2, 256).is_of_use(&coarse, &coarse) && !key(1, 0.2, 256).is_of_use(&fine, &coarse));
        assert!(!key(2, 0.3, 128).is_of_use(&coarse, &coarse));
    }

    #[test]
    fn every_axis_over_the_whole_range_is_sound_and_values_come_back() {
        for parameter in Parameter::ALL {
            let range = whole(parameter);
            let axis = axis_over(parameter, range, 16).expect("a range of values");
            assert!(parameter.domain().contains(axis.low) && parameter.domain().contains(axis.high), "{}", parameter.key());
            let back = coordinate(parameter, value(parameter, range.high));
            assert!((back - range.high).abs() < 1e-12);
        }
    }

    #[test]
    fn an_axis_stops_where_surfaces_stop() {
        let axis = axis_over(Parameter::K, Range { low: -3.0, high: 5.0 }, 16).expect("half of it is a range");
        assert_eq!((axis.low, axis.high), (0.0, 5.0));
        assert_eq!(axis_over(Parameter::K, Range { low: -3.0, high: -1.0 }, 16), None);
    }

    #[test]
    fn many_rows_make_a_coarse_landscape() {
        assert_eq!((nodes(27, 256, 20_000_000), nodes(27, 128, 4_000_000), nodes(0, 256, 20_000_000)), (256, 128, 256));
        assert_eq!((nodes(2000, 256, 20_000_000), nodes(1_000_000, 256, 20_000_000)), (100, 16));
        assert_eq!((tidy(2.037_19), tidy(1.0)), (2.037, 1.0));
    }
}

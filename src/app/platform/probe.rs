//! What stands where in the window, for a program that tries it out: a page draws it all into one
//! canvas, which tells a driver of browsers nothing.

use egui::accesskit::Node;
use serde::Serialize;
use wasm_bindgen::JsValue;

/// The variable of the page that holds the widgets of the last frame, a list as JSON.
const VARIABLE: &str = "widgets";

/// A widget as readers of screens are told of it.
#[derive(Serialize)]
struct Widget<'a> {
    role: String,
    label: &'a str,
    value: &'a str,
    number: Option<f64>,
    /// Left, top, right, bottom; in points of the page.
    place: [f64; 4],
}

/// Tells the widgets of every frame.
struct Probe;

/// Begins to tell the page what stands where.
pub fn tell_widgets(ctx: &egui::Context) {
    ctx.enable_accesskit();
    ctx.add_plugin(Probe);
}

impl egui::Plugin for Probe {
    fn debug_name(&self) -> &'static str {
        "probe"
    }

    fn output_hook(&mut self, ctx: &egui::Context, output: &mut egui::FullOutput) {
        let Some(update) = &output.platform_output.accesskit_update else { return };
        let zoom = f64::from(ctx.zoom_factor());
        // A slider has its name from the label beside it.
        let label_beside = |node: &Node| {
            let beside = update.nodes.iter().find(|(id, _)| node.labelled_by().contains(id));
            beside.and_then(|(_, label)| label.label().or(label.value())).unwrap_or_default()
        };
        let widget = |(_, node): &'_ (_, Node)| {
            let bounds = node.bounds()?;
            let place = [bounds.x0, bounds.y0, bounds.x1, bounds.y1].map(|at| at * zoom);
            let (label, value) = (node.label().unwrap_or_else(|| label_beside(node)), node.value().unwrap_or_default());
            serde_json::to_string(&Widget { role: format!("{:?}", node.role()), label, value, number: node.numeric_value(), place }).ok()
        };
        let widgets: Vec<String> = update.nodes.iter().filter_map(widget).collect();
        let _ = js_sys::Reflect::set(&js_sys::global(), &VARIABLE.into(), &JsValue::from_str(&format!("[{}]", widgets.join(","))));
    }
}

//! The rows above the picture: what is seen, under which light, through which analyser, beside which surface.

use crate::app::views::picture::painted::texts;
use crate::app::work::picture_options::{PictureCompanion, PictureOptions};
use crate::app::work::surface::{PinnedSurface, another};
use crate::report::PictureQuantity;
use egui::{ComboBox, DragValue, Role, Slider, Ui, WidgetInfo};
use pbrdf::model::Shape;
use pbrdf::optics::SlopeDistribution;
use tr::tr;

fn shape_name(shape: Shape) -> String {
    match shape {
        Shape::Cylinder => tr!("Cylinder"),
        Shape::Plate => tr!("Plate"),
        Shape::Relief => tr!("Relief"),
        _ => tr!("Sphere"),
    }
}

/// Shape and quantity.
pub fn content_ui(set: &mut PictureOptions, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        // All on one line beside a panel at a projector.
        ui.spacing_mut().item_spacing.x = 2.0;
        for shape in Shape::ALL {
            ui.selectable_value(&mut set.shape, shape, shape_name(shape));
        }
        ui.separator();
        for quantity in PictureQuantity::ALL {
            let [name, help] = texts(quantity);
            ui.selectable_value(&mut set.quantity, quantity, name).on_hover_text(help);
        }
    });
}

/// A field with an angle in degrees that a screen reader calls by that name.
fn angle_ui(value: &mut f64, range: std::ops::RangeInclusive<f64>, name: &str, ui: &mut Ui) {
    let field = ui.add(DragValue::new(value).range(range).speed(0.5).max_decimals(1).suffix("°"));
    let degrees = *value;
    field.widget_info(|| WidgetInfo { value: Some(degrees), label: Some(name.to_owned()), ..WidgetInfo::new(Role::SpinButton) });
    field.on_hover_text(name);
}

/// Lamp and sky.
pub fn light_ui(set: &mut PictureOptions, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        ui.checkbox(&mut set.lamp, tr!("Lamp"))
            .on_hover_text(tr!("A distant, unpolarised lamp; drag on the picture to move its highlight"));
        ui.add_enabled_ui(set.lamp, |ui| {
            angle_ui(&mut set.polar, 0.0..=180.0, &tr!("Angle of the lamp from the camera"), ui);
            angle_ui(&mut set.azimuth, -180.0..=360.0, &tr!("Azimuth of the lamp, from right to up"), ui);
        });
        ui.separator();
        ui.checkbox(&mut set.sky, tr!("Sky")).on_hover_text(tr!("A uniform, unpolarised sky"));
        ui.add_enabled_ui(set.sky, |ui| {
            let name = tr!("Radiance of the sky");
            let radiance = set.sky_radiance;
            let field = ui.add(DragValue::new(&mut set.sky_radiance).range(0.0..=100.0).speed(0.01).max_decimals(3));
            field.widget_info(|| WidgetInfo { value: Some(radiance), label: Some(name.clone()), ..WidgetInfo::new(Role::SpinButton) });
            field.on_hover_text(&name);
        });
    });
}

/// The analyser, where it is looked through.
pub fn analyser_ui(set: &mut PictureOptions, turned: &mut Option<f64>, ui: &mut Ui) {
    if set.quantity != PictureQuantity::Analyser {
        *turned = None;
        return;
    }
    ui.horizontal_wrapped(|ui| {
        let mut angle = (set.analyser + turned.unwrap_or(0.0)).rem_euclid(180.0);
        let slider = ui.add(Slider::new(&mut angle, 0.0..=180.0).suffix("°").max_decimals(1).text(tr!("analyser")));
        if slider.on_hover_text(tr!("Angle of its axis, from right to up")).changed() {
            (*turned, set.analyser) = (None, angle);
        }
        let mut turns = turned.is_some();
        if ui.checkbox(&mut turns, tr!("Turn")).on_hover_text(tr!("The analyser turns by itself")).changed() {
            // Where it stops it stays.
            set.analyser = angle;
            *turned = turns.then_some(0.0);
        }
    });
}

/// What the halves of the picture are of: the sliders, and the surface beside them.
pub fn half_names(companion: PictureCompanion, own: SlopeDistribution, pinned: &[PinnedSurface]) -> Option<[String; 2]> {
    let name = |distribution| match distribution {
        SlopeDistribution::Gauss => tr!("Gauss"),
        SlopeDistribution::Cauchy => tr!("Cauchy"),
    };
    match companion {
        PictureCompanion::Nothing => None,
        PictureCompanion::OtherDistribution => Some([own, another(own)].map(name)),
        PictureCompanion::Pinned(place) => pinned.get(place).map(|pin| [tr!("sliders"), pin.name.clone()]),
    }
}

/// The surface beside that of the sliders.
pub fn companion_ui(set: &mut PictureOptions, own: SlopeDistribution, pinned: &[PinnedSurface], ui: &mut Ui) {
    let name = |companion: PictureCompanion| match (companion, another(own)) {
        (PictureCompanion::Nothing, _) => tr!("nothing"),
        (PictureCompanion::OtherDistribution, SlopeDistribution::Gauss) => tr!("Gauss, equal median slope"),
        (PictureCompanion::OtherDistribution, SlopeDistribution::Cauchy) => tr!("Cauchy, equal median slope"),
        (PictureCompanion::Pinned(place), _) => pinned.get(place).map_or_else(|| tr!("nothing"), |pin| pin.name.clone()),
    };
    ui.horizontal_wrapped(|ui| {
        ui.label(tr!("Beside it"));
        let pins = (0..pinned.len()).map(PictureCompanion::Pinned);
        let combo = ComboBox::from_id_salt("picture companion").width(190.0).selected_text(name(set.companion)).show_ui(ui, |ui| {
            for companion in [PictureCompanion::Nothing, PictureCompanion::OtherDistribution].into_iter().chain(pins) {
                ui.selectable_value(&mut set.companion, companion, name(companion));
            }
        });
        combo.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, tr!("Beside it")));
        let is_there = set.companion != PictureCompanion::Nothing;
        for (difference, name, help) in [
            (false, tr!("Halves"), tr!("Sliders on the left, the other on the right")),
            (true, tr!("Difference"), tr!("The other less the sliders")),
        ] {
            let button = egui::Button::selectable(set.difference == difference, name);
            if ui.add_enabled(is_there, button).on_hover_text(help).clicked() {
                set.difference = difference;
            }
        }
    });
}

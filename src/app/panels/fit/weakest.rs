//! The direction that the data determine least: sliders move along it while the curves hardly change.

use crate::app::text::localized::Localized as _;
use crate::app::views::Cx;
use crate::app::views::action::{Action, InquiryAction};
use crate::app::work::edit::Edit;
use crate::app::work::weakest_walk::WeakestWalk;
use egui::{Button, Label, Slider, Ui};
use pbrdf::fit::{GeodesicWay, UnknownName as _};
use tr::tr;

pub fn weakest_ui(cx: &mut Cx<'_>, ui: &mut Ui) {
    let fits = &cx.jobs.fits;
    let (is_sought, is_walking) = (fits.walk.is_running(), fits.walking_since.is_some());
    let walk = cx.work.walk().cloned();
    ui.horizontal(|ui| {
        let help =
            tr!("Sliders move from the fit along the direction that the data determine least, until a bound is met: a geodesic of the \
             model manifold (Transtrum and Qiu, PRL 113, 098701 (2014)). The curves hardly change: as many surfaces fit these data.");
        if ui.add_enabled(!is_sought && !is_walking, Button::new(tr!("Weakest direction"))).on_hover_text(help).clicked() {
            cx.actions.push(Action::Inquire(InquiryAction::Walk(GeodesicWay::Nearer)));
        }
        if is_walking {
            if ui.button(tr!("Stop")).on_hover_text(tr!("Sliders stay where they are; Esc takes them back to the fit")).clicked() {
                cx.actions.push(Action::Inquire(InquiryAction::StopWalk));
            }
        } else if let Some((walk, _)) = &walk {
            let other = if walk.way == GeodesicWay::Nearer { GeodesicWay::Farther } else { GeodesicWay::Nearer };
            if ui.button(tr!("The other way")).on_hover_text(tr!("From the fit in the opposite sense")).clicked() {
                cx.actions.push(Action::Inquire(InquiryAction::Walk(other)));
            }
        }
        if is_sought {
            ui.spinner();
        }
    });
    if let Some((walk, share)) = walk {
        walk_ui(&walk, share, cx, ui);
    }
}

fn walk_ui(walk: &WeakestWalk, share: f64, cx: &mut Cx<'_>, ui: &mut Ui) {
    let mut percent = 100.0 * share;
    let slider = Slider::new(&mut percent, 0.0..=100.0).suffix(" %").fixed_decimals(0).text(tr!("of the way"));
    if ui.add(slider).changed() {
        cx.edits.push(Edit::WalkTo(0.01 * percent));
    }
    let arrow = |along: f64| if along > 0.0 { "↑" } else { "↓" };
    let movers: Vec<String> = walk.movers().iter().map(|(name, along)| format!("{} {}", name.symbol(), arrow(*along))).collect();
    ui.label(tr!("It begins with {}", movers.join(", ")));
    if let Some(rise) = walk.rise(share) {
        ui.label(tr!("Sum of squares: {} % of the rise that the data allow at 95 %", format!("{:.0}", 100.0 * rise)));
    }
    ui.add(Label::new(tr!("At its end: {}.", walk.geodesic.end.localized())).wrap());
}

//! Small screens, and frames in other pages.

use crate::app::shell::room::{Below, Query};
use crate::app::tests::{explorer, harness, wait};
use crate::app::views::action::{Action, WindowAction};
use crate::app::work::pane_id::PaneId;
use egui_kittest::kittest::Queryable as _;

#[test]
fn a_small_screen_has_one_pane_and_the_sliders_and_the_works_own_arrangement_stays() {
    let mut window = harness();
    let (before, on_screen) = (explorer(&mut window).work.layout().clone(), explorer(&mut window).dock.on_screen());
    assert!(on_screen.len() > 1);
    explorer(&mut window).dialogs.room.may_be_small = true;
    window.set_size(egui::vec2(844.0, 390.0));
    wait(&mut window);
    assert_eq!(explorer(&mut window).dock.on_screen(), on_screen[..1]);
    explorer(&mut window).actions.push(Action::Window(WindowAction::ShowPane(PaneId::Lobes)));
    wait(&mut window);
    assert_eq!(explorer(&mut window).dock.on_screen(), [PaneId::Lobes]);
    window.get_by_label("Pane alone").click();
    wait(&mut window);
    assert_eq!(explorer(&mut window).dialogs.room.below, Below::Nothing);
    // A lesson's panes come one by one as well.
    explorer(&mut window).actions.push(Action::ShowStep(1, 0));
    wait(&mut window);
    assert_eq!(explorer(&mut window).dock.on_screen().len(), 1);
    explorer(&mut window).actions.push(Action::CloseLesson);
    wait(&mut window);
    assert_eq!(*explorer(&mut window).work.layout(), before);
    window.set_size(egui::vec2(1280.0, 800.0));
    wait(&mut window);
    assert_eq!(explorer(&mut window).dock.on_screen(), on_screen);
}

#[test]
fn a_frame_shows_what_its_address_asks_for_through_all_of_a_lesson() {
    let mut window = harness();
    explorer(&mut window).dialogs.room.embedded = Query::new("?embed=dolp,lobes").embedded;
    explorer(&mut window).actions.push(Action::ShowStep(1, 0));
    wait(&mut window);
    assert_eq!(explorer(&mut window).dock.on_screen(), [PaneId::Dolp, PaneId::Lobes]);
    assert!(window.query_by_label("File").is_none() && window.query_by_label("Fit").is_none());
    for step in 1..explorer(&mut window).lessons.all[1].steps.len() {
        explorer(&mut window).actions.push(Action::ShowStep(1, step));
        wait(&mut window);
        assert_eq!(explorer(&mut window).dock.on_screen(), [PaneId::Dolp, PaneId::Lobes]);
    }
}

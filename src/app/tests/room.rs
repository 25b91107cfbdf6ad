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

#[test]
fn a_lesson_is_read_on_a_small_screen_and_its_sliders_are_one_choice_away() {
    // A phone on its side, and upright: beside the pane, and below it.
    for size in [egui::vec2(844.0, 390.0), egui::vec2(390.0, 844.0)] {
        let mut window = harness();
        explorer(&mut window).dialogs.room.may_be_small = true;
        window.set_size(size);
        wait(&mut window);
        assert!(window.query_by_label("Lesson").is_none());
        explorer(&mut window).actions.push(Action::ShowStep(0, 0));
        wait(&mut window);
        assert_eq!(explorer(&mut window).dialogs.room.below, Below::Lesson);
        let text = explorer(&mut window).lessons.current().expect("a lesson").1.watch.in_language("en").to_owned();
        assert!(window.query_by_label_contains(&text).is_some(), "what to watch is told");
        window.get_by_label("Sliders").click();
        wait(&mut window);
        assert!(window.query_by_label_contains(&text).is_none());
        window.get_by_label("Lesson").click();
        wait(&mut window);
        window.get_by_label("Next step").click();
        wait(&mut window);
        assert_eq!(explorer(&mut window).lessons.open(), Some((0, 1)));
        window.get_by_label("Close lesson").click();
        wait(&mut window);
        assert_eq!((explorer(&mut window).dialogs.room.below, explorer(&mut window).lessons.open()), (Below::Sliders, None));
    }
}

#[test]
fn a_plot_of_a_phone_on_its_side_has_most_of_the_height() {
    let mut window = harness();
    explorer(&mut window).dialogs.room.may_be_small = true;
    window.set_size(egui::vec2(844.0, 390.0));
    wait(&mut window);
    for below in ["Sliders", "Fit"] {
        window.get_by_label(below).click();
        wait(&mut window);
        let plot = window.get_by_label("Plot: DoLP against θr").rect();
        assert!(plot.height() > 0.4 * 390.0 && plot.width() > 0.4 * 844.0, "{below}: {plot}");
    }
    assert!(window.query_by_label("Close").is_none(), "tabs close by the menu alone");
}

#[test]
fn a_low_frame_of_another_page_has_room_for_its_lesson() {
    let mut window = harness();
    explorer(&mut window).dialogs.room.embedded = Query::new("?embed=dolp").embedded;
    window.set_size(egui::vec2(800.0, 450.0));
    explorer(&mut window).actions.push(Action::ShowStep(1, 0));
    wait(&mut window);
    assert!(window.query_by_label("Next step").is_some());
    // It is there for the lesson, which nothing could bring back.
    assert!(window.query_by_label("Close lesson").is_none() && window.query_by_label("Keep this").is_none());
}

//! The table of commands: menus, keyboard, palette.

use crate::app::shell::app::App;
use crate::app::shell::commands;
use crate::app::shell::commands::Availability;
use crate::app::storage::export::SheetForm;
use crate::app::tests::{explorer, harness, plots, wait};
use crate::app::text::i18n::Language;
use crate::app::views::action::{Action, InquiryAction, ListAction, WindowAction};
use crate::app::work::edit::Edit;
use crate::app::work::pane_id::PaneId;
use crate::app::work::settings::Theme;
use crate::app::work::workspace::Workspace;
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use pbrdf::model::Parameters;

#[test]
fn no_two_commands_have_the_same_keys_or_the_same_name() {
    let mut harness = harness();
    explorer(&mut harness).window.remember(std::path::Path::new("/somewhere/mine.csv"));
    let items = commands::items(explorer(&mut harness));
    for (i, item) in items.iter().enumerate() {
        assert!(!item.text.is_empty() && !item.tooltip.is_empty(), "{item:?}");
        for other in &items[..i] {
            assert!(item.shortcut.is_none() || item.shortcut != other.shortcut, "{item:?} and {other:?}");
            assert_ne!(item.text, other.text);
        }
    }
}

#[test]
fn every_command_can_be_carried_out() {
    let commands: Vec<Action> = commands::items(explorer(&mut harness())).into_iter().map(|item| item.action).collect();
    // All in one window, so that the later ones meet what the earlier ones left.
    let mut harness = harness();
    for command in commands {
        if let Action::CopyPlot(pane) = command
            && !explorer(&mut harness).dock.is_on_screen(pane)
        {
            // Until then the command is grey.
            explorer(&mut harness).actions.push(Action::Window(WindowAction::ShowPane(pane)));
            wait(&mut harness);
        }
        if command == Action::CopyPlot(PaneId::Posterior) {
            // Grey as well, until it is drawn.
            continue;
        }
        explorer(&mut harness).actions.push(command.clone());
        if command == Action::List(ListAction::Close(None)) {
            // The others are about data.
            explorer(&mut harness).actions.push(Action::Undo);
        }
        if matches!(command, Action::RunBenchmark(_)) {
            // Begun is enough: to its end it takes a minute in a debug build.
            harness.step();
            explorer(&mut harness).actions.push(Action::CancelBenchmark);
        }
        if command == Action::Inquire(InquiryAction::DrawPosterior) {
            // The same of sixteen thousand draws.
            harness.step();
            explorer(&mut harness).actions.push(Action::Inquire(InquiryAction::CancelPosterior));
        }
        wait(&mut harness);
        let notice = explorer(&mut harness).toasts.take();
        let says_so =
            matches!(command, Action::CopyTable | Action::CopyResults(_) | Action::CopyLink | Action::Inquire(InquiryAction::Walk(_)));
        assert_eq!(notice.is_some(), says_so, "{command:?}: {notice:?}");
    }
}

#[test]
fn commands_about_what_is_not_there_change_nothing() {
    let mut harness = harness();
    let (settings, rows) = (explorer(&mut harness).work.values(), explorer(&mut harness).work.active().measurement.rows.clone());
    let profiles = pbrdf::model::Parameter::ALL.map(Action::Profile);
    let others = [
        Action::Import,
        Action::CancelImport,
        Action::ReturnToFit(99),
        Action::UseCase(99),
        Action::UseFinish(99),
        Action::UseModel("none"),
        Action::ShowStep(99, 0),
        Action::ShowStep(0, 99),
    ];
    for edit in [Edit::Mask { rows: vec![usize::MAX], masked: true }, Edit::UseModelFit(99), Edit::ReturnToFit(99)] {
        explorer(&mut harness).work.apply(edit);
        assert_eq!(explorer(&mut harness).work.values(), settings);
    }
    for command in profiles.into_iter().chain(others) {
        explorer(&mut harness).actions.push(command.clone());
        wait(&mut harness);
        let explorer = explorer(&mut harness);
        assert_eq!(
            (explorer.toasts.take(), &explorer.work.values(), &explorer.work.active().measurement.rows),
            (None, &settings, &rows),
            "{command:?}"
        );
    }
}

#[test]
fn keys_do_what_menus_say() {
    let mut harness = harness();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::L);
    harness.run();
    assert!(explorer(&mut harness).work.settings().log_brdf);
    harness.get_by_label("View").click();
    harness.run();
    harness.get_by_label("Logarithmic lobes").click();
    harness.run();
    assert!(!explorer(&mut harness).work.settings().log_brdf);
}

#[test]
fn keys_work_while_a_slider_has_the_focus_and_not_while_a_field_is_typed_into() {
    let mut harness = harness();
    harness.get_by_role_and_label(egui::accesskit::Role::Slider, "k").focus();
    harness.run();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::L);
    harness.run();
    assert!(explorer(&mut harness).work.settings().log_brdf);
    harness.get_by_label("File").click();
    harness.run();
    harness.get_by_role_and_label(egui::accesskit::Role::TextInput, "Type a path to open and press Enter:").focus();
    harness.run();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::L);
    harness.run();
    assert!(explorer(&mut harness).work.settings().log_brdf);
}

#[test]
fn the_palette_finds_a_command_by_a_few_letters() {
    let mut harness = harness();
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::P);
    harness.run();
    assert!(explorer(&mut harness).dialogs.palette.is_open);
    harness.get_by_label("Find a command").type_text("dark");
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
    let explorer = explorer(&mut harness);
    assert_eq!(explorer.window.theme, Theme::Dark);
    assert!(!explorer.dialogs.palette.is_open);
}

#[test]
fn arrows_choose_in_the_palette_and_escape_leaves_it() {
    let mut harness = harness();
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::P);
    harness.run();
    harness.get_by_label("Find a command").type_text("reset");
    harness.run();
    harness.key_press(Key::ArrowDown);
    harness.run();
    explorer(&mut harness).work.surface_mut().parameters.n = 7.0;
    harness.key_press(Key::Escape);
    harness.run();
    assert!(!explorer(&mut harness).dialogs.palette.is_open);
    assert_eq!(explorer(&mut harness).work.surface().parameters.n, 7.0);
}

#[test]
fn the_palette_begins_as_the_menus_do_and_finds_all_of_a_menu() {
    let mut harness = harness();
    let open = |harness: &mut Harness<'static, Option<App>>, text: &str| {
        explorer(harness).actions.push(Action::Window(WindowAction::OpenPalette));
        harness.run();
        harness.get_by_label("Find a command").type_text(text);
        harness.run();
    };
    open(&mut harness, "export");
    // Seven that are always there, and the plot of the posterior, which is none of those of `plots`.
    assert_eq!(harness.query_all_by_label_contains("Export › ").count(), 8 + SheetForm::ALL.len() + plots().count());
    harness.key_press(Key::Escape);
    harness.run();
    open(&mut harness, "");
    let top = |name: &str| harness.get_by_label_contains(name).rect().top();
    assert!(top("File › Open measurements…") < top("File › Save measurement as…") && top("File › Save session as…") < top("File › Quit"));
    harness.key_press(Key::Escape);
    harness.run();
    open(&mut harness, "chinese");
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(explorer(&mut harness).window.language, Language::Chinese);
}

#[test]
fn ctrl_y_does_again_what_was_undone() {
    let mut harness = harness();
    explorer(&mut harness).work.surface_mut().parameters.k = 4.5;
    harness.run();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run();
    assert_eq!(explorer(&mut harness).work.surface().parameters, Parameters::default());
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Y);
    harness.run();
    assert_eq!(explorer(&mut harness).work.surface().parameters.k, 4.5);
}

#[test]
fn undo_brings_back_every_setting() {
    let mut harness = harness();
    let before = explorer(&mut harness).work.values();
    let steps: [fn(&mut Workspace); 5] = [
        |work| work.surface_mut().parameters.k = 4.5,
        |work| work.surface_mut().model.volume = false,
        |work| work.settings_mut().log_brdf = true,
        |work| work.settings_mut().theta_i = 12.5,
        |work| work.settings_mut().show_limit = false,
    ];
    for step in steps {
        step(&mut explorer(&mut harness).work);
        harness.run();
    }
    let after = explorer(&mut harness).work.values();
    for _ in steps {
        explorer(&mut harness).actions.push(Action::Undo);
        harness.run();
    }
    assert_eq!(explorer(&mut harness).work.values(), before);
    for _ in steps {
        explorer(&mut harness).actions.push(Action::Redo);
        harness.run();
    }
    assert_eq!(explorer(&mut harness).work.values(), after);
}

#[test]
fn the_arrangement_and_colours_of_the_window_are_no_steps_of_undo() {
    let mut harness = harness();
    let steps_before = explorer(&mut harness).work.can_undo();
    for command in [Action::Window(WindowAction::SetTheme(Theme::Dark)), Action::Window(WindowAction::ToggleFrameTimes)] {
        explorer(&mut harness).actions.push(command);
        harness.run();
    }
    assert_eq!(explorer(&mut harness).work.can_undo(), steps_before);
}

#[test]
fn parameters_are_copied_and_pasted_as_text() {
    let mut harness = harness();
    explorer(&mut harness).work.surface_mut().parameters.n = 2.07;
    explorer(&mut harness).actions.push(Action::CopyParameters);
    harness.step();
    let copied = harness.output().platform_output.commands.iter().find_map(|command| match command {
        egui::OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    let copied = copied.expect("text on the clipboard");
    assert!(copied.starts_with("n=2.07, k=3"), "{copied}");
    explorer(&mut harness).work.surface_mut().parameters = Parameters::default();
    harness.input_mut().events.push(egui::Event::Paste(copied));
    harness.run();
    assert_eq!(explorer(&mut harness).work.surface().parameters.n, 2.07);
    harness.input_mut().events.push(egui::Event::Paste("what is this".to_owned()));
    harness.run();
    assert!(explorer(&mut harness).toasts.text().expect("a notice").contains("is no set of parameters"));
    assert_eq!(explorer(&mut harness).work.surface().parameters.n, 2.07);
}

#[test]
fn what_is_impossible_is_not_ordered_by_its_keys() {
    let mut harness = harness();
    let items = commands::items(explorer(&mut harness));
    let redo = items.iter().find(|item| item.action == Action::Redo).expect("redo is in the table");
    assert_eq!(redo.status, Availability::Impossible);
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    harness.run();
    assert!(explorer(&mut harness).toasts.is_empty());
}

#[test]
fn the_palette_finds_english_names_in_every_language() {
    let mut harness = harness();
    explorer(&mut harness).window.language = Language::Chinese;
    explorer(&mut harness).actions.push(Action::Window(WindowAction::OpenPalette));
    harness.run();
    harness.get_by_label("查找命令").type_text("start fit");
    harness.run();
    assert!(harness.query_by_label_contains("Start fit").is_some(), "what was found is seen");
    harness.key_press(Key::Enter);
    harness.step();
    wait(&mut harness);
    assert!(explorer(&mut harness).work.shown_fit().is_some());
    // And the names that are shown, without the English ones.
    explorer(&mut harness).actions.push(Action::Window(WindowAction::OpenPalette));
    harness.run();
    harness.get_by_label("查找命令").type_text("拟合");
    harness.run();
    assert!(harness.query_by_label_contains("Start fit").is_none());
    harness.key_press(Key::Escape);
    harness.run();
}

#[test]
fn the_name_of_a_pane_finds_the_pane_before_what_else_has_the_word() {
    for language in Language::ALL {
        let mut harness = harness();
        explorer(&mut harness).window.language = language;
        harness.run();
        let panes: Vec<(PaneId, String)> = commands::items(explorer(&mut harness))
            .into_iter()
            .filter_map(|item| match item.action {
                Action::Window(WindowAction::ShowPane(pane)) => Some((pane, item.text.to_string())),
                _ => None,
            })
            .collect();
        for (pane, name) in panes {
            explorer(&mut harness).actions.push(Action::Window(WindowAction::ClosePane(pane)));
            explorer(&mut harness).actions.push(Action::Window(WindowAction::OpenPalette));
            harness.run_steps(2);
            assert!(!explorer(&mut harness).dock.is_on_screen(pane));
            explorer(&mut harness).dialogs.palette.filter.clone_from(&name);
            harness.key_press(Key::Enter);
            harness.run_steps(3);
            assert!(explorer(&mut harness).dock.is_on_screen(pane), "{name}");
        }
    }
}

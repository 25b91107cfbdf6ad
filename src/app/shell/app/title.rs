//! The title of the window: the session, and whether it is saved.

use crate::app::shell::app::App;
use crate::app::text::help::TITLE;
use crate::app::work::workspace::Workspace;
use egui::ViewportCommand;
use tr::tr;

/// The title: the name of the session, or of the active measurement where the session has none, with a
/// mark while anything is not saved.
pub fn title(app: &App) -> String {
    let own = app.own_work();
    let name = own.session_file().and_then(|path| path.file_name()).map(|name| name.to_string_lossy().into_owned());
    let is_saved = app.persistence.saved_session == Some(own.revision());
    match (name, is_saved) {
        (None, true) => TITLE.to_owned(),
        (name, is_saved) => {
            let name = name.unwrap_or_else(|| measurements(own));
            let name = name.trim_end_matches(".json").trim_end_matches(".pbrdf");
            format!("{}{name} – {TITLE}", if is_saved { "" } else { "*" })
        }
    }
}

/// The active measurement, and how many are beside it.
fn measurements(work: &Workspace) -> String {
    let list = work.measurements();
    match (list.has_rows(), list.iter().count()) {
        (false, _) => tr!("unnamed"),
        (true, 1) => work.active().title(),
        (true, count) => tr!("{0} and {1} more", work.active().title(), count - 1),
    }
}

/// Takes the work as it is for saved.
pub fn mark_saved(app: &mut App) {
    app.persistence.saved_session = Some(app.own_work().revision());
}

/// Tells the desktop, when the title is another one.
pub fn show_title(app: &mut App, ctx: &egui::Context) {
    let title = title(app);
    if app.persistence.title != title {
        app.persistence.title.clone_from(&title);
        ctx.send_viewport_cmd(ViewportCommand::Title(title));
    }
}

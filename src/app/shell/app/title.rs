//! The title of the window: the session, and whether it is saved.

use crate::app::shell::app::App;
use crate::app::text::help::TITLE;
use egui::ViewportCommand;
use tr::tr;

/// The title: the name of the session, with a mark while anything is not saved.
pub fn title(app: &App) -> String {
    let own = app.own_work();
    let name = own.session_file().and_then(|path| path.file_name()).map(|name| name.to_string_lossy().into_owned());
    let is_saved = app.persistence.saved_session == Some(own.revision());
    match (name, is_saved) {
        (None, true) => TITLE.to_owned(),
        (name, is_saved) => {
            let name = name.unwrap_or_else(|| tr!("unnamed"));
            let name = name.trim_end_matches(".json").trim_end_matches(".pbrdf");
            format!("{}{name} – {TITLE}", if is_saved { "" } else { "*" })
        }
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

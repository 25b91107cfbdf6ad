//! A work goes to the clipboard as a link, and comes from one.

use crate::app::platform;
use crate::app::shell::app::App;
use crate::app::shell::app::autosave::set_aside;
use crate::app::shell::app::lesson::{close_lesson, is_free_for_lessons};
use crate::app::shell::lessons::LessonSession;
use crate::app::storage::session::Session;
use crate::app::storage::share_link::{LeftOut, OpenedLink, SharedWork, is_link};
use crate::app::views::action::Action;
use crate::app::work::edit::Edit;
use crate::app::work::parameter_text;
use tr::tr;

/// The page that links of a desktop lead to: where `web/dist` is tried out, unless the build names another one.
const PAGE: &str = match option_env!("PBRDF_EXPLORER_PAGE") {
    Some(page) => page,
    None => "http://localhost:8000/",
};

/// Carries out what is about links and pasted texts; the error is a sentence.
pub fn execute(app: &mut App, ctx: &egui::Context, action: Action) -> Result<(), String> {
    match action {
        Action::CopyLink => copy_link(app, ctx),
        Action::OpenLink(text) => open_link(app, text),
        Action::PasteParameters(text) if is_link(&text) => open_link(app, text),
        Action::PasteParameters(text) => {
            let parameters = parameter_text::read(&text, app.work.surface().parameters)?;
            app.work.apply(Edit::SetParameters(parameters));
            Ok(())
        }
        _ => Ok(()),
    }
}

/// What is shown now, as a link.
pub fn shared_work(app: &App) -> SharedWork {
    let lesson = app.lessons.current().zip(app.lessons.open());
    let lesson = lesson.map(|((lesson, _), (_, step))| (lesson.title.original().to_owned(), step));
    SharedWork { language: app.window.language, lesson, work: Session::of(&app.work) }
}

/// The shown work to the clipboard, as a link.
///
/// # Errors
/// Memory takes no more; a sentence.
fn copy_link(app: &mut App, ctx: &egui::Context) -> Result<(), String> {
    let fragment = shared_work(app).fragment().map_err(|error| tr!("There is no link: {}.", error.to_string()))?;
    let page = platform::page().unwrap_or_else(|| PAGE.to_owned());
    ctx.copy_text(format!("{page}{}", fragment.text));
    let letters = fragment.text.len();
    match fragment.left_out {
        LeftOut::Nothing => app.toasts.info(tr!("The link is copied ({} letters): it holds sliders, data, fits and panes.", letters)),
        LeftOut::Fits => app.toasts.error(tr!("The link is copied without fits, which make it too long; a session file holds them.")),
        LeftOut::FitsAndMeasurements => {
            app.toasts.error(tr!("The link is copied without measurements and fits, which make it too long; a session file holds them."));
        }
    }
    Ok(())
}

/// Reads the link in a text, unless something else is on its way.
///
/// # Errors
/// Something else is, or the job does not start; a sentence.
fn open_link(app: &mut App, text: String) -> Result<(), String> {
    is_free_for_lessons(app)?;
    app.jobs.files.open_link(text)
}

/// Shows the work of a link; the user's own is kept. Where the link cannot be read, all stays.
pub fn link_read(app: &mut App, result: Result<Box<OpenedLink>, String>) {
    let OpenedLink { language, lesson, work } = match result {
        Ok(opened) => *opened,
        Err(sentence) => return app.toasts.load_error(sentence),
    };
    app.toasts.dismiss_load_errors();
    let place = lesson.as_ref().and_then(|(title, step)| Some((app.lessons.find(title, *step)?, *step)));
    if let Some((lesson, step)) = place {
        // The lesson comes over the user's own work, as it does out of the menu.
        close_lesson(app);
        let saved = app.show_work(work.into_work());
        app.lessons.session = Some(Box::new(LessonSession { lesson, step, saved }));
    } else {
        if let Err(sentence) = set_aside(app) {
            return app.toasts.error(sentence);
        }
        app.lessons.session = None;
        app.show_work(work.into_work());
        if let Some((title, _)) = lesson {
            app.toasts.error(tr!("The lesson “{}” is not known here: its work is shown without it.", title));
        }
        app.toasts.info(tr!("The work of the link is shown; your own is kept under File › Recent."));
    }
    app.window.language = language;
}

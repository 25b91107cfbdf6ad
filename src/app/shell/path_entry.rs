//! Paths typed by hand, for where the desktop has no dialog. A box keeps its path until that has
//! served; a file that is there is replaced only after a question, which elsewhere the desktop's
//! own dialog asks.

use crate::app::platform;
use crate::app::storage::export::ExportKind;
use crate::app::views::action::Action;
use std::path::{Path, PathBuf};

/// The boxes of the menu File.
#[derive(Debug, Default)]
pub struct PathEntry {
    pub open: String,
    pub save: String,
    pub export: String,
}

/// The path in a box, if there is one; `~/` is the folder of the user, as in a shell.
pub fn path_in(text: &str) -> Option<PathBuf> {
    let text = Some(text.trim()).filter(|text| !text.is_empty())?;
    if platform::IS_PAGE {
        // A download has a name and no folder.
        return Path::new(text).file_name().map(PathBuf::from);
    }
    let own = text.strip_prefix("~/").and_then(|rest| Some(std::env::home_dir()?.join(rest)));
    Some(own.unwrap_or_else(|| PathBuf::from(text)))
}

impl PathEntry {
    /// The measurement or the session into the typed path, as its ending says.
    pub fn save_command(&self) -> Option<Action> {
        let path = path_in(&self.save)?;
        let is_session = ExportKind::Session.check(&path).is_ok();
        Some(if is_session { Action::ExportNew(ExportKind::Session, path) } else { Action::SaveNew(path) })
    }

    /// An export into the typed path, which then has an ending.
    pub fn export_command(&mut self, what: ExportKind) -> Option<Action> {
        let path = what.with_ending(path_in(&self.export)?);
        self.export = path.display().to_string();
        Some(Action::ExportNew(what, path))
    }

    /// Empties the boxes with that path: it was read or written.
    pub fn clear_if(&mut self, path: &Path) {
        for text in [&mut self.open, &mut self.save, &mut self.export] {
            if path_in(text).is_some_and(|typed| typed == path) {
                text.clear();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Action, ExportKind, PathEntry, path_in};
    use std::path::Path;

    #[test]
    fn a_typed_path_says_by_its_ending_what_is_saved() {
        let command = |name: &str| PathEntry { save: format!(" {name} "), ..PathEntry::default() }.save_command();
        for name in ["a.pbrdf.json", "a.JSON"] {
            assert_eq!(command(name), Some(Action::ExportNew(ExportKind::Session, name.into())));
        }
        for name in ["a.csv", "a", "a.json.csv"] {
            assert_eq!(command(name), Some(Action::SaveNew(name.into())));
        }
        assert_eq!(command(" "), None);
    }

    #[test]
    fn a_tilde_is_the_folder_of_the_user() {
        let home = std::env::home_dir().expect("whoever runs tests has a folder");
        assert_eq!(path_in(" ~/data/a.csv"), Some(home.join("data/a.csv")));
        for text in ["/a/~/b", "~b.csv", "a~/b"] {
            assert_eq!(path_in(text), Some(text.into()));
        }
        let mut typed = PathEntry { open: "~/a.csv".to_owned(), ..PathEntry::default() };
        typed.clear_if(&home.join("a.csv"));
        assert_eq!(typed.open, "");
    }

    #[test]
    fn a_box_is_emptied_by_its_own_path_alone() {
        let mut typed = PathEntry { open: "/a.csv".to_owned(), save: " /b.csv".to_owned(), export: "/c".to_owned() };
        assert_eq!(typed.export_command(ExportKind::Curves), Some(Action::ExportNew(ExportKind::Curves, "/c.csv".into())));
        for path in ["/b.csv", "/c.csv", "/d.csv"] {
            typed.clear_if(Path::new(path));
        }
        assert_eq!((typed.open.as_str(), typed.save.as_str(), typed.export.as_str()), ("/a.csv", "", ""));
    }
}

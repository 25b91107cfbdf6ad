//! The settings file: read at start, written in one move, set aside when damaged.

use crate::app::platform;
use crate::app::storage::earlier_keys::EarlierFile;
use crate::app::text::i18n::Language;
use crate::app::text::localized::Localized as _;
use crate::app::work::layout::Layout;
use crate::app::work::settings::{Settings, WindowSettings};
use crate::app::work::settings_error::SettingsError;
use crate::app::work::surface::Surface;
use crate::files::disk;
use crate::files::write_file::write_file;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use tr::tr;

/// Name of the program in the folders of the desktop.
pub const APP: &str = "pbrdf-explorer";

/// The settings file.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct SettingsFile {
    pub settings: SavedSettings,
    pub layout: Layout,
    pub window: WindowSettings,
}

/// Settings and surface as files hold them: under one key.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct SavedSettings {
    #[serde(flatten)]
    pub settings: Settings,
    #[serde(flatten)]
    pub surface: Surface,
}

/// What is read of a file with settings beside the settings: the surface, which stands among them.
#[derive(Deserialize, Default)]
#[serde(default)]
pub struct SurfaceOfFile {
    pub settings: Surface,
}

/// What is read of the settings file.
#[derive(Deserialize, Default)]
#[serde(default)]
struct SettingsContents {
    settings: Settings,
    layout: Option<serde_json::Value>,
    window: WindowSettings,
}

impl SettingsFile {
    /// Checks that every value means something; the error is the key of one that does not, and why.
    fn validate(&self) -> Result<(), String> {
        let SavedSettings { settings, surface } = &self.settings;
        surface.validate().and_then(|()| settings.validate()).map_err(|error| format!("settings.{}", error.localized()))?;
        if self.window.is_sound() { Ok(()) } else { Err(SettingsError::OutOfRange("window.size").localized()) }
    }
}

/// Where the settings are, if the machine has a place for them.
pub fn path() -> Option<PathBuf> {
    platform::config_folder(APP).map(|folder| folder.join("settings.json"))
}

/// The settings of the last session, or the defaults; with a sentence if a file had to be set
/// aside.
pub fn load() -> (SettingsFile, Option<String>) {
    path().map_or_else(|| (SettingsFile::default(), None), |path| load_from(&path))
}

/// The settings where there are none yet: in the language of the user.
pub fn fresh() -> SettingsFile {
    let window = WindowSettings { language: Language::of_environment(), ..WindowSettings::default() };
    SettingsFile { window, ..SettingsFile::default() }
}

pub fn load_from(path: &Path) -> (SettingsFile, Option<String>) {
    let reason = match disk::read(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            return (fresh(), None);
        }
        Err(error) => {
            return (
                SettingsFile::default(),
                Some(tr!("The settings of the last session cannot be read ({}); the defaults are used.", error.localized())),
            );
        }
        Ok(bytes) => match read(&bytes) {
            Ok(settings) => match settings.validate() {
                Ok(()) => return (settings, None),
                Err(reason) => reason,
            },
            Err(error) => error.localized(),
        },
    };
    let aside = path.with_extension("damaged.json");
    let kept = match disk::rename(path, &aside) {
        Ok(()) => tr!("it is kept as {}", aside.display()),
        Err(error) => tr!("it could not be set aside ({})", error.localized()),
    };
    (
        SettingsFile::default(),
        Some(tr!("The settings file {0} is damaged ({1}); {2}, and the defaults are used.", path.display(), reason, kept)),
    )
}

fn read(bytes: &[u8]) -> serde_json::Result<SettingsFile> {
    let SettingsContents { settings, layout, window } = serde_json::from_slice(bytes)?;
    let SurfaceOfFile { settings: mut surface } = serde_json::from_slice(bytes)?;
    let earlier: EarlierFile = serde_json::from_slice(bytes)?;
    earlier.apply(&mut surface);
    let layout = layout.map_or_else(|| earlier.layout(), Layout::from_value);
    Ok(SettingsFile { settings: SavedSettings { settings, surface }, layout, window })
}

/// Writes the settings; a crash leaves the old file or the new one.
pub fn save(path: &Path, settings: &SettingsFile) -> std::io::Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    disk::create_dir_all(folder)?;
    write_file(path, |out| Ok(serde_json::to_writer_pretty(out, settings)?))
}

//! Preferences of the user, saved between runs of the program.

use std::path::PathBuf;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{text, write_new};

/// Returns the file of preferences: `stillbase/preferences.toml` in the system's folder for settings, such as
/// `~/.config`.
pub fn file() -> Option<PathBuf> {
    Some(directories::ProjectDirs::from("", "", "stillbase")?.config_dir().join("preferences.toml"))
}

/// Loads the preferences; the defaults if there is no file, or if it cannot be parsed.
pub fn load<T: DeserializeOwned + Default>() -> T {
    let text = file().and_then(|file| text::read(&file).ok());
    text.and_then(|text| toml::from_str(&text).ok()).unwrap_or_default()
}

/// Saves preferences; errors are ignored, because no session depends on them.
pub fn save(preferences: &impl Serialize) {
    let written = || -> Option<()> {
        let (file, text) = (file()?, toml::to_string(preferences).ok()?);
        std::fs::create_dir_all(file.parent()?).ok()?;
        write_new(&file, text.as_bytes(), true).ok()
    };
    written();
}

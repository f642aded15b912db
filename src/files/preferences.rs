//! What is remembered from one start to the next, in a file of the person's own.

use std::path::PathBuf;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{text, write_new};

/// Where it stands: `stillbase/preferences.toml` in the folder for settings, such as `~/.config`.
pub fn file() -> Option<PathBuf> {
    Some(directories::ProjectDirs::from("", "", "stillbase")?.config_dir().join("preferences.toml"))
}

/// What was remembered; nothing if there is no file, or one that is not understood.
pub fn load<T: DeserializeOwned + Default>() -> T {
    let text = file().and_then(|file| text::read(&file).ok());
    text.and_then(|text| toml::from_str(&text).ok()).unwrap_or_default()
}

/// Remembers; what cannot be written is forgotten, since nothing of a session depends on it.
pub fn save(preferences: &impl Serialize) {
    let written = || -> Option<()> {
        let (file, text) = (file()?, toml::to_string(preferences).ok()?);
        std::fs::create_dir_all(file.parent()?).ok()?;
        write_new(&file, text.as_bytes(), true).ok()
    };
    written();
}

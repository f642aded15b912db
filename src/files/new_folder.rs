//! [`NewFolder`]: a folder of numbered pictures that appears whole or not at all.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use super::WriteError;
use super::draft::{TemporaryFolder, folder_of, making};

/// Beginning and ending of the name of a picture in a folder.
const PICTURE_NAME: [&str; 2] = ["frame-", ".png"];

/// A folder that is being filled. [`finish`](Self::finish) gives it its name; if it is dropped before, nothing remains.
#[derive(Debug)]
pub struct NewFolder {
    folder: PathBuf,
    force: bool,
    draft: TemporaryFolder,
    count: u32,
}

/// Makes a folder for several files, if there is none yet.
///
/// # Errors
/// If its parent does not exist, or the folder cannot be made.
pub fn make_folder(folder: &Path) -> Result<(), WriteError> {
    if folder.is_dir() {
        return Ok(());
    }
    check_new_folder(folder, false)?;
    fs::create_dir(folder).map_err(|source| WriteError::Failed { file: folder.into(), source })
}

/// Checks that a folder may be written: its parent exists, and its name is free. With `force`, it may be that of a
/// folder which holds nothing but numbered pictures.
///
/// # Errors
/// If one of these does not hold.
pub fn check_new_folder(folder: &Path, force: bool) -> Result<(), WriteError> {
    match fs::symlink_metadata(folder) {
        Ok(there) if !there.is_dir() => return Err(WriteError::NotAFolder(folder.into())),
        Ok(_) if !force => return Err(WriteError::Exists(folder.into())),
        Ok(_) if !holds_pictures_only(folder) => return Err(WriteError::HoldsOthers(folder.into())),
        _ => {}
    }
    let parent = folder_of(folder);
    match parent.is_dir() {
        true => Ok(()),
        false => Err(WriteError::NoFolder { file: folder.into(), folder: parent.into() }),
    }
}

fn is_picture(name: &OsStr) -> bool {
    let [begin, end] = PICTURE_NAME;
    let number = name.to_str().and_then(|name| name.strip_prefix(begin)?.strip_suffix(end));
    number.is_some_and(|number| !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit()))
}

fn holds_pictures_only(folder: &Path) -> bool {
    let Ok(mut entries) = fs::read_dir(folder) else { return false };
    entries.all(|entry| entry.is_ok_and(|entry| is_picture(&entry.file_name())))
}

impl NewFolder {
    /// Begins a folder.
    ///
    /// # Errors
    /// As [`check_new_folder`], or if its parent cannot be written.
    pub fn create(folder: &Path, force: bool) -> Result<Self, WriteError> {
        check_new_folder(folder, force)?;
        let draft = TemporaryFolder::create(folder).map_err(|source| failed(folder, source))?;
        Ok(Self { folder: folder.into(), force, draft, count: 0 })
    }

    /// Adds the next picture, as a PNG file: `frame-00001.png` and so on.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn push(&mut self, png: &[u8]) -> Result<(), WriteError> {
        self.count += 1;
        let [begin, end] = PICTURE_NAME;
        let file = self.draft.part.join(format!("{begin}{:05}{end}", self.count));
        fs::write(file, png).map_err(|source| failed(&self.folder, source))
    }

    /// Gives the folder its name.
    ///
    /// # Errors
    /// If its name cannot be taken.
    pub fn finish(self) -> Result<(), WriteError> {
        let parts = making();
        check_new_folder(&self.folder, self.force)?;
        let before = self.draft.aside();
        let is_replaced = self.force && self.folder.is_dir();
        if is_replaced {
            fs::rename(&self.folder, &before).map_err(|source| failed(&self.folder, source))?;
        }
        let named = fs::rename(&self.draft.part, &self.folder);
        if is_replaced {
            // What was there returns if the new folder could not take its name.
            let _ = if named.is_ok() { fs::remove_dir_all(&before) } else { fs::rename(&before, &self.folder) };
        }
        drop(parts);
        named.map_err(|source| failed(&self.folder, source))
    }
}

fn failed(folder: &Path, source: std::io::Error) -> WriteError {
    WriteError::Failed { file: folder.into(), source }
}

//! Writing files so that nothing is lost: never over another without being told to, and never half.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why a file was not written.
#[derive(Debug, Error)]
pub enum WriteError {
    /// It is there already.
    #[error("{} exists: want another name, or --force to replace it", .0.display())]
    Exists(PathBuf),
    /// The name is that of a folder.
    #[error("{} is a folder: want the name of a file", .0.display())]
    IsFolder(PathBuf),
    /// A device or a pipe, which another file must not replace.
    #[error("{} is no plain file: want the name of a new one", .0.display())]
    NotPlain(PathBuf),
    /// Its folder is not there.
    #[error("{}: no folder {}: want one that exists", file.display(), folder.display())]
    NoFolder {
        /// The file.
        file: PathBuf,
        /// The folder.
        folder: PathBuf,
    },
    /// The file system.
    #[error("{}: {source}: want a place that can be written", file.display())]
    Failed {
        /// The file.
        file: PathBuf,
        /// Why.
        source: io::Error,
    },
}

/// Refuses a file that exists, unless forced; folders and devices; and a file in a folder that does not exist.
///
/// # Errors
/// If it is refused.
pub fn check_new(file: &Path, force: bool) -> Result<(), WriteError> {
    match fs::metadata(file) {
        Ok(there) if there.is_dir() => return Err(WriteError::IsFolder(file.into())),
        Ok(there) if !there.is_file() => return Err(WriteError::NotPlain(file.into())),
        // A link to nowhere is something too.
        _ if !force && fs::symlink_metadata(file).is_ok() => return Err(WriteError::Exists(file.into())),
        _ => {}
    }
    let folder = folder_of(file);
    match folder.is_dir() {
        true => Ok(()),
        false => Err(WriteError::NoFolder { file: file.into(), folder: folder.into() }),
    }
}

fn folder_of(file: &Path) -> &Path {
    file.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Where a file is written before it takes its name: hidden beside it, free when asked for.
pub fn beside(file: &Path) -> PathBuf {
    let numbered = |attempt: u32| {
        let mut name = OsString::from(".");
        name.push(file.file_name().unwrap_or_default());
        name.push(format!(".{}-{attempt}.part", std::process::id()));
        file.with_file_name(name)
    };
    // One may be left over by a program of the same number that was killed.
    (0..1000).map(numbered).find(|part| part.symlink_metadata().is_err()).unwrap_or_else(|| numbered(1000))
}

/// A file in the making, buffered. It takes its name in [`finish`](Self::finish); dropped before, it leaves nothing.
#[derive(Debug)]
pub struct NewFile {
    /// What errors call it.
    asked: PathBuf,
    force: bool,
    out: BufWriter<File>,
    draft: Draft,
}

/// A file beside the one that it is to become.
#[derive(Debug)]
struct Draft {
    part: PathBuf,
    file: PathBuf,
}

impl Drop for Draft {
    fn drop(&mut self) {
        // Gone already if it was renamed; if it cannot be removed, nobody is left to tell.
        let _ = fs::remove_file(&self.part);
    }
}

impl NewFile {
    /// Begins a file.
    ///
    /// # Errors
    /// As [`check_new`], or if its folder cannot be written.
    pub fn create(file: &Path, force: bool) -> Result<Self, WriteError> {
        check_new(file, force)?;
        let failed = |source| WriteError::Failed { file: file.into(), source };
        // Through a link, so that the link stays.
        let target = fs::canonicalize(file).unwrap_or_else(|_| file.into());
        let part = beside(&target);
        let out = OpenOptions::new().write(true).create_new(true).open(&part).map_err(failed)?;
        let draft = Draft { part, file: target };
        Ok(Self { asked: file.into(), force, out: BufWriter::new(out), draft })
    }

    /// What was asked for.
    pub fn path(&self) -> &Path {
        &self.asked
    }

    /// Puts the file under its name.
    ///
    /// # Errors
    /// If not everything could be written, or another file has taken the name meanwhile.
    pub fn finish(mut self) -> Result<(), WriteError> {
        let failed = |source| WriteError::Failed { file: self.asked.clone(), source };
        self.out.flush().map_err(failed)?;
        self.out.get_ref().sync_all().map_err(failed)?;
        check_new(&self.draft.file, self.force)?;
        fs::rename(&self.draft.part, &self.draft.file).map_err(failed)
    }
}

impl Write for NewFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.out.write(bytes)
    }
    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// Writes a whole file, or leaves everything as it was.
///
/// # Errors
/// If it exists and is not to be replaced, or cannot be written.
pub fn write_new(file: &Path, bytes: &[u8], force: bool) -> Result<(), WriteError> {
    let mut out = NewFile::create(file, force)?;
    out.write_all(bytes).map_err(|source| WriteError::Failed { file: file.into(), source })?;
    out.finish()
}

/// `name.ending`, or `name-1.ending` and so on, whichever is free in the current folder.
pub fn free_name(name: &str, ending: &str) -> PathBuf {
    // A name is free text; as the name of a file it must stay in this folder.
    let plain = |c: char| if c.is_alphanumeric() || matches!(c, '-' | '_' | ' ') { c } else { '-' };
    let name: String = name.chars().map(plain).take(100).collect();
    let numbered = (1..1000).map(|i| PathBuf::from(format!("{name}-{i}.{ending}")));
    std::iter::once(PathBuf::from(format!("{name}.{ending}")))
        .chain(numbered)
        .find(|file| file.symlink_metadata().is_err())
        .unwrap_or_else(|| PathBuf::from(format!("{name}-{}.{ending}", std::process::id())))
}

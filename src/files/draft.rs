//! [`TemporaryFile`]: a temporary file in the folder of the file that it will become. It is removed if the program ends
//! before that.
//!
//! The crate `tempfile` makes temporary files too, but does not do three things that this module does. Temporary files
//! of killed programs are found by their names and released locks, and removed. A signal handler can remove all
//! temporary files without dropping their owners; from then on, no file takes its final name. Tests can inject a
//! fault at each step.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::fault::WriteStep;

pub(super) fn folder_of(file: &Path) -> &Path {
    file.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Paths of this program's temporary files. While the lock is held, none can be created or take its final name.
static MAKING: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

pub(super) fn making() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    MAKING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Guard after [`abandon`]: while it lives, no temporary file can be created or take its final name.
#[derive(Debug)]
pub struct WriteBlock(#[expect(dead_code, reason = "held, not read")] MutexGuard<'static, BTreeSet<PathBuf>>);

/// Removes all temporary files, before the program ends.
pub fn abandon() -> WriteBlock {
    let parts = making();
    for part in parts.iter() {
        // The program ends, so errors cannot be reported.
        let _ = if part.is_dir() { fs::remove_dir_all(part) } else { fs::remove_file(part) };
    }
    WriteBlock(parts)
}

/// Ending of the names of temporary files.
pub(super) const PART_ENDING: &str = ".stillbase.part";

/// Ending of the names of temporary folders.
const FOLDER_ENDING: &str = ".stillbase.parts";

/// Returns the path of a temporary file, hidden in the same folder: `.case.csv.4711-0.stillbase.part`; that of a
/// temporary folder has another `ending`.
fn part_of(file: &Path, attempt: u32, ending: &str) -> PathBuf {
    // The name may already be as long as the file system allows.
    let name: String = file.file_name().unwrap_or_default().to_string_lossy().chars().take(40).collect();
    file.with_file_name(format!(".{name}.{}-{attempt}{ending}", std::process::id()))
}

fn is_part(name: &OsStr, ending: &str) -> bool {
    let counted = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let middle = name.to_str().and_then(|name| name.strip_prefix('.')?.strip_suffix(ending));
    let number = middle.and_then(|middle| middle.rsplit_once('.')?.1.split_once('-'));
    number.is_some_and(|(process, attempt)| counted(process) && counted(attempt))
}

/// Removes temporary files and folders of killed programs from a folder. A program holds a lock on each of them, and
/// the system releases the lock when the program ends.
fn sweep(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let Ok(kind) = entry.file_type() else { continue };
        let is_file = kind.is_file() && is_part(&entry.file_name(), PART_ENDING);
        let is_folder = kind.is_dir() && is_part(&entry.file_name(), FOLDER_ENDING);
        if !(is_file || is_folder) {
            continue;
        }
        // A system that cannot open folders keeps them.
        let Ok(part) = File::open(entry.path()) else { continue };
        if part.try_lock().is_ok() {
            // What cannot be removed belongs to another user.
            let _ = if is_folder { fs::remove_dir_all(entry.path()) } else { fs::remove_file(entry.path()) };
        }
    }
}

/// A temporary file in the folder of the file that it will become.
#[derive(Debug)]
pub(super) struct TemporaryFile {
    pub part: PathBuf,
    pub file: PathBuf,
}

impl TemporaryFile {
    /// Creates a locked temporary file for `file`.
    pub fn create(file: PathBuf) -> io::Result<(Self, File)> {
        sweep(folder_of(&file));
        let mut parts = making();
        for attempt in 0..1000 {
            let part = part_of(&file, attempt, PART_ENDING);
            super::fault::fail_if_due(WriteStep::Fallible)?;
            let out = match OpenOptions::new().read(true).write(true).create_new(true).open(&part) {
                Err(e) if e.kind() == ErrorKind::AlreadyExists => continue,
                out => out?,
            };
            // Another program may have removed the file before it was locked. On systems without file locks, no program
            // removes temporary files of others.
            let swept = matches!(out.try_lock(), Err(TryLockError::WouldBlock)) || part.symlink_metadata().is_err();
            if !swept {
                parts.insert(part.clone());
                return Ok((Self { part, file }, out));
            }
        }
        Err(io::Error::new(ErrorKind::AlreadyExists, "a thousand files in the making stand beside it"))
    }
}

impl Drop for TemporaryFile {
    fn drop(&mut self) {
        let mut parts = making();
        // The file no longer exists if it has taken its final name. If it cannot be removed, a later sweep tries again.
        let _ = fs::remove_file(&self.part);
        parts.remove(&self.part);
    }
}

/// A temporary folder beside the folder that it will become.
#[derive(Debug)]
pub(super) struct TemporaryFolder {
    pub part: PathBuf,
    /// Holds the lock, where a system can open folders.
    _lock: Option<File>,
}

impl TemporaryFolder {
    /// Creates a locked temporary folder for `folder`.
    pub fn create(folder: &Path) -> io::Result<Self> {
        sweep(folder_of(folder));
        let mut parts = making();
        for attempt in 0..1000 {
            let part = part_of(folder, attempt, FOLDER_ENDING);
            super::fault::fail_if_due(WriteStep::Fallible)?;
            match fs::create_dir(&part) {
                Err(e) if e.kind() == ErrorKind::AlreadyExists => continue,
                made => made?,
            }
            let lock = File::open(&part).ok();
            let swept = lock.as_ref().is_some_and(|lock| matches!(lock.try_lock(), Err(TryLockError::WouldBlock)));
            if !swept && part.is_dir() {
                parts.insert(part.clone());
                return Ok(Self { part, _lock: lock });
            }
        }
        Err(io::Error::new(ErrorKind::AlreadyExists, "a thousand folders in the making stand beside it"))
    }

    /// Returns a temporary name for the folder that this one replaces.
    pub fn aside(&self) -> PathBuf {
        let mut name = self.part.as_os_str().to_owned();
        name.push(".before");
        name.into()
    }
}

impl Drop for TemporaryFolder {
    fn drop(&mut self) {
        let mut parts = making();
        // The folder no longer exists if it has taken its final name.
        let _ = fs::remove_dir_all(&self.part);
        parts.remove(&self.part);
    }
}

/// A file whose writing can fail by an injected fault.
#[derive(Debug)]
pub(super) struct FallibleFile(pub File);

impl Write for FallibleFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if super::fault::is_due(WriteStep::Fallible) {
            self.0.write_all(&bytes[..bytes.len() / 2])?;
            super::fault::strike()?;
        }
        self.0.write(bytes)
    }
    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

impl Seek for FallibleFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.0.seek(to)
    }
}

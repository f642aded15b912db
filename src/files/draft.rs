//! [`Draft`]: a file in the making, beside the one that it is to become, and what becomes of it if the program ends.
//!
//! The crate `tempfile` makes such files too, but leaves three things to do that make up this file: what a killed program
//! left behind is found again and removed, by its name and because nobody holds its lock; who ends the program by a signal
//! removes all drafts without dropping their owners, and keeps others from taking their names meanwhile; and a fault can be
//! asked for at each step. What it would bring is the loop for a free name.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::fault::Step;

pub(super) fn folder_of(file: &Path) -> &Path {
    file.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The files in the making of this program. Who holds them keeps others from beginning and from taking their names.
static MAKING: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

pub(super) fn making() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    MAKING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// All files in the making are gone, and no other can begin or take its name as long as this lives.
#[derive(Debug)]
pub struct Abandoned(#[expect(dead_code, reason = "held, not read")] MutexGuard<'static, BTreeSet<PathBuf>>);

/// Gives up all files in the making, for who is about to end the program.
pub fn abandon() -> Abandoned {
    let parts = making();
    for part in parts.iter() {
        // Nobody is left to tell.
        let _ = fs::remove_file(part);
    }
    Abandoned(parts)
}

/// What names of files in the making end in.
pub(super) const PART_ENDING: &str = ".stillbase.part";

/// Where a file is written before it takes its name: hidden beside it, `.case.csv.4711-0.stillbase.part`.
fn part_of(file: &Path, attempt: u32) -> PathBuf {
    // A name may be as long as the file system allows already.
    let name: String = file.file_name().unwrap_or_default().to_string_lossy().chars().take(40).collect();
    file.with_file_name(format!(".{name}.{}-{attempt}{PART_ENDING}", std::process::id()))
}

fn is_part(name: &OsStr) -> bool {
    let counted = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let middle = name.to_str().and_then(|name| name.strip_prefix('.')?.strip_suffix(PART_ENDING));
    let number = middle.and_then(|middle| middle.rsplit_once('.')?.1.split_once('-'));
    number.is_some_and(|(process, attempt)| counted(process) && counted(attempt))
}

/// Removes what programs that were killed have left in a folder. Who makes a file holds a lock on it, which ends with
/// the program whatever ends it.
fn sweep(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    let plain = |entry: &fs::DirEntry| entry.file_type().is_ok_and(|kind| kind.is_file());
    for entry in entries.flatten().filter(|entry| is_part(&entry.file_name()) && plain(entry)) {
        let Ok(part) = File::open(entry.path()) else { continue };
        if part.try_lock().is_ok() {
            // Where it cannot be removed, it belongs to another user.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// A file beside the one that it is to become.
#[derive(Debug)]
pub(super) struct Draft {
    pub part: PathBuf,
    pub file: PathBuf,
}

impl Draft {
    /// Begins a file beside another, locked.
    pub fn create(file: PathBuf) -> io::Result<(Self, File)> {
        sweep(folder_of(&file));
        let mut parts = making();
        for attempt in 0..1000 {
            let part = part_of(&file, attempt);
            super::fault::at(Step::Fallible)?;
            let out = match OpenOptions::new().read(true).write(true).create_new(true).open(&part) {
                Err(e) if e.kind() == ErrorKind::AlreadyExists => continue,
                out => out?,
            };
            // Another program may have removed it in between; where files cannot be locked, none are removed.
            let swept = matches!(out.try_lock(), Err(TryLockError::WouldBlock)) || part.symlink_metadata().is_err();
            if !swept {
                parts.insert(part.clone());
                return Ok((Self { part, file }, out));
            }
        }
        Err(io::Error::new(ErrorKind::AlreadyExists, "a thousand files in the making stand beside it"))
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        let mut parts = making();
        // Gone already if it has taken its name; if it cannot be removed, the next who writes here tries again.
        let _ = fs::remove_file(&self.part);
        parts.remove(&self.part);
    }
}

/// A file whose writing can be made to fail.
#[derive(Debug)]
pub(super) struct Checked(pub File);

impl Write for Checked {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if super::fault::is_due(Step::Fallible) {
            self.0.write_all(&bytes[..bytes.len() / 2])?;
            super::fault::strike()?;
        }
        self.0.write(bytes)
    }
    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

impl Seek for Checked {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.0.seek(to)
    }
}

//! [`Journal`]: a backup of the present session, so that a crash, a kill or a power cut loses at most its last second.
//! The file is removed when the program ends normally; a file that remains is offered for recovery at the next start.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::{WriteError, write_new};

/// Returns the folder of journals: `stillbase/sessions` in the system's folder for program state, such as
/// `~/.local/state`.
pub fn folder() -> Option<PathBuf> {
    let own = directories::ProjectDirs::from("", "", "stillbase")?;
    Some(own.state_dir().unwrap_or_else(|| own.data_local_dir()).join("sessions"))
}

/// Maximum number of journals, that is, of programs that run at once with a journal each.
const MAX_JOURNALS: usize = 64;

/// The journal of a running program, which holds a lock on it.
#[derive(Debug)]
pub struct Journal {
    file: PathBuf,
    lock: (PathBuf, File),
}

/// A journal of a program that did not end normally.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftoverJournal {
    /// File of the session.
    pub file: PathBuf,
    /// Time of its last change.
    pub when: SystemTime,
}

fn names(folder: &Path, number: usize) -> [PathBuf; 2] {
    [folder.join(format!("session-{number}.toml")), folder.join(format!("session-{number}.lock"))]
}

/// Opens and locks a lock file, if no other program holds it.
fn locked(name: &Path) -> Option<File> {
    let file = File::options().create(true).truncate(false).write(true).open(name).ok()?;
    match file.try_lock() {
        Ok(()) => Some(file),
        Err(TryLockError::WouldBlock | TryLockError::Error(_)) => None,
    }
}

impl Journal {
    /// Begins a journal under the first free number; `None` if there is none, or if the folder cannot be written.
    pub fn begin(folder: &Path) -> Option<Self> {
        fs::create_dir_all(folder).ok()?;
        (0..MAX_JOURNALS).find_map(|number| {
            let [file, name] = names(folder, number);
            let lock = locked(&name)?;
            // Checked while the lock is held: before that, another program could begin this journal after the check.
            file.symlink_metadata().is_err().then_some(Self { file, lock: (name, lock) })
        })
    }

    /// Returns its file.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// Removes the journal, so that no recovery is offered at the next start.
    pub fn end(self) {
        remove_journal(&self.file);
        let (name, lock) = self.lock;
        // Removed while still locked, so that no other program locks a file that is about to be removed.
        let _ = fs::remove_file(name);
        drop(lock);
    }
}

/// Writes a session, whole or not at all, and syncs it to the disk.
///
/// # Errors
/// If the session cannot be written.
pub fn write(file: &Path, text: &str) -> Result<(), WriteError> {
    write_new(file, text.as_bytes(), true)
}

/// Returns the journals of programs that did not end normally, newest first.
pub fn leftover_journals(folder: &Path) -> Vec<LeftoverJournal> {
    let of = |number: usize| {
        let [file, name] = names(folder, number);
        let about = file.symlink_metadata().ok().filter(fs::Metadata::is_file)?;
        // If the lock is held, its program still runs.
        locked(&name)?;
        Some(LeftoverJournal { file, when: about.modified().ok()? })
    };
    let mut all: Vec<LeftoverJournal> = (0..MAX_JOURNALS).filter_map(of).collect();
    all.sort_by_key(|left| std::cmp::Reverse(left.when));
    all
}

/// Removes a journal.
pub fn remove_journal(file: &Path) {
    // A journal that cannot be removed is offered again, and nothing is lost.
    let _ = fs::remove_file(file);
}

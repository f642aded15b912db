//! [`Journal`]: the present session in a file of the program's own, so that a crash, a kill or a power cut loses at most
//! its last second. The file goes when the program ends in order; one that is left behind is offered at the next start.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::{WriteError, write_new};

/// Where journals stand: `stillbase/sessions` in the folder for what programs remember, such as `~/.local/state`.
pub fn folder() -> Option<PathBuf> {
    let own = directories::ProjectDirs::from("", "", "stillbase")?;
    Some(own.state_dir().unwrap_or_else(|| own.data_local_dir()).join("sessions"))
}

/// How many programs may run at once and keep a journal each; no file is looked for beyond.
const MOST: usize = 64;

/// The journal of a program that runs. It is locked as long as that is so.
#[derive(Debug)]
pub struct Journal {
    file: PathBuf,
    lock: (PathBuf, File),
}

/// What a program left behind that did not end in order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Left {
    /// The session.
    pub file: PathBuf,
    /// When it was written last.
    pub when: SystemTime,
}

fn names(folder: &Path, number: usize) -> [PathBuf; 2] {
    [folder.join(format!("session-{number}.toml")), folder.join(format!("session-{number}.lock"))]
}

/// A lock file of one's own, if nobody holds it.
fn locked(name: &Path) -> Option<File> {
    let file = File::options().create(true).truncate(false).write(true).open(name).ok()?;
    match file.try_lock() {
        Ok(()) => Some(file),
        Err(TryLockError::WouldBlock | TryLockError::Error(_)) => None,
    }
}

impl Journal {
    /// The first that nobody writes and nobody left behind; `None` if the folder cannot be written.
    pub fn begin(folder: &Path) -> Option<Self> {
        fs::create_dir_all(folder).ok()?;
        (0..MOST).find_map(|number| {
            let [file, name] = names(folder, number);
            let lock = locked(&name)?;
            // Looked for with the lock held: another program may have begun in between.
            file.symlink_metadata().is_err().then_some(Self { file, lock: (name, lock) })
        })
    }

    /// Where it is written.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// Removes it: there is nothing to be offered at the next start.
    pub fn end(self) {
        forget(&self.file);
        let (name, lock) = self.lock;
        // Before it is let go, so that nobody else takes what is about to be removed.
        let _ = fs::remove_file(name);
        drop(lock);
    }
}

/// Writes a session, whole or not at all, and has it on the disk.
///
/// # Errors
/// If it cannot be written.
pub fn write(file: &Path, text: &str) -> Result<(), WriteError> {
    write_new(file, text.as_bytes(), true)
}

/// What was left behind by programs that did not end in order, newest first.
pub fn left(folder: &Path) -> Vec<Left> {
    let of = |number: usize| {
        let [file, name] = names(folder, number);
        let about = file.symlink_metadata().ok().filter(fs::Metadata::is_file)?;
        // Held: its program still runs.
        locked(&name)?;
        Some(Left { file, when: about.modified().ok()? })
    };
    let mut all: Vec<Left> = (0..MOST).filter_map(of).collect();
    all.sort_by_key(|left| std::cmp::Reverse(left.when));
    all
}

/// Removes what was left behind.
pub fn forget(file: &Path) {
    // One that cannot be removed is offered once more, and nothing is lost.
    let _ = fs::remove_file(file);
}

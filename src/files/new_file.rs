//! [`NewFile`]: a file that appears whole or not at all, and replaces nothing unasked.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::draft::{Checked, Draft, PART_ENDING, folder_of, making};
use super::fault::Step;

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
        /// The system's reason.
        source: io::Error,
    },
    /// It is there, but the disk may not know it yet.
    #[error("{} is written whole, but its folder was not synced ({source}): a power cut may undo it", file.display())]
    Unsynced {
        /// The file.
        file: PathBuf,
        /// The system's reason.
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

/// A file in the making, buffered. It takes its name in [`finish`](Self::finish); dropped before, it leaves nothing.
#[derive(Debug)]
pub struct NewFile {
    /// What errors call it.
    asked: PathBuf,
    force: bool,
    /// The file that it replaces has further names (hard links), which are to show the new content, too.
    has_other_names: bool,
    out: BufWriter<Checked>,
    draft: Draft,
}

/// The file that another one replaces.
struct Before {
    metadata: fs::Metadata,
    has_other_names: bool,
}

impl Before {
    fn of(file: &Path) -> Option<Self> {
        let metadata = fs::symlink_metadata(file).ok().filter(fs::Metadata::is_file)?;
        #[cfg(unix)]
        let has_other_names = std::os::unix::fs::MetadataExt::nlink(&metadata) > 1;
        #[cfg(not(unix))]
        let has_other_names = false;
        Some(Self { metadata, has_other_names })
    }

    /// Gives a file its owner, as far as the system allows, and its permissions: who could not read the old content
    /// cannot read the new one.
    fn lend_access(&self, file: &File) -> io::Result<()> {
        #[cfg(unix)]
        {
            use std::os::unix::fs::{MetadataExt, fchown};
            // Only the superuser may give files away; the owner is then who writes.
            let _ = fchown(file, Some(self.metadata.uid()), Some(self.metadata.gid()));
        }
        file.set_permissions(self.metadata.permissions())
    }
}

impl NewFile {
    /// Begins a file.
    ///
    /// # Errors
    /// As [`check_new`], or if its folder cannot be written.
    pub fn create(file: &Path, force: bool) -> Result<Self, WriteError> {
        check_new(file, force)?;
        // Through a link, so that the link stays.
        let target = fs::canonicalize(file).unwrap_or_else(|_| file.into());
        let failed = |source| WriteError::Failed { file: file.into(), source };
        let before = Before::of(&target);
        let (draft, out) = Draft::create(target).map_err(failed)?;
        if let Some(before) = &before {
            before.lend_access(&out).map_err(failed)?;
        }
        let has_other_names = before.is_some_and(|before| before.has_other_names);
        Ok(Self { asked: file.into(), force, has_other_names, out: BufWriter::new(Checked(out)), draft })
    }

    /// What was asked for.
    pub fn path(&self) -> &Path {
        &self.asked
    }

    /// The last bytes so far, at most so many, and where they begin.
    ///
    /// # Errors
    /// If they cannot be read.
    pub fn tail(&mut self, most: u64) -> io::Result<(u64, Vec<u8>)> {
        let end = self.out.seek(SeekFrom::End(0))?;
        let from = end.saturating_sub(most);
        let mut bytes = Vec::new();
        let file = &mut self.out.get_mut().0;
        file.seek(SeekFrom::Start(from))?;
        file.take(most).read_to_end(&mut bytes)?;
        Ok((from, bytes))
    }

    /// Writes over what stands somewhere.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn replace(&mut self, at: u64, bytes: &[u8]) -> io::Result<()> {
        self.out.seek(SeekFrom::Start(at))?;
        self.out.write_all(bytes)?;
        self.out.seek(SeekFrom::End(0)).map(|_| ())
    }

    /// Puts the file under its name.
    ///
    /// # Errors
    /// If not everything could be written, or another file has taken the name meanwhile.
    pub fn finish(self) -> Result<(), WriteError> {
        finish_all([self])
    }

    fn failed(&self, source: io::Error) -> WriteError {
        WriteError::Failed { file: self.asked.clone(), source }
    }

    /// Everything on the disk, under whatever name.
    fn settle(&mut self) -> Result<(), WriteError> {
        let settled = self
            .out
            .flush()
            .and_then(|()| super::fault::at(Step::Fallible))
            .and_then(|()| self.out.get_ref().0.sync_all());
        settled.map_err(|source| self.failed(source))
    }

    /// Takes its name; what was there before, if it may be replaced, is kept aside if asked to.
    fn take_name(&self, keep: bool) -> Result<Taken, WriteError> {
        let Draft { part, file } = &self.draft;
        check_new(&self.asked, self.force)?;
        let in_place = self.has_other_names;
        let before = if self.force && (keep || in_place) { aside(part, file, in_place) } else { None };
        let named = |()| match (self.force, in_place, &before) {
            (false, ..) => link(part, file),
            (true, false, _) => fs::rename(part, file),
            (true, true, Some(before)) => copy_into(part, file).inspect_err(|_| _ = copy_into(before, file)),
            (true, true, None) => Err(io::Error::other("no room for a copy of what it replaces")),
        };
        match super::fault::at(Step::Fallible).and_then(named) {
            Ok(()) => Ok(Taken { file: file.clone(), before, in_place }),
            Err(error) => {
                before.map(fs::remove_file);
                Err(match error.kind() {
                    ErrorKind::AlreadyExists => WriteError::Exists(self.asked.clone()),
                    _ => self.failed(error),
                })
            }
        }
    }
}

/// Gives a file in the making a name that must be free: of two that try, one succeeds.
fn link(part: &Path, file: &Path) -> io::Result<()> {
    match fs::hard_link(part, file) {
        Ok(()) => {
            if super::fault::at(Step::Tidy).is_ok() {
                // It goes with the draft otherwise.
                let _ = fs::remove_file(part);
            }
            Ok(())
        }
        Err(e) if e.kind() == ErrorKind::AlreadyExists => Err(e),
        // A file system without second names: an empty file keeps the name until the whole one replaces it.
        Err(_) => {
            OpenOptions::new().write(true).create_new(true).open(file)?;
            fs::rename(part, file).inspect_err(|_| _ = fs::remove_file(file))
        }
    }
}

/// Writes the content of a file into another one, which keeps all its names, and has it on the disk. Other than a name,
/// content does not change at once: ended in between, both versions are left beside it until the next file is written.
fn copy_into(from: &Path, to: &Path) -> io::Result<()> {
    let (mut from, mut to) = (File::open(from)?, OpenOptions::new().write(true).truncate(true).open(to)?);
    super::fault::at(Step::Tidy)?;
    io::copy(&mut from, &mut to)?;
    to.sync_all()
}

/// What a file holds that is about to be replaced, under another name, if the file system has room for that: a copy
/// where the file is written over. A sweep takes it for left over.
fn aside(part: &Path, file: &Path, copied: bool) -> Option<PathBuf> {
    let aside =
        part.with_file_name(format!("{}0{PART_ENDING}", part.file_name()?.to_str()?.strip_suffix(PART_ENDING)?));
    let made = if copied { fs::copy(file, &aside).map(|_| ()) } else { fs::hard_link(file, &aside) };
    made.inspect_err(|_| {
        if copied {
            _ = fs::remove_file(&aside)
        }
    })
    .ok()
    .map(|()| aside)
}

/// A name that was taken.
struct Taken {
    file: PathBuf,
    /// What had the name before.
    before: Option<PathBuf>,
    /// Its content was replaced, not its name.
    in_place: bool,
}

impl Taken {
    /// As it was.
    fn give_back(self, force: bool) {
        // What was kept aside comes back; a name that was free is free again.
        let _ = match &self.before {
            Some(before) if self.in_place => copy_into(before, &self.file).and_then(|()| fs::remove_file(before)),
            Some(before) => fs::rename(before, &self.file),
            None if !force => fs::remove_file(&self.file),
            None => Ok(()),
        };
    }
}

/// Puts files that belong together under their names: all, or none. They take them in their order, so where the last
/// one is, all are.
///
/// # Errors
/// If not everything could be written, or another file has taken a name meanwhile.
pub fn finish_all<const N: usize>(mut files: [NewFile; N]) -> Result<(), WriteError> {
    for file in &mut files {
        file.settle()?;
    }
    let mut taken = Vec::with_capacity(N);
    // Nothing may come between: not the end of the program either.
    let parts = making();
    for file in &files {
        match file.take_name(N > 1) {
            Ok(name) => taken.push((name, file.force)),
            Err(error) => {
                taken.into_iter().rev().for_each(|(name, force)| name.give_back(force));
                drop(parts);
                return Err(error);
            }
        }
    }
    for before in taken.iter().filter_map(|(name, _)| name.before.as_ref()) {
        let _ = fs::remove_file(before);
    }
    drop(parts);
    for file in &files {
        let synced = super::fault::at(Step::Fallible).and_then(|()| sync(folder_of(&file.draft.file)));
        synced.map_err(|source| WriteError::Unsynced { file: file.asked.clone(), source })?;
    }
    Ok(())
}

/// Has the disk know the names in a folder.
fn sync(folder: &Path) -> io::Result<()> {
    if !cfg!(unix) {
        return Ok(());
    }
    // A folder that may be written need not be readable.
    let Ok(folder) = File::open(folder) else { return Ok(()) };
    match folder.sync_all() {
        // Not every file system knows how.
        Err(e) if matches!(e.kind(), ErrorKind::InvalidInput | ErrorKind::Unsupported) => Ok(()),
        done => done,
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
    made(file, bytes, force)?.finish()
}

/// A whole file that has yet to take its name.
///
/// # Errors
/// As [`write_new`].
pub fn made(file: &Path, bytes: &[u8], force: bool) -> Result<NewFile, WriteError> {
    let mut out = NewFile::create(file, force)?;
    out.write_all(bytes).map_err(|source| WriteError::Failed { file: file.into(), source })?;
    Ok(out)
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

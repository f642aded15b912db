//! [`NewFile`]: a file that appears whole or not at all, and replaces another only if forced. One that is meant for
//! standard output is written to a temporary file first, and copied there when it is whole.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::draft::{FallibleFile, PART_ENDING, TemporaryFile, folder_of, making};
use super::fault::WriteStep;

/// Why a file was not written.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The file exists already.
    #[error("{} exists: want another name, or --force to replace it", .0.display())]
    Exists(PathBuf),
    /// The name belongs to a folder.
    #[error("{} is a folder: want the name of a file", .0.display())]
    IsFolder(PathBuf),
    /// The name belongs to a device or a pipe, which is not replaced.
    #[error("{} is no plain file: want the name of a new one", .0.display())]
    NotPlain(PathBuf),
    /// The name of a folder belongs to a file.
    #[error("{} is no folder: want a new name, or one that ends in .gif or .png", .0.display())]
    NotAFolder(PathBuf),
    /// The folder to be replaced holds other files.
    #[error("{} holds more than numbered pictures: want another name", .0.display())]
    HoldsOthers(PathBuf),
    /// Its folder does not exist.
    #[error("{}: no folder {}: want one that exists", file.display(), folder.display())]
    NoFolder {
        /// The file.
        file: PathBuf,
        /// The folder.
        folder: PathBuf,
    },
    /// The file system reports an error.
    #[error("{}: {source}: want a place that can be written", file.display())]
    Failed {
        /// The file.
        file: PathBuf,
        /// Reason given by the operating system.
        source: io::Error,
    },
    /// Overwriting the file failed, and so did restoring it.
    #[error("{} is not whole ({source}): what it held before is in {}", file.display(), before.display())]
    Damaged {
        /// The file.
        file: PathBuf,
        /// The file with its previous content.
        before: PathBuf,
        /// Reason given by the operating system.
        source: io::Error,
    },
    /// Standard output cannot be written.
    #[error("standard output: {0}: want a place that can be written")]
    Standard(#[source] io::Error),
    /// The file is complete, but its folder could not be synced to the disk.
    #[error("{} is written whole, but its folder was not synced ({source}): a power cut may undo it", file.display())]
    Unsynced {
        /// The file.
        file: PathBuf,
        /// Reason given by the operating system.
        source: io::Error,
    },
}

/// Name of standard output as a file.
const STANDARD_OUTPUT: &str = "-";

/// Returns whether the name of a file is that of standard output.
pub fn is_standard(file: &Path) -> bool {
    file.as_os_str() == STANDARD_OUTPUT
}

/// Checks that a file may be written: its folder exists, and the name is not that of a folder or device. The file must
/// not exist, unless `force` is set. Standard output may be written.
///
/// # Errors
/// If one of these does not hold.
pub fn check_new(file: &Path, force: bool) -> Result<(), WriteError> {
    if is_standard(file) {
        return Ok(());
    }
    match fs::metadata(file) {
        Ok(there) if there.is_dir() => return Err(WriteError::IsFolder(file.into())),
        Ok(there) if !there.is_file() => return Err(WriteError::NotPlain(file.into())),
        // A dangling link counts as an existing file.
        _ if !force && fs::symlink_metadata(file).is_ok() => return Err(WriteError::Exists(file.into())),
        _ => {}
    }
    let folder = folder_of(file);
    match folder.is_dir() {
        true => Ok(()),
        false => Err(WriteError::NoFolder { file: file.into(), folder: folder.into() }),
    }
}

/// A buffered file being written. [`finish`](Self::finish) gives it its final name; if it is dropped before,
/// nothing remains.
#[derive(Debug)]
pub struct NewFile {
    /// The requested path, which errors name.
    requested: PathBuf,
    force: bool,
    /// Whether the file that it replaces has further hard links, which must get the new content, too.
    has_other_names: bool,
    out: BufWriter<FallibleFile>,
    draft: TemporaryFile,
}

/// The file that a new file replaces.
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

    /// Copies the permissions of the old file, and its owner as far as the system allows, to a new file. So only those
    /// who could read the old content can read the new one.
    fn lend_access(&self, file: &File) -> io::Result<()> {
        #[cfg(unix)]
        {
            use std::os::unix::fs::{MetadataExt, fchown};
            // Only the superuser may change the owner; otherwise the writing user owns the file.
            let _ = fchown(file, Some(self.metadata.uid()), Some(self.metadata.gid()));
        }
        file.set_permissions(self.metadata.permissions())
    }
}

impl NewFile {
    /// Begins a new file; `-` is standard output.
    ///
    /// # Errors
    /// As [`check_new`], or if its folder cannot be written.
    pub fn create(file: &Path, force: bool) -> Result<Self, WriteError> {
        check_new(file, force)?;
        let target = match is_standard(file) {
            true => std::env::temp_dir().join("standard-output"),
            // A link is followed, so that the link itself stays.
            false => fs::canonicalize(file).unwrap_or_else(|_| file.into()),
        };
        let failed = |source| WriteError::Failed { file: file.into(), source };
        let before = if is_standard(file) { None } else { Before::of(&target) };
        let (draft, out) = TemporaryFile::create(target).map_err(failed)?;
        if let Some(before) = &before {
            before.lend_access(&out).map_err(failed)?;
        }
        #[cfg(unix)]
        if is_standard(file) {
            use std::os::unix::fs::PermissionsExt;
            // Others can look into the folder of temporary files.
            out.set_permissions(fs::Permissions::from_mode(0o600)).map_err(failed)?;
        }
        let has_other_names = before.is_some_and(|before| before.has_other_names);
        Ok(Self { requested: file.into(), force, has_other_names, out: BufWriter::new(FallibleFile(out)), draft })
    }

    /// Returns the requested path.
    pub fn path(&self) -> &Path {
        &self.requested
    }

    /// Returns the temporary path, to which another program may write the content.
    pub(super) fn draft_path(&self) -> &Path {
        &self.draft.part
    }

    /// Returns the last bytes written so far, at most `most`, with their offset in the file.
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

    /// Overwrites the bytes at an offset.
    ///
    /// # Errors
    /// If the bytes cannot be written.
    pub fn replace(&mut self, at: u64, bytes: &[u8]) -> io::Result<()> {
        self.out.seek(SeekFrom::Start(at))?;
        self.out.write_all(bytes)?;
        self.out.seek(SeekFrom::End(0)).map(|_| ())
    }

    /// Gives the file its final name.
    ///
    /// # Errors
    /// If not everything could be written or synced, or another file has taken the name meanwhile.
    pub fn finish(self) -> Result<(), WriteError> {
        finish_all([self])
    }

    fn failed(&self, source: io::Error) -> WriteError {
        WriteError::Failed { file: self.requested.clone(), source }
    }

    /// Syncs its content to the disk, still under its temporary name.
    fn sync_content(&mut self) -> Result<(), WriteError> {
        let synced = self
            .out
            .flush()
            .and_then(|()| super::fault::fail_if_due(WriteStep::Fallible))
            .and_then(|()| self.out.get_ref().0.sync_all());
        synced.map_err(|source| self.failed(source))
    }

    /// Copies the content to standard output.
    fn print(&self) -> Result<(), WriteError> {
        let copied = || {
            // Another program may have written it.
            let mut content = File::open(&self.draft.part)?;
            let mut out = io::stdout().lock();
            io::copy(&mut content, &mut out)?;
            out.flush()
        };
        copied().map_err(WriteError::Standard)
    }

    /// Gives the file its final name. With `keep`, the file that it replaces is kept under a temporary name.
    fn take_name(&self, keep: bool) -> Result<Taken, WriteError> {
        let TemporaryFile { part, file } = &self.draft;
        check_new(&self.requested, self.force)?;
        let in_place = self.has_other_names;
        let before = if self.force && (keep || in_place) { aside(part, file, in_place) } else { None };
        let mut restored = true;
        let named = |()| match (self.force, in_place, &before) {
            (false, ..) => link(part, file),
            (true, false, _) => fs::rename(part, file),
            (true, true, Some(before)) => {
                copy_into(part, file).inspect_err(|_| restored = copy_into(before, file).is_ok())
            }
            (true, true, None) => Err(io::Error::other("no room for a copy of what it replaces")),
        };
        match super::fault::fail_if_due(WriteStep::Fallible).and_then(named) {
            Ok(()) => Ok(Taken { file: file.clone(), before, in_place }),
            Err(error) => {
                if let (false, Some(before)) = (restored, &before) {
                    let before = named_before(before, file);
                    return Err(WriteError::Damaged { file: self.requested.clone(), before, source: error });
                }
                before.map(fs::remove_file);
                Err(match error.kind() {
                    ErrorKind::AlreadyExists => WriteError::Exists(self.requested.clone()),
                    _ => self.failed(error),
                })
            }
        }
    }
}

/// Gives a temporary file a final name that must be free: of two programs that try, one succeeds.
fn link(part: &Path, file: &Path) -> io::Result<()> {
    match fs::hard_link(part, file) {
        Ok(()) => {
            if super::fault::fail_if_due(WriteStep::Tidy).is_ok() {
                // If this fails, dropping the [`TemporaryFile`] removes the file.
                let _ = fs::remove_file(part);
            }
            Ok(())
        }
        Err(e) if e.kind() == ErrorKind::AlreadyExists => Err(e),
        // On a file system without hard links, an empty file reserves the name until the complete file replaces it.
        Err(_) => {
            OpenOptions::new().write(true).create_new(true).open(file)?;
            fs::rename(part, file).inspect_err(|_| _ = fs::remove_file(file))
        }
    }
}

/// Copies the content of a file into another, which keeps all its hard links, and syncs it. Unlike a rename this is not
/// atomic: if the program ends in between, both versions remain under temporary names until the next file is written.
fn copy_into(from: &Path, to: &Path) -> io::Result<()> {
    let (mut from, mut to) = (File::open(from)?, OpenOptions::new().write(true).truncate(true).open(to)?);
    super::fault::fail_if_due(WriteStep::Tidy)?;
    io::copy(&mut from, &mut to)?;
    to.sync_all()
}

/// Keeps, under a temporary name, the content of a file that is about to be replaced, if the file system allows it.
/// This is a copy if the file will be overwritten, or else a hard link. If the program is killed, a later write
/// removes it.
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

/// Renames the previous content of a file from its temporary name to a lasting one, because the next write would remove
/// a temporary file. The name is `FILE.before`, `FILE.before-1` and so on.
fn named_before(temporary: &Path, file: &Path) -> PathBuf {
    let mut name = file.as_os_str().to_owned();
    name.push(".before");
    let numbered = (1..1000).map(|i| PathBuf::from(format!("{}-{i}", Path::new(&name).display())));
    let free = std::iter::once(PathBuf::from(&name)).chain(numbered).find(|file| file.symlink_metadata().is_err());
    free.filter(|free| fs::rename(temporary, free).is_ok()).unwrap_or_else(|| temporary.into())
}

/// A final name that a file has taken.
struct Taken {
    file: PathBuf,
    /// The previous file of that name, under its temporary name.
    before: Option<PathBuf>,
    /// Whether the content of the previous file was overwritten, rather than its name replaced.
    in_place: bool,
}

impl Taken {
    /// Restores the previous state: the previous file, or a free name.
    fn give_back(self, force: bool) {
        let _ = match &self.before {
            Some(before) if self.in_place => copy_into(before, &self.file).and_then(|()| fs::remove_file(before)),
            Some(before) => fs::rename(before, &self.file),
            None if !force => fs::remove_file(&self.file),
            None => Ok(()),
        };
    }
}

/// Gives files that belong together their final names: all, or none. Names are taken in order, so when the last new
/// file is in place, all are. Standard output is written last.
///
/// # Errors
/// If not everything could be written or synced, or another file has taken a name meanwhile.
pub fn finish_all<const N: usize>(mut files: [NewFile; N]) -> Result<(), WriteError> {
    for file in &mut files {
        file.sync_content()?;
    }
    let mut taken = Vec::with_capacity(N);
    // While this lock is held, no other temporary file takes its final name, and no signal handler ends the program.
    let parts = making();
    let has_name = |file: &&NewFile| !is_standard(&file.requested);
    for file in files.iter().filter(has_name) {
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
    for file in files.iter().filter(has_name) {
        let synced = super::fault::fail_if_due(WriteStep::Fallible).and_then(|()| sync(folder_of(&file.draft.file)));
        synced.map_err(|source| WriteError::Unsynced { file: file.requested.clone(), source })?;
    }
    files.iter().filter(|file| !has_name(file)).try_for_each(NewFile::print)
}

/// Syncs the names in a folder to the disk.
fn sync(folder: &Path) -> io::Result<()> {
    if !cfg!(unix) {
        return Ok(());
    }
    // A folder that may be written need not be readable.
    let Ok(folder) = File::open(folder) else { return Ok(()) };
    match folder.sync_all() {
        // Not every file system can sync folders.
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

/// Writes a whole file, or leaves everything unchanged.
///
/// # Errors
/// If the file exists and `force` is not set, or if it cannot be written.
pub fn write_new(file: &Path, bytes: &[u8], force: bool) -> Result<(), WriteError> {
    write_temporary(file, bytes, force)?.finish()
}

/// Writes the whole content of a file under a temporary name; [`NewFile::finish`] gives it its final name.
///
/// # Errors
/// As [`write_new`].
pub fn write_temporary(file: &Path, bytes: &[u8], force: bool) -> Result<NewFile, WriteError> {
    let mut out = NewFile::create(file, force)?;
    out.write_all(bytes).map_err(|source| WriteError::Failed { file: file.into(), source })?;
    Ok(out)
}

/// Returns whether two paths name the same file. The file need not exist, but its folder must.
pub fn is_same_place(a: &Path, b: &Path) -> bool {
    let place = |file: &Path| {
        let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let whole = fs::canonicalize(file).ok();
        whole.or_else(|| Some(fs::canonicalize(folder).ok()?.join(file.file_name()?)))
    };
    a == b || place(a).is_some_and(|a| place(b) == Some(a))
}

/// Returns the first of `name.ending`, `name-1.ending` and so on that is free in the current folder. If `ending` is
/// empty, the name has no dot.
pub fn free_name(name: &str, ending: &str) -> PathBuf {
    // `name` is free text; the file must stay in this folder.
    let plain = |c: char| if c.is_alphanumeric() || matches!(c, '-' | '_' | ' ') { c } else { '-' };
    let name: String = name.chars().map(plain).take(100).collect();
    let ending = if ending.is_empty() { String::new() } else { format!(".{ending}") };
    let numbered = (1..1000).map(|i| PathBuf::from(format!("{name}-{i}{ending}")));
    std::iter::once(PathBuf::from(format!("{name}{ending}")))
        .chain(numbered)
        .find(|file| file.symlink_metadata().is_err())
        .unwrap_or_else(|| PathBuf::from(format!("{name}-{}{ending}", std::process::id())))
}

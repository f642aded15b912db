//! Files that commands write: whole or not at all, and never over another unless asked.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::failure::Failure;

/// Says whether a file may be written.
///
/// # Errors
/// If something is there already and `force` is not set, or its folder does not exist.
pub fn may_write(path: &Path, force: bool) -> Result<(), Failure> {
    let refuse = |why: &str| Err(Failure::wrong_input(why).of(path.display()));
    match fs::metadata(path) {
        Ok(there) if there.is_dir() => return refuse("is a folder: want the name of a file"),
        // A device or a pipe takes what comes; nothing is lost in it.
        Ok(there) if !there.is_file() => return Ok(()),
        Ok(_) if !force => return refuse("exists: want another name, or --force to replace it"),
        Ok(_) => {}
        Err(_) if !force && fs::symlink_metadata(path).is_ok() => {
            return refuse("exists as a link to nowhere: want another name, or --force to replace it");
        }
        Err(_) => {}
    }
    match folder(path).is_dir() {
        true => Ok(()),
        false => refuse(&format!("there is no folder {}: want one that exists", folder(path).display())),
    }
}

fn folder(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A hidden file beside `name` that nobody else has.
fn begin(name: &Path) -> io::Result<(File, Draft)> {
    let mut attempt = 0;
    loop {
        let mut beside = std::ffi::OsString::from(".");
        beside.push(name.file_name().unwrap_or_default());
        beside.push(format!(".{}-{attempt}.part", std::process::id()));
        let draft = folder(name).join(beside);
        match OpenOptions::new().write(true).create_new(true).open(&draft) {
            Ok(file) => return Ok((file, Draft(draft))),
            // Left over by a program of the same number that was killed.
            Err(e) if e.kind() == io::ErrorKind::AlreadyExists && attempt < 100 => attempt += 1,
            Err(e) => return Err(e),
        }
    }
}

/// A file in the making. It stands under its name only once [`finish`](Self::finish) has succeeded.
pub struct NewFile {
    name: PathBuf,
    force: bool,
    file: BufWriter<File>,
    /// What is renamed in the end; none for a device, which is written directly.
    draft: Option<Draft>,
}

/// A file that goes away unless it is kept.
struct Draft(PathBuf);

impl Drop for Draft {
    fn drop(&mut self) {
        // Gone already if it was renamed.
        let _ = fs::remove_file(&self.0);
    }
}

impl NewFile {
    /// Begins a file.
    ///
    /// # Errors
    /// If it may not be written, see [`may_write`].
    pub fn create(path: &Path, force: bool) -> Result<Self, Failure> {
        may_write(path, force)?;
        // Through a link, so that the link stays.
        let name = fs::canonicalize(path).unwrap_or_else(|_| path.into());
        let failed = |e: io::Error| Failure::writing(path.display(), &e);
        if fs::metadata(&name).is_ok_and(|there| !there.is_file()) {
            let file = BufWriter::new(OpenOptions::new().write(true).open(&name).map_err(failed)?);
            return Ok(Self { name, force, file, draft: None });
        }
        let (file, draft) = begin(&name).map_err(failed)?;
        Ok(Self { name, force, file: BufWriter::new(file), draft: Some(draft) })
    }

    /// Puts the file under its name.
    ///
    /// # Errors
    /// If not everything could be written, or another file has taken the name meanwhile.
    pub fn finish(mut self) -> Result<(), Failure> {
        let failed = |e: io::Error| Failure::writing(self.name.display(), &e);
        self.file.flush().map_err(failed)?;
        if let Some(Draft(draft)) = &self.draft {
            self.file.get_ref().sync_all().map_err(failed)?;
            may_write(&self.name, self.force)?;
            fs::rename(draft, &self.name).map_err(failed)?;
        }
        Ok(())
    }
}

impl Write for NewFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }
    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

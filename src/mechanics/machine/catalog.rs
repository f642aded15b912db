//! The machines that come with the program.

use std::path::Path;
use std::sync::LazyLock;

use super::{FileError, Machine, MachineError, parse, read};
use crate::settings::range::shortened;

static BUILTINS: LazyLock<Vec<Machine>> = LazyLock::new(|| {
    [
        ("nine-link", include_str!("../../../assets/machines/nine-link.toml")),
        ("nine-link-table-1", include_str!("../../../assets/machines/nine-link-table-1.toml")),
    ]
    .into_iter()
    .map(|(name, text)| parse(text, name).expect("the machines that come along are valid"))
    .collect()
});

/// The built-in machines, the default first.
pub fn builtins() -> &'static [Machine] {
    &BUILTINS
}

/// A built-in machine by name.
pub fn builtin(name: &str) -> Option<&'static Machine> {
    builtins().iter().find(|m| m.name() == name)
}

/// A machine by built-in name or by file; a relative file is looked up beside `folder` if there is one.
///
/// # Errors
/// If it is neither, or the file is not a machine.
pub fn find(name: &str, folder: Option<&Path>) -> Result<Machine, FileError> {
    if let Some(machine) = builtin(name) {
        return Ok(machine.clone());
    }
    let file = folder.map_or_else(|| name.into(), |f| f.join(name));
    match read(&file) {
        Err(FileError::Unreadable { source, .. })
            if source.kind() == std::io::ErrorKind::NotFound && !name.ends_with(".toml") =>
        {
            let known = builtins().iter().map(Machine::name).collect::<Vec<_>>().join(", ");
            let error = MachineError::Syntax(format!("no such machine: want {known}, or a TOML file"));
            Err(FileError::Wrong { file: shortened(name, 300), line: None, error })
        }
        other => other,
    }
}

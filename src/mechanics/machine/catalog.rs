//! The machines that come with the program.

use std::sync::LazyLock;

use super::file::{FileError, parse};
use super::model::Machine;
use stillbase_settings::spelling::UnknownName;

static BUILTINS: LazyLock<Vec<Machine>> = LazyLock::new(|| {
    [
        ("nine-link", include_str!("../../../assets/machines/nine-link.toml")),
        ("nine-link-table-1", include_str!("../../../assets/machines/nine-link-table-1.toml")),
        ("two-drive", include_str!("../../../assets/machines/two-drive.toml")),
        ("four-drive", include_str!("../../../assets/machines/four-drive.toml")),
        ("serial-3r", include_str!("../../../assets/machines/serial-3r.toml")),
        ("nine-link-geared", include_str!("../../../assets/machines/nine-link-geared.toml")),
        ("counter-rotating", include_str!("../../../assets/machines/counter-rotating.toml")),
        ("scara", include_str!("../../../assets/machines/scara.toml")),
        ("space-arm", include_str!("../../../assets/machines/space-arm.toml")),
        ("spot", include_str!("../../../assets/machines/spot.toml")),
        ("ets-vii", include_str!("../../../assets/machines/ets-vii.toml")),
        ("nine-link-bare", include_str!("../../../assets/machines/nine-link-bare.toml")),
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

/// Returns a copy of a built-in machine by name; files are not searched.
///
/// # Errors
/// If there is no machine of that name; the error lists the names.
pub fn named(name: &str) -> Result<Machine, FileError> {
    builtin(name).cloned().ok_or_else(|| unknown(name, &[]))
}

/// Returns the error for a name that no built-in machine has, and none of the templates `others`.
pub fn unknown(name: &str, others: &[&'static str]) -> FileError {
    UnknownName::new(name, "machine", builtins().iter().map(Machine::name).collect(), others).into()
}

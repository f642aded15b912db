//! Writing of files without loss: a file appears whole or not at all, and replaces another only if forced. Reading of
//! tables from other programs.

mod draft;
pub mod fault;
mod find;
pub mod heading;
#[cfg(feature = "window")]
pub mod journal;
mod new_file;
#[cfg(feature = "window")]
pub mod preferences;
#[cfg(feature = "cli")]
pub mod shards;
#[cfg(feature = "tables")]
pub mod table;
pub mod text;

pub use draft::{WriteBlock, abandon};
pub use find::{FoundScenario, machine, scenario};
pub use new_file::{NewFile, WriteError, check_new, finish_all, free_name, is_same_place, made, write_new};

/// Returns the absolute path of an existing file.
pub fn absolute_path(file: &std::path::Path) -> Option<std::path::PathBuf> {
    file.canonicalize().ok()
}

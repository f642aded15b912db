//! Files written so that nothing is lost: whole or not at all, and over another one only when asked to; and tables of
//! numbers that others wrote.

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

pub use draft::{Abandoned, abandon};
pub use find::{Found, machine, scenario};
pub use new_file::{NewFile, WriteError, check_new, finish_all, free_name, made, write_new};

/// The whole name of a file that is there, so that it is found again from any folder.
pub fn whole(file: &std::path::Path) -> Option<std::path::PathBuf> {
    file.canonicalize().ok()
}

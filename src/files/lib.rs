//! Writing of files without loss: a file appears whole or not at all, and replaces another only if forced. Reading of
//! tables from other programs.
//!
//! Others reach this crate as `stillbase::files`; `stillbase` alone follows semantic versioning.

mod afloat;
mod draft;
#[doc(hidden)]
pub mod fault;
mod find;
#[doc(hidden)]
pub mod heading;
#[cfg(feature = "window")]
#[doc(hidden)]
pub mod journal;
mod new_file;
#[doc(hidden)]
pub mod new_folder;
#[cfg(feature = "rows")]
mod parquet_guard;
#[cfg(feature = "rows")]
mod parquet_rows;
#[cfg(feature = "window")]
#[doc(hidden)]
pub mod preferences;
#[cfg(feature = "record")]
pub mod recorded;
pub mod recorded_case;
#[cfg(feature = "rows")]
#[doc(hidden)]
pub mod row_file;
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod shards;
#[doc(hidden)]
pub mod stamp;
#[cfg(feature = "tables")]
pub mod table;
pub mod text;
#[doc(hidden)]
pub mod video;

#[doc(hidden)]
pub use afloat::{floating_base, left_out_of_base, scenario_afloat, scenario_on_free_base};
#[doc(hidden)]
pub use draft::{WriteBlock, abandon};
pub use find::{
    FoundMachine, FoundScenario, any_scenario, assembly, assembly_scenario, found_machine, machine, model, scenario,
};
pub use new_file::{NewFile, WriteError, write_new};
#[doc(hidden)]
pub use new_file::{check_new, finish_all, free_name, is_same_place, is_standard, write_temporary};

/// Returns the absolute path of an existing file.
#[doc(hidden)]
pub fn absolute_path(file: &std::path::Path) -> Option<std::path::PathBuf> {
    file.canonicalize().ok()
}

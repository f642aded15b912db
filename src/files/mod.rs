//! Writing files so that nothing is lost: never over another without being told to, and never half.

pub mod fault;
mod find;
mod new_file;
pub mod text;

pub use find::{machine, scenario};
pub use new_file::{Abandoned, NewFile, WriteError, abandon, check_new, finish_all, free_name, made, write_new};

//! Stillbase in Python: machines, their dynamics, and everything that the command line answers.
//!
//! Answers of the command line are found by the command line: it is carried out within the interpreter, and its JSON
//! becomes Python's dictionaries, so that names, numbers and errors are the same. Only what has to be fast goes another
//! way: the signals of a run become arrays without a copy; `dynamics` and `step_batch` work on whole arrays.
//!
//! This crate serves the workspace alone, and may change in any version.

mod arrays;
mod asked;
mod dynamics;
mod machine;
mod run;
mod steps;
mod watched;

use pyo3::prelude::*;

/// Zero reaction manipulators: the part of the package that is written in Rust.
#[pymodule]
mod _stillbase {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::asked::{NoAnswer, StillbaseError, WrongInput, ask, main, plan, record};
    #[pymodule_export]
    use super::dynamics::Dynamics;
    #[pymodule_export]
    use super::machine::Machine;
    #[pymodule_export]
    use super::run::{Run, simulate};

    /// Runs are mappings for others, too.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        let mapping = module.py().import("collections.abc")?.getattr("Mapping")?;
        mapping.call_method1("register", (module.py().get_type::<Run>(),)).map(|_| ())
    }

    /// Version of the package.
    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "a name of Python")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}

//! The program: a window on a scenario, and a command for everything else.

use std::process::ExitCode;

use stillbase_commands as commands;

/// Sets `XDG_RUNTIME_DIR`, if unset, to a folder that does not exist. Otherwise graphics libraries that look for a
/// display there print on standard error that the variable is not set.
fn name_runtime_folder() {
    const FOLDER: &str = "XDG_RUNTIME_DIR";
    if cfg!(target_os = "linux") && std::env::var_os(FOLDER).is_none_or(|folder| folder.is_empty()) {
        // SAFETY: the program has just begun and has no other thread.
        unsafe { std::env::set_var(FOLDER, "/nonexistent") };
    }
}

fn main() -> ExitCode {
    name_runtime_folder();
    option_env!("STILLBASE_COMMIT").into_iter().for_each(commands::name_commit);
    commands::watch();
    #[cfg(debug_assertions)]
    if let Ok(wanted) = std::env::var("STILLBASE_FAULT") {
        stillbase::files::fault::arm_fault(&wanted);
    }
    ExitCode::from(commands::carry_out(std::env::args_os()))
}

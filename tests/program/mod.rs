//! The program, from outside.

mod cli;
mod files;

use std::process::{Command, Output, Stdio};

use crate::folder::Folder;

impl Folder {
    /// The program, to be run in it.
    pub fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_stillbase"));
        command.args(args).current_dir(&self.0).stdin(Stdio::null());
        command
    }

    pub fn run(&self, args: &[&str]) -> Output {
        self.command(args).output().expect("the program starts")
    }
}

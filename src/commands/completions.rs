//! `stillbase completions`

use std::io::{self, Write};

use clap::Args;
use clap_complete::{Shell, generate};

use super::failure::Failure;
use super::program::Arguments;

/// Print the completions of commands and options for a shell
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase completions bash > ~/.local/share/bash-completion/completions/stillbase
  stillbase completions zsh > ~/.zfunc/_stillbase
  stillbase completions fish > ~/.config/fish/completions/stillbase.fish")]
pub struct CompletionsArguments {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

impl CompletionsArguments {
    /// Prints the completions.
    pub fn run(&self) -> Result<(), Failure> {
        // The generator panics if its writer fails, so it writes to memory.
        let mut text = Vec::new();
        generate(self.shell, &mut Arguments::program(), "stillbase", &mut text);
        let mut out = io::stdout().lock();
        out.write_all(&text).and_then(|()| out.flush()).map_err(|e| Failure::standard_output(&e))
    }
}

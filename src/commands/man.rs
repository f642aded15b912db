//! `stillbase man`

use std::io::{self, Write};
use std::path::PathBuf;

use clap::Args;
use clap_mangen::Man;
use stillbase_files::new_folder::make_folder;
use stillbase_files::{check_new, is_standard, write_new};
use stillbase_settings::number::counted;

use super::exit::print_message;
use super::failure::Failure;
use super::program::Arguments;

/// The version that manual pages state.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Print the manual page, or write one for the program and one for each command
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase man | man -l -
  stillbase man -o ~/.local/share/man/man1")]
pub struct ManArguments {
    /// Write the pages into this folder, which exists
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    /// Replace the files if they exist
    #[arg(long)]
    force: bool,
}

impl ManArguments {
    /// Prints the page of the program, or writes all pages.
    pub fn run(&self) -> Result<(), Failure> {
        let mut program = Arguments::program().version(VERSION);
        program.build();
        let Some(folder) = &self.output else {
            let text = page(program)?;
            let mut out = io::stdout().lock();
            return out.write_all(&text).and_then(|()| out.flush()).map_err(|e| Failure::standard_output(&e));
        };
        if is_standard(folder) {
            let why = "-o - is for one page, and these are several: want a folder, or `stillbase man` without -o, which \
                       prints the page of the program";
            return Err(Failure::wrong_input(why));
        }
        let commands = program.get_subcommands().filter(|command| command.get_name() != "help").cloned();
        let named = |command: clap::Command| {
            let name = format!("stillbase-{}", command.get_name());
            (name.clone(), command.name(name).version(VERSION))
        };
        let mut pages = vec![("stillbase".to_owned(), program.clone())];
        pages.extend(commands.map(named));
        let files: Vec<_> = pages.iter().map(|(name, _)| folder.join(format!("{name}.1"))).collect();
        // All are checked first, so that none is written if one cannot be.
        files.iter().try_for_each(|file| check_new(file, self.force))?;
        make_folder(folder)?;
        for (file, (_, command)) in files.iter().zip(pages) {
            write_new(file, &page(command)?, self.force)?;
        }
        print_message(format!("wrote {} to {}", counted(files.len(), "page"), folder.display()));
        Ok(())
    }
}

fn page(command: clap::Command) -> Result<Vec<u8>, Failure> {
    let mut text = Vec::new();
    Man::new(command).render(&mut text).map_err(Failure::wrong_input)?;
    Ok(text)
}

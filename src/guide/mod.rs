#![doc = include_str!("links.txt")]
#![doc = include_str!("README.md")]
//!
//! # How the guide is built
//! Each page is a Markdown file in the folder of this module, so it can be read on a code host too. Pages link by
//! labels, which they define at their end with relative paths of files. The file `links.txt` is included before each
//! page and defines the same labels with addresses in this documentation; the first definition takes precedence. Files
//! of the repository, such as pictures, are addressed relative to `target/doc`, where `cargo doc` writes. Tests check
//! that every label has both addresses and that the targets of both exist. They also run the commands of every page and
//! parse every TOML block.

macro_rules! pages {
    ($($name:ident: $file:literal,)*) => {$(
        #[doc = include_str!("links.txt")]
        #[doc = include_str!($file)]
        pub mod $name {}
    )*};
}

pages! {
    first_run: "first_run.md",
    planning: "planning.md",
    plants: "plants.md",
    spacecraft: "spacecraft.md",
    assemblies: "assemblies.md",
    inside: "inside.md",
    draw: "draw.md",
    design: "design.md",
    workshop: "workshop.md",
    elsewhere: "elsewhere.md",
    tolerances: "tolerances.md",
    trim: "trim.md",
    own_motion: "own_motion.md",
    files: "files.md",
    keys: "keys.md",
    results: "results.md",
    command_line: "command_line.md",
    recording: "recording.md",
    python: "python.md",
    many_machines: "many_machines.md",
    paper: "paper.md",
    speed: "speed.md",
}

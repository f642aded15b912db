#![doc = include_str!("links.txt")]
#![doc = include_str!("README.md")]
//!
//! # How the guide is built
//! Each page is a Markdown file beside this one, so it can be read on a code host too. Pages link by labels, which they
//! define at their end with paths between files. Before each page stands `links.txt`, which gives the same labels the
//! addresses that hold here: the first definition counts. Files of the repository, pictures among them, are addressed
//! from `target/doc`, where `cargo doc` writes. Tests hold that every label has both addresses and that both lead
//! somewhere, run the commands of every page, and read every TOML block.

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
    inside: "inside.md",
    design: "design.md",
    elsewhere: "elsewhere.md",
    tolerances: "tolerances.md",
    trim: "trim.md",
    own_motion: "own_motion.md",
    files: "files.md",
    keys: "keys.md",
    command_line: "command_line.md",
    recording: "recording.md",
    paper: "paper.md",
    speed: "speed.md",
}

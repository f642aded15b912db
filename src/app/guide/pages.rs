//! [`Page`]: the pages of the guide, as they are compiled into the program.

/// Declares the pages by their files without extension, in the order of the index.
macro_rules! pages {
    ($($page:ident: $file:literal,)*) => {
        /// A page of the guide.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Page {
            $(#[doc = concat!("The page `", $file, ".md`.")] $page,)*
        }

        impl Page {
            /// All pages, in the order of the index, which comes first.
            pub const ALL: &[Self] = &[$(Self::$page),*];

            /// Returns the name of the file without its extension.
            pub const fn file(self) -> &'static str {
                match self { $(Self::$page => $file),* }
            }

            /// Returns the text, Markdown.
            pub const fn text(self) -> &'static str {
                match self { $(Self::$page => include_str!(concat!("../../guide/", $file, ".md"))),* }
            }
        }
    };
}

pages! {
    Index: "README",
    FirstRun: "first_run",
    Planning: "planning",
    Plants: "plants",
    Spacecraft: "spacecraft",
    Assemblies: "assemblies",
    Inside: "inside",
    Draw: "draw",
    Design: "design",
    Workshop: "workshop",
    Elsewhere: "elsewhere",
    Tolerances: "tolerances",
    Trim: "trim",
    OwnMotion: "own_motion",
    Files: "files",
    Keys: "keys",
    Results: "results",
    CommandLine: "command_line",
    Recording: "recording",
    Python: "python",
    ManyMachines: "many_machines",
    Paper: "paper",
    Speed: "speed",
}

//! How the program names the ways out that its answers point at.

use stillbase::study::advice::Remedy;

/// The option or the command that is a way out.
pub fn option(remedy: Remedy) -> &'static str {
    match remedy {
        Remedy::Gaps => "--gaps",
        Remedy::Smoothing => "--smooth",
        Remedy::CutOff => "--smooth HZ",
        Remedy::PoseConstant => "--b",
        Remedy::Workspace => "`stillbase workspace --b`",
        Remedy::Design => "`stillbase design`",
        Remedy::Check => "`stillbase check`",
    }
}

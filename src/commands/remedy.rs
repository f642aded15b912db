//! Names of remedies on the command line.

use stillbase_study::advice::Remedy;

/// Returns the option or the command of a remedy.
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

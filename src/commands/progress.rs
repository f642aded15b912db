//! The progress bar on standard error, if that is a terminal.

use indicatif::{ProgressBar, ProgressStyle};

use super::exit::is_quiet;

/// Returns a bar of a length.
pub fn bar(length: u64) -> ProgressBar {
    if is_quiet() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(length);
    if let Ok(style) = ProgressStyle::with_template("{msg:12} {wide_bar} {percent:>3} %  {eta:>4}") {
        bar.set_style(style);
    }
    bar
}

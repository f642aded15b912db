//! [`ResumePoint`]: the state of the display that no edit contains: the instant, and the user's plots. A journal
//! contains this state in comments before the session, so that a crash does not lose it.

use serde::{Deserialize, Serialize};

use stillbase_files::heading;
use stillbase_picture::charts::choice::PlotChoice;

/// Instant and plots on display.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ResumePoint {
    /// The instant on display, s.
    pub time: f64,
    /// The choice of plots.
    pub plots: PlotChoice,
}

impl ResumePoint {
    /// Returns the text of a session, with this state in comments before it.
    pub fn before(&self, session: &str) -> String {
        heading::under(self, session)
    }

    /// Reads the state from the comments before a session; `None` if they contain no valid state.
    pub fn of(text: &str) -> Option<Self> {
        heading::of(text).filter(|left: &Self| left.time.is_finite() && left.time >= 0.0)
    }
}

//! [`LeftOff`]: what belongs to a session on display and is in none of its edits: the instant, and a person's own plots.
//! A journal keeps it in comments before the session, so that a crash loses neither.

use serde::{Deserialize, Serialize};

use crate::files::heading;
use crate::picture::charts::choice::Choice;

/// Where a person left off.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LeftOff {
    /// The instant on display, s.
    pub time: f64,
    /// What plots show.
    pub plots: Choice,
}

impl LeftOff {
    /// A session, as text, with this before it.
    pub fn before(&self, session: &str) -> String {
        heading::under(self, session)
    }

    /// What stands before a session, as far as it is understood.
    pub fn of(text: &str) -> Option<Self> {
        heading::of(text).filter(|left: &Self| left.time.is_finite() && left.time >= 0.0)
    }
}

//! [`Preferences`]: how a person likes the window, remembered from one start to the next.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::picture::scene::palette::Theme;

/// How the window is liked. A file of an older or newer program reads as far as it is understood.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Preferences {
    /// Light or dark.
    pub theme: Theme,
    /// Width and height, points of the screen.
    pub size: [f32; 2],
    /// The hints of the first minute are still to be shown.
    pub hints: bool,
    /// The panel on the left is shown.
    pub side: bool,
    /// How wide it was made, points of the screen.
    pub side_width: Option<f32>,
    /// The panel on the right is shown.
    pub plots: bool,
    /// How wide it was made, points of the screen.
    pub plots_width: Option<f32>,
    /// Files that were opened and saved, newest first.
    pub recent: Vec<PathBuf>,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            theme: Theme::Dark,
            size: [1440.0, 900.0],
            hints: true,
            side: true,
            side_width: None,
            plots: true,
            plots_width: None,
            recent: Vec::new(),
        }
    }
}

impl Preferences {
    /// With sizes that a window can have, whatever a file said.
    #[must_use]
    pub fn sound(mut self) -> Self {
        let usual = Self::default();
        let within = |x: f32, low: f32, high: f32, usual: f32| if x.is_finite() { x.clamp(low, high) } else { usual };
        self.size = [
            within(self.size[0], 960.0, 16_000.0, usual.size[0]),
            within(self.size[1], 600.0, 16_000.0, usual.size[1]),
        ];
        self.side_width = self.side_width.filter(|w| w.is_finite()).map(|w| w.clamp(220.0, 480.0));
        self.plots_width = self.plots_width.filter(|w| w.is_finite()).map(|w| w.clamp(260.0, 1200.0));
        self.recent.truncate(32);
        self
    }
}

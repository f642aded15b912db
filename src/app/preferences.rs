//! [`Preferences`]: the user's preferences for the window, stored between program runs.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::layout::{Layout, Panel, Panels, WindowArrangement};
use stillbase_picture::notation::Notation;
use stillbase_picture::scene::palette::Theme;

/// Preferences for the window. In a file, unknown keys are ignored, and missing keys have their defaults.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Preferences {
    /// Colour theme.
    pub theme: Theme,
    /// Units and names.
    pub notation: Notation,
    /// Width and height of the window, logical points.
    pub size: [f32; 2],
    /// Whether to show the hints at the next start.
    pub hints: bool,
    /// The layout.
    pub layout: Layout,
    /// Whether settings are on the right and plots on the left.
    pub swapped: bool,
    /// Whether the design view shows the equations instead of the balance.
    #[serde(rename = "learns")]
    pub shows_equations: bool,
    /// Whether *Explore* shows the panel of settings.
    pub side: bool,
    /// Width of the panel of settings in *Explore*, if set by the user, logical points.
    pub side_width: Option<f32>,
    /// Whether *Explore* shows the panel of plots.
    pub plots: bool,
    /// Width of the panel of plots in *Explore*, if set by the user, logical points.
    pub plots_width: Option<f32>,
    /// Whether *Compare* shows the panel of settings.
    pub compare_side: bool,
    /// Width of the panel of settings in *Compare*, if set by the user, logical points.
    pub compare_side_width: Option<f32>,
    /// Whether *Compare* shows the panel of plots.
    pub compare_plots: bool,
    /// Width of the panel of plots in *Compare*, if set by the user, logical points.
    pub compare_plots_width: Option<f32>,
    /// Recently opened and saved files, newest first.
    pub recent: Vec<PathBuf>,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            theme: Theme::Dark,
            notation: Notation::default(),
            size: [1440.0, 900.0],
            hints: true,
            layout: Layout::Explore,
            swapped: false,
            shows_equations: false,
            side: true,
            side_width: None,
            plots: true,
            plots_width: None,
            compare_side: false,
            compare_side_width: None,
            compare_plots: true,
            compare_plots_width: None,
            recent: Vec::new(),
        }
    }
}

impl Preferences {
    /// Returns the preferences of a window with this arrangement and size, points of the screen.
    pub(super) fn of(arrangement: &WindowArrangement, size: [f32; 2], hints: bool, recent: &[PathBuf]) -> Self {
        let WindowArrangement { theme, notation, layout, swapped, shows_equations, panels: [explore, compare, _] } =
            arrangement;
        Self {
            theme: *theme,
            notation: *notation,
            size,
            hints,
            layout: *layout,
            swapped: *swapped,
            shows_equations: *shows_equations,
            side: explore.side.shown,
            side_width: explore.side.width,
            plots: explore.plots.shown,
            plots_width: explore.plots.width,
            compare_side: compare.side.shown,
            compare_side_width: compare.side.width,
            compare_plots: compare.plots.shown,
            compare_plots_width: compare.plots.width,
            recent: recent.to_vec(),
        }
    }

    /// Returns the arrangement of the window, with the layout *Explore*; the caller then chooses the stored layout.
    pub(super) fn arrangement(&self) -> WindowArrangement {
        let panel = |shown, width| Panel { shown, width };
        let explore = Panels { side: panel(self.side, self.side_width), plots: panel(self.plots, self.plots_width) };
        let compare = Panels {
            side: panel(self.compare_side, self.compare_side_width),
            plots: panel(self.compare_plots, self.compare_plots_width),
        };
        let panels = [explore, compare, Panels::default_of(Layout::Present)];
        WindowArrangement {
            notation: self.notation,
            swapped: self.swapped,
            shows_equations: self.shows_equations,
            panels,
            ..WindowArrangement::with_theme(self.theme)
        }
    }

    /// Limits all sizes to those that a window can have, and drops recent files with relative paths or after the 32nd.
    #[must_use]
    pub fn sound(mut self) -> Self {
        let usual = Self::default();
        let within = |x: f32, low: f32, high: f32, usual: f32| if x.is_finite() { x.clamp(low, high) } else { usual };
        self.size = [
            within(self.size[0], 960.0, 16_000.0, usual.size[0]),
            within(self.size[1], 600.0, 16_000.0, usual.size[1]),
        ];
        let wide = |made: Option<f32>, low: f32, high: f32| made.filter(|w| w.is_finite()).map(|w| w.clamp(low, high));
        self.side_width = wide(self.side_width, 220.0, 480.0);
        self.plots_width = wide(self.plots_width, 260.0, 1200.0);
        self.compare_side_width = wide(self.compare_side_width, 220.0, 480.0);
        self.compare_plots_width = wide(self.compare_plots_width, 260.0, 2400.0);
        // Relative paths refer to an unknown folder.
        self.recent.retain(|file| file.is_absolute());
        self.recent.truncate(32);
        self
    }
}

//! [`Preferences`]: how a person likes the window, remembered from one start to the next.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::layout::{Arrangement, Layout, Panel, Panels};
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
    /// What the window is for.
    pub layout: Layout,
    /// Settings stand on the right and plots on the left.
    pub swapped: bool,
    /// The equations stand beside the machine that is designed.
    pub learns: bool,
    /// The panel of settings is shown, to explore.
    pub side: bool,
    /// How wide it was made, points of the screen.
    pub side_width: Option<f32>,
    /// The panel of plots is shown, to explore.
    pub plots: bool,
    /// How wide it was made, points of the screen.
    pub plots_width: Option<f32>,
    /// The panel of settings is shown, to compare.
    pub compare_side: bool,
    /// How wide it was made.
    pub compare_side_width: Option<f32>,
    /// The panel of plots is shown, to compare.
    pub compare_plots: bool,
    /// How wide it was made.
    pub compare_plots_width: Option<f32>,
    /// Files that were opened and saved, newest first.
    pub recent: Vec<PathBuf>,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            theme: Theme::Dark,
            size: [1440.0, 900.0],
            hints: true,
            layout: Layout::Explore,
            swapped: false,
            learns: false,
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
    /// Of a window so arranged and so large, points of the screen.
    pub(super) fn of(arrangement: &Arrangement, size: [f32; 2], hints: bool, recent: &[PathBuf]) -> Self {
        let Arrangement { theme, layout, swapped, learns, panels: [explore, compare, _] } = arrangement;
        Self {
            theme: *theme,
            size,
            hints,
            layout: *layout,
            swapped: *swapped,
            learns: *learns,
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

    /// How the window is arranged; to explore, until it is laid out for what it was for last.
    pub(super) fn arrangement(&self) -> Arrangement {
        let panel = |shown, width| Panel { shown, width };
        let explore = Panels { side: panel(self.side, self.side_width), plots: panel(self.plots, self.plots_width) };
        let compare = Panels {
            side: panel(self.compare_side, self.compare_side_width),
            plots: panel(self.compare_plots, self.compare_plots_width),
        };
        let panels = [explore, compare, Panels::usual(Layout::Present)];
        Arrangement { swapped: self.swapped, learns: self.learns, panels, ..Arrangement::usual(self.theme) }
    }

    /// With sizes that a window can have, whatever a file said.
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
        // What is relative was said in a folder that nobody knows any more.
        self.recent.retain(|file| file.is_absolute());
        self.recent.truncate(32);
        self
    }
}

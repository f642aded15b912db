//! [`Layout`]: what people do with the window, and which panels it has for that.

use serde::{Deserialize, Serialize};

/// What the window is for just now.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Layout {
    /// Settings, scene and plots.
    #[default]
    Explore,
    /// Scene, wide plots, and the table of runs side by side.
    Compare,
    /// The scene alone, with what counts in large type.
    Present,
}

impl Layout {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Explore, Self::Compare, Self::Present];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Explore => "Explore",
            Self::Compare => "Compare",
            Self::Present => "Present",
        }
    }

    /// What it has.
    pub fn words(self) -> &'static str {
        match self {
            Self::Explore => "settings, scene and plots",
            Self::Compare => "scene, wide plots and the runs side by side",
            Self::Present => "the scene alone, what counts in large type",
        }
    }
}

/// A panel beside the scene.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Panel {
    /// It is on display.
    pub shown: bool,
    /// How wide it was made, points of the screen; none as long as it was left alone.
    pub width: Option<f32>,
}

impl Panel {
    /// As wide as it makes itself.
    pub const fn usual(shown: bool) -> Self {
        Self { shown, width: None }
    }

    /// How wide it was made, given how wide it is and how wide it is made by itself.
    pub(super) fn made(&self, now: f32, usual: f32) -> Option<f32> {
        if self.width.is_some() || (now - usual).abs() > 1.0 { Some(now) } else { None }
    }
}

/// The panels of a layout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Panels {
    /// Settings.
    pub side: Panel,
    /// Plots.
    pub plots: Panel,
    /// The table of runs side by side.
    pub compare: bool,
}

impl Panels {
    /// As a layout has them until a hand changes that.
    pub const fn usual(layout: Layout) -> Self {
        let (side, plots) = (matches!(layout, Layout::Explore), !matches!(layout, Layout::Present));
        let compare = matches!(layout, Layout::Compare);
        Self { side: Panel::usual(side), plots: Panel::usual(plots), compare }
    }
}

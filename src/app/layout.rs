//! [`Layout`]: what people do with the window, and which panels it has for that.

use serde::{Deserialize, Serialize};

use crate::picture::scene::palette::Theme;

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
}

impl Panels {
    /// As a layout has them until a hand changes that.
    pub const fn usual(layout: Layout) -> Self {
        let (side, plots) = (matches!(layout, Layout::Explore), !matches!(layout, Layout::Present));
        Self { side: Panel::usual(side), plots: Panel::usual(plots) }
    }
}

/// What is on display below the scene: the window has room for one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Below {
    /// The table of runs side by side.
    Runs,
    /// The study of tolerances.
    Tolerances,
    /// What a table says that was opened.
    Table,
}

/// How the window is arranged: a person's liking, which outlives the session.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrangement {
    /// Light or dark.
    pub theme: Theme,
    /// What the window is for just now.
    pub layout: Layout,
    /// Settings stand on the right and plots on the left.
    pub swapped: bool,
    /// The equations stand beside the machine that is designed, and not its balance.
    pub learns: bool,
    /// The panels of each layout, in the order of [`Layout::ALL`].
    pub panels: [Panels; Layout::ALL.len()],
}

impl Arrangement {
    /// As it is until a hand changes that.
    pub fn usual(theme: Theme) -> Self {
        let panels = Layout::ALL.map(Panels::usual);
        Self { theme, layout: Layout::Explore, swapped: false, learns: false, panels }
    }

    /// The panels on display.
    pub fn now(&self) -> &Panels {
        &self.panels[self.layout as usize]
    }

    /// The panels on display, to change.
    pub fn now_mut(&mut self) -> &mut Panels {
        &mut self.panels[self.layout as usize]
    }

    /// Lays the window out; again, and to present: as that layout is at first.
    pub(super) fn lay_out(&mut self, layout: Layout) {
        if layout == self.layout || layout == Layout::Present {
            self.panels[layout as usize] = Panels::usual(layout);
        }
        self.layout = layout;
    }
}

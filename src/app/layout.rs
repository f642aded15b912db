//! [`Layout`]: the purposes of the window, and the panels for each.

use serde::{Deserialize, Serialize};

use stillbase_picture::notation::Notation;
use stillbase_picture::scene::palette::Theme;

/// A layout of the window that serves one purpose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Layout {
    /// Settings, scene and plots.
    #[default]
    Explore,
    /// Scene, wide plots, and the table of runs side by side.
    Compare,
    /// The scene alone, with the main results in large type.
    Present,
}

impl Layout {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Explore, Self::Compare, Self::Present];

    /// Returns its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Explore => "Explore",
            Self::Compare => "Compare",
            Self::Present => "Present",
        }
    }

    /// Returns its content in words.
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
    /// Whether it is on display.
    pub shown: bool,
    /// Width set by the user, points of the screen; `None` while the user has not changed it.
    pub width: Option<f32>,
}

impl Panel {
    /// A panel of its default width.
    pub const fn with_default_width(shown: bool) -> Self {
        Self { shown, width: None }
    }

    /// Returns the width to store, points: the present width `now`, if the user set one earlier or if it differs from
    /// the default `default`.
    pub(super) fn stored_width(&self, now: f32, default: f32) -> Option<f32> {
        if self.width.is_some() || (now - default).abs() > 1.0 { Some(now) } else { None }
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
    /// The default panels of a layout.
    pub const fn default_of(layout: Layout) -> Self {
        let (side, plots) = (matches!(layout, Layout::Explore), !matches!(layout, Layout::Present));
        Self { side: Panel::with_default_width(side), plots: Panel::with_default_width(plots) }
    }
}

/// Content of the panel below the scene; there is room for only one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BottomPanel {
    /// The table of runs side by side.
    Runs,
    /// The study of tolerances.
    Tolerances,
    /// The panel of the open table.
    Table,
}

/// Arrangement of the window: a preference of the user, which outlives the session.
#[derive(Clone, Debug, PartialEq)]
pub struct WindowArrangement {
    /// Light or dark.
    pub theme: Theme,
    /// Units and names.
    pub notation: Notation,
    /// The present layout.
    pub layout: Layout,
    /// Whether settings are on the right and plots on the left.
    pub swapped: bool,
    /// Whether the design view shows the equations in place of the balance.
    pub shows_equations: bool,
    /// The panels of each layout, in the order of [`Layout::ALL`].
    pub panels: [Panels; Layout::ALL.len()],
}

impl WindowArrangement {
    /// Returns the default arrangement.
    pub fn with_theme(theme: Theme) -> Self {
        let panels = Layout::ALL.map(Panels::default_of);
        Self {
            theme,
            notation: Notation::default(),
            layout: Layout::Explore,
            swapped: false,
            shows_equations: false,
            panels,
        }
    }

    /// The panels on display.
    pub fn now(&self) -> &Panels {
        &self.panels[self.layout as usize]
    }

    /// The panels on display, to change.
    pub fn now_mut(&mut self) -> &mut Panels {
        &mut self.panels[self.layout as usize]
    }

    /// Chooses a layout. Choosing `Present`, or the current layout again, restores its default panels.
    pub(super) fn lay_out(&mut self, layout: Layout) {
        if layout == self.layout || layout == Layout::Present {
            self.panels[layout as usize] = Panels::default_of(layout);
        }
        self.layout = layout;
    }
}

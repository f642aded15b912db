//! Colours by meaning, for scenes, plots, recordings and figures.

use super::Rgba;

/// Light or dark theme.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Theme {
    /// Light text on a dark background.
    #[default]
    Dark,
    /// Dark text on white.
    Light,
}

/// Colour by meaning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Palette {
    /// Background of scenes.
    pub background: Rgba,
    /// Background of panels.
    pub panel: Rgba,
    /// Hairlines and the grid.
    pub line: Rgba,
    /// Colour of text.
    pub ink: Rgba,
    /// Secondary text.
    pub dim: Rgba,
    /// Drives 1 to 8.
    pub drives: [Rgba; 8],
    /// b, its workspace, the time cursor.
    pub amber: Rgba,
    /// Reactions that are zero.
    pub zero: Rgba,
    /// Reactions that are not zero.
    pub reaction: Rgba,
}

/// Returns the colours of a theme.
pub const fn palette(theme: Theme) -> Palette {
    match theme {
        Theme::Dark => Palette {
            background: hex(0x111317),
            panel: hex(0x1b1e25),
            line: hex(0x2a2e38),
            ink: hex(0xe6e8ec),
            dim: hex(0x8b93a1),
            drives: [
                hex(0x5cb3ea),
                hex(0xf08a5d),
                hex(0x4cc9a0),
                hex(0xa873f5),
                hex(0xbde85a),
                hex(0x7b8fa3),
                hex(0xf5e3bf),
                hex(0xa3faf5),
            ],
            amber: hex(0xe8b84a),
            zero: hex(0x4cc9a0),
            reaction: hex(0xff5d5d),
        },
        Theme::Light => Palette {
            background: hex(0xffffff),
            panel: hex(0xfbfbfc),
            line: hex(0xdfe2e7),
            ink: hex(0x1d2129),
            dim: hex(0x6b7280),
            drives: [
                hex(0x0072b2),
                hex(0xc2410c),
                hex(0x047857),
                hex(0x8b2bd9),
                hex(0x5e2a0c),
                hex(0x4a5b6e),
                hex(0x4a0f5c),
                hex(0xa0578f),
            ],
            amber: hex(0xa86d00),
            zero: hex(0x047857),
            reaction: hex(0xc81e1e),
        },
    }
}

impl Palette {
    /// Returns the colour of drive `k`, counted from 0.
    pub fn drive(&self, k: usize) -> Rgba {
        self.drives[k % self.drives.len()]
    }

    /// Returns the colour of an overlaid run in plots of one curve. Colours of drives 1 to 3 are left out, because
    /// the third also marks reactions that are zero.
    pub fn run(&self, i: usize) -> Rgba {
        let [_, _, _, others @ ..] = &self.drives;
        others[i % others.len()]
    }
}

/// Returns a colour with its alpha multiplied by `alpha`, 0..1.
pub fn faded([r, g, b, a]: Rgba, alpha: f32) -> Rgba {
    [r, g, b, a * alpha]
}

/// Interpolates between `a` and `b`: `share` 0 gives `a`, 1 gives `b`.
pub fn mix(a: Rgba, b: Rgba, share: f32) -> Rgba {
    [0, 1, 2, 3].map(|i| a[i] + (b[i] - a[i]) * share)
}

const fn hex(rgb: u32) -> Rgba {
    [((rgb >> 16) & 0xff) as f32 / 255.0, ((rgb >> 8) & 0xff) as f32 / 255.0, (rgb & 0xff) as f32 / 255.0, 1.0]
}

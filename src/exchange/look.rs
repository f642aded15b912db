//! Appearance of models for other programs.

/// Half the drawn width of a bar, m.
pub const DRAWN_BAR_RADIUS: f64 = 0.012;
/// Colours of the drives as RGBA, from the palette of Okabe and Ito.
pub const DRIVE_COLOURS: [&str; 8] = [
    "0.34 0.71 0.91 1",
    "0.84 0.37 0 1",
    "0 0.62 0.45 1",
    "0.90 0.62 0 1",
    "0.80 0.47 0.65 1",
    "0.94 0.89 0.26 1",
    "0 0.45 0.70 1",
    "0.6 0.6 0.6 1",
];
/// Colour of a base that floats, as RGBA.
pub const BASE_COLOUR: &str = "0.55 0.58 0.62 1";

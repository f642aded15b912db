//! What to record.

/// Offscreen pictures to take on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pictures {
    /// Pictures a second of simulated time.
    pub fps: f64,
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Arrows show what the pins carry.
    pub pin_forces: bool,
}

/// What to record, and over what.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// Pictures, if any. Where there is nothing to draw with, the recording goes without and says so in its
    /// [`notes`](super::Recording::notes).
    pub pictures: Option<Pictures>,
    /// Replace a file that is there.
    pub force: bool,
}

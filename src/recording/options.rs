//! Options of a recording.

/// Options of offscreen pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pictures {
    /// Pictures per second of simulated time.
    pub fps: f64,
    /// Width, pixels.
    pub width: u32,
    /// Height, pixels.
    pub height: u32,
    /// Whether arrows show the pin forces.
    pub pin_forces: bool,
}

/// Options of a recording.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// Pictures, if requested. Without a usable graphics adapter none are made, and the
    /// [`notes`](super::Recording::notes) say so.
    pub pictures: Option<Pictures>,
    /// Whether signals have a row at every step. Otherwise long runs have rows at a fixed rate: at least 100 a second,
    /// and about 500 in all.
    pub every_step: bool,
    /// Whether an existing file is replaced.
    pub force: bool,
}

//! Panels, plots and the viewport: the same pixels in a window, in a test and in a figure.
//!
//! Everything here reads a [`Session`] and gives back [`Command`]s; the [`Desk`] carries them out. Nothing is computed
//! and nothing is changed in between.

mod command;
mod compare;
mod desk;
mod keys;
mod look;
mod order;
mod path;
mod plots;
mod side;
mod status;
mod study;
mod switch;
mod theme;
mod top;
mod viewport;
mod widgets;
#[cfg(feature = "window")]
pub mod window;

pub use command::{Command, FileDialog, OnBoard, Purpose};
pub use desk::Desk;
use look::set_b;
pub use look::{Look, Wish};

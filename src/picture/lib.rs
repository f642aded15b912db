//! Scenes and charts as plain data, and the code that draws them.
//!
//! Others reach this crate as `stillbase::picture`; `stillbase` alone follows semantic versioning.

#[cfg(feature = "ui")]
#[doc(hidden)]
pub mod canvas;
#[doc(hidden)]
pub mod charts;
#[doc(hidden)]
pub mod columns;
#[cfg(feature = "render")]
pub mod film;
#[cfg(feature = "ui")]
#[doc(hidden)]
pub mod gui;
#[doc(hidden)]
pub mod notation;
#[doc(hidden)]
pub mod numbers;
#[cfg(feature = "ui")]
#[doc(hidden)]
pub mod paint;
#[cfg(feature = "ui")]
#[doc(hidden)]
pub mod print;
#[cfg(feature = "render")]
pub mod render;
#[cfg(feature = "ui")]
#[doc(hidden)]
pub mod report;
pub mod scene;
#[cfg(feature = "render")]
#[doc(hidden)]
pub mod webp;

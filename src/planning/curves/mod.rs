//! Curves of the end effector and paths of the drives, drawn or given by samples.

pub mod curve;
pub mod given;
#[doc(hidden)]
pub mod low_pass;
pub mod path;
mod point;
#[doc(hidden)]
pub mod spline;
#[doc(hidden)]
pub mod table;

pub use curve::{Curve, CurveError, CurvePoint};
pub use given::{Coordinates, Samples};
pub use path::{Path, PathError};
pub use point::PathPoint;
pub use table::PathTable;

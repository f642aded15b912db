//! When: time laws, limits of the drives, the fastest motion along a path.

pub mod fastest;
mod jerk;
mod keep;
pub mod law;
pub mod limits;
pub mod profile;
mod smooth;
mod topp;
pub mod usage;

pub use fastest::{Fastest, TimeError, fastest};
pub use law::{Progress, TimeLaw};
pub use limits::Limits;
pub use profile::Profile;
pub use usage::Usage;

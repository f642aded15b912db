//! Following curves of the end effector on a plane b = const, continuously and on one sheet, or the reason why not.
//!
//! Source: (15), (16). On a sheet, where det ∂(x, y)/∂(a_1, a_2) keeps its sign, each point has one pose that
//! continues the last one. A curve is reactionless if and only if it can be followed in this way.

mod follow;
mod remedy;
mod rule;
mod track;
mod walk;

pub use follow::follow;
pub use rule::{Blocked, Rule, SheetEnd, TraceEnd};
pub use walk::{common_b, is_feasible, part, walk};

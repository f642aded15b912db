//! Keep balanced: the least change of what may be changed with which (7) and (8) hold.
//!
//! What is least is Σ (p Δ)² over all numbers that may change, Δ in kg or m from where the change is measured,
//! [`from`](Adjusted::from). For all centres of mass along the links from 0, it is what [`design`](super::design()) has
//! least. (7) and (8) are linear in m and s = m l_c, and so is a bound on l_c: lo m ≤ s ≤ hi m. Where no body has both
//! its mass and a place to change, that is a quadratic program with one optimum: what balance leaves free is a plane,
//! bounds cut it, and the answer is the point of what is left that is nearest to where nothing changes. Where a body has
//! both, [`search`] looks from several starts, and the answer is not certified.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | m, l_c | mass of a body; its place along or across its link | kg, m |
//! | m₀, l₀ | where their changes are measured from | kg, m |
//! | p | penalty on a change | 1/kg, 1/m |
//! | y | p (m − m₀) of a mass, p (m/m₀)(l_c − l₀) of a place: (7) and (8) are linear in them | |
//! | z | y = y₀ + N z fulfils (7) and (8) for every z; N has orthonormal columns | |

mod asked;
mod problem;
mod refusal;
mod search;

pub use asked::{Adjusted, Hold, Keep};
pub use problem::{Kept, keep, keep_with, unreachable_by_changes};
pub use refusal::{Limit, NotKept, Relief, Side};

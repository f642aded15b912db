//! Keep balanced: the least change of what may be changed with which (7) and (8) hold.
//!
//! Where masses may change the unknowns are m and s = m l_c, in which the conditions are linear and a bound on l_c is
//! lo m ≤ s ≤ hi m. What is least is Σ (p x)², where x is, for each parameter that may change,
//!
//! * of a mass: m − m₀, kg;
//! * of a place: (m/m₀) (l_c − l₀), m: how far it moves, times how much heavier the body becomes; where the mass stays,
//!   how far it moves.
//!
//! m₀ and l₀ are where the change is measured from: each parameter's [`from`](Adjusted::from). For all centres of mass
//! along the links from 0, it is what [`design`](super::design()) has least. So it is a quadratic program with one
//! optimum. What balance leaves free of all x is a plane; bounds cut it, and the answer is the point of what is left
//! that is nearest to where nothing changes.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | m, l_c | mass of a body; its place along or across its link | kg, m |
//! | p | penalty on a change | 1/kg, 1/m |
//! | y | p x, of each parameter | |
//! | z | y = y₀ + N z fulfils (7) and (8) for every z; N has orthonormal columns | |

mod asked;
mod problem;
mod refusal;

pub use asked::{Adjusted, Hold, Keep};
pub use problem::{Kept, keep, keep_with, unreachable_by_changes};
pub use refusal::{Limit, NotKept, Relief, Side};

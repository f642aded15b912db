//! [`doubt`]: whether a measurement is what it says it is.
//!
//! Least squares believe every column: a moment of the wrong sign gives momenta of the wrong sign, and exchanged columns
//! give another machine. So each plausible [`Fault`] is a hypothesis, too: the measurement is fitted as it would be without
//! it, and the data decide.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | σ | what the fit leaves of force and of moment, root mean square, as a share of what was measured | |
//! | N | independent rows: the fewer of both fits, less those that the numbers use up | |
//! | d_D², d² | squared distance of the momenta, and of all numbers, from the file in standard deviations of [`Tolerances`] | |
//! | c² | that of first moments and couplings, the larger of both fits, and one for each of the p numbers | |
//! | Λ | likelihood ratio of a hypothesis to the measurement as given | |
//!
//! # How
//! ln Λ = Σ N ln(σ₀/σ) + p/2 ln((d_D0² + c²)/(d_D² + c²)) ± ln 10⁶ where one keeps the joint limits and the other leaves
//! them. The first term is the F-test of the residuals. The second compares the momenta with the file on the scale of
//! its other errors, which is unknown: a machine that is far off in everything is no evidence of a fault. The signs of
//! first moments are no part of it, because a balanced machine can be off either way. A machine that is not balanced
//! cannot: with d² of the momenta and of those first moments and couplings that its file has, p/2 ln(d₀²/(`FAR` d²)) is
//! the second term if that is more.
//! The measurement as given is refused where Λ is above 10⁴, or where no machine can have what was found
//! ([`impossible`]).
//!
//! Some faults leave the same residuals: a machine that is balanced does not tell whether fx or fy is reversed. Then
//! faults are ordered by all of d², and the message names each that is not clearly less likely than the first.
//!
//! # Source
//! Wilks (1938) for ratios; Kass and Raftery (1995) for what they mean.

mod doubting;
mod fault;
mod odds;
mod possible;
mod said;
mod tolerances;

pub(super) use doubting::Doubting;
pub use doubting::doubt;
pub use said::{Cause, Doubt, Said};

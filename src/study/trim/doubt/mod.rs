//! [`doubt`]: tests a measurement for wrong signs, exchanged columns and wrong units.
//!
//! Least squares accepts every column as given. A moment of the wrong sign gives momenta of the wrong sign, and
//! exchanged columns give a different machine. Each plausible `Fault` is therefore a hypothesis. The corrected
//! measurement is fitted too, and the likelihood ratio decides.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | σ | root mean square residual of force and of moment, as a fraction of the measured value | |
//! | N | half the degrees of freedom: the smaller effective number of rows of the two fits less fitted parameters | |
//! | d_D², d² | squared distance from the file, of the momenta and of all unknowns, in units of `Tolerances` | |
//! | c² | the larger squared distance of first moments and couplings in both fits, plus the number p of unknowns | |
//! | Λ | likelihood ratio of a hypothesis to the measurement as given, whose values have the index 0 | |
//!
//! ln Λ = Σ N ln(σ₀/σ) + p/2 ln((d_D0² + c²)/(d_D² + c²)) ± ln 10⁶ if one hypothesis keeps the joint limits and the
//! other violates them. The first term is the F-test of the residuals. The second compares the momenta with the file,
//! relative to its other errors c². A machine that deviates in everything is no evidence of a fault. Signs of first
//! moments are no evidence if the file's machine is balanced. Otherwise another d² covers the momenta, and the first
//! moments and couplings that are not zero in the file. Then the second term is at least p/2 ln(d₀²/(`MIN_IMPROVEMENT`
//! d²)). The measurement as given is rejected if Λ exceeds 10⁴, or if no machine can have the values found.
//!
//! Some faults give the same residuals: a balanced machine does not show whether fx or fy is reversed. Then faults are
//! ordered by d² of all unknowns, and the message names each that is not clearly less likely than the first.
//!
//! # Source
//! Wilks (1938) for likelihood ratios; Kass and Raftery (1995) for their interpretation.

mod doubting;
mod fault;
mod odds;
mod plate;
mod possible;
mod rejection;
mod tolerances;
mod zeros;

pub use doubting::doubt;
pub(super) use doubting::{DoubtSearch, FaultWords, Suspected};
pub(super) use fault::{Angles, ColumnNames, NamedAngles, angle_faults, list};
pub(super) use odds::{ChannelFit, FitTrial};
pub(super) use plate::{PlateMeasurement, limit_violation};
pub use rejection::{Cause, Doubt, MeasuredValue, Residual};
pub use zeros::OtherZero;
pub(super) use zeros::{nearest_zeros, other_zero, own_zeros, zero_faults, zeros_in_words};

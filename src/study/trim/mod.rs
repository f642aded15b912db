//! Trim balancing: identifies the residuals of (7) and (8) of a built machine from measured base forces, and corrects
//! them.
//!
//! For known drive angles, force and moment on the base are linear in first moments g_k, couplings C_kl and momenta
//! D_k. A few measured motions and least squares therefore identify them with their uncertainty. They also yield the
//! least change of counterweights that corrects the balance, and the motion that would add most information.
//!
//! In orbit there is no force to measure; [`OrbitTrimQuery`] takes the rates of the base instead.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | f, n | measured force and moment on the base, as in [`dynamics`](stillbase_mechanics::dynamics) | N, N m |
//! | p | Σ i g_k q̇_k e_k, linear momentum: f = −ṗ + a constant | kg m/s |
//! | h | Σ D_k q̇_k + Σ_{k<l} Re(C_kl e^{i(q_l − q_k)}) (q̇_k + q̇_l): n = −ḣ + Σ g_k e_k × gravity + a constant | kg m²/s |
//! | x | g_k and C_kl, along and across, then D_k: the unknowns | kg m, kg m² |
//! | X | rows of f_x, f_y, n per unit of x, without each motion's straight line over time (sensor offset, drift) | |
//! | φ, w | window (1 − u²)⁴ for averaging rows if accelerations are not given, and its half width | , s |
//! | σ | standard deviation of the residuals of force or moment | N, N m |
//!
//! # Method
//! If rates and accelerations are given, each sample is a row. Otherwise windows φ avoid a second differentiation of
//! the data: ∫ φ f = ∫ φ̇ p + const and ∫ φ n = ∫ φ̇ h + ∫ φ (Σ g e × gravity) + const. Both sides are averaged with
//! the same window, so a wide window loses information but causes no bias. q̇ is measured, or from five neighbouring
//! samples (error of fourth order in their spacing). Noise in the angles biases the least-squares estimate towards 0;
//! the bias is removed to first
//! order.
//!
//! Intervals have a confidence of 95 %. The covariance is the sandwich (XᵀX)⁻¹ S (XᵀX)⁻¹ with Bartlett's window over
//! the autocorrelation of the scores. The critical value grows with the fraction of the data that this window covers.
//!
//! # Source
//! Newey and West (1987) for S; Andrews (1991) for the width of its window; Kiefer and Vogelsang (2005) for critical
//! values; modulating functions after Shinbrot (1957).

mod adopted_parameters;
mod adopting_edit;
mod correction_benefit;
mod differences;
mod doubt;
mod error;
mod fit;
mod long_run;
mod machine_correction;
mod next_excitation;
mod orbit;
mod recording;
mod report;
mod rows;
mod trim_method;
mod trimming;
mod unknowns;
mod window;

pub use adopted_parameters::{AdoptedParameters, adopt_parameters};
pub use adopting_edit::adopting_edit;
pub use correction_benefit::{CorrectionBenefit, correction_benefit};
pub use doubt::{Cause, Doubt, MeasuredValue, OtherZero, Residual, doubt};
pub use error::TrimError;
pub use fit::{Fit, IdentifiedNumbers, fit};
pub use machine_correction::{
    MachineCorrection, NoCorrection, ParameterChange, correct_machine, corrected_as_built, identified_machine,
};
pub use next_excitation::{Excitation, NextMeasurement, next_excitation};
pub use orbit::{
    BASE_RATE, KnownValue, OrbitBase, OrbitMotion, OrbitOutcome, OrbitReport, OrbitTrimQuery, OrbitTrimRequest,
    orbit_trim,
};
pub use recording::{MeasuredMotion, MeasurementSet};
pub use report::{ExcitationReport, MeasuredUnknown, Number, Suggestion, TrimImprovement, TrimReport};
pub use rows::{Regressor, RegressorSource};
pub use trim_method::{TrimMethod, free_weights};
pub use trimming::{NoTrim, TrimOutcome, TrimQuery, TrimRequest, TrimResult};
pub use unknowns::{ComplexPart, Unknown, Unknowns};

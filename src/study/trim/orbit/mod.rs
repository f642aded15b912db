//! [`OrbitTrimQuery`]: identifies first moments and couplings of a machine in orbit, from the rates of its base.
//!
//! Nothing acts on a spacecraft whose thrusters are off, so its angular momentum L about the common centre of mass stays
//! constant. Base and drives turn about this point, which moves with the drives; so the momentum has the form of a fixed
//! base, with the base as one more drive 0 and other coefficients:
//!
//! L = D₀ ω + Σ D′_k q̇_k + Σ Re(C₀_k e^{i φ_k}) (ω + q̇_k) + Σ_{k<l} Re(C′_kl e^{i(φ_l − φ_k)}) (q̇_k + q̇_l) + J Ω
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | ω | rate of the base | rad/s |
//! | φ_k, r_k | angle and rate of drive k relative to the base; q̇_k = ω + r_k | rad, rad/s |
//! | M, m | mass of all, and of the base | kg |
//! | ρ | centre of mass of the base, seen from the base pin | m |
//! | D₀ | I_b + m (1 − m/M) ρρ̄, and what rotors add: known | kg m² |
//! | C₀_k, C′_kl | −m ρ̄ g_k/M, and C_kl − ḡ_k g_l/M | kg m² |
//! | D′_k | D_k − g_k ḡ_k/M | kg m² |
//! | J, Ω | inertia of a reaction wheel, and its absolute rate | kg m², rad/s |
//!
//! # What can be found
//! Momenta are equal up to a factor: without a wheel only ratios to D₀ can be found. Mass, inertia and centre of mass of
//! the base are therefore taken as known, and M from the machine; [`KnownValue`] tells what that is worth. First moments appear through C₀_k, so they are found
//! only if the centre of mass of the base lies off the base pin; at the pin, g_k is not told apart from C_kl and D_k.
//!
//! # Method
//! ω is predicted from angles and rates of the drives, and L is fitted for each motion. Least squares of measured less
//! predicted ω have no bias from its noise, which a fit of L itself would have. Gauss–Newton steps begin at the machine's
//! file. Intervals are those of [`fit`](super::fit()). Before,
//! [`doubt`](super::doubt()) asks whether a usual mistake of columns explains the rates far better.
//!
//! r_k is the absolute rate less ω as measured. Encoders measure r_k, and absolute rates are their sum with ω: the noise of
//! ω cancels in r_k. Absolute rates from elsewhere leave it there, where it bends the fit: the intervals do not hold.

mod consistency;
mod craft;
mod delay;
mod fault;
mod fit;
mod known;
mod motion;
mod query;
mod report;

pub use known::KnownValue;
pub use motion::{BASE_RATE, OrbitBase, OrbitMotion};
pub use query::{OrbitOutcome, OrbitTrimQuery, OrbitTrimRequest, orbit_trim};
pub use report::OrbitReport;

//! Tolerances: random machines around a nominal one, and what their bases feel.
//!
//! Balance is a matter of constants: g_k = 0, C_kl = 0, λ as designed. A machine that is built has others. This module
//! draws such machines and says how large the base wrench becomes, how many machines keep within limits, and which
//! tolerance is to blame.
//!
//! # Where linearity ends
//! While the drives track their motion perfectly, the wrench is linear in the constants g, C and H: that is what
//! [`Ensemble`] uses, exactly, for large deviations too. It is *not* linear in masses and lengths (m a_k a_l), nor is
//! the norm |f_B| or a peak over time. And tracking is only as good as control: feedback with finite gains and a model
//! that is not the machine, torque limits, unequal gains, friction that is felt, or a base that moves, all change the
//! motion itself. For those, [`simulate()`] runs each machine in full.
//!
//! | what | modules |
//! |---|---|
//! | what varies, by which spread | [`Parameter`]; `Tolerance` and `Spread` of [scenarios](crate::session::scenario) |
//! | random machines, a million a second | [`Ensemble`], [`Sampler`], [`Outcome`] |
//! | means and deviations over time, exact, first-order and sampled | [`Bands`], [`Agreement`] |
//! | which tolerance matters | [`Share`] |
//! | all of it for a run, as a window shows it | [`Study`] |
//! | some machines after another, tracking perfectly or simulated | [`Batch`] |
//! | quantiles, histograms, yield | [`Quantiles`], [`Histogram`], [`Yield`] |
//! | what all machines come to, or a part of them | [`PartReport`]: [`Distributions`], [`Yields`], [`AgainstTracking`] |

mod bands;
mod batch;
mod constants;
mod deviate;
mod ensemble;
mod error;
mod moments;
mod parameter;
mod part;
mod report;
mod shares;
mod simulate;
mod statistics;
mod study;

pub use bands::{Agreement, Bands, ForceBand, Gap, MomentBand, PERCENTILES};
pub use batch::{Batch, Mode};
pub use deviate::{CHUNK, inverse_normal};
pub use ensemble::{Ensemble, Outcome, Sampler};
pub use error::ToleranceError;
pub use parameter::Parameter;
pub use part::{Part, PartReport, shard};
pub use report::{AgainstTracking, Distribution, Distributions, Kept, Yields};
pub use shares::{Share, Shares};
pub use simulate::simulate;
pub use statistics::{Histogram, Quantiles, Yield};
pub use study::{INSTANTS, Studied, Study, Studying, left_out};

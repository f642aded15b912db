//! Tolerances: random machines around a nominal one, and the reactions on their bases.
//!
//! A machine is balanced if its constants have certain values: g_k = 0, C_kl = 0, λ as designed. A built machine has
//! slightly different ones. This module samples such machines. It computes the size of the base wrench, the fraction of
//! machines within limits, and the contribution of each tolerance.
//!
//! # Limits of linearity
//! With perfect tracking, the wrench is linear in g, C and the diagonal H_kk of the mass matrix. [`Ensemble`] is
//! exact for large deviations too. The wrench is *not* linear in masses and lengths (m a_k a_l). Norms of f_B and
//! peaks are not linear even in g, C, H_kk. Tracking is not perfect with finite gains if the model differs from the
//! machine. Nor is it with torque limits, unequal gains, uncompensated friction, or a moving base. All these effects
//! alter the motion itself, so [`simulate()`] then simulates each machine.
//!
//! | what | modules |
//! |---|---|
//! | parameters that vary, and their spreads | [`UncertainParameter`]; `Tolerance` and `Spread` of [scenarios](stillbase_session::scenario) |
//! | random machines, a million per second | [`Ensemble`], [`Sampler`], [`SampleOutcome`] |
//! | means and standard deviations over time, exact, first-order and sampled | [`Bands`], [`Agreement`] |
//! | contribution of each tolerance | [`Share`] |
//! | the whole study of a run, for display | [`Study`] |
//! | consecutive machines, with perfect tracking or simulated | [`Batch`] |
//! | quantiles, histograms, yield | [`Quantiles`], [`Histogram`], [`Yield`] |
//! | results of any number of machines in bounded memory, which add up exactly | [`Summary`], [`Octave`], [`Recount`] |
//! | results over all machines, or a part of them | [`PartReport`]: [`Distributions`], [`Yields`], [`TrackingComparison`] |

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
mod summary;

pub use bands::{Agreement, BandDifference, Bands, ForceBand, MomentBand, PERCENTILES};
pub use batch::{Batch, GoesOn, Mode};
pub use deviate::{CHUNK, inverse_normal};
pub use ensemble::{Ensemble, SampleOutcome, Sampler};
pub use error::ToleranceError;
pub use parameter::UncertainParameter;
pub use part::{EnsemblePart, PartReport, PartResults, shard};
pub use report::{Distribution, Distributions, LimitYield, TrackingComparison, Yields};
pub use shares::{Share, Shares};
pub use simulate::simulate;
pub use statistics::{Histogram, Quantiles, Yield};
pub use study::{STUDY_INSTANTS, StudiedRun, Study, StudyQuery, neglected_effects};
pub use summary::{
    BIN_WIDTH, BinPlace, BinValues, Extreme, KnownRanks, Limits, MAX_VALUES, OCTAVE_BINS, OCTAVES, Octave, Recount,
    Summary, Unmergeable, bin_of, lower_edge,
};

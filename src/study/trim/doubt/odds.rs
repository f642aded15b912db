//! Likelihood ratio of a measurement corrected for a fault to the measurement as given.

use super::rejection::Residual;
use super::tolerances::Tolerances;
use crate::trim::fit::IdentifiedNumbers;

/// Contribution to ln Λ if only one of both fits keeps the joint limits: ln 10⁶.
const LIMITS_LOG_ODDS: f64 = 13.8;
/// Factor by which d² must decrease to be evidence of a fault. Mere deviations beyond the tolerances decrease it by
/// less.
const MIN_IMPROVEMENT: f64 = 30.0;
/// Violation above which the joint limits count as violated, rad.
pub(super) const LIMIT_LEFT_BEYOND: f64 = 0.1;
/// Violation up to which the joint limits count as kept, rad.
pub(super) const LIMIT_KEPT_WITHIN: f64 = 0.02;
/// Fraction of the effective rows that is counted, because the correlation of few rows is uncertain.
const COUNTED_FRACTION: f64 = 0.5;
/// Residuals below this fraction of the largest possible reaction are rounding errors, of the arithmetic or of printed
/// digits.
const ROUNDING_LEVEL: f64 = 1e-10;
/// Lower bound on relative residuals: smaller residuals are errors of the finite differences, and no evidence.
const MIN_RELATIVE_RESIDUAL: f64 = 1e-6;

/// A fit of a measurement, as given or without a fault.
pub(in crate::trim) struct FitTrial {
    pub numbers: IdentifiedNumbers,
    /// Force and moment; or the rate of a base that floats, and each rate against its angle.
    pub channels: Vec<ChannelFit>,
    /// Degrees of freedom as a fraction of the effective rows; values outside of 0.1 … 1 count as these.
    pub share: f64,
    /// Violation of the joint limits, rad.
    pub limit_violation: f64,
}

/// What a fit leaves unexplained of one measured quantity.
pub(in crate::trim) struct ChannelFit {
    pub residual: Residual,
    /// Effective number of independent rows.
    pub effective: f64,
    /// Largest root mean square value that a machine of this size could have in these motions.
    pub largest: f64,
    /// Shares of either fit below this are no evidence.
    pub floor: f64,
    /// Factor between the shares of two fits that is no evidence.
    pub slack: f64,
}

impl FitTrial {
    /// Returns what is not explained.
    pub fn residuals(&self) -> Vec<Residual> {
        self.channels.iter().map(|channel| channel.residual.clone()).collect()
    }
}

/// Returns ln Λ for the decision, and ln Λ for the ranking; `None` if they cannot be computed.
pub(super) fn likelihood_ratio(tolerances: &Tolerances, given: &FitTrial, other: &FitTrial) -> Option<[f64; 2]> {
    let share = other.share.clamp(0.1, 1.0);
    let evidence = |was: &ChannelFit, now: &ChannelFit| {
        let floor = was.floor.max(now.floor).max(MIN_RELATIVE_RESIDUAL);
        let [before, after] = [was, now].map(|fit| fit.residual.share.max(floor));
        let (less, slack) = ((before / after).ln(), was.slack.ln());
        let improvement = less.signum() * (less.abs() - slack).max(0.0);
        let evidence = COUNTED_FRACTION * was.effective.min(now.effective) * share * improvement;
        // Residuals within rounding need no explanation: a balanced machine gives no force, whatever its unit.
        let is_explained = was.residual.noise <= ROUNDING_LEVEL * was.largest;
        if is_explained { evidence.min(0.0) } else { evidence }
    };
    let residuals: f64 = given.channels.iter().zip(&other.channels).map(|(was, now)| evidence(was, now)).sum();
    let (before, after) = (tolerances.distance(&given.numbers)?, tolerances.distance(&other.numbers)?);
    // A change of units changes which unknowns are well determined; take the larger number.
    let p = before.numbers.max(after.numbers);
    let scale = before.balance.max(after.balance) + p;
    let limits = match [given.limit_violation, other.limit_violation] {
        [was, now] if was > LIMIT_LEFT_BEYOND && now < LIMIT_KEPT_WITHIN => LIMITS_LOG_ODDS,
        [was, now] if was < LIMIT_KEPT_WITHIN && now > LIMIT_LEFT_BEYOND => -LIMITS_LOG_ODDS,
        _ => 0.0,
    };
    let common = residuals + limits;
    let momenta = 0.5 * p * ((before.momenta + scale) / (after.momenta + scale)).ln();
    // A distance below its expected value p is replaced by p.
    let all = 0.5 * p * (before.all.max(p) / after.all.max(p)).ln();
    let far = before.known.zip(after.known).map_or(f64::NEG_INFINITY, |([was, p], [now, more])| {
        let p = p.max(more);
        0.5 * p * (was / (MIN_IMPROVEMENT * now.max(p))).ln()
    });
    Some([common + momenta.max(far), common + all]).filter(|odds| odds.iter().all(|x| x.is_finite()))
}

//! Likelihood ratio of a measurement corrected for a fault to the measurement as given.

use super::tolerances::Tolerances;
use crate::trim::error::TrimError;
use crate::trim::fit::{Fit, estimate};
use crate::trim::rows::Regressor;
use stillbase_mechanics::machine::Machine;

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

/// A fit, its degrees of freedom as a fraction of the effective rows, and its violation of the joint limits, rad.
pub(super) struct FitTrial {
    pub fit: Fit,
    share: f64,
    pub limit_violation: f64,
}

pub(super) fn try_fit(machine: &Machine, rows: &Regressor, limit_violation: f64) -> Result<FitTrial, TrimError> {
    let estimate = estimate(machine, rows)?;
    Ok(FitTrial { fit: estimate.fit, share: estimate.share.clamp(0.1, 1.0), limit_violation })
}

/// Returns the residuals of force and of moment as fractions of the measured values.
pub(super) fn shares(fit: &Fit) -> [f64; 2] {
    [0, 1].map(|of| fit.noise[of] / fit.size[of].max(f64::MIN_POSITIVE))
}

/// Returns ln Λ for the decision, and ln Λ for the ranking; `None` if they cannot be computed.
pub(super) fn likelihood_ratio(tolerances: &Tolerances, given: &FitTrial, other: &FitTrial) -> Option<[f64; 2]> {
    let (was, now) = (&given.fit, &other.fit);
    let residuals = |of: usize| {
        let [before, after] = [was, now].map(|fit| shares(fit)[of].max(MIN_RELATIVE_RESIDUAL));
        let evidence =
            COUNTED_FRACTION * was.effective[of].min(now.effective[of]) * other.share * (before / after).ln();
        // Residuals within rounding need no explanation: a balanced machine gives no force, whatever its unit.
        let is_explained = was.noise[of] <= ROUNDING_LEVEL * was.largest[of];
        if is_explained { evidence.min(0.0) } else { evidence }
    };
    let (before, after) = (tolerances.distance(was)?, tolerances.distance(now)?);
    // A change of units changes which unknowns are well determined; take the larger number.
    let p = before.numbers.max(after.numbers);
    let scale = before.balance.max(after.balance) + p;
    let limits = match [given.limit_violation, other.limit_violation] {
        [was, now] if was > LIMIT_LEFT_BEYOND && now < LIMIT_KEPT_WITHIN => LIMITS_LOG_ODDS,
        [was, now] if was < LIMIT_KEPT_WITHIN && now > LIMIT_LEFT_BEYOND => -LIMITS_LOG_ODDS,
        _ => 0.0,
    };
    let common = residuals(0) + residuals(1) + limits;
    let momenta = 0.5 * p * ((before.momenta + scale) / (after.momenta + scale)).ln();
    // A distance below its expected value p is replaced by p.
    let all = 0.5 * p * (before.all.max(p) / after.all.max(p)).ln();
    let far = before.known.zip(after.known).map_or(f64::NEG_INFINITY, |([was, p], [now, more])| {
        let p = p.max(more);
        0.5 * p * (was / (MIN_IMPROVEMENT * now.max(p))).ln()
    });
    Some([common + momenta.max(far), common + all]).filter(|odds| odds.iter().all(|x| x.is_finite()))
}

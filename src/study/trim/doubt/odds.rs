//! How much better a measurement is explained without a fault.

use super::tolerances::Tolerances;
use crate::mechanics::machine::Machine;
use crate::study::trim::error::TrimError;
use crate::study::trim::fit::{Fit, estimate};
use crate::study::trim::rows::Rows;

/// ln Λ of joint limits that are kept instead of left: odds of 10⁶.
const LIMITS: f64 = 13.8;
/// By how many times all numbers have to come closer to the file, in squares, before that is evidence of a fault: errors
/// of which the tolerances know nothing make them come closer by less.
const FAR: f64 = 30.0;
/// Limits are left by more than this, rad.
pub(super) const LEFT: f64 = 0.1;
/// Limits are kept within this, rad.
pub(super) const KEPT: f64 = 0.02;
/// As few rows tell how correlated they are, this share of the independent ones is counted.
const CORRELATED: f64 = 0.5;
/// What is below this share of what the machine could give is rounding, also of digits that were written.
const ROUNDING: f64 = 1e-10;
/// Residuals below this share of what was measured are those of differences between samples, and no evidence.
const EXACT: f64 = 1e-6;

/// A fit, and how far angles leave their limits.
pub(super) struct Tried {
    pub fit: Fit,
    share: f64,
    pub leaves: f64,
}

pub(super) fn tried(machine: &Machine, rows: &Rows, leaves: f64) -> Result<Tried, TrimError> {
    let estimate = estimate(machine, rows)?;
    Ok(Tried { fit: estimate.fit, share: estimate.share.clamp(0.1, 1.0), leaves })
}

/// What a fit leaves of force and of moment, as shares of what was measured.
pub(super) fn shares(fit: &Fit) -> [f64; 2] {
    [0, 1].map(|of| fit.noise[of] / fit.size[of].max(f64::MIN_POSITIVE))
}

/// ln Λ that decides, and ln Λ that ranks.
pub(super) fn odds(tolerances: &Tolerances, given: &Tried, other: &Tried) -> Option<[f64; 2]> {
    let (was, now) = (&given.fit, &other.fit);
    let residuals = |of: usize| {
        let [before, after] = [was, now].map(|fit| shares(fit)[of].max(EXACT));
        let evidence = CORRELATED * was.effective[of].min(now.effective[of]) * other.share * (before / after).ln();
        // Where rounding alone is left there is nothing to explain: a balanced machine gives no force, whatever its unit.
        let is_explained = was.noise[of] <= ROUNDING * was.largest[of];
        if is_explained { evidence.min(0.0) } else { evidence }
    };
    let (before, after) = (tolerances.distance(was)?, tolerances.distance(now)?);
    // Units change what is known; more of it speaks.
    let p = before.numbers.max(after.numbers);
    let scale = before.balance.max(after.balance) + p;
    let limits = match [given.leaves, other.leaves] {
        [was, now] if was > LEFT && now < KEPT => LIMITS,
        [was, now] if was < KEPT && now > LEFT => -LIMITS,
        _ => 0.0,
    };
    let common = residuals(0) + residuals(1) + limits;
    let momenta = 0.5 * p * ((before.momenta + scale) / (after.momenta + scale)).ln();
    // Closer to the file than the tolerances is not better.
    let all = 0.5 * p * (before.all.max(p) / after.all.max(p)).ln();
    let far = before.known.zip(after.known).map_or(f64::NEG_INFINITY, |([was, p], [now, more])| {
        let p = p.max(more);
        0.5 * p * (was / (FAR * now.max(p))).ln()
    });
    Some([common + momenta.max(far), common + all]).filter(|odds| odds.iter().all(|x| x.is_finite()))
}

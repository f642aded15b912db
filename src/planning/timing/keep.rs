//! Slowing a motion down so that it keeps its limits everywhere, not only at the nodes of its plan.

use crate::Motion;
use crate::timing::law::PathProgress;
use crate::timing::limits::DriveLimits;
use crate::timing::profile::{Profile, after};
use crate::timing::usage::Demand;
use stillbase_mechanics::arm_on_base::ArmOnBase;

/// Number of intervals of a phase that is sampled finely.
const FINE_INTERVALS: usize = 16;
/// Distance of samples from the ends of a phase, as a fraction of it. Without it, rounding would decide which side of a
/// jump of the path's derivatives is evaluated.
const END_MARGIN_SHARE: f64 = 1e-6;
/// Relative margin against rounding.
const ROUNDING: f64 = 1e-9;
/// Maximum relative excess of the slowdown over the necessary one.
const NEGLIGIBLE: f64 = 1e-7;

/// Three samples, within a phase, of several quantities. Each quantity is smooth there, but their maximum need not be,
/// so each is assessed separately.
pub(super) struct PhaseBound {
    phase: (PathProgress, f64),
    /// Maximum over the three samples.
    pub(super) seen: f64,
    /// Upper estimate of the maximum in the phase: the vertex of the parabola through the three values plus a quarter
    /// of their spread.
    pub(super) bound: f64,
    /// Index of the quantity that gives the bound, and its three values.
    likeliest: (usize, [f64; 3]),
    /// Upper estimate for the other quantities.
    others: f64,
}

impl PhaseBound {
    /// Samples a phase at both ends and in its middle.
    pub(super) fn of<const N: usize>(phase: (PathProgress, f64), of: impl Fn(&PathProgress) -> [f64; N]) -> Self {
        let [from, to] = [0.0, 1.0].map(|u| within(&phase, u, &of));
        Self::between(phase, [&from, &to], of)
    }

    /// Samples a phase in its middle; the quantities at both ends are given.
    pub(super) fn between<const N: usize>(
        phase: (PathProgress, f64),
        [from, to]: [&[f64; N]; 2],
        of: impl Fn(&PathProgress) -> [f64; N],
    ) -> Self {
        let middle = within(&phase, 0.5, &of);
        let mut phase_bound = Self { phase, seen: 0.0, bound: 0.0, likeliest: (0, [0.0; 3]), others: 0.0 };
        for k in 0..N {
            let own = [from[k], middle[k], to[k]];
            let greatest = own[0].max(own[1]).max(own[2]);
            let spread = greatest - own[0].min(own[1]).min(own[2]);
            phase_bound.seen = phase_bound.seen.max(greatest);
            if spread > ROUNDING * greatest {
                let bound = crest(own).max(greatest) + 0.25 * spread;
                if bound > phase_bound.bound {
                    (phase_bound.others, phase_bound.bound, phase_bound.likeliest) =
                        (phase_bound.bound, bound, (k, own));
                } else {
                    phase_bound.others = phase_bound.others.max(bound);
                }
            }
        }
        phase_bound.bound = phase_bound.bound.max(phase_bound.seen);
        phase_bound
    }

    /// Samples the phase more finely. Returns the maximum that is found and an upper estimate, which is at most
    /// `enough` or equal to the maximum.
    pub(super) fn closer<const N: usize>(&self, enough: f64, of: impl Fn(&PathProgress) -> [f64; N]) -> [f64; 2] {
        // The error of the parabola at two more samples bounds the error of the three parabolas through neighbouring
        // samples.
        let (k, [a, b, c]) = self.likeliest;
        let [p, q] = [0.25, 0.75].map(|u| within(&self.phase, u, &of)[k]);
        let off = (p - 0.125 * (3.0 * a + 6.0 * b - c)).abs().max((q - 0.125 * (3.0 * c + 6.0 * b - a)).abs());
        let top = [[a, p, b], [p, b, q], [b, q, c]].map(crest).into_iter().fold(self.seen, f64::max);
        let bound = (top + off).max(self.others);
        if bound <= enough {
            return [top, bound];
        }
        let near: [[f64; N]; FINE_INTERVALS + 1] =
            std::array::from_fn(|i| within(&self.phase, i as f64 / FINE_INTERVALS as f64, &of));
        let tops = |w: &[[f64; N]]| (0..N).map(|k| crest([w[0][k], w[1][k], w[2][k]])).fold(0.0, f64::max);
        let top = near.windows(3).map(tops).fold(self.seen, f64::max);
        [top, top]
    }
}

/// Returns the quantities at the fraction u of a phase.
fn within<const N: usize>(
    (from, time): &(PathProgress, f64),
    u: f64,
    of: impl Fn(&PathProgress) -> [f64; N],
) -> [f64; N] {
    of(&after(from, u.clamp(END_MARGIN_SHARE, 1.0 - END_MARGIN_SHARE) * time))
}

/// Returns the maximum of all quantities over all phases.
pub(super) fn greatest<const N: usize>(
    phases: impl Iterator<Item = (PathProgress, f64)>,
    of: impl Fn(&PathProgress) -> [f64; N],
) -> f64 {
    greatest_of(phases.map(|phase| PhaseBound::of(phase, &of)).collect(), of)
}

/// Returns the maximum of all quantities over sampled phases, or slightly more. It samples finely those phases that may
/// contain the maximum, the likeliest first.
pub(super) fn greatest_of<const N: usize>(
    mut phase_bounds: Vec<PhaseBound>,
    of: impl Fn(&PathProgress) -> [f64; N],
) -> f64 {
    let mut found_max = phase_bounds.iter().map(|phase_bound| phase_bound.seen).fold(0.0, f64::max);
    let mut upper = found_max;
    phase_bounds.retain(|phase_bound| phase_bound.bound > found_max);
    phase_bounds.sort_unstable_by(|x, y| y.bound.total_cmp(&x.bound));
    for phase_bound in phase_bounds {
        let enough = found_max * (1.0 + NEGLIGIBLE);
        if phase_bound.bound <= enough {
            upper = upper.max(phase_bound.bound);
            break;
        }
        let [found, bound] = phase_bound.closer(enough, &of);
        (found_max, upper) = (found_max.max(found), upper.max(bound));
    }
    found_max.max(upper)
}

/// Returns the maximum of the parabola through three even samples if it lies between them, else the maximum of the
/// samples.
fn crest([a, b, c]: [f64; 3]) -> f64 {
    let (slope, bend) = (0.5 * (c - a), a - 2.0 * b + c);
    // A vertex beyond the outer samples is not in this phase.
    if bend < 0.0 && slope.abs() <= -bend { b - 0.5 * slope * slope / bend } else { a.max(b).max(c) }
}

/// Returns a profile slowed down by a factor on time, so that every limit is kept. Returns `None` if the factor is
/// infinite.
pub(super) fn slow_to_keep(profile: &Profile, factor: f64) -> Option<Profile> {
    // An excess at rounding level needs no slower profile.
    let needed = factor > 1.0 + ROUNDING;
    factor.is_finite().then(|| if needed { profile.stretched(factor * (1.0 + ROUNDING)) } else { profile.clone() })
}

/// Minimum number of parts in which a motion is sampled.
const MIN_PARTS: usize = 2000;

impl Motion {
    /// Returns the motion slowed down to the limits of the drives on torque, speed and acceleration. Returns `None` if
    /// no duration is sufficient.
    ///
    /// Its profile must consist of phases, as those of the fastest motions do.
    #[must_use]
    pub fn slowed(&self, arm: &ArmOnBase, limits: &DriveLimits) -> Option<Self> {
        let limits = DriveLimits { jerk: DriveLimits::none(limits.jerk.len()).jerk, ..*limits };
        let count = self.profile.phases().count().max(1);
        // An even number, so that a change in the middle of a phase falls between two parts.
        let parts = 2 * MIN_PARTS.div_ceil(2 * count);
        let cut = |(from, time): (PathProgress, f64)| {
            let time = time / parts as f64;
            (0..parts).map(move |i| (after(&from, i as f64 * time), time))
        };
        let stretches = |at: &PathProgress| Demand::of(&self.path, arm, &limits, at).stretches(&limits);
        let profile = slow_to_keep(&self.profile, greatest(self.profile.phases().flat_map(cut), stretches))?;
        Some(Self { path: self.path.clone(), profile })
    }
}

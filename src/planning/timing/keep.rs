//! By how much a motion must be slowed down to keep its limits everywhere, not only at the nodes of its plan.

use crate::mechanics::dynamics::Surroundings;
use crate::mechanics::machine::Inertia;
use crate::planning::Motion;
use crate::planning::timing::law::Progress;
use crate::planning::timing::limits::Limits;
use crate::planning::timing::profile::{Profile, after};
use crate::planning::timing::usage::Demand;

/// Parts of a phase that is looked at closely.
const CLOSE: usize = 16;
/// How far from its ends, as a share of a phase: where a path's derivatives jump, rounding would decide which side is
/// looked at.
const INSIDE: f64 = 1e-6;
/// What rounding may need.
const SPARE: f64 = 1e-9;

/// The greatest of several quantities that are each smooth within every phase, over all phases. The greatest of them is
/// not smooth where one takes over from another, so each is looked at by itself.
///
/// A peak between three instants is taken to be that of the parabola through them; phases in which one could be the
/// greatest of all are looked at closely.
pub(super) fn greatest<const N: usize>(
    phases: impl Iterator<Item = (Progress, f64)>,
    of: impl Fn(&Progress) -> [f64; N],
) -> f64 {
    let mut most: f64 = 0.0;
    for (from, time) in phases {
        let at = |u: f64| of(&after(&from, u.clamp(INSIDE, 1.0 - INSIDE) * time));
        let three = [at(0.0), at(0.5), at(1.0)];
        let before = most;
        let mut close = false;
        for k in 0..N {
            let own = three.map(|values| values[k]);
            let seen = own.into_iter().fold(0.0, f64::max);
            let spread = seen - own.into_iter().fold(f64::INFINITY, f64::min);
            most = most.max(seen);
            close |= spread > SPARE * seen && crest(own).max(seen) + 0.25 * spread > before;
        }
        if close {
            let near: [[f64; N]; CLOSE + 1] = std::array::from_fn(|i| at(i as f64 / CLOSE as f64));
            for w in near.windows(3) {
                let tops = (0..N).map(|k| crest([w[0][k], w[1][k], w[2][k]]));
                most = tops.fold(most, f64::max);
            }
        }
    }
    most
}

/// The top of the parabola through three values at even distances, if it lies between them; else the greatest of them.
fn crest([a, b, c]: [f64; 3]) -> f64 {
    let (slope, bend) = (0.5 * (c - a), a - 2.0 * b + c);
    // Farther out it is none of this phase.
    if bend < 0.0 && slope.abs() <= -bend { b - 0.5 * slope * slope / bend } else { a.max(b).max(c) }
}

/// A profile slowed down by the least factor with which every limit is kept; `stretches` are those factors at one
/// instant, one a limit. `None` if no time is enough.
pub(super) fn kept<const N: usize>(profile: &Profile, stretches: impl Fn(&Progress) -> [f64; N]) -> Option<Profile> {
    let factor = greatest(profile.phases(), stretches);
    // Rounding is not worth another profile.
    let needed = factor > 1.0 + SPARE;
    factor.is_finite().then(|| if needed { profile.stretched(factor * (1.0 + SPARE)) } else { profile.clone() })
}

/// At least so many parts of a motion are looked at.
const LOOKS: usize = 2000;

impl Motion {
    /// The motion as slow as the limits of the drives on torque, speed and acceleration want it. `None` if no time is
    /// enough.
    ///
    /// Its timing is to be by phases, as those of the fastest motions are.
    #[must_use]
    pub fn slowed(&self, model: &Inertia, around: &Surroundings, limits: &Limits) -> Option<Self> {
        let limits = Limits { jerk: Limits::none(limits.jerk.len()).jerk, ..*limits };
        let count = self.profile.phases().count().max(1);
        // An even number, so that what changes in the middle of a phase changes between two parts.
        let parts = 2 * LOOKS.div_ceil(2 * count);
        let cut = |(from, time): (Progress, f64)| {
            let time = time / parts as f64;
            (0..parts).map(move |i| (after(&from, i as f64 * time), time))
        };
        let stretches = |at: &Progress| Demand::of(&self.path, model, around, &limits, at).stretches(&limits);
        let factor = greatest(self.profile.phases().flat_map(cut), stretches);
        let by = if factor > 1.0 + SPARE { factor * (1.0 + SPARE) } else { 1.0 };
        let profile = if by > 1.0 { self.profile.stretched(by) } else { self.profile.clone() };
        factor.is_finite().then(|| Self { path: self.path.clone(), profile })
    }
}

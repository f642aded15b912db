//! By how much a motion must be slowed down to keep its limits everywhere, not only at the nodes of its plan.

use crate::mechanics::dynamics::Surroundings;
use crate::mechanics::machine::Inertia;
use crate::planning::Motion;
use crate::planning::timing::law::Progress;
use crate::planning::timing::limits::Limits;
use crate::planning::timing::profile::{Profile, after};
use crate::planning::timing::usage::Demand;

/// Parts of a phase that is looked at closely.
const CLOSE_PARTS: usize = 16;
/// How far from its ends, as a share of a phase: where a path's derivatives jump, rounding would decide which side is
/// looked at.
const END_MARGIN_SHARE: f64 = 1e-6;
/// What rounding may need.
const ROUNDING: f64 = 1e-9;
/// A motion may be slower than it has to be by this share of its time.
const NEGLIGIBLE: f64 = 1e-7;

/// Several quantities that are each smooth within a phase, seen at three instants of it. The greatest of them is not
/// smooth where one takes over from another, so each is looked at by itself.
pub(super) struct Glance {
    phase: (Progress, f64),
    /// The greatest value at the three instants.
    pub(super) seen: f64,
    /// What a closer look may find at most: the tops of the parabolas through three values, and a quarter of the spread.
    pub(super) bound: f64,
    /// Which quantity gives the bound, its three values, and the bound of the others.
    likeliest: (usize, [f64; 3]),
    others: f64,
}

impl Glance {
    /// At both ends of a phase and in its middle.
    pub(super) fn of<const N: usize>(phase: (Progress, f64), of: impl Fn(&Progress) -> [f64; N]) -> Self {
        let [from, to] = [0.0, 1.0].map(|u| within(&phase, u, &of));
        Self::between(phase, [&from, &to], of)
    }

    /// The same where the quantities at both ends are known.
    pub(super) fn between<const N: usize>(
        phase: (Progress, f64),
        [from, to]: [&[f64; N]; 2],
        of: impl Fn(&Progress) -> [f64; N],
    ) -> Self {
        let middle = within(&phase, 0.5, &of);
        let mut glance = Self { phase, seen: 0.0, bound: 0.0, likeliest: (0, [0.0; 3]), others: 0.0 };
        for k in 0..N {
            let own = [from[k], middle[k], to[k]];
            let greatest = own[0].max(own[1]).max(own[2]);
            let spread = greatest - own[0].min(own[1]).min(own[2]);
            glance.seen = glance.seen.max(greatest);
            if spread > ROUNDING * greatest {
                let bound = crest(own).max(greatest) + 0.25 * spread;
                if bound > glance.bound {
                    (glance.others, glance.bound, glance.likeliest) = (glance.bound, bound, (k, own));
                } else {
                    glance.others = glance.others.max(bound);
                }
            }
        }
        glance.bound = glance.bound.max(glance.seen);
        glance
    }

    /// The greatest value that is found in the phase, and what it is at most: the same, or less than is `enough`.
    pub(super) fn closer<const N: usize>(&self, enough: f64, of: impl Fn(&Progress) -> [f64; N]) -> [f64; 2] {
        // By how much the parabola misses two more values is more than those through all five miss.
        let (k, [a, b, c]) = self.likeliest;
        let [p, q] = [0.25, 0.75].map(|u| within(&self.phase, u, &of)[k]);
        let off = (p - 0.125 * (3.0 * a + 6.0 * b - c)).abs().max((q - 0.125 * (3.0 * c + 6.0 * b - a)).abs());
        let top = [[a, p, b], [p, b, q], [b, q, c]].map(crest).into_iter().fold(self.seen, f64::max);
        let bound = (top + off).max(self.others);
        if bound <= enough {
            return [top, bound];
        }
        let near: [[f64; N]; CLOSE_PARTS + 1] =
            std::array::from_fn(|i| within(&self.phase, i as f64 / CLOSE_PARTS as f64, &of));
        let tops = |w: &[[f64; N]]| (0..N).map(|k| crest([w[0][k], w[1][k], w[2][k]])).fold(0.0, f64::max);
        let top = near.windows(3).map(tops).fold(self.seen, f64::max);
        [top, top]
    }
}

/// The quantities at a part of a phase.
fn within<const N: usize>((from, time): &(Progress, f64), u: f64, of: impl Fn(&Progress) -> [f64; N]) -> [f64; N] {
    of(&after(from, u.clamp(END_MARGIN_SHARE, 1.0 - END_MARGIN_SHARE) * time))
}

/// The greatest of all quantities over all phases.
pub(super) fn greatest<const N: usize>(
    phases: impl Iterator<Item = (Progress, f64)>,
    of: impl Fn(&Progress) -> [f64; N],
) -> f64 {
    greatest_of(phases.map(|phase| Glance::of(phase, &of)).collect(), of)
}

/// The same of phases that have been glanced at, or a negligible bit more: those in which it may be are looked at
/// closely, the likeliest first.
pub(super) fn greatest_of<const N: usize>(mut glances: Vec<Glance>, of: impl Fn(&Progress) -> [f64; N]) -> f64 {
    let mut most = glances.iter().map(|glance| glance.seen).fold(0.0, f64::max);
    let mut at_most = most;
    glances.retain(|glance| glance.bound > most);
    glances.sort_unstable_by(|x, y| y.bound.total_cmp(&x.bound));
    for glance in glances {
        let enough = most * (1.0 + NEGLIGIBLE);
        if glance.bound <= enough {
            at_most = at_most.max(glance.bound);
            break;
        }
        let [found, bound] = glance.closer(enough, &of);
        (most, at_most) = (most.max(found), at_most.max(bound));
    }
    most.max(at_most)
}

/// The top of the parabola through three values at even distances, if it lies between them; else the greatest of them.
fn crest([a, b, c]: [f64; 3]) -> f64 {
    let (slope, bend) = (0.5 * (c - a), a - 2.0 * b + c);
    // Farther out it is none of this phase.
    if bend < 0.0 && slope.abs() <= -bend { b - 0.5 * slope * slope / bend } else { a.max(b).max(c) }
}

/// A profile slowed down by a factor on time with which every limit is kept. `None` if no time is enough.
pub(super) fn kept(profile: &Profile, factor: f64) -> Option<Profile> {
    // Rounding is not worth another profile.
    let needed = factor > 1.0 + ROUNDING;
    factor.is_finite().then(|| if needed { profile.stretched(factor * (1.0 + ROUNDING)) } else { profile.clone() })
}

/// At least so many parts of a motion are looked at.
const MIN_PARTS: usize = 2000;

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
        let parts = 2 * MIN_PARTS.div_ceil(2 * count);
        let cut = |(from, time): (Progress, f64)| {
            let time = time / parts as f64;
            (0..parts).map(move |i| (after(&from, i as f64 * time), time))
        };
        let stretches = |at: &Progress| Demand::of(&self.path, model, around, &limits, at).stretches(&limits);
        let profile = kept(&self.profile, greatest(self.profile.phases().flat_map(cut), stretches))?;
        Some(Self { path: self.path.clone(), profile })
    }
}

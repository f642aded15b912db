//! Distance between motions of equal timing in the metric of kinetic energy: see [`nearest`](super::nearest).

use crate::Motion;
use crate::curves::given::Samples;
use crate::golden::golden;
use crate::reactionless::BSet;
use stillbase_mechanics::kinematics::end_effector;
use stillbase_mechanics::machine::{Chain, Inertia};
use stillbase_mechanics::planar::PerDrive;
use stillbase_query::ProgressCallback;

/// Distance between two motions of equal timing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// Greatest distance of the end effectors, m.
    pub end_effector: f64,
    /// Greatest |Δq_k|, rad.
    pub joints: PerDrive,
    /// ‖Δq‖, rad.
    pub rms: f64,
}

impl Deviation {
    /// Returns the deviation between motions of equal duration, from `instants` + 1 evenly spaced instants.
    pub fn between(tip: &Chain, model: &Inertia, one: &Motion, other: &Motion, instants: usize) -> Self {
        let n = model.drives();
        let mut worst = Self { end_effector: 0.0, joints: PerDrive::zeros(n), rms: 0.0 };
        let whole: f64 = (0..n).map(|k| model.diagonal(k)).sum();
        for i in 0..=instants {
            let share = i as f64 / instants as f64;
            let [a, b] = [one, other].map(|motion| motion.path.at(motion.profile.at(share * motion.duration()).s).q);
            let gap = end_effector(tip, &a.units()) - end_effector(tip, &b.units());
            worst.end_effector = worst.end_effector.max(gap.norm());
            let off = a.0.minus(&b.0);
            worst.joints.iter_mut().zip(off.iter()).for_each(|(worst, off)| *worst = worst.max(off.abs()));
            let square: f64 = off.iter().enumerate().map(|(k, off)| model.diagonal(k) * off * off).sum();
            // The trapezoidal rule.
            let weight = if i == 0 || i == instants { 0.5 } else { 1.0 };
            worst.rms += weight * square / (whole * instants as f64);
        }
        worst.rms = worst.rms.sqrt();
        worst
    }
}

/// Returns ‖Δq‖ of samples at the same times, by the trapezoidal rule, rad.
pub(super) fn angle_distance(model: &Inertia, one: &Samples, other: &Samples) -> f64 {
    let n = model.drives();
    let whole: f64 = (0..n).map(|k| model.diagonal(k)).sum();
    let square = |i: usize| -> f64 {
        let pairs = one.values(i).iter().zip(other.values(i)).enumerate();
        pairs.map(|(k, (a, b))| model.diagonal(k) * (a - b) * (a - b)).sum()
    };
    let spaces = (1..one.count()).map(|i| 0.5 * (one.time(i) - one.time(i - 1)) * (square(i) + square(i - 1)));
    (spaces.sum::<f64>() / (whole * one.duration())).sqrt()
}

/// Finds the b of a set, rad, at which the distance `far` is least, and that distance. It tries `tries` evenly spaced
/// b in each interval and `mean`, then refines the best by `sections` golden section steps. Returns `None` if the
/// distance is finite nowhere, or if `goes_on` cancels the search.
pub(super) fn least(
    set: &BSet,
    mean: f64,
    [tries, sections]: [usize; 2],
    far: impl Fn(f64) -> f64,
    goes_on: ProgressCallback<'_>,
) -> Option<(f64, f64)> {
    let mut best: Option<(f64, f64, [f64; 2])> = None;
    let intervals = set.shifted_near(mean).intervals;
    let all = intervals.len() * (tries + 1) + sections + 1;
    let (mut done, mut stopped) = (0, false);
    // After cancellation every further distance is infinite.
    let mut far = |b: f64| {
        stopped = stopped || !goes_on(f64::from(done) / all as f64);
        done += 1;
        if stopped { f64::INFINITY } else { far(b) }
    };
    for [low, high] in intervals {
        let step = (high - low) / tries as f64;
        let inside = (0..tries).map(|i| low + (i as f64 + 0.5) * step);
        for b in inside.chain((low..=high).contains(&mean).then_some(mean)) {
            let distance = far(b);
            if distance.is_finite() && best.is_none_or(|(_, least, _)| distance < least) {
                best = Some((b, distance, [(b - step).max(low), (b + step).min(high)]));
            }
        }
    }
    let (b, distance, around) = best?;
    let refined = golden(around, sections, &mut far);
    let found = if refined.1 < distance { refined } else { (b, distance) };
    (!stopped).then_some(found)
}

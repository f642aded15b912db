//! Limits on jerk along a curve: a motion that is proved by checking it, and how far it is from a bound.
//!
//! With jerk limited the fastest motion on a curve is no convex problem. The fastest one without is averaged over a
//! window in time, which makes s̈ continuous and s⃛ piecewise constant; then time is stretched by the least factor with
//! which every limit holds, found in closed form at every instant of a dense grid. The window is the one that needs the
//! least time of all.

use super::Motion;
use super::fastest::{Fastest, TimeError, s_curve};
use super::law::Progress;
use super::limits::Limits;
use super::path::Path;
use super::profile::{Profile, Span};
use super::topp::Grid;
use super::usage::{Demand, Usage};
use crate::dynamics::Surroundings;
use crate::machine::Inertia;

/// Parts of a phase of a law that are checked.
const PARTS: usize = 500;
/// Instants for the account of what limits.
const INSTANTS: usize = 2000;
/// Windows tried at first, as parts of T, from the first to the last in even ratios.
const WINDOWS: (f64, f64, usize) = (0.004, 2.0, 12);
/// Steps of the search between the best of them.
const STEPS: usize = 9;
/// In the search only one phase of so many is looked at.
const SPARSE: usize = 5;
/// What |s̈| is bounded by in a second attempt, times 1/T²: a path whose q′ vanishes somewhere lets it grow there beyond
/// all bounds, which no average over time mends.
const BOUND: f64 = 20.0;
/// What rounding and the places between the instants may need.
const SPARE: f64 = 1.0 + 1e-6;

struct Task<'a> {
    path: &'a Path,
    model: &'a Inertia,
    around: &'a Surroundings,
    limits: &'a Limits,
}

impl Task<'_> {
    fn stretch_at(&self, at: &Progress) -> f64 {
        Demand::of(self.path, self.model, self.around, self.limits, at).stretch(self.limits)
    }

    /// The least factor on time with which a profile keeps all limits.
    fn stretch(&self, profile: &Profile, every: usize) -> f64 {
        profile.instants(every).fold(0.0, |m: f64, at| m.max(self.stretch_at(&at)))
    }

    fn time(&self, profile: &Profile, every: usize) -> f64 {
        profile.duration() * self.stretch(profile, every)
    }
}

/// A motion within all limits; `bound` is the fastest one without those on jerk.
pub(super) fn smooth(
    path: &Path,
    model: &Inertia,
    around: &Surroundings,
    limits: &Limits,
    grid: &Grid,
    bound: Result<Fastest, TimeError>,
) -> Result<Fastest, TimeError> {
    let task = Task { path, model, around, limits };
    let bound = match bound {
        // Jerk alone may be limited, or jerk and speed.
        Err(TimeError::Unlimited { .. } | TimeError::SpeedOnly) => None,
        Ok(bound) if bound.profile.duration() == 0.0 => return Ok(bound),
        other => Some(other?),
    };
    // The law that is best where jerk alone counts; it serves where all else fails.
    let law = s_curve(f64::INFINITY, f64::INFINITY, 32.0).map(|spans| Profile::of_spans(&parts(&spans)));
    let mut best = law.map_or_else(|| (f64::INFINITY, Profile::none()), |law| (task.time(&law, 1), law));
    let calmer = |b: &Fastest| {
        let sweep = grid.with_bound(BOUND / b.profile.duration().powi(2)).fastest().ok()?;
        Profile::through(grid.s, &sweep.x, &sweep.rise)
    };
    let bases = bound.iter().flat_map(|b| [Some(b.profile.clone()), calmer(b)]);
    for profile in bases.flatten().filter_map(|base| averaged(&task, &base.levelled()?)) {
        let time = task.time(&profile, 1);
        if time < best.0 {
            best = (time, profile);
        }
    }
    let (time, profile) = best;
    if !(time.is_finite() && time > 0.0) {
        return Err(TimeError::Stuck { s: 0.0 });
    }
    let profile = profile.stretched(SPARE * time / profile.duration());
    let gap = bound.map(|b| profile.duration() / b.profile.duration() - 1.0);
    let motion = Motion { path: path.clone(), profile };
    let limiting = Usage::of(&motion, model, around, limits, INSTANTS).leading;
    Ok(Fastest { profile: motion.profile, gap, limiting })
}

/// Spans cut into parts, so that all along them is checked.
fn parts(spans: &[Span]) -> Vec<Span> {
    let cut = |span: &Span| {
        let (time, from) = (span.time / PARTS as f64, *span);
        (0..PARTS).map(move |i| Span { time, acceleration: from.acceleration + i as f64 * time * from.jerk, ..from })
    };
    spans.iter().flat_map(cut).collect()
}

/// A profile averaged over the window that takes the least time once stretched.
fn averaged(task: &Task, profile: &Profile) -> Option<Profile> {
    let whole = profile.duration();
    let time = |window: f64| profile.averaged(window).map_or(f64::INFINITY, |p| task.time(&p, SPARSE));
    let (first, last, count) = WINDOWS;
    let ratio = (last / first).powf(1.0 / (count - 1) as f64);
    let mut best = (f64::INFINITY, first * whole);
    for i in 0..count {
        let window = whole * first * ratio.powi(i as i32);
        let t = time(window);
        if t < best.0 {
            best = (t, window);
        }
    }
    // Golden section in the logarithm, between the neighbours of the best.
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let (mut low, mut high) = ((best.1 / ratio).ln(), (best.1 * ratio).ln());
    for _ in 0..STEPS {
        let (p, q) = (high - golden * (high - low), low + golden * (high - low));
        let (tp, tq) = (time(p.exp()), time(q.exp()));
        if tp < best.0 {
            best = (tp, p.exp());
        }
        if tq < best.0 {
            best = (tq, q.exp());
        }
        if tp < tq { high = q } else { low = p }
    }
    best.0.is_finite().then(|| profile.averaged(best.1)).flatten()
}

//! Limits on jerk along a curve: a motion that is proved by checking it, and how far it is from a bound.
//!
//! With jerk limited the fastest motion on a curve is no convex problem. The fastest one without is cut off at its peaks
//! and averaged over a window in time, which makes s̈ continuous and s⃛ piecewise constant; then time is stretched by the
//! least factor with which every limit holds, found in closed form at every instant of a dense grid. The window is the
//! one that needs the least time of all. On a straight line, where the optimum is known, this comes within 1.2 % of it.

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
const WINDOWS: (f64, f64, usize) = (0.001, 2.0, 12);
/// Steps of the search between the best of them.
const STEPS: usize = 6;
/// At first only one phase of so many is looked at.
const SPARSE: usize = 6;
/// What |s̈| is bounded by in a second attempt, times 1/T²: a path whose q′ vanishes somewhere lets it grow there beyond
/// all bounds, which no average over time mends.
const BOUND: f64 = 20.0;
/// What rounding and the places between the instants may need.
const SPARE: f64 = 1.0 + 1e-6;

/// How wide peaks of ṡ are left, beside the window: at a peak s̈ falls by twice of what it does elsewhere, and this leaves
/// time for it to fall in two steps; where jerk rules all along, peaks serve better.
const CLIPS: [f64; 2] = [1.0, 0.0];

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

    /// The least time in which a profile keeps all limits once stretched; infinite as soon as it is known to be above
    /// `best`.
    fn time(&self, profile: &Profile, every: usize, best: f64) -> f64 {
        let whole = profile.duration();
        let mut factor: f64 = 0.0;
        for at in profile.instants(every) {
            factor = factor.max(self.stretch_at(&at));
            if factor * whole > best {
                return f64::INFINITY;
            }
        }
        factor * whole
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
    let mut best = law.map_or_else(|| (f64::INFINITY, Profile::none()), |law| (task.time(&law, 1, f64::INFINITY), law));
    let calmer = |b: &Fastest| {
        let most = BOUND / b.profile.duration().powi(2);
        let calm = b.profile.levelled()?.instants(1).all(|at| at.acceleration.abs() <= most);
        let sweep = if calm { None } else { grid.with_bound(most).fastest().ok() }?;
        Profile::through(grid.s, &sweep.x, &sweep.rise)
    };
    let bases = bound.iter().flat_map(|b| [Some(b.profile.clone()), calmer(b)]);
    for profile in bases.flatten().flat_map(|base| CLIPS.map(|clip| averaged(&task, &base, clip))).flatten() {
        let time = task.time(&profile, 1, best.0);
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
fn averaged(task: &Task, profile: &Profile, clip: f64) -> Option<Profile> {
    let whole = profile.duration();
    let average = |window: f64| profile.clipped(clip * window)?.averaged(window);
    let time = |window: f64, every, best| average(window).map_or(f64::INFINITY, |p| task.time(&p, every, best));
    let (first, last, count) = WINDOWS;
    let ratio = (last / first).powf(1.0 / (count - 1) as f64);
    let mut best = (f64::INFINITY, first * whole);
    for i in 0..count {
        let window = whole * first * ratio.powi(i as i32);
        let t = time(window, SPARSE, best.0);
        if t < best.0 {
            best = (t, window);
        }
    }
    // Golden section in the logarithm, between the neighbours of the best, with nothing left out any more.
    best.0 = time(best.1, 1, f64::INFINITY);
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let (mut low, mut high) = ((best.1 / ratio).ln(), (best.1 * ratio).ln());
    for _ in 0..STEPS {
        let (p, q) = (high - golden * (high - low), low + golden * (high - low));
        for place in [p, q] {
            let t = time(place.exp(), 1, best.0);
            if t < best.0 {
                best = (t, place.exp());
            }
        }
        if best.1.ln() < 0.5 * (p + q) { high = q } else { low = p }
    }
    best.0.is_finite().then(|| average(best.1)).flatten()
}

//! The fastest motion along any path whose limits are known, with accelerations that change gradually.

use crate::timing::fastest::{GRID_INTERVALS, stations};
use crate::timing::law::PathProgress;
use crate::timing::limits::LimitsOnPath;
use crate::timing::outcome::TimeError;
use crate::timing::profile::Profile;
use crate::timing::topp::{NoTiming, PathConstraints, UNLIMITED};

/// Finds the fastest motion from rest to rest along a path within its limits, which hold at stations of a grid. It is
/// refined where limited quantities change much.
///
/// # Errors
/// If nothing limits the motion, or no motion keeps the limits.
pub fn fastest_within(limits: &impl LimitsOnPath) -> Result<Profile, TimeError> {
    let grid = PathConstraints::new(limits, stations(GRID_INTERVALS));
    if grid.rows.iter().all(|row| row.a == 0.0 && row.c == 0.0) {
        let is_limited = grid.cap.iter().any(|x| *x < UNLIMITED);
        return Err(if is_limited { TimeError::SpeedOnly } else { TimeError::Unlimited { s: 0.0 } });
    }
    let (grid, found) = grid.fastest_refined(limits);
    let stuck = |i: usize| TimeError::Stuck { s: grid.s[i] };
    let sweep = found.map_err(|(NoTiming::At(i) | NoTiming::Rest(i))| stuck(i))?;
    if let Some(i) = sweep.x.iter().position(|x| *x >= UNLIMITED) {
        return Err(TimeError::Unlimited { s: grid.s[i] });
    }
    Profile::through(&grid.s, &sweep.x, &sweep.rise).ok_or_else(|| stuck(0))
}

impl Profile {
    /// Returns times, s, and s at even times of the motion whose s is the mean over the last `share` of the duration T: it
    /// lasts T (1 + share), and s̈ does not jump. The mean of quantities that keep their limits keeps them, too, as far as
    /// limits do not change within that time.
    ///
    /// The profile must consist of phases, as those of the fastest motions do.
    pub fn averaged(&self, share: f64, count: usize) -> Vec<[f64; 2]> {
        let (whole, width) = (self.duration(), share * self.duration());
        // Start, progress, and ∫ s dt up to there, of each phase.
        let mut phases = Vec::new();
        let (mut t, mut sum) = (0.0, 0.0);
        for (from, time) in self.phases() {
            phases.push((t, from, sum));
            (t, sum) = (t + time, sum + area(&from, time));
        }
        let area_until = |t: f64| {
            let within = t.clamp(0.0, whole);
            let i = phases.partition_point(|(start, ..)| *start <= within).saturating_sub(1);
            let own = phases.get(i).map_or(0.0, |(start, from, before)| before + area(from, within - start));
            own + (t - whole).max(0.0)
        };
        let at = |i: usize| {
            let t = (whole + width) * i as f64 / count as f64;
            [t, (area_until(t) - area_until(t - width)) / width]
        };
        (0..=count).map(at).collect()
    }
}

/// Returns ∫ s dt over a time t, s, at constant jerk.
fn area(from: &PathProgress, t: f64) -> f64 {
    t * (from.s + t * (from.rate / 2.0 + t * (from.acceleration / 6.0 + t * from.jerk / 24.0)))
}

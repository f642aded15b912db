//! [`Delay`]: a base whose rate comes later or earlier than the angles and rates of the drives.
//!
//! If ω comes late by τ, a fit leaves −τ ω̇ of it, as far as the unknowns do not take that up. Gauss–Newton steps find τ
//! together with all unknowns.

use super::fit::OrbitFit;
use super::motion::{BASE_RATE, OrbitBase, OrbitMotion, raised};
use crate::trim::differences::interpolated;
use crate::trim::doubt::FaultWords;
use stillbase_mechanics::machine::Machine;
use stillbase_settings::number::fixed_or_finer;

/// Maximum number of Gauss–Newton steps, and the change that ends them, as a fraction of the mean time between two rows.
const MAX_STEPS: usize = 12;
const LAST_CHANGE: f64 = 1e-6;
/// Change of τ for derivatives, as a fraction of this time.
const SMALL_CHANGE: f64 = 1e-3;
/// Largest delay that is looked for, as a fraction of the shortest motion.
const MAX_FRACTION: f64 = 0.1;
/// Shortest delay that is named, as a fraction of the mean time between two rows, and in standard deviations.
const MIN_ROWS: f64 = 0.05;
const MIN_DEVIATIONS: f64 = 5.0;

/// What comes late, and by how much.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Delay {
    /// Delay τ, s; negative if early.
    late: f64,
    /// `true` if the angle of the base is as late as its rate.
    attitude: bool,
    /// Whether absolute angles and rates of the drives were built with what is late.
    within_drives: bool,
}

impl Delay {
    /// Returns the delays that explain motions best, one for each way to be late.
    pub fn all(machine: &Machine, base: &OrbitBase, motions: &[OrbitMotion]) -> Vec<Self> {
        let ways = [(false, false), (false, true), (true, false), (true, true)];
        let none = ways.map(|(attitude, within_drives)| Self { late: 0.0, attitude, within_drives });
        none.into_iter().filter_map(|delay| delay.estimated(machine, base, motions)).collect()
    }

    fn estimated(self, machine: &Machine, base: &OrbitBase, motions: &[OrbitMotion]) -> Option<Self> {
        let shortest = motions.iter().map(OrbitMotion::duration).fold(f64::INFINITY, f64::min);
        let rows: usize = motions.iter().map(OrbitMotion::rows).sum();
        let between = motions.iter().map(OrbitMotion::duration).sum::<f64>() / rows as f64;
        let (mut now, mut deviation) = (self, 0.0);
        for _ in 0..MAX_STEPS {
            let undone = |late: f64| {
                let own = Self { late, ..now };
                let all: Vec<_> = motions.iter().map(|motion| own.undone(motion, &now.rows(motion))).collect();
                OrbitMotion::thinned(&all)
            };
            let change = SMALL_CHANGE * between;
            let fit = OrbitFit::of(machine, base, &undone(now.late)).ok()?;
            let more;
            [more, deviation] = fit.parameter(&undone(now.late + change), change)?;
            now.late += more;
            if now.late.abs() > MAX_FRACTION * shortest {
                return None;
            }
            if more.abs() < LAST_CHANGE * between {
                break;
            }
        }
        (now.late.abs() > (MIN_ROWS * between).max(MIN_DEVIATIONS * deviation)).then_some(now)
    }

    /// Returns the delay in words.
    pub fn words(&self) -> FaultWords {
        let (rate, both) = (BASE_RATE.to_owned(), format!("attitude/base and {BASE_RATE}"));
        let [come, moved] = if self.late > 0.0 { ["late", "earlier"] } else { ["early", "later"] };
        let (what, comes) = if self.attitude { (both, "come") } else { (rate, "comes") };
        let by = format!("{} s", fixed_or_finer(self.late.abs(), 4));
        let built = if self.attitude { "angles and rates" } else { "rates" };
        let (within, anew) = match self.within_drives {
            true => (format!(", also within absolute {built} of the drives"), ", and those built with it anew"),
            false => (String::new(), ""),
        };
        FaultWords {
            what: format!("{what} {comes} {by} {come}{within}"),
            want: format!("{what} moved by {by} to {moved} times{anew}"),
            mistakes: if self.within_drives { 2 } else { 1 },
        }
    }

    /// Returns a motion whose base is as much earlier as it came late, without the rows of which that is not known.
    pub fn undo(&self, motion: &OrbitMotion) -> OrbitMotion {
        self.undone(motion, &self.rows(motion))
    }

    /// Returns the rows of a motion of which it is known what came late.
    fn rows(&self, motion: &OrbitMotion) -> Vec<usize> {
        let t = &motion.t;
        let is_known = |row: &usize| t[0] <= t[*row] + self.late && t[*row] + self.late <= t[t.len() - 1];
        (0..t.len()).filter(is_known).collect()
    }

    fn undone(&self, motion: &OrbitMotion, rows: &[usize]) -> OrbitMotion {
        let t = &motion.t;
        let moved =
            |y: &[f64]| -> Vec<f64> { rows.iter().map(|row| interpolated(t, y, t[*row] + self.late)).collect() };
        let kept = |y: &[f64]| -> Vec<f64> { rows.iter().map(|row| y[*row]).collect() };
        let base_rate = moved(&motion.base_rate);
        let attitude = if self.attitude { moved(&motion.attitude) } else { kept(&motion.attitude) };
        // Absolute values that are right give other relative ones with another base.
        let lacks =
            |was: &[f64], now: &[f64], at: usize| if self.within_drives { 0.0 } else { was[rows[at]] - now[at] };
        let at = 0..rows.len();
        OrbitMotion {
            t: kept(t),
            angles: at
                .clone()
                .map(|at| raised(&motion.angles[rows[at]], lacks(&motion.attitude, &attitude, at)))
                .collect(),
            rates: at.map(|at| raised(&motion.rates[rows[at]], lacks(&motion.base_rate, &base_rate, at))).collect(),
            wheel_rate: kept(&motion.wheel_rate),
            attitude,
            base_rate,
        }
    }
}

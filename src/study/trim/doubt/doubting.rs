//! [`Doubting`]: the faults, tried one after the other.

use super::fault::Fault;
use super::odds::{Tried, odds, shares, tried};
use super::possible::impossible;
use super::said::{Cause, Doubt, Said};
use super::tolerances::{Tolerances, known};
use crate::mechanics::machine::Machine;
use crate::mechanics::planar::Vector;
use crate::study::trim::error::TrimError;
use crate::study::trim::recording::{Motion, Recording};
use crate::study::trim::rows::Rows;
use crate::study::trim::unknowns::{Unknown, Unknowns};

/// ln Λ above which a fault is believed: odds of 10⁴.
const BELIEVED: f64 = 9.21;
/// Numbers that differ from each other by a smaller share are not told as different.
const SAME: f64 = 1e-3;
/// Each further mistake that a fault consists of is less likely by these odds, in logarithm.
const MISTAKE: f64 = 2.3;
/// Faults less likely than the first by more than this ln Λ are not named.
const NAMED: f64 = 6.9;
/// As many are named at most.
const MAX_NAMED: usize = 5;
/// Samples that are looked at: so many by the square of the number of unknowns.
const MAX_WORK: usize = 4_000_000;

/// Whether a measurement is not what it says; `None` where it can be believed. Of long recordings parts are looked at.
///
/// # Errors
/// If the recording cannot be used.
pub fn doubt(machine: &Machine, recording: &Recording, angles_only: bool) -> Result<Option<Doubt>, TrimError> {
    let mut doubting = Doubting::begin(machine, recording, angles_only)?;
    while doubting.next(machine) {}
    Ok(doubting.doubt(machine))
}

/// The same under way.
pub struct Doubting {
    recording: Recording,
    angles_only: bool,
    rows: Rows,
    given: Tried,
    tolerances: Tolerances,
    /// Numbers that no machine has.
    broken: Vec<Unknown>,
    faults: Vec<Fault>,
    /// How many faults were tried.
    done: usize,
    likely: Vec<Likely>,
}

/// A fault that explains the measurement.
struct Likely {
    /// ln Λ.
    odds: f64,
    /// The same of what orders faults.
    ranks: f64,
    fault: Fault,
    tried: Tried,
}

impl Doubting {
    /// With the measurement as given, before any fault is tried.
    ///
    /// # Errors
    /// If the recording cannot be used.
    pub fn begin(machine: &Machine, recording: &Recording, angles_only: bool) -> Result<Self, TrimError> {
        recording.check(machine.drives())?;
        let recording = shortened(machine, recording);
        let rows = Rows::of(machine, &recording, angles_only)?;
        let given = tried(machine, &rows, leaves(machine, &recording))?;
        Ok(Self {
            tolerances: Tolerances::of(machine),
            broken: impossible(machine, &given.fit),
            faults: Fault::all(machine),
            done: 0,
            likely: Vec::new(),
            recording,
            angles_only,
            rows,
            given,
        })
    }

    /// How much is done, from 0 to 1.
    pub fn share(&self) -> f64 {
        self.done as f64 / self.faults.len().max(1) as f64
    }

    /// Tries the next fault; whether there was one.
    pub fn next(&mut self, machine: &Machine) -> bool {
        let Some(fault) = self.faults.get(self.done) else { return false };
        self.likely.extend(self.explained(machine, fault));
        self.done += 1;
        true
    }

    /// A fault with what speaks for it; none if the measurement is not explained by it.
    fn explained(&self, machine: &Machine, fault: &Fault) -> Option<Likely> {
        let Self { rows, given, .. } = self;
        let own = fault.angles.as_ref().map(|angles| angles.undo(&self.recording));
        let (mut heard, mut as_given, mut left) = (rows.clone(), None, given.leaves);
        if let Some(own) = &own {
            left = leaves(machine, own);
            let fresh = Rows::at_least(rows.half(), machine, own, self.angles_only).ok()?;
            // Residuals are compared over the same windows.
            if fresh.half() > rows.half() {
                let wide = Rows::at_least(fresh.half(), machine, &self.recording, self.angles_only);
                as_given = wide.and_then(|rows| tried(machine, &rows, given.leaves)).ok();
            }
            heard = fresh;
        }
        heard.hear(|force, moment| fault.undo(force, moment));
        let other = tried(machine, &heard, left).ok()?;
        let [decides, ranks] = odds(&self.tolerances, as_given.as_ref().unwrap_or(given), &other)?;
        // What is impossible as given is explained by what is not, however little else speaks for it.
        let explains = match self.broken.as_slice() {
            [] => decides > BELIEVED,
            _ => ranks > 0.0,
        };
        (explains && impossible(machine, &other.fit).is_empty()).then(|| Likely {
            odds: decides.max(ranks),
            ranks: ranks - MISTAKE * (fault.mistakes - 1) as f64,
            fault: fault.clone(),
            tried: other,
        })
    }

    /// What the faults that were tried come to; `None` where the measurement can be believed.
    pub fn doubt(mut self, machine: &Machine) -> Option<Doubt> {
        if self.likely.is_empty() && self.broken.is_empty() {
            return None;
        }
        self.likely.sort_by(|a, b| b.ranks.total_cmp(&a.ranks));
        let best = self.likely.first().map_or(0.0, |first| first.ranks);
        self.likely.retain(|one| one.ranks > best - NAMED);
        let Self { given: Tried { fit, .. }, broken, likely, .. } = &self;
        let said = |place: usize| Said {
            name: fit.unknowns.at(place).name(machine),
            unit: fit.unknowns.at(place).unit(),
            value: fit.measured[place],
            half_width: fit.half_width(place),
            file: fit.nominal[place],
        };
        let place = |unknown: &Unknown| (0..fit.unknowns.count()).find(|i| fit.unknowns.at(*i) == *unknown);
        let furthest = furthest(machine, &self.given, likely.first().map(|first| &first.tried));
        let causes = likely.iter().map(|Likely { odds, fault, tried, .. }| Cause {
            what: fault.what.clone(),
            want: fault.want.clone(),
            odds: odds / std::f64::consts::LN_10,
            noise: tried.fit.noise,
            shares: shares(&tried.fit),
            furthest: furthest.map(|place| tried.fit.measured[place]),
            leaves: tried.leaves,
        });
        let mut causes: Vec<Cause> = causes.collect();
        causes.dedup_by(|a, b| a.what == b.what && a.want == b.want);
        causes.truncate(MAX_NAMED);
        Some(Doubt {
            causes,
            impossible: broken.iter().filter_map(place).map(said).collect(),
            furthest: furthest.map(said),
            noise: fit.noise,
            shares: shares(fit),
            leaves: self.given.leaves,
        })
    }
}

/// The momentum that is furthest from the file as given, by what another fit makes of it, else by the file; or a first
/// moment or coupling of a machine that is not balanced, where that is further.
fn furthest(machine: &Machine, given: &Tried, other: Option<&Tried>) -> Option<usize> {
    let (fit, known) = (&given.fit, known(machine));
    let off = |i: &usize| {
        let better = other.map_or(fit.nominal[*i], |other| other.fit.measured[*i]);
        (fit.measured[*i] - better).abs() / fit.nominal[*i].abs().max(f64::MIN_POSITIVE)
    };
    let told = (0..fit.unknowns.count()).filter(|i| fit.told[*i] && known[*i]);
    // What is as in the file is no evidence.
    let told = told.filter(|i| off(i) > SAME);
    told.max_by(|a, b| off(a).total_cmp(&off(b)))
}

/// By how much relative angles leave their limits, whole turns aside, rad.
fn leaves(machine: &Machine, recording: &Recording) -> f64 {
    let mut most: f64 = 0.0;
    for angle in machine.angles() {
        let (low, high) = (*angle.limits.start(), *angle.limits.end());
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        if !half.is_finite() {
            continue;
        }
        for q in recording.motions.iter().flat_map(|motion| &motion.q) {
            let by = q[angle.to] - q[angle.from] + angle.offset - middle;
            let turns = std::f64::consts::TAU * (by / std::f64::consts::TAU).round();
            most = most.max((by - turns).abs() - half);
        }
    }
    most
}

/// A recording short enough to be fitted many times: of too long ones some motions, of these the first samples.
fn shortened(machine: &Machine, recording: &Recording) -> Recording {
    let unknowns = Unknowns::of(machine.drives()).count();
    let most = (MAX_WORK / unknowns.pow(2)).clamp(1_000, 20_000);
    let samples: usize = recording.motions.iter().map(|motion| motion.t.len()).sum();
    if samples <= most {
        return recording.clone();
    }
    let count = recording.motions.len().min(most / 250);
    let each = most / count;
    let cut = |motion: &Motion| {
        let rows = motion.t.len().min(each);
        let part = |all: &[_]| all.iter().copied().take(rows).collect();
        Motion {
            t: motion.t[..rows].to_vec(),
            q: part(&motion.q),
            qd: part(&motion.qd),
            qdd: part(&motion.qdd),
            force: motion.force[..rows].to_vec(),
            moment: motion.moment[..rows].to_vec(),
        }
    };
    let motions = (0..count).map(|i| cut(&recording.motions[i * recording.motions.len() / count])).collect();
    Recording { motions }
}

impl Rows {
    /// What was measured, as something else; lines over time stay taken out.
    fn hear(&mut self, as_what: impl Fn(Vector, f64) -> (Vector, f64)) {
        let [fx, fy, n] = &mut self.channels;
        for ((fx, fy), n) in fx.y.iter_mut().zip(&mut fy.y).zip(&mut n.y) {
            let (force, moment) = as_what(Vector::new(*fx, *fy), *n);
            (*fx, *fy, *n) = (force.re, force.im, moment);
        }
    }
}

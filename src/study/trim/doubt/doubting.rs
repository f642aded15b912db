//! [`DoubtSearch`]: the test of all faults, one after the other.

use super::fault::Fault;
use super::odds::{FitTrial, likelihood_ratio, shares, try_fit};
use super::possible::impossible_numbers;
use super::rejection::{Cause, Doubt, MeasuredValue};
use super::tolerances::{Tolerances, known_numbers};
use crate::trim::error::TrimError;
use crate::trim::recording::{MeasuredMotion, MeasurementSet};
use crate::trim::rows::Regressor;
use crate::trim::unknowns::{Unknown, Unknowns};
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::Vector;

/// Threshold of ln Λ above which a fault is accepted: odds of 10⁴.
const MIN_LOG_ODDS: f64 = 9.21;
/// Values with a smaller relative difference are treated as equal.
const EQUAL_BELOW: f64 = 1e-3;
/// Penalty on ln Λ for each further independent mistake that a fault consists of.
const LOG_ODDS_PER_MISTAKE: f64 = 2.3;
/// A fault is named if its ln Λ is at most this far below that of the best fault.
const MAX_LOG_ODDS_BEHIND: f64 = 6.9;
/// Maximum number of faults that are named.
const MAX_NAMED: usize = 5;
/// Maximum number of samples times the square of the number of unknowns, unless 1 000 samples already exceed it.
const MAX_WORK: usize = 4_000_000;

/// Tests a measurement for faults; `None` if it is plausible as given. Only parts of a long recording are tested.
///
/// # Errors
/// Fails if the recording cannot be used.
pub fn doubt(machine: &Machine, recording: &MeasurementSet, angles_only: bool) -> Result<Option<Doubt>, TrimError> {
    let mut doubting = DoubtSearch::begin(machine, recording, angles_only)?;
    while doubting.next(machine) {}
    Ok(doubting.doubt(machine))
}

/// A test for faults in progress.
pub struct DoubtSearch {
    recording: MeasurementSet,
    angles_only: bool,
    rows: Regressor,
    given: FitTrial,
    tolerances: Tolerances,
    /// Unknowns whose values, fitted to the measurement as given, no machine can have.
    infeasible: Vec<Unknown>,
    faults: Vec<Fault>,
    /// Number of faults tested.
    done: usize,
    likely: Vec<Likely>,
}

/// A fault that explains the measurement.
struct Likely {
    /// ln Λ of the fault.
    odds: f64,
    /// ln Λ by which faults are ordered.
    ranks: f64,
    fault: Fault,
    tried: FitTrial,
}

impl DoubtSearch {
    /// Fits the measurement as given, before any fault is tested.
    ///
    /// # Errors
    /// Fails if the recording cannot be used.
    pub fn begin(machine: &Machine, recording: &MeasurementSet, angles_only: bool) -> Result<Self, TrimError> {
        recording.check(machine.drives())?;
        let recording = shortened(machine, recording);
        let rows = Regressor::of(machine, &recording, angles_only)?;
        let given = try_fit(machine, &rows, limit_violation(machine, &recording))?;
        Ok(Self {
            tolerances: Tolerances::of(machine),
            infeasible: impossible_numbers(machine, &given.fit),
            faults: Fault::all(machine),
            done: 0,
            likely: Vec::new(),
            recording,
            angles_only,
            rows,
            given,
        })
    }

    /// Returns the fraction done, from 0 to 1.
    pub fn share(&self) -> f64 {
        self.done as f64 / self.faults.len().max(1) as f64
    }

    /// Tests the next fault; returns whether there was one.
    pub fn next(&mut self, machine: &Machine) -> bool {
        let Some(fault) = self.faults.get(self.done) else { return false };
        self.likely.extend(self.explained(machine, fault));
        self.done += 1;
        true
    }

    /// Returns a fault with its odds; `None` if it does not explain the measurement.
    fn explained(&self, machine: &Machine, fault: &Fault) -> Option<Likely> {
        let Self { rows, given, .. } = self;
        let own = fault.angles.as_ref().map(|angles| angles.undo(&self.recording));
        let (mut transformed, mut as_given, mut violation) = (rows.clone(), None, given.limit_violation);
        if let Some(own) = &own {
            violation = limit_violation(machine, own);
            let fresh = Regressor::at_least(rows.half(), machine, own, self.angles_only).ok()?;
            // Residuals must be compared for the same windows.
            if fresh.half() > rows.half() {
                let wide = Regressor::at_least(fresh.half(), machine, &self.recording, self.angles_only);
                as_given = wide.and_then(|rows| try_fit(machine, &rows, given.limit_violation)).ok();
            }
            transformed = fresh;
        }
        transformed.transform(|force, moment| fault.undo(force, moment));
        let other = try_fit(machine, &transformed, violation).ok()?;
        let [decides, ranks] = likelihood_ratio(&self.tolerances, as_given.as_ref().unwrap_or(given), &other)?;
        // If the values as given are impossible, any fault with possible values and a positive ranking ln Λ explains
        // them.
        let explains = match self.infeasible.as_slice() {
            [] => decides > MIN_LOG_ODDS,
            _ => ranks > 0.0,
        };
        (explains && impossible_numbers(machine, &other.fit).is_empty()).then(|| Likely {
            odds: decides.max(ranks),
            ranks: ranks - LOG_ODDS_PER_MISTAKE * (fault.mistakes - 1) as f64,
            fault: fault.clone(),
            tried: other,
        })
    }

    /// Returns the result of the faults tested; `None` if the measurement is plausible as given.
    pub fn doubt(mut self, machine: &Machine) -> Option<Doubt> {
        if self.likely.is_empty() && self.infeasible.is_empty() {
            return None;
        }
        self.likely.sort_by(|a, b| b.ranks.total_cmp(&a.ranks));
        let best = self.likely.first().map_or(0.0, |first| first.ranks);
        self.likely.retain(|one| one.ranks > best - MAX_LOG_ODDS_BEHIND);
        let Self { given: FitTrial { fit, .. }, infeasible, likely, .. } = &self;
        let measured_value = |place: usize| MeasuredValue {
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
            limit_violation: tried.limit_violation,
        });
        let mut causes: Vec<Cause> = causes.collect();
        causes.dedup_by(|a, b| a.what == b.what && a.want == b.want);
        causes.truncate(MAX_NAMED);
        Some(Doubt {
            causes,
            impossible: infeasible.iter().filter_map(place).map(measured_value).collect(),
            furthest: furthest.map(measured_value),
            noise: fit.noise,
            shares: shares(fit),
            limit_violation: self.given.limit_violation,
        })
    }
}

/// Returns the identifiable unknown with the largest relative deviation from the other fit, or from the file if there
/// is no other fit. Only momenta are compared, and first moments and couplings that are clearly not zero in the file.
fn furthest(machine: &Machine, given: &FitTrial, other: Option<&FitTrial>) -> Option<usize> {
    let (fit, known) = (&given.fit, known_numbers(machine));
    let off = |i: &usize| {
        let better = other.map_or(fit.nominal[*i], |other| other.fit.measured[*i]);
        (fit.measured[*i] - better).abs() / fit.nominal[*i].abs().max(f64::MIN_POSITIVE)
    };
    let candidates = (0..fit.unknowns.count()).filter(|i| fit.identifiable[*i] && known[*i]);
    // Values that agree with the other fit, or else with the file, are no evidence.
    let candidates = candidates.filter(|i| off(i) > EQUAL_BELOW);
    candidates.max_by(|a, b| off(a).total_cmp(&off(b)))
}

/// Returns the largest violation of the limits of relative angles, modulo whole turns, rad; 0 if there is none.
fn limit_violation(machine: &Machine, recording: &MeasurementSet) -> f64 {
    let mut most: f64 = 0.0;
    for angle in machine.angles() {
        let (low, high) = (*angle.limits.start(), *angle.limits.end());
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        if !half.is_finite() {
            continue;
        }
        for q in recording.motions.iter().flat_map(|motion| &motion.q) {
            let by = angle.value(q) - middle;
            let turns = std::f64::consts::TAU * (by / std::f64::consts::TAU).round();
            most = most.max((by - turns).abs() - half);
        }
    }
    most
}

/// Returns a recording short enough for many fits: a long one is reduced to the first samples of some of its motions.
fn shortened(machine: &Machine, recording: &MeasurementSet) -> MeasurementSet {
    let unknowns = Unknowns::of(machine.drives()).count();
    let most = (MAX_WORK / unknowns.pow(2)).clamp(1_000, 20_000);
    let samples: usize = recording.motions.iter().map(|motion| motion.t.len()).sum();
    if samples <= most {
        return recording.clone();
    }
    let count = recording.motions.len().min(most / 250);
    let each = most / count;
    let truncated = |motion: &MeasuredMotion| {
        let rows = motion.t.len().min(each);
        let part = |all: &[_]| all.iter().copied().take(rows).collect();
        MeasuredMotion {
            t: motion.t[..rows].to_vec(),
            q: part(&motion.q),
            qd: part(&motion.qd),
            qdd: part(&motion.qdd),
            force: motion.force[..rows].to_vec(),
            moment: motion.moment[..rows].to_vec(),
        }
    };
    let motions = (0..count).map(|i| truncated(&recording.motions[i * recording.motions.len() / count])).collect();
    MeasurementSet { motions }
}

impl Regressor {
    /// Transforms the measured force and moment. The straight line taken out of each motion stays out, because the
    /// transformation is linear.
    fn transform(&mut self, transformation: impl Fn(Vector, f64) -> (Vector, f64)) {
        let [fx, fy, n] = &mut self.channels;
        for ((fx, fy), n) in fx.y.iter_mut().zip(&mut fy.y).zip(&mut n.y) {
            let (force, moment) = transformation(Vector::new(*fx, *fy), *n);
            (*fx, *fy, *n) = (force.re, force.im, moment);
        }
    }
}

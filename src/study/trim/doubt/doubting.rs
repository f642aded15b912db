//! [`DoubtSearch`]: the test of all faults, one after the other.

use super::odds::{FitTrial, likelihood_ratio};
use super::plate::PlateMeasurement;
use super::possible::impossible_numbers;
use super::rejection::{Cause, Doubt, MeasuredValue};
use super::tolerances::{Tolerances, known_numbers};
use crate::trim::error::TrimError;
use crate::trim::recording::MeasurementSet;
use crate::trim::unknowns::Unknown;
use stillbase_mechanics::machine::Machine;

/// Threshold of ln Λ above which a fault is accepted: odds of 10⁴.
const MIN_LOG_ODDS: f64 = 9.21;
/// Values with a smaller relative difference are treated as equal.
const EQUAL_BELOW: f64 = 1e-3;
/// Penalty on ln Λ for each further independent mistake that a fault consists of.
const LOG_ODDS_PER_MISTAKE: f64 = 2.3;
/// A fault is named if its ln Λ is at most this far below that of the best fault.
const MAX_LOG_ODDS_BEHIND: f64 = 6.9;
/// Number of tolerances per unknown beyond which no built machine differs from its file.
const IMPLAUSIBLE: f64 = 100.0;
/// Maximum number of faults that are named.
const MAX_NAMED: usize = 5;

/// Tests a measurement for faults; `None` if it is plausible as given. Only parts of a long recording are tested.
///
/// # Errors
/// Fails if the recording cannot be used.
pub fn doubt(machine: &Machine, recording: &MeasurementSet, angles_only: bool) -> Result<Option<Doubt>, TrimError> {
    let mut doubting = PlateMeasurement::search(machine, recording, angles_only)?;
    while doubting.next(machine) {}
    Ok(doubting.doubt(machine))
}

/// A measurement that can be fitted without each of some faults.
pub(in crate::trim) trait Suspected {
    /// A fault, with its correction.
    type Fault;

    /// Returns the description of a fault.
    fn words(fault: &Self::Fault) -> &FaultWords;

    /// Fits the measurement without a fault. The second fit is that of the measurement as given with which it has to be
    /// compared, if this is another one than `given`.
    fn without(&self, machine: &Machine, given: &FitTrial, fault: &Self::Fault)
    -> Option<(FitTrial, Option<FitTrial>)>;
}

/// A fault in words.
#[derive(Clone, Debug)]
pub(in crate::trim) struct FaultWords {
    /// Description, as a sentence without its full stop.
    pub what: String,
    /// Remedy.
    pub want: String,
    /// Number of independent mistakes that the fault counts as; a wrong unit of force counts as three.
    pub mistakes: usize,
}

/// A test for faults in progress.
pub(in crate::trim) struct DoubtSearch<S: Suspected> {
    suspected: S,
    given: FitTrial,
    faults: Vec<S::Fault>,
    tolerances: Tolerances,
    /// Unknowns whose values, fitted to the measurement as given, no machine can have.
    infeasible: Vec<Unknown>,
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
    fault: FaultWords,
    tried: FitTrial,
}

impl<S: Suspected> DoubtSearch<S> {
    /// Begins a test of faults, before any is tested; `given` is the fit of the measurement as given.
    pub fn of(machine: &Machine, suspected: S, given: FitTrial, faults: Vec<S::Fault>) -> Self {
        Self {
            tolerances: Tolerances::of(machine),
            infeasible: impossible_numbers(machine, &given.numbers),
            done: 0,
            likely: Vec::new(),
            suspected,
            given,
            faults,
        }
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
    fn explained(&self, machine: &Machine, fault: &S::Fault) -> Option<Likely> {
        let (other, as_given) = self.suspected.without(machine, &self.given, fault)?;
        let fault = S::words(fault);
        let given = as_given.as_ref().unwrap_or(&self.given);
        let [decides, ranks] = likelihood_ratio(&self.tolerances, given, &other)?;
        if self.is_farther(&other) {
            return None;
        }
        // If the values as given are impossible, any fault with possible values and a positive ranking ln Λ explains
        // them.
        let explains = match self.infeasible.as_slice() {
            [] => decides > MIN_LOG_ODDS,
            _ => ranks > 0.0,
        };
        (explains && impossible_numbers(machine, &other.numbers).is_empty()).then(|| Likely {
            odds: decides.max(ranks),
            ranks: ranks - LOG_ODDS_PER_MISTAKE * (fault.mistakes - 1) as f64,
            fault: fault.clone(),
            tried: other,
        })
    }

    /// Returns whether a fit is so much farther from the machine's file than the measurement as given that it explains
    /// nothing, however small its residuals: one more number would explain as much.
    fn is_farther(&self, other: &FitTrial) -> bool {
        let distance = |fit: &FitTrial| self.tolerances.distance(&fit.numbers);
        let Some([was, now]) = distance(&self.given).zip(distance(other)).map(|(was, now)| [was, now]) else {
            return true;
        };
        now.all > was.all && now.all > IMPLAUSIBLE.powi(2) * now.numbers
    }

    /// Returns the result of the faults tested; `None` if the measurement is plausible as given.
    pub fn doubt(mut self, machine: &Machine) -> Option<Doubt> {
        if self.likely.is_empty() && self.infeasible.is_empty() {
            return None;
        }
        self.likely.sort_by(|a, b| b.ranks.total_cmp(&a.ranks));
        let best = self.likely.first().map_or(0.0, |first| first.ranks);
        self.likely.retain(|one| one.ranks > best - MAX_LOG_ODDS_BEHIND);
        let Self { infeasible, likely, given, .. } = &self;
        let numbers = &given.numbers;
        let measured_value = |place: usize| MeasuredValue {
            name: numbers.unknowns.at(place).name(machine),
            unit: numbers.unknowns.at(place).unit(),
            value: numbers.measured[place],
            half_width: numbers.half_width(place),
            file: numbers.nominal[place],
        };
        let place = |unknown: &Unknown| (0..numbers.unknowns.count()).find(|i| numbers.unknowns.at(*i) == *unknown);
        let furthest = furthest(machine, given, likely.first().map(|first| &first.tried));
        let causes = likely.iter().map(|Likely { odds, fault, tried, .. }| Cause {
            what: fault.what.clone(),
            want: fault.want.clone(),
            odds: odds / std::f64::consts::LN_10,
            residuals: tried.residuals(),
            furthest: furthest.map(|place| tried.numbers.measured[place]),
            limit_violation: tried.limit_violation,
        });
        let mut causes: Vec<Cause> = causes.collect();
        causes.dedup_by(|a, b| a.what == b.what && a.want == b.want);
        causes.truncate(MAX_NAMED);
        Some(Doubt {
            motion: None,
            causes,
            impossible: infeasible.iter().filter_map(place).map(measured_value).collect(),
            furthest: furthest.map(measured_value),
            residuals: given.residuals(),
            limit_violation: given.limit_violation,
        })
    }
}

/// Returns the identifiable unknown with the largest relative deviation from the other fit, or from the file if there
/// is no other fit. Only momenta are compared, and first moments and couplings that are clearly not zero in the file.
fn furthest(machine: &Machine, given: &FitTrial, other: Option<&FitTrial>) -> Option<usize> {
    let (numbers, known) = (&given.numbers, known_numbers(machine));
    let off = |i: &usize| {
        let better = other.map_or(numbers.nominal[*i], |other| other.numbers.measured[*i]);
        (numbers.measured[*i] - better).abs() / numbers.nominal[*i].abs().max(f64::MIN_POSITIVE)
    };
    let apart = |i: &usize| {
        (numbers.measured[*i] - other.map_or(numbers.nominal[*i], |other| other.numbers.measured[*i])).abs()
    };
    let candidates = (0..numbers.unknowns.count()).filter(|i| numbers.identifiable[*i] && known[*i]);
    // Values that agree with the other fit, or else with the file, are no evidence.
    let candidates = candidates.filter(|i| off(i) > EQUAL_BELOW && apart(i) > numbers.half_width(*i));
    candidates.max_by(|a, b| off(a).total_cmp(&off(b)))
}

//! [`TrimReport`]: report on a measurement.

use schemars::JsonSchema;
use serde::Serialize;

use super::adopted_parameters::AdoptedParameters;
use super::correction_benefit::CorrectionBenefit;
use super::fit::Fit;
use super::machine_correction::{MachineCorrection, ParameterChange};
use super::next_excitation::{Excitation, NextMeasurement};
use super::rows::{Regressor, RegressorSource};
use super::unknowns::Unknowns;
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::Vector;
use stillbase_settings::number::{fixed, fixed_or_scientific};

/// Identified values of a machine, their correction, and the next measurement.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct TrimReport {
    /// Name of the machine.
    pub machine: String,
    /// Number of measured motions.
    pub motions: usize,
    /// Number of rows.
    pub rows: usize,
    /// Origin of the rows: `samples` with measured accelerations, or `windows`.
    pub made_of: &'static str,
    /// Half width of a window, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window: Option<f64>,
    /// Root mean square of force, N, and moment, N m, without offset and drift.
    pub size: [f64; 2],
    /// Standard deviation σ of the residuals of force, N, and moment, N m.
    pub noise: [f64; 2],
    /// Effective number of independent rows of force and of moment.
    pub effective_rows: [f64; 2],
    /// Values of every line of (7) and (8), and of the momenta.
    pub numbers: Vec<Number>,
    /// Groups of unknowns that are only identifiable in combination.
    #[serde(rename = "untold")]
    pub unidentifiable: Vec<Vec<String>>,
    /// Proposed changes.
    pub changes: Vec<ParameterChange>,
    /// Effect of the change over these motions, even if it is not significant and therefore not proposed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub worth: Option<TrimImprovement>,
    /// Proposal for the next measurement.
    pub next: Suggestion,
}

/// Effect of a change, and whether it is significant.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct TrimImprovement {
    /// Effect of the change.
    #[serde(flatten)]
    pub worth: CorrectionBenefit,
    /// Whether the 95 % interval of the gain lies above 0.
    pub helps: bool,
}

/// An unknown as it was measured.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct MeasuredUnknown {
    /// Name of the unknown.
    pub name: String,
    /// Unit of the value.
    pub unit: &'static str,
    /// Value in the machine's file.
    pub nominal: f64,
    /// Whether the unknown is identifiable from the data.
    #[serde(rename = "told")]
    pub identifiable: bool,
    /// Measured value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured: Option<f64>,
    /// Half width of the 95 % interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub half_width: Option<f64>,
    /// Change of the value if what is taken as known is 1 % off; only in orbit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub per_percent: Option<f64>,
    /// Whether the unknown differs significantly from the machine's file. Measured by forces, the values used for the others
    /// are given; measured in orbit, the file's value lies outside of the interval.
    pub off: bool,
}

/// An unknown of (7) and (8), or a momentum.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Number {
    /// What was measured.
    #[serde(flatten)]
    pub unknown: MeasuredUnknown,
    /// Value used: estimated with the values from the file held fixed; for (7) and (8) that of the file unless `off`.
    pub taken: f64,
    /// Half width of the 95 % interval of that value; 0 if it is from the file.
    pub taken_half_width: f64,
    /// Residual after the change.
    #[serde(rename = "left", skip_serializing_if = "Option::is_none")]
    pub residual: Option<f64>,
    /// Whether the unknown belongs to (7) or (8).
    #[serde(skip)]
    pub balance: bool,
}

/// Proposal for the next measurement.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Suggestion {
    /// Name of the least known unknown.
    pub worst: String,
    /// Present half width of its 95 % interval; `None` if it is not identifiable.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub half_width: Option<f64>,
    /// Unit of the value.
    pub unit: &'static str,
    /// Duration of each motion, s.
    pub duration: f64,
    /// Factor on the accelerations that were measured, without which none of these motions would tell the unknown.
    pub faster: f64,
    /// Motions, the best first.
    pub candidates: Vec<ExcitationReport>,
}

/// Half widths below this are rounding errors.
const KNOWN_BELOW: f64 = 1e-12;

impl Suggestion {
    /// Returns a proposal with the names of the machine.
    pub(super) fn of(machine: &Machine, unknowns: &Unknowns, next: &NextMeasurement) -> Self {
        let worst = unknowns.at(next.least_known);
        let tried = |candidate: &Excitation| ExcitationReport {
            motion: candidate.words(machine),
            candidate: candidate.clone(),
        };
        Self {
            worst: worst.name(machine),
            half_width: Some(next.half_width).filter(|half| half.is_finite()),
            unit: worst.unit(),
            duration: next.duration,
            faster: next.faster,
            candidates: next.candidates.iter().map(tried).collect(),
        }
    }

    /// Returns in words the least known unknown and the effect of the best motion; `None` if there are no candidates, or if
    /// all is known to rounding.
    pub fn words(&self) -> Option<String> {
        let best = self.candidates.first().filter(|_| self.half_width.is_none_or(|half| half > KNOWN_BELOW))?;
        let now = match self.half_width {
            Some(half) => format!("Least known is {}, ± {} {}", self.worst, fixed_or_scientific(half, 6), self.unit),
            None => format!("Nothing is known of {} yet", self.worst),
        };
        let then = match best.candidate.half_width {
            half if half.is_finite() => format!("would make that ± {} {}", fixed_or_scientific(half, 6), self.unit),
            _ => "would not identify it either".into(),
        };
        let faster = match self.faster > 1.0 {
            true => format!(", accelerated {:.0} times as strongly as these motions,", self.faster),
            false => String::new(),
        };
        Some(format!("{now}; {} s of {}{faster} {then}.", fixed(self.duration, 2), best.motion))
    }
}

/// A motion to measure next.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct ExcitationReport {
    /// Description in words.
    pub motion: String,
    /// Parameters of the motion and its predicted effect.
    #[serde(flatten)]
    pub candidate: Excitation,
}

/// Returns a sentence for each group of unknowns that is not identifiable.
pub(super) fn untold_words(groups: &[Vec<String>]) -> impl Iterator<Item = String> {
    groups.iter().map(|group| match group.as_slice() {
        [one] => format!("The data say nothing of {one}: it is taken from the machine's file."),
        several => {
            format!("The data cannot tell {} apart: they are taken from the machine's file.", several.join(", "))
        }
    })
}

impl TrimReport {
    /// Iterates over the numbers that change.
    pub fn changed(&self) -> impl Iterator<Item = &ParameterChange> {
        self.changes.iter().filter(|change| change.to != change.from)
    }

    /// Returns in words the reason that nothing changes; meaningful only if nothing changes.
    pub fn why_no_change(&self) -> String {
        let off = self.numbers.iter().any(|number| number.balance && number.unknown.off);
        match self.worth.filter(|_| off) {
            Some(gain) => {
                let worth = gain.worth.words();
                format!("No change is shown to help. Over these motions the correction found would lower {worth}.")
            }
            None => "Nothing to change: no line of (7) and (8) that can be corrected is significantly off.".into(),
        }
    }

    /// Returns a sentence for each group of unknowns that is not identifiable.
    pub fn untold_words(&self) -> impl Iterator<Item = String> {
        untold_words(&self.unidentifiable)
    }

    /// Builds the report from the fit, and from the correction and its effect, if there is one.
    pub(super) fn of(
        machine: &Machine,
        rows: &Regressor,
        fit: &Fit,
        taken: &AdoptedParameters,
        mended: Option<&MachineCorrection>,
        worth: Option<CorrectionBenefit>,
        next: &NextMeasurement,
    ) -> Self {
        let unknowns = &fit.numbers.unknowns;
        let number = |i: usize| {
            let what = unknowns.at(i);
            let identifiable = fit.numbers.identifiable[i];
            let part = |left: &Vector| if i.is_multiple_of(2) { left.re } else { left.im };
            let balance = i < unknowns.of_balance();
            Number {
                unknown: MeasuredUnknown {
                    name: what.name(machine),
                    unit: what.unit(),
                    nominal: fit.numbers.nominal[i] + 0.0,
                    identifiable,
                    measured: identifiable.then_some(fit.numbers.measured[i] + 0.0),
                    half_width: identifiable.then_some(fit.numbers.half_width(i)),
                    per_percent: None,
                    off: taken.differs[i],
                },
                taken: taken.values[i] + 0.0,
                taken_half_width: taken.half_widths[i],
                residual: mended.filter(|_| balance).and_then(|m| m.residuals.get(i / 2)).map(|left| part(left) + 0.0),
                balance,
            }
        };
        let name = |i: &usize| unknowns.at(*i).name(machine);
        Self {
            machine: machine.name().to_owned(),
            motions: rows.motions.len(),
            rows: rows.count(),
            made_of: if rows.source == RegressorSource::Samples { "samples" } else { "windows" },
            window: if let RegressorSource::Windows { half, .. } = rows.source { Some(half) } else { None },
            size: fit.size,
            noise: fit.noise,
            effective_rows: fit.effective,
            numbers: (0..unknowns.count()).map(number).collect(),
            unidentifiable: fit.confounded.iter().map(|group| group.iter().map(name).collect()).collect(),
            changes: mended.map_or_else(Vec::new, |mended| mended.changes.clone()),
            worth: worth.map(|worth| TrimImprovement { worth, helps: worth.helps() }),
            next: Suggestion::of(machine, unknowns, next),
        }
    }
}

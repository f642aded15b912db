//! [`OrbitReport`]: what motions in orbit tell about a machine.

use nalgebra::DVector;
use schemars::JsonSchema;
use serde::Serialize;

use super::fault::column_names;
use super::fit::{MAX_DEVIATION, OrbitFit};
use super::known::{Explained, KnownValue, one_percent_off};
use super::motion::{BASE_RATE, OrbitBase, OrbitMotion};
use crate::trim::doubt::{Doubt, OtherZero, Residual, other_zero};
use crate::trim::next_excitation::{DriveLimits, NextMeasurement, Sines, next_motion};
use crate::trim::report::{MeasuredUnknown, Suggestion, untold_words};
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::PerDrive;
use stillbase_settings::number::fixed_or_scientific;

/// The file explains the rates if all unknowns leave less than this fraction less of them unexplained.
const EXPLAINED: f64 = 0.5;
/// One known value explains the rates if it leaves at most this fraction of what the file leaves, however small the noise.
const NEARLY_ALL: f64 = 1e-3;
/// Residuals whose neighbours are correlated more strongly than this vary slowly, unlike noise.
const SLOW: f64 = 0.9;
/// Slow residuals above this fraction of the base rate refuse a measurement.
const UNEXPLAINED: f64 = 0.01;
/// Residuals below this fraction of the base rate count for nothing.
const NEGLIGIBLE: f64 = 1e-4;
/// Angles that vary by less than this do not move, rad.
const STILL_RAD: f64 = 1e-3;

/// First moments, couplings and momenta of a machine in orbit, from momentum alone.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct OrbitReport {
    /// Name of the machine.
    pub machine: String,
    /// Number of measured motions.
    pub motions: usize,
    /// Number of rows.
    pub rows: usize,
    /// Standard deviation of the base rate that is not explained, rad/s.
    pub rate_noise: f64,
    /// Root mean square of the base rate that the machine's file does not explain, rad/s.
    pub rate_off: f64,
    /// Root mean square of the base rate, rad/s.
    #[serde(skip)]
    rate_size: f64,
    /// Whether what is not explained varies slowly, unlike noise.
    pub residual_is_slow: bool,
    /// Known values one of which alone explains the rates as well as all numbers together.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub known: Vec<KnownValue>,
    /// A zero of the angles with which fewer unknowns differ from the machine's file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zero: Option<OtherZero>,
    /// Why not all is told, if a cause is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub advice: Option<String>,
    /// Values of every line of (7) and (8), and of the momenta.
    pub numbers: Vec<MeasuredUnknown>,
    /// Groups of unknowns that are only identifiable in combination.
    #[serde(rename = "untold")]
    pub unidentifiable: Vec<Vec<String>>,
    /// Proposal for the next measurement.
    pub next: Suggestion,
}

impl OrbitReport {
    /// Builds the report from a fit.
    pub(super) fn of(machine: &Machine, base: &OrbitBase, motions: &[OrbitMotion], fit: &OrbitFit) -> Self {
        let OrbitFit { numbers, errors, noise: rate_noise, off: rate_off, .. } = fit;
        let (p, rows) = (numbers.unknowns.count(), errors.len());
        // How far each number moves with each known value.
        let shifts: Vec<DVector<f64>> =
            one_percent_off(machine, base).iter().map(|craft| fit.shift(craft, motions)).collect();
        let rounding = numbers.unknowns.rounding(&Inertia::of(machine));
        let number = |i: usize| {
            let (what, half, is_told) = (numbers.unknowns.at(i), numbers.half_width(i), numbers.identifiable[i]);
            let (measured, nominal) = (numbers.measured[i], numbers.nominal[i]);
            MeasuredUnknown {
                name: what.name(machine),
                unit: what.unit(),
                nominal: nominal + 0.0,
                identifiable: is_told,
                measured: is_told.then_some(measured + 0.0),
                half_width: is_told.then_some(half),
                per_percent: is_told.then(|| shifts.iter().map(|shift| shift[i].powi(2)).sum::<f64>().sqrt()),
                off: is_told && (measured - nominal).abs() > half + rounding[i],
            }
        };
        let name = |i: &usize| numbers.unknowns.at(*i).name(machine);
        // As much as the unknowns explain of noise alone, and some more.
        let chance = 1.0 + 3.0 * (p * fit.lags) as f64 / rows as f64;
        let known = match *rate_noise < (1.0 - EXPLAINED) * rate_off {
            true => {
                let most = (rate_noise * chance.sqrt()).max(NEARLY_ALL * rate_off);
                Explained::of(machine, base, motions).by_one_value(most)
            }
            false => Vec::new(),
        };
        let is_told = !numbers.identifiable.contains(&false);
        Self {
            machine: machine.name().to_owned(),
            motions: motions.len(),
            rows,
            rate_noise: *rate_noise,
            rate_off: *rate_off,
            rate_size: fit.size,
            residual_is_slow: *rate_noise > NEGLIGIBLE * fit.size
                && fit.slow_noise().powi(2) > SLOW * rate_noise.powi(2),
            known,
            zero: other_zero(machine, numbers, &column_names(machine)),
            advice: if is_told { None } else { advice(machine, base, motions) },
            numbers: (0..p).map(number).collect(),
            unidentifiable: fit.confounded.iter().map(|group| group.iter().map(name).collect()).collect(),
            next: Suggestion::of(machine, &numbers.unknowns, &next(machine, motions, fit)),
        }
    }

    /// Returns the doubt of rates that the model leaves unexplained beyond noise; `None` if it leaves little.
    pub(super) fn unexplained(&self) -> Option<Doubt> {
        let share = self.rate_noise / self.rate_size.max(f64::MIN_POSITIVE);
        let left = Residual { unit: format!("rad/s of {BASE_RATE}"), noise: self.rate_noise, share };
        (self.residual_is_slow && share > UNEXPLAINED).then(|| Doubt {
            motion: None,
            causes: Vec::new(),
            impossible: Vec::new(),
            furthest: None,
            residuals: vec![left],
            limit_violation: 0.0,
        })
    }

    /// What is taken as known, and what the intervals are of.
    pub const KNOWN_WORDS: &str = "Known are mass and inertia of the base and the wheel, and the mass of the arm; \
                                   ± 95 % is of noise alone.";

    /// Returns in words how much of the base rate is not explained.
    pub fn rate_words(&self) -> String {
        let [off, noise] = [self.rate_off, self.rate_noise].map(|rate| fixed_or_scientific(rate, 4));
        format!("base rate not explained: by the machine's file {off} rad/s rms, by what was measured {noise} rad/s")
    }

    /// Returns sentences about what makes the intervals doubtful.
    pub fn doubts(&self) -> Vec<String> {
        let mut words = Vec::new();
        if self.rate_noise > self.rate_off {
            words.push(
                "The fit explains these rates worse than the machine's file does: the columns do not belong together. Check \
                 that angles and rates of drives and base count from the same axis with the same sign, and are in rad."
                    .into(),
            );
        }
        if let [first, others @ ..] = &self.known[..] {
            let value = |known: &KnownValue| {
                let [file, explains] = [known.file, known.explains].map(|x| fixed_or_scientific(x, 5));
                format!("{} = {explains} {} instead of {file}", known.key, known.unit)
            };
            let others = others.iter().map(|known| format!(", or {}", value(known))).collect::<String>();
            words.push(format!(
                "One known value alone explains these rates as well as the whole table: {}{others}. \
                 Then the intervals do not hold: weigh the parts, and check masses and the inertia of the base first.",
                value(first)
            ));
        }
        if let Some(OtherZero { what, want, off_given, off_then }) = &self.zero {
            words.push(format!(
                "If {what}, {off_then} numbers differ from the file instead of {off_given}: want {want}. Momentum does not tell \
                 zeros of angles, so check them first."
            ));
        }
        if self.residual_is_slow {
            words.push(
                "What is not explained varies slowly, unlike noise: the model does not explain the rates, and the \
                 intervals do not hold. Check masses, inertia of base and wheel, that no thruster is on, and that all angles \
                 and rates count from the same axis, with the same sign."
                    .into(),
            );
        }
        words
    }

    /// Returns a sentence for each group of unknowns that is not identifiable.
    pub fn untold_words(&self) -> impl Iterator<Item = String> {
        untold_words(&self.unidentifiable)
    }
}

/// Returns the motion that would tell most of what is least known.
fn next(machine: &Machine, motions: &[OrbitMotion], fit: &OrbitFit) -> NextMeasurement {
    let n = machine.drives();
    let largest =
        |k: usize| motions.iter().flat_map(|motion| &motion.rates).fold(0.0_f64, |most, r| most.max(r[k].abs()));
    let fastest: Vec<f64> = (0..n).map(largest).collect();
    let samples = || motions.iter().flat_map(|motion| &motion.angles);
    let limits = DriveLimits::of(n, samples, |k| varies(motions, |q| q[k]), |k, reach| fastest[k].powi(2) / reach);
    let total = motions.iter().map(OrbitMotion::duration).sum::<f64>();
    let duration = total / motions.len() as f64;
    // A second tells as much as one of those that were measured: variance times the time of an independent row.
    let density = fit.noise.powi(2) * total / fit.effective;
    let more = |sines: &Sines| {
        let motion = OrbitMotion::swung(sines, duration);
        fit.information(&motion, density * motion.rows() as f64 / duration)
    };
    NextMeasurement::telling(&limits, |limits| {
        next_motion(machine, &fit.numbers, limits, duration, MAX_DEVIATION, more)
    })
}

/// Returns whether a function of the angles, rad, varies within one of the motions.
fn varies(motions: &[OrbitMotion], of: impl Fn(&PerDrive) -> f64) -> bool {
    motions.iter().any(|motion| {
        let each = || motion.angles.iter().map(&of);
        each().fold(f64::NEG_INFINITY, f64::max) - each().fold(f64::INFINITY, f64::min) > STILL_RAD
    })
}

/// Returns in words why motions do not tell all unknowns, if a cause is known.
fn advice(machine: &Machine, base: &OrbitBase, motions: &[OrbitMotion]) -> Option<String> {
    let n = machine.drives();
    let name = |k: usize| machine.spec().drives[k].name.as_str();
    let still: Vec<&str> = (0..n).filter(|k| !varies(motions, |q| q[*k])).map(name).collect();
    if !still.is_empty() {
        return Some(format!("{} did not move: want motions in which every drive moves.", still.join(", ")));
    }
    let pairs = (0..n).flat_map(|k| (k + 1..n).map(move |l| (k, l)));
    let together: Vec<String> = pairs
        .filter(|(k, l)| !varies(motions, |q| q[*l] - q[*k]))
        .map(|(k, l)| format!("{} and {}", name(k), name(l)))
        .collect();
    if !together.is_empty() {
        let pairs = together.join(", ");
        return Some(format!("Turned as one: {pairs}. Want motions in which they turn apart."));
    }
    (base.body.com.norm() < 1e-9)
        .then(|| "With its centre of mass at the base pin, the base tells no first moments apart.".into())
}

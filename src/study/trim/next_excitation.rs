//! [`next_excitation`]: finds the motion that would add most information on the least known unknown.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use schemars::JsonSchema;
use serde::Serialize;

use super::fit::{Fit, IdentifiedNumbers};
use super::recording::{MeasuredMotion, MeasurementSet};
use super::rows::{LinearTrend, Regressor};
use super::unknowns::Unknowns;
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::{DriveAngles, PerDrive};

/// A motion to measure next: each drive moves as a sine about the middle of its measured range.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Excitation {
    /// Indices of the drives that move, and their senses, ±1.
    #[serde(skip)]
    pub drives: Vec<(usize, f64)>,
    /// Amplitude of each drive in `drives`, rad, in the same order.
    pub amplitude: Vec<f64>,
    /// Frequency of each drive in `drives`, Hz; drives that move in step or against each other share a frequency.
    pub frequency: Vec<f64>,
    /// Predicted half width of the interval of the least known unknown; infinite if it is still not identifiable.
    #[serde(skip_serializing_if = "is_infinite")]
    pub half_width: f64,
    /// Factor by which the intervals of all unknowns of (7) and (8) become narrower, geometric mean.
    #[serde(rename = "narrower")]
    pub all: f64,
}

fn is_infinite(x: &f64) -> bool {
    !x.is_finite()
}

impl Excitation {
    /// Describes the motion in words, with the names of the drives.
    pub fn words(&self, machine: &Machine) -> String {
        let names: Vec<&str> = self.drives.iter().map(|(k, _)| machine.spec().drives[*k].name.as_str()).collect();
        let own_frequencies = self.frequency.windows(2).any(|w| w[0] != w[1]);
        let [rest @ .., last] = names.as_slice() else { return String::new() };
        let all = if rest.is_empty() { (*last).to_owned() } else { format!("{} and {last}", rest.join(", ")) };
        match self.drives.as_slice() {
            [_] => format!("drive {all} alone"),
            _ if own_frequencies => format!("drives {all}, each at its own frequency"),
            both if both.iter().any(|(_, sign)| *sign < 0.0) => format!("drives {all} against each other"),
            _ => format!("drives {all} in step"),
        }
    }
}

/// Proposal for the next measurement.
#[derive(Clone, Debug, PartialEq)]
pub struct NextMeasurement {
    /// Index of the least known unknown of (7) or (8).
    pub least_known: usize,
    /// Present half width of its interval; infinite if it is not identifiable.
    pub half_width: f64,
    /// Duration of each candidate, s.
    pub duration: f64,
    /// Candidates, the best first.
    pub candidates: Vec<Excitation>,
    /// Factor on the accelerations that were measured, without which no candidate would tell the least known unknown.
    pub faster: f64,
}

/// Number of instants at which a candidate is evaluated.
const INSTANTS: usize = 160;
/// Maximum number of iterations of the eigenvalue solver.
const MAX_ITERATIONS: usize = 10_000;
/// Amplitude for drives that did not move, rad; limited to the largest measured amplitude.
const DEFAULT_AMPLITUDE_RAD: f64 = 0.5;
/// Acceleration if none was measured, rad/s².
const DEFAULT_ACCELERATION: f64 = 5.0;

/// Assesses motions on a force plate: each drive alone, every pair in step and against each other, all drives in step, and
/// all at different frequencies. Amplitudes are those measured; accelerations are the largest measured, unless they are given,
/// rad/s². The uncertainty after each is predicted from the information that its rows add at the identified noise.
pub fn next_excitation(
    machine: &Machine,
    recording: &MeasurementSet,
    rows: &Regressor,
    fit: &Fit,
    accelerations: Option<&[f64]>,
) -> NextMeasurement {
    let motions = &recording.motions;
    let samples = || motions.iter().flat_map(|motion| &motion.q);
    let limits = DriveLimits::of(machine.drives(), samples, |k| rows.moves[k], |k, _| rows.fastest[k])
        .with_accelerations(accelerations);
    let duration = motions.iter().map(MeasuredMotion::duration).sum::<f64>() / motions.len() as f64;
    let more = |sines: &Sines| sines.information(machine, &rows.unknowns, duration, fit);
    next_motion(machine, &fit.numbers, &limits, duration, f64::INFINITY, more)
}

/// Assesses candidates: each drive alone, every pair in step and against each other, all drives in step, and all at
/// different frequencies, within `limits` and for `duration`, s. The uncertainty after each candidate is predicted from
/// the `information` that it adds. An unknown is told if its standard deviation is below the fraction `told` of its scale.
pub(super) fn next_motion(
    machine: &Machine,
    numbers: &IdentifiedNumbers,
    limits: &DriveLimits,
    duration: f64,
    told: f64,
    information: impl Fn(&Sines) -> DMatrix<f64>,
) -> NextMeasurement {
    let scales = numbers.unknowns.scales(&Inertia::of(machine));
    let balance = numbers.unknowns.of_balance();
    let size = |i: usize| if numbers.identifiable[i] { numbers.half_width(i) / scales[i] } else { f64::INFINITY };
    let least_known = (0..balance).max_by(|a, b| size(*a).total_cmp(&size(*b))).unwrap_or_default();
    let half_width = if numbers.identifiable[least_known] { numbers.half_width(least_known) } else { f64::INFINITY };
    let now = Known::of(&numbers.information, &scales);
    let assessed = |drives: Vec<(usize, f64)>, own_frequencies: bool| {
        let motion = limits.motion(machine, &drives, own_frequencies);
        let then = Known::of(&(&numbers.information + information(&motion)), &scales);
        let after = then.variance(least_known).filter(|after| after.sqrt() < told);
        let half_width = match (numbers.identifiable[least_known], after) {
            (_, None) => f64::INFINITY,
            (true, Some(after)) => half_width * now.variance(least_known).map_or(1.0, |now| (after / now).sqrt()),
            (false, Some(after)) => numbers.critical * after.sqrt() * scales[least_known],
        };
        let all = (0.5 * (then.log_volume(balance) - now.log_volume(balance)) / balance as f64).exp();
        let amplitude = drives.iter().map(|(k, _)| motion.amplitude[*k]).collect();
        let frequency = drives.iter().map(|(k, _)| motion.rate[*k] / std::f64::consts::TAU).collect();
        Excitation { drives, amplitude, frequency, half_width, all: 1.0 / all.max(f64::MIN_POSITIVE) }
    };
    let n = machine.drives();
    let mut candidates: Vec<Excitation> = (0..n).map(|k| assessed(vec![(k, 1.0)], false)).collect();
    for (k, l) in Inertia::pairs(n) {
        candidates.push(assessed(vec![(k, 1.0), (l, 1.0)], false));
        candidates.push(assessed(vec![(k, 1.0), (l, -1.0)], false));
    }
    let every = || (0..n).map(|k| (k, 1.0)).collect::<Vec<_>>();
    if n > 2 {
        candidates.push(assessed(every(), false));
    }
    if n > 1 {
        candidates.push(assessed(every(), true));
    }
    candidates.sort_by(|a, b| a.half_width.total_cmp(&b.half_width));
    NextMeasurement { least_known, half_width, duration, candidates, faster: 1.0 }
}

/// Largest factor by which a proposed motion is faster than those that were measured.
const MAX_FASTER: f64 = 64.0;

impl NextMeasurement {
    /// Returns the proposal of `propose` for drives that accelerate as strongly as they did, or, where no such motion tells
    /// the least known unknown, for the smallest power of two times as strongly.
    pub(super) fn telling(limits: &DriveLimits, propose: impl Fn(&DriveLimits) -> Self) -> Self {
        let mut faster = 1.0;
        loop {
            let next = Self { faster, ..propose(&limits.faster(faster)) };
            if next.candidates.first().is_none_or(|best| best.half_width.is_finite()) {
                return next;
            }
            faster *= 2.0;
            if faster > MAX_FASTER {
                return propose(limits);
            }
        }
    }
}

/// Ranges and accelerations of the drives.
pub(super) struct DriveLimits {
    middle: Vec<f64>,
    reach: Vec<f64>,
    acceleration: Vec<f64>,
}

impl DriveLimits {
    /// Returns the ranges over which the drives moved in `samples`, rad. `moves` returns whether a drive moved.
    /// `fastest` returns the acceleration of a drive, rad/s², that moved by an amplitude, rad.
    pub fn of<'a, I: Iterator<Item = &'a PerDrive>>(
        n: usize,
        samples: impl Fn() -> I,
        moves: impl Fn(usize) -> bool,
        fastest: impl Fn(usize, f64) -> f64,
    ) -> Self {
        let ends = |k: usize| {
            let start = [f64::INFINITY, f64::NEG_INFINITY];
            samples().fold(start, |[low, high], q| [low.min(q[k]), high.max(q[k])])
        };
        let ends: Vec<[f64; 2]> = (0..n).map(ends).collect();
        let half = |k: usize| 0.5 * (ends[k][1] - ends[k][0]);
        let widest = (0..n).filter(|k| moves(*k)).map(half).fold(0.0, f64::max);
        let reach = |k: usize| if moves(k) { half(k) } else { widest.min(DEFAULT_AMPLITUDE_RAD) };
        let reach: Vec<f64> = (0..n).map(|k| reach(k).max(1e-6)).collect();
        let seen = |k: usize| fastest(k, reach[k]);
        let most = (0..n).filter(|k| moves(*k)).map(seen).fold(0.0, f64::max);
        let usual = if most > 0.0 { most } else { DEFAULT_ACCELERATION };
        let own = |k: usize| if moves(k) && seen(k) > 0.0 { seen(k) } else { usual };
        Self {
            middle: ends.iter().map(|[low, high]| 0.5 * (low + high)).collect(),
            acceleration: (0..n).map(own).collect(),
            reach,
        }
    }

    /// Returns these limits with accelerations that are given, rad/s².
    pub fn with_accelerations(self, given: Option<&[f64]>) -> Self {
        let own = |(k, usual): (usize, &f64)| given.and_then(|all| all.get(k)).copied().unwrap_or(*usual);
        Self { acceleration: self.acceleration.iter().enumerate().map(own).collect(), ..self }
    }

    /// Returns these limits with accelerations larger by a factor.
    fn faster(&self, factor: f64) -> Self {
        let acceleration = self.acceleration.iter().map(|own| factor * own).collect();
        Self { middle: self.middle.clone(), reach: self.reach.clone(), acceleration }
    }

    /// Returns sines of some drives with the amplitudes `reach`, reduced as far as the joint limits require.
    fn motion(&self, machine: &Machine, drives: &[(usize, f64)], own_frequencies: bool) -> Sines {
        let n = machine.drives();
        let signs: Vec<f64> =
            (0..n).map(|k| drives.iter().find(|(own, _)| *own == k).map_or(0.0, |(_, sign)| *sign)).collect();
        let mut scale = 1.0;
        let mut sines = self.sines(&signs, own_frequencies, scale);
        while scale > 0.02 && !sines.keeps_limits(machine) {
            scale *= 0.8;
            sines = self.sines(&signs, own_frequencies, scale);
        }
        sines
    }

    fn sines(&self, signs: &[f64], own_frequencies: bool, scale: f64) -> Sines {
        let moving = || (0..signs.len()).filter(|k| signs[*k] != 0.0);
        let amplitude: Vec<f64> = (0..signs.len()).map(|k| scale * self.reach[k]).collect();
        let own = |k: usize| (self.acceleration[k] / amplitude[k]).sqrt();
        // In step, the drives move at the frequency of the slowest.
        let slowest = moving().map(own).fold(f64::INFINITY, f64::min);
        let rate = |k: usize| if own_frequencies { own(k) * (1.0 - 0.13 * k as f64) } else { slowest };
        Sines {
            middle: self.middle.clone(),
            rate: (0..signs.len()).map(rate).collect(),
            signed: amplitude.iter().zip(signs).map(|(a, sign)| a * sign).collect(),
            amplitude,
        }
    }
}

/// Drives that swing about the middle of their ranges.
pub(super) struct Sines {
    middle: Vec<f64>,
    amplitude: Vec<f64>,
    signed: Vec<f64>,
    rate: Vec<f64>,
}

impl Sines {
    /// Returns the instants of a motion of a duration, s, at which it is evaluated.
    pub fn instants(duration: f64) -> impl Iterator<Item = f64> {
        (0..INSTANTS).map(move |i| duration * (i as f64 + 0.5) / INSTANTS as f64)
    }

    /// Returns angles, rates and accelerations at a time, s.
    pub fn at(&self, t: f64) -> [PerDrive; 3] {
        let n = self.middle.len();
        let each = |f: &dyn Fn(usize) -> f64| PerDrive::from_fn(n, f);
        [
            each(&|k| self.middle[k] + self.signed[k] * (self.rate[k] * t).sin()),
            each(&|k| self.signed[k] * self.rate[k] * (self.rate[k] * t).cos()),
            each(&|k| -self.signed[k] * self.rate[k].powi(2) * (self.rate[k] * t).sin()),
        ]
    }

    fn keeps_limits(&self, machine: &Machine) -> bool {
        machine.angles().iter().all(|angle| {
            let middle = angle.value(&self.middle);
            let together = self.rate[angle.to] == self.rate[angle.from];
            let (to, from) = (self.signed[angle.to], self.signed[angle.from]);
            let most = if together { (to - from).abs() } else { to.abs() + from.abs() };
            // If the middle itself violates the limits, so did the measurement; then the limits are not applied.
            !angle.limits.contains(&middle)
                || (angle.limits.contains(&(middle - most)) && angle.limits.contains(&(middle + most)))
        })
    }

    /// Returns the information Σ xᵀ x over time, divided by the noise densities of force and moment.
    pub fn information(&self, machine: &Machine, unknowns: &Unknowns, duration: f64, fit: &Fit) -> DMatrix<f64> {
        let p = unknowns.count();
        let mut rows = [0, 1, 2].map(|_| DMatrix::zeros(INSTANTS, p));
        let mut one = [0, 1, 2].map(|_| vec![0.0; p]);
        for (i, t) in Self::instants(duration).enumerate() {
            let [q, qd, qdd] = self.at(t);
            let [fx, fy, n] = &mut one;
            unknowns.reaction(&DriveAngles(q).units(), &qd, &qdd, machine.gravity(), [fx, fy, n]);
            for (rows, one) in rows.iter_mut().zip(&one) {
                one.iter().enumerate().for_each(|(j, x)| rows[(i, j)] = *x);
            }
        }
        let dt = duration / INSTANTS as f64;
        let line = LinearTrend::through(&(0..INSTANTS).map(|i| i as f64).collect::<Vec<_>>());
        let mut sum = DMatrix::zeros(p, p);
        for (mut rows, density) in rows.into_iter().zip([fit.density[0], fit.density[0], fit.density[1]]) {
            rows.column_iter_mut().for_each(|mut column| line.take_out(column.as_mut_slice()));
            sum += rows.tr_mul(&rows) * (dt / density.max(f64::MIN_POSITIVE));
        }
        sum
    }
}

/// Eigendecomposition of an information matrix, for unknowns divided by their scales.
struct Known {
    values: DVector<f64>,
    vectors: DMatrix<f64>,
    threshold: f64,
}

impl Known {
    fn of(information: &DMatrix<f64>, scales: &[f64]) -> Self {
        let scaled = DMatrix::from_fn(scales.len(), scales.len(), |i, j| information[(i, j)] * scales[i] * scales[j]);
        let uninformative = || SymmetricEigen {
            eigenvalues: DVector::zeros(scales.len()),
            eigenvectors: DMatrix::identity(scales.len(), scales.len()),
        };
        let eigen = SymmetricEigen::try_new(scaled, f64::EPSILON, MAX_ITERATIONS).unwrap_or_else(uninformative);
        let threshold = 1e-12 * eigen.eigenvalues.amax();
        Self { values: eigen.eigenvalues, vectors: eigen.eigenvectors, threshold }
    }

    /// Returns the variance of an unknown; `None` if it is not identifiable.
    fn variance(&self, place: usize) -> Option<f64> {
        let part = |i: usize| self.vectors[(place, i)].powi(2);
        let known = |i: &usize| self.values[*i] > self.threshold;
        let identifiable = (0..self.values.len()).all(|i| known(&i) || part(i) < 1e-6);
        identifiable.then(|| (0..self.values.len()).filter(known).map(|i| part(i) / self.values[i]).sum())
    }

    /// Returns the logarithm of the product of the first `count` variances, with 1 for unknowns that are not
    /// identifiable.
    fn log_volume(&self, count: usize) -> f64 {
        (0..count).map(|i| self.variance(i).unwrap_or(1.0).max(f64::MIN_POSITIVE).ln()).sum()
    }
}

//! [`PlateMeasurement`]: forces and moments of a machine on a fixed base, tested for faults.

use super::doubting::{DoubtSearch, FaultWords, Suspected};
use super::fault::Fault;
use super::odds::{ChannelFit, FitTrial};
use super::rejection::Residual;
use crate::trim::error::TrimError;
use crate::trim::fit::estimate;
use crate::trim::recording::{MeasuredMotion, MeasurementSet};
use crate::trim::rows::Regressor;
use crate::trim::unknowns::Unknowns;
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::{PerDrive, Vector};

/// Maximum number of samples times the square of the number of unknowns, unless 1 000 samples already exceed it.
const MAX_WORK: usize = 4_000_000;

/// A measurement of force and moment, with its rows as given.
pub(in crate::trim) struct PlateMeasurement {
    recording: MeasurementSet,
    angles_only: bool,
    rows: Regressor,
}

impl PlateMeasurement {
    /// Fits a recording as given, and begins the search for faults. Only parts of a long one are tested.
    ///
    /// # Errors
    /// Fails if the recording cannot be used.
    pub fn search(
        machine: &Machine,
        recording: &MeasurementSet,
        angles_only: bool,
    ) -> Result<DoubtSearch<Self>, TrimError> {
        recording.check(machine.drives())?;
        let recording = shortened(machine, recording);
        let rows = Regressor::of(machine, &recording, angles_only)?;
        let given = try_fit(machine, &rows, limits_left(machine, &recording))?;
        let faults = Fault::all(machine, &given.numbers);
        Ok(DoubtSearch::of(machine, Self { recording, angles_only, rows }, given, faults))
    }
}

impl Suspected for PlateMeasurement {
    type Fault = Fault;

    fn words(fault: &Fault) -> &FaultWords {
        &fault.words
    }

    fn without(&self, machine: &Machine, given: &FitTrial, fault: &Fault) -> Option<(FitTrial, Option<FitTrial>)> {
        let rows = &self.rows;
        let own = fault.angles.as_ref().map(|angles| angles.undo(&self.recording));
        let (mut transformed, mut as_given, mut violation) = (rows.clone(), None, given.limit_violation);
        if let Some(own) = &own {
            violation = limits_left(machine, own);
            let fresh = Regressor::at_least(rows.half(), machine, own, self.angles_only).ok()?;
            // Residuals must be compared for the same windows.
            if fresh.half() > rows.half() {
                let wide = Regressor::at_least(fresh.half(), machine, &self.recording, self.angles_only);
                as_given = wide.and_then(|rows| try_fit(machine, &rows, given.limit_violation)).ok();
            }
            transformed = fresh;
        }
        transformed.transform(|force, moment| fault.undo(force, moment));
        Some((try_fit(machine, &transformed, violation).ok()?, as_given))
    }
}

fn try_fit(machine: &Machine, rows: &Regressor, limit_violation: f64) -> Result<FitTrial, TrimError> {
    let estimate = estimate(machine, rows)?;
    let fit = estimate.fit;
    let channel = |(of, unit): (usize, &'static str)| ChannelFit {
        residual: Residual {
            unit: unit.into(),
            noise: fit.noise[of],
            share: fit.noise[of] / fit.size[of].max(f64::MIN_POSITIVE),
        },
        effective: fit.effective[of],
        largest: fit.largest[of],
        floor: 0.0,
        slack: 1.0,
    };
    let channels = ["N", "N m"].into_iter().enumerate().map(channel).collect();
    Ok(FitTrial { numbers: fit.numbers, channels, share: estimate.share, limit_violation })
}

fn limits_left(machine: &Machine, recording: &MeasurementSet) -> f64 {
    limit_violation(machine, recording.motions.iter().flat_map(|motion| &motion.q))
}

/// Returns the largest violation of the limits of relative angles, modulo whole turns, rad; 0 if there is none.
pub(in crate::trim) fn limit_violation<'a>(
    machine: &Machine,
    angles: impl Iterator<Item = &'a PerDrive> + Clone,
) -> f64 {
    let mut most: f64 = 0.0;
    for angle in machine.angles() {
        let (low, high) = (*angle.limits.start(), *angle.limits.end());
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        if !half.is_finite() {
            continue;
        }
        for q in angles.clone() {
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

//! [`dead_signal`]: rates that do not change while what they are rates of does.

use super::fit::OrbitFit;
use super::motion::{BASE_RATE, OrbitBase, OrbitMotion};
use crate::trim::error::TrimError;
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::PerDrive;

/// A rate is dead if its angle changes by rates that differ from it by more than this fraction of their size.
const MIN_DIFFERENCE: f64 = 0.5;
/// Rates below this are none, rad/s.
const MIN_RATE: f64 = 1e-4;

/// Returns the error of the first rate that is the same in all rows of a motion though its angle tells otherwise, or that is
/// of a base which the machine's file turns.
pub(super) fn dead_signal(machine: &Machine, base: &OrbitBase, motions: &[OrbitMotion]) -> Option<TrimError> {
    motions.iter().enumerate().find_map(|(i, motion)| dead_in(machine, base, i, motion))
}

fn dead_in(machine: &Machine, base: &OrbitBase, motion: usize, of: &OrbitMotion) -> Option<TrimError> {
    // Absolute rates are sums, so they are constant within rounding.
    let is_constant = |rate: &[f64]| rate.windows(2).all(|pair| (pair[0] - pair[1]).abs() <= 1e-12);
    let dead = |path: String, rates: &[f64], angles: &[f64]| {
        let value = *rates.first().filter(|_| is_constant(rates))?;
        let by_angle = || angles.windows(2).zip(of.t.windows(2)).map(|(q, t)| (q[1] - q[0]) / (t[1] - t[0]));
        let differs = rms(by_angle().map(|rate| rate - value));
        let size = rms(by_angle());
        (differs > MIN_RATE.max(MIN_DIFFERENCE * size)).then_some(TrimError::DeadSignal {
            motion,
            path,
            value,
            by_angle: size,
        })
    };
    if let Some(error) = dead(BASE_RATE.into(), &of.base_rate, &of.attitude) {
        return Some(error);
    }
    if is_constant(&of.base_rate) {
        // A base that a wheel holds does not turn, and the fit knows of the wheel.
        let off = OrbitFit::of(machine, base, std::slice::from_ref(of)).ok()?.off;
        if off > MIN_RATE {
            return Some(TrimError::StillBase { motion, by_file: off });
        }
    }
    let absolute = |own: &[_], base: &[f64], k: usize| -> Vec<f64> {
        own.iter().zip(base).map(|(own, base): (&PerDrive, &f64)| own[k] + base).collect()
    };
    machine.spec().drives.iter().enumerate().find_map(|(k, drive)| {
        let [rates, angles] = [absolute(&of.rates, &of.base_rate, k), absolute(&of.angles, &of.attitude, k)];
        dead(format!("rate/{}", drive.name), &rates, &angles)
    })
}

fn rms(of: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = of.fold((0.0, 0_u32), |(sum, count), x| (sum + x * x, count + 1));
    (sum / f64::from(count.max(1))).sqrt()
}

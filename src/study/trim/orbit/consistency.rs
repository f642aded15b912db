//! Rates against their angles: signals that do not change, and rates that are not those of their angles.
//!
//! A rate is integrated, because differences of angles are noisy: angle = a + b t + c ∫ rate dt, where a is unknown and b
//! takes up a bias of the gyroscope. c is 1 if both belong together.

use std::ops::Range;

use super::fit::OrbitFit;
use super::motion::{BASE_RATE, OrbitBase, OrbitMotion};
use crate::trim::error::TrimError;
use nalgebra::DVector;
use stillbase_mechanics::machine::Machine;

/// A signal is dead if its partner changes by rates that differ from it by more than this fraction of their size.
const MIN_DIFFERENCE: f64 = 0.5;
/// Rates below this are none, rad/s.
const MIN_RATE: f64 = 1e-4;
/// Rates below this factor times their noise are none.
const NOISE_FACTOR: f64 = 3.0;
/// Angle and integrated rate may differ by this fraction of what they change by.
const MAX_FRACTION: f64 = 0.03;
/// Smaller differences of angle and integrated rate, rad, are none.
const MIN_ANGLE: f64 = 3e-3;
/// Factor on the random walk of an integrated rate with noise.
const WALK_FACTOR: f64 = 4.0;
/// A factor explains a difference if it leaves this fraction of it.
const LEFT_BY_FACTOR: f64 = 0.3;
/// Times between two rows that are longer than the usual one by this factor are gaps.
const GAP: f64 = 3.0;
/// Minimum number of rows between gaps.
const MIN_PART: usize = 10;
/// Factors that differ by less are one and the same.
const EQUAL_FACTORS: f64 = 0.05;

/// An angle with its rate.
struct Pair {
    names: [String; 2],
    angle: Vec<f64>,
    rate: Vec<f64>,
}

/// Returns the pairs of a motion: of the base, then of each drive, absolute.
fn pairs(machine: &Machine, motion: &OrbitMotion) -> Vec<Pair> {
    let base = Pair {
        names: ["attitude/base".into(), BASE_RATE.into()],
        angle: motion.attitude.clone(),
        rate: motion.base_rate.clone(),
    };
    let of_drive = |(k, name): (usize, &str)| Pair {
        names: [format!("angle/{name}"), format!("rate/{name}")],
        angle: motion.angles.iter().zip(&motion.attitude).map(|(q, turn)| q[k] + turn).collect(),
        rate: motion.rates.iter().zip(&motion.base_rate).map(|(rate, base)| rate[k] + base).collect(),
    };
    let drives = machine.spec().drives.iter().map(|drive| drive.name.as_str()).enumerate();
    [base].into_iter().chain(drives.map(of_drive)).collect()
}

fn is_constant(values: &[f64]) -> bool {
    // Absolute values are sums, so they are constant within rounding.
    values.windows(2).all(|pair| (pair[0] - pair[1]).abs() <= 1e-12)
}

/// Returns the error of the first dead signal: an angle or rate that is the same in all rows of a motion, although the other one
/// changes. A base that stands still is an error, too, if the arm turns it by the machine's file.
pub(super) fn dead_signal(machine: &Machine, base: &OrbitBase, motions: &[OrbitMotion]) -> Option<TrimError> {
    motions.iter().enumerate().find_map(|(i, motion)| dead_in(machine, base, i, motion))
}

fn dead_in(machine: &Machine, base: &OrbitBase, motion: usize, of: &OrbitMotion) -> Option<TrimError> {
    let all = pairs(machine, of);
    let by_angle = |pair: &Pair| {
        let differences = pair.angle.windows(2).zip(of.t.windows(2));
        differences.map(|(q, t)| (q[1] - q[0]) / (t[1] - t[0])).collect::<Vec<f64>>()
    };
    let dead = |pair: &Pair| {
        let [angle, rate] = &pair.names;
        let size = rms(pair.rate.iter().copied());
        if is_constant(&pair.angle) && !is_constant(&pair.rate) && size > MIN_RATE.max(NOISE_FACTOR * noise(&pair.rate))
        {
            return Some(TrimError::DeadAngle { motion, angle: angle.clone(), rate: rate.clone(), size });
        }
        let value = *pair.rate.first().filter(|_| is_constant(&pair.rate))?;
        let by_angle = by_angle(pair);
        let (differs, size) = (rms(by_angle.iter().map(|rate| rate - value)), rms(by_angle.iter().copied()));
        let is_dead = differs > MIN_RATE.max(MIN_DIFFERENCE * size).max(NOISE_FACTOR * noise(&by_angle));
        is_dead.then(|| TrimError::DeadSignal { motion, path: rate.clone(), value, by_angle: size })
    };
    if let Some(error) = all.iter().find_map(dead) {
        return Some(error);
    }
    if is_constant(&of.base_rate) {
        // A base that a wheel holds does not turn, and the fit knows of the wheel.
        let off = OrbitFit::of(machine, base, &OrbitMotion::thinned(std::slice::from_ref(of))).ok()?.off;
        return (off > MIN_RATE).then_some(TrimError::StillBase { motion, by_file: off });
    }
    None
}

/// Returns the error of the rates that are not those of their angles.
pub(super) fn contradiction(machine: &Machine, motions: &[OrbitMotion]) -> Option<TrimError> {
    motions.iter().enumerate().find_map(|(i, motion)| {
        let compared = |pair: Pair| Some((Compared::of(&motion.t, &pair.angle, &pair.rate)?, pair.names));
        let all: Vec<(Compared, [String; 2])> = pairs(machine, motion).into_iter().filter_map(compared).collect();
        let (first, [angle, rate]) = all.iter().find(|(own, _)| own.contradicts())?;
        // Where all rates are too large or too small alike, the time is.
        let is_like = |own: &Compared| own.is_factor && (own.factor / first.factor - 1.0).abs() < EQUAL_FACTORS;
        if all.len() > 1 && all.iter().all(|(own, _)| own.contradicts() && is_like(own)) {
            return Some(TrimError::WrongTime { motion: i, factor: first.factor });
        }
        let factor = Some(first.factor).filter(|_| first.is_factor);
        let (angle, rate) = (angle.clone(), rate.clone());
        Some(TrimError::RateOfAngle { motion: i, angle, rate, factor, off: first.off })
    })
}

/// How an integrated rate compares with its angle.
struct Compared {
    /// Root mean square difference, without a straight line, rad.
    off: f64,
    /// The largest difference that is none, rad.
    most: f64,
    /// The rate is as many times that of the angle.
    factor: f64,
    /// Whether the factor explains the difference.
    is_factor: bool,
}

impl Compared {
    /// Compares an angle with its rate; `None` if neither changes.
    fn of(t: &[f64], angle: &[f64], rate: &[f64]) -> Option<Self> {
        let mut integral = vec![0.0; t.len()];
        for i in 1..t.len() {
            integral[i] = integral[i - 1] + 0.5 * (rate[i] + rate[i - 1]) * (t[i] - t[i - 1]);
        }
        // What happened in a gap is not known.
        let parts = || without_gaps(t).filter(|part| part.len() >= MIN_PART);
        let whole = |of: &[f64]| -> DVector<f64> {
            parts().flat_map(|part| without_line(&t[part.clone()], &of[part])).collect::<Vec<_>>().into()
        };
        let (y, x) = (whole(angle), whole(&integral));
        let size = y.norm().max(x.norm()) / (y.len().max(1) as f64).sqrt();
        if size < MIN_ANGLE {
            return None;
        }
        let off = rms((&y - &x).iter().copied());
        let scale = x.dot(&y) / x.norm_squared().max(f64::MIN_POSITIVE);
        let time = t[t.len() - 1] - t[0];
        let walk = noise(rate) * (time * time / t.len() as f64).sqrt();
        Some(Self {
            off,
            most: (MAX_FRACTION * size).max(MIN_ANGLE).max(WALK_FACTOR * walk),
            factor: scale.recip(),
            is_factor: rms((&y - scale * &x).iter().copied()) < LEFT_BY_FACTOR * off,
        })
    }

    fn contradicts(&self) -> bool {
        self.off > self.most
    }
}

/// Returns the ranges of rows between gaps in time.
fn without_gaps(t: &[f64]) -> impl Iterator<Item = Range<usize>> {
    let mut steps: Vec<f64> = t.windows(2).map(|t| t[1] - t[0]).collect();
    let usual = match steps.len() / 2 {
        0 => f64::INFINITY,
        half => *steps.select_nth_unstable_by(half, f64::total_cmp).1,
    };
    let is_gap = |i: &usize| t[*i] - t[*i - 1] > GAP * usual;
    let ends: Vec<usize> = (1..t.len()).filter(is_gap).chain([t.len()]).collect();
    let starts: Vec<usize> = [0].into_iter().chain(ends.iter().copied()).collect();
    starts.into_iter().zip(ends).map(|(from, to)| from..to)
}

/// Returns values less their best straight line over time.
fn without_line(t: &[f64], of: &[f64]) -> Vec<f64> {
    let n = t.len() as f64;
    let middle = t.iter().sum::<f64>() / n;
    let mean = of.iter().sum::<f64>() / n;
    let [along, size] =
        t.iter().zip(of).fold([0.0; 2], |[a, s], (t, x)| [a + (t - middle) * x, s + (t - middle).powi(2)]);
    let slope = along / size.max(f64::MIN_POSITIVE);
    t.iter().zip(of).map(|(t, x)| x - mean - slope * (t - middle)).collect()
}

/// Returns the standard deviation of white noise of values, by fourth differences.
pub(super) fn noise(of: &[f64]) -> f64 {
    rms(of.windows(5).map(|x| (x[0] - 4.0 * (x[1] + x[3]) + 6.0 * x[2] + x[4]) / 70.0_f64.sqrt()))
}

fn rms(of: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = of.fold((0.0, 0_u32), |(sum, count), x| (sum + x * x, count + 1));
    (sum / f64::from(count.max(1))).sqrt()
}

//! [`Regressor`]: the linear equations of a recording.

use nalgebra::DMatrix;

use super::differences::{noise, stencil};
use super::error::TrimError;
use super::recording::{MeasuredMotion, MeasurementSet};
use super::unknowns::Unknowns;
use super::window::SmoothingWindow;
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Vector};

/// Origin of the rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RegressorSource {
    /// Samples with measured rates and accelerations.
    Samples,
    /// Averages over windows.
    Windows {
        /// Half width of a window, s.
        half: f64,
        /// Root mean square noise of the accelerations relative to their root mean square; for the worst drive.
        noise: f64,
    },
}

/// Equations for f_x, f_y and n in the unknowns, row by row; the straight line over time is removed from each motion.
#[derive(Clone, Debug)]
pub struct Regressor {
    /// The unknowns.
    pub unknowns: Unknowns,
    /// Origin of the rows.
    pub source: RegressorSource,
    /// Whether each drive moves.
    pub moves: Vec<bool>,
    /// Largest acceleration of each drive, rad/s².
    pub fastest: Vec<f64>,
    /// Mean time between rows, s.
    pub spacing: f64,
    /// Number of rows of each motion.
    pub motions: Vec<usize>,
    /// Time of each row, s.
    times: Vec<f64>,
    pub(super) channels: [Channel; 3],
}

/// Equations for f_x, f_y or n.
#[derive(Clone, Debug)]
pub(super) struct Channel {
    /// Matrix, rows × unknowns.
    pub x: DMatrix<f64>,
    pub y: Vec<f64>,
    /// Expected contribution of the noise in the angles or measured rates to xᵀ x; 0 if the source is samples.
    pub noise: DMatrix<f64>,
}

/// Minimum half width of a window, in sampling intervals.
const MIN_HALF_WIDTH_SAMPLES: f64 = 10.0;
/// Maximum half width of a window, as a fraction of the duration of the shortest motion.
const MAX_HALF_WIDTH_FRACTION: f64 = 0.2;
/// Number of rows per half width of a window.
const ROWS_PER_HALF_WIDTH: f64 = 4.0;
/// Accepted relative noise of the accelerations: the narrowest window within it is chosen.
const ACCEPTED_NOISE: f64 = 2e-3;
/// A drive counts as still if the relative noise of its acceleration is at least this for all windows.
const STILL_NOISE: f64 = 0.2;
/// A drive counts as still if its angle varies by at most this, rad.
const TURNING_ABOVE_RAD: f64 = 1e-9;
/// With measured accelerations, a still drive's angle varies by at most this, rad; the next bound must hold too.
const STILL_RANGE_RAD: f64 = 1e-3;
/// Upper bound on the root mean square acceleration of a still drive, as a fraction of that of the fastest drive.
const STILL_ACCELERATION: f64 = 1e-2;
/// Number of parameters of the straight line that a sensor adds to each channel of a motion: offset and drift.
pub(super) const TREND_PARAMETERS: usize = 2;

impl Regressor {
    /// Builds the equations of a recording, for a machine's drives and gravity. Measured rates and accelerations are
    /// ignored if `angles_only` is set.
    ///
    /// # Errors
    /// Fails if the recording cannot be used.
    pub fn of(machine: &Machine, recording: &MeasurementSet, angles_only: bool) -> Result<Self, TrimError> {
        Self::at_least(0.0, machine, recording, angles_only)
    }

    /// Builds the equations with windows whose half width is at least `half`, s.
    ///
    /// # Errors
    /// Fails if the recording cannot be used.
    pub(super) fn at_least(
        half: f64,
        machine: &Machine,
        recording: &MeasurementSet,
        angles_only: bool,
    ) -> Result<Self, TrimError> {
        machine.check_all_turn("trims")?;
        recording.check(machine.drives())?;
        let mut rows = match recording.has_accelerations() && !angles_only {
            true => Self::of_samples(machine, recording),
            false => Self::of_windows(half, machine, recording, angles_only)?,
        };
        if !rows.moves.contains(&true) {
            return Err(TrimError::Still);
        }
        let (own, unknowns) =
            (rows.count().saturating_sub(TREND_PARAMETERS * rows.motions.len()), rows.unknowns.count());
        if 3 * own <= unknowns {
            return Err(TrimError::TooFew { rows: rows.count(), unknowns });
        }
        rows.level();
        let finite = |channel: &Channel| channel.x.iter().chain(&channel.y).all(|x| x.is_finite());
        if rows.channels.iter().all(finite) { Ok(rows) } else { Err(TrimError::NotFinite) }
    }

    /// Returns the number of rows.
    pub fn count(&self) -> usize {
        self.motions.iter().sum()
    }

    fn of_samples(machine: &Machine, recording: &MeasurementSet) -> Self {
        let all = || recording.motions.iter();
        let squares = |k: usize| all().flat_map(|m| &m.qdd).map(|a| a[k] * a[k]).sum::<f64>();
        let fastest = (0..machine.drives()).map(squares).fold(0.0, f64::max);
        let is_still = |k: usize| {
            let turns = |m: &MeasuredMotion| spread(m.q.iter().map(|q| q[k]));
            all().map(turns).fold(0.0, f64::max) <= STILL_RANGE_RAD
                && squares(k) <= STILL_ACCELERATION.powi(2) * fastest
        };
        let moves: Vec<bool> = (0..machine.drives()).map(|k| !is_still(k)).collect();
        let mut made = Making::of(machine);
        for motion in all().map(|motion| with_fixed_still_drives(motion, &moves)) {
            for i in 0..motion.t.len() {
                let e = DriveAngles(motion.q[i]).units();
                made.next(motion.t[i] - motion.t[0], motion.force[i], motion.moment[i]);
                let [fx, fy, n] = &mut made.rows;
                made.unknowns.reaction(&e, &motion.qd[i], &motion.qdd[i], made.gravity, [fx, fy, n]);
                made.push();
            }
            made.end_of_motion();
        }
        let time: f64 = all().map(MeasuredMotion::duration).sum();
        made.rows(RegressorSource::Samples, moves, time)
    }

    /// Returns the half width of the windows, s; 0 for samples.
    pub(super) fn half(&self) -> f64 {
        if let RegressorSource::Windows { half, .. } = self.source { half } else { 0.0 }
    }

    fn of_windows(
        least: f64,
        machine: &Machine,
        recording: &MeasurementSet,
        angles_only: bool,
    ) -> Result<Self, TrimError> {
        let smooth: Vec<Smooth> = recording.motions.iter().map(|motion| Smooth::of(motion, angles_only)).collect();
        let mut widths = widths(&smooth)?;
        widths.retain(|half| *half >= least);
        let drives = machine.drives();
        let shares: Vec<Vec<f64>> = widths.iter().map(|half| noise_ratios(&smooth, *half, drives)).collect();
        let best = |k: usize| shares.iter().map(|of| of[k]).fold(f64::INFINITY, f64::min);
        let turns = |m: &MeasuredMotion, k: usize| spread(m.q.iter().map(|q| q[k])) > TURNING_ABOVE_RAD;
        let turns = |k: usize| recording.motions.iter().any(|motion| turns(motion, k));
        let moves: Vec<bool> = (0..drives).map(|k| turns(k) && best(k) < STILL_NOISE).collect();
        let worst = |of: &Vec<f64>| of.iter().zip(&moves).filter(|(_, m)| **m).map(|(x, _)| *x).fold(0.0, f64::max);
        let worst: Vec<f64> = shares.iter().map(worst).collect();
        let least = (0..widths.len()).min_by(|a, b| worst[*a].total_cmp(&worst[*b])).unwrap_or_default();
        let chosen = worst.iter().position(|share| *share <= ACCEPTED_NOISE).unwrap_or(least);
        let half = *widths.get(chosen).ok_or(TrimError::Still)?;
        let mut made = Making::of(machine);
        for own in &smooth {
            own.rows(half, &moves, &mut made);
        }
        let time = smooth.iter().map(|own| own.motion.duration() - 2.0 * half).sum();
        Ok(made.rows(RegressorSource::Windows { half, noise: worst[chosen] }, moves, time))
    }

    /// Removes from each motion the straight line over time that fits it best: offset and drift of a sensor. With the
    /// line removed from both sides, a fit is the same as one with an offset and a drift for each channel and motion.
    fn level(&mut self) {
        let mut from = 0;
        for &count in &self.motions {
            let line = LinearTrend::through(&self.times[from..from + count]);
            for Channel { x, y, .. } in &mut self.channels {
                x.column_iter_mut().for_each(|mut column| line.take_out(column.rows_mut(from, count).as_mut_slice()));
                line.take_out(&mut y[from..from + count]);
            }
            from += count;
        }
    }
}

/// Removes straight lines over given times.
pub(super) struct LinearTrend {
    /// Times less their mean, scaled to norm 1; zero for a single time.
    slope: Vec<f64>,
}

impl LinearTrend {
    /// Prepares the removal for given times.
    pub fn through(times: &[f64]) -> Self {
        let mean = times.iter().sum::<f64>() / times.len() as f64;
        let mut slope: Vec<f64> = times.iter().map(|t| t - mean).collect();
        let size = slope.iter().map(|t| t * t).sum::<f64>().sqrt();
        slope.iter_mut().for_each(|t| *t /= if size > 0.0 { size } else { 1.0 });
        Self { slope }
    }

    /// Subtracts the best straight line from a series.
    pub fn take_out(&self, series: &mut [f64]) {
        let mean = series.iter().sum::<f64>() / series.len() as f64;
        let by: f64 = series.iter().zip(&self.slope).map(|(y, t)| y * t).sum();
        series.iter_mut().zip(&self.slope).for_each(|(y, t)| *y -= mean + by * t);
    }
}

fn spread(values: impl Iterator<Item = f64>) -> f64 {
    let ends = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
    ends[1] - ends[0]
}

/// Returns the motion with constant angles for drives that count as still.
fn with_fixed_still_drives(motion: &MeasuredMotion, moves: &[bool]) -> MeasuredMotion {
    let mut motion = motion.clone();
    for k in (0..moves.len()).filter(|k| !moves[*k]) {
        let mean = motion.q.iter().map(|q| q[k]).sum::<f64>() / motion.q.len() as f64;
        motion.q.iter_mut().for_each(|q| q[k] = mean);
        motion.qd.iter_mut().chain(&mut motion.qdd).for_each(|x| x[k] = 0.0);
    }
    motion
}

/// Returns the half widths of windows that the motions permit, s, in ascending order.
fn widths(smooth: &[Smooth]) -> Result<Vec<f64>, TrimError> {
    let narrowest = smooth.iter().map(|own| MIN_HALF_WIDTH_SAMPLES * own.spacing).fold(0.0, f64::max);
    let enough = |own: &Smooth| MAX_HALF_WIDTH_FRACTION * own.motion.duration() >= narrowest && own.motion.t.len() > 1;
    if let Some(motion) = smooth.iter().position(|own| !enough(own)) {
        let own = &smooth[motion];
        let want = (MIN_HALF_WIDTH_SAMPLES / MAX_HALF_WIDTH_FRACTION) as usize + 1;
        return Err(TrimError::Short { motion, rows: own.motion.t.len(), time: own.motion.duration(), want });
    }
    let widest = smooth.iter().map(|own| MAX_HALF_WIDTH_FRACTION * own.motion.duration()).fold(f64::INFINITY, f64::min);
    let steps = (2.0 * (widest / narrowest).log2()).floor().max(0.0) as i32;
    Ok((0..=steps).map(|i| narrowest * 2_f64.powf(0.5 * f64::from(i))).collect())
}

/// Returns the relative noise of the acceleration of each drive.
fn noise_ratios(smooth: &[Smooth], half: f64, drives: usize) -> Vec<f64> {
    let (mut noises, mut sizes) = (vec![0.0; drives], vec![f64::MIN_POSITIVE; drives]);
    for own in smooth {
        // The noise of the last window that has enough samples stands for that of all.
        let (mut windows, mut last_gain) = (0_u32, 0.0);
        for centre in own.centres(half, 0.5 * half) {
            let Some(window) = SmoothingWindow::about(&own.motion.t, centre, half) else { continue };
            for (k, size) in sizes.iter_mut().enumerate() {
                let mean: f64 = window.samples.clone().zip(&window.rate).map(|(j, d)| d * own.qd[j][k]).sum();
                *size += mean * mean;
            }
            (windows, last_gain) = (windows + 1, own.gain(&window));
        }
        for (noise, own) in noises.iter_mut().zip(&own.noise) {
            *noise += last_gain.powi(2) * own.powi(2) * f64::from(windows);
        }
    }
    noises.iter().zip(&sizes).map(|(noise, size)| (noise / size).sqrt()).collect()
}

/// A motion with rates, measured or by finite differences.
struct Smooth<'a> {
    motion: &'a MeasuredMotion,
    qd: Vec<PerDrive>,
    /// Whether the rates were measured.
    measured: bool,
    /// Noise σ for each drive: of the rates if they were measured, else of the angles.
    noise: Vec<f64>,
    /// Median time between samples, s.
    spacing: f64,
}

impl<'a> Smooth<'a> {
    fn of(motion: &'a MeasuredMotion, angles_only: bool) -> Self {
        let (t, drives) = (&motion.t, motion.q.first().map_or(0, |q| q.len()));
        let measured = !motion.qd.is_empty() && !angles_only;
        let rate = |i: usize| {
            let (from, weights) = stencil(t, i);
            PerDrive::from_fn(drives, |k| weights.iter().enumerate().map(|(j, w)| w * motion.q[from + j][k]).sum())
        };
        let qd = if measured { motion.qd.clone() } else { (0..t.len()).map(rate).collect() };
        let source = if measured { &motion.qd } else { &motion.q };
        let noise = (0..drives).map(|k| noise(t, |i| source[i][k]).unwrap_or(f64::INFINITY)).collect();
        let mut steps: Vec<f64> = t.windows(2).map(|w| w[1] - w[0]).collect();
        steps.sort_by(f64::total_cmp);
        let spacing = steps.get(steps.len() / 2).copied().unwrap_or(f64::INFINITY);
        Self { motion, qd, measured, noise, spacing }
    }

    /// Iterates over the centres of windows that lie within the motion.
    fn centres(&self, half: f64, step: f64) -> impl Iterator<Item = f64> + use<> {
        let (start, room) = (self.motion.t[0] + half, self.motion.duration() - 2.0 * half);
        let count = (room / step).max(0.0).floor() as usize;
        let step = if count > 0 { room / count as f64 } else { 0.0 };
        (0..=count).map(move |i| start + step * i as f64)
    }

    /// Returns the ratio of σ of an averaged acceleration to σ of the underlying samples.
    fn gain(&self, window: &SmoothingWindow) -> f64 {
        if self.measured {
            return window.rate.iter().map(|d| d * d).sum::<f64>().sqrt();
        }
        let from = window.samples.start.saturating_sub(2);
        let mut weights = vec![0.0; window.samples.end + 3 - from];
        for (i, d) in window.samples.clone().zip(&window.rate) {
            let (first, stencil) = stencil(&self.motion.t, i);
            stencil.iter().enumerate().for_each(|(j, w)| weights[(first + j).saturating_sub(from)] += d * w);
        }
        weights.iter().map(|w| w * w).sum::<f64>().sqrt()
    }

    /// Adds one row for each window.
    fn rows(&self, half: f64, moves: &[bool], made: &mut Making) {
        let mean = |k: usize| self.motion.q.iter().map(|q| q[k]).sum::<f64>() / self.motion.q.len() as f64;
        let still: Vec<f64> = (0..moves.len()).map(mean).collect();
        let n = moves.len();
        let angle = |j: usize| PerDrive::from_fn(n, |k| if moves[k] { self.motion.q[j][k] } else { still[k] });
        let rate = |j: usize| PerDrive::from_fn(n, |k| if moves[k] { self.qd[j][k] } else { 0.0 });
        let mut one = made.rows.clone();
        let mut noise = None;
        for centre in self.centres(half, half / ROWS_PER_HALF_WIDTH) {
            let Some(window) = SmoothingWindow::about(&self.motion.t, centre, half) else { continue };
            let (mut force, mut moment, mut time) = (Vector::default(), 0.0, 0.0);
            made.rows.iter_mut().for_each(|row| row.fill(0.0));
            for ((j, a), d) in window.samples.clone().zip(&window.mean).zip(&window.rate) {
                let (e, [px, py, h]) = (DriveAngles(angle(j)).units(), &mut one);
                made.unknowns.momentum(&e, &rate(j), [px, py, h]);
                made.rows.iter_mut().zip(&one).for_each(|(sum, one)| add(sum, *d, one));
                if made.gravity != Vector::default() {
                    made.unknowns.weight_moment(&e, made.gravity, &mut one[2]);
                    add(&mut made.rows[2], *a, &one[2]);
                }
                force += self.motion.force[j] * *a;
                moment += self.motion.moment[j] * a;
                time += (self.motion.t[j] - self.motion.t[0]) * a;
            }
            made.next(time, force, moment);
            made.push();
            let gain = *noise.get_or_insert_with(|| self.gain(&window));
            let middle = DriveAngles(angle(window.samples.start + window.samples.len() / 2)).units();
            for k in (0..n).filter(|k| moves[*k] && self.noise[*k].is_finite()) {
                let unit = PerDrive::from_fn(n, |l| if l == k { 1.0 } else { 0.0 });
                let [fx, fy, m] = &mut one;
                made.unknowns.reaction(&middle, &PerDrive::zeros(n), &unit, Vector::default(), [fx, fy, m]);
                made.noisy(&one, (gain * self.noise[k]).powi(2));
            }
        }
        made.end_of_motion();
    }
}

fn add(sum: &mut [f64], by: f64, one: &[f64]) {
    sum.iter_mut().zip(one).for_each(|(sum, one)| *sum += by * one);
}

/// Equations under construction.
struct Making {
    unknowns: Unknowns,
    gravity: Vector,
    /// The current row of each channel.
    rows: [Vec<f64>; 3],
    x: [Vec<f64>; 3],
    y: [Vec<f64>; 3],
    noise: [DMatrix<f64>; 3],
    motions: Vec<usize>,
    times: Vec<f64>,
}

impl Making {
    fn of(machine: &Machine) -> Self {
        let unknowns = Unknowns::of(machine.drives());
        let p = unknowns.count();
        let empty = || [Vec::new(), Vec::new(), Vec::new()];
        let noise = std::array::from_fn(|_| DMatrix::zeros(p, p));
        let rows = std::array::from_fn(|_| vec![0.0; p]);
        Self {
            unknowns,
            gravity: machine.gravity(),
            rows,
            x: empty(),
            y: empty(),
            noise,
            motions: Vec::new(),
            times: Vec::new(),
        }
    }

    /// Appends the measured values of the current row.
    fn next(&mut self, time: f64, force: Vector, moment: f64) {
        self.times.push(time);
        self.y.iter_mut().zip([force.re, force.im, moment]).for_each(|(y, value)| y.push(value));
    }

    fn push(&mut self) {
        self.x.iter_mut().zip(&self.rows).for_each(|(x, row)| x.extend_from_slice(row));
    }

    fn noisy(&mut self, by: &[Vec<f64>; 3], variance: f64) {
        for (noise, by) in self.noise.iter_mut().zip(by) {
            let used: Vec<usize> = (0..by.len()).filter(|i| by[*i] != 0.0).collect();
            for &i in &used {
                used.iter().for_each(|&j| noise[(i, j)] += variance * by[i] * by[j]);
            }
        }
    }

    fn end_of_motion(&mut self) {
        let before: usize = self.motions.iter().sum();
        self.motions.push(self.y[0].len() - before);
    }

    fn rows(mut self, source: RegressorSource, moves: Vec<bool>, time: f64) -> Regressor {
        let (count, p) = (self.y[0].len(), self.unknowns.count());
        self.motions.retain(|rows| *rows > 0);
        let spaces = count.saturating_sub(self.motions.len()).max(1);
        let mut y = self.y.into_iter();
        let mut noise = self.noise.into_iter();
        let channels = self.x.map(|x| Channel {
            x: DMatrix::from_row_slice(count, p, &x),
            y: y.next().unwrap_or_default(),
            noise: noise.next().unwrap_or_else(|| DMatrix::zeros(p, p)),
        });
        let spacing = time / spaces as f64;
        // The column of D_k contains −q̈_k.
        let moment = &channels[2];
        let place = self.unknowns.of_balance();
        let fastest = (0..moves.len()).map(|k| moment.x.column(place + k).amax()).collect();
        let Self { unknowns, motions, times, .. } = self;
        Regressor { unknowns, source, moves, fastest, spacing, motions, times, channels }
    }
}

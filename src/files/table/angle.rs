//! Columns of continuous motions: angles are unwrapped, and jumps are errors.

use std::f64::consts::{PI, TAU};

use super::reader::RowPlace;
use stillbase_settings::number::ShortNumber;

/// Largest magnitude of an angle without unit, rad: a larger one is probably in degrees and is rejected.
const MAX_PLAIN_ANGLE_RAD: f64 = 2.0 * TAU;
/// Largest step of an angle from one sample to the next, rad.
const MAX_STEP_RAD: f64 = 0.5 * PI;
/// A step is a jump if it is this many times as fast as both neighbouring steps, and larger than the smallest jump.
const JUMP_FACTOR: f64 = 10.0;
/// Smallest jump of an angle, rad.
const MIN_JUMP_RAD: f64 = 0.1;
/// Smallest jump of a length, m.
const MIN_JUMP_M: f64 = 0.02;
/// A time step is a gap if it is this many times as long as the median time step.
pub(super) const GAP_FACTOR: f64 = 10.0;

/// The reason why a column is not a continuous motion.
pub(super) struct AngleBreak {
    /// Index of the row, from 0.
    pub row: usize,
    what: String,
    /// For a jump from the previous row, the end of the message.
    jump: Option<String>,
}

impl AngleBreak {
    fn jump(name: &str, row: usize, step: f64, unit: &str) -> Self {
        let turns = if unit == "rad" { ", which no whole turn explains" } else { "" };
        let rest = format!("{turns}: want a continuous motion, sampled more often if it is that fast");
        Self { row, what: format!("column {name}: a jump of {step:.3} {unit} from "), jump: Some(rest) }
    }

    /// Returns the reason in words; `places` holds the place of each row.
    pub fn why(&self, places: &[RowPlace]) -> String {
        match &self.jump {
            Some(rest) => format!("{}{}{rest}", self.what, places[self.row - 1]),
            None => self.what.clone(),
        }
    }
}

/// Unwraps column `k` of angles, rad, and returns the number of steps from which whole turns were removed. Column 0 is
/// the time, s.
///
/// # Errors
/// If a column without unit exceeds two turns, so that it is probably in degrees, or if the angles jump.
pub(super) fn continuous_angle(
    rows: &mut [Vec<f64>],
    k: usize,
    name: &str,
    has_unit: bool,
) -> Result<usize, AngleBreak> {
    if let Some(row) = rows.iter().position(|row| !has_unit && row[k].abs() > MAX_PLAIN_ANGLE_RAD) {
        let what = format!(
            "column {name}: {} rad is more than two turns: want radians; if these are degrees, name the column \
             \"{name} (deg)\", if they are radians, \"{name} (rad)\"",
            ShortNumber(rows[row][k])
        );
        return Err(AngleBreak { row, what, jump: None });
    }
    let turns = unwrap(rows, k);
    match jump(rows, k, MIN_JUMP_RAD, MAX_STEP_RAD) {
        Some((row, step)) => Err(AngleBreak::jump(name, row, step, "rad")),
        None => Ok(turns),
    }
}

/// Checks that column `k` of lengths, m, does not jump. Column 0 is the time, s.
pub(super) fn continuous_length(rows: &[Vec<f64>], k: usize, name: &str) -> Result<(), AngleBreak> {
    match jump(rows, k, MIN_JUMP_M, f64::INFINITY) {
        Some((row, step)) => Err(AngleBreak::jump(name, row, step, "m")),
        None => Ok(()),
    }
}

/// Unwraps a column of angles, rad, and returns the number of steps from which whole turns were removed.
fn unwrap(rows: &mut [Vec<f64>], k: usize) -> usize {
    let (mut turns, mut count) = (0.0, 0);
    let mut before = rows[0][k];
    for row in rows.iter_mut().skip(1) {
        let step = ((row[k] - before) / TAU).round();
        before = row[k];
        count += usize::from(step != 0.0);
        turns -= step;
        if turns != 0.0 {
            row[k] += TAU * turns;
        }
    }
    count
}

/// Finds the first jump of a column and returns its row and size. Steps up to `min_jump` are never jumps, steps beyond
/// `max_step` always are.
fn jump(rows: &[Vec<f64>], k: usize, min_jump: f64, max_step: f64) -> Option<(usize, f64)> {
    let step = |i: usize| rows[i][k] - rows[i - 1][k];
    let speed = |i: usize| (step(i) / (rows[i][0] - rows[i - 1][0])).abs();
    (1..rows.len()).map(|i| (i, step(i))).find(|(i, size)| {
        let beside = [i.checked_sub(1).filter(|i| *i > 0), Some(i + 1).filter(|i| *i < rows.len())];
        let most = beside.into_iter().flatten().map(speed).fold(0.0, f64::max);
        (size.abs() > min_jump && speed(*i) > JUMP_FACTOR * most) || size.abs() > max_step
    })
}

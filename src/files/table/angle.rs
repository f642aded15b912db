//! Columns that are to be continuous motions: whole turns are taken out of angles, and jumps are refused.

use std::f64::consts::{PI, TAU};

use crate::settings::number::Short;

/// An angle without unit beyond this, rad, is taken for one in degrees.
const MAX_PLAIN_ANGLE: f64 = 2.0 * TAU;
/// From one sample to the next an angle may move by this much, rad.
const MAX_STEP: f64 = 0.5 * PI;
/// A step this many times as fast as both beside it is a jump, if it is also larger than the least one.
const JUMP_FACTOR: f64 = 10.0;
/// The least jumps, rad and m.
const MIN_JUMP_RAD: f64 = 0.1;
const MIN_JUMP_M: f64 = 0.02;
/// A time between samples this many times as long as the usual one is a gap.
pub(super) const GAP_FACTOR: f64 = 10.0;

/// What keeps a column from being a continuous motion.
pub(super) struct Broken {
    /// At which row, counted from 0.
    pub row: usize,
    what: String,
    /// Whether it is a jump from the row before.
    jump: Option<String>,
}

impl Broken {
    fn jump(name: &str, row: usize, step: f64, unit: &str) -> Self {
        let turns = if unit == "rad" { ", which no whole turn explains" } else { "" };
        let rest = format!("{turns}: want a continuous motion, sampled more often if it is that fast");
        Self { row, what: format!("column {name}: a jump of {step:.3} {unit} from line "), jump: Some(rest) }
    }

    /// In words, by the lines of rows.
    pub fn why(&self, lines: &[u64]) -> String {
        match &self.jump {
            Some(rest) => format!("{}{}{rest}", self.what, lines[self.row - 1]),
            None => self.what.clone(),
        }
    }
}

/// Takes whole turns out of the steps of column `k` of angles, rad; how many there were. Column 0 is the time, s.
///
/// # Errors
/// If these are no angles in rad, or jump.
pub(super) fn continuous_angle(rows: &mut [Vec<f64>], k: usize, name: &str, has_unit: bool) -> Result<usize, Broken> {
    if let Some(row) = rows.iter().position(|row| !has_unit && row[k].abs() > MAX_PLAIN_ANGLE) {
        let what = format!(
            "column {name}: {} rad is more than two turns: want radians; if these are degrees, name the column \
             \"{name} (deg)\", if they are radians, \"{name} (rad)\"",
            Short(rows[row][k])
        );
        return Err(Broken { row, what, jump: None });
    }
    let turns = unwrap(rows, k);
    match jump(rows, k, MIN_JUMP_RAD, MAX_STEP) {
        Some((row, step)) => Err(Broken::jump(name, row, step, "rad")),
        None => Ok(turns),
    }
}

/// Refuses a column `k` of lengths, m, that jumps. Column 0 is the time, s.
pub(super) fn continuous_length(rows: &[Vec<f64>], k: usize, name: &str) -> Result<(), Broken> {
    match jump(rows, k, MIN_JUMP_M, f64::INFINITY) {
        Some((row, step)) => Err(Broken::jump(name, row, step, "m")),
        None => Ok(()),
    }
}

/// Takes whole turns out of the steps of a column; how many there were.
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

/// The first step of a column that no smooth motion makes: at which row, and how large. Steps up to `min_jump` are none,
/// those beyond `max_step` always are.
fn jump(rows: &[Vec<f64>], k: usize, min_jump: f64, max_step: f64) -> Option<(usize, f64)> {
    let step = |i: usize| rows[i][k] - rows[i - 1][k];
    let speed = |i: usize| (step(i) / (rows[i][0] - rows[i - 1][0])).abs();
    (1..rows.len()).map(|i| (i, step(i))).find(|(i, size)| {
        let beside = [i.checked_sub(1).filter(|i| *i > 0), Some(i + 1).filter(|i| *i < rows.len())];
        let most = beside.into_iter().flatten().map(speed).fold(0.0, f64::max);
        (size.abs() > min_jump && speed(*i) > JUMP_FACTOR * most) || size.abs() > max_step
    })
}

//! How fast a path of the last platform can be followed: the time in which all blocks of its chain keep their limits.

use super::tip::{TipError, wrong};
use stillbase_mechanics::assembly::{Assembly, BlockState, MAX_BLOCKS};
use stillbase_mechanics::planar::{DriveAngles, PerDrive};
use stillbase_planning::timing::limits::LimitedQuantity;
use stillbase_planning::timing::{ConstraintRow, LimitsOnPath, fastest_within};
use stillbase_planning::{Motion, Reference};
use stillbase_settings::number::significant;
use stillbase_settings::range::Range;

/// Number of instants in each interval at which limits are checked.
const CHECKS: usize = 8;

/// Factor on the least time, for what torques do between these instants.
const TIME_MARGIN: f64 = 1.0005;

/// Range of the time.
pub(super) const TIME: Range = Range::new(1e-3, 3600.0, "s");

/// Part of the time of a leg over which the accelerations of the fastest law change, and the number of its instants.
const EASED_SHARE: f64 = 0.02;
pub(super) const EASED_INSTANTS: usize = 600;
/// Number of these instants over which accelerations change, if there are few.
const EASED_LEAST: f64 = 8.0;

/// The limits of all drives of a chain of blocks along one leg.
struct ChainLimits<'a> {
    assembly: &'a Assembly,
    /// Places of the blocks in the assembly.
    blocks: &'a [usize],
    /// Motions of the blocks over a unit of time, in which the leg is followed evenly.
    motions: &'a [Motion],
    /// States of all blocks, those of the chain at rest anywhere.
    states: [BlockState; MAX_BLOCKS],
    /// Block of the chain, drive and limit of each row, and of each limited rate.
    rows: Vec<(usize, usize, LimitedQuantity, f64)>,
    speeds: Vec<(usize, usize, f64)>,
}

impl<'a> ChainLimits<'a> {
    fn of(assembly: &'a Assembly, blocks: &'a [usize], motions: &'a [Motion], rest: &[DriveAngles]) -> Self {
        let (mut rows, mut speeds) = (Vec::new(), Vec::new());
        for (block, place) in blocks.iter().enumerate() {
            for (k, drive) in assembly.blocks()[*place].machine.spec().drives.iter().enumerate() {
                rows.extend(drive.torque_limit.map(|limit| (block, k, LimitedQuantity::Torque, limit)));
                rows.extend(drive.acceleration_limit.map(|limit| (block, k, LimitedQuantity::Acceleration, limit)));
                speeds.extend(drive.speed_limit.map(|limit| (block, k, limit)));
            }
        }
        Self { assembly, blocks, motions, states: states_at_rest(rest), rows, speeds }
    }

    /// Returns the torques of all blocks; `of` returns the state of a block of the chain.
    fn torques(&self, of: impl Fn(usize) -> BlockState) -> [PerDrive; MAX_BLOCKS] {
        let mut states = self.states;
        self.blocks.iter().enumerate().for_each(|(i, place)| states[*place] = of(i));
        let mut torques = [PerDrive::zeros(0); MAX_BLOCKS];
        self.assembly.loads(&states, |i, of| torques[i] = of.torque);
        torques
    }
}

impl LimitsOnPath for ChainLimits<'_> {
    fn counts(&self) -> [usize; 2] {
        [self.rows.len(), self.speeds.len()]
    }

    fn at(&self, s: f64, rows: &mut [ConstraintRow], speeds: &mut [f64]) -> f64 {
        let mut chain = self.states;
        let mut first = [PerDrive::zeros(0); MAX_BLOCKS];
        let mut second = first;
        for (i, (place, motion)) in self.blocks.iter().zip(self.motions).enumerate() {
            let motors = self.assembly.blocks()[*place].inertia.motors();
            let Reference { q, qd, qdd } = motion.at(s);
            (first[i], second[i]) = (motors.to_motors(&qd), motors.to_motors(&qdd));
            chain[i] = BlockState { q, qd, qdd };
        }
        // Torques are linear in accelerations and in squares of rates.
        let rest = self.torques(|i| at_rest(&chain[i].q));
        let along = self.torques(|i| BlockState { qdd: chain[i].qd, ..at_rest(&chain[i].q) });
        let moving = self.torques(|i| chain[i]);
        for (row, (block, k, quantity, limit)) in rows.iter_mut().zip(&self.rows) {
            let (place, k) = (self.blocks[*block], *k);
            *row = match quantity {
                LimitedQuantity::Torque => {
                    let g = rest[place][k];
                    ConstraintRow { a: (along[place][k] - g) / limit, c: (moving[place][k] - g) / limit, g: g / limit }
                }
                _ => ConstraintRow { a: first[*block][k] / limit, c: second[*block][k] / limit, g: 0.0 },
            };
        }
        let mut largest = 0.0_f64;
        for (speed, (block, k, limit)) in speeds.iter_mut().zip(&self.speeds) {
            *speed = first[*block][*k].abs() / limit;
            largest = largest.max(*speed);
        }
        1.0 / (largest * largest)
    }
}

/// Returns times, s, and shares of a leg, 0 to 1, of the fastest motion from rest to rest along it; its accelerations
/// change gradually. `motions` follow the leg evenly over a unit of time.
///
/// # Errors
/// If no drive has a limit, or no motion keeps them.
pub(super) fn fastest_leg(
    assembly: &Assembly,
    blocks: &[usize],
    motions: &[Motion],
    rest: &[DriveAngles],
    count: usize,
) -> Result<Vec<[f64; 2]>, TipError> {
    match fastest_within(&ChainLimits::of(assembly, blocks, motions, rest)) {
        Ok(profile) => Ok(profile.averaged(EASED_SHARE.max(EASED_LEAST / count as f64), count)),
        Err(why) => wrong("law", format!("finds no time: {why}")),
    }
}

/// Returns the states of blocks at rest.
fn states_at_rest(rest: &[DriveAngles]) -> [BlockState; MAX_BLOCKS] {
    let none = PerDrive::zeros(0);
    let mut states = [BlockState { q: DriveAngles(none), qd: none, qdd: none }; MAX_BLOCKS];
    states.iter_mut().zip(rest).for_each(|(state, q)| *state = at_rest(q));
    states
}

fn at_rest(q: &DriveAngles) -> BlockState {
    BlockState { q: *q, qd: PerDrive::zeros(q.len()), qdd: PerDrive::zeros(q.len()) }
}

/// Returns the least time, s, in which motions over a unit of time keep all limits of their drives. Torques from motion and
/// accelerations fall with the square of the time, rates with the time, and torques from weight stay.
///
/// # Errors
/// If no drive has a limit, or weight alone passes one.
pub(super) fn least_time(
    assembly: &Assembly,
    blocks: &[usize],
    motions: &[Motion],
    rest: &[DriveAngles],
    count: usize,
) -> Result<f64, TipError> {
    let (none, mut states) = (PerDrive::zeros(0), states_at_rest(rest));
    let (mut squared, mut is_limited) = (0.0_f64, false);
    for i in 0..=CHECKS * (count - 1) {
        let t = i as f64 / (CHECKS * (count - 1)) as f64;
        let (mut torques, mut weights) = ([none; MAX_BLOCKS], [none; MAX_BLOCKS]);
        for (place, motion) in blocks.iter().zip(motions) {
            states[*place] = at_rest(&motion.at(t).q);
        }
        assembly.loads(&states, |i, of| weights[i] = of.torque);
        for (place, motion) in blocks.iter().zip(motions) {
            let Reference { q, qd, qdd } = motion.at(t);
            states[*place] = BlockState { q, qd, qdd };
        }
        assembly.loads(&states, |i, of| torques[i] = of.torque);
        for place in blocks {
            let (block, state) = (&assembly.blocks()[*place], &states[*place]);
            let motors = block.inertia.motors();
            let [rates, accelerations] = [&state.qd, &state.qdd].map(|of| motors.to_motors(of));
            for (k, drive) in block.machine.spec().drives.iter().enumerate() {
                if let Some(limit) = drive.torque_limit {
                    let (weight, motion) = (weights[*place][k], torques[*place][k] - weights[*place][k]);
                    let room = limit - weight * motion.signum();
                    if limit <= weight.abs() {
                        let said = format!(
                            "weight alone asks {:.4} N m of drive {} of {}: want other points",
                            weight.abs(),
                            drive.name,
                            block.name
                        );
                        return wrong("time", said);
                    }
                    squared = squared.max(motion.abs() / room);
                    is_limited = true;
                }
                if let Some(limit) = drive.speed_limit {
                    squared = squared.max((rates[k].abs() / limit).powi(2));
                    is_limited = true;
                }
                if let Some(limit) = drive.acceleration_limit {
                    squared = squared.max(accelerations[k].abs() / limit);
                    is_limited = true;
                }
            }
        }
    }
    let time = TIME_MARGIN * squared.sqrt();
    if !is_limited || time < TIME.low() {
        return wrong("time", "is not stated, and no drive that moves has a limit: want time, s");
    }
    if time > TIME.high() {
        let (time, most) = (significant(time), TIME.high());
        return wrong("time", format!("would be {time} s by the limits of the drives: want at most {most} s"));
    }
    Ok(time)
}

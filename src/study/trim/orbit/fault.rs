//! [`OrbitMeasurement`]: motions in orbit, tested for the usual mistakes of their columns.
//!
//! Two quantities speak for a fault: what a fit leaves unexplained of the base rate, and what each measured rate leaves of the
//! differences of its angle. Of the first, only what varies slowly counts: noise of the base rate is in absolute rates of the
//! drives, too, and a wrong hypothesis would explain noise by itself.

use nalgebra::DMatrix;

use super::delay::Delay;
use super::fit::OrbitFit;
use super::motion::{BASE_RATE, DEGREE, OrbitBase, OrbitMotion, RPM, raised};
use crate::trim::doubt::{
    Angles, ChannelFit, ColumnNames, DoubtSearch, FaultWords, FitTrial, NamedAngles, Residual, Suspected, angle_faults,
    limit_violation, list, zero_faults,
};
use crate::trim::error::TrimError;
use crate::trim::fit::IdentifiedNumbers;
use crate::trim::long_run::{bartlett_lags, correlation_length};
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::PerDrive;

/// Fraction of a rate that its angle need not explain: angles are rounded and noisy, and differences are not derivatives.
const RATE_FLOOR: f64 = 0.02;
/// Factor between the residuals of two fits that is no evidence of a fault.
pub(super) const SLACK: f64 = 2.0;
/// Residuals below this fraction of the base rate are rounding errors.
pub(super) const EXACT: f64 = 1e-6;
/// Number of standard deviations of a slow part of white noise that count as zero.
const SURE: f64 = 1.5;

/// Numbers of one row as the columns say.
struct Columns {
    /// Absolute angles, rad, and rates, rad/s, of the drives.
    angles: PerDrive,
    rates: PerDrive,
    /// Angle, rad, and rate, rad/s, of the base.
    attitude: f64,
    base_rate: f64,
    /// Absolute rate of the wheel, rad/s.
    wheel_rate: f64,
}

impl Columns {
    /// Maps angles and rates of the drives.
    fn map(&mut self, by: &Angles) {
        (self.angles, self.rates) = (by.angles(&self.angles), by.rates(&self.rates));
    }

    /// Adds angle and rate of the base to those of the drives, which were seen from it.
    fn add_base(&mut self) {
        (self.angles, self.rates) = (raised(&self.angles, self.attitude), raised(&self.rates, self.base_rate));
    }
}

/// Returns values of which one has the other sign.
fn reversed(of: &PerDrive, which: usize) -> PerDrive {
    PerDrive::from_fn(of.len(), |k| if k == which { -of[k] } else { of[k] })
}

/// A mistake, and the motion corrected for it.
pub(super) struct OrbitFault {
    words: FaultWords,
    correction: Correction,
}

/// How a mistake is undone.
enum Correction {
    /// Row by row.
    Row(Box<dyn Fn(&mut Columns) + Send + Sync>),
    Delay(Delay),
}

/// Motions that are tested for faults.
pub(super) struct OrbitMeasurement {
    base: OrbitBase,
    motions: Vec<OrbitMotion>,
}

impl OrbitMeasurement {
    /// Fits motions as given, and begins the search for faults.
    ///
    /// # Errors
    /// As [`OrbitFit::of`].
    pub fn search(machine: &Machine, base: OrbitBase, motions: &[OrbitMotion]) -> Result<DoubtSearch<Self>, TrimError> {
        let given = tried(machine, &base, motions)?;
        let has_wheel = motions.iter().flat_map(|motion| &motion.wheel_rate).any(|rate| *rate != 0.0);
        let mut faults = OrbitFault::all(machine, &given.numbers, has_wheel);
        let delays = Delay::all(machine, &base, motions);
        faults.extend(
            delays.into_iter().map(|delay| OrbitFault { words: delay.words(), correction: Correction::Delay(delay) }),
        );
        let measured = Self { base, motions: motions.to_vec() };
        Ok(DoubtSearch::of(machine, measured, given, faults))
    }
}

impl Suspected for OrbitMeasurement {
    type Fault = OrbitFault;

    fn words(fault: &OrbitFault) -> &FaultWords {
        &fault.words
    }

    fn without(&self, machine: &Machine, given: &FitTrial, fault: &OrbitFault) -> Option<(FitTrial, Option<FitTrial>)> {
        let motions: Vec<OrbitMotion> = self.motions.iter().map(|motion| fault.undo(motion)).collect();
        let other = tried(machine, &self.base, &motions).ok()?;
        // What explains the rates worse is no explanation, however near to the file it comes.
        let [was, now] = [given, &other].map(|fit| &fit.channels[0]);
        let floor = was.floor.max(now.floor).max(EXACT);
        (now.residual.share <= SLACK * was.residual.share.max(floor)).then_some((other, None))
    }
}

fn tried(machine: &Machine, base: &OrbitBase, motions: &[OrbitMotion]) -> Result<FitTrial, TrimError> {
    let thinned = OrbitMotion::thinned(motions);
    let fit = OrbitFit::of(machine, base, &thinned)?;
    let (slow, size) = (fit.slow_noise(), fit.size.max(f64::MIN_POSITIVE));
    // By chance, a part of white noise varies slowly, too.
    let floor = SURE * (2.0 / (fit.errors.len() as f64).sqrt()).sqrt() * white_noise(&thinned) / size;
    let rate = ChannelFit {
        residual: Residual { unit: format!("rad/s of {BASE_RATE}"), noise: fit.noise, share: slow / size },
        effective: fit.effective,
        largest: fit.largest,
        floor,
        slack: SLACK,
    };
    let names = machine.spec().drives.iter().map(|drive| format!("rate/{}", drive.name));
    let names = [BASE_RATE.to_owned()].into_iter().chain(names);
    let channels = [rate].into_iter().chain(names.enumerate().map(|(k, name)| rate_against_angle(motions, k, &name)));
    Ok(FitTrial {
        channels: channels.collect(),
        share: (fit.effective - fit.rank as f64) / fit.effective,
        limit_violation: limit_violation(machine, motions.iter().flat_map(|motion| &motion.angles)),
        numbers: fit.numbers,
    })
}

/// Returns the standard deviation of the noise of the base rate, rad/s, by fourth differences: the same for all faults.
fn white_noise(motions: &[OrbitMotion]) -> f64 {
    let differences = || {
        let rows = motions.iter().flat_map(|motion| motion.base_rate.windows(5));
        rows.map(|rate| (rate[0] - 4.0 * (rate[1] + rate[3]) + 6.0 * rate[2] + rate[4]).powi(2) / 70.0)
    };
    (differences().sum::<f64>() / differences().count().max(1) as f64).sqrt()
}

/// Compares the rate of the base, 0, or of drive k, k + 1, with the differences of its angle.
fn rate_against_angle(motions: &[OrbitMotion], of: usize, name: &str) -> ChannelFit {
    let counts: Vec<usize> = motions.iter().map(|motion| motion.rows() - 1).collect();
    let at = |motion: &OrbitMotion, row: usize| match of.checked_sub(1) {
        None => [motion.attitude[row], motion.base_rate[row]],
        Some(k) => [motion.angles[row][k] + motion.attitude[row], motion.rates[row][k] + motion.base_rate[row]],
    };
    let (mut errors, mut size) = (Vec::new(), 0.0);
    for motion in motions {
        for row in 1..motion.rows() {
            let ([before, earlier], [q, rate]) = (at(motion, row - 1), at(motion, row));
            let mean = 0.5 * (earlier + rate);
            errors.push((q - before) / (motion.t[row] - motion.t[row - 1]) - mean);
            size += mean * mean;
        }
    }
    let count = errors.len();
    let lags = bartlett_lags(&[errors.as_slice()], &counts, 1);
    let errors = DMatrix::from_vec(count, 1, errors);
    let [noise, size] = [errors.norm_squared(), size].map(|sum| (sum / count.max(1) as f64).sqrt());
    ChannelFit {
        residual: Residual {
            unit: format!("rad/s of {name} against its angle"),
            noise,
            share: noise / size.max(f64::MIN_POSITIVE),
        },
        effective: count as f64 / correlation_length(&errors, &counts, lags, 1),
        largest: size,
        floor: RATE_FLOOR,
        slack: SLACK,
    }
}

/// Returns the names of the columns of angles.
pub(super) fn column_names(machine: &Machine) -> ColumnNames {
    ColumnNames {
        angles: machine.spec().drives.iter().map(|drive| format!("angle/{}", drive.name)).collect(),
        with: "with rates",
        base_angle: Some("attitude/base"),
    }
}

impl OrbitFault {
    fn of(
        what: impl Into<String>,
        want: impl Into<String>,
        correct: impl Fn(&mut Columns) + Send + Sync + 'static,
    ) -> Self {
        let words = FaultWords { what: what.into(), want: want.into(), mistakes: 1 };
        Self { words, correction: Correction::Row(Box::new(correct)) }
    }

    fn of_angles((words, by): NamedAngles) -> Self {
        Self { words, correction: Correction::Row(Box::new(move |row| row.map(&by))) }
    }

    /// Returns all faults that are tested: angles and rates of the drives that count from elsewhere, the other way, in
    /// another order or unit; the same of the base and its wheel.
    fn all(machine: &Machine, numbers: &IdentifiedNumbers, has_wheel: bool) -> Vec<Self> {
        let names = |what: &str| -> Vec<String> {
            machine.spec().drives.iter().map(|drive| format!("{what}/{}", drive.name)).collect()
        };
        let (angles, rates) = (names("angle"), names("rate"));
        let n = angles.len();
        let columns = column_names(machine);
        let mut all: Vec<Self> = angle_faults(machine, &columns).into_iter().map(Self::of_angles).collect();
        all.extend(zero_faults(machine, numbers, &columns).into_iter().map(Self::of_angles));
        let add = format!("attitude/base added to each angle, and {BASE_RATE} to each rate");
        all.push(Self::of(
            "the drives are measured relative to the base, not to space",
            add.clone(),
            Columns::add_base,
        ));
        if n > 1 {
            let sums = Angles::linear(n, |k, l| if l <= k { 1.0 } else { 0.0 });
            let first = format!("{} relative to the base and {} to the drive before", angles[0], list(&angles[1..]));
            let want = format!("absolute ones: in each row, sums of the angles up to each drive, and {add}");
            all.push(Self::of(first, want, move |row| {
                row.map(&sums);
                row.add_base();
            }));
            if let Some((words, by)) = columns.relative_of_file(machine) {
                let what = format!("{}, and {} is relative to the base", words.what, angles[0]);
                let want = format!("{}, with {add}", words.want);
                all.push(Self::of(what, want, move |row| {
                    row.map(&by);
                    row.add_base();
                }));
            }
        }
        // Rates alone, unlike their angles.
        for (k, l) in Inertia::pairs(n) {
            let [one, other] = [&rates[k], &rates[l]];
            let want = format!("the names {one} and {other} exchanged in the header");
            all.push(Self::of(format!("{one} and {other} are exchanged, their angles are not"), want, move |row| {
                (row.rates[k], row.rates[l]) = (row.rates[l], row.rates[k]);
            }));
        }
        for (k, rate) in rates.iter().enumerate() {
            all.push(Self::of(format!("{rate} has the wrong sign"), format!("{rate} times −1"), move |row| {
                row.rates = reversed(&row.rates, k);
            }));
        }
        let in_degrees = |unit: &str, column: &str| format!("the unit in the header, as {column} ({unit})");
        // Angles alone, unlike their rates.
        for (k, angle) in angles.iter().enumerate() {
            all.push(Self::of(format!("{angle} has the wrong sign"), format!("{angle} times −1"), move |row| {
                row.angles = reversed(&row.angles, k);
            }));
        }
        all.extend([
            Self::of(
                "the angles of the drives are measured relative to the base, their rates are not",
                "attitude/base added to each angle",
                |row| row.angles = raised(&row.angles, row.attitude),
            ),
            Self::of(
                format!("{} are in degrees, their rates are not", list(&angles)),
                in_degrees("deg", &angles[0]),
                |row| row.angles = row.angles.scaled(DEGREE),
            ),
            Self::of("attitude/base has the wrong sign", "attitude/base times −1", |row| {
                row.attitude = -row.attitude
            }),
            Self::of("attitude/base is in degrees, its rate is not", in_degrees("deg", "attitude/base"), |row| {
                row.attitude *= DEGREE;
            }),
        ]);
        let turn = |factor: f64| {
            move |row: &mut Columns| {
                (row.attitude, row.base_rate) = (factor * row.attitude, factor * row.base_rate);
            }
        };
        let both = format!("attitude/base and {BASE_RATE}");
        let degrees = |row: &mut Columns| {
            (row.angles, row.rates) = (row.angles.scaled(DEGREE), row.rates.scaled(DEGREE));
        };
        all.extend([
            Self::of(format!("{both} count the other way"), format!("{both} times −1"), turn(-1.0)),
            Self::of(format!("{BASE_RATE} has the wrong sign"), format!("{BASE_RATE} times −1"), |row| {
                row.base_rate = -row.base_rate;
            }),
            Self::of(
                format!("{both} are in degrees, not in radians"),
                in_degrees("deg", "attitude/base"),
                turn(DEGREE),
            ),
            Self::of(
                format!("{BASE_RATE} is in degrees per second, not in rad/s"),
                in_degrees("deg/s", BASE_RATE),
                |row| row.base_rate *= DEGREE,
            ),
            Self::of(
                "angles and rates of drives and base are in degrees, not in radians",
                in_degrees("deg", "attitude/base"),
                move |row| {
                    degrees(row);
                    turn(DEGREE)(row);
                },
            ),
            Self::of(
                format!("{} are in degrees per second, not in rad/s", list(&rates)),
                in_degrees("deg/s", &rates[0]),
                |row| row.rates = row.rates.scaled(DEGREE),
            ),
        ]);
        if has_wheel {
            let relative = format!("{BASE_RATE} added to wheel/rate");
            all.extend([
                Self::of("wheel/rate is relative to the base, not to space", relative, |row| {
                    row.wheel_rate += row.base_rate;
                }),
                Self::of("wheel/rate has the wrong sign", "wheel/rate times −1", |row| {
                    row.wheel_rate = -row.wheel_rate
                }),
                Self::of("wheel/rate is in turns per minute, not in rad/s", in_degrees("rpm", "wheel/rate"), |row| {
                    row.wheel_rate *= RPM;
                }),
            ]);
        }
        all
    }

    /// Returns a motion corrected for this fault.
    fn undo(&self, motion: &OrbitMotion) -> OrbitMotion {
        let correct = match &self.correction {
            Correction::Row(correct) => correct,
            Correction::Delay(delay) => return delay.undo(motion),
        };
        let mut all = motion.clone();
        for row in 0..motion.rows() {
            let [turn, rate] = [motion.attitude[row], motion.base_rate[row]];
            let mut columns = Columns {
                angles: raised(&motion.angles[row], turn),
                rates: raised(&motion.rates[row], rate),
                attitude: turn,
                base_rate: rate,
                wheel_rate: motion.wheel_rate[row],
            };
            correct(&mut columns);
            all.attitude[row] = columns.attitude;
            all.base_rate[row] = columns.base_rate;
            all.angles[row] = raised(&columns.angles, -columns.attitude);
            all.rates[row] = raised(&columns.rates, -columns.base_rate);
            all.wheel_rate[row] = columns.wheel_rate;
        }
        all
    }
}

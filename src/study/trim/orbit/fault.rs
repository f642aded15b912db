//! [`OrbitMeasurement`]: motions in orbit, tested for the usual mistakes of their columns.
//!
//! Two quantities speak for a fault: what a fit leaves unexplained of the base rate, and what each measured rate leaves of the
//! differences of its angle. Of the first, only what varies slowly counts: noise of the base rate is in absolute rates of the
//! drives, too, and a wrong hypothesis would explain noise by itself.

use std::sync::Arc;

use nalgebra::DMatrix;

use super::consistency::noise;
use super::delay::Delay;
use super::fit::OrbitFit;
use super::motion::{BASE_RATE, DEGREE, OrbitBase, OrbitMotion, RPM, raised};
use crate::trim::doubt::{
    Angles, ChannelFit, ColumnNames, DoubtSearch, FaultWords, FitTrial, NamedAngles, Residual, Suspected, angle_faults,
    limit_violation, list, nearest_zeros, own_zeros, zero_faults, zeros_in_words,
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
/// Factor on the standard deviation of the slow part of white noise that counts as zero.
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
    Row(RowCorrection),
    /// Row by row, then what the angles lack.
    RowThenZeros(RowCorrection, Angles),
    /// What the angles of each motion lack.
    Zeros(Vec<Angles>),
    Delay(Delay),
}

/// Corrects the numbers of a row.
type RowCorrection = Arc<dyn Fn(&mut Columns) + Send + Sync>;

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
        faults.extend(OrbitFault::encoders_with_zeros(machine, &base, motions));
        faults.extend(zeros_of_motions(machine, &base, motions));
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
        let motions = self.motions.iter().enumerate();
        let motions: Vec<OrbitMotion> = motions.map(|(i, motion)| fault.undo(i, motion)).collect();
        let other = tried(machine, &self.base, &motions).ok()?;
        // What explains the rates worse is no explanation, however near to the file it comes.
        let [was, now] = [given, &other].map(|fit| &fit.channels[0]);
        let floor = was.floor.max(now.floor).max(EXACT);
        (now.residual.share <= SLACK * was.residual.share.max(floor)).then_some((other, None))
    }
}

/// Returns the standard deviation of the noise of the base rate, rad/s.
fn white_noise(motions: &[OrbitMotion]) -> f64 {
    let rows: usize = motions.iter().map(OrbitMotion::rows).sum();
    let squares = motions.iter().map(|motion| motion.rows() as f64 * noise(&motion.base_rate).powi(2));
    (squares.sum::<f64>() / rows.max(1) as f64).sqrt()
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

/// Maximum number of Gauss–Newton steps for the zeros of motions, and the change that ends them, rad.
const ZERO_STEPS: usize = 6;
const LAST_ZERO_CHANGE: f64 = 1e-6;
/// Change of a zero for derivatives, rad.
const ZERO_CHANGE: f64 = 1e-5;

/// Returns the fault that each of several motions counts its angles from zeros of its own; `None` if there is one motion, or if
/// one of them does not tell its zeros.
fn zeros_of_motions(machine: &Machine, base: &OrbitBase, motions: &[OrbitMotion]) -> Option<OrbitFault> {
    let (columns, n) = (column_names(machine), machine.drives());
    if motions.len() < 2 {
        return None;
    }
    let motions = &OrbitMotion::thinned(motions);
    // Each alone tells its own phases, then all together what is left between them.
    let alone = |motion: &OrbitMotion| {
        let fit = OrbitFit::of(machine, base, std::slice::from_ref(motion)).ok()?;
        own_zeros(machine, &fit.numbers)
    };
    let mut zeros: Vec<PerDrive> = motions.iter().map(alone).collect::<Option<_>>()?;
    let undone = |zeros: &[PerDrive]| {
        let shifted = motions.iter().zip(zeros).map(|(motion, zeros)| {
            let by = Angles::shifted(*zeros);
            corrected(motion, &|row| row.map(&by))
        });
        shifted.collect::<Vec<_>>()
    };
    for _ in 0..ZERO_STEPS {
        let fit = OrbitFit::of(machine, base, &undone(&zeros)).ok()?;
        let changed = (0..motions.len() * n).map(|place| {
            let mut changed = zeros.clone();
            changed[place / n][place % n] += ZERO_CHANGE;
            undone(&changed)
        });
        let step = fit.parameters(changed, ZERO_CHANGE)?;
        (0..step.len()).for_each(|place| zeros[place / n][place % n] += step[place]);
        if step.amax() < LAST_ZERO_CHANGE {
            break;
        }
    }
    let each = |(i, zeros): (usize, &PerDrive)| format!("motion {}: {}", i + 1, zeros_in_words(&columns, zeros));
    let want: Vec<String> = zeros.iter().enumerate().map(each).collect();
    let words = FaultWords {
        what: "each motion counts its angles from zeros of its own, as of encoders set to zero at its start".into(),
        want: format!("zeros as in the file, by its masses: {}", want.join("; ")),
        mistakes: n * motions.len(),
    };
    Some(OrbitFault { words, correction: Correction::Zeros(zeros.into_iter().map(Angles::shifted).collect()) })
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
        Self { words, correction: Correction::Row(Arc::new(correct)) }
    }

    fn of_angles((words, by): NamedAngles) -> Self {
        Self { words, correction: Correction::Row(Arc::new(move |row| row.map(&by))) }
    }

    /// Returns the faults of drives that are measured relative to the base, or each to the drive before.
    fn relative_encoders(machine: &Machine) -> Vec<Self> {
        let columns = column_names(machine);
        let (angles, n) = (&columns.angles, columns.angles.len());
        let add = format!("attitude/base added to each angle, and {BASE_RATE} to each rate");
        let mut all = vec![Self::of(
            "the drives are measured relative to the base, not to space",
            add.clone(),
            Columns::add_base,
        )];
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
        all
    }

    /// Returns the same faults of encoders that count from other zeros, too: those that bring the numbers nearest to the file.
    fn encoders_with_zeros(machine: &Machine, base: &OrbitBase, motions: &[OrbitMotion]) -> Vec<Self> {
        let (columns, motions) = (column_names(machine), OrbitMotion::thinned(motions));
        let with_zeros = |fault: Self| {
            let undone: Vec<OrbitMotion> = motions.iter().map(|motion| fault.undo(0, motion)).collect();
            let fit = OrbitFit::of(machine, base, &undone).ok()?;
            let (zeros, by) = nearest_zeros(machine, &fit.numbers, &columns)?;
            let Correction::Row(correct) = fault.correction else { return None };
            let words = FaultWords {
                what: format!("{}, and {}", fault.words.what, zeros.what),
                want: format!("{}; then {}", fault.words.want, zeros.want),
                mistakes: fault.words.mistakes + zeros.mistakes,
            };
            Some(Self { words, correction: Correction::RowThenZeros(correct, by) })
        };
        Self::relative_encoders(machine).into_iter().filter_map(with_zeros).collect()
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
        all.extend(Self::relative_encoders(machine));
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
                "the rates of the drives are measured relative to the base, their angles are not",
                format!("{BASE_RATE} added to each rate"),
                |row| row.rates = raised(&row.rates, row.base_rate),
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

    /// Returns the i-th motion corrected for this fault.
    fn undo(&self, i: usize, motion: &OrbitMotion) -> OrbitMotion {
        match &self.correction {
            Correction::Row(correct) => corrected(motion, correct.as_ref()),
            Correction::RowThenZeros(correct, zeros) => corrected(motion, &|row| {
                correct(row);
                row.map(zeros);
            }),
            Correction::Zeros(each) => corrected(motion, &|row| row.map(&each[i])),
            Correction::Delay(delay) => delay.undo(motion),
        }
    }
}

/// Returns a motion with each row corrected.
fn corrected(motion: &OrbitMotion, correct: &dyn Fn(&mut Columns)) -> OrbitMotion {
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

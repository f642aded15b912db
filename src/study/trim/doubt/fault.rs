//! [`Fault`]: a possible mistake of a user or fault of a sensor, and the measurement corrected for it.
//!
//! # Symbols
//! | letter | meaning |
//! |---|---|
//! | A, b | the true angles are A q + b, where q are the given angles; rates are A q̇, accelerations A q̈ |
//! | u | the true force is u f or u conj(f), where f is the given force as a complex number |
//! | s | the true moment is s n, where n is the given moment |

use super::doubting::FaultWords;
use super::zeros::zero_faults;
use crate::trim::fit::IdentifiedNumbers;
use crate::trim::{MeasuredMotion, MeasurementSet};
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::{PerDrive, Vector};

/// A fault: its description, the remedy, and the correction of the measurement.
#[derive(Clone, Debug)]
pub(in crate::trim) struct Fault {
    /// Description and remedy.
    pub words: FaultWords,
    /// Correction of the angles; `None` if only force and moment are affected.
    pub angles: Option<Angles>,
    /// Factor u, and whether f is conjugated.
    force: (Vector, bool),
    /// Factor s.
    moment: f64,
}

/// The correction of angles: matrix A by rows, and offset b.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::trim) struct Angles {
    rows: Vec<PerDrive>,
    offset: PerDrive,
}

impl Angles {
    pub fn linear(n: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let rows = (0..n).map(|k| PerDrive::from_fn(n, |l| entry(k, l))).collect();
        Self { rows, offset: PerDrive::zeros(n) }
    }

    /// Returns the correction of angles that lack an offset, rad.
    pub fn shifted(offset: PerDrive) -> Self {
        let n = offset.len();
        Self { offset, ..Self::linear(n, |k, l| if k == l { 1.0 } else { 0.0 }) }
    }

    /// Returns A x: corrected rates.
    pub fn rates(&self, x: &PerDrive) -> PerDrive {
        PerDrive::from_fn(self.rows.len(), |k| self.rows[k].dot(x))
    }

    /// Returns A x + b: corrected angles.
    pub fn angles(&self, x: &PerDrive) -> PerDrive {
        self.rates(x).plus(1.0, &self.offset)
    }

    /// Returns the recording with corrected angles.
    pub fn undo(&self, recording: &MeasurementSet) -> MeasurementSet {
        let motion = |motion: &MeasuredMotion| {
            let each = |all: &[PerDrive]| all.iter().map(|x| self.rates(x)).collect::<Vec<_>>();
            let q = motion.q.iter().map(|q| self.angles(q)).collect();
            MeasuredMotion { q, qd: each(&motion.qd), qdd: each(&motion.qdd), ..motion.clone() }
        };
        MeasurementSet { motions: recording.motions.iter().map(motion).collect() }
    }
}

impl Fault {
    /// Returns the corrected force and moment.
    pub fn undo(&self, force: Vector, moment: f64) -> (Vector, f64) {
        let (u, mirrored) = self.force;
        (u * if mirrored { force.conj() } else { force }, self.moment * moment)
    }

    /// Returns all faults that are tested. For force and moment: signs, order and units. For the angles: signs, the
    /// exchange of any two, degrees for radians and the reverse, and relative angles. With up to four drives also
    /// cyclic exchanges of three. With eight drives there are at most 79.
    ///
    /// `numbers` are those of the fit as given: they tell from which zeros the angles may count.
    pub fn all(machine: &Machine, numbers: &IdentifiedNumbers) -> Vec<Self> {
        let columns = ColumnNames {
            angles: (0..machine.drives()).map(|k| format!("q{}", k + 1)).collect(),
            with: "with rates and accelerations",
            base_angle: None,
        };
        let of_angles =
            |(words, angles)| Self { words, angles: Some(angles), force: (Vector::new(1.0, 0.0), false), moment: 1.0 };
        let mut all = frames();
        all.extend(units());
        all.extend(angle_faults(machine, &columns).into_iter().map(of_angles));
        all.extend(zero_faults(machine, numbers, &columns).into_iter().map(of_angles));
        all
    }
}

/// Names of the columns of angles in messages.
pub(in crate::trim) struct ColumnNames {
    /// Name of the column of each drive.
    pub angles: Vec<String>,
    /// The columns that change with those of the angles, as "with rates".
    pub with: &'static str,
    /// Name of the column of the angle of a base that floats.
    pub base_angle: Option<&'static str>,
}

/// A fault of the angles, and their correction.
pub(in crate::trim) type NamedAngles = (FaultWords, Angles);

/// Returns the faults of the angles: signs, the exchange of any two, degrees for radians and the reverse, and relative
/// angles. With up to four drives also cyclic exchanges of three.
pub(in crate::trim) fn angle_faults(machine: &Machine, columns: &ColumnNames) -> Vec<NamedAngles> {
    let n = machine.drives();
    let mut all: Vec<NamedAngles> =
        (0..n).map(|k| columns.reversed(|l| l == k, &format!("{} counts the other way", columns.angles[k]))).collect();
    if n > 1 {
        all.push(columns.reversed(|_| true, "all angles count the other way"));
    }
    all.extend(orders(n).into_iter().map(|order| columns.reordered(&order)));
    let degree = std::f64::consts::PI / 180.0;
    all.push(columns.degrees(degree, true));
    // In orbit, only a header turns degrees into radians.
    all.extend(columns.base_angle.is_none().then(|| columns.degrees(degree.recip(), false)));
    if n > 1 {
        all.push(columns.relative());
        all.extend(columns.relative_of_file(machine));
    }
    all
}

/// Returns a fault of force and moment only.
fn channels(what: &str, want: &str, mistakes: usize, force: (Vector, bool), moment: f64) -> Fault {
    Fault { words: FaultWords { what: what.into(), want: want.into(), mistakes }, angles: None, force, moment }
}

/// Returns a fault of the angles only.
fn of_angles(what: String, want: String, angles: Angles) -> NamedAngles {
    (FaultWords { what, want, mistakes: 1 }, angles)
}

/// Returns the faults of all sensor frames with axes parallel to those of the base, in any order and sense.
fn frames() -> Vec<Fault> {
    let one = Vector::new(1.0, 0.0);
    let i = Vector::i();
    let swap = "the names fx and fy exchanged in the header";
    let turned = "the force sensor is turned by 90°";
    vec![
        channels("nz has the wrong sign", "nz times −1", 1, (one, false), -1.0),
        channels("fx has the wrong sign", "fx times −1", 1, (-one, true), 1.0),
        channels("fy has the wrong sign", "fy times −1", 1, (one, true), 1.0),
        channels("fx and fy are exchanged", swap, 1, (i, true), 1.0),
        channels(
            "fx, fy and nz have the wrong sign, as of a sensor that reads the force of the base on the machine",
            "fx, fy and nz times −1",
            1,
            (-one, false),
            -1.0,
        ),
        channels("fx and fy have the wrong sign", "fx and fy times −1", 1, (-one, false), 1.0),
        channels(turned, "the column fx as fy, and the column fy times −1 as fx", 2, (i, false), 1.0),
        channels(turned, "the column fy as fx, and the column fx times −1 as fy", 2, (-i, false), 1.0),
        channels(
            "fx and fy are exchanged and have the wrong sign",
            &format!("{swap}, both times −1"),
            2,
            (-i, true),
            1.0,
        ),
        channels(
            "fx and nz have the wrong sign, as of a sensor upside down",
            "fx and nz times −1",
            2,
            (-one, true),
            -1.0,
        ),
        channels(
            "fy and nz have the wrong sign, as of a sensor upside down",
            "fy and nz times −1",
            2,
            (one, true),
            -1.0,
        ),
        channels(
            "fx and fy are exchanged and nz has the wrong sign, as of a sensor upside down",
            &format!("{swap}, and nz times −1"),
            2,
            (i, true),
            -1.0,
        ),
        channels(
            &format!("{turned} and nz has the wrong sign"),
            "the column fx as fy, the column fy times −1 as fx, and nz times −1",
            2,
            (i, false),
            -1.0,
        ),
        channels(
            &format!("{turned} and nz has the wrong sign"),
            "the column fy as fx, the column fx times −1 as fy, and nz times −1",
            2,
            (-i, false),
            -1.0,
        ),
        channels(
            "fx and fy are exchanged, and fx, fy and nz have the wrong sign",
            &format!("{swap}, and fx, fy and nz times −1"),
            2,
            (-i, true),
            -1.0,
        ),
    ]
}

fn units() -> Vec<Fault> {
    // The force of imbalance may have any size, so it is weak evidence of its unit.
    let scaled = |what: &str, want: &str, force: f64, moment: f64| {
        let mistakes = if force == 1.0 { 1 } else { 3 };
        channels(what, want, mistakes, (Vector::new(force, 0.0), false), moment)
    };
    let named = |unit: &str| format!("the unit in the header, as {unit}");
    vec![
        scaled("nz is in N mm, not in N m", &named("nz (N mm)"), 1.0, 1e-3),
        scaled("nz is in kN m, not in N m", &named("nz (kN m)"), 1.0, 1e3),
        scaled("fx and fy are in mN, not in N", &named("fx (mN)"), 1e-3, 1.0),
        scaled("fx and fy are in kN, not in N", &named("fx (kN)"), 1e3, 1.0),
        scaled(
            "force and moment are in mN and mN m, or masses of the machine's file in t",
            "units in the header, as fx (mN) and nz (mN m), and kg in the machine's file",
            1e-3,
            1e-3,
        ),
        // Masses in g are numbers a thousand times too large, so the measurement seems a thousand times too small.
        scaled(
            "force and moment are in kN and kN m, or masses of the machine's file in g",
            "units in the header, as fx (kN) and nz (kN m), and kg in the machine's file",
            1e3,
            1e3,
        ),
        scaled("lengths of the machine's file are in mm", "m and kg m² in the machine's file", 1e3, 1e6),
    ]
}

/// Returns the orders of columns that are tested: the true angle of drive k is in column `order[k]`.
fn orders(n: usize) -> Vec<Vec<usize>> {
    let exchanged = |moves: &[(usize, usize)]| {
        let mut order: Vec<usize> = (0..n).collect();
        moves.iter().for_each(|(k, l)| order.swap(*k, *l));
        order
    };
    let pairs: Vec<(usize, usize)> = Inertia::pairs(n).collect();
    let mut all: Vec<Vec<usize>> = pairs.iter().map(|pair| exchanged(&[*pair])).collect();
    if n <= 4 {
        for &(k, l) in &pairs {
            (l + 1..n).for_each(|m| all.extend([exchanged(&[(k, l), (l, m)]), exchanged(&[(l, m), (k, l)])]));
        }
    }
    all
}

impl ColumnNames {
    fn reversed(&self, which: impl Fn(usize) -> bool, what: &str) -> NamedAngles {
        let n = self.angles.len();
        let names: Vec<String> = (0..n).filter(|k| which(*k)).map(|k| self.angles[k].clone()).collect();
        let angles = Angles::linear(n, |k, l| {
            if k != l {
                0.0
            } else if which(k) {
                -1.0
            } else {
                1.0
            }
        });
        of_angles(what.into(), format!("{} times −1, {}", list(&names), self.with), angles)
    }

    fn reordered(&self, order: &[usize]) -> NamedAngles {
        let moved: Vec<usize> = (0..order.len()).filter(|k| order[*k] != *k).collect();
        let names =
            |of: &dyn Fn(usize) -> usize| list(&moved.iter().map(|k| self.angles[of(*k)].clone()).collect::<Vec<_>>());
        let (here, there) = (names(&|k| order[k]), names(&|k| k));
        let what = match moved.len() {
            2 => format!("{there} are exchanged"),
            _ => format!("{here} stand in the place of {there}"),
        };
        let angles = Angles::linear(order.len(), |k, l| if order[k] == l { 1.0 } else { 0.0 });
        of_angles(what, format!("the columns {here} named {there} in the header, {}", self.with), angles)
    }

    fn degrees(&self, scale: f64, are_degrees: bool) -> NamedAngles {
        let [is, not, unit] = if are_degrees { ["degrees", "radians", "deg"] } else { ["radians", "degrees", "rad"] };
        let angles = Angles::linear(self.angles.len(), |k, l| if k == l { scale } else { 0.0 });
        of_angles(
            format!("the angles are in {is}, not in {not}"),
            format!("the unit in the header, as {} ({unit})", self.angles[0]),
            angles,
        )
    }

    /// Returns the fault that each angle is relative to the preceding drive.
    fn relative(&self) -> NamedAngles {
        let (n, names) = (self.angles.len(), &self.angles[1..]);
        let what = format!("{} are relative angles, each seen from the drive before", list(names));
        let [first, second] = [&self.angles[0], &self.angles[1]];
        let want =
            format!("absolute ones: add {first} to {second}, then the new {second} to the next, and so on, row by row");
        of_angles(
            if n == 2 { format!("{second} is a relative angle, seen from drive 1") } else { what },
            if n == 2 { format!("an absolute one: {first} + {second} in each row") } else { want },
            Angles::linear(n, |k, l| if l <= k { 1.0 } else { 0.0 }),
        )
    }

    /// Returns the fault that the columns after the first contain the relative angles of the machine's file, in its order;
    /// `None` if these do not determine all drives.
    pub fn relative_of_file(&self, machine: &Machine) -> Option<NamedAngles> {
        let (n, angles) = (machine.drives(), machine.angles());
        if angles.len() + 1 != n {
            return None;
        }
        let mut known: Vec<Option<(PerDrive, f64)>> = vec![None; n];
        known[0] = Some((PerDrive::from_fn(n, |l| if l == 0 { 1.0 } else { 0.0 }), 0.0));
        // Each pass finds at least one more drive, unless no further drive can be found.
        for _ in 1..n {
            for (i, angle) in angles.iter().enumerate() {
                let own = |by: f64| PerDrive::from_fn(n, |l| if l == i + 1 { by } else { 0.0 });
                match (known[angle.from], known[angle.to]) {
                    (Some((row, offset)), None) => {
                        known[angle.to] = Some((row.plus(1.0, &own(1.0)), offset - angle.offset));
                    }
                    (None, Some((row, offset))) => {
                        known[angle.from] = Some((row.plus(-1.0, &own(1.0)), offset + angle.offset));
                    }
                    _ => {}
                }
            }
        }
        let known: Vec<(PerDrive, f64)> = known.into_iter().collect::<Option<_>>()?;
        let names: Vec<String> = angles.iter().map(|angle| angle.name.clone()).collect();
        let offset = PerDrive::from_fn(n, |k| known[k].1);
        let map = Angles { rows: known.into_iter().map(|(row, _)| row).collect(), offset };
        let what =
            format!("{} hold the relative angles {} of the machine's file", list(&self.angles[1..]), list(&names));
        Some(of_angles(what, "absolute drive angles".into(), map))
    }
}

/// Joins names to a list in words.
pub(in crate::trim) fn list(names: &[String]) -> String {
    match names {
        [rest @ .., last] if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => names.concat(),
    }
}

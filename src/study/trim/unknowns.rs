//! [`Unknowns`]: the unknowns of a measurement, and their linear relation to force, moment and momentum.

use stillbase_mechanics::balance::Condition;
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::{PerDrive, UnitVectors, Vector, cross};

/// Part of a complex coefficient of (7) or (8).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ComplexPart {
    /// Real part: masses on the axes of the links.
    Along,
    /// Imaginary part: masses off the axes of the links.
    Across,
}

/// One of the unknowns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unknown {
    /// A part of a coefficient of (7), kg m, or of (8), kg m².
    Of(Condition, ComplexPart),
    /// The momentum coefficient D_k, kg m².
    Momentum(usize),
}

impl Unknown {
    /// Returns the name, with the names of its drives.
    pub fn name(self, machine: &Machine) -> String {
        let drive = |k: usize| &machine.spec().drives[k].name;
        let part = |part: ComplexPart| if part == ComplexPart::Along { "along" } else { "across" };
        match self {
            Self::Of(Condition::Force(k), of) => format!("g {} {}", drive(k), part(of)),
            Self::Of(Condition::Coupling(k, l), of) => format!("C {},{} {}", drive(k), drive(l), part(of)),
            Self::Momentum(k) => format!("D {}", drive(k)),
        }
    }

    /// Returns the unit.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Of(condition, _) => condition.unit(),
            Self::Momentum(_) => "kg m²",
        }
    }
}

/// Differences below this fraction of the scale of an unknown are rounding errors.
const ROUNDING: f64 = 1e-9;

/// The unknowns for n drives: the parts along and across of each line of (7), then of (8), then every D_k.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknowns {
    drives: usize,
    conditions: Vec<Condition>,
}

impl Unknowns {
    /// Returns the unknowns of a machine with a number of drives.
    pub fn of(drives: usize) -> Self {
        Self { drives, conditions: Condition::all(drives).collect() }
    }

    /// Returns the number of drives.
    pub fn drives(&self) -> usize {
        self.drives
    }

    /// Returns the conditions (7), then (8), in their order.
    pub fn conditions(&self) -> &[Condition] {
        &self.conditions
    }

    /// Returns the number of unknowns.
    pub fn count(&self) -> usize {
        2 * self.conditions.len() + self.drives
    }

    /// Returns the number of unknowns of (7) and (8), which come first.
    pub fn of_balance(&self) -> usize {
        2 * self.conditions.len()
    }

    /// Returns the unknown at an index.
    pub fn at(&self, place: usize) -> Unknown {
        let part = if place.is_multiple_of(2) { ComplexPart::Along } else { ComplexPart::Across };
        match self.conditions.get(place / 2) {
            Some(condition) => Unknown::Of(*condition, part),
            None => Unknown::Momentum(place - self.of_balance()),
        }
    }

    /// Returns the values of a machine.
    pub fn nominal(&self, inertia: &Inertia) -> Vec<f64> {
        let parts =
            self.conditions.iter().map(|condition| condition.residual(inertia)).flat_map(|left| [left.re, left.im]);
        parts.chain((0..self.drives).map(|k| inertia.momentum(k))).collect()
    }

    /// Returns a scale for each unknown: √(M Σ H_kk) for lines of (7), kg m, and Σ H_kk for the others, kg m².
    pub fn scales(&self, inertia: &Inertia) -> Vec<f64> {
        let turning = (0..self.drives).map(|k| inertia.diagonal(k)).sum::<f64>().max(f64::MIN_POSITIVE);
        let moment = (turning * inertia.mass()).sqrt();
        let of = |i: usize| match self.at(i) {
            Unknown::Of(Condition::Force(_), _) => moment,
            _ => turning,
        };
        (0..self.count()).map(of).collect()
    }

    /// Returns for each unknown the largest difference from a file that is a rounding error.
    pub(super) fn rounding(&self, inertia: &Inertia) -> Vec<f64> {
        self.scales(inertia).into_iter().map(|scale| ROUNDING * scale).collect()
    }

    /// Computes dynamic force (x, y) and moment on the base, that of the weight included, per unit of each unknown.
    pub fn reaction(&self, e: &UnitVectors, qd: &PerDrive, qdd: &PerDrive, gravity: Vector, out: [&mut [f64]; 3]) {
        let [fx, fy, n] = out;
        self.weight_moment(e, gravity, n);
        for (i, condition) in self.conditions.iter().enumerate() {
            match *condition {
                Condition::Force(k) => {
                    let v = -e[k] * Vector::new(-qd[k] * qd[k], qdd[k]);
                    complex(v, i, fx, fy);
                }
                Condition::Coupling(k, l) => {
                    let z = e[k].conj() * e[l];
                    let (sum, squares) = (qdd[k] + qdd[l], qd[k] * qd[k] - qd[l] * qd[l]);
                    n[2 * i] = -(z.re * sum + z.im * squares);
                    n[2 * i + 1] = z.im * sum - z.re * squares;
                }
            }
        }
        let from = self.of_balance();
        (0..self.drives).for_each(|k| n[from + k] = -qdd[k]);
    }

    /// Computes linear (x, y) and angular momentum per unit of each unknown.
    pub fn momentum(&self, e: &UnitVectors, qd: &PerDrive, out: [&mut [f64]; 3]) {
        let [px, py, h] = out;
        h.fill(0.0);
        for (i, condition) in self.conditions.iter().enumerate() {
            match *condition {
                Condition::Force(k) => complex(e[k] * Vector::new(0.0, qd[k]), i, px, py),
                Condition::Coupling(k, l) => {
                    let z = e[k].conj() * e[l] * (qd[k] + qd[l]);
                    h[2 * i] = z.re;
                    h[2 * i + 1] = -z.im;
                }
            }
        }
        let from = self.of_balance();
        (0..self.drives).for_each(|k| h[from + k] = qd[k]);
    }

    /// Computes the moment of the weight per unit of each unknown.
    pub fn weight_moment(&self, e: &UnitVectors, gravity: Vector, n: &mut [f64]) {
        n.fill(0.0);
        for k in 0..self.drives {
            n[2 * k] = cross(e[k], gravity);
            n[2 * k + 1] = cross(e[k] * Vector::i(), gravity);
        }
    }
}

/// Writes the components of v and i v, which belong to the real and the imaginary part of the i-th condition.
fn complex(v: Vector, i: usize, x: &mut [f64], y: &mut [f64]) {
    (x[2 * i], x[2 * i + 1]) = (v.re, -v.im);
    (y[2 * i], y[2 * i + 1]) = (v.im, v.re);
}

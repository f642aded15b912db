//! [`Craft`]: a machine on a base that floats, and its momentum in the unknowns. Symbols as in [`super`].

use nalgebra::DVector;

use super::motion::OrbitBase;
use crate::trim::unknowns::{ComplexPart, Unknown, Unknowns};
use stillbase_mechanics::arm_on_base::FloatingBase;
use stillbase_mechanics::balance::Condition;
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::{MAX_DRIVES, PerDrive, Vector, unit};

/// Coefficients of the momentum about the common centre of mass.
pub(super) struct Coefficients {
    /// D₀.
    base: f64,
    own: [f64; MAX_DRIVES],
    to_base: [Vector; MAX_DRIVES],
    between: [[Vector; MAX_DRIVES]; MAX_DRIVES],
    first_moments: [Vector; MAX_DRIVES],
}

/// The machine on its base.
pub(super) struct Craft {
    pub unknowns: Unknowns,
    /// M, kg.
    mass: f64,
    /// m ρ, kg m.
    moment: Vector,
    /// D₀, kg m².
    pub inertia: f64,
    pub wheel: f64,
}

impl Craft {
    pub fn of(machine: &Machine, base: &OrbitBase) -> Self {
        Self::with_mass(machine, base, machine.mass())
    }

    /// Returns the machine as if it had another mass, kg, with the same coefficients.
    pub fn with_mass(machine: &Machine, base: &OrbitBase, arm: f64) -> Self {
        let inertia = Inertia::of(machine);
        let FloatingBase { mass: own, inertia: about, com } = base.body;
        let mass = own + arm;
        // Rotors whose stators sit on the base turn with it, too.
        let rotors = inertia.locked() - inertia.total_momentum();
        Self {
            unknowns: Unknowns::of(machine.drives()),
            mass,
            moment: own * com,
            inertia: about + own * (1.0 - own / mass) * com.norm_sqr() + rotors,
            wheel: base.wheel,
        }
    }

    /// Returns unknowns, followed by anything, as coefficients in which the momentum is linear: C₀_k in the place of g_k, C′_kl
    /// of C_kl, and D′_k of D_k.
    pub fn to_linear(&self, x: &DVector<f64>) -> DVector<f64> {
        let of = self.coefficients(x);
        let mut all = x.clone();
        for place in 0..self.unknowns.count() {
            let part = |of: Vector, part| if part == ComplexPart::Along { of.re } else { of.im };
            all[place] = match self.unknowns.at(place) {
                Unknown::Of(Condition::Force(k), of_part) => part(of.to_base[k], of_part),
                Unknown::Of(Condition::Coupling(k, l), of_part) => part(of.between[k][l], of_part),
                Unknown::Momentum(k) => of.own[k],
            };
        }
        all
    }

    /// Inverse of [`to_linear`](Self::to_linear). With the centre of mass of the base at the base pin, C₀ tells no first moments:
    /// then they are those of the machine's `file`.
    pub fn unknowns_of(&self, file: &DVector<f64>, y: &DVector<f64>) -> DVector<f64> {
        let n = self.unknowns.drives();
        let value = |of: &DVector<f64>, place: usize| Vector::new(of[2 * place], of[2 * place + 1]);
        // First moments come first.
        let is_told = self.moment.norm() > 1e-9 * self.mass * (self.inertia / self.mass).sqrt();
        let first_moment =
            |k: usize| if is_told { -self.mass * value(y, k) / self.moment.conj() } else { value(file, k) };
        let g: Vec<Vector> = (0..n).map(first_moment).collect();
        let mut all = y.clone();
        for place in 0..self.unknowns.count() {
            let part = |of: Vector, part| if part == ComplexPart::Along { of.re } else { of.im };
            all[place] = match self.unknowns.at(place) {
                Unknown::Of(Condition::Force(k), of_part) => part(g[k], of_part),
                Unknown::Of(Condition::Coupling(k, l), of_part) => {
                    y[place] + part(g[k].conj() * g[l], of_part) / self.mass
                }
                Unknown::Momentum(k) => y[place] + g[k].norm_sqr() / self.mass,
            };
        }
        all
    }

    /// Computes the momentum per unit of each linear coefficient, at the rate ω of the base.
    pub fn linear_row(&self, angles: &PerDrive, rates: &PerDrive, base_rate: f64, row: &mut [f64]) {
        for (place, value) in row.iter_mut().enumerate() {
            let part = |e: Vector, part| if part == ComplexPart::Along { e.re } else { -e.im };
            *value = match self.unknowns.at(place) {
                Unknown::Of(Condition::Force(k), of_part) => {
                    part(unit(angles[k]), of_part) * (rates[k] + 2.0 * base_rate)
                }
                Unknown::Of(Condition::Coupling(k, l), of_part) => {
                    part(unit(angles[l] - angles[k]), of_part) * (rates[k] + rates[l] + 2.0 * base_rate)
                }
                Unknown::Momentum(k) => rates[k] + base_rate,
            };
        }
    }

    pub fn coefficients(&self, x: &DVector<f64>) -> Coefficients {
        let zero = Vector::default();
        let mut all = Coefficients {
            base: self.inertia,
            own: [0.0; MAX_DRIVES],
            to_base: [zero; MAX_DRIVES],
            between: [[zero; MAX_DRIVES]; MAX_DRIVES],
            first_moments: [zero; MAX_DRIVES],
        };
        for place in 0..self.unknowns.count() {
            let part =
                |part| if part == ComplexPart::Along { Vector::new(x[place], 0.0) } else { Vector::new(0.0, x[place]) };
            match self.unknowns.at(place) {
                Unknown::Of(Condition::Force(k), of) => all.first_moments[k] += part(of),
                Unknown::Of(Condition::Coupling(k, l), of) => all.between[k][l] += part(of),
                Unknown::Momentum(k) => all.own[k] = x[place],
            }
        }
        let (n, g) = (self.unknowns.drives(), all.first_moments);
        for k in 0..n {
            all.own[k] -= g[k].norm_sqr() / self.mass;
            all.to_base[k] = -self.moment.conj() * g[k] / self.mass;
            for l in k + 1..n {
                all.between[k][l] -= g[k].conj() * g[l] / self.mass;
            }
        }
        all
    }

    /// Returns the momentum without base rate, the inertia that it turns with, and the derivatives of ω by the unknowns,
    /// if `momentum` is L, kg m²/s, less that of the wheel.
    pub fn row(
        &self,
        of: &Coefficients,
        angles: &PerDrive,
        rates: &PerDrive,
        momentum: Option<f64>,
        row: &mut [f64],
    ) -> [f64; 2] {
        let n = self.unknowns.drives();
        let turn = |k: usize, l: usize| unit(angles[l] - angles[k]);
        let (mut still, mut turning) = (0.0, of.base);
        for k in 0..n {
            let coupled = (of.to_base[k] * unit(angles[k])).re;
            still += of.own[k] * rates[k] + coupled * rates[k];
            turning += of.own[k] + 2.0 * coupled;
            for l in k + 1..n {
                let coupled = (of.between[k][l] * turn(k, l)).re;
                still += coupled * (rates[k] + rates[l]);
                turning += 2.0 * coupled;
            }
        }
        let Some(momentum) = momentum else { return [still, turning] };
        let rate = (momentum - still) / turning;
        // The momentum that a change of each coefficient adds at this rate.
        let own = |k: usize| rates[k] + rate;
        let to_base = |k: usize, by: Vector| (by * unit(angles[k])).re * (rates[k] + 2.0 * rate);
        let between = |k: usize, l: usize, by: Vector| (by * turn(k, l)).re * (rates[k] + rates[l] + 2.0 * rate);
        for (place, value) in row.iter_mut().enumerate().take(self.unknowns.count()) {
            let part = |part| if part == ComplexPart::Along { Vector::new(1.0, 0.0) } else { Vector::i() };
            let added = match self.unknowns.at(place) {
                Unknown::Momentum(k) => own(k),
                Unknown::Of(Condition::Coupling(k, l), of) => between(k, l, part(of)),
                Unknown::Of(Condition::Force(k), part_of) => {
                    let (by, g) = (part(part_of) / self.mass, &of.first_moments);
                    let others: f64 = (0..n)
                        .map(|l| match k.cmp(&l) {
                            std::cmp::Ordering::Less => between(k, l, -by.conj() * g[l]),
                            std::cmp::Ordering::Greater => between(l, k, -g[l].conj() * by),
                            std::cmp::Ordering::Equal => -2.0 * (by.conj() * g[k]).re * own(k),
                        })
                        .sum();
                    others + to_base(k, -self.moment.conj() * by)
                }
            };
            *value = -added / turning;
        }
        [rate, turning]
    }
}

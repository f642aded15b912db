//! Friction of bearings and pins: viscous, and Coulomb friction with exact sticking.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | v | sliding rate: in a bearing q̇_k less the rate of the stator (θ̇ on the base), in a pin q̇_l − q̇_k | rad/s |
//! | f | friction torque against v: c v + τ_C sgn v while sliding, any \|f\| ≤ τ_C while stuck | N m |
//!
//! Friction acts between two parts with equal and opposite torques. Coulomb friction is not smoothed: a contact either
//! slides in one direction or is stuck. A stuck contact transmits exactly the torque that keeps it stuck
//! ([`Contacts::solve_stuck`]). So there is neither creep nor chatter at rest, at any step size.

use super::each::DriveValues;
use super::load::MAX_PAYLOAD;
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::MAX_DRIVES;
use stillbase_settings::keyed::keyed;
use stillbase_settings::range::Range;

const TORQUE_RANGE: Range = Range::new(0.0, MAX_PAYLOAD, "N m");
const VISCOUS_RANGE: Range = Range::new(0.0, MAX_PAYLOAD, "N m s");

keyed! {
    /// Settings of friction. In the bearing of a drive, friction acts between the drive and the part that carries its
    /// stator.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Friction at "plant.friction" {
        /// Viscous friction in the bearings of the drives: a torque against the rate relative to the stator.
        viscous: DriveValues = "0", range: VISCOUS_RANGE;
        /// Coulomb friction in the bearings of the drives; a drive at rest sticks until a larger torque acts on it.
        coulomb: DriveValues = "0", range: TORQUE_RANGE;
        /// Viscous friction in every pin, against the rate between its two links.
        pin_viscous: f64 = "0", range: VISCOUS_RANGE;
        /// Coulomb friction in every pin; a pin at rest sticks.
        pin_coulomb: f64 = "0", range: TORQUE_RANGE;
    }
}

/// Maximum number of contacts: a bearing for each drive, and the pins between each pair of drives.
pub const MAX_CONTACTS: usize = MAX_DRIVES + MAX_DRIVES * (MAX_DRIVES - 1) / 2;

/// A contact with friction between two rotational coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Contact {
    /// Index of the coordinate with positive sign in v = q̇_plus − q̇_minus.
    plus: usize,
    /// Index of the other coordinate; out of range for a fixed base.
    minus: usize,
    /// Viscous coefficient c, N m s.
    viscous: f64,
    /// Coulomb torque τ_C, N m.
    coulomb: f64,
    /// Number of pins that the contact represents; 0 for a bearing.
    pins: f64,
}

/// Slip direction of each contact: 0 stuck, ±1 sliding.
pub type SlipDirections = [i8; MAX_CONTACTS];

/// All contacts of a machine with friction: the bearings first.
#[derive(Clone, Debug, PartialEq)]
pub struct Contacts {
    list: Vec<Contact>,
    bearings: usize,
}

/// Torques that friction changes, N m.
pub struct FrictionTorques<'a> {
    /// Generalised forces, to which friction torques are added.
    pub force: &'a mut [f64],
    /// Friction torque in the bearing of each drive, to which the torque of its contact is added.
    pub bearing: &'a mut [f64],
    /// Torques of stuck contacts: the first guess, then the result.
    pub stuck_torque: &'a mut [f64; MAX_CONTACTS],
}

impl Contacts {
    /// Sliding rate below which a contact counts as stuck, rad/s.
    pub(crate) const STICTION_SPEED: f64 = 1e-12;

    /// Returns the slip directions of all contacts for given rates, rad/s.
    pub(crate) fn slips(&self, qd: &[f64]) -> SlipDirections {
        let mut slip = [0; MAX_CONTACTS];
        for i in (0..self.len()).filter(|i| self.can_stick(*i)) {
            let v = self.sliding(i, qd);
            slip[i] = if v.abs() < Self::STICTION_SPEED { 0 } else { v.signum() as i8 };
        }
        slip
    }

    /// Returns the contacts of a machine; `base` is the index of the base among the rotational coordinates, if it
    /// moves.
    pub fn of(machine: &Machine, friction: &Friction, base: Option<usize>) -> Self {
        let n = machine.drives();
        let minus = base.unwrap_or(usize::MAX);
        let (viscous, coulomb) = (friction.viscous.of(n), friction.coulomb.of(n));
        let stator = |k| machine.motors().on(k).unwrap_or(minus);
        let bearing = |k| Contact { plus: k, minus: stator(k), viscous: viscous[k], coulomb: coulomb[k], pins: 0.0 };
        let rubs = |c: &Contact| c.viscous > 0.0 || c.coulomb > 0.0;
        let mut list: Vec<Contact> = (0..n).map(bearing).filter(rubs).collect();
        let bearings = list.len();
        if friction.pin_viscous > 0.0 || friction.pin_coulomb > 0.0 {
            let pins = pins(machine);
            // Pins on links that keep their orientation turn against the base.
            let indices = n + usize::from(machine.ground().is_some());
            list.extend(Inertia::pairs(indices).filter_map(|(k, l)| {
                let count = pins.iter().filter(|pair| **pair == (k, l) || **pair == (l, k)).count() as f64;
                let (viscous, coulomb) = (count * friction.pin_viscous, count * friction.pin_coulomb);
                let (plus, minus) = if l == n { (k, base.unwrap_or(n)) } else { (l, k) };
                (count > 0.0).then_some(Contact { plus, minus, viscous, coulomb, pins: count })
            }));
        }
        Self { list, bearings }
    }

    /// Returns whether there is no friction.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Returns the number of contacts.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Returns the sliding rate of a contact, rad/s.
    #[inline]
    pub fn sliding(&self, i: usize, qd: &[f64]) -> f64 {
        let c = &self.list[i];
        qd[c.plus] - qd.get(c.minus).copied().unwrap_or(0.0)
    }

    /// Returns the reduced inertia of a contact, kg m²; `inertia_of` returns the inertia of a rotational coordinate.
    pub fn reduced_inertia(&self, i: usize, inertia_of: impl Fn(usize) -> f64) -> f64 {
        let c = &self.list[i];
        let (a, b) = (inertia_of(c.plus), if c.minus < MAX_DRIVES { inertia_of(c.minus) } else { f64::INFINITY });
        1.0 / (1.0 / a + 1.0 / b)
    }

    /// Returns whether a contact can stick.
    pub fn can_stick(&self, i: usize) -> bool {
        self.list[i].coulomb > 0.0
    }

    /// Returns whether any contact can stick.
    pub fn any_can_stick(&self) -> bool {
        self.list.iter().any(|contact| contact.coulomb > 0.0)
    }

    /// Returns τ_C of a contact, N m.
    pub fn coulomb(&self, i: usize) -> f64 {
        self.list[i].coulomb
    }

    /// Returns the friction torque in one pin between links of drives `from` and `to`, N m; it is positive against
    /// q̇_to − q̇_from. `stuck_torque` contains the torques of stuck contacts, N m. Pins between the same two drives
    /// share the torque equally.
    pub fn pin_torque(
        &self,
        from: usize,
        to: usize,
        qd: &[f64],
        slip: &SlipDirections,
        stuck_torque: &[f64; MAX_CONTACTS],
    ) -> f64 {
        let pins = self.list.iter().enumerate().skip(self.bearings);
        let ends = |c: &Contact| (c.minus.min(c.plus), c.minus.max(c.plus));
        let Some((i, c)) = pins.into_iter().find(|(_, c)| ends(c) == (from.min(to), from.max(to))) else { return 0.0 };
        let held = if c.coulomb > 0.0 && slip[i] == 0 { stuck_torque[i] } else { c.coulomb * f64::from(slip[i]) };
        let against = c.viscous * self.sliding(i, qd) + held;
        if c.plus == to { against / c.pins } else { -against / c.pins }
    }

    /// Adds the torque `f`, N m, against the sliding of a contact to generalised forces.
    #[inline]
    pub(super) fn apply(&self, i: usize, f: f64, force: &mut [f64]) {
        let c = &self.list[i];
        force[c.plus] -= f;
        if let Some(minus) = force.get_mut(c.minus) {
            *minus += f;
        }
    }

    /// Adds the friction torques of sliding contacts to the generalised forces `force`, N m. Those of bearings are also
    /// added to `bearing`, indexed by drive. Returns the dissipated power, W.
    #[inline]
    pub fn slide(&self, slip: &SlipDirections, qd: &[f64], force: &mut [f64], bearing: &mut [f64]) -> f64 {
        let mut lost = 0.0;
        for (i, c) in self.list.iter().enumerate() {
            let v = self.sliding(i, qd);
            let f = c.viscous * v + c.coulomb * f64::from(slip[i]);
            lost += f * v;
            self.apply(i, f, force);
            if i < self.bearings {
                bearing[c.plus] += f;
            }
        }
        lost
    }

    /// Computes the torques of stuck contacts by projected Gauss–Seidel sweeps and adds them to `torques`. Each torque
    /// either satisfies |f| ≤ τ_C with v̇ = 0, or is at its bound, against v̇. `solve` returns accelerations for
    /// generalised forces; `free` are the accelerations without these torques. Returns the dissipated power, W. It
    /// is zero unless a contact starts to slide in the step. If contacts do not interact, one sweep is exact.
    pub fn solve_stuck(
        &self,
        slip: &SlipDirections,
        qd: &[f64],
        free: &[f64],
        solve: impl Fn(&[f64; MAX_DRIVES]) -> [f64; MAX_DRIVES],
        torques: FrictionTorques<'_>,
    ) -> f64 {
        let FrictionTorques { force, bearing, stuck_torque } = torques;
        const MAX_SWEEPS: usize = 2000;
        let stuck = |i: &usize| self.list[*i].coulomb > 0.0 && slip[*i] == 0;
        if !(0..self.list.len()).any(|i| stuck(&i)) {
            return 0.0;
        }
        let mut qdd = [0.0; MAX_DRIVES];
        qdd[..free.len()].copy_from_slice(free);
        // Start from the previous torques.
        for (i, contact) in self.list.iter().enumerate() {
            stuck_torque[i] = if stuck(&i) { stuck_torque[i].clamp(-contact.coulomb, contact.coulomb) } else { 0.0 };
            if stuck_torque[i] != 0.0 {
                let mut unit = [0.0; MAX_DRIVES];
                self.apply(i, stuck_torque[i], &mut unit[..free.len()]);
                qdd.iter_mut().zip(&solve(&unit)).for_each(|(a, r)| *a += r);
            }
        }
        for _ in 0..MAX_SWEEPS {
            let mut change: f64 = 0.0;
            for i in (0..self.list.len()).filter(stuck) {
                let mut unit = [0.0; MAX_DRIVES];
                self.apply(i, 1.0, &mut unit[..free.len()]);
                let response = solve(&unit);
                let give = -self.sliding(i, &response[..free.len()]);
                let limit = self.list[i].coulomb;
                let f = (stuck_torque[i] + self.sliding(i, &qdd[..free.len()]) / give).clamp(-limit, limit);
                let more = f - stuck_torque[i];
                stuck_torque[i] = f;
                qdd.iter_mut().zip(&response).for_each(|(a, r)| *a += more * r);
                change = change.max(more.abs() / limit);
            }
            if change < 1e-15 {
                break;
            }
        }
        let mut lost = 0.0;
        for i in (0..self.list.len()).filter(stuck) {
            self.apply(i, stuck_torque[i], force);
            lost += stuck_torque[i] * self.sliding(i, qd);
            if i < self.bearings {
                bearing[self.list[i].plus] += stuck_torque[i];
            }
        }
        lost
    }
}

/// Returns, for every pin between links of different drives, the indices of the two drives.
fn pins(machine: &Machine) -> Vec<(usize, usize)> {
    let drive = |j: usize| machine.resolved_links()[j].drive;
    let attachments = machine.resolved_links().iter().filter_map(|part| Some((drive(part.parent?), part.drive)));
    let closures = machine.loops().iter().map(|l| (drive(l.a), drive(l.b)));
    attachments.chain(closures).filter(|(k, l)| k != l).collect()
}

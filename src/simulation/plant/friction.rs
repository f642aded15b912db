//! Friction of bearings and pins: viscous, and Coulomb's with true sticking.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | v | rate of sliding: q̇_k − θ̇ in the bearing of drive k, or q̇_k − q̇_on; q̇_l − q̇_k in a pin | rad/s |
//! | f | friction torque against it: c v + τ_C sgn v while sliding, any |f| ≤ τ_C while stuck | N m |
//!
//! Friction is internal to its pair: what it takes from one side it gives to the other. Coulomb friction is not
//! smoothed: a contact either slides one way or is stuck, and a stuck one takes just the torque that keeps it so
//! ([`Contacts::hold`]). So nothing creeps or chatters at rest, and the step size does not matter.

use super::each::Each;
use super::load::MAX_PAYLOAD;
use crate::mechanics::machine::{Inertia, Machine};
use crate::mechanics::planar::MAX_DRIVES;
use crate::settings::keyed::keyed;
use crate::settings::range::Range;

const TORQUE: Range = Range::new(0.0, MAX_PAYLOAD, "N m");
const VISCOUS: Range = Range::new(0.0, MAX_PAYLOAD, "N m s");

keyed! {
    /// Friction as a file states it. In the bearing of a drive it is between the drive and what its stator sits on.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Friction at "plant.friction" {
        /// Viscous friction in the bearings of the drives: a torque against the rate relative to the base.
        viscous: Each = "0", range: VISCOUS;
        /// Coulomb friction in the bearings of the drives; a drive at rest sticks until more than this pulls.
        coulomb: Each = "0", range: TORQUE;
        /// Viscous friction in every pin, against the rate between its two links.
        pin_viscous: f64 = "0", range: VISCOUS;
        /// Coulomb friction in every pin; a pin at rest sticks.
        pin_coulomb: f64 = "0", range: TORQUE;
    }
}

/// The most pairs of drives and bases that can rub: eight drives on the base, and each on each.
pub const MAX_CONTACTS: usize = MAX_DRIVES + MAX_DRIVES * (MAX_DRIVES - 1) / 2;

/// Two directions that rub on each other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Contact {
    /// v = q̇_plus − q̇_minus; `minus` is beyond the drives for a base that does not turn.
    plus: usize,
    minus: usize,
    /// N m s.
    viscous: f64,
    /// N m.
    coulomb: f64,
    /// Pins that share it, all alike; 0 for a bearing.
    pins: f64,
}

/// What a contact does: 0 stuck, ±1 sliding that way.
pub type SlipDirections = [i8; MAX_CONTACTS];

/// Every contact of a machine that has friction: the bearings first.
#[derive(Clone, Debug, PartialEq)]
pub struct Contacts {
    list: Vec<Contact>,
    bearings: usize,
}

impl Contacts {
    /// Slower than this a contact does not slide, rad/s.
    pub(crate) const STILL: f64 = 1e-12;

    /// What every contact does in a state of motion.
    pub(crate) fn slips(&self, qd: &[f64]) -> SlipDirections {
        let mut slip = [0; MAX_CONTACTS];
        for i in (0..self.len()).filter(|i| self.sticks(*i)) {
            let v = self.sliding(i, qd);
            slip[i] = if v.abs() < Self::STILL { 0 } else { v.signum() as i8 };
        }
        slip
    }

    /// Those of a machine; `base` is the index of the base among what turns, if it does.
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
            list.extend(Inertia::pairs(n).filter_map(|(k, l)| {
                let count = pins.iter().filter(|pair| **pair == (k, l) || **pair == (l, k)).count() as f64;
                let (viscous, coulomb) = (count * friction.pin_viscous, count * friction.pin_coulomb);
                (count > 0.0).then_some(Contact { plus: l, minus: k, viscous, coulomb, pins: count })
            }));
        }
        Self { list, bearings }
    }

    /// Whether nothing rubs.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Rate of sliding of a contact, rad/s.
    #[inline]
    pub fn sliding(&self, i: usize, qd: &[f64]) -> f64 {
        let c = &self.list[i];
        qd[c.plus] - qd.get(c.minus).copied().unwrap_or(0.0)
    }

    /// What the two sides of a contact resist a torque between them with, kg m², given what each turning part resists
    /// alone.
    pub fn resists(&self, i: usize, alone: impl Fn(usize) -> f64) -> f64 {
        let c = &self.list[i];
        let (a, b) = (alone(c.plus), if c.minus < MAX_DRIVES { alone(c.minus) } else { f64::INFINITY });
        1.0 / (1.0 / a + 1.0 / b)
    }

    /// Whether a contact can stick.
    pub fn sticks(&self, i: usize) -> bool {
        self.list[i].coulomb > 0.0
    }

    /// Whether any can stick.
    pub fn stick(&self) -> bool {
        self.list.iter().any(|contact| contact.coulomb > 0.0)
    }

    /// τ_C of a contact, N m.
    pub fn coulomb(&self, i: usize) -> f64 {
        self.list[i].coulomb
    }

    /// Friction of one pin between links that follow drives `from` and `to`, N m, against q̇_to − q̇_from;
    /// `stuck_torque` holds the torques of stuck contacts. Pins between the same two drives turn alike, so each has an
    /// equal part.
    pub fn couple(
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

    /// Adds the torque `f` against sliding of a contact to generalised forces.
    #[inline]
    pub(super) fn apply(&self, i: usize, f: f64, force: &mut [f64]) {
        let c = &self.list[i];
        force[c.plus] -= f;
        if let Some(minus) = force.get_mut(c.minus) {
            *minus += f;
        }
    }

    /// Friction of all that slides, added to generalised forces, N m; the power it takes, W. Bearings also in
    /// `bearing`, drive by drive.
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

    /// The torques of stuck contacts, that nothing stuck may move: each |f| ≤ τ_C with v̇ = 0, or at its bound against
    /// v̇. `solve` gives accelerations for generalised forces, `free` those without these torques. Adds to `force`;
    /// `stuck_torque` holds the torques, before as a first guess, after as found; gives the power they take, W, which
    /// is none unless a contact has begun to slide since the step did. The number of sweeps is bounded; one is exact
    /// where contacts do not act on each other.
    pub fn hold(
        &self,
        slip: &SlipDirections,
        (qd, free): (&[f64], &[f64]),
        solve: impl Fn(&[f64; MAX_DRIVES]) -> [f64; MAX_DRIVES],
        force: &mut [f64],
        bearing: &mut [f64],
        stuck_torque: &mut [f64; MAX_CONTACTS],
    ) -> f64 {
        const SWEEPS: usize = 2000;
        let stuck = |i: &usize| self.list[*i].coulomb > 0.0 && slip[*i] == 0;
        if !(0..self.list.len()).any(|i| stuck(&i)) {
            return 0.0;
        }
        let mut qdd = [0.0; MAX_DRIVES];
        qdd[..free.len()].copy_from_slice(free);
        // From what held a moment ago.
        for (i, contact) in self.list.iter().enumerate() {
            stuck_torque[i] = if stuck(&i) { stuck_torque[i].clamp(-contact.coulomb, contact.coulomb) } else { 0.0 };
            if stuck_torque[i] != 0.0 {
                let mut unit = [0.0; MAX_DRIVES];
                self.apply(i, stuck_torque[i], &mut unit[..free.len()]);
                qdd.iter_mut().zip(&solve(&unit)).for_each(|(a, r)| *a += r);
            }
        }
        for _ in 0..SWEEPS {
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

/// The drives that the two sides of every pin follow.
fn pins(machine: &Machine) -> Vec<(usize, usize)> {
    let drive = |j: usize| machine.resolved_links()[j].drive;
    let attachments = machine.resolved_links().iter().filter_map(|part| Some((drive(part.parent?), part.drive)));
    let closures = machine.loops().iter().map(|l| (drive(l.a), drive(l.b)));
    attachments.chain(closures).filter(|(k, l)| k != l).collect()
}

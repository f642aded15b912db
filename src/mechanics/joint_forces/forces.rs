//! Forces of the pins at one instant.

use super::block::together;
use super::joints::Joints;
use super::pins::{FLAT_SINE, MAX_PINS};
use super::tree::{SolveStep, Stator};
use crate::dynamics::ExternalLoads;
use crate::planar::{MAX_DRIVES, PerDrive, UnitVectors, Vector, cross};

/// Forces of all pins, and torques of the motors, at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinForces {
    len: usize,
    forces: [Vector; MAX_PINS],
    undefined: u32,
    torque: PerDrive,
}

impl PinForces {
    /// Returns the force that the first link of pin i exerts on its second link, N, in base axes. `None` while a
    /// parallelogram on which the force depends is flat.
    #[inline]
    pub fn get(&self, i: usize) -> Option<Vector> {
        (i < self.len && self.undefined & 1 << i == 0).then(|| self.forces[i])
    }

    /// Returns the forces of all pins, N. They stay finite: at a change point, |sin(q_k − q_l)| is replaced by
    /// [`FLAT_SINE`].
    #[inline]
    pub fn bounded(&self) -> &[Vector] {
        &self.forces[..self.len]
    }

    /// Returns the set of pins whose force is undefined, one bit each.
    pub fn undefined(&self) -> u32 {
        self.undefined
    }

    /// Returns the largest force, N, bounded as in [`bounded`](Self::bounded), and its pin.
    pub fn largest(&self) -> (f64, usize) {
        let mut worst = (0.0, 0);
        for (i, force) in self.bounded().iter().enumerate() {
            let square = force.norm_sqr();
            // NaN is treated as the largest, so that a diverged run is visible.
            if square > worst.0 || square.is_nan() {
                worst = (square, i);
            }
        }
        (worst.0.sqrt(), worst.1)
    }

    /// Returns the torques of the motors without the friction in the drives' bearings, N m, from the moments that the
    /// driven links need. `None` at a change point. Without friction, and with all motors on the base,
    /// [`inverse`](crate::dynamics::inverse) returns these torques even there.
    pub fn torque(&self) -> Option<PerDrive> {
        (self.undefined == 0).then_some(self.torque)
    }
}

impl Joints {
    /// Returns the force of every pin and the torques of the motors for a motion, with frictionless pins. On a moving
    /// base, gravity is g − p̈_B.
    pub fn forces(&self, e: &UnitVectors, qd: &PerDrive, qdd: &PerDrive, around: &ExternalLoads) -> PinForces {
        self.forces_with(e, qd, qdd, around, |_, _| 0.0)
    }

    /// Returns the same as [`forces`](Self::forces) with friction in the pins. `couple(k, l)` is the friction torque,
    /// N m, of a pin from a link that follows drive k to one that follows drive l. It is positive if it resists drive l
    /// turning faster than drive k.
    #[inline]
    pub fn forces_with(
        &self,
        e: &UnitVectors,
        qd: &PerDrive,
        qdd: &PerDrive,
        around: &ExternalLoads,
        couple: impl Fn(usize, usize) -> f64,
    ) -> PinForces {
        let zero = Vector::default();
        let mut turn = [zero; MAX_DRIVES];
        for k in 0..self.drives {
            turn[k] = Vector::new(-qd[k] * qd[k], qdd[k]) * e[k];
        }
        let links = &self.links[..];
        // From B outwards: the acceleration of each root minus gravity, and the force and moment that each link alone
        // needs.
        let (mut root, mut force, mut moment) = ([zero; MAX_PINS], [zero; MAX_PINS], [0.0; MAX_PINS]);
        for (j, link) in links.iter().enumerate() {
            let (drive, arm) = link.arm;
            root[j] = match link.parent {
                Some(p) => root[p] + turn[drive] * arm,
                None => -around.gravity,
            };
            force[j] = root[j] * link.mass + link.first * turn[link.drive];
            moment[j] = link.second * qdd.padded()[link.drive] + cross(link.first * e[link.drive], root[j]);
            if let Some(along) = link.end_effector {
                force[j] -= around.force;
                moment[j] -= along * cross(e[link.drive], around.force);
            }
        }
        // The friction of a pin acts on both of its links with opposite signs.
        for &(from, to) in &self.rubbing {
            let f = couple(links[from].drive, links[to].drive);
            moment[from] -= f;
            moment[to] += f;
        }
        // From the tips inwards: each link adds its force and moment to those of its parent.
        for (j, link) in links.iter().enumerate().rev() {
            if let Some(p) = link.parent {
                let (drive, arm) = link.arm;
                moment[p] += arm * cross(e[drive], force[j]);
                force[p] += force[j];
            }
        }
        // The link that carries a motor bears the reaction: the moment of the links that the motor turns, and the
        // torque that accelerates its rotor.
        let react = |stator: &Stator, moment: &mut [f64]| {
            let turned = links.iter().zip(&*moment).filter(|(l, _)| l.driven && l.drive == stator.drive);
            let rotor: f64 = stator.rotor.rates.iter().zip(qdd.iter()).map(|(r, qdd)| r * qdd).sum();
            let reaction = turned.map(|(_, m)| m).sum::<f64>() + stator.rotor.inertia * rotor;
            if let Some(link) = stator.link {
                moment[link] += reaction;
            }
        };
        self.stators.iter().filter(|stator| stator.before).for_each(|stator| react(stator, &mut moment));
        let mut out = PinForces {
            len: self.pins.len(),
            forces: [zero; MAX_PINS],
            undefined: 0,
            torque: PerDrive::zeros(self.drives),
        };
        let mut apply = |c: usize, lambda: Vector, force: &mut [Vector], moment: &mut [f64]| {
            let closure = &self.closures[c];
            out.forces[closure.pin] = lambda;
            for &(j, w) in &closure.levers {
                moment[j] -= w * cross(e[links[j].drive], lambda);
            }
            for &(j, sense) in &closure.carried {
                force[j] -= lambda * sense;
            }
        };
        for step in &self.steps {
            match step {
                SolveStep::Pair { closure, rows: [(i, v), (j, w)] } => {
                    let (ek, el) = (e[links[*i].drive], e[links[*j].drive]);
                    let mut sine = cross(ek, el);
                    if sine.abs() < FLAT_SINE {
                        out.undefined |= self.closures[*closure].reaches;
                        sine = FLAT_SINE.copysign(sine);
                    }
                    let lambda = (el * (moment[*i] / v) - ek * (moment[*j] / w)) / sine;
                    apply(*closure, lambda, &mut force, &mut moment);
                }
                SolveStep::Together { closures, rows } => {
                    let (lambdas, regular) = together(links, &self.closures, closures, rows, e, &moment);
                    for (&c, &lambda) in closures.iter().zip(&lambdas) {
                        if !regular {
                            out.undefined |= self.closures[c].reaches;
                        }
                        apply(c, lambda, &mut force, &mut moment);
                    }
                }
            }
        }
        self.stators.iter().filter(|stator| !stator.before).for_each(|stator| react(stator, &mut moment));
        for (j, link) in links.iter().enumerate() {
            out.forces[link.link] = force[j];
            // What holds a link on the base that never turns is no motor.
            if let Some(torque) = out.torque.get_mut(link.drive).filter(|_| link.driven) {
                *torque += moment[j];
            }
        }
        for Stator { drive, rotor, .. } in &self.stators {
            let turning: f64 = rotor.rates.iter().zip(qdd.iter()).map(|(r, qdd)| r * qdd).sum();
            out.torque[*drive] += rotor.inertia * rotor.rates[*drive] * turning;
        }
        out
    }

    /// Returns f_B, the force that the links at B exert on the base, N.
    pub fn on_base(&self, forces: &PinForces) -> Vector {
        let at_base = self.pins.iter().zip(forces.bounded()).filter(|(pin, _)| pin.from.is_none());
        -at_base.map(|(_, f)| f).sum::<Vector>()
    }
}

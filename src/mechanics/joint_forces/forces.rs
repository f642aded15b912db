//! Forces of the pins at one instant.

use super::block::together;
use super::joints::Joints;
use super::pins::{FLAT, MAX_PINS};
use super::tree::{SolveStep, Stator};
use crate::mechanics::dynamics::Surroundings;
use crate::mechanics::planar::{MAX_DRIVES, PerDrive, Units, Vector, cross};

/// What the pins carry at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forces {
    len: usize,
    forces: [Vector; MAX_PINS],
    undefined: u32,
    torque: PerDrive,
}

impl Forces {
    /// Force of pin i, N, base axes: what its first link exerts on its second. `None` while a parallelogram that it
    /// depends on is flat.
    #[inline]
    pub fn get(&self, i: usize) -> Option<Vector> {
        (i < self.len && self.undefined & 1 << i == 0).then(|| self.forces[i])
    }

    /// The same, finite always: at a change point what it would be at |sin(q_k − q_l)| = [`FLAT`].
    #[inline]
    pub fn bounded(&self) -> &[Vector] {
        &self.forces[..self.len]
    }

    /// Pins whose force is undefined, one bit each.
    pub fn undefined(&self) -> u32 {
        self.undefined
    }

    /// The largest force, N, bounded as in [`bounded`](Self::bounded), and its pin.
    pub fn worst(&self) -> (f64, usize) {
        let mut worst = (0.0, 0);
        for (i, force) in self.bounded().iter().enumerate() {
            let square = force.norm_sqr();
            // Not a number counts as worst: a run that has blown up shows.
            if square > worst.0 || square.is_nan() {
                worst = (square, i);
            }
        }
        (worst.0.sqrt(), worst.1)
    }

    /// Torques of the motors less the friction of the drives' bearings, N m, from the moments that the links at B ask for; `None` at a
    /// change point, where [`inverse`](crate::mechanics::dynamics::inverse) knows it for pins without friction.
    pub fn torque(&self) -> Option<PerDrive> {
        (self.undefined == 0).then_some(self.torque)
    }
}

/// What links ask of their roots: force, N, and moment, N m.
struct Asked {
    force: [Vector; MAX_PINS],
    moment: [f64; MAX_PINS],
}

impl Joints {
    /// Force of every pin for a motion, and the torques of the drives, with pins that turn freely. On a base that
    /// moves, gravity is g − p̈_B.
    pub fn forces(&self, e: &Units, qd: &PerDrive, qdd: &PerDrive, around: &Surroundings) -> Forces {
        self.forces_with(e, qd, qdd, around, |_, _| 0.0)
    }

    /// The same with friction in the pins: `couple` is asked for the friction torque of a pin from a link that follows
    /// one drive to a link that follows another, N m, against the second turning faster than the first.
    #[inline]
    pub fn forces_with(
        &self,
        e: &Units,
        qd: &PerDrive,
        qdd: &PerDrive,
        around: &Surroundings,
        couple: impl Fn(usize, usize) -> f64,
    ) -> Forces {
        let mut asked = self.asked(e, qd, qdd, around);
        // What a pin's friction takes from one side it gives to the other.
        for &(from, to) in &self.rubbing {
            let f = couple(self.links[from].drive, self.links[to].drive);
            asked.moment[from] -= f;
            asked.moment[to] += f;
        }
        // And inwards: with all that hangs on it.
        for (j, link) in self.links.iter().enumerate().rev() {
            if let Some(p) = link.parent {
                let (drive, arm) = link.arm;
                asked.moment[p] += arm * cross(e[drive], asked.force[j]);
                asked.force[p] += asked.force[j];
            }
        }
        let mut out = Forces {
            len: self.pins.len(),
            forces: [Vector::default(); MAX_PINS],
            undefined: 0,
            torque: PerDrive::zeros(self.drives),
        };
        self.stators.iter().filter(|stator| stator.before).for_each(|stator| self.lean(stator, qdd, &mut asked));
        self.close(e, &mut asked, &mut out);
        self.stators.iter().filter(|stator| !stator.before).for_each(|stator| self.lean(stator, qdd, &mut asked));
        for (j, link) in self.links.iter().enumerate() {
            out.forces[link.link] = asked.force[j];
            if link.driven {
                out.torque[link.drive] += asked.moment[j];
            }
        }
        for Stator { drive, rotor, .. } in &self.stators {
            let turning: f64 = rotor.rates.iter().zip(qdd.iter()).map(|(r, qdd)| r * qdd).sum();
            out.torque[*drive] += rotor.inertia * rotor.rates[*drive] * turning;
        }
        out
    }

    /// What each link asks of its root for itself: from B outwards, by the acceleration of each root less gravity.
    #[inline]
    fn asked(&self, e: &Units, qd: &PerDrive, qdd: &PerDrive, around: &Surroundings) -> Asked {
        let zero = Vector::default();
        let mut turn = [zero; MAX_DRIVES];
        for k in 0..self.drives {
            turn[k] = Vector::new(-qd[k] * qd[k], qdd[k]) * e[k];
        }
        let (mut root, mut force, mut moment) = ([zero; MAX_PINS], [zero; MAX_PINS], [0.0; MAX_PINS]);
        for (j, link) in self.links.iter().enumerate() {
            let (drive, arm) = link.arm;
            root[j] = match link.parent {
                Some(p) => root[p] + turn[drive] * arm,
                None => -around.gravity,
            };
            force[j] = root[j] * link.mass + link.first * turn[link.drive];
            moment[j] = link.second * qdd[link.drive] + cross(link.first * e[link.drive], root[j]);
            if let Some(along) = link.end_effector {
                force[j] -= around.force;
                moment[j] -= along * cross(e[link.drive], around.force);
            }
        }
        Asked { force, moment }
    }

    /// A motor in a joint leans on the link that carries it; its rotor takes of both what it wants to turn.
    #[inline]
    fn lean(&self, stator: &Stator, qdd: &PerDrive, asked: &mut Asked) {
        let turned = self.links.iter().zip(&asked.moment).filter(|(l, _)| l.driven && l.drive == stator.drive);
        let rotor: f64 = stator.rotor.rates.iter().zip(qdd.iter()).map(|(r, qdd)| r * qdd).sum();
        let whole = turned.map(|(_, m)| m).sum::<f64>() + stator.rotor.inertia * rotor;
        if let Some(link) = stator.link {
            asked.moment[link] += whole;
        }
    }

    /// Forces of the pins that close loops, in the order in which they can be found.
    #[inline]
    fn close(&self, e: &Units, asked: &mut Asked, out: &mut Forces) {
        for step in &self.steps {
            match step {
                SolveStep::Pair { closure, rows: [(i, v), (j, w)] } => {
                    let (ek, el) = (e[self.links[*i].drive], e[self.links[*j].drive]);
                    let mut sine = cross(ek, el);
                    if sine.abs() < FLAT {
                        out.undefined |= self.closures[*closure].reaches;
                        sine = FLAT.copysign(sine);
                    }
                    let lambda = (el * (asked.moment[*i] / v) - ek * (asked.moment[*j] / w)) / sine;
                    self.bear(*closure, lambda, e, asked, out);
                }
                SolveStep::Together { closures, rows } => {
                    let (lambdas, regular) = together(&self.links, &self.closures, closures, rows, e, &asked.moment);
                    for (&c, &lambda) in closures.iter().zip(&lambdas) {
                        if !regular {
                            out.undefined |= self.closures[c].reaches;
                        }
                        self.bear(c, lambda, e, asked, out);
                    }
                }
            }
        }
    }

    /// Lets the pin of a loop bear a force, N, and takes it from what is asked of the others.
    #[inline]
    fn bear(&self, c: usize, lambda: Vector, e: &Units, asked: &mut Asked, out: &mut Forces) {
        let closure = &self.closures[c];
        out.forces[closure.pin] = lambda;
        for &(j, w) in &closure.levers {
            asked.moment[j] -= w * cross(e[self.links[j].drive], lambda);
        }
        for &(j, sense) in &closure.carried {
            asked.force[j] -= lambda * sense;
        }
    }

    /// f_B, N: what the links at B exert on the base.
    pub fn on_base(&self, forces: &Forces) -> Vector {
        let at_base = self.pins.iter().zip(forces.bounded()).filter(|(pin, _)| pin.from.is_none());
        -at_base.map(|(_, f)| f).sum::<Vector>()
    }
}

//! The pin forces that a frame keeps, and their peaks and means over a run.

use super::{AxialMoments, Forces, Joints, Tilt};
use crate::mechanics::dynamics::Surroundings;
use crate::mechanics::machine::Machine;
use crate::mechanics::planar::{PerDrive, Units, Vector};

/// How many pins a frame keeps the forces of: a session holds many frames, so there is no room for all that a machine
/// may have. The worst of all pins is known in any case.
pub const KEPT: usize = 16;

/// The inside of the machine at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inside {
    pins: [Vector; KEPT],
    known: u8,
    undefined: u16,
    worst_pin: u8,
    /// The largest force of a pin, N; 0 where statics does not determine them.
    pub worst: f64,
    /// What tilts the base.
    pub tilt: Tilt,
}

impl Inside {
    fn of(forces: &Forces, tilt: Tilt) -> Self {
        let known = forces.bounded().len().min(KEPT);
        let mut pins = [Vector::default(); KEPT];
        pins[..known].copy_from_slice(&forces.bounded()[..known]);
        let (worst, worst_pin) = forces.worst();
        Self { pins, known: known as u8, undefined: forces.undefined() as u16, worst_pin: worst_pin as u8, worst, tilt }
    }

    /// Force of pin i, N, in the order of [`Joints::pins`]: what its first link exerts on its second. `None` at a
    /// change point, for pins beyond [`KEPT`], and where statics does not determine it.
    pub fn pin(&self, i: usize) -> Option<Vector> {
        (i < usize::from(self.known) && self.undefined & 1 << i == 0).then(|| self.pins[i])
    }

    /// Its size, N, finite always: at a change point what it would be at |sin(q_k − q_l)| = [`FLAT`](super::FLAT); 0
    /// for pins that are not kept.
    pub fn size(&self, i: usize) -> f64 {
        self.pins.get(i).map_or(0.0, |f| f.norm())
    }

    /// How many pins there are forces of.
    pub fn pins(&self) -> usize {
        self.known.into()
    }

    /// The pin of the largest force.
    pub fn worst_pin(&self) -> Option<usize> {
        (self.known > 0).then_some(self.worst_pin.into())
    }
}

/// Looks into a machine while it moves.
#[derive(Clone, Debug)]
pub struct PinLoads {
    joints: Option<Joints>,
    axial: AxialMoments,
}

impl PinLoads {
    /// For a machine; where statics does not determine the forces of pins, what tilts the base only.
    pub fn of(machine: &Machine) -> Self {
        Self { joints: Joints::of(machine).ok(), axial: AxialMoments::of(machine) }
    }

    /// The size of what tilts the base, N m.
    pub fn tilt(&self, e: &Units, qd: &PerDrive, qdd: &PerDrive, around: &Surroundings) -> f64 {
        if self.axial.is_flat() { 0.0 } else { self.axial.tilt(e, qd, qdd, around).total().norm() }
    }

    /// The present instant, with the friction of pins as [`Joints::forces_with`] asks for it. On a base that moves,
    /// gravity is g − p̈_B.
    pub fn at(
        &self,
        e: &Units,
        qd: &PerDrive,
        qdd: &PerDrive,
        around: &Surroundings,
        couple: impl Fn(usize, usize) -> f64,
    ) -> Inside {
        let tilt = self.axial.tilt(e, qd, qdd, around);
        match &self.joints {
            Some(joints) => Inside::of(&joints.forces_with(e, qd, qdd, around, couple), tilt),
            None => Inside { tilt, ..Inside::default() },
        }
    }
}

/// Peak and mean of the force of one pin over a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PinPeak {
    /// The largest force, N, of the instants at which it is defined.
    pub force: f64,
    /// When, s.
    pub time: f64,
    /// Mean of its size over those instants, N.
    pub mean: f64,
    /// Instants at which it is defined.
    pub defined: u64,
    /// Instants at a change point, at which it is not.
    pub undefined: u64,
}

impl PinPeak {
    /// Takes in one more instant.
    pub fn include(&mut self, time: f64, force: Option<Vector>) {
        let Some(force) = force.map(|f| f.norm()) else {
            self.undefined += 1;
            return;
        };
        if force > self.force || self.defined == 0 {
            (self.force, self.time) = (force, time);
        }
        self.defined += 1;
        self.mean += (force - self.mean) / self.defined as f64;
    }
}

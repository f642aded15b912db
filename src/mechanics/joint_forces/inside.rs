//! Pin forces at one instant, as a frame stores them, and their peaks and means over a run.

use super::{AxialMoments, Joints, PinForces, TiltMoment};
use crate::dynamics::ExternalLoads;
use crate::machine::Machine;
use crate::planar::{PerDrive, UnitVectors, Vector};

/// Maximum number of pins whose forces a frame stores, which limits the memory of a session with many frames. A frame
/// always stores the largest force over all pins.
pub const MAX_FRAME_PINS: usize = 16;

/// Pin forces and tilting moment at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InternalLoads {
    pins: [Vector; MAX_FRAME_PINS],
    known: u8,
    undefined: u16,
    worst_pin: u8,
    /// The largest force of a pin, N; 0 if statics does not determine the forces.
    pub largest_force: f64,
    /// The moment that tilts the base, N m.
    pub tilt: TiltMoment,
}

impl InternalLoads {
    fn of(forces: &PinForces, tilt: TiltMoment) -> Self {
        let known = forces.bounded().len().min(MAX_FRAME_PINS);
        let mut pins = [Vector::default(); MAX_FRAME_PINS];
        pins[..known].copy_from_slice(&forces.bounded()[..known]);
        let (largest_force, worst_pin) = forces.largest();
        Self {
            pins,
            known: known as u8,
            undefined: forces.undefined() as u16,
            worst_pin: worst_pin as u8,
            largest_force,
            tilt,
        }
    }

    /// Returns the force that the first link of pin i exerts on its second link, N; i is an index into
    /// [`Joints::pins`]. `None` at a change point, for pins beyond [`MAX_FRAME_PINS`], and if statics does not
    /// determine the force.
    pub fn pin(&self, i: usize) -> Option<Vector> {
        (i < usize::from(self.known) && self.undefined & 1 << i == 0).then(|| self.pins[i])
    }

    /// Returns the magnitude of the force of pin i, N. It stays finite: at a change point, |sin(q_k − q_l)| is replaced
    /// by [`FLAT_SINE`](super::FLAT_SINE). For pins that are not stored it is 0.
    pub fn size(&self, i: usize) -> f64 {
        self.pins.get(i).map_or(0.0, |f| f.norm())
    }

    /// Returns the number of pins whose forces are stored.
    pub fn pins(&self) -> usize {
        self.known.into()
    }

    /// Returns the pin with the largest force; `None` if statics does not determine the forces.
    pub fn worst_pin(&self) -> Option<usize> {
        (self.known > 0).then_some(self.worst_pin.into())
    }
}

/// Computes pin forces and the tilting moment of a machine in motion.
#[derive(Clone, Debug)]
pub struct PinLoads {
    joints: Option<Joints>,
    axial: AxialMoments,
}

impl PinLoads {
    /// Prepares the computation for a machine. If statics does not determine the pin forces, only the tilting moment
    /// is computed.
    pub fn of(machine: &Machine) -> Self {
        Self { joints: Joints::of(machine).ok(), axial: AxialMoments::of(machine) }
    }

    /// Returns the magnitude of the tilting moment, N m.
    pub fn tilt(&self, e: &UnitVectors, qd: &PerDrive, qdd: &PerDrive, around: &ExternalLoads) -> f64 {
        if self.axial.is_flat() { 0.0 } else { self.axial.tilt(e, qd, qdd, around).total().norm() }
    }

    /// Returns pin forces and tilting moment at one instant; `couple` is the pin friction of [`Joints::forces_with`].
    /// On a moving base, gravity is g − p̈_B.
    pub fn at(
        &self,
        e: &UnitVectors,
        qd: &PerDrive,
        qdd: &PerDrive,
        around: &ExternalLoads,
        couple: impl Fn(usize, usize) -> f64,
    ) -> InternalLoads {
        let tilt = self.axial.tilt(e, qd, qdd, around);
        match &self.joints {
            Some(joints) => InternalLoads::of(&joints.forces_with(e, qd, qdd, around, couple), tilt),
            None => InternalLoads { tilt, ..InternalLoads::default() },
        }
    }
}

/// Peak and mean of the force of one pin over a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PinPeak {
    /// Largest magnitude of the force, N, over the instants at which the force is defined.
    pub force: f64,
    /// Time of the largest force, s.
    pub time: f64,
    /// Mean magnitude of the force over those instants, N.
    pub mean: f64,
    /// Number of instants at which the force is defined.
    pub defined: u64,
    /// Number of instants at a change point, at which the force is undefined.
    pub undefined: u64,
}

impl PinPeak {
    /// Includes one more instant, s, with its force, N; `None` if the force is undefined.
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

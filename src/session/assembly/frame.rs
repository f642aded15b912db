//! [`AssemblyFrame`]: blocks and base at one instant, and [`AssemblyVerdict`] on a run of them.

use nalgebra::{Matrix3, Vector3};

use super::base::MovingSupport;
use stillbase_mechanics::assembly::{Assembly, Attitude, BlockLoads, BlockState, MAX_BLOCKS, SpatialLoads};
use stillbase_mechanics::planar::PerDrive;
use stillbase_settings::number::fixed_or_finer;
use stillbase_simulation::frame::{SharedBase, silent};

/// The state at one instant.
#[derive(Clone, Debug)]
pub struct AssemblyFrame {
    /// Number of the step.
    pub step: u64,
    /// Time, s.
    pub time: f64,
    /// States of the blocks; those beyond the last have no drives.
    pub states: [BlockState; MAX_BLOCKS],
    /// Torques of the motors of each block, N m.
    pub torques: [PerDrive; MAX_BLOCKS],
    /// End effectors, m, in axes of the base.
    pub tips: [Vector3<f64>; MAX_BLOCKS],
    /// What the blocks put on their base, as it moves.
    pub loads: SpatialLoads,
    /// Attitude of the base; level if it is fixed.
    pub attitude: Attitude,
    /// Origin of the base in space, m.
    pub origin: Vector3<f64>,
    /// Rate of the base in its axes, rad/s.
    pub rate: Vector3<f64>,
}

impl AssemblyFrame {
    /// Returns the frame of a step and a time, s, with the states of all blocks on a base.
    pub(super) fn of(
        assembly: &Assembly,
        (step, time): (u64, f64),
        states: [BlockState; MAX_BLOCKS],
        base: &MovingSupport,
    ) -> Self {
        let mut torques = [PerDrive::zeros(0); MAX_BLOCKS];
        let mut see = |i: usize, of: &BlockLoads| torques[i] = of.torque;
        let (loads, rate) = match base.motion(assembly, &states) {
            Some((moving, gravity)) => (assembly.loads_on(&moving, &gravity, &states, see), moving.rate),
            None => (assembly.loads(&states, &mut see), Vector3::zeros()),
        };
        let (attitude, origin) = base.place();
        let tips = assembly.end_effectors(&states);
        Self { step, time, torques, tips, loads, states, attitude, origin, rate }
    }

    /// Returns a point of the base in space, m.
    pub fn in_space(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.origin + self.attitude.0 * point
    }

    /// Returns where a block of the assembly is in space: the place of its mount, m, and the directions x, y, z of its
    /// plane.
    ///
    /// # Panics
    /// If there is no such block.
    pub fn place(&self, assembly: &Assembly, block: usize) -> (Vector3<f64>, Matrix3<f64>) {
        let mount = &assembly.blocks()[block].mount;
        let below = mount.on.map_or_else(Vector3::zeros, |carrier| self.tips[carrier]);
        let turn = self.attitude.0.to_rotation_matrix().into_inner() * mount.axes;
        (self.in_space(&(below + mount.at)), turn)
    }
}

/// Assessment of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AssemblyVerdict {
    /// Peaks of the parts of force, N, and moment, N m, from motion: x, y, z of each.
    pub peaks: [f64; 6],
    /// Peak of Σ|τ|, N m, and peak of Σ m |a|, N: what the peaks are compared with.
    pub scale: [f64; 2],
    /// Largest turn of the base, rad, and that at the end.
    pub turn: [f64; 2],
    /// Largest distance of the base from where it was, m.
    pub shift: f64,
    /// Number of steps.
    pub steps: u64,
}

impl AssemblyVerdict {
    /// Names of the components of force and moment.
    pub const COMPONENTS: [&str; 6] = ["f_x", "f_y", "f_z", "n_x", "n_y", "n_z"];

    /// Returns the assessment up to the step of a frame, from the base that it shares.
    pub fn of(step: u64, shared: &SharedBase) -> Self {
        let SharedBase { peaks, scale, turn, shift, .. } = *shared;
        Self { peaks, scale, turn, shift, steps: step }
    }

    /// Returns the result in a sentence: what reaches a fixed base, or how a free one turns.
    pub fn sentence(&self, is_fixed: bool) -> String {
        if !is_fixed {
            let [most, end] = self.turn.map(|turn| fixed_or_finer(turn, 6));
            return format!("the base turns by up to {most} rad, and by {end} rad at the end");
        }
        let all = Self::COMPONENTS.iter().zip(self.peaks).zip(self.silent());
        let loud = all.filter(|(_, silent)| !silent).map(|((name, peak), _)| {
            let unit = if name.starts_with('f') { "N" } else { "N m" };
            format!("{name} up to {} {unit}", fixed_or_finer(peak, 6))
        });
        match loud.collect::<Vec<_>>()[..] {
            [] => "silent: nothing reaches the base in any of six components".to_owned(),
            ref loud => format!("reacts: {}", loud.join(", ")),
        }
    }

    /// Returns whether each of the six components is silent.
    pub fn silent(&self) -> [bool; 6] {
        silent(&self.peaks, &self.scale)
    }

    pub(super) fn see(&mut self, assembly: &Assembly, frame: &AssemblyFrame) {
        let six = frame.loads.motion.components();
        self.peaks.iter_mut().zip(six).for_each(|(most, x)| *most = most.max(x.abs()));
        let torque: f64 = frame.torques.iter().flat_map(|torque| torque.iter()).map(|x| x.abs()).sum();
        let forces = assembly.inertial_forces(&frame.states);
        self.scale = [self.scale[0].max(torque), self.scale[1].max(forces)];
        let turn = frame.attitude.0.angle();
        self.turn = [self.turn[0].max(turn), turn];
        self.shift = self.shift.max(frame.origin.norm());
        self.steps = frame.step;
    }
}

//! [`AssemblyRun`]: blocks that follow their references, on one base.

use std::sync::Arc;

use nalgebra::Vector3;

use super::file::{AssemblyBase, AssemblyScenario, BlockTask};
use super::shared::{between, state_of};
use crate::scenario::Scenario;
use crate::{Refusal, Run, replay};
use stillbase_mechanics::assembly::{Assembly, Attitude, BlockState, MAX_BLOCKS, SpatialLoads};
use stillbase_mechanics::planar::{DriveAngles, PerDrive};
use stillbase_planning::{Motion, Reference};
use stillbase_settings::number::fixed_or_finer;
use stillbase_simulation::control::Control;

/// A reaction below this share of the sum of all torques is none.
const SILENT: f64 = 1e-6;

/// How a block moves.
#[derive(Clone, Debug)]
enum BlockMotion {
    /// As planned.
    Planned(Arc<Motion>),
    /// As simulated, with edits and control: the states at the steps of this size, s.
    Simulated(f64, Arc<[BlockState]>),
    /// At rest.
    Rests(DriveAngles),
}

impl BlockMotion {
    /// Plans a task, or simulates it for a duration, s.
    fn of(task: &BlockTask, duration: Option<f64>) -> Result<Self, Refusal> {
        let scenario = &task.scenario;
        if task.rests {
            let run = Run::new(scenario)?;
            return Ok(Self::Rests(run.plan().motion.at(0.0).q));
        }
        if scenario.edits.is_empty() && scenario.control == Control::default() {
            return Ok(Self::Planned(Run::new(scenario)?.plan().motion.clone()));
        }
        let mut states = Vec::new();
        // Edits may come after the planned motion: the whole says how long it goes on.
        let whole = Scenario { duration: duration.or(scenario.duration), ..scenario.clone() };
        replay(&whole, |_, frame| states.push(state_of(frame)))?;
        Ok(Self::Simulated(scenario.step, states.into()))
    }

    /// Duration, s.
    fn duration(&self) -> f64 {
        match self {
            Self::Planned(motion) => motion.duration(),
            Self::Simulated(step, states) => (states.len() - 1) as f64 * step,
            Self::Rests(_) => 0.0,
        }
    }

    fn at(&self, t: f64) -> BlockState {
        let Reference { q, qd, qdd } = match self {
            Self::Planned(motion) => motion.at(t),
            Self::Rests(q) => Reference::at_rest(*q),
            Self::Simulated(step, states) => {
                let place = (t / step).max(0.0);
                let i = (place.floor() as usize).min(states.len() - 1);
                let Some(next) = states.get(i + 1) else { return states[i] };
                return between(&states[i], next, *step, place - i as f64);
            }
        };
        BlockState { q, qd, qdd }
    }
}

/// An assembly in motion.
#[derive(Clone, Debug)]
pub struct AssemblyRun {
    scenario: AssemblyScenario,
    motions: Vec<BlockMotion>,
    duration: f64,
}

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
    /// What the blocks put on a base at rest.
    pub loads: SpatialLoads,
    /// Attitude of the base; level if it is fixed.
    pub attitude: Attitude,
    /// Origin of the base in space, m.
    pub origin: Vector3<f64>,
    /// Rate of the base in its axes, rad/s.
    pub rate: Vector3<f64>,
}

/// Assessment of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AssemblyVerdict {
    /// Peaks of the parts of force, N, and moment, N m, from motion: x, y, z of each.
    pub peaks: [f64; 6],
    /// Peak of Σ|τ|, N m, and peak of Σ m |a|, N: what the peaks are compared with.
    pub scale: [f64; 2],
    /// Largest turn of the base, rad, and that at the end.
    pub turn: [f64; 2],
    /// Number of steps.
    pub steps: u64,
}

impl AssemblyVerdict {
    /// Names of the components of force and moment.
    pub const COMPONENTS: [&str; 6] = ["f_x", "f_y", "f_z", "n_x", "n_y", "n_z"];

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
        std::array::from_fn(|i| self.peaks[i] <= SILENT * self.scale[usize::from(i < 3)])
    }

    pub(super) fn see(&mut self, assembly: &Assembly, frame: &AssemblyFrame) {
        let six = frame.loads.motion.components();
        self.peaks.iter_mut().zip(six).for_each(|(most, x)| *most = most.max(x.abs()));
        let torque: f64 = frame.torques.iter().flat_map(|torque| torque.iter()).map(|x| x.abs()).sum();
        let forces = assembly.inertial_forces(&frame.states);
        self.scale = [self.scale[0].max(torque), self.scale[1].max(forces)];
        let turn = frame.attitude.0.angle();
        self.turn = [self.turn[0].max(turn), turn];
        self.steps = frame.step;
    }
}

impl AssemblyRun {
    /// Plans the tasks of all blocks.
    ///
    /// # Errors
    /// If the task of a block cannot be planned, with the place of the block; or if the run would have too many steps.
    pub fn new(scenario: &AssemblyScenario) -> Result<Self, (usize, Refusal)> {
        let mut motions = Vec::with_capacity(scenario.tasks.len());
        for (i, task) in scenario.tasks.iter().enumerate() {
            motions.push(BlockMotion::of(task, scenario.duration).map_err(|why| (i, why))?);
        }
        let longest = motions.iter().map(BlockMotion::duration);
        let duration = scenario.duration.unwrap_or_else(|| longest.fold(0.0, f64::max));
        Ok(Self { scenario: scenario.clone(), motions, duration })
    }

    /// Returns the scenario.
    pub fn scenario(&self) -> &AssemblyScenario {
        &self.scenario
    }

    /// Returns the duration, s.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Returns the number of steps; `None` if there are too many.
    pub fn steps(&self) -> Option<u64> {
        self.scenario.fits(self.duration).then(|| (self.duration / self.scenario.step - 1e-9).ceil().max(0.0) as u64)
    }

    fn states(&self, t: f64) -> [BlockState; MAX_BLOCKS] {
        let none = PerDrive::zeros(0);
        let mut all = [BlockState { q: DriveAngles(none), qd: none, qdd: none }; MAX_BLOCKS];
        all.iter_mut().zip(&self.motions).for_each(|(state, motion)| *state = motion.at(t));
        all
    }

    /// Goes through the run and gives `see` every step, until it returns false. Returns the assessment.
    pub fn run(&self, mut see: impl FnMut(&AssemblyFrame) -> bool) -> AssemblyVerdict {
        let AssemblyScenario { assembly, base, step, .. } = &self.scenario;
        let (mut verdict, mut attitude) = (AssemblyVerdict::default(), Attitude::level());
        let rest = Vector3::zeros();
        let moving = |t: f64| match base {
            AssemblyBase::Fixed => None,
            AssemblyBase::Free(base) => Some(assembly.base_motion(base, &self.states(t), &rest)),
        };
        let first = moving(0.0).map_or(rest, |motion| motion.com);
        for i in 0..=self.steps().unwrap_or(0) {
            // The last step may be shorter.
            let time = (i as f64 * step).min(self.duration);
            let (rate, com) = moving(time).map_or((rest, rest), |motion| (motion.rate, motion.com));
            let frame = self.frame(assembly, i, time, (attitude, first - attitude.0 * com, rate));
            verdict.see(assembly, &frame);
            if !see(&frame) {
                break;
            }
            let h = ((i + 1) as f64 * step).min(self.duration) - time;
            if matches!(base, AssemblyBase::Free(_)) && h > 0.0 {
                attitude = attitude.after(h, |part, _| moving(time + part * h).map_or(rest, |motion| motion.rate));
            }
        }
        verdict
    }

    fn frame(
        &self,
        assembly: &Assembly,
        step: u64,
        time: f64,
        (attitude, origin, rate): (Attitude, Vector3<f64>, Vector3<f64>),
    ) -> AssemblyFrame {
        AssemblyFrame::of(assembly, (step, time), self.states(time), (attitude, origin, rate))
    }
}

impl AssemblyFrame {
    /// Returns the frame of a step and a time, s, with the states of all blocks, and the attitude, the origin, m, and the
    /// rate, rad/s, of the base.
    pub(super) fn of(
        assembly: &Assembly,
        (step, time): (u64, f64),
        states: [BlockState; MAX_BLOCKS],
        (attitude, origin, rate): (Attitude, Vector3<f64>, Vector3<f64>),
    ) -> Self {
        let mut torques = [PerDrive::zeros(0); MAX_BLOCKS];
        let loads = assembly.loads(&states, |i, of| torques[i] = of.torque);
        let tips = assembly.end_effectors(&states);
        Self { step, time, torques, tips, loads, states, attitude, origin, rate }
    }

    /// Returns a point of the base in space, m.
    pub fn in_space(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.origin + self.attitude.0 * point
    }
}

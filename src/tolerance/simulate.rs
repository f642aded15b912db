//! A varied machine under control that knows only the nominal one.

use super::ensemble::Outcome;
use crate::machine::Machine;
use crate::session::{Refusal, Run};
use crate::simulation::{Guide, Simulation};

/// Simulates a planned motion, control and all, with another machine as plant.
///
/// # Errors
/// If the numbers blow up.
pub fn simulate(planned: &Run, plant: &Machine) -> Result<Outcome, Refusal> {
    let scenario = planned.scenario();
    let guide = Guide::Motion { motion: planned.plan().motion.clone(), start: 0.0 };
    let mut simulation = Simulation::new(&scenario.machine, plant, scenario.gains, scenario.step, guide);
    let (mut steps, mut moment, mut force) = (0.0, 0.0, 0.0);
    loop {
        let frame = simulation.frame();
        if !frame.is_finite() {
            return Err(Refusal::Diverged { time: frame.time });
        }
        moment += frame.base_moment().powi(2);
        force += frame.wrench.dynamic.force.norm_sqr();
        steps += 1.0;
        if frame.step >= planned.last_step() {
            return Ok(Outcome {
                peak_moment: frame.peaks.moment,
                peak_force: frame.peaks.force,
                rms_moment: f64::sqrt(moment / steps),
                rms_force: f64::sqrt(force / steps),
            });
        }
        simulation.advance();
    }
}

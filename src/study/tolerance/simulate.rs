//! Simulation of a varied machine under control that knows only the nominal one.

use super::batch::GoesOn;
use super::ensemble::SampleOutcome;
use stillbase_mechanics::machine::Machine;
use stillbase_session::{Refusal, Run};
use stillbase_simulation::frame::Frame;
use stillbase_simulation::plant::{Load, PlantDifferences};
use stillbase_simulation::{Setup, Simulation};

/// Number of steps after which `goes_on` is asked again; they take some milliseconds.
const STEPS_PER_QUESTION: u64 = 256;

/// Simulates a planned motion, control included, with another machine as the plant.
///
/// # Errors
/// If the plant cannot hold its payload, the state diverges, or an audit fails: a study has no values of such runs.
/// Also if `goes_on` returns `false`.
pub fn simulate(planned: &Run, plant: &Machine, goes_on: GoesOn<'_>) -> Result<SampleOutcome, Refusal> {
    let scenario = planned.scenario();
    let guide = planned.plan().guide(&scenario.machine);
    // A payload held from the start is part of the varied machine; a payload taken up later is not.
    let load = scenario.plant.payload;
    let payload = if load.is_held(0.0, 0.5 * scenario.step) { Load::default() } else { load };
    let rest = PlantDifferences { payload, ..scenario.plant.clone() };
    let setup = Setup { plant: &rest, ..scenario.setup() };
    let mut simulation = Simulation::of_machine(&setup, plant.clone(), guide)?;
    let last = planned.last_step();
    let (mut weights, mut moment, mut force) = (0.0, 0.0, 0.0);
    // Without a wheel the moment is n_B, also on a free base, which feels that about its own centre of mass.
    let has_wheel = scenario.base.wheel.is_some();
    let on_base = |frame: &Frame| if has_wheel { frame.felt_moment } else { frame.base_moment() };
    loop {
        let frame = simulation.frame();
        if frame.step.is_multiple_of(STEPS_PER_QUESTION) && !goes_on() {
            return Err(Refusal::Stopped);
        }
        if !frame.is_finite() {
            return Err(Refusal::Diverged { time: frame.time });
        }
        // Trapezoidal rule: the first and the last sample have half the weight.
        let weight = if frame.step == 0 || frame.step >= last { 0.5 } else { 1.0 };
        moment += weight * on_base(&frame).powi(2);
        force += weight * frame.wrench.dynamic.force.norm_sqr();
        weights += weight;
        if frame.step >= last {
            if let Some(lamp) = frame.first_violation() {
                return Err(Refusal::Untrusted { why: lamp.to_string() });
            }
            return Ok(SampleOutcome {
                peak_moment: if has_wheel { frame.peaks.moment } else { frame.peaks.arm_moment },
                peak_force: frame.peaks.force,
                rms_moment: f64::sqrt(moment / weights),
                rms_force: f64::sqrt(force / weights),
            });
        }
        simulation.advance();
    }
}

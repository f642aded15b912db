//! Runs from their start to their end, with everything that was done to them.

use crate::query::Queries;
use crate::session::changes::{Failed, folded, in_order};
use crate::session::scenario::Scenario;
use crate::session::{Refusal, Run, TimedEdit};
use crate::simulation::audit::AuditFigure;
use crate::simulation::frame::Frame;

/// A scenario with the edits before its first step made part of it, and the others left out, and how many those others
/// are.
///
/// # Errors
/// If an edit cannot be made.
pub fn settled(scenario: &Scenario) -> Result<(Scenario, usize), Refusal> {
    let script = in_order(&scenario.edits);
    let (start, count) =
        folded(scenario, &script, &Queries::default()).map_err(|failed| failed.named(&scenario.edits))?;
    Ok((start, script.len() - count))
}

/// Frames of a scenario with its edits, from the first to the last step, one at a time.
///
/// # Errors
/// If it cannot start, or an edit cannot apply.
pub fn replay(scenario: &Scenario, see: impl FnMut(&Run, &Frame)) -> Result<Run, Refusal> {
    replay_if(scenario, |_| Ok(()), see)
}

/// The same; `check` is given the number of the last step before the run begins, and may refuse it.
///
/// # Errors
/// As [`replay`], and if it is refused.
pub fn replay_if(
    scenario: &Scenario,
    allow: impl FnOnce(u64) -> Result<(), Refusal>,
    see: impl FnMut(&Run, &Frame),
) -> Result<Run, Refusal> {
    let mut see = see;
    whole(scenario, allow, |run, frame| {
        see(run, frame);
        true
    })
}

/// The same as [`replay`]; `see` says of each frame whether the rest is still wanted.
///
/// # Errors
/// As [`replay`], and [`Refusal::Stopped`] if it is not.
pub fn replay_while(scenario: &Scenario, see: impl FnMut(&Run, &Frame) -> bool) -> Result<Run, Refusal> {
    whole(scenario, |_| Ok(()), see)
}

fn whole(
    scenario: &Scenario,
    allow: impl FnOnce(u64) -> Result<(), Refusal>,
    see: impl FnMut(&Run, &Frame) -> bool,
) -> Result<Run, Refusal> {
    let end = |run: &Run, script: &[TimedEdit]| {
        let last = run.whole(script)?;
        allow(last).map(|()| last).map_err(Failed::from)
    };
    let done = perform(scenario, &in_order(&scenario.edits), (end, false), None, see);
    done.map_err(|failed| failed.named(&scenario.edits))
}

/// What shakes the base at every step of a scenario: f_Bx and f_By of motion, N, and the moment that it feels, N m; and
/// the first audit that the run has failed.
///
/// # Errors
/// As [`replay`].
pub fn felt(scenario: &Scenario) -> Result<([Vec<f64>; 3], Option<AuditFigure>), Refusal> {
    let mut course: [Vec<f64>; 3] = Default::default();
    let run = replay(scenario, |_, frame| {
        let force = frame.wrench.dynamic.force;
        let now = [force.re, force.im, frame.felt_moment()];
        course.iter_mut().zip(now).for_each(|(all, x)| all.push(x));
    })?;
    Ok((course, run.frame().fault()))
}

/// Runs a scenario, as edits at the start leave it, to a last step, with a script in order, and shows every frame to
/// `see`, which says whether the rest is still wanted. A task that does not fit its machine is refused, or, with
/// patience, waits at its first step.
pub(super) fn perform(
    scenario: &Scenario,
    script: &[TimedEdit],
    (end, patient): (impl FnOnce(&Run, &[TimedEdit]) -> Result<u64, Failed>, bool),
    known: Option<&Run>,
    mut see: impl FnMut(&Run, &Frame) -> bool,
) -> Result<Run, Failed> {
    let (mut run, begun) = Run::begin(scenario, script, known)?;
    if let Some(waiting) = run.waiting() {
        if !patient {
            return Err(waiting.why.clone().into());
        }
        see(&run, &run.frame());
        return Ok(run);
    }
    let end = end(&run, script)?;
    let mut edits = script.iter().enumerate().skip(begun).peekable();
    loop {
        let step = run.simulation().step_count();
        while let Some((i, timed)) = edits.next_if(|(_, e)| e.step <= step) {
            run.apply(&timed.edit).map_err(|refusal| Failed::at(i, refusal))?;
        }
        let frame = run.frame();
        if !frame.is_finite() {
            return Err(Refusal::Diverged { time: frame.time }.into());
        }
        if !see(&run, &frame) {
            return Err(Refusal::Stopped.into());
        }
        if step >= end {
            return Ok(run);
        }
        run.advance();
    }
}

//! Replays scenarios with their edits from the first to the last step.

use crate::changes::{ScriptError, fold_start_edits, in_order};
use crate::scenario::Scenario;
use crate::whole_frame::{WholeFrame, signals_of_whole};
use crate::{Refusal, Run, TimedEdit};
use stillbase_query::Queries;
use stillbase_simulation::audit::AuditFigure;
use stillbase_simulation::frame::Frame;
use stillbase_simulation::signal_table::SignalTable;

/// Applies the edits at step 0 that precede the first drag. Returns the scenario without the other edits, and the
/// number of the others.
///
/// # Errors
/// If an edit cannot apply.
pub fn with_start_edits(scenario: &Scenario) -> Result<(Scenario, usize), Refusal> {
    let script = in_order(&scenario.edits);
    let (start, count) =
        fold_start_edits(scenario, &script, &Queries::default()).map_err(|failed| failed.named(&scenario.edits))?;
    Ok((start, script.len() - count))
}

/// Runs a scenario with its edits and calls `see` with every frame, from the first to the last step. Returns the run at
/// its last step.
///
/// # Errors
/// If the scenario cannot start, an edit cannot apply, the run has too many steps, or the motion diverges.
pub fn replay(scenario: &Scenario, see: impl FnMut(&Run, &Frame)) -> Result<Run, Refusal> {
    let mut see = see;
    replay_while(scenario, |run, frame| {
        see(run, frame);
        true
    })
}

/// Does the same as [`replay`]; `see` returns whether the run is to go on.
///
/// # Errors
/// As [`replay`], and [`Refusal::Stopped`] if `see` ends the run early.
pub fn replay_while(scenario: &Scenario, see: impl FnMut(&Run, &Frame) -> bool) -> Result<Run, Refusal> {
    replay_if(scenario, |_| Ok(()), see)
}

/// Does the same as [`replay_while`]. Before the run begins, `allow` receives the number of the last step, and may
/// refuse it.
///
/// # Errors
/// As [`replay_while`], and the refusal of `allow`.
pub fn replay_if(
    scenario: &Scenario,
    allow: impl FnOnce(u64) -> Result<(), Refusal>,
    see: impl FnMut(&Run, &Frame) -> bool,
) -> Result<Run, Refusal> {
    let end = |run: &Run, script: &[TimedEdit]| {
        let last = run.checked_last_step(script)?;
        allow(last).map(|()| last).map_err(ScriptError::from)
    };
    let done = perform(scenario, &in_order(&scenario.edits), end, false, None, see);
    done.map_err(|failed| failed.named(&scenario.edits))
}

/// Returns the signals of a scenario at the instants that `keeps` chooses, as long as `goes_on` returns `true`. Before
/// the run begins, `allow` receives the number of the last step and the number of signals, and may refuse them.
///
/// # Errors
/// As [`replay_while`], and the refusal of `allow`.
pub fn signal_table(
    scenario: &Scenario,
    allow: impl FnOnce(u64, usize) -> Result<(), Refusal>,
    mut keeps: impl FnMut(&Run, &Frame) -> bool,
    goes_on: impl Fn() -> bool,
) -> Result<SignalTable, Refusal> {
    // The first edits may draw another machine.
    let (start, _) = with_start_edits(scenario)?;
    let signals = signals_of_whole(&start);
    let mut table = SignalTable::of(&signals);
    let see = |run: &Run, frame: &Frame| {
        if keeps(run, frame) {
            let whole = WholeFrame::of(run, frame);
            table.push(frame.time, signals.iter().map(|signal| whole.value(signal)));
        }
        goes_on()
    };
    replay_if(scenario, |last| allow(last, signals.len()), see)?;
    Ok(table)
}

/// Returns the dynamic f_Bx and f_By, N, and the net moment on the base, N m, at every step of a scenario, as long as
/// `goes_on` returns `true`. Also returns the first figure of the final audit that exceeds its tolerance, if any.
///
/// # Errors
/// As [`replay_while`].
pub fn base_loads(
    scenario: &Scenario,
    goes_on: impl Fn() -> bool,
) -> Result<([Vec<f64>; 3], Option<AuditFigure>), Refusal> {
    let mut course: [Vec<f64>; 3] = Default::default();
    let run = replay_while(scenario, |_, frame| {
        let force = frame.wrench.dynamic.force;
        let now = [force.re, force.im, frame.felt_moment];
        course.iter_mut().zip(now).for_each(|(all, x)| all.push(x));
        goes_on()
    })?;
    Ok((course, run.frame().first_violation()))
}

/// Runs a scenario up to the step that `end` returns; the script is in order of steps. Calls `see` with every frame;
/// `see` returns whether the run is to go on. If the task does not fit its machine, the run is refused or, if `patient`
/// is true, waits at its first step.
pub(super) fn perform(
    scenario: &Scenario,
    script: &[TimedEdit],
    end: impl FnOnce(&Run, &[TimedEdit]) -> Result<u64, ScriptError>,
    patient: bool,
    known: Option<&Run>,
    mut see: impl FnMut(&Run, &Frame) -> bool,
) -> Result<Run, ScriptError> {
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
            run.apply(&timed.edit).map_err(|refusal| ScriptError::at(i, refusal))?;
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

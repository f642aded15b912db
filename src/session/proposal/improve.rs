//! Proposals that improve a plan that starts: one that exceeds a limit of a drive, changes b, or is of a machine that is
//! not balanced.

use super::{Proposal, round_up};
use crate::design::balancing_change;
use crate::run::Run;
use crate::scenario::{Scenario, TaskKind};
use crate::verdict::changes_b;
use stillbase_mechanics::machine::Inertia;
use stillbase_planning::timing::TimeLaw;
use stillbase_query::ProgressCallback;
use stillbase_settings::change::{join, single_change};
use stillbase_settings::word::Choice;

/// Largest factor by which a motion is made longer to keep the limits of the drives.
const MAX_TIME_FACTOR: f64 = 64.0;

/// Returns proposals for a scenario that starts, but whose plan exceeds a limit of a drive or changes b, or whose
/// machine is not balanced. Each has been planned, and mends what its text says.
pub fn improvements(scenario: &Scenario) -> Vec<Proposal> {
    improvements_while(scenario, &mut |_| true).unwrap_or_default()
}

pub(super) fn improvements_while(scenario: &Scenario, goes_on: ProgressCallback<'_>) -> Option<Vec<Proposal>> {
    let bare = scenario.without_edits();
    let Ok(run) = Run::new(&bare) else { return Some(Vec::new()) };
    let mut proposals = Vec::new();
    let forecast = &run.plan().forecast;
    if forecast.exceeded_limit.is_some() {
        proposals.extend(long_enough(&bare, goes_on)?);
        let fastest = Proposal::new(
            "find the fastest motion within the limits",
            single_change("task.law", TimeLaw::Fastest.words().file),
        );
        proposals.extend(Some(fastest).filter(|fastest| fastest.tried(&bare).is_some_and(|run| keeps_limits(&run))));
    }
    if !Inertia::of(&bare.machine).is_balanced() {
        let balanced =
            balancing_change(&bare).map(|change| Proposal::new("balance the machine", change).reduced(&bare));
        proposals.extend(balanced.filter(|balanced| balanced.tried(&bare).is_some()));
    } else if changes_b(&run) {
        let kind = single_change("task.kind", TaskKind::Reactionless.words().file);
        let reactionless = Proposal::new("run it reactionless", kind);
        proposals.extend(Some(reactionless).filter(|one| one.tried(&bare).is_some()));
    }
    Some(proposals)
}

/// Returns whether [`improvements`] has anything to improve about a plan, without a search.
pub fn is_improvable(run: &Run) -> bool {
    !keeps_limits(run) || changes_b(run) || !Inertia::of(&run.scenario().machine).is_balanced()
}

fn keeps_limits(run: &Run) -> bool {
    run.plan().forecast.exceeded_limit.is_none()
}

/// Returns a proposal whose plan, `run`, has been tried, in a form that keeps the limits of the drives: with a longer
/// time where that helps. Otherwise its text says which limit it exceeds, and how far. `None` if the search was
/// cancelled.
pub(super) fn within_limits(proposal: Proposal, run: &Run, goes_on: ProgressCallback<'_>) -> Option<Proposal> {
    let Some((limit, factor)) = run.plan().forecast.exceeded_limit else { return Some(proposal) };
    let longer = long_enough(run.scenario(), goes_on)?;
    if let Some((own, longer)) = longer.and_then(|longer| Some((proposal.change()?.clone(), longer)))
        && let Some(time) = longer.change()
    {
        return Some(Proposal::new(format!("{}, and {}", proposal.text, longer.text), join(own, time)));
    }
    Some(Proposal { text: format!("{} ({limit}: {factor:.2} times its limit)", proposal.text), ..proposal })
}

/// Proposes the shortest duration found, to 2 %, at which the planned motion keeps all limits of the drives. The outer
/// `Option` is `None` if the search was cancelled.
fn long_enough(scenario: &Scenario, goes_on: ProgressCallback<'_>) -> Option<Option<Proposal>> {
    if scenario.condition_for_effect("task.time").is_some() {
        return Some(None);
    }
    let of_factor = |factor: f64| {
        let time = round_up(factor * scenario.task.time);
        let text = format!("take {:.1} times as long, {time} s", time / scenario.task.time);
        Proposal::new(text, single_change("task.time", time))
    };
    let keeps = |factor: f64| of_factor(factor).tried(scenario).is_some_and(|run| keeps_limits(&run));
    let (mut short, mut long) = (1.0, 2.0);
    while !keeps(long) {
        if long >= MAX_TIME_FACTOR {
            return Some(None);
        }
        if !goes_on(0.0) {
            return None;
        }
        (short, long) = (long, 2.0 * long);
    }
    while long > 1.02 * short {
        if !goes_on(0.5) {
            return None;
        }
        let middle = (short * long).sqrt();
        if keeps(middle) { long = middle } else { short = middle }
    }
    Some(Some(of_factor(long)))
}

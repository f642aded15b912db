//! Proposals that lead out of a refusal: of a scenario, or of settings that a scenario cannot have.

use std::cell::Cell;
use std::sync::Arc;

use toml::Table;

use super::Proposal;
use super::improve::{improvements_while, within_limits};
use super::task::{candidates, made_task, shows_only_in_motion, would_plan};
use super::value::{nearest_values, taking_back};
use super::wider::{names_limits, wider_limits};
use crate::changes::after_start_edit;
use crate::edit::Edit;
use crate::refusal::Refusal;
use crate::replay::{replay_while, with_start_edits};
use crate::run::Run;
use crate::scenario::{Scenario, TaskKind};
use stillbase_query::{Portion, ProgressCallback, Queries, Query, Shared};
use stillbase_settings::change::join;

/// Maximum number of proposals for one refusal.
const MAX_PROPOSALS: usize = 4;

/// What is refused, or to be improved.
#[derive(Clone, Debug, PartialEq)]
pub struct RefusedChange {
    /// The scenario.
    scenario: Shared<Scenario>,
    /// Settings that the scenario was to have in addition, but cannot have.
    wanted: Table,
    /// Reason of the refusal; none if a plan is to be improved.
    refusal: Option<Refusal>,
}

impl RefusedChange {
    /// Returns the refusal of a scenario, with all of its settings.
    pub fn of(scenario: Shared<Scenario>, refusal: Refusal) -> Self {
        Self { scenario, wanted: Table::new(), refusal: Some(refusal) }
    }

    /// Returns the question what would improve the plan of a scenario.
    pub fn to_improve(scenario: Shared<Scenario>) -> Self {
        Self { scenario, wanted: Table::new(), refusal: None }
    }

    /// Returns the refusal of an edit of a scenario; `None` if the edit changes neither settings nor the start.
    pub fn of_edit(scenario: &Scenario, edit: &Edit, refusal: &Refusal) -> Option<Self> {
        let bare = scenario.without_edits();
        let of = |scenario: Scenario, wanted: Table| Self {
            scenario: Shared(Arc::new(scenario)),
            wanted,
            refusal: Some(refusal.clone()),
        };
        match edit {
            Edit::Set { change } => {
                let changed = bare.with_settings(change).ok().filter(|changed| changed.check("").is_ok());
                Some(changed.map_or_else(|| of(bare, change.clone()), |changed| of(changed, Table::new())))
            }
            Edit::PoseB { .. } => {
                let changed = after_start_edit(&bare, edit, &Queries::default()).ok()?;
                Some(of(changed, Table::new()))
            }
            _ => None,
        }
    }
}

impl RefusedChange {
    /// Returns the proposals that lead out of the refusal or, without one, that improve the plan.
    pub fn proposals(&self) -> Vec<Proposal> {
        self.proposals_while(&mut |_| true).unwrap_or_default()
    }

    fn proposals_while(&self, goes_on: ProgressCallback<'_>) -> Option<Vec<Proposal>> {
        let Self { scenario, wanted, refusal } = self;
        match refusal {
            Some(_) if !wanted.is_empty() => settings_while(&scenario.0, wanted, goes_on),
            Some(refusal) => proposals_while(&scenario.0, refusal, goes_on),
            None => improvements_while(&scenario.0, goes_on),
        }
    }
}

/// Query for the proposals that lead out of a refusal or, without one, that improve a plan.
#[derive(Debug)]
pub struct ProposalsQuery(RefusedChange);

impl Query for ProposalsQuery {
    type Input = RefusedChange;
    type Answer = Vec<Proposal>;

    fn begin(refused: Self::Input) -> Self {
        Self(refused)
    }

    fn go_on(&mut self, goes_on: ProgressCallback<'_>) -> Portion<Self::Answer> {
        self.0.proposals_while(goes_on).map_or(Portion::Stopped, Portion::Done)
    }
}

/// Returns proposals for a refused scenario, the least change first. Each has been tried, by a plan or a whole run.
pub fn proposals(scenario: &Scenario, refusal: &Refusal) -> Vec<Proposal> {
    proposals_while(scenario, refusal, &mut |_| true).unwrap_or_default()
}

/// Does the same as [`proposals`]; `None` if `goes_on` stops the search. It receives the fraction done, from 0 to 1.
pub fn proposals_while(scenario: &Scenario, refusal: &Refusal, goes_on: ProgressCallback<'_>) -> Option<Vec<Proposal>> {
    if matches!(refusal, Refusal::Unfinished(_)) {
        // No setting finishes a drawing.
        return Some(Vec::new());
    }
    // What starts is the scenario after its first edits, which may have drawn another machine; what is typed comes
    // before them.
    let start = with_start_edits(scenario).map_or_else(|_| scenario.without_edits(), |(start, _)| start);
    let candidates = candidates(&start, refusal);
    let count = candidates.len() + 2;
    // Wider limits and a task made for the machine take a search, so this is done only if the loop gets to it.
    // Of all kinds, one alone turns the base: another task is the last resort.
    let has_way_out = Cell::new(false);
    let takes_another = || would_plan(refusal) && !(start.task.kind == TaskKind::TurnBase && has_way_out.get());
    let made = std::iter::once_with(|| takes_another().then(|| made_task(&start)).flatten()).flatten();
    let wider = std::iter::once_with(|| names_limits(refusal).then(|| wider_limits(&start)).flatten()).flatten();
    let is_edited_later = with_start_edits(scenario).is_ok_and(|(_, others)| others > 0);
    let in_motion = shows_only_in_motion(refusal) || is_edited_later;
    // What works, as it was tried first: a longer time may have been added to it.
    let (mut proposals, mut known): (Vec<Proposal>, Vec<Proposal>) = Default::default();
    for (i, candidate) in candidates.into_iter().chain(wider).chain(made).enumerate() {
        if !goes_on(i as f64 / count as f64) {
            return None;
        }
        let candidate = candidate.reduced(scenario);
        let is_new = candidate.change().is_some_and(|change| !change.is_empty())
            && known.iter().all(|known| known.text != candidate.text && known.way != candidate.way);
        if !is_new {
            continue;
        }
        let share = i as f64 / count as f64;
        let first = candidate.clone();
        let working = match in_motion {
            true => runs_without_fault(scenario, &candidate, &mut || goes_on(share))?.then_some(candidate),
            false => match candidate.tried(scenario) {
                Some(run) => {
                    let longer = within_limits(candidate.clone(), &run, &mut |_| goes_on(share))?;
                    // An edit may set the time again.
                    Some(if longer.tried(scenario).is_some() { longer } else { candidate })
                }
                None => None,
            },
        };
        if let Some(working) = working {
            proposals.push(working);
            has_way_out.set(true);
            known.push(first);
            if proposals.len() == MAX_PROPOSALS {
                break;
            }
        }
    }
    Some(proposals)
}

/// Runs a scenario after a proposal; returns whether it comes to its end and its audit finds no fault. `None` if
/// `goes_on` stops the run.
fn runs_without_fault(scenario: &Scenario, proposal: &Proposal, goes_on: &mut dyn FnMut() -> bool) -> Option<bool> {
    let Some(changed) = proposal.typed(scenario) else { return Some(false) };
    match replay_while(&changed, |_, _| goes_on()) {
        Ok(run) => Some(run.frame().first_violation().is_none()),
        Err(Refusal::Stopped) => None,
        Err(_) => Some(false),
    }
}

/// Returns proposals for settings that a scenario cannot have: the nearest allowed values, or else the present ones.
/// A run with the wanted settings, and then those of a proposal, starts.
pub fn proposals_for_settings(scenario: &Scenario, wanted: &Table) -> Vec<Proposal> {
    settings_while(scenario, wanted, &mut |_| true).unwrap_or_default()
}

fn settings_while(scenario: &Scenario, wanted: &Table, goes_on: ProgressCallback<'_>) -> Option<Vec<Proposal>> {
    let with = |change: &Table| {
        let changed = scenario.with_settings(&join(wanted.clone(), change)).ok()?;
        changed.check("").ok().map(|()| changed)
    };
    let starts = |changed: &Scenario| Run::new(&with_start_edits(changed)?.0);
    let present = |path: &str| scenario.value(path);
    let allowed = |found: Proposal| {
        let changed = with(found.change()?)?;
        Some((found, changed))
    };
    let nearest = nearest_values(wanted, &present, &|change| with(change).is_some()).and_then(allowed);
    let mut found: Vec<Proposal> = Vec::new();
    if let Some((nearest, changed)) = nearest {
        match starts(&changed) {
            Ok(_) => found.push(nearest),
            // The values are allowed, but the task cannot be planned with them: what helps then is proposed with them.
            Err(why) => {
                let further = proposals_while(&changed, &why, goes_on)?;
                found.extend(further.into_iter().filter_map(|further| {
                    let change = join(nearest.change()?.clone(), further.change()?);
                    Some(Proposal::new(format!("{}, and {}", nearest.text, further.text), change))
                }));
            }
        }
    }
    if found.is_empty() {
        let kept = taking_back(wanted, &present).and_then(allowed);
        found.extend(kept.filter(|(_, changed)| starts(changed).is_ok()).map(|(kept, _)| kept));
    }
    Some(found)
}

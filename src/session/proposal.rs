//! [`Proposal`]: settings that let a refused task run, or that improve a run. Each has been tried.

use serde::{Serialize, Serializer};
use toml::Table;

use crate::design::balancing_change;
use crate::edit::Edit;
use crate::gentle_motion;
use crate::refusal::Refusal;
use crate::run::Run;
use crate::scenario::{MAX_STEPS, PathShape, Scenario, Task, TaskKind};
use crate::verdict::changes_b;
use stillbase_mechanics::machine::{Inertia, is_of_machine};
use stillbase_mechanics::planar::{Vector, unit};
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::reactionless::Decimal;
use stillbase_planning::timing::TimeLaw;
use stillbase_query::{Portion, ProgressCallback, Query, Shared};
use stillbase_settings::change::{join, leaves, single_change, typed};
use stillbase_settings::number::significant;
use stillbase_settings::range::Requirement;
use stillbase_settings::word::Choice;

/// Maximum number of proposals for one refusal.
const MAX_PROPOSALS: usize = 4;

/// Largest factor by which a motion is made longer to keep the limits of the drives.
const MAX_TIME_FACTOR: f64 = 64.0;
/// Numbers of decimals of turned points, m, in the order of the trials.
const TURNED_DECIMALS: [usize; 3] = [3, 5, 9];

/// A way out: a change of settings after which the task can be planned and run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Proposal {
    /// What the change does, as the label of a button: `take b = 2.2158 rad`.
    pub text: String,
    /// The settings, as files and edits state them; serialised as `--set` takes them: `task.b=2.2158`.
    #[serde(rename = "set", serialize_with = "as_typed")]
    pub change: Table,
}

fn as_typed<S: Serializer>(change: &Table, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(typed_settings(change))
}

fn typed_settings(change: &Table) -> impl Iterator<Item = String> {
    leaves(change).into_iter().map(|(key, value)| format!("{key}={}", typed(value)))
}

impl Proposal {
    fn new(text: impl Into<String>, change: Table) -> Self {
        Self { text: text.into(), change }
    }

    fn of_task(text: impl Into<String>, change: Table) -> Self {
        Self::new(text, Table::from_iter([("task".to_owned(), change.into())]))
    }

    /// Returns the settings, each as `--set` takes it: `task.b=2.2158`.
    pub fn settings(&self) -> Vec<String> {
        typed_settings(&self.change).collect()
    }

    /// Returns whether the proposal changes the machine.
    pub fn is_of_machine(&self) -> bool {
        self.change.keys().any(|key| is_of_machine(key))
    }

    /// Returns the proposal as one edit.
    pub fn edit(&self) -> Edit {
        Edit::Set { change: self.change.clone() }
    }

    /// Returns one edit that makes the settings of an edit and then those of the proposal.
    pub fn edit_after(&self, edit: &Edit) -> Edit {
        match edit {
            Edit::Set { change } => Edit::Set { change: join(change.clone(), &self.change) },
            _ => self.edit(),
        }
    }

    /// Returns the proposal without settings that change nothing.
    fn reduced(self, scenario: &Scenario) -> Self {
        let Some(changed) = self.applied(scenario) else { return self };
        let all: Vec<Table> =
            leaves(&self.change).into_iter().map(|(path, value)| single_change(&path, value.clone())).collect();
        let without = |kept: &[bool]| {
            let kept = all.iter().zip(kept).filter(|(_, kept)| **kept);
            Self { change: kept.fold(Table::new(), |all, (one, _)| join(all, one)), text: self.text.clone() }
        };
        let mut kept = vec![true; all.len()];
        for i in 0..all.len() {
            kept[i] = false;
            kept[i] = without(&kept).applied(scenario).is_none_or(|other| other != changed);
        }
        without(&kept)
    }

    /// Returns the scenario with the change.
    fn applied(&self, scenario: &Scenario) -> Option<Scenario> {
        let changed = scenario.with_settings(&self.change).ok()?;
        changed.check("").ok().map(|()| changed)
    }

    /// Returns the run after the change, at rest at its start; `None` if it is refused.
    fn tried(&self, scenario: &Scenario) -> Option<Run> {
        Run::new(&self.applied(scenario)?).ok()
    }
}

/// Query for the proposals that lead out of a refusal or, without one, that improve a plan.
#[derive(Debug)]
pub struct ProposalsQuery {
    scenario: Shared<Scenario>,
    refusal: Option<Refusal>,
}

impl Query for ProposalsQuery {
    type Input = (Shared<Scenario>, Option<Refusal>);
    type Answer = Vec<Proposal>;

    fn begin((scenario, refusal): Self::Input) -> Self {
        Self { scenario, refusal }
    }

    fn go_on(&mut self, goes_on: ProgressCallback<'_>) -> Portion<Self::Answer> {
        let proposals = match &self.refusal {
            Some(refusal) => proposals_while(&self.scenario.0, refusal, goes_on),
            None => improvements_while(&self.scenario.0, goes_on),
        };
        proposals.map_or(Portion::Stopped, Portion::Done)
    }
}

/// Returns proposals for a scenario that was refused, the least change first; each has been planned, and starts.
pub fn proposals(scenario: &Scenario, refusal: &Refusal) -> Vec<Proposal> {
    proposals_while(scenario, refusal, &mut |_| true).unwrap_or_default()
}

/// Does the same as [`proposals`], unless `goes_on` cancels it.
fn proposals_while(scenario: &Scenario, refusal: &Refusal, goes_on: ProgressCallback<'_>) -> Option<Vec<Proposal>> {
    let bare = scenario.without_edits();
    let candidates = candidates(&bare, refusal);
    let count = candidates.len() + 1;
    // Making a task for the machine takes a search, so this is done only if the loop below gets to it.
    let made = std::iter::once_with(|| would_plan(refusal).then(|| made_task(&bare)).flatten()).flatten();
    let mut proposals: Vec<Proposal> = Vec::new();
    for (i, candidate) in candidates.into_iter().chain(made).enumerate() {
        if !goes_on(i as f64 / count as f64) {
            return None;
        }
        let candidate = candidate.reduced(&bare);
        if !candidate.change.is_empty()
            && proposals.iter().all(|known| known.text != candidate.text && known.change != candidate.change)
            && candidate.tried(&bare).is_some()
        {
            proposals.push(candidate);
            if proposals.len() == MAX_PROPOSALS {
                break;
            }
        }
    }
    Some(proposals)
}

/// Returns proposals for a scenario that starts, but whose plan exceeds a limit of a drive or changes b, or whose
/// machine is not balanced. Each has been planned, and mends what its text says.
pub fn improvements(scenario: &Scenario) -> Vec<Proposal> {
    improvements_while(scenario, &mut |_| true).unwrap_or_default()
}

fn improvements_while(scenario: &Scenario, goes_on: ProgressCallback<'_>) -> Option<Vec<Proposal>> {
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

/// Returns changes that may lead out of a refusal, the least first.
fn candidates(scenario: &Scenario, refusal: &Refusal) -> Vec<Proposal> {
    let (task, machine) = (&scenario.task, &scenario.machine);
    let kind = |kind: TaskKind, text: &str| Proposal::new(text, single_change("task.kind", kind.words().file));
    let mut found = Vec::new();
    if let Some(b) = refusal.displayed_b() {
        found.push(Proposal::new(format!("take b = {b} rad"), single_change("task.b", b.value())));
        found.extend(turned_task(scenario, b.value()));
    }
    match refusal {
        Refusal::Edit { refusal, .. } => return candidates(scenario, refusal),
        Refusal::NoCommonPlane { why, .. } => {
            let shown = why.correction.and_then(|correction| Some((correction.point, correction.shown?)));
            found.extend(shown.and_then(|(point, shown)| {
                let mut change = task.moving(point, shown.point())?;
                change.insert("b".into(), shown.b.value().into());
                let [x, y] = shown.to;
                Some(Proposal::of_task(format!("move {} to ({x}, {y}) m", task.name_of(point)), change))
            }));
        }
        Refusal::OutOfRange { what, value, want: Requirement::Within(range) } => {
            let nearest = value.clamp(range.low(), range.high());
            let text = format!("take {what} = {}", typed(&nearest.into()));
            found.push(Proposal::new(text, single_change(what, nearest)));
        }
        Refusal::TooManySteps { time, .. } => {
            let step = round_up(time / MAX_STEPS as f64);
            found.push(Proposal::new(format!("take a step of {step} s"), single_change("step", step)));
        }
        _ => {}
    }
    if !would_plan(refusal) {
        return found;
    }
    let is_of_path = matches!(
        refusal,
        Refusal::Blocked(_) | Refusal::Path(_) | Refusal::Curve(_) | Refusal::NoWay(_) | Refusal::Unreachable { .. }
    );
    if is_of_path && task.uses("shape") && task.shape() != PathShape::JointLine {
        let change = single_change("task.shape", PathShape::JointLine.words().file);
        found.push(Proposal::new("take joint lines from point to point", change));
    }
    if matches!(refusal, Refusal::Time(_) | Refusal::TooLong { .. }) && task.law != TimeLaw::Quintic {
        found
            .push(Proposal::new("take the quintic time law", single_change("task.law", TimeLaw::Quintic.words().file)));
    }
    if !Inertia::of(machine).is_balanced() {
        found.extend(balancing_change(scenario).map(|change| Proposal::new("balance the machine", change)));
    }
    if task.kind != TaskKind::LeastReaction {
        found.push(kind(TaskKind::LeastReaction, "take the path of least reaction"));
    }
    if task.kind != TaskKind::MinimumNorm {
        found.push(kind(TaskKind::MinimumNorm, "follow the path, whatever the base feels"));
    }
    found
}

/// Returns whether another plan may lead out of a refusal. It cannot if the task could be planned already. A
/// finer step may help then, but only a simulation shows whether it does.
fn would_plan(refusal: &Refusal) -> bool {
    match refusal {
        Refusal::Edit { refusal, .. } => would_plan(refusal),
        Refusal::TooManySteps { .. }
        | Refusal::TooLarge { .. }
        | Refusal::Full { .. }
        | Refusal::Stopped
        | Refusal::Diverged { .. }
        | Refusal::Untrusted { .. }
        | Refusal::LeavesLimits { .. } => false,
        _ => true,
    }
}

/// Proposes a task made for the machine.
fn made_task(scenario: &Scenario) -> Option<Proposal> {
    let own = gentle_motion(&scenario.machine).ok()?;
    Some(Proposal::of_task("take a task made for this machine", own.task.whole()))
}

/// Proposes to keep b and turn all points of the task about the base pin. The workspace turns by the same angle when
/// b changes from `feasible_b`, rad, to the b of the task.
fn turned_task(scenario: &Scenario, feasible_b: f64) -> Vec<Proposal> {
    let task = &scenario.task;
    let Ok(space) = PoseSpace::of(&scenario.machine) else { return Vec::new() };
    if task.samples.is_some() {
        return Vec::new();
    }
    let turn = unit(space.turn(task.b - feasible_b));
    // Rounding may move a point out of the workspace; the first of the roundings that is feasible is proposed.
    let rounded = TURNED_DECIMALS.into_iter().filter_map(|decimals| {
        let round = |x: f64| Decimal::nearest(x, decimals).value();
        let points: Vec<Vector> =
            task.points().into_iter().map(|p| turn * p).map(|p| Vector::new(round(p.re), round(p.im))).collect();
        let text = format!("keep b = {} rad, and turn the task with it", significant(task.b));
        Some(Proposal::of_task(text, Task::visiting(&points)?))
    });
    rounded.collect()
}

/// Returns the next larger number of two significant digits.
fn round_up(x: f64) -> f64 {
    let unit = 10f64.powf(x.abs().log10().floor() - 1.0);
    let rounded = (x / unit).ceil() * unit;
    format!("{rounded:.1e}").parse().unwrap_or(rounded)
}

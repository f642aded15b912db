//! Applies edits to a scenario, and sorts edits by step.

use super::edit::{Edit, TimedEdit};
use super::refusal::Refusal;
use super::scenario::{Scenario, Task};
use stillbase_planning::pose_constant::PoseSpaceQuery;
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::posed::carried_points;
use stillbase_query::{Queries, QuickWork};
use stillbase_settings::range::shortened;

/// Returns the scenario with the settings or the push of an edit applied. Nothing is planned or checked; see
/// [`checked`]. Drags and poses do not change the scenario.
pub(super) fn changed(scenario: &Scenario, edit: &Edit) -> Result<Scenario, Refusal> {
    if let Some(block) = &scenario.assembly {
        block.check(edit)?;
    }
    let mut scenario = scenario.clone();
    match edit {
        Edit::Push { x, y } => {
            scenario.plant.force = [*x, *y];
        }
        Edit::Set { change } => scenario = scenario.with_settings(change)?,
        Edit::Sketch(step) => scenario = scenario.sketched(step)?,
        Edit::PoseB { .. }
        | Edit::DragTarget { .. }
        | Edit::DragBlocks { .. }
        | Edit::HandOver { .. }
        | Edit::DragAngles { .. }
        | Edit::PullLink { .. }
        | Edit::SlideB { .. } => {}
    }
    Ok(scenario)
}

/// Returns the scenario if it is valid after an edit of its settings or of the push.
pub(super) fn checked(scenario: Scenario, edit: &Edit) -> Result<Scenario, Refusal> {
    match edit {
        Edit::Push { .. } | Edit::Set { .. } | Edit::Sketch(_) => check_fit(scenario, edit.name()),
        _ => Ok(scenario),
    }
}

pub(super) fn check_fit(scenario: Scenario, of: &str) -> Result<Scenario, Refusal> {
    scenario.check(of).map_err(|why| Refusal::Task(why.to_string()))?;
    Ok(scenario)
}

/// Returns the scenario with an edit applied before the first step.
pub(super) fn after_start_edit(scenario: &Scenario, edit: &Edit, queries: &Queries) -> Result<Scenario, Refusal> {
    edit.check()?;
    let Edit::PoseB { b } = edit else { return changed(scenario, edit) };
    let space = queries.ask::<QuickWork<PoseSpaceQuery>>(&scenario.machine);
    Ok(Scenario { task: task_at_b(scenario, Result::as_deref(&space).ok(), *b), ..scenario.clone() })
}

/// Returns the task at another pose constant b, rad. Points turn with the reactionless workspace if b does not reach
/// all of them.
pub(super) fn task_at_b(scenario: &Scenario, space: Option<&PoseSpace>, b: f64) -> Task {
    if let Some(task) = scenario.task.posed(&scenario.machine, b) {
        return task;
    }
    let mut task = Task { b, start: None, ..scenario.task.clone() };
    let places = space.map(|space| carried_points(space, &task.points(), [scenario.task.b, b]));
    if let Some([from, via @ .., to]) = places.as_deref() {
        let place = |p: &stillbase_mechanics::planar::Vector| [p.re, p.im];
        (task.from, task.to) = (place(from), place(to));
        task.via = via.iter().map(place).collect();
    }
    task
}

/// Returns the number of edits at step 0 before the first that acts in motion.
pub(super) fn opening<'a>(script: impl IntoIterator<Item = &'a TimedEdit>) -> usize {
    script.into_iter().take_while(|e| e.step == 0 && !e.edit.acts_in_motion()).count()
}

/// Returns the indices of the edits sorted by step; edits of one step keep their order.
pub(super) fn order_of(edits: &[TimedEdit]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..edits.len()).collect();
    order.sort_by_key(|i| edits[*i].step);
    order
}

/// Returns the edits sorted by step; edits of one step keep their order.
pub(super) fn in_order(edits: &[TimedEdit]) -> Vec<TimedEdit> {
    order_of(edits).into_iter().map(|i| edits[i].clone()).collect()
}

/// Reason why a script cannot be carried out, and the index of the edit that causes it, if one does.
pub(super) struct ScriptError {
    edit: Option<usize>,
    refusal: Refusal,
}

impl ScriptError {
    pub(super) fn at(edit: usize, refusal: Refusal) -> Self {
        Self { edit: Some(edit), refusal }
    }

    /// Returns the refusal without the edit.
    pub(super) fn refusal(self) -> Refusal {
        self.refusal
    }

    /// Returns the refusal with the number of the edit in `edits`, which are in the order of the file.
    pub(super) fn named(self, edits: &[TimedEdit]) -> Refusal {
        let order = order_of(edits);
        match self.edit.and_then(|i| order.get(i)).and_then(|&i| Some((i, edits.get(i)?))) {
            Some((i, timed)) => Refusal::Edit {
                entry: i + 1,
                step: timed.step,
                title: shortened(&timed.edit.title(), 80),
                refusal: Box::new(self.refusal),
            },
            None => self.refusal,
        }
    }
}

impl<E: Into<Refusal>> From<E> for ScriptError {
    fn from(error: E) -> Self {
        Self { edit: None, refusal: error.into() }
    }
}

/// Applies the edits at step 0 before the first drag. Returns the scenario, without any edits, and the number of edits
/// applied.
pub(super) fn fold_start_edits(
    scenario: &Scenario,
    script: &[TimedEdit],
    queries: &Queries,
) -> Result<(Scenario, usize), ScriptError> {
    let count = opening(script);
    // Edits are removed first, because every copy below would copy them too.
    let mut start = scenario.without_edits();
    for (i, timed) in script[..count].iter().enumerate() {
        start = after_start_edit(&start, &timed.edit, queries).map_err(|refusal| ScriptError::at(i, refusal))?;
    }
    // Only the scenario after all of these edits has to be valid, not those in between.
    let start = if count > 0 { check_fit(start, "the scenario")? } else { start };
    Ok((start, count))
}

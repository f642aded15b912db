//! A scenario as edits leave it, and edits in their order.

use super::edit::{Edit, TimedEdit};
use super::refusal::Refusal;
use super::scenario::{Scenario, Task};
use crate::planning::pose_constant::SpaceOf;
use crate::planning::pose_space::PoseSpace;
use crate::planning::posed::carried;
use crate::query::{Queries, Whole};
use crate::settings::range::shortened;

/// A scenario with a parameter set; nothing is planned, and whether all fits together is for [`checked`] to say.
pub(super) fn changed(scenario: &Scenario, edit: &Edit) -> Result<Scenario, Refusal> {
    let mut scenario = scenario.clone();
    match edit {
        Edit::Push { x, y } => {
            scenario.plant.force = [*x, *y];
        }
        Edit::Set { change } => scenario = scenario.with(change)?,
        Edit::PoseB { .. }
        | Edit::DragTarget { .. }
        | Edit::DragAngles { .. }
        | Edit::PullLink { .. }
        | Edit::SlideB { .. } => {}
    }
    Ok(scenario)
}

/// A scenario that an edit of its settings has left sound.
pub(super) fn checked(scenario: Scenario, edit: &Edit) -> Result<Scenario, Refusal> {
    match edit {
        Edit::Push { .. } | Edit::Set { .. } => sound(scenario, edit.name()),
        _ => Ok(scenario),
    }
}

pub(super) fn sound(scenario: Scenario, of: &str) -> Result<Scenario, Refusal> {
    scenario.check(of).map_err(|why| Refusal::Task(why.to_string()))?;
    Ok(scenario)
}

/// A scenario as an edit before its first step leaves it.
pub(super) fn amended(scenario: &Scenario, edit: &Edit, queries: &Queries) -> Result<Scenario, Refusal> {
    edit.check()?;
    let Edit::PoseB { b } = edit else { return changed(scenario, edit) };
    let space = queries.ask::<Whole<SpaceOf>>(&scenario.machine);
    Ok(Scenario { task: posed(scenario, Result::as_deref(&space).ok(), *b), ..scenario.clone() })
}

/// The task at another b: where that does not reach all its points, they turn with what is reached.
pub(super) fn posed(scenario: &Scenario, space: Option<&PoseSpace>, b: f64) -> Task {
    if let Some(task) = scenario.task.posed(&scenario.machine, b) {
        return task;
    }
    let mut task = Task { b, ..scenario.task.clone() };
    let places = space.map(|space| carried(space, &task.points(), [scenario.task.b, b]));
    if let Some([from, via @ .., to]) = places.as_deref() {
        let place = |p: &crate::mechanics::planar::Vector| [p.re, p.im];
        (task.from, task.to) = (place(from), place(to));
        task.via = via.iter().map(place).collect();
    }
    task
}

/// How many edits come before the first step, up to the first that leads the machine.
pub(super) fn opening<'a>(script: impl IntoIterator<Item = &'a TimedEdit>) -> usize {
    script.into_iter().take_while(|e| e.step == 0 && !e.edit.leads()).count()
}

/// Places of edits in the order of their steps; those of one step stay in theirs.
pub(super) fn order_of(edits: &[TimedEdit]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..edits.len()).collect();
    order.sort_by_key(|i| edits[*i].step);
    order
}

/// Edits in the order of their steps; those of one step stay in theirs.
pub(super) fn in_order(edits: &[TimedEdit]) -> Vec<TimedEdit> {
    order_of(edits).into_iter().map(|i| edits[i].clone()).collect()
}

/// Why a script cannot be carried out, and which of its edits is to blame, counted from 0, if it is one.
pub(super) struct Failed {
    edit: Option<usize>,
    refusal: Refusal,
}

impl Failed {
    pub(super) fn at(edit: usize, refusal: Refusal) -> Self {
        Self { edit: Some(edit), refusal }
    }

    /// The refusal alone.
    pub(super) fn refusal(self) -> Refusal {
        self.refusal
    }

    /// Why, with the entry of the file that the script was made of.
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

impl<E: Into<Refusal>> From<E> for Failed {
    fn from(error: E) -> Self {
        Self { edit: None, refusal: error.into() }
    }
}

/// A scenario with the edits before its first step made, up to the first that leads the machine, and their number; it
/// carries no edits any more.
pub(super) fn folded(
    scenario: &Scenario,
    script: &[TimedEdit],
    queries: &Queries,
) -> Result<(Scenario, usize), Failed> {
    let count = opening(script);
    // Every copy below would copy its edits too.
    let mut start = scenario.without_edits();
    for (i, timed) in script[..count].iter().enumerate() {
        start = amended(&start, &timed.edit, queries).map_err(|refusal| Failed::at(i, refusal))?;
    }
    // Only the scenario after all of these edits has to be valid, not those in between.
    let start = if count > 0 { sound(start, "the scenario")? } else { start };
    Ok((start, count))
}

//! A scenario as edits leave it, and edits in their order.

use super::edit::{Edit, TimedEdit};
use super::refusal::Refusal;
use super::scenario::{Scenario, Task};
use crate::mechanics::planar::{Vector, unit};
use crate::planning::pose_constant::{Planes, PlanesOf};
use crate::planning::pose_space::PoseSpace;
use crate::planning::reactionless::PlanePoint;
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
    match &*queries.ask::<Whole<PlanesOf>>(&scenario.machine) {
        Some(planes) => Ok(posed(scenario, planes, *b)),
        None => {
            let posed = scenario.task.posed(&scenario.machine, *b);
            let task = posed.unwrap_or_else(|| turned(scenario, *b));
            Ok(Scenario { task, ..scenario.clone() })
        }
    }
}

/// The task of other than three drives at another b: where that does not reach all its points, they turn with what it
/// reaches.
fn turned(scenario: &Scenario, b: f64) -> Task {
    let task = Task { b, ..scenario.task.clone() };
    let Ok(space) = PoseSpace::of(&scenario.machine) else { return task };
    if task.points().iter().all(|p| space.reaches(*p, b)) {
        return task;
    }
    let turn = unit(space.turn(b - scenario.task.b));
    let place = |[x, y]: [f64; 2]| {
        let p = turn * Vector::new(x, y);
        [p.re, p.im]
    };
    let via = task.via.iter().copied().map(place).collect();
    Task { from: place(task.from), to: place(task.to), via, ..task }
}

/// The task on another plane: its points keep their places while one plane serves all; beyond that they turn with the
/// workspace.
pub(super) fn posed(scenario: &Scenario, planes: &Planes, b: f64) -> Scenario {
    let mut scenario = scenario.clone();
    if let Some(task) = scenario.task.posed(&scenario.machine, b) {
        return Scenario { task, ..scenario };
    }
    scenario.task.b = b;
    let points = scenario.task.points();
    if let (Err(_), Some(turned)) = (planes.serve(&points, b), planes.serve_turned(&points, b)) {
        let place = |at: &PlanePoint| {
            let p = planes.map().forward(at.a, at.b);
            [p.re, p.im]
        };
        if let [from, via @ .., to] = &turned[..] {
            (scenario.task.from, scenario.task.to) = (place(from), place(to));
            scenario.task.via = via.iter().map(place).collect();
        }
    }
    scenario
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

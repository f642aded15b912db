//! [`SharedTask`]: one task on several machines, with the same points, the same time and, if possible, the same start.

use toml::Value;

use super::Refusal;
use super::replay::with_start_edits;
use super::run::Run;
use super::scenario::{PathShape, Scenario, Task, TaskChange, TaskKind};
use stillbase_mechanics::kinematics::end_effector;
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::DriveAngles;
use stillbase_planning::pose_constant::PoseConstant;
use stillbase_settings::change::DEFAULT_WORD;
use stillbase_settings::word::Choice as _;

/// Largest distance of the end effector from A in the start pose of another machine, m.
const PLACE_TOLERANCE_M: f64 = 1e-9;
/// Poses that differ by less are the same, rad.
const POSE_TOLERANCE_RAD: f64 = 1e-9;

/// The task of a scenario on another machine.
#[derive(Clone, Debug, PartialEq)]
pub struct SharedTask {
    /// The scenario on this machine.
    pub scenario: Scenario,
    /// How the task differs from that of the other machines, if it does.
    pub note: Option<String>,
}

impl SharedTask {
    /// Returns the task of a scenario on each of some machines, after its edits before the first step. The runs start
    /// from one pose if it has the end effector of each machine at A. A machine without the pose constant that the kind
    /// of the task wants goes straight, with minimum-norm rates.
    ///
    /// # Errors
    /// If an edit of the scenario cannot apply.
    pub fn on(scenario: &Scenario, machines: &[&Machine]) -> Result<Vec<Self>, Refusal> {
        let (own, _) = with_start_edits(scenario)?;
        let mut starts: Vec<DriveAngles> = start_of(&own).into_iter().collect();
        let mut tasks: Vec<(Self, Option<DriveAngles>)> = Vec::new();
        for machine in machines {
            let alike = own.on_machine(machine);
            let start = start_of(&alike);
            tasks.push(match straightened(&alike).filter(|_| start.is_none()) {
                Some(straight) => straight,
                None => (Self { scenario: alike, note: None }, start),
            });
        }
        // Machines that do the task as it is stated choose the pose before those that go straight.
        for stated in [true, false] {
            let those = tasks.iter().filter(|(task, _)| task.note.is_none() == stated);
            starts.extend(those.filter_map(|(_, start)| *start));
        }
        Ok(tasks.into_iter().map(|(task, start)| task.started(start, &starts)).collect())
    }

    /// Returns the task, which begins at `own` now, from the first of some poses that has the end effector at A.
    fn started(self, own: Option<DriveAngles>, starts: &[DriveAngles]) -> Self {
        let Self { scenario, note } = &self;
        let (Some(own), a) = (own, scenario.task.points()[0]) else { return self };
        let tip = |q: &DriveAngles| end_effector(scenario.machine.end_effector(), &q.units());
        let fits = |q: &&DriveAngles| q.len() == own.len() && (tip(q) - a).norm() <= PLACE_TOLERANCE_M;
        let Some(start) = starts.iter().find(fits) else { return self };
        if start.0.minus(&own.0).max_abs() <= POSE_TOLERANCE_RAD {
            return self;
        }
        let angles: Vec<Value> = start.iter().map(|q| Value::from(*q)).collect();
        let change = TaskChange::from_iter([("start".to_owned(), angles.into())]);
        let Ok(task) = scenario.task.with_change(&change, &scenario.machine) else { return self };
        let begun = Scenario { task, ..scenario.clone() };
        match Run::new(&begun) {
            Ok(_) => Self { scenario: begun, note: note.clone() },
            Err(why) => {
                let apart = format!("it starts from another pose: from that of the others, {why}");
                let note = note.iter().cloned().chain([apart]).collect::<Vec<_>>().join("; ");
                Self { note: Some(note), ..self }
            }
        }
    }
}

/// Returns the pose from which the plan of a scenario starts, if there is a plan.
fn start_of(scenario: &Scenario) -> Option<DriveAngles> {
    Run::new(scenario).ok().map(|run| run.plan().motion.path.at(0.0).q)
}

/// Returns the task straight on and its start, if its machine lacks a pose constant and can do it so.
pub(crate) fn straightened(scenario: &Scenario) -> Option<(SharedTask, Option<DriveAngles>)> {
    let PoseConstant::None(why) = PoseConstant::of(&scenario.machine) else { return None };
    let kind = scenario.task.kind.words().file;
    let task = scenario.task.with_change(&straight(&scenario.task), &scenario.machine).ok()?;
    let scenario = Scenario { task, ..scenario.clone() };
    let start = start_of(&scenario)?;
    let note = format!("{why}; it moves with the kind minimum-norm in place of {kind}");
    Some((SharedTask { scenario, note: Some(note) }, Some(start)))
}

/// Returns the change of a task after which the end effector goes straight from point to point, with minimum-norm rates.
pub fn straight(task: &Task) -> TaskChange {
    let mut change = TaskChange::from_iter([("kind".to_owned(), Value::from("minimum-norm"))]);
    if task.shape() == PathShape::JointLine {
        change.insert("shape".into(), "line".into());
    }
    if matches!(task.kind, TaskKind::ChangeB | TaskKind::LeastReaction) {
        change.insert("b_to".into(), DEFAULT_WORD.into());
    }
    change
}

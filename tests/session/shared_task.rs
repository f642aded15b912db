//! One task on several machines: before and after of a design.

use stillbase::mechanics::balance::{Preset, design};
use stillbase::mechanics::machine::{self, Machine};
use stillbase::mechanics::planar::{DriveAngles, Vector};
use stillbase::session::scenario::{Scenario, TaskKind};
use stillbase::session::{Run, SharedTask, for_machine};
use stillbase::study::comparison::ComparedRun;

fn bare() -> Machine {
    machine::builtin("nine-link-bare").expect("built in").clone()
}

fn balanced() -> Machine {
    design(&bare(), &Preset::Table1.penalty(9).expect("nine links")).expect("it balances")
}

fn scenario(name: &str) -> Scenario {
    Scenario::builtin(name).expect("built in")
}

fn on(scenario: &Scenario, machines: &[&Machine]) -> Vec<SharedTask> {
    SharedTask::on(scenario, machines).expect("a task")
}

/// Drive angles of the planned motion at some instants.
fn angles(task: &SharedTask) -> Vec<DriveAngles> {
    let run = Run::new(&task.scenario).expect("a plan");
    (0..=10).map(|i| run.plan().motion.at(0.1 * f64::from(i)).q).collect()
}

fn distance(one: &DriveAngles, other: &DriveAngles) -> f64 {
    one.0.minus(&other.0).max_abs()
}

/// Without a b to hold, the bare machine goes straight through the same points, from the pose of the balanced one.
#[test]
fn a_machine_without_b_goes_straight_from_the_same_pose() {
    let case = scenario("case-3");
    let (bare, balanced) = (bare(), balanced());
    let tasks = on(&case, &[&bare, &balanced]);
    let kinds: Vec<TaskKind> = tasks.iter().map(|task| task.scenario.task.kind).collect();
    assert_eq!(kinds, [TaskKind::MinimumNorm, TaskKind::Reactionless]);
    assert!(tasks[0].note.as_ref().is_some_and(|note| note.contains("minimum-norm in place of reactionless")));
    assert!(tasks[1].note.is_none());
    for task in &tasks {
        let near = |(p, q): (&Vector, &Vector)| (p - q).norm() < 1e-9;
        assert!(task.scenario.task.points().iter().zip(&case.task.points()).all(near));
        assert_eq!(task.scenario.task.time, case.task.time);
        assert!(task.scenario.edits.is_empty());
    }
    let own = Run::new(&case).expect("a plan").plan().motion.at(0.0).q;
    assert!(tasks.iter().all(|task| distance(&angles(task)[0], &own) < 1e-9), "one start");
}

/// With minimum-norm rates arms of the same lengths turn alike, so that what differs between their runs is the ratio β
/// of the comparison of designs, which is found without a run.
#[test]
fn arms_of_the_same_lengths_turn_alike() {
    let case = scenario("case-1");
    let (bare, balanced) = (bare(), balanced());
    let tasks = on(&case, &[&bare, &balanced]);
    assert!(tasks.iter().all(|task| task.note.is_none() && task.scenario.task.kind == TaskKind::MinimumNorm));
    let [before, after] = [0, 1].map(|i| angles(&tasks[i]));
    assert!(before.iter().zip(&after).all(|(one, other)| distance(one, other) < 1e-8));
    let [first, second] = [0, 1].map(|i| ComparedRun::of(tasks[i].scenario.clone()).expect("it runs"));
    let design = second.candidate.compared_with(&first.candidate);
    let beta = design.comparison.and_then(|measures| measures.beta).expect("the same motion");
    let ratio = second.summary.rms_moment / first.summary.rms_moment;
    assert!(beta.moment.is_some_and(|moment| (moment - ratio).abs() < 1e-3 * ratio), "{beta:?}, {ratio}");
    // Alone, the bare machine chooses another elbow or b only if nobody has chosen before.
    let stated = on(&tasks[0].scenario, &[&balanced]);
    assert!(distance(&angles(&stated[0])[0], &before[0]) < 1e-9, "a stated start holds for each machine");
}

/// A pose that has the end effector of another arm elsewhere is none of its task: the points come first.
#[test]
fn another_arm_keeps_the_points() {
    let longer = bare().set("length.l9", "0.31").expect("a machine");
    let case = scenario("case-1");
    let task = &on(&case, &[&longer])[0];
    assert_eq!((task.scenario.task.points(), task.scenario.task.start), (case.task.points(), None));
    Run::new(&task.scenario).expect("it reaches them");
}

/// The window opens a machine without a b with the present task, as the command puts it there.
#[test]
fn a_bare_machine_is_opened_with_the_present_task() {
    let machine = bare().set("link.9.mass", "0.4").expect("a machine");
    let mut spec = machine.spec().clone();
    spec.name = "my bars".into();
    let machine = Machine::new(spec).expect("a machine");
    let case = scenario("case-3");
    let opened = for_machine(&case, &machine);
    assert_eq!((opened.task.points(), opened.task.kind), (case.task.points(), TaskKind::MinimumNorm));
}

//! A scenario around a machine that comes without one.

use stillbase::mechanics::machine::{Inertia, Machine, builtins, parse};
use stillbase::session::scenario::TaskKind;
use stillbase::session::{Run, gentle_motion, replay};

/// Every machine gets a task that it can do: within its limits, with no limit of a drive passed, and some way long.
fn does_its_task(machine: &Machine) -> TaskKind {
    let name = machine.name();
    let scenario = gentle_motion(machine).expect("a scenario");
    assert_eq!((scenario.name.as_str(), &scenario.machine), (name, machine));
    let run = Run::new(&scenario).unwrap_or_else(|why| panic!("{name}: {why}"));
    assert_eq!(run.plan().forecast.exceeded_limit, None, "{name}");
    let mut worst: f64 = 0.0;
    let done = replay(&scenario, |_, frame| {
        for (angle, a) in machine.angles().iter().zip(frame.a.iter()) {
            worst = worst.max(angle.limits.start() - a).max(a - angle.limits.end());
        }
    });
    let last = done.unwrap_or_else(|why| panic!("{name}: {why}")).frame();
    assert!(worst < 1e-6, "{name} passes a limit by {worst} rad");
    assert!((last.end_effector - run.frame().end_effector).norm() > 1e-3, "{name} does not move");
    if scenario.task.kind == TaskKind::Reactionless && Inertia::of(machine).is_balanced() {
        assert!(last.peaks.arm_moment < 1e-6 * last.peaks.torque.max_abs(), "{name}: {}", last.peaks.arm_moment);
    }
    // The same machine gets the same task.
    assert_eq!(gentle_motion(machine).expect("a scenario"), scenario);
    scenario.task.kind
}

#[test]
fn every_machine_that_comes_along_gets_a_task() {
    for machine in builtins() {
        let kind = does_its_task(machine);
        let can = Inertia::of(machine).is_balanced() && machine.drives() > 1;
        assert!(!can || kind == TaskKind::Reactionless, "{}: {kind:?}", machine.name());
    }
}

/// Angles without limits, with the drives in another order, and none at all.
#[test]
fn machines_of_other_kinds_get_one_too() {
    let arm = |drives: usize, angles: &str| {
        let mut text = "name = \"arm\"\n".to_owned();
        for k in 1..=drives {
            text += &format!("[[drive]]\nname = \"{k}\"\ntorque_limit = 9.0\n");
        }
        for k in 1..=drives {
            let attach = match k {
                1 => "\"base\"".to_owned(),
                _ => format!("{{ link = \"{}\", at = \"tip\" }}", k - 1),
            };
            text += &format!(
                "[[link]]\nname = \"{k}\"\ndrive = \"{k}\"\nattach = {attach}\nlength = 0.4\nmass = 1.0\n\
                 inertia = 0.02\ncom = 0.2\n"
            );
        }
        text += &format!("{angles}\n[end_effector]\nlink = \"{drives}\"\n");
        parse(&text, "arm.toml").expect("a machine")
    };
    let free = "[[angle]]\nname = \"a\"\nto = \"2\"\nfrom = \"1\"\n";
    let turned = "[[angle]]\nname = \"a\"\nto = \"1\"\nfrom = \"2\"\nmin = -2.0\nmax = -1.0\n";
    let second = "[[angle]]\nname = \"b\"\nto = \"3\"\nfrom = \"2\"\nmin = 0.2\nmax = 1.0\n";
    let both = |first: &str| format!("{first}{second}");
    // No angle means no limit, for three drives too.
    for (drives, angles) in [(2, free), (2, turned), (2, ""), (3, &both(turned)), (3, free), (3, ""), (4, "")] {
        does_its_task(&arm(drives, angles));
    }
}

//! Models for MuJoCo.

use stillbase::exchange::cut::Cut;
use stillbase::exchange::mjcf::{MjcfError, hinges, middle, mjcf};
use stillbase::mechanics::machine::{Machine, builtin, builtins, parse, to_toml};

fn model(machine: &Machine) -> String {
    mjcf(machine, None, &middle(machine), &Cut::default()).expect("a model")
}

fn count(text: &str, what: &str) -> usize {
    text.matches(what).count()
}

/// A body for each link and rotor, a hinge for each of them, a motor for each drive.
#[test]
fn every_part_is_in_the_model_once() {
    for machine in builtins() {
        let text = model(machine);
        let rotors = machine.spec().drives.iter().filter(|drive| drive.rotor.is_some()).count();
        let moving = machine.links().len() + rotors;
        let name = machine.name();
        assert_eq!(count(&text, "<body "), moving + 1, "{name}: and the base");
        assert_eq!(count(&text, "</body>"), moving + 1, "{name}");
        assert_eq!(count(&text, "<inertial "), moving, "{name}");
        assert_eq!(count(&text, "<motor "), machine.drives(), "{name}");
        assert_eq!(count(&text, "<connect "), machine.loops().len(), "{name}");
        assert_eq!(count(&text, "polycoef"), rotors, "{name}: gears");
        let pose = hinges(machine, &middle(machine)).expect("a pose");
        assert_eq!(pose.len(), moving, "{name}");
        let words = pose.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
        assert!(text.contains(&format!("qpos=\"{words}\"")), "{name}");
        assert!(!text.contains("NaN") && !text.contains("inf"), "{name}");
    }
}

/// A pin turns by the difference of what it joins, in every pose.
#[test]
fn hinges_add_up_to_directions() {
    let machine = builtin("nine-link").expect("built in");
    let q = [0.3, 1.1, -2.0];
    // In the order of the bodies: 1 with 5, 9, 7, 8 on it, 2 with 4, 3 with 6.
    let parts = machine.resolved_links();
    let direction = |j: usize| q[parts[j].drive];
    let pose = hinges(machine, &q).expect("a pose");
    let order = [0, 4, 8, 6, 7, 1, 3, 2, 5];
    for (turn, j) in pose.iter().zip(order) {
        let on = parts[j].parent.map_or(0.0, direction);
        assert!((turn - (direction(j) - on)).abs() < 1e-14, "link {}", j + 1);
    }
}

/// A machine whose loops are left out keeps its links parallel all the same.
#[test]
fn without_its_loops_links_are_kept_parallel() {
    let machine = builtin("nine-link").expect("built in");
    let mut spec = machine.spec().clone();
    spec.closures.clear();
    let open = Machine::new(spec).expect("a machine");
    let text = model(&open);
    assert_eq!(count(&text, "<connect "), 0);
    assert_eq!(count(&text, "<tendon tendon1=\"direction of link"), 6, "{text}");
    assert_eq!(count(&text, "<fixed name=\"direction of link"), 6);
}

#[test]
fn limits_of_angles_and_torques_are_in_it() {
    let text = model(builtin("nine-link").expect("built in"));
    assert!(text.contains("<motor name=\"drive_1\" joint=\"joint_link_1\" ctrlrange=\"-20 20\"/>"), "{text}");
    // a1 and a2 are the pins of links 5 and 9; a2 is half a turn off.
    let range = |link: &str| {
        let line =
            text.lines().find(|line| line.contains(&format!("<joint name=\"joint_link_{link}\""))).expect("a hinge");
        let numbers = line.split("range=\"").nth(1).and_then(|rest| rest.split('"').next()).expect("a range");
        numbers.split(' ').map(|x| x.parse::<f64>().expect("a number")).collect::<Vec<_>>()
    };
    let near = |got: &[f64], want: [f64; 2]| got.iter().zip(want).all(|(got, want)| (got - want).abs() < 1e-14);
    use std::f64::consts::PI;
    assert!(near(&range("5"), [0.0, PI]), "{:?}", range("5"));
    assert!(near(&range("9"), [-PI, 0.0]), "{:?}", range("9"));
}

#[test]
fn names_of_a_stranger_are_quoted() {
    let text = to_toml(builtin("two-drive").expect("built in")).replace("name = \"two-drive\"", "name = 'a\"<&>b'");
    let machine = parse(&text, "strange.toml").expect("a machine");
    assert!(model(&machine).starts_with("<mujoco model=\"a&quot;&lt;&amp;&gt;b\">"));
}

#[test]
fn what_mujoco_could_not_move_is_refused() {
    let machine = builtin("nine-link").expect("built in");
    assert_eq!(mjcf(machine, None, &[0.0; 2], &Cut::default()), Err(MjcfError::Pose { given: 2, wanted: 3 }));
    assert_eq!(hinges(machine, &[0.0; 4]), Err(MjcfError::Pose { given: 4, wanted: 3 }));
    let light = machine.set("link.4.inertia", "0").expect("in range");
    let why = mjcf(&light, None, &[0.0; 3], &Cut::default()).expect_err("MuJoCo moves no such body");
    assert_eq!(why, MjcfError::Massless { link: "4".into(), what: "inertia" });
    assert!(why.to_string().contains("link \"4\" has inertia 0"), "{why}");
}

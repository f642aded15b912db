//! Machines from other programs: what goes out comes back as the same machine, arms as others write them come in as what
//! textbooks say, and all else is refused by name.

use stillbase::exchange::import::{Imported, import};
use stillbase::exchange::mjcf::{middle, mjcf};
use stillbase::exchange::urdf::urdf;
use stillbase::mechanics::dynamics::mass_matrix;
use stillbase::mechanics::machine::{Counterweight, Inertia, Machine, builtin, builtins, place_of};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Units, Vector};

use super::arms::{THREE, TWO};
use crate::support::Noise;
use crate::support::random::{a_chain, a_machine};

fn machines() -> Vec<Machine> {
    let mut noise = Noise::of(11);
    let mut machines: Vec<Machine> = builtins().to_vec();
    for machine in builtins() {
        let mut spec = machine.spec().clone();
        spec.gravity = [0.3, -9.7];
        spec.payload = toml::from_str("mass = 0.4\ninertia = 0.003\noffset = [0.03, -0.02]").expect("a payload");
        let link = spec.links[0].name.clone();
        spec.counterweights.push(Counterweight { link, mass: 1.5, at: -0.1, radius: 0.05 });
        machines.push(Machine::new(spec).expect("a machine"));
    }
    machines.extend((0..60).map(|_| a_machine(&mut noise)));
    machines.extend((0..24).map(|i| a_chain(&mut noise, 1 + i % 8)));
    machines
}

/// The drive of another machine that has the name of drive k.
fn same_drive(machine: &Machine, k: usize, other: &Machine) -> usize {
    let name = &machine.spec().drives[k].name;
    let known = other.spec().drives.iter().position(|drive| drive.name == *name);
    known.unwrap_or_else(|| panic!("{}: no drive {name}", machine.name()))
}

#[track_caller]
fn near(what: &str, got: f64, want: f64, scale: f64) {
    assert!((got - want).abs() <= 1e-9 * scale, "{what}: {got}, want {want}");
}

#[track_caller]
fn near_point(what: &str, got: Vector, want: Vector) {
    assert!((got - want).norm() <= 1e-9 * (1.0 + want.norm()), "{what}: {got}, want {want}");
}

/// Centre of mass of a link, m.
fn com(machine: &Machine, j: usize, e: &Units) -> Vector {
    machine.com_chain(j).iter().zip(e).map(|(a, e)| a * *e).sum()
}

/// Both have the same mass matrix, momentum and places, in poses that are `pose` of the one where the other is at `at`.
fn same(machine: &Machine, found: &Imported, at: &[f64], noise: &mut Noise, is_urdf: bool) {
    let (n, other, name) = (machine.drives(), &found.machine, machine.name());
    assert_eq!(other.drives(), n, "{name}");
    let parts = machine.resolved_links();
    // Of two links of one drive that are pinned together URDF makes one.
    let on = |j: usize| parts[j].parent.filter(|parent| is_urdf && parts[*parent].drive == parts[j].drive);
    let merged: Vec<usize> = (0..parts.len()).filter(|j| on(*j).is_some()).collect();
    let is_changed = |j: usize| merged.iter().any(|i| on(*i) == Some(j)) || merged.contains(&j);
    assert_eq!(other.links().len() + merged.len(), machine.links().len(), "{name}");
    near(&format!("{name}: mass"), other.mass(), machine.mass(), machine.mass());
    let drives: Vec<usize> = (0..n).map(|k| same_drive(machine, k, other)).collect();
    let (own, theirs) = (Inertia::of(machine), Inertia::of(other));
    let scale = (0..n).map(|k| own.diagonal(k)).fold(0.0, f64::max);
    for k in 0..n {
        near(&format!("{name}: D {k}"), theirs.momentum(drives[k]), own.momentum(k), scale);
        let on = machine.motors().on(k).map(|on| drives[on]);
        assert_eq!(other.motors().on(drives[k]), on, "{name}: where motor {k} sits");
        assert_eq!(other.spec().drives[drives[k]].torque_limit, machine.spec().drives[k].torque_limit, "{name}");
    }
    for _ in 0..4 {
        let q = PerDrive::from_fn(n, |_| noise.between(-3.0, 3.0));
        let mut turned = q;
        for k in 0..n {
            turned[drives[k]] = found.pose[drives[k]] + q[k] - at[k];
        }
        let (e, f) = (DriveAngles(q).units(), DriveAngles(turned).units());
        let still = PerDrive::from_fn(n, |_| 0.0);
        let ((h, _), (g, _)) = (mass_matrix(&own, &e, &still), mass_matrix(&theirs, &f, &still));
        for (k, l) in (0..n).flat_map(|k| (0..n).map(move |l| (k, l))) {
            near(&format!("{name}: H {k} {l}"), g.get(drives[k], drives[l]), h.get(k, l), scale);
        }
        near_point(
            &format!("{name}: end effector"),
            place_of(other.end_effector(), &f),
            place_of(machine.end_effector(), &e),
        );
        for (j, link) in machine.links().iter().enumerate().filter(|(j, _)| !is_changed(*j)) {
            let known = other.links().iter().position(|other| other.name == link.name);
            let i = known.unwrap_or_else(|| panic!("{name}: no link {}", link.name));
            let root = |machine: &Machine, j: usize, e: &Units| place_of(&machine.resolved_links()[j].root, e);
            near_point(&format!("{name}: root of {}", link.name), root(other, i, &f), root(machine, j, &e));
            // A payload comes back as part of what holds it.
            if machine.end_link() != j || machine.spec().payload.mass == 0.0 {
                near_point(&format!("{name}: link {}", link.name), com(other, i, &f), com(machine, j, &e));
            }
        }
    }
}

#[test]
fn what_goes_out_as_urdf_comes_back() {
    let mut noise = Noise::of(12);
    for machine in machines() {
        let text = urdf(&machine);
        let found = import(&text).unwrap_or_else(|why| panic!("{}: {why}\n{text}", machine.name()));
        same(&machine, &found, &vec![0.0; machine.drives()], &mut noise, true);
    }
}

#[test]
fn what_goes_out_as_mjcf_comes_back_with_its_loops() {
    let mut noise = Noise::of(13);
    for machine in machines() {
        let at = middle(&machine);
        let text = mjcf(&machine, &at).expect("a model");
        let found = import(&text).unwrap_or_else(|why| panic!("{}: {why}\n{text}", machine.name()));
        same(&machine, &found, &at, &mut noise, false);
        assert_eq!(found.machine.spec().gravity, machine.spec().gravity);
        if builtin(machine.name()).is_some() {
            assert_eq!(found.machine.loops().len(), machine.loops().len(), "{}", machine.name());
            assert_eq!(found.machine.angles().len(), machine.angles().len(), "{}", machine.name());
        }
    }
}

/// Limits of angles come back in the same poses.
#[test]
fn limits_come_back() {
    for (name, text) in [("nine-link", true), ("serial-3r", true), ("serial-3r", false), ("scara", false)] {
        let machine = builtin(name).expect("built in");
        let at = if text { middle(machine) } else { vec![0.0; machine.drives()] };
        let text = if text { mjcf(machine, &at).expect("a model") } else { urdf(machine) };
        let found = import(&text).expect("a machine");
        assert_eq!(found.machine.angles().len(), machine.angles().len(), "{name}");
        for (own, other) in machine.angles().iter().zip(found.machine.angles()) {
            // How far each is from its limits in the pose of the file.
            let left = |machine: &Machine, angle: &stillbase::mechanics::machine::RelativeAngle, q: &[f64]| {
                let _ = machine;
                let a = q[angle.to] - q[angle.from] + angle.offset;
                [a - angle.limits.start(), angle.limits.end() - a]
            };
            let (want, got) = (left(machine, own, &at), left(&found.machine, other, &found.pose));
            // An angle that is counted the other way has its limits the other way round.
            let turned = [got[1], got[0]];
            let is_near = |got: [f64; 2]| got.iter().zip(want).all(|(a, b)| (a - b).abs() < 1e-9);
            assert!(is_near(got) || is_near(turned), "{name}: {got:?}, want {want:?}");
        }
    }
}

/// The mass matrix of every textbook, in relative angles, of two links that someone else has written down.
#[test]
fn an_arm_of_two_links_is_that_of_the_textbook() {
    let found = import(TWO).expect("an arm");
    let machine = &found.machine;
    assert_eq!((machine.drives(), machine.links().len()), (2, 2));
    assert_eq!(machine.motors().on(1), Some(0), "the motor of the elbow sits on the upper arm");
    let (l1, c1, c2, m1, m2, i1, i2) = (0.4, 0.18, 0.15, 2.5, 1.5, 0.04, 0.02);
    for elbow in [0.0, 0.7, -2.1] {
        let m22 = i2 + m2 * c2 * c2;
        let m12 = m22 + m2 * l1 * c2 * f64::cos(elbow);
        let m11 = i1 + m1 * c1 * c1 + m2 * l1 * l1 + 2.0 * m12 - m22;
        let q = PerDrive::from_fn(2, |k| found.pose[k] + 0.3 + if k == 1 { elbow } else { 0.0 });
        let still = PerDrive::from_fn(2, |_| 0.0);
        let (h, _) = mass_matrix(&Inertia::of(machine), &DriveAngles(q).units(), &still);
        // θ = (q_1, q_2 − q_1).
        near("M22", h.get(1, 1), m22, m11);
        near("M12", h.get(1, 1) + h.get(0, 1), m12, m11);
        near("M11", h.get(0, 0) + 2.0 * h.get(0, 1) + h.get(1, 1), m11, m11);
    }
    let spec = machine.spec();
    assert_eq!((spec.drives[0].torque_limit, spec.drives[1].speed_limit), (Some(40.0), Some(3.0)));
    assert_eq!(spec.angles.len(), 1, "that of the shoulder is against the base");
    assert_eq!(found.notes.len(), 2, "{:?}", found.notes);
}

/// An arm in a vertical plane, with a rotor and a link that is not along x.
#[test]
fn axes_may_lie_along_any_direction() {
    let found = import(THREE).expect("an arm");
    assert_eq!(found.machine.drives(), 3);
    let rotor = found.machine.spec().drives[1].rotor.expect("a rotor");
    assert_eq!((rotor.inertia, rotor.ratio), (1e-5, 80.0));
    // What the rotor weighs belongs to the link that carries it.
    near("mass", found.machine.mass(), 3.0 + 2.0 + 1.0 + 0.2, 1.0);
    let tip =
        place_of(found.machine.end_effector(), &DriveAngles(PerDrive::from_slice(&found.pose).expect("three")).units());
    // Of the file: 0.45 and 0.3 along x, and 0.25 above the shoulder.
    near("reach", tip.norm(), 0.75_f64.hypot(0.25), 1.0);
}

/// A file with something changed, and the words of the refusal.
#[test]
fn what_is_outside_of_the_family_is_refused_by_name() {
    for (from, to, words) in [
        ("type=\"revolute\"", "type=\"prismatic\"", ["line 14: joint \"shoulder\"", "revolute, continuous or fixed"]),
        ("type=\"revolute\"", "type=\"floating\"", ["joint \"shoulder\"", "type \"floating\""]),
        (
            "<axis xyz=\"0 0 1\"/>\n    <limit lower=\"-2.5\"",
            "<axis xyz=\"0 1 0\"/>\n    <limit lower=\"-2.5\"",
            ["link \"forearm\"", "all parallel"],
        ),
        ("<mass value=\"2.5\"/>", "<mass value=\"-2.5\"/>", ["<mass>", "-2.5 kg"]),
        ("<mass value=\"2.5\"/>", "<mass value=\"NaN\"/>", ["<mass>", "numbers from"]),
        ("<mass value=\"2.5\"/>", "<mass value=\"1e300\"/>", ["<mass>", "numbers from"]),
        ("<mass value=\"2.5\"/>", "", ["link \"upper_arm\"", "no <mass>"]),
        ("<child link=\"forearm\"/>", "<child link=\"foream\"/>", ["<child>", "no link \"foream\""]),
        ("<child link=\"forearm\"/>", "<child link=\"upper_arm\"/>", ["joint \"elbow\"", "a second joint"]),
        ("name=\"tool0\"", "name=\"forearm\"", ["link \"forearm\"", "names that stand once"]),
        ("<origin xyz=\"0.4 0 0\"/>", "<origin xyz=\"0.4 0 0 1\"/>", ["<origin>", "4 numbers: want 3"]),
        ("izz=\"0.04\"", "izz=\"-0.04\"", ["link \"upper_arm\"", "not below 0"]),
        (
            "<robot name=\"two\">",
            "<robot name=\"two\" xmlns:xacro=\"http://x\"><xacro:include filename=\"a\"/>",
            ["<include>", "plain URDF"],
        ),
        ("<robot name=\"two\">", "<robot name=\"two\"><link name=\"loose\"/>", ["link \"loose\"", "hangs on nothing"]),
        ("<robot name=\"two\">", "<sdf><robot name=\"two\">", ["", "XML"]),
    ] {
        assert!(TWO.contains(from), "{from}");
        let why = import(&TWO.replacen(from, to, 1)).expect_err(to).to_string();
        assert!(words.iter().all(|word| why.contains(word)), "{to}: {why}");
    }
    let missing =
        TWO.split("<inertial>").next().expect("a start").to_owned() + TWO.split_once("</inertial>").expect("one").1;
    let why = import(&missing).expect_err("no inertial").to_string();
    assert!(why.contains("link \"upper_arm\": it turns and has no <inertial>"), "{why}");
    let ends = TWO.find("<link name=\"tool0\">").expect("a tool");
    let bare = TWO[..ends].to_owned() + "</robot>";
    let why = import(&bare).expect_err("no end").to_string();
    assert!(why.contains("where the end effector is") && why.contains("want a link end_effector"), "{why}");
    assert!(import("<sdf/>").expect_err("no robot").to_string().contains("<robot> of URDF or <mujoco> of MJCF"));
}

#[test]
fn what_mjcf_has_besides_is_refused_by_name() {
    let machine = builtin("nine-link").expect("built in");
    let text = mjcf(machine, &middle(machine)).expect("a model");
    for (from, to, words) in [
        ("<joint name=\"link 1\"/>", "<joint name=\"link 1\" type=\"slide\"/>", ["joint \"link 1\"", "want hinges"]),
        ("<joint name=\"link 1\"/>", "<freejoint/>", ["<freejoint>", "on a base"]),
        (
            "<joint name=\"link 1\"/>",
            "<joint name=\"link 1\" armature=\"0.1\"/>",
            ["joint \"link 1\"", "a rotor as a body"],
        ),
        ("<joint name=\"link 1\"/>", "<joint name=\"link 1\" axis=\"1 0 0\"/>", ["turns about", "parallel"]),
        ("<worldbody>", "<include file=\"a.xml\"/><worldbody>", ["<include>", "one file"]),
        (
            "<key name=\"start\" qpos=\"1.5",
            "<key name=\"start\" qpos=\"1.6",
            ["connect \"loop", "every loop is closed"],
        ),
        ("site2=\"loop 1 b\"", "site2=\"loop 1 c\"", ["connect \"loop 1\"", "no site \"loop 1 c\""]),
        ("<motor name=\"drive 2\" joint=\"link 2\"", "<motor name=\"drive 2\" joint=\"link 4\"", ["\"drive", "motor"]),
    ] {
        assert!(text.contains(from), "{from}\n{text}");
        let why = import(&text.replacen(from, to, 1)).expect_err(to).to_string();
        assert!(words.iter().all(|word| why.contains(word)), "{to}: {why}");
    }
}

/// Meshes are decoration.
#[test]
fn meshes_are_left_out_with_a_note() {
    let found = import(TWO).expect("an arm");
    assert!(found.notes.iter().any(|note| note.contains("meshes")), "{:?}", found.notes);
}
